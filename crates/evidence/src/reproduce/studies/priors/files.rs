//! Tables and plots of the photons.

use super::photons::{AMBIENT_CELSIUS, Photons, Rows};
use hadar_report::figures::Plot;
use hadar_report::plot::{Axis, LineFigure, Rule, Series, Style};
use hadar_report::table::Table;

const HEADER: [&str; 5] = [
    "photons_without_prior_nearest",
    "photons_without_prior_local",
    "photons_hybrid_bound",
    "photons_average_lower",
    "photons_average_upper",
];

fn table(first: &[&str], rows: &Rows) -> Table {
    let mut table = Table::new(first.iter().chain(&HEADER).copied());
    for (keys, photons) in rows {
        let found = photons.all().map(|n| n.map_or_else(|| "infinite".into(), |n| format!("{n:.3e}")));
        table.push(keys.iter().map(|key| format!("{key:.4}")).chain(found).collect());
    }
    table
}

fn column(rows: &Rows, pick: fn(&Photons) -> Option<f64>) -> Vec<f64> {
    rows.iter().map(|(_, photons)| pick(photons).unwrap_or(f64::NAN)).collect()
}

/// Photons against the target's temperature at one lighting.
pub(super) fn temperatures(name: &'static str, lighting: f64, most: f64, rows: &Rows) -> Plot {
    let x: Vec<f64> = rows.iter().map(|(keys, _)| keys[0]).collect();
    let line = |label: &str, pick| Series::line(label, x.clone(), column(rows, pick));
    let figure = LineFigure::new(
        format!("Photons required to distinguish skin from aluminium, V = {lighting}"),
        Axis::linear("target temperature (°C)"),
        Axis::log("photons required").range(1e2, most),
    )
    .subtitle("Surroundings at 20 °C, 536 bands, temperature (± 2 K) and lighting (± 0.1) unknown; for Φ(1) = 84.1 % right.")
    .series(line("no prior, nearest distance", |n| n.nearest).colour(0))
    .series(line("no prior, local distance", |n| n.local).style(Style::Dashed).colour(0))
    .series(line("priors, average: enough", |n| n.average_upper).colour(1))
    .series(line("priors, average: not enough", |n| n.average_lower).style(Style::Dashed).colour(1))
    .series(
        line("priors, hybrid bound (of estimates, not of decisions)", |n| n.bound)
            .style(Style::Dashed)
            .colour(2),
    )
    .rule(Rule::vertical(AMBIENT_CELSIUS, "equal temperatures"));
    Plot { name: name.into(), figure: figure.into(), table: table(&["target_celsius", "lighting"], rows) }
}

/// Photons at equilibrium against the width of the prior.
pub(super) fn widths(rows: &Rows) -> Plot {
    let x: Vec<f64> = rows.iter().map(|(keys, _)| keys[0]).collect();
    let line = |label: &str, pick| Series::line(label, x.clone(), column(rows, pick));
    let bound = column(rows, |n| n.bound);
    // Anchored at the narrowest prior.
    let slope: Vec<f64> = match (x.first(), bound.first()) {
        (Some(x0), Some(n0)) => x.iter().map(|x| 2.0 * n0 * (x0 / x).powi(2)).collect(),
        _ => Vec::new(),
    };
    let figure = LineFigure::new(
        "At equilibrium the prior alone decides",
        Axis::log("deviation of the prior on the temperature (K)"),
        Axis::log("photons required"),
    )
    .subtitle(
        "Target and surroundings at 20 °C, V = 1 and known; without a prior no number of photons suffices.",
    )
    .series(line("average: enough", |n| n.average_upper).colour(1))
    .series(line("average: not enough", |n| n.average_lower).style(Style::Dashed).colour(1))
    .series(line("hybrid bound (of estimates, not of decisions)", |n| n.bound).style(Style::Dashed).colour(2))
    .series(Series::line("slope −2", x.clone(), slope).style(Style::Dotted).colour(6));
    Plot { name: "prior_width".into(), figure: figure.into(), table: table(&["prior_k"], rows) }
}
