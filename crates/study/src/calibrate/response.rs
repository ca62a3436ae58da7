//! The response of a camera behind a filter wheel by blackbodies, the wheel's relative transmittance, and radiances behind the filters.
//!
//! A reading of filter q is C = g ∫ r(ν) T_q(ν) L(ν) dν + K_q ([`hadar::calibration::filter_wheel`]); r is fitted at parts of its values
//! ([`hadar::calibration::finer`]) under a prior of smoothness, with the errors of the blackbodies. It is said to misfit beyond
//! χ²/ν = max(1.3, 1 + 5 √(2/ν)).
//!
//! Units: counts for C, K; photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹ for L; cm⁻¹ for ν.

mod looked_up;
mod results;
mod scene;

pub use results::{FilterRadiances, LeftOutFilter, ResponseFound, ResponseRow};

use super::stated::{taken_as_black, uncertainty_not_stated};
use super::whole::{at, samples};
use crate::{Warning, WorstBlackbody};
use hadar::calibration::determined::{CurvePrior, Determined};
use hadar::calibration::filter_wheel::{FilterWheel, Reading};
use hadar::calibration::finer::Finer;
use hadar::calibration::sent::{Deviations, Unknown};
use hadar::cube::Cube;
use hadar::demand::{Thing, Work};
use hadar::error::{Error, Result};
use hadar_estimate::calibrate::response::Response;
use hadar_estimate::calibrate::vignette::{Vignette, centre};
use hadar_scenario::calibrate::ResponseScenario;
use hadar_scenario::calibrate::blackbodies::BlackbodySpec;

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

/// What was fitted to the readings.
struct Fitted {
    /// At the parts.
    found: Response,
    at_values: Response,
    /// The same with the errors for curves that have kinks.
    kinked: Response,
    /// What the readings determine, with the parts and with the values alone.
    seen: Determined,
    known: Determined,
    /// At the values.
    typical: Vec<f64>,
}

impl Fitted {
    /// Of the values, row after row.
    fn covariance(&self, scale: f64) -> Vec<f64> {
        let covariance = &self.at_values.factor * self.at_values.factor.transpose() * (scale * scale);
        covariance.transpose().iter().copied().collect()
    }
}

