//! Heat cubes: photon counts `N[row][column][band]`, in memory or given by rows.
//!
//! A cube is only ever asked for whole rows, in any order and by many threads at once: one that is larger than
//! memory costs no more than the rows that are in work. Samples are `f32` or `f64`, and stay so.
//!
//! [`first_invalid`] names the sample that is no count, [`panchromatic`] adds the bands.

mod band_order;
mod band_sum;
mod invalid;

pub use band_order::Ordered;
pub use band_sum::panchromatic;
pub use invalid::first_invalid;

use crate::error::{Error, Result};
use std::fmt::Debug;
use std::ops::Range;

/// Rows, columns and bands of a cube; none is 0, and their product fits the address space.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
pub struct Shape {
    rows: usize,
    columns: usize,
    bands: usize,
}

impl Shape {
    /// A shape.
    ///
    /// # Errors
    /// A dimension that is 0, or more samples than memory has addresses.
    ///
    /// ```
    /// let shape = hadar::cube::Shape::new(480, 640, 54)?;
    /// assert_eq!(shape.row_len(), 640 * 54);
    /// assert!(hadar::cube::Shape::new(480, 0, 54).is_err());
    /// # Ok::<(), hadar::Error>(())
    /// ```
    pub fn new(rows: usize, columns: usize, bands: usize) -> Result<Self> {
        let samples = rows.checked_mul(columns).and_then(|pixels| pixels.checked_mul(bands));
        let addressable = samples.is_some_and(|samples| samples <= isize::MAX as usize / size_of::<f64>());
        if addressable && samples != Some(0) {
            return Ok(Self { rows, columns, bands });
        }
        Err(Error::malformed(
            format!("a cube of {rows} rows, {columns} columns and {bands} bands"),
            "give one with at least one of each, and no more than memory can address",
        ))
    }

    /// Rows (y).
    #[must_use]
    pub const fn rows(self) -> usize {
        self.rows
    }

    /// Columns (x, along which the cameras are apart).
    #[must_use]
    pub const fn columns(self) -> usize {
        self.columns
    }

    /// Bands.
    #[must_use]
    pub const fn bands(self) -> usize {
        self.bands
    }

    /// Samples of a row: columns × bands.
    #[must_use]
    pub const fn row_len(self) -> usize {
        self.columns * self.bands
    }

    /// All samples.
    #[must_use]
    pub const fn len(self) -> usize {
        self.rows * self.columns * self.bands
    }

    /// Never: a shape has no dimension of 0.
    #[must_use]
    pub const fn is_empty(self) -> bool {
        false
    }
}

/// What a sample is stored as.
pub trait Sample: bytemuck::Pod + Into<f64> + PartialOrd + Debug + Send + Sync + 'static {
    /// Its name in messages, `f32` or `f64`.
    const NAME: &'static str;

    /// The nearest sample to a number.
    fn of(value: f64) -> Self;
}

impl Sample for f32 {
    const NAME: &'static str = "f32";

    fn of(value: f64) -> Self {
        value as Self
    }
}

impl Sample for f64 {
    const NAME: &'static str = "f64";

    fn of(value: f64) -> Self {
        value
    }
}

/// A cube that gives its rows.
pub trait Rows<S: Sample>: Debug + Send + Sync {
    /// Its shape.
    fn shape(&self) -> Shape;

    /// The samples of `rows`, row after row, `[column][band]` within each. A cube in memory gives its own; one in a file
    /// fills `buffer` and gives that.
    ///
    /// # Errors
    /// Rows beyond the last one; a file that cannot be read.
    fn read<'a>(&'a self, rows: Range<usize>, buffer: &'a mut Vec<S>) -> Result<&'a [S]>;
}

impl<S: Sample, R: Rows<S> + ?Sized> Rows<S> for &R {
    fn shape(&self) -> Shape {
        (**self).shape()
    }

    fn read<'a>(&'a self, rows: Range<usize>, buffer: &'a mut Vec<S>) -> Result<&'a [S]> {
        (**self).read(rows, buffer)
    }
}

impl<S: Sample> Rows<S> for Box<dyn Rows<S> + '_> {
    fn shape(&self) -> Shape {
        self.as_ref().shape()
    }

    fn read<'a>(&'a self, rows: Range<usize>, buffer: &'a mut Vec<S>) -> Result<&'a [S]> {
        self.as_ref().read(rows, buffer)
    }
}

/// A cube of either kind of sample.
#[derive(Debug)]
pub enum Cube {
    /// 32-bit samples.
    F32(Box<dyn Rows<f32>>),
    /// 64-bit samples.
    F64(Box<dyn Rows<f64>>),
}

impl Cube {
    /// Its shape.
    #[must_use]
    pub fn shape(&self) -> Shape {
        CubeRef::from(self).shape()
    }
}

/// A cube of either kind of sample that belongs to somebody else, such as an array of another language.
#[derive(Debug, Clone, Copy)]
pub enum CubeRef<'a> {
    /// 32-bit samples.
    F32(&'a dyn Rows<f32>),
    /// 64-bit samples.
    F64(&'a dyn Rows<f64>),
}

impl CubeRef<'_> {
    /// Its shape.
    #[must_use]
    pub fn shape(self) -> Shape {
        match self {
            Self::F32(cube) => cube.shape(),
            Self::F64(cube) => cube.shape(),
        }
    }
}

impl<'a> From<&'a Cube> for CubeRef<'a> {
    fn from(cube: &'a Cube) -> Self {
        match cube {
            Cube::F32(cube) => Self::F32(cube.as_ref()),
            Cube::F64(cube) => Self::F64(cube.as_ref()),
        }
    }
}

/// A cube in memory.
#[derive(Debug, Clone, PartialEq)]
pub struct MemoryCube<S> {
    shape: Shape,
    samples: Vec<S>,
}

impl<S: Sample> MemoryCube<S> {
    /// A cube of samples `[row][column][band]`.
    ///
    /// # Errors
    /// A number of samples that is not that of the shape.
    pub fn new(shape: Shape, samples: Vec<S>) -> Result<Self> {
        if samples.len() == shape.len() {
            return Ok(Self { shape, samples });
        }
        Err(Error::Length {
            what: "samples of a cube".to_owned(),
            found: samples.len(),
            expected: shape.len(),
        })
    }

    /// All samples, `[row][column][band]`.
    #[must_use]
    pub fn samples(&self) -> &[S] {
        &self.samples
    }
}

impl<S: Sample> Rows<S> for MemoryCube<S> {
    fn shape(&self) -> Shape {
        self.shape
    }

    fn read<'a>(&'a self, rows: Range<usize>, _buffer: &'a mut Vec<S>) -> Result<&'a [S]> {
        crate::stop::check();
        let len = self.shape.row_len();
        self.samples
            .get(rows.start.saturating_mul(len)..rows.end.saturating_mul(len))
            .ok_or_else(|| beyond(&rows, self.shape))
    }
}

/// The error of an implementation of [`Rows::read`] that is asked for rows beyond its last.
#[must_use]
pub fn beyond(rows: &Range<usize>, shape: Shape) -> Error {
    let instead = format!("the cube has {} rows", shape.rows());
    Error::malformed(format!("rows {} to {} of a cube", rows.start, rows.end), instead)
}

impl From<MemoryCube<f32>> for Cube {
    fn from(cube: MemoryCube<f32>) -> Self {
        Self::F32(Box::new(cube))
    }
}

impl From<MemoryCube<f64>> for Cube {
    fn from(cube: MemoryCube<f64>) -> Self {
        Self::F64(Box::new(cube))
    }
}
