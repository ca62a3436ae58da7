//! Which cameras meet a rule, as text: the sentence, a table, then what limits each camera and what would help it.

use super::in_words_of_kind;
use super::market::of_market;
use super::measured::{of_measured, uncertainty, undecided};
use super::stop::{approach, decisions};
use crate::text::columns::aligned;
use crate::text::footing::{ASK_MORE, gaussian, of_scene, warnings};
use crate::text::numbers::{numbers, quantity, significant};
use crate::words::Say;
use crate::words::probability::{demanded, reliability};
use crate::words::shortfall::in_words;
use crate::words::size::rows::in_unit;
use crate::words::warnings::say_the_same;
use crate::words::{companion, conditions, safety};
use hadar::instrument::Readout;
use hadar::policy::{Quantity, Solution};
use hadar::words::share;
use hadar_scenario::Units;
use hadar_scenario::rule::Verdict;
use hadar_study::{
    ApartAnswer, CameraAnswer, CameraVerdict, Fixes, Found, LimitingScene, NotIdentifiable, NotInForce,
    RuleAnswer, RuleStudy, Shortfall, Warning,
};
use std::fmt::Write as _;

/// The answer and everything behind it.
#[must_use]
pub fn text(answer: &RuleAnswer, study: &RuleStudy) -> String {
    let units = answer.rule.scenario.units();
    let mut out = format!("{}\n\n", answer.sentence.say());
    if answer.only().is_none() {
        out.push_str(&overview(answer));
    }
    if let Some(market) = answer.market() {
        let _ = writeln!(out, "Shares: {}\n", of_market(&market));
    }
    for clause in &answer.clauses {
        if let Some(name) = &clause.name {
            let _ = writeln!(out, "{name} ({})", in_words_of_kind(clause.kind));
            if let Some(text) = &clause.text {
                let _ = writeln!(out, "  {text}");
            }
            let _ = writeln!(out, "  {}\n", clause.sentence.say());
        }
        if let Some(stop) = &clause.stop {
            let _ = writeln!(out, "Stop\n  {}\n", decisions(stop, units));
        }
        match &clause.found {
            Found::Apart(apart) => out.push_str(&of_apart(apart, units)),
            Found::Measured(measured) => out.push_str(&of_measured(measured, units)),
        }
    }
    let quotables: Vec<String> = answer
        .clauses
        .iter()
        .filter_map(|clause| {
            let name = clause.name.as_ref().map_or_else(String::new, |name| format!("{name}: "));
            Some(format!("  {name}{}", clause.apart()?.requirement.quotable.say()))
        })
        .collect();
    for camera in &answer.cameras {
        out.push_str(&conditions::paragraph_of(&camera.name, &camera.conditions, camera.passes));
    }
    if answer.cameras.iter().any(|camera| !camera.conditions.is_empty()) {
        let _ = writeln!(out, "{ASK_MORE}\n");
    }
    if !quotables.is_empty() {
        let _ = writeln!(out, "The rule in a sentence\n{}\n", quotables.join("\n"));
    }
    // Once, though several clauses have them: a camera sees alike whatever the clause.
    let companions = answer.clauses.iter().filter_map(|clause| clause.apart()).map(|apart| &apart.companions);
    for found in companions.take(1).flatten() {
        let name = found.camera.as_deref().unwrap_or_default();
        let _ = write!(out, "{name}: {}", companion::text(found, units));
    }
    if let Some(study) = study.study() {
        out.push_str(&of_scene(study, gaussian(study)));
    }
    out.push_str(&warnings(&together(answer)));
    out
}

/// Every camera with the clause that limits it.
fn overview(answer: &RuleAnswer) -> String {
    let mut rows = vec![["camera", "margin", "limited by", "evidence", "meets the rule"].map(str::to_owned)];
    rows.extend(answer.cameras.iter().map(|camera| {
        [
            camera.name.clone(),
            significant(camera.margin, 3),
            camera.limiting_clause.clone().unwrap_or_default(),
            camera.grade.name().to_owned(),
            meets_all(camera),
        ]
    }));
    aligned(&rows, &[1]) + "\n"
}

/// Yes, no or undecided of all clauses, and which do not let it be a yes.
pub(super) fn meets_all(camera: &CameraAnswer) -> String {
    match camera.verdict {
        Verdict::Meets => conditions::yes(&camera.conditions),
        Verdict::Undecided => format!("undecided: {}", camera.undecided.join(", ")),
        Verdict::Fails => format!("no: {}", camera.fails.join(", ")),
    }
}

