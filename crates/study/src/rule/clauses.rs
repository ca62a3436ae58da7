//! What comes of the clauses of a rule, as data.

use super::results::{
    ApproachResult, CameraVerdict, EnvelopeResult, NotIdentifiable, RuleRequirement, StopResult, WhoMeets,
};
use super::safety::SafetyOfRule;
use super::uncertainty::MarginUncertainty;
use crate::companion::Companion;
use crate::condition::Condition;
use crate::grade::Grade;
use crate::{Shortfall, Warning};
use hadar::demand::Work;
use hadar::ranging::depth::Demand;
use hadar_scenario::rule::Verdict;
use hadar_scenario::{Date, Rule};
use serde::ser::{Serialize, SerializeMap, Serializer};

/// Which cameras meet a rule.
///
/// In JSON a rule without `[[clause]]` has what its one clause has, `requirement`, `envelope`, `cameras` and
/// `not_identifiable`, at the top; one with clauses has the verdict on each camera in `cameras`, and all else in `clauses`.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct RuleAnswer {
    /// The rule with its defaults filled in.
    pub rule: Rule,
    /// The day that was asked about.
    pub on: Option<Date>,
    /// Materials by a name of this program that are others here.
    pub replaced: Vec<String>,
    /// All figures of every camera, looked up: the same of the same camera in any rule. Not in the JSON.
    pub camera_figures: Vec<String>,
    /// Codes of conditions that whoever asks accepts.
    pub accepted: Vec<String>,
    /// Which cameras do, in JSON a sentence.
    pub sentence: WhoMeets,
    /// Every camera, in the order of the rule.
    pub cameras: Vec<CameraAnswer>,
    /// What every clause says of it, in the order of the rule.
    pub clauses: Vec<ClauseAnswer>,
    /// What the reader must know; what concerns one camera is with that camera.
    pub warnings: Vec<Warning>,
    /// What was computed and what was skipped, with the time.
    pub stats: Work,
}

/// A camera before all clauses.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct CameraAnswer {
    /// Name of the camera, as the rule names it.
    pub name: String,
    /// Whether the camera meets the rule: yes, no or undecided.
    pub verdict: Verdict,
    /// Whether it meets the rule.
    pub passes: bool,
    /// The least of the margins: what is there over what is demanded.
    pub margin: f64,
    /// The clause of that margin; none of a rule without clauses.
    pub limiting_clause: Option<String>,
    /// The interval of the margin of that clause; `None` where no uncertainty is stated.
    pub interval: Option<[f64; 2]>,
    /// Clauses that it does not meet.
    pub fails: Vec<String>,
    /// Clauses that it may or may not meet.
    pub undecided: Vec<String>,
    /// The weakest evidence that its verdict rests on.
    pub grade: Grade,
    /// The same where all conditions hold.
    pub evidence: Grade,
    /// What meeting the rule rests on, hardest first.
    pub conditions: Vec<Condition>,
}

/// A clause before all cameras.
#[derive(Debug, Clone, serde::Serialize)]
#[non_exhaustive]
pub struct ClauseAnswer {
    /// Its name; none of a rule without clauses.
    pub name: Option<String>,
    /// The kind of the clause as the rule names it, such as `tell-apart`.
    pub kind: &'static str,
    /// The text of the clause in the rule.
    pub text: Option<String>,
    /// How the vehicle comes to a stop, if that is said.
    pub stop: Option<StopResult>,
    /// Which cameras meet it, in JSON a sentence.
    pub sentence: WhoMeets,
    /// What was found.
    #[serde(flatten)]
    pub found: Found,
}

/// What was found of a clause, by what it demands.
#[derive(Debug, Clone, serde::Serialize)]
#[serde(untagged)]
pub enum Found {
    /// Materials that are told apart.
    Apart(Box<ApartAnswer>),
    /// A quantity that a camera reaches.
    Measured(MeasuredAnswer),
}

/// A clause that requires materials to be distinguished.
#[derive(Debug, Clone, serde::Serialize)]
#[non_exhaustive]
pub struct ApartAnswer {
    /// What the clause requires of a camera.
    pub requirement: RuleRequirement,
    /// The operating envelope over which it is required.
    pub envelope: EnvelopeResult,
    /// Every camera, in the order of the rule.
    pub cameras: Vec<CameraVerdict>,
    /// The part of the operating envelope in which no camera could do it; `None` where only the verdict was asked for.
    pub not_identifiable: Option<NotIdentifiable>,
    /// What sizing practice says of every camera at its worst distance, where the rule says how large the target is.
    pub companions: Vec<Companion>,
    /// Whether each camera excludes each category with `safety = true`; empty without such categories.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub safety: Vec<SafetyOfRule>,
}

