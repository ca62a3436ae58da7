//! A first look at some rows: the range of the means, how large a difference may be, which neighbours are alike.

use super::cells::BINS;
use crate::error::{Error, Result};
use crate::ranging::cube::{Rows, Sample};

/// Rows that are looked at.
const ROWS: usize = 24;
/// Deviations beyond which a difference is an outlier.
const OUTLIER: f64 = 6.0;
/// Levels at which the scatter is looked at.
const LEVELS: usize = 8;
/// Median of χ² of one degree of freedom.
const MEDIAN: f64 = 0.454_936;

/// What was seen.
#[derive(Debug, Clone)]
pub(super) struct Start {
    pub(super) dark_level: f64,
    /// Largest difference of all other bands together of neighbours that are alike.
    pub(super) even: f64,
    /// Lowest and highest mean of each band.
    range: Vec<[f64; 2]>,
    /// Mean and variance at each level of each band, the lowest first.
    levels: Vec<[[f64; 2]; LEVELS]>,
}

impl Start {
    pub(super) fn new<S: Sample>(frames: &[&dyn Rows<S>], dark_level: f64) -> Result<Self> {
        let shape = frames[0].shape();
        let (bands, stride) = (shape.bands(), shape.rows().div_ceil(ROWS));
        let mut seen: Vec<Vec<[f64; 2]>> = vec![Vec::new(); bands];
        let mut sums = Vec::new();
        let (mut first, mut second) = (Vec::new(), Vec::new());
        for row in (0..shape.rows()).step_by(stride) {
            let one = frames[0].read(row..row + 1, &mut first)?;
            match frames.get(1) {
                None => {
                    for samples in one.chunks_exact(2 * bands) {
                        let (left, right) = samples.split_at(bands);
                        sums.push(pairs(left, right, dark_level, &mut seen));
                    }
                }
                Some(other) => {
                    let other = other.read(row..row + 1, &mut second)?;
                    for (left, right) in one.chunks(bands).zip(other.chunks(bands)) {
                        pairs(left, right, dark_level, &mut seen);
                    }
                }
            }
        }
        if seen.iter().all(Vec::is_empty) {
            return Err(Error::malformed(
                "no two samples that can be compared are both there",
                "give a cube with samples that are numbers",
            ));
        }
        if seen.iter().flatten().all(|pair| pair[1] == 0.0) {
            return Err(Error::malformed(
                "samples do not scatter at all: every one is the same as the one it is compared with",
                "give a cube as it was measured, frames that differ by their noise",
            ));
        }
        sums.retain(|sum| sum.is_finite());
        let even = match sums.is_empty() {
            true => f64::INFINITY,
            // The more even half.
            false => median(&mut sums),
        };
        let (mut range, mut levels) = (Vec::new(), Vec::new());
        for mut seen in seen {
            seen.sort_by(|a, b| a[0].total_cmp(&b[0]));
            let end = |pair: Option<&[f64; 2]>| pair.map_or(0.0, |pair| pair[0]);
            range.push([end(seen.first()), end(seen.last())]);
            levels.push(std::array::from_fn(|level| {
                let part = &seen[level * seen.len() / LEVELS..(level + 1) * seen.len() / LEVELS];
                let count = part.len().max(1) as f64;
                let mean = |of: usize| part.iter().map(|pair| pair[of]).sum::<f64>() / count;
                let mut squares: Vec<f64> = part.iter().map(|pair| pair[1]).collect();
                // Counts of a few photons have a median of their own: their mean tells more.
                [mean(0), (median(&mut squares) / MEDIAN).max(0.25 * mean(1))]
            }));
        }
        Ok(Self { dark_level, even, range, levels })
    }

    /// The bin of a mean.
    pub(super) fn bin(&self, band: usize, mean: f64) -> usize {
        let [low, high] = self.range[band];
        let place = (mean - low) / (high - low) * BINS as f64;
        // What is below goes to the first, NaN of a band of one level too.
        (place as usize).min(BINS - 1)
    }

    /// The largest squared difference that is no outlier.
    pub(super) fn most(&self, band: usize, mean: f64) -> f64 {
        let levels = &self.levels[band];
        let at = levels.iter().position(|level| level[0] >= mean);
        let variance = match at {
            Some(0) => levels[0][1],
            Some(i) => levels[i - 1][1].max(levels[i][1]),
            None => levels[LEVELS - 1][1] * (mean / levels[LEVELS - 1][0]).max(1.0).powi(2),
        };
        OUTLIER * OUTLIER * variance
    }
}

/// Notes mean and squared difference of two pixels, band by band; the absolute sum of the differences.
fn pairs<S: Sample>(left: &[S], right: &[S], dark_level: f64, seen: &mut [Vec<[f64; 2]>]) -> f64 {
    let mut sum = 0.0;
    for ((left, right), seen) in left.iter().zip(right).zip(seen) {
        let (left, right): (f64, f64) = ((*left).into(), (*right).into());
        let d = (left - right) * std::f64::consts::FRAC_1_SQRT_2;
        sum += d;
        if d.is_finite() {
            seen.push([0.5 * (left + right) - dark_level, d * d]);
        }
    }
    sum.abs()
}

fn median(values: &mut [f64]) -> f64 {
    let middle = values.len() / 2;
    match values.is_empty() {
        true => 0.0,
        false => *values.select_nth_unstable_by(middle, f64::total_cmp).1,
    }
}
