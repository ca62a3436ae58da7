//! Several scenarios asked the same: a row of a table for each, with the verdict and the figures that matter, or why there is no answer.

mod laws;

use crate::bundle::Bundle;
use crate::table::{Table, number};
use crate::text::columns::aligned;
use crate::text::significant;
use crate::words::several::{NOT_IN_FORCE, UNDECIDED, YES_IF, of_best, only_if, unanswered};
use hadar::error::Result;
use hadar::order;
use hadar_study::sweep::Question;
use serde::Serialize;
use serde_json::Value;
use std::fmt::Write as _;

/// Digits that a person compares by.
const DIGITS: usize = 4;

/// What came of one scenario.
#[derive(Debug, Clone, Serialize)]
pub struct Row {
    /// Its file as it was named.
    pub scenario: String,
    /// The code that the command ends with for it alone.
    pub exit_code: u8,
    /// Why there is no answer.
    pub error: Option<String>,
    /// The answer as the command prints it for it alone.
    pub answer: Option<Value>,
}

/// Heads of the columns behind the scenario, and where each stands in the answer, the first that is there.
const fn columns(question: Question) -> &'static [(&'static str, &'static [&'static str])] {
    match question {
        Question::Identify => &[
            ("verdict", &["/identifiability/identifiable", "/identifiable"]),
            ("if", &["/conditions"]),
            ("told from", &["/identifiability/told_from"]),
            ("nearest", &["/limiting", "/not_told_from"]),
            ("distance", &["/identifiability/distance_minimum"]),
            ("reaches", &["/identifiability/statistical_distance_minimum"]),
            ("probability", &["/identifiability/detection_probability_minimum"]),
        ],
        Question::Rule => &[
            ("verdict", &[]),
            ("if", &["/cameras/0/conditions"]),
            ("meet it", &[]),
            ("best", &["/cameras/0/name"]),
            ("margin", &["/cameras/0/margin"]),
            ("limited by", &["/cameras/0/limiting_clause"]),
        ],
        Question::Range => &[
            ("verdict", &["/verdict/met"]),
            ("signal", &["/verdict/signal"]),
            ("share", &["/verdict/share"]),
            ("demanded", &["/verdict/required_share"]),
            ("error [m]", &["/at/sigma_m"]),
        ],
        Question::Size
        | Question::Simulate
        | Question::Decompose
        | Question::Library
        | Question::CalibrateNoise => &[
            ("verdict", &["/verdict/met"]),
            ("if", &["/verdict/conditions"]),
            ("limited by", &["/limiting", "/not_told_from"]),
            ("reaches", &["/verdict/statistical_distance"]),
            ("demanded", &["/verdict/required_distance"]),
            ("margin", &["/verdict/margin"]),
            ("photons it takes", &["/requirement/photons"]),
        ],
    }
}

fn cells(question: Question, answer: &Value) -> Vec<Value> {
    let answer = match question {
        Question::Rule => &best_first(answer),
        _ => answer,
    };
    let found = |paths: &[&str]| paths.iter().find_map(|path| answer.pointer(path)).cloned();
    let meets: Vec<bool> = answer["cameras"]
        .as_array()
        .map_or_else(Vec::new, |cameras| cameras.iter().map(|camera| camera["passes"] == true).collect());
    let hang =
        answer["cameras"].as_array().is_some_and(|all| all.iter().any(|one| laws::hangs(&one["conditions"])));
    // A rule without a camera, or on a day on which it does not hold, is met by none.
    let met = !meets.is_empty() && meets.iter().all(|meets| *meets);
    let all = answer["cameras"].as_array().into_iter().flatten();
    let (fails, undecided) = all.fold((false, false), |(fails, undecided), camera| {
        (fails || camera["verdict"] == "fails", undecided || camera["verdict"] == "undecided")
    });
    let of = |(head, paths): &(&str, &[&str])| match (question, *head) {
        // Where a day was asked about, the answer says whether the rule holds on it.
        (Question::Rule, "verdict") if !answer["on"].is_null() && answer["in_force"] != true => {
            NOT_IN_FORCE.into()
        }
        (Question::Rule, "verdict") if met && hang => YES_IF.into(),
        (Question::Rule, "verdict") if !met && !fails && undecided => UNDECIDED.into(),
        (Question::Rule, "verdict") => met.into(),
        (Question::Rule, "meet it") => {
            format!("{} of {}", meets.iter().filter(|meets| **meets).count(), meets.len()).into()
        }
        // A 'yes' that hangs on something is none by itself.
        (Question::Identify, "verdict")
            if found(paths) == Some(true.into()) && laws::hangs(&answer["conditions"]) =>
        {
            YES_IF.into()
        }
        (_, "verdict")
            if answer["verdict"]["answer"] == "yes" && laws::hangs(&answer["verdict"]["conditions"]) =>
        {
            YES_IF.into()
        }
        (_, "verdict") if answer["verdict"]["answer"] == "undecided" => UNDECIDED.into(),
        (_, "if") => found(paths).map_or(Value::Null, |conditions| codes(&conditions)),
        _ => found(paths).unwrap_or_default(),
    };
    columns(question).iter().map(of).collect()
}

