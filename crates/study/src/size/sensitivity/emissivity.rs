//! What errors of the emissivities put on the statistical distance.
//!
//! Errors δ(ν) of target and alternative are independent of each other, Gaussian, of deviation s, with the correlation
//! exp(−|ν − ν′|/ℓ): a chain along ascending wavenumber, δ_{k+1} = ρ δ_k + s √(1 − ρ²) z, ρ = exp(−Δν/ℓ). What leads out
//! of [0, 1] is cut off. The distance is not linear in them (ripple that no temperature or lighting imitates adds in
//! quadrature), so pairs are drawn and the nearest state of each is searched in full. Draw k takes stream k of the
//! generator ChaCha8: the result does not depend on the number of threads.
//!
//! Where target or alternative is a class with a covariance, its errors are drawn of that (`scatter`).
//!
//! Assumptions: the noise is that of the spectra as they are; the limiting alternative stays the limiting one.

use super::linear;
use super::scatter::ScatterOf;
use crate::identify::quantile;
use crate::size::Solvers;
use crate::{Study, Surface};
use hadar::error::Result;
use hadar::instrument::Camera;
use hadar::parallel;
use rand::SeedableRng;
use rand::rngs::ChaCha8Rng;

/// Pairs that are drawn.
const DRAWS: usize = 64;
const SEED: u64 = 1;

/// The statistical distance where the emissivities have errors.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct EmissivityErrors {
    /// Root mean square error of each emissivity.
    pub error: f64,
    /// Length over which errors are correlated, cm⁻¹.
    pub correlation_cm1: f64,
    /// Number of pairs of emissivities that were drawn.
    pub draws: usize,
    /// Statistical distance with the emissivities as they are.
    pub distance: f64,
    /// 5 % of the draws are below.
    pub distance_5: f64,
    /// Half of the draws are below.
    pub distance_50: f64,
    /// 95 % of the draws are below.
    pub distance_95: f64,
    /// Share of the draws that meet the requirement.
    pub share_met: f64,
    /// Deviation of the distance to first order in the errors; `None` for local distances and where it is 0.
    pub sigma_linear: Option<f64>,
    /// What classes say of their scatter; the two figures above are then those of other surfaces.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub of_classes: Vec<ScatterOf>,
}

impl Study {
    /// What errors of the emissivities put on the distance to `alternative`.
    pub(crate) fn emissivity_errors(
        &self,
        camera: &Camera,
        alternative: &Surface,
        index: usize,
    ) -> Result<EmissivityErrors> {
        let spec = self.scenario.sensitivity.unwrap_or_default();
        let counting = self.counting_of(camera);
        let pair = [self.target.emissivity.as_slice(), alternative.emissivity.as_slice()];
        let mut solvers = Solvers::new(self, &self.bands);
        let (distance, nearest) = solvers.reached(self, pair, &counting, None)?;
        let [(own, of_target), (other, of_alternative)] = self.scatters(index, spec);
        let scatters = [&own, &other];
        let draw = |solvers: &mut Solvers<'_>, stream: usize| {
            let mut random = ChaCha8Rng::seed_from_u64(SEED);
            random.set_stream(stream as u64);
            let shaken = [0, 1].map(|which| scatters[which].applied(pair[which], &mut random));
            let pair = [shaken[0].as_slice(), shaken[1].as_slice()];
            Ok(solvers.reached(self, pair, &counting, None)?.0)
        };
        let mut distances = parallel::booked_with(DRAWS, || Solvers::new(self, &self.bands), draw)?;
        distances.sort_by(f64::total_cmp);
        let met = distances.iter().filter(|distance| **distance >= self.required).count();
        let sigma_linear = nearest
            .filter(|_| distance > 0.0)
            .map(|state| linear::sigma(self, alternative, &state, &counting, distance, scatters));
        Ok(EmissivityErrors {
            error: spec.emissivity_error,
            correlation_cm1: spec.correlation_cm1,
            draws: DRAWS,
            distance,
            distance_5: quantile(&distances, 0.05),
            distance_50: quantile(&distances, 0.5),
            distance_95: quantile(&distances, 0.95),
            share_met: met as f64 / DRAWS as f64,
            sigma_linear,
            of_classes: of_target.into_iter().chain(of_alternative).collect(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::ripple::Ripple;
    use super::*;

    /// Mean squares and products of 4000 draws; five deviations of such means, √(2/4000) = 0.022, are allowed.
    #[test]
    fn ripple_has_the_deviation_and_correlation_asked_for() {
        // Out of order, and the first wavenumber in two bands.
        let nodes = [800.0, 810.0, 803.0, 800.0, 900.0];
        let ripple = Ripple::new(&nodes, 1e-3, 10.0);
        let mut random = ChaCha8Rng::seed_from_u64(7);
        let (mut products, draws) = ([[0.0; 5]; 5], 4000);
        for _ in 0..draws {
            let shaken = ripple.applied(&[0.5; 5], &mut random);
            let error: Vec<f64> = shaken.iter().map(|e| (e - 0.5) / 1e-3).collect();
            assert!((error[0] - error[3]).abs() < 1e-9, "one wavenumber has one error");
            for (row, a) in products.iter_mut().zip(&error) {
                row.iter_mut().zip(&error).for_each(|(sum, b)| *sum += a * b / f64::from(draws));
            }
        }
        for (i, a) in nodes.iter().enumerate() {
            for (j, b) in nodes.iter().enumerate() {
                let exact = (-(a - b).abs() / 10.0f64).exp();
                assert!((products[i][j] - exact).abs() < 0.11, "{i} {j}: {} {exact}", products[i][j]);
            }
        }
    }

    #[test]
    fn emissivities_stay_possible() {
        let ripple = Ripple::new(&[800.0, 801.0], 0.5, 1.0);
        let mut random = ChaCha8Rng::seed_from_u64(7);
        for _ in 0..100 {
            assert!(ripple.applied(&[0.0, 1.0], &mut random).iter().all(|e| (0.0..=1.0).contains(e)));
        }
    }
}
