//! The main job as text: the verdict first, then the numbers, what would do, and what it hangs on.

use crate::text::footing::{assumptions, gaussian, warnings};
use crate::text::numbers::{numbers, photons, quantity, significant};
use crate::text::pairs::pair_table;
use crate::{classes, companion};
use hadar::policy::{Quantity, Solution};
use hadar::words::share;
use hadar_study::scenario::Units;
use hadar_study::study::{PairResult, Sizing, Study, no_limit};
use hadar_study::words::{demanded_probability, probability};
use std::fmt::Write as _;

/// Share of the draws that settles a question, and how many times the distance of the entries half of them must exceed to say
/// that errors outweigh it.
const SETTLED: f64 = 0.95;
const DROWNED: f64 = 2.0;

/// The verdict and everything behind it.
#[must_use]
pub fn text(result: &Sizing, study: &Study) -> String {
    let mut out = String::new();
    let _ = writeln!(out, "{}\n", result.verdict.sentence);
    let limiting = result.pairs.iter().find(|pair| pair.alternative == result.limiting);
    if let Some(pair) = limiting {
        out.push_str(&readings(pair, result, study));
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
        line("photons at the detector, all bands", significant(camera.photons, 4));
        let of_band = match camera.camera.frames {
            1 => "electronic noise of a band reading",
            _ => "electronic noise of a band",
        };
        line(of_band, format!("{} counts", significant(camera.noise_counts, 4)));
        line("gamma, noise / photons of a band", significant(camera.gamma_per_band, 3));
        line("t A_p / ((1+gamma) F^2)", format!("{} m^2 s", significant(camera.hardware_m2_s, 4)));
        let by_local = no_limit(study.scenario().requirement.by).is_some();
        if let Some(d) = pair.statistical_distance {
            line(
                if by_local { "statistical distance, local" } else { "statistical distance reached" },
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
                if by_local { "probability by it, no limit" } else { "detection probability at most" },
                match miss {
                    0.0 => format!("{} (error below 1e-300)", probability(d, 4)),
                    miss => format!("{} (error {})", probability(d, 4), significant(miss, 3)),
                },
            );
            line("information log2 2P", format!("{} bit", significant(bits, 3)));
        }
        if let (true, Some(d)) = (by_local, pair.statistical_distance_nearest) {
            let limit = format!("{} (probability {})", significant(d, 3), probability(d, 4));
            line("the limit, by the nearest distance", limit);
        }
        line(
            "least distance it resolves",
            format!("{} per sqrt(photon)", significant(camera.least_distance, 3)),
        );
        if let Some(footprint) = camera.footprint_m {
            line("pixel footprint at the target", study.units().length(footprint));
        }
        if let Some(blur) = camera.motion_blur_pixels {
            let of_bands = camera.camera.readout.exposures(study.bands().len()) > 1;
            let label = if of_bands { "motion while bands are exposed" } else { "motion during an exposure" };
            line(label, format!("up to {} pixel", significant(blur, 2)));
        }
        out.push('\n');
    }
    out.push_str(&classes::text(&result.classes));
    out.push_str(&solutions(result, study.units()));
    out.push_str(&sensitivity(result));
    if result.pairs.len() > 1 {
        out.push_str("All alternatives, hardest first\n");
        out.push_str(&pair_table(&result.pairs, study));
        out.push('\n');
    }
    if let Some(found) = &result.companion {
        out.push_str(&companion::text(found, study.units()));
    }
    out.push_str(&assumptions(study, gaussian(study)));
    out.push_str(&warnings(&result.warnings));
    out
}

/// The three readings of the distance, side by side.
fn readings(pair: &PairResult, result: &Sizing, study: &Study) -> String {
    let mut out = String::new();
    let requirement = &result.requirement;
    let _ = writeln!(
        out,
        "What it takes to tell {} from {} with d = {} (probability {}), by three readings",
        pair.target,
        pair.alternative,
        significant(requirement.distance, 4),
        demanded_probability(requirement.distance, 4)
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
        let hardware = hardware.map_or_else(|| "-".into(), |h| significant(h, 2));
        let distance = significant(distance, 3);
        let _ = writeln!(out, "{mark}{label:<34} {distance:>10}  {:>18}  {hardware:>14}", photons(count));
    }
    let state = &pair.nearest_state;
    let _ = writeln!(
        out,
        "  * decides. Nearest state of {} by shot noise: {}{}.\n",
        pair.alternative,
        study.units().temperature(state.temperature_k),
        numbers(", lighting ", &state.lighting, 3)
    );
    out
}

