//! Pictures of a rendered scene: what a thermal camera sees, and what is there.

use crate::figures::Plot;
use crate::plot::{Axis, Painted, Picture, Pictures, Rgb, categorical};
use crate::shown::Shown;
use crate::words::render::rendered;
use hadar_study::render::Rendered;

const FREEZING_K: f64 = 273.15;
const NOT_ONE: &str = "sky, or several materials in a pixel";

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
    let (table, mut pictures) = shown.layers(vec![
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
    let (material, keys) = materials(result, shown, &view.material);
    if let Some(picture) = pictures.iter_mut().find(|picture| picture.title == "Material") {
        *picture = material;
    }
    let figure = Pictures::new("What is there, and what does a thermal camera see of it?", pictures)
        .keys(keys)
        .subtitle(rendered(bands, shown))
        .no_value("");
    Plot { name: "scene".into(), figure: figure.into(), table }
}

/// Materials in colours of their own, with their names; pixels of none or of several in that of no value.
fn materials(result: &Rendered, shown: Shown, material: &[u16]) -> (Picture, Vec<(Rgb, String)>) {
    let none: Rgb = (0xD6, 0xD6, 0xD6);
    let areas: Vec<Option<usize>> = shown
        .places()
        .map(|[_, _, at]| material.get(at).copied().filter(|own| *own != u16::MAX).map(usize::from))
        .collect();
    // Those that are seen, so that their colours are few.
    let mut seen: Vec<usize> = areas.iter().flatten().copied().collect();
    seen.sort_unstable();
    seen.dedup();
    let colour = |own: usize| seen.iter().position(|one| *one == own).map_or(none, categorical);
    let pixels = areas.iter().map(|own| own.map_or(none, colour)).collect();
    let picture =
        Picture::painted("Material", Axis::linear(""), shown.wide(), Painted { pixels, ramp: None })
            .name_areas(&areas, &result.materials);
    let name = |own: &usize| Some((colour(*own), result.materials.get(*own)?.clone()));
    let keys = seen.iter().filter_map(name).chain([(none, NOT_ONE.to_owned())]);
    (picture, keys.collect())
}
