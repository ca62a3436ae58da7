//! Two quantities at a time: for each value of one, the value of the other with which the task is just met.
//!
//! Along a curve everything else stays as the camera has it. Beside the demand a second curve tells with which pairs the
//! camera is as good as it is now: it passes through the camera, and is there too where nothing meets the demand. Limits
//! that shot noise does not know ([`super::caps`]) are drawn as lines of their own and named at every point that
//! breaks one; what lies within all of them but diffraction, which only blurs, is told at every point as a range of the
//! second quantity.
//!
//! The values of the first quantity are evenly spread in the logarithm. To them are added the camera's own, the one that
//! alone would meet the demand, those of upright limits, and the last ones that have a solution, so that no boundary of the
//! plane lies between two points.

use super::caps::{Circumstances, Limit, limits};
use super::solve::{CameraTask, CapCode, Quantity, Solution};
use crate::error::Result;
use crate::order;
use serde::ser::{Serialize, SerializeStruct, Serializer};

/// How finely a curve is traced.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Resolution {
    /// Points that are evenly spread in the logarithm, at least 2; there are some more at boundaries.
    pub points: usize,
    /// Halvings of a step at whose one end nothing meets the demand.
    pub halvings: usize,
}

impl Resolution {
    /// Of a picture that stays.
    pub const FINE: Self = Self { points: 41, halvings: 8 };
    /// Of one that is drawn again at once: boundaries to a fiftieth of a decade.
    pub const COARSE: Self = Self { points: 11, halvings: 3 };
}

/// f-numbers, as far as lenses are made; factors around the camera's own value of the others.
const SLOWEST_F_NUMBER: f64 = 8.0;
const PIXELS: f64 = 8.0;
const EXPOSURES: f64 = 100.0;
const DISTANCES: f64 = 30.0;
/// The range is extended to the value that alone meets the demand, as far as this factor from the camera's own.
const FARTHEST: f64 = 1e6;
/// How far the range reaches beyond that value.
const BEYOND: f64 = 1.5;
/// Share by which frames that are as good as now may be worse: a whole frame more is no price for the last digits.
const AS_GOOD: f64 = 1e-6;
/// Values closer than this share are one.
const SAME: f64 = 1e-9;
/// Distance around which distances are drawn where none is stated, m.
const DISTANCE_M: f64 = 30.0;

/// The pairs that are traded, the one that is varied first.
pub const PAIRS: [(Quantity, Quantity); 4] = [
    (Quantity::FNumber, Quantity::Exposure),
    (Quantity::Pixel, Quantity::Noise),
    (Quantity::Distance, Quantity::Frames),
    (Quantity::Exposure, Quantity::Speed),
];

/// One point of a curve.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Point {
    /// Value of the first quantity.
    pub x: f64,
    /// Value of the second with which the task is just met; `None` if none suffices.
    pub y: Option<f64>,
    /// Value of the second with which the camera is as good as it is now.
    pub y_as_now: Option<f64>,
    /// Least and largest value of the second that meet the task and break no limit but diffraction, 0 or infinite (`null`
    /// in JSON) where that end is open; `None` if there is none.
    pub within_limits: Option<(f64, f64)>,
    /// Codes of the limits that the pair (x, y) breaks.
    pub capped: Vec<CapCode>,
    /// Why no value meets the requirement, in words.
    pub reason: Option<String>,
}

/// A limit over the plane of the two quantities.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct LimitLine {
    /// Code of the limit that the line shows.
    pub code: CapCode,
    /// Whether it limits the first quantity, whatever the second, and so is upright.
    pub upright: bool,
    /// Where it runs, as pairs (x, y); y is `None` in an upright one.
    pub points: Vec<(f64, Option<f64>)>,
}

