//! A heat cube in an array of Python, read where it lies.

use crate::array::{as_it_lies, numbers};
use crate::error::raised;
use crate::quantity::In;
use hadar::cube::{CubeRef, Rows, Sample, Shape};
use hadar::error::{Error, Result};
use numpy::ndarray::{ArrayView3, ArrayViewD, Ix3, s};
use numpy::{Element, PyReadonlyArrayDyn, PyUntypedArrayMethods as _};
use pyo3::prelude::*;
use std::ops::Range;

/// An array of counts of either kind of sample.
pub(crate) enum Lent<'py> {
    F32(PyReadonlyArrayDyn<'py, f32>),
    F64(PyReadonlyArrayDyn<'py, f64>),
}

impl<'py> Lent<'py> {
    /// Takes arrays of 32-bit and 64-bit floating-point numbers as they lie; whole numbers are converted.
    pub(crate) fn of(given: &Bound<'py, PyAny>) -> PyResult<Self> {
        match as_it_lies::<f32>(given)? {
            Some(array) => Ok(Self::F32(array)),
            None => numbers::<f64>(given, "cube", In::Counts).map(Self::F64),
        }
    }

    /// Shape of the array without its last axis, the bands.
    pub(crate) fn pixels(&self) -> &[usize] {
        let shape = match self {
            Self::F32(array) => array.shape(),
            Self::F64(array) => array.shape(),
        };
        shape.split_last().map_or(&[], |(_, pixels)| pixels)
    }

    /// The same as rows and columns of pixels.
    pub(crate) fn view(&self) -> PyResult<View<'_>> {
        let view = match self {
            Self::F32(array) => Lane::of(array).map(View::F32),
            Self::F64(array) => Lane::of(array).map(View::F64),
        };
        view.map_err(raised)
    }
}

/// A view of it that other threads may have.
#[derive(Debug)]
pub(crate) enum View<'a> {
    F32(Lane<'a, f32>),
    F64(Lane<'a, f64>),
}

impl View<'_> {
    pub(crate) fn cube(&self) -> CubeRef<'_> {
        match self {
            Self::F32(view) => CubeRef::F32(view),
            Self::F64(view) => CubeRef::F64(view),
        }
    }
}

/// Samples `[row][column][band]` of any strides.
#[derive(Debug)]
pub(crate) struct Lane<'a, S> {
    samples: ArrayView3<'a, S>,
    shape: Shape,
}

impl<'a, S: Sample + Element> Lane<'a, S> {
    fn of(array: &'a PyReadonlyArrayDyn<'_, S>) -> Result<Self> {
        let view: ArrayViewD<'a, S> = array.as_array();
        let found = view.ndim();
        let view = match found {
            1 => view.insert_axis(numpy::ndarray::Axis(0)).insert_axis(numpy::ndarray::Axis(0)),
            2 => view.insert_axis(numpy::ndarray::Axis(1)),
            _ => view,
        };
        let samples = view.into_dimensionality::<Ix3>().map_err(|_| {
            let instead = "give (rows, columns, bands), or (pixels, bands), or (bands,) of one pixel";
            Error::malformed(format!("a cube of {found} dimensions"), instead)
        })?;
        let (rows, columns, bands) = samples.dim();
        Ok(Self { samples, shape: Shape::new(rows, columns, bands)? })
    }
}

impl<S: Sample> Rows<S> for Lane<'_, S> {
    fn shape(&self) -> Shape {
        self.shape
    }

    fn read<'a>(&'a self, rows: Range<usize>, buffer: &'a mut Vec<S>) -> Result<&'a [S]> {
        if rows.start > rows.end || rows.end > self.shape.rows() {
            let found = format!("rows {} to {} of a cube", rows.start, rows.end);
            return Err(Error::malformed(found, format!("the cube has {} rows", self.shape.rows())));
        }
        let asked = self.samples.slice(s![rows, .., ..]);
        if let Some(samples) = asked.to_slice() {
            return Ok(samples);
        }
        buffer.clear();
        buffer.extend(asked.iter().copied());
        Ok(buffer)
    }
}
