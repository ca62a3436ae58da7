//! The `[sensitivity]` of a scenario: how wrong the emissivities may be.
//!
//! Errors are Gaussian, of deviation s in every wavenumber, and those of two wavenumbers that lie Δν apart have the
//! correlation exp(−|Δν|/ℓ). Measured libraries state no such pair of numbers; s = 0.005 and ℓ = 10 cm⁻¹ are a choice of
//! this program for a good laboratory spectrum. How far laboratories differ: M. Langsdale et al., Remote Sens. 13, 102
//! (2021), doi:10.3390/rs13010102; satellites' emissivities miss laboratory spectra by 0.01 and more (ASTER GED).

use super::emissivity_error;
use super::entries::Entries;
use super::section::Entry;
use hadar::error::Result;
use hadar::units::Dimension;

/// How wrong the emissivities may be (`[sensitivity]`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SensitivitySpec {
    /// Root mean square error of an emissivity, in [0, 1].
    pub emissivity_error: f64,
    /// Difference of wavenumbers over which the errors lose their correlation, cm⁻¹; above 0.
    pub correlation_cm1: f64,
}

impl Default for SensitivitySpec {
    fn default() -> Self {
        Self { emissivity_error: 0.005, correlation_cm1: 10.0 }
    }
}

impl SensitivitySpec {
    pub(super) fn read(entry: &Entry<'_>) -> Result<Self> {
        let section = entry.section()?;
        let default = Self::default();
        let emissivity_error = emissivity_error::read(&section, emissivity_error::Of::Absolute)?;
        let correlation_cm1 = section.quantity("correlation")?;
        Ok(Self {
            emissivity_error: emissivity_error.unwrap_or(default.emissivity_error),
            correlation_cm1: correlation_cm1.unwrap_or(default.correlation_cm1),
        })
    }

    pub(super) fn entries(self) -> Entries {
        Entries::default().put("emissivity_error", self.emissivity_error).put_quantity(
            "correlation",
            Dimension::Wavenumber,
            Some(self.correlation_cm1),
        )
    }
}
