//! Files about a rule cell by cell: one table, and a picture of it for every camera.

use crate::bundle::Bundle;
use crate::figures::Plot;
use crate::plot::{Axis, Figure, Matrix, number as number_in_picture};
use crate::table::{Table, number, optional};
use crate::words::rule::grid::{
    MARGIN, NO_CELL, NOT_MET, ROWS, at, columns, row, rows, speeds, title_of_camera, title_of_grid,
};
use crate::words::shortfall::codes;
use hadar::error::Result;
use hadar_scenario::Units;
use hadar_scenario::rule::Verdict;
use hadar_study::Grid;

/// All files.
///
/// # Errors
/// A table that cannot be written.
pub fn grid_bundle(found: &Grid, title: Option<&str>, units: Units) -> Result<Bundle> {
    let title = title_of_grid(title);
    let mut bundle = Bundle::about(Some(&title));
    bundle.add_table("grid.csv", table(found))?;
    let cameras = found.cells.first().map_or(&[][..], |cell| &cell.cameras);
    let plots = cameras.iter().enumerate().map(|(index, _)| picture(found, index, &title, units));
    bundle.add_plots(&plots.collect::<Vec<_>>())?;
    Ok(bundle)
}

fn table(found: &Grid) -> Table {
    let mut table = Table::new([
        "clause",
        "light",
        "speed_m_s",
        "decision_distance_m",
        "camera",
        "verdict",
        "conditions",
        "margin",
        "margin_low",
        "margin_high",
        "fails_by",
        "evidence",
        "impact_m_s",
    ]);
    for cell in &found.cells {
        for camera in &cell.cameras {
            table.push(vec![
                cell.clause.clone().unwrap_or_default(),
                cell.light.clone().unwrap_or_default(),
                number(cell.speed_m_s),
                number(cell.decision_distance_m),
                camera.camera.clone(),
                camera.verdict.name().to_owned(),
                camera.conditions.join(" "),
                number(camera.margin),
                optional(camera.interval.map(|ends| ends[0])),
                optional(camera.interval.map(|ends| ends[1])),
                codes(&camera.fails_by, " "),
                camera.grade.name().to_owned(),
                optional(camera.impact_m_s),
            ]);
        }
    }
    table
}

fn picture(found: &Grid, index: usize, title: &str, units: Units) -> Plot {
    let (rows, speeds) = (rows(found), speeds(found));
    let mut table = Table::new(["row", "speed_m_s", "margin", "verdict"]);
    let mut values = Vec::with_capacity(rows.len() * speeds.len());
    let mut not_met = Vec::with_capacity(values.capacity());
    let mut camera = "";
    for own in &rows {
        for speed_m_s in &speeds {
            let cell = at(found, *own, *speed_m_s).and_then(|cell| cell.cameras.get(index));
            values.push(cell.map_or(f64::NAN, |cell| cell.margin));
            not_met.push(cell.is_some_and(|cell| cell.verdict != Verdict::Meets));
            let Some(cell) = cell else { continue };
            camera = &cell.camera;
            let verdict = cell.verdict.name().to_owned();
            table.push(vec![row(own.0, own.1), number(*speed_m_s), number(cell.margin), verdict]);
        }
    }
    let names = rows.iter().map(|own| row(own.0, own.1)).collect();
    let heads = speeds.iter().map(|speed| number_in_picture(units.speed_number(*speed))).collect();
    let matrix = Matrix::new(
        title_of_camera(camera, title),
        (ROWS, names),
        (columns(units), heads),
        (Axis::log(MARGIN), values),
    );
    let figure = Figure::from(matrix.threshold(1.0, NOT_MET).marked(not_met).no_value(NO_CELL));
    Plot { name: format!("grid_{}", index + 1).into(), figure, table }
}
