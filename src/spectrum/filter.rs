//! The transmittance curve of a filter.

use super::bands::distinct;
use crate::error::{Error, Result, check};

/// The transmittance of a filter at ascending wavenumbers, straight lines between the rows, 0 outside.
#[derive(Debug, Clone, PartialEq)]
pub struct FilterCurve {
    pub(super) name: String,
    pub(super) wavenumbers_cm1: Vec<f64>,
    transmittances: Vec<f64>,
}

impl FilterCurve {
    /// A filter from rows (wavenumber in cm⁻¹, transmittance) in any order.
    ///
    /// # Errors
    /// Fewer than two rows, a wavenumber that is not positive or comes twice, a transmittance outside
    /// [0, 1], or a filter that transmits nothing.
    pub fn new(name: impl Into<String>, mut rows: Vec<(f64, f64)>) -> Result<Self> {
        let name = name.into();
        for &(wavenumber, transmittance) in &rows {
            check::positive("wavenumber of a filter", wavenumber, "cm^-1")?;
            check::unit_interval(&format!("transmittance of filter `{name}`"), transmittance)?;
        }
        rows.sort_by(|a, b| a.0.total_cmp(&b.0));
        distinct(rows.iter().map(|row| row.0), &format!("filter `{name}`"))?;
        if rows.len() < 2 || rows.iter().all(|row| row.1 == 0.0) {
            return Err(Error::malformed(
                format!("filter `{name}` transmits nothing"),
                "give at least two rows with a transmittance above 0",
            ));
        }
        let (wavenumbers_cm1, transmittances) = rows.into_iter().unzip();
        Ok(Self { name, wavenumbers_cm1, transmittances })
    }

    /// Transmittance at a wavenumber in cm⁻¹.
    #[must_use]
    pub fn transmittance(&self, wavenumber_cm1: f64) -> f64 {
        let right = self.wavenumbers_cm1.partition_point(|&row| row < wavenumber_cm1);
        match (self.wavenumbers_cm1.get(right), self.transmittances.get(right)) {
            (Some(&row), Some(&value)) if row == wavenumber_cm1 => value,
            (Some(&high), Some(&value_high)) if right > 0 => {
                let (low, value_low) = (self.wavenumbers_cm1[right - 1], self.transmittances[right - 1]);
                value_low + (value_high - value_low) * ((wavenumber_cm1 - low) / (high - low))
            }
            _ => 0.0,
        }
    }

    pub(super) fn support(&self) -> (f64, f64) {
        (self.wavenumbers_cm1[0], self.wavenumbers_cm1[self.wavenumbers_cm1.len() - 1])
    }
}
