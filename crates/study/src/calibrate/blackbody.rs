//! Response and offset of a spectrometer by blackbodies, and the radiance of a scene.

use super::left_out::LeftOut;
use super::scene_radiance::{DEAD, SceneFound, Spectrometer, beyond};
use super::stated::{taken_as_black, uncertainty_not_stated};
use super::whole::{at, means};
use crate::cube_bad::BadBand;
use crate::cube_bands::{InOrder, Stated};
use crate::{Warning, bands};
use hadar::calibration::blackbody::{Blackbodies, Parts};
use hadar::calibration::sent::Deviations;
use hadar::cube::{Cube, Shape};
use hadar::demand::{Thing, Work};
use hadar::error::{Error, Result};
use hadar::planck;
use hadar::words::significant;
use hadar_estimate::calibrate::spectrometer::Calibration;
use hadar_scenario::calibrate::BlackbodyScenario;
use hadar_scenario::calibrate::blackbodies::BlackbodySpec;
use hadar_scenario::calibrate::blackbodies::CubeFile;
use serde::Serialize;

/// By so much the pixels of a blackbody may scatter more than the stated noise.
const UNEVEN: f64 = 1.1;
/// χ²/ν beyond which blackbodies do not lie on lines, at least.
const MISFIT: f64 = 1.3;
/// A response that is known to no better than this share of it is hardly known.
const BARELY: f64 = 0.2;
/// Readings beyond which squares of them are no numbers any more.
const LARGEST: f64 = 1e60;
/// Share of the span of two blackbodies by which a response that is not linear may lie off their line in the middle.
const BEND: f64 = 0.01;
/// Temperatures of the range of the blackbodies at which errors are looked at.
const STEPS: usize = 41;
/// Share of the samples that may lie beyond the blackbodies without a word.
const BEYOND: f64 = 0.01;

/// Cubes that are open.
#[derive(Debug)]
pub struct BlackbodyStudy {
    scenario: BlackbodyScenario,
    wavenumbers_cm1: Vec<f64>,
    /// Of all bands, those left out among them.
    centres_cm1: Vec<f64>,
    left_out: LeftOut,
    order_taken: Option<Warning>,
    cubes: Vec<Cube>,
    scene: Option<Cube>,
}

/// A channel with its errors; radiances in photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ChannelRow {
    /// Wavenumber of the channel, cm⁻¹.
    pub wavenumber_cm1: f64,
    /// Response R of the channel, counts per radiance.
    pub response: f64,
    /// Errors of the response in two parts, counts per radiance.
    pub response_error: Parts,
    /// Offset ξ of the channel, counts.
    pub offset: f64,
    /// Errors of the offset in two parts, counts.
    pub offset_error: Parts,
    /// Covariance of the errors of response and offset, counts² per radiance.
    pub covariance: f64,
    /// Error common to all pixels of a radiance in the middle of the blackbodies, as temperature, K: by noise, by temperatures.
    pub sigma_middle_k: [f64; 2],
    /// Noise of one sample as temperature there, K.
    pub noise_middle_k: f64,
}

/// The largest errors of radiances between those of the blackbodies, rms of the channels, K.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Worst {
    /// Temperatures of the coldest and of the warmest blackbody, K.
    pub range_k: [f64; 2],
    /// The temperature at which what is common to all pixels is the largest.
    pub at_k: f64,
    /// Common to all pixels there: by noise, by temperatures.
    pub sigma_common_k: [f64; 2],
    /// Noise of a sample where it is the largest.
    pub noise_k: f64,
}

/// What was found.
#[derive(Debug, Clone, Serialize)]
pub struct BlackbodyFound {
    /// The question as it was asked, defaults filled in.
    pub scenario: BlackbodyScenario,
    /// The channels; bands that are left out are none.
    pub channels: Vec<ChannelRow>,
    /// Where the channels stand among the bands, counted from 0 in rising wavenumber.
    #[serde(skip)]
    pub places: Vec<usize>,
    /// Centres of all bands, cm⁻¹, those left out among them.
    #[serde(skip)]
    pub centres_cm1: Vec<f64>,
    /// Bands that are left out of all cubes, with why.
    pub left_out: Vec<BadBand>,
    /// The temperature in the middle of the blackbodies, K.
    pub middle_k: f64,
    /// Where between the blackbodies the error common to all pixels is the largest.
    pub worst: Worst,
    /// Errors of the blackbodies' temperatures as found, and their deviations, K.
    pub temperature_shifts_k: Vec<[f64; 2]>,
    /// χ² over its degrees of freedom; none of two blackbodies.
    pub chi_square_reduced: Option<f64>,
    /// Whether the blackbodies lie off straight lines beyond chance, so that errors do not hold.
    pub misfit: bool,
    /// The calibrated scene; none where no scene was given.
    pub scene: Option<SceneFound>,
    /// What was done and what was spared.
    pub stats: Work,
    /// What the reader must know.
    pub warnings: Vec<Warning>,
}

