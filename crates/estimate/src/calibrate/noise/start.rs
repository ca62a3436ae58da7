//! A first look at some rows: the range of the means, how large a difference may be, which neighbours are alike.

use hadar::cube::{Rows, Sample};
use hadar::error::{Error, Result};
use hadar::order;

/// Bins of the mean of each band, at most.
pub(super) const BINS: usize = 24;
/// Rows that are looked at.
const ROWS: usize = 24;
/// Deviations beyond which a difference is an outlier.
const OUTLIER: f64 = 6.0;
/// Differences of a bin, about.
const OF_BIN: usize = 150;
/// Levels at which the scatter is looked at.
const LEVELS: usize = 8;
/// Median of χ² of one degree of freedom.
const MEDIAN: f64 = 0.454_936;

/// What was seen.
#[derive(Debug, Clone)]
pub(super) struct Start {
    pub(super) dark_level: f64,
    /// Bins of a band that are in use.
    bins: usize,
    /// Highest brightness of a level, and the largest difference of all other bands together of its neighbours that are alike.
    even: Vec<[f64; 2]>,
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
        sums.retain(|[bright, sum]| bright.is_finite() && sum.is_finite());
        order::ascending(&mut sums, |a| a[0]);
        let per_level = sums.len().div_ceil(LEVELS).max(1);
        let even = sums.chunks(per_level).map(|level| {
            let mut differences: Vec<f64> = level.iter().map(|pair| pair[1]).collect();
            [level.last().map_or(f64::INFINITY, |pair| pair[0]), median(&mut differences)]
        });
        let even = even.collect();
        let (mut range, mut levels) = (Vec::new(), Vec::new());
        for mut seen in seen {
            order::ascending(&mut seen, |a| a[0]);
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
        let pixels = shape.rows() * shape.columns();
        let differences = if frames.len() > 1 { pixels * (frames.len() - 1) } else { pixels / 4 };
        let bins = (differences / OF_BIN).clamp(3, BINS);
        Ok(Self { dark_level, bins, even, range, levels })
    }

    /// Whether neighbours are of the more even half of those that are as bright: noise grows with light, so that one limit for all would
    /// leave out what is bright.
    pub(super) fn even(&self, bright: f64, sum: f64) -> bool {
        let level = self.even.iter().find(|level| bright <= level[0]).or(self.even.last());
        level.is_none_or(|level| sum <= level[1])
    }

    /// The bin of a mean.
    pub(super) fn bin(&self, band: usize, mean: f64) -> usize {
        let [low, high] = self.range[band];
        let place = (mean - low) / (high - low) * self.bins as f64;
        // What is below goes to the first, NaN of a band of one level too.
        (place as usize).min(self.bins - 1)
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

/// Notes mean and squared difference of two pixels, band by band; their brightness and the absolute sum of the differences.
fn pairs<S: Sample>(left: &[S], right: &[S], dark_level: f64, seen: &mut [Vec<[f64; 2]>]) -> [f64; 2] {
    let (mut bright, mut sum) = (0.0, 0.0);
    for ((left, right), seen) in left.iter().zip(right).zip(seen) {
        let (left, right): (f64, f64) = ((*left).into(), (*right).into());
        let d = (left - right) * std::f64::consts::FRAC_1_SQRT_2;
        bright += left + right;
        sum += d;
        if d.is_finite() {
            seen.push([0.5 * (left + right) - dark_level, d * d]);
        }
    }
    [bright, sum.abs()]
}

fn median(values: &mut [f64]) -> f64 {
    let middle = values.len() / 2;
    match values.is_empty() {
        true => 0.0,
        false => *values.select_nth_unstable_by(middle, f64::total_cmp).1,
    }
}
