//! Whether a cube follows its model, in words.

use hadar::words::{significant, whole};
use hadar_study::decompose::{CauseRow, ModelJudged, ModelVerdict};
use std::fmt::Write as _;

/// Causes that are listed.
const LISTED: usize = 6;

/// What all pixels say of the model, in words.
pub(super) fn text(model: &ModelJudged) -> String {
    let mut out = String::new();
    let deviations = |x: f64| significant(x, if x.abs() < 100.0 { 2 } else { 3 });
    if matches!(model.verdict, ModelVerdict::NotJudged | ModelVerdict::SharedNotTold) {
        return "Whether the cube follows its model was not asked: too few pixels are decided, there are as many unknowns as bands, or the method \
                leaves light out\n\n"
            .to_owned();
    }
    let says = match model.verdict {
        ModelVerdict::Rejected => "No",
        _ => "Nothing speaks against it",
    };
    let _ = writeln!(out, "Does the cube follow its model? {says}");
    if let Some((mean, below)) = model.p_value_mean.zip(model.p_value_deviations) {
        let _ = writeln!(
            out,
            "  p-values of {} pixels: mean {}, {} deviations {} a right model's",
            whole(model.pixels as u64),
            significant(mean, 3),
            deviations(below.abs()),
            if below > 0.0 { "below" } else { "above" },
        );
    }
    let worst = model.bands.iter().max_by(|a, b| a.deviations.abs().total_cmp(&b.deviations.abs()));
    if let Some(worst) = worst {
        let _ = writeln!(
            out,
            "  residual in common: {} of a pixel\'s noise at {} cm^-1, the most of {} bands ({} deviations; {} pixels)",
            significant(worst.residual, 2),
            significant(worst.wavenumber_cm1, 5),
            model.bands.len(),
            deviations(worst.deviations.abs()),
            whole(model.pixels_asked as u64),
        );
    }
    let shown: Vec<&CauseRow> = model.causes.iter().filter(|row| row.may_be).take(LISTED).collect();
    if model.verdict == ModelVerdict::Rejected {
        if shown.is_empty() {
            out.push_str("  no single cause that is known explains it\n");
        } else {
            out.push_str("  what would explain most of it, each alone, and what chi^2 falls by:\n");
        }
        for row in shown {
            let _ = writeln!(out, "    {:>10}  {}", significant(row.gain_chi_square, 3), cause(row));
        }
        out.push_str("  the deviations of the temperatures hold what these would do\n");
    } else if let Some(most) = shown.first() {
        let moved = most.temperature_moved.unwrap_or(0.0);
        let _ = writeln!(
            out,
            "  seen, and too little to matter: {}; temperatures move by {} of their deviations",
            cause(most),
            significant(moved, 1)
        );
    }
    out.push('\n');
    out
}

/// A cause and by how much, in words.
pub(crate) fn cause(row: &CauseRow) -> String {
    let amount = |unit: &str, factor: f64| {
        let (estimate, sigma) = (factor * row.estimate, factor.abs() * row.sigma);
        let digits = if sigma > 0.0 && estimate != 0.0 {
            (estimate.abs() / sigma).log10().floor().clamp(0.0, 3.0) as usize + 2
        } else {
            2
        };
        format!("{} +- {}{unit}", significant(estimate, digits.min(4)), significant(sigma, 1))
    };
    let light = row.light.map_or_else(String::new, |k| format!("environment[{k}]"));
    match row.cause {
        "gain" => format!("a gain: all counts larger by {}", amount(" %", 100.0)),
        "wavelength-shift" => format!("bands that lie higher by {}", amount(" cm^-1", 1.0)),
        "light-scale" => format!("{light} stronger by {}", amount(" %", 100.0)),
        "light-tilt" => format!(
            "{light} of another shape: stronger at the upper end of the bands, weaker at the lower one, by {}",
            amount(" %", 100.0)
        ),
        "light-path" => format!("{light} seen through air that is longer by {}", amount(" %", 100.0)),
        "light-temperature" => format!("{light} warmer by {}", amount(" K", 1.0)),
        "lighting-total" => format!("a sum of the lighting factors that is larger by {}", amount("", 1.0)),
        "light-missing" => format!("a light that is missing, with V = {}", amount("", 1.0)),
        "air" => format!("air on the path, {}", amount(" m", 1.0)),
        "band" => {
            format!("band {} (from 0) stronger by {}", row.band.unwrap_or_default(), amount(" %", 100.0))
        }
        "noise" if row.estimate < 0.0 => format!("noise smaller by {}", amount(" %", -100.0)),
        "noise" => format!("noise larger by {}", amount(" %", 100.0)),
        other => other.to_owned(),
    }
}
