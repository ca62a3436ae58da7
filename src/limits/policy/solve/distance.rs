//! The farthest at which a task is met.
//!
//! A target that fills its pixels is as bright from any distance, but for the air on the path and the last bit of
//! étendue near the lens (S7). Distance matters through the air and through the share of the pixel that a target of
//! stated size fills, both of which fall with it; near the lens the distance d rises a little. Air changes the spectrum
//! within a wide band too, so that d may rise and fall: the answer is how far the task is met without a gap from the
//! nearest distance at which it is, by steps of a factor, and it is said where that is not right before the lens.

use super::quantity::{Quantity, Trial};
use super::solution::{NEVER, Solution};
use super::task::CameraTask;
use crate::error::Result;
use crate::root::crossing_between;
use crate::words::quantity;

/// Nearer than so many focal lengths nothing is imaged at all.
const NEAR_FOCAL_LENGTHS: f64 = 2.0;
/// Farther than this nothing on Earth is, m.
const FAR_M: f64 = 1e8;
/// Nearer than this nobody asks, m.
const CLOSE_M: f64 = 5.0;
/// Factor from one distance to the next as the crossing is bracketed.
const STEP: f64 = std::f64::consts::SQRT_2;

impl CameraTask<'_> {
    /// The farthest distance that is looked at, m.
    #[must_use]
    pub fn looked_at_m(&self) -> f64 {
        self.farthest_m.unwrap_or(FAR_M)
    }
}

pub(super) fn solve(
    task: &CameraTask<'_>,
    mut distance: impl FnMut(&Trial) -> Result<f64>,
) -> Result<Solution> {
    let camera = task.value(Quantity::Distance);
    let mut at = |z: f64| distance(&task.forward(Quantity::Distance, z));
    let none = |statistical_distance: f64, reason: String| {
        Solution::new(None, camera, statistical_distance, Some(reason))
    };
    let near = NEAR_FOCAL_LENGTHS * task.camera.focal_length_m;
    let far = task.looked_at_m();
    let beyond = at(far)?;
    if beyond >= task.required {
        let reason = if task.farthest_m.is_some() {
            format!("it is met up to where the data of the air end, {}", quantity(far, "m"))
        } else if task.of_object && task.size_m.is_none() {
            "the pixels are stated, not the size: their number is the same at any distance".into()
        } else {
            "distance does not matter: the target fills its pixels, and there is no air on the path".into()
        };
        return Ok(none(beyond, reason));
    }
    // From near to far, up to the first distance that is too far.
    let mut steps = vec![far];
    while steps.last().is_some_and(|z| z / STEP >= near) {
        steps.push(steps[steps.len() - 1] / STEP);
    }
    let mut best = beyond;
    let mut met: Option<[f64; 2]> = None;
    let mut first: Option<f64> = None;
    for z in steps.into_iter().rev() {
        let reached = at(z)?;
        best = best.max(reached);
        if reached >= task.required {
            first = first.or(Some(z));
            met = Some([z, reached]);
            continue;
        }
        let Some([nearer, enough]) = met else { continue };
        let excess = |d: f64| (d / task.required).max(1e-300).ln().max(-1e3);
        let ends = [[-z.ln(), excess(reached)], [-nearer.ln(), excess(enough)]];
        let nearness = crossing_between(ends[0], ends[1], |nearness| at((-nearness).exp()).map(excess))?;
        let value = (-nearness).exp();
        let statistical_distance = at(value)?;
        // Nearer than a few metres the lens itself takes its share.
        let reason = first
            .filter(|first| *first > CLOSE_M && *first > STEP * near)
            .map(|first| format!("closer than about {first:.2} m it is not met"));
        return Ok(Solution::new(Some(value), camera, statistical_distance, reason));
    }
    let reason = if best == 0.0 { NEVER } else { "no distance is short enough" };
    Ok(none(best, reason.into()))
}
