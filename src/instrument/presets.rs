//! Known cameras, embedded with their provenance.
//!
//! A figure that no document states is absent, not guessed. What a camera cannot do without is then asked for, or stands
//! for a reason that [`super::Camera::assumed`] gives. A new camera is an entry of one of the files; its keys are the fields of
//! [`Preset`] and [`CameraSpec`].

#[cfg(feature = "library")]
use super::Camera;
use super::figures::{self, NOISES, Part, Row};
use super::{CameraSpec, EfficiencyCurve, NoiseSpec, Price};
use crate::error::Error;
#[cfg(feature = "library")]
use crate::{error::Result, inputs};
#[cfg(feature = "library")]
use std::sync::{Arc, OnceLock};

#[cfg(feature = "library")]
/// The paper's cameras, and those of public data sheets.
const FILES: [(&str, &str); 2] = [
    ("cameras/presets.toml", include_str!("../../cameras/presets.toml")),
    ("cameras/data_sheets.toml", include_str!("../../cameras/data_sheets.toml")),
];

#[cfg(feature = "library")]
#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    #[serde(default)]
    camera: Vec<Preset>,
}

crate::base::named::named! {
    /// Whether an array is cooled.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Deserialize, serde::Serialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum Cooling {
        /// A microbolometer or the like at room temperature.
        Uncooled = "uncooled",
        /// At the temperature of a cooler.
        Cooled = "cooled",
    }
    /// The name in a file.
    name
}

/// A known camera: its figures, and where they are from.
#[derive(Debug, Clone, PartialEq, Default, serde::Deserialize, serde::Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Preset {
    /// Name of the camera, as in `camera.preset`.
    pub name: String,
    /// What it is, in one line.
    pub description: String,
    /// The document that was read.
    pub document: Option<String>,
    /// Where the figures are from, what is left out, and what is known to be wrong with them.
    pub provenance: Vec<String>,
    /// Whether its array is cooled.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub kind: Option<Cooling>,
    /// False of what nobody can order.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sold: Option<bool>,
    /// What one piece costs, without a lens where it has none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub price: Option<Price>,
    /// Whether that is without a lens though the camera has one here.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub price_without_lens: Option<bool>,
    /// Where the price was seen, and when.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub price_source: Option<String>,
    /// What is stated of it.
    #[serde(flatten)]
    pub figures: CameraSpec,
    /// The file that it is of; none of one of the program's own.
    #[serde(skip_deserializing, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// Whether its noise is of who names the camera, not of its document.
    #[serde(skip)]
    pub is_noise_own: bool,
    /// The camera that its noise is stated of, where figures were moved since: conditions that the noise does not state are those of
    /// this one; none where it is the camera itself.
    #[serde(skip)]
    pub noise_at: Option<NoiseCamera>,
    /// Efficiencies over wavenumber, read from the files of the figures.
    #[serde(skip)]
    pub efficiency_curves: Vec<EfficiencyCurve>,
    /// Noise over wavenumber, read from the file of the figures.
    #[serde(skip)]
    pub noise_table: Option<NoiseSpec>,
}

/// Figures of a camera that a noise hangs on, each stated or not.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NoiseCamera {
    /// Exposure of one frame, s.
    pub exposure_s: Option<f64>,
    /// Number of frames in a second, Hz.
    pub frame_rate_hz: Option<f64>,
    /// f-number of the lens.
    pub f_number: Option<f64>,
    /// Side of a square pixel, m.
    pub pixel_m: Option<f64>,
    /// Efficiency of the optics, but for what depends on wavenumber; 1 where it is not stated.
    pub optics_efficiency: f64,
}

/// The keys of all figures that a camera cannot do without and nobody has given, in the order of the table.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Missing(pub Vec<&'static str>);

impl Missing {
    /// A line for each to be filled in, and what it is.
    #[must_use]
    pub fn lines(&self) -> Vec<String> {
        let rows: Vec<&Row> = self.0.iter().filter_map(|key| figures::row(key)).collect();
        let width = rows.iter().map(|row| row.blank().chars().count()).max().unwrap_or(0);
        let line = |row: &&Row| {
            let meaning = row.meaning.trim_end_matches('.');
            let other = if row.part == Part::Noise { "; or another of " } else { "" };
            let noises: Vec<&str> = NOISES.into_iter().filter(|key| *key != row.key).collect();
            let noises = if other.is_empty() { String::new() } else { noises.join(", ") };
            format!("{:<width$}  # {meaning}{other}{noises}", row.blank())
        };
        rows.iter().map(line).collect()
    }

