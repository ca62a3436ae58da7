//! What a request comes to, and its division into blocks of rows and strips of columns.

use super::direct::{MOST_COLUMNS, MOST_ROWS};
use super::kernels::stride;
use super::limits;
use super::request::{Cell, Request};
use crate::cube::Shape;
use crate::error::{Error, Result};
use crate::ranging::derivative::Derivative;
use crate::ranging::noise::{Joined, NoiseVariance};
use std::ops::Range;
use std::sync::Mutex;

/// Doubles of a strip that are to stay in a core's own cache.
const CACHE: usize = 1 << 15;

/// Doubles of a row of a strip that are to stay in the nearest cache.
const NEAR: usize = 1 << 11;

/// Samples of a window's rows that are to stay in a core's own cache.
const KEPT: usize = 1 << 18;

/// Rows of windows of a block.
const BLOCK_ROWS: usize = 64;

/// Windows of the blocks of all threads, some 60 bytes each.
const KEPT_WINDOWS: usize = 1 << 21;

/// Samples of the rows that a thread reads at a time, which are to stay in the cache that cores share.
const READ: usize = 1 << 21;

/// A request that fits its cube.
#[derive(Debug, Clone)]
pub(super) struct Plan<'a> {
    pub(super) request: &'a Request<'a>,
    pub(super) shape: Shape,
    pub(super) stride: usize,
    /// Columns at either end without a derivative.
    pub(super) margin: usize,
    /// First rows of the windows.
    pub(super) tops: Range<usize>,
    /// Variances of the bands; none if every sample has its own.
    pub(super) var_band: Vec<f64>,
    /// The same for whole vectors: what the quotients of single samples add to the counts.
    pub(super) var_sample: Vec<f64>,
    /// What the quotients of a band of a window add to its counts.
    pub(super) var_window: Vec<f64>,
}

impl<'a> Plan<'a> {
    pub(super) fn new(shape: Shape, request: &'a Request<'a>) -> Result<Self> {
        limits::variances(request.noise, shape)?;
        let window = request.window;
        let margin = request.derivative.margin();
        request.derivative.check_columns(shape.columns())?;
        if window.rows() > shape.rows() || window.columns() > shape.columns().saturating_sub(2 * margin) {
            let without = match margin {
                0 => String::new(),
                1 => ", of which 1 column at either end has no derivative".to_owned(),
                more => format!(", of which {more} columns at either end have no derivative"),
            };
            let [height, width] = [window.rows(), window.columns()];
            let found = format!(
                "a window of {height} x {width} pixels in an image of {} x {}{without}",
                shape.rows(),
                shape.columns()
            );
            return Err(Error::malformed(found, "give a smaller window or a larger image"));
        }
        let half = window.half_rows();
        let start = request.centres.start.max(half);
        let end = request.centres.end.min(shape.rows() - half).max(start);
        let bands = shape.bands();
        let var_band = match request.noise {
            NoiseVariance::None => vec![0.0; bands],
            NoiseVariance::Uniform(var) => vec![*var; bands],
            NoiseVariance::PerBand(var) => var.clone(),
            NoiseVariance::PerSample(_) => Vec::new(),
        };
        let stride = stride(bands);
        let mut plan = Self {
            request,
            shape,
            stride,
            margin,
            tops: start - half..end - half,
            var_sample: padded(&var_band, bands, stride, 1.0),
            var_window: Vec::new(),
            var_band,
        };
        let pixels = plan.pixels();
        plan.var_window = padded(&plan.var_band, bands, stride, pixels * plan.share(pixels));
        Ok(plan)
    }

    /// The same for some of the windows, whose first rows are given.
    pub(super) fn part(&self, tops: Range<usize>) -> Self {
        Self { tops, ..self.clone() }
    }

    /// Whether a cell is asked for.
    pub(super) fn wants(&self, cell: Cell) -> bool {
        self.request.cells.contains(&cell)
    }

    pub(super) fn central(&self) -> bool {
        self.request.derivative == Derivative::Central
    }

    /// Whether samples are worked on straight from the rows as stored: see [`super::direct`].
    pub(super) fn direct(&self) -> bool {
        self.central() && !self.var_band.is_empty()
    }

    /// Whether the sums over windows are, too.
    pub(super) fn direct_windows(&self) -> bool {
        self.direct() && self.small_windows()
    }

    /// Whether windows are summed row by row and column by column.
    pub(super) fn small_windows(&self) -> bool {
        let window = self.request.window;
        window.rows() <= MOST_ROWS && window.columns() <= MOST_COLUMNS
    }

    /// The part of Σσ² that counts where `joined` samples are.
    pub(super) fn share(&self, joined: f64) -> f64 {
        match self.request.joined {
            Joined::SumOfReadings => 1.0,
            Joined::OneReading => joined.recip(),
        }
    }

    /// Bands of a sample, and pixels of a window, as numbers of what is joined.
    pub(super) fn bands(&self) -> f64 {
        self.shape.bands() as f64
    }

    pub(super) fn pixels(&self) -> f64 {
        (self.request.window.rows() * self.request.window.columns()) as f64
    }

