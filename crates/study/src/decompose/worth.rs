//! What the maps are worth where it is known what is there.
//!
//! * Share of right materials, beside the mean of Φ(d) over some pixels, d the nearest distance from what is there to the nearest of
//!   the other materials in any state (nothing told between these two states is right more often than that).
//! * Root mean square of temperature error over the Cramér–Rao bound at the fit, and the share of errors within 1.96 of it: of pixels
//!   whose material is right and whose state no limit holds. Of a method that takes the scene for another these are the deviations
//!   that it says; one without deviations has neither.

use super::DecomposeStudy;
use super::truth::{There, Truth};
use hadar::error::Result;
use hadar::fisher::{Counting, Nuisance, Unknowns};
use hadar::identifiability::detection;
use hadar::identifiability::nearest::{NearestSolver, StateRange};
use hadar::parallel;
use hadar::scene::{State, Surroundings};
use hadar_estimate::decompose::{Light, Maps, Method, flag};
use hadar_scenario::decompose::SharedUnknown;

/// Pixels whose limit is computed.
const LIMITS: usize = 240;
/// Variance of a reading beside which no difference of two states is seen, counts².
const TELLS_NOTHING: f64 = 1e40;
/// Deviations that hold 95 %.
const NINETY_FIVE: f64 = 1.959_963_984_540_054;

/// How good the maps are.
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize)]
pub struct TruthFound {
    /// Share of pixels whose material is right.
    pub right_material: Option<f64>,
    /// Mean of Φ(d), what no test exceeds between a pixel and the closest confuser of the others; `None` without all of the truth.
    pub right_material_limit: Option<f64>,
    /// Standard error of that mean.
    pub right_material_limit_error: Option<f64>,
    /// Number of pixels over which that mean is taken.
    pub right_material_limit_pixels: usize,
    /// Root mean square of the error of the temperature over its bound.
    pub temperature_error_over_bound_rms: Option<f64>,
    /// Share of temperatures within 1.96 deviations.
    pub coverage_95: Option<f64>,
    /// Number of pixels over which these two are taken.
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

/// A mean square, value by value.
#[derive(Debug, Default)]
struct MeanSquare {
    sum: f64,
    count: usize,
}

impl MeanSquare {
    fn add(&mut self, x: f64) {
        (self.sum, self.count) = (x.mul_add(x, self.sum), self.count + 1);
    }

    fn root(&self) -> Option<f64> {
        (self.count > 0).then(|| (self.sum / self.count as f64).sqrt())
    }
}

/// What is counted of pixels whose truth is known, row after row.
#[derive(Debug, Default)]
pub(super) struct Held {
    known: usize,
    right: usize,
    decided: usize,
    right_where_decided: usize,
    confusion: Vec<Vec<usize>>,
    /// Material and state of the pixels whose limit is computed.
    chosen: Vec<(usize, f64, Vec<f64>)>,
    off_k: MeanSquare,
    over: MeanSquare,
    covered: usize,
    any: usize,
    any_covered: usize,
}

impl Held {
    pub(super) fn new(study: &DecomposeStudy, method: Method) -> Self {
        let is_compared = method.names_materials() && study.truth.as_ref().is_some_and(Truth::has_materials);
        let materials = if is_compared { study.names.len() } else { 0 };
        Self { confusion: vec![vec![0; materials + 1]; materials], ..Self::default() }
    }

    /// Holds the maps of some rows against what is there.
    pub(super) fn take(&mut self, study: &DecomposeStudy, method: Method, maps: &Maps, there: &There) {
        if let Some(material) = there.material.as_ref().filter(|_| method.names_materials()) {
            self.materials(study, maps, there, material);
        }
        if let Some(temperature_k) = &there.temperature_k {
            self.temperatures(method, maps, there, temperature_k);
        }
    }

    fn materials(&mut self, study: &DecomposeStudy, maps: &Maps, there: &There, material: &[usize]) {
        let truth = study.truth.as_ref();
        let count = study.told.surroundings.len();
        let every =
            truth.filter(|truth| truth.has_states()).map(|truth| truth.known.div_ceil(sampled(count)).max(1));
        for (i, (there_is, own)) in material.iter().zip(&maps.material).enumerate() {
            let own = usize::from(*own);
            let Some(row) = self.confusion.get_mut(*there_is) else { continue };
            let column = own.min(row.len().saturating_sub(1));
            row.get_mut(column).into_iter().for_each(|count| *count += 1);
            let (is_right, is_decided) = (own == *there_is, maps.is_decided(i));
            if let (Some(every), Some(temperature_k), Some(lighting)) =
                (every, &there.temperature_k, &there.lighting)
                && self.known.is_multiple_of(every)
                && let (Some(temperature_k), Some(lighting)) =
                    (temperature_k.get(i), lighting.get(i * count..(i + 1) * count))
            {
                self.chosen.push((*there_is, *temperature_k, lighting.to_vec()));
            }
            self.known += 1;
            self.right += usize::from(is_right);
            self.decided += usize::from(is_decided);
            self.right_where_decided += usize::from(is_right && is_decided);
        }
    }

