//! Which alternatives no state brings within reach of a target, by sums that all alternatives of the target share.
//!
//! If ‖√(N′ + v) − √(N + v)‖ < R in some state of the alternative, no band has √(N′ + v) > √(N + v) + R, so that
//!
//! ‖√(N′ + v) − √(N + v)‖² ≥ Σ r (N′ − N)²,  r = 1/(2√(N + v) + R)²,
//!
//! with weights of the target alone: where the right side never is below R² for the alternative's T′ and V′, no state is nearer than R.
//! N′ = e′ b(T′) + (1 − e′)(x + V′a) in counts; on an interval of temperatures b lies within ±h of a straight line p + σd, 0 ≤ σ ≤ 1
//! (chord and tangents of a convex curve, `chord` of the proofs of pairs), and
//!
//! √(Σ r (N′ − N)²) ≥ min √(Σ r (e′(p + σd) + (1 − e′)(x + V′a) − N)²) − √(Σ r e′² h²).
//!
//! The sums are products of spectra of target and interval with e′, e′² and e′(1 − e′): eight intervals at a time, side by side. Of the
//! quadratic Q in (σ, V′) any point z bounds the least over its box: Q(z) + min g·(y − z), g the gradient at z (convexity). Intervals that
//! do not suffice are cut into eight. Above a temperature at which the alternative's own emission is more than all bands can have within
//! reach nothing is to be shown.
//!
//! | symbol | unit | what |
//! |---|---|---|
//! | N, N′, v | counts, counts² | target, alternative, variance of all other noise |
//! | R | | the distance asked for |
//! | e′, b, a, x | | emissivity; blackbody, light per V′, light that is known: counts |
//!
//! Assumptions: gain and temperatures of the surroundings are known, no priors, one node a band; lighting is known, or of one object.

mod eight;
mod kernels;

use self::eight::{Eight, Interval};
use self::kernels::{Level, Products, lengths, lit_sums};
use super::LibraryScene;
use crate::fisher::{Counting, Nuisance, Unknowns};
use crate::identifiability::nearest::{Chord, StateRange, chord};
use crate::identifiability::space::StateSpace;
use crate::planck;
use crate::scene::{Parameter, State, Surroundings, check_emissivity};
use crate::simd::LANES;
use crate::spectrum::Bands;
use crate::units::SECOND_RADIATION_CM_K;

/// Share of the required distance that chords of the finer intervals may miss of a target's own counts.
const MISSED: f64 = 0.1;
/// hcν/kT at the hot end of the intervals, ν the middle of the bands, and the widest of the finer ones.
const HOT: f64 = 0.35;
const WIDEST: f64 = 0.1;
/// The hot end of an interval over its cold one at most, and intervals at most.
const RATIO: f64 = 1.35;
const MOST_INTERVALS: usize = 512;
/// Share of the required distance that what is colder than all intervals may send, and hcν/kT beyond which radiances underflow.
const DARK: f64 = 0.05;
const DARKEST: f64 = 300.0;
/// Rounding of a distance that is to be reached, as a share of it.
const SURELY: f64 = 1e-9;
/// A scene in which alternatives are compared with targets.
pub(super) struct Beyond<'e> {
    emissivities: Vec<&'e [f64]>,
    required: f64,
    /// V′, and 0 where none is free.
    lighting: [f64; 2],
    /// Of each band: v, blackbody of the target's temperature and the light on it, a, x.
    noise: Vec<f64>,
    own: Vec<f64>,
    lit: Vec<f64>,
    light: Vec<f64>,
    known: Vec<f64>,
    /// Intervals in eights, and each one cut into eight.
    coarse: Vec<Eight>,
    fine: Vec<Eight>,
    /// Counts of every alternative at the cold end of every interval, alternative by alternative; without those of intervals that have
    /// none, or must be looked at in any case.
    sent: Vec<f64>,
    /// Whether warmer states than all intervals need not be looked at.
    is_closed: bool,
}

