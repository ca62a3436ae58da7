//! The rows of a study of thermometry.

use hadar::order;
use hadar_study::{Reader, Thermometry, ThermometryRow};

/// The reader that stands for what a spectrum tells: lighting unknown where the scenario has it so.
pub(crate) fn decisive(row: &ThermometryRow) -> &Reader {
    row.lighting_unknown.as_ref().unwrap_or(&row.lighting_known)
}

/// Rows by rising temperature.
pub(crate) fn rising(result: &Thermometry) -> Vec<&ThermometryRow> {
    let mut rows: Vec<&ThermometryRow> = result.rows.iter().collect();
    order::ascending(&mut rows, |row| row.temperature_k);
    rows
}
