//! What is known of every pair, and of the target against all alternatives, as data.

use super::super::{ClassAnswer, Condition, PriorAverage, Shortfall, Warning};
use crate::decision::YesNo;
use hadar::demand::Work;
use hadar::identifiability::Status;
use hadar::identifiability::decision::DecisionLaw;
use hadar::identifiability::detection::ErrorBracket;
use hadar::scene::State;
use hadar_scenario::{DistanceKind, Scenario};
use std::collections::BTreeMap;

/// What can be distinguished from the target, alternative by alternative.
#[derive(Debug, Clone, serde::Serialize)]
#[non_exhaustive]
pub struct Identification {
    /// The scenario with its defaults filled in.
    pub scenario: Scenario,
    /// ΣS·Δν of the target, photons s⁻¹ m⁻² sr⁻¹.
    pub photon_radiance: f64,
    /// The pairs, in the order of the alternatives.
    pub pairs: Vec<PairResult>,
    /// The alternative that is hardest to distinguish.
    pub limiting: String,
    /// The target against the library as a whole (Algorithm 3).
    pub identifiability: Identifiability,
    /// The hardest alternative on average over the priors; `None` without priors, or where it was not asked for.
    pub prior_average: Option<PriorAverage>,
    /// What the members of classes say together, alternative by alternative; empty without classes.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub classes: Vec<ClassAnswer>,
    /// Whether each category with `safety = true` is excluded where the target is; empty without such categories.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub safety: Vec<SafetyOfTarget>,
    /// What it rests on that the camera tells an alternative, hardest first; empty where it was not asked for.
    pub conditions: Vec<Condition>,
    /// What the reader must know.
    pub warnings: Vec<Warning>,
    /// What it took. Searches within an average over priors, a choice of bands or a simulated decision are part of that
    /// section and not counted one by one.
    pub stats: Work,
}

/// A target against all its alternatives (Algorithm 3): the one hardest to distinguish decides.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Identifiability {
    /// Least distance per √photon, by the distance that decides (S33).
    pub distance_minimum: f64,
    /// Least statistical distance with the camera, as a state that was found shows it.
    pub statistical_distance_minimum: Option<f64>,
    /// What is proved of the least, and that which was found.
    pub statistical_distance_minimum_bounds: Option<[f64; 2]>,
    /// Largest probability of a correct decision, Φ of that distance.
    pub detection_probability_minimum: Option<f64>,
    /// Identifiability log₂ 2P of the paper, bits.
    pub identifiability_bits: Option<f64>,
    /// Whether the camera distinguishes the target from every alternative with the required probability.
    pub identifiable: Option<bool>,
    /// Alternatives that it distinguishes the target from.
    pub told_from: Option<usize>,
    /// The paper's prediction vector S32, target first: a heuristic, no bound and no test's probability.
    pub prediction_heuristic: Option<Vec<Prediction>>,
}

/// An entry of the prediction vector S32.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Prediction {
    /// Name of the material of this entry.
    pub material: String,
    /// Probability that S32 assigns to the material, 0 to 1.
    pub probability: f64,
}

/// The state of the alternative that looks most like the target.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct NearestState {
    /// Temperature of the alternative in that state, K.
    pub temperature_k: f64,
    /// Lighting factors of the alternative in that state, 0 to 1.
    pub lighting: Vec<f64>,
    /// Common factor of its counts in that state, where the gain is unknown.
    pub gain: f64,
    /// Temperatures of the environment objects, K, where they are unknown.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub environment_temperature_k: Option<Vec<f64>>,
}

impl NearestState {
    /// Of a state, with the temperatures of the surroundings where they are unknown.
    pub(crate) fn of(state: &State, environment: bool) -> Self {
        Self {
            temperature_k: state.temperature_k,
            lighting: state.lighting.clone(),
            gain: state.gain,
            environment_temperature_k: environment.then(|| state.environment_k.clone()),
        }
    }
}

/// Photons for the requirement by each reading of the distance, shot noise only.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct PhotonsRequired {
    /// Photons required by the nearest distance, which is the limit.
    pub nearest: Option<f64>,
    /// Photons required by the local distance, which is no limit.
    pub local: Option<f64>,
    /// By the local distance with unknown gain (S29).
    pub local_unknown_gain: Option<f64>,
}

impl PhotonsRequired {
    /// By the distance of a kind.
    #[must_use]
    pub const fn of(&self, kind: DistanceKind) -> Option<f64> {
        match kind {
            DistanceKind::Nearest => self.nearest,
            DistanceKind::Local => self.local,
            DistanceKind::LocalUnknownGain => self.local_unknown_gain,
        }
    }
}

/// How sure a nearest distance is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum NearestProof {
    /// No state is nearer by more than the share that is asked for.
    Proved,
    /// It is the best of a search; what is proved is farther below it.
    Searched,
}

