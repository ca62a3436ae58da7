//! The margin of a camera that tells materials apart, taken anew with other figures: what `uncertainty` asks for.

use super::apart::{Candidate, TellApart};
use super::approach::Approach;
use super::envelope::{Estimate, SCENES, Sighted};
use super::pairs::Searched;
use super::uncertainty::{Anew, Errors, MarginUncertainty, SMALLER, Uncertain};
use crate::Study;
use crate::size::sensitivity::{linear, ripple::Ripple, scatter::Scatter};
use hadar::error::{Place, Result};
use hadar::identifiability::nearest::NearestSolver;
use hadar::instrument::Camera;
use hadar::parallel;
use hadar::policy::{Quantity, Solution};
use hadar::scene::State;
use rand::SeedableRng;
use rand::rngs::ChaCha8Rng;
use std::borrow::Cow;
use std::sync::{PoisonError, RwLock};

const SEED: u64 = 1;

/// A scene in which a margin is taken anew.
pub(super) struct Scene {
    sighted: Sighted,
    alternative: usize,
    state: State,
}

impl Scene {
    /// A figure of the camera solved for in it; `None` where it has none.
    pub(super) fn solved(
        &self,
        rule: &TellApart,
        candidate: &Candidate,
        camera: &Camera,
        quantity: Quantity,
    ) -> Result<Option<Solution>> {
        let distance_m = rule.seen_from_m(candidate, &self.sighted, camera);
        let mut study = self.sighted.before(camera, distance_m, &rule.envelope)?.study;
        study.state = self.state.clone();
        let surface = study.alternatives[self.alternative].clone();
        let mut found = study.solutions_of(camera, &surface, &[quantity])?.0;
        Ok(found.pop().map(|(_, solution)| solution))
    }

    /// Whether another is the same.
    fn is_like(&self, other: &Self) -> bool {
        let place = |scene: &Self| scene.sighted.study.scenario.target.distance_m;
        let target = |scene: &Self| scene.sighted.study.target.name.clone();
        self.alternative == other.alternative
            && self.state == other.state
            && (place(self), target(self)) == (place(other), target(other))
    }
}

impl TellApart {
    /// How well the margin of a camera is known, in its worst scene `at` and in those of other pairs that come `near` it.
    pub(super) fn guarded(
        &self,
        uncertain: &Uncertain<'_>,
        candidate: &Candidate,
        worst: &Searched,
        near: Vec<Estimate>,
        at: &Study,
    ) -> Result<MarginUncertainty> {
        let distance = worst.pair.distance;
        let scenes = self.scenes(candidate, worst, near);
        let ripple = self
            .scenario
            .sensitivity
            .map(|spec| Ripple::new(at.bands.nodes_cm1(), spec.emissivity_error, spec.correlation_cm1))
            .map(Scatter::Ripple);
        let emissivities = match (self.scenario.sensitivity, &ripple, scenes.first()) {
            (Some(spec), Some(ripple), Some(own)) => {
                let surface = &at.alternatives[worst.pair.alternative];
                let (nearest, counting) = (&worst.pair.nearest, &own.sighted.counting);
                let sigma = linear::sigma(at, surface, nearest, counting, distance, [ripple, ripple]);
                Some((spec.emissivity_error, sigma / self.required))
            }
            _ => None,
        };
        let anew = Scenes { clause: self, candidate, ripple, known: RwLock::new(scenes) };
        for camera in uncertain.ends()? {
            anew.search(&camera)?;
        }
        uncertain.of_margin(distance / self.required, emissivities, &anew)
    }

    /// What is uncertain of a camera, if anything is.
    pub(super) fn uncertain<'a>(
        &self,
        candidate: &Candidate,
        place: &'a (dyn Fn(&str) -> Place + Sync),
    ) -> Result<Option<Uncertain<'a>>> {
        let emissivities = self.scenario.sensitivity.is_some();
        Uncertain::of(&candidate.named, (self.rule.coverage_factor, emissivities), place)
    }

    /// The scenes in which a margin is taken anew: the worst one, and those of other pairs that come near it.
    fn scenes(&self, candidate: &Candidate, worst: &Searched, near: Vec<Estimate>) -> Vec<Scene> {
        let own = worst.between.as_deref().unwrap_or(&candidate.sighted[worst.pair.sighted]);
        let mut scenes = vec![Scene {
            sighted: own.clone(),
            alternative: worst.pair.alternative,
            state: worst.pair.state.clone(),
        }];
        let others = near
            .into_iter()
            .filter(|pair| (pair.sighted, pair.alternative) != (worst.pair.sighted, worst.pair.alternative));
        scenes.extend(others.map(|pair| Scene {
            sighted: candidate.sighted[pair.sighted].clone(),
            alternative: pair.alternative,
            state: pair.state,
        }));
        scenes
    }

    /// The worst of a few scenes before a camera ([`Candidate::estimates`]), and its distance.
    pub(super) fn worst_of(
        &self,
        candidate: &Candidate,
        known: &[Estimate],
        scenes: [Option<usize>; 2],
        camera: &Camera,
    ) -> Result<Option<(Scene, f64)>> {
        let seen = |index: usize| {
            let sighted = &candidate.sighted[index];
            let from_m = self.seen_from_m(candidate, sighted, camera);
            Ok(Cow::Owned(sighted.before(camera, from_m, &self.envelope)?))
        };
        let estimates = candidate.estimates(known, scenes, seen)?;
        let worst = estimates.into_iter().min_by(|a, b| a.distance.total_cmp(&b.distance));
        Ok(worst.map(|Estimate { sighted, alternative, state, distance, .. }| {
            (Scene { sighted: candidate.sighted[sighted].clone(), alternative, state }, distance)
        }))
    }

    /// The distance of a scene; of one from where the first frame is taken, where the camera takes it now.
    fn seen_from_m(&self, candidate: &Candidate, sighted: &Sighted, camera: &Camera) -> Option<f64> {
        let own = sighted.study.scenario.target.distance_m;
        let farthest = candidate.distance_m.map(|[_, most]| most);
        match self.stop.as_ref() {
            Some(spec) if own == farthest => {
                Some(Approach::of(spec, camera, sighted.study.bands.len()).distance_m[1])
            }
            _ => own,
        }
    }

    /// The worst of all scenes before a camera, searched as that of the camera as it is stated is.
    fn worst_before(&self, candidate: &Candidate, camera: &Camera) -> Result<Option<(Scene, f64)>> {
        let mut moved = candidate.clone();
        for sighted in moved.sighted.iter_mut().chain(&mut moved.between) {
            *sighted =
                sighted.before(camera, self.seen_from_m(candidate, sighted, camera), &self.envelope)?;
        }
        let Some((worst, _)) = self.worst(&moved, false, &|_, _| true, &|_| ())? else { return Ok(None) };
        let Searched { pair, between, .. } = worst;
        let distance = pair.distance;
        let own = candidate.sighted.get(pair.sighted).cloned();
        let sighted = between.map(|between| *between).or(own);
        Ok(sighted
            .map(|sighted| (Scene { sighted, alternative: pair.alternative, state: pair.state }, distance)))
    }
}

