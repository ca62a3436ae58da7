//! A study of ranging by air as files: errors over distances and what each band tells, as tables and plots, with the answer as text.

mod figures;

pub use crate::words::air_ranging::text;
pub use figures::{bias, error_over_distance, information, stereo};

use crate::bundle::Bundle;
use crate::table::{Table, number, optional, yes_no};
use hadar::error::Result;
use hadar_study::air_ranging::{AirPoint, AirRanging};

/// All files; paths in the scenario are written relative to `out` where they lie below it.
///
/// # Errors
/// A table that cannot be written.
pub fn bundle(result: &AirRanging) -> Result<Bundle> {
    let mut bundle = Bundle::about(result.scenario.scene.title.as_deref());
    bundle.add_asked("scenario.toml", result.scenario.to_toml());
    bundle.add_table("distances.csv", distances(&result.curve))?;
    if !result.witness.is_empty() {
        bundle.add_table("estimates.csv", estimates(result))?;
    }
    bundle.add_conditions(&result.verdict.conditions.iter().map(|one| ("", one)).collect::<Vec<_>>())?;
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
    Table::of(
        curve,
        &[
            ("distance_m", &|point| number(point.distance_m)),
            ("sigma_m", &|point| optional(point.sigma_m)),
            ("sigma_emissivity_known_m", &|point| optional(point.sigma_emissivity_known_m)),
            ("sigma_lighting_known_m", &|point| optional(point.sigma_lighting_known_m)),
            ("sigma_others_known_m", &|point| optional(point.sigma_others_known_m)),
            ("bias_without_sky_m", &|point| optional(point.bias_without_sky_m)),
            ("without_sky_at_edge", &|point| yes_no(point.without_sky_at_edge)),
            ("sigma_window_m", &|point| optional(point.sigma_window_m)),
            ("sigma_stereo_m", &|point| optional(point.sigma_stereo_m)),
            ("counts", &|point| number(point.counts)),
        ],
    )
}

/// Estimates beside their bound, a row for every distance.
#[must_use]
pub fn estimates(result: &AirRanging) -> Table {
    Table::of(
        &result.witness,
        &[
            ("distance_m", &|one| number(one.distance_m)),
            ("bound_m", &|one| number(one.bound_m)),
            ("rmse_m", &|one| number(one.errors.rmse)),
            ("rmse_low_m", &|one| number(one.errors.rmse_interval.low)),
            ("rmse_high_m", &|one| number(one.errors.rmse_interval.high)),
            ("bias_m", &|one| number(one.errors.bias)),
            ("bias_low_m", &|one| number(one.errors.bias_interval.low)),
            ("bias_high_m", &|one| number(one.errors.bias_interval.high)),
            ("rmse_over_bound", &|one| number(one.rmse_over_bound)),
            ("rmse_over_bound_low", &|one| number(one.rmse_over_bound_interval.low)),
            ("rmse_over_bound_high", &|one| number(one.rmse_over_bound_interval.high)),
            ("verdict", &|one| one.verdict.text().to_owned()),
            ("share_of_fits_at_edge", &|one| number(one.at_edge)),
            ("unconverged_fits", &|one| one.unconverged.to_string()),
            ("trials", &|one| one.trials.to_string()),
        ],
    )
}
