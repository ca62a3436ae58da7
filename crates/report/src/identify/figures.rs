//! A library drawn: all materials against all.

mod bands;
mod scaling;

pub(super) use bands::bands_that_matter;
pub(super) use scaling::{band_number, library_size};

use crate::figures::{Plot, band_axis, over_bands};
use crate::plot::{
    Axis, Figure, LineFigure, Matrix as NamedMatrix, NamedSeries, NamedValues, Panel, Rule, Series, Style,
};
use crate::table::{Table, number, optional};
use crate::text::significant;
use crate::words::identify::captions;
use hadar::order;
use hadar::spectrum::Bands;
use hadar_scenario::DistanceKind;
use hadar_study::{Matrix, PairResult, SampleSpectra, Study, TargetVerdict};

/// All against all by the distance that decides: statistical with a camera, else per √photon. Rows and columns are
/// ordered by clusters.
#[must_use]
pub(super) fn distance_matrix(matrix: &Matrix) -> Plot {
    let (order, starts) = by_clusters(matrix);
    let nearest_decides = matrix.by == "nearest";
    let rows = match (&matrix.statistical_distance, &matrix.distance_local_unknown_gain) {
        (Some(rows), _) | (None, Some(rows)) => rows,
        (None, None) if nearest_decides => &matrix.distance_nearest,
        (None, None) => &matrix.distance_local,
    };
    let with_camera = matrix.statistical_distance.is_some();
    let names: Vec<String> = order.iter().map(|&i| matrix.materials[i].clone()).collect();
    let column = if with_camera { "statistical_distance" } else { "distance_per_sqrt_photon" };
    let columns = names.iter().map(|name| format!("{column}_{name}"));
    let mut table = Table::new(std::iter::once("target".to_owned()).chain(columns));
    for &i in &order {
        let row = order.iter().map(|&j| optional(rows[i][j]));
        table.push(std::iter::once(matrix.materials[i].clone()).chain(row).collect());
    }
    let values: Vec<f64> =
        order.iter().flat_map(|&i| order.iter().map(move |&j| rows[i][j].unwrap_or(f64::NAN))).collect();
    let mut finite: Vec<f64> = values.iter().copied().filter(|d| d.is_finite() && *d > 0.0).collect();
    finite.sort_by(f64::total_cmp);
    let last = finite.len().saturating_sub(1);
    let at = |share: f64| finite.get((share * last as f64) as usize).copied().unwrap_or(1.0);
    // A few nearly identical pairs must not use up the colours.
    let (low, high) = (at(0.02), at(1.0));
    let title = if with_camera {
        "Statistical distance d of every material from every other"
    } else {
        "Distance of every material from every other"
    };
    let unit = if with_camera { "statistical distance d" } else { "distance (per √photon)" };
    let mut figure = NamedMatrix::new(
        title,
        ("target", names.clone()),
        ("alternative", names),
        (Axis::log(unit).range(low, high.max(2.0 * low)), values),
    )
    .subtitle(captions::all_against_all(matrix.by, with_camera))
    .groups(starts);
    if with_camera {
        let required = significant(matrix.required_distance, 3);
        figure = figure.threshold(
            matrix.required_distance,
            format!("target not distinguished from the other: d below {required}"),
        );
    }
    Plot { name: "distance_matrix".into(), figure: Figure::from(figure), table }
}

/// Distance of every material to the one hardest to tell it from, the least identifiable first: the paper's Extended
/// Data Fig. 6b for any library.
#[must_use]
pub(super) fn minimum_distances(matrix: &Matrix) -> Plot {
    let with_camera = matrix.statistical_distance.is_some();
    let targets = matrix.hardest_first();
    let value = TargetVerdict::decisive_minimum;
    let unit = if with_camera { "statistical_distance" } else { "distance_per_sqrt_photon" };
    let mut table =
        Table::new(["target".to_owned(), "hardest_alternative".into(), format!("minimum_{unit}")]);
    for target in &targets {
        table.push(vec![target.material.clone(), target.limiting.clone(), number(value(target))]);
    }
    let names = targets.iter().map(|target| format!("{} – {}", target.material, target.limiting)).collect();
    let axis = if with_camera { "least statistical distance d" } else { "least distance (per √photon)" };
    let mut figure =
        NamedValues::new("Each material and the one hardest to distinguish from it", names, Axis::log(axis))
            .subtitle(captions::all_against_all(matrix.by, false))
            .series(NamedSeries::new("", targets.iter().map(|target| value(target)).collect()));
    if with_camera {
        figure = figure.threshold(matrix.required_distance, "required").below("not identifiable");
    }
    Plot { name: "minimum_distances".into(), figure: figure.into(), table }
}

/// Most materials whose mean readings are drawn into one plot.
const MEANS_DRAWN: usize = 6;

