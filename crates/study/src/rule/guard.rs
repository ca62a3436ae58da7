//! The margin of a camera that tells materials apart, taken anew with other figures: what `uncertainty` asks for.

use super::apart::{Candidate, TellApart};
use super::approach::Approach;
use super::envelope::{Estimate, SCENES, Sighted};
use super::pairs::Searched;
use super::uncertainty::{Errors, MarginUncertainty, Uncertain};
use crate::Study;
use crate::size::sensitivity::{linear, ripple::Ripple, scatter::Scatter};
use hadar::error::{Place, Result};
use hadar::instrument::Camera;
use hadar::policy::{Quantity, Solution};
use hadar::scene::State;
use rand::SeedableRng;
use rand::rngs::ChaCha8Rng;
use std::borrow::Cow;

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
        let mut scenes = self.scenes(candidate, worst, near);
        for camera in uncertain.ends()? {
            let found = self.worst_of(candidate, &[], [Some(SCENES); 2], &camera)?.map(|(scene, _)| scene);
            scenes.extend(found.filter(|found| !scenes.iter().any(|known| known.is_like(found))));
        }
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
        let of = |camera: &Camera, errors: Errors| {
            self.least_margin((candidate, &scenes), ripple.as_ref(), camera, errors)
        };
        uncertain.of_margin(distance / self.required, emissivities, true, &of)
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
        match &self.stop {
            Some(spec) if own == farthest => {
                Some(Approach::of(spec.stop(), camera, sighted.study.bands.len()).distance_m[1])
            }
            _ => own,
        }
    }

    /// The least margin of a camera in some scenes.
    fn least_margin(
        &self,
        (candidate, scenes): (&Candidate, &[Scene]),
        ripple: Option<&Scatter<'_>>,
        camera: &Camera,
        errors: Errors,
    ) -> Result<f64> {
        let mut least = f64::INFINITY;
        for Scene { sighted, alternative, state } in scenes {
            let distance_m = self.seen_from_m(candidate, sighted, camera);
            let sighted = sighted.before(camera, distance_m, &self.envelope)?;
            let pair = [&sighted.study.target, &sighted.study.alternatives[*alternative]];
            let pair: [Vec<f64>; 2] = match (errors, ripple) {
                (Errors::Stream(stream), Some(ripple)) => {
                    let mut random = ChaCha8Rng::seed_from_u64(SEED);
                    random.set_stream(stream);
                    pair.map(|surface| ripple.applied(&surface.emissivity, &mut random))
                }
                _ => pair.map(|surface| surface.emissivity.clone()),
            };
            let found = sighted.solver().with_counting(&pair[0], &pair[1], state, &sighted.counting)?;
            least = least.min(found.distance);
        }
        Ok(least / self.required)
    }
}
