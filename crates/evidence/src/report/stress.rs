//! The stress suite: text, the distribution of digits kept, and digits over the distance from equilibrium.

use crate::accuracy::stress::{FamilyReport, Point, StressReport};
use hadar::words::significant;
use hadar_report::figures::Plot;
use hadar_report::plot::{Axis, LineFigure, Series};
use hadar_report::table::{Table, markdown, number, optional};

/// Points that a picture can show apart.
const DRAWN: usize = 600;

/// The answer in a sentence, and a line for every family.
#[must_use]
pub fn stress_text(report: &StressReport) -> String {
    let comparisons: u64 = report.families.iter().map(|family| family.comparisons).sum();
    let mut text = match report.failures {
        0 => format!(
            "No failure in {} cases: no panic, no undeclared NaN, every status right, all {comparisons} relative errors within the estimate that came with the answer\n\n",
            report.cases
        ),
        failures => format!("{failures} of {} cases fail\n\n", report.cases),
    };
    let head = [
        "stress",
        "cases",
        "comparisons",
        "failures",
        "worst error / estimate",
        "median estimate / error",
        "at least 12 digits kept",
    ];
    let row = |family: &FamilyReport| {
        let median = family.median_overestimation;
        [
            family.stresses.to_string(),
            family.cases.to_string(),
            family.comparisons.to_string(),
            family.failures.to_string(),
            significant(family.worst_ratio, 2),
            median.map_or_else(|| "-".into(), |factor| significant(factor, 2)),
            hadar::words::share(with_digits(family, 12)),
        ]
    };
    text.push_str(&markdown(&head, report.families.iter().map(row)));
    for family in report.families.iter().filter(|family| family.failures > 0) {
        for failure in &family.first_failures {
            text.push_str(&format!("\ncase {} of seed {}: {}", failure.case, report.seed, failure.what));
        }
        text.push('\n');
    }
    text
}

/// Share of the comparisons that keep so many digits or more.
fn with_digits(family: &FamilyReport, digits: usize) -> f64 {
    let kept: u64 = family.digits_kept.iter().skip(digits).sum();
    if family.comparisons == 0 { 1.0 } else { kept as f64 / family.comparisons as f64 }
}

/// How many digits answers keep, and how far from equilibrium which differences keep them.
#[must_use]
pub fn stress_plots(report: &StressReport) -> Vec<Plot> {
    vec![digits_kept(report), over_equilibrium(report)]
}

/// Share of the comparisons with fewer than so many digits: as they are, and as the estimates promise.
fn digits_kept(report: &StressReport) -> Plot {
    let total: u64 = report.families.iter().map(|family| family.comparisons).sum();
    let fewer = |of: fn(&FamilyReport) -> &[u64]| -> Vec<f64> {
        let count = |digits: usize| -> u64 {
            report.families.iter().map(|family| of(family).iter().take(digits).sum::<u64>()).sum()
        };
        (1..=16).map(|digits| count(digits) as f64 / total.max(1) as f64).collect()
    };
    let digits: Vec<f64> = (1..=16).map(f64::from).collect();
    let (kept, promised) = (fewer(|family| &family.digits_kept), fewer(|family| &family.digits_promised));
    let figure = LineFigure::new(
        "Digits that answers keep at extremes",
        Axis::linear("digits"),
        Axis::log("share of the answers with fewer"),
    )
    .subtitle(format!(
        "{} generated cases, {total} comparisons with extended precision. The promise is each answer's own estimate.",
        report.cases
    ))
    .series(Series::line("kept", digits.clone(), kept))
    .series(Series::line("promised", digits, promised));
    let mut table = Table::new(["family", "stresses", "digits", "comparisons_kept", "comparisons_promised"]);
    for family in &report.families {
        let name = serde_json::to_value(family.family).ok();
        let name = name.as_ref().and_then(|name| name.as_str()).unwrap_or_default();
        let pairs = family.digits_kept.iter().zip(&family.digits_promised).enumerate();
        for (digits, (kept, promised)) in pairs {
            let mut row = vec![name.to_owned(), family.stresses.to_owned()];
            row.extend([digits as f64, *kept as f64, *promised as f64].map(number));
            table.push(row);
        }
    }
    Plot { name: "stress_digits".into(), figure: figure.into(), table }
}

/// Digits kept over |T − T₀|/T₀.
fn over_equilibrium(report: &StressReport) -> Plot {
    let shown: Vec<&Point> = {
        let apart: Vec<&Point> = report.points.iter().filter(|point| point.apart > 0.0).collect();
        let step = apart.len().div_ceil(DRAWN).max(1);
        apart.into_iter().step_by(step).collect()
    };
    let series = |label: &str, of: fn(&Point) -> f64| {
        Series::points(
            label,
            shown.iter().map(|point| point.apart).collect(),
            shown.iter().map(|point| of(point)).collect(),
        )
    };
    let figure = LineFigure::new(
        "Digits kept over the distance from thermal equilibrium",
        Axis::log("|T − T₀|/T₀"),
        Axis::linear("digits of the local distance").range(-0.5, 16.5),
    )
    .subtitle(
        "Target at T among surroundings at T₀. Differences: as the crate forms them; subtracted: B(T) − V B(T₀) in doubles, \
         which loses nothing where V is far below 1.",
    )
    .series(series("kept when subtracted", |point| point.digits_naive).colour(1))
    .series(series("claimed by the solver", |point| point.digits_claimed).colour(4))
    .series(series("kept by differences", |point| point.digits).colour(0));
    let mut table =
        Table::new(["case", "relative_distance", "digits", "digits_subtracted", "digits_claimed"]);
    for point in &report.points {
        table.push(vec![
            point.case.to_string(),
            optional(Some(point.apart)),
            number(point.digits),
            number(point.digits_naive),
            number(point.digits_claimed),
        ]);
    }
    Plot { name: "stress_equilibrium".into(), figure: figure.into(), table }
}
