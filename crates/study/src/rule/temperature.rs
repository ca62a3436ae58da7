//! A clause that demands a temperature: k σ_T at most, σ_T the Cramér–Rao bound of an unbiased estimate of the target's temperature
//! with all else unknown that the scenario names, k the coverage factor.
//!
//! The emissivity is known, the camera calibrated but for a gain that may be among the unknowns. The bound is largest somewhere
//! in the envelope: corners and scenes between them are looked at, then the largest is followed uphill, one range after the other,
//! in ever smaller steps. Nothing proves that no scene is worse.

use super::approach::{Approach, Moving, is_timed, spoiled};
use super::cameras::Named;
use super::clauses::{Definition, Measure, MeasuredAnswer, MeasuredScene, MeasuredVerdict};
use super::envelope::{Sighted, all, brightest, scattered_places, scene_at, unlit};
use super::uncertainty::{Anew, Errors, Judged, SMALLER, Uncertain};
use super::{apart, cameras};
use crate::condition::Condition;
use crate::grade::Grade;
use crate::rests_on::Circumstances;
use crate::warn::contradiction;
use crate::{Shortfall, Study};
use hadar::error::Result;
use hadar::fisher::Nuisance;
use hadar::fisher::precision::PrecisionSolver;
use hadar::instrument::Camera;
use hadar::material::Library;
use hadar::scene::{Parameter, State};
use hadar_scenario::rule::{Clause, StopSpec, Verdict};
use hadar_scenario::{Envelope, Rule};
use std::sync::{PoisonError, RwLock};

/// Of a range, the first step uphill and the last.
const FIRST_STEP: f64 = 0.25;
const LAST_STEP: f64 = 1e-4;

/// A clause with its cameras before every material.
#[derive(Debug)]
pub(super) struct TemperatureClause {
    error_k: f64,
    coverage_factor: f64,
    /// Whether the rule has errors of emissivities.
    sensitivity: bool,
    rule: Rule,
    stop: Option<StopSpec>,
    moving: Option<Moving>,
    envelope: Envelope,
    cameras: Vec<Before>,
}

/// A camera before every material, from every distance that is looked at.
#[derive(Debug)]
struct Before {
    named: Named,
    sighted: Vec<Sighted>,
    approach: Option<Approach>,
}

impl Before {
    /// The scene of the largest bound, of those that are found before each material from each distance.
    fn worst(&self, found: impl Fn(&Sighted) -> Result<Found>) -> Result<Option<(Found, &Sighted)>> {
        let mut worst: Option<(Found, &Sighted)> = None;
        for sighted in &self.sighted {
            let found = found(sighted)?;
            if worst.as_ref().is_none_or(|(known, _)| found.sigma_k > known.sigma_k) {
                worst = Some((found, sighted));
            }
        }
        Ok(worst)
    }

    /// From where the target is looked at the farthest, m.
    fn farthest_m(&self, envelope: &Envelope) -> Option<f64> {
        let range = self.approach.as_ref().map(|approach| approach.distance_m).or(envelope.distance_m);
        let own = self.sighted.first().and_then(|sighted| sighted.study.scenario.target.distance_m);
        range.map(|[_, most]| most).or(own)
    }
}

/// A scene with its bound, K.
#[derive(Clone)]
struct Found {
    sigma_k: f64,
    state: State,
}

impl TemperatureClause {
    pub(super) fn new(
        rule: &Rule,
        clause: &Clause,
        (error_k, coverage_factor): (f64, f64),
        cameras: &[Named],
        library: &Library,
    ) -> Result<Self> {
        let envelope = clause.envelope();
        let before = |(index, named): (usize, &Named)| before(rule, clause, index, named, &envelope, library);
        let cameras = cameras.iter().enumerate().map(before).collect::<Result<_>>()?;
        let (rule, stop, moving) = (rule.clone(), clause.stop, Moving::of(clause));
        let sensitivity = clause.scenario.sensitivity.is_some_and(|errors| errors.emissivity_error > 0.0);
        Ok(Self { error_k, coverage_factor, sensitivity, rule, stop, moving, envelope, cameras })
    }

