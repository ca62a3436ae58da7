//! Pictures of a rendered scene: what a thermal camera sees, and what is there.

use crate::figures::Plot;
use crate::plot::{Axis, Picture, Pictures};
use crate::table::{Table, number};
use hadar_study::render::Rendered;

/// Widest picture, pixels: of larger ones every second, third… row and column is shown.
const WIDEST: usize = 320;
const FREEZING_K: f64 = 273.15;

/// The left view.
#[must_use]
pub fn scene(result: &Rendered) -> Plot {
    let (rows, columns, bands) = (result.shape.rows(), result.shape.columns(), result.shape.bands());
    let stride = columns.max(rows).div_ceil(WIDEST);
    let shown: Vec<usize> = (0..rows)
        .step_by(stride)
        .flat_map(|row| (0..columns).step_by(stride).map(move |column| row * columns + column))
        .collect();
    let empty = hadar_study::render::Picture::default();
    let view = result.views.first().unwrap_or(&empty);
    let take = |value: &dyn Fn(usize) -> f64| -> Vec<f64> { shown.iter().map(|i| value(*i)).collect() };
    let counts =
        |i: usize| view.counts[i * bands..(i + 1) * bands].iter().map(|n| f64::from(*n)).sum::<f64>();
    let sky = |i: usize, value: f64| if view.depth_m[i].is_finite() { value } else { f64::NAN };
    let of = |i: usize| f64::from(view.material[i]);
    let layers = [
        ("counts", "Thermal image", Axis::linear("counts, all bands"), take(&counts)),
        (
            "temperature_c",
            "Temperature",
            Axis::linear("temperature (°C)"),
            take(&|i| sky(i, f64::from(view.temperature_k[i]) - FREEZING_K)),
        ),
        (
            "material",
            "Material",
            Axis::linear("index in the library"),
            take(&|i| if view.material[i] == u16::MAX { f64::NAN } else { of(i) }),
        ),
        (
            "incident",
            "Incident radiance",
            Axis::linear("X (photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹)"),
            take(&|i| sky(i, f64::from(view.incident[i]))),
        ),
        ("depth_m", "Depth", Axis::log("depth (m)"), take(&|i| sky(i, f64::from(view.depth_m[i])))),
    ];
    let mut table = Table::new(["row", "column"].into_iter().chain(layers.iter().map(|layer| layer.0)));
    for (k, i) in shown.iter().enumerate() {
        let values = layers.iter().map(|layer| number(layer.3[k]));
        let place = [(i / columns).to_string(), (i % columns).to_string()];
        table.push(place.into_iter().chain(values).collect());
    }
    let wide = columns.div_ceil(stride);
    let pictures =
        layers.into_iter().map(|(_, title, axis, values)| Picture::new(title, axis, wide, values)).collect();
    let every = match stride {
        1 => String::new(),
        stride => format!(" Every {stride}th row and column of {rows} × {columns} is shown."),
    };
    let figure = Pictures::new("What is there, and what a thermal camera sees of it", pictures)
        .subtitle(format!("Rendered, {bands} bands.{every}"))
        .no_value("sky, or several materials in a pixel");
    Plot { name: "scene".into(), figure: figure.into(), table }
}
