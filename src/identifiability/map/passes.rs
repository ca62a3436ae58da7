//! Passes over the bands for a row of a map, compiled per instruction set.
//!
//! Symbols as in [`super::row`]: S(τ) = S₀ + τ S₁ signal, u = 1/S weights, G = 1 + S₁/S₀ growth.

use crate::simd::{Chunk, LANES, added, dispatched, fold, fused, padded, product};
use crate::sum::CompensatedLanes;

/// Columns that a pass takes at most: four nuisances and two of the material.
pub(super) const MOST_COLUMNS: usize = 6;
/// Inner products of that many columns.
const MOST_ENTRIES: usize = MOST_COLUMNS * (MOST_COLUMNS + 1) / 2;
/// Inner products ⟨i, j⟩ with i ≤ j, row by row.
pub(super) type Entries = [f64; MOST_ENTRIES];
/// Chunks in a block of a compensated sum.
const BLOCK_CHUNKS: usize = 64;

dispatched! {
    /// S₁ = S(1) − S(0) of each band; the least and the largest growth S(1)/S(0), NaN or infinite where a band is dark.
    pub(super) fn growth_into<'a>(low: &'a [f64], high: &'a [f64], out: &'a mut [f64]) -> (f64, f64) {
        for ((out, low), high) in out.iter_mut().zip(low).zip(high) {
            *out = high - low;
        }
        let ((l8, l_rest), (h8, h_rest)) = (low.as_chunks::<LANES>(), high.as_chunks::<LANES>());
        let (mut least, mut most) = ([f64::INFINITY; LANES], [0.0; LANES]);
        for (low, high) in l8.iter().zip(h8) {
            (least, most) = seen(*low, *high, least, most);
        }
        for (low, high) in l_rest.iter().zip(h_rest) {
            (least, most) = seen([*low; LANES], [*high; LANES], least, most);
        }
        (least.iter().copied().fold(f64::INFINITY, f64::min), most.iter().copied().fold(0.0, f64::max))
    }
}

/// The least and the largest growth so far, lane by lane; a dark band counts as boundless.
#[inline(always)]
fn seen(low: Chunk, high: Chunk, least: Chunk, most: Chunk) -> (Chunk, Chunk) {
    let growth: Chunk = std::array::from_fn(|i| if low[i] > 0.0 { high[i] / low[i] } else { f64::INFINITY });
    (
        std::array::from_fn(|i| if growth[i] < least[i] { growth[i] } else { least[i] }),
        std::array::from_fn(|i| if growth[i] > most[i] { growth[i] } else { most[i] }),
    )
}

/// What [`slope_into`] reads and writes.
pub(super) struct Slope<'a> {
    /// S₀, S₁, and the τ of the reference.
    pub(super) low: &'a [f64],
    pub(super) growth: &'a [f64],
    pub(super) reference: f64,
    /// ∂S/∂g at both ends.
    pub(super) first: &'a [f64],
    pub(super) last: &'a [f64],
    /// 1 ÷ the difference of V between the ends.
    pub(super) per_lighting: f64,
    /// u at the reference, and x.
    pub(super) weights: &'a mut [f64],
    pub(super) slope: &'a mut [f64],
}

dispatched! {
    /// u, and x = −∂²S/∂g∂V from the values at both ends; Σ u x² and Σ u x c₀ with c₀ the one at the first end.
    pub(super) fn slope_into<'a>(work: Slope<'a>) -> (f64, f64) {
        let Slope { low, growth, reference, first, last, per_lighting, weights, slope } = work;
        let spectra = low.iter().zip(growth).zip(first).zip(last);
        for ((weight, slope), (((low, growth), first), last)) in weights.iter_mut().zip(&mut *slope).zip(spectra) {
            *weight = 1.0 / reference.mul_add(*growth, *low);
            *slope = (first - last) * per_lighting;
        }
        let (u, x, c) = (weights.as_chunks::<LANES>(), slope.as_chunks::<LANES>(), first.as_chunks::<LANES>());
        let (mut square, mut along) = ([0.0; LANES], [0.0; LANES]);
        for ((u, x), c) in u.0.iter().zip(x.0).zip(c.0) {
            let weighted = product(*u, *x);
            (square, along) = (added(weighted, *x, square), added(weighted, *c, along));
        }
        let weighted = product(padded(u.1), padded(x.1));
        (square, along) = (added(weighted, padded(x.1), square), added(weighted, padded(c.1), along));
        (fold(&square), fold(&along))
    }
}

