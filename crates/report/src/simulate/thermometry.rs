//! Thermometry against its bound: table, two plots and text.

mod figures;
pub(crate) mod rows;
#[cfg(test)]
mod tests;

pub use crate::words::simulate::thermometry::text;
pub use figures::{errors, rmse};

use crate::bundle::Bundle;
use crate::table::{Table, number, optional};
use hadar::error::Result;
use hadar_simulate::efficiency::Errors;
use hadar_study::{Reader, Study, Thermometry};
use std::path::Path;

/// All files; paths in the scenario are written relative to `out` where they lie below it.
///
/// # Errors
/// A figure that cannot be drawn.
pub fn bundle(study: &Study, result: &Thermometry, out: &Path) -> Result<Bundle> {
    let mut bundle = Bundle::about(study.scenario().title.as_deref());
    bundle.add_asked("scenario.toml", study.scenario().to_toml_beside(out));
    bundle.add_table("thermometry.csv", table(result))?;
    bundle.add_warnings(&result.warnings)?;
    bundle.add_plots(&[errors(result), rmse(result)])?;
    Ok(bundle)
}

/// Everything, a row for every true temperature.
#[must_use]
pub fn table(result: &Thermometry) -> Table {
    let mut header = vec!["temperature_k".to_owned(), "photons".into()];
    for reader in ["lighting_known", "lighting_unknown"] {
        for column in [
            "bound_k",
            "bias_k",
            "bias_low_k",
            "bias_high_k",
            "rmse_k",
            "rmse_low_k",
            "rmse_high_k",
            "variance_over_bound",
            "variance_over_bound_low",
            "variance_over_bound_high",
            "verdict",
            "bound_applies",
            "share_of_fits_at_edge",
            "unconverged_fits",
        ] {
            header.push(format!("{column}_{reader}"));
        }
    }
    header.push("bound_lighting_within_range_k".into());
    for imager in ["fixed", "manual"] {
        for column in ["mean_reading", "bias", "rmse"] {
            header.push(format!("{column}_k_{imager}_emissivity"));
        }
        header.push(format!("without_reading_{imager}_emissivity"));
    }
    let mut table = Table::new(header);
    for row in &result.rows {
        let mut cells = vec![number(row.temperature_k), number(row.photons)];
        for reader in [Some(&row.lighting_known), row.lighting_unknown.as_ref()] {
            cells.extend(reader_cells(reader));
        }
        cells.push(optional(row.bound_range_k));
        for imager in [&row.fixed, &row.manual] {
            let errors = imager.errors;
            cells.push(optional(errors.map(|errors| row.temperature_k + errors.bias)));
            cells.push(optional(errors.map(|errors| errors.bias)));
            cells.push(optional(errors.map(|errors| errors.rmse)));
            cells.push(imager.without_reading.to_string());
        }
        table.push(cells);
    }
    table
}

fn reader_cells(reader: Option<&Reader>) -> Vec<String> {
    let Some(reader) = reader else { return vec![String::new(); 14] };
    let Errors { bias, bias_interval, rmse, rmse_interval, .. } = reader.errors;
    let efficiency = reader.efficiency;
    vec![
        optional(reader.bound_k),
        number(bias),
        number(bias_interval.low),
        number(bias_interval.high),
        number(rmse),
        number(rmse_interval.low),
        number(rmse_interval.high),
        optional(efficiency.map(|e| e.ratio)),
        optional(efficiency.map(|e| e.ratio_interval.low)),
        optional(efficiency.map(|e| e.ratio_interval.high)),
        efficiency.map_or("", |e| e.verdict.text()).into(),
        if reader.bound_applies { "yes" } else { "no" }.into(),
        number(reader.at_edge),
        reader.unconverged.to_string(),
    ]
}
