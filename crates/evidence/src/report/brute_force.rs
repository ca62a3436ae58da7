//! Nearest distances against the brute force: a line for every set of unknowns, and what to repeat where something is wrong.

use crate::accuracy::brute_force::{BruteForceReport, SetReport};
use hadar::words::{quantity, significant};
use hadar_report::table::{Table, markdown, number};

/// The answer in a sentence, and a line for every set.
#[must_use]
pub fn brute_force_text(report: &BruteForceReport) -> String {
    let sum = |of: fn(&SetReport) -> u64| -> u64 { report.sets.iter().map(of).sum() };
    let scenes = sum(|set| set.cases);
    let mut text = match report.failures {
        0 => format!("No false statement in {scenes} scenes of seed {}", report.seed),
        failures => format!("{failures} of {scenes} scenes of seed {} say what is false", report.seed),
    };
    text.push_str(&format!(
        ": {} lower bounds above the brute force, {} distances above it by more than is to be proved ({} by more than 1 %); \
         {} of {} proved, {} with no bound at all. The brute force itself ended above the answer in {}\n\n",
        sum(|set| set.lower_above),
        sum(|set| set.above),
        sum(|set| set.far_above),
        sum(|set| set.proved),
        scenes - sum(|set| set.vanishing),
        sum(|set| set.unproved),
        sum(|set| set.missed),
    ));
    let head = [
        "unknown",
        "scenes",
        "no distance at all",
        "bounds above",
        "distances above",
        "by over 1 %",
        "largest excess (scene)",
        "proved",
        "no bound",
        "error too small",
        "no error told",
        "time (longest)",
        "brute force",
        "brute force above (scene)",
    ];
    let row = |set: &SetReport| {
        let mut cells = vec![set.unknown.clone()];
        let counts = [set.cases, set.vanishing, set.lower_above, set.above, set.far_above];
        cells.extend(counts.map(|count| count.to_string()));
        let worst = (set.above > 0).then_some(set.worst_case);
        cells.push(of_case(significant(set.worst_excess, 2), worst));
        let counts = [set.proved, set.unproved, set.error_wrong, set.error_untold];
        cells.extend(counts.map(|count| count.to_string()));
        let [mean, longest] = [set.mean_solver_s, set.longest_solver_s].map(|s| quantity(s, "s"));
        cells.extend([format!("{mean} ({longest})"), quantity(set.mean_brute_force_s, "s")]);
        cells.push(of_case(set.missed.to_string(), set.missed_case));
        cells
    };
    text.push_str(&markdown(&head, report.sets.iter().map(row)));
    for failure in report.sets.iter().flat_map(|set| &set.first_failures) {
        text.push_str(&format!("\nscene {} of seed {}: {}", failure.case, report.seed, failure.what));
    }
    if report.failures > 0 {
        text.push_str(&format!(
            "\n\none scene again: hadar accuracy brute-force --seed {} --scene <number>\n",
            report.seed
        ));
    }
    text
}

fn of_case(value: String, case: Option<u64>) -> String {
    case.map_or_else(|| "-".into(), |case| format!("{value} ({case})"))
}

/// The same as numbers.
#[must_use]
pub fn brute_force_table(report: &BruteForceReport) -> Table {
    let mut table = Table::new([
        "unknown",
        "scenes",
        "failures",
        "no_distance",
        "lower_above",
        "above",
        "above_1_percent",
        "worst_excess",
        "worst_scene",
        "proved",
        "unproved",
        "error_wrong",
        "error_untold",
        "mean_solver_s",
        "longest_solver_s",
        "mean_brute_force_s",
        "brute_force_above",
    ]);
    for set in &report.sets {
        let mut row = vec![set.unknown.clone()];
        let counts = [set.cases, set.failures, set.vanishing, set.lower_above, set.above, set.far_above];
        row.extend(counts.map(|count| count.to_string()));
        row.extend([number(set.worst_excess), set.worst_case.to_string()]);
        let counts = [set.proved, set.unproved, set.error_wrong, set.error_untold];
        row.extend(counts.map(|count| count.to_string()));
        row.extend([set.mean_solver_s, set.longest_solver_s, set.mean_brute_force_s].map(number));
        row.push(set.missed.to_string());
        table.push(row);
    }
    table
}
