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

use super::model::{self, Model};
use super::prove::{self, Effort};
use super::ranges::Ranges;
use super::scene::EnvelopeScene;
use super::{Attained, WorstCase, joint};
use crate::error::{Error, Result, check};
use crate::spectrum::Bands;

/// By how much of itself a weight may rise for rounding, where transmittances stay what they are: a part of what bounds allow for it.
const ROUNDING: f64 = 1e-13;

/// What the bands let through along a stretch of distances.
#[derive(Debug, Clone, Copy)]
pub struct Stretch<'a> {
    /// The bands as they are at the far end, nowhere more than those of the scene.
    pub far: &'a Bands,
    /// The same at the geometric mean of the two distances.
    pub middle: &'a Bands,
    /// The same bands with the share that transmittances may be off a parabola of ln z at each node.
    pub sag: &'a Bands,
}

impl Stretch<'_> {
    fn check(&self, near: &Bands) -> Result<()> {
        for bands in [self.far, self.middle, self.sag] {
            if bands.nodes_cm1() != near.nodes_cm1() {
                let what = "nodes of the bands at the far end".into();
                let (found, expected) = (bands.nodes_cm1().len(), near.nodes_cm1().len());
                return Err(Error::Length { what, found, expected });
            }
            bands.weights_cm1().iter().try_for_each(|&weight| {
                check::non_negative("weight of a band along a stretch of distances", weight, "cm^-1")
                    .map(drop)
            })?;
        }
        for (near, far) in [(near, self.middle), (self.middle, self.far)] {
            let rises = |(near, far): &(&f64, &f64)| **far > **near * (1.0 + ROUNDING);
            let rises = near.weights_cm1().iter().zip(far.weights_cm1()).find(rises);
            if let Some((_, &far)) = rises {
                let expected = "at most its weight from nearer";
                return Err(Error::out_of_range("weight of a band from afar", far, "cm^-1", expected));
            }
        }
        Ok(())
    }
}

/// A distance below which no scene of the envelope is, along the whole stretch, and the boxes that it took: no more than that of
/// `known`, at which the proof ends. `None` where nothing can be proved of these unknowns.
///
/// `scene` has the bands as they are at the near end, and the least counts per radiance and the most added variance along
/// the stretch. `known` is the least distance found from wherever, at whatever distance.
///
/// # Errors
/// As [`worst_case`](super::worst_case); bands that let through more at the far end than at the near one.
pub fn lower_bound_along(
    scene: &EnvelopeScene<'_>,
    stretch: &Stretch<'_>,
    ranges: &Ranges,
    known: &WorstCase,
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
    let best = joint::residual(&joint.0, &joint.0.point(&known.state, &known.nearest));
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
