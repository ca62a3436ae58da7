//! What a camera sees while its vehicle comes nearer, until the decision must stand.
//!
//! The last of its frames is read when the vehicle is at the distance of the decision, z; the first, t_acq earlier, was
//! read from z + w t_acq (w closing speed). Every frame of it is taken from between, so that its statistical distance is at least
//! that of as many frames from the worst of these distances. Over a range of speeds both ends are farthest for the highest
//! one; frames must fit into the least time that any speed leaves.

use super::results::{ApproachResult, CrossingResult, StopResult};
use crate::Shortfall;
use crate::condition::Condition;
use hadar::instrument::Camera;
use hadar::policy::Motion;
use hadar::policy::encounter::Encounter;
use hadar::policy::stop::Decision;
use hadar_scenario::rule::{Clause, StopSpec};

/// Speed and distance at which the picture moves fastest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Moving {
    pub(super) speed_m_s: f64,
    pub(super) distance_m: Option<f64>,
    /// Highest speed, m s⁻¹.
    pub(super) fastest_m_s: f64,
    /// The target's own way across, where it is said.
    pub(super) encounter: Option<Encounter>,
}

impl Moving {
    /// Of a clause, from the least of its distances; `None` where no speed is demanded.
    pub(super) fn of(clause: &Clause) -> Option<Self> {
        match &clause.stop {
            Some(spec) => {
                let pace = |one: Decision| one.speed_m_s.max(one.closing_m_s);
                let swiftest = spec.stop().swiftest();
                Some(Self {
                    speed_m_s: pace(swiftest),
                    distance_m: Some(swiftest.distance_m),
                    fastest_m_s: pace(spec.stop().decisions()[1]),
                    encounter: spec.encounter().copied(),
                })
            }
            None => clause.scenario.requirement.speed_m_s.map(|speed_m_s| Self {
                speed_m_s,
                distance_m: clause.envelope().distance_m.map(|[least, _]| least),
                fastest_m_s: speed_m_s,
                encounter: None,
            }),
        }
    }

    /// Pixels that the picture moves in a second, at most; `None` without a distance.
    fn pixels_per_s(self, camera: &Camera) -> Option<f64> {
        match self.encounter {
            Some(encounter) => Some(encounter.pixels_per_s(camera).0),
            None => Some(Motion::of(camera, self.distance_m)?.blur_pixels(self.speed_m_s, 1.0)),
        }
    }

    /// The same while all bands are exposed.
    pub(super) fn blur_pixels(self, camera: &Camera, bands: usize) -> Option<f64> {
        Some(self.pixels_per_s(camera)? * camera.sweep_s(bands))
    }

    /// The same of one speed, the target as far as a decision says.
    pub(super) fn blur_pixels_at(self, here: &Decision, camera: &Camera, bands: usize) -> f64 {
        let per_s = match self.encounter {
            Some(encounter) => encounter.pixels_per_s_at(camera, here),
            None => {
                let pace_m_s = here.speed_m_s.max(here.closing_m_s);
                Motion::of(camera, Some(here.distance_m))
                    .map_or(0.0, |motion| motion.blur_pixels(pace_m_s, 1.0))
            }
        };
        per_s * camera.sweep_s(bands)
    }

    /// How long the picture moves by less than a pixel, s.
    pub(super) fn sharp_s(self, camera: &Camera) -> Option<f64> {
        self.pixels_per_s(camera).map(f64::recip)
    }

    /// How far the target moves across the line of sight while so many bands are exposed, at most, at any speed, m.
    pub(super) fn smear_m(self, camera: &Camera, bands: usize) -> Option<f64> {
        let per_s = match self.encounter {
            Some(encounter) => encounter.metres_per_s(camera),
            None => Motion::of(camera, self.distance_m)?.blur_m(self.fastest_m_s, 1.0),
        };
        Some(per_s * camera.sweep_s(bands))
    }

    /// That the target is not in the view in time, if so; who does not cross is taken to stay in it.
    pub(super) fn out_of_view(self, camera: &Camera) -> Option<Shortfall> {
        let (encounter, half_view_rad) = (self.encounter?, Encounter::half_view_rad(camera)?);
        let seen = |decision: &Decision| encounter.decided_m(decision, half_view_rad).is_some();
        (!encounter.speeds().iter().all(seen)).then_some(Shortfall::OutOfView)
    }

