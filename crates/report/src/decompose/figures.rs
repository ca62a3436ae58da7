//! Pictures of a decomposed cube: temperature, its deviation, material, how many are left; what its pixels have in common that the model has not.

use crate::figures::Plot;
use crate::plot::{Axis, Band, LineFigure, Pictures, Series, Style};
use crate::shown::Shown;
use crate::table::{Table, number, optional};
use crate::words::decompose::how;
use crate::words::pictures::{NOTHING_TOLD, thinned};
use hadar_study::decompose::{Block, CauseRow, Decomposed, ModelJudged};

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

/// What the pixels have in common in each band beside what a right model would leave; nothing where it was not asked.
#[must_use]
pub(super) fn residual(model: &ModelJudged) -> Option<Plot> {
    if model.bands.len() < 2 {
        return None;
    }
    let of = |value: &dyn Fn(&hadar_study::decompose::BandResidual) -> f64| -> Vec<f64> {
        model.bands.iter().map(value).collect()
    };
    let nu = of(&|row| row.wavenumber_cm1);
    let residual = of(&|row| row.residual);
    let sigma = of(&|row| if row.deviations == 0.0 { 0.0 } else { row.residual / row.deviations });
    let table = Table::of_columns([
        ("wavenumber_cm1", &nu),
        ("residual_per_noise", &residual),
        ("sigma", &sigma),
        ("deviations", &of(&|row| row.deviations)),
    ]);
    let twice = |sign: f64| sigma.iter().map(|sigma| sign * 2.0 * sigma).collect();
    let figure = LineFigure::new(
        "What all pixels have in common and the model has not",
        Axis::linear("wavenumber (cm⁻¹)"),
        Axis::linear("mean residual (deviations of a pixel's noise)"),
    )
    .band(Band::new("two deviations of a right model", nu.clone(), twice(-1.0), twice(1.0)))
    .series(Series::line("residual", nu, residual).style(Style::Marked).colour(1));
    Some(Plot { name: "model_residual".into(), figure: figure.into(), table })
}

/// What may be otherwise than told, a row each.
#[must_use]
pub(super) fn causes(model: &ModelJudged) -> Table {
    let place = |at: Option<usize>| at.map_or_else(String::new, |at| at.to_string());
    Table::of(
        &model.causes,
        &[
            ("cause", &|row: &CauseRow| row.cause.to_owned()),
            ("environment", &|row| place(row.light)),
            ("band", &|row| place(row.band)),
            ("estimate", &|row| number(row.estimate)),
            ("sigma", &|row| number(row.sigma)),
            ("unit", &|row| row.unit.to_owned()),
            ("gain_chi_square", &|row| number(row.gain_chi_square)),
            ("temperature_moved", &|row| optional(row.temperature_moved)),
            ("may_be", &|row| row.may_be.to_string()),
        ],
    )
}
