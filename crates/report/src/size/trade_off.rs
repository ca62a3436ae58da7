//! One quantity of a camera against another, drawn.

use crate::figures::Plot;
use crate::plot::{Axis, Band, LineFigure, Marker, Rule, Series, Style};
use crate::table::{Table, number, optional};
use crate::text::significant;
use hadar::policy::{CapCode, Quantity, TradeOff};

/// What is drawn reaches this far beyond camera and demand.
const MARGIN: f64 = 3.0;
/// A name of more letters is not written beside the camera.
const LONG: usize = 24;
/// Farther than this factor from the camera's own value nothing is drawn: nobody builds it.
const FARTHEST: f64 = 1e6;

/// The curve with which the demand is met, that with which the camera is as good as it is now, and the limits.
#[must_use]
pub(super) fn trade_off(curve: &TradeOff, camera: &str) -> Plot {
    let (x, y) = (curve.x, curve.y);
    let mut header = vec![x.key().to_owned(), y.key().to_owned(), format!("{}_as_now", y.key())];
    header.extend(["capped".to_owned(), "reason".to_owned()]);
    let mut table = Table::new(header);
    for point in &curve.points {
        let reason = point.reason.clone().unwrap_or_default();
        let numbers = [number(point.x), optional(point.y), optional(point.y_as_now)];
        table.push(
            numbers
                .into_iter()
                .chain([point.capped.iter().map(|code| code.name()).collect::<Vec<_>>().join(" "), reason])
                .collect(),
        );
    }
    let scale = |quantity: Quantity| if quantity == Quantity::Pixel { 1e6 } else { 1.0 };
    let (sx, sy) = (scale(x), scale(y));
    let at: Vec<f64> = curve.points.iter().map(|point| point.x * sx).collect();
    let column = |of: &dyn Fn(usize) -> Option<f64>| -> Vec<f64> {
        (0..at.len()).map(|i| of(i).map_or(f64::NAN, |y| y * sy)).collect()
    };
    let met = column(&|i| curve.points[i].y);
    let now = column(&|i| curve.points[i].y_as_now);
    let own = (curve.camera.0 * sx, curve.camera.1 * sy);
    let (bottom, top) = extent(curve, &[&met, &now], own.1, sy);

    let [from, to] = [at.first(), at.last()].map(|end| end.copied().unwrap_or(1.0));
    let mut figure = LineFigure::new(
        format!("{} against {}", title(y), x.name()),
        Axis::log(axis(x)).range(from, to),
        Axis::log(axis(y)).range(bottom, top),
    )
    .subtitle(subtitle(curve, camera));
    if met.iter().any(|y| y.is_finite()) {
        let edge = if y.is_least() { top } else { bottom };
        let edges = met.iter().map(|y| if y.is_finite() { edge } else { f64::NAN }).collect();
        let shown = met.iter().map(|y| y.clamp(bottom, top)).collect();
        let label = format!("meets d = {}", significant(curve.required, 3));
        figure = figure
            .band(Band::new(label, at.clone(), shown, edges).colour(2))
            .series(Series::line("just met", at.clone(), met).colour(0));
    }
    if now.iter().any(|y| y.is_finite()) {
        let label = format!("as now, d = {}", significant(curve.as_now, 3));
        figure = figure.series(Series::line(label, at, now).style(Style::Dashed).colour(6));
    }
    for (i, line) in curve.limits.iter().enumerate() {
        let label = words(line.code, y);
        if line.upright {
            let here = line.points.first().map_or(f64::NAN, |point| point.0);
            figure = figure.rule(Rule::vertical(here * sx, label));
        } else {
            let (x, y) = line.points.iter().map(|(x, y)| (x * sx, y.map_or(f64::NAN, |y| y * sy))).unzip();
            let colour = [1, 3, 4, 5][i % 4];
            figure = figure.series(Series::line(label, x, y).style(Style::Dotted).colour(colour));
        }
    }
    if own.0.is_finite() && own.1.is_finite() {
        let label = if camera.len() > LONG { "this camera" } else { camera };
        figure = figure.marker(Marker::new(label, own.0, own.1));
    }
    Plot { name: format!("trade_off_{}_{}", name(x), name(y)).into(), figure: figure.into(), table }
}

/// The range of the vertical axis: curves, camera and limits, as far as they are near each other.
fn extent(curve: &TradeOff, curves: &[&Vec<f64>], own: f64, scale: f64) -> (f64, f64) {
    let limits = curve.limits.iter().flat_map(|line| &line.points).filter_map(|(_, y)| *y).map(|y| y * scale);
    let drawn = curves.iter().flat_map(|curve| curve.iter().copied());
    let middle = if own.is_finite() && own > 0.0 { own } else { 1.0 };
    let near = |value: &f64| *value >= middle / FARTHEST && *value <= middle * FARTHEST;
    let (low, high) = limits
        .chain(drawn)
        .chain([middle])
        .filter(near)
        .fold((f64::INFINITY, 0.0f64), |(low, high), value| (low.min(value), high.max(value)));
    let least = if curve.y == Quantity::Frames { 1.0f64.min(low) } else { low / MARGIN };
    (least.max(f64::MIN_POSITIVE), high * MARGIN)
}

fn subtitle(curve: &TradeOff, camera: &str) -> String {
    let rest = format!("All else as {camera} has it.");
    let none = curve.points.iter().all(|point| point.y.is_none());
    let why = curve.points.iter().rev().find_map(|point| point.reason.as_ref()).filter(|_| none);
    let side = if curve.y.is_least() { "above" } else { "below" };
    let (x, y) = (curve.x.name(), curve.y.name());
    match why {
        Some(why) => {
            format!("{rest} At no {x} shown does any {y} meet d = {}: {why}.", significant(curve.required, 3))
        }
        None => format!(
            "{rest} The demand is met {side} the curve; dotted and grey lines are limits beside shot noise."
        ),
    }
}

fn title(quantity: Quantity) -> String {
    let name = quantity.name();
    let mut letters = name.chars();
    letters
        .next()
        .map_or_else(String::new, |first| first.to_uppercase().collect::<String>() + letters.as_str())
}

fn axis(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::Exposure => "exposure (s)",
        Quantity::Pixel => "pixel (µm)",
        Quantity::FNumber => "f-number",
        Quantity::Noise => "noise per reading (counts)",
        Quantity::Frames => "averaged frames",
        Quantity::Distance => "distance of the target (m)",
        Quantity::Speed => "speed (m/s)",
    }
}

/// In file names.
fn name(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::Exposure => "exposure",
        Quantity::Pixel => "pixel",
        Quantity::FNumber => "f_number",
        Quantity::Noise => "noise",
        Quantity::Frames => "frames",
        Quantity::Distance => "distance",
        Quantity::Speed => "speed",
    }
}

const fn words(code: CapCode, limited: Quantity) -> &'static str {
    match code {
        CapCode::Motion if matches!(limited, Quantity::Speed) => "speed demanded",
        CapCode::Diffraction => "pixel = λF",
        CapCode::Motion => "motion of one pixel",
        CapCode::FrameRate => "a whole frame",
        CapCode::FullWell => "full well",
        CapCode::Impractical => "practice",
        CapCode::LowestNoise => "read noise and converter",
    }
}
