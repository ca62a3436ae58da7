//! A study of ranging by air as files: errors over distances and what each band tells, as tables and plots, with the answer as text.

mod figures;

pub use crate::words::air_ranging::text;
pub use figures::{bias, error_over_distance, information, stereo};

use crate::bundle::Bundle;
use crate::table::{Table, number, optional};
use hadar::error::Result;
use hadar_study::air_ranging::{AirPoint, AirRanging};
use std::path::Path;

/// All files; paths in the scenario are written relative to `out` where they lie below it.
///
/// # Errors
/// A table that cannot be written.
pub fn bundle(result: &AirRanging, out: &Path) -> Result<Bundle> {
    let mut bundle = Bundle::about(result.scenario.scene.title.as_deref());
    bundle.add_asked("scenario.toml", result.scenario.to_toml_beside(out));
    bundle.add_table("distances.csv", distances(&result.curve))?;
    if !result.witness.is_empty() {
        bundle.add_table("estimates.csv", estimates(result))?;
    }
    bundle.add_warnings(&result.warnings)?;
    let plots: Vec<_> = [error_over_distance(result), information(result)]
        .into_iter()
        .chain(bias(result))
        .chain(stereo(result))
        .collect();
    bundle.add_plots(&plots)?;
    Ok(bundle)
}

/// Bounds, a row for every distance.
#[must_use]
pub fn distances(curve: &[AirPoint]) -> Table {
    let mut table = Table::new([
        "distance_m",
        "sigma_m",
        "sigma_emissivity_known_m",
        "sigma_lighting_known_m",
        "sigma_others_known_m",
        "bias_without_sky_m",
        "without_sky_at_edge",
        "sigma_window_m",
        "sigma_stereo_m",
        "counts",
    ]);
    for point in curve {
        table.push(vec![
            number(point.distance_m),
            optional(point.sigma_m),
            optional(point.sigma_emissivity_known_m),
            optional(point.sigma_lighting_known_m),
            optional(point.sigma_others_known_m),
            optional(point.bias_without_sky_m),
            if point.without_sky_at_edge { "yes" } else { "no" }.into(),
            optional(point.sigma_window_m),
            optional(point.sigma_stereo_m),
            number(point.counts),
        ]);
    }
    table
}

/// Estimates beside their bound, a row for every distance.
#[must_use]
pub fn estimates(result: &AirRanging) -> Table {
    let mut table = Table::new([
        "distance_m",
        "bound_m",
        "rmse_m",
        "rmse_low_m",
        "rmse_high_m",
        "bias_m",
        "bias_low_m",
        "bias_high_m",
        "rmse_over_bound",
        "rmse_over_bound_low",
        "rmse_over_bound_high",
        "verdict",
        "share_of_fits_at_edge",
        "unconverged_fits",
        "trials",
    ]);
    for one in &result.witness {
        let (errors, ratio) = (&one.errors, &one.rmse_over_bound_interval);
        let numbers = [
            one.distance_m,
            one.bound_m,
            errors.rmse,
            errors.rmse_interval.low,
            errors.rmse_interval.high,
            errors.bias,
            errors.bias_interval.low,
            errors.bias_interval.high,
            one.rmse_over_bound,
            ratio.low,
            ratio.high,
        ];
        let mut row: Vec<String> = numbers.into_iter().map(number).collect();
        row.extend([
            one.verdict.text().to_owned(),
            number(one.at_edge),
            one.unconverged.to_string(),
            one.trials.to_string(),
        ]);
        table.push(row);
    }
    table
}
