//! Whether J(full) of a window reaches what is required, without looking at every sample.
//!
//! All terms of J are 0 or above, and rounding does not reverse an order. The sum of a window with some of its
//! pixels left out (as 0), added in the order of the two-level sums, is therefore never above the sum that
//! [`super::information`] gives: where it reaches the requirement, so does J, without any margin. First one row in
//! as many as the window is high is evaluated, of which each window has exactly one; then those pixels that windows
//! still open need. The answer is the same.
//!
//! Windows that the first rows let expect to stay below by far are then tried with an upper bound of every pixel not
//! yet evaluated (`bounds`): where the sum of the bounds, and a margin for rounding, stays below the
//! requirement, so does J. No sample can be left out there: it might be the one that carries the information. What
//! is saved is arithmetic, not reading.

#[cfg(test)]
mod tests;

use super::blocks::{Plan, Strip, run};
use super::boxes::{Image, window_sums};
use super::parts::Part;
use super::samples::{BandSums, Room, bounds_of_row, pixels_of_row};
use super::{Cell, InformationMap, Request, Window, pixels};
use crate::cube::{Cube, CubeRef};
use crate::demand::{Reason, Thing, Work};
use crate::error::{Result, check};
use std::ops::Range;

/// Columns that are evaluated or left out together.
const TILE: usize = 64;

/// Pixels that are worked on at once.
const AT_ONCE: usize = 1 << 21;

/// Rows of windows that a thread sums at a time.
const BLOCK: usize = 32;

/// How far below the requirement a window has to look, by its first row, for a bound to be tried.
const HOPE: f64 = 4.0;

/// Part of the requirement left for the rounding of sums, of bounds as of quotients.
const MARGIN: f64 = 1e-9;

/// Which windows reach a required information.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Decision {
    /// J(full) ≥ required, \[row\]\[column\] of the windows' centres.
    pub above: Vec<bool>,
    /// Rows of the centres.
    pub rows: Range<usize>,
    /// Columns of the centres.
    pub columns: Range<usize>,
    /// What it took.
    pub stats: Stats,
}

/// Windows and samples that were, and were not, evaluated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize)]
#[non_exhaustive]
pub struct Stats {
    /// Windows that some of their pixels prove to be above.
    pub windows_proved_above: usize,
    /// Windows that upper bounds of their pixels prove to be below.
    pub windows_proved_below: usize,
    /// Windows whose pixels were all evaluated.
    pub windows_computed: usize,
    /// Number of samples of the cubes that were evaluated.
    pub samples_evaluated: usize,
    /// Number of samples that belong to any window.
    pub samples_total: usize,
}

impl Stats {
    /// The same as a ledger, for a cube of so many samples.
    #[must_use]
    pub fn work(&self, samples: usize) -> Work {
        let mut work = Work::default();
        work.compute(Thing::Samples, self.samples_evaluated as u64);
        work.spare(Thing::Samples, Reason::Decided, samples.saturating_sub(self.samples_evaluated) as u64);
        work.compute(Thing::Windows, self.windows_computed as u64);
        work.spare(Thing::Windows, Reason::ProvedAbove, self.windows_proved_above as u64);
        work.spare(Thing::Windows, Reason::ProvedBelow, self.windows_proved_below as u64);
        work
    }
}

/// Whether J(full) ≥ `required_per_pixel2` (pixel⁻²) in each window of a request, whose `cells` are not looked at.
///
/// The same as comparing the map of [`super::information`]. Samples that need not be looked at are not checked.
///
/// # Errors
/// Those of [`super::information`]; a count that is NaN; a requirement that is not a positive number.
pub fn decide(cube: &Cube, request: &Request<'_>, required_per_pixel2: f64) -> Result<Decision> {
    in_parts(cube, request, required_per_pixel2, AT_ONCE)
}