    fn temperatures(&mut self, method: Method, maps: &Maps, there: &There, temperature_k: &[f64]) {
        let each = maps.temperature_k.iter().zip(temperature_k);
        let each = each.map(|(own, there)| f64::from(*own) - there);
        let states = maps.temperature_sigma_k.iter().zip(maps.material.iter().zip(&maps.flags));
        let closed =
            flag::LIGHTING_AT_LIMIT | flag::TEMPERATURE_AT_LIMIT | flag::TEMPERATURE_UNKNOWN | flag::SKIPPED;
        for (i, (off, (sigma_k, (material, flags)))) in each.zip(states).enumerate() {
            if off.is_finite() {
                self.off_k.add(off);
            }
            let over = off / f64::from(*sigma_k);
            if !method.has_likelihood() || over.is_nan() {
                continue;
            }
            let is_covered = over.abs() <= NINETY_FIVE;
            self.any += 1;
            self.any_covered += usize::from(is_covered);
            let is_right =
                there.material.as_ref().is_none_or(|there| there.get(i) == Some(&usize::from(*material)));
            if is_right && flags & closed == 0 {
                self.over.add(over);
                self.covered += usize::from(is_covered);
            }
        }
    }

    /// How good the maps are.
    pub(super) fn found(self, study: &DecomposeStudy) -> Result<TruthFound> {
        let share = |count: usize, of: usize| (of > 0).then(|| count as f64 / of as f64);
        let limits = limits(study, &self.chosen)?;
        let mut found = TruthFound {
            right_material: share(self.right, self.known),
            right_material_limit_pixels: limits.len(),
            right_where_decided: share(self.right_where_decided, self.decided),
            temperature_error_over_bound_rms: self.over.root(),
            coverage_95: share(self.covered, self.over.count),
            coverage_pixels: self.over.count,
            coverage_95_all: share(self.any_covered, self.any),
            temperature_rmse_k: self.off_k.root(),
            confusion: self.confusion,
            ..TruthFound::default()
        };
        if !limits.is_empty() {
            let count = limits.len() as f64;
            let mean = limits.iter().sum::<f64>() / count;
            let square = limits.iter().map(|p| (p - mean).powi(2)).sum::<f64>();
            found.right_material_limit = Some(mean);
            found.right_material_limit_error =
                (count > 1.0).then(|| (square / (count * (count - 1.0))).sqrt());
        }
        Ok(found)
    }
}

/// Pixels whose nearest distances are computed: with each light beyond three, half as many, as each takes twice as long.
fn sampled(lights: usize) -> usize {
    LIMITS >> lights.saturating_sub(3).min(4)
}

/// Φ(d) to the nearest of the other materials for some pixels.
fn limits(study: &DecomposeStudy, chosen: &[(usize, f64, Vec<f64>)]) -> Result<Vec<f64>> {
    let scale = study.told.counts_per_radiance[0];
    let uniform = study.told.counts_per_radiance.iter().all(|k| (k / scale - 1.0).abs() < 1e-9);
    if study.told.path.is_some()
        || study.scenario.unknown.shared != SharedUnknown::default()
        || !uniform
        || study.told.library.len() < 2
        || chosen.is_empty()
    {
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
    // A band that is left out tells nothing.
    let mut var_added = study.told.var_added.clone();
    for band in &study.told.bad_bands {
        if let Some(var) = var_added.get_mut(*band) {
            *var = TELLS_NOTHING;
        }
    }
    let counting = Counting { counts_per_radiance: scale, var_added };
    let limit = |solver: &mut NearestSolver<'_>, (own, temperature_k, lighting): &(usize, f64, Vec<f64>)| {
        let state = State {
            temperature_k: *temperature_k,
            lighting: lighting.clone(),
            gain: 1.0,
            environment_k: surroundings.objects().iter().map(|object| object.temperature_k).collect(),
        };
        let emissivity = &study.told.library[*own];
        let mut nearest = f64::INFINITY;
        for (_, other) in study.told.library.iter().enumerate().filter(|(place, _)| place != own) {
            // Between two equal ones any test guesses.
            let distance = if other == emissivity {
                0.0
            } else {
                solver.with_counting(emissivity, other, &state, &counting)?.distance
            };
            nearest = nearest.min(distance);
        }
        Ok(detection::probability(nearest))
    };
    let solver = || NearestSolver::new(&study.told.bands, &surroundings, unknowns.clone(), range);
    parallel::try_map_with(chosen.len(), solver, |solver, i| limit(solver, &chosen[i]))
}

/// The spectra of the surroundings.
fn surroundings(study: &DecomposeStudy) -> Result<Surroundings> {
    let nodes = study.told.bands.nodes_cm1();
    let widths = study.told.bands.widths_cm1();
    let radiance = |light: &Light| match light {
        Light::Radiance(radiance) => radiance.clone(),
        // One value for all nodes of a band.
        Light::Counts(counts) => {
            let per_band: Vec<f64> = counts
                .iter()
                .zip(study.told.counts_per_radiance.iter().zip(&widths))
                .map(|(n, (k, width))| n / (k * width))
                .collect();
            study.told.bands.spread(&per_band)
        }
    };
    Surroundings::of_radiances(nodes, &study.told.surroundings.iter().map(radiance).collect::<Vec<_>>())
}
