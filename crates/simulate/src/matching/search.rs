//! Two views, the disparities that are tried in them, and what a match comes to.

use hadar::cube::Shape;
use hadar::error::{Error, Result, check};
use hadar::ranging::information::Window;
use std::ops::Range;

/// Two views of the same shape: expected counts, or readings.
///
/// ```
/// use hadar::cube::Shape;
/// use hadar_simulate::matching::StereoPair;
/// let shape = Shape::new(1, 2, 1)?;
/// assert!(StereoPair::new(shape, &[1.0, 2.0], &[2.0, 3.0]).is_ok());
/// assert!(StereoPair::new(shape, &[1.0, 2.0], &[2.0]).is_err());
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct StereoPair<'a> {
    shape: Shape,
    left: &'a [f64],
    right: &'a [f64],
}

impl<'a> StereoPair<'a> {
    /// Views `[row][column][band]` of the same shape.
    ///
    /// # Errors
    /// A view whose samples are not as many as the shape has, or one that is not finite.
    pub fn new(shape: Shape, left: &'a [f64], right: &'a [f64]) -> Result<Self> {
        for (what, view) in [("samples of the left view", left), ("samples of the right view", right)] {
            if view.len() != shape.len() {
                return Err(Error::Length { what: what.into(), found: view.len(), expected: shape.len() });
            }
            if let Some(at) = view.iter().position(|sample| !sample.is_finite()) {
                let (row, column) = (at / shape.row_len(), at % shape.row_len() / shape.bands());
                let what = format!("{what}, row {row}, column {column}");
                check::finite(&what, view.get(at).copied().unwrap_or(f64::NAN), "counts")?;
            }
        }
        Ok(Self { shape, left, right })
    }

    /// Shape of either view.
    #[must_use]
    pub const fn shape(&self) -> Shape {
        self.shape
    }

    /// The left view.
    #[must_use]
    pub const fn left(&self) -> &'a [f64] {
        self.left
    }

    /// The right view.
    #[must_use]
    pub const fn right(&self) -> &'a [f64] {
        self.right
    }
}

/// Whole disparities that are tried, pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
pub struct Search {
    least: i32,
    most: i32,
}

impl Search {
    /// From `least` to `most`, both included.
    ///
    /// # Errors
    /// Fewer than three disparities, or more than 65 536.
    ///
    /// ```
    /// use hadar_simulate::matching::Search;
    /// assert_eq!(Search::new(0, 31)?.disparities(), 32);
    /// assert!(Search::new(3, 4).is_err());
    /// # Ok::<(), hadar::Error>(())
    /// ```
    pub fn new(least: i32, most: i32) -> Result<Self> {
        if (2..65_536).contains(&(i64::from(most) - i64::from(least))) {
            return Ok(Self { least, most });
        }
        Err(Error::malformed(
            format!("a search from {least} to {most} pixels of disparity"),
            "give a range of 3 to 65536 whole disparities, the lowest first",
        ))
    }

    /// Lowest one.
    #[must_use]
    pub const fn least(self) -> i32 {
        self.least
    }

    /// Highest one.
    #[must_use]
    pub const fn most(self) -> i32 {
        self.most
    }

    /// How many.
    #[must_use]
    pub const fn disparities(self) -> usize {
        (self.most as i64 - self.least as i64 + 1) as usize
    }

    /// Those, counted from the lowest, whose window about column x − d lies within the image.
    pub(super) fn within(self, column: usize, columns: usize, half: usize) -> Range<usize> {
        let (x, half, last) = (column as i64, half as i64, columns as i64 - 1);
        let (least, most) = (i64::from(self.least), i64::from(self.most));
        let (first, end) = ((x + half - last).max(least), (x - half).min(most) + 1);
        (first - least) as usize..(end.max(first) - least) as usize
    }
}

hadar::named! {
    /// Why there is no disparity.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum Failure {
        /// Nothing in the window that could be matched: it is the same everywhere.
        Flat = "no texture",
        /// The best match is at an end of the range (or of the image): the true one may be beyond.
        RangeEnd = "best at the end of the range",
        /// The refinement ran out of its pixel, or did not end.
        Unconverged = "refinement did not converge",
    }
    /// In words.
    text
}

/// A disparity, pixels, or why there is none.
pub type Match = std::result::Result<f64, Failure>;

/// A window fits into the image.
pub(super) fn check_window(window: Window, shape: Shape) -> Result<()> {
    if window.rows() <= shape.rows() && window.columns() <= shape.columns() {
        return Ok(());
    }
    Err(Error::malformed(
        format!(
            "a window of {} x {} pixels in an image of {} rows and {} columns",
            window.rows(),
            window.columns(),
            shape.rows(),
            shape.columns()
        ),
        "give one that fits into the image",
    ))
}