/// The same in parts of some `pixels`, but no lower than a window.
pub(super) fn in_parts(
    cube: &Cube,
    request: &Request<'_>,
    required_per_pixel2: f64,
    pixels: usize,
) -> Result<Decision> {
    check::positive("required information", required_per_pixel2, "pixel^-2")?;
    let request = Request { cells: &[Cell::Full], ..request.clone() };
    let plan = Plan::new(cube.shape(), &request)?;
    let (height, end) = ((pixels / plan.shape.columns()).max(request.window.rows()), plan.tops.end);
    let (mut above, mut stats) =
        (Vec::with_capacity(plan.tops.len() * plan.centres().len()), Stats::default());
    for start in plan.tops.clone().step_by(height) {
        let part = plan.part(start..end.min(start + height));
        // Rows that the next part looks at again are counted there.
        let owned = if part.tops.end == end { part.rows().len() } else { part.tops.len() };
        above.extend(decide_part(cube, &part, required_per_pixel2, owned, &mut stats)?);
    }
    let half = request.window.half_rows();
    Ok(Decision { above, rows: plan.tops.start + half..end + half, columns: plan.centres(), stats })
}

/// The windows of a part; what it took is added for the first `owned` of its rows.
fn decide_part(
    cube: &Cube,
    plan: &Plan<'_>,
    required_per_pixel2: f64,
    owned: usize,
    stats: &mut Stats,
) -> Result<Vec<bool>> {
    let (rows, inner, window) = (plan.rows(), plan.inner(), plan.request.window);
    let mut state = State {
        strips: plan.strips_of(TILE),
        quotients: vec![0.0; rows.len() * inner.len()],
        evaluated: Vec::new(),
        plan,
        cube: cube.into(),
    };
    state.evaluated = vec![false; rows.len() * state.strips.len()];

    let height = window.rows();
    let mut wanted = vec![false; state.evaluated.len()];
    for (row, wanted) in wanted.chunks_mut(state.strips.len()).enumerate() {
        // A single row cannot be left out of a window of one row.
        wanted.fill(height == 1 || (rows.start + row) % height == height / 2);
    }
    state.evaluate(&wanted)?;
    let first = state.windows()?;
    let mut above: Vec<bool> = first.iter().map(|j| *j >= required_per_pixel2).collect();
    let (mut proved_above, mut proved_below) = (0, 0);
    if height > 1 {
        proved_above = above.iter().filter(|above| **above).count();
        // Windows with nothing left to do.
        let mut done = above.clone();
        let hopeful = HOPE * height as f64;
        let not_tried: Vec<bool> = first.iter().map(|j| hopeful * j >= required_per_pixel2).collect();
        drop(first);
        if plan.central() && not_tried.contains(&false) {
            let bounds = state.bounds(&state.open(&not_tried, window))?;
            let limit = (1.0 - MARGIN) * required_per_pixel2;
            for ((done, bound), not_tried) in done.iter_mut().zip(bounds).zip(not_tried) {
                if !not_tried && bound < limit {
                    *done = true;
                    proved_below += 1;
                }
            }
        }
        if done.contains(&false) {
            let wanted = state.open(&done, window);
            state.evaluate(&wanted)?;
            let windows = state.windows()?;
            for ((above, j), done) in above.iter_mut().zip(windows).zip(done) {
                *above |= !done && j >= required_per_pixel2;
            }
        }
    }

    let samples = |columns: usize| columns * plan.shape.bands();
    let evaluated = state.evaluated.chunks(state.strips.len()).take(owned);
    let evaluated = evaluated.flat_map(|row| row.iter().zip(&state.strips)).filter(|(done, _)| **done);
    stats.windows_proved_above += proved_above;
    stats.windows_proved_below += proved_below;
    stats.windows_computed += above.len() - proved_above - proved_below;
    stats.samples_evaluated += evaluated.map(|(_, strip)| samples(strip.quotients.len())).sum::<usize>();
    stats.samples_total += samples(inner.len()) * owned;
    Ok(above)
}

struct State<'a> {
    plan: &'a Plan<'a>,
    cube: CubeRef<'a>,
    strips: Vec<Strip>,
    /// Σ_b (∂N)²/(N + σ²), 0 where not yet evaluated.
    quotients: Vec<f64>,
    /// [row][strip]
    evaluated: Vec<bool>,
}