dispatched! {
    /// Inner products of `columns` with the weights of each τ of `nodes`.
    pub(super) fn products_at<'a>(
        low: &'a [f64],
        growth: &'a [f64],
        columns: &'a [&'a [f64]],
        nodes: &'a [f64],
        out: &'a mut [Entries],
    ) {
        for (&node, out) in nodes.iter().zip(out) {
            match *columns {
                [a, b] => products::<2, 3>(low, growth, [a, b], node, out),
                [a, b, c] => products::<3, 6>(low, growth, [a, b, c], node, out),
                [a, b, c, d] => products::<4, 10>(low, growth, [a, b, c, d], node, out),
                [a, b, c, d, e] => products::<5, 15>(low, growth, [a, b, c, d, e], node, out),
                [a, b, c, d, e, f] => products::<6, 21>(low, growth, [a, b, c, d, e, f], node, out),
                _ => out.fill(f64::NAN),
            }
        }
    }
}

#[inline(always)]
fn products<const K: usize, const P: usize>(
    low: &[f64],
    growth: &[f64],
    columns: [&[f64]; K],
    node: f64,
    out: &mut Entries,
) {
    let bands = low.len();
    let ((l, l_rest), (g, g_rest)) = (low.as_chunks(), growth[..bands].as_chunks());
    let columns = columns.map(|column| column[..bands].as_chunks());
    let mut sums = [CompensatedLanes::default(); P];
    run::<K, P>(l, g, columns.map(|column| column.0), node, &mut sums);
    if !l_rest.is_empty() {
        // A signal of 1 where there is no band any more: nothing is divided by zero.
        let mut low = [1.0; LANES];
        low[..l_rest.len()].copy_from_slice(l_rest);
        let columns = columns.map(|column| [padded(column.1)]);
        run::<K, P>(&[low], &[padded(g_rest)], columns.each_ref().map(|column| &column[..]), node, &mut sums);
    }
    for (out, sum) in out.iter_mut().zip(&sums) {
        *out = sum.value();
    }
}

/// The bands of [`products`] in whole chunks. Values pass through locals, chunk by chunk: only then are they
/// kept in full-width registers.
#[inline(always)]
fn run<const K: usize, const P: usize>(
    low: &[Chunk],
    growth: &[Chunk],
    columns: [&[Chunk]; K],
    node: f64,
    sums: &mut [CompensatedLanes; P],
) {
    let count = low.len();
    let growth = &growth[..count];
    let columns = columns.map(|column| &column[..count]);
    for start in (0..count).step_by(BLOCK_CHUNKS) {
        let mut lanes = [[0.0; LANES]; P];
        for c in start..(start + BLOCK_CHUNKS).min(count) {
            let signal = fused(node, growth[c], low[c]);
            let weights: Chunk = std::array::from_fn(|i| 1.0 / signal[i]);
            let values: [Chunk; K] = std::array::from_fn(|i| columns[i][c]);
            let mut entry = 0;
            for i in 0..K {
                let weighted = product(weights, values[i]);
                for value in &values[i..] {
                    lanes[entry] = added(weighted, *value, lanes[entry]);
                    entry += 1;
                }
            }
        }
        add(sums, &lanes);
    }
}

/// Never inlined: the lanes then go through memory all at once, which keeps the loop before in full-width registers.
#[inline(never)]
fn add<const P: usize>(sums: &mut [CompensatedLanes; P], lanes: &[Chunk; P]) {
    for (sum, lanes) in sums.iter_mut().zip(lanes) {
        sum.add(*lanes);
    }
}
