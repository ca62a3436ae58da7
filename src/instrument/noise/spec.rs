//! The electronic noise of a camera as it is stated, its conditions complete.

use crate::error::{Error, Result, check};
use crate::order;

/// How the noise of a camera is stated.
#[derive(Debug, Clone, Default, PartialEq, serde::Serialize)]
#[serde(rename_all = "kebab-case", tag = "kind")]
pub enum NoiseSpec {
    /// No electronic noise at all.
    #[default]
    None,
    /// Noise-equivalent temperature difference.
    Netd {
        /// NETD of one frame as it is measured, with the shot noise of its photons, K.
        netd_k: f64,
        /// Temperature of the blackbody at which it is stated, K.
        temperature_k: f64,
        /// f-number at which it is stated.
        f_number: f64,
        /// Optics efficiency with which its photons are counted.
        optics_efficiency: f64,
        /// Side of the pixel for which it is stated, m.
        pixel_m: f64,
    },
    /// Specific detectivity D*.
    Detectivity {
        /// Specific detectivity D* of the detector, cm √Hz W⁻¹.
        detectivity_cm_hz05_w: f64,
        /// Noise bandwidth Δf, Hz; that of the exposure where `None`.
        bandwidth_hz: Option<f64>,
    },
    /// Noise-equivalent power of a bandwidth of 1 Hz.
    Nep {
        /// Noise-equivalent power NEP of the detector, W Hz^-½.
        nep_w_hz05: f64,
        /// Noise bandwidth Δf, Hz; that of the exposure where `None`.
        bandwidth_hz: Option<f64>,
    },
    /// Noise-equivalent spectral radiance, the same per wavelength in all bands.
    SpectralRadiance {
        /// NESR, µflick (µW cm⁻² sr⁻¹ µm⁻¹).
        microflick: f64,
        /// f-number at which it is stated.
        f_number: f64,
        /// Optics efficiency with which it is stated.
        optics_efficiency: f64,
        /// Side of the pixel for which it is stated, m.
        pixel_m: f64,
    },
    /// Standard deviation of a band reading.
    Counts {
        /// Standard deviation σ of a reading of one band, counts.
        sigma_counts: f64,
    },
    /// Standard deviation of a band reading over wavenumber.
    Table {
        /// Ascending wavenumbers at which the noise is stated, cm⁻¹.
        wavenumbers_cm1: Vec<f64>,
        /// σ there, counts; straight lines between, the last one beyond.
        sigma_counts: Vec<f64>,
    },
}

/// What an NETD is stated for.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct NetdConditions {
    /// Temperature of the blackbody, K.
    pub temperature_k: f64,
    /// f-number of the optics for which it is stated.
    pub f_number: f64,
    /// Share of the photons that they pass.
    pub optics_efficiency: f64,
    /// Side of the pixel, m.
    pub pixel_m: f64,
}

impl NoiseSpec {
    /// Whether it is stated as a figure of the sheet (NETD, D*, NEP, NESR) that counts follow from only at stated conditions.
    #[must_use]
    pub const fn is_of_a_sheet(&self) -> bool {
        matches!(
            self,
            Self::Netd { .. } | Self::Detectivity { .. } | Self::Nep { .. } | Self::SpectralRadiance { .. }
        )
    }

    /// Whether there is any.
    #[must_use]
    pub fn is_some(&self) -> bool {
        !matches!(self, Self::None) && *self != Self::Counts { sigma_counts: 0.0 }
    }

    /// A table of noise from rows (wavenumber in cm⁻¹, σ in counts) in any order.
    ///
    /// # Errors
    /// No rows, a wavenumber that is not positive or comes twice, a σ below 0.
    pub fn table(mut rows: Vec<(f64, f64)>) -> Result<Self> {
        for &(wavenumber, sigma) in &rows {
            check::positive("wavenumber of the noise", wavenumber, "cm^-1")?;
            check::non_negative("noise", sigma, "counts")?;
        }
        order::ascending(&mut rows, |a| a.0);
        if rows.is_empty() || rows.windows(2).any(|pair| pair[0].0 == pair[1].0) {
            let found = "the table of noise has no rows, or a wavenumber comes twice";
            return Err(Error::malformed(found, "give each wavenumber one row"));
        }
        let (wavenumbers_cm1, sigma_counts) = rows.into_iter().unzip();
        Ok(Self::Table { wavenumbers_cm1, sigma_counts })
    }

    /// Key of a scenario that states this kind.
    #[must_use]
    pub const fn key(&self) -> &'static str {
        match self {
            Self::None | Self::Counts { .. } => "noise_electrons",
            Self::Netd { .. } => "netd",
            Self::Detectivity { .. } => "detectivity",
            Self::Nep { .. } => "nep",
            Self::SpectralRadiance { .. } => "nesr",
            Self::Table { .. } => "noise_table",
        }
    }

    /// Checks what no key of a scenario states.
    pub(in crate::instrument) fn check(&self) -> Result<()> {
        match self {
            Self::Netd { optics_efficiency, .. } => {
                check::positive("optics efficiency of the NETD", *optics_efficiency, "").map(drop)
            }
            Self::Table { sigma_counts, .. } => sigma_counts
                .iter()
                .try_for_each(|sigma| check::non_negative("noise", *sigma, "counts").map(drop)),
            _ => Ok(()),
        }
    }
}
