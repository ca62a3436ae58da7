//! Where a category that matters for safety cannot be excluded, by the cameras of a clause.
//!
//! A camera excludes it where all of its materials are on one side of the pairs that the clause searches, the camera meets the clause, and
//! the least statistical distance that is proved over the envelope reaches Φ⁻¹(0.99): of every scene then at most 1 % of the readings are
//! taken for the other side. The bound is that of the worst pair, whether the category is in it or not, which is the safe side.

use super::results::{CameraVerdict, EnvelopeResult};
use crate::identify::AT_99;
use hadar_scenario::decompose::CategorySpec;
use serde::Serialize;

/// Whether a camera excludes a category that matters for safety, anywhere in the envelope of a clause.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SafetyOfRule {
    /// Its name.
    pub category: String,
    /// The camera.
    pub camera: String,
    /// Whether it is excluded wherever it is not.
    pub excluded: bool,
    /// The least statistical distance that is proved over the envelope; `None` if nothing is.
    pub statistical_distance_lower: Option<f64>,
    /// Materials of it that the clause does not compare, of which nothing is known.
    pub not_compared: Vec<String>,
}

/// Of every category with `safety = true` and every camera.
pub(super) fn rows(
    categories: &[CategorySpec],
    envelope: &EnvelopeResult,
    cameras: &[CameraVerdict],
    required: f64,
) -> Vec<SafetyOfRule> {
    let classes = envelope.classes.iter();
    let class_names: Vec<&String> = classes.map(|side| &side.name).collect();
    let row = |spec: &CategorySpec, camera: &CameraVerdict| {
        let is_in = |names: &[String], one: &String| names.contains(one);
        let on_a_side = |names: &[String]| spec.materials.iter().all(|one| is_in(names, one));
        let is_compared = |one: &&String| {
            is_in(&envelope.materials, one) || is_in(&envelope.alternatives, one) || class_names.contains(one)
        };
        let lower = camera.lower_bound.map(|share| share * required);
        SafetyOfRule {
            category: spec.name.clone(),
            camera: camera.name.clone(),
            excluded: camera.passes
                && lower.is_some_and(|lower| lower >= AT_99)
                && (on_a_side(&envelope.materials) || on_a_side(&envelope.alternatives)),
            statistical_distance_lower: lower,
            not_compared: spec.materials.iter().filter(|one| !is_compared(one)).cloned().collect(),
        }
    };
    let safety = categories.iter().filter(|spec| spec.safety);
    safety.flat_map(|spec| cameras.iter().map(move |camera| row(spec, camera))).collect()
}
