//! The scaling laws drawn.

use crate::figures::Plot;
use crate::plot::{Axis, Band, LineFigure, Rule, Series, Style};
use crate::table::Table;
use crate::text::significant;
use crate::words::identify::captions;
use hadar_study::{Scaling, Study};

/// Least distance against the size of the library; nothing where there is only one size.
#[must_use]
pub(crate) fn library_size(scaling: &Scaling, target: &str) -> Option<Plot> {
    let library = &scaling.library;
    if library.materials.len() < 2 {
        return None;
    }
    let x: Vec<f64> = library.materials.iter().map(|&count| count as f64).collect();
    let of = |i: usize| library.quantiles.iter().map(|q| q[i]).collect::<Vec<f64>>();
    let table = Table::of_columns([
        ("materials", &x),
        (&format!("expected_minimum_{target}_per_sqrt_photon"), &library.target),
        ("quantile_10_percent_per_sqrt_photon", &of(0)),
        ("median_per_sqrt_photon", &of(1)),
        ("quantile_90_percent_per_sqrt_photon", &of(2)),
    ]);
    let figure = LineFigure::new(
        "More materials, less distance between them",
        Axis::log("materials in the library"),
        Axis::log("least distance (per √photon)"),
    )
    .subtitle(captions::library_size(scaling.by, of(2).iter().all(|d| *d == 0.0)))
    .band(Band::new("10 % to 90 % of the targets", x.clone(), of(0), of(2)))
    .series(Series::line("median target", x.clone(), of(1)).style(Style::Marked).colour(0))
    .series(
        Series::line(format!("target {target}"), x, library.target.clone()).style(Style::Marked).colour(1),
    );
    Some(Plot { name: "library_size".into(), figure: figure.into(), table })
}

/// Least and median distance against the number of bands, at the camera's photons where there is one; nothing where there
/// is only one number.
#[must_use]
pub(crate) fn band_number(scaling: &Scaling, study: &Study) -> Option<Plot> {
    let bands = &scaling.bands;
    if bands.bands.len() < 2 {
        return None;
    }
    let target = &study.target().name;
    let noisy = !bands.camera.is_empty();
    let x: Vec<f64> = bands.bands.iter().map(|&count| count as f64).collect();
    let mut columns = vec![
        ("bands", &x),
        ("minimum_per_sqrt_photon", &bands.shot_noise),
        ("median_per_sqrt_photon", &bands.shot_noise_median),
    ];
    if noisy {
        columns.push(("minimum_camera_statistical_distance", &bands.camera));
        columns.push(("median_camera_statistical_distance", &bands.camera_median));
    }
    let table = Table::of_columns(columns);
    // With a camera, what its photons make of them.
    let photons = study.counting().map(|counting| counting.counts_per_radiance * study.photon_radiance());
    let at_photons =
        |values: &[f64]| values.iter().map(|d| d * photons.unwrap_or(1.0).sqrt()).collect::<Vec<f64>>();
    let axis = if photons.is_some() { "statistical distance d" } else { "distance (per √photon)" };
    let mut figure = LineFigure::new(
        format!("How many bands distinguish {target} from the library?"),
        Axis::log("number of bands"),
        Axis::log(axis),
    )
    .subtitle(captions::band_number(scaling));
    let shot = (at_photons(&bands.shot_noise), at_photons(&bands.shot_noise_median));
    let mut curves =
        vec![("least, shot noise alone", &shot.0, 0, false), ("median, shot noise alone", &shot.1, 0, true)];
    if noisy {
        curves.push(("least, noise of the camera", &bands.camera, 1, false));
        curves.push(("median, noise of the camera", &bands.camera_median, 1, true));
    }
    let mut drawn: Vec<&Vec<f64>> = Vec::new();
    for (label, values, colour, is_median) in curves {
        // An alternative that is the same leaves nothing in any number of bands; one alone is its own median.
        if values.iter().any(|value| *value > 0.0) && !drawn.contains(&values) {
            drawn.push(values);
            let curve = Series::line(label, x.clone(), values.clone()).style(Style::Marked).colour(colour);
            figure = figure.series(if is_median { curve.open() } else { curve });
        }
    }
    if photons.is_some() {
        let required = study.required_distance();
        let label = format!("demanded: d = {}", significant(required, 3));
        figure = figure.rule(Rule::horizontal(required, label));
    }
    Some(Plot { name: "band_number".into(), figure: figure.into(), table })
}
