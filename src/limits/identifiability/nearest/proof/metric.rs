//! What a quadratic in the counts says of the distance.
//!
//! With y = √(N + v) of the target and s = √(N′ + v) of the alternative, and any counts N₀ with s₀, r₀ = y − s₀,
//!
//! ‖y − s‖² = ‖r₀‖² − Σ (r₀/s₀)(N′ − N₀) + Σ (y/s₀)(s − s₀)²,   (s − s₀)² = (N′ − N₀)²/(s + s₀)².
//!
//! A state nearer than d has s ≤ y + d in *every* band. So no state nearer than d is below the quadratic
//!
//! ‖r₀‖² − Σ (r₀/s₀)(N′ − N₀) + Σ (y/s₀)(N′ − N₀)²/(s₀ + y + d)²,
//!
//! whose value and slope at N₀ are exact. With N₀ = N it is the weighted least-squares sum Σ (N′ − N)²/(2y + d)².
//! A band in which s₀ is 0 is left out: each adds a square.
//!
//! Where more is known of how bright a band can become in a box than s ≤ y + d, that stands in its place: by such a quadratic itself the
//! states within reach lie in an ellipsoid, ‖Q(u − Qᵀh)‖ with ‖u‖ ≤ e in the orthonormal basis Q of the weighted columns, and no band of
//! it has more than e‖Q_w‖ − Q_w·Qᵀh ([`Ellipsoid`]).

use super::vectors::{add_into, add_root_into, add_square_into};
use crate::simd::{Chunk, LANES, added, dispatched, fold};
use crate::sum::dot;

/// What counts are lifted by, so that rounding takes nothing of them.
const SURELY: f64 = 1.0 + 1e-12;

/// cost + ‖weight · (N′ − N₀) + shift‖² − length², length = ‖shift‖.
#[derive(Debug, Clone, Default)]
pub(super) struct Metric {
    pub(super) weight: Vec<f64>,
    pub(super) shift: Vec<f64>,
    pub(super) cost: f64,
    pub(super) length: f64,
}

impl Metric {
    /// About the target itself, written with N₀ = 0.
    pub(super) fn about_target(root: &[f64], counts: &[f64], reach: f64) -> Self {
        let sums = root.iter().map(|y| 2.0 * y + reach);
        let weight: Vec<f64> = sums.map(|sum| if sum > 0.0 { 1.0 / sum } else { 0.0 }).collect();
        let shift: Vec<f64> = weight.iter().zip(counts).map(|(w, n)| -w * n).collect();
        let cost = dot(&shift, &shift);
        Self { weight, shift, cost, length: cost.sqrt() }
    }

    /// About other counts, of states whose roots are nowhere above the `brightest`.
    pub(super) fn put_about(&mut self, counts: &[f64], [root, own, noise]: [&[f64]; 3], brightest: &[f64]) {
        crate::stop::check();
        self.weight.resize(root.len(), 0.0);
        self.shift.resize(root.len(), 0.0);
        let out = [&mut self.weight[..], &mut self.shift[..]];
        let [cost, square] = about(Bands { root, counts, noise, own, brightest, out });
        (self.cost, self.length) = (cost, square.sqrt());
    }
}

/// The states within reach by a quadratic.
pub(super) struct Ellipsoid<'a> {
    /// Q and Qᵀh.
    pub(super) basis: &'a [Vec<f64>],
    pub(super) along: &'a [f64],
    /// e.
    pub(super) radius: f64,
    /// Counts that it is about, and what more the chords may have missed, band by band.
    pub(super) counts: &'a [f64],
    pub(super) missed: &'a [f64],
}