/// A clause that requires materials to be distinguished: a table, then each camera.
fn of_apart(apart: &ApartAnswer, units: Units) -> String {
    let right = |camera: &CameraVerdict| reliability(camera.statistical_distance);
    let mut rows =
        vec![["camera", "margin", "d at worst", "correct at most", "meets the rule"].map(str::to_owned)];
    rows.extend(apart.cameras.iter().map(|camera| {
        [
            camera.name.clone(),
            significant(camera.margin, 3),
            significant(camera.statistical_distance, 3),
            right(camera),
            meets(camera),
        ]
    }));
    let mut out = aligned(&rows, &[1, 2, 3]);
    let _ = writeln!(
        out,
        "  margin: least d over the operating envelope / {} required ({})\n",
        significant(apart.requirement.distance, 4),
        demanded(apart.requirement.distance)
    );
    for sentence in safety::of_rule(&apart.safety) {
        let _ = writeln!(out, "{sentence}");
    }
    if !apart.safety.is_empty() {
        out.push('\n');
    }
    apart.cameras.iter().for_each(|camera| out.push_str(&details(camera, units)));
    if let Some(part) = &apart.not_identifiable {
        let _ = writeln!(out, "{}\n", no_camera(part).join("\n  "));
    }
    out
}

/// The line above what is said of a rule that does not hold, if it does not.
pub(super) fn idle(of: Option<NotInForce>) -> String {
    of.map_or_else(String::new, |idle| format!("{}\n", idle.say()))
}

