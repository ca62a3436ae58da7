//! Whether a rule is passed, as evidence that others sign: by all cameras, proved, on a stated day on which the rule holds, with the rule as it is
//! written and nothing that somebody would first have to accept.
//!
//! Where a camera surely fails the rule as it is written, and the rule holds, it is failed. All else is a warning, with its reasons.

use super::clauses::{ClauseAnswer, RuleAnswer};
use super::not_in_force::NotInForce;
use crate::condition::Condition;
use crate::grade::Grade;
use hadar_scenario::rule::Verdict;
use serde::ser::SerializeMap;

hadar::named! {
    /// What comes of a rule, as `test-result` of in-toto has it.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
    #[serde(rename_all = "UPPERCASE")]
    pub enum Outcome {
        /// Every camera meets every clause, proved, unconditionally, on a stated day.
        Passed = "PASSED",
        /// Neither.
        Warned = "WARNED",
        /// A camera does not meet a clause of a rule that holds.
        Failed = "FAILED",
    }
    /// The word, e.g. `PASSED`.
    word
}

/// Why a rule is not passed.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Reason {
    /// A camera does not meet a clause.
    Fails(Place),
    /// A camera may or may not meet a clause.
    Undecided(Place),
    /// That it meets a clause is no proof.
    NotProved(Place, Grade),
    /// Meeting a clause rests on conditions that nobody accepted, by their codes.
    RestsOn(Place, Vec<String>),
    /// Figures of a camera of which nobody says where they are from.
    Unsourced {
        /// The camera.
        camera: String,
        /// Their keys.
        figures: Vec<String>,
    },
    /// A value stands in the place of the rule's own.
    Changed {
        /// Its key.
        key: String,
        /// What stands there.
        value: String,
    },
    /// Materials by a name of this program are others.
    Replaced {
        /// Their names.
        materials: Vec<String>,
    },
    /// No day was stated.
    NoDay,
    /// The rule does not say when it holds.
    NoDates,
    /// The rule does not hold on that day.
    NotInForce(NotInForce),
}

/// A camera before a clause.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Place {
    /// The camera.
    pub camera: String,
    /// The clause; none of a rule without clauses.
    pub clause: Option<String>,
}

impl Reason {
    /// Its stable code.
    #[must_use]
    pub const fn code(&self) -> &'static str {
        match self {
            Self::Fails(_) => "fails",
            Self::Undecided(_) => "undecided",
            Self::NotProved(..) => "not-proved",
            Self::RestsOn(..) => "conditions",
            Self::Unsourced { .. } => "camera-figures",
            Self::Changed { .. } => "changed",
            Self::Replaced { .. } => "materials-replaced",
            Self::NoDay => "no-day",
            Self::NoDates => "no-dates",
            Self::NotInForce(_) => "not-in-force",
        }
    }

    /// Whose it is, where it is of a camera.
    #[must_use]
    pub const fn place(&self) -> Option<&Place> {
        match self {
            Self::Fails(place)
            | Self::Undecided(place)
            | Self::NotProved(place, _)
            | Self::RestsOn(place, _) => Some(place),
            Self::Unsourced { .. }
            | Self::Changed { .. }
            | Self::Replaced { .. }
            | Self::NoDay
            | Self::NoDates
            | Self::NotInForce(_) => None,
        }
    }
}

impl RuleAnswer {
    /// Whether the rule is passed, and why not.
    #[must_use]
    pub fn outcome(&self) -> (Outcome, Vec<Reason>) {
        let mut reasons: Vec<Reason> =
            self.clauses.iter().flat_map(|clause| self.of_clause(clause)).collect();
        let fails = reasons.iter().any(|one| matches!(one, Reason::Fails(_)));
        reasons.extend(self.unsourced());
        let mut is_rule = true;
        // A rule that does not hold, or with other values, is not the one that is failed.
        for set in &self.rule.scenario.source.settings {
            is_rule = false;
            reasons.push(Reason::Changed { key: set.key.clone(), value: set.value.clone() });
        }
        if !self.replaced.is_empty() {
            is_rule = false;
            reasons.push(Reason::Replaced { materials: self.replaced.clone() });
        }
        if let Some(idle) = self.sentence.idle {
            is_rule = false;
            reasons.push(Reason::NotInForce(idle));
        }
        if self.on.is_none() {
            reasons.push(Reason::NoDay);
        }
        // Of a rule without dates nobody knows that it holds.
        if self.rule.about.from.is_none() && self.rule.about.until.is_none() {
            reasons.push(Reason::NoDates);
        }
        let outcome = match (fails && is_rule, reasons.is_empty()) {
            (true, _) => Outcome::Failed,
            (false, true) => Outcome::Passed,
            (false, false) => Outcome::Warned,
        };
        (outcome, reasons)
    }

    /// Cameras with figures of which nobody says where they are from.
    fn unsourced(&self) -> impl Iterator<Item = Reason> {
        self.cameras.iter().enumerate().filter_map(|(index, camera)| {
            let own = self.rule.camera_figures(index).into_iter().map(|figure| figure.key);
            let file =
                (self.rule.own_document(index) == Some(None)).then(|| self.rule.cameras[index].key.clone());
            let figures: Vec<String> =
                own.chain(file).filter(|key| self.rule.behind(key).next().is_none()).collect();
            (!figures.is_empty()).then(|| Reason::Unsourced { camera: camera.name.clone(), figures })
        })
    }

    fn of_clause(&self, clause: &ClauseAnswer) -> Vec<Reason> {
        let mut reasons = Vec::new();
        for line in clause.lines() {
            let place = || Place { camera: line.camera.to_owned(), clause: clause.name.clone() };
            match line.verdict {
                Verdict::Fails => reasons.push(Reason::Fails(place())),
                Verdict::Undecided => reasons.push(Reason::Undecided(place())),
                Verdict::Meets => {
                    if line.evidence != Grade::Proved {
                        reasons.push(Reason::NotProved(place(), line.evidence));
                    }
                    // What is set over the rule is said once, of all.
                    let open = Condition::unaccepted(line.conditions, &self.accepted)
                        .filter(|one| !matches!(one, Condition::Setting { .. }));
                    let codes: Vec<String> = open.map(Condition::code).collect();
                    if !codes.is_empty() {
                        reasons.push(Reason::RestsOn(place(), codes));
                    }
                }
            }
        }
        reasons
    }
}

impl serde::Serialize for Reason {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("code", self.code())?;
        if let Some(place) = self.place() {
            map.serialize_entry("camera", &place.camera)?;
            map.serialize_entry("clause", &place.clause)?;
        }
        match self {
            Self::NotProved(_, grade) => map.serialize_entry("evidence", grade)?,
            Self::RestsOn(_, codes) => map.serialize_entry("conditions", codes)?,
            Self::Unsourced { camera, figures } => {
                map.serialize_entry("camera", camera)?;
                map.serialize_entry("figures", figures)?;
            }
            Self::Changed { key, value } => {
                map.serialize_entry("key", key)?;
                map.serialize_entry("value", value)?;
            }
            Self::Replaced { materials } => map.serialize_entry("materials", materials)?,
            Self::NotInForce(idle) => map.serialize_entry("day", &idle.day.to_string())?,
            Self::Fails(_) | Self::Undecided(_) | Self::NoDay | Self::NoDates => {}
        }
        map.end()
    }
}
