//! The response of a camera behind a filter wheel by blackbodies, the wheel's relative transmittance, and radiances behind the filters.

use super::left_out::LeftOut;
use super::stated::{taken_as_black, uncertainty_not_stated};
use super::whole::{at, open, samples, shown};
use crate::cube_bad::BadBand;
use crate::heat_cube::columns;
use crate::{Warning, WorstBlackbody};
use hadar::calibration::determined::{CurvePrior, Determined};
use hadar::calibration::filter_wheel::{FilterWheel, Reading};
use hadar::calibration::finer::Finer;
use hadar::calibration::sent::{Deviations, Unknown};
use hadar::cube::{Cube, Shape};
use hadar::demand::{Thing, Work};
use hadar::error::{Error, Result};
use hadar::order;
use hadar::planck;
use hadar::spectrum::{FilterCurve, interpolated};
use hadar_estimate::calibrate::response::{FilterRadiance, Response};
use hadar_estimate::calibrate::vignette::{Vignette, centre, subtracted};
use hadar_scenario::calibrate::ResponseScenario;
use hadar_scenario::calibrate::blackbodies::{BlackbodySpec, CubeFile};
use serde::Serialize;
use std::path::Path;

/// Points over the width of a part of a response value at which a filter is looked at.
const POINTS: usize = 11;
/// A column of this ending is the reflectance of the filter before it.
const REFLECTANCE: &str = ":reflectance";
/// Fewest degrees of freedom of a test of the readings.
const TESTED: f64 = 0.5;
/// Share of χ² of which one blackbody is named as its cause.
const EXPLAINS: f64 = 0.5;
/// χ² per degree of freedom beyond which readings do not fit, at least.
const MISFIT: f64 = 1.3;

/// Cubes that are open, and filters looked up.
#[derive(Debug)]
pub struct ResponseStudy {
    scenario: ResponseScenario,
    centres_cm1: Vec<f64>,
    /// The parts of each value, over which readings are summed.
    finer: Finer,
    names: Vec<String>,
    left_out: Vec<LeftOutFilter>,
    /// Of every filter, over the parts.
    transmittances: Vec<Vec<f64>>,
    /// At the parts.
    typical: Vec<f64>,
    cubes: Vec<Cube>,
    scene: Option<[Cube; 2]>,
}

/// A value of the response, counts per photon s⁻¹ m⁻² sr⁻¹.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ResponseRow {
    /// Its wavenumber, cm⁻¹.
    pub wavenumber_cm1: f64,
    /// R.
    pub response: f64,
    /// Its deviation.
    pub sigma: f64,
    /// The deviation known beforehand.
    pub sigma_beforehand: f64,
    /// The typical curve, scaled to the readings.
    pub typical: f64,
    /// The deviation by the readings alone; none where they do not tell it.
    pub sigma_readings_alone: Option<f64>,
}

/// A filter that is left out.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct LeftOutFilter {
    /// Its name.
    pub filter: String,
    /// Its band of the cubes, from 0.
    pub band: usize,
    /// `named`, `missing`, `stuck` or `saturated`.
    pub why: &'static str,
}

/// Radiances of a scene behind the filters, photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹.
#[derive(Debug, Clone, Serialize)]
pub struct FilterRadiances {
    /// Rows, columns and filters.
    pub shape: Shape,
    /// Mean radiance of every sample over its filter and the response.
    #[serde(skip)]
    pub radiance: Vec<f32>,
    /// Deviation of a sample for itself at the centre, of every filter, with that of its pixel's η at the rms of the scene's contrast; noise
    /// is that over η elsewhere.
    pub sigma_noise: Vec<f64>,
    /// Deviation common to all pixels at the mean radiance, of every filter: by the response, by the centre's η, by the reference's temperature.
    pub sigma_common: Vec<f64>,
}

