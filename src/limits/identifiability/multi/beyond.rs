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

mod intervals;
mod kernels;

use self::intervals::{Curve, Intervals};
use self::kernels::{Level, Products, lengths, lit_sums};
use super::LibraryScene;
use crate::fisher::{Counting, Nuisance};
use crate::identifiability::space::StateSpace;
use crate::planck;
use crate::scene::{Parameter, check_emissivity};
use crate::simd::LANES;

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
    intervals: Intervals,
    /// Counts that every alternative sends at each of their ends, alternative by alternative.
    sent: Vec<f64>,
}

/// A target, and its products with the finer intervals, as far as they were needed.
#[derive(Default)]
pub(super) struct Seen {
    /// r, x − N.
    weight: Vec<f64>,
    rest: Vec<f64>,
    fine: Vec<Option<Vec<Products>>>,
}

impl<'e> Beyond<'e> {
    /// `None` where nothing of this kind can be said of the scene.
    pub(super) fn new(
        scene: &LibraryScene<'_>,
        counting: &Counting,
        emissivities: Vec<&'e [f64]>,
        required: f64,
    ) -> Option<Self> {
        let LibraryScene { bands, surroundings, unknowns, range, state, .. } = *scene;
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
        let given = [&own, &lit, &light, &noise];
        let sound = given.into_iter().flatten().all(|x| x.is_finite() && *x >= 0.0);
        if !(sound && required > 0.0 && required.is_finite()) {
            return None;
        }
        let curve = Curve { bands, scale: &scale };
        let intervals = match unknown(Nuisance::Temperature) {
            true => Intervals::of(curve, range.temperature_k, &own, required)?,
            false => Intervals::at(&own),
        };
        let ends = || intervals.ends.iter();
        let sent = emissivities.iter().flat_map(|e| ends().map(|end| crate::sum::dot(end, e))).collect();
        Some(Self { emissivities, required, lighting, noise, own, lit, light, known, intervals, sent })
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
        seen.fine.resize_with(self.intervals.fine.len(), || None);
        let most: f64 = (0..own.len()).map(|w| counts[w] + reach * (2.0 * root(w) + reach)).sum();
        let Intervals { coarse, fine, ends, is_closed, count } = &self.intervals;
        let levels = self.emissivities.iter().enumerate().map(|(other, emissivity)| {
            // The first interval of which even the cold end sends too much.
            let sent = &self.sent[other * ends.len()..][..ends.len()];
            let bright = sent.iter().position(|sent| *sent * (1.0 - SURELY) > most);
            let until = bright.map_or(*count, |first| first.min(*count));
            let [light, slope, rest] = lit_sums(&seen.weight, &seen.rest, &self.light, emissivity);
            (Level { light, slope, rest, lighting: self.lighting }, until, bright.is_some() || *is_closed)
        });
        let levels: Vec<(Level, usize, bool)> = levels.collect();
        let mut beyond: Vec<bool> = levels.iter().map(|(_, _, is_closed)| *is_closed).collect();
        beyond[target] = false;
        // Eight by eight, so that its products stay in the nearest cache.
        let of_target = [&*seen.weight, &seen.rest, &self.light, &self.known];
        for (eight, intervals) in coarse.iter().enumerate() {
            let first = eight * LANES;
            let columns = intervals.products(of_target);
            for ((emissivity, (level, until, _)), beyond) in
                self.emissivities.iter().zip(&levels).zip(&mut beyond)
            {
                if !*beyond || *until <= first {
                    continue;
                }
                let found = lengths(&columns, emissivity, *level);
                let near = (0..LANES.min(until - first)).filter(|lane| !is_enough(&found[*lane]));
                *beyond = near.map(|lane| first + lane).all(|place| {
                    let Some(parts) = fine.get(place) else { return false };
                    let columns = seen.fine[place].get_or_insert_with(|| parts.products(of_target));
                    lengths(columns, emissivity, *level).iter().all(is_enough)
                });
            }
        }
        beyond
    }
}

#[cfg(test)]
mod tests;
