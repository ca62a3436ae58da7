//! What is stated of the electronic noise: at most one of its kinds, and the conditions of that one.
//!
//! A scenario states figures one by one ([`NoiseFigures`]), a document one noise with its conditions ([`StatedNoise`]).

use std::path::PathBuf;

/// The figures of the electronic noise; a scenario states one of [`super::NOISES`] and its conditions.
#[derive(Debug, Clone, PartialEq, Default, serde::Deserialize, serde::Serialize)]
#[serde(from = "Option<StatedNoise>", into = "Option<StatedNoise>")]
pub struct NoiseFigures {
    /// Whether there is none at all. Documents only.
    pub is_none: bool,
    /// Noise-equivalent temperature difference of one frame, K.
    pub netd_k: Option<f64>,
    /// Temperature of the blackbody at which the NETD is stated, K.
    pub netd_temperature_k: Option<f64>,
    /// f-number at which the NETD or the NESR is stated.
    pub netd_f_number: Option<f64>,
    /// Optics efficiency with which the photons of the NETD or the NESR are counted.
    pub netd_optics_efficiency: Option<f64>,
    /// Side of the pixel for which the NETD or the NESR is stated, m.
    pub netd_pixel_m: Option<f64>,
    /// Specific detectivity D*, cm √Hz W⁻¹.
    pub detectivity_cm_hz05_w: Option<f64>,
    /// Noise-equivalent power of 1 Hz, W Hz^-½.
    pub nep_w_hz05: Option<f64>,
    /// Noise-equivalent spectral radiance of a band, µflick.
    pub nesr_microflick: Option<f64>,
    /// Where it is stated, µm. Documents only.
    pub nesr_wavelength_um: Option<f64>,
    /// Standard deviation of a band reading, counts.
    pub electrons: Option<f64>,
    /// CSV with the columns `wavenumber_cm1,sigma_counts`, absolute path.
    pub table: Option<PathBuf>,
    /// Bandwidth for which D* or NEP is taken, Hz.
    pub bandwidth_hz: Option<f64>,
}

/// Noise as a document states it; conditions that it does not state are `None`.
#[derive(Debug, Clone, PartialEq, serde::Deserialize, serde::Serialize)]
#[serde(rename_all = "kebab-case", tag = "kind", deny_unknown_fields)]
pub enum StatedNoise {
    /// None at all.
    None,
    /// Noise-equivalent temperature difference of a frame.
    Netd {
        /// Noise-equivalent temperature difference of one frame, K.
        netd_k: f64,
        /// Temperature of the blackbody, K.
        temperature_k: Option<f64>,
        /// f-number of the lens for which it is stated.
        f_number: Option<f64>,
        /// Optics efficiency with which its photons are counted.
        optics_efficiency: Option<f64>,
        /// Side of the pixel, m.
        pixel_m: Option<f64>,
    },
    /// Specific detectivity.
    Detectivity {
        /// Specific detectivity D* of the detector, cm √Hz W⁻¹.
        detectivity_cm_hz05_w: f64,
        /// Bandwidth for which the noise is stated, Hz.
        bandwidth_hz: Option<f64>,
    },
    /// Noise-equivalent power of 1 Hz.
    Nep {
        /// Noise-equivalent power of the detector, W Hz^-½.
        nep_w_hz05: f64,
        /// Bandwidth for which the noise is stated, Hz.
        bandwidth_hz: Option<f64>,
    },
    /// Noise-equivalent spectral radiance.
    Nesr {
        /// Noise-equivalent spectral radiance of a band, µflick.
        microflick: f64,
        /// Where it is stated, µm.
        wavelength_um: Option<f64>,
        /// f-number of the lens for which it is stated.
        f_number: Option<f64>,
        /// Optics efficiency for which it is stated, 0 to 1.
        optics_efficiency: Option<f64>,
        /// Side of the pixel, m.
        pixel_m: Option<f64>,
    },
    /// Deviation of a band reading.
    Counts {
        /// Standard deviation of a reading of one band, counts.
        sigma_counts: f64,
    },
}

impl NoiseFigures {
    /// Whether its noise is one of a bandwidth, D* or NEP, so that its conditions are those of another value of it too.
    #[must_use]
    pub const fn is_of_bandwidth(&self) -> bool {
        self.detectivity_cm_hz05_w.is_some() || self.nep_w_hz05.is_some()
    }

