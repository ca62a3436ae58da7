//! The `[camera]` of a scenario: a preset, and the fields that override it.

use std::path::PathBuf;

use super::read::file;
use super::section::{ABOVE_ZERO, ABSOLUTE_TEMPERATURE, Entry, FROM_ZERO, Rule, SHARE};
use hadar::error::Result;
pub use hadar::instrument::Readout;
use hadar::units::Dimension;

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
    "quantum_efficiency",
    "netd",
    "netd_temperature",
    "netd_f_number",
    "netd_pixel",
    "detectivity",
    "nep",
    "nesr",
    "noise_electrons",
    "noise_table",
    "noise_bandwidth",
    "noise_exposure",
    "flicker_fraction",
    "dark_rate",
    "read_noise",
    "quantisation_bits",
    "full_well",
    "photon_bunching",
    "readout",
    "frames",
    "frame_rate",
    "sensor_temperature",
    "filter_temperature",
    "field_of_view",
    "pixels",
];

/// The keys that state the noise, of which there is at most one.
pub const NOISES: [&str; 6] = ["netd", "detectivity", "nep", "nesr", "noise_electrons", "noise_table"];

/// An efficiency as written: the same at all wavenumbers, or a file of rows.
#[derive(Debug, Clone, PartialEq)]
pub enum Efficiency {
    /// In (0, 1].
    Number(f64),
    /// CSV with the columns `wavenumber_cm1,efficiency`, absolute path.
    File(PathBuf),
}

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
    pub optics_efficiency: Option<Efficiency>,
    /// Share of the photons on the detector that are counted, in (0, 1].
    pub quantum_efficiency: Option<Efficiency>,
    /// Noise-equivalent temperature difference of one frame, K; above 0. At most one of [`NOISES`].
    pub netd_k: Option<f64>,
    /// Temperature of the blackbody at which the NETD is stated, K; above 0.
    pub netd_temperature_k: Option<f64>,
    /// f-number at which the NETD is stated; at least 0.5.
    pub netd_f_number: Option<f64>,
    /// Side of the pixel for which the NETD is stated, m; above 0.
    pub netd_pixel_m: Option<f64>,
    /// Specific detectivity D*, cm √Hz W⁻¹; above 0. At most one of [`NOISES`].
    pub detectivity_cm_hz05_w: Option<f64>,
    /// Noise-equivalent power of 1 Hz, W Hz^-½; above 0. At most one of [`NOISES`].
    pub nep_w_hz05: Option<f64>,
    /// Noise-equivalent spectral radiance, µflick; above 0. At most one of [`NOISES`].
    pub nesr_microflick: Option<f64>,
    /// Standard deviation of a band reading's electronic noise, in counts; 0 or above. At most one of [`NOISES`].
    pub noise_electrons: Option<f64>,
    /// CSV with the columns `wavenumber_cm1,sigma_counts`, absolute path. At most one of [`NOISES`].
    pub noise_table: Option<PathBuf>,
    /// Bandwidth for which D* or NEP is taken, Hz; above 0. 1/(2 × exposure of the noise) without.
    pub noise_bandwidth_hz: Option<f64>,
    /// Exposure for which the noise is stated, s; above 0.
    pub noise_exposure_s: Option<f64>,
    /// Share of the electronic noise variance that is flicker, in [0, 1].
    pub flicker_fraction: Option<f64>,
    /// Counts per second without light; 0 or above.
    pub dark_rate_per_s: Option<f64>,
    /// Deviation that every reading adds, counts; 0 or above.
    pub read_noise: Option<f64>,
    /// Bits of the converter, which divide the full well; at least 1.
    pub quantisation_bits: Option<u32>,
    /// Counts at which a pixel is full; above 0.
    pub full_well: Option<f64>,
    /// Whether the bunching of thermal photons adds its noise.
    pub photon_bunching: Option<bool>,
    /// Whether all bands are read in one exposure or one after the other.
    pub readout: Option<Readout>,
    /// Number of frames that are averaged; at least 1.
    pub frames: Option<u32>,
    /// Frames per second, Hz; above 0.
    pub frame_rate_hz: Option<f64>,
    /// Temperature of the sensor, whose light filters throw back, K; above 0.
    pub sensor_temperature_k: Option<f64>,
    /// Temperature of the filters, K; above 0.
    pub filter_temperature_k: Option<f64>,
    /// Full field of view across, rad; between 0 and π, both excluded.
    pub field_of_view_rad: Option<f64>,
    /// Pixels across the field of view; at least 1.
    pub pixels: Option<u32>,
}

