//! First pass, over the samples: of every pixel the sum over bands and the information of its bands, of every
//! window the
//! information of its bands.
//!
//! A block of rows is worked on in strips of columns, so that what is kept of the last rows (as many as a window
//! has) stays in
//! cache. For the sums over windows see [`super::boxes`].

use super::Cell;
use super::blocks::{Plan, Strip, run};
use super::boxes::{Along, Stack, add_to, along, grow};
use super::checks::Checked;
use super::direct::{Lanes, Pixels, windows};
use super::kernels::{Below, ratios, ratios_central, ratios_ends, totals};
use super::rows::Buffer;
use crate::error::Result;
use crate::ranging::cube::Cube;
use crate::ranging::derivative::Differentiator;
use crate::ranging::noise::NoiseVariance;
use crate::simd::{Aligned, Chunk, LANES};
use std::ops::Range;

/// Sums over the bands of pixels and of windows.
#[derive(Debug, Default)]
pub(super) struct BandSums {
    /// Σ_b (∂N)²/(N + σ²), [row][column] of the pixels in windows with a derivative; empty unless asked for.
    pub(super) quotients: Vec<f64>,
    /// Σ_b N, [row][column], all columns.
    pub(super) counts: Vec<f64>,
    /// Σ_b σ², likewise; empty unless every sample has its own.
    pub(super) variances: Vec<f64>,
    /// Σ_b (Σ_p ∂N)²/Σ_p (N + σ²), [row][column] of the windows; empty unless asked for.
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
/// columns with a
/// derivative.
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

#[derive(Default)]
struct StripRoom {
    slopes: Option<Differentiator>,
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
    lanes: Vec<Chunk>,
    /// Of a row of pixels, and of windows.
    direct: Lanes,
    totals: Vec<f64>,
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

impl StripRoom {
    fn prepare(&mut self, plan: &Plan<'_>) -> Result<()> {
        if !plan.central() && self.slopes.is_none() {
            self.slopes = Some(Differentiator::new(plan.request.derivative, plan.shape.columns())?);
        }
        Ok(())
    }

    /// Widens and checks row `y` of a strip.
    fn widen(&mut self, y: usize, plan: &Plan<'_>, strip: &Strip, checked: &Checked<'_>) -> Result<()> {
        let bands = plan.shape.bands();
        let start = checked.at(y, strip.read.start);
        let seen = checked.counts.widen(start, bands, self.counts.row(y));
        let seen_var = checked.variances.map(|raw| raw.widen(start, bands, self.variances.row(y)));
        checked.look(seen, seen_var)
    }

    fn start(&mut self, plan: &Plan<'_>, strip: &Strip, first: usize, variances: bool) {
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
    fn pixels(
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
    fn direct(&mut self, y: usize, plan: &Plan<'_>, strip: &Strip, checked: &Checked<'_>, to: &mut [f64]) {
        let window = plan.request.window;
        let len = strip.read.len() * plan.stride;
        grow(&mut self.sum, len);
        let start = checked.at(y + 1 - window.rows(), strip.read.start);
        let rows = (plan.shape.row_len(), window.rows());
        checked.counts.sum_rows(start, rows, plan.shape.bands(), &mut self.sum[..len]);
        windows(&self.sum[..len], window.columns(), &plan.var_window, &mut self.direct, to);
    }

    /// The quotients of row `y`, over the bands of each pixel.
    fn quotients(
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
    fn spectral(
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
