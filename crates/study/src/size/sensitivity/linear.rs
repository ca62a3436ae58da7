//! Deviation of the nearest distance to first order in errors of the emissivities.
//!
//! By the envelope theorem the nearest state does not move to first order, so that with r_w = √(N + σ²) − √(N′ + σ²),
//! d² = Σ r_w² (and the rows of priors), N_w = κ Σ_j w_j S(ν_j) and ∂S/∂e = B(T) − Σ_k V_k ε_k B(T_k) = C
//!
//! ∂d/∂e_j = κ r_w w_j C_j/(2 d √(N + σ²)),   ∂d/∂e′_j = −κ r_w w_j C′_j/(2 d √(N′ + σ²)),
//!
//! and the variance is s² Σ_jk g_j g_k ρ_jk for each surface; with ρ a chain along ascending wavenumber that is one sum. By the sample
//! covariance of a class it is Σ_i (g·m_i)².

use super::ripple::Ripple;
use super::scatter::Scatter;
use crate::{Study, Surface};
use hadar::fisher::Counting;
use hadar::scene::State;
use hadar::spectrum::Bands;

/// Deviation of d.
pub(crate) fn sigma(
    study: &Study,
    alternative: &Surface,
    nearest: &State,
    counting: &Counting,
    distance: f64,
    scatters: [&Scatter<'_>; 2],
) -> f64 {
    let [target, other] = gradients(study, alternative, nearest, counting, distance);
    (scatters[0].variance(&target) + scatters[1].variance(&other)).sqrt()
}

/// ∂d/∂e of target and alternative at every node.
pub(crate) fn gradients(
    study: &Study,
    alternative: &Surface,
    nearest: &State,
    counting: &Counting,
    distance: f64,
) -> [Vec<f64>; 2] {
    let (bands, surroundings) = (&study.bands, &study.surroundings);
    let kappa = counting.counts_per_radiance;
    let surfaces = [(&study.target, &study.state), (alternative, nearest)];
    let roots = surfaces.map(|(surface, state)| {
        let signal = bands.weigh(&surroundings.signal(&surface.emissivity, state));
        let root = signal.iter().enumerate().map(|(w, s)| (kappa * s + counting.var_added(w)).sqrt());
        root.collect::<Vec<f64>>()
    });
    let per_band = bands.sum_nodes(&vec![1.0; bands.nodes_cm1().len()]);
    [0, 1].map(|which| {
        let (_, state) = surfaces[which];
        let sign = if which == 0 { 1.0 } else { -1.0 };
        let of_band = (0..bands.len()).flat_map(|w| {
            let r = roots[0][w] - roots[1][w];
            let slope = sign * kappa * r / (2.0 * distance * roots[which][w]);
            std::iter::repeat_n(slope, per_band[w] as usize)
        });
        let weighed = contrast(study, bands, state);
        of_band.zip(weighed).map(|(slope, weighed)| slope * weighed).collect()
    })
}

/// ∂S_w/∂e_j = w_j (B − X)(ν_j) at every node of the bands: a surface is as bright as its emissivity says, between a perfect mirror and a
/// blackbody.
pub(crate) fn contrast(study: &Study, bands: &Bands, state: &State) -> Vec<f64> {
    let nodes = bands.nodes_cm1().len();
    let [mirror, black] = [0.0, 1.0].map(|e| study.surroundings.signal(&vec![e; nodes], state));
    let contrast = black.iter().zip(&mirror).map(|(black, mirror)| black - mirror);
    contrast.zip(bands.weights_cm1()).map(|(contrast, weight)| contrast * weight).collect()
}

impl Scatter<'_> {
    /// Variance of Σ_j g_j δ_j.
    fn variance(&self, gradient: &[f64]) -> f64 {
        match self {
            Self::Ripple(ripple) => ripple.sigma * ripple.sigma * variance(gradient, ripple),
            Self::Modes(modes) => modes.iter().map(|mode| hadar::sum::dot(gradient, mode).powi(2)).sum(),
        }
    }
}

/// Σ_jk g_j g_k ρ_jk for errors of unit deviation.
fn variance(gradient: &[f64], ripple: &Ripple) -> f64 {
    let (mut sum, mut before) = (0.0, 0.0);
    for (node, correlation) in &ripple.chain {
        // Σ over all nodes before, with their correlations to this one.
        before *= correlation;
        let g = gradient[*node];
        sum += g * (g + 2.0 * before);
        before += g;
    }
    sum.max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::size::Solvers;
    use hadar::material::Library;
    use hadar_scenario::Scenario;

    #[test]
    fn the_chain_sums_every_pair() {
        let nodes = [800.0, 810.0, 803.0, 800.0, 900.0];
        let gradient = [1.0, -2.0, 0.5, 0.3, 4.0];
        let mut exact = 0.0;
        for (a, g) in nodes.iter().zip(&gradient) {
            for (b, h) in nodes.iter().zip(&gradient) {
                exact += g * h * (-(a - b as &f64).abs() / 10.0).exp();
            }
        }
        let found = variance(&gradient, &Ripple::new(&nodes, 1.0, 10.0));
        assert!((found / exact - 1.0).abs() < 1e-14, "{found} {exact}");
    }

    /// Against differences of distances searched in full: their own error is that of the second order, (1e-5)² of a
    /// distance that doubles within 1e-2.
    #[test]
    fn the_gradient_is_that_of_the_distance() {
        let text = "[target]\nmaterial = \"skin\"\ntemperature = \"37 degC\"\n[[environment]]\ntemperature = \"20 degC\"\nlighting = 0.5\n\
            [alternatives]\nmaterials = [\"soda-lime-glass\"]\n[bands]\nstep = \"20 cm^-1\"\n[camera]\npreset = \"flir-a325sc\"\n";
        let scenario = Scenario::from_toml(text, None).unwrap();
        let study = Study::new(&scenario, &Library::embedded().unwrap()).unwrap();
        let alternative = &study.alternatives[0];
        let counting = study.counting().unwrap();
        let reached = |target: &[f64], other: &[f64]| {
            Solvers::new(&study, &study.bands).reached(&study, [target, other], &counting, None).unwrap()
        };
        let (target, other) = (&study.target.emissivity, &alternative.emissivity);
        let (distance, state) = reached(target, other);
        let [of_target, of_other] = gradients(&study, alternative, &state.unwrap(), &counting, distance);
        for node in [0, 7, 13, target.len() - 1] {
            let shifted = |emissivity: &[f64], by: f64| {
                let mut emissivity = emissivity.to_vec();
                emissivity[node] += by;
                emissivity
            };
            let h = 1e-5;
            let by_target =
                (reached(&shifted(target, h), other).0 - reached(&shifted(target, -h), other).0) / (2.0 * h);
            let by_other =
                (reached(target, &shifted(other, h)).0 - reached(target, &shifted(other, -h)).0) / (2.0 * h);
            let scale = of_target.iter().chain(&of_other).fold(0.0f64, |most, g| most.max(g.abs()));
            assert!(
                (of_target[node] - by_target).abs() < 1e-5 * scale,
                "{node}: {} {by_target}",
                of_target[node]
            );
            assert!(
                (of_other[node] - by_other).abs() < 1e-5 * scale,
                "{node}: {} {by_other}",
                of_other[node]
            );
        }
    }
}
