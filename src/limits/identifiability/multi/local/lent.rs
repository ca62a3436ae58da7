//! What one target lends to all its pairs, and their distances from it.
//!
//! Symbols as in [`super`]. What the first pass reads is laid out chunk by chunk: of the target e, m and k₁, k₂…, of a group of
//! [`TOGETHER`] alternatives their emissivities. Both are then read from one end to the other.

use super::kernels::{MOST_NUISANCES, TOGETHER, direction_into, projections, residual_square};
use crate::aligned::Aligned;
use crate::simd::LANES;

/// Largest none/d for which the one-pass difference of squares keeps 1e-14·none/d: 2u·(none/d)² below it.
const ONE_PASS: f64 = 16.0;
/// Largest none/d for which a residual once projected is good; beyond it rank and rounding are judged too.
const TWO_PASSES: f64 = 1e5;

/// Emissivities in groups, zeros where there are no more bands or materials: `[group][chunk][alternative][lane]`.
pub(super) fn grouped(emissivities: &[&[f64]]) -> Aligned {
    let bands = emissivities.first().map_or(0, |spectrum| spectrum.len());
    let group_len = bands.next_multiple_of(LANES) * TOGETHER;
    let mut groups = Aligned::zeros(group_len * emissivities.len().div_ceil(TOGETHER));
    for (out, group) in groups.chunks_mut(group_len.max(1)).zip(emissivities.chunks(TOGETHER)) {
        for (place, spectrum) in group.iter().enumerate() {
            scatter(spectrum, place, TOGETHER, out);
        }
    }
    groups
}

/// Writes the chunks of a spectrum to every `of`-th place.
fn scatter(spectrum: &[f64], place: usize, of: usize, out: &mut [f64]) {
    for (from, to) in spectrum.chunks(LANES).zip(out.chunks_mut(of * LANES)) {
        to[place * LANES..][..from.len()].copy_from_slice(from);
    }
}

/// What a target lends.
#[derive(Debug, Clone, Default)]
pub(super) struct Lent {
    /// Whether all pairs of the target are served by it.
    pub(super) is_shared: bool,
    /// u, c and m of each band.
    pub(super) weights: Aligned,
    pub(super) contrast: Aligned,
    pub(super) square: Aligned,
    /// Factor from the norm to the distance.
    pub(super) half: f64,
    /// The orthogonal nuisance columns one after the other, and their norms.
    columns: Vec<f64>,
    norms: Vec<f64>,
    /// e, m and k₁, k₂… chunk by chunk.
    spectra: Aligned,
}

impl Lent {
    /// Makes room for another target.
    pub(super) fn clear(&mut self, bands: usize) {
        for spectrum in [&mut self.weights, &mut self.contrast, &mut self.square] {
            spectrum.set_len(bands);
        }
        self.columns.clear();
        self.norms.clear();
    }

    /// Takes a nuisance column that is orthogonal to those before.
    pub(super) fn take(&mut self, column: &[f64], norm: f64) {
        self.columns.extend_from_slice(column);
        self.norms.push(norm);
    }

    /// Lays out what the first pass reads.
    pub(super) fn interleave(&mut self, own: &[f64]) {
        let bands = own.len();
        let of = 2 + self.norms.len();
        let mut direction = vec![0.0; bands];
        self.spectra.set_len(bands.next_multiple_of(LANES) * of);
        // Of the last chunk only what there are bands for is written.
        let rest = self.spectra.len().saturating_sub(of * LANES);
        self.spectra[rest..].fill(0.0);
        scatter(own, 0, of, &mut self.spectra);
        scatter(&self.square, 1, of, &mut self.spectra);
        for (i, (column, norm)) in self.columns.chunks(bands.max(1)).zip(&self.norms).enumerate() {
            direction_into(column, &self.weights, &self.contrast, 1.0 / norm, &mut direction);
            scatter(&direction, 2 + i, of, &mut self.spectra);
        }
    }

    /// Distances to up to [`TOGETHER`] alternatives, NaN where the pair must be judged on its own; for how many
    /// others a second pass was needed.
    pub(super) fn distances(
        &self,
        own: &[f64],
        others: &[&[f64]],
        group: &[f64],
        out: &mut [f64],
        lost: &mut [f64],
    ) -> usize {
        let (squares, dots) = projections(&self.spectra, group, self.norms.len());
        lost.iter_mut().zip(squares).for_each(|(lost, square)| *lost = square);
        let mut second = 0;
        for (i, (out, other)) in out.iter_mut().zip(others).enumerate() {
            let dots = dots[i];
            let along: f64 = dots.iter().map(|dot| dot * dot).sum();
            let left = squares[i] - along;
            *out = if squares[i] == 0.0 {
                // Nothing, or so little that its square is; of itself that need not be looked at.
                if std::ptr::eq(own, *other) || own == *other { 0.0 } else { f64::NAN }
            } else if !squares[i].is_finite() {
                f64::NAN
            } else if left * (ONE_PASS * ONE_PASS) >= squares[i] {
                self.half * left.sqrt()
            } else {
                let left = self.residual(own, other, dots);
                let good = left * (TWO_PASSES * TWO_PASSES) >= squares[i];
                second += usize::from(good);
                if good { self.half * left.sqrt() } else { f64::NAN }
            };
        }
        second
    }

    /// Σ u r² with the residual r formed band by band.
    fn residual(&self, own: &[f64], other: &[f64], dots: [f64; MOST_NUISANCES]) -> f64 {
        let mut taken = [(0.0, own); MOST_NUISANCES];
        let columns = self.columns.chunks(own.len().max(1)).zip(&self.norms);
        for ((taken, (column, norm)), dot) in taken.iter_mut().zip(columns).zip(dots) {
            *taken = (dot / norm, column);
        }
        residual_square(own, other, &self.contrast, &self.weights, taken, self.norms.len())
    }
}
