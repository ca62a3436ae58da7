//! Second pass, over the pixels: sums over windows of what the first pass left of each pixel.
//!
//! With n = Σ_b N, v = Σ_b σ² and q = Σ_b (∂N)²/(N + σ²) of a pixel, ∂n the derivative of the row of n, and the share
//! s of v that counts where samples are joined ([`Plan::share`]):
//!
//! * both resolutions: J = Σ_p q
//! * spatial alone:    J = Σ_p (∂n)²/(s v + n)
//! * neither:          J = (Σ_p ∂n)²/(s Σ_p v + Σ_p n)
//!
//! Small windows are summed quantity by quantity, row by row and then column by column; larger ones in two levels
//! ([`super::boxes`]), all quantities of a pixel side by side in one vector, a record.

use super::blocks::Plan;
use super::boxes::{Along, Image, Stack, along, window_sums};
use super::parts::Part;
use super::request::Cell;
use super::samples::BandSums;
use crate::aligned::Aligned;
use crate::error::Result;
use crate::ranging::derivative::Differentiator;
use crate::simd::{Chunk, LANES};
use std::ops::Range;

/// Doubles of a pixel: Σ_b (∂N)²/(N + σ²), (Σ_b ∂N)²/Σ_b (N + σ²), Σ_b ∂N, Σ_b N, Σ_b σ², and none.
const RECORD: usize = LANES;

/// Rows of windows that are summed at a time.
const BLOCK: usize = 16;

/// What a thread keeps from part to part.
#[derive(Default)]
pub(super) struct Room {
    slopes: Option<Differentiator>,
    stack: Stack,
    slope: Vec<f64>,
    spatial: Vec<f64>,
    sum: Aligned,
    ends: Aligned,
    begin: Aligned,
    windows: Aligned,
}

/// The second pass, over a part of a plan; `sums` are of all its rows.
pub(super) fn windows(plan: &Plan<'_>, sums: &BandSums, part: &mut Part<'_>, room: &mut Room) -> Result<()> {
    part.cut(BLOCK).into_iter().try_for_each(|part| match plan.small_windows() {
        true => part.small(plan, sums, room),
        false => part.large(plan, sums, room),
    })
}

impl Room {
    /// What takes derivatives of rows.
    fn slopes(&mut self, plan: &Plan<'_>) -> Result<&mut Differentiator> {
        Ok(match &mut self.slopes {
            Some(slopes) => slopes,
            none => none.insert(Differentiator::new(plan.request.derivative, plan.shape.columns())?),
        })
    }

    /// ∂n of some rows, one after the other, as many as a block's windows have.
    fn slope_rows(&mut self, plan: &Plan<'_>, sums: &BandSums, rows: Range<usize>) -> Result<()> {
        let (len, columns) = (plan.inner().len(), plan.shape.columns());
        let mut slope = std::mem::take(&mut self.slope);
        slope.resize(rows.len() * len, 0.0);
        let slopes = self.slopes(plan)?;
        for (slope, row) in slope.chunks_exact_mut(len).zip(rows) {
            slopes.apply(&sums.counts[row * columns..(row + 1) * columns], 1, slope)?;
        }
        self.slope = slope;
        Ok(())
    }

    /// (∂n)²/(s v + n) of the same rows.
    fn spatial_rows(&mut self, plan: &Plan<'_>, sums: &BandSums, rows: Range<usize>) {
        let (inner, columns, share) = (plan.inner(), plan.shape.columns(), plan.share(plan.bands()));
        let len = inner.len();
        let var_pixel = crate::sum::sum(&plan.var_band);
        self.spatial.resize(rows.len() * len, 0.0);
        let to = self.spatial.chunks_exact_mut(len).zip(self.slope.chunks_exact(len));
        for ((to, slope), row) in to.zip(rows) {
            let at = row * columns + inner.start;
            let pixels = to.iter_mut().zip(slope).zip(&sums.counts[at..]);
            if plan.var_band.is_empty() {
                for (((to, slope), count), var) in pixels.zip(&sums.variances[at..]) {
                    *to = slope * slope / (share * var + count);
                }
            } else {
                for ((to, slope), count) in pixels {
                    *to = slope * slope / (share * var_pixel + count);
                }
            }
        }
    }

