//! The two plots of thermometry.

use crate::figures::Plot;
use crate::plot::{Axis, Band, LineFigure, Panel, Rule, Series, Style};
use crate::simulate::thermometry::rows::{decisive, rising};
use crate::table::Table;
use crate::text::significant;
use crate::words::pictures;
use crate::words::simulate::thermometry as words;
use hadar_simulate::efficiency::Errors;
use hadar_study::{Reader, Thermometry, ThermometryRow};

fn true_temperature() -> Axis {
    Axis::linear("true temperature (°C)")
}

/// The words for maximum likelihood, the same in both plots; a scene without surroundings has no lighting.
fn likelihood_label(result: &Thermometry, lighting_unknown: bool) -> &'static str {
    match (lighting_unknown, result.environment_k.is_empty()) {
        (true, _) => "maximum likelihood, lighting unknown",
        (false, false) => "maximum likelihood, lighting known",
        (false, true) => "maximum likelihood",
    }
}

fn fixed_label(result: &Thermometry) -> String {
    format!("thermal imaging, emissivity {}", result.fixed.emissivity)
}

const MANUAL_LABEL: &str = "thermal imaging, emissivity by hand";
const FIXED: (Style, usize) = (Style::Line, 2);
const MANUAL: (Style, usize) = (Style::Dashed, 3);

fn lighting_unknown(result: &Thermometry) -> bool {
    result.rows.iter().any(|row| row.lighting_unknown.is_some())
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
    let table = Table::of_columns([
        ("temperature_k", &of(&|row| row.temperature_k)),
        ("error_maximum_likelihood_k", &own),
        ("error_maximum_likelihood_low_k", &low),
        ("error_maximum_likelihood_high_k", &high),
        ("error_fixed_emissivity_k", &fixed),
        ("error_manual_emissivity_k", &manual),
    ]);
    // Millikelvin where that keeps the numbers short.
    let largest = low.iter().chain(&high).fold(0.0_f64, |largest, x| largest.max(x.abs()));
    let (factor, unit) = if largest < 1.0 { (1e3, "mK") } else { (1.0, "K") };
    let scaled = |values: &[f64]| values.iter().map(|x| factor * x).collect::<Vec<f64>>();
    let label = likelihood_label(result, lighting_unknown(result));
    let colour = usize::from(lighting_unknown(result));
    let lower = Panel::new(Axis::linear(format!("mean error ({unit})")))
        .band(
            Band::new("95 % interval of the mean", celsius.clone(), scaled(&low), scaled(&high))
                .colour(colour),
        )
        .rule(Rule::horizontal(0.0, ""))
        .series(Series::points(label, celsius.clone(), scaled(&own)).colour(colour));
    let figure = LineFigure::new(
        format!("Bias: how far from the truth is {} read?", result.target),
        true_temperature(),
        Axis::linear("mean error (K)"),
    )
    .subtitle(words::errors(result))
    .rule(Rule::horizontal(0.0, ""))
    .series(Series::points(label, celsius.clone(), own).colour(colour))
    .series(Series::line(fixed_label(result), celsius.clone(), fixed).style(FIXED.0).colour(FIXED.1))
    .series(Series::line(MANUAL_LABEL, celsius, manual).style(MANUAL.0).colour(MANUAL.1))
    .lower(lower);
    Plot { name: "temperature_error".into(), figure: figure.into(), table }
}

