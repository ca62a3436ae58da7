//! Nearest distances of every material against every other one, in one scene.
//!
//! Rows are spread over the threads of the pool; each thread's solver keeps its grid of blackbody radiances
//! from pair to pair. The result does not depend on the number of threads.

use crate::error::Result;
use crate::fisher::{Counting, Unknowns};
use crate::identifiability::nearest::{NearestDistance, NearestSolver, StateRange};
use crate::scene::{State, Surroundings};
use crate::spectrum::Bands;
use rayon::prelude::*;

/// Everything around the materials of a library that stays the same.
#[derive(Debug, Clone, Copy)]
pub struct LibraryScene<'a> {
    /// Bands.
    pub bands: &'a Bands,
    /// Surroundings.
    pub surroundings: &'a Surroundings,
    /// Unknowns.
    pub unknowns: &'a Unknowns,
    /// The range of the alternatives' states.
    pub range: StateRange,
    /// The state of every target.
    pub state: &'a State,
    /// To what share of a distance it is proved, if at all.
    pub tolerance: Option<f64>,
}

impl<'a> LibraryScene<'a> {
    /// A solver of nearest states in this scene.
    pub(super) fn solver(&self) -> NearestSolver<'a> {
        let solver = NearestSolver::new(self.bands, self.surroundings, self.unknowns.clone(), self.range);
        match self.tolerance {
            Some(tolerance) => solver.proving(tolerance),
            None => solver,
        }
    }

    /// Nearest state of every alternative (column) to every target (row) per √photon, shot noise only; `None`
    /// on the diagonal.
    ///
    /// # Errors
    /// As [`NearestSolver::per_photon`], for the first pair that fails.
    pub fn nearest_per_photon(&self, emissivities: &[&[f64]]) -> Result<Vec<Option<NearestDistance>>> {
        self.nearest(emissivities, |solver, own, other| {
            solver.per_photon(own, other, self.state, f64::INFINITY)
        })
    }

    /// The same as statistical distances d with the camera's own noise.
    ///
    /// # Errors
    /// As [`NearestSolver::with_counting`], for the first pair that fails.
    pub fn nearest_with_counting(
        &self,
        emissivities: &[&[f64]],
        counting: &Counting,
    ) -> Result<Vec<Option<NearestDistance>>> {
        self.nearest(emissivities, |solver, own, other| {
            solver.with_counting(own, other, self.state, counting)
        })
    }

    fn nearest(
        &self,
        emissivities: &[&[f64]],
        pair: impl Fn(&mut NearestSolver<'a>, &[f64], &[f64]) -> Result<NearestDistance> + Sync,
    ) -> Result<Vec<Option<NearestDistance>>> {
        let rows: Result<Vec<Vec<_>>> = (0..emissivities.len())
            .into_par_iter()
            .map_init(
                || self.solver(),
                |solver, target| {
                    let row = emissivities.iter().enumerate().map(|(other, emissivity)| {
                        (other != target).then(|| pair(solver, emissivities[target], emissivity)).transpose()
                    });
                    row.collect()
                },
            )
            .collect();
        rows.map(|rows| rows.concat())
    }
}
