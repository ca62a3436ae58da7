//! An estimator beside its bound.

use super::results::AirWitness;
use super::{AirPlan, AirRangingStudy};
use hadar::error::{Error, Result};
use hadar::fisher::precision::JointBound;
use hadar::ranging::air::AirSolver;
use hadar_simulate::air_ranging::AirFitter;
use hadar_simulate::efficiency::{Criteria, Efficiency};
use hadar_simulate::sequential::Interval;

/// Distances at which spectra are drawn, at most.
const MOST: usize = 10;

impl AirRangingStudy {
    /// Some of the distances of the curve, from the first to the last.
    pub(super) fn witness_distances(&self, plan: &AirPlan) -> Vec<f64> {
        let all = &self.scenario.distances_m;
        match (plan.trials, all.len()) {
            (0, _) => Vec::new(),
            (_, count) if count <= MOST => all.clone(),
            (_, count) => (0..MOST).filter_map(|i| all.get(i * (count - 1) / (MOST - 1)).copied()).collect(),
        }
    }

    /// Estimates at a distance; `None` where it is not seen.
    pub(super) fn witness(
        &self,
        solver: &AirSolver<'_>,
        plan: &AirPlan,
        (index, distance_m): (usize, f64),
    ) -> Result<Option<AirWitness>> {
        let state = self.state(distance_m);
        let counting = self.counting(&state)?;
        let bound_m = solver.bound(&state, &counting)?.sigma_m;
        if !bound_m.is_finite() {
            return Ok(None);
        }
        let fitter = AirFitter::new(solver, &state, &counting)?;
        let fits = fitter.trials(&state, u32::try_from(index).unwrap_or(u32::MAX), plan.trials, plan.seed)?;
        let estimates: Vec<f64> = fits.iter().map(|fit| fit.distance_m).collect();
        let criteria = Criteria { together: MOST, ..Criteria::default() };
        let found = Efficiency::of(&estimates, &[distance_m], &JointBound::from_sigma(bound_m)?, &criteria)?;
        let Some(one) = found.parameters.first() else {
            return Err(Error::malformed("estimates of nothing", "report this as a bug"));
        };
        let interval = one.errors.rmse_interval;
        Ok(Some(AirWitness {
            distance_m,
            bound_m,
            trials: plan.trials,
            errors: one.errors,
            rmse_over_bound: one.errors.rmse / bound_m,
            rmse_over_bound_interval: Interval { low: interval.low / bound_m, high: interval.high / bound_m },
            verdict: one.verdict,
            at_edge: fits.iter().filter(|fit| fit.at_edge).count() as f64 / fits.len().max(1) as f64,
            unconverged: fits.iter().filter(|fit| !fit.converged && !fit.at_edge).count(),
        }))
    }
}
