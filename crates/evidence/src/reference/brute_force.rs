//! The nearest state of an alternative by brute force: a lattice of temperatures, and the least of what is convex at each.
//!
//! min over θ′ of f = Σ (√(N+v) − √(N′(θ′)+v))², d = √f (`model`). For fixed temperatures f is jointly convex in gain and
//! gain × lighting, and what limits these is linear: its least is found there without search (`descent`). So a lattice is
//! needed of the unknown temperatures alone, dense in the logarithm and denser around the scene's (`lattice`):
//!
//! 1. for every point of the first unknown temperature the least over all else: on a lattice of the other temperatures, its
//!    low places followed down with these free;
//! 2. the low places of that profile followed down with everything free, in doubles;
//! 3. the best of them again in numbers of 31 digits ([`double_double`](super::double_double)).
//!
//! Whatever comes out is the distance of a state within the range: never below the true one by more than the rounding of
//! 31 digits, so that a proved lower bound above it is false, however good the search. It shares types with the crate (bands,
//! surroundings, states, unknowns, noise), no arithmetic. Priors are not known to it.
//!
//! Source: convexity, Boyd, Vandenberghe, Convex Optimization, 3.2 (2004): a sum of −√ of affine functions is convex.

mod descent;
mod lattice;
mod model;
mod search;

use self::descent::{Each, MOST};
use self::lattice::{axis, low_places};
use self::model::{Layout, Model, Spectrum};
pub use self::search::Found;
use self::search::{Candidate, Search, logarithms, temperature_k};
use super::double_double::{DoubleDouble, Real};
use super::local::{Noise, Pair};
use hadar::fisher::Unknowns;
use hadar::identifiability::nearest::StateRange;
use hadar::scene::{State, Surroundings};
use hadar::spectrum::Bands;

/// Low places of a lattice of inner temperatures that are followed.
const FOLLOWED: usize = 3;
/// Low places of the profile that are followed in doubles, and in 31 digits.
const CANDIDATES: usize = 40;
const POLISHED: usize = 12;

/// Share by which two costs are one, where they are above the rounding of doubles.
const SAME: f64 = 1e-9;
const NOISE: f64 = 1e-24;

/// Brute force in fixed bands, surroundings, unknowns and range.
#[derive(Debug, Clone)]
pub struct BruteForce<'a> {
    bands: &'a Bands,
    surroundings: &'a Surroundings,
    layout: Layout,
    fineness: f64,
}

impl<'a> BruteForce<'a> {
    /// For one set of bands, surroundings, unknowns and range of the alternative's state.
    #[must_use]
    pub fn new(
        bands: &'a Bands,
        surroundings: &'a Surroundings,
        unknowns: &Unknowns,
        range: StateRange,
    ) -> Self {
        let layout = Layout::new(unknowns, range, surroundings.objects().len());
        Self { bands, surroundings, layout, fineness: 1.0 }
    }

    /// The same with lattices so many times as dense.
    #[must_use]
    pub fn as_dense(self, times: f64) -> Self {
        Self { fineness: times, ..self }
    }

    /// How far the alternative in the state `other` is from the target in its own, with 31 digits.
    #[must_use]
    pub fn separation(&self, pair: Pair<'_>, other: &State, noise: Noise<'_>) -> DoubleDouble {
        let model = self.model::<DoubleDouble>(pair, noise);
        let spectra: Vec<Spectrum<DoubleDouble>> = (0..=self.layout.objects)
            .map(|s| model.spectrum(s, DoubleDouble::from(temperature_k(other, s)).logarithm(), false))
            .collect();
        let spectra: Vec<_> = spectra.iter().collect();
        let gain = DoubleDouble::from(other.gain);
        let mut factors = [gain; MOST];
        for (factor, lighting) in factors[1..].iter_mut().zip(&other.lighting) {
            *factor = gain * DoubleDouble::from(*lighting);
        }
        (model.cost(&factors, &spectra) * model.scale).root()
    }