/// A target, and its products with the finer intervals, as far as they were needed.
#[derive(Default)]
pub(super) struct Seen {
    /// r, x − N.
    weight: Vec<f64>,
    rest: Vec<f64>,
    fine: Vec<Option<Vec<Products>>>,
}

/// The scene with its camera.
#[derive(Clone, Copy)]
pub(super) struct Seeing<'s> {
    pub(super) bands: &'s Bands,
    pub(super) surroundings: &'s Surroundings,
    pub(super) unknowns: &'s Unknowns,
    pub(super) range: StateRange,
    pub(super) state: &'s State,
    pub(super) counting: &'s Counting,
}

impl<'s> Seeing<'s> {
    pub(super) fn of(scene: &LibraryScene<'s>, counting: &'s Counting) -> Self {
        let LibraryScene { bands, surroundings, unknowns, range, state, .. } = *scene;
        Self { bands, surroundings, unknowns, range, state, counting }
    }
}

impl<'e> Beyond<'e> {
    /// `None` where nothing of this kind can be said of the scene.
    pub(super) fn new(seeing: Seeing<'_>, emissivities: Vec<&'e [f64]>, required: f64) -> Option<Self> {
        let Seeing { bands, surroundings, unknowns, range, state, counting } = seeing;
        let unknown = |nuisance| unknowns.contains(nuisance);
        let objects = surroundings.objects().len();
        let free = unknown(Nuisance::Lighting) && objects > 0;
        let others = unknown(Nuisance::Gain) || unknown(Nuisance::EnvironmentTemperature);
        if others || unknowns.has_priors() || !bands.one_node_per_band() || (free && objects > 1) {
            return None;
        }
        let nodes = bands.nodes_cm1();
        let fits = emissivities.iter().all(|e| check_emissivity(e, nodes.len()).is_ok());
        if !fits || state.lighting.len() != objects || state.environment_k.len() != objects {
            return None;
        }
        let scale: Vec<f64> =
            bands.weights_cm1().iter().map(|w| w * counting.counts_per_radiance * state.gain).collect();
        let counted = |radiance: &mut dyn FnMut(usize) -> f64| -> Vec<f64> {
            (0..nodes.len()).map(|w| scale[w] * radiance(w)).collect()
        };
        let mut light = vec![0.0; nodes.len()];
        let mut lit = vec![0.0; nodes.len()];
        for (k, (object, &temperature_k)) in
            surroundings.objects().iter().zip(&state.environment_k).enumerate()
        {
            let own = object.emissivity.as_deref();
            light = counted(&mut |w| {
                own.map_or(1.0, |e| e[w]) * planck::photon_radiance(nodes[w], temperature_k)
            });
            lit.iter_mut().zip(&light).for_each(|(lit, light)| *lit += state.lighting[k] * light);
        }
        let (mut known, mut lighting) = (vec![0.0; nodes.len()], [0.0; 2]);
        if free {
            let space = StateSpace::new(unknowns.clone(), range, objects);
            let [low, high] = space.bounds(Parameter::Lighting(0));
            let sum = space.lighting_sum();
            lighting =
                [low.min(sum), if unknowns.known_lighting_total().is_some() { sum } else { high.min(sum) }];
        } else {
            known.clone_from(&lit);
            light.fill(0.0);
        }
        let own = counted(&mut |w| planck::photon_radiance(nodes[w], state.temperature_k));
        let noise: Vec<f64> = (0..nodes.len()).map(|w| counting.var_added(w)).collect();
        let mut beyond = Self {
            emissivities,
            required,
            lighting,
            noise,
            own,
            lit,
            light,
            known,
            coarse: Vec::new(),
            fine: Vec::new(),
            sent: Vec::new(),
            is_closed: true,
        };
        let given = [&beyond.own, &beyond.lit, &beyond.light, &beyond.noise];
        let sound = given.into_iter().flatten().all(|x| x.is_finite() && *x >= 0.0);
        if !(sound && required > 0.0 && required.is_finite()) {
            return None;
        }
        if unknown(Nuisance::Temperature) {
            beyond.cut(bands, &scale, range.temperature_k)?;
        } else {
            let point = Interval {
                low: beyond.own.clone(),
                rise: vec![0.0; nodes.len()],
                half: vec![0.0; nodes.len()],
            };
            beyond.coarse = vec![Eight::of(&[point])];
        }
        Some(beyond)
    }

