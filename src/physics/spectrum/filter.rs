//! The curves of a filter: transmittance T, reflectance R, absorptance E = 1 − T − R (S8).

use super::rows::{distinct, interpolated};
use crate::error::{Error, Result, check};
use crate::order;

/// By so much transmittance and reflectance may exceed 1: rounding of a table.
const ROUNDING: f64 = 1e-3;

/// The transmittance of a filter at ascending wavenumbers, straight lines between the rows, 0 outside; and its reflectance,
/// which is what is not transmitted where no other is given.
#[derive(Debug, Clone, PartialEq)]
pub struct FilterCurve {
    pub(super) name: String,
    pub(super) wavenumbers_cm1: Vec<f64>,
    transmittances: Vec<f64>,
    /// Empty where the filter absorbs nothing.
    reflectances: Vec<f64>,
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
        order::ascending(&mut rows, |a| a.0);
        distinct(rows.iter().map(|row| row.0), &format!("filter `{name}`"))?;
        if rows.len() < 2 || rows.iter().all(|row| row.1 == 0.0) {
            return Err(Error::malformed(
                format!("filter `{name}` transmits nothing"),
                "give at least two rows with a transmittance above 0",
            ));
        }
        let (wavenumbers_cm1, transmittances) = rows.into_iter().unzip();
        Ok(Self { name, wavenumbers_cm1, transmittances, reflectances: Vec::new() })
    }

    /// Its name.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The filter with its reflectance at rows (wavenumber in cm⁻¹, reflectance), those of its transmittance in any order.
    ///
    /// # Errors
    /// Rows at other wavenumbers, a reflectance outside [0, 1], or one that makes more than 1 with the transmittance.
    ///
    /// ```
    /// use hadar::spectrum::FilterCurve;
    /// let filter = FilterCurve::new("a", vec![(900.0, 0.6), (1000.0, 0.8)])?
    ///     .with_reflectance(vec![(900.0, 0.3), (1000.0, 0.1)])?;
    /// assert!((filter.reflectance(950.0) - 0.2).abs() < 1e-15);
    /// assert_eq!(filter.reflectance(2000.0), 1.0);
    /// # Ok::<(), hadar::Error>(())
    /// ```
    pub fn with_reflectance(mut self, mut rows: Vec<(f64, f64)>) -> Result<Self> {
        order::ascending(&mut rows, |a| a.0);
        let quantity = format!("reflectance of filter `{}`", self.name);
        if !rows.iter().map(|row| &row.0).eq(&self.wavenumbers_cm1) {
            let instead = "give both in the same rows";
            return Err(Error::malformed(
                format!("{quantity} at other wavenumbers than its transmittance"),
                instead,
            ));
        }
        for ((_, reflectance), transmittance) in rows.iter().zip(&self.transmittances) {
            check::unit_interval(&quantity, *reflectance)?;
            if reflectance + transmittance > 1.0 + ROUNDING {
                let most = format!("at most 1 with the transmittance of {transmittance}");
                return Err(Error::out_of_range(quantity, *reflectance, "", most));
            }
        }
        self.reflectances = rows.into_iter().map(|row| row.1).collect();
        Ok(self)
    }

    /// Reflectance at a wavenumber in cm⁻¹: 1 where the filter has no rows.
    #[must_use]
    pub fn reflectance(&self, wavenumber_cm1: f64) -> f64 {
        let (low, high) = self.support();
        if self.reflectances.is_empty() || !(low..=high).contains(&wavenumber_cm1) {
            return 1.0 - self.transmittance(wavenumber_cm1);
        }
        interpolated(&self.wavenumbers_cm1, &self.reflectances, wavenumber_cm1)
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
