//! Sensitivity of the verdicts to the figures of a rule, in words.

use crate::text::columns::aligned;
use hadar::words::share;
use hadar_study::{FiguresMoved, Moved};
use std::fmt::Write as _;

/// Changes below this are none.
const NOTHING: f64 = 1e-3;

/// On which figures verdicts hang, then every figure by how much of a margin hangs on it.
#[must_use]
pub fn figures_moved(found: &FiguresMoved) -> String {
    let deciding: Vec<&Moved> = found.figures.iter().filter(|one| !one.verdicts.is_empty()).collect();
    let mut keys: Vec<&str> = Vec::new();
    for one in &deciding {
        if !keys.contains(&one.key.as_str()) {
            keys.push(&one.key);
        }
    }
    let mut out = match keys.as_slice() {
        [] => "No verdict changes when any one figure of the rule changes by a tenth.\n".to_owned(),
        keys => {
            format!("Verdicts change when {} changes by a tenth: {}.\n", counted(keys.len()), keys.join(", "))
        }
    };
    for one in &deciding {
        let _ = writeln!(
            out,
            "  {} at {} instead of {}: {}",
            one.key,
            one.moved_to,
            one.value,
            one.verdicts.join("; ")
        );
    }
    out.push('\n');
    let mut rows = vec![
        ["figure", "value", "moved to", "largest change of a margin", "breaks a test"].map(str::to_owned),
    ];
    let moves = |one: &&Moved| one.largest_change.is_some_and(|change| change >= NOTHING);
    for one in found.figures.iter().filter(moves) {
        let test = one
            .breaks_a_test
            .map_or_else(String::new, |breaks| if breaks { "yes".into() } else { "no".into() });
        let change = one.largest_change.map_or_else(|| "-".into(), share);
        rows.push([one.key.clone(), one.value.clone(), one.moved_to.clone(), change, test]);
    }
    out += &aligned(&rows, &[3]);
    let idle: Vec<&Moved> = found.figures.iter().filter(|one| one.refused.is_none() && !moves(one)).collect();
    let mut silent: Vec<&str> = idle
        .iter()
        .map(|one| one.key.as_str())
        .filter(|key| !keys.contains(key) && found.figures.iter().all(|one| one.key != *key || !moves(&one)))
        .collect();
    silent.sort_unstable();
    silent.dedup();
    if !silent.is_empty() {
        let _ = writeln!(out, "\nNo verdict changes with a tenth more or less of: {}", silent.join(", "));
    }
    for one in found.figures.iter().filter(|one| one.refused.is_some()) {
        let why = one.refused.as_deref().unwrap_or_default();
        let _ = writeln!(out, "{} at {}: refused: {why}", one.key, one.moved_to);
    }
    out += "Numbers are changed one at a time by a tenth; a temperature by 3 K; for a probability, its difference from 1 by a tenth.\n";
    out
}

fn counted(count: usize) -> String {
    if count == 1 { "one figure".into() } else { format!("{count} figures") }
}

/// The title of a report about it.
pub(crate) fn title_of_figures(rule: Option<&str>) -> String {
    rule.map_or_else(
        || "Sensitivity of the verdicts to the figures of a rule".into(),
        |rule| format!("{rule}: sensitivity to its figures"),
    )
}
