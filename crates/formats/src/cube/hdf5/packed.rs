//! Arrays in packed chunks whose first dimension is that of the rows: by blocks of as many rows as a chunk has.

use super::array::Array;
use crate::cube::arrange::Part;
use crate::cube::axes::Axes;
use crate::cube::blocks::{Blocks, room};
use hadar::cube::{Cube, Rows, Sample, Shape};
use hadar::error::Result;
use std::ops::Range;

/// A cube of which blocks of rows are unpacked as they are asked for.
#[derive(Debug)]
struct Packed<S> {
    array: Array,
    shape: Shape,
    order: Axes,
    blocks: Blocks<S>,
}

/// The cube of an array, with chunks of so many rows.
pub(super) fn cube(array: Array, shape: Shape, order: Axes, chunk: usize) -> Cube {
    fn of<S: Sample>(array: Array, shape: Shape, order: Axes, chunk: usize) -> Box<Packed<S>> {
        Box::new(Packed { array, shape, order, blocks: Blocks::new(shape, chunk) })
    }
    match array.stored.is_double() {
        true => Cube::F64(of(array, shape, order, chunk)),
        false => Cube::F32(of(array, shape, order, chunk)),
    }
}

impl<S: Sample> Rows<S> for Packed<S> {
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
            if let Some(values) = &self.array.values {
                values.of_stored(block, self.shape.bands());
            }
            Ok(())
        })?;
        Ok(samples)
    }
}
