//! Known cameras, embedded with their provenance.
//!
//! A figure that no document states is absent, not guessed. What a camera cannot do without is then asked for, or stands
//! for a stated reason: the frame time for an exposure (an NETD is of a frame, so that signal and noise stretch alike and
//! only shot noise depends on it), an efficiency of 1 beside an NETD (which was measured through the same lens).
//! Every such figure is listed in [`Camera::assumed`].

use super::{Camera, EfficiencyCurve, NoiseSpec, Readout};
use crate::error::{Error, Result};

/// The paper's cameras, and those of public data sheets.
const FILES: [(&str, &str); 2] = [
    ("cameras/presets.toml", include_str!("../../cameras/presets.toml")),
    ("cameras/data_sheets.toml", include_str!("../../cameras/data_sheets.toml")),
];

/// Temperature of the blackbody at which figures are quoted where none is stated, K.
const REFERENCE_K: f64 = 303.15;
/// The range in which the paper counts photons, cm⁻¹.
const PAPER_RANGE_CM1: [f64; 2] = [715.0, 1250.0];

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    #[serde(default)]
    camera: Vec<Preset>,
}

/// What is stated of a camera; what is not is `None`.
#[derive(Debug, Clone, PartialEq, Default, serde::Deserialize, serde::Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Preset {
    /// Name, as in `camera.preset`.
    pub name: String,
    /// What it is, in one line.
    pub description: String,
    /// The document that was read.
    pub document: Option<String>,
    /// Where the figures are from, what is left out, and what is known to be wrong with them.
    pub provenance: Vec<String>,
    /// Exposure of one frame, s.
    pub exposure_s: Option<f64>,
    /// Frames per second.
    pub frame_rate_hz: Option<f64>,
    /// Side of a square pixel, m.
    pub pixel_m: Option<f64>,
    /// f-number.
    pub f_number: Option<f64>,
    /// Focal length, m.
    pub focal_length_m: Option<f64>,
    /// Share of the photons that the optics pass.
    pub optics_efficiency: Option<f64>,
    /// Share of the photons on the detector that are counted.
    pub quantum_efficiency: Option<f64>,
    /// Efficiencies over wavenumber.
    #[serde(skip)]
    pub efficiency_curves: Vec<EfficiencyCurve>,
    /// Electronic noise of one band reading.
    pub noise: Option<StatedNoise>,
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
    /// Whether the bunching of thermal photons adds its noise.
    pub photon_bunching: bool,
    /// When the bands are exposed.
    pub readout: Option<Readout>,
    /// Bands of a spectral instrument.
    pub spectral_bands: Option<u32>,
    /// Whether it has one band of its own, so that a spectrum takes filters.
    pub filters_needed: bool,
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
    /// Pixels down the field of view.
    pub lines: Option<u32>,
    /// Temperature of the blackbody at which photons and γ are quoted, K.
    pub reference_temperature_k: Option<f64>,
    /// The spectral range of the detector, cm⁻¹.
    pub spectral_range_cm1: Option<[f64; 2]>,
}

/// Noise as a document states it; conditions that it does not state are `None`.
#[derive(Debug, Clone, PartialEq, serde::Deserialize, serde::Serialize)]
#[serde(rename_all = "kebab-case", tag = "kind", deny_unknown_fields)]
pub enum StatedNoise {
    /// None at all.
    None,
    /// Noise-equivalent temperature difference of a frame.
    Netd {
        /// K.
        netd_k: f64,
        /// Temperature of the blackbody, K.
        temperature_k: Option<f64>,
        /// f-number.
        f_number: Option<f64>,
        /// Optics efficiency with which its photons are counted.
        optics_efficiency: Option<f64>,
        /// Side of the pixel, m.
        pixel_m: Option<f64>,
    },
    /// Specific detectivity.
    Detectivity {
        /// cm √Hz W⁻¹.
        detectivity_cm_hz05_w: f64,
        /// Noise bandwidth, Hz.
        bandwidth_hz: Option<f64>,
    },
    /// Noise-equivalent power of 1 Hz.
    Nep {
        /// W Hz^-½.
        nep_w_hz05: f64,
        /// Noise bandwidth, Hz.
        bandwidth_hz: Option<f64>,
    },
    /// Noise-equivalent spectral radiance.
    Nesr {
        /// µflick.
        microflick: f64,
        /// Where it is stated, µm.
        wavelength_um: Option<f64>,
    },
    /// Deviation of a band reading.
    Counts {
        /// Counts.
        sigma_counts: f64,
    },
    /// Deviation over wavenumber.
    #[serde(skip)]
    Table(NoiseSpec),
}

/// A figure that a camera cannot do without and nobody has given.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Missing {
    /// Its key in a scenario.
    pub key: &'static str,
    /// A value to write.
    pub example: &'static str,
}

