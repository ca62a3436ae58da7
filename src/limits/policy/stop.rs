//! Where and when a vehicle must have decided, so that it stops before it touches what is ahead.
//!
//! A vehicle of speed v closes in on a target that moves along the same way at u (away from it above 0, towards it below):
//! closing speed w = v − u. After a decision nothing happens for the latency t_l; then it brakes at a, until it no longer
//! closes in (u ≥ 0) or stands (u < 0), for t_b = min(v, w)/a. The decision must stand at the distance
//!
//! z = w t_l + w t_b − ½ a t_b² + m     (m a margin that must be left)
//!
//! and, where the target comes into view at the distance z₀ or at the time z₀/w before contact, no later than (z₀ − z)/w after.
//! A fast vehicle decides farther away, and sooner: over a range of speeds v₁ ≤ v ≤ v₂
//!
//! * z grows with v, since z′ ≥ t_l + (v − max(u, 0))/a > 0;
//! * (z₀ − z)/w has its least value at an end: from a distance z₀ it falls; from a time to contact it is the sum of a line,
//!   −v/2a, and of a hyperbola in w, so that it is concave or falls;
//! * max(v, w)/z, by which the picture moves, grows until v² = 2a(m − u t_l) + u² (u ≥ 0), or (v + |u|)² = 2am − u² (u < 0), and falls
//!   from there.
//!
//! Assumptions: a straight way, constant speeds, full deceleration as soon as the latency is over; the latency holds all that
//! is between the last photon and the brakes. Units: m, s, m s⁻¹, m s⁻².
//!
//! Source: uniformly decelerated motion. Used like this in 49 CFR 571.127 (start of a run at 4.0 s times the closing speed) and
//! ISO 3691-4 (a truck stops within the range of its personnel detection).

use crate::error::{Error, Result, check};

/// A manoeuvre that ends before contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stop {
    speeds_m_s: [f64; 2],
    target_m_s: f64,
    latency_s: f64,
    deceleration_m_s2: f64,
    margin_m: f64,
    start: Option<Start>,
}

/// Where the target comes into view.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Start {
    /// So long before contact, s.
    TimeToContact(f64),
    /// At that distance, m.
    Distance(f64),
}

/// What a manoeuvre asks for at one speed.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Decision {
    /// Speed of the vehicle, m s⁻¹.
    pub speed_m_s: f64,
    /// Speed at which vehicle and target approach, m s⁻¹.
    pub closing_m_s: f64,
    /// Distance at which the decision is due, m.
    pub distance_m: f64,
    /// Distance at which the target comes into view, m; `None` if nothing is said of it.
    pub start_m: Option<f64>,
    /// Time from then until the decision is due, s.
    pub time_s: Option<f64>,
}

/// Figures of a manoeuvre, as they are said; [`Stop::new`] checks them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StopFigures {
    /// Speeds of the vehicle, least first, m s⁻¹; above 0.
    pub speeds_m_s: [f64; 2],
    /// Speed of the target along the vehicle's way, m s⁻¹; above 0 away from it. Below the least speed.
    pub target_m_s: f64,
    /// From the last photon to the brakes, s; 0 or above.
    pub latency_s: f64,
    /// Deceleration, m s⁻²; above 0.
    pub deceleration_m_s2: f64,
    /// Distance that must be left, m; 0 or above.
    pub margin_m: f64,
    /// Where the target comes into view, if that is limited.
    pub start: Option<Start>,
}

impl Decision {
    /// The same with the decision elsewhere.
    #[must_use]
    pub fn at_distance(self, distance_m: f64) -> Self {
        Self { distance_m, ..self }
    }
}

