//! The response of a camera behind a filter wheel, in words.

use crate::text::columns::{Columns, left, right};
use crate::text::footing::{ASSUMPTIONS, warnings};
use hadar::words::{quantity, significant};
use hadar_study::calibrate::{ResponseFound, ResponseRow};
use std::fmt::Write as _;

/// The whole answer.
#[must_use]
pub fn text(result: &ResponseFound) -> String {
    let values = result.response.len();
    let known = result.scenario.response.known();
    let headline = match result.misfit {
        true => {
            "The readings do not fit a response, so that no error or interval below holds (see the warning).\n"
        }
        false => "",
    };
    let mut out = format!(
        "{headline}Of {values} response values the readings determine {}; the rest is the {} curve and that responses are smooth.\n\n",
        result.determined,
        if result.scenario.response.typical.is_some() { "typical" } else { "level" }
    );
    let peak = result.response.iter().map(|row| row.response).fold(0.0, f64::max);
    let relative = |of: &dyn Fn(&ResponseRow) -> f64| {
        let square: f64 = result.response.iter().map(|row| (of(row) / peak).powi(2)).sum();
        100.0 * (square / values.max(1) as f64).sqrt()
    };
    let _ = writeln!(
        out,
        "  determined: directions known to a tenth of the peak by the readings alone (numerical rank {})",
        result.rank
    );
    let _ = writeln!(
        out,
        "  with smoothness: {} numbers are the readings' own; values {} (rms{}; beforehand {} %)",
        significant(result.effective, 3),
        match result.misfit {
            true => "known to no stated share of the peak".to_owned(),
            false => format!("known to {} % of the peak", significant(relative(&|row| row.sigma), 2)),
        },
        match result.misfit {
            true => String::new(),
            false =>
                format!("; {} % if the response has kinks", significant(relative(&|row| row.sigma_kinked), 2)),
        },
        significant(relative(&|row| row.sigma_beforehand), 2)
    );
    let _ = match result.chi_square_reduced {
        Some(chi) => writeln!(
            out,
            "  readings about the fit: chi2/nu {} (nu {})",
            significant(chi, 3),
            significant(result.freedom, 3)
        ),
        None => writeln!(
            out,
            "  readings about the fit: the unknowns fit any readings, so that nothing tests them"
        ),
    };
    let _ = writeln!(
        out,
        "  unit of the response: counts (unit of the cubes) per photon s^-1 m^-2 sr^-1; its peak {}",
        significant(peak, 3)
    );
    if let (Some([low, high]), Some(sigma)) = (result.eta_range, result.eta_sigma) {
        let _ = writeln!(
            out,
            "  relative transmittance of the wheel: {} to {}, each pixel to {}",
            significant(low, 3),
            significant(high, 3),
            significant(sigma, 2)
        );
    }
    if let Some(scene) = &result.scene {
        out.push_str("\nScene: radiance.npy, mean photon radiance over filter and response (photons s^-1 m^-2 sr^-1 per cm^-1)\n");
        let width = result.filters.iter().map(|name| name.chars().count()).max().unwrap_or(0).max(6);
        let mut table = Columns::new([
            left("filter", width),
            right("noise of a sample", 18),
            right("common to all pixels", 20),
            right("with kinks", 10),
        ]);
        for (q, name) in result.filters.iter().enumerate() {
            let sigmas = [scene.sigma_noise[q], scene.sigma_common[q], scene.sigma_common_kinked[q]]
                .map(|x| significant(x, 2));
            table.row(std::iter::once(name.clone()).chain(sigmas));
        }
        out.push_str(&table.text());
    }
    let _ = writeln!(
        out,
        "\n{ASSUMPTIONS}\n  an offset for each filter that stays the same; {} that fill the view (a reference is black); noise of {} (unit of the \
         cubes) in every sample\n  known beforehand: scale to {} %, shape to {} % of the peak, correlated over {} (a quarter there; Matern 5/2: no \
         kinks)\n",
        super::blackbody::sent_by(&result.scenario.blackbodies),
        significant(result.scenario.noise, 3),
        significant(100.0 * known.scale, 2),
        significant(100.0 * known.shape, 2),
        quantity(known.correlation_cm1, "cm^-1")
    );
    out + &warnings(&result.warnings)
}

/// Below the picture of the response.
pub(crate) fn shaded(result: &ResponseFound) -> &'static str {
    match result.misfit {
        true => "The readings do not fit a response: no interval holds, and none is shown.",
        false => "Shaded: 95 %, of the readings together with what is known beforehand.",
    }
}
