//! The two plots of thermometry.

use super::{decisive, rising};
use crate::report::figures::Plot;
use crate::report::plot::{Axis, Band, LineFigure, Panel, Rule, Series, Style};
use crate::report::table::Table;
use crate::report::text::significant;
use crate::simulate::efficiency::Errors;
use crate::study::{Reader, Thermometry, ThermometryRow};

fn true_temperature() -> Axis {
    Axis::linear("true temperature (°C)")
}

fn imager_error(errors: Option<Errors>, what: impl Fn(Errors) -> f64) -> f64 {
    errors.map_or(f64::NAN, what)
}

/// Mean error of the readings against the true temperature: the paper's Extended Data Fig. 9e.
#[must_use]
pub fn errors(result: &Thermometry) -> Plot {
    let rows = rising(result);
    let celsius: Vec<f64> = rows.iter().map(|row| row.temperature_k - 273.15).collect();
    let of = |what: &dyn Fn(&ThermometryRow) -> f64| rows.iter().map(|row| what(row)).collect::<Vec<f64>>();
    let own = of(&|row| decisive(row).errors.bias);
    let (low, high) = (
        of(&|row| decisive(row).errors.bias_interval.low),
        of(&|row| decisive(row).errors.bias_interval.high),
    );
    let fixed = of(&|row| imager_error(row.fixed.errors, |errors| errors.bias));
    let manual = of(&|row| imager_error(row.manual.errors, |errors| errors.bias));
    let mut table = Table::new([
        "temperature_k",
        "error_maximum_likelihood_k",
        "error_maximum_likelihood_low_k",
        "error_maximum_likelihood_high_k",
        "error_fixed_emissivity_k",
        "error_manual_emissivity_k",
    ]);
    for (i, row) in rows.iter().enumerate() {
        table.push_numbers(&[row.temperature_k, own[i], low[i], high[i], fixed[i], manual[i]]);
    }
    // Millikelvin where that keeps the numbers short.
    let largest = low.iter().chain(&high).fold(0.0_f64, |largest, x| largest.max(x.abs()));
    let (factor, unit) = if largest < 1.0 { (1e3, "mK") } else { (1.0, "K") };
    let scaled = |values: &[f64]| values.iter().map(|x| factor * x).collect::<Vec<f64>>();
    let lower = Panel::new(Axis::linear(format!("mean error ({unit})")))
        .band(Band::new("95 % interval of the mean", celsius.clone(), scaled(&low), scaled(&high)).colour(1))
        .rule(Rule::horizontal(0.0, ""))
        .series(Series::line("maximum likelihood", celsius.clone(), scaled(&own)).colour(1));
    let lighting =
        if rows.iter().any(|row| row.lighting_unknown.is_some()) { ", lighting unknown" } else { "" };
    let figure = LineFigure::new(
        format!("How far from the truth {} is read", result.target),
        true_temperature(),
        Axis::linear("mean error (K)"),
    )
    .subtitle(format!(
        "{}, {} spectra at each temperature, emissivity known to maximum likelihood{lighting}. Below: maximum likelihood \
         alone. Manual emissivity {} is calibrated at {:.1} °C.",
        result.camera,
        result.trials,
        significant(result.manual.emissivity, 3),
        result.calibrated_k - 273.15
    ))
    .rule(Rule::horizontal(0.0, ""))
    .series(Series::line("maximum likelihood", celsius.clone(), own).colour(1))
    .series(Series::line(
        format!("thermal imaging, emissivity {}", result.fixed.emissivity),
        celsius.clone(),
        fixed,
    ).colour(2))
    .series(
        Series::line("thermal imaging, emissivity entered by hand", celsius, manual)
            .style(Style::Dashed)
            .colour(3),
    )
    .lower(lower);
    Plot { name: "temperature_error", figure: figure.into(), table }
}