/// One quantity against another.
#[derive(Debug, Clone, PartialEq)]
pub struct TradeOff {
    /// The quantity that is varied.
    pub x: Quantity,
    /// The one that is solved for.
    pub y: Quantity,
    /// Both of the camera; infinite or no number where it has none.
    pub camera: (f64, f64),
    /// Statistical distance that is demanded.
    pub required: f64,
    /// Statistical distance of the camera as it is.
    pub as_now: f64,
    /// Points of the curve, by ascending value of x.
    pub points: Vec<Point>,
    /// Limits that shot noise does not know.
    pub limits: Vec<LimitLine>,
}

impl Serialize for TradeOff {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        let mut out = serializer.serialize_struct("TradeOff", 7)?;
        out.serialize_field("x", self.x.key())?;
        out.serialize_field("y", self.y.key())?;
        out.serialize_field("camera", &self.camera)?;
        out.serialize_field("distance", &self.required)?;
        out.serialize_field("distance_now", &self.as_now)?;
        out.serialize_field("points", &self.points)?;
        out.serialize_field("limits", &self.limits)?;
        out.end()
    }
}

impl TradeOff {
    /// Whether any pair of values meets the demand.
    #[must_use]
    pub fn has_solution(&self) -> bool {
        self.points.iter().any(|point| point.y.is_some())
    }
}

/// Where a quantity is varied: around the camera's own value, and to the one that alone meets the demand.
fn range(task: &CameraTask<'_>, quantity: Quantity, alone: Option<f64>) -> [f64; 2] {
    let own = task.value(quantity);
    let [low, high] = match quantity {
        Quantity::FNumber => [crate::instrument::FASTEST_F_NUMBER, SLOWEST_F_NUMBER.max(2.0 * own)],
        Quantity::Pixel => [own / PIXELS, own * PIXELS],
        Quantity::Distance => {
            let middle = if own.is_finite() { own } else { DISTANCE_M };
            [middle / DISTANCES, middle * DISTANCES]
        }
        _ => [own / EXPOSURES, own * EXPOSURES],
    };
    match alone.filter(|value| *value >= low / FARTHEST && *value <= high * FARTHEST) {
        Some(value) if value < low => [value / BEYOND, high],
        Some(value) if value > high => [low, value * BEYOND],
        _ => [low, high],
    }
}

