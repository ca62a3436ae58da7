//! Tables and plots.

use super::pairs::{Decided, Pair};
use crate::reproduce::studies::page::bars;
use hadar::error::Result;
use hadar::identifiability::detection;
use hadar_report::figures::Plot;
use hadar_report::plot::{Axis, LineFigure, Rule, Series, Style};
use hadar_report::table::Table;

/// All distances.
pub(super) fn pairs_csv(pairs: &[Pair]) -> Result<String> {
    let mut table = Table::new([
        "target",
        "alternative",
        "local_per_sqrt_photon",
        "local_unknown_gain_per_sqrt_photon",
        "nearest_per_sqrt_photon",
        "local_over_nearest",
        "return_over_nearest",
        "nearest_state_celsius",
        "nearest_state_lighting",
    ]);
    for pair in pairs {
        let d = &pair.distances;
        table.push(vec![
            pair.names[0].clone(),
            pair.names[1].clone(),
            format!("{:.3e}", d.local),
            format!("{:.2e}", d.local_unknown_gain),
            format!("{:.3e}", d.nearest),
            format!("{:.3e}", pair.ratio()),
            format!("{:.3}", d.back / d.nearest),
            format!("{:.2}", d.nearest_state.temperature_k - 273.15),
            format!("{:.3}", d.nearest_state.lighting.first().copied().unwrap_or(0.0)),
        ]);
    }
    table.to_csv()
}

/// All simulated pairs.
pub(super) fn decisions_csv(decided: &[Decided]) -> Result<String> {
    let mut table = Table::new([
        "target",
        "alternative",
        "photons",
        "local_distance",
        "probability_local",
        "probability_two_sided_estimate",
        "probability_best_fits",
        "best_fits_low",
        "best_fits_high",
        "probability_known_states",
        "trials",
        "unconverged",
    ]);
    for one in decided {
        let p = |value: f64| format!("{value:.4}");
        table.push(vec![
            one.names[0].clone(),
            one.names[1].clone(),
            format!("{:.3e}", one.photons),
            p(one.local),
            p(one.promised()),
            p(one.two_sided()),
            p(one.probability),
            p(one.interval.low),
            p(one.interval.high),
            p(one.known),
            one.trials.to_string(),
            one.unconverged.to_string(),
        ]);
    }
    table.to_csv()
}

/// Share of the pairs with a ratio below each.
pub(super) fn ratios(pairs: &[Pair]) -> Plot {
    let mut sorted: Vec<f64> = pairs.iter().map(Pair::ratio).collect();
    sorted.sort_by(f64::total_cmp);
    let share: Vec<f64> =
        (1..=sorted.len()).map(|rank| 100.0 * rank as f64 / sorted.len().max(1) as f64).collect();
    let mut table = Table::new(["local_over_nearest", "share_of_pairs_percent"]);
    sorted.iter().zip(&share).for_each(|(ratio, share)| table.push_numbers(&[*ratio, *share]));
    let below = |limit: f64| 100.0 * sorted.partition_point(|r| *r < limit) as f64 / sorted.len() as f64;
    let figure = LineFigure::new(
        "The local distance against the nearest, over a whole library",
        Axis::log("local distance over nearest distance"),
        Axis::linear("pairs with a smaller ratio (%)").range(0.0, 100.0),
    )
    .subtitle(format!(
        "{} ordered pairs, target at 60 °C and V = 0.5, surroundings at 20 °C. Below one half: {:.0} %; above \
         two: {:.0} %.",
        sorted.len(),
        below(0.5),
        100.0 - below(2.0)
    ))
    .series(Series::line("", sorted, share).colour(0))
    .rule(Rule::vertical(0.5, "too small by a factor 2"))
    .rule(Rule::vertical(1.0, "equal"))
    .rule(Rule::vertical(2.0, "too large by a factor 2"));
    Plot { name: "ratios".into(), figure: figure.into(), table }
}

/// Simulated decisions against what the local distance and the two-sided estimate say.
pub(super) fn decisions(decided: &[Decided]) -> Plot {
    let mut table = Table::new([
        "probability_local",
        "probability_two_sided_estimate",
        "probability_best_fits",
        "best_fits_low",
        "best_fits_high",
    ]);
    for one in decided {
        table.push_numbers(&[
            one.promised(),
            one.two_sided(),
            one.probability,
            one.interval.low,
            one.interval.high,
        ]);
    }
    let of = |pick: fn(&Decided) -> f64| decided.iter().map(pick).collect::<Vec<f64>>();
    let (p, low, high) = (of(|d| d.probability), of(|d| d.interval.low), of(|d| d.interval.high));
    let figure = LineFigure::new(
        "Simulated decisions against their limits",
        Axis::linear("predicted share of correct decisions").range(0.48, 1.02),
        Axis::linear("simulated share of correct decisions").range(0.70, 0.88),
    )
    .subtitle(format!(
        "{} random pairs, each with the photons at which the nearest distance is 1; bars are 95 % intervals.",
        decided.len()
    ))
    .series(
        Series::line("simulated = predicted", vec![0.70, 0.88], vec![0.70, 0.88])
            .style(Style::Dashed)
            .colour(6),
    )
    .series(bars("", &of(Decided::promised), &low, &high).colour(1))
    .series(bars("", &of(Decided::two_sided), &low, &high).colour(2))
    .series(Series::points("by the local distance", of(Decided::promised), p.clone()).colour(1))
    .series(Series::points("by the two-sided estimate", of(Decided::two_sided), p).colour(2))
    .rule(Rule::horizontal(detection::probability(1.0), "limit Φ(1) of the nearest distance"));
    Plot { name: "decisions".into(), figure: figure.into(), table }
}
