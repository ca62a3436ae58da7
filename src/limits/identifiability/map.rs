//! Distances over a grid of target temperature and lighting (the paper's Fig. 3c).
//!
//! Rows run over T, columns over the lighting factor of the first environment object; what depends on T
//! alone is computed once per row, and the rest at a few lighting factors wherever that keeps all digits: see `map/row.rs`.
//! Rows are spread over the threads of the pool; the result does not depend on their number.

mod chebyshev;
mod passes;
mod row;

use self::row::{Pair, RowSolver};
use super::nearest::{NearestSolver, StateRange};
use crate::error::Result;
use crate::fisher::Unknowns;
use crate::scene::{State, Surroundings};
use crate::simd::Aligned;
use crate::spectrum::Bands;
use rayon::prelude::*;

/// Rows that one solver takes at least: to set it up costs as much as a row.
const ROWS_TOGETHER: usize = 8;

/// The pair of materials and everything around it that stays the same over a map.
#[derive(Debug, Clone)]
pub struct MapScene<'a> {
    /// Bands.
    pub bands: &'a Bands,
    /// Surroundings.
    pub surroundings: &'a Surroundings,
    /// Unknowns.
    pub unknowns: &'a Unknowns,
    /// Emissivity of the target at the nodes.
    pub emissivity: &'a [f64],
    /// Emissivity of the alternative at the nodes.
    pub alternative: &'a [f64],
    /// The lighting of the other environment objects, and everything else of the state.
    pub state: &'a State,
}

/// Local distance per √photon and ΣS (photons s⁻¹ m⁻² sr⁻¹) at one point of a map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapPoint {
    /// Distance per √photon; 0 where nothing can be told apart.
    pub distance: f64,
    /// Photon radiance of the target.
    pub photon_radiance: f64,
}

impl MapScene<'_> {
    fn at(&self, temperature_k: f64, lighting: f64) -> State {
        let mut state = State { temperature_k, ..self.state.clone() };
        if let Some(first) = state.lighting.first_mut() {
            *first = lighting;
        }
        state
    }

    /// Local distances, temperature after temperature (rows), lighting within.
    ///
    /// # Errors
    /// As [`LocalSolver::per_photon`](super::local::LocalSolver::per_photon), at the first point that fails.
    pub fn local(&self, temperatures_k: &[f64], lightings: &[f64]) -> Result<Vec<MapPoint>> {
        let solver = || RowSolver::new(self.bands, self.surroundings, self.unknowns);
        let (emissivity, alternative) = (Aligned::from(self.emissivity), Aligned::from(self.alternative));
        let pair = Pair { emissivity: &emissivity, alternative: &alternative };
        let rows: Result<Vec<Vec<MapPoint>>> = temperatures_k
            .par_iter()
            .with_min_len(ROWS_TOGETHER)
            .map_init(solver, |solver, &temperature_k| {
                let mut row = Vec::with_capacity(lightings.len());
                solver.row(pair, &mut self.at(temperature_k, 0.0), lightings, &mut row)?;
                Ok(row)
            })
            .collect();
        rows.map(|rows| rows.concat())
    }

    /// Nearest distances, temperature after temperature (rows), lighting within.
    ///
    /// # Errors
    /// As [`NearestSolver::per_photon`], at the first point that fails.
    pub fn nearest(&self, range: StateRange, temperatures_k: &[f64], lightings: &[f64]) -> Result<Vec<f64>> {
        let solver = || NearestSolver::new(self.bands, self.surroundings, self.unknowns.clone(), range);
        let rows: Result<Vec<Vec<f64>>> = temperatures_k
            .par_iter()
            .map_init(solver, |solver, &temperature_k| {
                lightings
                    .iter()
                    .map(|&lighting| {
                        let state = self.at(temperature_k, lighting);
                        let nearest =
                            solver.per_photon(self.emissivity, self.alternative, &state, f64::INFINITY)?;
                        Ok(nearest.distance)
                    })
                    .collect()
            })
            .collect();
        rows.map(|rows| rows.concat())
    }
}

#[cfg(test)]
mod tests;
