//! Block matching: the whole disparity of the best score, and between disparities by a curve through three scores.
//!
//! With scores s₋, s₀, s₊ at d₀ − 1, d₀ (the best) and d₀ + 1:
//!
//! * parabola: d = d₀ + (s₋ − s₊)/[2(s₋ − 2s₀ + s₊)];
//! * equiangular lines: d = d₀ + (s₊ − s₋)/[2(s₀ − min(s₋, s₊))].
//!
//! Neither is the true shape of the peak: views without noise already have an error b of the sub-pixel part of
//! d (pixel locking), which the bound knows nothing of. It also changes how far the
//! estimate follows d: the variance is bounded by (1 + b′)²/J instead of 1/J. A parabola through correlations
//! in 5 × 5 pixels of a texture of up to 0.25 cycles per pixel: |b| up to 0.03 pixels on average over windows
//! and 0.065 rms; variance 0.7 of 1/J at whole disparities (1.07 of its own bound) and 2.3 half-way, however
//! many photons there are.
//!
//! Source: Shimizu and Okutomi, Int. J. Comput. Vis. 63, 207 (2005), doi:10.1007/s11263-005-6878-5 (bias of fits).

pub use super::strip::Score;

use super::layout::View;
use super::search::{Failure, Match, Search};
use super::strip::Strip;
use hadar::ranging::information::Window;
use std::ops::Range;

/// The curve through three scores.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Fit {
    /// None: whole disparities.
    Whole,
    /// A parabola.
    #[default]
    Parabola,
    /// Two lines of opposite slope.
    Equiangular,
}

impl Fit {
    /// Where the peak is between three scores of which the middle one is the largest, −½ to ½.
    fn peak(self, [before, best, after]: [f64; 3]) -> f64 {
        let (numerator, denominator) = match self {
            Self::Whole => return 0.0,
            Self::Parabola => (after - before, 2.0 * ((best - before) + (best - after))),
            Self::Equiangular => (after - before, 2.0 * (best - before.min(after))),
        };
        if denominator > 0.0 { (numerator / denominator).clamp(-0.5, 0.5) } else { 0.0 }
    }
}

/// Block matching.
///
/// ```
/// use hadar::ranging::information::Window;
/// use hadar_simulate::matching::block::{Block, Fit, Score};
/// let block = Block::new(Window::new(5, 5)?);
/// assert!(block.score == Score::Correlation && block.fit == Fit::Parabola);
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
pub struct Block {
    /// Size of the block of pixels that is matched.
    pub window: Window,
    /// The measure of similarity by which blocks are compared.
    pub score: Score,
    /// How the peak is found.
    pub fit: Fit,
}

impl Block {
    /// Correlation with a parabola.
    #[must_use]
    pub const fn new(window: Window) -> Self {
        Self { window, score: Score::Correlation, fit: Fit::Parabola }
    }

    /// The disparity from scores that begin at the lowest one of the search, of which `within` are known.
    pub(super) fn peak(&self, scores: &[f64], within: Range<usize>, search: Search) -> Match {
        let first = within.start;
        let Some(known) = scores.get(within) else { return Err(Failure::Flat) };
        let (mut best, mut least, mut at) = (f64::NEG_INFINITY, f64::INFINITY, 0);
        for (i, &score) in known.iter().enumerate() {
            if score > best {
                (best, at) = (score, i);
            }
            least = least.min(score);
        }
        if known.len() < 3 {
            return Err(Failure::RangeEnd);
        }
        if best <= least {
            return Err(Failure::Flat);
        }
        match (at.checked_sub(1).and_then(|i| known.get(i)), known.get(at + 1)) {
            (Some(&before), Some(&after)) => {
                let whole = f64::from(search.least()) + (first + at) as f64;
                Ok(whole + self.fit.peak([before, best, after]))
            }
            _ => Err(Failure::RangeEnd),
        }
    }

    /// Room to match with.
    pub(super) fn strip(&self, search: Search) -> Strip {
        Strip::new(self.window, search, self.score)
    }

    /// Matches windows about some columns of a row.
    pub(super) fn row(
        &self,
        strip: &mut Strip,
        views: [View; 2],
        row: usize,
        columns: &[usize],
        search: Search,
        mut found: impl FnMut(usize, Match),
    ) {
        let [left, right] = views;
        let (Some(first), Some(last)) = (columns.iter().min(), columns.iter().max()) else { return };
        strip.start(left, right, row, *first..last + 1);
        let (all, half) = (left.layout.shape().columns(), self.window.half_columns());
        for (at, column) in columns.iter().enumerate() {
            let within = search.within(*column, all, half);
            found(at, self.peak(strip.scores(column - first), within, search));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_find_the_peak_of_their_own_shape() {
        for at in [-0.45_f64, -0.2, 0.0, 0.31] {
            let parabola = [-1.0, 0.0, 1.0].map(|x: f64| 3.0 - 0.7 * (x - at) * (x - at));
            let roof = [-1.0, 0.0, 1.0].map(|x: f64| 3.0 - 0.7 * (x - at).abs());
            assert!((Fit::Parabola.peak(parabola) - at).abs() < 1e-14);
            assert!((Fit::Equiangular.peak(roof) - at).abs() < 1e-14);
            assert_eq!(Fit::Whole.peak(parabola), 0.0);
        }
    }

    #[test]
    fn a_peak_at_an_end_or_none_is_a_failure() {
        let block = Block::new(Window::new(3, 3).unwrap());
        let search = Search::new(-1, 3).unwrap();
        let of = |scores: [f64; 5], within| block.peak(&scores, within, search);
        assert_eq!(of([0.0, 1.0, 0.0, -1.0, 0.0], 0..5), Ok(0.0));
        assert_eq!(of([0.0, 1.0, 0.0, -1.0, 0.0], 1..5), Err(Failure::RangeEnd));
        assert_eq!(of([0.0, 1.0, 0.0, -1.0, 2.0], 0..5), Err(Failure::RangeEnd));
        assert_eq!(of([0.5; 5], 0..5), Err(Failure::Flat));
        assert_eq!(of([0.0; 5], 2..2), Err(Failure::RangeEnd));
        assert_eq!(block.peak(&[], 0..5, search), Err(Failure::Flat));
    }
}
