//! The tangent of the cost at some counts: a bound of a whole box that is exact where the cost is least in it.
//!
//! With y = √(N + v) and s = √(N′ + v) the cost f = ‖y − s‖² is convex in N and N′ together. So with any counts N₀ of the alternative, r = y − s₀
//! and slopes p = −r/s₀ by N′ and r/y by N, where the target's counts are off by no more than a share ε,
//!
//! f ≥ ‖r‖² + p·(N′ − N₀) − ε Σ|r/y|N.
//!
//! A box has N′ = Σ zA ± Σ z·half, half what a chord misses of a unit of its source: the cost of a unit of amplitude is p·A less |p|·half,
//! and what is left is the least of a linear cost (`amplitudes`). With N₀ the nearest to N that is within what the chords miss of Σ z₀A the
//! bound falls below ‖r‖² by no more than the cost of z₀ less the least, which vanishes where ‖r‖² is least over the box. In what follows p = 0 in the
//! bands that reach N.
//!
//! For the next z₀ one Newton step on ‖r‖²: weights ½f″ = y/(4s³), or for the first ones 1/(2s(y + s)), with which a band alone reaches
//! N at once from wherever it is.

use crate::simd::{Chunk, LANES, added, dispatched, fold};

/// Share of the square of y below which counts are lifted, for a slope.
const FLOOR: f64 = 1e-24;

/// What [`slopes`] reads and writes, in whole chunks.
pub(super) struct Bands<'a> {
    /// y, N and v.
    pub(super) root: &'a [f64],
    pub(super) own: &'a [f64],
    pub(super) noise: &'a [f64],
    /// Σ z₀A, and what chords may miss of it.
    pub(super) counts: &'a [f64],
    pub(super) missed: &'a [f64],
    /// p.
    pub(super) pull: &'a mut [f64],
    /// √ of the weight of a Newton step; `exact` for ½f″ itself.
    pub(super) weight: &'a mut [f64],
    pub(super) exact: bool,
}

dispatched! {
    /// Slopes and weights of every band; returned are ‖r‖² and Σ|r/y|N.
    pub(super) fn slopes<'a>(bands: Bands<'a>) -> [f64; 2] {
        let Bands { root, own, noise, counts, missed, pull, weight, exact } = bands;
        let lines = [root, own, noise, counts, missed].map(|line| line.as_chunks().0);
        let (pull, _) = pull.as_chunks_mut();
        let (weight, _) = weight.as_chunks_mut();
        let [root, own, noise, counts, missed] = lines.map(|line| &line[..pull.len()]);
        let weight = &mut weight[..pull.len()];
        let (mut cost, mut by_own) = ([0.0; LANES], [0.0; LANES]);
        for c in 0..pull.len() {
            let band = [root[c], own[c], noise[c], counts[c], missed[c]];
            let [square, p, w, q] = one(band, exact);
            cost = std::array::from_fn(|i| cost[i] + square[i]);
            by_own = added(q, own[c], by_own);
            pull[c] = p;
            weight[c] = w;
        }
        [fold(&cost), fold(&by_own)]
    }
}

/// r², p, weight and |r/y| of a chunk of bands.
#[inline(always)]
fn one([y, own, noise, counts, missed]: [Chunk; 5], exact: bool) -> [Chunk; 4] {
    let nearest: Chunk = std::array::from_fn(|i| {
        let (low, high) = (counts[i] - missed[i], counts[i] + missed[i]);
        let near = if own[i] < low { low } else { own[i] };
        let near = if near > high { high } else { near };
        let least = FLOOR * y[i] * y[i];
        if near > least { near } else { least }
    });
    let s: Chunk = std::array::from_fn(|i| (nearest[i] + noise[i]).sqrt());
    let sum: Chunk = std::array::from_fn(|i| y[i] + s[i]);
    let residual: Chunk =
        std::array::from_fn(|i| if sum[i] > 0.0 { (own[i] - nearest[i]) / sum[i] } else { 0.0 });
    // Of a target that is dark each count adds itself, and what chords miss of it may be more than all of it.
    let cost =
        std::array::from_fn(|i| if y[i] > 0.0 { residual[i] * residual[i] } else { counts[i] - missed[i] });
    let pull = std::array::from_fn(|i| if y[i] > 0.0 { -residual[i] / s[i] } else { 1.0 });
    let square: Chunk =
        std::array::from_fn(
            |i| {
                if exact { 0.25 * y[i] / (s[i] * s[i] * s[i]) } else { 0.5 / (s[i] * sum[i]) }
            },
        );
    let bends = |i: usize| y[i] > 0.0 && !(residual[i] == 0.0 && missed[i] > 0.0);
    let weight = std::array::from_fn(|i| if bends(i) { square[i].sqrt() } else { 0.0 });
    let by_own = std::array::from_fn(|i| if y[i] > 0.0 { (residual[i] / y[i]).abs() } else { 0.0 });
    [cost, pull, weight, by_own]
}

dispatched! {
    /// Σ |a||b|.
    pub(super) fn size_of_product<'a>(a: &'a [f64], b: &'a [f64]) -> f64 {
        let mut lanes = [0.0; LANES];
        for (a, b) in a.as_chunks::<LANES>().0.iter().zip(b.as_chunks::<LANES>().0) {
            let both: Chunk = std::array::from_fn(|i| (a[i] * b[i]).abs());
            lanes = std::array::from_fn(|i| lanes[i] + both[i]);
        }
        fold(&lanes)
    }
}
