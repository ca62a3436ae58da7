//! The noise of a camera, in words.

use crate::text::footing::{ASSUMPTIONS, read_as, warnings};
use hadar::units::Dimension;
use hadar::words::{significant, whole};
use hadar_estimate::calibrate::Line;
use hadar_study::calibrate::NoiseFound;
use std::fmt::Write as _;

/// The whole answer.
#[must_use]
pub fn text(result: &NoiseFound) -> String {
    let mut out = format!("{}\n\n", sentence(result));
    // The others are of the same shape.
    out.extend(result.read.first().map(read_as));
    let common = &result.transfer.common;
    let _ = writeln!(out, "Variance of a sample of mean m (unit of the cube), all bands");
    let line = |name: &str, [value, low, high]: [f64; 3]| {
        let [low, high] = [low, high].map(|end| significant(end, 3));
        format!("  {name:<34}  {:>10}   95 %: {low} to {high}\n", significant(value, 3))
    };
    let of = |value: f64, sigma: f64| {
        let [low, high] = Line::interval(value, sigma);
        [value, low, high]
    };
    out += &line("a, electronic noise (unit^2)", of(common.electronic, common.sigma_electronic));
    out += &line("b, one photon (unit)", of(common.per_photon, common.sigma_per_photon));
    if result.gain_deviation.is_some() {
        out += &line("c, spread of gains squared", of(common.spread, common.sigma_spread));
    }
    out += &line("1/b, photons per unit", result.photons_per_unit);
    out += &line("sqrt(a)/b, noise of a reading (e-)", result.noise_electrons);
    let _ = writeln!(
        out,
        "  {}; own lines of all {} bands are in noise.csv\n",
        match result.transfer.chi_square_reduced.is_nan() {
            true => "whether bands have a line in common is not told by so few".to_owned(),
            false => format!(
                "bands about their common line: chi2/nu {}, by chance below {} (99.9 %)",
                significant(result.transfer.chi_square_reduced, 2),
                significant(result.transfer.chi_square_limit, 2)
            ),
        },
        result.transfer.bands.len()
    );
    out += &in_three_dimensions(result);
    if let Some(camera) = camera(result) {
        let _ = writeln!(out, "For a scenario\n{}", indented(&camera));
    }
    let _ = writeln!(out, "{ASSUMPTIONS}");
    let how = match result.transfer.uneven {
        None => format!(
            "  {} frames of one scene that did not change; a pixel is compared with itself.",
            result.frames
        ),
        Some(uneven) => format!(
            "  one frame: neighbours of a row are compared, {} % of them, as many of bright as of dark ones, left out as different;\n  \
             texture that three neighbouring bands share is taken out (at most {} of the noise of a band).",
            significant(100.0 * uneven, 2),
            significant(result.transfer.bands.iter().map(|band| band.texture).fold(0.0, f64::max), 2)
        ),
    };
    let _ = writeln!(out, "{how}");
    let _ = writeln!(
        out,
        "  {} % of the differences are left out as beyond 6 deviations; a band's sigma (sigma.csv) is that at the mean of all its samples.\n  \
         Poissonian photons; a sample without light is {}.\n  \
         Noise that is independent between pixels and bands, which is not checked: noise of whole rows or of all bands alike is in these\n  \
         figures, but what follows from several samples by them errs by more than it says.\n",
        significant(100.0 * result.transfer.outliers, 2),
        significant(result.scenario.noise.dark_level, 4)
    );
    out + &warnings(&result.warnings)
}

fn sentence(result: &NoiseFound) -> String {
    let [photons, low, high] = result.photons_per_unit;
    let [noise, least, most] = result.noise_electrons;
    if let (false, true, Some(terms)) =
        (result.usable, result.scenario.noise.uniform, &result.three_dimensional)
    {
        let of = |place: usize| significant(terms[place].sigma()[0], 3);
        return format!(
            "Beside {} of each pixel from frame to frame, {} stay from pixel to pixel, {} from row to row and {} from column to column (unit of \
             the cube); frames of one brightness do not tell photons from electronic noise.",
            of(0),
            of(1),
            of(2),
            of(3)
        );
    }
    if !result.usable {
        return format!(
            "No camera's figures follow from these {} samples: see the warnings; variances of the bands are measured all the same.",
            whole((result.shape.len() * result.frames) as u64)
        );
    }
    let half = |low: f64, high: f64| significant(0.5 * (high - low), 2);
    if least <= 0.0 {
        return format!(
            "One unit of the cube is {} photons (+- {}), and the electronic noise of a reading is below {} electrons.",
            significant(photons, 3),
            half(low, high),
            significant(most, 3)
        );
    }
    format!(
        "One unit of the cube is {} photons (+- {}), and the electronic noise of a reading is {} electrons (+- {}).",
        significant(photons, 3),
        half(low, high),
        significant(noise, 3),
        half(least, most)
    )
}

