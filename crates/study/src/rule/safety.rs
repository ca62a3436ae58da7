//! Where a category that matters for safety cannot be excluded, by the cameras of a clause.
//!
//! A camera excludes it where its materials are all of one side of the pairs that the clause searches (those of a side are not compared with
//! each other), the camera meets the clause, and
//! the least statistical distance that is proved over the envelope reaches Φ⁻¹(0.99): of every scene then at most 1 % of the readings are
//! taken for the other side. The bound is that of the worst pair, whether the category is in it or not, which is the safe side.
//! What an exclusion rests on is another matter (`exclusion`).

use super::results::{CameraVerdict, EnvelopeResult};
use crate::condition::Condition;
use crate::identify::AT_99;
use hadar_scenario::decompose::CategorySpec;
use serde::Serialize;

/// Whether a camera excludes a category that matters for safety, anywhere in the operating envelope of a clause.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SafetyOfRule {
    /// Name of the category that matters for safety.
    pub category: String,
    /// Name of the camera, as the rule names it.
    pub camera: String,
    /// Whether it is excluded wherever it is not.
    pub excluded: bool,
    /// The least statistical distance that is proved over the operating envelope; `None` if nothing is.
    pub statistical_distance_lower: Option<f64>,
    /// Materials of it that the clause does not compare, of which nothing is known.
    pub not_compared: Vec<String>,
    /// Other materials of its category, which are not compared with it.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub not_compared_with: Vec<String>,
    /// What of the materials that are compared is entered as one number: an exclusion rests on it.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub constants: Vec<String>,
    /// What it rests on that it is excluded, hardest first; empty where it is not.
    pub conditions: Vec<Condition>,
}

/// Whether a camera excludes a category, without what it rests on.
pub(super) fn rows(
    categories: &[CategorySpec],
    envelope: &EnvelopeResult,
    cameras: &[CameraVerdict],
    constants: &[String],
) -> Vec<SafetyOfRule> {
    let classes = envelope.classes.iter();
    let class_names: Vec<&String> = classes.map(|side| &side.name).collect();
    let row = |spec: &CategorySpec, camera: &CameraVerdict| {
        let is_in = |names: &[String], one: &String| names.contains(one);
        // Those of a side that are not of it; nothing where it is not on that side alone.
        let beside = |names: &[String]| {
            let is_on_it = spec.materials.iter().all(|one| is_in(names, one));
            let others = names.iter().filter(|one| !spec.materials.contains(one));
            is_on_it.then(|| others.cloned().collect::<Vec<_>>())
        };
        let side = beside(&envelope.materials).or_else(|| beside(&envelope.alternatives));
        let is_compared = |one: &&String| {
            is_in(&envelope.materials, one) || is_in(&envelope.alternatives, one) || class_names.contains(one)
        };
        let lower = camera.lower_bound;
        SafetyOfRule {
            category: spec.name.clone(),
            camera: camera.name.clone(),
            excluded: camera.passes
                && lower.is_some_and(|lower| lower >= AT_99)
                && side.as_ref().is_some_and(Vec::is_empty),
            statistical_distance_lower: lower,
            not_compared_with: side.unwrap_or_default(),
            constants: constants.to_vec(),
            conditions: Vec::new(),
            not_compared: spec.materials.iter().filter(|one| !is_compared(one)).cloned().collect(),
        }
    };
    let safety = categories.iter().filter(|spec| spec.safety);
    safety.flat_map(|spec| cameras.iter().map(move |camera| row(spec, camera))).collect()
}