/// What was found.
#[derive(Debug, Clone, Serialize)]
pub struct ResponseFound {
    /// The question.
    pub scenario: ResponseScenario,
    /// Names of the filters; those left out are not among them.
    pub filters: Vec<String>,
    /// Filters that are left out of all cubes, with why.
    pub left_out: Vec<LeftOutFilter>,
    /// The response.
    pub response: Vec<ResponseRow>,
    /// Covariance of its values, row after row.
    #[serde(skip)]
    pub covariance: Vec<f64>,
    /// Resolving kernels, row after row.
    #[serde(skip)]
    pub kernels: Vec<f64>,
    /// Directions known to a tenth of the peak by the readings alone.
    pub determined: usize,
    /// Singular values above rounding.
    pub rank: usize,
    /// Effective number with smoothness.
    pub effective: f64,
    /// Deviation of every direction, peak of the typical curve 1; none where nothing tells it.
    pub sigma_directions: Vec<Option<f64>>,
    /// Offsets K_q + ξ at the centre, counts.
    pub offsets: Vec<f64>,
    /// Their deviations, counts.
    pub offset_sigmas: Vec<f64>,
    /// χ² of the readings over its degrees of freedom; none where the unknowns fit any readings.
    pub chi_square_reduced: Option<f64>,
    /// Those, n − tr H: the readings less what the unknowns take of them.
    pub freedom: f64,
    /// Whether the readings lie off the response beyond chance, so that errors do not hold.
    pub misfit: bool,
    /// Rows and columns of the cubes.
    pub size: [usize; 2],
    /// Relative transmittance η of every pixel; none where the cubes are all centre.
    #[serde(skip)]
    pub eta: Option<Vignette>,
    /// Least and largest η.
    pub eta_range: Option<[f64; 2]>,
    /// Deviation of η in a pixel.
    pub eta_sigma: Option<f64>,
    /// The scene.
    pub scene: Option<FilterRadiances>,
    /// What was done and what was spared.
    pub stats: Work,
    /// What the reader must know.
    pub warnings: Vec<Warning>,
}

impl ResponseStudy {
    /// Looks up filters and the typical curve, and opens the cubes.
    ///
    /// # Errors
    /// Filters that are dependent or not those of the cubes, cubes of different sizes, files that cannot be used; with file, line, key.
    pub fn new(scenario: &ResponseScenario) -> Result<Self> {
        let (source, spec) = (&scenario.source, &scenario.response);
        let [low, high] = spec.range_cm1;
        let step = (high - low) / (spec.values - 1) as f64;
        let centres_cm1: Vec<f64> = (0..spec.values).map(|j| low + step * j as f64).collect();
        let key = if spec.values < 2 { "response.values" } else { "response.correlation" };
        let finer = Finer::of(&centres_cm1, spec.known.correlation_cm1).map_err(at(source, key))?;
        let parts_cm1 = finer.centres_cm1();
        let (names, transmittances) =
            filters(&spec.filters, parts_cm1, finer.step_cm1()).map_err(at(source, "response.filters"))?;
        let typical = spec.typical.as_ref().map(|path| typical(path, parts_cm1)).transpose();
        let typical =
            typical.map_err(at(source, "response.typical"))?.unwrap_or_else(|| vec![1.0; parts_cm1.len()]);
        let mut named = Vec::new();
        let mut opened = |file: &CubeFile, key: &str| -> Result<Cube> {
            let (cube, bad) = open(file, source, key)?;
            named.extend(bad);
            Ok(cube)
        };
        let mut cubes = Vec::new();
        for (k, blackbody) in scenario.blackbodies.iter().enumerate() {
            let key = format!("blackbody[{k}].data");
            let cube = opened(&blackbody.data, &key)?;
            check_filters(&cube, names.len()).map_err(at(source, &key))?;
            if let Some(first) = cubes.first() {
                same_size(&cube, first, "blackbody[0]").map_err(at(source, &key))?;
            }
            cubes.push(cube);
        }
        let scene = scenario.scene.as_ref().map(|spec| {
            let scene = opened(&spec.data, "scene.data")?;
            same_size(&scene, &cubes[0], "blackbody[0]").map_err(at(source, "scene.data"))?;
            let file = CubeFile { path: spec.reference.clone(), ..spec.data.clone() };
            let reference = opened(&file, "scene.reference")?;
            same_size(&reference, &scene, "the scene").map_err(at(source, "scene.reference"))?;
            Ok([scene, reference])
        });
        let scene = scene.transpose()?;
        let mut study = Self {
            scenario: scenario.clone(),
            scene,
            left_out: Vec::new(),
            centres_cm1,
            finer,
            names,
            transmittances,
            typical,
            cubes,
        };
        study.leave_out(&named).map_err(at(source, "blackbody"))?;
        let wheel = study.wheel_of_values(1.0)?;
        if let Some([like, dependent]) = wheel.dependent() {
            let [like, dependent] = [like, dependent].map(|q| &study.names[q]);
            let found = format!(
                "filter `{dependent}` is a combination of those before it, the most like `{like}`: the filters are linearly dependent"
            );
            let error =
                Error::malformed(found, format!("leave `{dependent}` out, and its band of the cubes"));
            return Err(at(source, "response.filters")(error));
        }
        Ok(study)
    }

