//! Which cameras meet a rule, as text: the sentence, a table, then what limits each camera and what would help it.

use super::stop::{approach, decisions, metres};
use crate::companion;
use crate::size::text::in_unit;
use crate::text::footing::{gaussian, of_scene, warnings};
use crate::text::numbers::{numbers, quantity, significant};
use hadar::instrument::Readout;
use hadar::policy::{Quantity, Solution};
use hadar::words::share;
use hadar_study::scenario::Units;
use hadar_study::scenario::rule::Verdict;
use hadar_study::study::{
    ApartAnswer, CameraVerdict, Fixes, Found, LimitingScene, MarginUncertainty, Measure, MeasuredAnswer,
    MeasuredScene, MeasuredVerdict, NotIdentifiable, RuleAnswer, RuleStudy, Shortfall, Warning,
};
use hadar_study::words::{demanded, reliability};
use std::fmt::Write as _;

/// The answer and everything behind it.
#[must_use]
pub fn text(answer: &RuleAnswer, study: &RuleStudy) -> String {
    let units = answer.rule.scenario.units();
    let mut out = format!("{}\n\n", answer.sentence);
    if answer.only().is_none() {
        out.push_str(&overview(answer));
    }
    for clause in &answer.clauses {
        if let Some(name) = &clause.name {
            let _ = writeln!(out, "{name} ({})", in_words_of_kind(clause.kind));
            if let Some(text) = &clause.text {
                let _ = writeln!(out, "  {text}");
            }
            let _ = writeln!(out, "  {}\n", clause.sentence);
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
            Some(format!("  {name}{}", clause.apart()?.requirement.quotable))
        })
        .collect();
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
        let verdict = match (camera.verdict, &camera.provided) {
            (Verdict::Meets, None) => "yes".to_owned(),
            (Verdict::Meets, Some(proviso)) => format!("yes, if {proviso}"),
            (Verdict::Undecided, _) => format!("undecided: {}", camera.undecided.join(", ")),
            (Verdict::Fails, _) => format!("no: {}", camera.fails.join(", ")),
        };
        [
            camera.name.clone(),
            significant(camera.margin, 3),
            camera.limiting_clause.clone().unwrap_or_default(),
            camera.grade.name().to_owned(),
            verdict,
        ]
    }));
    columns(&rows, &[1]) + "\n"
}

/// Rows with their columns below each other, those of numbers to the right; the last one as it is.
pub(super) fn columns<const N: usize>(rows: &[[String; N]], numbers: &[usize]) -> String {
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..N).map(width).collect();
    let mut out = String::new();
    for row in rows {
        let cells = row.iter().zip(&widths).enumerate().map(|(column, (cell, width))| {
            if numbers.contains(&column) { format!("{cell:>width$}") } else { format!("{cell:<width$}") }
        });
        out.push_str(cells.collect::<Vec<_>>().join("  ").trim_end());
        out.push('\n');
    }
    out
}

/// A clause that tells materials apart: a table, then each camera.
fn of_apart(apart: &ApartAnswer, units: Units) -> String {
    let right = |camera: &CameraVerdict| reliability(camera.statistical_distance);
    let mut rows =
        vec![["camera", "margin", "d at worst", "right at most", "meets the rule"].map(str::to_owned)];
    rows.extend(apart.cameras.iter().map(|camera| {
        [
            camera.name.clone(),
            significant(camera.margin, 3),
            significant(camera.statistical_distance, 3),
            right(camera),
            meets(camera),
        ]
    }));
    let mut out = columns(&rows, &[1, 2, 3]);
    let _ = writeln!(
        out,
        "  margin: least d over the envelope / {} demanded ({})\n",
        significant(apart.requirement.distance, 4),
        demanded(apart.requirement.distance)
    );
    apart.cameras.iter().for_each(|camera| out.push_str(&details(camera, units)));
    if let Some(part) = &apart.not_identifiable {
        let _ = writeln!(out, "{}\n", no_camera(part).join("\n  "));
    }
    out
}

