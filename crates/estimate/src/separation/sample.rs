//! Pixels of a cube that a library is made from: some of them, drawn evenly, so that the work does not grow with the cube.

use crate::decompose::{Maps, Options, Setting, decompose};
use hadar::cube::{Cube, MemoryCube, Rows, Sample as Stored, Shape};
use hadar::error::Result;
use hadar::parallel;
use hadar::random::generator;

/// Stream of random numbers of the choice.
const STREAM: u64 = 1 << 32;

/// Counts of some pixels, all bands of each.
#[derive(Debug, Clone)]
pub(super) struct Sample {
    pub(super) bands: usize,
    counts: Vec<f64>,
}

impl Sample {
    /// At most `most` pixels of which no band that counts is missing.
    pub(super) fn of(cube: &Cube, setting: &Setting<'_>, most: usize, seed: u64) -> Result<Self> {
        match cube {
            Cube::F32(rows) => Self::of_rows(rows.as_ref(), setting, most, seed),
            Cube::F64(rows) => Self::of_rows(rows.as_ref(), setting, most, seed),
        }
    }

    fn of_rows<S: Stored>(cube: &dyn Rows<S>, setting: &Setting<'_>, most: usize, seed: u64) -> Result<Self> {
        let shape = cube.shape();
        let (all, columns, bands) = (shape.rows() * shape.columns(), shape.columns(), shape.bands());
        let mut chosen: Vec<usize> = if all <= most {
            (0..all).collect()
        } else {
            rand::seq::index::sample(&mut generator(seed, STREAM), all, most).into_vec()
        };
        chosen.sort_unstable();
        let is_bad = |band: usize| setting.bad_bands.contains(&band);
        let of_row = |buffer: &mut Vec<S>, row: usize| -> Result<Vec<f64>> {
            let own = chosen.partition_point(|i| *i < row * columns)
                ..chosen.partition_point(|i| *i < (row + 1) * columns);
            let mut counts = Vec::with_capacity(own.len() * bands);
            if own.is_empty() {
                return Ok(counts);
            }
            let samples = cube.read(row..row + 1, buffer)?;
            for pixel in &chosen[own] {
                let pixel = &samples[(pixel % columns) * bands..][..bands];
                let whole = (0..bands).all(|band| is_bad(band) || pixel[band].into().is_finite());
                if whole {
                    counts.extend(pixel.iter().map(|sample| (*sample).into() / setting.units_per_count));
                }
            }
            Ok(counts)
        };
        let rows: Vec<Vec<f64>> = parallel::try_map_with(shape.rows(), Vec::new, of_row)?;
        Ok(Self { bands, counts: rows.concat() })
    }

    pub(super) fn pixels(&self) -> usize {
        self.counts.len() / self.bands
    }

    pub(super) fn pixel(&self, i: usize) -> &[f64] {
        &self.counts[i * self.bands..][..self.bands]
    }

    /// Counts of the bands that count of a pixel.
    pub(super) fn used(&self, i: usize, used: &[usize]) -> Vec<f64> {
        let pixel = self.pixel(i);
        used.iter().map(|band| pixel[*band]).collect()
    }

    /// Some of the pixels.
    pub(super) fn some(&self, of: &[usize]) -> Self {
        Self { bands: self.bands, counts: of.iter().flat_map(|i| self.pixel(*i)).copied().collect() }
    }

    /// At most so many of the pixels, evenly.
    pub(super) fn every(&self, most: usize) -> Self {
        let stride = self.pixels().div_ceil(most).max(1);
        self.some(&(0..self.pixels()).step_by(stride).collect::<Vec<_>>())
    }

    /// The pixels decomposed by a library, with a prior probability of each emissivity.
    pub(super) fn decomposed(
        &self,
        setting: &Setting<'_>,
        library: &[Vec<f64>],
        prior: Vec<f64>,
    ) -> Result<Maps> {
        let shape = Shape::new(1, self.pixels(), self.bands)?;
        let cube = Cube::from(MemoryCube::new(shape, self.counts.clone())?);
        let setting = Setting { library, units_per_count: 1.0, ..*setting };
        decompose(&setting, &Options { prior, ..Options::default() }, &cube, &|_| ())
    }
}
