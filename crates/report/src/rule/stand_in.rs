//! The thermal stand-in as table and picture: how exact it must be so that no camera of the rule tells it from a person.

use crate::bundle::Bundle;
use crate::figures::Plot;
use crate::plot::{Axis, Figure, LineFigure, Series};
use crate::table::{Table, number, optional};
use crate::words::rule::below_a_line;
use hadar::error::Result;
use hadar_study::{StandIn, StandInAnswer};

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
    .subtitle(below_a_line(answer.distance));
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