    /// The message, of a camera of that name.
    #[must_use]
    pub fn error(&self, camera: &str) -> Error {
        let keys = self.0.join(", ");
        let (found, instead) = match camera {
            "" => (
                format!("neither a preset nor {keys} is given"),
                "name a preset (`hadar cameras list` has them), or write what the camera has in place of the dots:",
            ),
            name => (
                format!("no document that was read states {keys} of {name}"),
                "write what the camera has in place of the dots:",
            ),
        };
        Error::Incomplete { found, instead: instead.into(), lines: self.lines() }
    }
}

#[cfg(feature = "library")]
/// All that is known of all cameras, in the order of the files.
///
/// # Errors
/// A file that is not valid; a test keeps that from happening.
pub fn all() -> Result<&'static [Preset]> {
    // A rule asks for its cameras thousands of times, a sweep in every row.
    static READ: OnceLock<Vec<Preset>> = OnceLock::new();
    if let Some(cameras) = READ.get() {
        return Ok(cameras);
    }
    let mut cameras = Vec::new();
    for (path, text) in FILES {
        let file: File = toml::from_str(text).map_err(|error| {
            Error::malformed(error.to_string().replace('\n', " "), format!("mend {path}"))
        })?;
        cameras.extend(file.camera);
    }
    Ok(READ.get_or_init(|| cameras))
}

#[cfg(feature = "library")]
/// What is known of the camera of that name.
///
/// # Errors
/// [`Error::UnknownName`] with the nearest names.
pub fn find(name: &str) -> Result<&'static Preset> {
    static FIGURES: OnceLock<Vec<OnceLock<Arc<[u8]>>>> = OnceLock::new();
    let cameras = all()?;
    match cameras.iter().enumerate().find(|(_, camera)| camera.name == name) {
        Some((at, camera)) => {
            // What it costs is no figure that an answer rests on.
            let figures = || Preset {
                kind: None,
                sold: None,
                price: None,
                price_without_lens: None,
                price_source: None,
                ..camera.clone()
            };
            let content = || Arc::from(serde_json::to_vec(&figures()).unwrap_or_default());
            let of_all = FIGURES.get_or_init(|| cameras.iter().map(|_| OnceLock::new()).collect());
            inputs::built_in("camera", name, || {
                of_all.get(at).map_or_else(content, |slot| Arc::clone(slot.get_or_init(content)))
            });
            Ok(camera)
        }
        None => Err(Error::unknown_name("camera", name, cameras.iter().map(|camera| camera.name.as_str()))),
    }
}

#[cfg(feature = "library")]
/// The camera of that name.
///
/// # Errors
/// As [`find`]; a figure that no document states and that must be given.
pub fn get(name: &str) -> Result<Camera> {
    find(name)?.camera().map_err(|missing| missing.error(name))?.checked()
}

#[cfg(all(test, feature = "library"))]
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
        assert!((figures.photons / 2.505e9 - 1.0).abs() < 1e-3, "{figures:?}");
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
                    assert!(message.contains(&preset.name), "{message}");
                    assert_eq!(missing.lines().len(), missing.0.len());
                    for (key, line) in missing.0.iter().zip(missing.lines()) {
                        assert!(
                            message.contains(&line) && line.starts_with(&format!("{key} = ")),
                            "{message}"
                        );
                        // No number that could be taken for one of this camera.
                        let value = line.split_once('#').unwrap().0;
                        assert!(!value.contains(|char: char| char.is_ascii_digit()), "{line}");
                    }
                }
            }
        }
        let names: Vec<String> = all().unwrap().iter().map(|preset| preset.name.clone()).collect();
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
    fn a_key_that_means_nothing_is_refused() {
        let entry = "[[camera]]\nname = \"ours\"\npixel_m = 12e-6\n";
        let file: File = toml::from_str(entry).unwrap();
        assert_eq!(file.camera[0].figures.pixel_m, Some(12e-6));
        assert!(toml::from_str::<File>(&format!("{entry}pixel = 12e-6\n")).is_err());
    }

    #[test]
    fn unknown_cameras_are_named() {
        assert!(get("flir-a325").unwrap_err().to_string().contains("flir-a325sc"));
    }
}