impl CameraSpec {
    /// Whether it states a noise of its own.
    #[must_use]
    pub fn states_noise(&self) -> bool {
        self.netd_k.is_some()
            || self.detectivity_cm_hz05_w.is_some()
            || self.nep_w_hz05.is_some()
            || self.nesr_microflick.is_some()
            || self.noise_electrons.is_some()
            || self.noise_table.is_some()
    }

    pub(super) fn read(entry: &Entry<'_>) -> Result<Self> {
        Self::read_beside(entry, &[])
    }

    /// The same in a table that may hold `other` keys too.
    pub(super) fn read_beside(entry: &Entry<'_>, other: &[&str]) -> Result<Self> {
        let section = entry.section(&[other, KEYS].concat())?;
        section.at_most_one(&NOISES)?;
        let efficiency = |entry: &Entry<'_>| {
            if entry.is_text() {
                file(entry).map(Efficiency::File)
            } else {
                entry.number("0.9", EFFICIENCY).map(Efficiency::Number)
            }
        };
        let temperature = |key| section.quantity(key, Dimension::Temperature, ABSOLUTE_TEMPERATURE);
        let preset = section.read("preset", |entry| Ok(entry.text("\"flir-a325sc\"")?.trim().to_owned()))?;
        Ok(Self {
            preset,
            exposure_s: section.quantity("exposure", Dimension::Time, ABOVE_ZERO)?,
            pixel_m: section.quantity("pixel", Dimension::Length, ABOVE_ZERO)?,
            f_number: section.number("f_number", "1.3", F_NUMBER)?,
            focal_length_m: section.quantity("focal_length", Dimension::Length, ABOVE_ZERO)?,
            optics_efficiency: section.read("optics_efficiency", efficiency)?,
            quantum_efficiency: section.read("quantum_efficiency", efficiency)?,
            netd_k: section.quantity("netd", Dimension::TemperatureDifference, ABOVE_ZERO)?,
            netd_temperature_k: section.quantity(
                "netd_temperature",
                Dimension::Temperature,
                ABSOLUTE_TEMPERATURE,
            )?,
            netd_f_number: section.number("netd_f_number", "1.0", F_NUMBER)?,
            netd_pixel_m: section.quantity("netd_pixel", Dimension::Length, ABOVE_ZERO)?,
            detectivity_cm_hz05_w: section.quantity("detectivity", Dimension::Detectivity, ABOVE_ZERO)?,
            nep_w_hz05: section.quantity("nep", Dimension::NoiseEquivalentPower, ABOVE_ZERO)?,
            nesr_microflick: section.quantity("nesr", Dimension::SpectralRadiance, ABOVE_ZERO)?,
            noise_electrons: section.number("noise_electrons", "1000", FROM_ZERO)?,
            noise_table: section.read("noise_table", file)?,
            noise_bandwidth_hz: section.quantity("noise_bandwidth", Dimension::Frequency, ABOVE_ZERO)?,
            noise_exposure_s: section.quantity("noise_exposure", Dimension::Time, ABOVE_ZERO)?,
            flicker_fraction: section.number("flicker_fraction", "0.5", SHARE)?,
            dark_rate_per_s: section.quantity("dark_rate", Dimension::Rate, FROM_ZERO)?,
            read_noise: section.number("read_noise", "100", FROM_ZERO)?,
            quantisation_bits: section.read("quantisation_bits", |entry| entry.count("14"))?,
            full_well: section.number("full_well", "1e7", ABOVE_ZERO)?,
            photon_bunching: section.read("photon_bunching", Entry::boolean)?,
            readout: section.choice("readout", &Readout::ALL.map(|readout| (readout.name(), readout)))?,
            frames: section.read("frames", |entry| entry.count("16"))?,
            frame_rate_hz: section.quantity("frame_rate", Dimension::Frequency, ABOVE_ZERO)?,
            sensor_temperature_k: temperature("sensor_temperature")?,
            filter_temperature_k: temperature("filter_temperature")?,
            field_of_view_rad: section.quantity("field_of_view", Dimension::Angle, FIELD_OF_VIEW)?,
            pixels: section.read("pixels", |entry| entry.count("320"))?,
        })
    }
}
