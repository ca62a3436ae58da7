//! Cubes that are looked at while they are read: how many of their pixels are at the largest value, and how many are dark.
//!
//! Nothing is read for it, and no row is counted twice. Of a large cube every so many rows are looked at.

use hadar::cube::{Cube, Rows, Sample, Shape};
use hadar::error::Result;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// Samples of a cube that are looked at, at most but for one row.
const LOOKED_AT: usize = 1 << 24;

/// What was seen of a cube.
#[derive(Debug)]
pub(super) struct Watch {
    /// From a row that is looked at to the next.
    step: usize,
    /// Whether each of them has been.
    done: Vec<AtomicBool>,
    tally: Mutex<Tally>,
}

/// Pixels that were counted.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Tally {
    pub(super) pixels: usize,
    /// The largest sample of all, and how many pixels have one that is as large.
    pub(super) most: f64,
    pub(super) at_most: usize,
    /// Pixels that are 0 in all bands.
    pub(super) dark: usize,
}

impl Watch {
    /// A cube that is watched.
    pub(super) fn over(cube: Cube) -> (Cube, Arc<Self>) {
        let shape = cube.shape();
        let step = shape.len().div_ceil(LOOKED_AT).min(shape.rows());
        let done = (0..shape.rows().div_ceil(step)).map(|_| AtomicBool::new(false)).collect();
        let watch = Arc::new(Self { step, done, tally: Mutex::default() });
        let cube = match cube {
            Cube::F32(cube) => Cube::F32(Box::new(Watched { cube, watch: watch.clone() })),
            Cube::F64(cube) => Cube::F64(Box::new(Watched { cube, watch: watch.clone() })),
        };
        (cube, watch)
    }

    /// What was seen until now.
    pub(super) fn tally(&self) -> Tally {
        *self.tally.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn look<S: Sample>(&self, row: usize, samples: &[S], bands: usize) {
        let is_due = row.is_multiple_of(self.step)
            && self.done.get(row / self.step).is_some_and(|done| !done.swap(true, Ordering::Relaxed));
        if !is_due {
            return;
        }
        let mut own = Tally::default();
        for pixel in samples.chunks(bands) {
            // NaN is none.
            let most = pixel.iter().fold(f64::NEG_INFINITY, |most, sample| most.max((*sample).into()));
            let is_dark = pixel.iter().all(|sample| (*sample).into() == 0.0);
            own = own.and(Tally { pixels: 1, most, at_most: 1, dark: usize::from(is_dark) });
        }
        let mut tally = self.tally.lock().unwrap_or_else(PoisonError::into_inner);
        *tally = tally.and(own);
    }
}

impl Tally {
    fn and(self, other: Self) -> Self {
        let at_most = match self.most.total_cmp(&other.most) {
            _ if self.pixels == 0 => other.at_most,
            std::cmp::Ordering::Less => other.at_most,
            std::cmp::Ordering::Equal => self.at_most + other.at_most,
            std::cmp::Ordering::Greater => self.at_most,
        };
        let most = if self.pixels == 0 { other.most } else { self.most.max(other.most) };
        Self { pixels: self.pixels + other.pixels, most, at_most, dark: self.dark + other.dark }
    }
}

#[derive(Debug)]
struct Watched<S: Sample> {
    cube: Box<dyn Rows<S>>,
    watch: Arc<Watch>,
}

impl<S: Sample> Rows<S> for Watched<S> {
    fn shape(&self) -> Shape {
        self.cube.shape()
    }

    fn read<'a>(&'a self, rows: Range<usize>, buffer: &'a mut Vec<S>) -> Result<&'a [S]> {
        let shape = self.cube.shape();
        let samples = self.cube.read(rows.clone(), buffer)?;
        for (row, samples) in rows.zip(samples.chunks(shape.row_len())) {
            self.watch.look(row, samples, shape.bands());
        }
        Ok(samples)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hadar::cube::MemoryCube;

    #[test]
    fn every_pixel_is_counted_once_in_whatever_order_rows_are_read() {
        let shape = Shape::new(40, 30, 3).unwrap();
        let mut samples: Vec<f32> = (0..shape.len()).map(|i| (i * 7 % 900) as f32).collect();
        // Seven pixels cut off, four of them in one row; three dark, one without a reading.
        for pixel in [5, 31, 32, 33, 34, 600, 1199] {
            samples[3 * pixel + 1] = 1000.0;
        }
        for pixel in [100, 101, 900] {
            samples[3 * pixel..3 * pixel + 3].fill(0.0);
        }
        samples[3 * 700..3 * 700 + 3].fill(f32::NAN);
        let (cube, watch) = Watch::over(MemoryCube::new(shape, samples).unwrap().into());
        let Cube::F32(rows) = &cube else { panic!("f32") };
        let mut buffer = Vec::new();
        for part in [20..40, 0..25, 10..11] {
            rows.read(part, &mut buffer).unwrap();
        }
        assert_eq!(watch.tally(), Tally { pixels: 1200, most: 1000.0, at_most: 7, dark: 3 });
    }
}
