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
mod divide;
mod surface;

use self::counts::Axis;
use self::divide::Division;
use self::surface::Surfaces;
pub use super::space::StateRange;
use crate::error::{Error, Result, check};
use crate::fisher::Unknowns;
use crate::scene::{Jacobian, State, Surroundings, check_emissivity};
use crate::spectrum::Bands;
use crate::statistics::Statistics;

/// More bands than this make the lattice too large.
pub const MAX_BANDS: usize = 3;
/// Most points of a mesh along one unknown or band.
const MAX_MESH: usize = 1_000_000;
/// Squares of more photons than this, over variances, would not be numbers.
const MAX_PHOTONS: f64 = 1e80;

/// How finely states and counts are meshed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LatticeMesh {
    /// Temperatures over the range, if temperature is unknown.
    pub temperatures: usize,
    /// Lighting factors over the range, for each environment object, if lighting is unknown.
    pub lightings: usize,
    /// Gains over `gain`, if gain is unknown.
    pub gains: usize,
    /// Lowest and highest gain.
    pub gain: [f64; 2],
    /// Most cells along the counts of one band.
    pub cells: usize,
    /// Probability that may be left outside the box of counts.
    pub tail: f64,
}

impl Default for LatticeMesh {
    /// 64 temperatures, 32 lighting factors, 9 gains within a factor 2, 1024 cells, a tail of 1e-9.
    fn default() -> Self {
        Self { temperatures: 64, lightings: 32, gains: 9, gain: [0.5, 2.0], cells: 1024, tail: 1e-9 }
    }
}

impl LatticeMesh {
    /// Half the spacing of states and cells; the states of the coarse mesh stay among those of the fine one.
    fn refined(self) -> Self {
        let finer = |n: usize| (2 * n).saturating_sub(1).max(1);
        Self {
            temperatures: finer(self.temperatures),
            lightings: finer(self.lightings),
            gains: finer(self.gains),
            cells: 2 * self.cells,
            ..self
        }
    }
}

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

/// Algorithm 1 in fixed bands and surroundings.
///
/// ```
/// use hadar::fisher::{Nuisance, Unknowns};
/// use hadar::identifiability::lattice::{LatticeDetector, LatticeMesh, StateRange};
/// use hadar::scene::{EnvironmentObject, Surroundings};
/// use hadar::spectrum::Bands;
/// use hadar::statistics::Statistics;
///
/// let bands = Bands::from_rows([(800.0, 50.0), (1000.0, 50.0), (1200.0, 50.0)])?;
/// let object = EnvironmentObject { temperature_k: 293.15, emissivity: None };
/// let surroundings = Surroundings::new(bands.nodes_cm1(), vec![object])?;
/// let unknowns = Unknowns::new([Nuisance::Temperature])?;
/// let range = StateRange { temperature_k: [270.0, 350.0], ..StateRange::default() };
/// let library = [vec![0.95, 0.95, 0.95], vec![0.9, 0.5, 0.7]];
/// let state = surroundings.state(310.15, &[0.5])?;
/// let detector = LatticeDetector::new(&bands, &surroundings, unknowns, range, Statistics::Poisson)?;
/// let found = detector.detect(&library, 0, &state, 1000.0)?;
/// assert!(found.probabilities[0] > 0.9 && found.mesh_change < 0.01);
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct LatticeDetector<'a> {
    bands: &'a Bands,
    surroundings: &'a Surroundings,
    unknowns: Unknowns,
    range: StateRange,
    statistics: Statistics,
    mesh: LatticeMesh,
}

impl<'a> LatticeDetector<'a> {
    /// A detector with the default mesh. `range` is the range of the unknowns of all materials; give one in
    /// which the mesh is fine enough, not all that physics allows.
    ///
    /// # Errors
    /// More than [`MAX_BANDS`] bands, a range that is no range, an environment temperature among the
    /// unknowns, or statistics of other bands.
    pub fn new(
        bands: &'a Bands,
        surroundings: &'a Surroundings,
        unknowns: Unknowns,
        range: StateRange,
        statistics: Statistics,
    ) -> Result<Self> {
        if bands.len() > MAX_BANDS {
            return Err(Error::out_of_range(
                "number of bands of a lattice",
                bands.len() as f64,
                "",
                format!("at most {MAX_BANDS}; for more, simulate the decision"),
            ));
        }
        statistics.check_bands(bands.len())?;
        surface::check_unknowns(&unknowns, &range)?;
        Ok(Self { bands, surroundings, unknowns, range, statistics, mesh: LatticeMesh::default() })
    }

    /// The same with another mesh.
    ///
    /// # Errors
    /// A mesh without states or cells or with more than 10⁶ along one axis, a tail outside [1e-15, 0.1], or
    /// gains that are no range.
    pub fn with_mesh(self, mesh: LatticeMesh) -> Result<Self> {
        for (what, number) in [
            ("temperatures of the mesh", mesh.temperatures),
            ("lighting factors of the mesh", mesh.lightings),
            ("gains of the mesh", mesh.gains),
            ("cells of the mesh", mesh.cells),
        ] {
            if !(1..=MAX_MESH).contains(&number) {
                let expected = format!("from 1 to {MAX_MESH}");
                return Err(Error::out_of_range(what, number as f64, "", expected));
            }
        }
        let [low, high] = mesh.gain;
        check::positive("lowest gain of the mesh", low, "")?;
        check::non_negative("width of the gains of the mesh", high - low, "")?;
        if !(1e-15..=0.1).contains(&mesh.tail) {
            return Err(Error::out_of_range("tail of the counts", mesh.tail, "", "from 1e-15 to 0.1"));
        }
        Ok(Self { mesh, ..self })
    }

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
