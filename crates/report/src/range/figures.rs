//! Pictures of the view and of its bounds, lines with their witnesses, errors of derivatives.

use crate::figures::Plot;
use crate::plot::{
    Axis, LineFigure, Painted, Panel, Picture, Pictures, Rgb, Series, Style, categorical, number as written,
};
use crate::range::lines_table;
use crate::table::{Table, number};
use crate::words::pictures;
use crate::words::range::captions;
use hadar::error::Result;
use hadar::ranging::derivative::{Derivative, Differentiator};
use hadar_study::range::{Line, PictureKind, Ranging, Signal, quantile};
use std::f64::consts::PI;

/// A picture's table holds so many of its columns at most: the maps themselves are in NPY files.
const COLUMNS: usize = 80;
/// The share of the values at either end that a colour scale does not cover.
const TAIL: f64 = 0.01;
/// Relative spread below which values are one and the same.
const FLAT: f64 = 1e-9;
/// Errors of so many times the largest depth are not drawn.
const BEYOND: f64 = 10.0;

/// What the left camera sees: thermal image, scattered signal and the truth behind them.
#[must_use]
pub fn views(result: &Ranging) -> Option<Plot> {
    let columns = result.shape.columns();
    let lines: Vec<usize> = result.lines.iter().map(|line| line.row).collect();
    let scattered = result.maps.pictures.iter().find(|(kind, _)| *kind == PictureKind::Scattered);
    let span = scattered.map(|(_, values)| ends(values));
    let pictures: Vec<(String, Picture)> = result
        .maps
        .pictures
        .iter()
        .map(|(kind, values)| {
            let (title, axis, key) = match kind {
                PictureKind::ThermalImage => {
                    (pictures::THERMAL_IMAGE, Axis::linear("photons per pixel"), "thermal_photons")
                }
                PictureKind::Scattered => (
                    "Scattered signal (no camera measures it alone)",
                    Axis::linear("photons per pixel"),
                    "scattered_photons",
                ),
                PictureKind::Temperature => {
                    ("Temperature T", Axis::linear("temperature (°C)"), "temperature_degc")
                }
                PictureKind::Lighting => (
                    "Thermal lighting X: share that is not sky",
                    Axis::linear("1 − V of the sky"),
                    "lighting_not_sky",
                ),
                PictureKind::Depth => ("Depth", Axis::log("depth (m)"), "depth_m"),
            };
            let axis = match kind {
                PictureKind::ThermalImage => around(axis, values, span),
                _ => clipped(axis, values),
            };
            (key.to_owned(), Picture::new(title, axis, columns, values.clone()).lines(&lines))
        })
        .collect();
    // One colour shows nothing: what is the same everywhere is said.
    let mut said = String::new();
    let pictures = pictures.into_iter().filter(|(_, picture)| {
        let flat = constant(&picture.values);
        if let Some(value) = flat {
            said += &captions::everywhere(&picture.title, value, &picture.colour.title);
        }
        flat.is_none() && picture.values.iter().any(|value| value.is_finite())
    });
    let mut keys = Vec::new();
    let pictures: Vec<_> = pictures.map(|(key, picture)| (key, few_values(picture, &mut keys))).collect();
    let subtitle = captions::views([result.shape.rows(), columns], &said);
    let figure = |pictures| {
        Pictures::new("Which texture is there to range by? The left view", pictures)
            .subtitle(subtitle.clone())
            .no_value("sky")
            .keys(keys.clone())
    };
    plot("views", figure, pictures, ([0, 0], 1))
}

/// The value that all of them have but for rounding, if there is one.
fn constant(values: &[f64]) -> Option<f64> {
    let finite = || values.iter().copied().filter(|value| value.is_finite());
    let (low, high) = (finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max));
    (high - low <= FLAT * high.abs()).then_some(high).filter(|value| value.is_finite())
}