/// A clause that demands a quantity.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct MeasuredAnswer {
    /// Name of the quantity that is required.
    pub quantity: Measure,
    /// How much of it, in the unit of the quantity.
    pub demanded: f64,
    /// What that means, in JSON in words.
    pub definition: Definition,
    /// Every camera, in the order of the rule.
    pub cameras: Vec<MeasuredVerdict>,
}

/// What a quantity that a clause demands means.
#[derive(Debug, Clone, PartialEq)]
pub enum Definition {
    /// Pixels across a size at the greatest distance, by geometry and motion alone.
    Pixels {
        /// Pixels demanded.
        pixels: f64,
        /// Size of the target, m.
        size_m: f64,
    },
    /// Standard deviations of an unbiased estimate of the temperature, the emissivity known.
    Temperature {
        /// How many.
        coverage_factor: f64,
        /// What they must be within, K.
        error_k: f64,
        /// Whether there are errors of the emissivities, which are not carried into it.
        without_emissivity_errors: bool,
    },
    /// The least error of a depth.
    Depth {
        /// What is looked at.
        object: &'static str,
        /// The error demanded.
        error: Demand,
        /// The share of the windows that must reach it.
        share: f64,
        /// Distances that it is looked at from.
        distances: usize,
        /// Whether the rule has air, which is not in it.
        without_air: bool,
        /// Whether there are uncertain figures, which are not carried into it.
        without_uncertainty: bool,
    },
}

/// A quantity that a clause demands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Measure {
    /// Pixels across the target, at least.
    Pixels,
    /// Error of the temperature, K, at most.
    TemperatureErrorK,
    /// Error of the distance, m, at most.
    DepthErrorM,
    /// Error of the distance over the distance, at most.
    RelativeDepthError,
}

/// One camera against a quantity.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct MeasuredVerdict {
    /// Name of the camera, as the rule names it.
    pub name: String,
    /// Whether the camera meets the clause: yes, no or undecided.
    pub verdict: Verdict,
    /// Whether it meets the clause.
    pub passes: bool,
    /// What it does not meet.
    pub fails_by: Vec<Shortfall>,
    /// What it may or may not meet, its figures being uncertain.
    pub undecided_by: Vec<Shortfall>,
    /// How well its margin is known; `None` where no uncertainty is stated.
    pub uncertainty: Option<MarginUncertainty>,
    /// What it reaches where that is the least; `None` where there is no bound on an error.
    pub value: Option<f64>,
    /// How much better than demanded: the value over the demand of what must be large, the demand over the value of an error.
    pub margin: f64,
    /// How that is known: the weakest of what it rests on.
    pub grade: Grade,
    /// How it is known where all conditions hold.
    pub evidence: Grade,
    /// Where it is the least.
    pub limiting: MeasuredScene,
    /// How the vehicle comes nearer, if that is said.
    pub approach: Option<ApproachResult>,
    /// What meeting it rests on, hardest first.
    pub conditions: Vec<Condition>,
    /// What the reader must know.
    pub warnings: Vec<Warning>,
}

/// Where a camera is nearest to failing; what does not matter is `None`.
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize)]
#[non_exhaustive]
pub struct MeasuredScene {
    /// Distance of the target from the camera, m.
    pub distance_m: Option<f64>,
    /// How far the target moves across the line of sight while a frame is exposed, m, where that is what limits the pixels on it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub smear_m: Option<f64>,
    /// Name of the material of the target.
    pub target: Option<String>,
    /// Temperature of the target in that scene, K.
    pub temperature_k: Option<f64>,
    /// Lighting factor of every object.
    pub lighting: Vec<f64>,
    /// Temperature of every object, K.
    pub surroundings_k: Vec<f64>,
}

