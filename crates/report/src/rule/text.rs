//! Which cameras meet a rule, as text: the sentence, a table, then what limits each camera and what would help it.

use crate::size::text::in_unit;
use crate::text::footing::{GAUSSIAN, assumptions, warnings};
use crate::text::numbers::{celsius, numbers, quantity, significant};
use crate::text::shortfalls::no;
use hadar::policy::{Quantity, Solution};
use hadar::words::share;
use hadar_study::study::{
    CameraVerdict, Fixes, LimitingScene, NotIdentifiable, RuleAnswer, RuleStudy, Shortfall, Warning,
};
use hadar_study::words::reliability;
use std::fmt::Write as _;

/// The answer and everything behind it.
#[must_use]
pub fn text(answer: &RuleAnswer, study: &RuleStudy) -> String {
    let mut out = format!("{}\n\n", answer.sentence);
    let width = answer.cameras.iter().map(|camera| camera.name.chars().count()).max().unwrap_or(0).max(6);
    let head = ["meets", "margin", "d at worst", "right at most", "limited by"];
    let _ = writeln!(
        out,
        "{:<width$}  {:<5}  {:>8}  {:>10}  {:>13}  {}",
        "camera", head[0], head[1], head[2], head[3], head[4]
    );
    for camera in &answer.cameras {
        let row = format!(
            "{:<width$}  {:<5}  {:>8}  {:>10}  {:>13}  {}",
            camera.name,
            if camera.passes { "yes" } else { "no" },
            significant(camera.margin, 3),
            significant(camera.statistical_distance, 3),
            reliability(camera.statistical_distance),
            limited_by(camera),
        );
        let _ = writeln!(out, "{row}");
    }
    let _ = writeln!(
        out,
        "  margin: least d over the envelope / {} demanded ({})\n",
        significant(answer.requirement.distance, 4),
        reliability(answer.requirement.distance)
    );
    answer.cameras.iter().for_each(|camera| out.push_str(&details(camera)));
    if let Some(part) = &answer.not_identifiable {
        let _ = writeln!(out, "{}\n", no_camera(part).join("\n  "));
    }
    let _ = writeln!(out, "The rule in a sentence\n  {}\n", answer.requirement.quotable);
    if let Some(study) = study.study() {
        out.push_str(&assumptions(study, GAUSSIAN));
    }
    out.push_str(&warnings(&together(answer)));
    out
}

/// The pair that limits a camera, or what spoils its images where it tells that pair.
fn limited_by(camera: &CameraVerdict) -> String {
    match camera.passes || camera.fails_by.contains(&Shortfall::Distance) {
        true => format!("{} against {}", camera.limiting.target, camera.limiting.alternative),
        false => no(&camera.fails_by),
    }
}

/// All warnings; what is said of several cameras is said once, with their names.
pub(crate) fn together(answer: &RuleAnswer) -> Vec<Warning> {
    let mut said: Vec<(&Warning, Vec<&str>)> = Vec::new();
    for camera in &answer.cameras {
        for warning in &camera.warnings {
            match said.iter_mut().find(|(known, _)| known.says_as(warning)) {
                Some((_, names)) => names.push(&camera.name),
                None => said.push((warning, vec![&camera.name])),
            }
        }
    }
    let all = answer.cameras.len();
    let of_cameras = said.into_iter().map(|(warning, names)| {
        let who = if names.len() == all && all > 1 { "all cameras".into() } else { names.join(", ") };
        warning.clone().of_cameras(&who)
    });
    answer.warnings.iter().cloned().chain(of_cameras).collect()
}

/// What limits a camera, how sure that is, and what would help.
fn details(camera: &CameraVerdict) -> String {
    let mut out = format!("{}\n", camera.name);
    let mut line = |label: &str, text: String| {
        let _ = writeln!(out, "  {label:<12} {text}");
    };
    line("limited by", scene(&camera.limiting));
    line("certificate", camera.certificate.to_string());
    let spoiled: Vec<Shortfall> =
        camera.fails_by.iter().copied().filter(|reason| *reason != Shortfall::Distance).collect();
    if !spoiled.is_empty() {
        let longest = camera.longest_exposure_s.map_or_else(String::new, |longest| {
            format!(": exposures of {} and more are too long", quantity(longest, "s"))
        });
        line("fails by", format!("{}{longest}", in_words(&spoiled)));
    }
    if let Some(fixes) = &camera.fixes {
        line("would do", would_do(fixes));
    }
    if let Some(blur) = camera.motion_blur_pixels {
        line("motion blur", format!("{} pixels at the least distance", significant(blur, 2)));
    }
    out.push('\n');
    out
}

