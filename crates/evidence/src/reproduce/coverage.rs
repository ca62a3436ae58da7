//! How often the 95 % intervals of a calibration hold the truth, over drawn experiments.
//!
//! Every experiment draws temperatures of the blackbodies about the stated ones, then readings; the estimate's ±1.96 σ is held
//! against the truth, in every channel. Channels of one experiment share the errors of the temperatures, so that the deviation of
//! a coverage is that of the shares of the experiments.
//!
//! The response of the filter-wheel camera is drawn from what is known of it beforehand, since that is part of its intervals: for one given
//! response they hold more or less often, by the bias of its smoothness. A stream of the generator for each experiment.

use hadar::calibration::sent::Unknown;
use hadar::error::Result;
use hadar::parallel;
use hadar::planck;
use hadar::random::generator;
use hadar_estimate::calibrate::response::Response;
use hadar_estimate::calibrate::spectrometer::Calibration;
use hadar_estimate::calibrate::twin::{FilterWheelTwin, SpectrometerTwin, normal};

/// ± so many deviations are a 95 % interval.
const REACH: f64 = 1.959_963_984_540_054;

/// A coverage with its deviation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Coverage {
    /// Share of the intervals that hold the truth.
    pub(crate) share: f64,
    /// Its deviation by the number of experiments.
    pub(crate) sigma: f64,
}

impl Coverage {
    /// Of the shares of some experiments.
    fn of(shares: impl Iterator<Item = f64> + Clone) -> Self {
        let count = shares.clone().count().max(2) as f64;
        let share = shares.clone().sum::<f64>() / count;
        let var = shares.map(|one| (one - share).powi(2)).sum::<f64>() / (count - 1.0);
        Self { share, sigma: (var / count).sqrt() }
    }
}

/// The share of some errors, each with its deviation, within ±1.96 deviations.
fn held(errors: impl Iterator<Item = (f64, f64)>) -> f64 {
    let (mut within, mut all) = (0.0, 0.0);
    for (error, sigma) in errors {
        within += f64::from(u8::from(error.abs() <= REACH * sigma));
        all += 1.0;
    }
    within / all
}

/// What is held in the experiments of a spectrometer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SpectrometerCoverage {
    /// Of R.
    pub(crate) response: Coverage,
    /// Of ξ.
    pub(crate) offset: Coverage,
    /// Of the radiance of a scene, noise of its own reading included.
    pub(crate) radiance: Coverage,
    /// Of the emissivity of a surface.
    pub(crate) emissivity: Coverage,
    /// Of the surroundings of that surface.
    pub(crate) surroundings: Coverage,
}

/// A surface that a spectrometer is tried on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Experiment<'a> {
    /// Temperatures of the blackbodies, K.
    pub(crate) blackbodies_k: &'a [f64],
    /// Their deviations, K.
    pub(crate) errors_k: &'a [f64],
    /// Temperatures of the surface, K.
    pub(crate) surface_k: &'a [f64],
    /// Their deviations, K.
    pub(crate) surface_errors_k: &'a [f64],
    /// Its emissivity, the same in all channels.
    pub(crate) emissivity: f64,
    /// Temperature of its surroundings, K.
    pub(crate) surroundings_k: f64,
    /// Temperature of a blackbody scene, K.
    pub(crate) scene_k: f64,
}

/// Coverage of everything that a spectrometer measures.
///
/// # Errors
/// Temperatures that calibrate nothing.
pub(crate) fn spectrometer(
    twin: &SpectrometerTwin,
    of: Experiment<'_>,
    experiments: usize,
    seed: u64,
) -> Result<SpectrometerCoverage> {
    let nu = &twin.wavenumbers_cm1;
    let channels = nu.len();
    let one = |stream: usize| -> Result<[f64; 5]> {
        let mut rng = generator(seed, stream as u64);
        let blackbodies = twin.readings(of.blackbodies_k, of.errors_k)?;
        let mut read = |t: &f64, u: &f64, e: f64| -> Vec<f64> {
            let true_k = t + u * normal(&mut rng);
            let sent = |c: usize| {
                e * planck::photon_radiance(nu[c], true_k)
                    + (1.0 - e) * planck::photon_radiance(nu[c], of.surroundings_k)
            };
            twin.drawn(sent, &mut rng)
        };
        let black: Vec<Vec<f64>> =
            of.blackbodies_k.iter().zip(of.errors_k).map(|(t, u)| read(t, u, 1.0)).collect();
        let own: Vec<Vec<f64>> =
            of.surface_k.iter().zip(of.surface_errors_k).map(|(t, u)| read(t, u, of.emissivity)).collect();
        let scene = read(&of.scene_k, &0.0, 1.0);
        let found = Calibration::found(blackbodies, &black)?;
        let surface = found.surface(&twin.readings(of.surface_k, of.surface_errors_k)?, &own)?;
        let (of_black, bound) = (&found.blackbodies, &found.bound);
        let response = held(
            (0..channels)
                .map(|c| (found.response[c] - twin.response[c], bound.response(of_black, c).sigma())),
        );
        let offset = held(
            (0..channels).map(|c| (found.offset(c) - twin.offset[c], bound.offset(of_black, c).sigma())),
        );
        let radiance = held((0..channels).map(|c| {
            let measured = found.radiance(c, scene[c]);
            let common = bound.radiance(of_black, c, measured).sigma();
            let sigma = common.hypot(twin.sigma / found.response[c]);
            (measured - planck::photon_radiance(nu[c], of.scene_k), sigma)
        }));
        let emissivity =
            held(surface.iter().map(|s| (s.emissivity - of.emissivity, s.errors.emissivity.sigma())));
        let surroundings = held(surface.iter().zip(nu).map(|(s, nu)| {
            let truth = planck::photon_radiance(*nu, of.surroundings_k);
            (s.surroundings - truth, s.errors.surroundings.sigma())
        }));
        Ok([response, offset, radiance, emissivity, surroundings])
    };
    let shares: Vec<[f64; 5]> = parallel::try_map(experiments, one)?;
    let [response, offset, radiance, emissivity, surroundings] =
        [0, 1, 2, 3, 4].map(|i| Coverage::of(shares.iter().map(move |share| share[i])));
    Ok(SpectrometerCoverage { response, offset, radiance, emissivity, surroundings })
}

