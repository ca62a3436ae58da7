//! What a thread keeps of the rows of a strip of columns, and what it makes of them.

use super::blocks::{Plan, Strip};
use super::boxes::{Along, Stack, add_to, along, grow};
use super::checks::Checked;
use super::direct::{Lanes, Pixels, windows};
use super::kernels::{Below, ratios, ratios_central, ratios_ends};
use super::request::Cell;
use crate::error::Result;
use crate::ranging::derivative::Differentiator;
use crate::simd::{Aligned, Chunk, LANES};

#[derive(Default)]
pub(super) struct StripRoom {
    slopes: Option<Differentiator>,
    pub(super) counts: Stack,
    pub(super) variances: Stack,
    /// Σ of the counts over the rows of windows.
    sum: Aligned,
    /// What stands below the fraction.
    below: Aligned,
    slope: Aligned,
    /// Sums over windows of `below`, and of `slope`.
    below_sums: Aligned,
    slope_sums: Aligned,
    ends: Aligned,
    begin: Aligned,
    pub(super) lanes: Vec<Chunk>,
    /// Of a row of pixels, and of windows.
    direct: Lanes,
    totals: Vec<f64>,
}

impl StripRoom {
    pub(super) fn prepare(&mut self, plan: &Plan<'_>) -> Result<()> {
        if !plan.central() && self.slopes.is_none() {
            self.slopes = Some(Differentiator::new(plan.request.derivative, plan.shape.columns())?);
        }
        Ok(())
    }

    /// Widens and checks row `y` of a strip.
    pub(super) fn widen(
        &mut self,
        y: usize,
        plan: &Plan<'_>,
        strip: &Strip,
        checked: &Checked<'_>,
    ) -> Result<()> {
        let bands = plan.shape.bands();
        let start = checked.at(y, strip.read.start);
        let seen = checked.counts.widen(start, bands, self.counts.row(y));
        let seen_var = checked.variances.map(|raw| raw.widen(start, bands, self.variances.row(y)));
        checked.look(seen, seen_var)
    }

    pub(super) fn start(&mut self, plan: &Plan<'_>, strip: &Strip, first: usize, variances: bool) {
        let len = strip.read.len() * plan.stride;
        let height = if plan.wants(Cell::Spectral) { plan.request.window.rows() } else { 1 };
        self.counts.start(height, len, first);
        if variances {
            self.variances.start(height, len, first);
        }
        for row in [
            &mut self.sum,
            &mut self.below,
            &mut self.slope,
            &mut self.below_sums,
            &mut self.slope_sums,
            &mut self.ends,
        ] {
            grow(row, len);
        }
        self.begin.set_len(plan.stride);
        if self.lanes.len() < strip.read.len() {
            self.lanes.resize(strip.read.len(), [0.0; LANES]);
        }
    }

    /// The sums and, if there is room for them, the quotients of row `y` over the bands of each pixel.
    pub(super) fn pixels(
        &mut self,
        y: usize,
        plan: &Plan<'_>,
        strip: &Strip,
        checked: &Checked<'_>,
        to_totals: Option<&mut [f64]>,
        ratios: &mut [f64],
    ) -> Result<()> {
        // With the columns on either side that a difference takes.
        let stacked = plan.wants(Cell::Spectral) && !plan.direct_windows();
        let own =
            if stacked { strip.read.clone() } else { strip.quotients.start - 1..strip.quotients.end + 1 };
        self.totals.resize(own.len(), 0.0);
        let len = own.len() * plan.stride;
        let wide = if stacked {
            self.counts.row(y)
        } else {
            grow(&mut self.below, len);
            &mut self.below[..len]
        };
        let start = checked.at(y, own.start);
        let to =
            Pixels { var: &plan.var_sample, wide, totals: &mut self.totals, ratios, lanes: &mut self.direct };
        checked.look(checked.counts.pixels(start, plan.shape.bands(), to), None)?;
        if let Some(to) = to_totals {
            to.copy_from_slice(&self.totals[strip.totals.start - own.start..strip.totals.end - own.start]);
        }
        Ok(())
    }

    /// The quotients of small windows that end with row `y`, over their bands.
    pub(super) fn direct(
        &mut self,
        y: usize,
        plan: &Plan<'_>,
        strip: &Strip,
        checked: &Checked<'_>,
        to: &mut [f64],
    ) {
        let window = plan.request.window;
        let len = strip.read.len() * plan.stride;
        grow(&mut self.sum, len);
        let start = checked.at(y + 1 - window.rows(), strip.read.start);
        let rows = (plan.shape.row_len(), window.rows());
        checked.counts.sum_rows(start, rows, plan.shape.bands(), &mut self.sum[..len]);
        windows(&self.sum[..len], window.columns(), &plan.var_window, &mut self.direct, to);
    }

    /// The quotients of row `y`, over the bands of each pixel.
    pub(super) fn quotients(
        &mut self,
        y: usize,
        plan: &Plan<'_>,
        strip: &Strip,
        variances: bool,
        to: &mut [f64],
    ) -> Result<()> {
        let stride = plan.stride;
        let from = strip.quotients.start - strip.read.start;
        let samples = from * stride..(from + strip.quotients.len()) * stride;
        let row = &self.counts.row(y)[..];
        let below = if variances {
            self.below[..row.len()].copy_from_slice(row);
            add_to(self.variances.row(y), &mut self.below);
            &self.below[samples]
        } else {
            &row[samples]
        };
        let mut of = Below { below, var: &plan.var_sample, derivative: &[], stride };
        if let Some(slopes) = &mut self.slopes {
            let len = plan.inner().len() * stride;
            slopes.apply(row, stride, &mut self.slope[..len])?;
            of.derivative = &self.slope[..len];
            ratios(of, &mut self.lanes, to);
        } else {
            ratios_central(&row[(from - 1) * stride..], of, &mut self.lanes, to);
        }
        Ok(())
    }

    /// The quotients of the windows that end with row `y`, over their bands.
    pub(super) fn spectral(
        &mut self,
        y: usize,
        plan: &Plan<'_>,
        strip: &Strip,
        variances: bool,
        to: &mut [f64],
    ) -> Result<()> {
        let stride = plan.stride;
        let width = plan.request.window.columns();
        let len = strip.read.len() * stride;
        self.counts.sum(y, &mut self.sum[..len]);
        let inside = plan.margin * stride..(strip.read.len() - plan.margin) * stride;
        let below = if variances {
            let share = plan.share((plan.request.window.rows() * width) as f64);
            self.variances.sum(y, &mut self.below[..len]);
            for (below, count) in self.below[..len].iter_mut().zip(self.sum.iter()) {
                *below = share * *below + *count;
            }
            &self.below[inside]
        } else {
            &self.sum[inside]
        };
        let place = Along { stride, width, first: strip.read.start + plan.margin };
        along(below, place, &mut self.ends, &mut self.begin, &mut self.below_sums);
        let windows = strip.centres.len() * stride;
        let mut of =
            Below { below: &self.below_sums[..windows], var: &plan.var_window, derivative: &[], stride };
        if let Some(slopes) = &mut self.slopes {
            let len = plan.inner().len() * stride;
            slopes.apply(&self.sum[..strip.read.len() * stride], stride, &mut self.slope[..len])?;
            along(&self.slope[..len], place, &mut self.ends, &mut self.begin, &mut self.slope_sums);
            of.derivative = &self.slope_sums[..windows];
            ratios(of, &mut self.lanes, to);
        } else {
            ratios_ends(&self.sum[..len], width, of, &mut self.lanes, to);
        }
        Ok(())
    }
}
