//! What the maps are worth where it is known what is there.
//!
//! * Share of right materials, beside the mean of Φ(d) over some pixels, d the nearest distance from what is there to the nearest of
//!   the other materials in any state (nothing told between these two states is right more often than that).
//! * Root mean square of temperature error over the Cramér–Rao bound at the fit, and the share of errors within 1.96 of it: of pixels
//!   whose material is right and whose state no limit holds. Of a method that takes the scene for another these are the deviations
//!   that it says; one without deviations has neither.

use super::DecomposeStudy;
use super::truth::Truth;
use hadar::decompose::{Light, Maps, Method, flag};
use hadar::error::Result;
use hadar::fisher::{Counting, Nuisance, Unknowns};
use hadar::identifiability::detection;
use hadar::identifiability::nearest::{NearestSolver, StateRange};
use hadar::scene::{State, Surroundings};
use rayon::prelude::*;

/// Pixels whose limit is computed.
const LIMITS: usize = 240;
/// Deviations that hold 95 %.
const NINETY_FIVE: f64 = 1.959_963_984_540_054;

/// How good the maps are.
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize)]
pub struct TruthFound {
    /// Share of pixels whose material is right.
    pub right_material: Option<f64>,
    /// Mean of Φ(d), what no test exceeds between a pixel and the nearest state of the others; `None` without all of the truth.
    pub right_material_limit: Option<f64>,
    /// Standard error of that mean.
    pub right_material_limit_error: Option<f64>,
    /// Pixels of that mean.
    pub right_material_limit_pixels: usize,
    /// Root mean square of the error of the temperature over its bound.
    pub temperature_error_over_bound_rms: Option<f64>,
    /// Share of temperatures within 1.96 deviations.
    pub coverage_95: Option<f64>,
    /// Pixels of these two.
    pub coverage_pixels: usize,
    /// The same share of all pixels with an interval, whatever their material and limits.
    pub coverage_95_all: Option<f64>,
    /// Root mean square error of the temperature of all pixels that have one, K.
    pub temperature_rmse_k: Option<f64>,
    /// Share of right materials among the pixels that have one candidate.
    pub right_where_decided: Option<f64>,
    /// Pixels of each material that is there (row) by what was found (column, the last one for none).
    pub confusion: Vec<Vec<usize>>,
}

impl Truth {
    /// Holds the maps against what is there.
    pub(super) fn found(&self, study: &DecomposeStudy, method: Method, maps: &Maps) -> Result<TruthFound> {
        let mut found = TruthFound::default();
        let pixels = maps.material.len();
        let share = |count: usize, of: usize| (of > 0).then(|| count as f64 / of as f64);
        if let Some(material) = self.material.as_ref().filter(|_| method.names_materials()) {
            let known = |i: &usize| material[*i] < study.names.len();
            let right = |i: &usize| usize::from(maps.material[*i]) == material[*i];
            let all: Vec<usize> = (0..pixels).filter(known).collect();
            found.right_material = share(all.iter().filter(|i| right(i)).count(), all.len());
            let decided: Vec<usize> = all.iter().copied().filter(|i| maps.is_decided(*i)).collect();
            found.right_where_decided = share(decided.iter().filter(|i| right(i)).count(), decided.len());
            found.confusion = vec![vec![0; study.names.len() + 1]; study.names.len()];
            for i in &all {
                let column = usize::from(maps.material[*i]).min(study.names.len());
                found.confusion[material[*i]][column] += 1;
            }
            if let (Some(temperature_k), Some(lighting)) = (&self.temperature_k, &self.lighting) {
                let chosen: Vec<usize> = all
                    .iter()
                    .copied()
                    .step_by(all.len().div_ceil(sampled(study.lights.len())).max(1))
                    .collect();
                let limits = limits(study, material, temperature_k, lighting, &chosen)?;
                found.right_material_limit_pixels = limits.len();
                if !limits.is_empty() {
                    let count = limits.len() as f64;
                    let mean = limits.iter().sum::<f64>() / count;
                    let square = limits.iter().map(|p| (p - mean).powi(2)).sum::<f64>();
                    found.right_material_limit = Some(mean);
                    found.right_material_limit_error =
                        (count > 1.0).then(|| (square / (count * (count - 1.0))).sqrt());
                }
            }
        }
        if let Some(truth) = &self.temperature_k {
            let error = |i: usize| f64::from(maps.temperature_k[i]) - truth[i];
            found.temperature_rmse_k = rms((0..pixels).map(error).filter(|error| error.is_finite()));
            if !method.has_likelihood() {
                return Ok(found);
            }
            let is_open = |i: &usize| {
                let held = flag::LIGHTING_AT_LIMIT | flag::TEMPERATURE_AT_LIMIT | flag::TEMPERATURE_UNKNOWN;
                let right = self.material.as_ref().is_none_or(|m| m[*i] == usize::from(maps.material[*i]));
                right && maps.flags[*i] & (held | flag::SKIPPED) == 0
            };
            let over: Vec<f64> = (0..pixels)
                .filter(is_open)
                .map(|i| error(i) / f64::from(maps.temperature_sigma_k[i]))
                .filter(|over| !over.is_nan())
                .collect();
            found.coverage_pixels = over.len();
            found.coverage_95 = share(over.iter().filter(|x| x.abs() <= NINETY_FIVE).count(), over.len());
            found.temperature_error_over_bound_rms = rms(over.iter().copied());
            let any = (0..pixels).map(|i| error(i) / f64::from(maps.temperature_sigma_k[i]));
            let any: Vec<f64> = any.filter(|ratio| !ratio.is_nan()).collect();
            found.coverage_95_all = share(any.iter().filter(|x| x.abs() <= NINETY_FIVE).count(), any.len());
        }
        Ok(found)
    }
}

