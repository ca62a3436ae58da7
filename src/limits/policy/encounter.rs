//! Where in the picture a target is that crosses the way of a vehicle, and how fast it moves there.
//!
//! A target crosses at c, and vehicle and target meet (with nobody braking) within b of the camera's axis. At the distance z, closing in at
//! w, it has z/w to go: it is at most c z/w + b beside the axis, at the bearing
//!
//! tan θ = c/w + b/z,
//!
//! largest where the decision must stand, and at the lowest speed. Beyond half the view θ_h the camera must have decided before, at
//!
//! z_h = b/(tan θ_h − c/w),
//!
//! and cannot where c/w ≥ tan θ_h: it never sees the target. On its way, walking or standing, at any bearing up to θ_e = min(θ, half the
//! view), it moves across the line of sight by no more than
//!
//! v_⊥ = w sin θ_e + c,   Δ = v_⊥ t/(z α) pixels in the time t
//!
//! (α the angle of a pixel, rad). A target that keeps its pace and will be hit stands still in the
//! picture but for b; people do not keep their pace.
//!
//! Over a range of speeds Δ and v_⊥ are the largest of 257 speeds each with equal steps of v, of 1/v and of ln v, and of the swiftest of a target straight ahead.
//!
//! Assumptions: a straight way, the camera looks along it. Units: m, s, m s⁻¹, rad.
//!
//! Source: plane geometry; motion as in [`super::motion`]. Tests of crossings: 49 CFR 571.127, Table 2 (5 km/h, 50 % overlap).

use super::motion::Motion;
use super::stop::{Decision, Stop};
use crate::error::{Result, check};
use crate::instrument::Camera;

/// Speeds of a range that are looked at.
const SPEEDS: usize = 256;

/// A manoeuvre before a target that crosses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Encounter {
    stop: Stop,
    crossing_m_s: f64,
    offset_m: f64,
}

impl Encounter {
    /// Of a target that crosses at `crossing_m_s`; both meet within `offset_m` of the camera's axis.
    ///
    /// # Errors
    /// A figure below 0 or no number.
    ///
    /// ```
    /// use hadar::policy::encounter::Encounter;
    /// use hadar::policy::stop::{Stop, StopFigures};
    /// let figures = StopFigures {
    ///     speeds_m_s: [10.0; 2],
    ///     target_m_s: 0.0,
    ///     latency_s: 0.5,
    ///     deceleration_m_s2: 5.0,
    ///     margin_m: 0.0,
    ///     start: None,
    /// };
    /// // Decided at 15 m; by then at most 1.5 s of 2 m/s, and 1 m, beside the axis: 4 m of 15.
    /// let meets = Encounter::new(Stop::new(figures)?, 2.0, 1.0)?;
    /// assert!((meets.widest_rad() - (4.0f64 / 15.0).atan()).abs() < 1e-12);
    /// # Ok::<(), hadar::Error>(())
    /// ```
    pub fn new(stop: Stop, crossing_m_s: f64, offset_m: f64) -> Result<Self> {
        check::non_negative("speed of a target that crosses", crossing_m_s, "m/s")?;
        check::non_negative("offset of a target that crosses", offset_m, "m")?;
        Ok(Self { stop, crossing_m_s, offset_m })
    }

    /// How fast the target crosses, m s⁻¹.
    #[must_use]
    pub fn crossing_m_s(&self) -> f64 {
        self.crossing_m_s
    }

    /// Within which distance of the camera's axis both meet, m.
    #[must_use]
    pub fn offset_m(&self) -> f64 {
        self.offset_m
    }

    /// How far beside the axis the target is at most until a decision, rad.
    #[must_use]
    pub fn bearing_rad(&self, decision: &Decision) -> f64 {
        (self.crossing_m_s / decision.closing_m_s + self.offset_m / decision.distance_m).atan()
    }

    /// The same at every speed.
    #[must_use]
    pub fn widest_rad(&self) -> f64 {
        self.bearing_rad(&self.stop.decisions()[0])
    }

    /// Half the view that a camera surely has, rad: of figures that contradict each other the narrower; `None` where it is not known.
    #[must_use]
    pub fn half_view_rad(camera: &Camera) -> Option<f64> {
        let by_view = camera.field_of_view_rad.map(|view| 0.5 * view);
        let by_lens = camera
            .pixels
            .map(|pixels| (0.5 * f64::from(pixels) * camera.pixel_m / camera.focal_length_m).atan());
        by_view.into_iter().chain(by_lens).reduce(f64::min)
    }

    /// Where a decision must stand at the latest, m: as the manoeuvre says, or where the target leaves half a view; `None` where it is not in it
    /// after it has come into view.
    #[must_use]
    pub fn decided_m(&self, decision: &Decision, half_view_rad: f64) -> Option<f64> {
        let inward = half_view_rad.min(SIDEWAYS_RAD).tan() - self.crossing_m_s / decision.closing_m_s;
        // Who meets the camera itself is at one bearing all the time.
        let sees = if self.offset_m > 0.0 { inward > 0.0 } else { inward >= 0.0 };
        let leaves_m = if self.offset_m > 0.0 { self.offset_m / inward } else { 0.0 };
        let decided_m = decision.distance_m.max(leaves_m);
        (sees && decision.start_m.is_none_or(|start_m| decided_m < start_m)).then_some(decided_m)
    }

