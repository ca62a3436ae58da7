//! χ², slope, information and ln det C of residuals r = D f + √N′ ε, f a curve of the Matérn-5/2 law: exact, band after band.
//!
//! Along x = 3.55 ν/ℓ the curve is the first of three numbers z = (f, (∂ + 1) f, (∂ + 1)² f) that are a Markov process,
//! z(x + d) = e⁻ᵈ T(d) z(x) + noise, T = [1, d, d²/2; 0, 1, d; 0, 0, 1]. What a band is expected to be after those before it
//! (Kalman) whitens C = diag N′ + D R D at a cost in proportion to the bands, whatever the counts: with innovations a′ of vectors a and
//! their variances S, aᵀC⁻¹b = Σ a′b′/S and ln det C = Σ ln S.
//!
//! Eight states of any materials and any size of the errors lie side by side, one in each lane.
//!
//! Source: Hartikainen and Särkkä, 'Kalman filtering and smoothing solutions to temporal Gaussian process regression models' (2010).

use crate::decompose::model::MOST;
use hadar::correlation::QUARTER;
use hadar::simd::{Chunk, LANES, added, dispatched, fused, product};

/// Most vectors: the residual and a column of each unknown.
pub(super) const MOST_VECTORS: usize = MOST + 1;
/// What stands in a band before the vectors: N′ and the reach of the errors.
pub(super) const BEFORE: usize = 2;

/// From one band to the next.
#[derive(Debug)]
struct Step {
    /// To this one.
    band: usize,
    decay: f64,
    apart: f64,
    half_square: f64,
    /// Covariance of what is new: 11, 12, 13, 22, 23, 33.
    noise: [f64; 6],
}

/// Covariance of z: q ∫ e⁻²ᵗ (t²/2, t, 1)ᵀ(t²/2, t, 1) dt with q = 16/3, so that f has variance 1.
const STATIONARY: [f64; 6] = [1.0, 1.0, 2.0 / 3.0, 4.0 / 3.0, 4.0 / 3.0, 8.0 / 3.0];

/// The law of the errors from band to band, in the order of their wavenumbers.
#[derive(Debug)]
pub(super) struct Law {
    steps: Vec<Step>,
}

impl Law {
    pub(super) fn new(centres_cm1: &[f64], length_cm1: f64) -> Self {
        let mut order: Vec<usize> = (0..centres_cm1.len()).collect();
        order.sort_by(|a, b| centres_cm1[*a].total_cmp(&centres_cm1[*b]));
        let first = order.first().map(|&band| Step {
            band,
            decay: 0.0,
            apart: 0.0,
            half_square: 0.0,
            noise: STATIONARY,
        });
        let step = |pair: &[usize]| {
            // Beyond 100 nothing is left of e⁻ᵈ d⁴.
            let apart = (QUARTER * (centres_cm1[pair[1]] - centres_cm1[pair[0]]) / length_cm1).min(100.0);
            let half_square = 0.5 * apart * apart;
            let decay = libm::exp(-apart);
            let kept = moved(STATIONARY, apart, half_square, |factor, a, b| factor * a + b);
            let noise = std::array::from_fn(|i| STATIONARY[i] - decay * decay * kept[i]);
            Step { band: pair[1], decay, apart, half_square, noise }
        };
        Self { steps: first.into_iter().chain(order.windows(2).map(step)).collect() }
    }
}

/// T P Tᵀ of a symmetric P.
#[inline(always)]
fn moved<X: Copy>(p: [X; 6], d: f64, half: f64, fused: impl Fn(f64, X, X) -> X) -> [X; 6] {
    let [p11, p12, p13, p22, p23, p33] = p;
    let first = fused(half, p13, fused(d, p12, p11));
    let second = fused(half, p23, fused(d, p22, p12));
    let third = fused(half, p33, fused(d, p23, p13));
    let below = fused(d, p33, p23);
    [
        fused(half, third, fused(d, second, first)),
        fused(d, third, second),
        third,
        fused(d, below, fused(d, p23, p22)),
        below,
        p33,
    ]
}

/// What the filter finds in each lane.
#[derive(Debug, Clone)]
pub(super) struct Found {
    /// aᵀC⁻¹b of vectors a ≤ b.
    pub(super) products: [[Chunk; MOST_VECTORS]; MOST_VECTORS],
    whole: Logarithm,
    least: Logarithm,
}

impl Default for Found {
    fn default() -> Self {
        let products = [[[0.0; LANES]; MOST_VECTORS]; MOST_VECTORS];
        Self { products, whole: Logarithm::NONE, least: Logarithm::NONE }
    }
}

impl Found {
    /// ln det C, and Σ ln N′: ln det C were there no errors.
    pub(super) fn logarithms(&self, lane: usize) -> (f64, f64) {
        (self.whole.value(lane), self.least.value(lane))
    }
}

