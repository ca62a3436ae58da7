//! Two quantities at a time: for each value of one, the value of the other with which the task is just met.
//!
//! Along a curve everything else stays as the camera has it. Beside the demand a second curve tells with which pairs the
//! camera is as good as it is now: it passes through the camera, and is there too where nothing meets the demand. Limits
//! that shot noise does not know ([`super::caps`]) are drawn as lines of their own and named at every point that
//! breaks one.

use super::caps::{Circumstances, Limit, limits};
use super::solve::{CameraTask, CapCode, Quantity, Solution};
use crate::error::Result;
use serde::ser::{Serialize, SerializeStruct, Serializer};

/// Points of a curve.
pub const POINTS: usize = 41;
/// f-numbers, as far as lenses are made; factors around the camera's own value of the others.
const SLOWEST_F_NUMBER: f64 = 8.0;
const PIXELS: f64 = 8.0;
const EXPOSURES: f64 = 100.0;
const DISTANCES: f64 = 30.0;
/// Share by which frames that are as good as now may be worse: a whole frame more is no price for the last digits.
const AS_GOOD: f64 = 1e-3;
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
    /// Codes of the limits that the pair (x, y) breaks.
    pub capped: Vec<CapCode>,
    /// Why no value suffices.
    pub reason: Option<String>,
}

/// A limit over the plane of the two quantities.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct LimitLine {
    /// Code of the limit.
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
    /// The curve, x ascending.
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

/// Where a quantity is varied around the camera's own value.
fn range(task: &CameraTask<'_>, quantity: Quantity) -> [f64; 2] {
    let own = task.value(quantity);
    match quantity {
        Quantity::FNumber => [crate::instrument::FASTEST_F_NUMBER, SLOWEST_F_NUMBER.max(2.0 * own)],
        Quantity::Pixel => [own / PIXELS, own * PIXELS],
        Quantity::Distance => {
            let middle = if own.is_finite() { own } else { DISTANCE_M };
            [middle / DISTANCES, middle * DISTANCES]
        }
        _ => [own / EXPOSURES, own * EXPOSURES],
    }
}

/// Traces a curve. `solve` solves a task for a quantity; `as_now` is the statistical distance of the camera as it is.
///
/// # Errors
/// Those of `solve` and of the limits.
pub fn trace(
    task: &CameraTask<'_>,
    (x, y): (Quantity, Quantity),
    as_now: f64,
    given: &Circumstances<'_>,
    solve: &mut dyn FnMut(&CameraTask<'_>, Quantity) -> Result<Solution>,
) -> Result<TradeOff> {
    let [low, high] = range(task, x);
    let last = (POINTS - 1) as f64;
    let mut points = Vec::with_capacity(POINTS);
    let mut lines: Vec<LimitLine> = Vec::new();
    for i in 0..POINTS {
        let at = (low.ln() + (high / low).ln() * i as f64 / last).exp();
        let trial = task.forward(x, at);
        let here = CameraTask { camera: &trial.camera, distance_m: trial.distance_m, ..task.clone() };
        let solution = match solved(&here, y, solve) {
            // A table of the air may end before.
            Err(error) if x == Quantity::Distance => {
                let reason = Some(error.to_string());
                points.push(Point { x: at, y: None, y_as_now: None, capped: Vec::new(), reason });
                continue;
            }
            solution => solution?,
        };
        let of_y = limits(y, &trial, given)?;
        for limit in &of_y {
            record(&mut lines, limit, at);
        }
        let mut capped = Vec::new();
        if let Some(value) = solution.value {
            let both = here.forward(y, value);
            // A speed is limited where the exposure that sets it is.
            let of_x =
                if y == Quantity::Speed { limits(x, &trial, given)? } else { limits(x, &both, given)? };
            let of_x = of_x.iter().filter(|limit| !(y == Quantity::Speed && limit.code == CapCode::Motion));
            let broken = of_y.iter().filter_map(|limit| limit.broken_by(value));
            capped = broken.chain(of_x.filter_map(|limit| limit.broken_by(at))).map(|cap| cap.code).collect();
            capped.sort_unstable();
            capped.dedup();
        }
        let slack = if y == Quantity::Frames { AS_GOOD } else { 0.0 };
        let now = CameraTask { required: as_now * (1.0 - slack), ..here.clone() };
        let y_as_now = if as_now > 0.0 { solved(&now, y, solve)?.value } else { None };
        points.push(Point { x: at, y: solution.value, y_as_now, capped, reason: solution.reason });
    }
    for limit in limits(x, &task.own(), given)? {
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
        let bands = Bands::from_rows([(900.0, 1.0)]).unwrap();
        let task = CameraTask {
            camera: &camera,
            bands: &bands,
            required: 2.0,
            farthest_m: None,
            distance_m: Some(30.0),
            size_m: None,
        };
        let given = Circumstances { bands: &bands, speed_m_s: Some(10.0), brightest: &|_| Ok(0.0) };
        trace(&task, (x, y), shot(&task.own()).unwrap(), &given, &mut |task, quantity| {
            task.solve(quantity, shot)
        })
        .unwrap()
    }

    #[test]
    fn exposure_grows_as_the_square_of_the_f_number() {
        let curve = traced(Quantity::FNumber, Quantity::Exposure);
        assert_eq!(curve.points.len(), POINTS);
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
        assert_eq!(codes, [(CapCode::Motion, false), (CapCode::Diffraction, true)]);
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