    pub(super) fn study(&self) -> Option<&Study> {
        self.cameras.first()?.sighted.first().map(|sighted| &sighted.study)
    }

    /// Every camera, with the number of bands that it reads.
    pub(super) fn looking(&self) -> Vec<(&Named, usize)> {
        let bands = |one: &Before| one.sighted.first().map_or(1, |sighted| sighted.study.bands.len());
        self.cameras.iter().map(|one| (&one.named, bands(one))).collect()
    }

    pub(super) fn answer(&self, progress: &dyn Fn(usize)) -> Result<MeasuredAnswer> {
        let mut verdicts = Vec::with_capacity(self.cameras.len());
        for (done, camera) in self.cameras.iter().enumerate() {
            verdicts.push(self.judged(camera)?);
            progress(done + 1);
        }
        let definition = Definition::Temperature {
            coverage_factor: self.coverage_factor,
            error_k: self.error_k,
            without_emissivity_errors: self.sensitivity,
        };
        let (quantity, demanded) = (Measure::TemperatureErrorK, self.error_k);
        Ok(MeasuredAnswer { quantity, demanded, definition, cameras: verdicts })
    }

    fn judged(&self, before: &Before) -> Result<MeasuredVerdict> {
        let worst = before.worst(largest)?;
        let sigma_k = worst.as_ref().map_or(f64::INFINITY, |(found, _)| found.sigma_k);
        let value = Some(self.coverage_factor * sigma_k).filter(|value| value.is_finite());
        let margin = value.map_or(0.0, |value| self.error_k / value);
        let (rule, named) = (&self.rule, &before.named);
        let place = |key: &str| rule.camera_place(named.index, key);
        let uncertain = Uncertain::of(named, (rule.coverage_factor, false), &place)?;
        let bands = before.sighted.first().map_or(1, |sighted| sighted.study.bands.len());
        let spoils = |camera: &Camera| {
            let mut found = spoiled(self.moving, self.stop.as_ref(), camera, bands);
            let full = before.sighted.iter().any(|sighted| {
                let own = sighted.study.scenario.target.distance_m;
                let Ok(seen) = sighted.before(camera, own, &self.envelope) else { return true };
                let bright = Study { state: brightest(&seen.ranges), ..seen.study };
                let reading =
                    bright.camera_result(bright.photon_radiance()).map(|found| found.brightest_reading);
                camera.full_well.zip(reading).is_some_and(|(full, reading)| reading > full)
            });
            found.extend(full.then_some(Shortfall::FullWell));
            found
        };
        // The first frame is taken where this camera takes it.
        let seen_by = |sighted: &Sighted, camera: &Camera| {
            let own = sighted.study.scenario.target.distance_m;
            let farthest = before.approach.as_ref().map(|approach| approach.distance_m[1]);
            let distance_m = match self.stop.as_ref() {
                Some(spec) if own == farthest => Some(Approach::of(spec, camera, bands).distance_m[1]),
                _ => own,
            };
            sighted.before(camera, distance_m, &self.envelope)
        };
        let known = worst.iter().map(|(found, sighted)| (found.state.clone(), *sighted)).collect();
        let anew = Scenes { clause: self, before, seen_by: &seen_by, known: RwLock::new(known) };
        for camera in uncertain.as_ref().map_or_else(|| Ok(Vec::new()), Uncertain::ends)? {
            anew.search(&camera)?;
        }
        let by = Shortfall::TemperatureError;
        let (judged, uncertainty) = Uncertain::verdict(uncertain, margin, by, named, &spoils, &anew)?;
        let Judged { mut verdict, fails_by, mut undecided_by } = judged;
        // What errors of the emissivity make of the temperature is not in the bound.
        if verdict == Verdict::Meets && self.sensitivity {
            (verdict, undecided_by) = (Verdict::Undecided, vec![Shortfall::TemperatureError]);
        }
        let passes = verdict == Verdict::Meets;
        // With more noise than the scene has itself, it may be in the scene's own.
        let own_noise = worst.as_ref().is_none_or(|(found, sighted)| {
            let at = Study { state: found.state.clone(), ..sighted.study.clone() };
            at.counting().is_none_or(|own| own.var_added == sighted.counting.var_added)
        });
        let limiting = worst.map_or_else(MeasuredScene::default, |(found, sighted)| MeasuredScene {
            distance_m: sighted.study.scenario.target.distance_m,
            target: Some(sighted.study.target.name.clone()),
            temperature_k: Some(found.state.temperature_k),
            lighting: found.state.lighting,
            surroundings_k: found.state.environment_k,
            smear_m: None,
        });
        let mut warnings =
            before.sighted.first().map(|sighted| sighted.study.camera_warnings()).unwrap_or_default();
        warnings.extend(contradiction(&named.camera).filter(|_| self.moving.is_some()));
        // One scene in which it cannot be shows that it fails.
        let grade = if verdict != Verdict::Fails || !own_noise { Grade::Searched } else { Grade::Proved };
        let grade = grade.guarded(verdict, uncertainty.as_ref());
        let conditions = self.conditions(before, passes);
        Ok(MeasuredVerdict {
            name: named.name.clone(),
            verdict,
            passes,
            fails_by,
            undecided_by,
            uncertainty,
            value,
            margin,
            grade: grade.under(&conditions),
            evidence: grade,
            limiting,
            conditions,
            approach: before.approach.as_ref().map(|approach| approach.result),
            warnings,
        })
    }
}