/// The answers that there are, with what they are called.
fn answers(rows: &[Row]) -> Vec<(&str, &Value)> {
    rows.iter().filter_map(|row| Some((row.scenario.as_str(), row.answer.as_ref()?))).collect()
}

/// Codes of the favourable ones, hardest first.
fn codes(conditions: &Value) -> Value {
    let codes = conditions.as_array().into_iter().flatten().filter(|one| one["favourable"] == true);
    let mut codes: Vec<&str> = codes.filter_map(|one| one["code"].as_str()).collect();
    codes.dedup();
    if codes.is_empty() { Value::Null } else { codes.join(" ").into() }
}

/// The hardest of some codes, and how many there are behind it.
fn folded(codes: &str) -> String {
    match codes.split_once(' ') {
        Some((hardest, more)) => format!("{hardest} +{}", more.split(' ').count()),
        None => codes.to_owned(),
    }
}

/// The answer about a rule with the camera of the largest margin first.
fn best_first(answer: &Value) -> Value {
    let mut answer = answer.clone();
    if let Some(cameras) = answer.get_mut("cameras").and_then(Value::as_array_mut) {
        let margin = |camera: &Value| camera["margin"].as_f64().unwrap_or(f64::NEG_INFINITY);
        order::descending(cameras, margin);
    }
    answer
}

fn shown(cell: &Value) -> String {
    match cell {
        Value::Null => "-".into(),
        Value::Bool(true) => "yes".into(),
        Value::Bool(false) => "no".into(),
        Value::Number(number) if number.is_f64() => significant(number.as_f64().unwrap_or(f64::NAN), DIGITS),
        Value::String(text) => text.clone(),
        other => other.to_string(),
    }
}

/// The table as it is printed; an error stands in its row.
#[must_use]
pub fn text(question: Question, rows: &[Row]) -> String {
    let heads = columns(question).iter().map(|(head, _)| (*head).to_owned());
    let mut lines = vec![std::iter::once("scenario".to_owned()).chain(heads).collect::<Vec<_>>()];
    // Folded in the table, whole below it.
    let mut rests_on = String::new();
    for row in rows {
        let mut line = vec![row.scenario.clone()];
        match (&row.answer, &row.error) {
            (Some(answer), _) => {
                let found = cells(question, answer);
                // Of a rule the conditions are those of its best camera, and of one that is not in force nothing is said.
                let best = columns(question).iter().position(|(head, _)| *head == "best");
                let of = best
                    .map_or_else(|| row.scenario.clone(), |at| of_best(&row.scenario, &shown(&found[at])));
                let idle = found.first() == Some(&NOT_IN_FORCE.into());
                for ((head, _), cell) in columns(question).iter().zip(found) {
                    let whole = shown(&cell);
                    let is_folded = *head == "if" && whole.contains(' ');
                    if is_folded && !idle {
                        let _ = writeln!(rests_on, "{}", only_if(&of, &whole));
                    }
                    line.push(if is_folded { folded(&whole) } else { whole });
                }
            }
            (None, error) => line.push(format!("error: {}", error.clone().unwrap_or_default())),
        }
        lines.push(line);
    }
    let side_by_side = if question == Question::Rule { laws::text(&answers(rows), rows.len()) } else { None };
    let mut out = side_by_side.map_or_else(String::new, |text| text + "\n") + &aligned(&lines, &[]);
    if !rests_on.is_empty() {
        let _ = write!(out, "\n{rests_on}");
    }
    let failed = rows.iter().filter(|row| row.answer.is_none()).count();
    if failed > 0 {
        let _ = writeln!(out, "\n{}", unanswered(failed, rows.len()));
    }
    out
}