/// All warnings; what is said of several cameras is said once, with their names.
pub(crate) fn together(answer: &RuleAnswer) -> Vec<Warning> {
    let mut said: Vec<(&Warning, Vec<&str>)> = Vec::new();
    let lines: Vec<_> = answer.clauses.iter().flat_map(|clause| clause.lines()).collect();
    for camera in &lines {
        for warning in camera.warnings {
            match said.iter_mut().find(|(known, _)| say_the_same(known, warning)) {
                Some((_, names)) if names.contains(&camera.camera) => {}
                Some((_, names)) => names.push(camera.camera),
                None => said.push((warning, vec![camera.camera])),
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

/// Yes, no or undecided, and why.
pub(crate) fn meets(camera: &CameraVerdict) -> String {
    let said = match camera.verdict {
        Verdict::Meets => conditions::yes(&camera.conditions),
        Verdict::Undecided => undecided(&camera.undecided_by, camera.uncertainty.as_ref()),
        Verdict::Fails => format!("no: {}", fails_by(camera)),
    };
    said + &without_placeholders(camera)
}

/// What a camera fails by, in words.
pub(super) fn fails_by(camera: &CameraVerdict) -> String {
    let LimitingScene { target, alternative, .. } = &camera.limiting;
    let words = camera.fails_by.iter().map(|reason| match reason {
        Shortfall::Distance if camera.bands == 1 => {
            format!("one band cannot distinguish {target} from {alternative}")
        }
        Shortfall::Distance => format!("it cannot distinguish {target} from {alternative}"),
        other => in_words(&[*other]),
    });
    words.collect::<Vec<_>>().join("; ")
}

/// What is left of the margin without pairs of placeholders, to end a sentence.
pub(super) fn without_placeholders(camera: &CameraVerdict) -> String {
    camera.without_placeholders.as_ref().map_or_else(String::new, |without| {
        format!("; without pairs of placeholders the margin is {}", significant(without.margin, 3))
    })
}

/// How many bands a camera reads, and how.
pub(crate) fn reading(camera: &CameraVerdict) -> String {
    let how = match camera.readout {
        _ if camera.bands == 1 => return "one band".into(),
        Readout::Simultaneous => "at once",
        Readout::Sequential => "one after the other",
        Readout::FourierTransform => "through an interferometer",
        Readout::Dispersive => "side by side, line by line",
    };
    format!("{} bands {how}, {} for all of them", camera.bands, quantity(camera.sweep_s, "s"))
}

/// What limits a camera, how sure that is, and what would help.
fn details(camera: &CameraVerdict, units: Units) -> String {
    let mut out = format!("{}\n", camera.name);
    let mut line = |label: &str, text: String| {
        let _ = writeln!(out, "  {label:<12} {text}");
    };
    line("bands", reading(camera));
    if let Some(seen) = &camera.approach {
        line("until then", approach(seen, units));
    }
    line("limited by", scene(&camera.limiting, units));
    line("certificate", certified(camera));
    if let Some(found) = &camera.uncertainty {
        line("margin", uncertainty(camera.margin, found).join("\n               "));
    }
    let spoiled: Vec<Shortfall> =
        camera.fails_by.iter().copied().filter(|reason| *reason != Shortfall::Distance).collect();
    if !spoiled.is_empty() {
        // It is that of blur and full well alone.
        let by_exposure = spoiled.iter().any(|by| matches!(by, Shortfall::MotionBlur | Shortfall::FullWell));
        let longest = camera.longest_exposure_s.filter(|_| by_exposure);
        let longest = longest.map_or_else(String::new, |longest| match longest {
            0.0 => ": the frames alone take too long, however short the exposures".into(),
            longest => format!(": exposures of {} and more are too long", quantity(longest, "s")),
        });
        line("fails by", format!("{}{longest}", in_words(&spoiled)));
    }
    if let Some(fixes) = &camera.fixes {
        line("solutions", would_do(fixes, units));
    }
    if let Some(blur) = camera.motion_blur_pixels {
        line("motion blur", format!("{} pixels at the least distance", significant(blur, 2)));
    }
    out.push('\n');
    out
}

/// How sure the limiting scene is, and what that is worth where figures are uncertain.
pub(super) fn certified(camera: &CameraVerdict) -> String {
    let said = camera.certificate.say();
    if camera.uncertainty.is_none() { said } else { said + ", its figures as they are stated" }
}

/// A scene in one line.
pub(crate) fn scene(scene: &LimitingScene, units: Units) -> String {
    let kelvin: Vec<String> = scene.surroundings_k.iter().map(|kelvin| units.temperature(*kelvin)).collect();
    let distance = match scene.distance_m {
        Some(distance) if scene.distance_matters => format!(", {} away", units.length(distance)),
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
        units.temperature(scene.temperature_k),
        scene.alternative
    )
}

/// What would help, each alone.
pub(crate) fn would_do(fixes: &Fixes, units: Units) -> String {
    let texts: Vec<String> = fixes
        .that_do()
        .map(|(quantity, solution, spoiled)| {
            let spoiled =
                if spoiled.is_empty() { String::new() } else { format!(", but: {}", in_words(spoiled)) };
            format!("{}{spoiled}", one(quantity, solution, units))
        })
        .collect();
    if texts.is_empty() {
        let mut reasons = fixes.quantities.0.iter().filter_map(|(_, solution)| solution.reason.as_deref());
        return format!("no quantity alone: {}", reasons.next_back().unwrap_or("no value suffices"));
    }
    format!("alone: {}", texts.join("; or "))
}

fn one(solved: Quantity, solution: &Solution, units: Units) -> String {
    let value = solution.value.map_or_else(|| "-".into(), |value| in_unit(solved, value, units));
    format!("{} {value} (now {})", solved.name(), in_unit(solved, solution.camera, units))
}

/// The part of the envelope that no camera does, line by line.
pub(crate) fn no_camera(part: &NotIdentifiable) -> Vec<String> {
    let found = if part.fraction > 0.0 {
        let part_of = share(part.fraction) + &error(part.standard_error);
        format!("In {part_of} of the operating envelope no camera could meet it")
    } else {
        format!(
            "In all of {} scenes drawn from the operating envelope some camera could meet it",
            part.scenes
        )
    };
    let mut lines = vec![found, part.definition.say()];
    if let Some(near) = &part.neighbourhood {
        lines.push(format!(
            "nine tenths of these scenes are within {} K of equilibrium with the surroundings, unlit share up to {}",
            significant(near.temperature_difference_k, 2),
            significant(near.unlit, 2)
        ));
    }
    let within = part.fraction_within_emissivity_error;
    if within > 0.0 {
        let of = share(within) + &error(part.standard_error_within_emissivity_error);
        lines.push(format!("in {of} {}", part.emissivity_error.say()));
    }
    lines
}

/// The error of a share, behind it.
fn error(share: f64) -> String {
    if share < 1e-6 { String::new() } else { format!(" (+- {} %)", significant(100.0 * share, 2)) }
}