/// A clause that demands a quantity: a table, then what each camera sees until its decision.
fn of_measured(measured: &MeasuredAnswer, units: Units) -> String {
    let head = ["camera", "margin", measure(measured.quantity), "limited by", "evidence", "meets the clause"];
    let mut rows = vec![head.map(str::to_owned)];
    rows.extend(measured.cameras.iter().map(|camera| {
        [
            camera.name.clone(),
            significant(camera.margin, 3),
            camera.value.map_or_else(|| "no bound".into(), |value| significant(value, 3)),
            measured_scene(&camera.limiting, units),
            camera.grade.name().to_owned(),
            measured_meets(camera),
        ]
    }));
    let mut out = columns(&rows, &[1, 2]);
    let _ = writeln!(out, "  demanded: {}\n", measured.definition);
    for camera in &measured.cameras {
        let mut lines = Vec::new();
        lines.extend(camera.approach.as_ref().map(|seen| ("until then", approach(seen, units))));
        lines.extend(
            camera
                .uncertainty
                .as_ref()
                .map(|found| ("margin", uncertainty(camera.margin, found).join("\n               "))),
        );
        if !lines.is_empty() {
            let _ = writeln!(out, "{}", camera.name);
            lines.iter().for_each(|(label, text)| {
                let _ = writeln!(out, "  {label:<12} {text}");
            });
            out.push('\n');
        }
    }
    out
}

/// Yes, no or undecided, and why.
pub(super) fn measured_meets(camera: &MeasuredVerdict) -> String {
    match camera.verdict {
        Verdict::Meets => "yes".into(),
        Verdict::Undecided => undecided(&camera.undecided_by, camera.uncertainty.as_ref()),
        Verdict::Fails => format!("no: {}", in_words(&camera.fails_by)),
    }
}

/// A quantity with its unit, as a head of a column.
pub(super) const fn measure(quantity: Measure) -> &'static str {
    match quantity {
        Measure::Pixels => "pixels",
        Measure::TemperatureErrorK => "error, K",
        Measure::DepthErrorM => "error, m",
        Measure::RelativeDepthError => "error / depth",
    }
}

/// What a kind of clause demands, in words.
pub(super) fn in_words_of_kind(kind: &str) -> &str {
    match kind {
        "tell-apart" => "tells materials apart",
        "false-alarm" => "no false alarm",
        "resolution" => "pixels on the target",
        "temperature-error" => "knows a temperature",
        "depth-error" => "knows a distance",
        other => other,
    }
}

/// Where a quantity is least known, in one line.
pub(super) fn measured_scene(scene: &MeasuredScene, units: Units) -> String {
    let mut parts = Vec::new();
    if let Some(target) = &scene.target {
        let warm = scene.temperature_k.map(|kelvin| format!(" at {}", units.temperature(kelvin)));
        parts.push(target.clone() + &warm.unwrap_or_default());
    }
    if !scene.lighting.is_empty() {
        let kelvin: Vec<String> =
            scene.surroundings_k.iter().map(|kelvin| units.temperature(*kelvin)).collect();
        parts.push(format!("{}, surroundings {}", numbers("V ", &scene.lighting, 3), kelvin.join(" ")));
    }
    parts.extend(scene.distance_m.map(|z| format!("{} away", metres(z, units))));
    parts.join(", ")
}

