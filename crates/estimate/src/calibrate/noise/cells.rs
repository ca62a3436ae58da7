//! Sums of squared differences in bins of the mean, in interleaved groups.

use super::start::{BINS, Start};
use hadar::cube::{Rows, Sample};
use hadar::error::Result;
use rayon::prelude::*;

/// Groups of a jackknife.
pub(super) const GROUPS: usize = 32;
/// Parts of the rows that are gathered at the same time; sums do not depend on threads.
const PARTS: usize = 16;

/// Sums of the differences of a bin.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Cell {
    /// Degrees of freedom.
    pub(super) dof: f64,
    /// Sum of means.
    pub(super) mean: f64,
    /// Sum of squared deviations.
    pub(super) square: f64,
    /// Sums of products with the bands beside, and of these with each other.
    pub(super) with: [f64; 3],
    /// Squares of those two.
    pub(super) beside: [f64; 2],
}

impl Cell {
    pub(super) fn add(&mut self, other: &Self) {
        self.dof += other.dof;
        self.mean += other.mean;
        self.square += other.square;
        self.with.iter_mut().zip(&other.with).for_each(|(own, other)| *own += other);
        self.beside.iter_mut().zip(&other.beside).for_each(|(own, other)| *own += other);
    }

    /// Variance of texture by the products with the bands beside, `scale` their mean signal over this band's; how is decided by the
    /// `whole` of the groups.
    pub(super) fn texture(&self, whole: &Self, told: f64, scale: [f64; 2]) -> f64 {
        let [a, b, ab] = self.with.map(|sum| sum / self.dof);
        let spread = (whole.beside[0] * whole.beside[1] / whole.dof).sqrt();
        if whole.with[2] > told * spread { a * b / ab } else { 0.5 * (a / scale[0] + b / scale[1]) }
    }
}

/// All sums.
#[derive(Debug, Clone)]
pub(super) struct Cells {
    bands: usize,
    cells: Vec<Cell>,
    /// Sum and number of all samples of each band that are there, above the dark level.
    all: Vec<[f64; 2]>,
    pub(super) outliers: f64,
    pub(super) uneven: f64,
    pub(super) even: f64,
}

impl Cells {
    fn new(bands: usize) -> Self {
        let cells = vec![Cell::default(); bands * BINS * GROUPS];
        let all = vec![[0.0; 2]; bands];
        Self { bands, cells, all, outliers: 0.0, uneven: 0.0, even: 0.0 }
    }

    fn add(&mut self, other: &Self) {
        self.cells.iter_mut().zip(&other.cells).for_each(|(own, other)| own.add(other));
        self.all.iter_mut().flatten().zip(other.all.iter().flatten()).for_each(|(own, other)| *own += other);
        self.outliers += other.outliers;
        self.uneven += other.uneven;
        self.even += other.even;
    }

    pub(super) fn bands(&self) -> usize {
        self.bands
    }

    pub(super) fn count(&self) -> f64 {
        self.cells.iter().map(|cell| cell.dof).sum()
    }

    /// The bins of a band, without one group.
    pub(super) fn bins(&self, band: usize, without: Option<usize>) -> Vec<Cell> {
        let own = self.cells.chunks(BINS * GROUPS).nth(band).unwrap_or_default();
        own.chunks(GROUPS)
            .map(|groups| {
                let mut sum = Cell::default();
                for (group, cell) in groups.iter().enumerate() {
                    if Some(group) != without {
                        sum.add(cell);
                    }
                }
                sum
            })
            .collect()
    }

    /// Mean of all samples of a band above the dark level, compared or not, and their number.
    pub(super) fn of_all(&self, band: usize) -> [f64; 2] {
        let [sum, count] = self.all.get(band).copied().unwrap_or_default();
        [sum / count, count]
    }

    /// Notes all samples of a row of one frame.
    fn note<S: Sample>(&mut self, row_of: &[S], dark_level: f64) {
        for pixel in row_of.chunks_exact(self.bands) {
            for (sample, [sum, count]) in pixel.iter().zip(self.all.iter_mut().map(|all| all.each_mut())) {
                let sample: f64 = (*sample).into();
                if sample.is_finite() {
                    *sum += sample - dark_level;
                    *count += 1.0;
                }
            }
        }
    }

    fn signal(&self, band: usize) -> f64 {
        let bins = self.bins(band, None);
        bins.iter().map(|bin| bin.mean).sum::<f64>() / bins.iter().map(|bin| bin.dof).sum::<f64>().max(1.0)
    }

