//! Which counts and variances can be used, and what is said of one that cannot.
//!
//! A count is 0 or lies between [`LEAST`] and [`MOST`]: far beyond any detector on both sides, and such that products
//! of the seven sums over the largest windows still are ordinary doubles.

use super::blocks::Plan;
use super::kernels::Seen;
use super::rows::Raw;
use crate::error::{Error, Result};
use crate::ranging::cube::Shape;
use crate::ranging::noise::NoiseVariance;
use std::ops::Range;

/// The largest count and variance.
pub(super) const MOST: f64 = 1e27;

/// The least sum of a count and its variance.
pub(super) const LEAST: f64 = 1e-27;

/// Checks the variances that are the same in all pixels.
pub(super) fn variances(noise: &NoiseVariance, shape: Shape) -> Result<()> {
    noise.check(shape)?;
    let too_large = |var: &f64| {
        let expected = format!("at most {MOST:e}");
        Err(Error::out_of_range("noise variance", *var, "counts^2", expected))
    };
    match noise {
        NoiseVariance::Uniform(var) if *var > MOST => too_large(var),
        NoiseVariance::PerBand(var) => var.iter().find(|var| **var > MOST).map_or(Ok(()), too_large),
        _ => Ok(()),
    }
}

/// Rows as they were read, with what their samples are to be checked against.
#[derive(Debug, Clone, Copy)]
pub(super) struct Checked<'a> {
    pub(super) shape: Shape,
    /// The rows of the cube that were read.
    pub(super) rows: (usize, usize),
    pub(super) counts: Raw<'a>,
    /// Variances of every sample.
    pub(super) variances: Option<Raw<'a>>,
    /// Variances of the bands, otherwise.
    pub(super) var_band: &'a [f64],
    /// Whether any of them is so small that a count of 0 would be divided by.
    pub(super) zero_matters: bool,
}

impl<'a> Checked<'a> {
    pub(super) fn new(
        plan: &'a Plan<'_>,
        rows: (usize, usize),
        counts: Raw<'a>,
        variances: Option<Raw<'a>>,
    ) -> Self {
        let zero_matters = variances.is_some() || plan.var_band.iter().any(|var| *var < LEAST);
        Self { shape: plan.shape, rows, counts, variances, var_band: &plan.var_band, zero_matters }
    }

    /// Place of the first sample of a pixel among those read.
    pub(super) fn at(&self, row: usize, column: usize) -> usize {
        (row - self.rows.0) * self.shape.row_len() + column * self.shape.bands()
    }

    /// Looks closely if what was seen on the way is not beyond doubt; the first offending sample of all the rows
    /// read is named.
    pub(super) fn look(&self, counts: Seen, variances: Option<Seen>) -> Result<()> {
        let sound = counts.sound && variances.is_none_or(|seen| seen.sound);
        if sound && (!self.zero_matters || counts.least >= LEAST) {
            return Ok(());
        }
        self.closely(self.rows.0..self.rows.1)
    }

    fn closely(&self, rows: Range<usize>) -> Result<()> {
        for row in rows {
            for column in 0..self.shape.columns() {
                for band in 0..self.shape.bands() {
                    let at = (row - self.rows.0) * self.shape.row_len() + column * self.shape.bands() + band;
                    let count = self.counts.get(at);
                    let var = self
                        .variances
                        .map_or_else(|| self.var_band.get(band).copied(), |raw| Some(raw.get(at)));
                    let place = Place { row, column, band };
                    place.check(count, var.unwrap_or(0.0))?;
                }
            }
        }
        Ok(())
    }
}

struct Place {
    row: usize,
    column: usize,
    band: usize,
}

impl Place {
    fn name(&self, what: &str) -> String {
        format!("{what} at row {}, column {}, band {} (from 0)", self.row, self.column, self.band)
    }

    fn check(&self, count: f64, var: f64) -> Result<()> {
        if !(0.0..=MOST).contains(&count) {
            let expected = format!(
                "a number of photons from 0 to {MOST:e}; mask or fill bad pixels, subtract no background from counts"
            );
            return Err(Error::out_of_range(self.name("the count"), count, "", expected));
        }
        if !(0.0..=MOST).contains(&var) {
            let expected = format!("from 0 to {MOST:e}");
            return Err(Error::out_of_range(self.name("the noise variance"), var, "counts^2", expected));
        }
        if count + var < LEAST {
            let expected = format!(
                "at least {LEAST:e} where there is no electronic noise; give a noise variance above 0"
            );
            return Err(Error::out_of_range(self.name("the count"), count, "", expected));
        }
        Ok(())
    }
}
