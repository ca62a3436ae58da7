//! The main job as text: the verdict first, then the numbers, what would do, and what it hangs on.

use super::rows;
use crate::text::footing::{assumptions, of_counts, warnings};
use crate::text::numbers::{numbers, photons, significant};
use crate::text::pairs::pair_table;
use crate::words::Say;
use crate::words::probability::demanded_probability;
use crate::words::size::ROUNDED;
use crate::words::{classes, companion, conditions, safety};
use hadar::words::share;
use hadar_scenario::Units;
use hadar_study::{NearestProof, PairResult, Sizing, Study};
use std::fmt::Write as _;

/// Share of the draws that settles a question, and how many times the distance of the entries half of them must exceed to say
/// that errors outweigh it.
const SETTLED: f64 = 0.95;
const DROWNED: f64 = 2.0;

/// The verdict and everything behind it.
#[must_use]
pub fn text(result: &Sizing, study: &Study) -> String {
    let mut out = String::new();
    let _ = writeln!(out, "{}\n", result.verdict.sentence.say());
    out.push_str(&conditions::paragraph(&result.verdict.conditions, result.verdict.met == Some(true)));
    if !result.safety.is_empty() {
        let _ = writeln!(out, "{}", safety::of_target(&result.safety));
    }
    let limiting = rows::limiting(result);
    if let Some(pair) = limiting {
        out.push_str(&readings(pair, result, study));
    }
    if result.camera.is_some() && limiting.is_some() {
        let name = match (&result.camera, study.scenario().camera.as_ref()) {
            (Some(camera), Some(spec)) if spec.preset.is_some() => format!("Camera {}", camera.camera.name),
            _ => "The camera".to_owned(),
        };
        let _ = writeln!(out, "{name} in this scene");
        for row in rows::of_camera(result, study) {
            let _ = writeln!(out, "  {:<33}  {}", row.label, row.value);
        }
        out.push('\n');
    }
    let of_object = rows::of_object(result);
    if !of_object.is_empty() {
        let _ = writeln!(out, "All readings of the object together");
        for row in of_object {
            let _ = writeln!(out, "  {:<33}  {}", row.label, row.value);
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
    out.push_str(&assumptions(study, of_counts(study, &result.pairs)));
    out.push_str(&warnings(&result.warnings));
    out
}

/// The verdict and what it rests on, and no more.
#[must_use]
pub fn check(result: &Sizing) -> String {
    let verdict = &result.verdict;
    format!(
        "{}\n\n{}",
        verdict.sentence.say(),
        conditions::paragraph(&verdict.conditions, verdict.met == Some(true))
    )
}

/// The three readings of the distance, side by side.
fn readings(pair: &PairResult, result: &Sizing, study: &Study) -> String {
    let mut out = String::new();
    let requirement = &result.requirement;
    let _ = writeln!(
        out,
        "Required to distinguish {} from {} with d = {} (probability {}), by three distances",
        pair.target,
        pair.alternative,
        significant(requirement.distance, 4),
        demanded_probability(requirement.distance, 4)
    );
    let _ =
        writeln!(out, "  {:<34} {:>10}  {:>18}  {:>14}", "reading", "distance", "photons", "H_req [m^2 s]");
    let (n, h) = (requirement.photons_by, requirement.hardware_by_m2_s);
    let rows = [
        ("nearest", "nearest distance (the limit)", pair.distance_nearest, n.nearest, h.nearest),
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
    let [least, enough] = requirement.photons_bounds;
    let apart = least.is_some_and(|least| enough.is_none_or(|enough| enough > least * (1.0 + ROUNDED)));
    if pair.proof == NearestProof::Searched && apart {
        let enough = match requirement.photons {
            Some(enough) => format!("{} photons suffice by the proof", significant(enough, 3)),
            None => "by the proof no number of photons is known to suffice".into(),
        };
        let lower = significant(pair.distance_nearest_lower, 3);
        let _ = writeln!(out, "  The nearest distance is the best of a search; {lower} is proved: {enough}.");
    }
    let state = &pair.nearest_state;
    let _ = writeln!(
        out,
        "  * used for the verdict. Closest confuser with shot noise alone: {} at {}{}.\n",
        pair.alternative,
        study.units().temperature(state.temperature_k),
        numbers(", lighting ", &state.lighting, 3)
    );
    out
}

/// What would do, quantity by quantity, and what stands against it.
pub(crate) fn solutions(result: &Sizing, units: Units) -> String {
    if result.solve_for.is_none() {
        return String::new();
    }
    let head = match result.verdict.met {
        Some(true) => {
            "Values up to which each figure meets the requirement, the rest of the camera unchanged"
        }
        _ => "Values that meet the requirement, one quantity at a time, the rest of the camera unchanged",
    };
    let mut out = format!("{head}\n");
    let solved = rows::solved(result, units);
    if let [rows::Solved { label: "", value, .. }] = solved.as_slice() {
        let _ = writeln!(out, "  {value}\n");
        return out;
    }
    for row in solved {
        let now = if row.now.is_empty() { String::new() } else { format!("({})", row.now) };
        let answer = match row.found {
            true => format!("{:<18} {now}{}", row.value, row.remark),
            false => row.value,
        };
        let _ = writeln!(out, "  {:<33}  {}", row.label, answer.trim_end());
        for cap in row.caps {
            let _ = writeln!(out, "  {:<33}  {cap}", "");
        }
    }
    out.push('\n');
    out
}

/// What the verdict hangs on, in a few lines.
fn sensitivity(result: &Sizing) -> String {
    let Some(found) = &result.sensitivity else { return String::new() };
    // A distance of 0 hangs on nothing.
    if found.emissivity.distance == 0.0 {
        return String::new();
    }
    let mut out = String::from("Sensitivity of the verdict\n");
    let levers = found.elasticities.0.iter().filter_map(|(lever, elasticity)| {
        let value = elasticity.as_ref()?.value;
        // What changes nothing is not worth a word.
        (value.abs() >= 5e-3).then(|| format!("{} {value:+.2} %", lever.name()))
    });
    let levers: Vec<String> = levers.collect();
    let levers = if levers.is_empty() { "nothing".into() } else { levers.join(", ") };
    let mut line = |label: &str, text: String| {
        let _ = writeln!(out, "  {label:<33}  {text}");
    };
    line("1 % more of each changes d by", levers);
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
            line("emissivities scatter as in their classes", spread);
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
        (true, met) if met >= SETTLED => "it remains met with such errors",
        (true, _) => "with such errors it may not be met; measure these emissivities before relying on it",
        (false, met) if met <= 1.0 - SETTLED => "it remains unmet with such errors",
        (false, _) => "with such errors it may be met or not; measure these emissivities first",
    };
    let more = if drowned {
        ", but the errors exceed the difference of the materials: d is that of the tabulated values, which must be measured"
    } else {
        ""
    };
    format!("{what}{more}")
}
