//! Pictures of a decomposed cube: temperature, its deviation, material, how many are left.

use crate::figures::Plot;
use crate::plot::{Axis, Pictures};
use crate::shown::Shown;
use crate::words::decompose::how;
use crate::words::pictures::{NOTHING_TOLD, thinned};
use hadar_study::decompose::{Block, Decomposed};

/// The maps, of the pixels that are shown.
#[must_use]
pub(super) fn maps(result: &Decomposed, pixels: &Block, shown: Shown) -> Plot {
    let maps = &pixels.maps;
    let none = |x: f64| if x.is_finite() { x } else { f64::NAN };
    let whole = |of: &[u16], nothing: u16| -> Vec<f64> {
        of.iter().map(|x| if *x == nothing { f64::NAN } else { f64::from(*x) }).collect()
    };
    let (table, pictures) = shown.layers(vec![
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
    ]);
    let figure = Pictures::new("What the photons tell", pictures)
        .subtitle(format!("{}.{}", how(result), thinned(shown)))
        .no_value(NOTHING_TOLD);
    Plot { name: "maps".into(), figure: figure.into(), table }
}
