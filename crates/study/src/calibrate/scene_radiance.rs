//! Radiances of a scene by a calibrated spectrometer, with what all pixels err by in common and what each errs by for itself.
//!
//! S = B̄ + (C − C̄)/R of every sample, W m⁻² sr⁻¹ per cm⁻¹, R and C̄ of the band or of each pixel for itself; the errors of
//! [`hadar::calibration::blackbody`], whose variance is a parabola in the radiance.

use super::whole::{at, beside, check_memory, pairs, shown};
use hadar::calibration::blackbody::Blackbodies;
use hadar::cube::{Cube, Shape};
use hadar::error::{Error, Result};
use hadar::planck;
use hadar::units::{PLANCK_J_S, SPEED_OF_LIGHT_M_S};
use hadar_estimate::calibrate::spectrometer::Calibration;
use hadar_scenario::Source;
use serde::Serialize;

/// A response within so many of its deviations from 0 is none.
pub(super) const DEAD: f64 = 5.0;
/// Samples of which the typical errors of a scene are taken.
const LOOKED_AT: usize = 20_000;
/// Bytes of a sample: radiance and errors, once more in the files of the report.
const KEPT: u64 = 16;
const KEPT_OF_EACH: u64 = 24;

/// A calibrated scene, W m⁻² sr⁻¹ per cm⁻¹.
#[derive(Debug, Clone, Serialize)]
pub struct SceneFound {
    /// Numbers of rows, columns and bands of the scene.
    pub shape: Shape,
    /// Radiance of every sample.
    #[serde(skip)]
    pub radiance: Vec<f32>,
    /// Deviation common to all pixels, at every sample's radiance.
    #[serde(skip)]
    pub sigma_common: Vec<f32>,
    /// Deviation that each pixel has for itself in all scenes, by the noise of its own calibration; none where all have one.
    #[serde(skip)]
    pub sigma_pixel: Option<Vec<f32>>,
    /// Samples of pixels that respond to nothing.
    pub dead: usize,
    /// Samples that are no numbers.
    pub missing: usize,
    /// Deviation common to all pixels as a temperature that it is no larger than in 95 of 100 of them, rms of the bands, K.
    pub sigma_common_most_k: f64,
    /// Deviation of each sample for itself, of every band; with that of its pixel's calibration (rms) where it has its own.
    pub sigma_noise: Vec<f64>,
    /// Deviation common to all pixels that it is no larger than in 95 of 100 of them, of every band.
    pub sigma_common_most: Vec<f64>,
    /// What of it all bands have together, by the blackbodies' temperatures, emissivities and surroundings: the largest between their radiances, of every band.
    pub sigma_together: Vec<f64>,
}

/// A calibrated spectrometer before a scene.
pub(super) struct Spectrometer<'a> {
    pub(super) found: &'a Calibration,
    pub(super) wavenumbers_cm1: &'a [f64],
    /// Cubes of the blackbodies.
    pub(super) cubes: &'a [Cube],
    /// Deviation of a sample, counts.
    pub(super) noise: f64,
    pub(super) source: &'a Source,
}