impl Stop {
    /// Checks and takes the figures.
    ///
    /// # Errors
    /// A figure out of its range; a target that is as fast as the vehicle; a start that is no farther than the stop.
    ///
    /// ```
    /// use hadar::policy::stop::{Start, Stop, StopFigures};
    /// // 60 km/h, 0.5 s, 5 m/s², in view 4 s before contact: decided at 36.1 m, 1.83 s later.
    /// let stop = Stop::new(StopFigures {
    ///     speeds_m_s: [60.0 / 3.6; 2],
    ///     target_m_s: 0.0,
    ///     latency_s: 0.5,
    ///     deceleration_m_s2: 5.0,
    ///     margin_m: 0.0,
    ///     start: Some(Start::TimeToContact(4.0)),
    /// })?;
    /// let [decision, _] = stop.decisions();
    /// assert!((decision.distance_m / 36.11 - 1.0).abs() < 1e-3);
    /// assert!((decision.time_s.unwrap() / 1.8333 - 1.0).abs() < 1e-4);
    /// # Ok::<(), hadar::Error>(())
    /// ```
    pub fn new(figures: StopFigures) -> Result<Self> {
        let StopFigures { speeds_m_s, target_m_s, latency_s, deceleration_m_s2, margin_m, start } = figures;
        let [slowest, fastest] = speeds_m_s;
        check::positive("speed", slowest, "m/s")?;
        check::finite("speed", fastest, "m/s")?;
        if fastest < slowest {
            return Err(Error::out_of_range("highest speed", fastest, "m/s", "at least the lowest one"));
        }
        check::finite("speed of the target", target_m_s, "m/s")?;
        if target_m_s >= slowest {
            let expected = "below the speed of the vehicle, which else never closes in";
            return Err(Error::out_of_range("speed of the target", target_m_s, "m/s", expected));
        }
        check::non_negative("latency", latency_s, "s")?;
        check::positive("deceleration", deceleration_m_s2, "m/s^2")?;
        check::non_negative("margin", margin_m, "m")?;
        match start {
            Some(Start::TimeToContact(time_s)) => check::positive("time to contact", time_s, "s")?,
            Some(Start::Distance(start_m)) => check::positive("start", start_m, "m")?,
            None => 0.0,
        };
        let stop = Self { speeds_m_s, target_m_s, latency_s, deceleration_m_s2, margin_m, start };
        for decision in stop.decisions() {
            check::positive("distance of the decision", decision.distance_m, "m")?;
            if let Some((start_m, time_s)) = decision.start_m.zip(decision.time_s)
                && (time_s <= 0.0 || time_s.is_nan())
            {
                let expected = format!(
                    "farther than the {:.4} m in which the vehicle stops from {:.4} m/s",
                    decision.distance_m, decision.speed_m_s
                );
                return Err(Error::out_of_range("start", start_m, "m", expected));
            }
        }
        Ok(stop)
    }

    /// What it asks for at the lowest and the highest speed: the least and the greatest distance of a decision.
    #[must_use]
    pub fn decisions(&self) -> [Decision; 2] {
        self.speeds_m_s.map(|speed| self.at(speed))
    }

    /// The one that leaves the least time; `None` where the start is not limited.
    #[must_use]
    pub fn hastiest(&self) -> Option<Decision> {
        let [slow, fast] = self.decisions();
        let (slow_s, fast_s) = slow.time_s.zip(fast.time_s)?;
        Some(if slow_s < fast_s { slow } else { fast })
    }

    /// The one from which the picture moves fastest, by the vehicle's speed or by the closing speed, if that is larger.
    #[must_use]
    pub fn swiftest(&self) -> Decision {
        let [slowest, fastest] = self.speeds_m_s;
        let (a, m, u) = (self.deceleration_m_s2, self.margin_m, self.target_m_s);
        let turn = match u >= 0.0 {
            true => (2.0 * a * (m - u * self.latency_s) + u * u).max(0.0).sqrt(),
            false => (2.0 * a * m - u * u).max(0.0).sqrt() + u,
        };
        self.at(turn.clamp(slowest, fastest))
    }

    /// How fast both close in when they touch, the decision of one speed standing no sooner than `decided_m` before, m s⁻¹; 0 where the
    /// vehicle stands by then, or no longer closes in.
    ///
    /// ```
    /// use hadar::policy::stop::{Stop, StopFigures};
    /// let stop = Stop::new(StopFigures {
    ///     speeds_m_s: [10.0; 2],
    ///     target_m_s: 0.0,
    ///     latency_s: 0.5,
    ///     deceleration_m_s2: 5.0,
    ///     margin_m: 0.0,
    ///     start: None,
    /// })?;
    /// let [decision, _] = stop.decisions();
    /// // 15 m are needed. Of 11.4 m the latency takes 5, and 100 − 2 · 5 · 6.4 = 36 = 6².
    /// assert_eq!(stop.impact_m_s(&decision, 15.0), 0.0);
    /// assert!((stop.impact_m_s(&decision, 11.4) - 6.0).abs() < 1e-12);
    /// assert_eq!(stop.impact_m_s(&decision, 5.0), 10.0);
    /// # Ok::<(), hadar::Error>(())
    /// ```
    #[must_use]
    pub fn impact_m_s(&self, decision: &Decision, decided_m: f64) -> f64 {
        let closing = decision.closing_m_s;
        let gap_m = (decided_m - closing * self.latency_s).max(0.0);
        let squared = closing * closing - 2.0 * self.deceleration_m_s2 * gap_m;
        // A target that comes nearer may reach a vehicle that stands by then.
        let standing = (-self.target_m_s).max(0.0);
        let rounding = 1e-12 * closing * closing;
        if squared <= standing * standing + rounding { 0.0 } else { squared.sqrt() }
    }

