//! Entropy of grey levels, in windows and of an image.
//!
//! H = log₂ n − Σ_k f(c_k)/n with f(c) = c log₂ c. When the window moves on by a pixel, one column leaves the histogram
//! and one enters: the cost grows with the window's height, not its area. f is a table of integers (f scaled by a
//! power of two), so that what is taken out of the sum is exactly what was put in, and a window of one level has
//! exactly 0 bit.
//!
//! Source: Huang, Yang, Tang, IEEE Trans. ASSP 27, 13 (1979).

use super::{Image, TextureMap};
use hadar::cube::MemoryCube;
use hadar::error::{Error, Result};
use hadar::ranging::information::Window;
use rayon::prelude::*;

/// Grey levels.
const LEVELS: usize = 256;

/// The entropy, bit, of the grey levels in every window that lies whole in an image of one band. The levels span
/// `range` (grey values of the first and the last; what lies beyond belongs to them) or else the image's own.
///
/// # Errors
/// More bands than one, a value that is not finite (or beyond 10¹⁴⁰), a range that does not rise, a window larger than
/// the image.
pub(crate) fn local_entropy(
    image: &MemoryCube<f64>,
    window: Window,
    range: Option<[f64; 2]>,
) -> Result<TextureMap> {
    let image = Image::of(image)?;
    let (rows, columns) = image.centres(window)?;
    let levels = levels(image, range)?;
    let table = Table::of(window.rows() * window.columns());
    let mut values = vec![0.0; rows.len() * columns.len()];
    values.par_chunks_mut(columns.len()).enumerate().for_each(|(top, values)| {
        let rows = &levels[top * image.columns..][..window.rows() * image.columns];
        let mut histogram = Histogram { counts: [0; LEVELS], sum: 0, table: &table };
        let column = |x: usize| rows.iter().skip(x).step_by(image.columns).copied();
        (0..window.columns()).for_each(|x| column(x).for_each(|level| histogram.add(level)));
        for (left, value) in values.iter_mut().enumerate() {
            if left > 0 {
                column(left - 1).for_each(|level| histogram.remove(level));
                column(left + window.columns() - 1).for_each(|level| histogram.add(level));
            }
            *value = table.entropy(histogram.sum);
        }
    });
    image.map(window, values)
}

/// The entropy, bit, of the grey levels of an image of one band; the levels as in [`local_entropy`].
///
/// # Errors
/// More bands than one, a value that is not finite (or beyond 10¹⁴⁰), a range that does not rise.
pub(crate) fn global_entropy(image: &MemoryCube<f64>, range: Option<[f64; 2]>) -> Result<f64> {
    let image = Image::of(image)?;
    let mut counts = [0_usize; LEVELS];
    levels(image, range)?.iter().for_each(|&level| counts[usize::from(level)] += 1);
    let count = image.samples.len() as f64;
    // − p log₂ p of each level: no term is negative.
    let bits = counts.iter().filter(|&&n| n > 0).map(|&n| n as f64 / count * libm::log2(count / n as f64));
    Ok(hadar::sum::sum(&bits.collect::<Vec<_>>()))
}

/// The level of every pixel.
fn levels(image: Image<'_>, range: Option<[f64; 2]>) -> Result<Vec<u8>> {
    let [low, high] = match range {
        Some([low, high])
            if low.is_finite() && high.is_finite() && low < high && (high - low).is_finite() =>
        {
            [low, high]
        }
        Some([low, high]) => {
            return Err(Error::malformed(
                format!("grey levels from {low} to {high}"),
                "give two finite numbers, the lower one first",
            ));
        }
        None => image.samples.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], &value| {
            [low.min(value), high.max(value)]
        }),
    };
    if low == high {
        return Ok(vec![0; image.samples.len()]);
    }
    let last = (LEVELS - 1) as f64;
    // The conversion clamps to 0..=255.
    Ok(image.samples.iter().map(|&value| ((value - low) / (high - low)).mul_add(last, 0.5) as u8).collect())
}

/// f(c) = c log₂ c for the counts of a window, times 2^shift, as integers.
#[derive(Debug)]
struct Table {
    scaled: Vec<i64>,
    shift: i32,
}

impl Table {
    fn of(pixels: usize) -> Self {
        let f = |c: usize| if c == 0 { 0.0 } else { c as f64 * libm::log2(c as f64) };
        // So large that f(n) still fits with a bit to spare, and no larger than f64 has digits for f(2).
        let shift = (61 - libm::log2(f(pixels) + 1.0).ceil() as i32).min(51);
        let scale = f64::from(shift).exp2();
        Self { scaled: (0..=pixels).map(|c| (f(c) * scale).round() as i64).collect(), shift }
    }

    /// H from Σ f(c_k).
    fn entropy(&self, sum: i64) -> f64 {
        let (all, pixels) = (self.scaled.last().copied().unwrap_or(0), self.scaled.len() - 1);
        (all - sum) as f64 / f64::from(self.shift).exp2() / pixels as f64
    }
}

/// The levels of a window.
#[derive(Debug)]
struct Histogram<'a> {
    counts: [u32; LEVELS],
    sum: i64,
    table: &'a Table,
}

impl Histogram<'_> {
    #[inline(always)]
    fn add(&mut self, level: u8) {
        let count = &mut self.counts[usize::from(level)];
        self.sum -= self.table.scaled[*count as usize];
        *count += 1;
        self.sum += self.table.scaled[*count as usize];
    }

    #[inline(always)]
    fn remove(&mut self, level: u8) {
        let count = &mut self.counts[usize::from(level)];
        self.sum -= self.table.scaled[*count as usize];
        *count -= 1;
        self.sum += self.table.scaled[*count as usize];
    }
}
