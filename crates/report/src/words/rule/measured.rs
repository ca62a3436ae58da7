//! Clauses that demand a quantity, and how well margins are known, as text.

use super::stop::{approach, metres};
use crate::text::columns::aligned;
use crate::text::numbers::{numbers, quantity, significant};
use crate::words::shortfall::in_words;
use crate::words::{Say, conditions};
use hadar::words::share;
use hadar_scenario::Units;
use hadar_scenario::rule::Verdict;
use hadar_study::{MarginUncertainty, Measure, MeasuredAnswer, MeasuredScene, MeasuredVerdict, Shortfall};
use std::fmt::Write as _;

/// A clause that demands a quantity: a table, then what each camera sees until its decision.
pub(super) fn of_measured(measured: &MeasuredAnswer, units: Units) -> String {
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
    let mut out = aligned(&rows, &[1, 2]);
    let _ = writeln!(out, "  demanded: {}\n", measured.definition.say());
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
        Verdict::Meets => conditions::yes(&camera.conditions),
        Verdict::Undecided => undecided(&camera.undecided_by, camera.uncertainty.as_ref()),
        Verdict::Fails => format!("no: {}", in_words(&camera.fails_by)),
    }
}

/// A quantity with its unit, as a head of a column.
pub(crate) const fn measure(quantity: Measure) -> &'static str {
    match quantity {
        Measure::Pixels => "pixels",
        Measure::TemperatureErrorK => "error, K",
        Measure::DepthErrorM => "error, m",
        Measure::RelativeDepthError => "error / depth",
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
    parts.extend(scene.smear_m.map(|smear| format!("smear of {} in an exposure", units.length(smear))));
    parts.extend(scene.distance_m.map(|z| format!("{} away", metres(z, units))));
    parts.join(", ")
}

/// What is undecided, and between which ends the margin lies.
pub(super) fn undecided(by: &[Shortfall], uncertainty: Option<&MarginUncertainty>) -> String {
    let words = by.iter().map(|reason| match (reason, uncertainty) {
        (Shortfall::Distance | Shortfall::Pixels | Shortfall::TemperatureError, Some(found))
            if found.low < 1.0 =>
        {
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

/// What is promised of a margin whose figures are uncertain, to end a phrase.
pub(super) fn guarded(uncertainty: Option<&MarginUncertainty>) -> String {
    uncertainty.map_or_else(String::new, |found| {
        format!(", with its uncertain figures at k = {}", significant(found.coverage_factor, 2))
    })
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
        let surely = significant(drawn.surely_above, 3);
        let surely =
            if surely == low { String::new() } else { format!(", the lower end surely above {surely}") };
        lines.push(format!("{low} to {high} by {} draws{surely}", drawn.count));
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
