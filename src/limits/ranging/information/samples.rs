//! First pass, over the samples: of every pixel the sums over its bands, of every window the information of its bands.
//!
//! | of | what | for |
//! |---|---|---|
//! | pixels | Σ_b N, Σ_b σ² | all cells |
//! | pixels | Σ_b (∂N)²/(N + σ²) | both resolutions |
//! | windows | Σ_b (Σ_p ∂N)²/Σ_p (N + σ²) | spectral alone |
//!
//! Some rows are read at a time, on to the end of their last window, and worked on in strips of columns, so that what is kept of
//! the last rows (as many as a window has) stays in cache ([`super::strips`]; for the sums over windows see [`super::boxes`]).

use super::blocks::{Plan, Strip};
use super::checks::Checked;
use super::parts::fit;
use super::request::Cell;
use super::rows::Buffer;
use super::strips::{StripRoom, StripRow};
use crate::cube::CubeRef;
use crate::error::Result;
use crate::ranging::noise::NoiseVariance;
use std::ops::Range;

/// Sums over the bands of pixels.
#[derive(Debug, Default)]
pub(super) struct BandSums {
    /// Σ_b (∂N)²/(N + σ²), `[row][column]` of the pixels in windows with a derivative; empty unless asked for.
    pub(super) quotients: Vec<f64>,
    /// Σ_b N, `[row][column]`, all columns.
    pub(super) counts: Vec<f64>,
    /// Σ_b σ², likewise; empty unless every sample has its own.
    pub(super) variances: Vec<f64>,
}

/// The first pass over all rows of a plan: the sums over bands, and Σ_b (Σ_p ∂N)²/Σ_p (N + σ²), `[row][column]` of the windows,
/// where there is room for it.
pub(super) fn band_sums(
    cube: CubeRef<'_>,
    plan: &Plan<'_>,
    room: &mut Room,
    sums: &mut BandSums,
    spectral: &mut [f64],
) -> Result<()> {
    let (rows, inner, columns) = (plan.rows(), plan.inner().len(), plan.shape.columns());
    fit(&mut sums.quotients, if plan.wants(Cell::Full) { rows.len() * inner } else { 0 });
    fit(&mut sums.counts, rows.len() * columns);
    fit(&mut sums.variances, if plan.var_band.is_empty() { rows.len() * columns } else { 0 });
    let (mut start, strips) = (plan.tops.start, plan.strips());
    while start < plan.tops.end {
        let end = plan.tops.end.min(start + plan.read_rows());
        let owned = start..if end == plan.tops.end { rows.end } else { end };
        let last = if plan.wants(Cell::Spectral) { end + plan.request.window.rows() - 1 } else { 0 };
        let read = owned.start..owned.end.max(last);
        let mut to = Results { tops: start..end, owned, first: plan.tops.start, sums, spectral };
        to.take_rows(cube, plan, &strips, read, room)?;
        start = end;
    }
    Ok(())
}

/// The quotients of one row of pixels, in some of the strips of a plan for [`Cell::Full`] alone; `to` is for all
/// columns with a derivative.
pub(super) fn pixels_of_row(
    cube: CubeRef<'_>,
    plan: &Plan<'_>,
    y: usize,
    strips: &[&Strip],
    room: &mut Room,
    to: &mut [f64],
) -> Result<()> {
    crate::stop::check();
    let counts = room.counts.read(cube, y..y + 1)?;
    let variances = match plan.request.noise {
        NoiseVariance::PerSample(cube) => Some(room.variances.read(cube.into(), y..y + 1)?),
        _ => None,
    };
    let checked = Checked::new(plan, (y, y + 1), counts, variances).complete();
    room.strip.prepare(plan)?;
    for strip in strips {
        let to = &mut to[strip.quotients.start - plan.margin..strip.quotients.end - plan.margin];
        let row = StripRow { y, plan, strip, checked: &checked };
        if plan.direct() {
            room.strip.direct_pixels(row, None, to)?;
            continue;
        }
        room.strip.start(plan, strip, y, variances.is_some());
        room.strip.widen(row)?;
        room.strip.quotients(row, to)?;
    }
    Ok(())
}

