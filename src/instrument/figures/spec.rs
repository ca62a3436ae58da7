//! The figures of a camera, each stated or not.

use super::noise::NoiseFigures;
use crate::instrument::Readout;
use std::path::PathBuf;
use std::sync::Arc;

/// An efficiency as written: the same at all wavenumbers, or a file of rows.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(untagged)]
pub enum Efficiency {
    /// In (0, 1].
    Number(f64),
    /// CSV with the columns `wavenumber_cm1,efficiency`, absolute path.
    File(PathBuf),
}

impl Efficiency {
    /// The number, if it is one.
    #[must_use]
    pub const fn number(&self) -> Option<f64> {
        match self {
            Self::Number(number) => Some(*number),
            Self::File(_) => None,
        }
    }
}

/// What is stated of a camera; what is not is `None`. What each figure means is said in [`super::TABLE`].
#[derive(Debug, Clone, PartialEq, Default, serde::Deserialize, serde::Serialize)]
#[serde(default)]
pub struct CameraSpec {
    /// Name of a known camera, whose figures hold where the others are silent.
    #[serde(skip)]
    pub preset: Option<String>,
    /// What is stated of that camera, where it is one of the user's own.
    #[serde(skip)]
    pub own: Option<Arc<CameraSpec>>,
    /// Exposure of one frame, s.
    pub exposure_s: Option<f64>,
    /// Frames per second, Hz.
    pub frame_rate_hz: Option<f64>,
    /// Side of a square pixel, m.
    pub pixel_m: Option<f64>,
    /// f-number.
    pub f_number: Option<f64>,
    /// Focal length, m.
    pub focal_length_m: Option<f64>,
    /// Share of the photons that the optics pass.
    pub optics_efficiency: Option<Efficiency>,
    /// Share of the photons on the detector that are counted.
    pub quantum_efficiency: Option<Efficiency>,
    /// Electronic noise of one band reading, and the conditions under which it is stated.
    pub noise: NoiseFigures,
    /// Exposure for which the noise is stated, s.
    pub noise_exposure_s: Option<f64>,
    /// Share of the noise variance at that exposure which is flicker.
    pub flicker_fraction: Option<f64>,
    /// Counts per second without any light.
    pub dark_rate_per_s: Option<f64>,
    /// Deviation that every reading adds, counts.
    pub read_noise_counts: Option<f64>,
    /// Bits of the converter.
    pub quantisation_bits: Option<u32>,
    /// Counts at which a pixel is full.
    pub full_well: Option<f64>,
    /// Whether the bunching of thermal photons adds its noise. A document that is silent means that it does not.
    #[serde(default = "not_asked_for")]
    pub photon_bunching: Option<bool>,
    /// When the bands are exposed.
    pub readout: Option<Readout>,
    /// Bands that it has of its own; with one of them a spectrum takes filters.
    pub spectral_bands: Option<u32>,
    /// Frames that are averaged.
    pub frames: Option<u32>,
    /// Temperature of the sensor, K.
    pub sensor_temperature_k: Option<f64>,
    /// Temperature of the filters, K.
    pub filter_temperature_k: Option<f64>,
    /// Full field of view across, rad.
    pub field_of_view_rad: Option<f64>,
    /// Pixels across the field of view.
    pub pixels: Option<u32>,
    /// Pixels down the field of view. Documents only, as is all that has no row in [`super::TABLE`].
    pub lines: Option<u32>,
    /// Temperature of the blackbody at which photons and γ are quoted, K. Documents only.
    pub reference_temperature_k: Option<f64>,
    /// The spectral range of the detector, cm⁻¹. Documents only.
    pub spectral_range_cm1: Option<[f64; 2]>,
}

// What a field's default must return.
#[allow(clippy::unnecessary_wraps)]
const fn not_asked_for() -> Option<bool> {
    Some(false)
}