    /// Cuts the range of temperatures into intervals.
    fn cut(&mut self, bands: &Bands, scale: &[f64], [lowest_k, highest_k]: [f64; 2]) -> Option<()> {
        crate::stop::check();
        let nodes = bands.nodes_cm1();
        let (first, last) = bands.range_cm1();
        let middle = SECOND_RADIATION_CM_K * 0.5 * (first + last);
        let all: f64 = self.own.iter().sum();
        let finest = (16.0 * MISSED * self.required / all.sqrt()).sqrt().min(WIDEST);
        let step = LANES as f64 * finest;
        let curve = |temperature_k: f64| {
            let [mut value, mut slope] = [(); 2].map(|()| vec![0.0; nodes.len()]);
            planck::photon_radiance_and_slope_into(nodes, temperature_k, &mut value, &mut slope);
            for spectrum in [&mut value, &mut slope] {
                spectrum.iter_mut().zip(scale).for_each(|(x, scale)| *x *= scale);
            }
            [value, slope]
        };
        // Weights are at most 1/R².
        let is_dark = |x: f64| {
            let [value, _] = curve(middle / x);
            value.iter().map(|b| b * b).sum::<f64>().sqrt() <= DARK * self.required * self.required
        };
        let mut cold_k = highest_k.min(middle / HOT).max(lowest_k);
        self.is_closed = cold_k >= highest_k;
        let mut temperatures_k = vec![cold_k];
        while cold_k > lowest_k && !is_dark(middle / cold_k) {
            let x = middle / cold_k;
            if temperatures_k.len() > MOST_INTERVALS || x > DARKEST {
                return None;
            }
            cold_k = (middle / (x + step).min(x * RATIO)).max(lowest_k);
            temperatures_k.push(cold_k);
        }
        temperatures_k.reverse();
        let interval = |[cold_k, hot_k]: [f64; 2]| {
            let [cold, hot] = [curve(cold_k), curve(hot_k)];
            let mut interval = Interval::zeros(nodes.len());
            chord(Chord {
                width: hot_k - cold_k,
                more: 0.0,
                cold: [&cold[0], &cold[1]],
                hot: [&hot[0], &hot[1]],
                low: &mut interval.low,
                rise: &mut interval.rise,
                half: &mut interval.half,
            });
            interval
        };
        let mut intervals = Vec::new();
        let coldest_k = temperatures_k[0];
        let [coldest, _] = curve(coldest_k);
        if coldest_k > lowest_k || temperatures_k.len() == 1 {
            // All that is colder, between nothing and that; or the one temperature there is.
            let part = if coldest_k > lowest_k { 0.5 } else { 0.0 };
            let half: Vec<f64> = coldest.iter().map(|b| part * b).collect();
            let low = coldest.iter().zip(&half).map(|(b, half)| b - half).collect();
            let dark = Interval { low, rise: vec![0.0; nodes.len()], half };
            self.fine.push(Eight::of(std::slice::from_ref(&dark)));
            intervals.push((0.0, dark));
        }
        for pair in temperatures_k.windows(2) {
            crate::stop::check();
            let [cold_k, hot_k] = [pair[0], pair[1]];
            let end = |i: usize| {
                if i == LANES { hot_k } else { cold_k + (hot_k - cold_k) * i as f64 / LANES as f64 }
            };
            let parts: Vec<Interval> = (0..LANES).map(|i| interval([end(i), end(i + 1)])).collect();
            self.fine.push(Eight::of(&parts));
            intervals.push((cold_k, interval([cold_k, hot_k])));
        }
        let whole: Vec<&Interval> = intervals.iter().map(|(_, interval)| interval).collect();
        self.coarse = whole.chunks(LANES).map(Eight::of_all).collect();
        let ends =
            intervals.iter().map(|(cold_k, _)| *cold_k).chain([temperatures_k[temperatures_k.len() - 1]]);
        let ends: Vec<Vec<f64>> =
            ends.map(|t| if t > 0.0 { curve(t)[0].clone() } else { vec![0.0; nodes.len()] }).collect();
        for emissivity in &self.emissivities {
            self.sent.extend(ends.iter().map(|end| crate::sum::dot(end, emissivity)));
        }
        Some(())
    }