/// Least depth error of every window by each signal (disparity where depth is not known).
#[must_use]
pub fn bound_maps(result: &Ranging) -> Option<Plot> {
    let maps = &result.maps;
    let with_depth = maps.depth_m.iter().any(|depth| depth.is_finite());
    let scale = result.geometry.depth_error_per_px_at_10_m / 100.0;
    let per_signal: Vec<(Signal, Vec<f64>)> = maps
        .disparity_error_px
        .iter()
        .map(|(signal, errors)| {
            let value = |(error, depth): (&f64, &f64)| {
                if with_depth { error * depth * depth * scale } else { *error }
            };
            (*signal, errors.iter().zip(&maps.depth_m).map(value).collect())
        })
        .collect();
    let no_bound = |values: &[f64]| values.iter().all(|value| !value.is_finite());
    let without: Vec<&str> =
        per_signal.iter().filter(|(_, values)| no_bound(values)).map(|(signal, _)| signal.name()).collect();
    // One scale for all, so that they can be compared; an error larger than any depth is no depth.
    let all: Vec<f64> =
        per_signal.iter().flat_map(|(_, values)| values).copied().filter(|v| v.is_finite()).collect();
    let deepest = maps.depth_m.iter().copied().filter(|z| z.is_finite()).fold(0.0, f64::max);
    let most = if deepest > 0.0 { deepest } else { f64::INFINITY };
    let high = quantile(&all, 1.0 - TAIL).min(most);
    let low = quantile(&all, TAIL).min(0.1 * high);
    let unit = if with_depth { "depth error (m)" } else { "disparity error (pixels)" };
    let suffix = if with_depth { "depth_error_m" } else { "disparity_error_px" };
    let demand = result.scenario.requirement.error;
    let pictures: Vec<_> = per_signal
        .iter()
        .filter(|(_, values)| !no_bound(values))
        .map(|(signal, values)| {
            let axis = Axis::log(unit).range(low, high);
            let key = format!("{suffix}_{}", signal.key());
            let title = format!("Bound, {}", signal.name());
            let picture = Picture::new(title, axis, maps.columns.len().div_ceil(maps.step), values.clone());
            let over = |(error, depth): (&f64, &f64)| (error / demand.at(*depth)).ln();
            let beyond: Vec<f64> = values.iter().zip(&maps.depth_m).map(over).collect();
            (key, if with_depth { picture.boundary(beyond) } else { picture })
        })
        .collect();
    let subtitle = captions::bounds(result.scenario.stereo.window, with_depth, &without);
    let meaning = captions::boundary(demand);
    let figure = |pictures| {
        Pictures::new("How precisely can depth be measured, and where is the demand met?", pictures)
            .subtitle(subtitle.clone())
            .boundary_meaning(meaning.clone())
            .no_value("sky, not seen by both cameras, or no texture at all")
    };
    plot("bounds_map", figure, pictures, ([maps.rows.start, maps.columns.start], maps.step))
}

/// Depths that block matching finds in one noisy pair.
#[must_use]
pub fn matched_maps(result: &Ranging) -> Option<Plot> {
    let columns = result.shape.columns();
    let truth = result.maps.pictures.iter().find(|(kind, _)| *kind == PictureKind::Depth);
    let range = truth.map(|(_, values)| {
        let finite: Vec<f64> = values.iter().copied().filter(|z| z.is_finite()).collect();
        (quantile(&finite, TAIL), quantile(&finite, 1.0 - TAIL))
    });
    let axis = || {
        let axis = Axis::log("depth (m)");
        range.map_or(axis.clone(), |(low, high)| axis.range(low, high))
    };
    let mut pictures: Vec<(String, Picture)> = result
        .matched
        .iter()
        .map(|matched| {
            let key = format!("depth_m_{}", matched.signal.key());
            let title = format!("Matched, {}", matched.signal.name());
            (key, Picture::new(title, axis(), columns, matched.depth_m.clone()))
        })
        .collect();
    if pictures.is_empty() {
        return None;
    }
    if let Some((_, values)) = truth {
        pictures
            .push(("depth_m_truth".to_owned(), Picture::new("True depth", axis(), columns, values.clone())));
    }
    let figure = |pictures| {
        Pictures::new("Does block matching find the true depth?", pictures)
            .subtitle(captions::MATCHED)
            .no_value("sky, or no match")
    };
    plot("matched", figure, pictures, ([0, 0], 1))
}

