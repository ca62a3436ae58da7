//! Some pixels of a cube, evenly in rows and columns: what is asked of a whole cube is asked of these where it has more.

use hadar::cube::{MemoryCube, Rows, Sample, Shape};
use hadar::error::Result;

/// Pixels that are enough to say what a cube is like.
pub(super) const LOOKED: usize = 1 << 14;

/// Some pixels of a cube, `most` at most, evenly in rows and columns.
pub(super) fn some<S: Sample>(cube: &dyn Rows<S>, most: usize) -> Result<MemoryCube<S>> {
    let shape = cube.shape();
    let stride = ((shape.rows() * shape.columns()) as f64 / most as f64).sqrt().ceil().max(1.0) as usize;
    let [down, across] = [stride.min(shape.rows()), stride.min(shape.columns())];
    let (mut samples, mut buffer, mut rows, mut columns) = (Vec::new(), Vec::new(), 0, 0);
    for row in (0..shape.rows()).step_by(down) {
        let own = cube.read(row..row + 1, &mut buffer)?;
        columns = 0;
        for pixel in own.chunks(shape.bands()).step_by(across) {
            samples.extend_from_slice(pixel);
            columns += 1;
        }
        rows += 1;
    }
    MemoryCube::new(Shape::new(rows, columns, shape.bands())?, samples)
}
