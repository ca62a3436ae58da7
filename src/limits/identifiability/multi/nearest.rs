//! Nearest distances of every material against every other one, in one scene.
//!
//! Rows are spread over the threads of the pool; each thread's solver keeps its memory from pair to pair. The result does not
//! depend on the number of threads. Of a pair its distance, the bound and the error are kept, 24 bytes: 24 MB for a thousand
//! materials.

use super::count::check_count;
use crate::error::Result;
use crate::fisher::{Counting, Unknowns};
use crate::identifiability::nearest::{NearestDistance, NearestSolver, StateRange};
use crate::parallel;
use crate::scene::{State, Surroundings};
use crate::spectrum::Bands;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Is told how many targets of how many are done.
pub type Progress<'p> = &'p (dyn Fn(usize, usize) + Sync);

/// Nearest distances of every alternative (column) to every target (row), row by row; 0 on the diagonal.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct NearestMatrix {
    /// Distances.
    pub distance: Vec<f64>,
    /// What is proved of them ([`NearestDistance::lower`]).
    pub lower: Vec<f64>,
    /// Their estimated relative errors by rounding ([`NearestDistance::relative_error`]).
    pub relative_error: Vec<f64>,
}

impl NearestMatrix {
    /// Whether distance i is proved to this share of it.
    #[must_use]
    pub fn is_proved_to(&self, i: usize, share: f64) -> bool {
        self.lower[i] >= (1.0 - share) * self.distance[i]
    }
}

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
    pub(in crate::limits::identifiability) fn solver(&self) -> NearestSolver<'a> {
        let solver = NearestSolver::new(self.bands, self.surroundings, self.unknowns.clone(), self.range);
        match self.tolerance {
            Some(tolerance) => solver.proving(tolerance),
            None => solver,
        }
    }

    /// Nearest distances per √photon, shot noise only.
    ///
    /// # Errors
    /// As [`NearestSolver::per_photon`], for the first pair that fails.
    pub fn nearest_per_photon(
        &self,
        emissivities: &[&[f64]],
        progress: Progress<'_>,
    ) -> Result<NearestMatrix> {
        self.nearest(emissivities, progress, |solver, own, other| {
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
        progress: Progress<'_>,
    ) -> Result<NearestMatrix> {
        self.nearest(emissivities, progress, |solver, own, other| {
            solver.with_counting(own, other, self.state, counting)
        })
    }

    fn nearest(
        &self,
        emissivities: &[&[f64]],
        progress: Progress<'_>,
        pair: impl Fn(&mut NearestSolver<'a>, &[f64], &[f64]) -> Result<NearestDistance> + Sync,
    ) -> Result<NearestMatrix> {
        let (done, count) = (AtomicUsize::new(0), emissivities.len());
        check_count(count)?;
        let row = |solver: &mut NearestSolver<'a>, target: usize| -> Result<Vec<[f64; 3]>> {
            let found = emissivities.iter().enumerate().map(|(other, emissivity)| {
                if other == target {
                    return Ok([0.0; 3]);
                }
                let found = pair(solver, emissivities[target], emissivity)?;
                Ok([found.distance, found.lower, found.relative_error])
            });
            let row = found.collect();
            progress(done.fetch_add(1, Ordering::Relaxed) + 1, count);
            row
        };
        let rows: Result<Vec<_>> = parallel::try_map_with(count, || self.solver(), row);
        let mut matrix = NearestMatrix::default();
        for [distance, lower, relative_error] in rows?.into_iter().flatten() {
            matrix.distance.push(distance);
            matrix.lower.push(lower);
            matrix.relative_error.push(relative_error);
        }
        Ok(matrix)
    }
}
