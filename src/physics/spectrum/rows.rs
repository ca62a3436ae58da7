//! Rows of ascending wavenumber.

use crate::error::{Error, Result};

/// Relative difference below which two wavenumbers, or lengths, are one: 10⁴/λ seldom hits a round one exactly.
const SAME: f64 = 1e-12;

/// Whether two wavenumbers or lengths are one and the same.
pub(crate) fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= SAME * a.abs().max(b.abs())
}

/// Refuses a wavenumber that comes twice in `what`.
pub(super) fn distinct(ascending: impl Iterator<Item = f64>, what: &str) -> Result<()> {
    let mut last = f64::NAN;
    for value in ascending {
        if value == last {
            return Err(Error::malformed(
                format!("wavenumber {value} cm^-1 comes twice in {what}"),
                "keep one of the rows",
            ));
        }
        last = value;
    }
    Ok(())
}

/// A step that is so many times as wide as all of up to so many on either side is a gap, where there is one on each side and so many of both.
const WIDE: f64 = 5.0;
const BESIDE: usize = 3;
/// Share of a gap at either end that still is its row: wavenumbers of files are rounded.
const EDGE: f64 = 1e-3;

/// Gaps of a spectrum: rows more than 5 times as far apart as any of the three steps on either side, near an end of those that there are. What was
/// measured at even steps was not measured between them; a table of a few rows by hand has no steps.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Gaps(Vec<[f64; 2]>);

impl Gaps {
    /// Those of rows at ascending wavenumbers, cm⁻¹.
    ///
    /// ```
    /// use hadar::spectrum::Gaps;
    /// let rows: Vec<f64> = (0..50).chain(150..200).map(|i| 700.0 + f64::from(i)).collect();
    /// let gaps = Gaps::of(&rows);
    /// assert!(gaps.check(749.0).is_ok() && gaps.check(800.0).is_err());
    /// ```
    #[must_use]
    pub fn of(rows_cm1: &[f64]) -> Self {
        let widest = |rows: &[f64]| rows.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
        let gap = |at: usize| {
            let (before, after) = rows_cm1.split_at_checked(at)?;
            let before = before.get(at.saturating_sub(BESIDE + 1)..)?;
            let after = after.get(..after.len().min(BESIDE + 1))?;
            let (a, b) = (*before.last()?, *after.first()?);
            let has_steps = before.len().min(after.len()) > 1 && before.len() + after.len() > BESIDE + 1;
            (has_steps && b - a > WIDE * widest(before).max(widest(after))).then_some([a, b])
        };
        Self((1..rows_cm1.len()).filter_map(gap).collect())
    }

    /// Refuses a wavenumber that lies in one.
    ///
    /// # Errors
    /// The rows around it.
    pub fn check(&self, wavenumber_cm1: f64) -> Result<()> {
        self.check_range([wavenumber_cm1; 2])
    }

    /// Refuses a range that reaches into one.
    ///
    /// # Errors
    /// The rows around it.
    pub fn check_range(&self, [low_cm1, high_cm1]: [f64; 2]) -> Result<()> {
        let inside = |[a, b]: &&[f64; 2]| {
            let edge = EDGE * (b - a);
            a + edge < high_cm1 && low_cm1 < b - edge
        };
        let Some([a, b]) = self.0.iter().find(inside) else { return Ok(()) };
        Err(Error::malformed(
            format!("no rows between {a:.2} and {b:.2} cm^-1, over five times as far apart as those beside"),
            "add what was measured there, or narrow the bands to what was",
        ))
    }
}

/// The value at x on straight lines between rows of ascending x; beyond them that of the last one.
#[must_use]
pub fn interpolated(xs: &[f64], ys: &[f64], x: f64) -> f64 {
    let right = xs.partition_point(|&row| row < x);
    match (xs.get(right), ys.get(right)) {
        (Some(&row), Some(&value)) if row == x || right == 0 => value,
        (Some(&high), Some(&value_high)) => {
            let (low, value_low) = (xs[right - 1], ys[right - 1]);
            value_low + (value_high - value_low) * ((x - low) / (high - low))
        }
        _ => ys.last().copied().unwrap_or(0.0),
    }
}
