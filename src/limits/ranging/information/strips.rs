//! One row of a strip of columns: what it gives of its pixels, and of the windows that end with it.
//!
//! Of every pixel, over its bands b: Σ_b N, Σ_b σ², and the quotients Σ_b (∂N)²/(N + σ²). Of every window, with the sums
//! over its pixels p taken band by band first: Σ_b (Σ_p ∂N)²/Σ_p (N + σ²). There are two ways to each.
//!
//! | | straight from the rows as stored (`direct`) | from widened rows |
//! |---|---|---|
//! | for | the central difference and variances per band; small windows | all else |
//! | pixels | [`StripRoom::direct_pixels`], with a check on the way | [`StripRoom::widen`], then [`StripRoom::quotients`] |
//! | windows | [`StripRoom::direct_windows`], over the window's rows anew | [`StripRoom::windows`], over a [`Stack`] of rows |
//!
//! Where the derivative is not the central difference, it is taken of whole rows ([`Differentiator`]); it is linear, so that
//! Σ_p ∂N is the window sum of the derivative of the summed rows.

use super::blocks::{Plan, Strip};
use super::boxes::{Along, Stack, add_to, along, grow};
use super::checks::Checked;
use super::direct::{Lanes, Pixels, windows};
use super::kernels::{Below, ratios, ratios_central, ratios_ends, totals};
use super::request::Cell;
use crate::aligned::Aligned;
use crate::error::Result;
use crate::ranging::derivative::Differentiator;
use crate::simd::{Chunk, LANES};

/// A row of the cube within a strip.
#[derive(Clone, Copy)]
pub(super) struct StripRow<'a> {
    pub(super) y: usize,
    pub(super) plan: &'a Plan<'a>,
    pub(super) strip: &'a Strip,
    pub(super) checked: &'a Checked<'a>,
}

impl StripRow<'_> {
    /// Whether every sample has a variance of its own.
    pub(super) fn variances(&self) -> bool {
        self.checked.variances.is_some()
    }
}

/// What a thread keeps from row to row.
#[derive(Default)]
pub(super) struct StripRoom {
    slopes: Option<Differentiator>,
    /// Widened rows, as many as a window has.
    counts: Stack,
    variances: Stack,
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
    /// Makes what takes derivatives, once for all strips.
    pub(super) fn prepare(&mut self, plan: &Plan<'_>) -> Result<()> {
        if !plan.central() && self.slopes.is_none() {
            self.slopes = Some(Differentiator::new(plan.request.derivative, plan.shape.columns())?);
        }
        Ok(())
    }

    /// Begins a strip with row `first`.
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

    /// Widens and checks a row.
    pub(super) fn widen(&mut self, row: StripRow<'_>) -> Result<()> {
        let StripRow { y, plan, strip, checked } = row;
        let bands = plan.shape.bands();
        let start = checked.at(y, strip.read.start);
        let seen = checked.counts.widen(start, bands, self.counts.row(y));
        let seen_var = checked.variances.map(|raw| raw.widen(start, bands, self.variances.row(y)));
        checked.look((y, strip.read.clone()), seen, seen_var)
    }

    /// Takes a widened row into the sums over rows, before the windows that end with it are summed.
    pub(super) fn push(&mut self, row: StripRow<'_>) {
        self.counts.push(row.y);
        if row.variances() {
            self.variances.push(row.y);
        }
    }

    /// The same, after them.
    pub(super) fn finish(&mut self, row: StripRow<'_>) {
        self.counts.finish(row.y);
        if row.variances() {
            self.variances.finish(row.y);
        }
    }

    /// Σ_b N of each pixel, and its quotients if there is room for them.
    pub(super) fn direct_pixels(
        &mut self,
        row: StripRow<'_>,
        to_totals: Option<&mut [f64]>,
        ratios: &mut [f64],
    ) -> Result<()> {
        let StripRow { y, plan, strip, checked } = row;
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
        checked.look((y, own.clone()), checked.counts.pixels(start, plan.shape.bands(), to), None)?;
        if let Some(to) = to_totals {
            to.copy_from_slice(&self.totals[strip.totals.start - own.start..strip.totals.end - own.start]);
        }
        Ok(())
    }

