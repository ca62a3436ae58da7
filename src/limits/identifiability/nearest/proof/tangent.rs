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
use crate::sum::CompensatedLanes;

/// Share of y² to which counts with their noise are lifted, for a slope.
const FLOOR: f64 = 1e-24;

/// What [`slopes`] and [`weights`] read, in whole chunks.
#[derive(Clone, Copy)]
pub(super) struct Bands<'a> {
    /// y, N and v.
    pub(super) root: &'a [f64],
    pub(super) own: &'a [f64],
    pub(super) noise: &'a [f64],
    /// Σ z₀A, and what chords may miss of it.
    pub(super) counts: &'a [f64],
    pub(super) missed: &'a [f64],
}

/// y, N and v of a chunk of bands, Σ z₀A, what chords may miss of it.
type Lines = [Chunk; 5];

impl<'a> Bands<'a> {
    fn chunks(&self) -> impl Iterator<Item = Lines> + 'a {
        let Self { root, own, noise, counts, missed } = *self;
        let [root, own, noise, counts, missed] =
            [root, own, noise, counts, missed].map(|line| -> &'a [Chunk] { line.as_chunks().0 });
        (0..root.len()).map(move |c| [root[c], own[c], noise[c], counts[c], missed[c]])
    }
}

dispatched! {
    /// p of every band; returned are ‖r‖² and Σ|r/y|N, `share` the N/y of every band.
    pub(super) fn slopes<'a>(bands: Bands<'a>, share: &'a [f64], pull: &'a mut [f64]) -> [f64; 2] {
        let (mut cost, mut by_own) = (CompensatedLanes::default(), [0.0; LANES]);
        let out = pull.as_chunks_mut().0.iter_mut().zip(share.as_chunks().0);
        for (lines, (pull, share)) in bands.chunks().zip(out) {
            let [square, slope, residual] = one(lines);
            *pull = slope;
            cost.add(square);
            by_own = added(residual, *share, by_own);
        }
        [cost.value(), fold(&by_own)]
    }
}

dispatched! {
    /// The root of the weight of every band in a Newton step; `exact` for ½f″ itself.
    pub(super) fn weights<'a>(bands: Bands<'a>, exact: bool, out: &'a mut [f64]) {
        for (lines, out) in bands.chunks().zip(out.as_chunks_mut::<LANES>().0) {
            let [y, own, noise, _, missed] = lines;
            let nearest = nearest(lines);
            let s: Chunk = std::array::from_fn(|i| (nearest[i] + noise[i]).sqrt());
            let square: Chunk = if exact {
                std::array::from_fn(|i| 0.25 * y[i] / (s[i] * s[i] * s[i]))
            } else {
                std::array::from_fn(|i| 0.5 / (s[i] * (y[i] + s[i])))
            };
            let bends = |i: usize| y[i] > 0.0 && !(nearest[i] == own[i] && missed[i] > 0.0);
            *out = std::array::from_fn(|i| if bends(i) { square[i].sqrt() } else { 0.0 });
        }
    }
}

/// N₀.
#[inline(always)]
fn nearest([y, own, noise, counts, missed]: Lines) -> Chunk {
    std::array::from_fn(|i| {
        let (low, high) = (counts[i] - missed[i], counts[i] + missed[i]);
        let near = if own[i] < low { low } else { own[i] };
        let near = if near > high { high } else { near };
        // Of none, beside no noise, the slope would be without limit.
        let lifted = FLOOR * y[i] * y[i] - noise[i];
        let least = if lifted > 0.0 { lifted } else { 0.0 };
        if near > least { near } else { least }
    })
}

/// r², p and |r| of a chunk of bands.
#[inline(always)]
fn one(lines: Lines) -> [Chunk; 3] {
    let [y, own, noise, counts, missed] = lines;
    let nearest = nearest(lines);
    let s: Chunk = std::array::from_fn(|i| (nearest[i] + noise[i]).sqrt());
    let pull: Chunk = std::array::from_fn(|i| (nearest[i] - own[i]) / (s[i] * (y[i] + s[i])));
    let residual: Chunk = std::array::from_fn(|i| if y[i] > 0.0 { (pull[i] * s[i]).abs() } else { 0.0 });
    // Of a target that is dark each count adds itself, and what chords miss of it may be more than all of it.
    let cost =
        std::array::from_fn(|i| if y[i] > 0.0 { residual[i] * residual[i] } else { counts[i] - missed[i] });
    let pull = std::array::from_fn(|i| if y[i] > 0.0 { pull[i] } else { 1.0 });
    [cost, pull, residual]
}

dispatched! {
    /// Σ |a||b|.
    pub(super) fn size_of_product<'a>(a: &'a [f64], b: &'a [f64]) -> f64 {
        let mut total = CompensatedLanes::default();
        for (a, b) in a.as_chunks::<LANES>().0.iter().zip(b.as_chunks::<LANES>().0) {
            total.add(std::array::from_fn(|i| (a[i] * b[i]).abs()));
        }
        total.value()
    }
}
