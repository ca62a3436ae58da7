//! Pixels that are shown in pictures and listed in their tables: every so many rows and columns, so that they are not too many.

use crate::plot::{Axis, Picture};
use crate::table::{Table, number};
use hadar::cube::Shape;

/// Widest picture, pixels: of larger cubes every second, third… row and column is shown.
const WIDEST: usize = 320;

/// Pixels that are shown.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Shown {
    /// Rows and columns of the whole.
    pub(crate) size: [usize; 2],
    /// From a row and column that is shown to the next.
    pub(crate) stride: usize,
}

/// What is shown of the pixels: the head of its column, its title, its scale, its values.
pub(crate) type Layer = (&'static str, &'static str, Axis, Vec<f64>);

impl Shown {
    /// Of an image or a cube of this shape.
    pub(crate) fn of(shape: Shape) -> Self {
        Self::within([shape.rows(), shape.columns()], WIDEST)
    }

    /// Of an image of so many rows and columns, at most `widest` of them.
    pub(crate) fn within(size: [usize; 2], widest: usize) -> Self {
        Self { size, stride: size[0].max(size[1]).div_ceil(widest) }
    }

    /// How many pixels are side by side.
    pub(crate) fn wide(self) -> usize {
        self.size[1].div_ceil(self.stride)
    }

    /// Row, column and place, counted row after row.
    pub(crate) fn places(self) -> impl Iterator<Item = [usize; 3]> {
        let ([rows, columns], stride) = (self.size, self.stride);
        let of_row = move |row: usize| {
            (0..columns).step_by(stride).map(move |column| [row, column, row * columns + column])
        };
        (0..rows).step_by(stride).flat_map(of_row)
    }

    /// A value of each of them by its place.
    pub(crate) fn values(self, of: impl Fn(usize) -> f64) -> Vec<f64> {
        self.places().map(|[_, _, at]| of(at)).collect()
    }

    /// Layers as a table and as pictures.
    pub(crate) fn layers(self, layers: Vec<Layer>) -> (Table, Vec<Picture>) {
        let mut table = Table::new(["row", "column"].into_iter().chain(layers.iter().map(|layer| layer.0)));
        for (i, [row, column, _]) in self.places().enumerate() {
            let values = layers.iter().map(|layer| number(layer.3.get(i).copied().unwrap_or(f64::NAN)));
            table.push([row.to_string(), column.to_string()].into_iter().chain(values).collect());
        }
        let picture = |(_, title, axis, values): Layer| Picture::new(title, axis, self.wide(), values);
        (table, layers.into_iter().map(picture).collect())
    }
}
