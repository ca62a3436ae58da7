//! Pictures of a decomposed cube: temperature, its deviation, material, how many are left.

use crate::figures::Plot;
use crate::plot::{Axis, Picture, Pictures};
use crate::table::{Table, number};
use hadar::cube::Shape;
use hadar_study::study::decompose::Decomposed;

/// Widest picture, pixels: of larger cubes every second, third… row and column is shown.
const WIDEST: usize = 320;

/// From a row and column that is shown to the next.
pub(super) fn stride(shape: Shape) -> usize {
    shape.columns().max(shape.rows()).div_ceil(WIDEST)
}

/// The maps.
#[must_use]
pub fn maps(result: &Decomposed) -> Plot {
    let (rows, columns) = (result.shape.rows(), result.shape.columns());
    let stride = stride(result.shape);
    let shown: Vec<(usize, usize)> = (0..rows)
        .step_by(stride)
        .flat_map(|row| (0..columns).step_by(stride).map(move |column| (row, column)))
        .collect();
    let take = |value: &dyn Fn(usize) -> f64| -> Vec<f64> {
        shown.iter().map(|(row, column)| value(row * columns + column)).collect()
    };
    let maps = &result.maps;
    let none = |x: f64| if x.is_finite() { x } else { f64::NAN };
    let layers = [
        (
            "temperature_k",
            "Temperature",
            Axis::linear("temperature (K)"),
            take(&|i| none(maps.temperature_k[i].into())),
        ),
        (
            "temperature_sigma_k",
            "Its deviation",
            Axis::log("standard deviation (K)"),
            take(&|i| none(maps.temperature_sigma_k[i].into())),
        ),
        (
            "material",
            "Material",
            Axis::linear("index in the library"),
            take(&|i| if maps.material[i] == u16::MAX { f64::NAN } else { maps.material[i].into() }),
        ),
        (
            "candidates",
            "Materials that 95 % leave",
            Axis::linear("materials"),
            take(&|i| if maps.candidates[i] == 0 { f64::NAN } else { maps.candidates[i].into() }),
        ),
    ];
    let mut table = Table::new(["row", "column"].into_iter().chain(layers.iter().map(|layer| layer.0)));
    for (i, (row, column)) in shown.iter().enumerate() {
        let values = layers.iter().map(|layer| number(layer.3[i]));
        table.push([row.to_string(), column.to_string()].into_iter().chain(values).collect());
    }
    let wide = columns.div_ceil(stride);
    let pictures =
        layers.into_iter().map(|(_, title, axis, values)| Picture::new(title, axis, wide, values)).collect();
    let every = match stride {
        1 => String::new(),
        stride => {
            format!(" Every {stride}th row and column of {rows} × {columns}; all are in the NPY files.")
        }
    };
    let figure = Pictures::new("What the photons tell", pictures)
        .subtitle(format!("{}.{every}", super::text::how(result)))
        .no_value("nothing is told");
    Plot { name: "maps".into(), figure: figure.into(), table }
}
