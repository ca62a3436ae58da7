//! Where the figures of a rule are from, and what its tests say, as text.

use super::text::idle;
use crate::text::significant;
use hadar_scenario::Rule;
use hadar_scenario::rule::{Figure, Ground};
use hadar_study::{NotInForce, TestResult, Told};
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
        "{name}: {} figures, {documented} of documents, {} choices of its author, some beside a document.\n",
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
