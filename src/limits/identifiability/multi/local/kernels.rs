//! Passes over the bands of one target with several alternatives, compiled per instruction set.
//!
//! Symbols as in [`super`]: u weights, c = G w C, m = u c², kᵢ = u c q̂ᵢ, Δ = e′ − e.
//!
//! * For the target: its spectra u, c, m and kᵢ.
//! * First pass, [`projections`]: Σ m Δ² and Σ kᵢ Δ of [`TOGETHER`] alternatives. A matrix waits for memory more than for
//!   arithmetic, so that what is read of the target serves a group of alternatives, and a group some targets.
//! * Second pass, [`residual_square`]: Σ u r² of one alternative, with the residual r formed band by band.
//!
//! Both passes have three steps: the number N of directions becomes one that the compiler knows, so that their sums stay in
//! registers; spectra are cut into chunks of [`LANES`] bands, the last one padded with zeros that add nothing;
//! chunks are gone through in blocks, after each of which the lanes are added to compensated sums.

use crate::simd::{Chunk, LANES, added, dispatched, fold, fused, padded, product};
use crate::sum::{Compensated, CompensatedLanes};

/// Alternatives worked on together.
pub(super) const TOGETHER: usize = 5;
/// Nuisances the shared kernels take; more of them go pair by pair.
pub(super) const MOST_NUISANCES: usize = 4;
/// Chunks in a block of a compensated sum: more than elsewhere, since a group of pairs ends a dozen of them.
const BLOCK_CHUNKS: usize = 96;

/// What [`contrast_into`] reads, and where it writes.
pub(super) struct Contrast<'a> {
    /// G.
    pub(super) gain: f64,
    /// κ, or 1 for weights per unit of band signal.
    pub(super) counts: f64,
    /// C, w and S of each band.
    pub(super) contrast: &'a [f64],
    pub(super) widths: &'a [f64],
    pub(super) signal: &'a [f64],
    /// σ²/κ of each band.
    pub(super) noise: &'a [f64],
    pub(super) u: &'a mut [f64],
    pub(super) c: &'a mut [f64],
    pub(super) m: &'a mut [f64],
}

dispatched! {
    /// u = κ/(S + σ²/κ), c = G w C and m = u c² of each band.
    pub(super) fn contrast_into<'a>(spectra: Contrast<'a>) {
        let Contrast { gain, counts, contrast, widths, signal, noise, u, c, m } = spectra;
        let given = contrast.iter().zip(widths).zip(signal).zip(noise);
        for (((u, c), m), (((contrast, width), signal), noise)) in u.iter_mut().zip(c).zip(m).zip(given) {
            let variance = signal + noise;
            *u = if variance > 0.0 { counts / variance } else { 0.0 };
            *c = gain * contrast * width;
            *m = *u * *c * *c;
        }
    }
}

dispatched! {
    /// u c q/‖q‖ of each band.
    pub(super) fn direction_into<'a>(column: &'a [f64], u: &'a [f64], c: &'a [f64], scale: f64, out: &'a mut [f64]) {
        for (((out, q), u), c) in out.iter_mut().zip(column).zip(u).zip(c) {
            *out = u * c * (q * scale);
        }
    }
}

dispatched! {
    /// Σ u a², to a few ulp per eight bands: told from what is no number.
    pub(super) fn weighted_square<'a>(a: &'a [f64], u: &'a [f64]) -> f64 {
        let count = a.len().min(u.len());
        let ((a, a_rest), (u, u_rest)) = (a[..count].as_chunks(), u[..count].as_chunks());
        let mut lanes = [0.0; LANES];
        for (a, u) in a.iter().zip(u) {
            lanes = added(product(*u, *a), *a, lanes);
        }
        let (a, u) = (padded(a_rest), padded(u_rest));
        fold(&added(product(u, a), a, lanes))
    }
}

/// A spectrum in chunks of bands, and the bands that are left.
#[derive(Clone, Copy)]
struct Cut<'a> {
    chunks: &'a [Chunk],
    rest: &'a [f64],
}

/// The first `bands` of a spectrum.
#[inline(always)]
fn cut(spectrum: &[f64], bands: usize) -> Cut<'_> {
    let (chunks, rest) = spectrum[..bands].as_chunks();
    Cut { chunks, rest }
}

/// a − b.
#[inline(always)]
fn less(a: Chunk, b: Chunk) -> Chunk {
    std::array::from_fn(|i| a[i] - b[i])
}

/// Σ m Δ² of each alternative, and Σ kᵢ Δ of each alternative along each direction.
pub(super) type Projections = ([f64; TOGETHER], [[f64; MOST_NUISANCES]; TOGETHER]);

dispatched! {
    /// [`Projections`] on `count` directions: of a target (e, m and kᵢ chunk by chunk) and a group of alternatives (chunk by chunk).
    pub(super) fn projections<'a>(lent: &'a [f64], group: &'a [f64], count: usize) -> Projections {
        match count {
            0 => project::<0>(lent, group),
            1 => project::<1>(lent, group),
            2 => project::<2>(lent, group),
            3 => project::<3>(lent, group),
            _ => project::<4>(lent, group),
        }
    }
}

