//! The farthest at which a task is met.
//!
//! A target that fills its pixels is as bright from any distance, but for the air on the path and the last bit of
//! étendue near the lens (S7). Distance matters through the air and through the share of the pixel that a target of
//! stated size fills, both of which fall with it; near the lens the distance d rises a little. So the crossing is sought
//! from the far end.

use super::{CameraTask, NEVER, Quantity, Solution, Trial};
use crate::error::Result;
use crate::root::crossing;

/// Nearer than so many focal lengths nothing is imaged at all.
const NEAR_FOCAL_LENGTHS: f64 = 2.0;
/// Farther than this nothing on Earth is, m.
const FAR_M: f64 = 1e8;
/// Factor from one distance to the next as the crossing is bracketed.
const STEP: f64 = 2.0;

pub(super) fn solve(
    task: &CameraTask<'_>,
    mut distance: impl FnMut(&Trial) -> Result<f64>,
) -> Result<Solution> {
    let camera = task.value(Quantity::Distance);
    let mut at = |z: f64| distance(&task.forward(Quantity::Distance, z));
    let none = |statistical_distance: f64, reason: String| Solution {
        value: None,
        camera,
        statistical_distance,
        reason: Some(reason),
        caps: Vec::new(),
    };
    let near = NEAR_FOCAL_LENGTHS * task.camera.focal_length_m;
    let mut far = FAR_M;
    // A table of the air may end before.
    let beyond = loop {
        match at(far) {
            Ok(reached) => break reached,
            Err(error) if far / STEP < near => return Err(error),
            Err(_) => far /= STEP,
        }
    };
    if beyond >= task.required {
        let reason = if far < FAR_M {
            format!("it is met as far as the air is known, {far:.3e} m")
        } else {
            "distance does not matter: the target fills its pixels, and there is no air that would end it"
                .into()
        };
        return Ok(none(beyond, reason));
    }
    let mut best = beyond;
    while far / STEP >= near {
        let nearer = far / STEP;
        let reached = at(nearer)?;
        best = best.max(reached);
        if reached >= task.required {
            let excess =
                |nearness: f64| Ok((at((-nearness).exp())? / task.required).max(1e-300).ln().max(-1e3));
            let value = (-crossing(-far.ln(), -nearer.ln(), excess)?).exp();
            let statistical_distance = at(value)?;
            return Ok(Solution {
                value: Some(value),
                camera,
                statistical_distance,
                reason: None,
                caps: Vec::new(),
            });
        }
        far = nearer;
    }
    let reason = if best == 0.0 { NEVER } else { "no distance is short enough" };
    Ok(none(best, reason.into()))
}
