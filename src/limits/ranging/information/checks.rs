//! Rows as they were read, and the close look at them that a suspicion of what was seen on the way leads to.

use super::blocks::Plan;
use super::kernels::Seen;
use super::limits::{LEAST, Place};
use super::rows::Raw;
use crate::cube::Shape;
use crate::error::Result;
use std::ops::Range;

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
