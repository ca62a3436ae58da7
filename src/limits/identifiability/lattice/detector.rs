//! What a lattice is asked: bands and surroundings, unknowns with their ranges, and how finely all is meshed.

use crate::error::{Error, Result, check};
use crate::fisher::{Nuisance, Unknowns};
use crate::identifiability::space::StateRange;
use crate::scene::Surroundings;
use crate::spectrum::Bands;
use crate::statistics::Statistics;

/// More bands than this make the lattice too large.
pub const MAX_BANDS: usize = 3;
/// Most points of a mesh along one unknown or band.
const MAX_MESH: usize = 1_000_000;

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
    pub(super) fn refined(self) -> Self {
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
    pub(super) bands: &'a Bands,
    pub(super) surroundings: &'a Surroundings,
    pub(super) unknowns: Unknowns,
    pub(super) range: StateRange,
    pub(super) statistics: Statistics,
    pub(super) mesh: LatticeMesh,
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
        check_unknowns(&unknowns, &range)?;
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
}

/// Makes sure that the unknowns can be meshed over the range.
fn check_unknowns(unknowns: &Unknowns, range: &StateRange) -> Result<()> {
    if unknowns.contains(Nuisance::EnvironmentTemperature) {
        return Err(Error::malformed(
            "an environment temperature among the unknowns of a lattice",
            "take it as known, or simulate the decision",
        ));
    }
    let [low, high] = range.temperature_k;
    check::positive("lowest temperature of the range", low, "K")?;
    check::non_negative("width of the range of temperatures", high - low, "K")?;
    let [low, high] = range.lighting;
    check::unit_interval("lowest lighting factor of the range", low)?;
    check::unit_interval("highest lighting factor of the range", high)?;
    check::non_negative("width of the range of lighting factors", high - low, "")?;
    check::unit_interval("largest sum of the lighting factors", range.lighting_sum).map(drop)
}
