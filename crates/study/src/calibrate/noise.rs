//! The noise of a camera out of its cubes.

use super::opened::Measured;
use crate::Warning;
use crate::cube_bad::cut_off_share;
use crate::cube_unit::check_light;
use hadar::cube::{Cube, Ordered, Rows, Sample, Shape};
use hadar::demand::{Thing, Work};
use hadar::error::{Error, Result};
use hadar::words::significant;
use hadar_estimate::calibrate::{
    Asked, Component, Correlation, Line, Transfer, noise_correlations, photon_transfer, three_dimensional,
};
use hadar_formats::cube::Found;
use hadar_scenario::calibrate::{NoiseScenario, NoiseSpec};
use serde::Serialize;

/// Share of texture in what neighbours differ by from which on its removal matters.
const TEXTURE: f64 = 0.2;
/// Key of the sample without light.
const DARK_LEVEL: &str = "noise.dark_level";
/// Share of samples at the largest value from which on the line is another one.
const CUT_OFF: f64 = 0.002;
/// Share of outliers from which on they are said.
const OUTLIERS: f64 = 1e-3;

/// Cubes that are open.
#[derive(Debug)]
pub struct NoiseStudy {
    scenario: NoiseScenario,
    frames: Measured,
}

/// The noise that was found.
#[derive(Debug, Clone, Serialize)]
pub struct NoiseFound {
    /// The question as it was asked, defaults filled in.
    pub scenario: NoiseScenario,
    /// What the files were read as.
    pub read: Vec<Found>,
    /// Numbers of rows, columns and bands of the cube.
    pub shape: Shape,
    /// How many frames there are.
    pub frames: usize,
    /// What photons make of it; `None` of frames of one brightness, which tell nothing of that.
    #[serde(flatten)]
    pub photons: Option<PhotonNoise>,
    /// Variances of the noise in three dimensions, unit² of the cube; `None` of one frame, or where samples are missing.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub three_dimensional: Option<[Component; 7]>,
    /// How the noise goes together along each dimension of the frames that is long enough to tell; of one frame nothing.
    pub correlations: Vec<Correlation>,
    /// What was done and what was spared.
    pub stats: Work,
    /// What the reader must know.
    pub warnings: Vec<Warning>,
}

/// Photons and electronic noise by photon transfer.
#[derive(Debug, Clone, Serialize)]
pub struct PhotonNoise {
    /// Photons for one unit of the cube, 1/b, with the ends of its 95 % interval.
    pub photons_per_unit: [f64; 3],
    /// Deviation of the electronic noise of a reading, electrons, with the ends of its 95 % interval.
    pub noise_electrons: [f64; 3],
    /// Root of c, the relative deviation of gains, where it was asked for.
    pub gain_deviation: Option<f64>,
    /// Whether the figures hold for all bands and are told well enough to be used.
    pub usable: bool,
    /// What was fitted.
    #[serde(flatten)]
    pub transfer: Transfer,
}

impl NoiseFound {
    /// Whether figures of a camera follow from this noise: not where samples that are taken as independent go together.
    #[must_use]
    pub fn is_independent(&self) -> bool {
        !self.correlations.iter().any(Correlation::is_large)
    }
}

impl NoiseStudy {
    /// Opens the cubes.
    ///
    /// # Errors
    /// Files that cannot be used, with file, line and key.
    pub fn new(scenario: &NoiseScenario) -> Result<Self> {
        let frames = Measured::open(&scenario.cube, &scenario.source)?;
        // Photons are counted in what is in proportion to light.
        for (found, path) in frames.read.iter().zip(&scenario.cube.data) {
            check_light(found).map_err(|error| error.in_file(path))?;
        }
        Ok(Self { frames, scenario: scenario.clone() })
    }

    /// The noise.
    ///
    /// # Errors
    /// Cubes out of which no noise can be told, each with what to give instead.
    pub fn noise(&self) -> Result<NoiseFound> {
        let spec = self.scenario.noise;
        let asked = Asked { dark_level: spec.dark_level, gain_spread: spec.gain_spread };
        let (cubes, good) = (&self.frames.cubes, &self.frames.good);
        for (cube, path) in cubes.iter().zip(&self.scenario.cube.data) {
            check_cut_off(cube, good).map_err(|error| error.in_file(path))?;
        }
        let singles = cubes.iter().filter_map(of_32).map(|cube| Ordered::new(cube, good.clone()));
        let singles = singles.collect::<Result<Vec<_>>>()?;
        let doubles = cubes.iter().filter_map(of_64).map(|cube| Ordered::new(cube, good.clone()));
        let doubles = doubles.collect::<Result<Vec<_>>>()?;
        let place = |error: Error| match (&error, &self.scenario.source.path, self.scenario.cube.data.first())
        {
            (Error::At { place, .. }, ..) if place.path.is_some() => error,
            (Error::At { place, .. }, Some(_), _) if place.key.as_deref() == Some(DARK_LEVEL) => {
                error.at(self.scenario.source.place(DARK_LEVEL))
            }
            (_, Some(_), _) => error.at(self.scenario.source.place("cube.data")),
            (_, None, Some(path)) => error.in_file(path),
            _ => error,
        };
        let (transfer, three_dimensional, correlations) = match (singles.is_empty(), doubles.is_empty()) {
            (false, true) => found(&rows(&singles), &asked),
            (true, false) => found(&rows(&doubles), &asked),
            _ => Err(Error::malformed(
                "frames of 32 bits and of 64 bits",
                "write all frames as one type, np.float32 or np.float64",
            )),
        }
        .map_err(place)?;
        let mut warnings = self.frames.warnings();
        let together: Vec<Correlation> = correlations.iter().filter(|of| of.is_large()).copied().collect();
        warnings.extend(
            together.iter().map(|&Correlation { of, value, limit, .. }| Warning::CorrelatedNoise {
                of,
                value,
                limit,
            }),
        );
        let shape = self.frames.cubes.first().map(Cube::shape).map_or_else(|| Shape::new(1, 1, 1), Ok)?;
        let photons = match transfer {
            Ok(transfer) => {
                let found = PhotonNoise::of(transfer, spec, &mut warnings).among(good, shape.bands());
                Some(PhotonNoise { usable: found.usable && together.is_empty(), ..found })
            }
            // One brightness tells nothing of photons, but what pixels share.
            Err(_) if spec.uniform && three_dimensional.is_some_and(|terms| terms[0].variance > 0.0) => None,
            Err(error) => return Err(place(error)),
        };
        Ok(NoiseFound {
            scenario: self.scenario.clone(),
            read: self.frames.read.clone(),
            shape,
            frames: self.frames.cubes.len(),
            photons,
            three_dimensional,
            correlations,
            stats: {
                let mut work = Work::default();
                work.compute(Thing::Samples, (self.frames.cubes.len() * shape.len()) as u64);
                work
            },
            warnings,
        })
    }
}