impl Ellipsoid<'_> {
    /// Lowers the brightest root of every band to what a state in it can have.
    pub(super) fn lower(&self, weight: &[f64], noise: &[f64], brightest: &mut [f64]) {
        crate::stop::check();
        let (mut shares, mut most) = (vec![0.0; weight.len()], vec![0.0; weight.len()]);
        for (column, along) in self.basis.iter().zip(self.along) {
            add_square_into(column, &mut shares);
            add_into(-along, column, &mut most);
        }
        add_root_into(self.radius, &shares, &mut most);
        lowered_into([&most, weight, self.counts, self.missed, noise], brightest);
    }
}

dispatched! {
    /// The lesser of what it is and √(N₀ + most/W + missed + v); as it is where W is 0.
    fn lowered_into<'a>(bands: [&'a [f64]; 5], brightest: &'a mut [f64]) -> () {
        let [most, weight, counts, missed, noise] = bands;
        let bands = most.iter().zip(weight).zip(counts.iter().zip(missed)).zip(noise);
        for (brightest, (((most, weight), (counts, missed)), noise)) in brightest.iter_mut().zip(bands) {
            let square = (counts + missed + noise) * SURELY + most / weight;
            let root = if square > 0.0 { square.sqrt() } else { 0.0 };
            *brightest = if *weight > 0.0 && root < *brightest { root } else { *brightest };
        }
    }
}

/// What [`about`] reads and writes, in whole chunks.
struct Bands<'a> {
    root: &'a [f64],
    counts: &'a [f64],
    noise: &'a [f64],
    own: &'a [f64],
    brightest: &'a [f64],
    out: [&'a mut [f64]; 2],
}

dispatched! {
    /// Weights and shifts of every band; returned are the cost and the square of the shift.
    fn about<'a>(bands: Bands<'a>) -> [f64; 2] {
        let Bands { root, counts, noise, own, brightest, out: [weights, shifts] } = bands;
        let lines = [root, counts, noise, own, brightest].map(|line| line.as_chunks().0);
        let (weights, _) = weights.as_chunks_mut();
        let (shifts, _) = shifts.as_chunks_mut();
        let [root, counts, noise, own, brightest] = lines.map(|line| &line[..weights.len()]);
        let shifts = &mut shifts[..weights.len()];
        let (mut cost, mut square) = ([0.0; LANES], [0.0; LANES]);
        for c in 0..weights.len() {
            let (residual, weight, half) = one(root[c], counts[c], noise[c], own[c], brightest[c]);
            cost = added(residual, residual, cost);
            square = added(half, half, square);
            weights[c] = weight;
            shifts[c] = half;
        }
        [fold(&cost), fold(&square)]
    }
}

/// r₀, weight and shift of a chunk of bands, 0 where s₀ or y is.
#[inline(always)]
fn one(y: Chunk, counts: Chunk, noise: Chunk, own: Chunk, brightest: Chunk) -> (Chunk, Chunk, Chunk) {
    let seen: Chunk = std::array::from_fn(|i| counts[i] + noise[i]);
    let s: Chunk = std::array::from_fn(|i| if seen[i] > 0.0 { seen[i].sqrt() } else { 0.0 });
    let residual: Chunk = std::array::from_fn(|i| (own[i] - counts[i]) / (y[i] + s[i]));
    let inverse: Chunk = std::array::from_fn(|i| 1.0 / s[i]);
    let size: Chunk = std::array::from_fn(|i| (y[i] * inverse[i]).sqrt());
    let sum: Chunk = std::array::from_fn(|i| s[i] + brightest[i]);
    let weight: Chunk = std::array::from_fn(|i| size[i] / sum[i]);
    // Half of p/weight, p = −r/s.
    let half: Chunk = std::array::from_fn(|i| -0.5 * residual[i] * inverse[i] * sum[i] / size[i]);
    let usable = |i: usize, value: f64| if s[i] > 1e-150 && y[i] > 0.0 { value } else { 0.0 };
    (
        std::array::from_fn(|i| usable(i, residual[i])),
        std::array::from_fn(|i| usable(i, weight[i])),
        std::array::from_fn(|i| usable(i, half[i])),
    )
}
