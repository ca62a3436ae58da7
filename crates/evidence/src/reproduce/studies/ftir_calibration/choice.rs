//! Which temperatures to choose: of blackbodies for a range of radiances, of a surface for its emissivity.
//!
//! The total time is given, and shared equally by n settings, so that the deviation of each is √n times that of the whole time at one.
//! Errors of a radiance are expressed as temperature, σ_S/B′(T) at scene temperature T, root mean square over channels and scene
//! temperatures ([`radiance_error`]). Far apart, blackbodies leave less of the noise; but the error u of a temperature grows with
//! B′(T), and outside of the scene's range it is carried over by its leverage.
//!
//! For a surface at two temperatures, noise falls with their distance, and the bias of an emissivity that changes with temperature
//! ([`hadar::calibration::surface::bias`]) does not ([`emissivity_error`]).
//!
//! The best of a list: every pair; more settings by exchange from the best pair, one at a time, until none helps.
//!
//! Units and assumptions: as in [`hadar::calibration::blackbody`]; every setting errs for itself.

use hadar::calibration::blackbody::Blackbodies;
use hadar::calibration::surface::{Truth, bias, errors};
use hadar::error::Result;
use hadar::planck;

/// A spectrometer, and the scenes it is calibrated for.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Wanted {
    /// Channels, cm⁻¹.
    pub(crate) wavenumbers_cm1: Vec<f64>,
    /// Response of each, counts per photon s⁻¹ m⁻² sr⁻¹ per cm⁻¹.
    pub(crate) response: Vec<f64>,
    /// Deviation of a reading that takes the whole time, counts.
    pub(crate) sigma: Vec<f64>,
    /// Uncertainty of each blackbody's temperature, K.
    pub(crate) temperature_error_k: f64,
    /// Brightness temperatures of the scenes, K.
    pub(crate) scenes_k: Vec<f64>,
}

/// Error common to all pixels of a calibrated radiance, as temperature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct RadianceError {
    /// By the noise of the blackbodies' readings, K.
    pub(crate) noise_k: f64,
    /// By their temperatures, K.
    pub(crate) temperature_k: f64,
}

impl RadianceError {
    /// Both, K.
    #[must_use]
    pub(crate) fn total_k(self) -> f64 {
        self.noise_k.hypot(self.temperature_k)
    }
}

/// The error that blackbodies at these temperatures leave.
///
/// # Errors
/// Fewer than two temperatures that differ.
pub(crate) fn radiance_error(wanted: &Wanted, temperatures_k: &[f64]) -> Result<RadianceError> {
    let n = temperatures_k.len();
    let longer = (n as f64).sqrt();
    let sigma: Vec<f64> = wanted.sigma.iter().map(|sigma| sigma * longer).collect();
    let of = Blackbodies::new(
        &wanted.wavenumbers_cm1,
        temperatures_k.to_vec(),
        vec![wanted.temperature_error_k; n],
        &vec![sigma; n],
    )?;
    let bound = of.bound(&wanted.response)?;
    let (mut noise, mut temperature) = (0.0, 0.0);
    for (c, nu) in wanted.wavenumbers_cm1.iter().enumerate() {
        for scene in &wanted.scenes_k {
            let slope = planck::photon_radiance_slope(*nu, *scene);
            let parts = bound.radiance(&of, c, planck::photon_radiance(*nu, *scene));
            noise += parts.var_noise / (slope * slope);
            temperature += parts.var_temperature / (slope * slope);
        }
    }
    let count = (wanted.wavenumbers_cm1.len() * wanted.scenes_k.len()).max(1) as f64;
    Ok(RadianceError { noise_k: (noise / count).sqrt(), temperature_k: (temperature / count).sqrt() })
}

/// The best `count` settings among some temperatures, in ascending order, with their error.
///
/// # Errors
/// Fewer than two temperatures to choose from that differ.
pub(crate) fn best_blackbodies(
    wanted: &Wanted,
    among_k: &[f64],
    count: usize,
) -> Result<(Vec<f64>, RadianceError)> {
    let mut best: Option<(Vec<f64>, RadianceError)> = None;
    let better = |found: RadianceError, best: &Option<(Vec<f64>, RadianceError)>| {
        best.as_ref().is_none_or(|(_, known)| found.total_k() < known.total_k())
    };
    for (i, a) in among_k.iter().enumerate() {
        for b in &among_k[i + 1..] {
            let found = radiance_error(wanted, &[*a, *b])?;
            if better(found, &best) {
                best = Some((vec![*a, *b], found));
            }
        }
    }
    let Some((pair, mut error)) = best else {
        // Says what is wrong with them.
        return radiance_error(wanted, among_k).map(|error| (among_k.to_vec(), error));
    };
    if count <= 2 {
        return Ok((pair, error));
    }
    let mut chosen: Vec<f64> = (0..count).map(|k| pair[k % 2]).collect();
    error = radiance_error(wanted, &chosen)?;
    loop {
        let before = error.total_k();
        for k in 0..count {
            for t in among_k {
                let mut other = chosen.clone();
                other[k] = *t;
                // All at one temperature is no calibration.
                if other.iter().all(|t| *t == other[0]) {
                    continue;
                }
                let found = radiance_error(wanted, &other)?;
                if found.total_k() < error.total_k() {
                    (chosen, error) = (other, found);
                }
            }
        }
        if error.total_k() > before * (1.0 - 1e-9) {
            break;
        }
    }
    chosen.sort_by(f64::total_cmp);
    Ok((chosen, error))
}