impl State<'_> {
    /// Evaluates the tiles that are wanted and not done yet, [row][strip].
    fn evaluate(&mut self, wanted: &[bool]) -> Result<()> {
        let due: Vec<bool> =
            wanted.iter().zip(&self.evaluated).map(|(wanted, done)| *wanted && !done).collect();
        let (plan, cube) = (self.plan, self.cube);
        run(self.jobs(&due), |(y, due, to), room: &mut Room| pixels_of_row(cube, plan, y, &due, room, to))?;
        for (done, due) in self.evaluated.iter_mut().zip(due) {
            *done |= due;
        }
        Ok(())
    }

    /// Upper bounds of J of the windows all of whose tiles are wanted or evaluated; those of others mean nothing.
    fn bounds(&mut self, wanted: &[bool]) -> Result<Vec<f64>> {
        let due: Vec<bool> =
            wanted.iter().zip(&self.evaluated).map(|(wanted, done)| *wanted && !done).collect();
        let (plan, cube) = (self.plan, self.cube);
        run(self.jobs(&due), |(y, due, to), room: &mut Room| bounds_of_row(cube, plan, y, &due, room, to))?;
        let bounds = self.sums()?;
        // What is not evaluated is 0 again.
        run(self.jobs(&due), |(_, due, to), _: &mut Room| {
            for strip in due {
                to[strip.quotients.start - plan.margin..strip.quotients.end - plan.margin].fill(0.0);
            }
            Ok(())
        })?;
        Ok(bounds)
    }

    /// Rows, their strips and where their quotients are, as far as there are tiles due.
    fn jobs(&mut self, due: &[bool]) -> Vec<(usize, Vec<&Strip>, &mut [f64])> {
        let (strips, first) = (&self.strips, self.plan.rows().start);
        let rows = self.quotients.chunks_mut(self.plan.inner().len().max(1)).enumerate();
        rows.zip(due.chunks(strips.len()))
            .map(|((row, to), due)| {
                let due = strips.iter().zip(due).filter(|(_, due)| **due).map(|(strip, _)| strip);
                (first + row, due.collect::<Vec<_>>(), to)
            })
            .filter(|(_, due, _)| !due.is_empty())
            .collect()
    }

    /// Sums over windows, added in the order of the map if they are small.
    fn sums(&self) -> Result<Vec<f64>> {
        let (window, columns, centres) =
            (self.plan.request.window, self.plan.inner().len(), self.plan.centres().len());
        let mut sums = vec![0.0; self.plan.tops.len() * centres];
        let parts = sums.chunks_mut(BLOCK * centres).enumerate().collect();
        run(parts, |(part, to), _: &mut ()| {
            let values = &self.quotients[part * BLOCK * columns..];
            window_sums(Image { values, pitch: columns, columns }, window, to);
            Ok(())
        })?;
        Ok(sums)
    }

    /// J of all windows, with what is not evaluated as 0.
    fn windows(&mut self) -> Result<Vec<f64>> {
        if self.plan.small_windows() {
            return self.sums();
        }
        let (plan, pixels) = (self.plan, self.plan.rows().len() * self.plan.shape.columns());
        let sums = BandSums {
            quotients: std::mem::take(&mut self.quotients),
            counts: vec![0.0; pixels],
            variances: vec![0.0; if plan.var_band.is_empty() { pixels } else { 0 }],
        };
        let mut map = InformationMap::default();
        let mut all = Part::all(&mut map, plan);
        run(all.cut(BLOCK), |mut part, room: &mut _| pixels::windows(plan, &sums, &mut part, room))?;
        self.quotients = sums.quotients;
        let [_, _, _, full] = map.information;
        Ok(full)
    }

    /// Tiles that windows still open need, [row][strip].
    fn open(&self, above: &[bool], window: Window) -> Vec<bool> {
        let mut wanted = vec![false; self.evaluated.len()];
        let (centres, half) = (self.plan.centres(), window.half_columns());
        let count = self.strips.len();
        for (top, above) in above.chunks(centres.len().max(1)).enumerate() {
            for (index, strip) in self.strips.iter().enumerate() {
                // Centres whose windows reach into the strip.
                let start = strip.quotients.start.saturating_sub(half).max(centres.start) - centres.start;
                let end = (strip.quotients.end + half).min(centres.end) - centres.start;
                if above[start..end].iter().all(|above| *above) {
                    continue;
                }
                for row in top..top + window.rows() {
                    wanted[row * count + index] = true;
                }
            }
        }
        wanted
    }
}
