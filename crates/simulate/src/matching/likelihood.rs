//! Maximum-likelihood matching.
//!
//! The disparity d minimises χ² = Σ_p [L_p − R(x_p − d)]²/v_p over the samples p of a window of the left view,
//! R the right view interpolated along its rows:
//!
//! * both views noisy: v = L + R + 2σ², from the readings at the best whole disparity (sum and difference of two
//!   readings of the same mean are uncorrelated, so these weights hardly pull the estimate). To first order in
//!   the noise the variance of d is 1/Σ (∂N)²/(2N + 2σ²) = 1/J_left + 1/J_right: the bound;
//! * the right view known, i.e. free of noise: v = R + σ², R at the estimate (iterated): Σ (L − R) R′/v = 0 is the
//!   equation of the largest likelihood, exactly for Poisson counts; variance 1/J_left.
//!
//! First a scan of whole disparities, then Gauss–Newton steps, halved where χ² would rise, within a pixel of
//! the best one; if they leave it, the least χ² of that pixel by bracketing.
//!
//! What that rests on: with both views noisy the template is itself noisy, and first order means that the
//! slope of the texture exceeds that of the noise. White noise has a slope of π²/3 times its variance (sinc,
//! at a whole disparity; less between), so with S = ⟨(∂N)²/(N + σ²)⟩ over the samples the excess over the
//! bound is of the order of (π²/3)/S. Measured, 5 × 5 pixels, texture up to 0.25 cycles per pixel, sinc,
//! variance over bound at a whole disparity and half-way, share of matches off by more than a pixel or failed:
//!
//! | S    | 6.0  | 6.5  | lost   |
//! |------|------|------|--------|
//! | 9000 | 1.00 | 0.98 | 0      |
//! | 915  | 1.01 | 1.01 | 0      |
//! | 91   | 1.06 | 1.01 | 0      |
//! | 9    | 1.58 | 1.16 | 0.0002 |
//! | 2.3  | 2.1  | 1.6  | 0.05   |
//!
//! (the last two without what was lost: with it 1.66 and 1.60, 13 and 17). A cubic spline smooths the right view's
//! noise between pixels: 1.16 and 0.93 at S = 91. A known template has no such excess.
//!
//! Left out: ln v of the likelihood, which carries of the order of 1/(2N) of the information. σ² of the right
//! view is that of the left pixel.
//!
//! Source: paper SI C, S37–S41; the equation is Fisher's scoring.

pub use super::interpolation::Interpolation;

use super::interpolation::{LOBES, Weights};
use super::lanes::{Lanes, Sums, chunks, differences, interpolate, window_sums};
use super::layout::View;
use super::search::{Failure, Match, Search};
use hadar::minimum::golden_section;
use hadar::ranging::information::Window;
use hadar::simd::{Chunk, LANES};
use std::convert::Infallible;
use std::ops::Range;

/// Steps of a refinement.
const STEPS: usize = 40;
/// A step this short, pixels, is the last one.
const SHORT: f64 = 1e-6;
/// Columns beyond a window that its interpolation needs.
const PAD: i64 = LOBES as i64 + 2;
/// Places tried where steps lead nowhere, on either side.
const PLACES: i32 = 8;
/// Narrowings of the bracket there, each by 0.62.
const NARROWINGS: usize = 26;
/// Farthest from the best whole disparity.
const REACH: f64 = 1.0;
/// Times that v follows the estimate, if the right view is known.
const ROUNDS: usize = 3;

/// Which views are noisy.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Noisy {
    /// Both, as cameras have it; bound 1/J_left + 1/J_right.
    #[default]
    Both,
    /// The left one; the right one is as expected, a known template; bound 1/J_left.
    Left,
}

impl Noisy {
    /// Variance of the difference of two readings, σ² the electronic noise of one.
    #[inline(always)]
    fn variance(self, left: f64, right: f64, var: f64) -> f64 {
        match self {
            // Nothing at all was read: one photon more would be one.
            Self::Both => (left + right + 2.0 * var).max(1.0),
            // Interpolation may fall below 0 where there are hardly any photons.
            Self::Left => (right + var).max(1e-6),
        }
    }
}