/// Bounds along each line, and how matching does beside them.
#[must_use]
pub fn lines(result: &Ranging) -> Vec<Plot> {
    let mut rows: Vec<usize> = result.lines.iter().map(|line| line.row).collect();
    rows.sort_unstable();
    rows.dedup();
    rows.into_iter()
        .map(|row| line(row, result.lines.iter().filter(|line| line.row == row).collect(), result))
        .collect()
}

/// Colour of a signal, and style of its bound.
const fn look(signal: Signal) -> (usize, Style) {
    match signal {
        Signal::ThermalImage => (0, Style::Line),
        // Where nothing but the whole image has texture, these two are one line.
        Signal::HeatCube => (1, Style::Dashed),
        Signal::ScatteredAsMeasured => (2, Style::Line),
        Signal::Reconstructed => (3, Style::Line),
        Signal::ReconstructedBlind => (4, Style::Line),
    }
}

fn line(row: usize, lines: Vec<&Line>, result: &Ranging) -> Plot {
    let depth = lines.iter().any(|line| line.depth_m.iter().any(|z| z.is_finite()));
    let title =
        format!("{} error along row {row} of the left view", if depth { "Depth" } else { "Disparity" });
    let axis = Axis::log(if depth { "depth error (m)" } else { "disparity error (pixels)" });
    let mut figure = LineFigure::new(title, Axis::linear("column (pixels)"), axis);
    let mut bias = Panel::new(Axis::linear(if depth { "bias (m)" } else { "bias (pixels)" }));
    let x = |line: &Line| line.columns.iter().map(|column| *column as f64).collect::<Vec<_>>();
    for line in &lines {
        let Some(method) = line.method else { continue };
        let label = format!("{method}, {}", line.signal.name());
        let (colour, _) = look(line.signal);
        // The second method of a signal has open symbols.
        let points = |label: String, values: &[f64]| {
            let points = Series::points(label, x(line), values.to_vec()).colour(colour).pale();
            if method.starts_with("block") { points } else { points.open() }
        };
        figure = figure.series(points(label, &line.rmse_m));
        bias = bias.series(points(String::new(), &line.bias_m));
    }
    let witnessed = !bias.series.is_empty();
    // Errors of far more than any depth say only that there is none.
    let deepest =
        lines.iter().flat_map(|line| &line.depth_m).copied().filter(|z| z.is_finite()).fold(0.0, f64::max);
    let most = if depth { BEYOND * deepest } else { f64::INFINITY };
    // Bounds lie on top of the points that reach them.
    let (mut drawn, mut hopeless): (Vec<Signal>, Vec<&str>) = (Vec::new(), Vec::new());
    for line in &lines {
        if drawn.contains(&line.signal) {
            continue;
        }
        drawn.push(line.signal);
        // Matches are of views without diffraction.
        let bound = if witnessed { &line.bound_without_diffraction_m } else { &line.bound_m };
        if bound.iter().all(|bound| bound.is_nan() || *bound > most) {
            hopeless.push(line.signal.name());
            continue;
        }
        let sharp = if witnessed { " without diffraction" } else { "" };
        let label = format!("bound{sharp}, {}", line.signal.name());
        let (colour, style) = look(line.signal);
        let shown = bound.iter().map(|bound| if *bound > most { f64::NAN } else { *bound }).collect();
        figure = figure.series(Series::line(label, x(line), shown).colour(colour).style(style));
    }
    let longest = lines.iter().max_by_key(|line| line.columns.len());
    if let Some(line) = longest.filter(|_| depth) {
        let demand = result.scenario.requirement.error;
        let allowed = line.depth_m.iter().map(|depth_m| demand.at(*depth_m)).collect();
        let label = format!("demanded: {}", captions::demanded(demand));
        figure = figure.series(Series::line(label, x(line), allowed).style(Style::Dotted).colour(6));
    }
    if witnessed {
        figure = figure.lower(bias);
    }
    let figure = figure.subtitle(captions::line(witnessed, BEYOND, &hopeless));
    Plot { name: format!("line_{row}").into(), figure: figure.into(), table: lines_table(lines) }
}

