//! A rule cell by cell, in words.

use super::reforms::verdict;
use crate::text::columns::aligned;
use crate::text::significant;
use hadar_scenario::Units;
use hadar_scenario::rule::Verdict;
use hadar_study::{CameraInCell, Grid, GridCell, Shortfall};
use std::fmt::Write as _;

/// What an empty place is in a picture.
pub(crate) const NO_CELL: &str = "no such cell";
/// What marked cells are in a picture.
pub(crate) const NOT_MET: &str = "not met or undecided, whatever the margin (why: grid.csv)";
/// What the colour of a cell is.
pub(crate) const MARGIN: &str = "margin: value reached over value required (for an error the inverse)";
/// What the rows and columns of the table are.
pub(crate) const ROWS: &str = "clause, light";

/// Below the tables.
const BELOW: &str = "Each cell: whether the clause is met at that speed in that light, and its margin, above 1 where the demand is met; 'yes, if' under the conditions below. b: blurred by a pixel or more; b?: blur unknown; l: its frames are read too late, and that alone leaves the closing speed in brackets at contact; v: the target is out of view; w: a pixel saturates.";

/// How many cells each camera meets, then every camera's table.
#[must_use]
pub fn cell_by_cell(found: &Grid, units: Units) -> String {
    let mut out = String::new();
    let cameras = found.cells.first().map_or(&[][..], |cell| &cell.cameras);
    for (index, camera) in cameras.iter().enumerate() {
        let _ = writeln!(out, "{} meets {}.", camera.camera, counted(found, index));
    }
    let speeds = speeds(found);
    let rows = rows(found);
    for (index, camera) in cameras.iter().enumerate() {
        let head = speeds.iter().map(|speed| significant(units.speed_number(*speed), 3));
        let first = format!("{} ({})", camera.camera, units.speed_unit());
        let mut lines = vec![std::iter::once(first).chain(head).collect::<Vec<_>>()];
        for (clause, light) in &rows {
            let one = |speed: &f64| {
                let cell = at(found, (*clause, *light), *speed).and_then(|cell| cell.cameras.get(index));
                cell.map_or_else(|| "-".to_owned(), |cell| in_short(cell, units))
            };
            lines.push(std::iter::once(row(*clause, *light)).chain(speeds.iter().map(one)).collect());
        }
        let _ = write!(out, "\n{}", aligned(&lines, &[]));
    }
    let _ = writeln!(out, "\n{BELOW}");
    for (index, camera) in cameras.iter().enumerate() {
        let cells = found.cells.iter().filter_map(|cell| cell.cameras.get(index));
        let mut codes: Vec<&str> = cells.flat_map(|cell| &cell.conditions).map(String::as_str).collect();
        codes.sort_unstable();
        codes.dedup();
        if !codes.is_empty() {
            let _ = writeln!(out, "{}: yes only if {}", camera.camera, codes.join(", "));
        }
    }
    out
}

/// Rows of the table: a clause in a light.
pub(crate) fn rows(found: &Grid) -> Vec<(Option<&str>, Option<&str>)> {
    let mut rows = Vec::new();
    for cell in &found.cells {
        let own = (cell.clause.as_deref(), cell.light.as_deref());
        if !rows.contains(&own) {
            rows.push(own);
        }
    }
    rows
}

/// What a row is called.
pub(crate) fn row(clause: Option<&str>, light: Option<&str>) -> String {
    clause.into_iter().chain(light).collect::<Vec<_>>().join(", ")
}

/// Columns of the table, m s⁻¹, the lowest first.
pub(crate) fn speeds(found: &Grid) -> Vec<f64> {
    let mut speeds: Vec<f64> = found.cells.iter().map(|cell| cell.speed_m_s).collect();
    speeds.sort_by(f64::total_cmp);
    // The same speed of two clauses may differ by rounding.
    speeds.dedup_by(|b, a| is_same(*a, *b));
    speeds
}

/// The cell of a row and a speed, if there is one.
pub(crate) fn at<'a>(
    found: &'a Grid,
    (clause, light): (Option<&str>, Option<&str>),
    speed_m_s: f64,
) -> Option<&'a GridCell> {
    found.cells.iter().find(|cell| {
        cell.clause.as_deref() == clause
            && cell.light.as_deref() == light
            && is_same(cell.speed_m_s, speed_m_s)
    })
}

fn is_same(one: f64, other: f64) -> bool {
    (one - other).abs() <= 1e-9 * one.abs().max(other.abs())
}

/// How many cells a camera meets, and how many of them under conditions.
fn counted(found: &Grid, index: usize) -> String {
    let cells = || found.cells.iter().filter_map(|cell| cell.cameras.get(index));
    let of = |wanted: Verdict| cells().filter(|cell| cell.verdict == wanted).count();
    let open = cells().filter(|cell| cell.verdict == Verdict::Meets && !cell.conditions.is_empty()).count();
    let met = of(Verdict::Meets);
    let mut said = match met {
        0 => format!("none of {} cells", cells().count()),
        met => format!("{met} of {} cells", cells().count()),
    };
    if open > 0 {
        said += &if open == met {
            ", all under conditions".to_owned()
        } else {
            format!(", {open} under conditions")
        };
    }
    match of(Verdict::Undecided) {
        0 => said,
        1 => said + "; 1 is undecided",
        count => format!("{said}; {count} are undecided"),
    }
}

/// A camera in a cell in the fewest words.
fn in_short(cell: &CameraInCell, units: Units) -> String {
    let spoiled: Vec<&str> = cell.fails_by.iter().filter_map(|by| spoils(*by)).collect();
    let said = verdict(cell.verdict, cell.conditions.is_empty());
    let margin = (cell.margin < 1.0 || spoiled.is_empty()).then(|| significant(cell.margin, 3));
    let why: Vec<&str> = margin.as_deref().into_iter().chain(spoiled).collect();
    let mut out = format!("{said} {}", why.join(" "));
    // Who is only late still brakes.
    if let (Some(impact_m_s), [Shortfall::DecisionTime]) = (cell.impact_m_s, cell.fails_by.as_slice()) {
        let _ = write!(out, " ({})", significant(units.speed_number(impact_m_s), 3));
    }
    out
}

/// What is wrong beside the margin, in a letter.
const fn spoils(by: Shortfall) -> Option<&'static str> {
    match by {
        Shortfall::DecisionTime => Some("l"),
        Shortfall::MotionBlur => Some("b"),
        Shortfall::MotionUnknown => Some("b?"),
        Shortfall::OutOfView => Some("v"),
        Shortfall::FullWell => Some("w"),
        Shortfall::Distance
        | Shortfall::Pixels
        | Shortfall::TemperatureError
        | Shortfall::DepthError
        | Shortfall::FrameRate
        | Shortfall::Diffraction
        | Shortfall::Impractical
        | Shortfall::LowestNoise => None,
    }
}

/// The title of a report about it.
pub(crate) fn title_of_grid(rule: Option<&str>) -> String {
    rule.map_or_else(|| "A rule cell by cell".into(), |rule| format!("{rule}, cell by cell"))
}

/// The title of a camera's picture.
pub(crate) fn title_of_camera(camera: &str, title: &str) -> String {
    format!("{title}: {camera}")
}

/// What the columns are.
pub(crate) fn columns(units: Units) -> String {
    format!("speed of the vehicle ({})", units.speed_unit())
}
