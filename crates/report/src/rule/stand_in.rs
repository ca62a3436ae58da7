//! The thermal stand-in as text, table and picture: how exact it must be so that no camera of the rule tells it from a person.

use super::text::idle;
use crate::bundle::Bundle;
use crate::figures::Plot;
use crate::plot::{Axis, Figure, LineFigure, Series};
use crate::table::{Table, number, optional};
use crate::text::footing::warnings;
use crate::text::significant;
use crate::words::probability::reliability;
use hadar::error::Result;
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
        "\n\n{}a stand-in at {}, before people of {}; told from them at most {} of the time (d = {})\n\n",
        answer.clause.as_ref().map_or_else(String::new, |clause| format!("clause {clause:?}: ")),
        units.temperature(answer.temperature_k),
        units.temperatures(answer.person_k),
        reliability(answer.distance),
        significant(answer.distance, 4)
    );
    let head = ["camera", "person", "stand-in", "emissivity +-", "temperature +-", "proved"];
    let mut rows = vec![head.map(str::to_owned)];
    rows.extend(answer.rows.iter().map(|row| {
        [
            row.camera.clone(),
            row.person.clone(),
            row.material.clone(),
            significant(row.emissivity_tolerance, 2),
            tolerance(row.temperature_tolerance_k),
            match (row.temperature_tolerance_k, row.temperature_tolerance_proved_k) {
                (None, _) => "-".into(),
                (Some(_), None) => "no".into(),
                (Some(_), Some(proved)) => tolerance(Some(proved)),
            },
        ]
    }));
    out.push_str(&super::columns::columns(&rows, &[3, 4, 5]));
    out.push_str(
        "\n  emissivity: the same difference at all wavenumbers; temperature: at the edge the farthest stand-in is as far from every person\n  \
         as the rule demands of cameras; proved: for all that is within, in all scenes of the envelope\n  \
         by what one pixel counts in all bands and frames: shape, motion and many pixels alike are other questions, and tell more\n",
    );
    let others = answer.warnings.iter().filter(|warning| warning.code() != Code::NotInForce);
    out.push_str(&warnings(&others.cloned().collect::<Vec<_>>()));
    out
}

/// What is asked of a stand-in, in a sentence.
fn sentence(answer: &StandInAnswer) -> String {
    let passes: Vec<&StandIn> =
        answer.rows.iter().filter(|row| row.temperature_tolerance_k.is_some()).collect();
    let told: Vec<&StandIn> =
        answer.rows.iter().filter(|row| row.temperature_tolerance_k.is_none()).collect();
    let [passing, all] = [passes.len(), answer.rows.len()];
    match (passes.first(), told.first()) {
        (None, _) => "Every stand-in is told from a person, even at its very temperature.".into(),
        (Some(_), None) if answer.without_errors => format!(
            "All {all} stand-ins pass for a person if spectra are exact and their temperatures are within the tolerances below; errors of \
             the emissivities are not in it."
        ),
        (Some(_), None) => format!(
            "No camera tells any of these {all} stand-ins from a person, if their temperatures are within the tolerances below."
        ),
        (Some(_), Some(_)) => format!(
            "{passing} of {all} stand-ins pass for a person before their camera, within the tolerances below; the others are told."
        ),
    }
}

fn tolerance(kelvin: Option<f64>) -> String {
    kelvin.map_or_else(|| "told".into(), |kelvin| format!("{} K", significant(kelvin, 3)))
}

/// Table and picture.
///
/// # Errors
/// A table that cannot be written.
pub fn stand_in_bundle(answer: &StandInAnswer) -> Result<Bundle> {
    let mut bundle = Bundle::about(Some("Stand-ins that pass for people"));
    bundle.add_table("stand_in.csv", table(answer))?;
    bundle.add_plots(&[picture(answer)])?;
    Ok(bundle)
}

fn table(answer: &StandInAnswer) -> Table {
    let mut table = Table::new([
        "camera",
        "person",
        "stand_in",
        "emissivity_tolerance",
        "temperature_tolerance_k",
        "temperature_tolerance_proved_k",
        "statistical_distance",
        "farthest_emissivity_offset",
        "farthest_temperature_k",
        "farthest_lighting",
        "farthest_surroundings_k",
        "person_temperature_k",
        "person_lighting",
    ]);
    let joined = |values: &[f64]| values.iter().map(|&value| number(value)).collect::<Vec<_>>().join(" ");
    for row in &answer.rows {
        let there = &row.farthest;
        table.push(vec![
            row.camera.clone(),
            row.person.clone(),
            row.material.clone(),
            number(row.emissivity_tolerance),
            optional(row.temperature_tolerance_k),
            optional(row.temperature_tolerance_proved_k),
            number(row.distance),
            number(there.emissivity_offset),
            number(there.temperature_k),
            joined(&there.lighting),
            joined(&there.surroundings_k),
            number(there.person_temperature_k),
            joined(&there.person_lighting),
        ]);
    }
    table
}

/// The edge of every stand-in that passes: temperature over emissivity.
fn picture(answer: &StandInAnswer) -> Plot {
    let mut figure = LineFigure::new(
        "How exact a stand-in must be",
        Axis::linear("tolerance of its emissivity, ±"),
        Axis::linear("tolerance of its temperature (K), ±"),
    )
    .subtitle(format!(
        "Below a line no test of one pixel tells it from a person more often than {}; open symbols: proved for all within.",
        reliability(answer.distance)
    ));
    let mut groups: Vec<[&str; 3]> = Vec::new();
    for row in &answer.rows {
        let group = [row.camera.as_str(), row.person.as_str(), row.material.as_str()];
        if !groups.contains(&group) {
            groups.push(group);
        }
    }
    for (index, [camera, person, material]) in groups.into_iter().enumerate() {
        let own = || {
            let rows = answer.rows.iter();
            rows.filter(move |row| row.camera == camera && row.person == person && row.material == material)
        };
        let points = |of: &dyn Fn(&StandIn) -> Option<f64>| -> (Vec<f64>, Vec<f64>) {
            own().filter_map(|row| Some((row.emissivity_tolerance, of(row)?))).unzip()
        };
        let (x, y) = points(&|row| row.temperature_tolerance_k);
        if x.is_empty() {
            continue;
        }
        let label = format!("{camera}: {material} for {person}");
        figure = figure.series(Series::line(label, x, y).colour(index));
        let (x, y) = points(&|row| row.temperature_tolerance_proved_k);
        if !x.is_empty() {
            figure = figure.series(Series::points("", x, y).colour(index).open());
        }
    }
    Plot { name: "stand_in".into(), figure: Figure::from(figure), table: table(answer) }
}
