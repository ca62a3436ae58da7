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
    /// Whether a count may be NaN, which makes what is made of it NaN.
    pub(super) may_miss: bool,
}

impl<'a> Checked<'a> {
    pub(super) fn new(
        plan: &'a Plan<'_>,
        rows: (usize, usize),
        counts: Raw<'a>,
        variances: Option<Raw<'a>>,
    ) -> Self {
        let zero_matters = variances.is_some() || plan.var_band.iter().any(|var| *var < LEAST);
        let may_miss = true;
        Self { shape: plan.shape, rows, counts, variances, var_band: &plan.var_band, zero_matters, may_miss }
    }

    /// The same where no count may be missing.
    pub(super) fn complete(self) -> Self {
        Self { may_miss: false, ..self }
    }

    /// Place of the first sample of a pixel among those read.
    pub(super) fn at(&self, row: usize, column: usize) -> usize {
        (row - self.rows.0) * self.shape.row_len() + column * self.shape.bands()
    }

    /// Looks closely if what was seen on the way, in columns of a row, is not beyond doubt; the first offending sample of all
    /// the rows read is named.
    pub(super) fn look(
        &self,
        (row, columns): (usize, Range<usize>),
        counts: Seen,
        variances: Option<Seen>,
    ) -> Result<()> {
        let sound = counts.sound && variances.is_none_or(|seen| seen.sound);
        if sound && (!self.zero_matters || counts.least >= LEAST) {
            return Ok(());
        }
        // Where counts are missing they are in many rows: each is looked at by itself, unless there is more to say.
        if self.may_miss && self.closely(row..row + 1, columns).is_ok() {
            return Ok(());
        }
        self.closely(self.rows.0..self.rows.1, 0..self.shape.columns())
    }

    fn closely(&self, rows: Range<usize>, columns: Range<usize>) -> Result<()> {
        crate::stop::check();
        for row in rows {
            let samples = self.at(row, columns.start)..self.at(row, columns.end);
            if self.may_miss && !self.zero_matters && self.counts.all_counts_or_missing(samples) {
                continue;
            }
            for column in columns.clone() {
                for band in 0..self.shape.bands() {
                    let at = (row - self.rows.0) * self.shape.row_len() + column * self.shape.bands() + band;
                    let count = self.counts.get(at);
                    if self.may_miss && count.is_nan() {
                        continue;
                    }
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
