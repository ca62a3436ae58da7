//! Measures of texture that do not know what it is for: standard deviation and entropy.
//!
//! * deviation: s = √(Σ(I − Ī)²/(n − 1)) of the n pixels of a window, in the unit of the image I;
//! * local entropy: H = −Σ_k p_k log₂ p_k (bit) of the p_k = c_k/n, c_k pixels of the window at grey level k of 256;
//! * global entropy: the same of the whole image.
//!
//! Level k is the nearest to 255 (I − I₀)/(I₁ − I₀) within 0..=255, with the range I₀..I₁ that is stated, or else the
//! image's own. These are the definitions of `stdfilt` and `entropyfilt` in Matlab, but only of windows that lie
//! whole in the image. Unlike the Fisher information of [`information`](hadar::ranging::information), neither asks in which
//! direction the image varies (of stripes along x, which no stereo pair can place, s is that of stripes along y), nor
//! whether it is noise that varies; nor can either be turned into an error of depth.
//!
//! Source: paper SI D and Fig. S12.

mod deviation;
mod entropy;

pub(crate) use deviation::standard_deviation;
pub(crate) use entropy::{global_entropy, local_entropy};

use hadar::cube::{MemoryCube, Rows};
use hadar::error::{Error, Result};
use hadar::ranging::information::Window;
use std::ops::Range;

/// Largest grey value, either sign, whose square and the sum of many such are still numbers.
const MAX_GREY: f64 = 1e140;

/// A measure of every window that lies whole in the image.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct TextureMap {
    /// Rows of the windows' centres.
    pub(crate) rows: Range<usize>,
    /// Columns of the windows' centres.
    pub(crate) columns: Range<usize>,
    /// The measure, `[row][column]` of the centres.
    pub(crate) values: Vec<f64>,
}

/// An image of one band.
#[derive(Debug, Clone, Copy)]
struct Image<'a> {
    samples: &'a [f64],
    rows: usize,
    columns: usize,
}

impl<'a> Image<'a> {
    fn of(image: &'a MemoryCube<f64>) -> Result<Self> {
        let shape = image.shape();
        if shape.bands() != 1 {
            return Err(Error::malformed(
                format!("an image of {} bands", shape.bands()),
                "give one band, or the sum of all (panchromatic)",
            ));
        }
        let samples = image.samples();
        if let Some(place) = samples.iter().position(|value| value.is_nan() || value.abs() > MAX_GREY) {
            let (row, column) = (place / shape.columns(), place % shape.columns());
            return Err(Error::out_of_range("grey value", samples[place], "", "a number within 1e140 of 0")
                .for_key(format!("row {row}, column {column} (counted from 0)")));
        }
        Ok(Self { samples, rows: shape.rows(), columns: shape.columns() })
    }

    /// The centres of the windows that lie whole in it.
    fn centres(self, window: Window) -> Result<(Range<usize>, Range<usize>)> {
        if window.rows() > self.rows || window.columns() > self.columns {
            return Err(Error::malformed(
                format!(
                    "a window of {} x {} pixels in an image of {} x {}",
                    window.rows(),
                    window.columns(),
                    self.rows,
                    self.columns
                ),
                "give one that fits into the image",
            ));
        }
        let (y, x) = (window.half_rows(), window.half_columns());
        Ok((y..self.rows - y, x..self.columns - x))
    }

    fn map(self, window: Window, values: Vec<f64>) -> Result<TextureMap> {
        let (rows, columns) = self.centres(window)?;
        Ok(TextureMap { rows, columns, values })
    }
}

#[cfg(test)]
mod tests;