impl TemperatureClause {
    /// What a 'yes' rests on: the scene, as where materials are told apart, and an emissivity that is known.
    fn conditions(&self, before: &Before, met: bool) -> Vec<Condition> {
        let Some(sighted) = before.sighted.first() else { return Vec::new() };
        let camera = &before.named.camera;
        let study = Study { camera: Some(camera.clone()), ..sighted.study.clone() };
        let seen = study.camera_result(study.photon_radiance());
        let asked = Circumstances {
            speed_m_s: self.moving.map(|moving| moving.speed_m_s),
            path: self.moving.and_then(|moving| moving.conditions(camera)),
            distance_m: before.farthest_m(&self.envelope),
            of_rule: true,
            is_timed: is_timed(self.stop.as_ref()),
            unlit: unlit(&sighted.ranges),
        };
        let brightest = seen.map_or(0.0, |seen| seen.brightest_reading);
        study.conditions_of_clause((camera, brightest), asked, vec![Condition::EmissivityKnown], met)
    }
}

/// A material of the target from a distance, seen by another camera.
type SeenBy<'a> = &'a (dyn Fn(&Sighted, &Camera) -> Result<Sighted> + Sync);

/// The scenes before one camera in which its margin is taken anew.
struct Scenes<'a> {
    clause: &'a TemperatureClause,
    before: &'a Before,
    seen_by: SeenBy<'a>,
    known: RwLock<Vec<(State, &'a Sighted)>>,
}

impl Scenes<'_> {
    fn margin_of(&self, sigma_k: f64) -> f64 {
        self.clause.error_k / (self.clause.coverage_factor * sigma_k)
    }
}