/// The table as a file, beside the reports of the scenarios.
///
/// # Errors
/// A table that cannot be written.
pub fn bundle(question: Question, rows: &[Row]) -> Result<Bundle> {
    let heads = columns(question).iter().map(|(head, _)| head.replace(' ', "_"));
    let mut table = Table::new(["scenario".to_owned()].into_iter().chain(heads).chain(["error".to_owned()]));
    for row in rows {
        let plain = |cell: &Value| match cell.as_f64() {
            Some(value) => number(value),
            None if cell.is_null() => String::new(),
            None => shown(cell),
        };
        let cells = match &row.answer {
            Some(answer) => cells(question, answer).iter().map(plain).collect(),
            None => vec![String::new(); columns(question).len()],
        };
        let error = row.error.clone().unwrap_or_default();
        table.push([row.scenario.clone()].into_iter().chain(cells).chain([error]).collect());
    }
    let mut bundle = Bundle::about(Some(&format!("{} of {} scenarios", question.name(), rows.len())));
    bundle.add_table("scenarios.csv", table)?;
    if let Some(plot) = laws::plot(&answers(rows)).filter(|_| question == Question::Rule) {
        bundle.add_plots(&[plot])?;
    }
    Ok(bundle)
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn a_row_has_what_the_answer_says_or_what_went_wrong() {
        let row = |scenario: &str, answer: Option<Value>, error: Option<&str>| Row {
            scenario: scenario.into(),
            exit_code: u8::from(error.is_some()),
            error: error.map(str::to_owned),
            answer,
        };
        let answer = json!({ "verdict": { "met": false, "margin": 0.05, "required_distance": 1.0 }, "limiting": "aluminium" });
        let hangs = json!({ "verdict": { "met": true, "answer": "yes", "margin": 2.0, "conditions": [
            { "code": "registered-frames", "favourable": true }, { "code": "no-air", "favourable": true },
            { "code": "setting", "favourable": false },
        ] } });
        let rows = [
            row("a.toml", Some(answer), None),
            row("b.toml", Some(hangs), None),
            row("longer.toml", None, Some("line 3: it is wrong")),
        ];
        let expected = "scenario     verdict  if                    limited by  reaches  demanded  margin   photons it takes\n\
                        a.toml       no       -                     aluminium   -        1.000     0.05000  -\n\
                        b.toml       yes, if  registered-frames +1  -           -        -         2.000    -\n\
                        longer.toml  error: line 3: it is wrong\n\nb.toml: yes only if registered-frames no-air\n\n1 of 3 scenarios without an answer.\n";
        assert_eq!(text(Question::Size, &rows), expected);
        let csv = bundle(Question::Size, &rows).unwrap();
        assert_eq!(csv.names().collect::<Vec<_>>(), ["scenarios.csv"]);
    }

    #[test]
    fn the_best_camera_of_a_rule_speaks_for_it() {
        let camera =
            |name: &str, margin: f64| json!({ "name": name, "margin": margin, "passes": margin > 1.0 });
        let answer = json!({ "cameras": [camera("a", 0.5), camera("b", 2.0)] });
        let cells: Vec<String> = cells(Question::Rule, &answer).iter().map(shown).collect();
        assert_eq!(cells, ["no", "-", "1 of 2", "b", "2.000", "-"]);
    }

    /// Only a rule that holds on the day, of at least one camera, all of which pass, is a 'yes'.
    #[test]
    fn a_rule_that_is_not_in_force_or_has_no_camera_is_no_yes() {
        let verdict = |on: Value, in_force: Value, cameras: Value| {
            let answer = json!({ "on": on, "in_force": in_force, "cameras": cameras });
            cells(Question::Rule, &answer).remove(0)
        };
        let passes = || json!([{ "name": "a", "passes": true, "margin": 2.0 }]);
        assert_eq!(verdict(json!("2020-01-02"), json!(false), passes()), "no, not in force");
        assert_eq!(verdict(json!("2020-01-02"), Value::Null, passes()), "no, not in force");
        assert_eq!(verdict(json!("2020-01-01"), json!(true), passes()), true);
        assert_eq!(verdict(json!("2020-01-01"), json!(true), json!([])), false);
        assert_eq!(verdict(Value::Null, Value::Null, passes()), true);
    }
}
