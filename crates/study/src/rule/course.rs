//! What a camera has of a target moment by moment, while its vehicle comes nearer at one speed.
//!
//! At the distance z, z/w before contact (w closing speed, nobody brakes): pixels across the target, h/(z α); how far its picture moves while
//! all bands are exposed; the statistical distance over that demanded, in the scene that limits the clause, of the frames read last; and
//! how fast both still close in at contact if the decision stands no sooner. Nothing is told apart before the frames are read, which
//! begins where the target comes into view, nor while it is beside the picture.

use super::apart::{Candidate, TellApart};
use super::approach::Moving;
use super::cameras::Named;
use super::clauses::{Found, RuleAnswer};
use super::envelope::Sighted;
use super::results::{CameraVerdict, LimitingScene};
use super::{Kind, RuleStudy};
use hadar::error::Result;
use hadar::parallel;
use hadar::policy::encounter::Encounter;
use hadar::policy::stop::Decision;
use hadar::scene::State;
use hadar_scenario::Rule;
use hadar_scenario::rule::{Clause, Demand, StopSpec};

/// Moments of a course beside that of the decision.
const MOMENTS: usize = 60;
/// How much earlier than its first photon a course begins where nothing is said of the start.
const BEFORE: f64 = 1.25;
/// Side of a target of which nobody says how large it is, m.
const ONE_METRE: f64 = 1.0;

/// The cameras on their way to the decision of a clause, at one speed.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Course {
    /// The clause; none of a rule without clauses.
    pub clause: Option<String>,
    /// What the manoeuvre asks for at this speed.
    pub decision: Decision,
    /// Side of what the pixels are across, m.
    pub size_m: f64,
    /// Pixels that are demanded across it.
    pub demanded_pixels: Option<f64>,
    /// Whether the clause tells materials apart.
    pub tells_apart: bool,
    /// Every camera, in the order of the rule.
    pub cameras: Vec<CourseOfCamera>,
}

/// One camera on its way.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct CourseOfCamera {
    /// Its name.
    pub name: String,
    /// From far to near.
    pub moments: Vec<Moment>,
}

/// What there is at one distance.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Moment {
    /// Distance, m.
    pub distance_m: f64,
    /// Until contact if nobody brakes, s.
    pub to_contact_s: f64,
    /// How far beside the axis the target is at most, rad, where it is said how it crosses.
    pub bearing_rad: Option<f64>,
    /// Whether it is in the picture; `None` where that cannot be said.
    pub in_view: Option<bool>,
    /// Pixels across the target.
    pub pixels: f64,
    /// How far its picture moves while all bands are exposed, at most, pixels.
    pub blur_pixels: f64,
    /// Statistical distance over that demanded, in the limiting scene; `None` where no frames of it are read, or nothing is told apart.
    pub margin: Option<f64>,
    /// How fast both close in at contact if the decision stands no sooner, m s⁻¹.
    pub impact_m_s: f64,
}

/// Where a camera looks, and what it is looked for.
struct Looking<'a> {
    spec: &'a StopSpec,
    moving: Moving,
    decision: Decision,
    size_m: f64,
    named: &'a Named,
    bands: usize,
    half_view_rad: Option<f64>,
}

impl Looking<'_> {
    fn moments(&self, margin: &(dyn Fn(f64) -> Result<Option<f64>> + Sync)) -> Result<Vec<Moment>> {
        let Decision { distance_m, closing_m_s, start_m, .. } = self.decision;
        let needed_m = closing_m_s * self.named.camera.acquisition_s(self.bands);
        let from_m = start_m.unwrap_or(BEFORE * (distance_m + needed_m));
        let mut places: Vec<f64> =
            (0..MOMENTS).map(|step| from_m * (1.0 - step as f64 / MOMENTS as f64)).collect();
        places.push(distance_m);
        places.sort_by(|a, b| b.total_cmp(a));
        places.dedup();
        let read_m = start_m.map(|start_m| start_m - needed_m);
        parallel::try_map(places.len(), |place| self.moment(places[place], read_m, margin))
    }

    fn moment(
        &self,
        distance_m: f64,
        read_m: Option<f64>,
        margin: &dyn Fn(f64) -> Result<Option<f64>>,
    ) -> Result<Moment> {
        let here = self.decision.at_distance(distance_m);
        let bearing_rad = self.spec.encounter().map(|one| one.bearing_rad(&here));
        let in_view = bearing_rad.zip(self.half_view_rad).map(|(bearing, half)| bearing <= half);
        let [_, coarser_rad] = self.named.camera.pixel_angles_rad();
        let is_read = read_m.is_none_or(|read_m| distance_m <= read_m) && in_view != Some(false);
        Ok(Moment {
            distance_m,
            to_contact_s: distance_m / here.closing_m_s,
            bearing_rad,
            in_view,
            pixels: self.size_m / (distance_m * coarser_rad),
            blur_pixels: self.moving.blur_pixels_at(&here, &self.named.camera, self.bands),
            margin: if is_read { margin(distance_m)? } else { None },
            impact_m_s: self.spec.stop().impact_m_s(&here, distance_m),
        })
    }
}