    /// Whether each alternative is beyond reach of a target, whatever its state; false where that is not shown.
    pub(super) fn of_target(&self, target: usize, seen: &mut Seen) -> Vec<bool> {
        crate::stop::check();
        let reach = self.required * (1.0 + SURELY);
        let is_enough = |length: &f64| *length >= reach;
        let own = self.emissivities[target];
        let counts = (0..own.len()).map(|w| own[w].mul_add(self.own[w], (1.0 - own[w]) * self.lit[w]));
        let counts: Vec<f64> = counts.collect();
        let root = |w: usize| (counts[w] + self.noise[w]).sqrt();
        seen.weight = (0..own.len()).map(|w| (2.0 * root(w) + reach).powi(-2)).collect();
        seen.rest = self.known.iter().zip(&counts).map(|(x, n)| x - n).collect();
        seen.fine.clear();
        seen.fine.resize_with(self.fine.len(), || None);
        let most: f64 = (0..own.len()).map(|w| counts[w] + reach * (2.0 * root(w) + reach)).sum();
        let intervals = self.fine.len().max(1);
        let levels = self.emissivities.iter().enumerate().map(|(other, emissivity)| {
            let sent = self.sent.chunks(intervals + 1).nth(other).unwrap_or_default();
            // The first interval of which even the cold end sends too much.
            let bright = sent.iter().position(|sent| *sent * (1.0 - SURELY) > most);
            let until = bright.map_or(intervals, |first| first.min(intervals));
            let [light, slope, rest] = lit_sums(&seen.weight, &seen.rest, &self.light, emissivity);
            (Level { light, slope, rest, lighting: self.lighting }, until, bright.is_some() || self.is_closed)
        });
        let levels: Vec<(Level, usize, bool)> = levels.collect();
        let mut beyond: Vec<bool> = levels.iter().map(|(_, _, is_closed)| *is_closed).collect();
        beyond[target] = false;
        // Eight by eight, so that its products stay in the nearest cache.
        for (eight, coarse) in self.coarse.iter().enumerate() {
            let first = eight * LANES;
            let columns = coarse.products([&seen.weight, &seen.rest, &self.light, &self.known]);
            for ((emissivity, (level, until, _)), beyond) in
                self.emissivities.iter().zip(&levels).zip(&mut beyond)
            {
                if !*beyond || *until <= first {
                    continue;
                }
                let found = lengths(&columns, emissivity, *level);
                let near = (0..LANES.min(until - first)).filter(|lane| !is_enough(&found[*lane]));
                *beyond = near.map(|lane| first + lane).all(|place| {
                    let Some(parts) = self.fine.get(place) else { return false };
                    let columns = seen.fine[place].get_or_insert_with(|| {
                        parts.products([&seen.weight, &seen.rest, &self.light, &self.known])
                    });
                    lengths(columns, emissivity, *level).iter().all(is_enough)
                });
            }
        }
        beyond
    }
}

#[cfg(test)]
mod tests;