/// All warnings; what is said of several cameras is said once, with their names.
pub(crate) fn together(answer: &RuleAnswer) -> Vec<Warning> {
    let mut said: Vec<(&Warning, Vec<&str>)> = Vec::new();
    let lines: Vec<_> = answer.clauses.iter().flat_map(|clause| clause.lines()).collect();
    for camera in &lines {
        for warning in camera.warnings {
            match said.iter_mut().find(|(known, _)| known.says_as(warning)) {
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
    let said = match (camera.verdict, &camera.provided) {
        (Verdict::Meets, None) => "yes".into(),
        (Verdict::Meets, Some(proviso)) => format!("yes, if {proviso}"),
        (Verdict::Undecided, _) => undecided(&camera.undecided_by, camera.uncertainty.as_ref()),
        (Verdict::Fails, _) => format!("no: {}", fails_by(camera)),
    };
    said + &without_placeholders(camera)
}

/// What is undecided, and between which ends the margin lies.
pub(super) fn undecided(by: &[Shortfall], uncertainty: Option<&MarginUncertainty>) -> String {
    let words = by.iter().map(|reason| match (reason, uncertainty) {
        (Shortfall::Distance | Shortfall::Pixels | Shortfall::TemperatureError, Some(found)) => {
            format!(
                "the margin lies between {} and {}",
                significant(found.low, 3),
                significant(found.high, 3)
            )
        }
        (other, _) => format!("perhaps {}", in_words(&[*other])),
    });
    format!("undecided: {}", words.collect::<Vec<_>>().join("; "))
}

/// How well a margin is known: its interval by both ways, then the budget, a line each.
pub(super) fn uncertainty(margin: f64, found: &MarginUncertainty) -> Vec<String> {
    let k = significant(found.coverage_factor, 2);
    let mut lines = vec![format!(
        "{} +- {} by first order (k = {k})",
        significant(margin, 3),
        significant(found.coverage_factor * found.first_order, 2)
    )];
    if let Some(drawn) = &found.draws {
        let [low, high] = drawn.interval.map(|end| significant(end, 3));
        lines.push(format!("{low} to {high} by {} draws", drawn.count));
    }
    lines.extend(found.budget.iter().map(|line| {
        let told = |value: f64| match line.unit {
            "" => significant(value, 3),
            unit => quantity(value, unit),
        };
        let value = line.value.map_or_else(String::new, |value| format!("{} ", told(value)));
        format!(
            "{} {value}u {}: {} of the margin, {} of its variance",
            line.figure,
            told(line.uncertainty),
            significant(line.contribution, 2),
            share(line.share)
        )
    }));
    lines
}

/// What a camera fails by, in words.
pub(super) fn fails_by(camera: &CameraVerdict) -> String {
    let LimitingScene { target, alternative, .. } = &camera.limiting;
    let words = camera.fails_by.iter().map(|reason| match reason {
        Shortfall::Distance if camera.bands == 1 => "one band cannot tell materials".into(),
        Shortfall::Distance => format!("it cannot tell {target} from {alternative}"),
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
    line("certificate", camera.certificate.to_string());
    if let Some(found) = &camera.uncertainty {
        line("margin", uncertainty(camera.margin, found).join("\n               "));
    }
    let spoiled: Vec<Shortfall> =
        camera.fails_by.iter().copied().filter(|reason| *reason != Shortfall::Distance).collect();
    if !spoiled.is_empty() {
        let longest = camera.longest_exposure_s.map_or_else(String::new, |longest| match longest {
            0.0 => ": the frames alone take too long, however short the exposures".into(),
            longest => format!(": exposures of {} and more are too long", quantity(longest, "s")),
        });
        line("fails by", format!("{}{longest}", in_words(&spoiled)));
    }
    if let Some(fixes) = &camera.fixes {
        line("would do", would_do(fixes, units));
    }
    if let Some(blur) = camera.motion_blur_pixels {
        line("motion blur", format!("{} pixels at the least distance", significant(blur, 2)));
    }
    out.push('\n');
    out
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
        return format!("nothing alone: {}", reasons.next_back().unwrap_or("no value suffices"));
    }
    format!("alone: {}", texts.join("; or "))
}

/// Codes, one after the other.
pub(crate) fn codes(shortfalls: &[Shortfall], between: &str) -> String {
    shortfalls.iter().map(|by| by.code()).collect::<Vec<_>>().join(between)
}

/// What is wrong with an image.
pub(super) fn in_words(spoiled: &[Shortfall]) -> String {
    let words = spoiled.iter().map(|reason| match reason {
        Shortfall::MotionBlur => "motion blur of a pixel or more",
        Shortfall::MotionUnknown => "motion that is not known without a distance",
        Shortfall::FullWell => "the brightest scene fills the well",
        Shortfall::FrameRate => "longer than a frame",
        Shortfall::Impractical => "not a practical camera",
        Shortfall::Diffraction => "diffraction blurs over more than a pixel",
        Shortfall::LowestNoise => "below what read noise and converter leave",
        Shortfall::Pixels => "too few pixels",
        Shortfall::TemperatureError => "the temperature is not known well enough",
        Shortfall::DepthError => "the distance is not known well enough",
        Shortfall::DecisionTime => "its frames are read after the decision must stand",
        other => other.code(),
    });
    words.collect::<Vec<_>>().join(", ")
}

fn one(solved: Quantity, solution: &Solution, units: Units) -> String {
    let value = solution.value.map_or_else(|| "-".into(), |value| in_unit(solved, value, units));
    format!("{} {value} (now {})", solved.name(), in_unit(solved, solution.camera, units))
}

/// The part of the envelope that no camera does, line by line.
pub(crate) fn no_camera(part: &NotIdentifiable) -> Vec<String> {
    let found = if part.fraction > 0.0 {
        let part_of = share(part.fraction) + &error(part.standard_error);
        format!("In {part_of} of the envelope no camera could do it")
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
    let within = part.fraction_within_emissivity_error;
    if within > 0.0 {
        let of = share(within) + &error(part.standard_error_within_emissivity_error);
        lines.push(format!("in {of} {}", part.emissivity_error));
    }
    lines
}

/// The error of a share, behind it.
fn error(share: f64) -> String {
    if share < 1e-6 { String::new() } else { format!(" (+- {} %)", significant(100.0 * share, 2)) }
}