    /// Mean signals of the two bands beside one, over its own.
    pub(super) fn beside(&self, band: usize) -> [f64; 2] {
        let own = self.signal(band);
        beside(band, self.bands).map(|other| self.signal(other) / own)
    }
}

/// The two bands that are nearest to one.
fn beside(band: usize, bands: usize) -> [usize; 2] {
    match band {
        0 => [1, 2.min(bands - 1)],
        last if last + 1 == bands => [last - 1, last.saturating_sub(2)],
        band => [band - 1, band + 1],
    }
}

/// Gathers all samples.
pub(super) fn gathered<S: Sample>(frames: &[&dyn Rows<S>], start: &Start) -> Result<Cells> {
    let shape = frames[0].shape();
    let (rows, bands) = (shape.rows(), shape.bands());
    let parts: Vec<Cells> = (0..PARTS.min(rows))
        .into_par_iter()
        .map(|part| {
            let (first, last) = (part * rows / PARTS.min(rows), (part + 1) * rows / PARTS.min(rows));
            let mut cells = Cells::new(bands);
            let mut buffers = vec![Vec::new(); frames.len()];
            for row in first..last {
                let mut read = Vec::with_capacity(frames.len());
                for (frame, buffer) in frames.iter().zip(&mut buffers) {
                    read.push(frame.read(row..row + 1, buffer)?);
                }
                read.iter().for_each(|samples| cells.note(samples, start.dark_level));
                match read.as_slice() {
                    [one] => cells.neighbours(one, row, start),
                    several => cells.frames(several, row, start),
                }
            }
            Ok(cells)
        })
        .collect::<Result<_>>()?;
    let mut sum = Cells::new(bands);
    parts.iter().for_each(|part| sum.add(part));
    Ok(sum)
}

impl Cells {
    /// Samples of a row in several frames.
    fn frames<S: Sample>(&mut self, frames: &[&[S]], row: usize, start: &Start) {
        let dof = frames.len() as f64 - 1.0;
        let bands = self.bands;
        for (i, first) in frames[0].iter().enumerate() {
            let (column, band) = (i / bands, i % bands);
            let (mut mean, mut square) = ((*first).into(), 0.0);
            for (k, frame) in frames.iter().enumerate().skip(1) {
                let value: f64 = frame[i].into();
                let off = value - mean;
                mean += off / (k as f64 + 1.0);
                square += off * (value - mean);
            }
            let mean = mean - start.dark_level;
            // A sample that is missing makes the sum so.
            if !square.is_finite() {
                continue;
            }
            if square / dof > start.most(band, mean) {
                self.outliers += dof;
                continue;
            }
            let group = (row * 7 + column) % GROUPS;
            let cell = &mut self.cells[(band * BINS + start.bin(band, mean)) * GROUPS + group];
            cell.dof += dof;
            cell.mean += dof * mean;
            cell.square += square;
        }
    }

    /// Pairs of neighbours of a row.
    fn neighbours<S: Sample>(&mut self, row_of: &[S], row: usize, start: &Start) {
        let bands = self.bands;
        let mut d = vec![0.0; bands];
        for (pair, samples) in row_of.chunks_exact(2 * bands).enumerate() {
            let (left, right) = samples.split_at(bands);
            let (mut bright, mut sum) = (0.0, 0.0);
            for ((d, left), right) in d.iter_mut().zip(left).zip(right) {
                let (left, right): (f64, f64) = ((*left).into(), (*right).into());
                *d = (left - right) * std::f64::consts::FRAC_1_SQRT_2;
                bright += left + right;
                sum += *d;
            }
            if !sum.is_finite() {
                continue;
            }
            let group = (row * 7 + pair) % GROUPS;
            for band in 0..bands {
                let [a, b] = beside(band, bands).map(|band| d[band]);
                // The noise of none of the three has a say in what is alike.
                if !start.even(bright, (sum - d[band] - a - b).abs()) {
                    self.uneven += 1.0;
                    continue;
                }
                self.even += 1.0;
                let (left, right): (f64, f64) = (left[band].into(), right[band].into());
                let mean = 0.5 * (left + right) - start.dark_level;
                let square = d[band] * d[band];
                if square > start.most(band, mean) {
                    self.outliers += 1.0;
                    continue;
                }
                let cell = &mut self.cells[(band * BINS + start.bin(band, mean)) * GROUPS + group];
                cell.dof += 1.0;
                cell.mean += mean;
                cell.square += square;
                cell.with[0] += d[band] * a;
                cell.with[1] += d[band] * b;
                cell.with[2] += a * b;
                cell.beside[0] += a * a;
                cell.beside[1] += b * b;
            }
        }
    }
}
