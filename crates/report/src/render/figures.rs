//! Pictures of a rendered scene: what a thermal camera sees, and what is there.

use crate::figures::Plot;
use crate::plot::{Axis, Pictures};
use crate::shown::Shown;
use crate::words::render::rendered;
use hadar_study::render::Rendered;

const FREEZING_K: f64 = 273.15;

/// The left view.
#[must_use]
pub fn scene(result: &Rendered) -> Plot {
    let (shown, bands) = (Shown::of(result.shape), result.shape.bands());
    let empty = hadar_study::render::Picture::default();
    let view = result.views.first().unwrap_or(&empty);
    let counts =
        |i: usize| view.counts[i * bands..(i + 1) * bands].iter().map(|n| f64::from(*n)).sum::<f64>();
    let sky = |i: usize, value: f64| if view.depth_m[i].is_finite() { value } else { f64::NAN };
    let of = |i: usize| f64::from(view.material[i]);
    let (table, pictures) = shown.layers(vec![
        ("counts", "Thermal image", Axis::linear("counts, all bands"), shown.values(counts)),
        (
            "temperature_c",
            "Temperature",
            Axis::linear("temperature (°C)"),
            shown.values(|i| sky(i, f64::from(view.temperature_k[i]) - FREEZING_K)),
        ),
        (
            "material",
            "Material",
            Axis::linear("index in the library"),
            shown.values(|i| if view.material[i] == u16::MAX { f64::NAN } else { of(i) }),
        ),
        (
            "incident",
            "Incident radiance",
            Axis::linear("X (photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹)"),
            shown.values(|i| sky(i, f64::from(view.incident[i]))),
        ),
        ("depth_m", "Depth", Axis::log("depth (m)"), shown.values(|i| sky(i, f64::from(view.depth_m[i])))),
    ]);
    let figure = Pictures::new("What is there, and what a thermal camera sees of it", pictures)
        .subtitle(rendered(bands, shown))
        .no_value("sky, or several materials in a pixel");
    Plot { name: "scene".into(), figure: figure.into(), table }
}