    /// What nobody stated of where the target is in the picture.
    pub(super) fn conditions(self, camera: &Camera) -> Option<Condition> {
        match self.encounter {
            None => Some(Condition::NobodyCrosses),
            Some(encounter) => {
                let bearing_rad = encounter.widest_rad();
                Encounter::half_view_rad(camera).is_none().then_some(Condition::InView { bearing_rad })
            }
        }
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
    pub(super) fn of(spec: &StopSpec, camera: &Camera, bands: usize) -> Self {
        let stop = spec.stop();
        let [near, far] = stop.decisions();
        let needed_s = camera.acquisition_s(bands);
        let half_view_rad = Encounter::half_view_rad(camera);
        // Who leaves the view before is decided about before.
        let seen = spec.encounter().zip(half_view_rad).map(|(encounter, half_view_rad)| {
            let decided = |one: Decision| Some((one, encounter.decided_m(&one, half_view_rad)?));
            encounter.speeds().into_iter().filter_map(decided).collect::<Vec<_>>()
        });
        let first = |decision: &Decision, decided_m: f64| {
            let first_m = decided_m + decision.closing_m_s * needed_s;
            // What needs more time than there is cannot look from before the start; that it is too slow is said elsewhere.
            decision.start_m.map_or(first_m, |start_m| start_m.min(first_m))
        };
        let of_view = seen.iter().flatten().map(|(decision, decided_m)| first(decision, *decided_m));
        let seen_from_m = of_view.fold(first(&far, far.distance_m), f64::max);
        let left = |(decision, decided_m): &(Decision, f64)| {
            Some((decision.start_m? - decided_m) / decision.closing_m_s)
        };
        let of_view = seen.iter().flatten().filter_map(left).reduce(f64::min);
        let time_s = stop
            .hastiest()
            .and_then(|one| one.time_s)
            .map(|time_s| of_view.map_or(time_s, |of_view| time_s.min(of_view)));
        Self {
            distance_m: [near.distance_m, seen_from_m],
            result: ApproachResult {
                seen_from_m,
                needed_s,
                frames_needed: camera.frames,
                time_s,
                frames_within: time_s.map(|time_s| camera.frames_within(time_s, bands)),
                footprint_m: camera.footprint_m(far.distance_m),
                in_view_from_m_s: spec.encounter().zip(half_view_rad).and_then(
                    |(encounter, half_view_rad)| {
                        let seen = encounter.in_view_from_m_s(half_view_rad);
                        (seen != Some(near.speed_m_s)).then_some(seen)
                    },
                ),
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
pub(super) fn is_timed(stop: Option<&StopSpec>) -> bool {
    stop.and_then(|spec| spec.stop().hastiest()).is_some_and(|one| one.time_s.is_some())
}

/// What a manoeuvre spoils of a camera's frames, whatever they are for: they blur, or come too late.
pub(super) fn spoiled(
    moving: Option<Moving>,
    stop: Option<&StopSpec>,
    camera: &Camera,
    bands: usize,
) -> Vec<Shortfall> {
    let blur = moving.map(|moving| moving.blur_pixels(camera, bands));
    let outside = moving.and_then(|moving| moving.out_of_view(camera));
    let blurred = match blur {
        Some(Some(blur)) if blur >= 1.0 => Some(Shortfall::MotionBlur),
        // What cannot be said is not met.
        Some(None) => Some(Shortfall::MotionUnknown),
        _ => None,
    };
    let late = stop.and_then(|stop| Approach::of(stop, camera, bands).shortfall());
    blurred.into_iter().chain(outside).chain(late).collect()
}

impl StopResult {
    /// What a manoeuvre asks of every camera.
    pub(super) fn of(spec: &StopSpec) -> Self {
        let stop = spec.stop();
        let [slowest, fastest] = stop.decisions();
        let crossing = spec.encounter().map(|one| CrossingResult {
            speed_m_s: one.crossing_m_s(),
            offset_m: one.offset_m(),
            bearing_rad: one.widest_rad(),
        });
        Self { slowest, fastest, hastiest: stop.hastiest(), swiftest: stop.swiftest(), crossing }
    }
}