    /// Whether two state a noise of the same kind, so that the conditions of the one are those of another value of it too.
    #[must_use]
    pub const fn is_of_kind(&self, other: &Self) -> bool {
        (self.netd_k.is_some() && other.netd_k.is_some())
            || (self.is_of_bandwidth() && other.is_of_bandwidth())
            || (self.nesr_microflick.is_some() && other.nesr_microflick.is_some())
            || (self.electrons.is_some() && other.electrons.is_some())
            || (self.table.is_some() && other.table.is_some())
    }

    /// The same value under the conditions of another of its kind, where it states none itself.
    #[must_use]
    pub fn under(self, other: &Self) -> Self {
        Self {
            netd_temperature_k: self.netd_temperature_k.or(other.netd_temperature_k),
            netd_f_number: self.netd_f_number.or(other.netd_f_number),
            netd_optics_efficiency: self.netd_optics_efficiency.or(other.netd_optics_efficiency),
            netd_pixel_m: self.netd_pixel_m.or(other.netd_pixel_m),
            bandwidth_hz: self.bandwidth_hz.or(other.bandwidth_hz),
            ..self
        }
    }

    /// The noise that is stated, unless it is a file or none is.
    #[must_use]
    pub fn stated(&self) -> Option<StatedNoise> {
        let bandwidth_hz = self.bandwidth_hz;
        if self.is_none {
            Some(StatedNoise::None)
        } else if let Some(netd_k) = self.netd_k {
            Some(StatedNoise::Netd {
                netd_k,
                temperature_k: self.netd_temperature_k,
                f_number: self.netd_f_number,
                optics_efficiency: self.netd_optics_efficiency,
                pixel_m: self.netd_pixel_m,
            })
        } else if let Some(detectivity_cm_hz05_w) = self.detectivity_cm_hz05_w {
            Some(StatedNoise::Detectivity { detectivity_cm_hz05_w, bandwidth_hz })
        } else if let Some(nep_w_hz05) = self.nep_w_hz05 {
            Some(StatedNoise::Nep { nep_w_hz05, bandwidth_hz })
        } else if let Some(microflick) = self.nesr_microflick {
            Some(StatedNoise::Nesr {
                microflick,
                wavelength_um: self.nesr_wavelength_um,
                f_number: self.netd_f_number,
                optics_efficiency: self.netd_optics_efficiency,
                pixel_m: self.netd_pixel_m,
            })
        } else {
            self.electrons.map(|sigma_counts| StatedNoise::Counts { sigma_counts })
        }
    }
}

impl From<StatedNoise> for NoiseFigures {
    fn from(noise: StatedNoise) -> Self {
        let nothing = Self::default();
        match noise {
            StatedNoise::None => Self { is_none: true, ..nothing },
            StatedNoise::Netd { netd_k, temperature_k, f_number, optics_efficiency, pixel_m } => Self {
                netd_k: Some(netd_k),
                netd_temperature_k: temperature_k,
                netd_f_number: f_number,
                netd_optics_efficiency: optics_efficiency,
                netd_pixel_m: pixel_m,
                ..nothing
            },
            StatedNoise::Detectivity { detectivity_cm_hz05_w, bandwidth_hz } => {
                Self { detectivity_cm_hz05_w: Some(detectivity_cm_hz05_w), bandwidth_hz, ..nothing }
            }
            StatedNoise::Nep { nep_w_hz05, bandwidth_hz } => {
                Self { nep_w_hz05: Some(nep_w_hz05), bandwidth_hz, ..nothing }
            }
            StatedNoise::Nesr { microflick, wavelength_um, f_number, optics_efficiency, pixel_m } => Self {
                nesr_microflick: Some(microflick),
                nesr_wavelength_um: wavelength_um,
                netd_f_number: f_number,
                netd_optics_efficiency: optics_efficiency,
                netd_pixel_m: pixel_m,
                ..nothing
            },
            StatedNoise::Counts { sigma_counts } => Self { electrons: Some(sigma_counts), ..nothing },
        }
    }
}

impl From<Option<StatedNoise>> for NoiseFigures {
    fn from(noise: Option<StatedNoise>) -> Self {
        noise.map_or_else(Self::default, Self::from)
    }
}

impl From<NoiseFigures> for Option<StatedNoise> {
    fn from(figures: NoiseFigures) -> Self {
        figures.stated()
    }
}