/// Maximum-likelihood matching.
///
/// ```
/// use hadar::ranging::information::Window;
/// use hadar_simulate::matching::likelihood::{Interpolation, Likelihood};
/// let likelihood = Likelihood::new(Window::new(5, 5)?);
/// assert!(likelihood.interpolation == Interpolation::Sinc);
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
pub struct Likelihood {
    /// Size of the window of pixels that is matched.
    pub window: Window,
    /// How the right view is interpolated.
    pub interpolation: Interpolation,
}

impl Likelihood {
    /// With a windowed sinc.
    #[must_use]
    pub const fn new(window: Window) -> Self {
        Self { window, interpolation: Interpolation::Sinc }
    }
}

/// Room to match with.
#[derive(Debug, Clone, Default)]
pub(super) struct Scratch {
    coefficients: Vec<f64>,
    left: Lanes,
    var: Lanes,
    right: Lanes,
    /// What the right view is interpolated from.
    around: Lanes,
    weights: Vec<Chunk>,
    values: Vec<Chunk>,
    scan: Vec<f64>,
}

/// A window at its best whole disparity.
struct Place<'a> {
    left: &'a [Chunk],
    /// From the first value that a window one pixel to the left needs.
    around: &'a [Chunk],
    lanes: usize,
    interpolation: Interpolation,
}

impl Likelihood {
    /// To be called first, whenever the right view has changed.
    pub(super) fn prepare(&self, scratch: &mut Scratch, right: View) {
        self.interpolation.coefficients_into(right, &mut scratch.coefficients);
    }

    /// To be called then, for windows about the columns `hull` of a row; `var` as the left view's samples or
    /// empty.
    pub(super) fn row(
        &self,
        scratch: &mut Scratch,
        [left, right]: [View; 2],
        var: &[f64],
        row: usize,
        hull: &Range<usize>,
        search: Search,
    ) {
        let half = [self.window.half_rows(), self.window.half_columns()];
        let rows = row - half[0]..row + half[0] + 1;
        let (first, end) = (hull.start as i64 - half[1] as i64, hull.end as i64 + half[1] as i64);
        scratch.left.fill(left, rows.clone(), first..end);
        scratch.var.fill(View { samples: var, ..left }, rows.clone(), first..end);
        let there = right.layout.columns(row);
        let columns = (first - i64::from(search.most())).max(there.start as i64) - PAD
            ..(end - i64::from(search.least())).min(there.end as i64) + PAD;
        scratch.right.fill(right, rows.clone(), columns.clone());
        let coefficients = View { samples: &scratch.coefficients, ..right };
        scratch.around.fill(coefficients, rows, columns);
    }

    /// Matches one of the windows.
    pub(super) fn window(
        &self,
        scratch: &mut Scratch,
        view: View,
        noisy: Noisy,
        column: usize,
        search: Search,
    ) -> Match {
        let (bands, half) = (view.layout.shape().bands(), self.window.half_columns());
        let lanes = chunks(self.window.rows(), bands);
        let used = self.window.rows() * bands;
        let Scratch { left, var, right, around, weights, values, scan, .. } = scratch;
        let (start, size) = (column as i64 - half as i64, self.window.columns() * lanes);
        let (left, var) = (left.from(start, lanes), var.from(start, lanes));
        let (left, var) = (left.get(..size).unwrap_or(left), var.get(..size).unwrap_or(var));
        let weigh = |values: &[Chunk], weights: &mut Vec<Chunk>| {
            weights.clear();
            weights.extend(left.iter().zip(values).zip(var).enumerate().map(|(i, ((l, r), var))| {
                let real = used - (i % lanes) * LANES;
                let weight =
                    |k: usize| if k < real { noisy.variance(l[k], r[k], var[k]).recip() } else { 0.0 };
                std::array::from_fn(weight)
            }));
        };
        // Whole disparities, weighted by the left view's readings.
        let within = search.within(column, view.layout.shape().columns(), half);
        scan.clear();
        scan.resize(within.len(), 0.0);
        let lowest = start - i64::from(search.least()) - within.end as i64 + 1;
        weigh(left, weights);
        differences(left, weights, right.from(lowest, lanes), lanes, scan);
        let at = least(scan)?;
        let whole = i64::from(search.least()) + (within.start + at) as i64;
        // Between them.
        let first = start - whole - 1 - self.interpolation.before() as i64;
        let place =
            Place { left, around: around.from(first, lanes), lanes, interpolation: self.interpolation };
        let mut shift = 0.0;
        for _ in 0..if noisy == Noisy::Left { ROUNDS } else { 1 } {
            values.resize(size, [0.0; LANES]);
            place.values(shift, values);
            weigh(values, weights);
            shift = place.refine(weights, shift)?;
        }
        Ok(whole as f64 + shift)
    }
}