/// What is held in the experiments of a filter-wheel camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FilterWheelCoverage {
    /// Of the 30 values.
    pub(crate) response: Coverage,
    /// Of the mean radiance of a blackbody scene behind each filter, noise of its own reading included.
    pub(crate) radiance: Coverage,
}

/// Coverage of the response, drawn from what is known of it, and of radiances measured with it.
///
/// # Errors
/// Readings that cannot be used.
pub(crate) fn filter_wheel(
    twin: &FilterWheelTwin,
    sigma: f64,
    temperature_error_k: f64,
    scene_k: f64,
    experiments: usize,
    seed: u64,
) -> Result<FilterWheelCoverage> {
    let readings = twin.readings(sigma);
    let errors = Unknown::temperatures(&vec![temperature_error_k; twin.temperatures_k.len()]);
    let centres = twin.wheel.centres_cm1();
    let one = |stream: usize| -> Result<[f64; 2]> {
        let mut rng = generator(seed, stream as u64);
        let z: Vec<f64> = (0..twin.prior.unknowns()).map(|_| normal(&mut rng)).collect();
        let truth = twin.prior.at(&z);
        let shifts: Vec<f64> = errors.iter().map(|one| one.deviation * normal(&mut rng)).collect();
        let mut counts = twin.means(&readings, &truth, &shifts);
        counts.iter_mut().for_each(|count| *count += sigma * normal(&mut rng));
        let errors = if temperature_error_k > 0.0 { &errors[..] } else { &[] };
        let found = Response::found(&twin.wheel, &twin.prior, &readings, &counts, errors)?;
        let response = held((0..truth.len()).map(|j| (found.values[j] - truth[j], found.sigma(j))));
        // A scene beside a reference of a temperature that is known, both read anew.
        let reference_k = twin.temperatures_k[0];
        let (mut scene, mut reference) = (vec![0.0; centres.len()], vec![0.0; centres.len()]);
        planck::photon_radiance_into(centres, scene_k, &mut scene);
        planck::photon_radiance_into(centres, reference_k, &mut reference);
        let radiance = held((0..twin.wheel.filters()).map(|q| {
            let of = |x: &[f64]| twin.wheel.counts(q, &truth, x);
            let noise = sigma * (normal(&mut rng) - normal(&mut rng));
            let measured = found.radiance(&twin.wheel, q, of(&scene) - of(&reference) + noise, reference_k);
            let own = 2f64.sqrt() * sigma * measured.per_count;
            (measured.radiance - of(&scene) / of(&vec![1.0; centres.len()]), own.hypot(measured.sigma_common))
        }));
        Ok([response, radiance])
    };
    let shares: Vec<[f64; 2]> = parallel::try_map(experiments, one)?;
    let [response, radiance] = [0, 1].map(|i| Coverage::of(shares.iter().map(move |share| share[i])));
    Ok(FilterWheelCoverage { response, radiance })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 0.93 to 0.97: 2000 experiments know a coverage of 0.95 to 0.005 even where all channels of one are held together, so that a right
    /// one is outside with a probability below 1e-4.
    #[test]
    fn intervals_of_a_spectrometer_hold_the_truth() {
        let twin = SpectrometerTwin::new();
        for (blackbodies_k, errors_k) in [
            (&[283.15, 333.15][..], &[0.03, 0.05][..]),
            (&[278.15, 303.15, 328.15, 353.15], &[0.05, 0.03, 0.05, 0.1]),
        ] {
            let of = Experiment {
                blackbodies_k,
                errors_k,
                surface_k: &[300.0, 330.0],
                surface_errors_k: &[0.02, 0.04],
                emissivity: 0.7,
                surroundings_k: 275.0,
                scene_k: 310.0,
            };
            let found = spectrometer(&twin, of, 2000, 3).unwrap();
            let all = [found.response, found.offset, found.radiance, found.emissivity, found.surroundings];
            for one in all {
                assert!((0.93..0.97).contains(&one.share), "{found:?}");
            }
        }
    }

    /// The same for the camera: 600 experiments; its values share less, by a deviation of at most 0.004 as drawn.
    #[test]
    fn intervals_of_a_response_hold_what_is_drawn_from_its_prior() {
        let twin = FilterWheelTwin::prototype().unwrap();
        let found = filter_wheel(&twin, 0.05, 0.02, 320.0, 600, 4).unwrap();
        for one in [found.response, found.radiance] {
            assert!((0.93..0.97).contains(&one.share) && one.sigma < 0.005, "{found:?}");
        }
    }
}