impl Missing {
    /// The message, of a camera of that name.
    #[must_use]
    pub fn error(self, camera: &str) -> Error {
        let (found, instead) = match (self.key, camera) {
            (key, "") => (
                format!("neither a preset nor camera.{key} is given"),
                format!("write {key} = {}, or preset = \"flir-a325sc\"", self.example),
            ),
            (key, name) => (
                format!("no document that was read states the {key} of {name}"),
                format!("write {key} = {}", self.example),
            ),
        };
        Error::malformed(found, instead)
    }
}

impl Preset {
    /// Whether its noise is one of a bandwidth, D* or NEP, so that its conditions are those of another value of it too.
    #[must_use]
    pub fn bandwidth_is_stated(&self) -> bool {
        matches!(self.noise, Some(StatedNoise::Detectivity { .. } | StatedNoise::Nep { .. }))
    }

    /// The camera with these figures, what stands for missing ones listed in [`Camera::assumed`].
    ///
    /// # Errors
    /// The first figure that is missing and nothing can stand for.
    pub fn camera(&self) -> std::result::Result<Camera, Missing> {
        let mut assumed = Vec::new();
        let need = |value: Option<f64>, key, example| value.ok_or(Missing { key, example });
        let exposure_s = match (self.exposure_s, self.frame_rate_hz) {
            (Some(exposure), _) => exposure,
            (None, Some(rate)) => {
                assumed.push(format!("exposure: not stated; the frame of {:.4} ms is taken", 1e3 / rate));
                1.0 / rate
            }
            (None, None) => return Err(Missing { key: "exposure", example: "\"12 ms\"" }),
        };
        let pixel_m = need(self.pixel_m, "pixel", "\"12 um\"")?;
        let f_number = need(self.f_number, "f_number", "1.3")?;
        let focal_length_m = need(self.focal_length_m, "focal_length", "\"18 mm\"")?;
        let optics_efficiency = self.optics_efficiency.unwrap_or_else(|| {
            let why = match self.noise {
                Some(StatedNoise::Netd { .. } | StatedNoise::Nesr { .. }) => {
                    "1 is taken, the noise being stated through the same optics"
                }
                _ => "1 is taken",
            };
            assumed.push(format!("optics_efficiency: not stated; {why}"));
            1.0
        });
        let Some(noise) = &self.noise else { return Err(Missing { key: "netd", example: "\"50 mK\"" }) };
        let noise = match noise {
            StatedNoise::None => NoiseSpec::None,
            StatedNoise::Netd {
                netd_k,
                temperature_k,
                f_number: at,
                optics_efficiency: eta,
                pixel_m: of,
            } => {
                if temperature_k.is_none() {
                    assumed.push(format!("netd_temperature: not stated; {REFERENCE_K} K is taken"));
                }
                if at.is_none() {
                    assumed.push(format!("netd_f_number: not stated; f/{f_number} is taken"));
                }
                NoiseSpec::Netd {
                    netd_k: *netd_k,
                    temperature_k: temperature_k.unwrap_or(REFERENCE_K),
                    f_number: at.unwrap_or(f_number),
                    optics_efficiency: eta.unwrap_or(optics_efficiency),
                    pixel_m: of.unwrap_or(pixel_m),
                }
            }
            StatedNoise::Detectivity { detectivity_cm_hz05_w, bandwidth_hz } => NoiseSpec::Detectivity {
                detectivity_cm_hz05_w: *detectivity_cm_hz05_w,
                bandwidth_hz: *bandwidth_hz,
            },
            StatedNoise::Nep { nep_w_hz05, bandwidth_hz } => {
                NoiseSpec::Nep { nep_w_hz05: *nep_w_hz05, bandwidth_hz: *bandwidth_hz }
            }
            StatedNoise::Nesr { microflick, .. } => NoiseSpec::SpectralRadiance { microflick: *microflick },
            StatedNoise::Counts { sigma_counts } => NoiseSpec::Counts { sigma_counts: *sigma_counts },
            StatedNoise::Table(table) => table.clone(),
        };
        let spectral_range_cm1 = self.spectral_range_cm1.unwrap_or_else(|| {
            let [low, high] = PAPER_RANGE_CM1;
            assumed.push(format!("spectral range: not stated; {low} to {high} cm^-1 is taken"));
            PAPER_RANGE_CM1
        });
        let flicker_fraction = self.flicker_fraction.unwrap_or_else(|| {
            if noise != NoiseSpec::None {
                let why = "0 is taken, so that frames average all of the noise out";
                assumed.push(format!("flicker_fraction: not stated; {why}"));
            }
            0.0
        });
        Ok(Camera {
            name: self.name.clone(),
            description: self.description.clone(),
            provenance: self.document.iter().chain(&self.provenance).cloned().collect(),
            assumed,
            exposure_s,
            pixel_m,
            f_number,
            focal_length_m,
            optics_efficiency,
            quantum_efficiency: self.quantum_efficiency.unwrap_or(1.0),
            efficiency_curves: self.efficiency_curves.clone(),
            noise,
            noise_exposure_s: self.noise_exposure_s.unwrap_or(exposure_s),
            flicker_fraction,
            dark_rate_per_s: self.dark_rate_per_s.unwrap_or(0.0),
            read_noise_counts: self.read_noise_counts.unwrap_or(0.0),
            quantisation_bits: self.quantisation_bits,
            full_well: self.full_well,
            photon_bunching: self.photon_bunching,
            readout: self.readout.unwrap_or(Readout::Simultaneous),
            frames: self.frames.unwrap_or(1),
            frame_rate_hz: self.frame_rate_hz,
            sensor_temperature_k: self.sensor_temperature_k,
            filter_temperature_k: self.filter_temperature_k,
            field_of_view_rad: self.field_of_view_rad,
            pixels: self.pixels,
            reference_temperature_k: self.reference_temperature_k.unwrap_or(REFERENCE_K),
            spectral_range_cm1,
        })
    }
}

