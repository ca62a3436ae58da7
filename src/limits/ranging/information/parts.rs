//! Rows of windows that are made together, and where what is found of them is put.

use super::blocks::Plan;
use super::request::{Cell, InformationMap};
use crate::error::{Error, Result};
use std::ops::Range;

/// Rows of the results; a cell that is not asked for is empty.
#[derive(Debug)]
pub(super) struct Part<'a> {
    /// First rows of the windows.
    pub(super) tops: Range<usize>,
    pub(super) total: &'a mut [f64],
    pub(super) spatial: &'a mut [f64],
    pub(super) spectral: &'a mut [f64],
    pub(super) full: &'a mut [f64],
    pub(super) photons: &'a mut [f64],
    pub(super) var: &'a mut [f64],
}

/// Makes room for `len` values; what they are is not said.
pub(super) fn fit(values: &mut Vec<f64>, len: usize) {
    if values.capacity() < len {
        *values = vec![0.0; len];
    } else {
        values.resize(len, 0.0);
    }
}

impl<'a> Part<'a> {
    /// All windows of a plan, in a map that is made as large as they are.
    pub(super) fn all(map: &'a mut InformationMap, plan: &Plan<'_>) -> Self {
        let half = plan.request.window.half_rows();
        (map.rows, map.columns) = (plan.tops.start + half..plan.tops.end + half, plan.centres());
        let len = map.rows.len() * map.columns.len();
        for (cell, values) in Cell::ALL.into_iter().zip(&mut map.information) {
            fit(values, if plan.wants(cell) { len } else { 0 });
        }
        fit(&mut map.photons, len);
        fit(&mut map.var_added, len);
        let [total, spatial, spectral, full] = &mut map.information;
        let (photons, var) = (&mut map.photons, &mut map.var_added);
        Self { tops: plan.tops.clone(), total, spatial, spectral, full, photons, var }
    }

    /// The same in parts of at most `rows` rows.
    pub(super) fn cut(&mut self, rows: usize) -> Vec<Part<'_>> {
        let width = self.photons.len().checked_div(self.tops.len()).unwrap_or(0);
        let end = self.tops.end;
        let mut rest = [&mut *self.total, self.spatial, self.spectral, self.full, self.photons, self.var];
        let mut take = |tops: &Range<usize>| {
            rest.each_mut().map(|rest| {
                let len = (tops.len() * width).min(rest.len());
                let (taken, left) = std::mem::take(rest).split_at_mut(len);
                *rest = left;
                taken
            })
        };
        let starts = self.tops.clone().step_by(rows);
        starts
            .map(|start| {
                let tops = start..end.min(start + rows);
                let [total, spatial, spectral, full, photons, var] = take(&tops);
                Part { tops, total, spatial, spectral, full, photons, var }
            })
            .collect()
    }

    /// No infinity: counts at the ends of what is allowed side by side.
    pub(super) fn finite(&self) -> Result<()> {
        let cells = [&*self.total, self.spatial, self.spectral, self.full];
        // NaN is what has a missing count in it.
        let infinite = |cell: &[f64]| cell.iter().fold(false, |any, j| any | (*j == f64::INFINITY));
        match cells.into_iter().any(infinite) {
            false => Ok(()),
            true => Err(Error::out_of_range(
                "the information of a window",
                f64::INFINITY,
                "pixel^-2",
                "finite; the counts of neighbouring pixels are too far apart",
            )),
        }
    }
}
