//! Thermometry against its bound: table, two plots and text.

mod figures;
pub(crate) mod rows;
#[cfg(test)]
mod tests;

pub use crate::words::simulate::thermometry::text;
pub use figures::{errors, rmse};

use crate::bundle::Bundle;
use crate::table::{Table, number, optional, yes_no};
use hadar::error::Result;
use hadar_study::{Reader, Study, Thermometry};

/// All files; paths in the scenario are written relative to `out` where they lie below it.
///
/// # Errors
/// A figure that cannot be drawn.
pub fn bundle(study: &Study, result: &Thermometry) -> Result<Bundle> {
    let mut bundle = Bundle::about(study.scenario().title.as_deref());
    bundle.add_asked("scenario.toml", study.scenario().to_toml());
    bundle.add_table("thermometry.csv", table(result))?;
    bundle.add_warnings(&result.warnings)?;
    bundle.add_plots(&[errors(result), rmse(result)])?;
    Ok(bundle)
}

/// A column, with the cell of a reader in it.
type OfReader = (&'static str, fn(&Reader) -> String);

const OF_READER: [OfReader; 14] = [
    ("bound_k", |reader| optional(reader.bound_k)),
    ("bias_k", |reader| number(reader.errors.bias)),
    ("bias_low_k", |reader| number(reader.errors.bias_interval.low)),
    ("bias_high_k", |reader| number(reader.errors.bias_interval.high)),
    ("rmse_k", |reader| number(reader.errors.rmse)),
    ("rmse_low_k", |reader| number(reader.errors.rmse_interval.low)),
    ("rmse_high_k", |reader| number(reader.errors.rmse_interval.high)),
    ("variance_over_bound", |reader| optional(reader.efficiency.map(|e| e.ratio))),
    ("variance_over_bound_low", |reader| optional(reader.efficiency.map(|e| e.ratio_interval.low))),
    ("variance_over_bound_high", |reader| optional(reader.efficiency.map(|e| e.ratio_interval.high))),
    ("verdict", |reader| reader.efficiency.map_or("", |e| e.verdict.text()).into()),
    ("bound_applies", |reader| yes_no(reader.bound_applies)),
    ("share_of_fits_at_edge", |reader| number(reader.at_edge)),
    ("unconverged_fits", |reader| reader.unconverged.to_string()),
];

/// Everything, a row for every true temperature.
#[must_use]
pub fn table(result: &Thermometry) -> Table {
    let mut header = vec!["temperature_k".to_owned(), "photons".into()];
    for reader in ["lighting_known", "lighting_unknown"] {
        header.extend(OF_READER.map(|(column, _)| format!("{column}_{reader}")));
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
            cells.extend(OF_READER.map(|(_, cell)| reader.map(cell).unwrap_or_default()));
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