/// Error of each derivative on sinusoids: as measured on one, and in closed form.
///
/// # Errors
/// A scheme that refuses its row, which none does.
pub fn derivative_errors() -> Result<Plot> {
    const FREQUENCIES: usize = 60;
    let omegas: Vec<f64> = (1..FREQUENCIES).map(|i| PI * i as f64 / FREQUENCIES as f64).collect();
    let pixels_per_cycle: Vec<f64> = omegas.iter().map(|omega| omega / (2.0 * PI)).collect();
    let mut figure = LineFigure::new(
        "How much of a texture's slope each derivative sees",
        Axis::linear("spatial frequency (cycles per pixel)").range(0.0, 0.5),
        Axis::linear("slope found over true slope").range(0.0, 1.1),
    )
    .subtitle(captions::DERIVATIVES);
    let mut table = Table::new(["cycles_per_pixel", "derivative", "slope_found_over_true", "closed_form"]);
    for (colour, scheme) in Derivative::ALL.into_iter().enumerate() {
        let closed = omegas.iter().map(|omega| scheme.response(*omega)).collect::<Result<Vec<f64>>>()?;
        let measured =
            omegas.iter().map(|omega| response_measured(scheme, *omega)).collect::<Result<Vec<f64>>>()?;
        for ((frequency, closed), measured) in pixels_per_cycle.iter().zip(&closed).zip(&measured) {
            table.push(vec![
                number(*frequency),
                scheme.name().to_owned(),
                number(*measured),
                number(*closed),
            ]);
        }
        let points = Series::points("", pixels_per_cycle.clone(), measured).colour(colour);
        let style = if scheme == Derivative::Fourier { Style::Dashed } else { Style::Line };
        let line = Series::line(scheme.name(), pixels_per_cycle.clone(), closed).colour(colour).style(style);
        figure = figure.series(line).series(points);
    }
    Ok(Plot { name: "derivatives".into(), figure: figure.into(), table })
}

/// Slope that a scheme finds on a sinusoid, over the true one, by least squares over the middle of a row.
pub(crate) fn response_measured(scheme: Derivative, omega: f64) -> Result<f64> {
    const COLUMNS: usize = 960;
    let row: Vec<f64> = (0..COLUMNS).map(|x| (omega * x as f64).sin()).collect();
    let margin = scheme.margin();
    let mut slopes = vec![0.0; COLUMNS - 2 * margin];
    Differentiator::new(scheme, COLUMNS)?.apply(&row, 1, &mut slopes)?;
    let middle = COLUMNS / 4..3 * COLUMNS / 4;
    let (mut top, mut bottom) = (0.0, 0.0);
    for x in middle {
        let truth = omega * (omega * x as f64).cos();
        top += slopes.get(x - margin).copied().unwrap_or(f64::NAN) * truth;
        bottom += truth * truth;
    }
    Ok(top / bottom)
}

/// What all but the lowest and highest of the values lie between.
fn ends(values: &[f64]) -> (f64, f64) {
    let finite: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
    (quantile(&finite, TAIL), quantile(&finite, 1.0 - TAIL))
}