/// The figures as a scenario's `[camera]` has them; of photons and electronic noise none where they do not hold.
pub(crate) fn camera(result: &NoiseFound) -> Option<String> {
    if !result.usable {
        // Frames of one brightness tell what pixels share, if not photons.
        let rows = if result.scenario.noise.uniform { shared(result) } else { String::new() };
        return (!rows.is_empty()).then(|| format!("[camera]\n{rows}"));
    }
    let [photons, ..] = result.photons_per_unit;
    let [noise, least, most] = result.noise_electrons;
    let mut out = String::from("[camera]\n");
    let _ = writeln!(out, "# one unit of the cube is {} photons", significant(photons, 4));
    let _ = match least > 0.0 {
        true => writeln!(out, "noise_electrons = {}", significant(noise, 3)),
        // What is not seen is taken as large as it can be.
        false => writeln!(out, "noise_electrons = {} # at most", significant(most, 3)),
    };
    let _ = match result.scenario.noise.exposure_s {
        Some(exposure_s) => {
            writeln!(out, "noise_exposure = \"{}\"", Dimension::Time.format(exposure_s))
        }
        None => writeln!(out, "# noise_exposure = \"…\": the exposure of these frames"),
    };
    out += &shared(result);
    Some(out)
}

/// What each of the seven variances is of, in the order in which they are found, and the key of a camera.
const TERMS: [(&str, &str, Option<&str>); 7] = [
    ("tvh", "pixel, from frame to frame", None),
    ("vh", "pixel to pixel, staying", Some("fixed_pattern")),
    ("v", "row to row, staying", Some("row_noise")),
    ("h", "column to column, staying", Some("column_noise")),
    ("tv", "row to row, from frame to frame", Some("temporal_row_noise")),
    ("th", "column to column, frame to frame", Some("temporal_column_noise")),
    ("t", "whole frames", Some("frame_noise")),
];

/// Deviations of the noise in three dimensions; nothing of one frame.
fn in_three_dimensions(result: &NoiseFound) -> String {
    let Some(components) = &result.three_dimensional else { return String::new() };
    let scene = if result.scenario.noise.uniform { "" } else { "; what stays has the scene in it" };
    let mut out = format!("Noise in three dimensions, deviations (unit of the cube){scene}\n");
    for (component, (of, what, _)) in components.iter().zip(TERMS) {
        let [sigma, low, high] = component.sigma().map(|sigma| significant(sigma, 3));
        let name = format!("{what} ({of})");
        let _ = writeln!(out, "  {name:<40}  {sigma:>10}   95 %: {low} to {high}");
    }
    out.push('\n');
    out
}

/// What pixels share, as a scenario's `[camera]` has it: what is not seen is taken as large as it can be.
fn shared(result: &NoiseFound) -> String {
    let Some(components) = &result.three_dimensional else { return String::new() };
    let (spec, mut out) = (&result.scenario.noise, String::new());
    let [pixel, ..] = components[0].sigma();
    for (component, (_, _, key)) in components.iter().zip(TERMS) {
        let Some(key) = key else { continue };
        let stays = matches!(key, "fixed_pattern" | "row_noise" | "column_noise");
        let [sigma, low, high] = component.sigma();
        let (share, at_most) = if low > 0.0 { (sigma / pixel, "") } else { (high / pixel, " # at most") };
        let _ = match spec.netd_k {
            _ if stays && !spec.uniform => {
                writeln!(out, "# {key}: the scene is in it; [noise] uniform = true says that there is none")
            }
            Some(netd_k) => writeln!(out, "{key} = \"{} mK\"{at_most}", significant(1e3 * netd_k * share, 3)),
            None => {
                writeln!(out, "# {key}: {} of the NETD{}", significant(share, 3), at_most.replace(" #", ","))
            }
        };
    }
    out
}

fn indented(text: &str) -> String {
    text.lines().map(|line| format!("  {line}\n")).collect()
}

/// Below the picture of the photon transfer.
pub(crate) fn each_point(common: &Line) -> String {
    format!(
        "Each point: samples of nearly one mean in one band; line: all bands together, one photon = {} unit(s), electronic noise {} electrons.",
        significant(common.per_photon, 3),
        significant(common.noise_electrons(), 3)
    )
}
