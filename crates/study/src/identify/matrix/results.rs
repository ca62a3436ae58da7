//! All against all as data.

use crate::Condition;
use crate::identify::SafetyOfTarget;
use hadar::demand::Work;
use hadar::identifiability::multi::Passes;
use hadar::order;
use hadar_scenario::Scenario;

/// Distances row by row of the target; `None` on the diagonal.
pub type Rows = Vec<Vec<Option<f64>>>;

/// Distances of every material of the scenario, target and alternatives, against every other one, each target
/// in the target's state.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Matrix {
    /// Names of the materials, the order of rows and columns.
    pub materials: Vec<String>,
    /// Name of the distance that decides: nearest or local.
    pub by: &'static str,
    /// Nearest distance of every target (row) from every material (column), per √photon.
    pub distance_nearest: Rows,
    /// What is proved of it: no state of the alternative is nearer.
    pub distance_nearest_lower: Rows,
    /// Its estimated relative error by rounding.
    pub relative_error_nearest: Rows,
    /// Local distance of every target (row) from every material (column), per √photon.
    pub distance_local: Rows,
    /// Estimated bound on its relative rounding error.
    pub relative_error: Rows,
    /// Local distance with unknown gain per √photon, where that decides.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub distance_local_unknown_gain: Option<Rows>,
    /// Estimated bound on its relative rounding error.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub relative_error_unknown_gain: Option<Rows>,
    /// Statistical distance of the camera by the distance that decides, as states that were found show it; `None` without a camera.
    pub statistical_distance: Option<Rows>,
    /// What is proved of it, whatever rounding did to it.
    pub statistical_distance_lower: Option<Rows>,
    /// Statistical distance d that is required for a pair.
    pub required_distance: f64,
    /// Every material as a target.
    pub targets: Vec<TargetVerdict>,
    /// What the camera makes of every pair; `None` without one.
    pub apart: Option<Apart>,
    /// Whether each category with `safety = true` is excluded where each of the materials is; empty without such categories.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub safety: Vec<SafetyOfTarget>,
    /// Nearest distances that are searched and not proved.
    pub unproved: usize,
    /// How the local distances per √photon were computed: what the targets lent to their pairs.
    pub passes: Passes,
}

/// One material against all others.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct TargetVerdict {
    /// Name of the material that is the target.
    pub material: String,
    /// The one hardest to distinguish it from.
    pub limiting: String,
    /// Its distance per √photon, by the distance that decides.
    pub distance_minimum: f64,
    /// Its statistical distance with the camera.
    pub statistical_distance_minimum: Option<f64>,
    /// What is proved of it.
    pub statistical_distance_minimum_lower: Option<f64>,
    /// Whether the camera distinguishes the material from every other one.
    pub identifiable: Option<bool>,
}

impl TargetVerdict {
    /// The statistical distance with a camera, else that per √photon.
    #[must_use]
    pub fn decisive_minimum(&self) -> f64 {
        self.statistical_distance_minimum.unwrap_or(self.distance_minimum)
    }
}

impl Matrix {
    /// The targets, the least identifiable first.
    #[must_use]
    pub fn hardest_first(&self) -> Vec<&TargetVerdict> {
        let mut targets: Vec<&TargetVerdict> = self.targets.iter().collect();
        order::ascending(&mut targets, |a| a.decisive_minimum());
        targets
    }
}

/// Pairs that can be distinguished, those that cannot, and the groups that these make.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Apart {
    /// Pairs distinguished, either of them the target.
    pub told_apart: Vec<[String; 2]>,
    /// Pairs of materials that the camera does not distinguish.
    pub not_told_apart: Vec<[String; 2]>,
    /// Disjoint groups of which no two members are distinguished.
    pub clusters: Vec<Vec<String>>,
    /// Groups that hang together by pairs that are not distinguished, if only by a chain of them.
    pub chains: Vec<Vec<String>>,
}

/// The answer to 'is the target identifiable', and no more.
#[derive(Debug, Clone, serde::Serialize)]
#[non_exhaustive]
pub struct Check {
    /// The scenario with its defaults filled in.
    pub scenario: Scenario,
    /// Whether the camera distinguishes the target from every alternative.
    pub identifiable: bool,
    /// The first alternative found that it does not; there may be more.
    pub not_told_from: Option<String>,
    /// Its place among the alternatives.
    #[serde(skip)]
    pub failed: Option<usize>,
    /// What a 'yes' rests on, hardest first; of a 'no' what was taken on the unfavourable side. Empty where they were not asked for.
    pub conditions: Vec<Condition>,
    /// Codes of conditions that whoever asks accepts.
    pub accepted: Vec<String>,
    /// What was computed for it and what was not.
    pub stats: Work,
}