    /// Makes the records of row `y` of pixels, row `row` of the first pass, and takes them into the sums.
    fn record(&mut self, plan: &Plan<'_>, sums: &BandSums, y: usize, row: usize) -> Result<()> {
        let (inner, columns) = (plan.inner(), plan.shape.columns());
        let [full, spatial] = [Cell::Full, Cell::Spatial].map(|cell| plan.wants(cell));
        if spatial || plan.wants(Cell::Total) {
            self.slope_rows(plan, sums, row..row + 1)?;
        }
        let counts = &sums.counts[row * columns..(row + 1) * columns];
        let (share, var_pixel) = (plan.share(plan.bands()), crate::sum::sum(&plan.var_band));
        let records = self.stack.row(y).as_chunks_mut::<RECORD>().0;
        for (x, record) in records.iter_mut().enumerate() {
            let count = counts[inner.start + x];
            let own = || sums.variances[row * columns + inner.start + x];
            let var = if plan.var_band.is_empty() { own() } else { var_pixel };
            let slope = self.slope[x];
            let full = if full { sums.quotients[row * inner.len() + x] } else { 0.0 };
            let spatial = if spatial { slope * slope / (share * var + count) } else { 0.0 };
            let of: Chunk = [full, spatial, slope, count, var, 0.0, 0.0, 0.0];
            *record = of;
        }
        self.stack.push(y);
        Ok(())
    }
}

impl Part<'_> {
    /// Sums over small windows, one quantity after the other.
    fn small(self, plan: &Plan<'_>, sums: &BandSums, room: &mut Room) -> Result<()> {
        let (window, inner, columns) = (plan.request.window, plan.inner(), plan.shape.columns());
        let (len, first) = (inner.len(), self.tops.start - plan.tops.start);
        let rows = first..first + self.tops.len() + window.rows() - 1;
        // Of all columns, and of those with a derivative.
        let whole = |values| Image { values, pitch: columns, columns: len };
        let part = |values| Image { values, pitch: len, columns: len };
        let start = first * columns + inner.start;
        window_sums(whole(&sums.counts[start..]), window, self.photons);
        if plan.var_band.is_empty() {
            window_sums(whole(&sums.variances[start..]), window, self.var);
        } else {
            self.var.fill(plan.pixels() * crate::sum::sum(&plan.var_band));
        }
        if plan.wants(Cell::Full) {
            window_sums(part(&sums.quotients[first * len..]), window, self.full);
        }
        if plan.wants(Cell::Total) || plan.wants(Cell::Spatial) {
            room.slope_rows(plan, sums, rows.clone())?;
        }
        if plan.wants(Cell::Spatial) {
            room.spatial_rows(plan, sums, rows);
            window_sums(part(&room.spatial), window, self.spatial);
        }
        if plan.wants(Cell::Total) {
            let share = plan.share(plan.bands() * plan.pixels());
            window_sums(part(&room.slope), window, self.total);
            for (total, (var, photons)) in self.total.iter_mut().zip(self.var.iter().zip(&*self.photons)) {
                *total = *total * *total / (share * var + photons);
            }
        }
        Ok(())
    }

    /// Sums over larger windows, all quantities together.
    fn large(mut self, plan: &Plan<'_>, sums: &BandSums, room: &mut Room) -> Result<()> {
        let (window, inner) = (plan.request.window, plan.inner());
        room.stack.start(window.rows(), inner.len() * RECORD, self.tops.start);
        room.slope.resize(inner.len(), 0.0);
        for row in [&mut room.sum, &mut room.ends, &mut room.windows] {
            row.set_len(inner.len() * RECORD);
        }
        room.begin.set_len(RECORD);
        let place = Along { stride: RECORD, width: window.columns(), first: inner.start };
        for y in self.tops.start..self.tops.end + window.rows() - 1 {
            room.record(plan, sums, y, y - plan.tops.start)?;
            if let Some(row) = (y + 1).checked_sub(self.tops.start + window.rows()) {
                room.stack.sum(y, &mut room.sum);
                along(&room.sum, place, &mut room.ends, &mut room.begin, &mut room.windows);
                let centres = plan.centres().len();
                self.put(plan, row * centres, &room.windows.as_chunks::<RECORD>().0[..centres]);
            }
            room.stack.finish(y);
        }
        Ok(())
    }

    /// Puts the sums of a row of windows into the results, from place `start` on.
    fn put(&mut self, plan: &Plan<'_>, start: usize, windows: &[Chunk]) {
        let var_all = plan.pixels() * crate::sum::sum(&plan.var_band);
        let var_window = |sum: f64| if plan.var_band.is_empty() { sum } else { var_all };
        let share = plan.share(plan.bands() * plan.pixels());
        fn put(to: &mut [f64], windows: &[Chunk], value: impl Fn(&Chunk) -> f64) {
            for (to, of) in to.iter_mut().zip(windows) {
                *to = value(of);
            }
        }
        put(&mut self.photons[start..], windows, |of| of[3]);
        put(&mut self.var[start..], windows, |of| var_window(of[4]));
        if plan.wants(Cell::Total) {
            put(&mut self.total[start..], windows, |of| of[2] * of[2] / (share * var_window(of[4]) + of[3]));
        }
        if plan.wants(Cell::Spatial) {
            put(&mut self.spatial[start..], windows, |of| of[1]);
        }
        if plan.wants(Cell::Full) {
            put(&mut self.full[start..], windows, |of| of[0]);
        }
    }
}
