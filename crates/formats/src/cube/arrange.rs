//! From the order in which a file has its samples to `[row][column][band]`.
//!
//! The axis that runs fastest in the file and the bands are gone through in tiles of a cache line: every line of either
//! array is then in the cache until all of it is done.

use super::axes::{Axes, Axis};
use hadar::cube::{Sample, Shape};
use hadar::error::{Error, Result};
use rayon::prelude::*;
use std::ops::Range;

/// Samples of a tile, and slices of the outermost axis that are read at a time: a cache line of `f32`.
const TILE: usize = 16;

/// A box of samples in another order.
#[derive(Debug, Clone)]
pub(super) struct Part<'a, S> {
    pub(super) samples: &'a [S],
    /// How many samples apart neighbours are along rows, columns and bands.
    pub(super) strides: [usize; 3],
    /// Which columns and bands of the cube they are.
    pub(super) columns: Range<usize>,
    pub(super) bands: Range<usize>,
}

impl<S: Sample> Part<'_, S> {
    /// Puts rows of the box, the first of them `row`, where they belong in whole rows of the cube.
    pub(super) fn put(&self, row: usize, rows: &mut [S], shape: Shape) {
        let [down, along, deep] = self.strides;
        let height = rows.len() / shape.row_len();
        let from = |y: usize, x: usize, b: usize| (row + y) * down + x * along + b * deep;
        let to = |y: usize, x: usize, b: usize| {
            y * shape.row_len() + (self.columns.start + x) * shape.bands() + self.bands.start + b
        };
        let (width, bands) = (self.columns.len(), self.bands.len());
        if deep == 1 {
            for y in 0..height {
                for x in 0..width {
                    let place = to(y, x, 0);
                    rows[place..place + bands].copy_from_slice(&self.samples[from(y, x, 0)..][..bands]);
                }
            }
        } else if along == 1 {
            for y in 0..height {
                for first in (0..width).step_by(TILE) {
                    let count = TILE.min(width - first);
                    for b in 0..bands {
                        let own = &self.samples[from(y, first, b)..][..count];
                        own.iter().enumerate().for_each(|(x, sample)| rows[to(y, first + x, b)] = *sample);
                    }
                }
            }
        } else {
            for first in (0..height).step_by(TILE) {
                let count = TILE.min(height - first);
                for x in 0..width {
                    for b in 0..bands {
                        let own = &self.samples[from(first, x, b)..][..count];
                        own.iter().enumerate().for_each(|(y, sample)| rows[to(first + y, x, b)] = *sample);
                    }
                }
            }
        }
    }
}

/// Samples `[row][column][band]` from a source that gives them in another order, some slices at a time.
pub(super) fn whole<S: Sample>(
    shape: Shape,
    order: Axes,
    mut next: impl FnMut(&mut [S]) -> Result<()>,
) -> Result<Vec<S>> {
    let mut samples = cleared(shape.len())?;
    if order == Axes::default() {
        next(&mut samples)?;
        return Ok(samples);
    }
    let [outer, middle, inner] = order.sides(shape);
    let strides = order.strides(shape);
    let mut slices = cleared(middle * inner * outer.min(TILE))?;
    for first in (0..outer).step_by(TILE) {
        let count = TILE.min(outer - first);
        let slices = &mut slices[..middle * inner * count];
        next(slices)?;
        let mut part =
            Part { samples: slices, strides, columns: 0..shape.columns(), bands: 0..shape.bands() };
        match order.outermost() {
            Axis::Rows => {
                part.put(0, &mut samples[first * shape.row_len()..][..count * shape.row_len()], shape);
                continue;
            }
            Axis::Columns => part.columns = first..first + count,
            Axis::Bands => part.bands = first..first + count,
        }
        samples.par_chunks_mut(TILE * shape.row_len()).enumerate().for_each(|(tile, rows)| {
            hadar::stop::check();
            part.put(tile * TILE, rows, shape);
        });
    }
    Ok(samples)
}

/// Zeros, if there is memory for them. They come from the system, which provides no more than what is written to: a
/// packed array that announces more than it holds takes no more than it holds.
pub(super) fn cleared<S: Sample>(len: usize) -> Result<Vec<S>> {
    bytemuck::allocation::try_zeroed_vec(len).map_err(|()| {
        Error::malformed(
            format!("the array needs {} bytes of memory, which there are not", len * size_of::<S>()),
            "write it as an NPY file, which is read by rows",
        )
    })
}