    /// Rows of pixels in any window.
    pub(super) fn rows(&self) -> Range<usize> {
        if self.tops.is_empty() {
            return self.tops.clone();
        }
        self.tops.start..self.tops.end + self.request.window.rows() - 1
    }

    /// Columns with a derivative.
    pub(super) fn inner(&self) -> Range<usize> {
        self.margin..self.shape.columns() - self.margin
    }

    /// Columns of the windows' centres.
    pub(super) fn centres(&self) -> Range<usize> {
        let (inner, half) = (self.inner(), self.request.window.half_columns());
        inner.start + half..inner.end - half
    }

    /// Rows of windows that a thread takes at a time: enough that the rows that blocks have in common count for little, not so many
    /// that what all threads keep of wide ones is too much, and as many blocks for every thread.
    pub(super) fn block_rows(&self) -> usize {
        let threads = rayon::current_num_threads();
        let kept = KEPT_WINDOWS / threads / self.centres().len().max(1);
        let least = BLOCK_ROWS.min(kept).max(4 * (self.request.window.rows() - 1)).max(1);
        let blocks = self.tops.len().div_ceil(least).next_multiple_of(threads);
        self.tops.len().div_ceil(blocks.max(1)).max(1)
    }

    /// Rows of windows whose rows are read at a time: beside them, as many as windows are high are read again.
    pub(super) fn read_rows(&self) -> usize {
        (READ / self.shape.row_len()).max(3 * (self.request.window.rows() - 1)).max(1)
    }

    /// Strips from left to right.
    pub(super) fn strips(&self) -> Vec<Strip> {
        let half = self.request.window.half_columns();
        let wide = if self.direct_windows() || self.direct() && !self.wants(Cell::Spectral) {
            (NEAR / self.stride).max(16)
        } else if self.wants(Cell::Spectral) {
            let columns = CACHE / (self.stride * self.request.window.rows());
            columns.max(4 * (half + 1)).max(16)
        } else {
            (CACHE / (4 * self.stride)).max(16)
        };
        self.strips_of(wide)
    }

    /// Strips that are worked on row by row together.
    pub(super) fn strips_together(&self) -> usize {
        if !self.direct_windows() {
            return 1;
        }
        let columns = KEPT / (self.shape.bands() * self.request.window.rows());
        columns.div_ceil((NEAR / self.stride).max(16))
    }

    /// Strips of at most `wide` columns of centres; all of them where the derivative needs whole rows.
    pub(super) fn strips_of(&self, wide: usize) -> Vec<Strip> {
        let centres = self.centres();
        let half = self.request.window.half_columns();
        let all = self.shape.columns();
        let wide = if self.central() { wide } else { centres.len() };
        let count = centres.len().div_ceil(wide).max(1);
        let cut = |i: usize| centres.start + centres.len() * i / count;
        (0..count)
            .map(|i| {
                let (start, end) = (cut(i), cut(i + 1));
                let (first, last) = (i == 0, i + 1 == count);
                let quotients = start - half..if last { end + half } else { end - half };
                let totals = if first { 0 } else { quotients.start }..if last { all } else { quotients.end };
                let right = if self.wants(Cell::Spectral) { end + half } else { quotients.end };
                let read = quotients.start - self.margin..right + self.margin;
                Strip { read, centres: start..end, quotients, totals }
            })
            .collect()
    }
}

fn padded(var: &[f64], bands: usize, stride: usize, factor: f64) -> Vec<f64> {
    let mut padded = vec![0.0; bands];
    for (to, var) in padded.iter_mut().zip(var) {
        *to = factor * var;
    }
    padded.resize(stride, 1.0);
    padded
}

/// Columns that are worked on together.
#[derive(Debug, Clone)]
pub(super) struct Strip {
    /// Columns that are read.
    pub(super) read: Range<usize>,
    /// Columns of the centres of its windows.
    pub(super) centres: Range<usize>,
    /// Columns whose quotients it computes.
    pub(super) quotients: Range<usize>,
    /// Columns whose sums over bands it computes.
    pub(super) totals: Range<usize>,
}

/// Runs jobs on all threads, each with room of its own, and gives the error of the first job that has one.
pub(super) fn run<J: Send, W: Default>(
    jobs: Vec<J>,
    work: impl Fn(J, &mut W) -> Result<()> + Sync,
) -> Result<()> {
    use rayon::prelude::*;
    let threads = rayon::current_num_threads().min(jobs.len()).max(1);
    let jobs = Mutex::new(jobs.into_iter().enumerate());
    let failed: Mutex<Option<(usize, Error)>> = Mutex::new(None);
    (0..threads).into_par_iter().with_max_len(1).for_each(|_| {
        let mut room = W::default();
        loop {
            crate::stop::check();
            // Jobs are begun in their order: those before one that failed are all begun.
            let Some((index, job)) = locked(&jobs).next() else { break };
            if locked(&failed).is_some() {
                break;
            }
            if let Err(error) = work(job, &mut room) {
                let mut failed = locked(&failed);
                if failed.as_ref().is_none_or(|(first, _)| index < *first) {
                    *failed = Some((index, error));
                }
            }
        }
    });
    locked(&failed).take().map_or(Ok(()), |(_, error)| Err(error))
}

fn locked<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
}
