//! The worst case of the statistical distance over an envelope of scenes, with a certificate.
//!
//! A requirement holds over ranges: temperature T of the target, lighting Vₖ and temperature Tₖ of every object
//! around it. The worst case is the least distance of all these scenes,
//!
//! d* = min over θ = (T, V, Tₖ) of d(θ),   d(θ) = min over θ′ of ‖√(N(θ)+v) − √(N′(θ′)+v)‖,
//!
//! N counts of the target, N′ of the alternative, v added variance of each band, θ′ whatever of (T′, V′, G′, Tₖ′) is
//! unknown, and the rest as in θ. So d* is one minimisation over θ and θ′ together.
//!
//! * From above (`attain`): a dense set of scenes with [`NearestSolver`](crate::identifiability::nearest::NearestSolver) in each, and descents from the best of
//!   them. The distance reported is that of [`NearestSolver::with_counting`](crate::identifiability::nearest::NearestSolver::with_counting) at the scene reported,
//!   or of [`NearestSolver::refine_with_counting`](crate::identifiability::nearest::NearestSolver::refine_with_counting) from a state that the descents came upon, where that is nearer.
//! * From below (`prove`, `bound`): branch and bound over θ and θ′ together, for every set of unknowns, with and without
//!   a known total of the lighting: up to four objects around, or two whose temperatures are unknown. Priors
//!   only add to the distance, so what is proved without them is true with them, but need not meet the distance
//!   attained. Gain is sought within |ln G′| ≤ 14, Tₖ′ between 0.1 and 10⁶ K.
//!
//! A proof accounts for the rounding of its own sums (`cell`), but it is not made of outward-rounded intervals,
//! and Planck's function is taken to be as exact as [`crate::planck`] states.
//!
//! Distance to the target is no dimension of a worst case. What air does to it along a stretch of distances is bounded by
//! [`lower_bound_along`] (`stretch`). Materials are enumerated by the caller.

mod attain;
mod bound;
mod cell;
mod cube;
mod halving;
mod joint;
mod linear;
mod model;
mod node;
mod partition;
mod prove;
mod ranges;
mod relation;
mod scene;
mod series;
mod stretch;

pub use self::prove::Effort;
pub use self::ranges::Ranges;
pub use self::scene::{EnvelopeScene, Stretch};
pub use self::stretch::{LeastKnown, lower_bound_along};

use self::attain::Attained;
use self::model::Model;
use crate::error::Result;
use crate::scene::State;

/// Scenes that are tried before the best of them are refined: with descents over scene and state together and a proof to
/// follow, with a proof of what the priors leave out, and without any.
const SCENES: usize = 64;
const SCENES_WITH_PRIORS: usize = 256;
const SCENES_WITHOUT_PROOF: usize = 1024;

/// Boxes at most where priors are left out of the bound.
const BOXES_WITH_PRIORS: u64 = 100_000;

/// What is known of a worst case.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Certificate {
    /// Proved to the tolerance: no scene of the envelope is below the lower bound.
    BranchAndBound,
    /// A lower bound is proved, but it is farther below the distance attained than the tolerance.
    Bounded {
        /// By how much, as a share of the distance attained.
        gap: f64,
    },
    /// The envelope holds a scene in which nothing differs: the distance is 0.
    Equilibrium,
    /// No proof: the best of a dense search and of refinements.
    DenseSearch {
        /// Scenes searched before refinement.
        points: usize,
    },
}

/// The least distance of an envelope.
#[derive(Debug, Clone, PartialEq)]
pub struct WorstCase {
    /// The statistical distance in the limiting scene: attained.
    pub distance: f64,
    /// Proved: no scene of the envelope is below. `None` if nothing is proved.
    pub lower_bound: Option<f64>,
    /// The limiting scene.
    pub state: State,
    /// The alternative's state that is nearest to it.
    pub nearest: State,
    /// How sure it is.
    pub certificate: Certificate,
    /// Nearest distances computed.
    pub evaluations: u64,
    /// Boxes of the branch and bound.
    pub boxes: u64,
}