impl BlackbodyStudy {
    /// Opens the cubes.
    ///
    /// # Errors
    /// Files that cannot be used, bands that are not those of the cubes; with file, line and key.
    pub fn new(scenario: &BlackbodyScenario) -> Result<Self> {
        let source = &scenario.source;
        let bands = bands::at_centres(&scenario.bands.source, source)?;
        if !bands.one_node_per_band() {
            let found = "channels of a spectrometer are bands of one wavenumber each";
            let instead = "write start, stop and step, or rows; filters are for hadar calibrate response";
            return Err(at(source, "bands")(Error::malformed(found, instead)));
        }
        let stated = Stated::of(&scenario.bands.source).map_err(at(source, "bands"))?;
        let (mut named, mut absent, mut order_taken) = (Vec::new(), Vec::new(), None);
        let mut opened = |file: &CubeFile, key: &str| -> Result<Cube> {
            let opened =
                InOrder::open(&file.path, file.variable.as_deref(), file.axes, stated.listed.as_deref())
                    .and_then(|opened| opened.among(&bands))
                    .map_err(at(source, &format!("{key}.data")))?;
            absent.extend(opened.absent());
            order_taken = order_taken.take().or_else(|| stated.warning(&opened.found));
            named.extend(opened.bad_bands(&file.bad_bands).map_err(at(source, &format!("{key}.bad_bands")))?);
            Ok(opened.cube)
        };
        let cubes = scenario.blackbodies.iter().enumerate();
        let cubes = cubes
            .map(|(k, spec)| opened(&spec.data, &format!("blackbody[{k}]")))
            .collect::<Result<Vec<_>>>()?;
        let scene = scenario.scene.as_ref().map(|scene| opened(&scene.data, "scene")).transpose()?;
        let left_out = LeftOut::of(bands.len(), &named, &absent, &cubes, scenario.noise)
            .map_err(at(source, "blackbody"))?;
        let without = |cube: Cube| left_out.without(cube);
        Ok(Self {
            cubes: cubes.into_iter().map(without).collect::<Result<_>>()?,
            scene: scene.map(without).transpose()?,
            wavenumbers_cm1: left_out
                .good
                .iter()
                .filter_map(|band| bands.nodes_cm1().get(*band))
                .copied()
                .collect(),
            centres_cm1: bands.nodes_cm1().to_vec(),
            left_out,
            order_taken,
            scenario: scenario.clone(),
        })
    }

