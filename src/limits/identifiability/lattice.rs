//! Algorithm 1: the exact detection probability on a lattice of counts, for up to three bands.
//!
//! A target in a known state sends counts n = (n₁…n_W) with probability 𝒫(n). To every n the decision is
//! the material whose surface (all states of its unknown temperature, lighting and gain) contains the state
//! that is the most likely to have sent n; P(m) is the sum of 𝒫(n) over the n that are decided for m. Ties
//! are split evenly. That is the paper's 'exact' probability: of this rule (the likelihood ratio of best
//! fits) and up to the two meshes.
//!
//! Counts: for the discrete laws every whole number of a box that leaves out no more than a stated tail of
//! 𝒫; where that is more than the cells asked for, equal groups of whole numbers, decided at their middle,
//! with the exact sum of 𝒫 over the group. Gaussian counts are continuous, so they always come in cells,
//! with the exact integral of 𝒫. States: a product mesh over the range of the unknowns, equally spaced
//! (gain: logarithmically). A Gaussian prior on an unknown, centred at the target's state, adds its −½(θ′ −
//! θ)²/σ_p² to the log-likelihood.
//!
//! Cost: the paper's loops take M W G^{W+2} steps. The same decisions are found by halving boxes of counts:
//! the log-likelihood of a state is linear (Gaussian: quadratic) in each nₗ, so that its largest excess
//! over that of a reference state is known exactly on a box, and states that can win nowhere in the box are
//! struck out. A box in which states of one material are left is decided at once; only boxes that a
//! decision boundary crosses are divided further, about G^{W−1} of them, with few states left in each.
//!
//! With as many unknowns as bands a surface fills the space of counts: almost every n can be explained by
//! every material, and the decision is left to the edges of the ranges and to the mesh. The result says so.
//!
//! Source: paper, Algorithm 1, S16.

mod counts;
mod detector;
mod divide;
mod surface;

use self::counts::Axis;
pub use self::detector::{LatticeDetector, LatticeMesh, MAX_BANDS};
use self::divide::Division;
use self::surface::Surfaces;
pub use super::space::StateRange;
use crate::error::{Error, Result, check};
use crate::scene::{Jacobian, State, check_emissivity};

/// Squares of more photons than this, over variances, would not be numbers.
const MAX_PHOTONS: f64 = 1e80;

/// The probability vector of Algorithm 1 with what is known of its error.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct LatticeDetection {
    /// P(m): probability that the target is taken for material m. They add up to 1 − tail.
    pub probabilities: Vec<f64>,
    /// Probability of the counts outside the box.
    pub tail: f64,
    /// Largest change of a P(m) from a mesh twice as coarse (states, and cells unless they are whole
    /// numbers).
    pub mesh_change: f64,
    /// Probability of the cells that a decision boundary crosses: rigorous bound of what the cells alone
    /// can be wrong by. 0 where every whole number is a cell.
    pub undecided: f64,
    /// Sites of the lattice of counts.
    pub lattice_points: u64,
    /// States of all surfaces together.
    pub states: usize,
    /// Whether there are as many unknowns as bands, so that the surfaces fill the space of counts.
    pub fills_space: bool,
}

impl LatticeDetector<'_> {
    /// Decides for one of `library` (emissivities at the nodes) when the target is material number `target`
    /// in `state` and sends `photons` counts on average, all bands together. The mesh asked for is the
    /// coarse one; the probabilities are those of the fine one.
    ///
    /// # Errors
    /// A target that is not in the library, an emissivity that does not fit the bands, a scene without
    /// photons, or meshes too large to be held.
    pub fn detect(
        &self,
        library: &[Vec<f64>],
        target: usize,
        state: &State,
        photons: f64,
    ) -> Result<LatticeDetection> {
        check::positive("photons", photons, "counts")?;
        if photons > MAX_PHOTONS {
            return Err(Error::out_of_range(
                "photons",
                photons,
                "counts",
                format!("at most {MAX_PHOTONS:e}"),
            ));
        }
        for emissivity in library {
            check_emissivity(emissivity, self.surroundings.nodes_cm1().len())?;
        }
        let Some(own) = library.get(target) else {
            return Err(Error::out_of_range(
                "number of the target's material",
                target as f64,
                "",
                format!("below {}", library.len()),
            ));
        };
        let mut jacobian = Jacobian::new(self.bands, self.surroundings);
        jacobian.evaluate(own, own, state, &[], false);
        let total = crate::sum::sum(jacobian.signal());
        check::positive("photon radiance of the target", total, "photons s^-1 m^-2 sr^-1")?;
        let counts = check::positive("counts per radiance", photons / total, "m^2 sr s")?;
        let means: Vec<f64> = jacobian.signal().iter().map(|signal| counts * signal).collect();

        let coarse = self.solve(library, state, &means, counts, self.mesh)?;
        let fine = self.solve(library, state, &means, counts, self.mesh.refined())?;
        let change = coarse.probabilities.iter().zip(&fine.probabilities).map(|(a, b)| (a - b).abs());
        Ok(LatticeDetection { mesh_change: change.fold(0.0, f64::max), ..fine })
    }

    fn solve(
        &self,
        library: &[Vec<f64>],
        state: &State,
        means: &[f64],
        counts: f64,
        mesh: LatticeMesh,
    ) -> Result<LatticeDetection> {
        let axes = Axis::all(&self.statistics, means, mesh.cells, mesh.tail)?;
        let surfaces = Surfaces::new(self, library, state, means, counts, mesh)?;
        let decided = Division { axes: &axes, surfaces: &surfaces }.decide();
        Ok(LatticeDetection {
            probabilities: surfaces.spread(&decided.shares, library.len()),
            tail: counts::tail(&axes),
            mesh_change: 0.0,
            undecided: decided.undecided,
            lattice_points: axes.iter().map(|axis| axis.len() as u64).product(),
            states: surfaces.states(),
            fills_space: self.unknowns.parameters(self.surroundings.objects().len()).len() >= means.len(),
        })
    }
}

#[cfg(test)]
mod tests;
