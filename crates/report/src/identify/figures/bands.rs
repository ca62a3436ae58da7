//! The bands that matter, drawn.

use crate::figures::{Plot, band_axis, over_bands};
use crate::plot::{Axis, Band, LineFigure, Series, Style};
use crate::table::Table;
use crate::words::identify::captions::SHARES;
use hadar_study::{BandsThatMatter, Study};

/// Share of every band in the distance, with the best bands and filters marked.
#[must_use]
pub(crate) fn bands_that_matter(found: &BandsThatMatter, study: &Study) -> Plot {
    let (x, bands, target) = (&found.center_cm1, study.bands(), &study.target().name);
    let table = Table::of_columns([
        ("center_cm1", x),
        ("share_of_local_distance_squared", &found.share_local),
        ("lost_without_the_band", &found.lost_without),
        ("share_of_nearest_separation_squared", &found.share_nearest),
    ]);
    let percent = |values: &[f64]| values.iter().map(|value| 100.0 * value).collect::<Vec<f64>>();
    let (local, nearest) = (percent(&found.share_local), percent(&found.share_nearest));
    let most = local.iter().chain(&nearest).copied().fold(0.0, f64::max);
    let top = 1.08 * if most > 0.0 { most } else { 1.0 };
    let mut figure = LineFigure::new(
        format!("Which bands distinguish {target} from {}?", found.alternative),
        band_axis(bands),
        Axis::linear("share of the squared distance (% per band)").range(0.0, top),
    )
    .subtitle(SHARES);
    // A choice that tells nothing is no best one.
    let choice = found.filters.as_ref().filter(|choice| choice.distance > 0.0);
    let filters = choice.map_or(&[][..], |choice| &choice.passbands);
    for (i, filter) in filters.iter().enumerate() {
        let label = match (i, filters.len()) {
            (0, 1) => "best filter".into(),
            (0, count) => format!("best {count} filters: the odd ones"),
            (1, _) => "the even ones".into(),
            _ => String::new(),
        };
        let span = vec![filter.low_cm1, filter.high_cm1];
        let band = Band::new(label, span, vec![0.0; 2], vec![top; 2]);
        // Neighbours are told apart by their shade.
        figure = figure.band(if i % 2 == 0 { band.colour(2) } else { band.colour(4) });
    }
    let curve = |label: &str, values: &[f64]| {
        let (x, y) = over_bands(bands, values);
        Series::line(label, x, y)
    };
    figure = figure
        .series(curve("local distance", &local).colour(0))
        .series(curve("nearest state", &nearest).style(Style::Dashed).colour(1));
    if let Some(choice) = found.bands.as_ref().filter(|choice| choice.distance > 0.0) {
        let at: Vec<f64> = choice.passbands.iter().map(|band| band.center_cm1).collect();
        let share = at.iter().map(|at| {
            let here = x.iter().position(|x| (x - at).abs() < 1e-6 * at);
            here.map_or(f64::NAN, |i| local[i])
        });
        let label = if at.len() == 1 { "best band".into() } else { format!("best {} bands", at.len()) };
        figure = figure.series(Series::points(label, at.clone(), share.collect()).colour(3));
    }
    Plot { name: "bands_that_matter".into(), figure: figure.into(), table }
}
