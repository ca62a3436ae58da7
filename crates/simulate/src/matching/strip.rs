//! Scores of all disparities for a row of windows, by running sums.
//!
//! Both views less the same offset of each band; of the windows about x (left) and x − d (right) with n pixels
//! each,
//!
//! * zero-normalised cross-correlation C = Σ_b [Σ LR − ΣL ΣR/n]/√(V_L V_R), V = Σ_b [Σ L² − (ΣL)²/n]: every
//!   band has its own mean taken off, so gain (common to all bands) and offset (of each band) of a view do not
//!   matter;
//! * squared differences, negative: 2Σ LR − Σ L² − Σ R².
//!
//! Σ LR over the rows of the window is a running sum per column (a row in, a row out), started anew by
//! [`Strip::start`]; over columns, window sums come from sums towards the start of blocks as long as the
//! window and from their start: three additions whatever the window, and nothing is subtracted. Disparities
//! lie side by side.

use super::layout::View;
use super::search::Search;
use hadar::ranging::information::Window;
use hadar::simd::{Chunk, LANES, dispatched, fused};
use std::ops::Range;

/// V below this share of Σ L² is rounding.
const FLAT: f64 = 1e-13;

/// How alike two windows are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Score {
    /// Zero-normalised cross-correlation, all bands together, each less its own mean: gain and offset do not
    /// matter.
    #[default]
    Correlation,
    /// Sum of squared differences, negative.
    SquaredDifferences,
}

/// Scores of the windows of a row, and the room to work them out.
#[derive(Debug, Clone)]
pub(super) struct Strip {
    window: Window,
    search: Search,
    score: Score,
    columns: Range<usize>,
    offsets: Vec<f64>,
    /// Σ LR over the window's rows, `[column][disparity]`.
    products: Vec<Chunk>,
    /// Scores, `[window][disparity]`.
    scores: Vec<Chunk>,
    left: Side,
    right: Side,
    row: Vec<f64>,
    mirrored: Vec<f64>,
}

/// Sums of one view.
#[derive(Debug, Clone, Default)]
struct Side {
    columns: Vec<f64>,
    sums: Vec<f64>,
    /// Σ², then of zero mean.
    squares: Vec<f64>,
    varied: Vec<f64>,
    /// Band's window sums, `[band][window]`.
    means: Vec<f64>,
    scale: Vec<f64>,
}

impl Strip {
    pub(super) fn new(window: Window, search: Search, score: Score) -> Self {
        Self {
            window,
            search,
            score,
            columns: 0..0,
            offsets: Vec::new(),
            products: Vec::new(),
            scores: Vec::new(),
            left: Side::default(),
            right: Side::default(),
            row: Vec::new(),
            mirrored: Vec::new(),
        }
    }

    /// Chunks of disparities.
    const fn lanes(&self) -> usize {
        self.search.disparities().div_ceil(LANES)
    }

    /// Columns that the windows reach.
    fn reach(&self) -> Range<usize> {
        let half = self.window.half_columns();
        self.columns.start - half..self.columns.end + half
    }

    fn rows(&self, row: usize) -> Range<usize> {
        let half = self.window.half_rows();
        row - half..row + half + 1
    }

    /// Windows about `columns` of `row`, all within the left view.
    pub(super) fn start(&mut self, left: View, right: View, row: usize, columns: Range<usize>) {
        self.columns = columns;
        let (bands, reach, rows) = (left.layout.shape().bands(), self.reach(), self.rows(row));
        self.offsets.clear();
        for band in 0..bands {
            let plane = left.part(row, band, reach.clone());
            // A whole number: counts stay whole, and sums of them exact.
            self.offsets.push((plane.iter().sum::<f64>() / plane.len().max(1) as f64).round());
        }
        self.products.clear();
        self.products.resize(reach.len() * self.lanes(), [0.0; LANES]);
        for row in rows {
            self.add(left, right, row, 1.0);
        }
        self.finish(left, right, row);
    }

    /// The same columns of the next row.
    pub(super) fn advance(&mut self, left: View, right: View, row: usize) {
        let rows = self.rows(row);
        self.add(left, right, rows.end - 1, 1.0);
        self.add(left, right, rows.start - 1, -1.0);
        self.finish(left, right, row);
    }