    /// The quotients of small windows that end with a row.
    pub(super) fn direct_windows(&mut self, row: StripRow<'_>, to: &mut [f64]) {
        let StripRow { y, plan, strip, checked } = row;
        let window = plan.request.window;
        let len = strip.read.len() * plan.stride;
        grow(&mut self.sum, len);
        let start = checked.at(y + 1 - window.rows(), strip.read.start);
        let rows = (plan.shape.row_len(), window.rows());
        checked.counts.sum_rows(start, rows, plan.shape.bands(), &mut self.sum[..len]);
        windows(&self.sum[..len], window.columns(), &plan.var_window, &mut self.direct, to);
    }

    /// Σ_b N of each pixel of a widened row, and Σ_b σ² if every sample has its own.
    pub(super) fn band_sums(&mut self, row: StripRow<'_>, counts: &mut [f64], variances: &mut [f64]) {
        let StripRow { y, plan, strip, .. } = row;
        let first = strip.read.start;
        let samples = (strip.totals.start - first) * plan.stride..(strip.totals.end - first) * plan.stride;
        totals(&self.counts.row(y)[samples.clone()], plan.stride, &mut self.lanes, counts);
        if row.variances() {
            totals(&self.variances.row(y)[samples], plan.stride, &mut self.lanes, variances);
        }
    }

    /// The quotients of each pixel of a widened row.
    pub(super) fn quotients(&mut self, row: StripRow<'_>, to: &mut [f64]) -> Result<()> {
        let StripRow { y, plan, strip, .. } = row;
        let stride = plan.stride;
        let from = strip.quotients.start - strip.read.start;
        let samples = from * stride..(from + strip.quotients.len()) * stride;
        let counts = &self.counts.row(y)[..];
        let below = if row.variances() {
            self.below[..counts.len()].copy_from_slice(counts);
            add_to(self.variances.row(y), &mut self.below);
            &self.below[samples]
        } else {
            &counts[samples]
        };
        let mut of = Below { below, var: &plan.var_sample, derivative: &[], stride };
        if let Some(slopes) = &mut self.slopes {
            let len = plan.inner().len() * stride;
            slopes.apply(counts, stride, &mut self.slope[..len])?;
            of.derivative = &self.slope[..len];
            ratios(of, &mut self.lanes, to);
        } else {
            ratios_central(&counts[(from - 1) * stride..], of, &mut self.lanes, to);
        }
        Ok(())
    }

    /// The quotients of the windows that end with a row that has been pushed.
    pub(super) fn windows(&mut self, row: StripRow<'_>, to: &mut [f64]) -> Result<()> {
        let StripRow { y, plan, strip, .. } = row;
        let stride = plan.stride;
        let width = plan.request.window.columns();
        let len = strip.read.len() * stride;
        // Over the rows of the windows.
        self.counts.sum(y, &mut self.sum[..len]);
        let inside = plan.margin * stride..(strip.read.len() - plan.margin) * stride;
        let below = if row.variances() {
            let share = plan.share(plan.pixels());
            self.variances.sum(y, &mut self.below[..len]);
            for (below, count) in self.below[..len].iter_mut().zip(self.sum.iter()) {
                *below = share * *below + *count;
            }
            &self.below[inside]
        } else {
            &self.sum[inside]
        };
        // Over their columns.
        let place = Along { stride, width, first: strip.read.start + plan.margin };
        along(below, place, &mut self.ends, &mut self.begin, &mut self.below_sums);
        let windows = strip.centres.len() * stride;
        let mut of =
            Below { below: &self.below_sums[..windows], var: &plan.var_window, derivative: &[], stride };
        if let Some(slopes) = &mut self.slopes {
            let inner = plan.inner().len() * stride;
            slopes.apply(&self.sum[..len], stride, &mut self.slope[..inner])?;
            along(&self.slope[..inner], place, &mut self.ends, &mut self.begin, &mut self.slope_sums);
            of.derivative = &self.slope_sums[..windows];
            ratios(of, &mut self.lanes, to);
        } else {
            ratios_ends(&self.sum[..len], width, of, &mut self.lanes, to);
        }
        Ok(())
    }
}
