//! Means of the segments of every line.

use super::found::Axis;
use hadar::cube::{Rows, Sample};
use hadar::error::Result;
use hadar::parallel;

/// Pixels of a segment, about, and how many segments there are.
const PIXELS: usize = 16;
const SEGMENTS: [usize; 2] = [8, 48];

/// Least and largest of no sample.
const NONE: [f64; 2] = [f64::INFINITY, f64::NEG_INFINITY];

/// Means, NaN where less than half of a segment is there.
#[derive(Debug)]
pub(super) struct Segments {
    pub(super) lines: usize,
    pub(super) count: usize,
    bands: usize,
    /// `[line][segment][band]`.
    means: Vec<f64>,
    /// `[line][band]`: the line has two samples or more, all the same.
    flat: Vec<bool>,
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
        let sums: Vec<(Vec<f64>, Vec<[f64; 2]>)> = parallel::try_map(parts, |part| {
            let across = match axis {
                Axis::Rows => count,
                Axis::Columns => columns,
            };
            let (mut sum, mut there) = (vec![0.0; across * bands], vec![0_u32; across * bands]);
            let mut ends = vec![NONE; across * bands];
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
                    let each = sum[own.clone()].iter_mut().zip(&mut there[own.clone()]).zip(pixel);
                    for (((sum, there), sample), ends) in each.zip(&mut ends[own]) {
                        let value: f64 = (*sample).into();
                        if value.is_finite() {
                            *sum += value;
                            *there += 1;
                            *ends = [ends[0].min(value), ends[1].max(value)];
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
            Ok((sum, ends))
        })?;
        let mut ends = vec![NONE; lines * bands];
        for (part, (_, own)) in sums.iter().enumerate() {
            for (place, own) in own.iter().enumerate() {
                let line = match axis {
                    Axis::Rows => part,
                    Axis::Columns => place / bands,
                };
                let ends = &mut ends[line * bands + place % bands];
                *ends = [ends[0].min(own[0]), ends[1].max(own[1])];
            }
        }
        let all = ends.iter().fold(NONE, |all, own| [all[0].min(own[0]), all[1].max(own[1])]);
        let flat = ends.iter().map(|own| own[0] >= own[1]).collect();
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
        Ok(Self { lines, count, bands, means, flat, constant: all[0] >= all[1] })
    }

    pub(super) fn is_constant(&self) -> bool {
        self.constant
    }

    /// Lines of a band that hold one value alone, where most others do not: nothing of the scene is in them.
    pub(super) fn flat(&self, band: usize) -> Vec<bool> {
        let there = |line: usize| (0..self.count).any(|i| self.mean(line, i, band).is_finite());
        let flat: Vec<bool> =
            (0..self.lines).map(|line| self.flat[line * self.bands + band] && there(line)).collect();
        match 2 * flat.iter().filter(|flat| **flat).count() <= self.lines {
            true => flat,
            false => vec![false; self.lines],
        }
    }

    /// Of one segment.
    pub(super) fn mean(&self, line: usize, segment: usize, band: usize) -> f64 {
        self.means[(line * self.count + segment) * self.bands + band]
    }

    /// The segments of every line of a band.
    pub(super) fn of_band(&self, band: usize) -> Vec<Vec<f64>> {
        let line = |line: usize| (0..self.count).map(|i| self.mean(line, i, band)).collect();
        (0..self.lines).map(line).collect()
    }
}