    fn warnings_of_left_out(&self) -> impl Iterator<Item = Warning> + '_ {
        ["missing", "stuck", "saturated"].into_iter().filter_map(|why| {
            let of = self.left_out.iter().filter(|one| one.why == why);
            let filters: Vec<String> = of.map(|one| one.filter.clone()).collect();
            (!filters.is_empty()).then_some(Warning::FiltersLeftOut { filters, why })
        })
    }

    /// Leaves the filters out whose bands are bad in some cube.
    fn leave_out(&mut self, named: &[usize]) -> Result<()> {
        let left_out = LeftOut::of(self.names.len(), named, &[], &self.cubes, self.scenario.noise)?;
        if left_out.bands.is_empty() {
            return Ok(());
        }
        let name = |band: usize| self.names.get(band).cloned().unwrap_or_default();
        let of = |bad: &BadBand| LeftOutFilter { filter: name(bad.band), band: bad.band, why: bad.why };
        self.left_out = left_out.bands.iter().map(of).collect();
        let is_good = |band: usize| left_out.good.contains(&band);
        let mut places = (0..).map(is_good);
        self.names.retain(|_| places.next().unwrap_or(false));
        let mut places = (0..).map(is_good);
        self.transmittances.retain(|_| places.next().unwrap_or(false));
        let cubes = std::mem::take(&mut self.cubes);
        self.cubes = cubes.into_iter().map(|cube| left_out.without(cube)).collect::<Result<_>>()?;
        if let Some([scene, reference]) = self.scene.take() {
            self.scene = Some([left_out.without(scene)?, left_out.without(reference)?]);
        }
        Ok(())
    }

    /// The sum that a reading is.
    fn wheel(&self, counts_per_radiance: f64) -> Result<FilterWheel> {
        let parts_cm1 = self.finer.centres_cm1().to_vec();
        FilterWheel::new(parts_cm1, self.transmittances.clone(), counts_per_radiance)
    }

    /// The same by the values alone: of how many values it is asked what readings determine.
    fn wheel_of_values(&self, counts_per_radiance: f64) -> Result<FilterWheel> {
        let means = self.transmittances.iter().map(|filter| self.finer.means(filter)).collect();
        FilterWheel::new(self.centres_cm1.clone(), means, counts_per_radiance)
    }

    /// Calibrates.
    ///
    /// # Errors
    /// Samples that are no numbers, blackbodies that read all the same.
    pub fn calibrate(&self) -> Result<ResponseFound> {
        let (scenario, source) = (&self.scenario, &self.scenario.source);
        let (specs, filters) = (&scenario.blackbodies, self.names.len());
        let read = self.cubes.iter().enumerate();
        let cubes = read
            .map(|(k, cube)| samples(cube).map_err(at(source, &format!("blackbody[{k}].data"))))
            .collect::<Result<Vec<_>>>()?;
        let shape = self.cubes[0].shape();
        let size = [shape.rows(), shape.columns()];
        let middle = centre(size, scenario.response.centre_half);
        let (readings, counts) = self.readings(&cubes, &middle);
        let scale = self.scale(&readings, &counts).map_err(at(source, "blackbody"))?;
        let wheel = self.wheel(scale)?;
        let prior = |centres: &[f64], typical: &[f64]| {
            CurvePrior::smooth(centres, typical, scenario.response.known).map_err(at(source, "response"))
        };
        let finer = &self.finer;
        let typical = finer.at_values(&self.typical);
        let (prior, prior_of_values) =
            (prior(finer.centres_cm1(), &self.typical)?, prior(&self.centres_cm1, &typical)?);
        let deviations: Vec<Deviations> = specs.iter().map(BlackbodySpec::deviations).collect();
        let errors = Unknown::all(&deviations).map_err(at(source, "blackbody"))?;
        let errors = if errors.iter().any(|one| one.deviation > 0.0) { &errors[..] } else { &[] };
        let found =
            Response::found(&wheel, &prior, &readings, &counts, errors).map_err(at(source, "blackbody"))?;
        let at_values = found.at_values(finer);
        let about = (!errors.is_empty()).then_some((errors, &found.values[..]));
        let seen = Determined::of(&wheel.scores(&readings, about)?, &prior)?;
        let about = (!errors.is_empty()).then_some((errors, &at_values.values[..]));
        let of_values = self.wheel_of_values(scale)?;
        let known = Determined::of(&of_values.scores(&readings, about)?, &prior_of_values)?;
        // Of readings that are all fitted nothing is left to be tested.
        let chi_square_reduced = (found.freedom > TESTED).then(|| found.chi_square_readings / found.freedom);
        let mut warnings: Vec<Warning> = self.warnings_of_left_out().collect();
        let misfit = chi_square_reduced.filter(|chi| *chi > most_by_chance(found.freedom.max(TESTED)));
        warnings.extend(misfit.map(|chi_square| self.does_not_fit(&found, chi_square)));
        warnings.extend(uncertainty_not_stated(specs));
        warnings.extend(taken_as_black(specs, self.centres_cm1[self.centres_cm1.len() / 2]));
        let values = self.centres_cm1.len();
        let row = |j: usize| ResponseRow {
            wavenumber_cm1: self.centres_cm1[j],
            response: scale * at_values.values[j],
            sigma: scale * at_values.sigma(j),
            sigma_beforehand: scale * known.sigma_prior[j],
            typical: scale * typical[j],
            sigma_readings_alone: Some(scale * known.sigma_free[j]).filter(|sigma| sigma.is_finite()),
        };
        let covariance = &at_values.factor * at_values.factor.transpose() * (scale * scale);
        // Also where all pixels are about the centre: then it is of each to their mean.
        let eta = (shape.rows() * shape.columns() > 1)
            .then(|| Vignette::found(&cubes, filters, &middle, scenario.noise))
            .transpose()
            .map_err(at(source, "blackbody"))?;
        if let Some(eta) = &eta
            && eta.chi_square_reduced > most_by_chance(eta.freedom.max(1) as f64)
        {
            warnings.push(Warning::VignetteDiffers { chi_square: eta.chi_square_reduced });
        }
        let scene = match &self.scene {
            Some([scene, reference]) => {
                Some(self.radiances(&wheel, &found, eta.as_ref(), [scene, reference])?)
            }
            None => None,
        };
        let mut stats = Work::default();
        let all = self.cubes.iter().chain(self.scene.iter().flatten()).map(|cube| cube.shape().len() as u64);
        stats.compute(Thing::Samples, all.sum());
        let range = |eta: &Vignette| {
            let fold = |with: fn(f64, f64) -> f64, from: f64| eta.values.iter().copied().fold(from, with);
            [fold(f64::min, f64::INFINITY), fold(f64::max, 0.0)]
        };
        Ok(ResponseFound {
            scenario: scenario.clone(),
            filters: self.names.clone(),
            left_out: self.left_out.clone(),
            response: (0..values).map(row).collect(),
            covariance: covariance.transpose().iter().copied().collect(),
            // What a value sees of a curve that is level over the width of each value.
            kernels: (0..values)
                .flat_map(|j| {
                    let row: Vec<f64> = seen.kernels.row(finer.place(j)).iter().copied().collect();
                    finer.means(&row).into_iter().map(|mean| mean * finer.parts() as f64)
                })
                .collect(),
            determined: known.number,
            rank: known.rank,
            effective: seen.effective,
            sigma_directions: known
                .singular
                .iter()
                .enumerate()
                .map(|(i, d)| (i < known.rank).then(|| 1.0 / d))
                .collect(),
            offsets: found.offsets.clone(),
            offset_sigmas: found.offset_sigmas.clone(),
            chi_square_reduced,
            freedom: found.freedom,
            misfit: misfit.is_some(),
            size,
            eta_range: eta.as_ref().map(range),
            eta_sigma: eta.as_ref().map(|eta| eta.sigma),
            eta,
            scene,
            stats,
            warnings,
        })
    }

    /// Every filter's reading of every blackbody, the mean about the centre in counts.
    fn readings(&self, cubes: &[Vec<f64>], middle: &[usize]) -> (Vec<Reading>, Vec<f64>) {
        let filters = self.names.len();
        let sigma = self.scenario.noise / (middle.len() as f64).sqrt();
        let (mut readings, mut counts) = (Vec::new(), Vec::new());
        for (blackbody, (cube, spec)) in cubes.iter().zip(&self.scenario.blackbodies).enumerate() {
            for filter in 0..filters {
                let sum: f64 = middle.iter().map(|pixel| cube[pixel * filters + filter]).sum();
                counts.push(sum / middle.len() as f64);
                readings.push(Reading { blackbody, sent: spec.sent(), filter, sigma });
            }
        }
        (readings, counts)
    }

    /// Readings off the response beyond chance, with the blackbody that explains most of it.
    fn does_not_fit(&self, found: &Response, chi_square: f64) -> Warning {
        let worst = found.worst.filter(|worst| worst.explains > EXPLAINS * found.chi_square);
        let worst = worst.map(|worst| WorstBlackbody {
            blackbody: worst.blackbody,
            temperature_k: self.scenario.blackbodies[worst.blackbody].temperature_k,
            off_k: worst.shift_k,
        });
        Warning::ResponseDoesNotFit { chi_square, worst }
    }

    /// g by which the typical curve is the nearest to the readings, an offset for each filter.
    fn scale(&self, readings: &[Reading], counts: &[f64]) -> Result<f64> {
        let (wheel, filters) = (self.wheel(1.0)?, self.names.len());
        let centres = wheel.centres_cm1();
        let mut radiance = vec![0.0; centres.len()];
        let models: Vec<f64> = readings
            .iter()
            .map(|reading| {
                reading.sent.radiance_into(centres, &mut radiance);
                wheel.counts(reading.filter, &self.typical, &radiance)
            })
            .collect();
        let (mut along, mut square) = (0.0, 0.0);
        for q in 0..filters {
            let of = |values: &[f64]| -> Vec<f64> {
                let own: Vec<f64> = values.iter().skip(q).step_by(filters).copied().collect();
                let mean = own.iter().sum::<f64>() / own.len() as f64;
                own.iter().map(|value| value - mean).collect()
            };
            for (model, count) in of(&models).iter().zip(of(counts)) {
                along += model * count;
                square += model * model;
            }
        }
        let scale = along / square;
        if scale.is_finite() && scale > 0.0 {
            return Ok(scale);
        }
        Err(Error::malformed(
            "warmer blackbodies do not read more behind these filters",
            "check the order of the temperatures and of the filters",
        ))
    }

    fn radiances(
        &self,
        wheel: &FilterWheel,
        found: &Response,
        eta: Option<&Vignette>,
        [scene, reference]: [&Cube; 2],
    ) -> Result<FilterRadiances> {
        let (source, filters) = (&self.scenario.source, self.names.len());
        let reference_k = self.scenario.scene.as_ref().map_or(f64::NAN, |spec| spec.reference_k);
        let shape = scene.shape();
        let scene = samples(scene).map_err(at(source, "scene.data"))?;
        let reference = samples(reference).map_err(at(source, "scene.reference"))?;
        let pixels = shape.rows() * shape.columns();
        let ones = vec![1.0; pixels];
        let (values, sigma_eta, sigma_centre) = match eta {
            Some(eta) => (&eta.values, eta.sigma, eta.sigma_centre),
            None => (&ones, 0.0, 0.0),
        };
        let counts = subtracted(&scene, &reference, values, filters).map_err(at(source, "scene"))?;
        let lines: Vec<FilterRadiance> =
            (0..filters).map(|q| found.radiance(wheel, q, 0.0, reference_k)).collect();
        let mut ends = vec![[f64::INFINITY, f64::NEG_INFINITY]; filters];
        for pixel in counts.chunks(filters) {
            for (end, count) in ends.iter_mut().zip(pixel) {
                *end = [end[0].min(*count), end[1].max(*count)];
            }
        }
        // Errors that grow with what is above the reference are largest at an end of the scene: each filter has the largest.
        let most: Vec<f64> = ends.iter().map(|[low, high]| low.abs().max(high.abs())).collect();
        let radiance = counts
            .iter()
            .enumerate()
            .map(|(i, count)| (lines[i % filters].radiance + lines[i % filters].per_count * count) as f32);
        let noise = std::f64::consts::SQRT_2 * self.scenario.noise;
        let centres = wheel.centres_cm1();
        let mut slope = vec![0.0; centres.len()];
        let mut base = slope.clone();
        planck::photon_radiance_and_slope_into(centres, reference_k, &mut base, &mut slope);
        let error_k = self.scenario.scene.as_ref().map_or(0.0, |spec| spec.reference_error_k);
        let common = |q: usize| {
            let at = |count: f64| found.radiance(wheel, q, count, reference_k).sigma_common;
            let by_response = at(ends[q][0]).max(at(ends[q][1]));
            let by_centre = lines[q].per_count * most[q] * sigma_centre;
            let by_reference = lines[q].per_count * wheel.counts(q, &found.values, &slope) * error_k;
            by_response.hypot(by_centre).hypot(by_reference)
        };
        let own = |q: usize| lines[q].per_count * noise.hypot(most[q] * sigma_eta);
        Ok(FilterRadiances {
            shape,
            radiance: radiance.collect(),
            sigma_noise: (0..filters).map(own).collect(),
            sigma_common: (0..filters).map(common).collect(),
        })
    }
}

