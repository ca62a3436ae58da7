//! Bad pixels of pictures of which nothing is known but how many counts a unit is: what [`super::cube_bad`] finds, without a temperature
//! to say what can be sent. The picture itself is the reference, by medians and order statistics that single pixels do not move.
//!
//! | code | name | a pixel |
//! |---|---|---|
//! | 1 | missing | a sample of which is no number, or infinite |
//! | 2 | dead | all samples of which are 0, while the median pixel of the picture holds 600 counts |
//! | 3 | stuck | all samples of which are one value, which noise would do once in 10⁹ pixels at most, in a picture few pixels of which are so |
//! | 7 | outlier | a sample n of which lies beyond those of the 5 × 5 pixels around it: n > h + 3(h − l) + 10 √(h + σ²), or n < l − 3(h − l) − 10 √(l + σ²), or n ≤ 0 where l > 10 √(l + σ²) |
//!
//! h and l are the third largest and the third smallest of the (up to 24) samples around it in the same band, counts; σ² is the variance of
//! the electronic noise, counts². Two bad pixels near each other therefore do not hide each other, and one that is spoilt moves h and l to
//! the next sample at most. A thing of one or two pixels, alone and far brighter than what is around it, cannot be told from a hot pixel and
//! is left out too: what rests on it alone is then not claimed. What is cut off is not looked for: expected counts have flat parts.

use super::cube_bad::{BadFound, BadPixels, NAMES};
use super::cube_sample::{LOOKED, some};
use hadar::cube::{Cube, MemoryCube, Rows, Sample, Shape};
use hadar::error::Result;
use hadar::parallel;
use std::collections::BTreeMap;

/// Counts of the median pixel beside which another does not hold none at all: a twentieth of them would be missed by e⁻³⁰.
const BRIGHT: f64 = 600.0;
/// Probability that noise makes all samples of a pixel the same.
const BY_CHANCE: f64 = 1e-9;
/// Of so many pixels one may have one value in all bands: where more have, the picture is made so.
const FLAT: usize = 16;
/// Rows and columns around a pixel that it is held against.
const AROUND: usize = 2;
/// Samples on either side that are not believed: with them, bad pixels come in threes before they hide each other.
const DISBELIEVED: usize = 2;
/// Fewer samples around a pixel say nothing of it.
const SAYING: usize = 8;
/// Times the spread of what is around it, and deviations of its noise, by which an outlier lies beyond.
const SPREADS: f64 = 3.0;
const DEVIATIONS: f64 = 10.0;
/// Rows that are read at a time.
const ROWS: usize = 32;

/// What is known of a picture.
#[derive(Debug)]
pub(super) struct Picture<'a> {
    /// Counts that one unit of the file is.
    pub(super) counts_per_unit: f64,
    /// Variance of the electronic noise in each band, counts²; the last holds for bands beyond, none where it is not known.
    pub(super) var_added: &'a [f64],
    /// Whether only what is missing is bad.
    pub(super) keeps: bool,
}

/// What the pixels looked at say of all.
#[derive(Debug, Clone, Copy)]
struct Habit {
    is_bright: bool,
    is_flat: bool,
}