impl Anew for Scenes<'_> {
    fn margin(&self, camera: &Camera, _: Errors) -> Result<f64> {
        let mut sigma_k = 0.0f64;
        for (state, sighted) in self.known.read().unwrap_or_else(PoisonError::into_inner).iter() {
            let seen = (self.seen_by)(sighted, camera)?;
            let own = &seen.study.target.emissivity;
            let bound = solver(&seen).bound(own, state, &seen.counting, Parameter::Temperature)?;
            sigma_k = sigma_k.max(bound.sigma);
        }
        Ok(self.margin_of(sigma_k))
    }

    fn search(&self, camera: &Camera) -> Result<bool> {
        let before = self.margin(camera, Errors::None)?;
        let found = self.before.worst(|sighted| largest(&(self.seen_by)(sighted, camera)?))?;
        let mut known = self.known.write().unwrap_or_else(PoisonError::into_inner);
        let found = found.filter(|(found, sighted)| {
            let is_known =
                known.iter().any(|(state, from)| *state == found.state && std::ptr::eq(*from, *sighted));
            self.margin_of(found.sigma_k) < before * (1.0 - SMALLER) && !is_known
        });
        let is_new = found.is_some();
        known.extend(found.map(|(found, sighted)| (found.state, sighted)));
        Ok(is_new)
    }
}

fn before(
    rule: &Rule,
    clause: &Clause,
    index: usize,
    named: &Named,
    envelope: &Envelope,
    library: &Library,
) -> Result<Before> {
    let mut scenario = rule.with_camera(clause, index);
    let approach = match &clause.stop {
        Some(spec) => Some(Approach::of(spec, &named.camera, cameras::Named::bands(named, &scenario)?)),
        None => None,
    };
    let range = approach.as_ref().map(|approach| approach.distance_m).or(envelope.distance_m);
    let distances: Vec<Option<f64>> = match range {
        None => vec![None],
        Some([least, most]) if least == most => vec![Some(least)],
        Some(ends) => apart::steps(ends).map(Some).collect(),
    };
    let mut sighted = Vec::new();
    for material in envelope.materials.iter().flatten() {
        scenario.target.material = material.clone();
        for distance_m in &distances {
            scenario.target.distance_m = *distance_m;
            for study in Study::of_each_target(&scenario, library)? {
                sighted.push(Sighted::new(study, envelope)?);
            }
        }
    }
    Ok(Before { named: named.clone(), sighted, approach })
}

fn solver(sighted: &Sighted) -> PrecisionSolver<'_> {
    let Study { bands, surroundings, unknowns, .. } = &sighted.study;
    PrecisionSolver::new(bands, surroundings, unknowns.with(Nuisance::Temperature))
}

/// The largest bound that is found over the ranges.
fn largest(sighted: &Sighted) -> Result<Found> {
    let target = &sighted.study.target;
    let mut solver = solver(sighted);
    let mut at = |place: &[f64]| -> Result<Option<Found>> {
        let Some(state) = scene_at(&sighted.ranges, place) else { return Ok(None) };
        let bound = solver.bound(&target.emissivity, &state, &sighted.counting, Parameter::Temperature)?;
        let sigma_k = bound.sigma * (1.0 + bound.relative_error);
        Ok(Some(Found { sigma_k: if sigma_k.is_nan() { f64::INFINITY } else { sigma_k }, state }))
    };
    let mut best: Option<(Found, Vec<f64>)> = None;
    for place in scattered_places(&sighted.ranges) {
        if let Some(found) = at(&place)?
            && best.as_ref().is_none_or(|(known, _)| found.sigma_k > known.sigma_k)
        {
            best = Some((found, place));
        }
    }
    let Some((mut best, mut place)) = best else {
        return Ok(Found { sigma_k: f64::INFINITY, state: sighted.study.state.clone() });
    };
    let wide: Vec<bool> = all(&sighted.ranges).iter().map(|[low, high]| low < high).collect();
    let mut step = FIRST_STEP;
    while step >= LAST_STEP && best.sigma_k.is_finite() {
        hadar::stop::check();
        let mut higher = false;
        for (dimension, _) in wide.iter().enumerate().filter(|(_, wide)| **wide) {
            for way in [-step, step] {
                let mut there = place.clone();
                there[dimension] = (there[dimension] + way).clamp(0.0, 1.0);
                if let Some(found) = at(&there)?
                    && found.sigma_k > best.sigma_k
                {
                    (best, place, higher) = (found, there, true);
                }
            }
        }
        if !higher {
            step *= 0.5;
        }
    }
    Ok(best)
}
