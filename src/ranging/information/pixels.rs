//! Second pass, over the pixels: sums over windows of what the first pass left of each pixel.

use super::blocks::{Plan, run};
use super::boxes::{Along, Image, Stack, along, window_sums};
use super::request::{Cell, InformationMap};
use super::samples::BandSums;
use crate::error::{Error, Result};
use crate::ranging::derivative::Differentiator;
use crate::simd::{Aligned, Chunk, LANES};
use std::ops::Range;

/// Doubles of a pixel: Σ_b (∂N)²/(N + σ²), (Σ_b ∂N)²/Σ_b (N + σ²), Σ_b ∂N, Σ_b N, Σ_b σ², and none.
const RECORD: usize = LANES;

/// Rows of windows of a block.
const BLOCK: usize = 16;

struct Block<'a> {
    tops: Range<usize>,
    total: &'a mut [f64],
    spatial: &'a mut [f64],
    full: &'a mut [f64],
    photons: &'a mut [f64],
    var: &'a mut [f64],
}

#[derive(Default)]
struct Room {
    slopes: Option<Differentiator>,
    stack: Stack,
    slope: Vec<f64>,
    spatial: Vec<f64>,
    sum: Aligned,
    ends: Aligned,
    begin: Aligned,
    windows: Aligned,
}

/// The second pass.
pub(super) fn windows(plan: &Plan<'_>, sums: &BandSums) -> Result<InformationMap> {
    let (columns, half) = (plan.centres(), plan.request.window.half_rows());
    let rows = plan.tops.start + half..plan.tops.end + half;
    let len = rows.len() * columns.len();
    let room = |wanted: bool| vec![0.0; if wanted { len } else { 0 }];
    let [mut total, mut spatial, mut full] =
        [Cell::Total, Cell::Spatial, Cell::Full].map(|cell| room(plan.wants(cell)));
    let (mut photons, mut var) = (room(true), room(true));
    let per_block = (BLOCK * columns.len()).max(1);
    {
        fn parts(values: &mut [f64], len: usize) -> impl Iterator<Item = &mut [f64]> {
            values.chunks_mut(len).chain(std::iter::repeat_with(<&mut [f64]>::default))
        }
        let (mut total, mut spatial) = (parts(&mut total, per_block), parts(&mut spatial, per_block));
        let (mut full, mut var) = (parts(&mut full, per_block), parts(&mut var, per_block));
        let mut photons = parts(&mut photons, per_block);
        let blocks: Vec<Block<'_>> = plan
            .tops
            .clone()
            .step_by(BLOCK)
            .map(|start| Block {
                tops: start..plan.tops.end.min(start + BLOCK),
                total: total.next().unwrap_or_default(),
                spatial: spatial.next().unwrap_or_default(),
                full: full.next().unwrap_or_default(),
                photons: photons.next().unwrap_or_default(),
                var: var.next().unwrap_or_default(),
            })
            .collect();
        run(blocks, |block, room: &mut Room| block.work(plan, sums, room))?;
    }
    Ok(InformationMap {
        rows,
        columns,
        information: [total, spatial, Vec::new(), full],
        photons,
        var_added: var,
    })
}

/// A map without an infinity: counts at the ends of what is allowed side by side.
pub(super) fn finite(map: InformationMap) -> Result<InformationMap> {
    // A sum of terms that are not negative is finite only if all of them are.
    let sums = map.information.iter().map(|cell| crate::sum::sum(cell));
    match sums.into_iter().find(|sum| !sum.is_finite()) {
        None => Ok(map),
        Some(sum) => Err(Error::out_of_range(
            "the information of a window",
            sum,
            "pixel^-2",
            "finite; the counts of neighbouring pixels are too far apart",
        )),
    }
}

