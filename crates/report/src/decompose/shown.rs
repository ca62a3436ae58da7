//! Pixels that are shown in pictures and listed in their tables: every so many rows and columns, so that they are not too many.

use hadar::cube::Shape;

/// Widest picture, pixels: of larger cubes every second, third… row and column is shown.
const WIDEST: usize = 320;

/// From a row and column that is shown to the next.
pub(super) fn stride(shape: Shape) -> usize {
    shape.columns().max(shape.rows()).div_ceil(WIDEST)
}

/// Row, column and place, counted row after row, of every pixel that is shown, and how many are side by side.
pub(super) fn places(shape: Shape, stride: usize) -> (Vec<[usize; 3]>, usize) {
    let (rows, columns) = (shape.rows(), shape.columns());
    let of_row =
        |row: usize| (0..columns).step_by(stride).map(move |column| [row, column, row * columns + column]);
    ((0..rows).step_by(stride).flat_map(of_row).collect(), columns.div_ceil(stride))
}
