//! Tables and plots.

use super::decided::{Estimate, Line};
use super::three_bands::LatticeLine;
use crate::reproduce::studies::page::bars;
use hadar::error::Result;
use hadar::identifiability::detection;
use hadar_report::figures::Plot;
use hadar_report::plot::{Axis, LineFigure, Series, Style};
use hadar_report::table::Table;

pub(super) fn csv(lines: &[Line]) -> Result<String> {
    let mut table = Table::new([
        "target",
        "alternative",
        "target_celsius",
        "statistics",
        "photons",
        "local_distance",
        "local_distance_unknown_gain",
        "nearest_distance",
        "return_ratio",
        "nearest_state_celsius",
        "nearest_state_lighting",
        "probability_local",
        "probability_limit_nearest",
        "probability_two_sided_estimate",
        "probability_best_fits",
        "best_fits_low",
        "best_fits_high",
        "best_fits_target_true",
        "best_fits_alternative_true",
        "probability_known_states",
        "known_states_low",
        "known_states_high",
        "bracket_low",
        "bracket_high",
        "verdict",
    ]);
    for line in lines {
        let p = |value: f64| format!("{value:.4}");
        let lighting = line.nearest_state.lighting.first().copied().unwrap_or(0.0);
        table.push(vec![
            line.names[0].into(),
            line.names[1].into(),
            format!("{}", line.celsius),
            line.law.into(),
            format!("{:.3e}", line.photons),
            p(line.local),
            if line.law == "poisson" { p(line.unknown_gain) } else { String::new() },
            p(line.nearest),
            p(line.return_ratio),
            format!("{:.2}", line.nearest_state.temperature_k - 273.15),
            format!("{lighting:.3}"),
            p(line.promised()),
            p(line.limit()),
            p(line.two_sided()),
            p(line.fitted.value),
            p(line.fitted.low),
            p(line.fitted.high),
            p(line.classes[0]),
            p(line.classes[1]),
            p(line.known.value),
            p(line.known.low),
            p(line.known.high),
            p(line.bracket[0]),
            p(line.bracket[1]),
            line.verdict().into(),
        ]);
    }
    table.to_csv()
}

pub(super) fn lattice_csv(lines: &[LatticeLine]) -> Result<String> {
    let mut table = Table::new([
        "target",
        "alternative",
        "photons",
        "probability_local",
        "lattice_target_true",
        "lattice_alternative_true",
        "lattice_mean",
        "lattice_mesh_change",
        "drawn_target_true",
        "drawn_alternative_true",
        "drawn_mean",
        "drawn_mean_low",
        "drawn_mean_high",
    ]);
    for line in lines {
        let p = |value: f64| format!("{value:.4}");
        table.push(vec![
            line.names[0].into(),
            line.names[1].into(),
            format!("{:.0}", line.photons),
            p(line.promised),
            p(line.lattice[0]),
            p(line.lattice[1]),
            p(0.5 * (line.lattice[0] + line.lattice[1])),
            p(line.mesh_change),
            p(line.classes[0].value),
            p(line.classes[1].value),
            p(line.mean.value),
            p(line.mean.low),
            p(line.mean.high),
        ]);
    }
    table.to_csv()
}

/// What the test of best fits achieves against the distances.
pub(super) fn against_distances(lines: &[Line]) -> Plot {
    let mut table = Table::new([
        "local_distance",
        "nearest_distance",
        "probability_best_fits",
        "best_fits_low",
        "best_fits_high",
    ]);
    for line in lines {
        table.push_numbers(&[line.local, line.nearest, line.fitted.value, line.fitted.low, line.fitted.high]);
    }
    let of = |pick: fn(&Line) -> f64| lines.iter().map(pick).collect::<Vec<f64>>();
    let (p, low, high) = (of(|l| l.fitted.value), of(|l| l.fitted.low), of(|l| l.fitted.high));
    let curve: Vec<f64> = (0..=200).map(|i| 10f64.powf(-2.0 + 3.5 * f64::from(i) / 200.0)).collect();
    let phi = curve.iter().map(|&d| detection::probability(d)).collect();
    let figure = LineFigure::new(
        "What a test achieves, against what the distances promise",
        Axis::log("statistical distance √N·d₀").range(0.01, 30.0),
        Axis::linear("correct decisions").range(0.45, 1.02),
    )
    .subtitle(
        "Every pair twice: at its nearest and at its local distance. Test of best fits, temperature and \
         lighting unknown; bars are 95 % intervals.",
    )
    .series(Series::line("Φ(√N·d₀)", curve, phi).colour(6))
    .series(bars("", &of(|l| l.local), &low, &high).colour(1))
    .series(bars("", &of(|l| l.nearest), &low, &high).colour(0))
    .series(Series::points("at the local distance", of(|l| l.local), p.clone()).colour(1))
    .series(Series::points("at the nearest distance", of(|l| l.nearest), p).colour(0));
    Plot { name: "against_distances".into(), figure: figure.into(), table }
}

/// What the test achieves against the estimates of it.
pub(super) fn against_estimates(lines: &[Line]) -> Plot {
    let mut table = Table::new([
        "probability_local",
        "probability_limit_nearest",
        "probability_two_sided_estimate",
        "probability_best_fits",
        "best_fits_low",
        "best_fits_high",
    ]);
    for line in lines {
        let Estimate { value, low, high } = line.fitted;
        table.push_numbers(&[line.promised(), line.limit(), line.two_sided(), value, low, high]);
    }
    let of = |pick: fn(&Line) -> f64| lines.iter().map(pick).collect::<Vec<f64>>();
    let (p, low, high) = (of(|l| l.fitted.value), of(|l| l.fitted.low), of(|l| l.fitted.high));
    let figure = LineFigure::new(
        "The two-sided estimate follows the test, the local distance does not",
        Axis::linear("predicted share of correct decisions").range(0.48, 1.02),
        Axis::linear("simulated share of correct decisions").range(0.48, 1.02),
    )
    .subtitle("All pairs at nearest distances √N·d₀ of 0.5, 1 and 2; bars are 95 % intervals.")
    .series(
        Series::line("simulated = predicted", vec![0.5, 1.0], vec![0.5, 1.0]).style(Style::Dashed).colour(6),
    )
    .series(bars("", &of(Line::promised), &low, &high).colour(1))
    .series(bars("", &of(Line::two_sided), &low, &high).colour(2))
    .series(Series::points("local distance", of(Line::promised), p.clone()).colour(1))
    .series(Series::points("two-sided estimate", of(Line::two_sided), p).colour(2));
    Plot { name: "against_estimates".into(), figure: figure.into(), table }
}
