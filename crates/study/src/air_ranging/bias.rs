//! What a model finds that leaves out the sky: S = e B(T), without anything that the target mirrors, fitted to counts that have it.

use super::AirRangingStudy;
use hadar::error::Result;
use hadar::fisher::Counting;
use hadar::ranging::air::{AirSolver, AirState};
use hadar_simulate::air_ranging::AirFitter;

impl AirRangingStudy {
    /// How much farther the model without sky puts the target, m, from counts without noise, and whether it ends at the end of the
    /// table; `None` where no fit ends.
    pub(super) fn without_sky(
        &self,
        solver: &AirSolver<'_>,
        state: &AirState,
        counting: &Counting,
    ) -> Result<Option<(f64, bool)>> {
        let mut dark = state.clone();
        dark.target.lighting.iter_mut().for_each(|lighting| *lighting = 0.0);
        let fitter = AirFitter::new(solver, &dark, counting)?;
        let centres = fitter.values(&dark);
        let fit = fitter.fit(&fitter.means(state)?, &dark, &centres)?;
        let found = fit.distance_m - state.distance_m;
        Ok((fit.converged || fit.at_edge).then_some((found, fit.at_edge)))
    }
}