/// What is the same of every line: one camera before one clause.
#[derive(Debug, Clone, Copy)]
pub struct Line<'a> {
    /// The camera.
    pub camera: &'a str,
    /// What comes of it.
    pub verdict: Verdict,
    /// Least margin.
    pub margin: f64,
    /// Evidence: the weakest of what it rests on.
    pub grade: Grade,
    /// Evidence where all conditions hold.
    pub evidence: Grade,
    /// What it does not meet.
    pub fails_by: &'a [Shortfall],
    /// What it may or may not meet.
    pub undecided_by: &'a [Shortfall],
    /// How well the margin is known.
    pub uncertainty: Option<&'a MarginUncertainty>,
    /// What meeting it rests on, hardest first.
    pub conditions: &'a [Condition],
    /// How the vehicle comes nearer.
    pub approach: Option<&'a ApproachResult>,
    /// What the reader must know.
    pub warnings: &'a [Warning],
}

impl ClauseAnswer {
    /// What it says of every camera.
    #[must_use]
    pub fn lines(&self) -> Vec<Line<'_>> {
        match &self.found {
            Found::Apart(apart) => apart.cameras.iter().map(CameraVerdict::line).collect(),
            Found::Measured(measured) => measured.cameras.iter().map(MeasuredVerdict::line).collect(),
        }
    }

    /// Materials that are told apart, if that is what it demands.
    #[must_use]
    pub fn apart(&self) -> Option<&ApartAnswer> {
        match &self.found {
            Found::Apart(apart) => Some(apart),
            Found::Measured(_) => None,
        }
    }
}

impl CameraVerdict {
    /// What it has in common with other kinds of verdicts.
    #[must_use]
    pub fn line(&self) -> Line<'_> {
        Line {
            camera: &self.name,
            verdict: self.verdict,
            margin: self.margin,
            grade: self.grade,
            evidence: self.evidence,
            fails_by: &self.fails_by,
            undecided_by: &self.undecided_by,
            uncertainty: self.uncertainty.as_ref(),
            conditions: &self.conditions,
            approach: self.approach.as_ref(),
            warnings: &self.warnings,
        }
    }
}

impl MeasuredVerdict {
    /// What it has in common with other kinds of verdicts.
    #[must_use]
    pub fn line(&self) -> Line<'_> {
        Line {
            camera: &self.name,
            verdict: self.verdict,
            margin: self.margin,
            grade: self.grade,
            evidence: self.evidence,
            fails_by: &self.fails_by,
            undecided_by: &self.undecided_by,
            uncertainty: self.uncertainty.as_ref(),
            conditions: &self.conditions,
            approach: self.approach.as_ref(),
            warnings: &self.warnings,
        }
    }
}

impl RuleAnswer {
    /// The one clause of a rule without `[[clause]]`, which tells materials apart.
    #[must_use]
    pub fn only(&self) -> Option<&ApartAnswer> {
        match self.clauses.as_slice() {
            [one] if one.name.is_none() => one.apart(),
            _ => None,
        }
    }
}

impl Serialize for RuleAnswer {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("rule", &self.rule)?;
        if let Some(day) = self.on {
            map.serialize_entry("on", &day.to_string())?;
            map.serialize_entry("in_force", &self.sentence.idle.is_none())?;
        }
        map.serialize_entry("accepted", &self.accepted)?;
        map.serialize_entry("sentence", &self.sentence)?;
        let (outcome, reasons) = self.outcome();
        map.serialize_entry("result", &outcome)?;
        map.serialize_entry("reasons", &reasons)?;
        if let Some(market) = self.market() {
            map.serialize_entry("market", &market)?;
        }
        match (self.only(), self.clauses.first()) {
            (Some(only), Some(clause)) => {
                map.serialize_entry("stop", &clause.stop)?;
                map.serialize_entry("requirement", &only.requirement)?;
                map.serialize_entry("envelope", &only.envelope)?;
                map.serialize_entry("cameras", &only.cameras)?;
                map.serialize_entry("not_identifiable", &only.not_identifiable)?;
                map.serialize_entry("companions", &only.companions)?;
                if !only.safety.is_empty() {
                    map.serialize_entry("safety", &only.safety)?;
                }
            }
            _ => {
                map.serialize_entry("cameras", &self.cameras)?;
                map.serialize_entry("clauses", &self.clauses)?;
            }
        }
        map.serialize_entry("warnings", &self.warnings)?;
        map.serialize_entry("stats", &self.stats)?;
        map.end()
    }
}
