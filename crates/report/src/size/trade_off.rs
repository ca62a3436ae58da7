//! One quantity of a camera against another, drawn.
//!
//! Green is what meets the demand and spoils no image; grey is what collects enough and is forbidden all the same, by
//! motion, the frame, the full well or the least noise. Both come from the study, which names them at every point.

use crate::figures::Plot;
use crate::plot::{self, Axis, Band, LineFigure, Marker, Rule, Series, Style};
use crate::table::{Table, number, optional};
use crate::text::{quantity, significant};
use crate::words::shortfall::no;
use crate::words::size::captions;
use hadar::policy::{CapCode, Quantity, TradeOff, trade_off::Point};
use hadar_study::Sizing;

/// What is drawn reaches this far beyond camera and demand.
const MARGIN: f64 = 3.0;
/// A name of more letters is not written beside the camera.
const LONG: usize = 24;
/// Farther than this factor from the camera's own value nothing is drawn: nobody builds it.
const FARTHEST: f64 = 1e6;
/// How far beyond camera and solution is drawn.
const AROUND: f64 = 32.0;
/// Share by which the value that would do must differ from the camera's to be named.
const OTHER: f64 = 0.01;

/// The curve with which the demand is met, that with which the camera is as good as it is now, and the limits.
#[must_use]
pub(super) fn trade_off(curve: &TradeOff, result: &Sizing) -> Plot {
    let (x, y) = (curve.x, curve.y);
    let camera = result.camera.as_ref().map_or("the camera", |camera| camera.camera.name.as_str());
    let scale = |quantity: Quantity| if quantity == Quantity::Pixel { 1e6 } else { 1.0 };
    let (sx, sy) = (scale(x), scale(y));
    let at: Vec<f64> = curve.points.iter().map(|point| point.x * sx).collect();
    let column = |of: fn(&Point) -> Option<f64>| -> Vec<f64> {
        curve.points.iter().map(|point| of(point).map_or(f64::NAN, |y| y * sy)).collect()
    };
    let (met, now) = (column(|point| point.y), column(|point| point.y_as_now));
    let own = (curve.camera.0 * sx, curve.camera.1 * sy);
    let (bottom, top) = extent(curve, &[&met, &now], own.1, sy);
    let solved = just_enough(curve);
    let [from, to] = [at.first(), at.last()].map(|end| end.copied().unwrap_or(1.0));
    let (from, to) = about(from, to, own.0, solved.map(|point| point.x * sx));
    // Whole numbers change in steps; between two points the larger one is sure to do.
    let drawn = |values: &[f64]| match y {
        Quantity::Frames => stairs(&at, values),
        _ => (at.clone(), values.to_vec()),
    };
    let area = |label: String, low: Vec<f64>, high: Vec<f64>| {
        let ((x, low), (_, high)) = (drawn(&low), drawn(&high));
        let inside = |values: Vec<f64>| values.iter().map(|y| y.clamp(bottom, top)).collect();
        Band::new(label, x, inside(low), inside(high))
    };
    let required = significant(curve.required, 3);
    // The answer first.
    let is_allowed = curve.points.iter().any(|point| point.within_limits.is_some());
    let answer = match (is_allowed, solved) {
        (false, _) => format!("nothing meets d = {required} within all limits"),
        (true, Some(point)) => {
            let value = just_enough_label(curve, point.x, point.y.unwrap_or(f64::NAN));
            format!("{value} just meets d = {required}")
        }
        (true, None) => format!("what meets d = {required}"),
    };
    let mut figure = LineFigure::new(
        format!("{} against {}: {answer}", title(y), x.name()),
        Axis::log(axis(x)).range(from, to),
        Axis::log(axis(y)).range(bottom, top),
    )
    .subtitle(captions::trade_off(curve, camera));
    let allowed = ends(curve, sy, |point| point.within_limits);
    let label =
        if allowed.0.iter().any(|y| !y.is_nan()) { format!("meets d = {required}") } else { String::new() };
    figure = figure.band(area(label, allowed.0.clone(), allowed.1.clone()).colour(2));
    // What meets the demand on either side of the allowed range, or all of it where nothing is allowed.
    let enough = ends(curve, sy, |point| {
        point.y.map(|value| if y.is_least() { (value, f64::INFINITY) } else { (0.0, value) })
    });
    let or = |values: &[f64], otherwise: &[f64]| -> Vec<f64> {
        values
            .iter()
            .zip(otherwise)
            .map(|(value, other)| if value.is_nan() { *other } else { *value })
            .collect()
    };
    let below = (enough.0.clone(), or(&allowed.0, &enough.1));
    let above = (
        allowed.1.iter().map(|y| if y.is_finite() { *y } else { f64::NAN }).collect::<Vec<f64>>(),
        enough.1.clone(),
    );
    let mut label = format!("d = {required} too, but against a limit");
    for (low, high) in [below, above] {
        // An area without extent is none.
        let low: Vec<f64> = low
            .iter()
            .zip(&high)
            .map(|(low, high)| if low.max(bottom) < high.min(top) { *low } else { f64::NAN })
            .collect();
        if low.iter().any(|y| !y.is_nan()) {
            figure = figure.band(area(std::mem::take(&mut label), low, high));
        }
    }
    let (x_met, y_met) = drawn(&met);
    figure = figure.series(Series::line("just met", x_met, y_met).colour(0));
    if now.iter().any(|y| y.is_finite()) {
        let label = format!("as good as now, d = {}", significant(curve.as_now, 3));
        let (x, y) = drawn(&now);
        figure = figure.series(Series::line(label, x, y).style(Style::Dashed).colour(6));
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
        let name = if camera.chars().count() > LONG { "this camera" } else { camera };
        let label = match result.verdict.fails_by.as_slice() {
            [] => name.to_owned(),
            reasons => format!("{name} ({})", no(reasons)),
        };
        figure = figure.marker(Marker::new(label, own.0, own.1));
    }
    if let Some(point) = solved {
        let value = point.y.unwrap_or(f64::NAN);
        figure =
            figure.marker(Marker::new(just_enough_label(curve, point.x, value), point.x * sx, value * sy));
    }
    Plot {
        name: format!("trade_off_{}_{}", name(x), name(y)).into(),
        figure: figure.into(),
        table: table(curve),
    }
}