/// Root mean squared error against the true temperature, with the bounds: the paper's Extended Data Fig. 9f.
#[must_use]
pub fn rmse(result: &Thermometry) -> Plot {
    let rows = rising(result);
    let celsius: Vec<f64> = rows.iter().map(|row| row.temperature_k - 273.15).collect();
    let of = |what: &dyn Fn(&ThermometryRow) -> Option<f64>| {
        rows.iter().map(|row| what(row).unwrap_or(f64::NAN)).collect::<Vec<f64>>()
    };
    let label = |unknown: bool| likelihood_label(result, unknown).to_owned();
    // Where the range of the lighting stops the fits, their error may be below the bound.
    let applies =
        rows.iter().all(|row| row.lighting_unknown.as_ref().is_none_or(|reader| reader.bound_applies));
    let bound = |unknown: bool| {
        let only = if unknown && !applies { " (of unbiased estimates: not of these)" } else { "" };
        label(unknown).replace("maximum likelihood", "bound") + only
    };
    let columns = [
        (bound(false), Style::Line, 0, of(&|row| row.lighting_known.bound_k)),
        (label(false), Style::Points, 0, of(&|row| Some(row.lighting_known.errors.rmse))),
        (bound(true), Style::Dashed, 1, of(&|row| row.lighting_unknown.as_ref()?.bound_k)),
        (label(true), Style::Points, 1, of(&|row| Some(row.lighting_unknown.as_ref()?.errors.rmse))),
        ("bound averaged over the lighting's range".to_owned(), Style::Dotted, 1, of(&range_bound)),
        (fixed_label(result), FIXED.0, FIXED.1, of(&|row| row.fixed.errors.map(|e| e.rmse))),
        (MANUAL_LABEL.to_owned(), MANUAL.0, MANUAL.1, of(&|row| row.manual.errors.map(|e| e.rmse))),
    ];
    let mut table = Table::new([
        "temperature_k",
        "bound_lighting_known_k",
        "rmse_lighting_known_k",
        "bound_lighting_unknown_k",
        "rmse_lighting_unknown_k",
        "bound_lighting_within_range_k",
        "rmse_fixed_emissivity_k",
        "rmse_manual_emissivity_k",
        "rmse_lighting_known_low_k",
        "rmse_lighting_known_high_k",
        "rmse_lighting_unknown_low_k",
        "rmse_lighting_unknown_high_k",
    ]);
    for (i, row) in rows.iter().enumerate() {
        let mut cells = vec![row.temperature_k];
        cells.extend(columns.iter().map(|(.., values)| values[i]));
        for reader in [Some(&row.lighting_known), row.lighting_unknown.as_ref()] {
            let interval = reader.map(|reader| reader.errors.rmse_interval);
            cells.extend([interval.map(|i| i.low), interval.map(|i| i.high)].map(|k| k.unwrap_or(f64::NAN)));
        }
        table.push_numbers(&cells);
    }
    let unbiased = of(&|row| row.lighting_unknown.as_ref()?.bound_k);
    let ends = unbiased.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), k| (low.min(*k), high.max(*k)));
    let left_out = match applies || ends.0 > ends.1 {
        true => String::new(),
        false => pictures::bound_left_out(&significant(ends.0, 2), &significant(ends.1, 2)),
    };
    let mut figure = LineFigure::new(
        format!("How precisely is {} read, and how precisely could it be?", result.target),
        true_temperature(),
        Axis::log("root mean squared error (K)"),
    )
    .subtitle(words::bounds(result, rows.iter().any(|row| range_bound(row).is_some())) + &left_out);
    for (label, style, colour, values) in columns {
        // A bound that is none for these estimates is in the table alone.
        let applies = applies || label != bound(true);
        if applies && values.iter().any(|value| value.is_finite()) {
            let series = Series::line(label, celsius.clone(), values).style(style).colour(colour);
            // What lies below is seen inside.
            figure = figure.series(open_if(series, style == Style::Points && colour == 1));
        }
    }
    Plot {
        name: "temperature_rmse".into(),
        figure: figure.lower(over_bound(result, &rows, &celsius)).into(),
        table,
    }
}

fn open_if(series: Series, open: bool) -> Series {
    if open { series.open() } else { series }
}

/// The bound averaged over the range of the lighting, where that stops the fits; elsewhere it hides under the others.
fn range_bound(row: &ThermometryRow) -> Option<f64> {
    let held = row.lighting_unknown.as_ref().is_some_and(|reader| !reader.bound_applies);
    row.bound_range_k.filter(|_| held)
}

/// Errors over the bounds that apply to them: 1 is as good as unbiased estimates can be.
fn over_bound(result: &Thermometry, rows: &[&ThermometryRow], celsius: &[f64]) -> Panel {
    let known: Vec<Option<&Reader>> = rows.iter().map(|row| Some(&row.lighting_known)).collect();
    let unknown: Vec<Option<&Reader>> = rows.iter().map(|row| row.lighting_unknown.as_ref()).collect();
    let mut panel = Panel::new(Axis::linear("error over bound")).rule(Rule::horizontal(1.0, ""));
    let likelihoods = [known, unknown];
    for (colour, readers) in likelihoods.into_iter().enumerate() {
        let label = likelihood_label(result, colour == 1);
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
                .series(open_if(Series::points(label, celsius.to_vec(), values).colour(colour), colour == 1));
        }
    }
    panel
}