    /// The lowest speed from which on a target can be seen in time, m s⁻¹; `None` where at none.
    #[must_use]
    pub fn in_view_from_m_s(&self, half_view_rad: f64) -> Option<f64> {
        let holds = |decision: &Decision| self.decided_m(decision, half_view_rad).is_some();
        let mut speeds = self.speeds();
        speeds.reverse();
        // From the highest speed downwards, as far as it holds.
        let last = speeds.iter().take_while(|decision| holds(decision)).last()?;
        let next = speeds.iter().find(|decision| decision.speed_m_s < last.speed_m_s && !holds(decision));
        let Some(next) = next else { return Some(last.speed_m_s) };
        let (mut low, mut high) = (next.speed_m_s, last.speed_m_s);
        while high - low > 1e-9 * high {
            let middle = 0.5 * (low + high);
            if holds(&self.stop.at(middle)) { high = middle } else { low = middle }
        }
        Some(high)
    }

    /// The speeds that are looked at, the lowest first.
    #[must_use]
    pub fn speeds(&self) -> Vec<Decision> {
        let [slowest, fastest] = self.stop.decisions().map(|one| one.speed_m_s);
        let share = |step: usize| step as f64 / SPEEDS as f64;
        let slow = |step: usize| ((1.0 - share(step)) / slowest + share(step) / fastest).recip();
        let even = |step: usize| slowest + share(step) * (fastest - slowest);
        let steep = |step: usize| slowest * (fastest / slowest).powf(share(step));
        let count = if slowest < fastest { SPEEDS } else { 0 };
        let mut speeds: Vec<f64> =
            (0..=count).flat_map(|step| [slow(step), even(step), steep(step)]).collect();
        speeds.iter_mut().for_each(|speed| *speed = speed.clamp(slowest, fastest));
        speeds.sort_by(f64::total_cmp);
        speeds.dedup();
        speeds.into_iter().map(|speed| self.stop.at(speed)).collect()
    }

    /// How many pixels the target moves in a second, at most, and where.
    #[must_use]
    pub fn pixels_per_s(&self, camera: &Camera) -> (f64, Decision) {
        self.most(|decision| self.pixels_per_s_at(camera, decision))
    }

    /// The same at one speed, the target as far as a decision says.
    #[must_use]
    pub fn pixels_per_s_at(&self, camera: &Camera, decision: &Decision) -> f64 {
        let [finest, _] = camera.pixel_angles_rad();
        let along = Motion::within(camera, decision.distance_m, self.bearing_rad(decision));
        along.blur_pixels(decision.closing_m_s, 1.0) + self.crossing_m_s / (finest * decision.distance_m)
    }

    /// How far the target moves across the line of sight in a second, at most, m.
    #[must_use]
    pub fn metres_per_s(&self, camera: &Camera) -> f64 {
        let of = |decision: &Decision| {
            let along = Motion::within(camera, decision.distance_m, self.bearing_rad(decision));
            along.blur_m(decision.closing_m_s, 1.0) + self.crossing_m_s
        };
        self.most(of).0
    }

    fn most(&self, of: impl Fn(&Decision) -> f64) -> (f64, Decision) {
        let swiftest = self.stop.swiftest();
        self.speeds().into_iter().fold((of(&swiftest), swiftest), |(most, where_to), decision| {
            let found = of(&decision);
            if found > most { (found, decision) } else { (most, where_to) }
        })
    }
}

/// The widest bearing there is.
const SIDEWAYS_RAD: f64 = std::f64::consts::FRAC_PI_2;

#[cfg(all(test, feature = "library"))]
mod tests {
    use super::*;
    use crate::instrument::presets;
    use crate::policy::stop::{Start, StopFigures};

    const STOP: StopFigures = StopFigures {
        speeds_m_s: [10.0 / 3.6, 60.0 / 3.6],
        target_m_s: 0.0,
        latency_s: 0.5,
        deceleration_m_s2: 7.0,
        margin_m: 0.0,
        start: None,
    };

    fn camera() -> Camera {
        let mut preset = presets::find("flir-boson-640-14mm").unwrap().clone();
        preset.figures.f_number = Some(1.0);
        preset.camera().unwrap().checked().unwrap()
    }

