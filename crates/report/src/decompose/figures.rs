//! Pictures of a decomposed cube: temperature, its deviation, material, how many are left, flags, p-values; what its pixels have in common that the model has not.

use crate::figures::Plot;
use crate::plot::{Axis, Band, LineFigure, Painted, Picture, Pictures, Rgb, Series, Style};
use crate::shown::Shown;
use crate::table::{Table, number, optional};
use crate::words::decompose::{FLAGGED, P_VALUES, flag_said, how};
use crate::words::pictures::{NOTHING_TOLD, thinned};
use hadar_estimate::decompose::flag;
use hadar_study::decompose::{Block, CauseRow, Decomposed, ModelJudged};

/// Flags in the order in which one hides the next, with the colours of Okabe and Ito, and that of none.
const FLAGS: [(u8, Rgb); 8] = [
    (flag::SKIPPED, (0, 0, 0)),
    (flag::NO_FIT, (213, 94, 0)),
    (flag::NO_INFORMATION, (204, 121, 167)),
    (flag::TEMPERATURE_UNKNOWN, (230, 159, 0)),
    (flag::TEMPERATURE_AT_LIMIT, (240, 228, 66)),
    (flag::UNDECIDED, (0, 114, 178)),
    (flag::LIGHTING_UNKNOWN, (86, 180, 233)),
    (flag::LIGHTING_AT_LIMIT, (0, 158, 115)),
];
const NO_FLAG: Rgb = (236, 237, 239);
/// p-values that are drawn as this one where they are less.
const LEAST_P: f64 = 1e-6;

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
    let figure = Pictures::new("What do the photons say of each pixel?", pictures)
        .subtitle(format!("{}.{}", how(result), thinned(shown)))
        .no_value(NOTHING_TOLD);
    Plot { name: "maps".into(), figure: figure.into(), table }
}

/// The flags, of the pixels that are shown: a column of the table for each that occurs, in the picture the first of a pixel.
#[must_use]
pub(super) fn flags(result: &Decomposed, pixels: &Block, shown: Shown) -> Plot {
    let all = &pixels.maps.flags;
    let occurs: Vec<(u8, Rgb)> =
        FLAGS.into_iter().filter(|(bit, _)| result.flags.iter().any(|row| row.bit == *bit)).collect();
    let colour = |flags: &u8| occurs.iter().find(|(bit, _)| flags & bit != 0).map_or(NO_FLAG, |one| one.1);
    let name = |bit: u8| flag::NAMES.iter().find(|one| one.0 == bit).map_or("", |one| one.1);
    let heads = occurs.iter().map(|(bit, _)| name(*bit).replace('-', "_"));
    let mut table = Table::new(["row", "column", "flags"].map(str::to_owned).into_iter().chain(heads));
    for ([row, column, _], flags) in shown.places().zip(all) {
        let each = occurs.iter().map(|(bit, _)| u8::from(flags & bit != 0).to_string());
        table.push(
            [row, column, usize::from(*flags)].map(|x| x.to_string()).into_iter().chain(each).collect(),
        );
    }
    let painted = Painted { pixels: all.iter().map(colour).collect(), ramp: None };
    let mut keys: Vec<(Rgb, String)> =
        occurs.iter().map(|(bit, rgb)| (*rgb, flag_said(*bit, result).to_owned())).collect();
    keys.push((NO_FLAG, "nothing is said".to_owned()));
    let picture = Picture::painted("Flags", Axis::linear(""), shown.wide(), painted);
    let figure = Pictures::new("What was decided of each pixel?", vec![picture])
        .subtitle(format!("{FLAGGED}{}", thinned(shown)))
        .keys(keys);
    Plot { name: "flags".into(), figure: figure.into(), table }
}

/// The p-values, of the pixels that are shown.
#[must_use]
pub(super) fn p_values(result: &Decomposed, pixels: &Block, shown: Shown) -> Plot {
    let values: Vec<f64> = pixels.maps.p_value.iter().map(|p| f64::from(*p)).collect();
    let drawn = values.iter().map(|p| if p.is_nan() { *p } else { p.max(LEAST_P) }).collect();
    let (table, _) = shown.layers(vec![("p_value", "p-value", Axis::linear("p-value"), values)]);
    let axis = Axis::log("p-value").range(LEAST_P, 1.0);
    let picture = Picture::new("p-value of the best material", axis, shown.wide(), drawn);
    let figure = Pictures::new("How well does the model fit each pixel?", vec![picture])
        .subtitle(format!("{}. {P_VALUES}{}", how(result), thinned(shown)))
        .no_value(NOTHING_TOLD);
    Plot { name: "p_value".into(), figure: figure.into(), table }
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
        "Residual that all pixels have in common",
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