impl Spectrometer<'_> {
    fn together(&self) -> Vec<f64> {
        let of = &self.found.blackbodies;
        let one = |(c, nu): (usize, &f64)| {
            let channel = &of.channels()[c];
            let radiances = channel.apart.iter().map(|apart| channel.mean_radiance + apart);
            let var = radiances.map(|s| self.found.bound.radiance(of, c, s).var_temperature);
            joules(*nu) * var.fold(0.0, f64::max).sqrt()
        };
        self.wavenumbers_cm1.iter().enumerate().map(one).collect()
    }

    /// With one response of each band for all pixels.
    pub(super) fn radiance(&self, cube: &Cube) -> Result<SceneFound> {
        check_memory(cube.shape(), KEPT, "the radiances of all samples")
            .map_err(at(self.source, "scene.data"))?;
        let (found, of) = (self.found, &self.found.blackbodies);
        // The variance of a radiance is a parabola: by three of its values.
        let lines: Vec<[f64; 6]> = (0..self.wavenumbers_cm1.len())
            .map(|c| {
                let channel = &of.channels()[c];
                let reach = channel.apart.iter().fold(0.0_f64, |most, b| most.max(b.abs()));
                let var = |s: f64| found.bound.radiance(of, c, s).sigma().powi(2);
                let mean = channel.mean_radiance;
                let [below, middle, above] = [var(mean - reach), var(mean), var(mean + reach)];
                let joules = joules(self.wavenumbers_cm1[c]);
                let square = joules * joules;
                [
                    joules * mean,
                    joules / found.response[c],
                    found.centre[c],
                    square * middle,
                    0.5 * joules * (above - below) / reach,
                    0.5 * (above + below - 2.0 * middle) / (reach * reach),
                ]
            })
            .collect();
        let both = pairs(cube, |band, sample| {
            let [mean, gain, centre, p, q, r] = lines[band];
            let off = gain * (sample - centre);
            let var = off.mul_add(off.mul_add(r, q), p);
            [(mean + off) as f32, var.max(0.0).sqrt() as f32]
        })?;
        let (radiance, sigma_common): (Vec<f32>, Vec<f32>) = both.into_iter().map(|[a, b]| (a, b)).unzip();
        let shape = cube.shape();
        Ok(SceneFound {
            shape,
            sigma_pixel: None,
            dead: 0,
            missing: radiance.iter().filter(|x| x.is_nan()).count(),
            sigma_common_most_k: most_k(self.wavenumbers_cm1, &radiance, &sigma_common),
            sigma_noise: lines.iter().map(|line| (self.noise * line[1]).abs()).collect(),
            sigma_common_most: most(&sigma_common, shape, |c| lines[c][3].max(0.0).sqrt()),
            sigma_together: self.together(),
            radiance,
            sigma_common,
        })
    }

    /// Every pixel by a response and an offset of its own; temperatures of the blackbodies as all pixels together find them.
    pub(super) fn radiance_of_each(&self, cube: &Cube) -> Result<SceneFound> {
        let (found, source, noise) = (self.found, self.source, self.noise);
        let shape = cube.shape();
        check_memory(shape, KEPT_OF_EACH, "the radiances of all samples")
            .map_err(at(source, "scene.data"))?;
        for (k, other) in self.cubes.iter().enumerate() {
            if other.shape() != shape {
                let sizes =
                    format!("the cube is {}, but the scene is {}", shown(other.shape()), shown(shape));
                let instead = "give blackbodies of its size, or write response = \"common\" in [scene]";
                return Err(at(source, &format!("blackbody[{k}].data"))(Error::malformed(sizes, instead)));
            }
        }
        let (nu, of) = (self.wavenumbers_cm1, &found.blackbodies);
        let mut sent = of.sent().to_vec();
        for (one, shift) in of.unknowns().iter().zip(&found.shifts) {
            sent[one.blackbody] = sent[one.blackbody].shifted(one.of, *shift);
        }
        let sigma = vec![vec![noise; nu.len()]; self.cubes.len()];
        let own = Blackbodies::of(nu, sent, &vec![[0.0; 3]; self.cubes.len()], &sigma)
            .map_err(at(source, "blackbody"))?;
        // Of the temperatures alone: a parabola, by three of its values.
        let lines: Vec<[f64; 4]> = (0..nu.len())
            .map(|c| {
                let channel = &own.channels()[c];
                let reach = channel.apart.iter().fold(0.0_f64, |most, b| most.max(b.abs()));
                let mean = channel.mean_radiance;
                let var = |s: f64| found.bound.radiance(of, c, s).var_temperature;
                let [below, middle, above] = [var(mean - reach), var(mean), var(mean + reach)];
                let (slope, bend) = (0.5 * (above - below) / reach, 0.5 * (above + below - 2.0 * middle));
                [joules(nu[c]), middle, slope, bend / (reach * reach)]
            })
            .collect();
        let place = |k: usize, error: Error| match k {
            0 => at(source, "scene.data")(error),
            k => at(source, &format!("blackbody[{}].data", k - 1))(error),
        };
        let [radiance, sigma_common, sigma_pixel] = beside(cube, self.cubes, place, |c, sample, black| {
            let (channel, [joules, p, q, r]) = (&own.channels()[c], lines[c]);
            let (mut response, mut centre) = (0.0, 0.0);
            for ((h, share), count) in channel.gain.iter().zip(&channel.share).zip(black) {
                response += h * count;
                centre += share * count;
            }
            if response * response < DEAD * DEAD * channel.var_response {
                return [f32::NAN; 3];
            }
            let off = (sample - centre) / response;
            let common = off.mul_add(off.mul_add(r, q), p).max(0.0).sqrt();
            let pixel = (off * off).mul_add(channel.var_response, channel.var_centre).sqrt() / response.abs();
            [channel.mean_radiance + off, common, pixel].map(|x| (joules * x) as f32)
        })?;
        let mut missing = 0;
        pairs(cube, |_, _| [0.0; 2])?.iter().for_each(|pair| missing += usize::from(pair[0].is_nan()));
        let dead = radiance.iter().filter(|x| x.is_nan()).count() - missing;
        let rms = |band: usize| {
            let every = (shape.len() / shape.bands() / LOOKED_AT).max(1) * shape.bands();
            let some = sigma_pixel.iter().skip(band).step_by(every).filter(|x| x.is_finite());
            let (sum, count) = some.fold((0.0, 0.0_f64), |(sum, count), x| {
                (f64::from(*x).mul_add(f64::from(*x), sum), count + 1.0)
            });
            sum / count.max(1.0)
        };
        let sigma_noise = (0..nu.len()).map(|c| {
            let sample = lines[c][0] * noise / found.response[c];
            sample.mul_add(sample, rms(c)).sqrt()
        });
        Ok(SceneFound {
            shape,
            sigma_noise: sigma_noise.collect(),
            sigma_common_most: most(&sigma_common, shape, |c| lines[c][0] * lines[c][1].max(0.0).sqrt()),
            sigma_together: self.together(),
            sigma_common_most_k: most_k(nu, &radiance, &sigma_common),
            missing,
            dead,
            radiance,
            sigma_common,
            sigma_pixel: Some(sigma_pixel),
        })
    }
}

