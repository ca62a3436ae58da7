//! Results as text for people: the answer in a sentence, then the numbers, then what they rest on.

mod many;
mod simulation;

pub use many::{answers, check, work, work_of};
pub use simulation::simulation;

use crate::instrument::{Camera, Figures, NoiseSpec};
use crate::policy::Quantity;
use crate::scenario::{Nuisance, Unknown};
use crate::study::{Identification, PairResult, Sizing, Study, Warning};
use std::fmt::Write as _;

/// A number with `digits` significant digits, plain where that is short, else in powers of ten.
#[must_use]
pub fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let exponent = value.abs().log10().floor() as i32;
    let last = digits.saturating_sub(1);
    if (-4..6).contains(&exponent) {
        let decimals = usize::try_from(last as i32 - exponent).unwrap_or(0);
        format!("{value:.decimals$}")
    } else {
        format!("{value:.last$e}")
    }
}

/// A length, time or such with a unit that keeps the number short.
#[must_use]
pub fn quantity(value: f64, unit: &str) -> String {
    for (factor, prefix) in [(1.0, ""), (1e3, "m"), (1e6, "u"), (1e9, "n")] {
        if value * factor >= 1.0 {
            return format!("{} {prefix}{unit}", significant(value * factor, 3));
        }
    }
    format!("{} {unit}", significant(value, 3))
}

/// A number in powers of ten with `decimals` decimals; a plain 0.
fn exponential(value: f64, decimals: usize) -> String {
    if value == 0.0 { "0".into() } else { format!("{value:.decimals$e}") }
}

fn photons(count: Option<f64>) -> String {
    count.map_or_else(|| "no number suffices".into(), |count| format!("{count:.2e}"))
}

fn celsius(kelvin: f64) -> String {
    format!("{:.2} degC", kelvin - 273.15)
}

/// The verdict and everything behind it.
#[must_use]
pub fn sizing(result: &Sizing, study: &Study) -> String {
    let mut out = String::new();
    let _ = writeln!(out, "{}\n", result.verdict.sentence);
    let limiting = result.pairs.iter().find(|pair| pair.alternative == result.limiting);
    if let Some(pair) = limiting {
        out.push_str(&readings(pair, result));
    }
    if let (Some(camera), Some(pair)) = (&result.camera, limiting) {
        let name = if study.scenario().camera.as_ref().is_some_and(|spec| spec.preset.is_some()) {
            format!("Camera {}", camera.camera.name)
        } else {
            "The camera".to_owned()
        };
        let _ = writeln!(out, "{name} in this scene");
        let mut line = |label: &str, text: String| {
            let _ = writeln!(out, "  {label:<34} {text}");
        };
        line("photons at the detector, all bands", exponential(camera.photons, 3));
        let of_band = match camera.camera.frames {
            1 => "electronic noise of a band reading",
            _ => "electronic noise of a band",
        };
        line(of_band, format!("{} counts", exponential(camera.noise_counts, 3)));
        line("gamma, noise / photons of a band", exponential(camera.gamma_per_band, 2));
        line("t A_p / ((1+gamma) F^2)", format!("{:.3e} m^2 s", camera.hardware_m2_s));
        if let Some(d) = pair.statistical_distance {
            line(
                "statistical distance reached",
                format!(
                    "{} (required {})",
                    significant(d, 3),
                    significant(result.verdict.required_distance, 4)
                ),
            );
        }
        if let (Some(p), Some(miss), Some(bits)) =
            (pair.detection_probability, pair.miss_probability, pair.information_bits)
        {
            line(
                "detection probability at most",
                format!("{} (error {})", significant(p, 4), significant(miss, 3)),
            );
            line("information log2 2P", format!("{} bit", significant(bits, 3)));
        }
        line("least distance it resolves", format!("{:.2e} per sqrt(photon)", camera.least_distance));
        if let Some(footprint) = camera.footprint_m {
            line("pixel footprint at the target", quantity(footprint, "m"));
        }
        if let Some(blur) = camera.motion_blur_pixels {
            line("motion during an exposure", format!("{} pixel at most", significant(blur, 2)));
        }
        out.push('\n');
    }
    out.push_str(&solutions(result));
    if result.pairs.len() > 1 {
        out.push_str("All alternatives, hardest first\n");
        out.push_str(&pair_table(&result.pairs, study));
        out.push('\n');
    }
    out.push_str(&assumptions(study));
    out.push_str(&warnings(&result.warnings));
    out
}

