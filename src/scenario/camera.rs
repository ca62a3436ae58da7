//! The `[camera]` of a scenario: a preset, and the fields that override it.

use super::section::{ABOVE_ZERO, ABSOLUTE_TEMPERATURE, Entry, FROM_ZERO, Rule, SHARE};
use crate::error::Result;
pub use crate::instrument::Readout;
use crate::units::Dimension;

const F_NUMBER: Rule =
    Rule { holds: |value| value >= 0.5, expected: "at least 0.5, the fastest that a lens in air can be" };
const EFFICIENCY: Rule = Rule { holds: |value| value > 0.0 && value <= 1.0, expected: "above 0, at most 1" };
const FIELD_OF_VIEW: Rule = Rule {
    holds: |value| value > 0.0 && value < std::f64::consts::PI,
    expected: "above 0 and below 180 deg",
};

/// The keys of `[camera]`.
const KEYS: &[&str] = &[
    "preset",
    "exposure",
    "pixel",
    "f_number",
    "focal_length",
    "optics_efficiency",
    "netd",
    "netd_temperature",
    "netd_f_number",
    "netd_pixel",
    "detectivity",
    "noise_electrons",
    "noise_exposure",
    "flicker_fraction",
    "full_well",
    "readout",
    "frames",
    "field_of_view",
    "pixels",
];

/// The camera as written (`[camera]`). A field that is `None` is the preset's.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CameraSpec {
    /// Name of a known camera, e.g. `flir-a325sc`.
    pub preset: Option<String>,
    /// Exposure time of a frame, s; above 0.
    pub exposure_s: Option<f64>,
    /// Side of a square pixel, m; above 0.
    pub pixel_m: Option<f64>,
    /// f-number F; at least 0.5.
    pub f_number: Option<f64>,
    /// Focal length, m; above 0.
    pub focal_length_m: Option<f64>,
    /// Share of the photons that the optics let through, in (0, 1].
    pub optics_efficiency: Option<f64>,
    /// Noise-equivalent temperature difference of one frame, K; above 0. At most one of the three noises.
    pub netd_k: Option<f64>,
    /// Temperature of the blackbody at which the NETD is stated, K; above 0.
    pub netd_temperature_k: Option<f64>,
    /// f-number at which the NETD is stated; at least 0.5.
    pub netd_f_number: Option<f64>,
    /// Side of the pixel for which the NETD is stated, m; above 0.
    pub netd_pixel_m: Option<f64>,
    /// Specific detectivity D*, cm √Hz W⁻¹; above 0. At most one of the three noises.
    pub detectivity_cm_hz05_w: Option<f64>,
    /// Standard deviation of a band reading's electronic noise, in counts; 0 or above. At most one of the three.
    pub noise_electrons: Option<f64>,
    /// Exposure for which the noise is stated, s; above 0.
    pub noise_exposure_s: Option<f64>,
    /// Share of the electronic noise variance that is flicker, in [0, 1].
    pub flicker_fraction: Option<f64>,
    /// Counts at which a pixel is full; above 0.
    pub full_well: Option<f64>,
    /// Whether all bands are read in one exposure or one after the other.
    pub readout: Option<Readout>,
    /// Number of frames that are averaged; at least 1.
    pub frames: Option<u32>,
    /// Full field of view across, rad; between 0 and π, both excluded.
    pub field_of_view_rad: Option<f64>,
    /// Pixels across the field of view; at least 1.
    pub pixels: Option<u32>,
}

impl CameraSpec {
    pub(super) fn read(entry: &Entry<'_>) -> Result<Self> {
        let section = entry.section(KEYS)?;
        section.at_most_one(&["netd", "detectivity", "noise_electrons"])?;
        let preset = section.read("preset", |entry| Ok(entry.text("\"flir-a325sc\"")?.trim().to_owned()))?;
        Ok(Self {
            preset,
            exposure_s: section.quantity("exposure", Dimension::Time, ABOVE_ZERO)?,
            pixel_m: section.quantity("pixel", Dimension::Length, ABOVE_ZERO)?,
            f_number: section.number("f_number", "1.3", F_NUMBER)?,
            focal_length_m: section.quantity("focal_length", Dimension::Length, ABOVE_ZERO)?,
            optics_efficiency: section.number("optics_efficiency", "0.9", EFFICIENCY)?,
            netd_k: section.quantity("netd", Dimension::TemperatureDifference, ABOVE_ZERO)?,
            netd_temperature_k: section.quantity(
                "netd_temperature",
                Dimension::Temperature,
                ABSOLUTE_TEMPERATURE,
            )?,
            netd_f_number: section.number("netd_f_number", "1.0", F_NUMBER)?,
            netd_pixel_m: section.quantity("netd_pixel", Dimension::Length, ABOVE_ZERO)?,
            detectivity_cm_hz05_w: section.quantity("detectivity", Dimension::Detectivity, ABOVE_ZERO)?,
            noise_electrons: section.number("noise_electrons", "1000", FROM_ZERO)?,
            noise_exposure_s: section.quantity("noise_exposure", Dimension::Time, ABOVE_ZERO)?,
            flicker_fraction: section.number("flicker_fraction", "0.5", SHARE)?,
            full_well: section.number("full_well", "1e7", ABOVE_ZERO)?,
            readout: section.choice("readout", &Readout::ALL.map(|readout| (readout.name(), readout)))?,
            frames: section.read("frames", |entry| entry.count("16"))?,
            field_of_view_rad: section.quantity("field_of_view", Dimension::Angle, FIELD_OF_VIEW)?,
            pixels: section.read("pixels", |entry| entry.count("320"))?,
        })
    }
}