/// Traces a curve between its boundaries. `solve` solves a task for a quantity; `as_now` is the statistical distance
/// of the camera as it is,
/// `alone` the value of the first quantity that alone meets the demand.
///
/// # Errors
/// Those of `solve` and of the limits.
pub fn trace(
    task: &CameraTask<'_>,
    pair: (Quantity, Quantity),
    as_now: f64,
    alone: Option<f64>,
    given: &Circumstances<'_>,
    resolution: Resolution,
    solve: &mut dyn FnMut(&CameraTask<'_>, Quantity) -> Result<Solution>,
) -> Result<TradeOff> {
    let (x, y) = pair;
    let [low, high] = range(task, x, alone);
    let of_x = limits(x, &task.own(), given)?;
    let exact = of_x.iter().map(|limit| limit.value).chain(alone).chain([task.value(x)]);
    let exact: Vec<f64> = exact.filter(|value| (low..=high).contains(value)).collect();
    let points = resolution.points.max(2);
    let last = (points - 1) as f64;
    let even = (0..points).map(|i| (low.ln() + (high / low).ln() * i as f64 / last).exp());
    let near = |a: f64, b: f64| (a / b - 1.0).abs() < SAME;
    let mut places: Vec<f64> = even.filter(|at| !exact.iter().any(|one| near(*one, *at))).collect();
    places.extend(&exact);
    places.sort_by(f64::total_cmp);
    places.dedup_by(|a, b| near(*a, *b));

    let mut found = Vec::with_capacity(places.len());
    for at in places {
        found.push(point(task, pair, at, as_now, given, solve)?);
    }
    for holds in [|point: &Point| point.y.is_some(), |point: &Point| point.within_limits.is_some()] {
        let mut at = |at| point(task, pair, at, as_now, given, solve);
        found.extend(edges(&found, &exact, holds, resolution.halvings, &mut at)?);
        order::ascending(&mut found, |(point, _)| point.x);
    }

    let mut lines: Vec<LimitLine> = Vec::new();
    let mut points = Vec::with_capacity(found.len());
    for (point, of_y) in found {
        of_y.iter().for_each(|limit| record(&mut lines, limit, point.x));
        points.push(point);
    }
    for limit in of_x {
        // What depends on the second quantity too is a line of that one.
        let drawn = lines.iter().any(|line| line.code == limit.code);
        if !drawn && limit.value >= low && limit.value <= high {
            let points = vec![(limit.value, None)];
            lines.push(LimitLine { code: limit.code, upright: true, points });
        }
    }
    let camera = (task.value(x), task.value(y));
    Ok(TradeOff { x, y, camera, required: task.required, as_now, points, limits: lines })
}

/// A point of a curve, and the limits on the second quantity there.
type Found = (Point, Vec<Limit>);

/// The last points at which something holds and the first at which it does not, to a part of a step; not where they are
/// known.
fn edges(
    found: &[Found],
    known: &[f64],
    holds: fn(&Point) -> bool,
    halvings: usize,
    at: &mut dyn FnMut(f64) -> Result<Found>,
) -> Result<Vec<Found>> {
    let mut edges = Vec::new();
    for pair in found.windows(2) {
        let [(a, _), (b, _)] = pair else { continue };
        let (mut inside, mut outside) = match (holds(a), holds(b)) {
            (true, false) => (a.x, b.x),
            (false, true) => (b.x, a.x),
            _ => continue,
        };
        let (mut last, mut first) = (None, None);
        for _ in 0..halvings {
            let middle = (inside * outside).sqrt();
            let tried = at(middle)?;
            if holds(&tried.0) {
                (inside, last) = (middle, Some(tried));
            } else {
                (outside, first) = (middle, Some(tried));
            }
        }
        // What is known exactly needs no neighbour inside.
        edges.extend(last.filter(|(point, _)| !known.iter().any(|at| (point.x / at - 1.0).abs() < SAME)));
        edges.extend(first);
    }
    Ok(edges)
}

/// One point, and the limits on the second quantity there.
fn point(
    task: &CameraTask<'_>,
    (x, y): (Quantity, Quantity),
    at: f64,
    as_now: f64,
    given: &Circumstances<'_>,
    solve: &mut dyn FnMut(&CameraTask<'_>, Quantity) -> Result<Solution>,
) -> Result<Found> {
    let trial = task.forward(x, at);
    let here = CameraTask { camera: &trial.camera, distance_m: trial.distance_m, ..task.clone() };
    let solution = match solved(&here, y, solve) {
        // A table of the air may end before.
        Err(error) if x == Quantity::Distance => {
            let reason = Some(error.to_string());
            let (capped, within_limits) = (Vec::new(), None);
            return Ok((Point { x: at, y: None, y_as_now: None, within_limits, capped, reason }, Vec::new()));
        }
        solution => solution?,
    };
    let of_y = limits(y, &trial, given)?;
    // What the camera breaks there whatever the second quantity: everything that makes an image useless limits exposures.
    let whatever: Vec<CapCode> = limits(Quantity::Exposure, &trial, given)?
        .iter()
        .filter(|limit| y != Quantity::Exposure && !of_y.iter().any(|other| other.code == limit.code))
        .filter_map(|limit| limit.broken_by(trial.camera.exposure_s))
        .map(|cap| cap.code)
        .collect();
    let (mut capped, mut within_limits) = (Vec::new(), None);
    if let Some(value) = solution.value {
        let both = here.forward(y, value);
        // A speed is limited where the exposure that sets it is.
        let of_x = limits(x, if y == Quantity::Speed { &trial } else { &both }, given)?;
        let of_x = of_x.iter().filter(|limit| !(y == Quantity::Speed && limit.code == CapCode::Motion));
        let broken = of_y.iter().filter_map(|limit| limit.broken_by(value));
        capped = broken.chain(of_x.filter_map(|limit| limit.broken_by(at))).map(|cap| cap.code).collect();
        capped.extend(&whatever);
        capped.sort_unstable();
        capped.dedup();
        let met = if y.is_least() { (value, f64::INFINITY) } else { (0.0, value) };
        let range = of_y.iter().fold(met, |(low, high), limit| match limit.is_least {
            true => (low.max(limit.value), high),
            false => (low, high.min(limit.value)),
        });
        within_limits = Some(range).filter(|(low, high)| whatever.is_empty() && low <= high);
    }
    let slack = if y == Quantity::Frames { AS_GOOD } else { 0.0 };
    let now = CameraTask { required: as_now * (1.0 - slack), ..here.clone() };
    let y_as_now = if as_now > 0.0 { solved(&now, y, solve)?.value } else { None };
    let reason = solution.reason;
    Ok((Point { x: at, y: solution.value, y_as_now, within_limits, capped, reason }, of_y))
}

fn record(lines: &mut Vec<LimitLine>, limit: &Limit, at: f64) {
    let point = (at, Some(limit.value));
    match lines.iter_mut().find(|line| line.code == limit.code) {
        Some(line) => line.points.push(point),
        None => lines.push(LimitLine { code: limit.code, upright: false, points: vec![point] }),
    }
}

/// One quantity solved for; of a speed the exposure is the one that is varied, not the least one.
fn solved(
    task: &CameraTask<'_>,
    quantity: Quantity,
    solve: &mut dyn FnMut(&CameraTask<'_>, Quantity) -> Result<Solution>,
) -> Result<Solution> {
    let solution = solve(task, if quantity == Quantity::Speed { Quantity::Exposure } else { quantity })?;
    if quantity != Quantity::Speed {
        return Ok(solution);
    }
    let fastest = task.value(Quantity::Speed);
    // Rounding does not make the camera's own exposure too short.
    let enough = solution.value.is_some_and(|least| least <= task.camera.exposure_s * (1.0 + 1e-9));
    let reason = match (enough, &solution.value) {
        (true, _) => None,
        (false, Some(_)) => Some("the exposure is too short".into()),
        (false, None) => solution.reason.clone(),
    };
    Ok(Solution { value: enough.then_some(fastest).filter(|speed| speed.is_finite()), reason, ..solution })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::instrument::{View, presets};
    use crate::policy::Trial;
    use crate::spectrum::Bands;

    /// d = 10⁻³ √N of one band in shot noise alone: H = t a²/F² is all that counts.
    fn shot(trial: &Trial) -> Result<f64> {
        let bands = Bands::from_rows([(900.0, 1.0)])?;
        let counting = trial.camera.counting(&bands, &View::at(None));
        Ok(1e-3 * (counting.counts_per_radiance * 1e21).sqrt())
    }

    fn traced(x: Quantity, y: Quantity) -> TradeOff {
        let mut camera = presets::get("ideal-pnrd").unwrap();
        (camera.pixels, camera.field_of_view_rad) = (Some(320), Some(0.4));
        // The lens of that view.
        camera.focal_length_m = camera.pixel_m * 320.0 / 0.4;
        let bands = Bands::from_rows([(900.0, 1.0)]).unwrap();
        let task = CameraTask {
            camera: &camera,
            bands: &bands,
            required: 2.0,
            farthest_m: None,
            distance_m: Some(30.0),
            size_m: None,
            of_object: false,
        };
        let given =
            Circumstances { bands: &bands, speed_m_s: Some(10.0), time_s: None, brightest: &|_| Ok(0.0) };
        let alone = task.solve(x, shot).unwrap().value;
        trace(
            &task,
            (x, y),
            shot(&task.own()).unwrap(),
            alone,
            &given,
            Resolution::FINE,
            &mut |task, quantity| task.solve(quantity, shot),
        )
        .unwrap()
    }

    #[test]
    fn exposure_grows_as_the_square_of_the_f_number() {
        let curve = traced(Quantity::FNumber, Quantity::Exposure);
        assert!(curve.points.len() >= Resolution::FINE.points && curve.points.is_sorted_by(|a, b| a.x < b.x));
        let first = curve.points[0].y.unwrap() / curve.points[0].x.powi(2);
        for point in &curve.points {
            let (y, now) = (point.y.unwrap(), point.y_as_now.unwrap());
            // The crossing is found to the last bits.
            assert!((y / point.x.powi(2) / first - 1.0).abs() < 1e-9);
            assert!((y / now / (2.0 / curve.as_now).powi(2) - 1.0).abs() < 1e-9);
            // 900 cm^-1 is 11.1 um, the pixel 12 um: f/1.08 is the slowest lens that does not blur.
            let blurred = point.x > 12e-6 * 900.0 / 0.01;
            assert_eq!(point.capped.contains(&CapCode::Diffraction), blurred, "{point:?}");
        }
        let codes: Vec<_> = curve.limits.iter().map(|line| (line.code, line.upright)).collect();
        assert_eq!(
            codes,
            [(CapCode::Motion, false), (CapCode::Impractical, false), (CapCode::Diffraction, true)]
        );
        // At 10 m/s the target moves a pixel in this time: longer exposures meet the demand and spoil the image.
        let longest = 30.0 * 0.4 / (320.0 * 0.2f64.sin() * 10.0);
        for point in &curve.points {
            let least = point.y.unwrap();
            let expected = (least <= longest).then_some((least, longest));
            assert_eq!(point.within_limits.is_some(), expected.is_some(), "{point:?}");
            if let (Some((low, high)), Some(expected)) = (point.within_limits, expected) {
                assert!(low == expected.0 && (high / expected.1 - 1.0).abs() < 1e-12, "{point:?}");
            }
        }
    }

    #[test]
    fn what_alone_meets_the_demand_is_a_point_however_far() {
        // 1e-3 √N is 2 at an exposure: where speeds begin, and where the curve of exposures passes the camera's f-number.
        let by_speed = traced(Quantity::Exposure, Quantity::Speed);
        let by_lens = traced(Quantity::FNumber, Quantity::Exposure);
        let own = by_lens.points.iter().find(|point| point.x == by_lens.camera.0).unwrap();
        let first = by_speed.points.iter().find(|point| point.y.is_some()).unwrap();
        assert!((first.x / own.y.unwrap() - 1.0).abs() < 1e-9, "{} {:?}", first.x, own.y);
        // The lens that does with the camera's own exposure.
        let lens = by_lens.camera.0 * by_lens.as_now / 2.0;
        let there = by_lens.points.iter().find(|point| (point.x / lens - 1.0).abs() < 1e-9).unwrap();
        assert!((there.y.unwrap() / by_lens.camera.1 - 1.0).abs() < 1e-9);
    }

    #[test]
    fn speed_falls_with_the_exposure_from_the_least_that_will_do() {
        let curve = traced(Quantity::Exposure, Quantity::Speed);
        let least = 12e-3 * (2.0 / curve.as_now).powi(2);
        assert!(curve.points.iter().any(|point| point.y.is_some()));
        for point in &curve.points {
            assert_eq!(point.y.is_some(), point.x >= least, "{point:?}");
            let exact = 30.0 * 0.4 / (320.0 * 0.2f64.sin() * point.x);
            if let Some(speed) = point.y {
                assert!((speed / exact - 1.0).abs() < 1e-12);
                assert_eq!(point.capped.contains(&CapCode::Motion), exact < 10.0);
            }
        }
    }
}