fn just_enough_label(curve: &TradeOff, at: f64, value: f64) -> String {
    let enough = in_words(curve.y, value);
    if curve.y == Quantity::Speed { format!("{enough} at {}", in_words(curve.x, at)) } else { enough }
}

fn table(curve: &TradeOff) -> Table {
    let (x, y) = (curve.x.key(), curve.y.key());
    let header = [x, y, &format!("{y}_as_now"), &format!("{y}_allowed_from"), &format!("{y}_allowed_to")];
    let mut table = Table::new(header.into_iter().chain(["capped", "reason"]).map(str::to_owned));
    for point in &curve.points {
        let (low, high) = point.within_limits.unzip();
        let high = high.filter(|high| high.is_finite());
        let mut row: Vec<String> = [Some(point.x), point.y, point.y_as_now, low, high].map(optional).to_vec();
        row[0] = number(point.x);
        row.push(point.capped.iter().map(|code| code.name()).collect::<Vec<_>>().join(" "));
        row.push(point.reason.clone().unwrap_or_default());
        table.push(row);
    }
    table
}

/// Lower and upper ends of a range at every point, NaN where there is none.
fn ends(curve: &TradeOff, scale: f64, of: impl Fn(&Point) -> Option<(f64, f64)>) -> (Vec<f64>, Vec<f64>) {
    let none = (f64::NAN, f64::NAN);
    curve.points.iter().map(|point| of(point).map_or(none, |(low, high)| (low * scale, high * scale))).unzip()
}

/// Between two points the larger of their values.
fn stairs(x: &[f64], y: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let (mut across, mut up) = (Vec::new(), Vec::new());
    for (x, y) in x.windows(2).zip(y.windows(2)) {
        let most = if y[0].is_nan() || y[1].is_nan() { f64::NAN } else { y[0].max(y[1]) };
        across.extend([x[0], x[0], x[1]]);
        up.extend([y[0], most, most]);
    }
    across.extend(x.last());
    up.extend(y.last());
    (across, up)
}

/// Where the solver arrives: at the camera's own first quantity, for a speed at the least exposure that will do; nowhere
/// if that is the camera itself.
fn just_enough(curve: &TradeOff) -> Option<&Point> {
    let found = match curve.y {
        Quantity::Speed => curve.points.iter().find(|point| point.y.is_some()),
        _ => curve.points.iter().find(|point| point.x == curve.camera.0 && point.y.is_some()),
    }?;
    let far = |a: f64, b: f64| (a / b - 1.0).abs() > OTHER;
    (far(found.x, curve.camera.0) || far(found.y?, curve.camera.1)).then_some(found)
}