    /// Calibrates.
    ///
    /// # Errors
    /// Samples that are no numbers, channels that respond to nothing.
    pub fn calibrate(&self) -> Result<BlackbodyFound> {
        let (scenario, source) = (&self.scenario, &self.scenario.source);
        let nu = &self.wavenumbers_cm1;
        let (mut counts, mut sigma, mut warnings) = (Vec::new(), Vec::new(), Vec::new());
        let mut samples = 0;
        warnings.extend(self.order_taken.iter().cloned());
        warnings.extend(self.left_out.warnings());
        for (k, cube) in self.cubes.iter().enumerate() {
            let (mean, scatter) = means(cube).map_err(at(source, &format!("blackbody[{k}].data")))?;
            let shape = cube.shape();
            let pixels = shape.rows() * shape.columns();
            samples += shape.len();
            let over = scatter.iter().map(|s| (s / scenario.noise).powi(2)).sum::<f64>() / nu.len() as f64;
            // χ²/ν of so many samples scatters by √(2/ν).
            let chance = 1.0 + 5.0 * (2.0 / ((pixels.max(2) - 1) * nu.len()) as f64).sqrt();
            let each_pixel = scenario.scene.as_ref().is_some_and(|scene| scene.each_pixel);
            if !each_pixel && pixels > 1 && over.sqrt() > UNEVEN.max(chance.sqrt()) {
                warnings.push(Warning::BlackbodyNotEven { blackbody: k, over: over.sqrt() });
            }
            if let Some(large) = mean.iter().find(|count| count.abs() > LARGEST) {
                let error = Error::out_of_range(
                    "mean of a blackbody",
                    *large,
                    "",
                    "below 1e60: give the cubes in counts",
                );
                return Err(at(source, &format!("blackbody[{k}].data"))(error));
            }
            counts.push(mean);
            sigma.push(vec![scenario.noise / (pixels as f64).sqrt(); nu.len()]);
        }
        let specs = &scenario.blackbodies;
        let temperatures_k: Vec<f64> = specs.iter().map(|spec| spec.temperature_k).collect();
        let deviations: Vec<Deviations> = specs.iter().map(BlackbodySpec::deviations).collect();
        let of = Blackbodies::of(nu, specs.iter().map(BlackbodySpec::sent).collect(), &deviations, &sigma)
            .map_err(at(source, "blackbody"))?;
        let found = Calibration::found(of, &counts).map_err(at(source, "blackbody"))?;
        self.responds(&found).map_err(at(source, "blackbody"))?;
        warnings.extend(uncertainty_not_stated(specs));
        warnings.extend(taken_as_black(specs, nu[nu.len() / 2]));
        let shares = (0..nu.len())
            .map(|c| found.bound.response(&found.blackbodies, c).sigma() / found.response[c].abs());
        let (barely, worst) = shares.fold((0, 0.0_f64), |(count, worst), share| {
            (count + usize::from(share > BARELY), worst.max(share))
        });
        if barely > 0 {
            warnings.push(Warning::ResponseBarelyKnown { channels: barely, of: nu.len(), worst });
        }
        let freedom = nu.len() * (specs.len() - 2);
        let chi_square_reduced = (freedom > 0).then(|| found.chi_square / freedom as f64);
        let misfit =
            chi_square_reduced.filter(|chi| *chi > MISFIT.max(1.0 + 5.0 * (2.0 / freedom as f64).sqrt()));
        warnings.extend(misfit.map(|chi_square| Warning::BlackbodiesDoNotFit { chi_square }));
        let [low, high] = ends(&temperatures_k);
        let middle_k = 0.5 * (low + high);
        if freedom == 0 {
            warnings.push(Warning::LinearityNotTested { share: BEND, off_k: self.bent_k([low, high]) });
        }
        let channels = (0..nu.len()).map(|c| self.row(&found, c, middle_k)).collect();
        let spectrometer = Spectrometer {
            found: &found,
            wavenumbers_cm1: nu,
            cubes: &self.cubes,
            noise: scenario.noise,
            source,
        };
        let scene = match (&self.scene, &scenario.scene) {
            (Some(cube), Some(spec)) if spec.each_pixel => Some(spectrometer.radiance_of_each(cube)?),
            (Some(cube), _) => Some(spectrometer.radiance(cube).map_err(at(source, "scene.data"))?),
            (None, _) => None,
        };
        if let Some(dead) = scene.as_ref().map(|scene| scene.dead).filter(|dead| *dead > 0) {
            warnings.push(Warning::DeadSamples { samples: dead });
        }
        if let Some(missing) = scene.as_ref().map(|scene| scene.missing).filter(|missing| *missing > 0) {
            warnings.push(Warning::MissingSamples { samples: missing });
        }
        if let Some(scene) = &scene {
            samples += scene.shape.len();
            let beyond = beyond(scene, nu, [low, high]);
            if beyond > BEYOND {
                warnings.push(Warning::BeyondBlackbodies { share: beyond, low_k: low, high_k: high });
            }
        }
        let scene = scene.map(|scene| self.among_all(scene)).transpose()?;
        let shifts = found.shifts.iter().take(specs.len()).enumerate();
        let mut stats = Work::default();
        stats.compute(Thing::Samples, samples as u64);
        Ok(BlackbodyFound {
            scenario: scenario.clone(),
            channels,
            places: self.left_out.good.clone(),
            centres_cm1: self.centres_cm1.clone(),
            left_out: self.left_out.bands.clone(),
            middle_k,
            worst: self.worst(&found, [low, high]),
            temperature_shifts_k: shifts
                .map(|(k, shift)| [*shift, found.bound.sigma_temperature_k(&found.blackbodies, k)])
                .collect(),
            chi_square_reduced,
            misfit: misfit.is_some(),
            scene,
            stats,
            warnings,
        })
    }

    /// A scene of all bands, those that are left out missing.
    fn among_all(&self, scene: SceneFound) -> Result<SceneFound> {
        let (shape, left_out) = (scene.shape, &self.left_out);
        Ok(SceneFound {
            shape: Shape::new(shape.rows(), shape.columns(), self.centres_cm1.len())?,
            radiance: left_out.among(scene.radiance),
            sigma_common: left_out.among(scene.sigma_common),
            sigma_pixel: scene.sigma_pixel.map(|sigma| left_out.among(sigma)),
            ..scene
        })
    }

