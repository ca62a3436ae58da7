//! A lower bound of the distance for every scene of an envelope, from wherever along a stretch of distances.
//!
//! Air lets through the share τ_j(z) of node j at distance z. With x = ln z between the near end and the far one,
//! s = (x − x_near)/(x_far − x_near), and the parabola through the ends and the middle of them,
//!
//! τ_j(z) = (1 − s)² τ_j(near) + 2s(1 − s) c_j + s² τ_j(far) + δ_j,   c_j = 2τ_j(middle) − ½[τ_j(near) + τ_j(far)],
//!
//! |δ_j| ≤ the sag of node j, with the same s for all nodes. The three weights are not negative and sum to 1: but for the sags
//! counts lie within the triangle of those with the shares τ(near), c and τ(far), and a bound of u·Δ (`bound`) for all z is
//! the least of those at its three corners, less ‖sag‖. Spectra are kept as that of the middle, h = ½(far − near) and
//! β = middle − ½(near + far), of which the corners are middle − β ± h and middle + β (`node`). |c_j| ≤ 3/2 τ_j(near).
//! Variances, norms and what is faint are those of the near end, where all is brightest; how bright an alternative may be is
//! asked of the far one.
//!
//! κ and the added variance depend on the distance too: d grows with κ and falls with v in every band, so that the least
//! κ and the most variance along the stretch, each by itself, bound it.
//!
//! Nothing is attained along a stretch; that no scene along it is below a distance known from elsewhere is proved, or not.

use super::attain::Attained;
use super::joint;
use super::model::{self, Model};
use super::prove::{self, Effort};
use super::ranges::Ranges;
use super::scene::{EnvelopeScene, Stretch};
use crate::error::Result;
use crate::scene::State;

/// The least distance found from wherever, at whatever distance.
#[derive(Debug, Clone, Copy)]
pub struct LeastKnown<'a> {
    /// The statistical distance.
    pub distance: f64,
    /// The scene.
    pub state: &'a State,
    /// The alternative's state that is nearest to it.
    pub nearest: &'a State,
}

/// A distance below which no scene of the envelope is, along the whole stretch, and the boxes that it took: no more than that of
/// `known`, at which the proof ends. `None` where nothing can be proved of these unknowns.
///
/// `scene` has the bands as they are at the near end, and the least counts per radiance and the most added variance along
/// the stretch.
///
/// # Errors
/// As [`worst_case`](super::worst_case); bands that let through more at the far end than at the near one.
///
/// ```
/// use hadar::atmosphere::Atmosphere;
/// use hadar::fisher::{Counting, Nuisance, Unknowns};
/// use hadar::identifiability::nearest::StateRange;
/// use hadar::policy::envelope::{
///     Effort, EnvelopeScene, LeastKnown, Ranges, Stretch, lower_bound_along, worst_case,
/// };
/// use hadar::scene::{EnvironmentObject, Surroundings};
/// use hadar::spectrum::Bands;
///
/// let (air, open) = (Atmosphere::embedded("us-standard")?, Bands::uniform(800.0, 1200.0, 50.0)?);
/// let nodes = open.nodes_cm1();
/// let at = |z: f64| air.transmittance(nodes, z).map(|tau| open.transmitted_at_nodes(&tau));
/// let (near, middle, far) = (at(100.0)?, at((100.0_f64 * 110.0).sqrt())?, at(110.0)?);
/// let sag = open.transmitted_at_nodes(&air.sag(nodes, [100.0, 110.0])?);
/// let around = EnvironmentObject { temperature_k: 283.0, emissivity: None };
/// let surroundings = Surroundings::new(nodes, vec![around])?;
/// let other: Vec<f64> = (0..nodes.len()).map(|j| 0.7 + 0.02 * j as f64).collect();
/// let counting = Counting { counts_per_radiance: 1e-13, var_added: vec![1e3; nodes.len()] };
/// let unknowns = Unknowns::new([Nuisance::Temperature])?;
/// let from_near = EnvelopeScene {
///     bands: &near,
///     surroundings: &surroundings,
///     emissivity: &vec![0.95; nodes.len()],
///     alternative: &other,
///     counting: &counting,
///     unknowns: &unknowns,
///     range: StateRange::default(),
/// };
/// let ranges = Ranges::new([300.0, 310.0], vec![[0.1, 0.8]], vec![[283.0; 2]])?;
/// let worst = worst_case(&EnvelopeScene { bands: &far, ..from_near }, &ranges, &Effort::default())?;
/// let stretch = Stretch { far: &far, middle: &middle, sag: &sag };
/// let known = LeastKnown { distance: worst.distance, state: &worst.state, nearest: &worst.nearest };
/// let (lower, _) = lower_bound_along(&from_near, &stretch, &ranges, &known, &Effort::default())?.unwrap();
/// assert!(lower <= worst.distance && lower > 0.98 * worst.distance);
/// # Ok::<(), hadar::Error>(())
/// ```
pub fn lower_bound_along(
    scene: &EnvelopeScene<'_>,
    stretch: &Stretch<'_>,
    ranges: &Ranges,
    known: &LeastKnown<'_>,
    effort: &Effort,
) -> Result<Option<(f64, u64)>> {
    scene.check()?;
    stretch.check(scene.bands)?;
    let objects = scene.surroundings.objects().len();
    ranges.check_objects(objects)?;
    if !model::provable(scene.unknowns, objects) || effort.boxes == 0 {
        return Ok(None);
    }
    if known.distance.is_nan() || known.distance <= 0.0 {
        return Ok(Some((0.0, 0)));
    }
    let mut joint = Model::new(scene, ranges);
    joint.0.along = Some(*stretch);
    let best = joint::residual(&joint.0, &joint.0.point(known.state, known.nearest));
    joint.0.lean([&best.target, &best.alternative]);
    let known = Attained {
        distance: known.distance,
        state: known.state.clone(),
        nearest: known.nearest.clone(),
        evaluations: 0,
    };
    let proof = prove::prove(&joint, ranges, effort, &best, known)?;
    Ok(Some((proof.lower_bound, proof.boxes)))
}
