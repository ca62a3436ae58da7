//! A library out of a cube, in words.

use crate::shown::Shown;
use crate::text::columns::{Columns, left, right};
use crate::text::cubes::{AGAINST, lighting_total, noise};
use crate::text::footing::{read_as, warnings};
use crate::text::numbers::degrees;
use crate::words::decompose::{exact, shared, surroundings_found};
use crate::words::pictures::thinned;
use hadar::words::{fixed, quantity, share, significant, whole};
use hadar_study::library::{LibraryFound, TruthOfClusters};
use std::fmt::Write as _;

/// The whole answer.
#[must_use]
pub fn text(result: &LibraryFound) -> String {
    let mut out = format!(
        "{}{}\n\n{}",
        sentence(result),
        surroundings_found(&result.surroundings_found),
        read_as(&result.read)
    );
    out.push_str(&clusters(result));
    out.push_str(&counts(result));
    if let Some(truth) = &result.truth {
        out.push_str(&against(truth));
    }
    out.push_str(&shared(result));
    out.push_str(&assumptions(result));
    out.push_str(&warnings(&result.warnings));
    out
}

fn sentence(result: &LibraryFound) -> String {
    let count = result.clusters.len();
    let fit = result.misfits.is_empty();
    let but = if fit { "" } else { " Not all of them explain their pixels: see the warnings." };
    let worst = result.clusters.iter().map(|row| row.cluster.sigma_mean).fold(0.0, f64::max);
    format!(
        "{} emissivit{} found in {} pixels ({} decided), mean emissivities known to +- {} at worst.{but}",
        whole(count as u64),
        if count == 1 { "y" } else { "ies" },
        whole(result.pixels as u64),
        share(result.decided as f64 / result.pixels.max(1) as f64),
        significant(worst, 2)
    )
}

fn clusters(result: &LibraryFound) -> String {
    let width = result.clusters.iter().map(|row| row.name.len()).max().unwrap_or(0).max(8);
    let mut table = Columns::new([
        left("", width),
        right("pixels", 9),
        right("mean emissivity", 16),
        right("median (degC)", 14),
        right("in common (K)", 14),
        right("chi2/nu", 9),
    ]);
    for row in &result.clusters {
        let one = &row.cluster;
        table.row([
            row.name.clone(),
            whole(row.pixels as u64),
            format!("{} +- {}", fixed(row.emissivity_mean, 3), significant(one.sigma_mean, 2)),
            degrees(row.temperature_median_k),
            format!("+- {}", significant(one.sigma_temperature_k, 2)),
            significant(one.chi_square_reduced, 3),
        ]);
    }
    let mut out = format!("Clusters, the most pixels first\n{}", table.text());
    out.push_str(
        "  In common: what all temperatures of a cluster may be off by together, as its emissivity is.\n\n",
    );
    out
}

fn counts(result: &LibraryFound) -> String {
    if result.tried.is_empty() {
        return String::new();
    }
    let mut table = Columns::new([
        right("clusters", 8),
        right("with pixels", 11),
        right("loss", 18),
        right("chi2/nu", 9),
    ]);
    for one in &result.tried {
        table.row([
            one.count.to_string(),
            one.left.to_string(),
            format!("{} +- {}", fixed(one.loss, 2), significant(one.error, 1)),
            significant(one.chi_square_reduced, 3),
        ]);
    }
    let mut out = format!("Counts tried, by their loss on pixels that were kept apart\n{}", table.text());
    out.push_str("  The fewest within a standard error of the least loss are taken; errors are of the difference from it.\n\n");
    out
}

fn against(truth: &TruthOfClusters) -> String {
    let mut out = format!("{AGAINST}\n");
    if let Some(right) = truth.right_material {
        let _ = writeln!(
            out,
            "  pixels of the most frequent material of their cluster: {} %",
            significant(100.0 * right, 4)
        );
    }
    if let Some(rmse) = truth.temperature_rmse_k {
        let median = truth.temperature_median_error_k.unwrap_or(f64::NAN);
        let _ = writeln!(
            out,
            "  temperature error: {} rms, {} median",
            quantity(rmse, "K"),
            quantity(median, "K")
        );
    }
    out.push('\n');
    out
}

/// What unknowns of the whole cube do.
fn shared(result: &LibraryFound) -> String {
    if result.shared.is_empty() {
        return String::new();
    }
    let mut out =
        "Unknown for the whole cube: included in the deviations, since the pixels do not determine it here\n"
            .to_owned();
    for row in &result.shared {
        let share_of = row.stated.unit.is_empty();
        let _ = write!(
            out,
            "  {}, known to {}{}: moves emissivities by {} rms",
            shared::named(row.stated.unknown, row.stated.light, row.stated.order),
            significant(if share_of { 100.0 * row.stated.sigma_stated } else { row.stated.sigma_stated }, 2),
            if share_of { " %".to_owned() } else { format!(" {}", row.stated.unit) },
            significant(row.emissivity_rms, 2)
        );
        match row.lost {
            0 => out.push('\n'),
            lost => {
                let _ = writeln!(out, "; {lost} of the clusters are not found again with it");
            }
        }
    }
    out.push('\n');
    out
}

fn assumptions(result: &LibraryFound) -> String {
    let scenario = &result.scenario;
    let [low, high] = scenario.unknown.temperature_k;
    let total = lighting_total(scenario.unknown.lighting_total);
    let noise = noise(&scenario.cube.unit);
    let known = scenario.emissivity;
    format!(
        "Assumptions\n  groups: NEM at a largest emissivity of {} under the smoothest of some lightings, ratios, K-means; then least squares on the heat signal\n  \
         beforehand: mean emissivity {} +- {}, shape +- {}, to a quarter over {}\n  \
         unknown: temperature {low} to {high} K, lighting of {} surroundings, {total}\n  noise: {noise}; bands independent\n  \
         errors: all temperatures, lightings and emissivities unknown together; made of {} pixels\n{}\n",
        scenario.clusters.max_emissivity,
        known.mean,
        known.magnitude,
        known.shape,
        quantity(known.correlation_cm1, "cm^-1"),
        scenario.environment.len(),
        whole((result.drawn - result.without_nem) as u64),
        exact(&scenario.unknown, &result.surroundings_found),
    )
}

/// Below the emissivities; `cut` says that not all of them are drawn.
pub(crate) fn one_deviation(cut: bool) -> String {
    let rest = if cut { " The clusters of the most pixels; all are in library.csv." } else { "" };
    format!("Shaded: one standard deviation, with all temperatures and lightings unknown.{rest}")
}

/// Below the map of clusters.
pub(crate) fn most_probable(shown: Shown) -> String {
    format!("The most probable cluster of each pixel, and its temperature.{}", thinned(shown))
}
