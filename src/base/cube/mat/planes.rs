//! From MATLAB's order, in which rows run fastest, to `[row][column][band]`.
//!
//! Bands are read some at a time, so many as fill a cache line of the result, and transposed in tiles of as many
//! rows: every line of either array is then in the cache until all of it is done.

use crate::cube::{Sample, Shape};
use crate::error::{Error, Result};
use rayon::prelude::*;

/// Bands that are read at a time, and rows of a tile: a cache line of `f32`.
const TILE: usize = 16;

/// A sample that a number of a file can become.
pub(super) trait Number: Sample {
    /// The nearest.
    fn narrowed(value: f64) -> Self;
}

impl Number for f32 {
    fn narrowed(value: f64) -> Self {
        value as Self
    }
}

impl Number for f64 {
    fn narrowed(value: f64) -> Self {
        value
    }
}

/// Samples `[row][column][band]` from a source that gives them `[band][column][row]`.
pub(super) fn transposed<S: Number>(
    shape: Shape,
    mut next: impl FnMut(&mut [S]) -> Result<()>,
) -> Result<Vec<S>> {
    let (rows, columns, bands) = (shape.rows(), shape.columns(), shape.bands());
    let plane = rows * columns;
    let mut samples = cleared(shape.len())?;
    let mut planes = cleared(plane * bands.min(TILE))?;
    for first in (0..bands).step_by(TILE) {
        let count = TILE.min(bands - first);
        let planes = &mut planes[..plane * count];
        next(planes)?;
        samples.par_chunks_mut(TILE * shape.row_len()).enumerate().for_each(|(tile, samples)| {
            let row = tile * TILE;
            let height = TILE.min(rows - row);
            for column in 0..columns {
                for band in 0..count {
                    let start = (band * columns + column) * rows + row;
                    let place = column * bands + first + band;
                    for (y, &sample) in planes[start..start + height].iter().enumerate() {
                        samples[y * shape.row_len() + place] = sample;
                    }
                }
            }
        });
    }
    Ok(samples)
}

/// Zeros, if there is memory for them. They come from the system, which provides no more than what is written to: a
/// packed array that announces more than it holds takes no more than it holds.
fn cleared<S: Sample>(len: usize) -> Result<Vec<S>> {
    bytemuck::allocation::try_zeroed_vec(len).map_err(|()| {
        Error::malformed(
            format!("the array needs {} bytes of memory, which there are not", len * size_of::<S>()),
            "write it as an NPY file, which is read by rows",
        )
    })
}