/// The three readings of the distance, side by side.
fn readings(pair: &PairResult, result: &Sizing) -> String {
    let mut out = String::new();
    let requirement = &result.requirement;
    let _ = writeln!(
        out,
        "What it takes to tell {} from {} with d = {} (probability {}), by three readings",
        pair.target,
        pair.alternative,
        significant(requirement.distance, 4),
        significant(requirement.detection_probability, 4)
    );
    let _ =
        writeln!(out, "  {:<34} {:>10}  {:>18}  {:>14}", "reading", "distance", "photons", "H_req [m^2 s]");
    let (n, h) = (requirement.photons_by, requirement.hardware_by_m2_s);
    let rows = [
        ("nearest", "nearest state (the limit)", pair.distance_nearest, n.nearest, h.nearest),
        ("local", "local, calibrated (S27)", pair.distance_local, n.local, h.local),
        (
            "local-unknown-gain",
            "local, unknown gain (S29)",
            pair.distance_local_unknown_gain,
            n.local_unknown_gain,
            h.local_unknown_gain,
        ),
    ];
    for (key, label, distance, count, hardware) in rows {
        let mark = if key == requirement.by { "* " } else { "  " };
        let hardware = hardware.map_or_else(|| "-".into(), |h| format!("{h:.1e}"));
        let _ = writeln!(out, "{mark}{label:<34} {distance:>10.2e}  {:>18}  {hardware:>14}", photons(count));
    }
    let state = &pair.nearest_state;
    let _ = writeln!(
        out,
        "  * decides. Nearest state of {} by shot noise: {}{}.\n",
        pair.alternative,
        celsius(state.temperature_k),
        listed(", lighting ", &state.lighting, 3)
    );
    out
}

/// Numbers with `decimals` decimals behind a label; nothing where there are none.
fn listed(label: &str, values: &[f64], decimals: usize) -> String {
    let values: Vec<String> = values.iter().map(|value| format!("{value:.decimals$}")).collect();
    if values.is_empty() { String::new() } else { format!("{label}{}", values.join(" ")) }
}

fn solutions(result: &Sizing) -> String {
    let Some(solutions) = &result.solve_for else { return String::new() };
    let mut out =
        String::from("What would meet the requirement, each with the rest of the camera as it is\n");
    for (quantity_solved, solution) in &solutions.0 {
        let show = |value: f64| match quantity_solved {
            Quantity::Exposure => quantity(value, "s"),
            Quantity::Pixel => quantity(value, "m"),
            Quantity::FNumber => format!("f/{}", significant(value, 3)),
            Quantity::Noise => format!("{} counts", exponential(value, 2)),
            Quantity::Frames => format!("{value:.0}"),
        };
        let answer = match (solution.value, &solution.reason) {
            (Some(value), _) => format!("{:<18} (now {})", show(value), show(solution.camera)),
            (None, Some(reason)) => format!(
                "none suffices: {reason} (reaches d = {})",
                significant(solution.statistical_distance, 2)
            ),
            (None, None) => "none suffices".into(),
        };
        let _ = writeln!(out, "  {:<34} {answer}", quantity_solved.name());
    }
    out.push('\n');
    out
}

/// Distances to all alternatives.
fn identification(result: &Identification, study: &Study) -> String {
    let mut out = many::verdict(result, study);
    out.push_str(&pair_table(&result.pairs, study));
    out.push_str(&many::prediction(result));
    out.push('\n');
    out
}

/// What results rest on, and what the reader must know.
fn footing(result: &Identification, study: &Study) -> String {
    assumptions(study) + &warnings(&result.warnings)
}

/// The pairs, that which is hardest to tell apart by the distance that decides first.
fn pair_table(pairs: &[PairResult], study: &Study) -> String {
    let kind = study.scenario().requirement.by;
    let decisive = |pair: &PairResult| pair.statistical_distance.unwrap_or_else(|| pair.distance(kind));
    let with_camera = pairs.iter().any(|pair| pair.statistical_distance.is_some());
    let width = pairs.iter().map(|pair| pair.alternative.len()).max().unwrap_or(0).max(11);
    let mut out = String::new();
    let _ = write!(
        out,
        "  {:<width$}  {:>9}  {:>9}  {:>9}  {:>18}  {:>24}",
        "alternative", "nearest", "local", "S29", "photons required", "nearest state"
    );
    let _ = writeln!(out, "{}", if with_camera { "    camera d  told apart" } else { "" });
    let mut sorted: Vec<&PairResult> = pairs.iter().collect();
    sorted.sort_by(|a, b| decisive(a).total_cmp(&decisive(b)));
    for pair in sorted {
        let nearest = &pair.nearest_state;
        let state = celsius(nearest.temperature_k) + &listed(", V ", &nearest.lighting, 2);
        let _ = write!(
            out,
            "  {:<width$}  {:>9}  {:>9}  {:>9}  {:>18}  {state:>24}",
            pair.alternative,
            exponential(pair.distance_nearest, 2),
            exponential(pair.distance_local, 2),
            exponential(pair.distance_local_unknown_gain, 2),
            photons(pair.photons_required)
        );
        let reached =
            pair.statistical_distance.map_or_else(String::new, |d| format!("  {:>10}", exponential(d, 2)));
        let told = pair.told_apart.map_or("", |told| if told { "         yes" } else { "          no" });
        let _ = writeln!(out, "{reached}{told}");
    }
    out
}

