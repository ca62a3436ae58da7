//! Rows of a cube of either kind of sample, as they were read.

use super::bounds::Bounded;
use super::direct::{Direct, Pixels, Stretch};
use super::kernels::{Seen, Stored};
use super::limits::MOST;
use crate::cube::{CubeRef, Rows};
use crate::error::Result;
use crate::simd::Chunk;
use std::ops::Range;

/// Room for rows that do not lie in memory.
#[derive(Debug, Default)]
pub(super) struct Buffer {
    narrow: Vec<f32>,
    wide: Vec<f64>,
}

impl Buffer {
    /// Reads rows.
    pub(super) fn read<'a>(&'a mut self, cube: CubeRef<'a>, rows: Range<usize>) -> Result<Raw<'a>> {
        let len = rows.len() * cube.shape().row_len();
        match cube {
            CubeRef::F32(cube) => exactly(cube, rows, len, &mut self.narrow).map(Raw::F32),
            CubeRef::F64(cube) => exactly(cube, rows, len, &mut self.wide).map(Raw::F64),
        }
    }
}

fn exactly<'a, S: Stored>(
    cube: &'a dyn Rows<S>,
    rows: Range<usize>,
    len: usize,
    buffer: &'a mut Vec<S>,
) -> Result<&'a [S]> {
    let samples = cube.read(rows, buffer)?;
    if samples.len() == len {
        return Ok(samples);
    }
    let what = "samples of rows of a cube".to_owned();
    Err(crate::Error::Length { what, found: samples.len(), expected: len })
}

/// Samples of rows, `[row][column][band]`.
#[derive(Debug, Clone, Copy)]
pub(super) enum Raw<'a> {
    F32(&'a [f32]),
    F64(&'a [f64]),
}

impl Raw<'_> {
    /// One sample; NaN beyond the last.
    pub(super) fn get(self, at: usize) -> f64 {
        match self {
            Raw::F32(samples) => samples.get(at).map_or(f64::NAN, |sample| f64::from(*sample)),
            Raw::F64(samples) => samples.get(at).copied().unwrap_or(f64::NAN),
        }
    }

    /// Whether all of some samples are counts that can be used, or NaN.
    pub(super) fn all_counts_or_missing(self, samples: Range<usize>) -> bool {
        fn all<S: Stored>(samples: Option<&[S]>) -> bool {
            let is_one = |sample: S| -> bool {
                let value: f64 = sample.into();
                value.is_nan() | (0.0..=MOST).contains(&value)
            };
            samples.is_some_and(|samples| samples.iter().fold(true, |all, sample| all & is_one(*sample)))
        }
        match self {
            Raw::F32(own) => all(own.get(samples)),
            Raw::F64(own) => all(own.get(samples)),
        }
    }

    /// Widens the samples from `start` on to whole vectors per column, as many columns as `to` has room for.
    pub(super) fn widen(self, start: usize, bands: usize, to: &mut [f64]) -> Seen {
        match self {
            Raw::F32(samples) => Stored::widen(&samples[start..], bands, to),
            Raw::F64(samples) => Stored::widen(&samples[start..], bands, to),
        }
    }

    /// What the pixels of a row give, as many columns from `start` on as there are totals.
    pub(super) fn pixels(self, start: usize, bands: usize, to: Pixels<'_>) -> Seen {
        match self {
            Raw::F32(samples) => Direct::pixels(Stretch { samples: &samples[start..], bands }, to),
            Raw::F64(samples) => Direct::pixels(Stretch { samples: &samples[start..], bands }, to),
        }
    }

    /// Σ over `height` rows, the first sample of which is at `start`, widened as by [`Self::widen`].
    pub(super) fn sum_rows(
        self,
        start: usize,
        (row_len, height): (usize, usize),
        bands: usize,
        to: &mut [f64],
    ) {
        match self {
            Raw::F32(samples) => {
                Direct::rows(Stretch { samples: &samples[start..], bands }, row_len, height, to);
            }
            Raw::F64(samples) => {
                Direct::rows(Stretch { samples: &samples[start..], bands }, row_len, height, to);
            }
        }
    }

    /// Upper bounds of the information of pixels, of which the first is in the second column from `start` on.
    pub(super) fn bounds(
        self,
        start: usize,
        bands: usize,
        var_least: f64,
        lanes: &mut Vec<Chunk>,
        to: &mut [f64],
    ) {
        match self {
            Raw::F32(samples) => {
                Bounded::bounds(Stretch { samples: &samples[start..], bands }, var_least, lanes, to);
            }
            Raw::F64(samples) => {
                Bounded::bounds(Stretch { samples: &samples[start..], bands }, var_least, lanes, to);
            }
        }
    }
}