/// Pixels whose nearest distances are computed: with each light beyond three, half as many, as each takes twice as long.
fn sampled(lights: usize) -> usize {
    LIMITS >> lights.saturating_sub(3).min(4)
}

fn rms(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (square, count) = values.fold((0.0, 0), |(sum, count), x| (x.mul_add(x, sum), count + 1));
    (count > 0).then(|| (square / f64::from(count)).sqrt())
}

/// Φ(d) to the nearest of the other materials for some pixels.
fn limits(
    study: &DecomposeStudy,
    material: &[usize],
    temperature_k: &[f64],
    lighting: &[f64],
    chosen: &[usize],
) -> Result<Vec<f64>> {
    let scale = study.counts_per_radiance[0];
    let uniform = study.counts_per_radiance.iter().all(|k| (k / scale - 1.0).abs() < 1e-9);
    if !uniform || study.library.len() < 2 {
        return Ok(Vec::new());
    }
    let surroundings = surroundings(study)?;
    let mut nuisances = vec![Nuisance::Temperature, Nuisance::Lighting];
    nuisances.extend(study.scenario.unknown.gain.then_some(Nuisance::Gain));
    let total = study.scenario.unknown.lighting_total;
    let unknowns = Unknowns::new(nuisances)?.lighting_total(total)?;
    let range = StateRange {
        temperature_k: study.scenario.unknown.temperature_k,
        lighting_sum: total.unwrap_or(1.0),
        ..StateRange::default()
    };
    let counting = Counting { counts_per_radiance: scale, var_added: study.var_added.clone() };
    let count = study.lights.len();
    let limit = |solver: &mut NearestSolver<'_>, i: &usize| {
        let state = State {
            temperature_k: temperature_k[*i],
            lighting: lighting[i * count..][..count].to_vec(),
            gain: 1.0,
            environment_k: surroundings.objects().iter().map(|object| object.temperature_k).collect(),
        };
        let own = &study.library[material[*i]];
        let mut nearest = f64::INFINITY;
        for (_, other) in study.library.iter().enumerate().filter(|(place, _)| *place != material[*i]) {
            // Between two equal ones any test guesses.
            let distance = if other == own {
                0.0
            } else {
                solver.with_counting(own, other, &state, &counting)?.distance
            };
            nearest = nearest.min(distance);
        }
        Ok(detection::probability(nearest))
    };
    let solver = || NearestSolver::new(&study.bands, &surroundings, unknowns.clone(), range);
    chosen.par_iter().map_init(solver, limit).collect()
}

/// The spectra of the surroundings.
fn surroundings(study: &DecomposeStudy) -> Result<Surroundings> {
    let nodes = study.bands.nodes_cm1();
    let widths = study.bands.widths_cm1();
    let radiance = |light: &Light| match light {
        Light::Radiance(radiance) => radiance.clone(),
        // One value for all nodes of a band.
        Light::Counts(counts) => {
            let per_band: Vec<f64> = counts
                .iter()
                .zip(study.counts_per_radiance.iter().zip(&widths))
                .map(|(n, (k, width))| n / (k * width))
                .collect();
            study.bands.spread(&per_band)
        }
    };
    Surroundings::of_radiances(nodes, &study.lights.iter().map(radiance).collect::<Vec<_>>())
}