/// The scenes before one camera in which its margin is taken anew.
struct Scenes<'a> {
    clause: &'a TellApart,
    candidate: &'a Candidate,
    ripple: Option<Scatter<'a>>,
    known: RwLock<Vec<Scene>>,
}

impl Anew for Scenes<'_> {
    fn margin(&self, camera: &Camera, errors: Errors) -> Result<f64> {
        let known = self.known.read().unwrap_or_else(PoisonError::into_inner);
        let mut in_each = known.iter().map(|scene| self.in_scene(scene, camera, errors, None));
        in_each.try_fold(f64::INFINITY, |least, margin| Ok(least.min(margin?)))
    }

    fn margins(&self, draws: &[Option<Camera>], random: bool, since: usize) -> Result<(Vec<f64>, usize)> {
        let known = self.known.read().unwrap_or_else(PoisonError::into_inner);
        let mut least = vec![f64::INFINITY; draws.len()];
        for scene in known.iter().skip(since) {
            let solver = || scene.sighted.solver();
            let of = |solver: &mut NearestSolver<'_>, index: usize| match &draws[index] {
                Some(camera) => self.in_scene(scene, camera, Errors::of_draw(index, random), Some(solver)),
                None => Ok(f64::INFINITY),
            };
            let found = parallel::try_map_with(draws.len(), solver, of)?;
            least.iter_mut().zip(found).for_each(|(least, found)| *least = least.min(found));
        }
        Ok((least, known.len()))
    }

    fn search(&self, camera: &Camera) -> Result<bool> {
        let found = self.clause.worst_of(self.candidate, &[], [Some(SCENES); 2], camera)?;
        self.learn(found, camera)
    }

    fn search_thoroughly(&self, camera: &Camera) -> Result<bool> {
        self.learn(self.clause.worst_before(self.candidate, camera)?, camera)
    }
}

impl Scenes<'_> {
    /// The margin of a camera in one scene; `solver` is one of the scene as the camera that is stated sees it, which serves where the bands are
    /// the same.
    fn in_scene(
        &self,
        scene: &Scene,
        camera: &Camera,
        errors: Errors,
        solver: Option<&mut NearestSolver<'_>>,
    ) -> Result<f64> {
        let Scene { sighted: stated, alternative, state } = scene;
        let distance_m = self.clause.seen_from_m(self.candidate, stated, camera);
        let sighted = stated.before(camera, distance_m, &self.clause.envelope)?;
        let pair = [&sighted.study.target, &sighted.study.alternatives[*alternative]];
        let pair: [Vec<f64>; 2] = match (errors, &self.ripple) {
            (Errors::Stream(stream), Some(ripple)) => {
                let mut random = ChaCha8Rng::seed_from_u64(SEED);
                random.set_stream(stream);
                pair.map(|surface| ripple.applied(&surface.emissivity, &mut random))
            }
            _ => pair.map(|surface| surface.emissivity.clone()),
        };
        let found = match solver.filter(|_| sighted.study.bands == stated.study.bands) {
            Some(solver) => solver.with_counting(&pair[0], &pair[1], state, &sighted.counting)?,
            None => sighted.solver().with_counting(&pair[0], &pair[1], state, &sighted.counting)?,
        };
        Ok(found.distance / self.clause.required)
    }

    /// Keeps a scene before a camera if it is a worse one; whether it is.
    fn learn(&self, found: Option<(Scene, f64)>, camera: &Camera) -> Result<bool> {
        let before = self.margin(camera, Errors::None)? * self.clause.required;
        let mut known = self.known.write().unwrap_or_else(PoisonError::into_inner);
        let found = found.filter(|(scene, distance)| {
            *distance < before * (1.0 - SMALLER) && !known.iter().any(|other| other.is_like(scene))
        });
        let is_new = found.is_some();
        known.extend(found.map(|(scene, _)| scene));
        Ok(is_new)
    }
}
