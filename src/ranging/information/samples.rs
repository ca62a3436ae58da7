//! First pass, over the samples: of every pixel the sum over bands and the information of its bands, of every
//! window the information of its bands.
//!
//! A block of rows is worked on in strips of columns, so that what is kept of the last rows (as many as a window
//! has) stays in cache. For the sums over windows see [`super::boxes`].

use super::blocks::{Plan, Strip, run};
use super::checks::Checked;
use super::kernels::totals;
use super::request::Cell;
use super::rows::Buffer;
use super::strips::StripRoom;
use crate::error::Result;
use crate::ranging::cube::Cube;
use crate::ranging::noise::NoiseVariance;
use std::ops::Range;

/// Sums over the bands of pixels and of windows.
#[derive(Debug, Default)]
pub(super) struct BandSums {
    /// Σ_b (∂N)²/(N + σ²), `[row][column]` of the pixels in windows with a derivative; empty unless asked for.
    pub(super) quotients: Vec<f64>,
    /// Σ_b N, `[row][column]`, all columns.
    pub(super) counts: Vec<f64>,
    /// Σ_b σ², likewise; empty unless every sample has its own.
    pub(super) variances: Vec<f64>,
    /// Σ_b (Σ_p ∂N)²/Σ_p (N + σ²), `[row][column]` of the windows; empty unless asked for.
    pub(super) spectral: Vec<f64>,
}

/// Rows of the results that a block makes.
struct Block<'a> {
    tops: Range<usize>,
    owned: Range<usize>,
    quotients: &'a mut [f64],
    counts: &'a mut [f64],
    variances: &'a mut [f64],
    spectral: &'a mut [f64],
}

/// Takes the first `len` values off a slice.
fn take<'a>(rest: &mut &'a mut [f64], len: usize) -> &'a mut [f64] {
    let len = len.min(rest.len());
    let (taken, left) = std::mem::take(rest).split_at_mut(len);
    *rest = left;
    taken
}

/// The first pass.
pub(super) fn band_sums(cube: &Cube, plan: &Plan<'_>, block_rows: usize) -> Result<BandSums> {
    let (rows, inner) = (plan.rows(), plan.inner().len());
    let room = |wanted: bool, rows: usize, columns: usize| vec![0.0; if wanted { rows * columns } else { 0 }];
    let mut sums = BandSums {
        quotients: room(plan.wants(Cell::Full), rows.len(), inner),
        counts: room(true, rows.len(), plan.shape.columns()),
        variances: room(plan.var_band.is_empty(), rows.len(), plan.shape.columns()),
        spectral: room(plan.wants(Cell::Spectral), plan.tops.len(), plan.centres().len()),
    };
    let mut blocks = Vec::new();
    let (mut quotients, mut counts) = (&mut sums.quotients[..], &mut sums.counts[..]);
    let (mut variances, mut spectral) = (&mut sums.variances[..], &mut sums.spectral[..]);
    let mut start = plan.tops.start;
    while start < plan.tops.end {
        let end = plan.tops.end.min(start + block_rows);
        let owned = start..if end == plan.tops.end { rows.end } else { end };
        blocks.push(Block {
            tops: start..end,
            quotients: take(&mut quotients, owned.len() * inner),
            counts: take(&mut counts, owned.len() * plan.shape.columns()),
            variances: take(&mut variances, owned.len() * plan.shape.columns()),
            spectral: take(&mut spectral, (end - start) * plan.centres().len()),
            owned,
        });
        start = end;
    }
    let strips = plan.strips();
    run(blocks, |block, room: &mut Room| block.work(cube, plan, &strips, room))?;
    Ok(sums)
}

/// The quotients of one row of pixels, in some of the strips of a plan for [`Cell::Full`] alone; `to` is for all
/// columns with a derivative.
pub(super) fn pixels_of_row(
    cube: &Cube,
    plan: &Plan<'_>,
    y: usize,
    strips: &[&Strip],
    room: &mut Room,
    to: &mut [f64],
) -> Result<()> {
    let counts = room.counts.read(cube, y..y + 1)?;
    let variances = match plan.request.noise {
        NoiseVariance::PerSample(cube) => Some(room.variances.read(cube, y..y + 1)?),
        _ => None,
    };
    let checked = Checked::new(plan, (y, y + 1), counts, variances);
    room.strip.prepare(plan)?;
    for strip in strips {
        let to = &mut to[strip.quotients.start - plan.margin..strip.quotients.end - plan.margin];
        if plan.direct() {
            room.strip.pixels(y, plan, strip, &checked, None, to)?;
            continue;
        }
        room.strip.start(plan, strip, y, variances.is_some());
        room.strip.widen(y, plan, strip, &checked)?;
        room.strip.quotients(y, plan, strip, variances.is_some(), to)?;
    }
    Ok(())
}

