//! A spectrometer calibrated by blackbodies, as files: response and offset with their errors, the radiance of a scene, a picture.

pub use crate::words::calibrate::blackbody::text;

use crate::bundle::Bundle;
use crate::cube_format::CubeFormat;
use crate::figures::{Plot, wavenumber_axis};
use crate::plot::{Axis, LineFigure, Panel, Series, Style};
use crate::table::{Table, number};
use crate::words::calibrate::blackbody::in_the_middle;
use hadar::error::Result;
use hadar_study::calibrate::{BlackbodyFound, ChannelRow};

/// All files; paths in the scenario are written relative to `out` where they lie below it.
///
/// # Errors
/// A figure that cannot be drawn.
pub fn bundle(result: &BlackbodyFound, format: CubeFormat) -> Result<Bundle> {
    let mut bundle = Bundle::about(result.scenario.title.as_deref());
    bundle.add_asked("scenario.toml", result.scenario.to_toml());
    bundle.add_table("channels.csv", response(result))?;
    bundle.add_table("temperatures.csv", temperatures(result))?;
    if let Some(scene) = &result.scene {
        let centres = &result.centres_cm1;
        let mut add =
            |name: &str, samples: &[f32]| format.add(&mut bundle, name, scene.shape, samples, centres);
        add("radiance", &scene.radiance)?;
    }
    // Errors that do not hold are not written for other commands to read.
    if let Some(scene) = result.scene.as_ref().filter(|_| !result.misfit) {
        let centres = &result.centres_cm1;
        let mut add =
            |name: &str, samples: &[f32]| format.add(&mut bundle, name, scene.shape, samples, centres);
        add("sigma_common", &scene.sigma_common)?;
        if let Some(pixel) = &scene.sigma_pixel {
            add("sigma_pixel", pixel)?;
        }
        // As `[cube] noise` of a decomposition takes it.
        let mut table = Table::new(["band", "wavenumber_cm1", "sigma", "sigma_common", "sigma_together"]);
        for ((c, row), band) in result.channels.iter().enumerate().zip(&result.places) {
            let sigmas = [scene.sigma_noise[c], scene.sigma_common_most[c], scene.sigma_together[c]];
            let numbers = [[row.wavenumber_cm1].as_slice(), &sigmas].concat().into_iter().map(number);
            table.push(std::iter::once(band.to_string()).chain(numbers).collect());
        }
        bundle.add_table("sigma.csv", table)?;
    }
    bundle.add_warnings(&result.warnings)?;
    bundle.add_plots(&[figure(result)])?;
    Ok(bundle)
}

fn response(result: &BlackbodyFound) -> Table {
    Table::of_numbers(
        &result.channels,
        &[
            ("wavenumber_cm1", &|row| row.wavenumber_cm1),
            ("response", &|row| row.response),
            ("response_sigma", &|row| row.response_error.sigma()),
            ("response_sigma_by_noise", &|row| row.response_error.var_noise.sqrt()),
            ("response_sigma_by_temperatures", &|row| row.response_error.var_temperature.sqrt()),
            ("offset", &|row| row.offset),
            ("offset_sigma", &|row| row.offset_error.sigma()),
            ("covariance", &|row| row.covariance),
            ("sigma_middle_by_noise_k", &|row| row.sigma_middle_k[0]),
            ("sigma_middle_by_temperatures_k", &|row| row.sigma_middle_k[1]),
            ("noise_middle_k", &|row| row.noise_middle_k),
        ],
    )
}

fn temperatures(result: &BlackbodyFound) -> Table {
    let mut table = Table::new([
        "temperature_k",
        "uncertainty_k",
        "found_off_by_k",
        "sigma_k",
        "emissivity",
        "emissivity_error",
        "surroundings_k",
        "surroundings_uncertainty_k",
    ]);
    for (spec, [shift, sigma]) in result.scenario.blackbodies.iter().zip(&result.temperature_shifts_k) {
        let (sent, [own, emissivity, surroundings]) = (spec.sent(), spec.deviations());
        let grey = [sent.emissivity, emissivity, sent.surroundings_k, surroundings];
        table.push(
            [[sent.temperature_k, own, *shift, *sigma], grey].concat().into_iter().map(number).collect(),
        );
    }
    table
}

fn figure(result: &BlackbodyFound) -> Plot {
    let x: Vec<f64> = result.channels.iter().map(|row| row.wavenumber_cm1).collect();
    let of = |pick: &dyn Fn(&ChannelRow) -> f64| result.channels.iter().map(pick).collect::<Vec<f64>>();
    let peak = of(&|row| row.response.abs()).into_iter().fold(0.0, f64::max);
    let (noise, temperature) =
        (of(&|row| 1e3 * row.sigma_middle_k[0]), of(&|row| 1e3 * row.sigma_middle_k[1]));
    let own = of(&|row| 1e3 * row.noise_middle_k);
    let response = of(&|row| row.response / peak);
    let table = Table::of_columns([
        ("wavenumber_cm1", &x),
        ("response_over_peak", &response),
        ("common_by_noise_mk", &noise),
        ("common_by_temperatures_mk", &temperature),
        ("noise_of_a_sample_mk", &own),
    ]);
    let figure = LineFigure::new(
        "Response by blackbodies, and the errors it leaves",
        wavenumber_axis(&x),
        Axis::linear("response (peak: 1)"),
    )
    .subtitle(in_the_middle(result))
    .series(Series::line("response", x.clone(), response).colour(0))
    .lower(
        Panel::new(Axis::log("error (mK)"))
            .series(Series::line("common to all pixels, by noise", x.clone(), noise).colour(1))
            .series(Series::line("common, by temperatures", x.clone(), temperature).colour(2))
            .series(Series::line("each sample", x, own).style(Style::Dashed).colour(6)),
    );
    Plot { name: "response".into(), figure: figure.into(), table }
}
