//! A spectrometer calibrated by blackbodies, in words.

use crate::cube_format::CubeFormat;
use crate::text::footing::{ASSUMPTIONS, warnings};
use hadar::words::{quantity, significant};
use hadar_scenario::calibrate::blackbodies::BlackbodySpec;
use hadar_study::calibrate::BlackbodyFound;
use std::fmt::Write as _;

/// What the samples of a calibrated cube are, as a decomposition scenario has it.
const RADIANCE: &str = "W m^-2 sr^-1 per cm^-1";

/// The whole answer.
#[must_use]
pub fn text(result: &BlackbodyFound, format: CubeFormat) -> String {
    let worst = result.worst;
    let [noise, temperature] = worst.sigma_common_k;
    let milli = |kelvin: f64| if kelvin > 0.0 { quantity(kelvin, "K") } else { "0".to_owned() };
    let mut out = match result.misfit {
        true => {
            "The blackbodies do not lie on straight lines, so that no error below holds (see the warning).\n"
                .to_owned()
        }
        false => String::new(),
    };
    let _ = writeln!(
        out,
        "{} channels calibrated by {} blackbodies: radiances as at {} to {} K err by up to {} in all pixels alike{}, and by up to {} in \
         each sample{}.\n",
        result.channels.len(),
        result.temperature_shifts_k.len(),
        significant(worst.range_k[0], 4),
        significant(worst.range_k[1], 4),
        milli(noise.hypot(temperature)),
        match result.chi_square_reduced {
            Some(_) => "",
            None => " if the response is linear",
        },
        milli(worst.noise_k),
        match &result.scene {
            Some(scene) => format!(
                "; those of the scene by up to {} in all pixels alike",
                milli(scene.sigma_common_most_k)
            ),
            None => String::new(),
        }
    );
    let _ = writeln!(
        out,
        "Common to all pixels (rms of the channels, as at {} K, where it is the largest)",
        significant(worst.at_k, 4)
    );
    let _ = writeln!(out, "  by noise of the blackbodies' readings      {}", milli(noise));
    let _ = writeln!(out, "  by what they are, in all channels           {}\n", milli(temperature));
    let _ = writeln!(out, "Blackbodies                stated to        found off by");
    for (spec, [shift, sigma]) in result.scenario.blackbodies.iter().zip(&result.temperature_shifts_k) {
        let found = match result.chi_square_reduced {
            Some(_) if spec.error_k() > 0.0 => format!("{:.1} +- {:.1} mK", 1e3 * shift, 1e3 * sigma),
            _ => "-".to_owned(),
        };
        let _ = writeln!(
            out,
            "  {:>10}             {:>10}        {found}",
            format!("{:.2} K", spec.temperature_k),
            spec.uncertainty_k.map_or_else(|| "not stated".to_owned(), milli)
        );
    }
    match result.chi_square_reduced {
        Some(chi) => {
            let _ = writeln!(out, "  about straight lines: chi2/nu {}", significant(chi, 3));
        }
        None => out.push_str(
            "  two blackbodies fit any line: nothing checks whether response and temperatures are right\n",
        ),
    }
    if let Some(scene) = &result.scene {
        let file = format.file("radiance");
        let mean = |values: &[f64]| {
            let square: f64 = values.iter().map(|x| x * x).sum();
            (square / values.len().max(1) as f64).sqrt()
        };
        let _ = match result.misfit {
            true => {
                writeln!(out, "\nScene: {file} ({RADIANCE}); errors of it are not written, since none holds")
            }
            false => writeln!(
                out,
                "\nScene: {file} ({RADIANCE}); noise of each sample {} (rms of the bands), common to all pixels up to {}\n  \
             by band in sigma.csv, by sample in {}; for a decomposition\n  [cube]\n  data = \"{file}\"\n  unit = \
             \"{RADIANCE}\"\n  noise = \"sigma.csv\"\n  (a number as noise leaves out what all pixels have in common, up to {}: only sigma.csv carries it)",
                significant(mean(&scene.sigma_noise), 2),
                significant(mean(&scene.sigma_common_most), 2),
                format.file("sigma_common"),
                milli(scene.sigma_common_most_k),
            ),
        };
    }
    let _ = writeln!(
        out,
        "\n{ASSUMPTIONS}\n  C = R B(T) + xi in every channel, R and xi {}; {} that fill the view; noise of {} (unit of the cubes) \
         in every sample.\n",
        match &result.scene {
            Some(scene) if scene.sigma_pixel.is_some() =>
                "one for each pixel (errors of its calibration in sigma_pixel.npy)",
            _ => "the same in all pixels",
        },
        sent_by(&result.scenario.blackbodies),
        significant(result.scenario.noise, 3)
    );
    out + &warnings(&result.warnings)
}

/// What blackbodies are taken to be.
pub(super) fn sent_by(specs: &[BlackbodySpec]) -> String {
    let grey = specs.iter().enumerate().filter_map(|(k, spec)| {
        let (sent, [_, error, surroundings]) = (spec.sent(), spec.deviations());
        (spec.surroundings_k.is_some()).then(|| {
            format!(
                "blackbody[{k}] of emissivity {} +- {} in surroundings of {} +- {surroundings} K",
                sent.emissivity,
                error,
                quantity(sent.surroundings_k, "K"),
            )
        })
    });
    let grey: Vec<String> = grey.collect();
    match grey.len() {
        0 => "blackbodies of emissivity 1".to_owned(),
        n if n < specs.len() => format!("{}, the others of emissivity 1,", grey.join(", ")),
        _ => grey.join(", "),
    }
}

/// Below the picture of the response.
pub(crate) fn in_the_middle(result: &BlackbodyFound) -> String {
    let middle = significant(result.middle_k, 4);
    format!("Errors of a radiance as temperature, at {middle} K in the middle of the blackbodies.")
}
