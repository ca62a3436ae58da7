//! Whether J(full) of a window reaches what is required, without looking at every sample.
//!
//! All terms of J are 0 or above, and rounding does not reverse an order. The sum of a window with some of its
//! pixels left
//! out (as 0), added in the order of the two-level sums, is therefore never above the sum that [`super::information`]
//! gives: where it
//! reaches the requirement, so does J, without any margin. First one row in as many as the window is high is
//! evaluated, of which each window has exactly one; then those pixels that windows still open need. The answer is
//! the same.
//!
//! No sample can be left out of a window that stays below: it might be the one that carries the information. There
//! the
//! time is that of reading and widening the cube in any case, not that of the arithmetic.

use super::blocks::{Plan, Strip, run};
use super::samples::{BandSums, Room, pixels_of_row};
use super::{Cell, Request, Window, pixels};
use crate::error::{Error, Result, check};
use crate::ranging::cube::Cube;
use std::ops::Range;

/// Columns that are evaluated or left out together.
const TILE: usize = 64;

/// Which windows reach a required information.
#[derive(Debug, Clone, PartialEq)]
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
pub struct Stats {
    /// Windows that some of their pixels prove to be above.
    pub windows_proved_above: usize,
    /// Windows proved below without all of their samples: see the module; none so far.
    pub windows_proved_below: usize,
    /// Windows whose pixels were all evaluated.
    pub windows_computed: usize,
    /// Samples that were evaluated.
    pub samples_evaluated: usize,
    /// Samples in any window.
    pub samples_total: usize,
}

/// Whether J(full) ≥ `required_per_pixel2` (pixel⁻²) in each window of a request, whose `cells` are not looked at.
///
/// The same as comparing the map of [`super::information`]. Samples that need not be looked at are not checked.
///
/// # Errors
/// Those of [`super::information`]; a requirement that is not a positive number.
pub fn decide(cube: &Cube, request: &Request<'_>, required_per_pixel2: f64) -> Result<Decision> {
    check::positive("required information", required_per_pixel2, "pixel^-2")?;
    let request = Request { cells: &[Cell::Full], ..request.clone() };
    let plan = Plan::new(cube.shape(), &request)?;
    let (rows, inner) = (plan.rows(), plan.inner());
    let mut state = State {
        strips: plan.strips_of(TILE),
        quotients: vec![0.0; rows.len() * inner.len()],
        evaluated: Vec::new(),
        plan: &plan,
        cube,
    };
    state.evaluated = vec![false; rows.len() * state.strips.len()];

    let height = request.window.rows();
    let mut wanted = vec![false; state.evaluated.len()];
    for (row, wanted) in wanted.chunks_mut(state.strips.len()).enumerate() {
        // A single row cannot be left out of a window of one row.
        wanted.fill(height == 1 || (rows.start + row) % height == height / 2);
    }
    state.evaluate(&wanted)?;
    let mut above = state.above(required_per_pixel2)?;
    let proved = if height == 1 { 0 } else { above.iter().filter(|above| **above).count() };
    if height > 1 && proved < above.len() {
        let wanted = state.open(&above, request.window);
        state.evaluate(&wanted)?;
        above = state.above(required_per_pixel2)?;
    }

    let samples = |columns: usize| columns * plan.shape.bands();
    let evaluated = state.evaluated.chunks(state.strips.len()).flat_map(|row| row.iter().zip(&state.strips));
    let stats = Stats {
        windows_proved_above: proved,
        windows_proved_below: 0,
        windows_computed: above.len() - proved,
        samples_evaluated: evaluated
            .filter(|(done, _)| **done)
            .map(|(_, s)| samples(s.quotients.len()))
            .sum(),
        samples_total: samples(inner.len()) * rows.len(),
    };
    let half = request.window.half_rows();
    let rows = plan.tops.start + half..plan.tops.end + half;
    Ok(Decision { above, rows, columns: plan.centres(), stats })
}

struct State<'a> {
    plan: &'a Plan<'a>,
    cube: &'a Cube,
    strips: Vec<Strip>,
    /// Σ_b (∂N)²/(N + σ²), 0 where not yet evaluated.
    quotients: Vec<f64>,
    /// [row][strip]
    evaluated: Vec<bool>,
}

impl State<'_> {
    /// Evaluates the tiles that are wanted and not done yet, [row][strip].
    fn evaluate(&mut self, wanted: &[bool]) -> Result<()> {
        let (plan, cube, strips) = (self.plan, self.cube, &self.strips);
        let first = plan.rows().start;
        let rows = self.quotients.chunks_mut(plan.inner().len().max(1));
        let tiles = self.evaluated.chunks_mut(strips.len()).zip(wanted.chunks(strips.len()));
        let mut jobs = Vec::new();
        for (row, (to, (done, wanted))) in rows.zip(tiles).enumerate() {
            let mut due = Vec::new();
            for ((done, wanted), strip) in done.iter_mut().zip(wanted).zip(strips) {
                if *wanted && !*done {
                    *done = true;
                    due.push(strip);
                }
            }
            if !due.is_empty() {
                jobs.push((first + row, due, to));
            }
        }
        run(jobs, |(y, due, to), room: &mut Room| pixels_of_row(cube, plan, y, &due, room, to))
    }

    /// Windows whose pixels, as far as they are evaluated, reach the requirement.
    fn above(&mut self, required: f64) -> Result<Vec<bool>> {
        let zeros = self.plan.rows().len() * self.plan.shape.columns();
        let sums = BandSums {
            quotients: std::mem::take(&mut self.quotients),
            counts: vec![0.0; zeros],
            variances: vec![0.0; if self.plan.var_band.is_empty() { zeros } else { 0 }],
            spectral: Vec::new(),
        };
        let map = pixels::windows(self.plan, &sums)?;
        self.quotients = sums.quotients;
        let [_, _, _, full] = map.information;
        if full.len() == self.plan.tops.len() * self.plan.centres().len() {
            return Ok(full.into_iter().map(|information| information >= required).collect());
        }
        Err(Error::malformed("a map of another size", "report this"))
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