/// χ² per degree of freedom that readings which fit may have.
fn most_by_chance(freedom: f64) -> f64 {
    MISFIT.max(1.0 + 5.0 * (2.0 / freedom).sqrt())
}

fn check_filters(cube: &Cube, filters: usize) -> Result<()> {
    if cube.shape().bands() == filters {
        return Ok(());
    }
    let found = format!("the cube is {}, but there are {filters} filters", shown(cube.shape()));
    Err(Error::malformed(found, "give a band for each filter, in the order of their columns"))
}

fn same_size(cube: &Cube, other: &Cube, name: &str) -> Result<()> {
    if cube.shape() == other.shape() {
        return Ok(());
    }
    let found =
        format!("the cube is {}, but that of {name} is {}", shown(cube.shape()), shown(other.shape()));
    Err(Error::malformed(found, "give cubes of one size, as the camera makes them"))
}

/// Names and mean transmittances over each width `step` about some centres.
fn filters(path: &Path, centres_cm1: &[f64], step: f64) -> Result<(Vec<String>, Vec<Vec<f64>>)> {
    let (mut names, mut all) = (Vec::new(), Vec::new());
    for (name, rows) in columns(path)? {
        if name.ends_with(REFLECTANCE) {
            continue;
        }
        let curve = FilterCurve::new(name.clone(), rows).map_err(|error| error.in_file(path))?;
        let mean = |nu: &f64| {
            let at = |i: usize| curve.transmittance(nu + step * ((i as f64 + 0.5) / POINTS as f64 - 0.5));
            (0..POINTS).map(at).sum::<f64>() / POINTS as f64
        };
        all.push(centres_cm1.iter().map(mean).collect());
        names.push(name);
    }
    Ok((names, all))
}

