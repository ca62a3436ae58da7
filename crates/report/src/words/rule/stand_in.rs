//! The thermal stand-in in words: how exact it must be so that no camera of the rule tells it from a person.

use super::text::idle;
use crate::text::columns::aligned;
use crate::text::footing::warnings;
use crate::text::significant;
use crate::words::probability::{percent, reliability};
use hadar_study::warning::Code;
use hadar_study::{StandIn, StandInAnswer};
use std::fmt::Write as _;

/// The tolerances.
#[must_use]
pub fn stand_in(answer: &StandInAnswer) -> String {
    let units = answer.units;
    let mut out = idle(answer.idle);
    out.push_str(&sentence(answer));
    let _ = write!(
        out,
        "\n\n{}a surrogate target at {}, compared with people of {}; distinguished from them with a probability of at most {} (d = {})\n\n",
        answer.clause.as_ref().map_or_else(String::new, |clause| format!("clause {clause:?}: ")),
        units.temperature(answer.temperature_k),
        units.temperatures(answer.person_k),
        reliability(answer.distance),
        significant(answer.distance, 4)
    );
    let head = ["camera", "person", "surrogate", "emissivity +-", "temperature +-", "proved"];
    let mut rows = vec![head.map(str::to_owned)];
    rows.extend(answer.rows.iter().map(|row| {
        [
            row.camera.clone(),
            row.person.clone(),
            row.material.clone(),
            significant(row.emissivity_tolerance, 2),
            match (row.temperature_tolerance_k, answer.shape) {
                (None, Some(_)) => "none".into(),
                (kelvin, _) => tolerance(kelvin),
            },
            match (row.temperature_tolerance_k, row.temperature_tolerance_proved_k) {
                (None, _) => "-".into(),
                (Some(_), None) => "no".into(),
                (Some(_), Some(proved)) => tolerance(Some(proved)),
            },
        ]
    }));
    out.push_str(&aligned(&rows, &[3, 4, 5]));
    let by = match answer.of_object {
        true => "all pixels of the object count together, in all bands and frames: shape and motion",
        false => "one pixel counts in all bands and frames: shape, motion and many pixels alike",
    };
    let _ = write!(
        out,
        "\n  emissivity: the same difference at all wavenumbers; temperature: at the edge the most different surrogate has the distance from every person\n  \
         that the rule requires of cameras; proved: for all surrogates within the tolerances, in all scenes of the operating envelope\n  {}\n  \
         counted here: {by} are other questions, and may reveal more\n",
        shapes(answer)
    );
    let others = answer.warnings.iter().filter(|warning| warning.code() != Code::NotInForce);
    out.push_str(&warnings(&others.cloned().collect::<Vec<_>>()));
    out
}

/// What the shapes of the spectra are.
fn shapes(answer: &StandInAnswer) -> String {
    match answer.shape {
        None => "the shape of its spectrum is exactly that of the material named; emissivity_error in [stand_in] takes one that is not".into(),
        Some(shape) => format!(
            "the shape of its spectrum is off by {} (rms), correlated over {} cm^-1: the least tolerance of {} shapes that were drawn, which {} of\n  \
             all such shapes have (with {} confidence); nothing is proved of them",
            significant(shape.emissivity_error, 3),
            significant(shape.correlation_cm1, 3),
            shape.count,
            percent(shape.share),
            percent(shape.confidence),
        ),
    }
}

/// What is asked of a stand-in, in a sentence.
fn sentence(answer: &StandInAnswer) -> String {
    let passes: Vec<&StandIn> =
        answer.rows.iter().filter(|row| row.temperature_tolerance_k.is_some()).collect();
    let told: Vec<&StandIn> =
        answer.rows.iter().filter(|row| row.temperature_tolerance_k.is_none()).collect();
    let [passing, all] = [passes.len(), answer.rows.len()];
    // Of drawn shapes some may be told where others pass.
    let shapes = if answer.shape.is_some() { "95 % of the shapes of " } else { "" };
    match (passes.first(), told.first()) {
        (None, _) if answer.shape.is_some() => {
            "For no surrogate target do 95 % of the shapes surely pass for a person, even at exactly the stated temperature."
                .into()
        }
        (None, _) => "Every surrogate target is distinguished from a person, even at exactly the stated temperature.".into(),
        (Some(_), None) if answer.without_errors => format!(
            "{shapes}All {all} surrogate targets pass for a person if spectra are exact and their temperatures are within the tolerances below; errors of \
             the emissivities are not included."
        ),
        (Some(_), None) => format!(
            "No camera distinguishes {shapes}any of these {all} surrogate targets from a person, if their temperatures are within the tolerances below."
        ),
        (Some(_), Some(_)) => format!(
            "{shapes}{passing} of {all} surrogate targets pass for a person with their camera, within the tolerances below; the others are distinguished{}.",
            if answer.shape.is_some() { ", or some of their shapes are" } else { "" }
        ),
    }
}

fn tolerance(kelvin: Option<f64>) -> String {
    kelvin.map_or_else(|| "distinguished".into(), |kelvin| format!("{} K", significant(kelvin, 3)))
}

/// Below the picture of the tolerances.
pub(crate) fn below_a_line(distance: f64) -> String {
    format!(
        "Below a line no test of one pixel distinguishes the surrogate from a person with a probability above {}; open symbols: proved for all tolerances below.",
        reliability(distance)
    )
}
