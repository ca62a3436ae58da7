//! Pictures of the view and of its bounds, lines with their witnesses, errors of derivatives.

use crate::figures::Plot;
use crate::plot::{Axis, LineFigure, Panel, Picture, Pictures, Series, Style};
use crate::range::lines_table;
use crate::table::{Table, number};
use hadar::error::Result;
use hadar::ranging::derivative::{Derivative, Differentiator};
use hadar_study::study::range::{Line, PictureKind, Ranging, Signal, quantile};
use std::f64::consts::PI;

/// A picture's table holds so many of its columns at most: the maps themselves are in NPY files.
const COLUMNS: usize = 80;
/// The share of the values at either end that a colour scale does not cover.
const TAIL: f64 = 0.01;

/// What the left camera sees: thermal image, scattered signal and the truth behind them.
#[must_use]
pub fn views(result: &Ranging) -> Option<Plot> {
    let columns = result.shape.columns();
    let lines: Vec<usize> = result.lines.iter().map(|line| line.row).collect();
    let pictures: Vec<(String, Picture)> = result
        .maps
        .pictures
        .iter()
        .map(|(kind, values)| {
            let (title, axis, key) = match kind {
                PictureKind::ThermalImage => {
                    ("Thermal image, all bands", Axis::linear("photons per pixel"), "thermal_photons")
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
            let axis = clipped(axis, values);
            (key.to_owned(), Picture::new(title, axis, columns, values.clone()).lines(&lines))
        })
        .collect();
    let subtitle = format!(
        "Left camera, {} × {columns} pixels. Colours cover all but the lowest and highest percent of the values.",
        result.shape.rows()
    );
    plot("views", "What the left camera sees", subtitle, "sky", pictures, [0, 0])
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
    // One scale for all, so that they can be compared.
    let all: Vec<f64> =
        per_signal.iter().flat_map(|(_, values)| values).copied().filter(|v| v.is_finite()).collect();
    let (low, high) = (quantile(&all, TAIL), quantile(&all, 1.0 - TAIL));
    let unit = if with_depth { "depth error (m)" } else { "disparity error (pixels)" };
    let suffix = if with_depth { "depth_error_m" } else { "disparity_error_px" };
    let pictures = per_signal
        .into_iter()
        .map(|(signal, values)| {
            let axis = Axis::log(unit).range(low, high);
            let key = format!("{suffix}_{}", signal.key());
            (key, Picture::new(format!("Bound, {}", signal.name()), axis, maps.columns.len(), values))
        })
        .collect();
    let window = result.scenario.stereo.window;
    let subtitle = format!(
        "Least error of windows of {} × {} pixels, at their centres in the left view. One colour scale for all.",
        window.rows(),
        window.columns()
    );
    let first = [maps.rows.start, maps.columns.start];
    plot(
        "bounds_map",
        "How well depth can be measured",
        subtitle,
        "sky, not seen by both cameras, or no texture at all",
        pictures,
        first,
    )
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
    let subtitle = "Block matching of one noisy pair.".to_owned();
    plot("matched", "Depth by matching", subtitle, "sky, or no match", pictures, [0, 0])
}

/// Bounds along each line, and how matching does beside them.
#[must_use]
pub fn lines(result: &Ranging) -> Vec<Plot> {
    let mut rows: Vec<usize> = result.lines.iter().map(|line| line.row).collect();
    rows.sort_unstable();
    rows.dedup();
    rows.into_iter()
        .map(|row| line(row, result.lines.iter().filter(|line| line.row == row).collect()))
        .collect()
}

fn line(row: usize, lines: Vec<&Line>) -> Plot {
    let depth = lines.iter().any(|line| line.depth_m.iter().any(|z| z.is_finite()));
    let axis = Axis::log(if depth { "depth error (m)" } else { "disparity error (pixels)" });
    let mut figure =
        LineFigure::new(format!("Depth error along row {row} of the left view"), Axis::linear("column (pixels)"), axis)
            .subtitle("Lines: least error of an unbiased estimate. Points: root-mean-square error of matches in repeated draws of the noise; where they are guesses, the range that is searched limits it.");
    let mut bias = Panel::new(Axis::linear(if depth { "bias (m)" } else { "bias (pixels)" }));
    let colour = |line: &Line| Signal::ALL.iter().position(|signal| *signal == line.signal).unwrap_or(0);
    let x = |line: &Line| line.columns.iter().map(|column| *column as f64).collect::<Vec<_>>();
    for line in &lines {
        let Some(method) = line.method else { continue };
        let label = format!("{method}, {}", line.signal.name());
        // The second method of a signal has a colour of its own.
        let shade = if method.starts_with("block") { colour(line) } else { (colour(line) + 5) % 7 };
        figure = figure.series(Series::points(label, x(line), line.rmse_m.clone()).colour(shade));
        bias = bias.series(Series::points("", x(line), line.bias_m.clone()).colour(shade));
    }
    // Bounds lie on top of the points that reach them.
    let mut drawn: Vec<Signal> = Vec::new();
    for line in &lines {
        if !drawn.contains(&line.signal) {
            drawn.push(line.signal);
            let label = format!("bound, {}", line.signal.name());
            let dark = if line.method.is_some() { 6 } else { colour(line) };
            let style = if line.signal == Signal::ScatteredAsMeasured { Style::Dashed } else { Style::Line };
            figure =
                figure.series(Series::line(label, x(line), line.bound_m.clone()).colour(dark).style(style));
        }
    }
    if !bias.series.is_empty() {
        figure = figure.lower(bias);
    }
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
    .subtitle(
        "Lines: closed form. Points: measured on sinusoids. The information found is the square of this.",
    );
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

fn clipped(axis: Axis, values: &[f64]) -> Axis {
    let finite: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
    let (low, high) = (quantile(&finite, TAIL), quantile(&finite, 1.0 - TAIL));
    // A picture without contrast is shown as such, not as its rounding.
    if high - low > 1e-9 * high.abs() { axis.range(low, high) } else { axis }
}

/// Pictures with a table of some of their pixels; `first` is the pixel at their upper left corner.
fn plot(
    name: &'static str,
    title: &str,
    subtitle: String,
    no_value: &str,
    pictures: Vec<(String, Picture)>,
    first: [usize; 2],
) -> Option<Plot> {
    let columns = pictures.first()?.1.columns;
    let rows = pictures.first()?.1.values.len().checked_div(columns)?;
    let step = columns.div_ceil(COLUMNS).max(1);
    let mut table = Table::new(
        ["row", "column"].map(str::to_owned).into_iter().chain(pictures.iter().map(|(key, _)| key.clone())),
    );
    for row in (0..rows).step_by(step) {
        for column in (0..columns).step_by(step) {
            let mut cells = vec![(row + first[0]).to_string(), (column + first[1]).to_string()];
            let at = row * columns + column;
            cells.extend(
                pictures.iter().map(|(_, picture)| {
                    picture.values.get(at).map_or_else(String::new, |value| short(*value))
                }),
            );
            table.push(cells);
        }
    }
    let subtitle =
        if step > 1 { format!("{subtitle} The table beside holds every {step}th pixel.") } else { subtitle };
    let pictures = pictures.into_iter().map(|(_, picture)| picture).collect();
    let figure = Pictures::new(title, pictures).subtitle(subtitle).no_value(no_value);
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
    plot(name, title, subtitle, "no value", pictures, [0, 0])
}
