//! Standard deviation in windows, at a cost per pixel that does not grow with them.
//!
//! The image is cut into tiles of the window's size. A window has a corner pixel (the upper left) of exactly one tile
//! in it; that pixel's value is subtracted first, so that a large mean is gone before anything is squared. Sums over
//! the window are those of the part of it before the corner, taken backwards from the corner, and those from the
//! corner on: along x, then along y (van Herk). Nothing is ever taken out of a sum, so that no error is carried from
//! one window to another. The corner lies in the window, hence no value in the sums exceeds the window's range,
//! and the variance loses at most a factor 2n of the precision of a sum of n terms.
//!
//! Source: van Herk, Pattern Recognition Letters 13, 517 (1992); shifted data: Chan, Golub, LeVeque, The American
//! Statistician 37, 242 (1983).

use super::{Image, TextureMap};
use hadar::cube::MemoryCube;
use hadar::error::{Error, Result};
use hadar::ranging::information::Window;
use rayon::prelude::*;
use std::ops::Range;

/// The standard deviation (n − 1 in the denominator) of every window that lies whole in an image of one band.
///
/// # Errors
/// More bands than one, a value that is not finite (or beyond 10¹⁴⁰), a window larger than the image or of one pixel.
pub(crate) fn standard_deviation(image: &MemoryCube<f64>, window: Window) -> Result<TextureMap> {
    let image = Image::of(image)?;
    image.centres(window)?;
    if window.rows() * window.columns() < 2 {
        return Err(Error::malformed(
            "a window of 1 x 1 pixel has no standard deviation",
            "give a larger one, e.g. 5 x 5",
        ));
    }
    // Windows by their upper left pixel.
    let (rows, columns) = (image.rows - window.rows() + 1, image.columns - window.columns() + 1);
    let mut values = vec![0.0; rows * columns];
    let bands = bands_of(&mut values, columns, rows, window.rows());
    bands.into_par_iter().for_each_init(<[Vec<Moments>; 2]>::default, |sums, (corner_row, tops, values)| {
        for corner_column in (0..image.columns).step_by(window.columns()) {
            let lefts = holding(corner_column, window.columns(), columns);
            if !lefts.is_empty() {
                let tile = Tile { image, window, corner: [corner_row, corner_column] };
                tile.deviations(&tops, &lefts, sums, |top, left, deviation| {
                    values[(top - tops.start) * columns + left] = deviation;
                });
            }
        }
    });
    image.map(window, values)
}

/// The rows of results that belong to each row of corners.
fn bands_of(
    mut values: &mut [f64],
    columns: usize,
    rows: usize,
    height: usize,
) -> Vec<(usize, Range<usize>, &mut [f64])> {
    let mut bands = Vec::new();
    for corner in (0..).step_by(height) {
        let tops = holding(corner, height, rows);
        if tops.is_empty() {
            return bands;
        }
        let (band, rest) = values.split_at_mut(tops.len() * columns);
        values = rest;
        bands.push((corner, tops, band));
    }
    bands
}

/// First pixels of the windows that hold a corner, of `count` windows in all.
fn holding(corner: usize, side: usize, count: usize) -> Range<usize> {
    (corner + 1).saturating_sub(side)..count.min(corner + 1)
}

/// A corner and the image around it.
#[derive(Debug, Clone, Copy)]
struct Tile<'a> {
    image: Image<'a>,
    window: Window,
    corner: [usize; 2],
}

/// Σy and Σy² of the values less the corner's.
#[derive(Debug, Clone, Copy, Default)]
struct Moments {
    sum: f64,
    squares: f64,
}

impl Moments {
    #[inline(always)]
    fn and(self, other: Self) -> Self {
        Self { sum: self.sum + other.sum, squares: self.squares + other.squares }
    }

    #[inline(always)]
    fn of(value: f64) -> Self {
        Self { sum: value, squares: value * value }
    }
}

impl Tile<'_> {
    /// Of the windows with these upper left pixels.
    fn deviations(
        self,
        tops: &Range<usize>,
        lefts: &Range<usize>,
        [sums, column]: &mut [Vec<Moments>; 2],
        mut put: impl FnMut(usize, usize, f64),
    ) {
        let [corner_row, corner_column] = self.corner;
        let width = lefts.len();
        let pivot = self.image.samples[corner_row * self.image.columns + corner_column];
        let rows = tops.start..tops.end - 1 + self.window.rows();
        sums.clear();
        sums.resize(rows.len() * width, Moments::default());
        for (sums, row) in sums.chunks_exact_mut(width).zip(rows.clone()) {
            let row = &self.image.samples[row * self.image.columns..][..self.image.columns];
            windows(sums, lefts.start, corner_column, self.window.columns(), |x| Moments::of(row[x] - pivot));
        }
        let count = (self.window.rows() * self.window.columns()) as f64;
        column.resize(tops.len(), Moments::default());
        for (x, left) in lefts.clone().enumerate() {
            let of_row = |y: usize| sums[(y - rows.start) * width + x];
            windows(column, tops.start, corner_row, self.window.rows(), of_row);
            for (moments, top) in column.iter().zip(tops.clone()) {
                let squares = moments.squares - moments.sum * (moments.sum / count);
                put(top, left, (squares.max(0.0) / (count - 1.0)).sqrt());
            }
        }
    }
}

/// Sums over windows of `side` that begin at `first` and one further each, all of which hold `corner`.
#[inline(always)]
fn windows(sums: &mut [Moments], first: usize, corner: usize, side: usize, at: impl Fn(usize) -> Moments) {
    // Before the corner, backwards.
    let mut before = Moments::default();
    let last = first + sums.len();
    for x in (first..corner).rev() {
        before = before.and(at(x));
        if x < last {
            sums[x - first] = before;
        }
    }
    if last > corner {
        sums[corner - first] = Moments::default();
    }
    // From the corner on.
    let mut after = Moments::default();
    let mut next = corner;
    for (x, sum) in (first..).zip(sums) {
        while next < x + side {
            after = after.and(at(next));
            next += 1;
        }
        *sum = sum.and(after);
    }
}