impl WorstCase {
    fn new(attained: Attained, lower_bound: Option<f64>, certificate: Certificate) -> Self {
        let Attained { distance, state, nearest, evaluations, .. } = attained;
        Self { distance, lower_bound, state, nearest, certificate, evaluations, boxes: 0 }
    }
}

/// The worst case of one pair of materials over an envelope.
///
/// # Errors
/// Ranges that do not fit the surroundings; emissivities, noise or a range of states that cannot be; a scene
/// without photons.
pub fn worst_case(scene: &EnvelopeScene<'_>, ranges: &Ranges, effort: &Effort) -> Result<WorstCase> {
    found(scene, ranges, None, effort)
}

/// The same from a scene that is near the worst one, with the alternative's state there, instead of from a dense set of scenes: enough
/// where a bound far below the distance is. What it proves holds wherever it began, but the distance attained may be farther above.
///
/// # Errors
/// As [`worst_case`].
pub fn worst_case_near(
    scene: &EnvelopeScene<'_>,
    ranges: &Ranges,
    known: [&State; 2],
    effort: &Effort,
) -> Result<WorstCase> {
    found(scene, ranges, Some(known), effort)
}

fn found(
    scene: &EnvelopeScene<'_>,
    ranges: &Ranges,
    known: Option<[&State; 2]>,
    effort: &Effort,
) -> Result<WorstCase> {
    scene.check()?;
    ranges.check_objects(scene.surroundings.objects().len())?;
    if let Some(state) = ranges.equilibrium(scene) {
        let attained = Attained { distance: 0.0, nearest: state.clone(), state, evaluations: 0 };
        return Ok(WorstCase::new(attained, Some(0.0), Certificate::Equilibrium));
    }
    if let Some(attained) = attain::nothing_differs(scene, ranges)? {
        return Ok(WorstCase::new(attained, Some(0.0), Certificate::Equilibrium));
    }
    let provable = model::provable(scene.unknowns, scene.surroundings.objects().len()) && effort.boxes > 0;
    let joint = provable.then(|| Model::new(scene, ranges));
    let points = match (provable, scene.unknowns.has_priors()) {
        (true, false) => SCENES,
        (true, true) => SCENES_WITH_PRIORS,
        (false, _) => SCENES_WITHOUT_PROOF,
    };
    // A descent over scene and state together knows nothing of priors.
    let descent = joint.as_ref().filter(|_| !scene.unknowns.has_priors());
    let attained = match (known, descent) {
        (Some([state, nearest]), Some(joint)) => {
            attain::attain_near(joint, ranges, joint.0.point(state, nearest))?
        }
        _ => attain::attain(scene, ranges, points, descent)?,
    };
    if attained.distance == 0.0 {
        return Ok(WorstCase::new(attained, Some(0.0), Certificate::Equilibrium));
    }
    let Some(mut joint) = joint else {
        return Ok(WorstCase::new(attained, None, Certificate::DenseSearch { points }));
    };
    let best = joint::residual(&joint.0, &joint.0.point(&attained.state, &attained.nearest));
    joint.0.lean([&best.target, &best.alternative]);
    // With priors the bound need not come near, however many boxes.
    let most = if scene.unknowns.has_priors() { BOXES_WITH_PRIORS } else { u64::MAX };
    let effort = Effort { boxes: effort.boxes.min(most), ..*effort };
    let proof = prove::prove(&joint, ranges, &effort, &best, attained)?;
    let gap = 1.0 - proof.lower_bound / proof.attained.distance;
    let proved = gap <= effort.relative_tolerance;
    let certificate = if proved { Certificate::BranchAndBound } else { Certificate::Bounded { gap } };
    let worst = WorstCase::new(proof.attained, Some(proof.lower_bound), certificate);
    Ok(WorstCase { boxes: proof.boxes, ..worst })
}

#[cfg(test)]
mod tests;