    /// The motion itself: a target at any place on its way, that walks either way, along or stands, step by step against what is said at most.
    #[test]
    fn no_target_on_its_way_moves_faster_than_said() {
        let camera = camera();
        let [finest, _] = camera.pixel_angles_rad();
        let half = 0.5 * camera.field_of_view_rad.unwrap();
        for (crossing, offset, along) in
            [(8.0 / 3.6, 1.0, 0.0), (1.4, 0.0, -1.4), (0.0, 0.5, 1.0), (3.0, 2.0, 0.0)]
        {
            let stop = Stop::new(StopFigures { target_m_s: along, ..STOP }).unwrap();
            let meets = Encounter::new(stop, crossing, offset).unwrap();
            let (most, _) = meets.pixels_per_s(&camera);
            let metres = meets.metres_per_s(&camera);
            let mut seen = [0.0f64; 2];
            for step in 0..=40 {
                let decision = stop.at(10.0 / 3.6 + f64::from(step) * (50.0 / 3.6) / 40.0);
                for place in 0..=20 {
                    let side = f64::from(place) / 20.0;
                    let (w, z) = (decision.closing_m_s, decision.distance_m);
                    let x = side * (crossing * z / w + offset);
                    if (x / z).atan() > half {
                        continue;
                    }
                    for walks in [-crossing, 0.0, crossing] {
                        let after = ((x + walks * 1e-5) / (z - w * 1e-5)).atan();
                        let turned = (after - (x / z).atan()).abs() / 1e-5;
                        seen[0] = seen[0].max(turned / finest);
                        seen[1] = seen[1].max(turned * x.hypot(z));
                    }
                }
            }
            assert!(
                seen[0] <= most * (1.0 + 1e-3) && seen[1] <= metres * (1.0 + 1e-3),
                "{seen:?} {most} {metres}"
            );
            // And it is no wild guess.
            assert!(seen[0] > 0.8 * most, "{seen:?} {most}");
        }
    }

    /// By hand: 5 km/h across 10 km/h is tan θ = ½ and b/z more; 32° of view hold it from 5/tan(16°) = 17.4 km/h on, were b none.
    #[test]
    fn a_slow_vehicle_looks_past_who_crosses() {
        let meets = Encounter::new(Stop::new(STOP).unwrap(), 5.0 / 3.6, 0.0).unwrap();
        assert!((meets.widest_rad() - 0.5f64.atan()).abs() < 1e-12);
        let from = meets.in_view_from_m_s(16f64.to_radians()).unwrap() * 3.6;
        assert!((from / 17.437 - 1.0).abs() < 1e-4, "{from}");
        assert_eq!(meets.in_view_from_m_s(0.07), None);
        assert!((meets.in_view_from_m_s(0.5).unwrap() * 3.6 - 10.0).abs() < 1e-9);
        // Half a metre beside, at 2.8 m from 10 km/h, is outside 16°; who stands there was inside from 0.5 m/tan(16°) = 1.74 m on: in time at 2.84 m.
        let beside = Encounter::new(Stop::new(STOP).unwrap(), 0.0, 2.0).unwrap();
        let slow = Stop::new(STOP).unwrap().decisions()[0];
        let left_m = 2.0 / 16f64.to_radians().tan();
        assert!((beside.decided_m(&slow, 16f64.to_radians()).unwrap() - left_m).abs() < 1e-12);
        assert!(
            left_m > slow.distance_m
                && beside.in_view_from_m_s(16f64.to_radians()).unwrap() * 3.6 < 10.0 + 1e-9
        );
        // Not where it comes into view after that.
        let late =
            Stop::new(StopFigures { start: Some(Start::Distance(6.0)), speeds_m_s: [10.0 / 3.6; 2], ..STOP })
                .unwrap();
        let late = Encounter::new(late, 0.0, 2.0).unwrap();
        assert_eq!(late.in_view_from_m_s(16f64.to_radians()), None);
        let half = Encounter::half_view_rad(&camera()).unwrap();
        let by_lens = (0.5f64 * 640.0 * 12e-6 / 14e-3).atan();
        assert!((half - by_lens.min(16f64.to_radians())).abs() < 1e-3, "{half}");
        assert!(Encounter::new(Stop::new(STOP).unwrap(), -1.0, 0.0).is_err());
        assert!(Encounter::new(Stop::new(STOP).unwrap(), 1.0, f64::NAN).is_err());
    }

    /// Whatever the speed in a range, however wide, the target moves no faster than the range says (to the steps of it).
    #[test]
    fn no_speed_of_a_range_is_faster_than_the_range() {
        let camera = camera();
        for (low, high) in [(0.033, 25.0), (0.00258, 2.37), (2.8, 16.7), (1.0, 1.1)] {
            for (crossing, offset, margin_m) in [(0.0, 3.0, 0.5), (2.2, 0.5, 0.0), (0.4, 1.0, 2.0)] {
                let of = |speeds_m_s: [f64; 2]| {
                    let figures = StopFigures { speeds_m_s, margin_m, ..STOP };
                    let meets = Encounter::new(Stop::new(figures).unwrap(), crossing, offset).unwrap();
                    [meets.pixels_per_s(&camera).0, meets.metres_per_s(&camera)]
                };
                let range = of([low, high]);
                for step in 0..=3000 {
                    let speed = low * (high / low).powf(f64::from(step) / 3000.0);
                    let one = of([speed.min(high); 2]);
                    assert!(
                        one.iter().zip(&range).all(|(one, range)| *one <= range * 1.002),
                        "{low} {high} {speed}: {one:?} {range:?}"
                    );
                }
            }
        }
    }
}
