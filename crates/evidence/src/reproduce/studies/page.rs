//! Parts of a study's page: tables, intervals in plots, errors.

use hadar_report::plot::Series;
use hadar_report::table::ruled_markdown;
use hadar_simulate::sequential::Interval;

/// A table in Markdown.
pub(super) fn markdown<S: AsRef<str>>(header: &[&str], rows: &[Vec<S>]) -> String {
    ruled_markdown(" --- ", header, rows)
}

/// Upright strokes from `low` to `high`, with gaps between them.
pub(super) fn bars(label: &str, x: &[f64], low: &[f64], high: &[f64]) -> Series {
    let xs = x.iter().flat_map(|&x| [x, x, f64::NAN]).collect();
    let ys = low.iter().zip(high).flat_map(|(&low, &high)| [low, high, f64::NAN]).collect();
    Series::line(label, xs, ys)
}

/// Root mean square with its 95 % interval from the scatter of the squares.
pub(super) fn root_mean_square(errors: &[f64]) -> (f64, Interval) {
    let n = errors.len().max(2) as f64;
    let mean = errors.iter().map(|e| e * e).sum::<f64>() / n;
    let var = errors.iter().map(|e| (e * e - mean).powi(2)).sum::<f64>() / (n - 1.0);
    let reach = 1.96 * (var / n).sqrt();
    (mean.sqrt(), Interval { low: (mean - reach).max(0.0).sqrt(), high: (mean + reach).sqrt() })
}