/// Logarithm of a product of positive numbers, with powers of 2 kept apart.
#[derive(Debug, Clone, Copy)]
struct Logarithm {
    mantissa: Chunk,
    exponent: [i64; LANES],
}

impl Logarithm {
    const NONE: Self = Self { mantissa: [1.0; LANES], exponent: [0; LANES] };

    #[inline(always)]
    fn add(&mut self, factor: Chunk) {
        const BITS: u32 = f64::MANTISSA_DIGITS - 1;
        const ONE: u64 = 1.0_f64.to_bits();
        let bits = product(self.mantissa, factor).map(f64::to_bits);
        for (exponent, bits) in self.exponent.iter_mut().zip(bits) {
            *exponent += (bits >> BITS) as i64 - (ONE >> BITS) as i64;
        }
        self.mantissa = bits.map(|bits| f64::from_bits(bits & ((1 << BITS) - 1) | ONE));
    }

    fn value(&self, lane: usize) -> f64 {
        (self.exponent[lane] as f64).mul_add(std::f64::consts::LN_2, libm::log(self.mantissa[lane]))
    }
}

/// Σ ln of positive numbers in whole chunks.
pub(super) fn logarithm_of_all(values: &[f64]) -> f64 {
    let mut product = Logarithm::NONE;
    values.as_chunks::<LANES>().0.iter().for_each(|chunk| product.add(*chunk));
    (0..LANES).map(|lane| product.value(lane)).sum()
}

/// Vectors for which the filter has room: a few, or all.
pub(super) fn room_for(vectors: usize) -> usize {
    if vectors <= 4 { vectors } else { MOST_VECTORS }
}

dispatched! {
    /// Of rows of `[N′, reach, vectors…][band][lane]`, the vectors as many as there is [`room_for`].
    pub(super) fn filter<'a>(law: &'a Law, rows: &'a [f64], vectors: usize, to: &'a mut Found) {
        match vectors {
            2 => whiten::<2>(law, rows, to),
            3 => whiten::<3>(law, rows, to),
            4 => whiten::<4>(law, rows, to),
            _ => whiten::<MOST_VECTORS>(law, rows, to),
        }
    }
}

#[inline(always)]
fn whiten<const V: usize>(law: &Law, rows: &[f64], to: &mut Found) {
    let none = [0.0; LANES];
    let times = |factor: f64, a: Chunk| a.map(|a| factor * a);
    let mut p = [none; 6];
    let mut states = [[none; 3]; V];
    let mut products = [[none; V]; V];
    let (mut whole, mut least) = (Logarithm::NONE, Logarithm::NONE);
    let rows = rows.as_chunks::<LANES>().0;
    let width = rows.len() / (BEFORE + V);
    let at = |k: usize, band: usize| rows[k * width + band];
    for step in &law.steps {
        let Step { band, decay, apart, half_square, noise } = *step;
        let kept = moved(p, apart, half_square, fused);
        p = std::array::from_fn(|i| fused(decay * decay, kept[i], [noise[i]; LANES]));
        let (mean, reach) = (at(0, band), at(1, band));
        p[0] = p[0].map(|p| if p > 0.0 { p } else { 0.0 });
        let gain = [product(reach, p[0]), product(reach, p[1]), product(reach, p[2])];
        let variance = added(reach, gain[0], mean);
        let weight = variance.map(|s| 1.0 / s);
        whole.add(variance);
        least.add(mean);
        let mut innovations = [none; V];
        let mut weighted = [none; V];
        for v in 0..V {
            let [a, b, c] = states[v];
            let before = [
                times(decay, fused(half_square, c, fused(apart, b, a))),
                times(decay, fused(apart, c, b)),
                times(decay, c),
            ];
            let minus = reach.map(|reach| -reach);
            innovations[v] = added(minus, before[0], at(BEFORE + v, band));
            weighted[v] = product(innovations[v], weight);
            states[v] = std::array::from_fn(|i| added(gain[i], weighted[v], before[i]));
        }
        for i in 0..V {
            for j in i..V {
                products[i][j] = added(innovations[i], weighted[j], products[i][j]);
            }
        }
        // p − p gain/S of the first row without a difference.
        let left = product(mean, weight);
        let [second, third] = [product(gain[1], weight), product(gain[2], weight)];
        let less = |p: Chunk, a: Chunk, b: Chunk| added(a.map(|a| -a), b, p);
        p = [
            product(p[0], left),
            product(p[1], left),
            product(p[2], left),
            less(p[3], second, gain[1]),
            less(p[4], second, gain[2]),
            less(p[5], third, gain[2]),
        ];
    }
    for i in 0..V {
        to.products[i][i..V].copy_from_slice(&products[i][i..]);
    }
    (to.whole, to.least) = (whole, least);
}
