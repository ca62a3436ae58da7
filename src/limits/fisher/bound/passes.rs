//! Passes over columns that take others off them and form inner products on the way.
//!
//! Columns stand one after the other. A pass reads every column once and works on a handful of them at a
//! time, in registers. Sums are those of [`crate::sum`]: their error does not grow with the number of rows.

use crate::simd::{Chunk, LANES, added, dispatched, fused, padded, product};
use crate::sum::{BLOCK, CompensatedLanes};

/// Columns worked on together.
const TOGETHER: usize = 3;
/// Chunks in a block of a compensated sum.
const CHUNKS: usize = BLOCK / LANES;

/// Nuisance columns of which the first few are done; the next one is to become orthogonal to the later ones.
pub(super) struct Pass<'a> {
    pub(super) columns: &'a mut [f64],
    pub(super) stride: usize,
    pub(super) weights: &'a [f64],
    pub(super) pivot: usize,
    /// Share of the pivot before in every column.
    pub(super) shares: &'a [f64],
    /// ⟨pivot, column⟩ for the pivot and the later columns.
    pub(super) dots: &'a mut [f64],
}

dispatched! {
    /// Takes the pivot before off this one and all later columns; inner products of this one with them.
    pub(super) fn eliminate<'a>(pass: Pass<'a>) {
        let Pass { columns, stride, weights, pivot, shares, dots } = pass;
        let rows = weights.len();
        let (before, rest) = columns.split_at_mut(pivot * stride);
        let (column, later) = rest.split_at_mut(stride);
        let done = before.chunks_exact(stride).next_back().map(|done| &done[..rows]);
        let (Some((square, dots)), Some((share, mut shares))) =
            (dots[pivot..].split_first_mut(), shares[pivot..].split_first())
        else {
            return;
        };
        let mut step = Step { weights, done, pivot: &mut column[..rows], share: *share };
        for (group, dots) in later.chunks_mut(TOGETHER * stride).zip(dots.chunks_mut(TOGETHER)) {
            let mut columns =
                group.chunks_exact_mut(stride).map(|column| &mut column[..rows]).zip(shares.iter().copied());
            let mut next = || columns.next().unwrap_or_default();
            *square = match dots.len() {
                1 => step.with([next()], dots),
                2 => step.with([next(), next()], dots),
                _ => step.with([next(), next(), next()], dots),
            };
            // Done for the pivot: further groups leave it as it is.
            step.share = 0.0;
            shares = &shares[dots.len()..];
        }
    }
}

dispatched! {
    /// Takes the shares of the other columns off the last one: ⟨last, last⟩ of what is left, and in `dots`
    /// ⟨last, column⟩ for every other column.
    pub(super) fn reduce_last<'a>(
        columns: &'a mut [f64],
        stride: usize,
        weights: &'a [f64],
        shares: &'a [f64],
        dots: &'a mut [f64],
    ) -> f64 {
        let rows = weights.len();
        let (others, last) = columns.split_at_mut(shares.len() * stride);
        let last = &mut last[..rows];
        if shares.is_empty() {
            return take_off(weights, [], last, [], dots);
        }
        let mut square = 0.0;
        // Backwards, as the last of the others is the one that the inner products wait for.
        let groups = others.rchunks(TOGETHER * stride).zip(shares.rchunks(TOGETHER));
        for ((group, shares), dots) in groups.zip(dots[..shares.len()].rchunks_mut(TOGETHER)) {
            let mut columns = group.chunks_exact(stride).map(|column| &column[..rows]);
            let mut next = || columns.next().unwrap_or_default();
            square = match *shares {
                [a] => take_off(weights, [next()], last, [a], dots),
                [a, b] => take_off(weights, [next(), next()], last, [a, b], dots),
                [a, b, c] => take_off(weights, [next(), next(), next()], last, [a, b, c], dots),
                _ => square,
            };
        }
        square
    }
}

/// The pivot, and the column that is taken off it and off others.
struct Step<'a> {
    weights: &'a [f64],
    done: Option<&'a [f64]>,
    pivot: &'a mut [f64],
    share: f64,
}

/// Inner products of the pivot with itself and N others.
struct Sums<const N: usize> {
    square: CompensatedLanes,
    dots: [CompensatedLanes; N],
}

