//! What was estimated for the whole cube, in words.

use hadar::words::{significant, whole};
use hadar_study::decompose::{SharedFound, SharedRow};
use std::fmt::Write as _;

/// Share of its stated deviation above which an unknown is hardly told.
const HARDLY: f64 = 0.9;

/// The unknowns, one a line.
pub(super) fn text(found: &SharedFound) -> String {
    let mut out = match found.pixels {
        0 => "Shared by all pixels: nothing could be estimated, as most pixels have several candidates; the stated deviations stay\n".to_owned(),
        pixels => format!("Shared by all pixels, and estimated with {} of them\n", whole(pixels as u64)),
    };
    for row in &found.unknowns {
        let _ = writeln!(out, "  {}", line(row, &found.unknowns));
    }
    if (found.noise_factor - 1.0).abs() > 1e-12 {
        let _ = writeln!(out, "  noise: {} times its stated deviation", significant(found.noise_factor, 3));
    }
    if !found.settled && found.pixels > 0 {
        out.push_str("  the estimates did not settle: nothing is decided by them\n");
    }
    out.push_str("  their deviations are in those of the temperatures; lighting factors and texture are those at the estimates\n\n");
    out
}

fn line(row: &SharedRow, all: &[SharedRow]) -> String {
    let (factor, unit) = match row.stated.unit {
        "" if row.stated.unknown != "light-missing" => (100.0, " %"),
        "" => (1.0, ""),
        unit => (1.0, unit),
    };
    let space = if unit.is_empty() || unit.starts_with(' ') { "" } else { " " };
    let (estimate, sigma, stated) =
        (factor * row.estimate, factor * row.sigma, factor * row.stated.sigma_stated);
    // As many digits as the deviation leaves.
    let digits = if estimate == 0.0 { 1.0 } else { (estimate.abs() / sigma).log10().floor() + 2.0 };
    let mut out = format!(
        "{}: {} +- {}{space}{unit} (told: 0 +- {}{space}{unit})",
        name(row),
        significant(estimate, digits.clamp(1.0, 6.0) as usize),
        significant(sigma, 1),
        significant(stated, 2),
    );
    if row.sigma > HARDLY * row.stated.sigma_stated {
        out.push_str("; the pixels hardly determine it");
    }
    for other in row.same_as.iter().filter_map(|i| all.get(*i)) {
        let _ = write!(out, "; the pixels do not distinguish it from {}", name(other));
    }
    out
}

fn name(row: &SharedRow) -> String {
    named(row.stated.unknown, row.stated.light, row.stated.order)
}

/// An unknown of the whole cube by its name.
pub(crate) fn named(unknown: &str, light: Option<usize>, order: Option<usize>) -> String {
    let light = light.map_or_else(String::new, |k| format!(" of environment[{k}]"));
    match unknown {
        "gain" => "gain".to_owned(),
        "wavelength-shift" => "wavelength shift".to_owned(),
        "light-scale" => format!("strength{light}"),
        "light-shape" => format!("shape{light}, Legendre polynomial {}", order.unwrap_or(1)),
        "light-path" => format!("path of the light{light} through the air"),
        "light-temperature" => format!("temperature{light}"),
        "light-missing" => "V of another light".to_owned(),
        "air" => "length of the air's path".to_owned(),
        other => other.to_owned(),
    }
}
