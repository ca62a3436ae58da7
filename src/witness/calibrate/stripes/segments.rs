//! Means of the segments of every line.

use super::found::Axis;
use crate::error::Result;
use crate::ranging::cube::{Rows, Sample};
use rayon::prelude::*;

/// Pixels of a segment, about, and how many segments there are.
const PIXELS: usize = 16;
const SEGMENTS: [usize; 2] = [8, 48];

/// Means, NaN where less than half of a segment is there.
#[derive(Debug)]
pub(super) struct Segments {
    pub(super) lines: usize,
    pub(super) count: usize,
    bands: usize,
    /// `[line][segment][band]`.
    means: Vec<f64>,
    constant: bool,
}

impl Segments {
    pub(super) fn of<S: Sample>(cube: &dyn Rows<S>, axis: Axis) -> Result<Self> {
        let shape = cube.shape();
        let (rows, columns, bands) = (shape.rows(), shape.columns(), shape.bands());
        let (lines, pixels) = match axis {
            Axis::Rows => (rows, columns),
            Axis::Columns => (columns, rows),
        };
        let count = (pixels / PIXELS).clamp(SEGMENTS[0], SEGMENTS[1]);
        let first = |segment: usize| segment * pixels / count;
        // Sums of each row of segments (columns as lines) or of each line (rows as lines).
        let parts = match axis {
            Axis::Rows => rows,
            Axis::Columns => count,
        };
        let sums: Vec<(Vec<f64>, f64, f64)> = (0..parts)
            .into_par_iter()
            .map(|part| {
                let across = match axis {
                    Axis::Rows => count,
                    Axis::Columns => columns,
                };
                let (mut sum, mut there) = (vec![0.0; across * bands], vec![0_u32; across * bands]);
                let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
                let mut buffer = Vec::new();
                let range = match axis {
                    Axis::Rows => part..part + 1,
                    Axis::Columns => first(part)..first(part + 1),
                };
                for row in range.clone() {
                    let samples = cube.read(row..row + 1, &mut buffer)?;
                    let mut place = 0;
                    for (column, pixel) in samples.chunks_exact(bands).enumerate() {
                        match axis {
                            Axis::Rows => {
                                if place + 1 < count && column >= first(place + 1) {
                                    place += 1;
                                }
                            }
                            Axis::Columns => place = column,
                        }
                        let own = place * bands..(place + 1) * bands;
                        let each = sum[own.clone()].iter_mut().zip(&mut there[own]).zip(pixel);
                        for ((sum, there), sample) in each {
                            let value: f64 = (*sample).into();
                            if value.is_finite() {
                                *sum += value;
                                *there += 1;
                                low = low.min(value);
                                high = high.max(value);
                            }
                        }
                    }
                }
                for (place, (sum, there)) in sum.iter_mut().zip(&there).enumerate() {
                    let full = match axis {
                        Axis::Rows => first(place / bands + 1) - first(place / bands),
                        Axis::Columns => range.len(),
                    };
                    *sum = if 2 * *there as usize >= full { *sum / f64::from(*there) } else { f64::NAN };
                }
                Ok((sum, low, high))
            })
            .collect::<Result<_>>()?;
        let low = sums.iter().map(|part| part.1).fold(f64::INFINITY, f64::min);
        let high = sums.iter().map(|part| part.2).fold(f64::NEG_INFINITY, f64::max);
        let means = match axis {
            Axis::Rows => sums.into_iter().flat_map(|part| part.0).collect(),
            Axis::Columns => {
                let mut means = vec![0.0; lines * count * bands];
                for (segment, (part, ..)) in sums.iter().enumerate() {
                    for (line, own) in part.chunks_exact(bands).enumerate() {
                        let at = (line * count + segment) * bands;
                        means[at..at + bands].copy_from_slice(own);
                    }
                }
                means
            }
        };
        Ok(Self { lines, count, bands, means, constant: low >= high })
    }

    pub(super) fn is_constant(&self) -> bool {
        self.constant
    }

    /// The segments of every line of a band.
    pub(super) fn of_band(&self, band: usize) -> Vec<Vec<f64>> {
        let line = |line: usize| {
            let at = |segment: usize| (line * self.count + segment) * self.bands + band;
            (0..self.count).map(|segment| self.means[at(segment)]).collect()
        };
        (0..self.lines).map(line).collect()
    }
}
