//! Which alternatives the light itself tells as required: no choice of bands can do more than all of them with no noise
//! but that of the photons.
//!
//! A choice for the alternative that fares worst would else be made for one that stays hopeless whatever is chosen.

use crate::Study;
use hadar::demand;
use hadar::error::Result;
use hadar::fisher::Counting;
use rayon::prelude::*;

impl Study {
    /// Indices of the alternatives that the camera's photons tell as required in all bands with shot noise alone, by
    /// the distance that decides, and of the others. All are of the first kind without a camera.
    pub(crate) fn within_reach(&self) -> Result<(Vec<usize>, Vec<usize>)> {
        let Some(Counting { counts_per_radiance, .. }) = self.counting() else {
            return Ok(((0..self.alternatives.len()).collect(), Vec::new()));
        };
        let shot = Counting { counts_per_radiance, var_added: Vec::new() };
        let kind = self.scenario.requirement.by;
        let distances = demand::gathered(
            self.alternatives
                .par_iter()
                .map(|surface| demand::ledger_of(|| self.statistical_distance(kind, surface, &shot))),
        )?;
        Ok((0..distances.len()).partition(|&i| distances[i] >= self.required))
    }

    pub(crate) fn names_of(&self, alternatives: &[usize]) -> Vec<String> {
        alternatives.iter().map(|&i| self.alternatives[i].name.clone()).collect()
    }
}
