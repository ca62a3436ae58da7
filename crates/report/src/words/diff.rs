//! A difference in words.

use crate::diff::{Changed, Curve, Difference, Moved, Warned, plain};
use crate::text::significant;
use serde_json::Value;
use std::fmt::Write as _;

/// Digits of figures, and figures that are listed.
const DIGITS: usize = 6;
const LISTED: usize = 40;

/// What differs, as it is printed.
#[must_use]
pub fn text(found: &Difference) -> String {
    if found.same {
        return format!(
            "Same: what was asked, the verdict, all of {} figures, all warnings.\n",
            found.compared
        );
    }
    let within = found.figures.iter().filter(|moved| moved.within_error == Some(true)).count();
    let beyond = found.figures.iter().filter(|moved| moved.within_error == Some(false)).count();
    let mut out = format!(
        "Different: {}; {} keys and {} files of the question differ; {} of {} figures moved ({within} within their stated errors, \
         {beyond} beyond them), {} curves; {} warnings came, {} went.\n",
        if found.verdict_changed { "the verdict is another one" } else { "the verdict is the same" },
        found.question.len(),
        found.inputs.len(),
        found.figures.len(),
        found.compared,
        found.curves.len(),
        found.warnings_came.len(),
        found.warnings_went.len(),
    );
    if let Some(verdict) = &found.verdict {
        let side = |text: &Option<String>| text.clone().unwrap_or_default();
        let _ = write!(out, "\nVerdict\n  {}\n  {}\n", side(&verdict.before), side(&verdict.after));
    }
    let rests_on = |sign: char, all: &[String]| -> Vec<String> {
        all.iter().map(|one| format!("{sign} {one}")).collect()
    };
    let mut conditions = rests_on('+', &found.conditions_came);
    conditions.extend(rests_on('-', &found.conditions_went));
    section(&mut out, "What a yes rests on that came (+) and went (-)", conditions);
    section(&mut out, "What was asked", found.question.iter().map(changed).collect());
    section(
        &mut out,
        "Files that were read",
        found.inputs.iter().map(|one| hashed(one, "content")).collect(),
    );
    let mut figures: Vec<String> = found.figures.iter().take(LISTED).map(moved).collect();
    if found.figures.len() > LISTED {
        figures.push(format!("and {} more, see --json", found.figures.len() - LISTED));
    }
    section(&mut out, "Figures", figures);
    section(&mut out, "Curves", found.curves.iter().map(curve).collect());
    let warned = |sign: char| move |one: &Warned| format!("{sign} [{}] {}", one.code, one.message);
    let mut warnings: Vec<String> = found.warnings_came.iter().map(warned('+')).collect();
    warnings.extend(found.warnings_went.iter().map(warned('-')));
    warnings.extend(found.warnings_changed.iter().map(|code| format!("  [{code}] says something else")));
    section(&mut out, "Warnings that came (+) and went (-)", warnings);
    section(&mut out, "Other files", found.files.iter().map(|one| hashed(one, "content")).collect());
    let made: Vec<String> = found.made_by.iter().map(|made| made.join(": ")).collect();
    section(&mut out, "Made by", made);
    out
}

fn section(out: &mut String, title: &str, lines: Vec<String>) {
    if !lines.is_empty() {
        let _ = writeln!(out, "\n{title}");
        lines.iter().for_each(|line| {
            let _ = writeln!(out, "  {line}");
        });
    }
}

fn changed(one: &Changed) -> String {
    let side = |text: &Option<String>| text.clone().unwrap_or_else(|| "-".into());
    format!("{}: {} -> {}", one.key, side(&one.before), side(&one.after))
}

fn hashed(one: &Changed, what: &str) -> String {
    match (&one.before, &one.after) {
        (None, _) => format!("{}: only the second has it", one.key),
        (_, None) => format!("{}: only the first has it", one.key),
        _ => format!("{}: of another {what}", one.key),
    }
}

fn moved(one: &Moved) -> String {
    let side = |value: &Option<Value>| match value {
        None => "-".to_owned(),
        Some(value) if value.is_f64() => significant(value.as_f64().unwrap_or(f64::NAN), DIGITS),
        Some(value) => plain(value),
    };
    let change = one.relative_change.map_or_else(String::new, |change| format!("  {}", percent(change)));
    let error = match one.within_error {
        None => "",
        Some(true) => "  within its error",
        Some(false) => "  beyond its error",
    };
    format!("{}: {} -> {}{change}{error}", one.figure, side(&one.before), side(&one.after))
}

fn curve(one: &Curve) -> String {
    let largest = one
        .largest_relative_change
        .map_or_else(String::new, |change| format!(", at most by {}", percent(change)));
    format!("{}: {} of {} values{largest}", one.curve, one.moved, one.values)
}

fn percent(share: f64) -> String {
    let sign = if share > 0.0 { "+" } else { "" };
    format!("{sign}{} %", significant(100.0 * share, 3))
}
