//! What the amplitudes of the alternative's sources may be, and the least of a linear cost over them.
//!
//! The alternative is a sum of sources: its surface with amplitude c₀ (the gain) and object k with cₖ = c₀Vₖ. A source of
//! unknown temperature stands in it by two *pieces*, its spectra at both ends of an interval. The amplitudes fulfil
//!
//! lₖ ≤ Vₖ ≤ uₖ,  ΣVₖ ≤ s (or = s),  c₀ = 1, or where the gain is free c₀ ≤ g and Σ amplitude · length ≤ total,
//!
//! the length of a piece being the sum of its counts. A piece may be a shape, A/β: then its amplitude is c·β, and c is known of it
//! to lie between two multiples, g and h. Every set here contains what is allowed, and may be somewhat larger
//! where that is simpler: a least value over it is a lower bound.
//!
//! With c₀ = 1 the least value comes of filling the cheapest pieces first (the constraints are laminar). With a free gain
//! the extreme points are rays cut off at the total, of which the cheapest per length is found as Dinkelbach does, rays cut off at g, and
//! mixtures of two of those that reach both: for a price μ of length both cost the same, and none costs less.
//! Source: W. Dinkelbach, Management Science 13, 492 (1967), doi:10.1287/mnsc.13.7.492.

use super::sources::Spectrum;

/// Steps of Dinkelbach's method; each one strictly betters the ray, and there are few.
const STEPS: usize = 50;

/// Share of a limit within which an amplitude stands at it.
const NEAR: f64 = 1e-6;

/// Rounding of a cost, of amplitudes and of what is chosen by them, as a share of the cost: two costs within it are the same.
const LAST_DIGITS: f64 = 4e-15;

/// The pieces of a box: whose they are, how long, how far each may go (without the gain), and at what temperature they are.
#[derive(Debug, Clone, Default)]
pub(super) struct Pieces {
    pub(super) source: Vec<usize>,
    pub(super) length: Vec<f64>,
    pub(super) cap: Vec<f64>,
    pub(super) temperature_k: Vec<f64>,
    /// The least and the largest c of a unit of the piece, where that is a shape.
    pub(super) unit: Vec<[f64; 2]>,
}

/// A piece to be put.
#[derive(Debug, Clone, Copy)]
pub(super) struct Piece {
    pub(super) source: usize,
    pub(super) length: f64,
    pub(super) cap: f64,
    pub(super) temperature_k: f64,
    pub(super) unit: [f64; 2],
}

impl Pieces {
    pub(super) fn put(&mut self, piece: Piece) {
        self.source.push(piece.source);
        self.length.push(piece.length);
        self.cap.push(piece.cap);
        self.temperature_k.push(piece.temperature_k);
        self.unit.push(piece.unit);
    }

    /// The spectrum of a source as it is.
    pub(super) fn put_known(&mut self, source: usize, spectrum: &Spectrum) {
        let (temperature_k, [length, _]) = (spectrum.temperature_k, spectrum.lengths());
        self.put(Piece { source, length, cap: f64::INFINITY, temperature_k, unit: [1.0; 2] });
    }

    pub(super) fn clear(&mut self) {
        self.source.clear();
        self.length.clear();
        self.cap.clear();
        self.temperature_k.clear();
        self.unit.clear();
    }

    /// The least and the largest c of a unit of a source's pieces.
    fn unit_of(&self, source: usize) -> [f64; 2] {
        let place = self.source.iter().position(|&own| own == source);
        place.map_or([1.0; 2], |place| self.unit[place])
    }
}

/// The set of amplitudes.
#[derive(Debug, Clone)]
pub(super) struct Amplitudes {
    /// Whether c₀ is free.
    pub(super) gain_free: bool,
    /// lₖ and uₖ of every object.
    pub(super) ranges: Vec<[f64; 2]>,
    /// s, and whether the sum is known.
    pub(super) sum: f64,
    pub(super) sum_known: bool,
    /// What all sources together send at most.
    pub(super) total: f64,
    /// Largest c₀ where that is free.
    pub(super) gain_cap: f64,
}

/// Memory of [`Amplitudes::least`], and by how much rounding may have lifted what it found.
#[derive(Debug, Clone, Default)]
pub(super) struct Ray {
    cost: Vec<f64>,
    vertex: Vec<f64>,
    long: Vec<f64>,
    lifted: f64,
}

impl Amplitudes {
    /// Whether amplitudes stand at the upper limit of an object's factor that is free, or of their sum.
    pub(super) fn at_limit(&self, amplitudes: &[f64]) -> bool {
        let Some((surface, lights)) = amplitudes.split_first() else { return false };
        let nearly = |value: f64, limit: f64| value >= limit * surface * (1.0 - NEAR);
        let full = |(k, light): (usize, &f64)| self.tied(k).is_none() && nearly(*light, self.ranges[k][1]);
        lights.iter().enumerate().any(full) || nearly(lights.iter().sum(), self.sum)
    }

