//! The loops over samples with the central difference and variances per band, straight from the rows as stored.
//!
//! Everything that a row of pixels gives is made in one loop over its columns: a column is widened, added up and
//! checked while it is in registers, and the quotients of the one before follow. The sums over small windows
//! ([`MOST_ROWS`] × [`MOST_COLUMNS`] at most) are plain sums of their rows and columns, in that order: with so few
//! terms they take less time than sums in two levels ([`super::boxes`]), which have to be written and read again.

use super::boxes::{chunks, chunks_mut};
use super::kernels::{Quotients, Seen, minus, plus, square, stride};
use super::limits::MOST;
use crate::cube::Sample;
use crate::simd::{Chunk, LANES, dispatched, fold_all};

/// Highest window that is summed row by row.
pub(super) const MOST_ROWS: usize = 9;

/// Widest window that is summed column by column.
pub(super) const MOST_COLUMNS: usize = 9;

/// Room for what the lanes of the columns of a row come to.
#[derive(Debug, Default)]
pub(super) struct Lanes {
    totals: Vec<Chunk>,
    ratios: Vec<Chunk>,
}

/// Columns of a row as stored, the first of which begins at `samples[0]`; what follows the last is not used.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stretch<'a, S> {
    pub(super) samples: &'a [S],
    pub(super) bands: usize,
}

/// What a row of pixels gives.
pub(super) struct Pixels<'a> {
    /// Variances of the bands, in whole vectors.
    pub(super) var: &'a [f64],
    /// The samples of all columns, widened, [column][`stride`].
    pub(super) wide: &'a mut [f64],
    /// Σ_b N of all columns.
    pub(super) totals: &'a mut [f64],
    /// Σ_b (∂N)²/(N + σ²), of all columns but the first and the last; empty if not wanted.
    pub(super) ratios: &'a mut [f64],
    pub(super) lanes: &'a mut Lanes,
}

/// The last vector of a column, with samples of the next one or, at the end of the rows, repeated ones behind its own.
#[inline(always)]
pub(super) fn last<'a, S: Sample>(
    column: &'a [S],
    bands: usize,
    spare: &'a mut [S; LANES],
) -> &'a [S; LANES] {
    let start = bands - bands % LANES;
    match column[start..].first_chunk::<LANES>() {
        Some(chunk) => chunk,
        None => {
            *spare = repeated(&column[start..bands]);
            spare
        }
    }
}

/// Fewer than [`LANES`] samples, and the last one again. Never inlined: it would keep the loops from whole vectors.
#[cold]
#[inline(never)]
fn repeated<S: Sample>(own: &[S]) -> [S; LANES] {
    std::array::from_fn(|i| own[i.min(own.len() - 1)])
}

/// Which lanes of the last vector are bands.
#[inline(always)]
fn keep(bands: usize) -> [bool; LANES] {
    std::array::from_fn(|i| i < bands % LANES)
}

#[inline(always)]
fn kept(x: Chunk, keep: [bool; LANES]) -> Chunk {
    // No product: NaN of the next column would stay.
    std::array::from_fn(|i| if keep[i] { x[i] } else { 0.0 })
}

#[inline(always)]
fn pixels<S: Sample>(of: Stretch<'_, S>, to: Pixels<'_>) -> Seen {
    let Stretch { samples, bands } = of;
    let Pixels { var, wide, totals, ratios, lanes } = to;
    let (stride, keep) = (stride(bands), keep(bands));
    lanes.totals.resize(totals.len(), [0.0; LANES]);
    lanes.ratios.resize(ratios.len(), [0.0; LANES]);
    let (mut least, mut spare) = ([f64::INFINITY; LANES], [S::zeroed(); LANES]);
    let mut see = |x: Chunk| {
        let so_far = least;
        least = std::array::from_fn(|i| if x[i] < so_far[i] { x[i] } else { so_far[i] });
    };
    for (x, lane) in lanes.totals.iter_mut().enumerate() {
        let column = &samples[x * bands..];
        let (before, to) = wide.split_at_mut(x * stride);
        let own = &mut to[..stride];
        let mut to = chunks_mut(own);
        let mut total = [0.0; LANES];
        for (from, to) in column[..bands].as_chunks::<LANES>().0.iter().zip(to.by_ref()) {
            let counts = from.map(Into::into);
            see(counts);
            total = plus(total, counts);
            *to = counts;
        }
        if let Some(to) = to.next() {
            let counts = last(column, bands, &mut spare).map(Into::into);
            see(counts);
            let counts = kept(counts, keep);
            total = plus(total, counts);
            *to = counts;
        }
        *lane = total;
        let Some(ratio) = x.checked_sub(2).and_then(|x| lanes.ratios.get_mut(x)) else { continue };
        let before = &before[(x - 2) * stride..];
        let middle = chunks(&before[stride..]).zip(chunks(var));
        let ends = chunks(&before[..stride]).zip(chunks(own));
        let mut quotients = Quotients::new();
        for ((count, var), (left, right)) in middle.zip(ends) {
            quotients.add(square(minus(*right, *left)), plus(*count, *var));
        }
        *ratio = quotients.sum();
    }
    fold_all(&lanes.totals, 1.0, totals);
    fold_all(&lanes.ratios, 0.25, ratios);
    // A sum of counts that are not negative is within bounds only if all of them are.
    let least = least.iter().fold(f64::INFINITY, |least, x| x.min(least));
    Seen { sound: least >= 0.0 && totals.iter().all(|total| *total <= MOST), least }
}