/// What is unknown, and what is known of it beforehand.
fn unknown(unknown: &Unknown) -> String {
    let named = unknown.nuisances.iter().map(|nuisance| {
        let unit = match nuisance {
            Nuisance::Temperature | Nuisance::EnvironmentTemperature => " K",
            Nuisance::Lighting | Nuisance::Gain => "",
        };
        let prior = unknown.priors.get(nuisance).map(|sigma| format!("known to +- {sigma}{unit}"));
        let total = unknown.lighting_total.filter(|_| *nuisance == Nuisance::Lighting);
        let total = total.map(|total| format!("total known to be {total}"));
        let known: Vec<String> = [prior, total].into_iter().flatten().collect();
        match known.as_slice() {
            [] => nuisance.name().to_owned(),
            known => format!("{} ({})", nuisance.name(), known.join(", ")),
        }
    });
    let named: Vec<String> = named.collect();
    if named.is_empty() { "nothing but the material".into() } else { named.join(", ") }
}

fn assumptions(study: &Study) -> String {
    let scenario = study.scenario();
    let unknown = unknown(&scenario.unknown);
    let bands = study.bands().bands();
    let (low, high) =
        (bands.first().map_or(0.0, |b| b.center_cm1), bands.last().map_or(0.0, |b| b.center_cm1));
    // As short as they were written, without the digits of a converted wavelength.
    let (low, high) = ((low * 100.0).round() / 100.0, (high * 100.0).round() / 100.0);
    let mut out = String::from("Assumptions\n");
    let _ = writeln!(out, "  unknown besides the material: {unknown}");
    let count = study.bands().len();
    let _ = writeln!(
        out,
        "  {count} band{} centred from {low} to {high} cm^-1",
        if count == 1 { "" } else { "s" }
    );
    out.push_str(
        "  opaque Lambertian target that fills the pixel, one scattering, no atmosphere on the path\n",
    );
    out.push_str(
        "  counts large enough to be Gaussian; two equally likely materials; d is a limit, not a promise\n",
    );
    if study.camera().is_some() {
        out.push_str("  every band is read by every pixel with the whole exposure; all photons are counted (quantum efficiency 1)\n");
    }
    out
}

fn warnings(warnings: &[Warning]) -> String {
    if warnings.is_empty() {
        return String::new();
    }
    let mut out = String::from("Warnings\n");
    // One line per code: a whole library would otherwise bury the answer.
    for (i, warning) in warnings.iter().enumerate() {
        if warnings[..i].iter().any(|earlier| earlier.code == warning.code) {
            continue;
        }
        let more = warnings[i + 1..].iter().filter(|later| later.code == warning.code).count();
        let rest =
            if more > 0 { format!(" (and {more} more of this kind, see --json)") } else { String::new() };
        let _ = writeln!(out, "  [{}] {}{rest}", warning.code, warning.message);
    }
    out
}

/// A camera with its figures and where they are from.
#[must_use]
pub fn camera(camera: &Camera, figures: &Figures) -> String {
    let mut out = format!("{}: {}\n\n", camera.name, camera.description);
    let mut line = |label: &str, text: String| {
        let _ = writeln!(out, "  {label:<34} {text}");
    };
    line("exposure", quantity(camera.exposure_s, "s"));
    line("pixel", quantity(camera.pixel_m, "m"));
    line("f-number", format!("f/{}", camera.f_number));
    line("focal length", quantity(camera.focal_length_m, "m"));
    line("optics efficiency", format!("{}", camera.optics_efficiency));
    line("noise", noise(camera));
    line("flicker share of noise variance", format!("{}", camera.flicker_fraction));
    line("readout", camera.readout.name().into());
    let [low, high] = camera.spectral_range_cm1;
    line("spectral range", format!("{low} to {high} cm^-1"));
    let _ = writeln!(out, "\nOne exposure of a blackbody at {}", celsius(figures.reference_temperature_k));
    let mut line = |label: &str, text: String| {
        let _ = writeln!(out, "  {label:<34} {text}");
    };
    line("photons", format!("{:.2e}", figures.photons));
    line("noise of a band reading", format!("{:.2e} counts", figures.noise_counts));
    line(&format!("gamma of a band, {} bands", figures.bands), format!("{:.1e}", figures.gamma_per_band));
    line("t A_p / ((1+gamma) F^2)", format!("{:.2e} m^2 s", figures.hardware_m2_s));
    out.push_str("\nProvenance\n");
    for note in &camera.provenance {
        let _ = writeln!(out, "  - {note}");
    }
    out
}

fn noise(camera: &Camera) -> String {
    match camera.noise {
        NoiseSpec::None => "none".into(),
        NoiseSpec::Netd { netd_k, temperature_k, .. } => {
            format!("NETD {} at {}", quantity(netd_k, "K"), celsius(temperature_k))
        }
        NoiseSpec::Detectivity { detectivity_cm_hz05_w } => {
            format!("D* {detectivity_cm_hz05_w:.2e} cm Hz^0.5/W")
        }
        NoiseSpec::Counts { sigma_counts } => format!("{sigma_counts:.2e} counts"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_keep_their_digits() {
        assert_eq!(significant(0.056_23, 3), "0.0562");
        assert_eq!(significant(663_212.0, 3), "663212");
        assert_eq!(significant(6.632e8, 3), "6.63e8");
        assert_eq!(quantity(12e-6, "m"), "12.0 um");
        assert_eq!(quantity(0.012, "s"), "12.0 ms");
        assert_eq!(quantity(0.0, "s"), "0 s");
    }
}
