//! The answer to a rule cell by cell, for a page that sets tables of its own. Every word of it is that of the certificate or of the text.

use super::certificate::{about_the_rule, in_a_word, title, what_it_is};
use super::hardest::scene_in_words;
use super::market::of_market;
use super::reasons::{passed, said};
use super::reforms::verdict;
use super::stop::decisions;
use super::{in_words_of_kind, measured, sources, text};
use crate::text::significant;
use crate::words::{Say, safety};
use hadar_scenario::Units;
use hadar_scenario::rule::Verdict;
use hadar_study::{
    CameraVerdict, ClauseAnswer, Condition, Found, MeasuredVerdict, Outcome, RuleAnswer, Warning,
};

pub use super::certificate::WORDS;
pub use super::reforms::{BESIDE, Change, ReformShown, shown as reforms};

/// The answer to a rule as a page shows it.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Shown {
    /// What the rule is called.
    pub title: String,
    /// What the answer is, and what it is not.
    pub what_it_is: String,
    /// What the rule says of itself: a label and a text.
    pub about: Vec<(&'static str, String)>,
    /// A sentence that says which cameras meet the rule.
    pub sentence: String,
    /// Whether the rule is passed: PASSED, WARNED or FAILED.
    pub result: Outcome,
    /// The same in a sentence.
    pub passed: String,
    /// Why it is not passed; empty where it is.
    pub reasons: Vec<String>,
    /// Which part of the market meets it, where shares are stated.
    pub market: Option<String>,
    /// Names of the cameras, in the order of all cells.
    pub cameras: Vec<String>,
    /// The answer to each clause by itself.
    pub clauses: Vec<ClauseShown>,
    /// All clauses together; empty of a rule with one.
    pub whole: Vec<Cell>,
    /// What the tests of the rule say; none where it has none.
    pub tests: Option<String>,
}

/// A clause before all cameras, as a page shows it.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct ClauseShown {
    /// Its name, or its kind in words.
    pub name: String,
    /// The kind of the clause, in words.
    pub kind: String,
    /// The text of the clause in the rule.
    pub text: Option<String>,
    /// A sentence that says which cameras meet the clause.
    pub sentence: String,
    /// What it demands, in a sentence that can be quoted.
    pub demanded: String,
    /// Where and when the decision is due.
    pub stop: Option<String>,
    /// What else is to be said of it, a sentence each.
    pub remarks: Vec<String>,
    /// Every camera, in the order of the rule.
    pub cells: Vec<Cell>,
}

/// A camera before a clause, or before all of them, as a page shows it.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Cell {
    /// What comes of it: `yes`, `yes, if`, `undecided` or `no`.
    pub verdict: &'static str,
    /// The same with the reason in the fewest words.
    pub short: String,
    /// The same with the reason in full.
    pub full: String,
    /// The margin to three digits.
    pub margin: String,
    /// How the verdict is known.
    pub evidence: &'static str,
    /// The scene in which the camera is nearest to failing; empty of all clauses together.
    pub scene: String,
    /// What would let it meet the demand; empty where nothing needs to, or nothing is said of it.
    pub would_do: String,
}

/// The answer to a rule.
#[must_use]
pub fn of(answer: &RuleAnswer) -> Shown {
    let (about, units) = (&answer.rule.about, answer.rule.scenario.units());
    let mut fields = about_the_rule(answer);
    fields.extend(about.text.clone().map(|text| ("Wording", text)));
    let (result, reasons) = answer.outcome();
    let whole = answer.cameras.iter().map(|camera| Cell {
        verdict: word(camera.verdict, &camera.conditions),
        short: in_a_word(camera.verdict, camera.grade, &camera.conditions, &[]),
        full: text::meets_all(camera),
        margin: significant(camera.margin, 3),
        evidence: camera.grade.name(),
        scene: String::new(),
        would_do: String::new(),
    });
    let tested = answer.tested();
    Shown {
        title: title(answer),
        what_it_is: what_it_is(&answer.rule),
        about: fields,
        sentence: answer.sentence.say(),
        result,
        passed: passed(result, &reasons),
        reasons: said(&reasons),
        market: answer.market().map(|market| of_market(&market)),
        cameras: answer.cameras.iter().map(|camera| camera.name.clone()).collect(),
        clauses: answer.clauses.iter().map(|clause| of_clause(clause, units)).collect(),
        whole: if answer.clauses.len() > 1 { whole.collect() } else { Vec::new() },
        tests: (!tested.is_empty()).then(|| sources::tests(&tested, answer.sentence.idle)),
    }
}

/// What the reader must know; what is said of several cameras is said once.
#[must_use]
pub fn warnings(answer: &RuleAnswer) -> Vec<Warning> {
    text::together(answer)
}

fn of_clause(clause: &ClauseAnswer, units: Units) -> ClauseShown {
    let kind = in_words_of_kind(clause.kind).to_owned();
    let (demanded, remarks, cells) = match &clause.found {
        Found::Apart(apart) => (
            apart.requirement.quotable.say(),
            safety::of_rule(&apart.safety),
            apart.cameras.iter().map(|camera| of_apart(camera, clause, units)).collect(),
        ),
        Found::Measured(measured) => (
            format!("Demanded: {}.", measured.definition.say()),
            Vec::new(),
            measured.cameras.iter().map(|camera| of_measured(camera, units)).collect(),
        ),
    };
    ClauseShown {
        name: clause.name.clone().unwrap_or_else(|| kind.clone()),
        kind,
        text: clause.text.clone(),
        sentence: clause.sentence.say(),
        demanded,
        stop: clause.stop.as_ref().map(|stop| decisions(stop, units)),
        remarks,
        cells,
    }
}

fn of_apart(camera: &CameraVerdict, clause: &ClauseAnswer, units: Units) -> Cell {
    Cell {
        verdict: word(camera.verdict, &camera.conditions),
        short: in_a_word(camera.verdict, camera.grade, &camera.conditions, &camera.fails_by),
        full: text::meets(camera),
        margin: significant(camera.margin, 3),
        evidence: camera.grade.name(),
        scene: scene_in_words(camera, clause, units),
        would_do: camera.fixes.as_ref().map_or_else(String::new, |fixes| text::would_do(fixes, units)),
    }
}

fn of_measured(camera: &MeasuredVerdict, units: Units) -> Cell {
    Cell {
        verdict: word(camera.verdict, &camera.conditions),
        short: in_a_word(camera.verdict, camera.grade, &camera.conditions, &camera.fails_by),
        full: measured::measured_meets(camera),
        margin: significant(camera.margin, 3),
        evidence: camera.grade.name(),
        scene: measured::measured_scene(&camera.limiting, units),
        would_do: String::new(),
    }
}

/// A verdict in a word or two.
fn word(of: Verdict, conditions: &[Condition]) -> &'static str {
    verdict(of, Condition::open(conditions).next().is_none())
}
