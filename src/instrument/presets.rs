//! Known cameras, embedded with their provenance.

use super::Camera;
use crate::error::{Error, Result};

const PRESETS: &str = include_str!("../../cameras/presets.toml");

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    camera: Vec<Camera>,
}

/// All known cameras, in the order of the file.
///
/// # Errors
/// A preset that is not valid; a test keeps that from happening.
pub fn all() -> Result<Vec<Camera>> {
    let file: File = toml::from_str(PRESETS).map_err(|error| {
        Error::malformed(error.to_string().replace('\n', " "), "mend cameras/presets.toml")
    })?;
    file.camera.into_iter().map(Camera::checked).collect()
}

/// The camera of that name.
///
/// # Errors
/// [`Error::UnknownName`] with the nearest names.
pub fn get(name: &str) -> Result<Camera> {
    let cameras = all()?;
    match cameras.iter().find(|camera| camera.name == name) {
        Some(camera) => Ok(camera.clone()),
        None => Err(Error::unknown_name("camera", name, cameras.iter().map(|camera| camera.name.as_str()))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
    fn the_lines_of_the_noise_budget_sum_to_the_total() {
        let mut camera = get("flir-a325sc").unwrap();
        let bands = camera.own_bands().unwrap();
        let signal = vec![5e18; bands.len()];
        for (exposure_s, frames) in [(12e-3, 1), (1e-3, 7), (1.0, 3)] {
            (camera.exposure_s, camera.frames) = (exposure_s, frames);
            let counting = camera.counting(&bands, Some(30.0));
            let total = 5e18 * counting.counts_per_radiance + counting.var_added(0);
            let lines: f64 =
                camera.noise_budget(&bands, &signal, Some(30.0)).iter().map(|line| line.var_counts).sum();
            assert!((lines / total - 1.0).abs() < 1e-13);
        }
    }

    #[test]
    fn unknown_cameras_are_named() {
        assert!(get("flir-a325").unwrap_err().to_string().contains("flir-a325sc"));
    }

    use crate::spectrum::Bands;
}
