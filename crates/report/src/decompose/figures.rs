//! Pictures of a decomposed cube: temperature, its deviation, material, how many are left.

use super::shown::places;
use crate::figures::Plot;
use crate::plot::{Axis, Picture, Pictures};
use crate::table::{Table, number};
use crate::words::decompose::how;
use hadar_study::decompose::{Block, Decomposed};

/// The maps, of the pixels that are shown.
#[must_use]
pub(super) fn maps(result: &Decomposed, shown: &Block, stride: usize) -> Plot {
    let (rows, columns) = (result.shape.rows(), result.shape.columns());
    let (places, wide) = places(result.shape, stride);
    let maps = &shown.maps;
    let none = |x: f64| if x.is_finite() { x } else { f64::NAN };
    let whole = |of: &[u16], nothing: u16| -> Vec<f64> {
        of.iter().map(|x| if *x == nothing { f64::NAN } else { f64::from(*x) }).collect()
    };
    let layers: [(&str, &str, Axis, Vec<f64>); 4] = [
        (
            "temperature_k",
            "Temperature",
            Axis::linear("temperature (K)"),
            maps.temperature_k.iter().map(|t| none(f64::from(*t))).collect(),
        ),
        (
            "temperature_sigma_k",
            "Its deviation",
            Axis::log("standard deviation (K)"),
            maps.temperature_sigma_k.iter().map(|sigma| none(f64::from(*sigma))).collect(),
        ),
        ("material", "Material", Axis::linear("index in the library"), whole(&maps.material, u16::MAX)),
        ("candidates", "Materials that 95 % leave", Axis::linear("materials"), whole(&maps.candidates, 0)),
    ];
    let mut table = Table::new(["row", "column"].into_iter().chain(layers.iter().map(|layer| layer.0)));
    for (i, [row, column, _]) in places.iter().enumerate() {
        let values =
            layers.iter().map(|layer| layer.3.get(i).map_or_else(String::new, |value| number(*value)));
        table.push([row.to_string(), column.to_string()].into_iter().chain(values).collect());
    }
    let pictures =
        layers.into_iter().map(|(_, title, axis, values)| Picture::new(title, axis, wide, values)).collect();
    let every = match stride {
        1 => String::new(),
        stride => {
            format!(" Every {stride}th row and column of {rows} × {columns}; all are in the NPY files.")
        }
    };
    let figure = Pictures::new("What the photons tell", pictures)
        .subtitle(format!("{}.{every}", how(result)))
        .no_value("nothing is told");
    Plot { name: "maps".into(), figure: figure.into(), table }
}