/// The mean readings of some materials, and below them one reading of the target and of the one hardest to tell from it,
/// against the target's mean: whether noise or the material is what is seen.
#[must_use]
pub(super) fn sample_spectra(spectra: &SampleSpectra, bands: &Bands, limiting: &str) -> Plot {
    // The target comes first; the hardest of the others is always among those drawn.
    let all = &spectra.materials;
    let mut shown: Vec<&(String, Vec<f64>, Vec<f64>)> = all.iter().take(1).collect();
    shown.extend(all.iter().skip(1).filter(|(name, ..)| name == limiting));
    shown.extend(all.iter().skip(1).filter(|(name, ..)| name != limiting).take(MEANS_DRAWN - shown.len()));
    let mut header = vec!["wavenumber_cm1".to_owned()];
    header.extend(
        shown.iter().flat_map(|(name, ..)| [format!("mean_{name}_counts"), format!("drawn_{name}_counts")]),
    );
    let mut table = Table::new(header);
    for (band, nu) in spectra.wavenumber_cm1.iter().enumerate() {
        let mut row = vec![*nu];
        row.extend(shown.iter().flat_map(|(_, mean, counts)| [mean[band], counts[band]]));
        table.push_numbers(&row);
    }
    let title = match all.len() {
        all if all > shown.len() => format!("What is read of {} of the {all} materials", shown.len()),
        _ => "What is read of each material".into(),
    };
    let mut figure = LineFigure::new(title, band_axis(bands), Axis::linear("mean counts in a band"))
        .subtitle(captions::readings(limiting, spectra.seed));
    for (i, (name, mean, _)) in shown.iter().enumerate() {
        let (x, y) = over_bands(bands, mean);
        figure = figure.series(Series::line(name, x, y).colour(i));
    }
    if let Some((target, own, _)) = shown.first() {
        let off = |counts: &[f64]| -> Vec<f64> {
            counts.iter().zip(own).map(|(counts, mean)| 100.0 * (counts / mean - 1.0)).collect()
        };
        let mut lower = Panel::new(Axis::linear("difference (%)")).rule(Rule::horizontal(0.0, ""));
        for (i, (name, mean, counts)) in shown.iter().enumerate().take(2) {
            let label = format!("{name}, one reading");
            let points = Series::points(label, spectra.wavenumber_cm1.clone(), off(counts)).colour(i);
            // Full ones would hide each other.
            lower = lower.series(if i == 0 { points } else { points.open() });
            if name != target {
                let (x, y) = over_bands(bands, &off(mean));
                lower =
                    lower.series(Series::line(format!("{name}, mean"), x, y).style(Style::Dashed).colour(6));
            }
        }
        figure = figure.lower(lower);
    }
    Plot { name: "sample_spectra".into(), figure: figure.into(), table }
}

/// The target's distance from every alternative, the hardest first: statistical with a camera, else per √photon.
#[must_use]
pub(super) fn distances(study: &Study, pairs: &[PairResult]) -> Plot {
    let with_camera = study.camera().is_some();
    let target = &study.target().name;
    let by = study.scenario().requirement.by;
    let per_photon = |pair: &PairResult| match by {
        DistanceKind::Nearest => pair.distance_nearest,
        DistanceKind::Local => pair.distance_local,
        DistanceKind::LocalUnknownGain => pair.distance_local_unknown_gain,
    };
    let value = |pair: &PairResult| match with_camera {
        true => pair.statistical_distance.unwrap_or(f64::NAN),
        false => per_photon(pair),
    };
    let mut ranked: Vec<&PairResult> = pairs.iter().collect();
    order::ascending(&mut ranked, |pair| value(pair));
    let unit = if with_camera { "statistical_distance" } else { "distance_per_sqrt_photon" };
    let mut table = Table::new(["alternative", unit, "told_apart"]);
    let required = study.required_distance();
    for pair in &ranked {
        let told = match with_camera {
            true if value(pair) >= required => "yes",
            true => "no",
            false => "",
        };
        table.push(vec![pair.alternative.clone(), number(value(pair)), told.into()]);
    }
    let names = ranked.iter().map(|pair| pair.alternative.clone()).collect();
    let axis = if with_camera { "statistical distance d" } else { "distance (per √photon)" };
    let mut figure =
        NamedValues::new(format!("How far {target} is from each alternative"), names, Axis::log(axis))
            .subtitle(captions::against_all(by.name()))
            .series(NamedSeries::new("", ranked.iter().map(|pair| value(pair)).collect()));
    if with_camera {
        figure = figure
            .threshold(required, format!("demanded: d = {}", significant(required, 3)))
            .below("not distinguished as demanded");
    }
    Plot { name: "distances".into(), figure: figure.into(), table }
}

/// Materials cluster by cluster, then the others, and where each group begins.
fn by_clusters(matrix: &Matrix) -> (Vec<usize>, Vec<usize>) {
    let place = |name: &String| matrix.materials.iter().position(|known| known == name);
    let (mut order, mut starts): (Vec<usize>, Vec<usize>) = (Vec::new(), Vec::new());
    for cluster in matrix.apart.iter().flat_map(|apart| &apart.clusters) {
        starts.push(order.len());
        order.extend(cluster.iter().filter_map(place));
    }
    starts.push(order.len());
    let rest: Vec<usize> = (0..matrix.materials.len()).filter(|i| !order.contains(i)).collect();
    order.extend(rest);
    starts.retain(|&start| start > 0 && start < order.len());
    (order, starts)
}
