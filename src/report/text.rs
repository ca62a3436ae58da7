//! Results as text for people: the answer in a sentence, then the numbers, then what they rest on.

mod apart;
mod bands;
mod camera;
mod exact;
mod footing;
mod many;
mod numbers;
mod pairs;
mod rule;
mod simulation;
mod work;

pub use camera::camera;
pub use many::{answers, check};
pub use numbers::{quantity, significant};
pub use rule::rule;
pub(super) use rule::{no_camera, scene, together, would_do};
pub use simulation::simulation;
pub use work::work;

pub(super) use self::footing::warnings;
use self::footing::{GAUSSIAN, assumptions};
use self::numbers::{celsius, exponential, numbers, photons};
use self::pairs::pair_table;
use crate::policy::Quantity;
use crate::study::{self, PairResult, Sizing, Study};
use std::fmt::Write as _;

/// What every answer about a scene rests on.
pub(super) fn footing_of(study: &Study) -> String {
    assumptions(study, GAUSSIAN)
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
        if let (Some(d), Some(miss), Some(bits)) =
            (pair.statistical_distance, pair.miss_probability, pair.information_bits)
        {
            line(
                "detection probability at most",
                format!("{} (error {})", study::probability(d, 4), significant(miss, 3)),
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
    out.push_str(&assumptions(study, GAUSSIAN));
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
        study::probability(requirement.distance, 4)
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
        numbers(", lighting ", &state.lighting, 3)
    );
    out
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