/// [`Projections`] on N directions. Values pass through locals, chunk by chunk: only then are they kept in full-width registers.
#[inline(always)]
fn project<const N: usize>(lent: &[f64], group: &[f64]) -> Projections {
    let (lent, group): (&[Chunk], &[Chunk]) = (lent.as_chunks().0, group.as_chunks().0);
    let mut sums = Sums::<N>::new();
    for (lent, group) in lent.chunks(BLOCK_CHUNKS * (N + 2)).zip(group.chunks(BLOCK_CHUNKS * TOGETHER)) {
        let (mut squares, mut dots) = ([[0.0; LANES]; TOGETHER], [[[0.0; LANES]; N]; TOGETHER]);
        for (lent, others) in lent.chunks_exact(N + 2).zip(group.chunks_exact(TOGETHER)) {
            let (e, m) = (lent[0], lent[1]);
            for a in 0..TOGETHER {
                let delta = less(others[a], e);
                squares[a] = added(product(m, delta), delta, squares[a]);
                for i in 0..N {
                    dots[a][i] = added(lent[2 + i], delta, dots[a][i]);
                }
            }
        }
        sums.add(&squares, &dots);
    }
    sums.values()
}

/// [`Projections`] while they are summed over the bands.
struct Sums<const N: usize> {
    squares: [Compensated; TOGETHER],
    dots: [[Compensated; N]; TOGETHER],
}

impl<const N: usize> Sums<N> {
    #[inline(always)]
    fn new() -> Self {
        Self { squares: [Compensated::default(); TOGETHER], dots: [[Compensated::default(); N]; TOGETHER] }
    }

    /// Adds the lanes of a block. Never inlined: the lanes then go through memory all at once, which keeps the
    /// loop before in full-width registers.
    #[inline(never)]
    #[allow(
        clippy::needless_range_loop,
        reason = "as nested iterators it takes a sixth of the time of a whole matrix more"
    )]
    fn add(&mut self, squares: &[Chunk; TOGETHER], dots: &[[Chunk; N]; TOGETHER]) {
        for a in 0..TOGETHER {
            self.squares[a].add(fold(&squares[a]));
            for i in 0..N {
                self.dots[a][i].add(fold(&dots[a][i]));
            }
        }
    }

    #[inline(always)]
    fn values(self) -> Projections {
        let mut along = [[0.0; MOST_NUISANCES]; TOGETHER];
        for (along, dots) in along.iter_mut().zip(&self.dots) {
            for (along, dot) in along.iter_mut().zip(dots) {
                *along = dot.value();
            }
        }
        (self.squares.map(|square| square.value()), along)
    }
}

dispatched! {
    /// Σ u (Δ c − Σ aᵢ qᵢ)² over the first `count` of (aᵢ, qᵢ).
    pub(super) fn residual_square<'a>(
        own: &'a [f64],
        other: &'a [f64],
        c: &'a [f64],
        u: &'a [f64],
        taken: [(f64, &'a [f64]); MOST_NUISANCES],
        count: usize,
    ) -> f64 {
        let spectra = [own, other, c, u];
        match count {
            0 | 1 => left_over::<1>(spectra, taken),
            2 => left_over::<2>(spectra, taken),
            3 => left_over::<3>(spectra, taken),
            _ => left_over::<4>(spectra, taken),
        }
    }
}

/// [`residual_square`] with N columns taken off; the spectra are those of target and alternative, c and u.
#[inline(always)]
fn left_over<const N: usize>(spectra: [&[f64]; 4], taken: [(f64, &[f64]); MOST_NUISANCES]) -> f64 {
    let bands = spectra[0].len();
    let spectra = spectra.map(|spectrum| cut(spectrum, bands));
    let shares: [f64; N] = std::array::from_fn(|i| taken[i].0);
    let columns: [_; N] = std::array::from_fn(|i| cut(taken[i].1, bands));
    let mut total = CompensatedLanes::default();
    left_over_chunks(spectra.map(|x| x.chunks), columns.map(|q| q.chunks), shares, &mut total);
    if !spectra[0].rest.is_empty() {
        let spectra = spectra.map(|x| [padded(x.rest)]);
        let columns = columns.map(|q| [padded(q.rest)]);
        let (spectra, columns) = (spectra.each_ref().map(|x| &x[..]), columns.each_ref().map(|q| &q[..]));
        left_over_chunks(spectra, columns, shares, &mut total);
    }
    total.value()
}

/// The chunks of [`left_over`].
#[inline(always)]
fn left_over_chunks<const N: usize>(
    spectra: [&[Chunk]; 4],
    columns: [&[Chunk]; N],
    shares: [f64; N],
    total: &mut CompensatedLanes,
) {
    let count = spectra[0].len();
    let [own, other, contrast, weights] = spectra.map(|spectrum| &spectrum[..count]);
    let columns = columns.map(|column| &column[..count]);
    for start in (0..count).step_by(BLOCK_CHUNKS) {
        let mut sum = [0.0; LANES];
        for c in start..(start + BLOCK_CHUNKS).min(count) {
            let mut r = product(less(other[c], own[c]), contrast[c]);
            for i in 0..N {
                r = fused(-shares[i], columns[i][c], r);
            }
            sum = added(product(weights[c], r), r, sum);
        }
        total.add(sum);
    }
}