    /// Brings amplitudes of all sources within what is allowed.
    pub(super) fn bring_within(&self, amplitudes: &mut [f64]) {
        let Some((surface, lights)) = amplitudes.split_first_mut() else { return };
        *surface = if self.gain_free { surface.min(self.gain_cap) } else { 1.0 };
        for (light, [low, high]) in lights.iter_mut().zip(&self.ranges) {
            *light = light.min(high * *surface).max(low * *surface);
        }
        let all: f64 = lights.iter().sum();
        if all > self.sum * *surface || (self.sum_known && all > 0.0) {
            lights.iter_mut().for_each(|light| *light *= self.sum * *surface / all);
        }
    }

    /// The factor of an object where it is known.
    pub(super) fn tied(&self, k: usize) -> Option<f64> {
        let [low, high] = self.ranges[k];
        (low >= high).then_some(low)
    }

    /// Least Σ cost · amplitude, and where it is.
    pub(super) fn least(&self, pieces: &Pieces, cost: &[f64], vertex: &mut [f64], ray: &mut Ray) -> f64 {
        ray.lifted = 0.0;
        if !self.gain_free {
            return self.ray(pieces, cost, vertex);
        }
        let [least, most] = pieces.unit_of(0);
        let limit = self.gain_cap * (most / least);
        let along = |vertex: &[f64], x: &[f64]| -> f64 { vertex.iter().zip(x).map(|(v, x)| v * x).sum() };
        vertex.fill(0.0);
        ray.cost.resize(cost.len(), 0.0);
        ray.vertex.resize(cost.len(), 0.0);
        let (mut rate, mut scale, mut settled) = (0.0, 0.0, false);
        for step in 0..=STEPS {
            for ((adjusted, cost), length) in ray.cost.iter_mut().zip(cost).zip(&pieces.length) {
                *adjusted = cost - rate * length;
                if adjusted.abs() <= LAST_DIGITS * cost.abs() {
                    *adjusted = 0.0;
                }
            }
            let better = self.ray(pieces, &ray.cost, &mut ray.vertex);
            // What the terms of that sum are, and what they came from.
            let (mut size, mut from) = (0.0, 0.0);
            for (i, (v, adjusted)) in ray.vertex.iter().zip(&ray.cost).enumerate() {
                size += v * adjusted.abs();
                from += if *adjusted == 0.0 {
                    0.0
                } else {
                    v * (cost[i].abs() + (rate * pieces.length[i]).abs())
                };
            }
            if better >= -LAST_DIGITS * from || step == STEPS {
                let less = (-better).max(0.0) + LAST_DIGITS * size;
                ray.lifted = self.hidden(less, limit, pieces, &mut ray.vertex);
                settled = true;
                break;
            }
            vertex.copy_from_slice(&ray.vertex);
            let length = along(vertex, &pieces.length);
            (rate, scale) = (along(vertex, cost) / length, self.total / length);
            if !(rate.is_finite() && scale.is_finite()) {
                // Without limit but for the gain, or beyond what numbers hold.
                scale = f64::INFINITY;
                break;
            }
        }
        if scale > limit {
            // Without the largest gain it is no more than this.
            let known = self.total * rate - ray.lifted;
            let least = self.least_within(limit, pieces, cost, vertex, ray);
            if settled && known.is_finite() {
                ray.lifted = ray.lifted.min((least - known).max(0.0));
            }
            return least;
        }
        vertex.iter_mut().for_each(|v| *v *= scale);
        self.total * rate
    }

    /// The least where the cheapest ray for its length, which is the `vertex`, would be cut off by the largest gain.
    fn least_within(
        &self,
        limit: f64,
        pieces: &Pieces,
        cost: &[f64],
        vertex: &mut [f64],
        ray: &mut Ray,
    ) -> f64 {
        let along = |vertex: &[f64], x: &[f64]| -> f64 { vertex.iter().zip(x).map(|(v, x)| v * x).sum() };
        let Ray { cost: adjusted, vertex: better, long, lifted } = ray;
        let most = self.total / limit;
        long.resize(cost.len(), 0.0);
        self.ray(pieces, cost, long);
        *lifted = 0.0;
        let mut share = 1.0;
        // Of rays cut off at the gain that one costs least; where it is too long, the ray of the vertex is short enough.
        if along(long, &pieces.length) > most {
            for step in 1..=STEPS {
                let [cost_long, cost_short] = [&**long, &*vertex].map(|v| along(v, cost));
                let [length_long, length_short] = [&**long, &*vertex].map(|v| along(v, &pieces.length));
                share = ((most - length_short) / (length_long - length_short)).clamp(0.0, 1.0);
                let price = (cost_short - cost_long) / (length_long - length_short);
                let price = if price < 0.0 { 0.0 } else { price };
                for ((adjusted, cost), length) in adjusted.iter_mut().zip(cost).zip(&pieces.length) {
                    *adjusted = cost + price * length;
                }
                let less = share * cost_long + (1.0 - share) * cost_short + price * most
                    - self.ray(pieces, adjusted, better);
                // No mixture of rays within the total is cheaper by more than that, but for the rays' own last digits.
                *lifted = limit * if less < 0.0 { 0.0 } else { less } + LAST_DIGITS * price * self.total;
                let size = share * cost_long.abs() + (1.0 - share) * cost_short.abs() + price * most;
                // What was found of this pair is of no other one.
                if less <= LAST_DIGITS * size || less.is_nan() || step == STEPS {
                    break;
                }
                if along(better, &pieces.length) > most {
                    long.copy_from_slice(better);
                } else {
                    vertex.copy_from_slice(better);
                }
            }
        }
        vertex.iter_mut().zip(&*long).for_each(|(v, long)| *v = limit * (share * long + (1.0 - share) * *v));
        let value = along(vertex, cost);
        if lifted.is_nan() || value.is_nan() {
            vertex.fill(f64::NAN);
            return f64::NAN;
        }
        value
    }