/// Of each band, what 95 of 100 samples do not exceed; of bands without a number what `else_of` says.
fn most(sigma: &[f32], shape: Shape, else_of: impl Fn(usize) -> f64) -> Vec<f64> {
    let every = (shape.len() / shape.bands() / LOOKED_AT).max(1) * shape.bands();
    let of = |band: usize| {
        let mut some: Vec<f32> =
            sigma.iter().skip(band).step_by(every).copied().filter(|x| x.is_finite()).collect();
        some.sort_by(f32::total_cmp);
        some.get(some.len() * 95 / 100).map_or_else(|| else_of(band), |x| f64::from(*x))
    };
    (0..shape.bands()).map(of).collect()
}

/// What errors of radiances are as temperatures: of each band what 95 of 100 samples do not exceed, rms of the bands, K.
fn most_k(wavenumbers_cm1: &[f64], radiance: &[f32], sigma: &[f32]) -> f64 {
    let bands = wavenumbers_cm1.len();
    let every = (radiance.len() / bands / LOOKED_AT).max(1) * bands;
    let (mut sum, mut count) = (0.0, 0.0_f64);
    for (band, nu) in wavenumbers_cm1.iter().enumerate() {
        let both = radiance.iter().zip(sigma).skip(band).step_by(every);
        let of = |(radiance, sigma): (&f32, &f32)| {
            let t = planck::brightness_temperature(*nu, f64::from(*radiance) / joules(*nu));
            f64::from(*sigma) / (joules(*nu) * planck::photon_radiance_slope(*nu, t))
        };
        let positive = both.filter(|(radiance, _)| **radiance > 0.0);
        let mut all: Vec<f64> = positive.map(of).filter(|x| x.is_finite()).collect();
        all.sort_by(f64::total_cmp);
        if let Some(most) = all.get(all.len() * 95 / 100) {
            sum += most * most;
            count += 1.0;
        }
    }
    (sum / count.max(1.0)).sqrt()
}

/// Energy of a photon, J.
fn joules(wavenumber_cm1: f64) -> f64 {
    PLANCK_J_S * SPEED_OF_LIGHT_M_S * 100.0 * wavenumber_cm1
}

/// Share of some of the samples that lie beyond the radiances of the blackbodies.
pub(super) fn beyond(scene: &SceneFound, wavenumbers_cm1: &[f64], [low_k, high_k]: [f64; 2]) -> f64 {
    let limits: Vec<[f64; 2]> = wavenumbers_cm1
        .iter()
        .map(|nu| [low_k, high_k].map(|t| joules(*nu) * planck::photon_radiance(*nu, t)))
        .collect();
    let bands = limits.len();
    let every = (scene.radiance.len() / bands / LOOKED_AT).max(1);
    let (mut out, mut all) = (0.0, 0.0);
    for pixel in scene.radiance.chunks(bands).step_by(every) {
        for (radiance, ([low, high], noise)) in pixel.iter().zip(limits.iter().zip(&scene.sigma_noise)) {
            let radiance = f64::from(*radiance);
            if !radiance.is_finite() {
                continue;
            }
            out += f64::from(u8::from(radiance < low - 3.0 * noise || radiance > high + 3.0 * noise));
            all += 1.0;
        }
    }
    out / f64::max(all, 1.0)
}
