//! What is asked of a cube, and what comes back: windows, resolutions, J of every window.

use crate::error::{Error, Result};
use crate::ranging::derivative::Derivative;
use crate::ranging::noise::{Joined, NoiseVariance};
use std::ops::Range;

/// A window of pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
pub struct Window {
    rows: usize,
    columns: usize,
}

impl Window {
    /// A window of `rows` × `columns` pixels, odd numbers so that it has a pixel at its centre.
    ///
    /// # Errors
    /// A side that is 0 or even.
    ///
    /// ```
    /// use hadar::ranging::information::Window;
    /// assert_eq!(Window::new(5, 7)?.columns(), 7);
    /// assert!(Window::new(4, 5).is_err());
    /// # Ok::<(), hadar::Error>(())
    /// ```
    pub fn new(rows: usize, columns: usize) -> Result<Self> {
        if rows % 2 == 1 && columns % 2 == 1 {
            return Ok(Self { rows, columns });
        }
        Err(Error::malformed(
            format!("a window of {rows} x {columns} pixels"),
            "give odd numbers of pixels, so that one is at its centre, e.g. 5 x 5",
        ))
    }

    /// Pixels in y.
    #[must_use]
    pub const fn rows(self) -> usize {
        self.rows
    }

    /// Pixels in x.
    #[must_use]
    pub const fn columns(self) -> usize {
        self.columns
    }

    /// Pixels above and below the centre.
    #[must_use]
    pub const fn half_rows(self) -> usize {
        self.rows / 2
    }

    /// Pixels on either side of the centre.
    #[must_use]
    pub const fn half_columns(self) -> usize {
        self.columns / 2
    }
}

/// Which resolution a window is looked at with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Cell {
    /// Neither: all photons of the window counted together.
    Total,
    /// Bands apart, pixels of the window together.
    Spectral,
    /// Pixels apart, bands together: a thermal image.
    Spatial,
    /// Pixels and bands apart: a heat cube.
    Full,
}

impl Cell {
    /// All four, in the order of Table S4.
    pub const ALL: [Self; 4] = [Self::Total, Self::Spatial, Self::Spectral, Self::Full];
}

/// What is asked of a cube.
#[derive(Debug, Clone)]
pub struct Request<'a> {
    /// The window.
    pub window: Window,
    /// How ∂N is taken.
    pub derivative: Derivative,
    /// Electronic noise.
    pub noise: &'a NoiseVariance,
    /// Electronic noise of joined samples.
    pub joined: Joined,
    /// What is to be computed; nothing else is.
    pub cells: &'a [Cell],
    /// Rows of the windows' centres; those whose window or derivative reaches beyond the image are left out.
    pub centres: Range<usize>,
}

/// J of every window, as far as it was asked for.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct InformationMap {
    /// Rows of the centres.
    pub rows: Range<usize>,
    /// Columns of the centres.
    pub columns: Range<usize>,
    /// J, pixel⁻², `[row][column]` of the centres; empty for a cell that was not asked for. In the order of [`Cell::ALL`].
    pub information: [Vec<f64>; 4],
    /// Photons N in each window, `[row][column]`.
    pub photons: Vec<f64>,
    /// ΣΣσ² of each window, counts², `[row][column]`.
    pub var_added: Vec<f64>,
}

impl InformationMap {
    /// J of a cell, pixel⁻², `[row][column]` of the centres; empty where it was not asked for.
    #[must_use]
    pub fn cell(&self, cell: Cell) -> &[f64] {
        let [total, spatial, spectral, full] = &self.information;
        match cell {
            Cell::Total => total,
            Cell::Spatial => spatial,
            Cell::Spectral => spectral,
            Cell::Full => full,
        }
    }
}
