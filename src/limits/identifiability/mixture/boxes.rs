//! What no mixture is below while the alternative's temperature is anywhere in an interval.
//!
//! With a plane (g, h) below (√a − √b)² (`hull`), the cost of mixtures is at least
//!
//! min_i [g·n_i + min_j min_T′ h·m_j(T′)]/D_i + v·(g + h).
//!
//! h·m_j(T′) is a sum Σ_n c_n B(ν_n, T′) of signed coefficients beside light that does not depend on T′. B is convex in T, so a chord is
//! above it by ½(T′ − T₁)(T₂ − T′)B″(θ) for some θ; with B″ within [low, high] on the interval no sum is below the lower end of its
//! chord by more than ⅛(T₂ − T₁)² Σ_n (c_n high_n where c_n > 0, c_n low_n else). B″ = B′(x coth(x/2) − 2)/T, x = hcν/kT, has one
//! maximum over T, at x = 4.4912 (the root of d/dT B″ = 0): on an interval it is least at an end, and largest at an end or there.
//!
//! Rounding: every sum is of terms that are known, and what 64 ulp of them amount to is taken off.

use super::hull::Plane;
use super::scene::{Scene, Side};
use crate::planck;
use crate::sum;
use crate::units::SECOND_RADIATION_CM_K;

/// x at which B″ is largest over T.
const PEAK: f64 = 4.491_162_329_141_398;
/// Share of the terms of a sum that its rounding, and that of the spectra, may amount to.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Blackbody radiances at both ends of an interval of temperatures, and the range of their second derivative.
pub(super) struct Interval {
    pub(super) ends_k: [f64; 2],
    ends: [Vec<f64>; 2],
    curvature: [Vec<f64>; 2],
}

impl Interval {
    pub(super) fn new(nodes_cm1: &[f64], ends_k: [f64; 2]) -> Self {
        let count = nodes_cm1.len();
        let [cold, hot] = ends_k.map(|temperature_k| {
            let (mut values, mut slopes) = (vec![0.0; count], vec![0.0; count]);
            planck::photon_radiance_and_slope_into(nodes_cm1, temperature_k, &mut values, &mut slopes);
            let curvature: Vec<f64> = nodes_cm1
                .iter()
                .zip(slopes.iter())
                .map(|(nu, slope)| curvature(*nu, temperature_k, *slope))
                .collect();
            (values, curvature)
        });
        let mut range = [Vec::with_capacity(count), Vec::with_capacity(count)];
        for (node, nu) in nodes_cm1.iter().enumerate() {
            let [a, b] = [cold.1[node], hot.1[node]];
            let at_peak = SECOND_RADIATION_CM_K * nu / PEAK;
            let inside = at_peak > ends_k[0] && at_peak < ends_k[1];
            let peak = if inside {
                curvature(*nu, at_peak, planck::photon_radiance_slope(*nu, at_peak))
            } else {
                0.0
            };
            range[0].push(a.min(b) * (1.0 - 1e-9));
            range[1].push(a.max(b).max(peak) * (1.0 + 1e-9));
        }
        Self { ends_k, ends: [cold.0, hot.0], curvature: range }
    }
}

/// B″ from B′.
fn curvature(nu_cm1: f64, temperature_k: f64, slope: f64) -> f64 {
    let x = SECOND_RADIATION_CM_K * nu_cm1 / temperature_k;
    // x coth(x/2) − 2 = x²/6 − x⁴/360 + …
    let shape = if x < 1e-2 { x * x / 6.0 } else { x / (0.5 * x).tanh() - 2.0 };
    slope * shape.max(0.0) / temperature_k
}

impl Scene<'_> {
    /// What the square of the distance is at least on an interval, by a plane.
    pub(super) fn bound(&self, interval: &Interval, plane: &Plane) -> f64 {
        crate::stop::check();
        let weights = self.library.bands.weights_cm1();
        let spread = self.library.bands.spread(&plane.h);
        let coefficients: Vec<f64> =
            weights.iter().zip(&spread).map(|(weight, h)| self.kappa * weight * h).collect();
        let [cold_k, hot_k] = interval.ends_k;
        let eighth = (hot_k - cold_k).powi(2) / 8.0;
        let curved: Vec<f64> = coefficients
            .iter()
            .zip(interval.curvature[0].iter().zip(&interval.curvature[1]))
            .map(|(c, (low, high))| c * if *c > 0.0 { high } else { low })
            .collect();
        let at_ends = [0, 1].map(|end| product(&coefficients, &interval.ends[end]));
        let lit: Vec<Vec<f64>> = self.light.iter().map(|light| product(&coefficients, light)).collect();
        let size = |terms: &[f64]| terms.iter().map(|term| term.abs()).sum::<f64>();
        let terms = size(&at_ends[1]) + lit.iter().map(|lit| size(lit)).sum::<f64>();
        let mut cheapest = f64::INFINITY;
        for emissivity in self.alternatives {
            let own = at_ends
                .each_ref()
                .map(|end| sum::dot(end, emissivity))
                .into_iter()
                .fold(f64::INFINITY, f64::min);
            let sag = (eighth * sum::dot(&curved, emissivity)).max(0.0);
            let scattered: Vec<f64> =
                lit.iter().map(|lit| sum::sum(lit) - sum::dot(lit, emissivity)).collect();
            let lightings = self.lightings.iter().map(|v| v.iter().zip(&scattered).map(|(v, p)| v * p).sum());
            let least = lightings.fold(f64::INFINITY, f64::min);
            cheapest = cheapest.min(own - sag + least);
        }
        let [noise, noise_terms] = plane.of_noise(&self.var_added);
        let Side { counts, photons } = &self.own;
        let least = counts.iter().zip(photons).map(|(n, d)| {
            let own_terms: f64 = plane.g.iter().zip(n).map(|(g, n)| (g * n).abs()).sum();
            let lost = ROUNDING * (own_terms + terms + noise_terms);
            (sum::dot(&plane.g, n) + cheapest + noise - lost) / d
        });
        least.fold(f64::INFINITY, f64::min)
    }
}

fn product(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a * b).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Second differences of B over 1 mK to 1 K are B″ but for their own error of 1e-4, and lie within what is said of an interval.
    #[test]
    fn second_derivatives_lie_within_their_range() {
        let nodes = [20.0, 400.0, 720.0, 1000.0, 1250.0, 3000.0];
        for ends_k in [[90.0, 91.0], [250.0, 450.0], [300.0, 300.5], [310.0, 3000.0]] {
            let interval = Interval::new(&nodes, ends_k);
            for (node, nu) in nodes.iter().enumerate() {
                for i in 0..=200 {
                    let t = ends_k[0] * (ends_k[1] / ends_k[0]).powf(f64::from(i) / 200.0);
                    let h = 2e-3 * t;
                    let b = |t: f64| planck::photon_radiance(*nu, t);
                    let second = (b(t + h) - 2.0 * b(t) + b(t - h)) / (h * h);
                    let [low, high] = [0, 1].map(|end| interval.curvature[end][node]);
                    // Second differences of 20 cm⁻¹ lose all but four digits.
                    let slack = 1e-3 * high;
                    assert!(
                        second >= low - slack && second <= high + slack,
                        "{nu} {t}: {low} {second} {high}"
                    );
                }
            }
        }
    }
}