/// A surface whose emissivity is wanted.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct WantedSurface {
    /// Channels, response, deviation of a reading of the whole time; the error of the surface's temperatures.
    pub(crate) spectrometer: Wanted,
    /// Its emissivity in each channel.
    pub(crate) emissivity: Vec<f64>,
    /// Radiance of the surroundings in each channel.
    pub(crate) surroundings: Vec<f64>,
    /// Change of the emissivity, K⁻¹.
    pub(crate) slope_per_k: f64,
    /// Temperature at which it is wanted, K.
    pub(crate) wanted_k: f64,
    /// The blackbodies that calibrate.
    pub(crate) blackbodies: Blackbodies,
}

/// Errors of an emissivity, root mean square over the channels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct EmissivityError {
    /// By noise.
    pub(crate) noise: f64,
    /// By the temperatures of surface and blackbodies.
    pub(crate) temperature: f64,
    /// By its change with temperature.
    pub(crate) bias: f64,
}

impl EmissivityError {
    /// All three.
    #[must_use]
    pub(crate) fn total(self) -> f64 {
        self.noise.hypot(self.temperature).hypot(self.bias)
    }
}

/// The error that two temperatures of the surface leave.
///
/// # Errors
/// Temperatures that are the same.
pub(crate) fn emissivity_error(wanted: &WantedSurface, temperatures_k: [f64; 2]) -> Result<EmissivityError> {
    let spectrometer = &wanted.spectrometer;
    let sigma: Vec<f64> = spectrometer.sigma.iter().map(|sigma| sigma * 2f64.sqrt()).collect();
    let readings = Blackbodies::new(
        &spectrometer.wavenumbers_cm1,
        temperatures_k.to_vec(),
        vec![spectrometer.temperature_error_k; 2],
        &vec![sigma; 2],
    )?;
    let bound = wanted.blackbodies.bound(&spectrometer.response)?;
    let (mut noise, mut temperature, mut bias_square) = (0.0, 0.0, 0.0);
    for (c, nu) in spectrometer.wavenumbers_cm1.iter().enumerate() {
        let truth = Truth {
            response: spectrometer.response[c],
            emissivity: wanted.emissivity[c],
            surroundings: wanted.surroundings[c],
        };
        let found = errors((&wanted.blackbodies, &bound), &readings, c, truth).emissivity;
        noise += found.var_noise;
        temperature += found.var_temperature;
        let off = bias(*nu, temperatures_k, wanted.wanted_k, wanted.slope_per_k, truth.surroundings);
        bias_square += off * off;
    }
    let count = spectrometer.wavenumbers_cm1.len().max(1) as f64;
    Ok(EmissivityError {
        noise: (noise / count).sqrt(),
        temperature: (temperature / count).sqrt(),
        bias: (bias_square / count).sqrt(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wanted(temperature_error_k: f64) -> Wanted {
        let wavenumbers_cm1: Vec<f64> = (0..8).map(|i| 800.0 + 60.0 * f64::from(i)).collect();
        let sigma = wavenumbers_cm1.iter().map(|nu| 0.01e-18 * planck::photon_radiance_slope(*nu, 300.0));
        Wanted {
            response: vec![1e-18; 8],
            sigma: sigma.collect(),
            wavenumbers_cm1,
            temperature_error_k,
            scenes_k: vec![280.0, 300.0, 320.0],
        }
    }

    /// Noise alone: as far apart as may be, half of the time at each end.
    #[test]
    fn without_uncertain_temperatures_the_ends_are_best() {
        let among: Vec<f64> = (0..9).map(|i| 260.0 + 10.0 * f64::from(i)).collect();
        let (pair, error) = best_blackbodies(&wanted(0.0), &among, 2).unwrap();
        assert_eq!(pair, [260.0, 340.0]);
        assert_eq!(error.temperature_k, 0.0);
        // Four settings of half the time each are the same two.
        let (four, same) = best_blackbodies(&wanted(0.0), &among, 4).unwrap();
        assert!(same.total_k() <= error.total_k() * (1.0 + 1e-9), "{four:?}");
    }

    /// No noise, one channel, one scene: the error is u where a blackbody is as the scene, and the leverages add up to 1, so that two
    /// blackbodies beside it leave less.
    #[test]
    fn uncertain_temperatures_are_weighed_by_their_leverage() {
        let mut one = wanted(0.1);
        one.scenes_k = vec![300.0];
        one.sigma.iter_mut().for_each(|sigma| *sigma *= 1e-6);
        let at = radiance_error(&one, &[300.0, 340.0]).unwrap();
        assert!((at.total_k() / 0.1 - 1.0).abs() < 1e-6);
        let beside = radiance_error(&one, &[299.9, 300.1]).unwrap();
        assert!((beside.total_k() / (0.1 / 2f64.sqrt()) - 1.0).abs() < 1e-3);
    }
}
