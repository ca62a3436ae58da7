//! `--check`: a line a camera, what is known of it and how.

use super::measured::{guarded, measure, measured_scene, undecided};
use super::text::{fails_by, idle, without_placeholders};
use crate::text::significant;
use crate::words::conditions;
use crate::words::shortfall::in_words;
use hadar_scenario::Units;
use hadar_scenario::rule::Verdict;
use hadar_study::{CameraVerdict, Condition, Found, Grade, Measure, MeasuredVerdict, RuleAnswer, Shortfall};
use std::fmt::Write as _;

/// A line for every camera; of a rule with clauses, a line for each of them below it.
#[must_use]
pub fn check(answer: &RuleAnswer) -> String {
    let idle = idle(answer.sentence.idle);
    if let Some(only) = answer.only() {
        let required = only.requirement.distance;
        let lines =
            only.cameras.iter().map(|camera| format!("{}: {}\n", camera.name, line(camera, required)));
        return idle + &lines.collect::<String>();
    }
    let units = answer.rule.scenario.units();
    let mut out = idle;
    for (index, camera) in answer.cameras.iter().enumerate() {
        let met = match camera.verdict {
            Verdict::Meets => conditions::yes_alone(&camera.conditions),
            Verdict::Undecided => "undecided".into(),
            Verdict::Fails => "not met".into(),
        };
        let _ = writeln!(out, "{}: {met} ({})", camera.name, camera.grade.name());
        for clause in &answer.clauses {
            let said = match &clause.found {
                Found::Apart(apart) => {
                    apart.cameras.get(index).map(|camera| line(camera, apart.requirement.distance))
                }
                Found::Measured(measured) => {
                    measured.cameras.get(index).map(|camera| measured_line(camera, measured.quantity, units))
                }
            };
            let name = clause.name.as_deref().unwrap_or("the rule");
            let _ = writeln!(out, "  {name}: {}", said.unwrap_or_default());
        }
    }
    out
}

/// How sure a 'yes' is where its conditions hold, and the hardest of them.
fn sure(conditions: &[Condition], evidence: Grade) -> String {
    match Condition::open(conditions).next() {
        None => evidence.name().to_owned(),
        Some(_) => format!("{}: {}", conditions::yes_alone(conditions), evidence.name()),
    }
}

fn measured_line(camera: &MeasuredVerdict, quantity: Measure, units: Units) -> String {
    let value = camera.value.map_or_else(|| "no bound".into(), |value| significant(value, 3));
    let value = format!("{} {value}", measure(quantity));
    let reached = format!("{} times the demand ({value})", at_least(camera.margin));
    let at = measured_scene(&camera.limiting, units);
    match camera.passes {
        true => match &camera.uncertainty {
            None => format!("{}: {reached}, {at}", sure(&camera.conditions, camera.evidence)),
            Some(found) => {
                let (low, guarded) = (at_least(found.low), guarded(camera.uncertainty.as_ref()));
                let grade = sure(&camera.conditions, camera.evidence);
                format!(
                    "{grade}: at least {low} times the demand{guarded} ({value} as they are stated), {at}"
                )
            }
        },
        false if camera.verdict == Verdict::Undecided => {
            format!("{}: {reached}, {at}", undecided(&camera.undecided_by, camera.uncertainty.as_ref()))
        }
        false => format!("not met: {}: {reached}, {at}", in_words(&camera.fails_by)),
    }
}

fn line(camera: &CameraVerdict, required: f64) -> String {
    let times = |distance: f64| format!("{} times the demand", at_least(distance / required));
    let said = if camera.verdict == Verdict::Undecided {
        undecided(&camera.undecided_by, camera.uncertainty.as_ref())
    } else if camera.passes {
        let low = camera.uncertainty.as_ref().map_or(camera.margin, |found| found.low);
        let guarded = guarded(camera.uncertainty.as_ref());
        match camera.lower_bound {
            Some(bound) if bound >= required => {
                format!(
                    "{}: at least {} everywhere{guarded}",
                    sure(&camera.conditions, camera.evidence),
                    times(bound)
                )
            }
            _ => {
                let least = times(low * required);
                let met = conditions::yes_alone(&camera.conditions);
                format!("{met}, but searched and not proved: {least} where it is least{guarded}")
            }
        }
    } else {
        let short = camera.fails_by.contains(&Shortfall::Distance) && camera.margin > 0.0;
        let margin = format!("{} times the demand: ", significant(camera.margin, 3));
        format!("not met: {}{}", if short { margin.as_str() } else { "" }, fails_by(camera))
    };
    said + &without_placeholders(camera)
}

/// Three digits, none of them rounded up: what is promised is kept.
fn at_least(ratio: f64) -> String {
    let digits = significant(ratio, 3);
    match digits.parse::<f64>() {
        Ok(shown) if shown > ratio => {
            significant(ratio - 0.5 * 10f64.powf(ratio.abs().log10().floor() - 2.0), 3)
        }
        _ => digits,
    }
}

#[cfg(test)]
mod tests {
    use super::at_least;

    #[test]
    fn what_is_promised_is_not_rounded_up() {
        let cases = [
            (1.6289, "1.62"),
            (1.0009, "1.00"),
            (2.0, "2.00"),
            (9.999, "9.99"),
            (123.9, "123"),
            (0.99999, "0.999"),
        ];
        for (ratio, shown) in cases {
            assert_eq!(at_least(ratio), shown);
        }
    }
}