/// All that is known of all cameras, in the order of the files.
///
/// # Errors
/// A file that is not valid; a test keeps that from happening.
pub fn all() -> Result<Vec<Preset>> {
    let mut cameras = Vec::new();
    for (path, text) in FILES {
        let file: File = toml::from_str(text).map_err(|error| {
            Error::malformed(error.to_string().replace('\n', " "), format!("mend {path}"))
        })?;
        cameras.extend(file.camera);
    }
    Ok(cameras)
}

/// What is known of the camera of that name.
///
/// # Errors
/// [`Error::UnknownName`] with the nearest names.
pub fn find(name: &str) -> Result<Preset> {
    let cameras = all()?;
    match cameras.iter().find(|camera| camera.name == name) {
        Some(camera) => Ok(camera.clone()),
        None => Err(Error::unknown_name("camera", name, cameras.iter().map(|camera| camera.name.as_str()))),
    }
}

/// The camera of that name.
///
/// # Errors
/// As [`find`]; a figure that no document states and that must be given.
pub fn get(name: &str) -> Result<Camera> {
    find(name)?.camera().map_err(|missing| missing.error(name))?.checked()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::instrument::View;
    use crate::spectrum::Bands;

    /// Table S2 by computation; 2 % is what reading 12 µm, 47.8 mK and η from two tables leaves.
    #[test]
    fn the_bolometer_of_table_s2() {
        let figures = get("flir-a325sc").unwrap().figures().unwrap();
        let close = |value: f64, printed: f64| (value / printed - 1.0).abs() < 0.02;
        assert_eq!(figures.bands, 536);
        assert!((figures.photons / 2.500e9 - 1.0).abs() < 1e-3, "{figures:?}");
        assert!((figures.noise_counts / 1.769e6 - 1.0).abs() < 1e-3, "{figures:?}");
        assert!(close(figures.gamma_per_band, 6.6e5) && close(figures.gamma_per_band, 6.68e5), "{figures:?}");
        assert!(close(figures.hardware_m2_s, 1.53e-18), "{figures:?}");
    }

    #[test]
    fn the_mct_detector_at_ten_micrometres() {
        let camera = get("nicolet-is50").unwrap();
        let bands = Bands::from_rows([(1000.0, 1.0)]).unwrap();
        // 1.28e5 counts, recomputed by hand: √(0.01 cm² · 174.8 kHz)/4.7e10 · 2.86 µs / 1.986e-20 J.
        let sigma = camera.reading_sigma(&bands).unwrap()[0];
        assert!((sigma / 1.281e5 - 1.0).abs() < 1e-3, "{sigma}");
    }

    #[test]
    fn every_camera_is_one_or_says_what_is_missing() {
        for preset in all().unwrap() {
            assert!(!preset.description.is_empty() && !preset.provenance.is_empty(), "{}", preset.name);
            match preset.camera() {
                Ok(camera) => {
                    drop(camera.checked().unwrap_or_else(|error| panic!("{}: {error}", preset.name)))
                }
                Err(missing) => {
                    let message = missing.error(&preset.name).to_string();
                    assert!(message.contains(missing.key) && message.contains(&preset.name), "{message}");
                }
            }
        }
        let names: Vec<String> = all().unwrap().into_iter().map(|preset| preset.name).collect();
        let mut once = names.clone();
        once.sort();
        once.dedup();
        assert_eq!(once.len(), names.len());
    }

    #[test]
    fn the_lines_of_the_noise_budget_sum_to_the_total() {
        let mut camera = get("flir-a325sc").unwrap();
        let bands = camera.own_bands().unwrap();
        let (signal, view) = (vec![5e18; bands.len()], View::at(Some(30.0)));
        for (exposure_s, frames) in [(12e-3, 1), (1e-3, 7), (1.0, 3)] {
            (camera.exposure_s, camera.frames) = (exposure_s, frames);
            let counting = camera.counting(&bands, &view);
            let total = 5e18 * counting.counts_per_radiance + counting.var_added(0);
            let lines: f64 =
                camera.noise_budget(&bands, &signal, &view).iter().map(|line| line.var_counts).sum();
            assert!((lines / total - 1.0).abs() < 1e-13);
        }
    }

    #[test]
    fn unknown_cameras_are_named() {
        assert!(get("flir-a325").unwrap_err().to_string().contains("flir-a325sc"));
    }
}
