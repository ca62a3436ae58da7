//! The bands that matter, drawn.

use crate::figures::{Plot, wavenumber_axis};
use crate::plot::{Axis, Band, LineFigure, Series, Style};
use crate::table::Table;
use hadar_study::study::BandsThatMatter;

/// Share of every band in the distance, with the best bands and filters marked.
#[must_use]
pub(crate) fn bands_that_matter(found: &BandsThatMatter, target: &str) -> Plot {
    let x = &found.center_cm1;
    let mut table = Table::new([
        "center_cm1",
        "share_of_local_distance_squared",
        "lost_without_the_band",
        "share_of_nearest_separation_squared",
    ]);
    for (i, x) in x.iter().enumerate() {
        table.push_numbers(&[*x, found.share_local[i], found.lost_without[i], found.share_nearest[i]]);
    }
    let percent = |values: &[f64]| values.iter().map(|value| 100.0 * value).collect::<Vec<f64>>();
    let (local, nearest) = (percent(&found.share_local), percent(&found.share_nearest));
    let top = local.iter().chain(&nearest).copied().fold(0.0, f64::max);
    let mut figure = LineFigure::new(
        format!("Which bands tell {target} from {}", found.alternative),
        wavenumber_axis(x),
        Axis::linear("share of the squared distance (% per band)").range(0.0, 1.05 * top),
    )
    .subtitle("What each band adds to the square of the distance once the unknowns are fitted.");
    let reach = x.last().copied().unwrap_or(0.0) - x.first().copied().unwrap_or(0.0);
    // A choice that tells nothing is no best one.
    let filters = found.filters.iter().filter(|choice| choice.distance > 0.0);
    let filters = filters.flat_map(|choice| &choice.passbands);
    for (i, filter) in filters.enumerate() {
        let count = found.filters.as_ref().map_or(0, |choice| choice.passbands.len());
        let label = if i == 0 { best(count, "filter") } else { String::new() };
        // Neighbours are told apart by a small gap.
        let inset = (0.02 * (filter.high_cm1 - filter.low_cm1)).min(0.002 * reach);
        let span = vec![filter.low_cm1 + inset, filter.high_cm1 - inset];
        figure = figure.band(Band::new(label, span, vec![0.0; 2], vec![1.05 * top; 2]).colour(2));
    }
    figure = figure
        .series(Series::line("local distance", x.clone(), local.clone()).colour(0))
        .series(Series::line("nearest state", x.clone(), nearest).style(Style::Dashed).colour(1));
    if let Some(choice) = found.bands.as_ref().filter(|choice| choice.distance > 0.0) {
        let at: Vec<f64> = choice.passbands.iter().map(|band| band.center_cm1).collect();
        let share = at.iter().map(|at| {
            let here = x.iter().position(|x| (x - at).abs() < 1e-6 * at);
            here.map_or(f64::NAN, |i| local[i])
        });
        let label = best(at.len(), "band");
        figure = figure.series(Series::points(label, at.clone(), share.collect()).colour(3));
    }
    Plot { name: "bands_that_matter".into(), figure: figure.into(), table }
}

fn best(count: usize, what: &str) -> String {
    if count == 1 { format!("best {what}") } else { format!("best {count} {what}s") }
}