/// Refuses samples that are cut off, which have no noise.
///
/// # Errors
/// More than a share of [`CUT_OFF`] of them.
fn check_cut_off(cube: &Cube, good: &[usize]) -> Result<()> {
    match cut_off_share(cube, good)? {
        Some([most, share]) if share > CUT_OFF => Err(Error::malformed(
            format!(
                "{} % of the samples are cut off at {}, where they have no noise",
                significant(100.0 * share, 2),
                significant(most, 6)
            ),
            "give frames of which nothing is cut off (a shorter exposure, the dark level left in), or NaN for the pixels that are in any frame",
        )),
        _ => Ok(()),
    }
}

impl PhotonNoise {
    /// The figures of a line that was fitted, with what the reader must know of it.
    fn of(transfer: Transfer, spec: NoiseSpec, warnings: &mut Vec<Warning>) -> Self {
        let common = transfer.common;
        if transfer.outliers > OUTLIERS {
            warnings.push(Warning::NoiseOutliers { share: transfer.outliers });
        }
        let texture = transfer.bands.iter().map(|band| band.texture).fold(0.0, f64::max);
        if texture > TEXTURE {
            warnings.push(Warning::TextureInNoise { share: texture });
        }
        let alike = transfer.is_common();
        if !alike {
            warnings.push(Warning::BandsDifferInNoise {
                chi_square: transfer.chi_square_reduced,
                limit: transfer.chi_square_limit,
            });
        }
        let is_bent = transfer.is_bent();
        if let Some([bend, sigma]) = transfer.bend.filter(|_| is_bent) {
            warnings.push(Warning::NoiseNotStraight { bend, sigma });
        }
        let [low, high] = Line::interval(common.per_photon, common.sigma_per_photon);
        let [least, most] = common.noise_electrons_interval();
        let told = low > 0.0;
        // No camera has a variance below 0, without light or at the least that was seen.
        let possible = !told || (most > 0.0 && transfer.least_variance() > 0.0);
        if !possible {
            warnings.push(Warning::NoiseBelowZero {
                electronic: common.electronic,
                sigma: common.sigma_electronic,
                dark_level: spec.dark_level,
            });
        }
        if !told {
            warnings.push(Warning::PhotonsNotTold {
                per_photon: common.per_photon,
                sigma: common.sigma_per_photon,
            });
        }
        let inverse = |b: f64| if b > 0.0 { 1.0 / b } else { f64::INFINITY };
        Self {
            photons_per_unit: [inverse(common.per_photon), inverse(high), inverse(low)],
            noise_electrons: [common.noise_electrons(), least, most],
            gain_deviation: spec.gain_spread.then(|| common.spread.max(0.0).sqrt()),
            usable: told && alike && possible && !is_bent,
            transfer,
        }
    }

    /// Of a cube of so many bands, of which those looked at were `of`.
    fn among(self, of: &[usize], bands: usize) -> Self {
        Self { transfer: self.transfer.among(of, bands), ..self }
    }
}

/// A photon transfer, or why there is none, the noise in three dimensions, and how it goes together.
type Told = (Result<Transfer>, Option<[Component; 7]>, Vec<Correlation>);

/// # Errors
/// Frames of different shapes, or that cannot be read.
fn found<S: Sample>(frames: &[&dyn Rows<S>], asked: &Asked) -> Result<Told> {
    let transfer = photon_transfer(frames, asked);
    let also = || Ok((three_dimensional(frames)?, noise_correlations(frames, asked.dark_level)?));
    match also() {
        Ok((terms, correlations)) => Ok((transfer, terms, correlations)),
        // What is wrong with the frames is said once.
        Err(error) => Err(transfer.err().unwrap_or(error)),
    }
}

fn rows<S: Sample, R: Rows<S>>(frames: &[R]) -> Vec<&dyn Rows<S>> {
    frames.iter().map(|frame| frame as &dyn Rows<S>).collect()
}

fn of_32(cube: &Cube) -> Option<&dyn Rows<f32>> {
    match cube {
        Cube::F32(rows) => Some(rows.as_ref()),
        Cube::F64(_) => None,
    }
}

fn of_64(cube: &Cube) -> Option<&dyn Rows<f64>> {
    match cube {
        Cube::F64(rows) => Some(rows.as_ref()),
        Cube::F32(_) => None,
    }
}
