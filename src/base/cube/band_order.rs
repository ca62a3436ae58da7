//! The bands of a cube in another order, some of them, or among others that it has not.

use super::{Cube, Rows, Sample, Shape};
use crate::error::{Error, Result};
use std::ops::Range;

/// A cube whose band `i` is the band `order[i]` of another.
#[derive(Debug)]
pub struct Ordered<'a, S: Sample> {
    cube: Box<dyn Rows<S> + 'a>,
    order: Vec<usize>,
    shape: Shape,
}

impl<'a, S: Sample> Ordered<'a, S> {
    /// Band `i` of it is the band `order[i]` of `cube`.
    ///
    /// # Errors
    /// No band, one that is not there, or one that is named twice.
    pub fn new(cube: impl Rows<S> + 'a, order: Vec<usize>) -> Result<Self> {
        let (mut sorted, shape) = (order.clone(), cube.shape());
        sorted.sort_unstable();
        let twice = sorted.windows(2).any(|pair| pair[0] == pair[1]);
        if twice || sorted.last().is_none_or(|last| *last >= shape.bands()) {
            let found = format!("an order of {} bands for {}", order.len(), shape.bands());
            return Err(Error::malformed(found, "name every band that is wanted once"));
        }
        let shape = Shape::new(shape.rows(), shape.columns(), order.len())?;
        Ok(Self { cube: Box::new(cube), order, shape })
    }
}

/// A cube among whose bands are some that another has not: of these it has NaN.
#[derive(Debug)]
struct Placed<S: Sample> {
    cube: Box<dyn Rows<S>>,
    places: Vec<Option<usize>>,
    shape: Shape,
}

impl Cube {
    /// The cube with bands in other places: band `i` of it is the band `places[i]` of this one, and missing (NaN) where there is none.
    ///
    /// # Errors
    /// No place, or a band that is not there.
    ///
    /// ```
    /// use hadar::cube::{Cube, MemoryCube, Shape};
    /// let cube: Cube = MemoryCube::new(Shape::new(1, 1, 2)?, vec![1.0, 2.0])?.into();
    /// let Cube::F64(wider) = cube.with_places(vec![Some(0), None, Some(1)])? else { return Ok(()) };
    /// let mut buffer = Vec::new();
    /// let samples = wider.read(0..1, &mut buffer)?;
    /// assert!(samples[0] == 1.0 && samples[1].is_nan() && samples[2] == 2.0);
    /// # Ok::<(), hadar::Error>(())
    /// ```
    pub fn with_places(self, places: Vec<Option<usize>>) -> Result<Self> {
        let own = self.shape();
        if let Some(beyond) = places.iter().flatten().find(|band| **band >= own.bands()) {
            let found = format!("band {beyond} of {}", own.bands());
            return Err(Error::malformed(found, "name bands that are there"));
        }
        let shape = Shape::new(own.rows(), own.columns(), places.len())?;
        Ok(match self {
            Self::F32(cube) => Self::F32(Box::new(Placed { cube, places, shape })),
            Self::F64(cube) => Self::F64(Box::new(Placed { cube, places, shape })),
        })
    }

    /// The cube with bands in another order, or without some: band `i` of it is the band `order[i]` of this one.
    ///
    /// # Errors
    /// No band, one that is not there, or one that is named twice.
    ///
    /// ```
    /// use hadar::cube::{Cube, MemoryCube, Shape};
    /// let cube: Cube = MemoryCube::new(Shape::new(1, 1, 3)?, vec![1.0, 2.0, 3.0])?.into();
    /// let Cube::F64(reversed) = cube.with_bands(vec![2, 1, 0])? else { return Ok(()) };
    /// assert_eq!(reversed.read(0..1, &mut Vec::new())?, [3.0, 2.0, 1.0]);
    /// # Ok::<(), hadar::Error>(())
    /// ```
    pub fn with_bands(self, order: Vec<usize>) -> Result<Self> {
        if order.iter().copied().eq(0..self.shape().bands()) {
            return Ok(self);
        }
        Ok(match self {
            Self::F32(cube) => Self::F32(Box::new(Ordered::new(cube, order)?)),
            Self::F64(cube) => Self::F64(Box::new(Ordered::new(cube, order)?)),
        })
    }
}

impl<S: Sample> Rows<S> for Placed<S> {
    fn shape(&self) -> Shape {
        self.shape
    }

    fn read<'a>(&'a self, rows: Range<usize>, buffer: &'a mut Vec<S>) -> Result<&'a [S]> {
        crate::stop::check();
        let mut own = Vec::new();
        let samples = self.cube.read(rows, &mut own)?;
        buffer.clear();
        let missing = S::of(f64::NAN);
        for pixel in samples.chunks(self.cube.shape().bands()) {
            let at = |place: &Option<usize>| place.and_then(|band| pixel.get(band)).copied();
            buffer.extend(self.places.iter().map(|place| at(place).unwrap_or(missing)));
        }
        Ok(buffer)
    }
}

impl<S: Sample> Rows<S> for Ordered<'_, S> {
    fn shape(&self) -> Shape {
        self.shape
    }

    fn read<'a>(&'a self, rows: Range<usize>, buffer: &'a mut Vec<S>) -> Result<&'a [S]> {
        crate::stop::check();
        let mut own = Vec::new();
        let samples = self.cube.read(rows, &mut own)?;
        buffer.clear();
        for pixel in samples.chunks(self.cube.shape().bands()) {
            buffer.extend(self.order.iter().filter_map(|band| pixel.get(*band)));
        }
        Ok(buffer)
    }
}
