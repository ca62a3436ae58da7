//! What a page shows of an answer of `hadar find`: a camera a row, those that meet first.

use super::{lens, of_filter, paid, why};
use crate::text::numbers::{between, listed, significant};
use crate::words::Say;
use hadar::words::quantity;
use hadar_study::Condition;
use hadar_study::find::{Choice, Failed, FindAnswer, Why};
use serde::Serialize;

/// A camera as a page lists it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Row {
    /// The name of the camera.
    pub camera: String,
    /// `meets`, `meets if`, `undecided` or `does not meet`.
    pub told: &'static str,
    /// The first condition of a yes and how many more there are, or why the camera does not meet.
    pub why: String,
    /// f-number and focal length of its lens.
    pub lens: String,
    /// Names of its filters, or their wavelengths.
    pub filters: String,
    /// Number of frames that are added up.
    pub frames: String,
    /// Time until all is read.
    pub time: String,
    /// The statistical distance, from what is proved to what was found.
    pub distance: String,
    /// What is known of the price.
    pub price: String,
    /// The scenario with this choice, as `hadar size` takes it; none of a camera that was not put to it.
    pub scenario: Option<String>,
}

const UNDECIDED: &str = "undecided";
const DOES_NOT_MEET: &str = "does not meet";

/// Those that meet, the best first; undecided ones; the others with the reason. Cameras that nobody can order, and those of which figures or
/// a lens are missing, are in the text alone.
#[must_use]
pub fn rows(found: &FindAnswer) -> Vec<Row> {
    let met = found.listed.iter().chain(&found.also).map(|choice| {
        let open: Vec<&Condition> = Condition::open(choice.conditions()).collect();
        match open.split_first() {
            None => chosen(choice, "meets", String::new()),
            Some((first, [])) => chosen(choice, "meets if", first.say()),
            Some((first, rest)) => {
                let more = if rest.len() == 1 { "condition" } else { "conditions" };
                chosen(choice, "meets if", format!("{}; and {} more {more}", first.say(), rest.len()))
            }
        }
    });
    let undecided = found.undecided.iter().map(|choice| {
        chosen(choice, UNDECIDED, "d reaches the requirement by the search, not by the proof".into())
    });
    let near = found.near.as_ref().map(|near| &near.choice);
    let is_near = |one: &&Failed| {
        near.is_some_and(|near| near.camera == one.camera && Some(&near.lens) == one.lens.as_ref())
    };
    let reason = found.failed.iter().find(is_near);
    let nearest = near.map(|choice| {
        let why = reason.map_or_else(String::new, |one| why(one, found.required_distance));
        chosen(choice, reason.map_or(DOES_NOT_MEET, told), why)
    });
    let is_shown = |one: &&Failed| !matches!(one.why, Why::Figures { .. } | Why::NoLens | Why::NotSold);
    let others = found.failed.iter().filter(|one| is_shown(one) && !is_near(one)).map(|one| Row {
        camera: one.camera.clone(),
        told: told(one),
        why: why(one, found.required_distance),
        lens: one.lens.as_ref().map(lens).unwrap_or_default(),
        filters: String::new(),
        frames: String::new(),
        time: String::new(),
        distance: one.upper.map(|d| format!("at most {}", significant(d, 3))).unwrap_or_default(),
        price: String::new(),
        scenario: None,
    });
    met.chain(undecided).chain(nearest).chain(others).collect()
}

fn told(failed: &Failed) -> &'static str {
    if failed.why == Why::Undecided { UNDECIDED } else { DOES_NOT_MEET }
}

fn chosen(choice: &Choice, told: &'static str, why: String) -> Row {
    let filters: Vec<String> =
        choice.filters.iter().map(|one| one.name.clone().unwrap_or_else(|| of_filter(one))).collect();
    Row {
        camera: choice.camera.clone(),
        told,
        why,
        lens: lens(&choice.lens),
        filters: if filters.is_empty() { "none".into() } else { listed(&filters) },
        frames: choice.frames.to_string(),
        time: quantity(choice.time_s, "s"),
        distance: between([choice.lower, choice.upper], 3),
        price: paid(choice).unwrap_or_else(|| "not known".into()),
        scenario: Some(choice.scenario.to_toml()),
    }
}
