//! Why a rule is not passed, in words.

use crate::words::Say;
use hadar_study::{CameraBeforeClause, NotPassed, Outcome};

/// Whether the rule is passed, in a sentence.
pub(super) fn passed(outcome: Outcome, reasons: &[NotPassed]) -> String {
    match outcome {
        Outcome::Passed => "Result: PASSED. Every camera is proved to meet every clause, under no condition except accepted ones, on a day on which the rule holds.".into(),
        _ => format!("Result: {}. {}", outcome.word(), if reasons.len() == 1 { "The reason:" } else { "The reasons:" }),
    }
}

const FAILS: &str = "does not meet it";
const IS_UNDECIDED: &str = "undecided";
const IS_UNPROVED: &str = "met, but not proved";
const RESTS: &str = "rests on conditions that were not accepted (--accept)";

/// Codes of reasons for which a rule is not passed, each with its meaning and what to do about it.
pub(crate) const REASONS: [[&str; 3]; 10] = [
    ["fails", "a camera does not meet a clause", "see its margin and what it fails by"],
    ["undecided", "a camera may or may not meet a clause", "state its figures with less uncertainty"],
    [
        "not-proved",
        "a camera meets a clause, but this is not proved",
        "see `evidence`: what was searched, simulated or assumed",
    ],
    [
        "conditions",
        "a clause is met only under conditions that were not accepted",
        "settle them, or name them with --accept",
    ],
    [
        "camera-figures",
        "no source is stated for figures of a camera",
        "name them in a [[source]], keys = [\"camera[0]\"], with a document or a choice",
    ],
    [
        "changed",
        "a value of the rule was replaced, so that this is another rule",
        "leave out --set and --judge",
    ],
    [
        "materials-replaced",
        "materials of built-in names were replaced",
        "leave out --library, or give them different names",
    ],
    ["no-day", "no day was stated on which the rule should hold", "name one with --on"],
    ["no-dates", "the rule does not say when it holds", "write from in [rule]"],
    ["not-in-force", "the rule does not hold on the day", "ask about a day on which it does"],
];

/// A reason that is of a camera: under which heading, where, and what else is said of it.
fn of_a_camera(reason: &NotPassed) -> Option<(&'static str, &CameraBeforeClause, String)> {
    match reason {
        NotPassed::Fails(place) => Some((FAILS, place, String::new())),
        NotPassed::Undecided(place) => Some((IS_UNDECIDED, place, String::new())),
        NotPassed::NotProved(place, grade) => Some((IS_UNPROVED, place, format!(", {}", grade.name()))),
        NotPassed::RestsOn(place, codes) => Some((RESTS, place, format!(": {}", codes.join(", ")))),
        _ => None,
    }
}

/// Reasons in words, those of a kind together, and of those the ones of a camera.
pub(super) fn said(reasons: &[NotPassed]) -> Vec<String> {
    let mut out = Vec::new();
    for heading in [FAILS, IS_UNDECIDED, IS_UNPROVED, RESTS] {
        let of_heading = reasons.iter().filter_map(of_a_camera).filter(|(own, ..)| *own == heading);
        let mut groups: Vec<(&str, String, Vec<&str>)> = Vec::new();
        for (_, place, what) in of_heading {
            match groups.iter_mut().find(|(camera, own, _)| *camera == place.camera && *own == what) {
                Some((.., clauses)) => clauses.extend(place.clause.as_deref()),
                None => groups.push((&place.camera, what, place.clause.as_deref().into_iter().collect())),
            }
        }
        let said = |(camera, what, clauses): (&str, String, Vec<&str>)| match clauses.as_slice() {
            [] => format!("{camera}{what}"),
            some => format!("{camera} ({}){what}", some.join(", ")),
        };
        let cameras: Vec<String> = groups.into_iter().map(said).collect();
        if !cameras.is_empty() {
            out.push(format!("{heading}: {}", cameras.join("; ")));
        }
    }
    let changed = |one: &NotPassed| match one {
        NotPassed::Changed { key, value } => Some(format!("{key} = {value}")),
        _ => None,
    };
    let changed: Vec<String> = reasons.iter().filter_map(changed).collect();
    if !changed.is_empty() {
        let what = "values of the rule were replaced, so that this is another rule";
        out.push(format!("{what}: {}", changed.join("; ")));
    }
    for reason in reasons {
        match reason {
            NotPassed::Unsourced { camera, figures } => out.push(format!(
                "no source is stated for figures of {camera}: {} ([[source]])",
                figures.join(", ")
            )),
            NotPassed::NoDay => out.push("no day was stated on which the rule should hold (--on)".into()),
            NotPassed::Replaced { materials } => {
                out.push(format!(
                    "materials of these names are not the program's, but those of --library: {}",
                    materials.join(", ")
                ));
            }
            NotPassed::NoDates => {
                out.push("the rule does not say from which day it holds ([rule] from)".into())
            }
            NotPassed::NotInForce(idle) => out.push(idle.say()),
            _ => {}
        }
    }
    out
}
