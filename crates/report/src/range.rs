//! A ranging study as files: bounds as tables and maps, pictures of the view, lines with their witnesses.

mod figures;
mod maps;

pub use crate::words::range::{text, verdict};
pub use figures::{bound_maps, derivative_errors, lines, matched_maps, picture_plot, views};
pub use maps::MapFiles;

use self::maps::add_maps;

use crate::bundle::Bundle;
use crate::table::{Table, number, optional};
use hadar::error::Result;
use hadar_study::range::{Line, ObjectBounds, Ranging, SignalBounds};

/// All files; paths in the scenario are written relative to `out` where they lie below it. `large` has the maps that the result does
/// not.
///
/// # Errors
/// A figure that cannot be drawn.
pub fn bundle(result: &Ranging, large: Option<&MapFiles>) -> Result<Bundle> {
    let mut bundle = Bundle::about(result.scenario.title.as_deref());
    bundle.add_asked("scenario.toml", result.scenario.to_toml());
    bundle.add_table("bounds.csv", bounds(result))?;
    if let Some(cells) = cells(result) {
        bundle.add_table("cells.csv", cells)?;
    }
    bundle.add_conditions(&result.verdict.conditions.iter().map(|one| ("", one)).collect::<Vec<_>>())?;
    bundle.add_warnings(&result.warnings)?;
    add_maps(&mut bundle, result, large)?;
    let plots: Vec<_> = [views(result), bound_maps(result), matched_maps(result)]
        .into_iter()
        .flatten()
        .chain(lines(result))
        .chain([derivative_errors()?])
        .collect();
    bundle.add_plots(&plots)?;
    Ok(bundle)
}

/// Bounds, a row for every object and signal.
#[must_use]
pub fn bounds(result: &Ranging) -> Table {
    let rows: Vec<(&ObjectBounds, &SignalBounds)> = result
        .objects
        .iter()
        .flat_map(|object| object.signals.iter().map(move |found| (object, found)))
        .collect();
    Table::of(
        &rows,
        &[
            ("object", &|(object, _)| object.name.clone()),
            ("signal", &|(_, found)| found.signal.name().to_owned()),
            ("windows", &|(_, found)| found.windows.to_string()),
            ("depth_median_m", &|(object, _)| optional(object.depth_m.map(|depth| depth[1]))),
            ("photons_per_window", &|(_, found)| number(found.photons)),
            ("gamma", &|(_, found)| number(found.gamma)),
            ("information_per_px2", &|(_, found)| number(found.information_per_px2)),
            ("sigma_correspondence_px", &|(_, found)| number(found.sigma_correspondence_px)),
            ("disparity_error_px", &|(_, found)| number(found.disparity_error_px)),
            ("depth_error_tenth_m", &|(_, found)| optional(found.depth_error_m.map(|errors| errors[0]))),
            ("depth_error_median_m", &|(_, found)| optional(found.depth_error_m.map(|errors| errors[1]))),
            ("depth_error_nine_tenths_m", &|(_, found)| {
                optional(found.depth_error_m.map(|errors| errors[2]))
            }),
            ("relative_depth_error", &|(_, found)| optional(found.relative_depth_error)),
            ("share_of_windows_that_reach_it", &|(_, found)| optional(found.share)),
            ("largest_depth_m", &|(_, found)| optional(found.largest_depth_m)),
        ],
    )
}

/// The four cells of Table S4.
fn cells(result: &Ranging) -> Option<Table> {
    let cells = result.cells?;
    let mut table = Table::new(["spatial_resolution", "spectral_resolution", "information_per_px2"]);
    let no_yes = |yes: bool| if yes { "with" } else { "without" }.to_owned();
    for (spatial, spectral, value) in [
        (false, false, cells.total),
        (true, false, cells.spatial),
        (false, true, cells.spectral),
        (true, true, cells.full),
    ] {
        table.push(vec![no_yes(spatial), no_yes(spectral), number(value)]);
    }
    Some(table)
}

/// Bounds and witnesses along lines, a row for every window.
pub(super) fn lines_table<'a>(lines: impl IntoIterator<Item = &'a Line>) -> Table {
    let of_line = |line: &'a Line| line.columns.iter().enumerate().map(move |(i, column)| (line, i, column));
    let rows: Vec<(&Line, usize, &usize)> = lines.into_iter().flat_map(of_line).collect();
    let at = |values: &[f64], i: &usize| optional(values.get(*i).copied());
    Table::of(
        &rows,
        &[
            ("row", &|(line, ..)| line.row.to_string()),
            ("column", &|(.., column)| column.to_string()),
            ("signal", &|(line, ..)| line.signal.name().to_owned()),
            ("method", &|(line, ..)| line.method.unwrap_or_default().to_owned()),
            ("depth_m", &|(line, i, _)| at(&line.depth_m, i)),
            ("bound_m", &|(line, i, _)| at(&line.bound_m, i)),
            ("bound_without_diffraction_m", &|(line, i, _)| at(&line.bound_without_diffraction_m, i)),
            ("rmse_m", &|(line, i, _)| at(&line.rmse_m, i)),
            ("bias_m", &|(line, i, _)| at(&line.bias_m, i)),
            ("outliers", &|(line, i, _)| at(&line.outliers, i)),
            ("trials", &|(line, ..)| line.trials.to_string()),
        ],
    )
}