    /// How far below what was found a ray may be that is cheaper by `less`: rays may be longer than others by any factor, so that
    /// what is rounding of a long one is much of a short one.
    fn hidden(&self, less: f64, limit: f64, pieces: &Pieces, vertex: &mut [f64]) -> f64 {
        let scale = |shortest: f64| (self.total / shortest).min(limit);
        if less > 0.0 { less * scale(self.ray(pieces, &pieces.length, vertex)) } else { 0.0 }
    }

    /// How large the amplitude of a piece can be of a state within reach.
    pub(super) fn most(&self, pieces: &Pieces, i: usize) -> f64 {
        let gain = if self.gain_free { self.gain_cap } else { 1.0 };
        let range = match pieces.source[i].checked_sub(1) {
            None => gain,
            Some(k) => gain * self.ranges[k][1],
        };
        (self.total / pieces.length[i]).min(range / pieces.unit[i][0])
    }

    /// How far above the least of all states within reach [`Amplitudes::least`] may come out: it is exact for costs that are off by
    /// their last digits, Σ |cost| · amplitude of the one found and of any other, and for what these hide.
    pub(super) fn rounding(&self, pieces: &Pieces, cost: &[f64], vertex: &[f64], ray: &Ray) -> f64 {
        let at = |i: usize| {
            if cost[i] == 0.0 { 0.0 } else { cost[i].abs() * (self.most(pieces, i) + vertex[i].abs()) }
        };
        ray.lifted + LAST_DIGITS * (0..cost.len()).map(at).sum::<f64>()
    }

    /// With c₀ = 1 at most; caps hold where the gain is not free.
    fn ray(&self, pieces: &Pieces, cost: &[f64], vertex: &mut [f64]) -> f64 {
        vertex.fill(0.0);
        let pieces_of = |source: usize| (0..cost.len()).filter(move |&i| pieces.source[i] == source);
        let cheapest = |source: usize| pieces_of(source).min_by(|&i, &j| cost[i].total_cmp(&cost[j]));
        let [least_unit, most_unit] = pieces.unit_of(0);
        let gain_least = least_unit / most_unit;
        let mut value = 0.0;
        let mut put = |vertex: &mut [f64], i: usize, amount: f64| {
            vertex[i] += amount;
            value += amount * cost[i];
        };
        if let Some(i) = cheapest(0) {
            put(vertex, i, 1.0 / most_unit);
        }
        // What may yet be lit at most, and must be at least where the sum is known.
        let (mut left, mut due) = (self.sum, if self.sum_known { self.sum * gain_least } else { 0.0 });
        for (k, [low, _]) in self.ranges.iter().enumerate() {
            let [least, most] = pieces.unit_of(k + 1);
            let amount = low * gain_least / most;
            left -= amount * least;
            due -= amount * most;
            if let (true, Some(i)) = (amount > 0.0, cheapest(k + 1)) {
                put(vertex, i, amount);
            }
        }
        // First what lowers the cost, the most per light it takes; then what must be, the cheapest per light it may give.
        for must in [false, true] {
            let rate = |i: usize| cost[i] / pieces.unit[i][usize::from(must)];
            let order = |i: usize, j: usize| rate(i).total_cmp(&rate(j)).then(i.cmp(&j));
            let mut last: Option<usize> = None;
            loop {
                let rest = if must { due } else { left };
                let next = (0..cost.len())
                    .filter(|&i| pieces.source[i] > 0 && (cost[i] >= 0.0) == must)
                    .filter(|&i| last.is_none_or(|last| order(last, i).is_lt()))
                    .min_by(|&i, &j| order(i, j));
                let Some(i) = next.filter(|_| rest > 0.0) else { break };
                last = Some(i);
                let (source, [least, most]) = (pieces.source[i], pieces.unit[i]);
                let had: f64 = pieces_of(source).map(|j| vertex[j]).sum();
                let room = self.ranges[source - 1][1] / least - had;
                let cap = if self.gain_free { f64::INFINITY } else { pieces.cap[i] - vertex[i] };
                let amount = room.min(rest / if must { most } else { least }).min(cap);
                if amount > 0.0 {
                    put(vertex, i, amount);
                    left -= amount * least;
                    due -= amount * most;
                }
            }
        }
        value
    }
}