/// The least of the sums, if it is not at an end.
fn least(sums: &[f64]) -> std::result::Result<usize, Failure> {
    let (mut low, mut high, mut at) = (f64::INFINITY, f64::NEG_INFINITY, 0);
    for (i, &sum) in sums.iter().enumerate() {
        if sum < low {
            (low, at) = (sum, i);
        }
        high = high.max(sum);
    }
    if sums.len() >= 3 && low == high {
        return Err(Failure::Flat);
    }
    if at == 0 || at + 1 >= sums.len() { Err(Failure::RangeEnd) } else { Ok(at) }
}

impl Place<'_> {
    /// What is interpolated `shift` beyond the whole disparity, from where, with which weights.
    fn taps(&self, shift: f64) -> (&[Chunk], Weights) {
        let pixel = (-shift).floor();
        let from = (pixel + 1.0) as usize * self.lanes;
        (self.around.get(from..).unwrap_or(&[]), self.interpolation.weights(-shift - pixel))
    }

    fn values(&self, shift: f64, to: &mut [Chunk]) {
        let (right, weights) = self.taps(shift);
        let taps = self.interpolation.taps();
        interpolate(right, self.lanes, &weights.value[..taps], to);
    }

    fn sums(&self, weights: &[Chunk], shift: f64) -> Sums {
        let (right, at) = self.taps(shift);
        let taps = self.interpolation.taps();
        window_sums(self.left, weights, right, self.lanes, (&at.value[..taps], &at.slope[..taps]))
    }

    /// Gauss–Newton.
    fn refine(&self, weights: &[Chunk], start: f64) -> Match {
        hadar::stop::check();
        let (mut shift, mut sums) = (start, self.sums(weights, start));
        for _ in 0..STEPS {
            if sums.information.is_nan() || sums.information <= 0.0 {
                return Err(Failure::Flat);
            }
            let mut step = (-sums.gradient / sums.information).clamp(-0.5, 0.5);
            loop {
                let next = shift + step;
                if next.abs() >= REACH {
                    return self.bracket(weights);
                }
                if step.abs() < SHORT {
                    return Ok(next);
                }
                let there = self.sums(weights, next);
                if there.chi_square <= sums.chi_square {
                    (shift, sums) = (next, there);
                    break;
                }
                step *= 0.5;
            }
        }
        self.bracket(weights)
    }

    /// The least χ² within the pixel, by golden sections about the best of several places.
    fn bracket(&self, weights: &[Chunk]) -> Match {
        let at = |i: i32| REACH * f64::from(i) / f64::from(PLACES);
        let of = |shift: f64| self.sums(weights, shift).chi_square;
        let places = (-PLACES..=PLACES).map(|i| (i, of(at(i))));
        let Some((best, _)) = places.min_by(|a, b| a.1.total_cmp(&b.1)) else {
            return Err(Failure::Unconverged);
        };
        if best.abs() == PLACES {
            return Err(Failure::Unconverged);
        }
        let around = [at(best - 1), at(best + 1)];
        let Ok([low, high]) = golden_section::<Infallible>(around, NARROWINGS, |shift| Ok(of(shift)));
        Ok(0.5 * (low + high))
    }
}
