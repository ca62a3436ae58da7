//! Newton's step in temperatures (K) and weights wₚⱼ = fₚuₚⱼ of the vertices, Σ w = 1, kept off their limits by the density.
//!
//! The bend is Fisher's information and what the density adds: 1/d² at a distance d from a limit. Where the counts push toward it with a slope g > 1/d, it
//! is g/d, the bend where the density stops them (a primal-dual interior point): else a weight that is far too large would hold up all others.
//!
//! Source: Nocedal and Wright, Numerical Optimization, 2nd ed. (2006), chapter 19.

use super::factor::{Factor, on_both_sides};
use super::parts::{LEAST_SHARE, Part, Point, Room, place_of, temperature_at};
use crate::decompose::model::{MOST, Model};

/// How far a step goes to a limit that is in its way.
const NEARER: f64 = 0.9;

/// A way from a state: how far each temperature and each weight go.
pub(super) struct Way {
    temperature_k: [f64; 2],
    weights: [[f64; MOST]; 2],
    /// What Φ loses on it.
    pub(super) gain: f64,
}

impl Way {
    /// Newton's step.
    pub(super) fn new(model: &Model, parts: &[Part], seen: &Room) -> Self {
        let vertices = model.vertices;
        let places = || (0..parts.len()).flat_map(|p| (0..vertices).map(move |j| (p, j)));
        let heaviest = places().max_by(|a, b| parts[a.0].weight(a.1).total_cmp(&parts[b.0].weight(b.1)));
        let base = heaviest.unwrap_or((0, 0));
        // Temperatures first, then more of each other weight and less of the base: ∂f = 1 of the first part's, ∂uᵢ = (δᵢⱼ − uᵢ)/f.
        let others = || places().filter(|place| *place != base);
        let count = parts.len() * vertices + parts.len() - 1;
        let turn = |x: &mut Point| {
            let old = *x;
            let own = |p: usize| &old[temperature_at(model, parts, p)..];
            let means: [f64; 2] = std::array::from_fn(|p| {
                let of = |part: &Part| (1..vertices).map(|i| part.mixture[i] * own(p)[i]).sum();
                parts.get(p).map_or(0.0, of)
            });
            let along = |(p, j): (usize, usize)| {
                let of_share = if parts.len() > 1 && p == 0 { old[0] } else { 0.0 };
                of_share + (if j > 0 { own(p)[j] } else { 0.0 } - means[p]) / parts[p].share
            };
            let of_base = along(base);
            (0..parts.len()).for_each(|p| x[p] = own(p)[0]);
            x[parts.len()..].iter_mut().zip(others()).for_each(|(x, place)| *x = along(place) - of_base);
        };
        let (mut slope, mut whole) = (seen.slope, seen.information);
        turn(&mut slope);
        on_both_sides(&mut whole, count, turn);
        // The density: s(1 − s) of places, and Π w / f^J (1 − f)^J of weights, of which what bends upwards counts. Toward a limit it
        // bends as much as it will where it stops the slope of the counts: no step goes far beyond.
        let [low, high] = model.range_k;
        let end = |s: f64, width: f64, slope: f64| {
            let bend = |to_limit: f64, slope: f64| to_limit.recip().max(-slope) / to_limit;
            let (below, above) = (s * width, (1.0 - s) * width);
            (below.recip() - above.recip(), bend(below, slope) + bend(above, -slope))
        };
        for (p, part) in parts.iter().enumerate() {
            let (first, second) = end(part.place(model), high - low, slope[p]);
            slope[p] += first;
            whole[p][p] += second;
        }
        let of_share =
            (parts.len() > 1).then(|| end(place_of(parts[0].share), 1.0 - 2.0 * LEAST_SHARE, seen.slope[0]));
        let all = vertices as f64;
        let along = |(p, j): (usize, usize)| 1.0 / parts[p].weight(j) - all / parts[p].share;
        let weight = |(p, j): (usize, usize)| parts[p].weight(j);
        for (i, place) in others().enumerate() {
            let i = parts.len() + i;
            whole[i][i] += weight(place).recip().max(-slope[i]) / weight(place);
            slope[i] += along(place) - along(base);
            let turned = |place: (usize, usize)| f64::from(place.0 == 0) - f64::from(base.0 == 0);
            for (k, other) in others().enumerate() {
                let k = parts.len() + k;
                whole[i][k] += weight(base).powi(-2);
                if let Some((_, second)) = of_share {
                    whole[i][k] += second * turned(place) * turned(other);
                }
            }
            slope[i] += of_share.map_or(0.0, |(first, _)| first * turned(place));
        }
        let (step, gain) = Factor::new(&whole, count).step(&slope);
        let mut way = Self { temperature_k: [0.0; 2], weights: [[0.0; MOST]; 2], gain };
        way.temperature_k[..parts.len()].copy_from_slice(&step[..parts.len()]);
        for ((p, j), by) in others().zip(&step[parts.len()..]) {
            way.weights[p][j] = *by;
            way.weights[base.0][base.1] -= by;
        }
        way
    }

    /// The share of the way that stays off the limits.
    pub(super) fn within(&self, model: &Model, parts: &[Part]) -> f64 {
        let [low, high] = model.range_k;
        let until = |from: f64, by: f64, low: f64, high: f64| {
            let room = if by < 0.0 { from - low } else { high - from };
            NEARER * room / by.abs()
        };
        let mut share: f64 = 1.0;
        for (p, part) in parts.iter().enumerate() {
            share = share.min(until(part.temperature_k, self.temperature_k[p], low, high));
            for j in 0..model.vertices {
                share = share.min(until(part.weight(j), self.weights[p][j], 0.0, f64::INFINITY));
            }
            if parts.len() > 1 {
                let by = self.weights[p][..model.vertices].iter().sum();
                share = share.min(until(part.share, by, LEAST_SHARE, 1.0 - LEAST_SHARE));
            }
        }
        share
    }

    pub(super) fn go(&self, vertices: usize, parts: &mut [Part], share: f64) {
        let mut weights = [[0.0; MOST]; 2];
        for (p, part) in parts.iter_mut().enumerate() {
            part.temperature_k = share.mul_add(self.temperature_k[p], part.temperature_k);
            for (j, weight) in weights[p][..vertices].iter_mut().enumerate() {
                *weight = share.mul_add(self.weights[p][j], part.weight(j)).max(f64::MIN_POSITIVE);
            }
        }
        let of: [f64; 2] = weights.map(|of| of[..vertices].iter().sum());
        for (p, part) in parts.iter_mut().enumerate() {
            part.share = of[p] / (of[0] + of[1]);
            part.mixture[..vertices].iter_mut().zip(&weights[p]).for_each(|(u, w)| *u = w / of[p]);
        }
    }
}