    /// The nearest state; nothing where no lighting within the range has the known total.
    #[must_use]
    pub fn nearest(&self, pair: Pair<'_>, noise: Noise<'_>) -> Option<Found> {
        let plain = Search::<f64>::new(self.model(pair, noise));
        let start = self.start(pair.state)?;
        let profile = match self.layout.temperatures.split_first() {
            None => vec![vec![plain.at(&logarithms(pair.state), &start, &[])]],
            Some((&outer, inner)) => self.profile(&plain, pair.state, outer, inner, &start),
        };
        let values: Vec<f64> = profile.iter().map(|candidates| candidates[0].cost).collect();
        let free = &self.layout.temperatures;
        let mut candidates: Vec<Candidate> = low_places(&[values.len()], &values, CANDIDATES)
            .into_iter()
            .flat_map(|place| &profile[place])
            .map(|candidate| plain.follow(candidate, free))
            .collect();
        candidates.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        candidates.dedup_by(|a, b| (a.cost - b.cost).abs() <= SAME * b.cost && b.cost > NOISE);
        let fine = Search::<DoubleDouble>::new(self.model(pair, noise));
        let polished = candidates.iter().take(POLISHED).map(|candidate| {
            let [temperatures, rest] =
                [&candidate.temperatures, &candidate.rest].map(|all| all.map(DoubleDouble::from));
            fine.polish(&fine.within_limits(&temperatures), &fine.lit_within_limits(rest), free)
        });
        polished.min_by(|a, b| a.distance.to_f64().total_cmp(&b.distance.to_f64()))
    }

    /// The end of the way down from a state, once it is within the range to 31 digits.
    #[must_use]
    pub fn nearest_from(&self, pair: Pair<'_>, start: &State, noise: Noise<'_>) -> Found {
        let fine = Search::<DoubleDouble>::new(self.model(pair, noise));
        let free = &self.layout.temperatures;
        let temperatures = logarithms(start);
        let temperatures = fine.within_limits(&temperatures);
        let gain = DoubleDouble::from(start.gain);
        let mut rest = [gain; MOST];
        for (factor, lighting) in rest[usize::from(self.layout.gain)..].iter_mut().zip(&start.lighting) {
            *factor = gain * DoubleDouble::from(*lighting);
        }
        let rest = fine.lit_within_limits(rest);
        fine.polish(&temperatures, &rest, free)
    }