/// Root mean squared error against the true temperature, with the bounds: the paper's Extended Data Fig. 9f.
#[must_use]
pub fn rmse(result: &Thermometry) -> Plot {
    let rows = rising(result);
    let celsius: Vec<f64> = rows.iter().map(|row| row.temperature_k - 273.15).collect();
    let of = |what: &dyn Fn(&ThermometryRow) -> Option<f64>| {
        rows.iter().map(|row| what(row).map_or(f64::NAN, |k| 1e3 * k)).collect::<Vec<f64>>()
    };
    let columns = [
        ("bound, lighting known", Style::Line, 0, of(&|row| row.lighting_known.bound_k)),
        ("likelihood, lighting known", Style::Points, 0, of(&|row| Some(row.lighting_known.errors.rmse))),
        ("bound, lighting unknown", Style::Line, 1, of(&|row| row.lighting_unknown.as_ref()?.bound_k)),
        (
            "likelihood, lighting unknown",
            Style::Points,
            1,
            of(&|row| row.lighting_unknown.as_ref().map(|reader| reader.errors.rmse)),
        ),
        ("bound, lighting within its range", Style::Dotted, 1, of(&|row| row.bound_range_k)),
        ("imaging, fixed emissivity", Style::Dashed, 2, of(&|row| row.fixed.errors.map(|e| e.rmse))),
        ("imaging, manual emissivity", Style::Dashed, 3, of(&|row| row.manual.errors.map(|e| e.rmse))),
    ];
    let mut table = Table::new([
        "temperature_k",
        "bound_lighting_known_mk",
        "rmse_lighting_known_mk",
        "bound_lighting_unknown_mk",
        "rmse_lighting_unknown_mk",
        "bound_lighting_within_range_mk",
        "rmse_fixed_emissivity_mk",
        "rmse_manual_emissivity_mk",
        "rmse_lighting_known_low_mk",
        "rmse_lighting_known_high_mk",
        "rmse_lighting_unknown_low_mk",
        "rmse_lighting_unknown_high_mk",
    ]);
    for (i, row) in rows.iter().enumerate() {
        let mut cells = vec![row.temperature_k];
        cells.extend(columns.iter().map(|(.., values)| values[i]));
        for reader in [Some(&row.lighting_known), row.lighting_unknown.as_ref()] {
            let interval = reader.map(|reader| reader.errors.rmse_interval);
            cells.extend(
                [interval.map(|i| i.low), interval.map(|i| i.high)].map(|k| k.map_or(f64::NAN, |k| 1e3 * k)),
            );
        }
        table.push_numbers(&cells);
    }
    let mut figure = LineFigure::new(
        format!("How precisely {} is read, and could be", result.target),
        true_temperature(),
        Axis::log("root mean squared error (mK)"),
    )
    .subtitle(format!(
        "{}, {} spectra at each temperature. Bounds are Cramér-Rao's, for unbiased estimates; the dotted one is van Trees' for \
         any estimate, averaged over the lighting.{}",
        result.camera,
        result.trials,
        if rows.iter().all(|row| decisive(row).bound_applies) {
            ""
        } else {
            " It is the one for fits held by the range of the lighting, as here; Cramér-Rao's is not theirs."
        }
    ));
    for (label, style, colour, values) in columns {
        if values.iter().any(|value| value.is_finite()) {
            figure = figure.series(Series::line(label, celsius.clone(), values).style(style).colour(colour));
        }
    }
    Plot { name: "temperature_rmse", figure: figure.lower(over_bound(&rows, &celsius)).into(), table }
}

/// Errors over the bounds that apply to them: 1 is as good as unbiased estimates can be.
fn over_bound(rows: &[&ThermometryRow], celsius: &[f64]) -> Panel {
    let known: Vec<Option<&Reader>> = rows.iter().map(|row| Some(&row.lighting_known)).collect();
    let unknown: Vec<Option<&Reader>> = rows.iter().map(|row| row.lighting_unknown.as_ref()).collect();
    let mut panel = Panel::new(Axis::linear("error over bound")).rule(Rule::horizontal(1.0, ""));
    let likelihoods = [("likelihood, lighting known", known), ("likelihood, lighting unknown", unknown)];
    for (colour, (label, readers)) in likelihoods.into_iter().enumerate() {
        let over = |what: &dyn Fn(&Errors) -> f64| -> Vec<f64> {
            let ratio = |reader: &Reader| Some(what(&reader.errors) / reader.bound_k?);
            let applying = readers.iter().map(|reader| reader.filter(|reader| reader.bound_applies));
            applying.map(|reader| reader.and_then(ratio).unwrap_or(f64::NAN)).collect()
        };
        let values = over(&|errors| errors.rmse);
        if values.iter().any(|value| value.is_finite()) {
            let low = over(&|errors| errors.rmse_interval.low);
            let high = over(&|errors| errors.rmse_interval.high);
            let meaning = if colour == 0 { "95 % interval of error" } else { "" };
            panel = panel
                .band(Band::new(meaning, celsius.to_vec(), low, high).colour(colour))
                .series(Series::points(label, celsius.to_vec(), values).colour(colour));
        }
    }
    panel
}
