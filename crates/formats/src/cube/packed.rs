//! Arrays in packed chunks: by blocks of as many rows as a chunk has where rows are their first dimension, else whole.

use super::arrange::{self, Part};
use super::axes::Axes;
use super::blocks::{Blocks, room};
use super::stored::Stored;
use super::values::Values;
use hadar::cube::{Cube, MemoryCube, Rows, Sample, Shape};
use hadar::error::Result;
use std::ops::Range;

/// An array of which slices of the first dimension can be unpacked.
pub(super) trait Slices: std::fmt::Debug + Send + Sync + 'static {
    fn stored(&self) -> Stored;

    /// What its numbers stand for, where they are not the samples themselves.
    fn values(&self) -> Option<&Values>;

    /// Slices of the first dimension, as they are stored.
    fn slices<S: Sample>(&self, first: usize, count: usize, out: &mut [S]) -> Result<()>;
}

/// A cube of which blocks of rows are unpacked as they are asked for.
#[derive(Debug)]
struct Packed<S, A> {
    array: A,
    shape: Shape,
    order: Axes,
    blocks: Blocks<S>,
}

/// The cube of an array with chunks of so many slices, outermost axis first in `order`; and the memory that it takes if it was unpacked whole.
pub(super) fn cube<A: Slices>(
    array: A,
    shape: Shape,
    order: Axes,
    chunk: usize,
) -> Result<(Cube, Option<u64>)> {
    fn of<S: Sample, A: Slices>(
        array: A,
        shape: Shape,
        order: Axes,
        chunk: usize,
    ) -> Result<Box<dyn Rows<S>>> {
        if order.place_of_rows() == 0 {
            return Ok(Box::new(Packed { array, shape, order, blocks: Blocks::new(shape, chunk) }));
        }
        let [_, middle, inner] = order.sides(shape);
        let mut first = 0;
        let mut samples = arrange::whole(shape, order, |out: &mut [S]| {
            let count = out.len() / (middle * inner);
            array.slices(first, count, out)?;
            first += count;
            Ok(())
        })?;
        if let Some(values) = array.values() {
            values.of_stored(&mut samples, shape.bands());
        }
        Ok(Box::new(MemoryCube::new(shape, samples)?))
    }
    let is_double = array.stored().is_double();
    let bytes = shape.len() as u64 * if is_double { 8 } else { 4 };
    let memory = (order.place_of_rows() != 0).then_some(bytes);
    let cube = match is_double {
        true => Cube::F64(of(array, shape, order, chunk)?),
        false => Cube::F32(of(array, shape, order, chunk)?),
    };
    Ok((cube, memory))
}

impl<S: Sample, A: Slices> Rows<S> for Packed<S, A> {
    fn shape(&self) -> Shape {
        self.shape
    }

    fn read<'a>(&'a self, rows: Range<usize>, buffer: &'a mut Vec<S>) -> Result<&'a [S]> {
        hadar::stop::check();
        let samples = room(&rows, self.shape, buffer)?;
        self.blocks.read(rows, samples, |rows: &Range<usize>, block: &mut [S]| {
            if self.order == Axes::default() {
                self.array.slices(rows.start, rows.len(), block)?;
            } else {
                let mut own = vec![S::zeroed(); block.len()];
                self.array.slices(rows.start, rows.len(), &mut own)?;
                let (columns, bands) = (0..self.shape.columns(), 0..self.shape.bands());
                let strides = self.order.strides(self.shape);
                Part { samples: &own, strides, columns, bands }.put(0, block, self.shape);
            }
            if let Some(values) = self.array.values() {
                values.of_stored(block, self.shape.bands());
            }
            Ok(())
        })?;
        Ok(samples)
    }
}