    /// Whether warmer blackbodies read more.
    fn responds(&self, found: &Calibration) -> Result<()> {
        let nu = &self.wavenumbers_cm1;
        let beyond = |sign: f64| {
            let sigma = |c: usize| found.blackbodies.channels()[c].var_response.sqrt();
            (0..nu.len()).filter(move |c| sign * found.response[*c] > DEAD * sigma(*c)).collect::<Vec<_>>()
        };
        let (more, less) = (beyond(1.0), beyond(-1.0));
        match less.first() {
            None if more.is_empty() => Err(Error::malformed(
                "the blackbodies read the same within noise in every channel",
                "check that their data are two files, and the noise of a sample",
            )),
            None => Ok(()),
            Some(first) => {
                let all = nu.len();
                let place = significant(nu[*first], 5);
                let found = format!(
                    "warmer blackbodies read less in {} of {all} channels (the first at {place} cm^-1)",
                    less.len()
                );
                let instead = match less.len() > more.len() {
                    true => {
                        "check whether data or temperatures of the blackbodies are swapped; turn the sign of all cubes if the \
                             instrument counts downwards"
                    }
                    false => {
                        "check the order of the bands and the phase of the spectra, and leave out channels that see nothing"
                    }
                };
                Err(Error::malformed(found, instead))
            }
        }
    }

    /// What a bend of [`BEND`] of the span of two blackbodies makes of a radiance in their middle, K: the largest of the channels.
    fn bent_k(&self, [low, high]: [f64; 2]) -> f64 {
        let off = |nu: &f64| {
            let span = planck::photon_radiance(*nu, high) - planck::photon_radiance(*nu, low);
            BEND * span / planck::photon_radiance_slope(*nu, 0.5 * (low + high))
        };
        self.wavenumbers_cm1.iter().map(off).fold(0.0, f64::max)
    }

    fn worst(&self, found: &Calibration, range_k: [f64; 2]) -> Worst {
        let [low, high] = range_k;
        let nu = &self.wavenumbers_cm1;
        let at = |i: usize| {
            let t = low + (high - low) * i as f64 / (STEPS - 1) as f64;
            let mut square = [0.0; 3];
            for (c, nu) in nu.iter().enumerate() {
                let slope = planck::photon_radiance_slope(*nu, t);
                let parts = found.bound.radiance(&found.blackbodies, c, planck::photon_radiance(*nu, t));
                let noise = self.scenario.noise / found.response[c];
                for (sum, var) in
                    square.iter_mut().zip([parts.var_noise, parts.var_temperature, noise * noise])
                {
                    *sum += var / (slope * slope) / self.wavenumbers_cm1.len() as f64;
                }
            }
            (t, square)
        };
        let all: Vec<(f64, [f64; 3])> = (0..STEPS).map(at).collect();
        let of = |entry: &(f64, [f64; 3])| entry.1[0] + entry.1[1];
        let first = all[0];
        let (at_k, square) =
            all.iter().fold(first, |most, entry| if of(entry) > of(&most) { *entry } else { most });
        Worst {
            range_k,
            at_k,
            sigma_common_k: [square[0].sqrt(), square[1].sqrt()],
            noise_k: all.iter().map(|entry| entry.1[2]).fold(0.0, f64::max).sqrt(),
        }
    }

    fn row(&self, found: &Calibration, c: usize, middle_k: f64) -> ChannelRow {
        let nu = self.wavenumbers_cm1[c];
        let slope = planck::photon_radiance_slope(nu, middle_k);
        let middle = found.bound.radiance(&found.blackbodies, c, planck::photon_radiance(nu, middle_k));
        ChannelRow {
            wavenumber_cm1: nu,
            response: found.response[c],
            response_error: found.bound.response(&found.blackbodies, c),
            offset: found.offset(c),
            offset_error: found.bound.offset(&found.blackbodies, c),
            covariance: found.bound.covariance(&found.blackbodies, c),
            sigma_middle_k: [middle.var_noise.sqrt() / slope, middle.var_temperature.sqrt() / slope],
            noise_middle_k: self.scenario.noise / found.response[c].abs() / slope,
        }
    }
}

fn ends(temperatures_k: &[f64]) -> [f64; 2] {
    let fold = |with: fn(f64, f64) -> f64, from: f64| temperatures_k.iter().copied().fold(from, with);
    [fold(f64::min, f64::INFINITY), fold(f64::max, 0.0)]
}