impl RuleStudy {
    /// The course of every clause with a vehicle that stops: at its highest speed, and at its lowest where a camera does not see the target in time
    /// there; of an answer to this rule.
    ///
    /// # Errors
    /// A distance of which the air's table says nothing.
    pub fn courses(&self, answer: &RuleAnswer) -> Result<Vec<Course>> {
        let mut courses = Vec::new();
        for ((kind, clause), found) in self.clauses.iter().zip(&self.rule.clauses).zip(&answer.clauses) {
            let (Some(spec), Some(moving)) = (&clause.stop, Moving::of(clause)) else { continue };
            let [slowest, fastest] = spec.stop().decisions();
            let looking = kind.looking();
            let misses = |named: &Named| moving.out_of_view(&named.camera).is_some() && slowest != fastest;
            let slow = looking.iter().any(|(named, _)| misses(named)).then_some(slowest);
            for decision in std::iter::once(fastest).chain(slow) {
                let (size_m, demanded_pixels) = size(&self.rule, clause);
                let cameras = looking.iter().enumerate().map(|(index, (named, bands))| {
                    let looks = Looking {
                        spec,
                        moving,
                        decision,
                        size_m,
                        named,
                        bands: *bands,
                        half_view_rad: Encounter::half_view_rad(&named.camera),
                    };
                    let moments = match (kind, &found.found) {
                        (Kind::Apart(apart), Found::Apart(answer)) => {
                            looks.moments(&|z| apart.margin_at(index, &answer.cameras[index], z))?
                        }
                        _ => looks.moments(&|_| Ok(None))?,
                    };
                    Ok(CourseOfCamera { name: named.name.clone(), moments })
                });
                courses.push(Course {
                    clause: clause.name.clone(),
                    decision,
                    size_m,
                    demanded_pixels,
                    tells_apart: matches!(kind, Kind::Apart(_)),
                    cameras: cameras.collect::<Result<_>>()?,
                });
            }
        }
        Ok(courses)
    }
}

impl Kind {
    /// Every camera, with the number of bands that it reads.
    pub(super) fn looking(&self) -> Vec<(&Named, usize)> {
        match self {
            Self::Apart(apart) => apart.candidates.iter().map(Candidate::looking).collect(),
            Self::Resolution(clause) => clause.looking(),
            Self::Temperature(clause) => clause.looking(),
            Self::Depth(clause) => clause.looking(),
        }
    }
}

impl Candidate {
    fn looking(&self) -> (&Named, usize) {
        (&self.named, self.near.first().map_or(1, |study| study.bands.len()))
    }
}

impl TellApart {
    /// Statistical distance over that demanded in the limiting scene of a camera, from another distance.
    fn margin_at(&self, index: usize, verdict: &CameraVerdict, distance_m: f64) -> Result<Option<f64>> {
        let LimitingScene { target, alternative, temperature_k, lighting, surroundings_k, .. } =
            &verdict.limiting;
        let near = self.candidates.get(index).into_iter().flat_map(|candidate| &candidate.near);
        let Some(study) = near.into_iter().find(|study| study.target.name == *target) else {
            return Ok(None);
        };
        let seen = Sighted::new(study.at_distance(distance_m)?, &self.envelope)?;
        let Some(surface) = seen.study.alternatives.iter().find(|one| one.name == *alternative) else {
            return Ok(None);
        };
        let state = State {
            temperature_k: *temperature_k,
            lighting: lighting.clone(),
            gain: 1.0,
            environment_k: surroundings_k.clone(),
        };
        let own = &seen.study.target.emissivity;
        let found = seen.solver().with_counting(own, &surface.emissivity, &state, &seen.counting)?;
        Ok(Some(found.distance / self.required))
    }
}

/// Side of the target, m, and pixels that are demanded across it.
fn size(rule: &Rule, clause: &Clause) -> (f64, Option<f64>) {
    let demanded = |clause: &Clause| match clause.demand {
        Demand::Resolution { pixels, size_m } => Some((size_m, pixels)),
        _ => None,
    };
    if let Some((size_m, pixels)) = demanded(clause) {
        return (size_m, Some(pixels));
    }
    let of_rule = || rule.clauses.iter().find_map(demanded).map(|(size_m, _)| size_m);
    (clause.scenario.target.size_m.or_else(of_rule).unwrap_or(ONE_METRE), None)
}
