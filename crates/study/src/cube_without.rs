//! Cubes that hand on the samples of bad pixels as missing ones.

use hadar::cube::{Cube, Rows, Sample, Shape};
use hadar::error::Result;
use std::ops::Range;

/// A cube whose bad pixels have no samples.
#[derive(Debug)]
struct Without<S> {
    cube: Box<dyn Rows<S>>,
    /// Pixels that are not 0 here have no samples, `[row][column]`.
    bad: Vec<u8>,
}

/// The cube without the samples of the pixels that are not 0 in a map; itself where there are none.
pub(super) fn without(cube: Cube, map: &[u8]) -> Cube {
    if map.iter().all(|code| *code == 0) {
        return cube;
    }
    let bad = map.to_vec();
    match cube {
        Cube::F32(cube) => Cube::F32(Box::new(Without { cube, bad })),
        Cube::F64(cube) => Cube::F64(Box::new(Without { cube, bad })),
    }
}

impl<S: Sample> Rows<S> for Without<S> {
    fn shape(&self) -> Shape {
        self.cube.shape()
    }

    fn read<'a>(&'a self, rows: Range<usize>, buffer: &'a mut Vec<S>) -> Result<&'a [S]> {
        let (shape, first) = (self.shape(), rows.start.saturating_mul(self.shape().columns()));
        let mut own = Vec::new();
        let samples = self.cube.read(rows, &mut own)?;
        buffer.clear();
        buffer.extend_from_slice(samples);
        let pixels = buffer.chunks_mut(shape.bands()).enumerate();
        for (_, pixel) in pixels.filter(|(i, _)| self.bad.get(first + i).is_some_and(|code| *code > 0)) {
            pixel.fill(S::of(f64::NAN));
        }
        Ok(buffer)
    }
}