/// An axis about the median, as long as between other ends, so that equal textures are equally seen.
fn around(axis: Axis, values: &[f64], others: Option<(f64, f64)>) -> Axis {
    let finite: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
    let (middle, half) = (quantile(&finite, 0.5), others.map_or(0.0, |(low, high)| 0.5 * (high - low)));
    if half > FLAT * middle.abs() { axis.range(middle - half, middle + half) } else { clipped(axis, values) }
}

/// Most values that are drawn as so many colours with their names.
const FEW: usize = 5;

/// A picture of a few values is one of areas, each with its value in the legend; others stay as they are.
fn few_values(picture: Picture, keys: &mut Vec<(Rgb, String)>) -> Picture {
    let same = |a: f64, b: f64| (a - b).abs() <= FLAT * a.abs();
    let mut seen: Vec<f64> = Vec::new();
    for value in picture.values.iter().copied().filter(|value| value.is_finite()) {
        if !seen.iter().any(|one| same(*one, value)) {
            seen.push(value);
        }
        if seen.len() > FEW {
            return picture;
        }
    }
    seen.sort_by(f64::total_cmp);
    let area = |value: &f64| seen.iter().position(|one| same(*one, *value));
    let areas: Vec<Option<usize>> = picture.values.iter().map(area).collect();
    let pixels = areas.iter().map(|area| area.map_or((0xD6, 0xD6, 0xD6), categorical)).collect();
    let names: Vec<String> =
        seen.iter().map(|value| format!("{}: {}", picture.colour.title, written(*value))).collect();
    keys.extend(names.into_iter().enumerate().map(|(i, name)| (categorical(i), name)));
    let painted = Some(Painted { pixels, ramp: None });
    Picture { painted, ..picture }
}

fn clipped(axis: Axis, values: &[f64]) -> Axis {
    let (low, high) = ends(values);
    if high - low > FLAT * high.abs() { axis.range(low, high) } else { axis }
}

/// Pictures with a table of some of their pixels; `first` is the pixel at their upper left corner, and every so many rows and
/// columns of the view are in them.
fn plot(
    name: &'static str,
    figure: impl Fn(Vec<Picture>) -> Pictures,
    pictures: Vec<(String, Picture)>,
    (first, thinned): ([usize; 2], usize),
) -> Option<Plot> {
    let columns = pictures.first()?.1.columns;
    let rows = pictures.first()?.1.values.len().checked_div(columns)?;
    let step = columns.div_ceil(COLUMNS).max(1);
    let mut table = Table::new(
        ["row", "column"].map(str::to_owned).into_iter().chain(pictures.iter().map(|(key, _)| key.clone())),
    );
    for row in (0..rows).step_by(step) {
        for column in (0..columns).step_by(step) {
            let place = [row, column].into_iter().zip(first);
            let mut cells: Vec<String> =
                place.map(|(at, first)| (first + at * thinned).to_string()).collect();
            let at = row * columns + column;
            cells.extend(
                pictures.iter().map(|(_, picture)| {
                    picture.values.get(at).map_or_else(String::new, |value| short(*value))
                }),
            );
            table.push(cells);
        }
    }
    let mut figure = figure(pictures.into_iter().map(|(_, picture)| picture).collect());
    figure.subtitle += &captions::some_of(thinned, step);
    Some(Plot { name: name.into(), figure: figure.into(), table })
}

/// Seven digits: what a picture needs, and a table of pixels can bear.
fn short(value: f64) -> String {
    if value.is_finite() { number(format!("{value:.6e}").parse().unwrap_or(value)) } else { String::new() }
}

/// Pictures side by side with a table of some of their pixels; each with the head of its column.
#[must_use]
pub fn picture_plot(
    name: &'static str,
    title: &str,
    subtitle: String,
    pictures: Vec<(String, Picture)>,
) -> Option<Plot> {
    plot(name, |pictures| Pictures::new(title, pictures).subtitle(subtitle.clone()), pictures, ([0, 0], 1))
}