    /// At a speed of the range; of others as if they were in it.
    #[must_use]
    pub fn at(&self, speed_m_s: f64) -> Decision {
        let closing_m_s = speed_m_s - self.target_m_s;
        let brake_s = speed_m_s.min(closing_m_s) / self.deceleration_m_s2;
        // Of the braking, the mean of the closing speeds at its begin and its end.
        let mean_m_s = closing_m_s - 0.5 * speed_m_s.min(closing_m_s);
        let distance_m = closing_m_s * self.latency_s + mean_m_s * brake_s + self.margin_m;
        let start_m = self.start.map(|start| match start {
            Start::TimeToContact(time_s) => time_s * closing_m_s,
            Start::Distance(start_m) => start_m,
        });
        let time_s = start_m.map(|start_m| (start_m - distance_m) / closing_m_s);
        Decision { speed_m_s, closing_m_s, distance_m, start_m, time_s }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NIGHT: StopFigures = StopFigures {
        speeds_m_s: [60.0 / 3.6; 2],
        target_m_s: 0.0,
        latency_s: 0.5,
        deceleration_m_s2: 5.0,
        margin_m: 0.0,
        start: Some(Start::TimeToContact(4.0)),
    };

    fn close(a: f64, b: f64, relative: f64) -> bool {
        (a - b).abs() <= relative * b.abs()
    }

    /// By hand: 16.667 m/s · 0.5 s + (16.667 m/s)²/(2 · 5 m/s²) = 8.333 m + 27.778 m; 4 s − 2.1667 s.
    #[test]
    fn sixty_kilometres_an_hour() {
        let stop = Stop::new(NIGHT).unwrap();
        let [decision, same] = stop.decisions();
        assert_eq!(decision, same);
        assert!(close(decision.distance_m, 8.0 + 1.0 / 3.0 + 27.0 + 7.0 / 9.0, 1e-15));
        assert!(close(decision.time_s.unwrap(), 11.0 / 6.0, 1e-15));
        assert!(close(decision.start_m.unwrap(), 200.0 / 3.0, 1e-15));
    }

    /// A pedestrian who walks along: only the closing speed must go. One who comes: until the vehicle stands, and they walked on.
    #[test]
    fn targets_that_move_along() {
        let walk = 5.0 / 3.6;
        let along = Stop::new(StopFigures { target_m_s: walk, ..NIGHT }).unwrap().decisions()[0];
        let w: f64 = 55.0 / 3.6;
        assert!(close(along.distance_m, 0.5 * w + w * w / 10.0, 1e-14));
        let comes = Stop::new(StopFigures { target_m_s: -walk, ..NIGHT }).unwrap().decisions()[0];
        let (v, w): (f64, f64) = (60.0 / 3.6, 65.0 / 3.6);
        // The vehicle's own stop, and the walk until then.
        assert!(close(comes.distance_m, 0.5 * w + v * v / 10.0 + walk * v / 5.0, 1e-14));
        assert!(close(comes.closing_m_s, w, 1e-15));
    }

    /// The motion itself, step by step, leaves just the margin.
    #[test]
    fn a_vehicle_that_decides_there_stops_with_its_margin() {
        for target_m_s in [0.0, 1.4, -1.4, -6.0] {
            let figures = StopFigures { target_m_s, margin_m: 1.5, speeds_m_s: [3.0, 20.0], ..NIGHT };
            for decision in Stop::new(figures).unwrap().decisions() {
                let (mut gap, mut v, mut time, step) = (decision.distance_m, decision.speed_m_s, 0.0, 1e-5);
                while v > target_m_s.max(0.0) {
                    gap -= (v - target_m_s) * step;
                    time += step;
                    v -= if time > 0.5 { 5.0 * step } else { 0.0 };
                }
                assert!((gap - 1.5).abs() < 2e-3, "{target_m_s} {decision:?} leaves {gap}");
            }
        }
    }

    /// The motion itself, step by step, from anywhere nearer.
    #[test]
    fn a_vehicle_that_decides_later_touches_as_fast_as_said() {
        for target_m_s in [0.0, 1.4, -1.4, -6.0] {
            let stop = Stop::new(StopFigures { target_m_s, speeds_m_s: [12.0; 2], ..NIGHT }).unwrap();
            let decision = stop.decisions()[0];
            for share in [0.05, 0.2, 0.45, 0.7, 0.95, 1.05] {
                let (mut gap, mut v, mut time, step) = (share * decision.distance_m, 12.0, 0.0, 1e-5);
                while gap > 0.0 && v > target_m_s.max(0.0) {
                    gap -= (v - target_m_s) * step;
                    time += step;
                    v -= if time > 0.5 { 5.0 * step } else { 0.0 };
                }
                let touched = if gap > 0.0 { 0.0 } else { v - target_m_s };
                let said = stop.impact_m_s(&decision, share * decision.distance_m);
                assert!(
                    (said - touched).abs() < 2e-3 * (1.0 + touched),
                    "{target_m_s} {share} {said} {touched}"
                );
            }
        }
    }

    /// Against every speed between: distance, time and v/z are extreme where it is said.
    #[test]
    fn the_worst_speeds_of_a_range() {
        for target_m_s in [0.0, 0.9, -1.4, -8.0] {
            for margin_m in [0.0, 0.3, 6.0] {
                for start in [Start::TimeToContact(6.0), Start::Distance(90.0)] {
                    let speeds_m_s = [10.0 / 3.6, 65.0 / 3.6];
                    let figures =
                        StopFigures { speeds_m_s, target_m_s, margin_m, start: Some(start), ..NIGHT };
                    let Ok(stop) = Stop::new(figures) else { continue };
                    let [slow, fast] = stop.decisions();
                    let swiftest = stop.swiftest();
                    let pace = |one: &Decision| one.speed_m_s.max(one.closing_m_s) / one.distance_m;
                    let quickest = pace(&swiftest);
                    for step in 0..=1000 {
                        let at = stop.at(10.0 / 3.6 + f64::from(step) * (55.0 / 3.6) / 1000.0);
                        assert!(at.distance_m >= slow.distance_m * (1.0 - 1e-14));
                        assert!(at.distance_m <= fast.distance_m * (1.0 + 1e-14));
                        let least = stop.hastiest().unwrap().time_s.unwrap();
                        assert!(at.time_s.unwrap() >= least * (1.0 - 1e-12), "{figures:?}");
                        assert!(pace(&at) <= quickest * (1.0 + 1e-12), "{figures:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn what_cannot_be_is_refused() {
        let refused = |figures: StopFigures, what: &str| {
            let error = Stop::new(figures).unwrap_err().to_string();
            assert!(error.contains(what), "{error}");
        };
        refused(StopFigures { latency_s: -0.1, ..NIGHT }, "latency");
        refused(StopFigures { deceleration_m_s2: 0.0, ..NIGHT }, "deceleration");
        refused(StopFigures { margin_m: -1.0, ..NIGHT }, "margin");
        refused(StopFigures { speeds_m_s: [0.0, 3.0], ..NIGHT }, "speed");
        refused(StopFigures { speeds_m_s: [3.0, 2.0], ..NIGHT }, "highest speed");
        refused(StopFigures { target_m_s: 17.0, ..NIGHT }, "speed of the target");
        refused(StopFigures { start: Some(Start::Distance(36.0)), ..NIGHT }, "farther than the 36.1111 m");
        refused(StopFigures { start: Some(Start::TimeToContact(2.1)), ..NIGHT }, "start");
        refused(StopFigures { start: Some(Start::TimeToContact(f64::NAN)), ..NIGHT }, "time to contact");
        refused(StopFigures { deceleration_m_s2: 1e-320, ..NIGHT }, "distance of the decision");
    }
}
