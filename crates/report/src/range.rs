//! A ranging study as files: bounds as tables and maps, pictures of the view, lines with their witnesses.

mod figures;
mod maps;

pub use crate::words::range::text;
pub use figures::{bound_maps, derivative_errors, lines, matched_maps, picture_plot, views};
pub use maps::MapFiles;

use self::maps::add_maps;

use crate::bundle::Bundle;
use crate::table::{Table, number, optional};
use hadar::error::Result;
use hadar_study::range::{Line, Ranging};
use std::path::Path;

/// All files; paths in the scenario are written relative to `out` where they lie below it. `large` has the maps that the result does
/// not.
///
/// # Errors
/// A figure that cannot be drawn.
pub fn bundle(result: &Ranging, out: &Path, large: Option<&MapFiles>) -> Result<Bundle> {
    let mut bundle = Bundle::about(result.scenario.title.as_deref());
    bundle.add_asked("scenario.toml", result.scenario.to_toml_beside(out));
    bundle.add_table("bounds.csv", bounds(result))?;
    if let Some(cells) = cells(result) {
        bundle.add_table("cells.csv", cells)?;
    }
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
    let mut table = Table::new([
        "object",
        "signal",
        "windows",
        "depth_median_m",
        "photons_per_window",
        "gamma",
        "information_per_px2",
        "sigma_correspondence_px",
        "disparity_error_px",
        "depth_error_tenth_m",
        "depth_error_median_m",
        "depth_error_nine_tenths_m",
        "relative_depth_error",
        "share_of_windows_that_reach_it",
        "largest_depth_m",
    ]);
    for object in &result.objects {
        for found in &object.signals {
            let error = |i: usize| optional(found.depth_error_m.map(|errors| errors[i]));
            table.push(vec![
                object.name.clone(),
                found.signal.name().to_owned(),
                found.windows.to_string(),
                optional(object.depth_m.map(|depth| depth[1])),
                number(found.photons),
                number(found.gamma),
                number(found.information_per_px2),
                number(found.sigma_correspondence_px),
                number(found.disparity_error_px),
                error(0),
                error(1),
                error(2),
                optional(found.relative_depth_error),
                optional(found.share),
                optional(found.largest_depth_m),
            ]);
        }
    }
    table
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
    let mut table = Table::new([
        "row",
        "column",
        "signal",
        "method",
        "depth_m",
        "bound_m",
        "bound_without_diffraction_m",
        "rmse_m",
        "bias_m",
        "outliers",
        "trials",
    ]);
    for line in lines {
        for (i, column) in line.columns.iter().enumerate() {
            let at = |values: &[f64]| optional(values.get(i).copied());
            table.push(vec![
                line.row.to_string(),
                column.to_string(),
                line.signal.name().to_owned(),
                line.method.unwrap_or_default().to_owned(),
                at(&line.depth_m),
                at(&line.bound_m),
                at(&line.bound_without_diffraction_m),
                at(&line.rmse_m),
                at(&line.bias_m),
                at(&line.outliers),
                line.trials.to_string(),
            ]);
        }
    }
    table
}