/// Upper bounds of the quotients of one row of pixels, likewise; with the central difference.
pub(super) fn bounds_of_row(
    cube: &Cube,
    plan: &Plan<'_>,
    y: usize,
    strips: &[&Strip],
    room: &mut Room,
    to: &mut [f64],
) -> Result<()> {
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

impl Block<'_> {
    fn work(mut self, cube: &Cube, plan: &Plan<'_>, strips: &[Strip], room: &mut Room) -> Result<()> {
        let last =
            if plan.wants(Cell::Spectral) { self.tops.end + plan.request.window.rows() - 1 } else { 0 };
        let read = self.owned.start..self.owned.end.max(last);
        let counts = room.counts.read(cube, read.clone())?;
        let variances = match plan.request.noise {
            NoiseVariance::PerSample(cube) => Some(room.variances.read(cube, read.clone())?),
            _ => None,
        };
        let checked = Checked::new(plan, (read.start, read.end), counts, variances);
        room.strip.prepare(plan)?;
        for strips in strips.chunks(plan.strips_together()) {
            if let ([strip], false) = (strips, plan.direct_windows()) {
                room.strip.start(plan, strip, read.start, variances.is_some());
            }
            for y in read.clone() {
                for strip in strips {
                    self.row(y, plan, strip, &checked, &mut room.strip)?;
                }
            }
        }
        Ok(())
    }

    /// Takes a row of a strip into the sums.
    fn row(
        &mut self,
        y: usize,
        plan: &Plan<'_>,
        strip: &Strip,
        checked: &Checked<'_>,
        room: &mut StripRoom,
    ) -> Result<()> {
        if self.owned.contains(&y) {
            self.pixels(y, plan, strip, checked, room)?;
        } else if !plan.direct_windows() {
            room.widen(y, plan, strip, checked)?;
        }
        if plan.wants(Cell::Spectral) {
            let top = (y + 1).checked_sub(plan.request.window.rows()).filter(|top| self.tops.contains(top));
            let to = top.map(|top| {
                let centres = plan.centres();
                let row = (top - self.tops.start) * centres.len();
                let (start, end) = (strip.centres.start - centres.start, strip.centres.end - centres.start);
                &mut self.spectral[row + start..row + end]
            });
            if plan.direct_windows() {
                if let Some(to) = to {
                    room.direct(y, plan, strip, checked, to);
                }
                return Ok(());
            }
            let variances = checked.variances.is_some();
            room.counts.push(y);
            if variances {
                room.variances.push(y);
            }
            if let Some(to) = to {
                room.spectral(y, plan, strip, variances, to)?;
            }
            room.counts.finish(y);
            if variances {
                room.variances.finish(y);
            }
        }
        Ok(())
    }

    /// Sums and quotients over the bands of each pixel.
    fn pixels(
        &mut self,
        y: usize,
        plan: &Plan<'_>,
        strip: &Strip,
        checked: &Checked<'_>,
        room: &mut StripRoom,
    ) -> Result<()> {
        let (stride, columns, inner) = (plan.stride, plan.shape.columns(), plan.inner().len());
        let of = |range: &Range<usize>, first: usize| range.start - first..range.end - first;
        let row = y - self.owned.start;
        let to_totals = row * columns + strip.totals.start..row * columns + strip.totals.end;
        let to_ratios = if plan.wants(Cell::Full) {
            let to = of(&strip.quotients, plan.margin);
            row * inner + to.start..row * inner + to.end
        } else {
            0..0
        };
        if plan.direct() {
            let (to_totals, to) = (&mut self.counts[to_totals], &mut self.quotients[to_ratios]);
            return room.pixels(y, plan, strip, checked, Some(to_totals), to);
        }
        room.widen(y, plan, strip, checked)?;
        let local = of(&strip.totals, strip.read.start);
        let samples = local.start * stride..local.end * stride;
        let (counts, lanes) = (&room.counts.row(y)[samples.clone()], &mut room.lanes);
        totals(counts, stride, lanes, &mut self.counts[to_totals.clone()]);
        if checked.variances.is_some() {
            totals(&room.variances.row(y)[samples], stride, &mut room.lanes, &mut self.variances[to_totals]);
        }
        if plan.wants(Cell::Full) {
            room.quotients(y, plan, strip, checked.variances.is_some(), &mut self.quotients[to_ratios])?;
        }
        Ok(())
    }
}