/// One target against one alternative.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct PairResult {
    /// Name of the target's material in the library.
    pub target: String,
    /// Name of the alternative material in the library.
    pub alternative: String,
    /// Whether each of the two is entered as one number for all wavenumbers: nothing is then known of what distinguishes them.
    pub placeholders: bool,
    /// Local distance per √photon, nuisances of the scenario.
    pub distance_local: f64,
    /// The same with gain unknown too: the paper's S29.
    pub distance_local_unknown_gain: f64,
    /// The same with nothing unknown but the material.
    pub distance_no_nuisance: f64,
    /// Nearest distance of the two materials, per √photon.
    pub distance_nearest: f64,
    /// What is proved of it: no state of the alternative is nearer.
    pub distance_nearest_lower: f64,
    /// Whether that is as near to it as is asked for.
    pub proof: NearestProof,
    /// Estimated relative rounding error of the nearest distance.
    pub relative_error_nearest: f64,
    /// The state it belongs to.
    pub nearest_state: NearestState,
    /// The parameters of that state that are at the edge of their range.
    pub nearest_at_edge: Vec<String>,
    /// Distance from that state back to the target's material, per √photon of the target.
    pub distance_return: f64,
    /// What is proved of it: no state of the target's material is nearer.
    pub distance_return_lower: f64,
    /// Whether that is as near to it as is asked for.
    pub proof_return: NearestProof,
    /// Estimated relative rounding error of it.
    pub relative_error_return: f64,
    /// Photons for the requirement by what is proved of the chosen distance, shot noise only; `None` where none suffice, or where nothing
    /// is proved.
    pub photons_required: Option<f64>,
    /// The least number that may do, as a state that was found shows, and that which is proved to do; none suffice where the first is `None`.
    pub photons_required_bounds: [Option<f64>; 2],
    /// Photons for the requirement by all three readings, as they were found.
    pub photons_required_by: PhotonsRequired,
    /// Statistical distance of the camera by the chosen distance, with its noise, as a state that was found shows it; of few counts that at
    /// which Φ is the probability by their own law.
    pub statistical_distance: Option<f64>,
    /// The same by the nearest distance: the limit, whichever decides.
    pub statistical_distance_nearest: Option<f64>,
    /// What that of the chosen distance is at least, as proved, and at most, as a state that was found shows.
    pub statistical_distance_bounds: Option<[f64; 2]>,
    /// Whether the requirement is reached: *undecided* where what is proved does not and what was found does.
    pub told: Option<YesNo>,
    /// Whether it is proved that it is reached.
    pub told_apart: Option<bool>,
    /// By which law counts are decided: Φ(d) of many, the exact one of few, or a bracket.
    pub decided_by: Option<DecisionLaw>,
    /// What the paper's shortcut √(N/(1+γ))·d₀ makes of it.
    pub statistical_distance_shortcut: Option<f64>,
    /// Largest probability of a correct decision, Φ(d), 0.5 to 1.
    pub detection_probability: Option<f64>,
    /// What it is at least, as proved, and at most.
    pub detection_probability_bounds: Option<[f64; 2]>,
    /// Smallest probability of a wrong decision, 1 − Φ(d).
    pub miss_probability: Option<f64>,
    /// Information on the material, log₂ 2P with P = Φ(d), bits.
    pub information_bits: Option<f64>,
    /// Mutual information of the binary decision.
    pub mutual_information_bits: Option<f64>,
    /// Estimate for a test that must fit temperature and lighting itself.
    pub two_sided_probability: Option<f64>,
    /// Rigorous bounds on the error of the best test between the two states; only by the nearest distance, which alone has two.
    pub error_bracket: Option<ErrorBracket>,
    /// Condition number of the scaled scores; `None` if infinite.
    pub condition_number: Option<f64>,
    /// Estimated bound on the relative rounding error of the local distance.
    pub relative_error: f64,
    /// Of the local distance with unknown gain.
    pub relative_error_unknown_gain: f64,
    /// Of the local distance with nothing unknown but the material.
    pub relative_error_no_nuisance: f64,
    /// Of the statistical distance of the camera, where a local distance decides.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub relative_error_statistical: Option<f64>,
    /// What kind of answer the local distance is.
    pub status: Status,
    /// The change of the nuisances that imitates the alternative, where the status is `blind`.
    pub blind_direction: Option<BTreeMap<String, f64>>,
}

impl PairResult {
    /// The distance per √photon of a kind.
    #[must_use]
    pub fn distance(&self, kind: DistanceKind) -> f64 {
        match kind {
            DistanceKind::Nearest => self.distance_nearest,
            DistanceKind::Local => self.distance_local,
            DistanceKind::LocalUnknownGain => self.distance_local_unknown_gain,
        }
    }
}

/// Whether a category that matters for safety is excluded where the target is.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct SafetyOfTarget {
    /// Name of the category that matters for safety.
    pub category: String,
    /// Name of the material that is in the place of the target.
    pub target: String,
    /// Whether the target is of the category itself.
    pub is_target: bool,
    /// Whether every one of its materials is excluded.
    pub excluded: bool,
    /// Its materials, in the order in which they are named.
    pub materials: Vec<SafetyMaterial>,
    /// What of it and of the target is entered as one number: an exclusion rests on it.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub constants: Vec<String>,
    /// What it rests on that it, or any of its materials, is excluded, hardest first; empty where none is.
    pub conditions: Vec<Condition>,
    /// What spoils the readings of the camera, which then exclude nothing.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub spoiled_by: Vec<Shortfall>,
}

/// A material of a category that matters for safety, against the target.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct SafetyMaterial {
    /// Name of the material in the library.
    pub material: String,
    /// Whether it is among the alternatives: if not, nothing is known of it.
    pub compared: bool,
    /// Whether what is proved of the camera excludes it.
    pub excluded: bool,
    /// The least probability that it is left among what 99 % leave, by any test; `None` without a camera or where it was not compared.
    pub probability_left_at_least: Option<f64>,
}
