//! The transmittance curve of a filter.

use super::bands::distinct;
use super::interpolated;
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
        let (low, high) = self.support();
        if !(low..=high).contains(&wavenumber_cm1) {
            return 0.0;
        }
        interpolated(&self.wavenumbers_cm1, &self.transmittances, wavenumber_cm1)
    }

    pub(super) fn support(&self) -> (f64, f64) {
        (self.wavenumbers_cm1[0], self.wavenumbers_cm1[self.wavenumbers_cm1.len() - 1])
    }
}