/// Σ over `H` rows, `row_len` samples apart.
#[inline(always)]
fn row_sums<S: Sample, const H: usize>(of: Stretch<'_, S>, row_len: usize, to: &mut [f64]) {
    let Stretch { samples, bands } = of;
    let (keep, mut spare) = (keep(bands), [S::zeroed(); LANES]);
    for (x, to) in to.chunks_exact_mut(stride(bands)).enumerate() {
        let (mut columns, mut whole) = ([samples; H], [samples.as_chunks::<LANES>().0; H]);
        for (row, (column, whole)) in columns.iter_mut().zip(&mut whole).enumerate() {
            *column = &samples[row * row_len + x * bands..];
            *whole = column[..bands].as_chunks().0;
        }
        let mut to = chunks_mut(to);
        for (i, to) in (0..bands / LANES).zip(to.by_ref()) {
            let mut sum: Chunk = whole[0][i].map(Into::into);
            for row in &whole[1..] {
                sum = plus(sum, row[i].map(Into::into));
            }
            *to = sum;
        }
        if let Some(to) = to.next() {
            let mut sum: Chunk = last(columns[0], bands, &mut spare).map(Into::into);
            for column in &columns[1..] {
                sum = plus(sum, last(column, bands, &mut spare).map(Into::into));
            }
            *to = kept(sum, keep);
        }
    }
}

#[inline(always)]
fn rows_of_windows<S: Sample>(of: Stretch<'_, S>, row_len: usize, height: usize, to: &mut [f64]) {
    match height {
        1 => row_sums::<S, 1>(of, row_len, to),
        3 => row_sums::<S, 3>(of, row_len, to),
        5 => row_sums::<S, 5>(of, row_len, to),
        7 => row_sums::<S, 7>(of, row_len, to),
        _ => row_sums::<S, MOST_ROWS>(of, row_len, to),
    }
}

/// The loops that read samples of one kind.
pub(super) trait Direct: Sample {
    /// What a row of pixels gives.
    fn pixels(of: Stretch<'_, Self>, to: Pixels<'_>) -> Seen;

    /// Σ over the rows of a window, each `row_len` samples after the one before, [column][`stride`].
    fn rows(of: Stretch<'_, Self>, row_len: usize, height: usize, to: &mut [f64]);
}

macro_rules! direct {
    ($sample:ty, $pixels:ident, $rows:ident) => {
        dispatched! {
            fn $pixels<'a>(of: Stretch<'a, $sample>, to: Pixels<'a>) -> Seen {
                pixels(of, to)
            }
        }

        dispatched! {
            fn $rows<'a>(of: Stretch<'a, $sample>, row_len: usize, height: usize, to: &'a mut [f64]) -> () {
                rows_of_windows(of, row_len, height, to);
            }
        }

        impl Direct for $sample {
            fn pixels(of: Stretch<'_, Self>, to: Pixels<'_>) -> Seen {
                $pixels(of, to)
            }

            fn rows(of: Stretch<'_, Self>, row_len: usize, height: usize, to: &mut [f64]) {
                $rows(of, row_len, height, to);
            }
        }
    };
}

direct!(f32, pixels_f32, rows_f32);
direct!(f64, pixels_f64, rows_f64);

#[inline(always)]
fn window_ratios<const W: usize>(row: &[f64], var: &[f64], lanes: &mut [Chunk]) {
    let stride = var.len();
    for (x, lanes) in lanes.iter_mut().enumerate() {
        let column = |x: usize| row[x * stride..(x + 1) * stride].as_chunks::<LANES>().0;
        let mut inside = [column(x); W];
        for (i, inside) in inside.iter_mut().enumerate() {
            *inside = column(x + 1 + i);
        }
        let ends = column(x).iter().zip(column(x + W + 1)).zip(chunks(var));
        let mut quotients = Quotients::new();
        for (i, ((left, right), var)) in ends.enumerate() {
            let mut sum = inside[0][i];
            for column in &inside[1..] {
                sum = plus(sum, column[i]);
            }
            let inner = minus(inside[W - 1][i], inside[0][i]);
            quotients.add(square(plus(inner, minus(*right, *left))), plus(sum, *var));
        }
        *lanes = quotients.sum();
    }
}

dispatched! {
    /// Σ_b (Σ_p ∂N)²/Σ_p (N + σ²) of windows of `width` columns: a central difference leaves only their ends. `row` holds
    /// the sums over the rows of the windows, of their columns and one more on either side; `var` Σ_p σ², in whole
    /// vectors.
    pub(super) fn windows<'a>(
        row: &'a [f64], width: usize, var: &'a [f64], lanes: &'a mut Lanes, to: &'a mut [f64]
    ) -> () {
        lanes.ratios.resize(to.len(), [0.0; LANES]);
        match width {
            1 => window_ratios::<1>(row, var, &mut lanes.ratios),
            3 => window_ratios::<3>(row, var, &mut lanes.ratios),
            5 => window_ratios::<5>(row, var, &mut lanes.ratios),
            7 => window_ratios::<7>(row, var, &mut lanes.ratios),
            _ => window_ratios::<MOST_COLUMNS>(row, var, &mut lanes.ratios),
        }
        fold_all(&lanes.ratios, 0.25, to);
    }
}