impl ResponseStudy {
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
        let fitted = self.fitted((&wheel, scale), &readings, &counts)?;
        let (found, known) = (&fitted.found, &fitted.known);
        // Of readings that are all fitted nothing is left to be tested.
        let chi_square_reduced = (found.freedom > TESTED).then(|| found.chi_square_readings / found.freedom);
        let mut warnings: Vec<Warning> = self.warnings_of_left_out().collect();
        let misfit = chi_square_reduced.filter(|chi| *chi > most_by_chance(found.freedom.max(TESTED)));
        warnings.extend(misfit.map(|chi_square| self.does_not_fit(found, chi_square)));
        let response = self.rows(&fitted, scale);
        warnings.extend(self.smoothness_not_stated(&response));
        warnings.extend(uncertainty_not_stated(specs));
        warnings.extend(taken_as_black(specs, self.centres_cm1[self.centres_cm1.len() / 2]));
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
                Some(self.radiances(&wheel, [found, &fitted.kinked], eta.as_ref(), [scene, reference])?)
            }
            None => None,
        };
        let range = |eta: &Vignette| {
            let fold = |with: fn(f64, f64) -> f64, from: f64| eta.values.iter().copied().fold(from, with);
            [fold(f64::min, f64::INFINITY), fold(f64::max, 0.0)]
        };
        Ok(ResponseFound {
            scenario: scenario.clone(),
            filters: self.names.clone(),
            left_out: self.left_out.clone(),
            response,
            covariance: fitted.covariance(scale),
            kernels: self.kernels(&fitted.seen),
            determined: known.number,
            rank: known.rank,
            effective: fitted.seen.effective,
            sigma_directions: (known.singular.iter().enumerate())
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
            stats: self.work(),
            warnings,
        })
    }

    /// The response at the parts and at the values, and what the readings determine of it.
    fn fitted(
        &self,
        (wheel, scale): (&FilterWheel, f64),
        readings: &[Reading],
        counts: &[f64],
    ) -> Result<Fitted> {
        let (scenario, source) = (&self.scenario, &self.scenario.source);
        let smoothness = scenario.response.known();
        let prior = |centres: &[f64], typical: &[f64]| {
            CurvePrior::smooth(centres, typical, smoothness).map_err(at(source, "response"))
        };
        let finer = &self.finer;
        let typical = finer.at_values(&self.typical);
        let (prior, prior_of_values) =
            (prior(finer.centres_cm1(), &self.typical)?, prior(&self.centres_cm1, &typical)?);
        let deviations: Vec<Deviations> =
            scenario.blackbodies.iter().map(BlackbodySpec::deviations).collect();
        let errors = Unknown::all(&deviations).map_err(at(source, "blackbody"))?;
        let errors = if errors.iter().any(|one| one.deviation > 0.0) { &errors[..] } else { &[] };
        let found =
            Response::found(wheel, &prior, readings, counts, errors).map_err(at(source, "blackbody"))?;
        let at_values = found.at_values(finer);
        let kinked = found.of_curves(&CurvePrior::kinked(finer.centres_cm1(), &self.typical, smoothness)?)?;
        let about = (!errors.is_empty()).then_some((errors, &found.values[..]));
        let seen = Determined::of(&wheel.scores(readings, about)?, &prior)?;
        let about = (!errors.is_empty()).then_some((errors, &at_values.values[..]));
        let of_values = self.wheel_of_values(scale)?;
        let known = Determined::of(&of_values.scores(readings, about)?, &prior_of_values)?;
        Ok(Fitted { found, at_values, kinked, seen, known, typical })
    }

    fn rows(&self, fitted: &Fitted, scale: f64) -> Vec<ResponseRow> {
        let Fitted { at_values, kinked, known, typical, .. } = fitted;
        let row = |j: usize| ResponseRow {
            wavenumber_cm1: self.centres_cm1[j],
            response: scale * at_values.values[j],
            sigma: scale * at_values.sigma(j),
            sigma_kinked: scale * kinked.sigma(self.finer.place(j)),
            sigma_beforehand: scale * known.sigma_prior[j],
            typical: scale * typical[j],
            sigma_readings_alone: Some(scale * known.sigma_free[j]).filter(|sigma| sigma.is_finite()),
        };
        (0..self.centres_cm1.len()).map(row).collect()
    }

    /// What a value sees of a curve that is level over the width of each value.
    fn kernels(&self, seen: &Determined) -> Vec<f64> {
        let finer = &self.finer;
        let of_value = |j: usize| {
            let row: Vec<f64> = seen.kernels.row(finer.place(j)).iter().copied().collect();
            finer.means(&row).into_iter().map(|mean| mean * finer.parts() as f64)
        };
        (0..self.centres_cm1.len()).flat_map(of_value).collect()
    }

    fn work(&self) -> Work {
        let mut stats = Work::default();
        let all = self.cubes.iter().chain(self.scene.iter().flatten()).map(|cube| cube.shape().len() as u64);
        stats.compute(Thing::Samples, all.sum());
        stats
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

    /// Errors that rest on a smoothness that nobody stated, and what they are if the response has kinks, of its peak.
    fn smoothness_not_stated(&self, rows: &[ResponseRow]) -> Option<Warning> {
        let spec = &self.scenario.response;
        let silent = [("shape_error", spec.shape_error), ("correlation", spec.correlation_cm1)];
        let keys: Vec<&'static str> =
            silent.into_iter().filter_map(|(key, stated)| stated.is_none().then_some(key)).collect();
        let peak = rows.iter().map(|row| row.response).fold(0.0, f64::max);
        let rms = |of: fn(&ResponseRow) -> f64| {
            let square: f64 = rows.iter().map(|row| (of(row) / peak).powi(2)).sum();
            (square / rows.len() as f64).sqrt()
        };
        (!keys.is_empty()).then(|| Warning::SmoothnessNotStated {
            keys,
            smooth: rms(|row| row.sigma),
            kinked: rms(|row| row.sigma_kinked),
        })
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
}

/// χ² per degree of freedom that readings which fit may have.
fn most_by_chance(freedom: f64) -> f64 {
    MISFIT.max(1.0 + 5.0 * (2.0 / freedom).sqrt())
}
