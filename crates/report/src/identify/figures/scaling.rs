//! The scaling laws drawn.

use crate::figures::Plot;
use crate::plot::{Axis, Band, LineFigure, Series, Style};
use crate::table::Table;
use hadar_study::study::Scaling;

/// Least distance against the size of the library.
#[must_use]
pub(crate) fn library_size(scaling: &Scaling, target: &str) -> Plot {
    let library = &scaling.library;
    let mut table = Table::new([
        "materials".to_owned(),
        format!("expected_minimum_{target}_per_sqrt_photon"),
        "quantile_10_percent_per_sqrt_photon".into(),
        "median_per_sqrt_photon".into(),
        "quantile_90_percent_per_sqrt_photon".into(),
    ]);
    let x: Vec<f64> = library.materials.iter().map(|&count| count as f64).collect();
    for ((x, own), [low, middle, high]) in x.iter().zip(&library.target).zip(&library.quantiles) {
        table.push_numbers(&[*x, *own, *low, *middle, *high]);
    }
    let of = |i: usize| library.quantiles.iter().map(|q| q[i]).collect::<Vec<f64>>();
    let figure = LineFigure::new(
        "More materials, less distance between them",
        Axis::log("materials in the library"),
        Axis::log("least distance (per √photon)"),
    )
    .subtitle(format!(
        "Expected {} distance from a target to the nearest of its alternatives, over all libraries of that size.{}",
        scaling.by,
        if of(2).iter().all(|d| *d == 0.0) { " All are 0." } else { "" }
    ))
    .band(Band::new("10 % to 90 % of the targets", x.clone(), of(0), of(2)))
    .series(Series::line("median target", x.clone(), of(1)).colour(0))
    .series(Series::line(format!("target {target}"), x, library.target.clone()).colour(1));
    Plot { name: "library_size".into(), figure: figure.into(), table }
}

/// Least and median distance against the number of bands.
#[must_use]
pub(crate) fn band_number(scaling: &Scaling, target: &str) -> Plot {
    let bands = &scaling.bands;
    let with_camera = !bands.camera.is_empty();
    let mut header = vec!["bands", "minimum_per_sqrt_photon", "median_per_sqrt_photon"];
    if with_camera {
        header.extend(["minimum_camera_statistical_distance", "median_camera_statistical_distance"]);
    }
    let mut table = Table::new(header);
    let x: Vec<f64> = bands.bands.iter().map(|&count| count as f64).collect();
    for (i, x) in x.iter().enumerate() {
        let mut row = vec![*x, bands.shot_noise[i], bands.shot_noise_median[i]];
        if with_camera {
            row.extend([bands.camera[i], bands.camera_median[i]]);
        }
        table.push_numbers(&row);
    }
    // What matters is how they change: each is shown relative to what all bands give.
    let relative = |values: &[f64]| -> Vec<f64> {
        let last = values.last().copied().unwrap_or(1.0);
        values.iter().map(|value| value / last).collect()
    };
    let left_out = match bands.left_out.as_slice() {
        [] => String::new(),
        [one] => format!(" Without {one}, which light alone does not tell as required."),
        more => format!(" Without {} alternatives that light alone does not tell as required.", more.len()),
    };
    let mut figure = LineFigure::new(
        format!("How many bands it takes to tell {target} from the library"),
        Axis::log("bands"),
        Axis::log("distance, relative to all bands"),
    )
    .subtitle(format!(
        "Neighbouring bands joined. Photons are the same for any number of bands{}.{left_out}{}",
        if with_camera { "; the camera's noise is added to every reading" } else { "" },
        if bands.shot_noise_median.iter().all(|d| *d == 0.0) { " All are 0." } else { "" }
    ));
    let mut curves = vec![
        ("least, shot noise alone", &bands.shot_noise, 0),
        ("median, shot noise alone", &bands.shot_noise_median, 0),
    ];
    if with_camera {
        curves.push(("least, noise of the camera", &bands.camera, 1));
        curves.push(("median, noise of the camera", &bands.camera_median, 1));
    }
    for (label, values, colour) in curves {
        // An alternative that is the same leaves nothing in any number of bands.
        if values.iter().any(|value| *value > 0.0) {
            let style = if label.starts_with("median") { Style::Dashed } else { Style::Line };
            figure =
                figure.series(Series::line(label, x.clone(), relative(values)).style(style).colour(colour));
        }
    }
    Plot { name: "band_number".into(), figure: figure.into(), table }
}
