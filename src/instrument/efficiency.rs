//! An efficiency that depends on wavenumber: of optics, or of a detector.
//!
//! η(ν) in [0, 1] at rows, straight lines between them. What a band receives of a spectrum S is ∫ η S dν over it: the
//! weights of its nodes are multiplied by η there, and everything that weighs a spectrum by band then counts what is
//! received.
//!
//! Source: η° of S8.

use crate::error::{Error, Result, check};
use crate::order;
use crate::spectrum::Bands;

/// Efficiency at ascending wavenumbers, straight lines between the rows.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct EfficiencyCurve {
    /// What it is of, e.g. `optics_efficiency`.
    name: String,
    /// Wavenumbers of the rows, cm⁻¹.
    wavenumbers_cm1: Vec<f64>,
    /// Efficiencies at those wavenumbers, 0 to 1.
    efficiencies: Vec<f64>,
}

impl EfficiencyCurve {
    /// A curve from rows (wavenumber in cm⁻¹, efficiency) in any order.
    ///
    /// # Errors
    /// Fewer than two rows, a wavenumber that is not positive or comes twice, an efficiency outside [0, 1], or none above 0.
    ///
    /// ```
    /// use hadar::instrument::EfficiencyCurve;
    /// let lens = EfficiencyCurve::new("lens", vec![(700.0, 0.8), (1300.0, 0.9)])?;
    /// assert!((lens.at(1000.0) - 0.85).abs() < 1e-15);
    /// # Ok::<(), hadar::Error>(())
    /// ```
    pub fn new(name: impl Into<String>, mut rows: Vec<(f64, f64)>) -> Result<Self> {
        let name = name.into();
        for &(wavenumber, efficiency) in &rows {
            check::positive(&format!("wavenumber of {name}"), wavenumber, "cm^-1")?;
            check::unit_interval(&name, efficiency)?;
        }
        order::ascending(&mut rows, |a| a.0);
        if let Some(twice) = rows.windows(2).find(|pair| pair[0].0 == pair[1].0) {
            let found = format!("wavenumber {} cm^-1 comes twice in {name}", twice[0].0);
            return Err(Error::malformed(found, "keep one of the rows"));
        }
        if rows.len() < 2 || rows.iter().all(|row| row.1 == 0.0) {
            let instead = "give at least two rows with an efficiency above 0";
            return Err(Error::malformed(format!("{name} lets nothing through"), instead));
        }
        let (wavenumbers_cm1, efficiencies) = rows.into_iter().unzip();
        Ok(Self { name, wavenumbers_cm1, efficiencies })
    }

    /// What it is of.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Wavenumbers of the rows, ascending, cm⁻¹.
    #[must_use]
    pub fn wavenumbers_cm1(&self) -> &[f64] {
        &self.wavenumbers_cm1
    }

    /// First and last wavenumber, cm⁻¹.
    #[must_use]
    pub fn range_cm1(&self) -> (f64, f64) {
        (self.wavenumbers_cm1[0], self.wavenumbers_cm1[self.wavenumbers_cm1.len() - 1])
    }

    /// Efficiency at a wavenumber in cm⁻¹; beyond the rows that of the last one.
    #[must_use]
    pub fn at(&self, wavenumber_cm1: f64) -> f64 {
        crate::spectrum::interpolated(&self.wavenumbers_cm1, &self.efficiencies, wavenumber_cm1)
    }

    /// Refuses bands of which the curve says nothing.
    ///
    /// # Errors
    /// Bands that reach beyond its rows or into a gap of them.
    pub fn check_covers(&self, bands: &Bands) -> Result<()> {
        bands.check_within(&self.name, &self.wavenumbers_cm1)
    }
}