    /// Scores of the window at a place of the columns, from the lowest disparity on (as far as
    /// [`Search::within`]); none for a left window without texture.
    pub(super) fn scores(&self, at: usize) -> &[f64] {
        let lanes = self.lanes();
        if self.left.scale.get(at).is_none_or(|scale| *scale == 0.0) {
            return &[];
        }
        self.scores.get(at * lanes..(at + 1) * lanes).unwrap_or(&[]).as_flattened()
    }

    fn add(&mut self, left: View, right: View, row: usize, sign: f64) {
        let lanes = self.lanes();
        for band in 0..self.offsets.len() {
            self.load(left, row, band);
            self.mirror(right, row, band);
            add_products(&mut self.products, lanes, &self.row, &self.mirrored, sign);
        }
    }

    /// The left view's columns.
    fn load(&mut self, left: View, row: usize, band: usize) {
        let offset = self.offsets.get(band).copied().unwrap_or(0.0);
        self.row.clear();
        self.row.extend(left.part(row, band, self.reach()).iter().map(|sample| sample - offset));
        self.row.resize(self.reach().len(), 0.0);
    }

    /// The right view's columns, the last one first: then disparities rise along them. 0 beyond the image.
    fn mirror(&mut self, right: View, row: usize, band: usize) {
        let offset = self.offsets.get(band).copied().unwrap_or(0.0);
        let (reach, there) = (self.reach(), right.layout.columns(row));
        let plane = right.plane(row, band);
        let (len, last) =
            (reach.len() + self.lanes() * LANES, reach.end as i64 - 1 - i64::from(self.search.least()));
        let start = there.start as i64;
        self.mirrored.clear();
        self.mirrored.resize(len, 0.0);
        // Entry k is column last − k.
        let first = (last + 1 - start - plane.len() as i64).max(0);
        let end = (last - start + 1).clamp(0, len as i64);
        let (from, skipped) =
            (first as usize, (start + plane.len() as i64 - 1 - last + first).max(0) as usize);
        let to = self.mirrored.iter_mut().take(end as usize).skip(from);
        to.zip(plane.iter().rev().skip(skipped)).for_each(|(to, sample)| *to = sample - offset);
    }

    fn finish(&mut self, left: View, right: View, row: usize) {
        let (lanes, width) = (self.lanes(), self.window.columns());
        let bands = self.offsets.len();
        let pixels = (self.window.rows() * width) as f64;
        let (windows, mirrored) = (self.columns.len(), self.reach().len() + lanes * LANES);
        self.left.clear(windows);
        self.right.clear(mirrored + 1 - width);
        for band in 0..bands {
            self.left.begin(windows + width - 1);
            self.right.begin(mirrored);
            for row in self.rows(row) {
                self.load(left, row, band);
                self.mirror(right, row, band);
                self.left.add(&self.row);
                self.right.add(&self.mirrored);
            }
            self.left.end(width, pixels);
            self.right.end(width, pixels);
        }
        let zero_mean = self.score == Score::Correlation;
        self.left.scale(zero_mean);
        self.right.scale(zero_mean);
        self.scores.clear();
        self.scores.resize(windows * lanes, [0.0; LANES]);
        box_sums(&self.products, lanes, width, &mut self.scores);
        if zero_mean {
            let (l, r) = (windows, mirrored + 1 - width);
            for (left, right) in self.left.means.chunks_exact(l).zip(self.right.means.chunks_exact(r)) {
                add_products(&mut self.scores, lanes, left, right, -1.0 / pixels);
            }
            scale_scores(&mut self.scores, lanes, &self.left.scale, &self.right.scale);
        } else {
            take_squares(&mut self.scores, lanes, &self.left.squares, &self.right.squares);
        }
    }
}

impl Side {
    fn clear(&mut self, windows: usize) {
        self.means.clear();
        for list in [&mut self.squares, &mut self.varied] {
            list.clear();
            list.resize(windows, 0.0);
        }
    }

    /// Sums of the columns and of their squares follow one another.
    fn begin(&mut self, columns: usize) {
        self.columns.clear();
        self.columns.resize(2 * columns, 0.0);
    }

    fn add(&mut self, row: &[f64]) {
        let (sums, squares) = self.columns.split_at_mut(row.len());
        for ((sum, square), x) in sums.iter_mut().zip(squares).zip(row) {
            *sum += x;
            *square += x * x;
        }
    }

