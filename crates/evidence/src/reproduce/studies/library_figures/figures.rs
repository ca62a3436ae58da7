//! What comes out, beside an independent calculation with another choice of random pairs.

use super::pairs::{Decided, Pair};
use crate::reproduce::studies::page::root_mean_square;
use hadar::error::Result;
use hadar::identifiability::detection;
use hadar_report::table::Table;
use hadar_simulate::sequential::Interval;

/// Off by more than this counts.
const OFF: f64 = 0.02;

/// A figure of an independent calculation beside ours.
pub(super) struct Figure {
    pub(super) what: &'static str,
    pub(super) expected: &'static str,
    pub(super) found: String,
    pub(super) verdict: &'static str,
}

fn agrees(interval: Interval, expected: f64) -> &'static str {
    let inside = (interval.low..=interval.high).contains(&expected);
    if inside { "agrees" } else { "differs by more than chance" }
}

fn share(what: &'static str, printed: &'static str, expected: f64, hits: usize, of: usize) -> Figure {
    let interval = Interval::wilson(hits as f64, of as u64, 0.95);
    Figure {
        what,
        expected: printed,
        found: format!(
            "{:.0} % (95 %: {:.0} to {:.0} %)",
            100.0 * hits as f64 / of as f64,
            100.0 * interval.low,
            100.0 * interval.high
        ),
        verdict: agrees(interval, expected),
    }
}

/// Shares over all pairs: nothing is random in them.
pub(super) fn distance_figures(pairs: &[Pair]) -> Vec<Figure> {
    let count = |limit: f64| pairs.iter().filter(|p| p.ratio().max(1.0 / p.ratio()) > limit).count();
    let figure = |what, printed, expected: f64, limit: f64| {
        let found = 100.0 * count(limit) as f64 / pairs.len() as f64;
        Figure {
            what,
            expected: printed,
            found: format!("{found:.1} % ({} of {})", count(limit), pairs.len()),
            verdict: if (found - expected).abs() < 1.0 { "agrees" } else { "differs" },
        }
    };
    vec![
        figure("pairs whose local distance is off by more than a factor 2", "38 %", 38.0, 2.0),
        figure("pairs whose photon number is off by more than a factor 10", "22 %", 22.0, 10f64.sqrt()),
    ]
}

/// Shares and errors over the simulated pairs.
pub(super) fn decision_figures(decided: &[Decided]) -> Vec<Figure> {
    let n = decided.len();
    let limit = detection::probability(1.0);
    let off =
        |pick: fn(&Decided) -> f64| -> Vec<f64> { decided.iter().map(|d| pick(d) - d.probability).collect() };
    let (local, two_sided) = (off(Decided::promised), off(Decided::two_sided));
    let count = |errors: &[f64], hit: fn(f64) -> bool| errors.iter().filter(|e| hit(**e)).count();
    let rms = |what, printed, expected: f64, errors: &[f64]| {
        let (value, interval) = root_mean_square(errors);
        Figure {
            what,
            expected: printed,
            found: format!("{value:.3} (95 %: {:.3} to {:.3})", interval.low, interval.high),
            verdict: agrees(interval, expected),
        }
    };
    let near = decided.iter().filter(|d| (d.probability - limit).abs() < OFF).count();
    let mut figures = vec![
        share("beats the local 'limit' by more than 0.02", "55 %", 0.55, count(&local, |e| e < -OFF), n),
        share("falls short of it by more than 0.02", "37 %", 0.37, count(&local, |e| e > OFF), n),
        rms("rms error of the local distance", "0.146", 0.146, &local),
    ];
    if let Some(best) = decided.iter().max_by(|a, b| a.probability.total_cmp(&b.probability)) {
        let reach = best.interval.half_width();
        let same = (best.probability - 0.8435).abs() <= reach.hypot(0.007);
        figures.push(Figure {
            what: "largest share of correct decisions (limit Φ(1) = 0.8413)",
            expected: "0.8435 ± 0.007",
            found: format!("{:.4} ± {reach:.4}", best.probability),
            verdict: if same { "agrees" } else { "differs by more than chance" },
        });
    }
    figures.push(share("within 0.02 of the limit", "53 %", 0.53, near, n));
    figures.push(rms("rms error of the two-sided estimate", "0.034", 0.034, &two_sided));
    figures
}

/// All of them.
pub(super) fn figures_csv(figures: &[Figure]) -> Result<String> {
    let mut table = Table::new(["figure", "expected", "found", "verdict"]);
    for figure in figures {
        let cells = [figure.what, figure.expected, figure.found.as_str(), figure.verdict];
        table.push(cells.map(str::to_owned).to_vec());
    }
    table.to_csv()
}
