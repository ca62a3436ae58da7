//! The response of a camera behind a filter wheel, as files: values with their covariance, η, radiances of a scene, pictures.

pub use crate::words::calibrate::response::text;

use crate::bundle::Bundle;
use crate::figures::{Plot, wavenumber_axis};
use crate::plot::{Axis, Band, LineFigure, Pictures, Series, Style};
use crate::shown::Shown;
use crate::table::{Table, number, optional};
use crate::words::calibrate::response::shaded;
use hadar::error::Result;
use hadar_formats::cube::{npy_map, write_npy_to};
use hadar_study::calibrate::{ResponseFound, ResponseRow};

/// Widest picture, pixels: of larger cubes every second, third… row and column is shown.
const WIDEST: usize = 420;

/// All files; paths in the scenario are written relative to `out` where they lie below it.
///
/// # Errors
/// A figure that cannot be drawn.
pub fn bundle(result: &ResponseFound) -> Result<Bundle> {
    let mut bundle = Bundle::about(result.scenario.title.as_deref());
    bundle.add_asked("scenario.toml", result.scenario.to_toml());
    bundle.add_table("values.csv", response(result))?;
    // Errors that do not hold are not written for other commands to read.
    if !result.misfit {
        bundle.add_table("covariance.csv", square(result, &result.covariance))?;
    }
    bundle.add_table("kernels.csv", square(result, &result.kernels))?;
    bundle.add_table("filters.csv", filters(result))?;
    let mut plots = vec![figure(result)];
    if let Some(eta) = &result.eta {
        let values: Vec<f32> = eta.values.iter().map(|eta| *eta as f32).collect();
        bundle.add("eta.npy", npy_map(&result.size, &values)?);
        plots.push(vignette(result, &eta.values));
    }
    if let Some(scene) = &result.scene {
        let mut cube = Vec::with_capacity(scene.shape.len() * 4 + 128);
        write_npy_to(&mut cube, scene.shape, &scene.radiance)?;
        bundle.add("radiance.npy", cube);
    }
    if let Some(scene) = result.scene.as_ref().filter(|_| !result.misfit) {
        let to = |values: &[f64]| values.iter().map(|x| *x as f32).collect::<Vec<f32>>();
        bundle.add("sigma_noise.npy", npy_map(&[result.filters.len()], &to(&scene.sigma_noise))?);
        bundle.add("sigma_common.npy", npy_map(&[result.filters.len()], &to(&scene.sigma_common))?);
    }
    bundle.add_warnings(&result.warnings)?;
    bundle.add_plots(&plots)?;
    Ok(bundle)
}

fn response(result: &ResponseFound) -> Table {
    Table::of(
        &result.response,
        &[
            ("wavenumber_cm1", &|row| number(row.wavenumber_cm1)),
            ("response", &|row| number(row.response)),
            ("sigma", &|row| number(row.sigma)),
            ("sigma_kinked", &|row| number(row.sigma_kinked)),
            ("sigma_beforehand", &|row| number(row.sigma_beforehand)),
            ("sigma_readings_alone", &|row| optional(row.sigma_readings_alone)),
            ("typical", &|row| number(row.typical)),
        ],
    )
}

fn square(result: &ResponseFound, values: &[f64]) -> Table {
    let names = result.response.iter().map(|row| format!("{:.1}", row.wavenumber_cm1));
    let mut table = Table::new(std::iter::once("wavenumber_cm1".to_owned()).chain(names));
    for (row, values) in result.response.iter().zip(values.chunks(result.response.len().max(1))) {
        let cells = values.iter().map(|x| number(*x));
        table.push(std::iter::once(number(row.wavenumber_cm1)).chain(cells).collect());
    }
    table
}

fn filters(result: &ResponseFound) -> Table {
    let mut table = Table::new([
        "filter",
        "offset",
        "offset_sigma",
        "sigma_noise",
        "sigma_common",
        "sigma_common_kinked",
    ]);
    for (q, name) in result.filters.iter().enumerate() {
        let scene = |pick: &dyn Fn(&hadar_study::calibrate::FilterRadiances) -> f64| {
            optional(result.scene.as_ref().map(pick))
        };
        table.push(vec![
            name.clone(),
            number(result.offsets[q]),
            number(result.offset_sigmas[q]),
            scene(&|scene| scene.sigma_noise[q]),
            scene(&|scene| scene.sigma_common[q]),
            scene(&|scene| scene.sigma_common_kinked[q]),
        ]);
    }
    table
}

fn figure(result: &ResponseFound) -> Plot {
    let x: Vec<f64> = result.response.iter().map(|row| row.wavenumber_cm1).collect();
    let peak = result.response.iter().map(|row| row.response).fold(0.0, f64::max);
    let of = |pick: &dyn Fn(&ResponseRow) -> f64| {
        result.response.iter().map(|row| pick(row) / peak).collect::<Vec<f64>>()
    };
    let (values, typical) = (of(&|row| row.response), of(&|row| row.typical));
    let edges = |sigma: &dyn Fn(&ResponseRow) -> f64| {
        let sigma = of(sigma);
        let edge =
            |sign: f64| values.iter().zip(&sigma).map(|(value, sigma)| value + sign * 1.96 * sigma).collect();
        [edge(-1.0), edge(1.0)]
    };
    let ([low, high], [low_kinked, high_kinked]) = (edges(&|row| row.sigma), edges(&|row| row.sigma_kinked));
    let table = Table::of_columns([
        ("wavenumber_cm1", &x),
        ("response_over_peak", &values),
        ("low_95", &low),
        ("high_95", &high),
        ("low_95_kinked", &low_kinked),
        ("high_95_kinked", &high_kinked),
        ("typical", &typical),
    ]);
    let mut figure = LineFigure::new(
        format!("Response: {} of {} values are determined by the readings", result.determined, x.len()),
        wavenumber_axis(&x),
        Axis::linear("response (peak: 1)"),
    )
    .subtitle(shaded(result));
    // Where readings do not fit, no interval holds.
    if !result.misfit {
        figure = figure
            .band(Band::new("95 % if the response has kinks", x.clone(), low_kinked, high_kinked).colour(6))
            .band(Band::new("95 %", x.clone(), low, high).colour(1));
    }
    let figure = figure
        .series(Series::line("known beforehand", x.clone(), typical).style(Style::Dashed).colour(6))
        .series(Series::line("estimated", x, values).style(Style::Marked).colour(1));
    Plot { name: "response".into(), figure: figure.into(), table }
}

fn vignette(result: &ResponseFound, eta: &[f64]) -> Plot {
    let shown = Shown::within(result.size, WIDEST);
    let axis = Axis::linear("η (1 at the centre)");
    let (table, pictures) = shown.layers(vec![("eta", "η", axis, shown.values(|at| eta[at]))]);
    let figure = Pictures::new("Relative transmittance of the filter wheel", pictures);
    Plot { name: "eta".into(), figure: figure.into(), table }
}
