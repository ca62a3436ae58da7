//! Which alternatives the light itself tells as required: no choice of bands can do more than all of them with no noise
//! but that of the photons.
//!
//! A choice for the alternative that fares worst would else be made for one that stays hopeless whatever is chosen.

use crate::Study;
use hadar::error::Result;
use hadar::fisher::Counting;
use hadar::parallel;

impl Study {
    /// Indices of the alternatives that the camera's photons tell as required in all bands with shot noise alone, by
    /// the distance that decides, and of the others. All are of the first kind without a camera.
    pub(crate) fn within_reach(&self) -> Result<(Vec<usize>, Vec<usize>)> {
        let Some(Counting { counts_per_radiance, .. }) = self.counting() else {
            return Ok(((0..self.alternatives.len()).collect(), Vec::new()));
        };
        let shot = Counting { counts_per_radiance, var_added: Vec::new() };
        let kind = self.scenario.requirement.by;
        let distances = parallel::booked(self.alternatives.len(), |i| {
            self.statistical_distance(kind, &self.alternatives[i], &shot)
        })?;
        Ok((0..distances.len()).partition(|&i| distances[i] >= self.required))
    }

    pub(crate) fn names_of(&self, alternatives: &[usize]) -> Vec<String> {
        alternatives.iter().map(|&i| self.alternatives[i].name.clone()).collect()
    }
}
