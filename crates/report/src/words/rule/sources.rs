//! Where the figures of a rule are from, and what its tests say, as text.

use super::text::idle;
use crate::text::significant;
use hadar::instrument::presets;
use hadar_scenario::Rule;
use hadar_scenario::rule::{Figure, Ground};
use hadar_study::{NotInForce, RuleAnswer, TestResult, Told};
use std::fmt::Write as _;

/// Every figure below what stands behind it.
#[must_use]
pub fn sources(rule: &Rule) -> String {
    let figures = rule.figures();
    let name = rule.about.name.as_deref().unwrap_or("This rule");
    let of_cameras: Vec<Figure> =
        (0..rule.cameras.len()).flat_map(|index| rule.camera_figures(index)).collect();
    let documented = figures.iter().filter(|figure| is_documented(rule, &figure.key)).count();
    let mut out = format!(
        "{name}: {} figures, {documented} of documents, {} choices of its author, some of them with a document.\n",
        figures.len(),
        figures.len() - documented
    );
    for line in dates(rule) {
        let _ = writeln!(out, "{line}");
    }
    for citation in &rule.sources {
        out.push('\n');
        match &citation.ground {
            Ground::Document { document, clause, quote, date, mark } => {
                let _ = writeln!(out, "{document}, {clause} ({date}, {})\n  \"{quote}\"", mark.name());
            }
            Ground::Choice(reason) => {
                let _ = writeln!(out, "Choice: {reason}");
            }
        }
        let own = figures.iter().chain(&of_cameras).filter(|figure| citation.covers(&figure.key));
        for Figure { key, value, line, .. } in own {
            let _ = writeln!(out, "  line {line}: {key} = {value}");
        }
    }
    out
}

/// Whether documents alone stand behind a figure.
pub(super) fn is_documented(rule: &Rule, key: &str) -> bool {
    let grounds: Vec<&Ground> = rule.behind(key).collect();
    !grounds.is_empty() && grounds.iter().all(|ground| matches!(ground, Ground::Document { .. }))
}

/// What stands behind something, in a phrase.
pub(super) fn from_where(ground: &Ground) -> String {
    match ground {
        Ground::Document { document, clause, quote, date, mark } => {
            format!("\u{201c}{quote}\u{201d}, {document}, {clause} ({date}, {})", mark.name())
        }
        Ground::Choice(reason) => format!("a choice: {reason}"),
    }
}

const NOBODY: &str = "nobody says from where";

/// Every number of the rule with what stands behind it.
pub(super) fn numbers_of(rule: &Rule) -> Vec<[String; 3]> {
    let named = |figure: Figure| [figure.key.clone(), figure.value, behind(rule, &figure.key)];
    rule.figures().into_iter().map(named).collect()
}

/// What stands behind a figure.
fn behind(rule: &Rule, key: &str) -> String {
    let said: Vec<String> = rule.behind(key).map(from_where).collect();
    if said.is_empty() { NOBODY.to_owned() } else { said.join("; ") }
}

/// Every figure of the cameras that the rule states, and the known cameras that stand behind the others.
pub(super) fn figures_of_cameras(answer: &RuleAnswer) -> Vec<[String; 4]> {
    let rule = &answer.rule;
    let mut rows = Vec::new();
    for (index, (camera, own)) in answer.cameras.iter().zip(&rule.cameras).enumerate() {
        if let Some(preset) = &own.spec.preset {
            let own = rule.own_document(index).map(|named| named.map(str::to_owned));
            let known = || {
                let known = presets::find(preset).ok()?;
                known.document.as_ref().or(known.provenance.first()).cloned()
            };
            let from = own.unwrap_or_else(known).unwrap_or_else(|| behind(rule, &rule.cameras[index].key));
            rows.push([camera.name.clone(), "preset".into(), preset.clone(), from]);
        }
        for figure in rule.camera_figures(index) {
            let key = figure.key.split_once('.').map_or(figure.key.as_str(), |(_, key)| key).to_owned();
            rows.push([camera.name.clone(), key, figure.value, behind(rule, &figure.key)]);
        }
    }
    rows
}

/// Whose the rule is and when it holds, a line each.
pub(super) fn dates(rule: &Rule) -> Vec<String> {
    let about = &rule.about;
    let mut lines = Vec::new();
    lines.extend(about.status.as_ref().map(|status| format!("Status: {status}")));
    match (about.from, about.until) {
        (Some(from), Some(until)) => lines.push(format!("Holds: from {from} until {until}")),
        (Some(from), None) => lines.push(format!("Holds: from {from}")),
        (None, Some(until)) => lines.push(format!("Holds: until {until}")),
        (None, None) => {}
    }
    lines
}

/// A line a test, and what was found instead.
#[must_use]
pub fn tests(results: &[TestResult], of_idle: Option<NotInForce>) -> String {
    let failed = results.iter().filter(|result| !result.passes).count();
    let mut out = idle(of_idle);
    let _ = match failed {
        0 => writeln!(out, "All {} tests of the rule hold.", results.len()),
        failed => writeln!(out, "{failed} of {} tests of the rule do not hold.", results.len()),
    };
    for result in results {
        let clause = result.clause.as_ref().map_or_else(String::new, |name| format!(", {name}"));
        let holds = if result.passes { "holds" } else { "does not hold" };
        let checks: Vec<String> = result
            .checks
            .iter()
            .map(|check| {
                let told = |told: Told| match told {
                    Told::Verdict(verdict) => verdict.name().to_owned(),
                    Told::Number(number) if check.what == "frames" => number.to_string(),
                    Told::Number(number) => significant(number, 4),
                };
                let found = check.found.map_or_else(|| "nothing".into(), told);
                match check.passes {
                    true => format!("{} {found}", check.what),
                    false => format!("{} is {found}, not {}", check.what, told(check.expected)),
                }
            })
            .collect();
        let _ = writeln!(out, "  {}{clause}: {holds}: {}", result.camera, checks.join(", "));
    }
    out
}
