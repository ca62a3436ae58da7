//! The bands of a cube in another order.

use super::{Cube, Rows, Sample, Shape};
use crate::error::{Error, Result};
use std::ops::Range;

/// A cube whose band `i` is the band `order[i]` of another.
#[derive(Debug)]
struct Ordered<S: Sample> {
    cube: Box<dyn Rows<S>>,
    order: Vec<usize>,
}

impl Cube {
    /// The cube with its bands in another order: band `i` of it is the band `order[i]` of this one.
    ///
    /// # Errors
    /// An order that has not every band once.
    ///
    /// ```
    /// use hadar::cube::{Cube, MemoryCube, Shape};
    /// let cube: Cube = MemoryCube::new(Shape::new(1, 1, 3)?, vec![1.0, 2.0, 3.0])?.into();
    /// let Cube::F64(reversed) = cube.with_bands(vec![2, 1, 0])? else { return Ok(()) };
    /// assert_eq!(reversed.read(0..1, &mut Vec::new())?, [3.0, 2.0, 1.0]);
    /// # Ok::<(), hadar::Error>(())
    /// ```
    pub fn with_bands(self, order: Vec<usize>) -> Result<Self> {
        let mut sorted = order.clone();
        sorted.sort_unstable();
        if !sorted.iter().copied().eq(0..self.shape().bands()) {
            let found = format!("an order of {} bands for {}", order.len(), self.shape().bands());
            return Err(Error::malformed(found, "name every band once"));
        }
        if order.is_sorted() {
            return Ok(self);
        }
        Ok(match self {
            Self::F32(cube) => Self::F32(Box::new(Ordered { cube, order })),
            Self::F64(cube) => Self::F64(Box::new(Ordered { cube, order })),
        })
    }
}

impl<S: Sample> Rows<S> for Ordered<S> {
    fn shape(&self) -> Shape {
        self.cube.shape()
    }

    fn read<'a>(&'a self, rows: Range<usize>, buffer: &'a mut Vec<S>) -> Result<&'a [S]> {
        crate::stop::check();
        let mut own = Vec::new();
        let samples = self.cube.read(rows, &mut own)?;
        buffer.clear();
        for pixel in samples.chunks(self.order.len()) {
            buffer.extend(self.order.iter().filter_map(|band| pixel.get(*band)));
        }
        Ok(buffer)
    }
}
