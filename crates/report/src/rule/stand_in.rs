//! The thermal stand-in as table and picture: how exact it must be so that no camera of the rule tells it from a person.

use crate::bundle::Bundle;
use crate::figures::Plot;
use crate::plot::{Axis, Figure, LineFigure, Series};
use crate::table::{Table, joined, number, optional};
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
    Table::of(
        &answer.rows,
        &[
            ("camera", &|row| row.camera.clone()),
            ("person", &|row| row.person.clone()),
            ("stand_in", &|row| row.material.clone()),
            ("emissivity_tolerance", &|row| number(row.emissivity_tolerance)),
            ("temperature_tolerance_k", &|row| optional(row.temperature_tolerance_k)),
            ("temperature_tolerance_proved_k", &|row| optional(row.temperature_tolerance_proved_k)),
            ("statistical_distance", &|row| number(row.distance)),
            ("farthest_emissivity_offset", &|row| number(row.farthest.emissivity_offset)),
            ("farthest_temperature_k", &|row| number(row.farthest.temperature_k)),
            ("farthest_lighting", &|row| joined(&row.farthest.lighting)),
            ("farthest_surroundings_k", &|row| joined(&row.farthest.surroundings_k)),
            ("person_temperature_k", &|row| number(row.farthest.person_temperature_k)),
            ("person_lighting", &|row| joined(&row.farthest.person_lighting)),
        ],
    )
}

/// The edge of every stand-in that passes: temperature over emissivity.
fn picture(answer: &StandInAnswer) -> Plot {
    let mut figure = LineFigure::new(
        "How exact must a surrogate target be?",
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
