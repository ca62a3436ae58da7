//! The noise of a camera, in words.

mod three_dimensional;

use self::three_dimensional::{in_three_dimensions, shared};
use crate::text::footing::{ASSUMPTIONS, read_as, warnings};
use hadar::units::Dimension;
use hadar::words::{significant, whole};
use hadar_estimate::calibrate::Line;
use hadar_study::calibrate::{NoiseFound, PhotonNoise};
use std::fmt::Write as _;

/// The whole answer.
#[must_use]
pub fn text(result: &NoiseFound) -> String {
    let mut out = format!("{}\n\n", sentence(result));
    // The others are of the same shape.
    out.extend(result.read.first().map(read_as));
    out.extend(result.photons.as_ref().map(of_photons));
    out += &in_three_dimensions(result);
    if let Some(camera) = camera(result) {
        let _ = writeln!(out, "For a scenario\n{}", indented(&camera));
    }
    let _ = writeln!(out, "{ASSUMPTIONS}");
    out += &result.photons.as_ref().map_or_else(|| of_frames(result), |photons| assumed(photons, result));
    out + &warnings(&result.warnings)
}

/// The line that was fitted.
fn of_photons(found: &PhotonNoise) -> String {
    let mut out = String::from("Variance of a sample of mean m (unit of the cube), all bands\n");
    let common = &found.transfer.common;
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
    if found.gain_deviation.is_some() {
        out += &line("c, spread of gains squared", of(common.spread, common.sigma_spread));
    }
    out += &line("1/b, photons per unit", found.photons_per_unit);
    out += &line("sqrt(a)/b, noise of a reading (e-)", found.noise_electrons);
    let _ = writeln!(
        out,
        "  {}; own lines of all {} bands are in noise.csv\n",
        match found.transfer.chi_square_reduced.is_nan() {
            true => "so few bands do not show whether they have a line in common".to_owned(),
            false => format!(
                "bands about their common line: chi2/nu {}, by chance below {} (99.9 %)",
                significant(found.transfer.chi_square_reduced, 2),
                significant(found.transfer.chi_square_limit, 2)
            ),
        },
        found.transfer.bands.len()
    );
    out
}

/// That frames were compared.
fn of_frames(result: &NoiseFound) -> String {
    format!(
        "  {} frames of one scene that did not change; a pixel is compared with itself.\n\n",
        result.frames
    )
}

/// What a photon transfer takes for granted, and what it left out.
fn assumed(found: &PhotonNoise, result: &NoiseFound) -> String {
    let how = match found.transfer.uneven {
        None => of_frames(result).trim_end().to_owned(),
        Some(uneven) => format!(
            "  one frame: neighbours of a row are compared, {} % of them, as many of bright as of dark ones, left out as different;\n  \
             texture that three neighbouring bands share is taken out (at most {} of the noise of a band).",
            significant(100.0 * uneven, 2),
            significant(found.transfer.bands.iter().map(|band| band.texture).fold(0.0, f64::max), 2)
        ),
    };
    format!(
        "{how}\n  {} % of the differences are left out as beyond 6 deviations; a band's sigma (sigma.csv) is that at the mean of all its samples.\n  \
         Poissonian photons; a sample without light is {}.\n  \
         {}\n  \
         Noise of whole rows or of all bands alike is in these figures, but what follows from several samples by them errs by more than it\n  \
         says.\n\n",
        significant(100.0 * found.transfer.outliers, 2),
        significant(result.scenario.noise.dark_level, 4),
        independent(result)
    )
}

/// Which noise is independent by its correlations, and what nobody looked at.
fn independent(result: &NoiseFound) -> String {
    let of: Vec<String> = result
        .correlations
        .iter()
        .map(|of| format!("{} of {} (at most {})", significant(of.value, 2), of.of, significant(of.limit, 1)))
        .collect();
    let unseen: Vec<&str> = ["frames", "rows", "columns"]
        .into_iter()
        .filter(|dimension| result.correlations.iter().all(|of| of.of != *dimension))
        .chain(["bands"])
        .collect();
    let seen = match of.is_empty() {
        true => String::new(),
        false => {
            format!("Noise of neighbours that is independent; its correlation is {}.\n  ", of.join(", "))
        }
    };
    format!("{seen}That a camera does not filter along {} is not checked.", unseen.join(", "))
}

fn sentence(result: &NoiseFound) -> String {
    let usable = result.photons.as_ref().filter(|photons| photons.usable);
    let is_even = result.scenario.noise.uniform && result.is_independent();
    if let (None, true, Some(terms)) = (usable, is_even, &result.three_dimensional) {
        let of = |place: usize| significant(terms[place].sigma()[0], 3);
        return format!(
            "In addition to {} of each pixel from frame to frame, {} remain from pixel to pixel, {} from row to row and {} from column to column (unit of \
             the cube); frames of one brightness do not distinguish photons from electronic noise.",
            of(0),
            of(1),
            of(2),
            of(3)
        );
    }
    if !result.is_independent() {
        return format!(
            "No noise follows from these {} samples: theirs goes together from pixel to pixel or from frame to frame, see the warnings.",
            whole((result.shape.len() * result.frames) as u64)
        );
    }
    let Some(PhotonNoise { photons_per_unit, noise_electrons, .. }) = usable else {
        return format!(
            "No camera's figures follow from these {} samples: see the warnings; variances of the bands are measured all the same.",
            whole((result.shape.len() * result.frames) as u64)
        );
    };
    let ([photons, low, high], [noise, least, most]) = (*photons_per_unit, *noise_electrons);
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
    let Some(photons) = result.photons.as_ref().filter(|photons| photons.usable) else {
        // Frames of one brightness tell what pixels share, if not photons.
        let is_even = result.scenario.noise.uniform && result.is_independent();
        let rows = if is_even { shared(result) } else { String::new() };
        return (!rows.is_empty()).then(|| format!("[camera]\n{rows}"));
    };
    let ([photons, ..], [noise, least, most]) = (photons.photons_per_unit, photons.noise_electrons);
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