/// Upper bounds of the quotients of one row of pixels, likewise; with the central difference.
pub(super) fn bounds_of_row(
    cube: CubeRef<'_>,
    plan: &Plan<'_>,
    y: usize,
    strips: &[&Strip],
    room: &mut Room,
    to: &mut [f64],
) -> Result<()> {
    crate::stop::check();
    let (counts, bands) = (room.counts.read(cube, y..y + 1)?, plan.shape.bands());
    // Variances of single samples are not read: 0 is below all of them.
    let least = plan.var_band.iter().copied().reduce(f64::min).unwrap_or(0.0);
    for strip in strips {
        let to = &mut to[strip.quotients.start - plan.margin..strip.quotients.end - plan.margin];
        counts.bounds((strip.quotients.start - 1) * bands, bands, least, &mut room.strip.lanes, to);
    }
    Ok(())
}

/// What a thread keeps from block to block.
#[derive(Default)]
pub(super) struct Room {
    counts: Buffer,
    variances: Buffer,
    strip: StripRoom,
}

/// Where the results of rows are put.
struct Results<'a> {
    /// First rows of the windows, and the rows of pixels that are made now.
    tops: Range<usize>,
    owned: Range<usize>,
    /// The row that the results begin with.
    first: usize,
    sums: &'a mut BandSums,
    spectral: &'a mut [f64],
}

impl Results<'_> {
    fn take_rows(
        &mut self,
        cube: CubeRef<'_>,
        plan: &Plan<'_>,
        strips: &[Strip],
        read: Range<usize>,
        room: &mut Room,
    ) -> Result<()> {
        crate::stop::check();
        let counts = room.counts.read(cube, read.clone())?;
        let variances = match plan.request.noise {
            NoiseVariance::PerSample(cube) => Some(room.variances.read(cube.into(), read.clone())?),
            _ => None,
        };
        let checked = Checked::new(plan, (read.start, read.end), counts, variances);
        room.strip.prepare(plan)?;
        for strips in strips.chunks(plan.strips_together()) {
            if let ([strip], false) = (strips, plan.direct_windows()) {
                room.strip.start(plan, strip, read.start, variances.is_some());
            }
            for y in read.clone() {
                crate::stop::check();
                for strip in strips {
                    self.take_in(StripRow { y, plan, strip, checked: &checked }, &mut room.strip)?;
                }
            }
        }
        Ok(())
    }

    /// Takes a row of a strip into the sums.
    fn take_in(&mut self, row: StripRow<'_>, room: &mut StripRoom) -> Result<()> {
        let StripRow { y, plan, .. } = row;
        if self.owned.contains(&y) {
            self.pixels(row, room)?;
        } else if !plan.direct_windows() {
            room.widen(row)?;
        }
        if plan.wants(Cell::Spectral) { self.windows(row, room) } else { Ok(()) }
    }

    /// Sums and quotients over the bands of each pixel.
    fn pixels(&mut self, row: StripRow<'_>, room: &mut StripRoom) -> Result<()> {
        let StripRow { y, plan, strip, .. } = row;
        let (columns, inner) = (plan.shape.columns(), plan.inner().len());
        let own = y - self.first;
        let to_totals = own * columns + strip.totals.start..own * columns + strip.totals.end;
        let to_ratios = if plan.wants(Cell::Full) {
            let [from, to] = [strip.quotients.start, strip.quotients.end].map(|x| x - plan.margin);
            own * inner + from..own * inner + to
        } else {
            0..0
        };
        if plan.direct() {
            let (to_totals, to) = (&mut self.sums.counts[to_totals], &mut self.sums.quotients[to_ratios]);
            return room.direct_pixels(row, Some(to_totals), to);
        }
        room.widen(row)?;
        let to_variances = if row.variances() { to_totals.clone() } else { 0..0 };
        room.band_sums(row, &mut self.sums.counts[to_totals], &mut self.sums.variances[to_variances]);
        if plan.wants(Cell::Full) {
            room.quotients(row, &mut self.sums.quotients[to_ratios])?;
        }
        Ok(())
    }

    /// The information of the bands of each window that ends with a row.
    fn windows(&mut self, row: StripRow<'_>, room: &mut StripRoom) -> Result<()> {
        let StripRow { y, plan, strip, .. } = row;
        let top = (y + 1).checked_sub(plan.request.window.rows()).filter(|top| self.tops.contains(top));
        let to = top.map(|top| {
            let centres = plan.centres();
            let own = (top - self.first) * centres.len();
            let [start, end] = [strip.centres.start, strip.centres.end].map(|x| x - centres.start);
            &mut self.spectral[own + start..own + end]
        });
        if plan.direct_windows() {
            if let Some(to) = to {
                room.direct_windows(row, to);
            }
            return Ok(());
        }
        room.push(row);
        if let Some(to) = to {
            room.windows(row, to)?;
        }
        room.finish(row);
        Ok(())
    }
}