    fn model<'s, R: Real>(&'s self, pair: Pair<'s>, noise: Noise<'_>) -> Model<'s, R> {
        Model::new(self.bands, self.surroundings, &self.layout, pair, noise)
    }

    /// Gain and Cₖ within the range, the middle of it.
    fn start(&self, own: &State) -> Option<Each<f64>> {
        let Layout { gain, lighting, total, range, objects, .. } = &self.layout;
        let mut rest = [0.0; MOST];
        rest[0] = own.gain;
        if !lighting {
            return Some(rest);
        }
        let [low, high] = range.lighting;
        let each = *objects as f64;
        let sum = total.unwrap_or(range.lighting_sum);
        let share = match total {
            Some(total) => total / each,
            None => low + 0.5 * (high - low).min(sum / each - low),
        };
        for factor in rest.iter_mut().skip(usize::from(*gain)).take(*objects) {
            *factor = own.gain * share;
        }
        (share >= low && share <= high && share * each <= sum * (1.0 + 1e-15)).then_some(rest)
    }

    /// The low places at every point of the outer temperature, lowest first.
    fn profile(
        &self,
        plain: &Search<'_, f64>,
        own: &State,
        outer: usize,
        inner: &[usize],
        start: &Each<f64>,
    ) -> Vec<Vec<Candidate>> {
        let all: Vec<f64> = (0..=self.layout.objects).map(|s| temperature_k(own, s)).collect();
        let nodes = self.bands.nodes_cm1();
        let reach = nodes.iter().fold([f64::INFINITY, 0.0], |[a, b]: [f64; 2], &nu| [a.min(nu), b.max(nu)]);
        let [outer_coarse, inner_coarse] = match inner.len() {
            0 => [1.0, 1.0],
            1 => [2.0, 4.0],
            _ => [5.0, 12.0],
        };
        let seen = own.lighting.iter().zip(&own.environment_k).filter(|(factor, _)| **factor > 0.0);
        let hottest_k = seen.map(|(_, k)| *k).fold(own.temperature_k, f64::max);
        let points = |spectrum: usize, coarse: f64| {
            let scene = if coarse > 4.0 { vec![temperature_k(own, spectrum)] } else { all.clone() };
            let axis = axis(self.layout.limits_k(spectrum), &scene, hottest_k, reach, coarse / self.fineness);
            if inner.len() < 2 { axis } else { thinned(axis) }
        };
        let spectra_at = |spectrum: usize, temperatures: &[f64]| -> Vec<Spectrum<f64>> {
            temperatures.iter().map(|t| plain.model.spectrum(spectrum, t.ln(), false)).collect()
        };
        let axes: Vec<Vec<f64>> = inner.iter().map(|&spectrum| points(spectrum, inner_coarse)).collect();
        let tables: Vec<Vec<Spectrum<f64>>> =
            inner.iter().zip(&axes).map(|(&spectrum, axis)| spectra_at(spectrum, axis)).collect();
        let sides: Vec<usize> = axes.iter().map(Vec::len).collect();
        let known: Vec<Spectrum<f64>> =
            (0..=self.layout.objects).map(|s| plain.model.spectrum(s, all[s].ln(), false)).collect();
        let mut warm = *start;
        let mut last: Option<Candidate> = None;
        let outer_axis = points(outer, outer_coarse);
        let profile = outer_axis.into_iter().map(|temperature| {
            let here = plain.model.spectrum(outer, temperature.ln(), false);
            let mut spectra: Vec<&Spectrum<f64>> = known.iter().collect();
            spectra[outer] = &here;
            let places = sides.iter().product::<usize>();
            let mut lattice: Vec<(f64, Each<f64>)> = Vec::with_capacity(places);
            for place in 0..places {
                for (axis, (&spectrum, at)) in inner.iter().zip(digits(place, &sides)).enumerate() {
                    spectra[spectrum] = &tables[axis][at];
                }
                let (rest, cost) = plain.convex(&warm, &spectra);
                if cost.is_finite() {
                    warm = rest;
                }
                lattice.push((cost, rest));
            }
            let values: Vec<f64> = lattice.iter().map(|(cost, _)| *cost).collect();
            let mut temperatures = logarithms(own);
            temperatures[outer] = temperature.ln();
            let low = low_places(&sides, &values, if inner.is_empty() { 1 } else { FOLLOWED });
            let starts = low.into_iter().map(|place| {
                for (axis, (&spectrum, at)) in inner.iter().zip(digits(place, &sides)).enumerate() {
                    temperatures[spectrum] = axes[axis][at].ln();
                }
                Candidate { cost: lattice[place].0, temperatures, rest: lattice[place].1 }
            });
            let mut starts: Vec<Candidate> = starts.collect();
            if let (Some(last), false) = (&last, inner.is_empty()) {
                // The valley of the point before.
                let mut temperatures = last.temperatures;
                temperatures[outer] = temperature.ln();
                starts.push(Candidate { temperatures, ..last.clone() });
            }
            let mut followed: Vec<Candidate> =
                starts.iter().map(|start| plain.follow(start, inner)).collect();
            followed.sort_by(|a, b| a.cost.total_cmp(&b.cost));
            last = followed.first().cloned();
            followed
        });
        profile.filter(|candidates| !candidates.is_empty()).collect()
    }
}

/// In three dimensions the points that close in on a temperature are left to the way down.
fn thinned(axis: Vec<f64>) -> Vec<f64> {
    let mut kept: Vec<f64> = Vec::new();
    for temperature in axis {
        if kept.last().is_none_or(|last| temperature > last * 1.003) {
            kept.push(temperature);
        }
    }
    kept
}

/// Places along each axis of a place in a lattice.
fn digits(place: usize, sides: &[usize]) -> Vec<usize> {
    let mut rest = place;
    let mut found: Vec<usize> = sides
        .iter()
        .rev()
        .map(|side| {
            let digit = rest % side;
            rest /= side;
            digit
        })
        .collect();
    found.reverse();
    found
}

#[cfg(test)]
mod tests;
