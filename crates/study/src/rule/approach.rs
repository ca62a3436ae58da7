//! What a camera sees while its vehicle comes nearer, until the decision must stand.
//!
//! The last of its frames is read when the vehicle is at the distance of the decision, z; the first, t_acq earlier, was
//! read from z + w t_acq (w closing speed). Every frame of it is taken from between, so that its statistical distance is at least
//! that of as many frames from the worst of these distances. Over a range of speeds both ends are farthest for the highest
//! one; frames must fit into the least time that any speed leaves.

use super::results::{ApproachResult, StopResult};
use crate::Shortfall;
use hadar::instrument::Camera;
use hadar::policy::Motion;
use hadar::policy::stop::Stop;
use hadar_scenario::rule::Clause;

/// Speed and distance at which the picture moves fastest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Moving {
    pub(super) speed_m_s: f64,
    pub(super) distance_m: Option<f64>,
}

impl Moving {
    /// Of a clause, from the least of its distances; `None` where no speed is demanded.
    pub(super) fn of(clause: &Clause) -> Option<Self> {
        match &clause.stop {
            Some(spec) => Some(Self::before(spec.stop())),
            None => clause.scenario.requirement.speed_m_s.map(|speed_m_s| Self {
                speed_m_s,
                distance_m: clause.envelope().distance_m.map(|[least, _]| least),
            }),
        }
    }

    fn before(stop: &Stop) -> Self {
        let swiftest = stop.swiftest();
        let speed_m_s = swiftest.speed_m_s.max(swiftest.closing_m_s);
        Self { speed_m_s, distance_m: Some(swiftest.distance_m) }
    }

    /// Pixels that the picture moves while all bands are exposed, at most; `None` without a distance.
    pub(super) fn blur_pixels(self, camera: &Camera, bands: usize) -> Option<f64> {
        let motion = Motion::of(camera, self.distance_m)?;
        Some(motion.blur_pixels(self.speed_m_s, camera.sweep_s(bands)))
    }

    /// How far it moves across the line of sight meanwhile, at most, in m at the target.
    pub(super) fn blur_m(self, camera: &Camera, bands: usize) -> Option<f64> {
        let motion = Motion::of(camera, self.distance_m)?;
        Some(motion.blur_m(self.speed_m_s, camera.sweep_s(bands)))
    }
}

/// A camera on its way to the decision.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Approach {
    /// From where it looks, the least first, m.
    pub(super) distance_m: [f64; 2],
    pub(super) result: ApproachResult,
}

impl Approach {
    /// Of a camera that reads so many bands.
    pub(super) fn of(stop: &Stop, camera: &Camera, bands: usize) -> Self {
        let [near, far] = stop.decisions();
        let needed_s = camera.acquisition_s(bands);
        let first_m = far.distance_m + far.closing_m_s * needed_s;
        // What needs more time than there is cannot look from before the start; that it is too slow is said elsewhere.
        let seen_from_m = far.start_m.map_or(first_m, |start_m| start_m.min(first_m));
        let time_s = stop.hastiest().and_then(|one| one.time_s);
        Self {
            distance_m: [near.distance_m, seen_from_m],
            result: ApproachResult {
                seen_from_m,
                needed_s,
                frames_needed: camera.frames,
                time_s,
                frames_within: time_s.map(|time_s| camera.frames_within(time_s, bands)),
                footprint_m: camera.footprint_m(far.distance_m),
            },
        }
    }

    /// Whether it has read its frames too late.
    pub(super) fn shortfall(&self) -> Option<Shortfall> {
        let late = self.result.frames_within.is_some_and(|frames| frames < self.result.frames_needed);
        late.then_some(Shortfall::DecisionTime)
    }
}

/// Whether a manoeuvre says how much time there is until the decision.
pub(super) fn is_timed(stop: Option<&Stop>) -> bool {
    stop.and_then(Stop::hastiest).is_some_and(|one| one.time_s.is_some())
}

/// What a manoeuvre spoils of a camera's frames, whatever they are for: they blur, or come too late.
pub(super) fn spoiled(
    moving: Option<Moving>,
    stop: Option<&Stop>,
    camera: &Camera,
    bands: usize,
) -> Vec<Shortfall> {
    let blur = moving.map(|moving| moving.blur_pixels(camera, bands));
    let blurred = match blur {
        Some(Some(blur)) if blur >= 1.0 => Some(Shortfall::MotionBlur),
        // What cannot be said is not met.
        Some(None) => Some(Shortfall::MotionUnknown),
        _ => None,
    };
    let late = stop.and_then(|stop| Approach::of(stop, camera, bands).shortfall());
    blurred.into_iter().chain(late).collect()
}

impl StopResult {
    /// What a manoeuvre asks of every camera.
    pub(super) fn of(stop: &Stop) -> Self {
        let [slowest, fastest] = stop.decisions();
        Self { slowest, fastest, hastiest: stop.hastiest(), swiftest: stop.swiftest() }
    }
}
