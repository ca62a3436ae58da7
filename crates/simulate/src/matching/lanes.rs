//! The rows of a group of windows side by side, `[column][row and band]`, so that sums over rows and bands go on
//! in step.

use super::layout::View;
use hadar::simd::{Chunk, LANES, added, dispatched, fold, fused, product};
use std::ops::Range;

/// Samples of some rows; 0 in lanes that have no row.
#[derive(Debug, Clone, Default)]
pub(super) struct Lanes {
    first: i64,
    samples: Vec<Chunk>,
}

/// Chunks that rows and bands fill.
pub(super) const fn chunks(rows: usize, bands: usize) -> usize {
    (rows * bands).div_ceil(LANES)
}

impl Lanes {
    /// Takes `columns` of `rows`; mirrored beyond those there are.
    pub(super) fn fill(&mut self, view: View, rows: Range<usize>, columns: Range<i64>) {
        let bands = view.layout.shape().bands();
        let lanes = chunks(rows.len(), bands);
        self.first = columns.start;
        self.samples.clear();
        self.samples.resize((columns.end - columns.start).max(0) as usize * lanes, [0.0; LANES]);
        for (at, row) in rows.enumerate() {
            let there = view.layout.columns(row);
            let (start, last) = (there.start as i64, there.len() as i64 - 1);
            for band in 0..bands {
                let plane = view.plane(row, band);
                let to = self.samples.as_flattened_mut().iter_mut().skip(at * bands + band);
                for (to, column) in to.step_by(lanes * LANES).zip(columns.clone()) {
                    let near = (column - start).abs();
                    let near = if near > last { (2 * last - near).max(0) } else { near };
                    *to = plane.get(near as usize).copied().unwrap_or(0.0);
                }
            }
        }
    }

    /// The samples from a column on.
    pub(super) fn from(&self, column: i64, lanes: usize) -> &[Chunk] {
        let skipped = usize::try_from(column - self.first).unwrap_or(0);
        self.samples.get(skipped * lanes..).unwrap_or(&[])
    }
}

/// χ² and its derivatives: Σ w(L − R)², Σ w(L − R)R′, Σ wR′².
#[derive(Debug, Clone, Copy)]
pub(super) struct Sums {
    pub(super) chi_square: f64,
    pub(super) gradient: f64,
    pub(super) information: f64,
}

/// Weights of the values beside a place, and those of the slope.
pub(super) type Taps<'a> = (&'a [f64], &'a [f64]);

dispatched! {
    /// Σ w(L − R)² with R from every column on, the last of which comes first.
    pub(super) fn differences<'a>(
        left: &'a [Chunk], weights: &'a [Chunk], right: &'a [Chunk], lanes: usize, sums: &'a mut [f64],
    ) {
        let count = sums.len();
        for (at, sum) in sums.iter_mut().enumerate() {
            let mut total: Chunk = [0.0; LANES];
            for ((l, w), r) in left.iter().zip(weights).zip(&right[(count - 1 - at) * lanes..]) {
                let off: Chunk = std::array::from_fn(|k| l[k] - r[k]);
                total = added(product(off, *w), off, total);
            }
            *sum = fold(&total);
        }
    }
}

dispatched! {
    /// Sums over a window of `left.len()/lanes` columns, `right` interpolated.
    pub(super) fn window_sums<'a>(
        left: &'a [Chunk], weights: &'a [Chunk], right: &'a [Chunk], lanes: usize, taps: Taps<'a>,
    ) -> Sums {
        let [mut chi_square, mut gradient, mut information]: [Chunk; 3] = [[0.0; LANES]; 3];
        for (i, (l, w)) in left.iter().zip(weights).enumerate() {
            let [mut r, mut slope]: [Chunk; 2] = [[0.0; LANES]; 2];
            for ((v, s), x) in taps.0.iter().zip(taps.1).zip(right[i..].iter().step_by(lanes)) {
                r = fused(*v, *x, r);
                slope = fused(*s, *x, slope);
            }
            let off: Chunk = std::array::from_fn(|k| l[k] - r[k]);
            let weighted = product(off, *w);
            chi_square = added(weighted, off, chi_square);
            gradient = added(weighted, slope, gradient);
            information = added(product(slope, slope), *w, information);
        }
        Sums { chi_square: fold(&chi_square), gradient: fold(&gradient), information: fold(&information) }
    }
}

dispatched! {
    /// The interpolated values of a window.
    pub(super) fn interpolate<'a>(right: &'a [Chunk], lanes: usize, value: &'a [f64], to: &'a mut [Chunk]) {
        for (i, to) in to.iter_mut().enumerate() {
            *to = [0.0; LANES];
            for (v, x) in value.iter().zip(right[i..].iter().step_by(lanes)) {
                *to = fused(*v, *x, *to);
            }
        }
    }
}