impl Picture<'_> {
    pub(super) fn find(&self, cube: &Cube) -> Result<BadFound> {
        match cube {
            Cube::F32(rows) => self.find_in(rows.as_ref()),
            Cube::F64(rows) => self.find_in(rows.as_ref()),
        }
    }

    fn find_in<S: Sample>(&self, cube: &dyn Rows<S>) -> Result<BadFound> {
        let shape = cube.shape();
        let habit = self.habit(&some(cube, LOOKED)?);
        let of_block = |buffer: &mut Vec<S>, block: usize| -> Result<Vec<u8>> {
            let own = block * ROWS..((block + 1) * ROWS).min(shape.rows());
            let first = own.start.saturating_sub(AROUND);
            let samples = cube.read(first..(own.end + AROUND).min(shape.rows()), buffer)?;
            let mut codes = Vec::with_capacity(own.len() * shape.columns());
            for row in own {
                hadar::stop::check();
                let all = (0..shape.columns())
                    .map(|column| self.code(samples, shape, [row - first, column], habit));
                codes.extend(all);
            }
            Ok(codes)
        };
        let map = parallel::try_map_with(shape.rows().div_ceil(ROWS), Vec::new, of_block)?.concat();
        let mut counts: BTreeMap<u8, usize> = BTreeMap::new();
        map.iter().filter(|code| **code > 0).for_each(|code| *counts.entry(*code).or_default() += 1);
        let of = |(code, pixels): (u8, usize)| {
            let why = NAMES.get(usize::from(code) - 1)?;
            Some(BadPixels { why, code, pixels })
        };
        let pixels: Vec<BadPixels> = counts.into_iter().filter_map(of).collect();
        let map = if pixels.is_empty() { Vec::new() } else { map };
        Ok(BadFound { bands: Vec::new(), map, pixels })
    }

    fn habit<S: Sample>(&self, looked: &MemoryCube<S>) -> Habit {
        let pixels = || looked.samples().chunks(looked.shape().bands());
        let mut sums: Vec<f64> = pixels().map(|pixel| pixel.iter().map(|one| (*one).into()).sum()).collect();
        sums.retain(|sum: &f64| !sum.is_nan());
        let middle = sums.len() / 2;
        let median = match sums.is_empty() {
            true => 0.0,
            false => *sums.select_nth_unstable_by(middle, f64::total_cmp).1,
        };
        let is_flat =
            |pixel: &&[S]| pixel.first() != Some(&S::of(0.0)) && pixel.windows(2).all(|two| two[0] == two[1]);
        let flat = pixels().filter(is_flat).count();
        Habit { is_bright: median * self.counts_per_unit >= BRIGHT, is_flat: FLAT * flat > pixels().count() }
    }

    /// The code of the pixel at a row and column of some rows.
    fn code<S: Sample>(&self, samples: &[S], shape: Shape, [row, column]: [usize; 2], habit: Habit) -> u8 {
        let (columns, bands) = (shape.columns(), shape.bands());
        let at = (row * columns + column) * bands;
        let Some(pixel) = samples.get(at..at + bands) else { return 0 };
        let value = |band: usize| -> f64 { pixel[band].into() };
        if (0..bands).any(|band| !value(band).is_finite()) {
            return 1;
        }
        if self.keeps {
            return 0;
        }
        let first = value(0);
        if (1..bands).all(|band| value(band) == first) {
            if first == 0.0 {
                return if habit.is_bright { 2 } else { 0 };
            }
            let counts = (first * self.counts_per_unit).abs();
            // The most probable value of counts of mean n has the probability 1/√(2πn).
            let same = |band: usize| {
                (1.0 / (std::f64::consts::TAU * (counts + self.var(band))).sqrt()).min(1.0).ln()
            };
            if !habit.is_flat && (1..bands).map(same).sum::<f64>() < BY_CHANCE.ln() {
                return 3;
            }
        }
        let rows = samples.len() / shape.row_len();
        let around = |band: usize| {
            let near = row.saturating_sub(AROUND)..(row + AROUND + 1).min(rows);
            near.flat_map(move |y| {
                let near = column.saturating_sub(AROUND)..(column + AROUND + 1).min(columns);
                near.filter(move |x| (y, *x) != (row, column)).map(move |x| (y * columns + x) * bands + band)
            })
        };
        let is_beyond = |band: usize| {
            let own = value(band);
            let other = |i: usize| samples.get(i).map_or(f64::NAN, |one| (*one).into());
            // Most samples are within what is around them: a few of the others say so.
            let (mut above, mut below) = (0, 0);
            for other in around(band).map(other) {
                above += usize::from(other >= own);
                below += usize::from(other <= own);
                if above > DISBELIEVED && below > DISBELIEVED {
                    return false;
                }
            }
            let mut all: Vec<f64> = around(band).map(other).filter(|one| one.is_finite()).collect();
            if all.len() < SAYING {
                return false;
            }
            all.sort_by(f64::total_cmp);
            let counts = |i: usize| all[i] * self.counts_per_unit;
            let (low, high) = (counts(DISBELIEVED), counts(all.len() - 1 - DISBELIEVED));
            let sigma = |n: f64| (n.max(0.0) + self.var(band)).sqrt();
            let (own, spread) = (own * self.counts_per_unit, SPREADS * (high - low));
            // At an edge the spread is wide, but what is warm never sends nothing.
            let nothing = own <= 0.0 && low > DEVIATIONS * sigma(low);
            nothing
                || own > high + spread + DEVIATIONS * sigma(high)
                || own < low - spread - DEVIATIONS * sigma(low)
        };
        if (0..bands).any(is_beyond) { 7 } else { 0 }
    }

    fn var(&self, band: usize) -> f64 {
        self.var_added.get(band).or(self.var_added.last()).copied().unwrap_or(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const SHAPE: [usize; 3] = [20, 24, 4];

    /// A wall of one temperature with a warm edge, and shot noise of some kind: no random numbers, the same always.
    fn wall() -> Vec<f64> {
        let [rows, columns, bands] = SHAPE;
        let of = |i: usize| {
            let (x, band) = (i / bands % columns, i % bands);
            let level = if x < 12 { 5000.0 } else { 9000.0 } + 100.0 * band as f64;
            level + ((i * 7919 % 613) as f64 - 306.0) * 0.4
        };
        (0..rows * columns * bands).map(of).collect()
    }

    fn found(samples: Vec<f64>) -> Vec<(usize, u8)> {
        let [rows, columns, bands] = SHAPE;
        let cube =
            Cube::F64(Box::new(MemoryCube::new(Shape::new(rows, columns, bands).unwrap(), samples).unwrap()));
        let picture = Picture { counts_per_unit: 1.0, var_added: &[], keeps: false };
        let map = picture.find(&cube).unwrap().map;
        map.into_iter().enumerate().filter(|(_, code)| *code > 0).collect()
    }

    proptest! {
        /// Whatever is put into one pixel, it alone is found to be bad, beside those that are bad already; at an edge, what is not far beyond
        /// both its sides is not.
        #[test]
        fn a_spoilt_pixel_is_its_own(
            at in 0_usize..480,
            value in prop::sample::select(vec![0.0, f64::NAN, f64::INFINITY, -7.0, 1e36, 1e20, 65535.0, 13_000.0]),
            whole in any::<bool>(),
        ) {
            let mut samples = wall();
            // Two hot pixels near each other, and a dead one.
            samples[(5 * 24 + 6) * 4] = 40_000.0;
            samples[(6 * 24 + 7) * 4 + 2] = 41_000.0;
            samples[(15 * 24 + 18) * 4..][..4].fill(0.0);
            let before = found(samples.clone());
            prop_assert_eq!(before.iter().map(|one| one.1).collect::<Vec<_>>(), vec![7, 7, 2]);
            samples[at * 4..][..if whole { 4 } else { 1 }].fill(value);
            let after = found(samples);
            let is_at_edge = (10..14).contains(&(at % 24));
            prop_assert!(after.iter().any(|one| one.0 == at) || is_at_edge && value == 13_000.0);
            let others = |all: &[(usize, u8)]| all.iter().filter(|one| one.0 != at).copied().collect::<Vec<_>>();
            prop_assert_eq!(others(&after), others(&before));
        }
    }

    /// Pictures whose pixels have one value in all bands are made so, and a corner of a slope is none of its outliers.
    #[test]
    fn what_is_smooth_or_made_flat_is_good() {
        let [rows, columns, bands] = SHAPE;
        let flat: Vec<f64> = (0..rows * columns)
            .flat_map(|i| vec![1e9 * (1.0 + 0.1 * (0.5 * (i % columns) as f64).sin()); bands])
            .collect();
        assert!(found(flat).is_empty());
        let slope = (0..rows * columns * bands)
            .map(|i| 1e9 + 1e6 * (i / bands % columns + i / bands / columns) as f64);
        assert!(found(slope.collect()).is_empty());
    }
}