impl Step<'_> {
    /// Takes `done` off the pivot and the others (each with its share of it); returns ⟨pivot, pivot⟩ and,
    /// in `dots`, ⟨pivot, others⟩.
    #[inline(always)]
    fn with<const N: usize>(&mut self, others: [(&mut [f64], f64); N], dots: &mut [f64]) -> f64 {
        match self.done {
            Some(done) => self.through::<N, true>(done, others, dots),
            None => self.through::<N, false>(self.weights, others, dots),
        }
    }

    #[inline(always)]
    fn through<const N: usize, const SUBTRACT: bool>(
        &mut self,
        done: &[f64],
        others: [(&mut [f64], f64); N],
        dots: &mut [f64],
    ) -> f64 {
        let shares = Shares { own: self.share, others: others.each_ref().map(|(_, share)| *share) };
        let (u, u_rest) = self.weights.as_chunks();
        let (d, d_rest) = done.as_chunks();
        let (p, p_rest) = self.pivot.as_chunks_mut();
        let mut others = others.map(|(other, _)| other.as_chunks_mut());
        let mut sums = Sums { square: CompensatedLanes::default(), dots: [CompensatedLanes::default(); N] };
        run::<N, SUBTRACT>(u, d, p, others.each_mut().map(|other| &mut *other.0), &shares, &mut sums);
        if !u_rest.is_empty() {
            let mut p = [padded(p_rest)];
            let mut o = others.each_ref().map(|other| [padded(other.1)]);
            let rest = o.each_mut().map(|other| &mut other[..]);
            run::<N, SUBTRACT>(&[padded(u_rest)], &[padded(d_rest)], &mut p, rest, &shares, &mut sums);
            for (to, from) in p_rest.iter_mut().zip(p[0]) {
                *to = from;
            }
            for ((_, to), from) in others.iter_mut().zip(o) {
                for (to, from) in to.iter_mut().zip(from[0]) {
                    *to = from;
                }
            }
        }
        for (dot, sum) in dots.iter_mut().zip(sums.dots) {
            *dot = sum.value();
        }
        sums.square.value()
    }
}

/// Shares of the column that is taken off.
struct Shares<const N: usize> {
    own: f64,
    others: [f64; N],
}

/// The rows of a [`Step`] in whole chunks. Values pass through locals, chunk by chunk: only then are they
/// kept in full-width registers.
#[inline(always)]
fn run<const N: usize, const SUBTRACT: bool>(
    weights: &[Chunk],
    done: &[Chunk],
    pivot: &mut [Chunk],
    others: [&mut [Chunk]; N],
    shares: &Shares<N>,
    sums: &mut Sums<N>,
) {
    let count = weights.len();
    let (done, pivot) = (&done[..count], &mut pivot[..count]);
    let others = others.map(|other| &mut other[..count]);
    for start in (0..count).step_by(CHUNKS) {
        let (mut square, mut dots) = ([0.0; LANES], [[0.0; LANES]; N]);
        for c in start..(start + CHUNKS).min(count) {
            let mut p = pivot[c];
            if SUBTRACT {
                p = fused(-shares.own, done[c], p);
                pivot[c] = p;
            }
            let weighted = product(weights[c], p);
            square = added(weighted, p, square);
            for n in 0..N {
                let mut other = others[n][c];
                if SUBTRACT {
                    other = fused(-shares.others[n], done[c], other);
                    others[n][c] = other;
                }
                dots[n] = added(weighted, other, dots[n]);
            }
        }
        sums.square.add(square);
        for (sum, lanes) in sums.dots.iter_mut().zip(dots) {
            sum.add(lanes);
        }
    }
}

/// Takes the shares of `others` off `from`; ⟨from, from⟩ of what is left and ⟨from, others⟩.
#[inline(always)]
fn take_off<const N: usize>(
    weights: &[f64],
    others: [&[f64]; N],
    from: &mut [f64],
    shares: [f64; N],
    dots: &mut [f64],
) -> f64 {
    let (u, u_rest) = weights.as_chunks();
    let (x, x_rest) = from.as_chunks_mut();
    let others = others.map(|other| other.as_chunks());
    let mut sums = Sums { square: CompensatedLanes::default(), dots: [CompensatedLanes::default(); N] };
    run_off(u, others.map(|other| other.0), x, shares, &mut sums);
    if !u_rest.is_empty() {
        let mut x = [padded(x_rest)];
        let rest = others.map(|other| [padded(other.1)]);
        run_off(&[padded(u_rest)], rest.each_ref().map(|other| &other[..]), &mut x, shares, &mut sums);
        for (to, from) in x_rest.iter_mut().zip(x[0]) {
            *to = from;
        }
    }
    for (dot, sum) in dots.iter_mut().zip(sums.dots) {
        *dot = sum.value();
    }
    sums.square.value()
}

/// The rows of [`take_off`] in whole chunks.
#[inline(always)]
fn run_off<const N: usize>(
    weights: &[Chunk],
    others: [&[Chunk]; N],
    from: &mut [Chunk],
    shares: [f64; N],
    sums: &mut Sums<N>,
) {
    let count = weights.len();
    let from = &mut from[..count];
    let others = others.map(|other| &other[..count]);
    for start in (0..count).step_by(CHUNKS) {
        let (mut square, mut dots) = ([0.0; LANES], [[0.0; LANES]; N]);
        for c in start..(start + CHUNKS).min(count) {
            let mut x = from[c];
            for n in 0..N {
                x = fused(-shares[n], others[n][c], x);
            }
            from[c] = x;
            let weighted = product(weights[c], x);
            square = added(weighted, x, square);
            for n in 0..N {
                dots[n] = added(weighted, others[n][c], dots[n]);
            }
        }
        sums.square.add(square);
        for (sum, lanes) in sums.dots.iter_mut().zip(dots) {
            sum.add(lanes);
        }
    }
}