/// What would do, quantity by quantity, and what stands against it.
fn solutions(result: &Sizing, units: Units) -> String {
    let Some(solutions) = &result.solve_for else { return String::new() };
    let head = match result.verdict.met {
        Some(true) => "How far each figure may go, with the rest of the camera as it is",
        _ => "What would meet the requirement, each with the rest of the camera as it is",
    };
    let mut out = format!("{head}\n");
    // Where nothing helps for one and the same reason, that is all there is to say.
    let hopeless = |solution: &Solution| solution.value.is_none() && solution.statistical_distance == 0.0;
    if solutions.0.iter().all(|(_, solution)| hopeless(solution))
        && let Some(reason) = solutions.0.iter().find_map(|(_, solution)| solution.reason.as_ref())
    {
        let _ = writeln!(out, "  nothing: {reason}\n");
        return out;
    }
    for (solved, solution) in &solutions.0 {
        // A speed that was not asked for and cannot be worked out is of no interest.
        if *solved == Quantity::Speed && solution.camera.is_nan() {
            continue;
        }
        let now = if solution.camera.is_finite() {
            // The noise of bands may differ: what is solved for is a factor of them all.
            let factor = match (*solved, solution.value) {
                (Quantity::Noise, Some(value)) if solution.camera > 0.0 => {
                    format!(", times {}", significant(value / solution.camera, 3))
                }
                _ => String::new(),
            };
            format!("(now {}{factor})", in_unit(*solved, solution.camera, units))
        } else {
            String::new()
        };
        let answer = match (solution.value, &solution.reason) {
            (Some(value), None) => format!("{:<18} {now}", in_unit(*solved, value, units)),
            (Some(value), Some(reason)) => format!("{:<18} {now}; {reason}", in_unit(*solved, value, units)),
            (None, Some(reason)) if solution.statistical_distance >= result.requirement.distance => {
                format!("any: {reason}")
            }
            (None, Some(reason)) => format!(
                "none suffices: {reason} (reaches d = {})",
                significant(solution.statistical_distance, 2)
            ),
            (None, None) => "none suffices".into(),
        };
        let name = match solved {
            Quantity::Speed => "speed, at the exposure it takes",
            other => other.name(),
        };
        let _ = writeln!(out, "  {name:<34} {}", answer.trim_end());
        for cap in &solution.caps {
            let side = if cap.blocks { "but" } else { "better" };
            let bound = match (cap.blocks, solved.is_least()) {
                (true, true) | (false, false) => "no more than",
                (true, false) | (false, true) => "no less than",
            };
            let limit = in_unit(*solved, cap.limit, units);
            let _ =
                writeln!(out, "  {:<34} [{}] {side} {bound} {limit}: {}", "", cap.code.name(), cap.reason);
        }
    }
    out.push('\n');
    out
}

pub(crate) fn in_unit(solved: Quantity, value: f64, units: Units) -> String {
    match solved {
        Quantity::Exposure => quantity(value, "s"),
        Quantity::Pixel => quantity(value, "m"),
        Quantity::FNumber => format!("f/{}", significant(value, 3)),
        Quantity::Noise => format!("{} counts", significant(value, 3)),
        Quantity::Frames => format!("{value:.0}"),
        Quantity::Distance => units.length(value),
        Quantity::Speed => units.speed(value),
    }
}

/// What the verdict hangs on, in a few lines.
fn sensitivity(result: &Sizing) -> String {
    let Some(found) = &result.sensitivity else { return String::new() };
    // A distance of 0 hangs on nothing.
    if found.emissivity.distance == 0.0 {
        return String::new();
    }
    let mut out = String::from("What the verdict hangs on\n");
    let levers = found.elasticities.0.iter().filter_map(|(lever, elasticity)| {
        let value = elasticity.as_ref()?.value;
        // What changes nothing is not worth a word.
        (value.abs() >= 5e-3).then(|| format!("{} {value:+.2} %", lever.name()))
    });
    let levers: Vec<String> = levers.collect();
    let levers = if levers.is_empty() { "nothing".into() } else { levers.join(", ") };
    let mut line = |label: &str, text: String| {
        let _ = writeln!(out, "  {label:<34} {text}");
    };
    line("1 % more of it changes d by", levers);
    let of = &found.emissivity;
    if of.error > 0.0 || !of.of_classes.is_empty() {
        let linear = of.sigma_linear.map_or_else(String::new, |sigma| {
            format!("; to first order {} +- {}", significant(of.distance, 2), significant(sigma, 2))
        });
        let [low, middle, high] =
            [of.distance_5, of.distance_50, of.distance_95].map(|distance| significant(distance, 2));
        let spread = format!("d = {middle} ({low} to {high} in 90 % of {} draws){linear}", of.draws);
        let met =
            format!("{} of the draws meet the requirement: {}", share(of.share_met), conclusion(result));
        if of.of_classes.is_empty() {
            line(&format!("emissivities wrong by {} rms", of.error), spread);
            line(&format!("  correlated over {} cm^-1", of.correlation_cm1), met);
        } else {
            line("emissivities scatter as classes say", spread);
            for class in &of.of_classes {
                let how = match class.correlation_cm1 {
                    Some(length) => {
                        format!("{} rms, correlated over {length} cm^-1", significant(class.error, 2))
                    }
                    None => {
                        format!("{} rms, as its {} spectra do", significant(class.error, 2), class.spectra)
                    }
                };
                line(&format!("  {}", class.class), how);
            }
            if of.of_classes.len() == 1 {
                line(
                    "  the other",
                    format!("{} rms, correlated over {} cm^-1", of.error, of.correlation_cm1),
                );
            }
            line("  together", met);
        }
    }
    out.push('\n');
    out
}

/// What errors of the emissivities mean for the distance.
fn conclusion(result: &Sizing) -> String {
    let Some(found) = &result.sensitivity else { return String::new() };
    let of = &found.emissivity;
    let drowned = of.distance_50 > DROWNED * of.distance;
    let what = match (of.distance >= result.requirement.distance, of.share_met) {
        (true, met) if met >= SETTLED => "such errors leave it met",
        (true, _) => "such errors can undo it; measure these emissivities before relying on it",
        (false, met) if met <= 1.0 - SETTLED => "such errors do not make it met",
        (false, _) => "within such errors it may be met or not; measure these emissivities first",
    };
    let more = if drowned {
        ", but look more different than the materials do: d is that of the entries, to be measured"
    } else {
        ""
    };
    format!("{what}{more}")
}