/// The first column beside the wavenumbers, brought to a peak of 1; 0 outside of its rows.
fn typical(path: &Path, centres_cm1: &[f64]) -> Result<Vec<f64>> {
    let table = columns(path)?;
    let Some((_, rows)) = table.first() else {
        let error = Error::malformed("the table has one column", "write wavenumber_cm1,response");
        return Err(error.in_file(path));
    };
    let mut rows = rows.clone();
    order::ascending(&mut rows, |a| a.0);
    let (xs, ys): (Vec<f64>, Vec<f64>) = rows.into_iter().unzip();
    let (Some(low), Some(high)) = (xs.first(), xs.last()) else {
        return Err(Error::malformed("the table has no rows", "write one for every wavenumber").in_file(path));
    };
    let at = |nu: &f64| if (*low..=*high).contains(nu) { interpolated(&xs, &ys, *nu) } else { 0.0 };
    let curve: Vec<f64> = centres_cm1.iter().map(at).collect();
    let peak = curve.iter().copied().fold(0.0, f64::max);
    if !(peak > 0.0 && curve.iter().all(|r| *r >= 0.0)) {
        let error =
            Error::malformed("the typical curve is nowhere above 0, or below it", "write responses from 0");
        return Err(error.in_file(path));
    }
    Ok(curve.iter().map(|r| r / peak).collect())
}