    fn end(&mut self, width: usize, pixels: f64) {
        let (sums, squares) = self.columns.split_at(self.columns.len() / 2);
        box_sum(sums, width, &mut self.sums);
        self.means.extend_from_slice(&self.sums);
        for (varied, sum) in self.varied.iter_mut().zip(&self.sums) {
            *varied -= sum * sum / pixels;
        }
        box_sum(squares, width, &mut self.sums);
        for ((total, varied), square) in self.squares.iter_mut().zip(&mut self.varied).zip(&self.sums) {
            *total += square;
            *varied += square;
        }
    }

    /// 1/√V; 0 without texture.
    fn scale(&mut self, zero_mean: bool) {
        self.scale.clear();
        let both = self.varied.iter().zip(&self.squares);
        self.scale.extend(both.map(|(varied, squares)| match *varied > FLAT * squares {
            true if zero_mean => varied.sqrt().recip(),
            textured => f64::from(u8::from(textured)),
        }));
    }
}

/// Sums of `width` neighbours: of every block of as many those to its end, then, of the next one, from its start.
fn box_sum(x: &[f64], width: usize, sums: &mut Vec<f64>) {
    sums.clear();
    sums.resize((x.len() + 1).saturating_sub(width), 0.0);
    for from in (0..sums.len()).step_by(width) {
        let mut sum = 0.0;
        for i in (from..from + width).rev() {
            sum += x[i];
            if let Some(to) = sums.get_mut(i) {
                *to = sum;
            }
        }
        let mut sum = 0.0;
        for (to, x) in sums.iter_mut().skip(from + 1).take(width - 1).zip(x.iter().skip(from + width)) {
            sum += x;
            *to += sum;
        }
    }
}

dispatched! {
    /// [`box_sum`] over columns of disparities.
    fn box_sums<'a>(x: &'a [Chunk], lanes: usize, width: usize, sums: &'a mut [Chunk]) {
        let windows = sums.len() / lanes;
        for from in (0..windows).step_by(width) {
            let here = width.min(windows - from);
            for lane in 0..lanes {
                let mut sum: Chunk = [0.0; LANES];
                for i in (0..width).rev() {
                    let x = x[(from + i) * lanes + lane];
                    sum = std::array::from_fn(|k| sum[k] + x[k]);
                    if i < here {
                        sums[(from + i) * lanes + lane] = sum;
                    }
                }
                let mut sum: Chunk = [0.0; LANES];
                for i in 1..here {
                    let x = x[(from + width + i - 1) * lanes + lane];
                    sum = std::array::from_fn(|k| sum[k] + x[k]);
                    let to = &mut sums[(from + i) * lanes + lane];
                    let old = *to;
                    *to = std::array::from_fn(|k| old[k] + sum[k]);
                }
            }
        }
    }
}

/// The disparities of column i in a mirrored list, of whose own columns there are n.
#[inline(always)]
fn disparities(mirrored: &[f64], n: usize, i: usize, lanes: usize) -> &[Chunk] {
    mirrored[n - 1 - i..].as_chunks::<LANES>().0.get(..lanes).unwrap_or(&[])
}

dispatched! {
    /// factor·L R of every column and disparity onto what is there.
    fn add_products<'a>(
        to: &'a mut [Chunk], lanes: usize, left: &'a [f64], mirrored: &'a [f64], factor: f64,
    ) {
        for (i, (to, x)) in to.chunks_exact_mut(lanes).zip(left).enumerate() {
            for (to, right) in to.iter_mut().zip(disparities(mirrored, left.len(), i, lanes)) {
                *to = fused(factor * x, *right, *to);
            }
        }
    }
}

dispatched! {
    /// Covariances to correlations.
    fn scale_scores<'a>(to: &'a mut [Chunk], lanes: usize, left: &'a [f64], mirrored: &'a [f64]) {
        for (i, (to, x)) in to.chunks_exact_mut(lanes).zip(left).enumerate() {
            for (to, right) in to.iter_mut().zip(disparities(mirrored, left.len(), i, lanes)) {
                let old = *to;
                *to = std::array::from_fn(|k| old[k] * x * right[k]);
            }
        }
    }
}

dispatched! {
    /// 2Σ LR − Σ L² − Σ R².
    fn take_squares<'a>(to: &'a mut [Chunk], lanes: usize, left: &'a [f64], mirrored: &'a [f64]) {
        for (i, (to, x)) in to.chunks_exact_mut(lanes).zip(left).enumerate() {
            for (to, right) in to.iter_mut().zip(disparities(mirrored, left.len(), i, lanes)) {
                let old = *to;
                *to = std::array::from_fn(|k| 2.0 * old[k] - x - right[k]);
            }
        }
    }
}