/// The range of the horizontal axis: a decade and a half about the camera and the solution, of what was computed.
fn about(from: f64, to: f64, own: f64, solved: Option<f64>) -> (f64, f64) {
    if !(own.is_finite() && own > 0.0) {
        return (from, to);
    }
    let solved = solved.unwrap_or(own);
    (from.max(own.min(solved) / AROUND), to.min(own.max(solved) * AROUND))
}

fn in_words(of: Quantity, value: f64) -> String {
    match of {
        Quantity::Exposure => quantity(value, "s").replace(" us", " µs"),
        Quantity::Pixel | Quantity::Distance => quantity(value, "m").replace(" um", " µm"),
        Quantity::Speed => format!("{} m/s", plot::number(value)),
        Quantity::FNumber => format!("f/{}", significant(value, 3)),
        Quantity::Noise => format!("{} counts", plot::number(value)),
        Quantity::Frames if value == 1.0 => "1 frame".into(),
        Quantity::Frames => format!("{value} frames"),
    }
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
        CapCode::DecisionTime => "time demanded",
        CapCode::FrameRate => "a whole frame",
        CapCode::FullWell => "full well",
        CapCode::Impractical => "practice",
        CapCode::LowestNoise => "read noise and converter",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::Figure;
    use hadar::material::Library;
    use hadar_scenario::Scenario;
    use hadar_study::Study;

    /// A camera that needs a longer exposure than it has, in a frame of 60 Hz.
    const SCENE: &str = "[target]\nmaterial = \"skin\"\ntemperature = \"37 degC\"\ndistance = \"30 m\"\n\
        [[environment]]\ntemperature = \"20 degC\"\nlighting = 0.5\n\
        [alternatives]\nmaterials = [\"soda-lime-glass\"]\n[bands]\nstep = \"20 cm^-1\"\n\
        [camera]\npreset = \"flir-a325sc\"\nnetd = \"10 mK\"\nflicker_fraction = 0.1\nframe_rate = \"60 Hz\"\n\
        [requirement]\ndistance = REQUIRED\nspeed = \"3 mph\"";

    fn figures(required: &str) -> (Sizing, Vec<(TradeOff, LineFigure)>) {
        let scenario = Scenario::from_toml(&SCENE.replace("REQUIRED", required), None).unwrap();
        let study = Study::new(&scenario, &Library::embedded().unwrap()).unwrap();
        let sizing = study.size().unwrap();
        let drawn = study.trade_offs(&sizing).unwrap().into_iter().map(|curve| {
            let Figure::Line(figure) = trade_off(&curve, &sizing).figure else { panic!("no curves") };
            (curve, figure)
        });
        let drawn = drawn.collect();
        (sizing, drawn)
    }

    #[test]
    fn the_solution_is_marked_on_the_curve_and_green_ends_at_the_limits() {
        for required in ["1.0", "6.0", "8.0"] {
            let (sizing, drawn) = figures(required);
            let solved = &sizing.solve_for.as_ref().unwrap().0;
            for (curve, figure) in drawn {
                // The camera, and where the solver arrives.
                let [_, marker] = figure.panel.markers.as_slice() else { panic!("{:?} {required}", curve.y) };
                let just = figure.panel.series.iter().find(|series| series.label == "just met").unwrap();
                assert!(just.x.iter().zip(&just.y).any(|(x, y)| (*x, *y) == (marker.x, marker.y)));
                let (_, solution) = solved.iter().find(|(quantity, _)| *quantity == curve.y).unwrap();
                let value = solution.value.unwrap();
                assert!((marker.y / value - 1.0).abs() < 1e-6, "{:?}: {} {value}", curve.y, marker.y);
                // Nothing green above a frame, and grey there instead.
                if curve.y == Quantity::Exposure {
                    let green = figure.panel.bands.iter().find(|band| band.colour == Some(2)).unwrap();
                    let inside = |y: &&f64| !y.is_nan();
                    assert!(green.high.iter().filter(inside).all(|y| *y <= 1.0 / 60.0 * (1.0 + 1e-9)));
                    assert!(figure.panel.bands.iter().any(|band| band.colour.is_none()));
                }
            }
        }
    }

    #[test]
    fn whole_numbers_are_drawn_as_steps() {
        let (x, y) = stairs(&[1.0, 2.0, 3.0], &[4.0, 5.0, f64::NAN]);
        assert_eq!(x, [1.0, 1.0, 2.0, 2.0, 2.0, 3.0, 3.0]);
        assert_eq!(y[..4], [4.0, 5.0, 5.0, 5.0]);
        assert!(y[4..].iter().all(|y| y.is_nan()));
    }
}
