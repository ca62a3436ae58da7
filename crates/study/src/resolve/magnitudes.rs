//! Numbers that a scene and a camera could have.
//!
//! Every value was checked by itself when it was read. Here they are checked together, in the unit in which they are
//! used: a slip of the pen such as an exposure of 10²⁰⁰ s is told as such, before its square is no longer a number.

use crate::Study;
use hadar::error::{Error, Result};
use hadar_scenario::Scenario;
use std::ops::{Range, RangeInclusive};

/// Photons, and noise in counts.
const PHOTONS: Range<f64> = 1e-60..1e60;
/// Least noise of a detector, in units of the shot noise of a reading: what a figure of its sheet comes to, in the wrong unit or at
/// conditions that are none, is no noise at all, and the verdict that of an ideal camera.
const QUIETEST: f64 = 1e-6;
/// Statistical distance demanded.
const DISTANCE: Range<f64> = 1e-9..1e9;
/// Temperatures, K.
const TEMPERATURE_K: RangeInclusive<f64> = 1e-6..=1e6;

/// Temperatures that a scene could have: asked before any spectrum is made of them.
pub(super) fn check_temperatures(scenario: &Scenario) -> Result<()> {
    let objects = scenario.environment.iter().enumerate();
    let objects = objects.map(|(k, object)| (format!("environment[{k}].temperature"), object.temperature_k));
    let target = ("target.temperature".to_owned(), scenario.target.temperature_k);
    let behind = scenario.background.iter();
    let behind = behind.map(|behind| ("background.temperature".to_owned(), behind.temperature_k));
    let ends = scenario.alternatives.temperature_range_k.iter().flatten();
    let ends = ends.map(|kelvin| ("alternatives.temperature".to_owned(), *kelvin));
    for (key, kelvin) in std::iter::once(target).chain(objects).chain(behind).chain(ends) {
        if !TEMPERATURE_K.contains(&kelvin) {
            let error = Error::out_of_range("temperature", kelvin, "K", "between 1e-6 and 1e6 K");
            return Err(error.at(scenario.place(&key)));
        }
    }
    Ok(())
}

impl Study {
    /// Numbers that a scene could have, a target that radiates at all, a camera whose noise can be squared.
    pub(super) fn check_magnitudes(&self) -> Result<()> {
        if !DISTANCE.contains(&self.required) {
            let error =
                Error::out_of_range("statistical distance", self.required, "", "between 1e-9 and 1e9");
            return Err(error.at(self.scenario.place("requirement.distance")));
        }
        let (signal, counting) = self.seen();
        let radiance: f64 = signal.iter().sum();
        if !(radiance > 0.0 && radiance.is_finite()) {
            let expected = "above 0: a warmer scene, or bands at lower wavenumbers";
            let unit = "photons s^-1 m^-2 sr^-1";
            return Err(Error::out_of_range("photon radiance of the target", radiance, unit, expected)
                .at(self.scenario.place("target.temperature")));
        }
        let Some(counting) = counting else { return Ok(()) };
        let photons = counting.counts_per_radiance * radiance;
        let noise = counting.var_added.iter().copied().fold(0.0, f64::max).sqrt();
        let refused = |found: String| {
            let instead = "check the units of its exposure, pixel, noise and frames";
            Err(Error::malformed(found, instead).at(self.scenario.place("camera")))
        };
        if !(PHOTONS.contains(&photons) && noise < PHOTONS.end) {
            return refused(format!(
                "the camera would count {photons:.0e} photons with a noise of {noise:.0e}"
            ));
        }
        let Some(camera) = self.camera.as_ref().filter(|camera| camera.noise.is_of_a_sheet()) else {
            return Ok(());
        };
        let shot = (photons / (self.bands.len() as f64 * f64::from(camera.frames))).sqrt();
        let own = camera.electronic_noise_counts(&self.bands);
        if own >= QUIETEST * shot {
            return Ok(());
        }
        refused(format!(
            "the noise that is stated comes to {own:.0e} counts of a reading, whose photons alone make one of {shot:.0e}"
        ))
    }
}