/// A scene in one line.
pub(crate) fn scene(scene: &LimitingScene) -> String {
    let kelvin: Vec<String> = scene.surroundings_k.iter().map(|kelvin| celsius(*kelvin)).collect();
    let distance = match scene.distance_m {
        Some(distance) if scene.distance_matters => format!(", {} m away", significant(distance, 3)),
        Some(_) => ", at any distance".into(),
        None => String::new(),
    };
    let surroundings = if kelvin.is_empty() {
        ", no surroundings".to_owned()
    } else {
        format!("{}, surroundings {}", numbers(", V ", &scene.lighting, 3), kelvin.join(" "))
    };
    format!(
        "{} at {} against {}{surroundings}{distance}",
        scene.target,
        celsius(scene.temperature_k),
        scene.alternative
    )
}

/// What would help, each alone.
pub(crate) fn would_do(fixes: &Fixes) -> String {
    let texts: Vec<String> = fixes
        .that_do()
        .map(|(quantity, solution, spoiled)| {
            let spoiled =
                if spoiled.is_empty() { String::new() } else { format!(", but: {}", in_words(spoiled)) };
            format!("{}{spoiled}", one(quantity, solution))
        })
        .collect();
    if texts.is_empty() {
        let mut reasons = fixes.quantities.0.iter().filter_map(|(_, solution)| solution.reason.as_deref());
        return format!("nothing alone: {}", reasons.next_back().unwrap_or("no value suffices"));
    }
    format!("alone: {}", texts.join("; or "))
}

/// Codes, one after the other.
pub(crate) fn codes(shortfalls: &[Shortfall], between: &str) -> String {
    shortfalls.iter().map(|by| by.code()).collect::<Vec<_>>().join(between)
}

/// What is wrong with an image.
fn in_words(spoiled: &[Shortfall]) -> String {
    let words = spoiled.iter().map(|reason| match reason {
        Shortfall::MotionBlur => "motion blur of a pixel or more",
        Shortfall::MotionUnknown => "motion that is not known without a distance",
        Shortfall::FullWell => "the brightest scene fills the well",
        Shortfall::FrameRate => "longer than a frame",
        Shortfall::Diffraction => "diffraction blurs over more than a pixel",
        Shortfall::LowestNoise => "below what read noise and converter leave",
        other => other.code(),
    });
    words.collect::<Vec<_>>().join(", ")
}

fn one(solved: Quantity, solution: &Solution) -> String {
    let value = solution.value.map_or_else(|| "-".into(), |value| in_unit(solved, value));
    format!("{} {value} (now {})", solved.name(), in_unit(solved, solution.camera))
}

/// The part of the envelope that no camera does, line by line.
pub(crate) fn no_camera(part: &NotIdentifiable) -> Vec<String> {
    let found = if part.fraction > 0.0 {
        let part_of =
            format!("In {} (+- {}) of the envelope", share(part.fraction), error(part.standard_error));
        format!("{part_of} no camera could do it")
    } else {
        format!("In all of {} scenes drawn from the envelope some camera could do it", part.scenes)
    };
    let mut lines = vec![found, part.definition.to_string()];
    if let Some(near) = &part.neighbourhood {
        lines.push(format!(
            "nine tenths of these scenes are within {} K of equilibrium with the surroundings, unlit share up to {}",
            significant(near.temperature_difference_k, 2),
            significant(near.unlit, 2)
        ));
    }
    lines.push(format!(
        "in {} (+- {}) {}",
        share(part.fraction_within_emissivity_error),
        error(part.standard_error_within_emissivity_error),
        part.emissivity_error
    ));
    lines
}

/// The error of a share.
fn error(share: f64) -> String {
    if share < 1e-6 {
        return "0 %".into();
    }
    format!("{} %", significant(100.0 * share, 2))
}