impl Block<'_> {
    /// Sums over small windows, one quantity after the other.
    fn small(self, plan: &Plan<'_>, sums: &BandSums, room: &mut Room) -> Result<()> {
        let (window, inner, columns) = (plan.request.window, plan.inner(), plan.shape.columns());
        let (bands, pixels) = (plan.shape.bands() as f64, (window.rows() * window.columns()) as f64);
        let (len, first) = (inner.len(), self.tops.start - plan.tops.start);
        let rows = self.tops.len() + window.rows() - 1;
        let whole = |values| Image { values, pitch: columns, columns: len };
        let part = |values| Image { values, pitch: len, columns: len };
        let start = first * columns + inner.start;
        window_sums(whole(&sums.counts[start..]), window, self.photons);
        let var_pixel = crate::sum::sum(&plan.var_band);
        if plan.var_band.is_empty() {
            window_sums(whole(&sums.variances[start..]), window, self.var);
        } else {
            self.var.fill(pixels * var_pixel);
        }
        if plan.wants(Cell::Full) {
            window_sums(part(&sums.quotients[first * len..]), window, self.full);
        }
        if !plan.wants(Cell::Total) && !plan.wants(Cell::Spatial) {
            return Ok(());
        }
        let slopes = match &mut room.slopes {
            Some(slopes) => slopes,
            none => none.insert(Differentiator::new(plan.request.derivative, columns)?),
        };
        room.slope.resize(rows * len, 0.0);
        for (slope, row) in room.slope.chunks_exact_mut(len).zip(first..) {
            slopes.apply(&sums.counts[row * columns..(row + 1) * columns], 1, slope)?;
        }
        if plan.wants(Cell::Spatial) {
            let share = plan.share(bands);
            room.spatial.resize(rows * len, 0.0);
            let to = room.spatial.chunks_exact_mut(len).zip(room.slope.chunks_exact(len));
            for ((to, slope), row) in to.zip(first..) {
                let at = row * columns + inner.start;
                for ((to, slope), count) in to.iter_mut().zip(slope).zip(&sums.counts[at..]) {
                    *to = slope * slope / (share * var_pixel + count);
                }
                if plan.var_band.is_empty() {
                    let below = sums.counts[at..].iter().zip(&sums.variances[at..]);
                    for ((to, slope), (count, var)) in to.iter_mut().zip(slope).zip(below) {
                        *to = slope * slope / (share * var + count);
                    }
                }
            }
            window_sums(part(&room.spatial), window, self.spatial);
        }
        if plan.wants(Cell::Total) {
            let share = plan.share(bands * pixels);
            window_sums(part(&room.slope), window, self.total);
            for (total, (var, photons)) in self.total.iter_mut().zip(self.var.iter().zip(&*self.photons)) {
                *total = *total * *total / (share * var + photons);
            }
        }
        Ok(())
    }

    fn work(self, plan: &Plan<'_>, sums: &BandSums, room: &mut Room) -> Result<()> {
        if plan.small_windows() {
            return self.small(plan, sums, room);
        }
        let (window, inner) = (plan.request.window, plan.inner());
        let columns = plan.shape.columns();
        if room.slopes.is_none() {
            room.slopes = Some(Differentiator::new(plan.request.derivative, columns)?);
        }
        room.stack.start(window.rows(), inner.len() * RECORD, self.tops.start);
        room.slope.resize(inner.len(), 0.0);
        for row in [&mut room.sum, &mut room.ends, &mut room.windows] {
            row.set_len(inner.len() * RECORD);
        }
        room.begin.set_len(RECORD);
        let place = Along { stride: RECORD, width: window.columns(), first: inner.start };
        let centres = plan.centres().len();
        let pixels = (window.rows() * window.columns()) as f64;
        let bands = plan.shape.bands() as f64;
        let var_pixel: f64 = crate::sum::sum(&plan.var_band);
        let (share_pixel, share_window) = (plan.share(bands), plan.share(bands * pixels));
        let var_window = |sum: f64| if plan.var_band.is_empty() { sum } else { pixels * var_pixel };
        let Self { tops, total, spatial, full, photons, var } = self;
        let cells = [plan.wants(Cell::Total), plan.wants(Cell::Spatial), plan.wants(Cell::Full)];
        for y in tops.start..tops.end + window.rows() - 1 {
            let row = y - plan.tops.start;
            let counts = &sums.counts[row * columns..(row + 1) * columns];
            if let Some(slopes) = &mut room.slopes
                && (cells[0] || cells[1])
            {
                slopes.apply(counts, 1, &mut room.slope)?;
            }
            let records = room.stack.row(y).as_chunks_mut::<RECORD>().0;
            for (x, record) in records.iter_mut().enumerate() {
                let count = counts[inner.start + x];
                let own = || sums.variances[row * columns + inner.start + x];
                let var = if plan.var_band.is_empty() { own() } else { var_pixel };
                let slope = room.slope[x];
                let full = if cells[2] { sums.quotients[row * inner.len() + x] } else { 0.0 };
                let spatial = if cells[1] { slope * slope / (share_pixel * var + count) } else { 0.0 };
                let of: Chunk = [full, spatial, slope, count, var, 0.0, 0.0, 0.0];
                *record = of;
            }
            room.stack.push(y);
            if y + 1 >= tops.start + window.rows() {
                room.stack.sum(y, &mut room.sum);
                along(&room.sum, place, &mut room.ends, &mut room.begin, &mut room.windows);
                let row = (y + 1 - window.rows() - tops.start) * centres;
                let windows = &room.windows.as_chunks::<RECORD>().0[..centres];
                for (to, of) in photons[row..].iter_mut().zip(windows) {
                    *to = of[3];
                }
                for (to, of) in var[row..].iter_mut().zip(windows) {
                    *to = var_window(of[4]);
                }
                if cells[0] {
                    for (to, of) in total[row..].iter_mut().zip(windows) {
                        *to = of[2] * of[2] / (share_window * var_window(of[4]) + of[3]);
                    }
                }
                if cells[1] {
                    for (to, of) in spatial[row..].iter_mut().zip(windows) {
                        *to = of[1];
                    }
                }
                if cells[2] {
                    for (to, of) in full[row..].iter_mut().zip(windows) {
                        *to = of[0];
                    }
                }
            }
            room.stack.finish(y);
        }
        Ok(())
    }
}
