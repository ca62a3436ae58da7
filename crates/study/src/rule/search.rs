//! One camera against a rule: the least distance over all materials, alternatives and scenes, and what would raise it.
//!
//! A few scenes of every pair give an estimate from above. The pairs are then searched in the order of these estimates,
//! each only as exactly as it matters: a pair whose distance is a multiple of the least one known needs a bound
//! that is above that, not its own worst case to 1 %.

use super::super::{NearestState, Shortfall, Study, Surface, Warning, warn};
use super::apart::{Candidate, TellApart};
use super::approach::{is_timed, spoiled};
use super::earlier::{Earlier, Worst};
use super::envelope::{Estimate, SCENES as SCATTERED, Sighted, brightest, darkest, unlit};
use super::pairs::Searched;
use super::results::{CameraVerdict, Certified, Fixes, LimitingScene, WithoutPlaceholders};
use super::uncertainty::{self, Judged, Uncertain};
use crate::condition::Condition;
use crate::decision::YesNo;
use crate::grade::Grade;
use crate::proviso::Proviso;
use crate::rests_on::Circumstances;
use crate::warn::contradiction;
use hadar::demand::{self, Reason, Thing};
use hadar::error::{Error, Result};
use hadar::fisher::Nuisance;
use hadar::identifiability::detection;
use hadar::identifiability::nearest::StateRange;
use hadar::instrument::{Camera, Readout};
use hadar::order;
use hadar::policy::envelope::Certificate;
use hadar::policy::{self, CapCode, Quantity};
use hadar::scene::State;
use hadar_scenario::rule::Verdict;
use std::borrow::Cow;
use std::collections::BTreeMap;

/// How far below the distance attained a bound may be, as a share of it.
pub(super) const TOLERANCE: f64 = 0.01;
/// The same where it is hardly above that demanded.
const FINEST: f64 = 1e-4;
/// Relative difference of distances that is rounding.
const ROUNDING: f64 = 1e-9;
/// Worst scenes that a figure is solved for at most.
const SCENES: usize = 6;
/// Share of the worst distance up to which the scenes of other pairs count where figures are uncertain.
const NEAR: f64 = 1.5;

/// What a camera's image of the brightest scene is like.
#[derive(Debug, Default)]
pub(super) struct Image {
    /// Motion during an exposure, pixels.
    blur: Option<f64>,
    /// Photons of the fullest reading.
    reading: f64,
    longest_exposure_s: Option<f64>,
    /// What is wrong with it.
    spoiled: Vec<Shortfall>,
}

/// The scene and the pair that decide.
pub(super) struct Limit<'a> {
    pub(super) at: &'a Study,
    pub(super) surface: &'a Surface,
    /// What is proved of the statistical distance.
    pub(super) lower_bound: Option<f64>,
}

/// What the reader of a verdict must know beside it.
struct Noted {
    /// Whether the camera is said to meet the requirement without a proof.
    unproved: bool,
    /// Whether the noise is that of a brighter scene than the limiting one.
    noisier: bool,
    /// Whether small errors of the emissivities change the distance several times over.
    fragile: bool,
}

impl TellApart {
    /// The verdict on one camera, and the scene and the pairs that it rests on; `alone` asks for no more than it. `progress` is told how many
    /// pairs are done.
    pub(super) fn judged(
        &self,
        index: usize,
        alone: bool,
        earlier: (&[Earlier<'_>], bool),
        progress: &dyn Fn(usize),
    ) -> Result<(CameraVerdict, (bool, Worst))> {
        let candidate = &self.candidates[index];
        let place = |key: &str| self.rule.camera_place(candidate.named.index, key);
        let uncertain = self.uncertain(candidate, &place)?;
        let alone = alone && uncertain.is_none();
        let (worst, pairs) = self.worst_or_known(index, alone, earlier, progress)?;
        let kept = (alone, (worst.clone(), pairs.clone()));
        let least = pairs.iter().map(|pair| pair.distance).fold(f64::INFINITY, f64::min);
        let near: Vec<Estimate> =
            pairs.iter().filter(|pair| pair.distance <= NEAR * least).cloned().collect();
        let sighted = worst.between.as_deref().unwrap_or(&candidate.sighted[worst.pair.sighted]);
        let surface = &sighted.study.alternatives[worst.pair.alternative];
        let distance = worst.pair.distance;
        let at = Study { state: worst.pair.state.clone(), ..sighted.study.clone() };
        let image = at.camera.as_ref().map(|camera| self.image(candidate, camera)).unwrap_or_default();
        let mut others = vec![image.spoiled.clone()];
        let uncertain = uncertain.filter(|_| distance > 0.0);
        for camera in uncertain.iter().flat_map(Uncertain::sides) {
            others.push(self.image(candidate, &camera?).spoiled);
        }
        let guarded = |uncertain: &Uncertain<'_>| self.guarded(uncertain, candidate, &worst, near, &at);
        let uncertainty = uncertain.as_ref().map(guarded).transpose()?;
        let by = (Shortfall::Distance, candidate.named.may_be_better() && distance > 0.0);
        let judged = uncertainty::judged(distance / self.required, uncertainty.as_ref(), by, &others);
        let Judged { verdict, fails_by, undecided_by } =
            self.as_proved(candidate, judged, &worst, (&at, surface))?;
        let passes = verdict == Verdict::Meets;
        let gap = worst.lower_bound.filter(|_| distance > 0.0).map(|bound| 1.0 - bound / distance);
        let certificate =
            worst.certificate.map_or_else(Certified::counterexample, |found| Certified::of(found, gap));
        let mut grade = Grade::Proved;
        // What is proved of the worst scene is guarded as its margin is, and what is guarded rests on draws.
        let guard = uncertainty.as_ref().map_or(0.0, |found| distance / self.required - found.low);
        let lower_bound = worst.lower_bound.map(|bound| (bound - guard * self.required).max(0.0));
        grade = grade.guarded(verdict, uncertainty.as_ref());
        let unproved = passes && lower_bound.is_none_or(|bound| bound < self.required);
        grade = if unproved { grade.max(Grade::Searched) } else { grade };
        let noisier = at.counting().is_some_and(|own| own.var_added != sighted.counting.var_added);
        // A scene that fails with more noise than it has itself may do with its own.
        if noisier && fails_by.as_slice() == [Shortfall::Distance] {
            grade = Grade::Searched;
        }
        let mut limiting = limiting(
            candidate.distance_matters,
            &at,
            surface,
            &worst.pair,
            self.is_unknown(Nuisance::EnvironmentTemperature),
        );
        let without_placeholders = match limiting.placeholders {
            Some(_) if !alone => self.without_placeholders(candidate)?,
            _ => None,
        };
        let (mut fixes, mut fragile) = (None, false);
        if !alone {
            let shot = at.nearest(surface, f64::INFINITY)?;
            limiting.hardware_m2_s = policy::photons_required(self.required, shot.distance)
                .map(|photons| policy::hardware_required_m2_s(photons, at.photon_radiance()));
            let local = at.local(at.unknowns.clone(), surface, f64::INFINITY)?;
            fragile = shot.distance > 0.0 && local.distance_no_nuisance > warn::FRAGILE_RATIO * shot.distance;
            if let Some(camera) = at.camera.as_ref().filter(|_| distance < self.required) {
                fixes = Some(self.fixes(candidate, &pairs, &at, (camera, surface))?);
            }
        }
        let conditions =
            self.conditions(candidate, passes, &image, &Limit { at: &at, surface, lower_bound })?;
        let warnings = self.remarks(candidate, &Noted { unproved, noisier, fragile }, &at, surface);
        let bands = at.bands.len();
        let verdict = CameraVerdict {
            name: candidate.named.name.clone(),
            passes,
            fails_by,
            bands,
            readout: at.camera.as_ref().map_or(Readout::Simultaneous, |camera| camera.readout),
            sweep_s: at.camera.as_ref().map_or(0.0, |camera| camera.sweep_s(bands)),
            without_placeholders,
            margin: distance / self.required,
            statistical_distance: distance,
            detection_probability: detection::probability(distance),
            lower_bound,
            certificate,
            limiting,
            fixes,
            motion_blur_pixels: image.blur,
            brightest_reading: image.reading,
            longest_exposure_s: image.longest_exposure_s,
            approach: candidate.approach.as_ref().map(|approach| approach.result),
            verdict,
            undecided_by,
            uncertainty,
            grade: grade.under(&conditions),
            evidence: grade,
            conditions,
            warnings,
        };
        Ok((verdict, kept))
    }

    /// The worst of all pairs before a camera: what an earlier clause found, if that is the same question.
    fn worst_or_known(
        &self,
        index: usize,
        alone: bool,
        (earlier, nearly_alike): (&[Earlier<'_>], bool),
        progress: &dyn Fn(usize),
    ) -> Result<Worst> {
        if let Some(known) = earlier.iter().find_map(|clause| clause.worst(self, index, alone)) {
            demand::spared(Thing::WorstCases, Reason::Shared, known.1.len() as u64);
            return Ok(known.clone());
        }
        if nearly_alike {
            for clause in earlier {
                if let Some(known) = clause.nearly_worst(self, index, alone)? {
                    demand::spared(Thing::WorstCases, Reason::Shared, known.1.len() as u64);
                    return Ok(known);
                }
            }
        }
        let found = self.worst(&self.candidates[index], alone, &|_, _| true, progress)?;
        found.ok_or_else(|| {
            Error::malformed("there is no pair of materials", "name one in alternatives.materials")
        })
    }

    /// 'Can' is said of what is proved, and of few counts by their own law: between that and the worst scene found it is undecided.
    fn as_proved(
        &self,
        candidate: &Candidate,
        judged: Judged,
        worst: &Searched,
        (at, surface): (&Study, &Surface),
    ) -> Result<Judged> {
        let surely = self.surely_required(candidate);
        let few_counts = surely > self.required;
        let bound = worst.lower_bound.or(few_counts.then_some(worst.pair.distance));
        let may_do = match at.counting() {
            Some(counting) if few_counts && judged.fails_by == [Shortfall::Distance] => {
                at.decided(self.scenario.requirement.by, surface, &counting)?.told != YesNo::No
            }
            _ => false,
        };
        if may_do || judged.verdict == Verdict::Meets && bound.is_some_and(|bound| bound < surely) {
            let (fails_by, undecided_by) = (Vec::new(), vec![Shortfall::Distance]);
            return Ok(Judged { verdict: Verdict::Undecided, fails_by, undecided_by });
        }
        Ok(judged)
    }

    /// The statistical distance that surely suffices in every scene, those of the fewest counts among them.
    fn surely_required(&self, candidate: &Candidate) -> f64 {
        let of = |sighted: &Sighted| {
            let dark = Study { state: darkest(&sighted.ranges), ..sighted.study.clone() };
            dark.counting().map_or(self.required, |counting| dark.surely_required(&counting))
        };
        candidate.sighted.iter().map(of).fold(self.required, f64::max)
    }

    /// What a 'yes' rests on; of a 'no' what was taken on the unfavourable side.
    pub(super) fn conditions(
        &self,
        candidate: &Candidate,
        met: bool,
        image: &Image,
        limit: &Limit<'_>,
    ) -> Result<Vec<Condition>> {
        let Some((near, camera)) =
            candidate.near.first().and_then(|near| Some((near, near.camera.as_ref()?)))
        else {
            return Ok(Vec::new());
        };
        let farthest_m = candidate.distance_m.map(|[_, most]| most);
        let asked = Circumstances {
            unlit: near.ranges(&self.envelope).map_or(1.0, |ranges| unlit(&ranges)),
            speed_m_s: self.pace_m_s(),
            path: self.moving.and_then(|moving| moving.conditions(camera)),
            distance_m: farthest_m,
            of_rule: true,
            is_timed: is_timed(self.stop.as_ref()),
        };
        let Limit { at, surface, lower_bound } = limit;
        let constants = at.target.placeholders(surface);
        let mut own: Vec<Condition> =
            constants.map(|emissivities| Condition::Constants { emissivities }).into_iter().collect();
        if met {
            // A rule that states errors is guarded against them; the pixels of an object share them.
            let (unstated, is_object) = (self.scenario.sensitivity.is_none(), at.scenario.is_of_object());
            if unstated && is_object {
                own.extend(at.usual_errors(surface)?);
            }
            let of_pixel = unstated && !is_object;
            let errors = of_pixel.then(|| at.emissivity_errors(camera, surface, usize::MAX)).transpose()?;
            let errors = errors.map(|found| [found.error, found.share_met]);
            own.extend(at.of_pair(camera, *lower_bound, errors));
            own.extend(near.ranges_that_decide(false, &|range| self.meets_in(candidate, range))?);
        }
        Ok(near.conditions_of_clause((camera, image.reading), asked, own, met))
    }

    /// Whether a camera meets the demand where the states of the alternatives are of such a range.
    fn meets_in(&self, candidate: &Candidate, range: StateRange) -> Result<bool> {
        let mut wider = candidate.clone();
        for sighted in wider.sighted.iter_mut().chain(&mut wider.between) {
            sighted.study.range = range;
        }
        let found = self.worst(&wider, true, &|_, _| true, &|_| ())?;
        Ok(found.is_none_or(|(worst, _)| worst.lower_bound.unwrap_or(worst.pair.distance) >= self.required))
    }

    fn proviso(&self, candidate: &Candidate) -> Option<Proviso> {
        let near = candidate.near.first()?;
        Proviso::of(near.camera.as_ref()?, near.bands.len(), self.pace_m_s()?)
    }

    /// What each figure of the camera would have to be in the limiting scene and in those that are the worst of a few at its solution, and
    /// what that would spoil.
    fn fixes(
        &self,
        candidate: &Candidate,
        pairs: &[Estimate],
        at: &Study,
        (camera, surface): (&Camera, &Surface),
    ) -> Result<Fixes> {
        let task = at.task(camera);
        // Where the target is and how fast it moves is the rule's to say.
        let mut quantities = at.solutions_of(camera, surface, &Quantity::OF_CAMERA)?;
        for (quantity, solution) in &mut quantities.0 {
            for _ in 0..SCENES {
                let Some(value) = solution.value else { break };
                let changed = task.forward(*quantity, value).camera;
                let Some((scene, distance)) = self.worst_of(candidate, pairs, [Some(0), None], &changed)?
                else {
                    break;
                };
                if distance >= self.required * (1.0 - ROUNDING) {
                    break;
                }
                let found = scene.solved(self, candidate, camera, *quantity)?;
                let Some(found) = found else { break };
                *solution = found.or_harder(solution.clone(), *quantity);
            }
        }
        let mut any = false;
        let mut spoils = BTreeMap::new();
        for (quantity, solution) in &quantities.0 {
            let Some(value) = solution.value else { continue };
            let mut spoiled = self.image(candidate, &task.forward(*quantity, value).camera).spoiled;
            // That is not the quantity's doing.
            spoiled.retain(|by| *by != Shortfall::MotionUnknown);
            // Those of the limiting scene that the brightest one does not know of.
            spoiled.extend(solution.caps.iter().filter_map(|cap| match cap.code {
                CapCode::Diffraction => Some(Shortfall::Diffraction),
                CapCode::Impractical => Some(Shortfall::Impractical),
                CapCode::LowestNoise => Some(Shortfall::LowestNoise),
                CapCode::DecisionTime | CapCode::FrameRate | CapCode::FullWell | CapCode::Motion => None,
            }));
            any |= spoiled.is_empty();
            if !spoiled.is_empty() {
                spoils.insert(quantity.key(), spoiled);
            }
        }
        Ok(Fixes { any, spoils, quantities })
    }

    fn is_unknown(&self, nuisance: Nuisance) -> bool {
        self.scenario.unknown.nuisances.contains(&nuisance)
    }

    /// The image that a camera makes of the brightest scene, from the least distance.
    pub(super) fn image(&self, candidate: &Candidate, camera: &Camera) -> Image {
        let mut image = Image::default();
        for near in &candidate.near {
            let Ok(ranges) = near.ranges(&self.envelope) else { continue };
            let (state, camera) = (brightest(&ranges), Some(camera.clone()));
            let bright = Study { state, camera, ..near.clone() };
            let Some(seen) = bright.camera_result(bright.photon_radiance()) else { continue };
            image.reading = image.reading.max(seen.brightest_reading);
        }
        let bands = candidate.near.first().map_or(1, |near| near.bands.len());
        image.blur = self.moving.and_then(|moving| moving.blur_pixels(camera, bands));
        let blurred =
            image.blur.map(|blur| camera.exposure_of_sweep_s(bands, camera.sweep_s(bands) / blur).max(0.0));
        let full = camera.full_well.map(|full| camera.exposure_s * full / image.reading);
        image.longest_exposure_s = blurred.into_iter().chain(full).reduce(f64::min);
        image.spoiled = spoiled(self.moving, self.stop.as_ref(), camera, bands);
        if camera.full_well.is_some_and(|full| image.reading > full) {
            image.spoiled.push(Shortfall::FullWell);
        }
        if camera.clone().checked().is_err()
            && camera.frame_s().is_some_and(|frame| camera.exposure_s > frame)
        {
            image.spoiled.push(Shortfall::FrameRate);
        }
        image
    }

    /// What is to be said of a camera before any scene is searched.
    fn warnings_of(&self, candidate: &Candidate) -> Vec<Warning> {
        let Some(near) = candidate.near.first() else { return Vec::new() };
        let Some(camera) = &near.camera else { return Vec::new() };
        let state =
            near.ranges(&self.envelope).map_or_else(|_| near.state.clone(), |ranges| brightest(&ranges));
        let mut warnings = Study { state, ..near.clone() }.camera_warnings();
        warnings.extend(self.proviso(candidate).map(Warning::FramesInMotion));
        let farthest_m = candidate.distance_m.map(|[_, most]| most);
        warnings.extend(near.size_unknown(camera, farthest_m));
        let assumed = camera.assumed.iter().cloned();
        warnings.extend(assumed.map(|figure| Warning::CameraFigureAssumed { figure }));
        warnings.extend(contradiction(camera).filter(|_| self.moving.is_some()));
        if self.moving.is_some() && self.image(candidate, camera).blur.is_none() {
            warnings.push(Warning::RuleMotionBlurUnknown);
        }
        warnings
    }

    /// What is to be said of a camera, made of what was found of it.
    fn remarks(&self, candidate: &Candidate, noted: &Noted, at: &Study, surface: &Surface) -> Vec<Warning> {
        let mut warnings = self.warnings_of(candidate);
        warnings.extend(noted.unproved.then_some(Warning::NotProved));
        warnings.extend(noted.noisier.then_some(Warning::BrightestNoise));
        warnings.extend(at.placeholders(surface));
        warnings.extend(noted.fragile.then_some(Warning::FragileScene));
        warnings
    }

    /// The worst of all pairs, and what each has come to, or a scene that is below the requirement where no more is asked for.
    pub(super) fn worst(
        &self,
        candidate: &Candidate,
        alone: bool,
        counts: &dyn Fn(&Surface, &Surface) -> bool,
        progress: &dyn Fn(usize),
    ) -> Result<Option<(Searched, Vec<Estimate>)>> {
        let mut pairs = candidate
            .estimates(&[], [Some(SCATTERED), None], |index| Ok(Cow::Borrowed(&candidate.sighted[index])))?;
        pairs.retain(|pair| {
            let Study { target, alternatives, .. } = &candidate.sighted[pair.sighted].study;
            counts(target, &alternatives[pair.alternative])
        });
        order::ascending(&mut pairs, |a| a.distance);
        let count = pairs.len();
        let mut found: Vec<Searched> = Vec::with_capacity(count);
        let decisive = self.decisive(candidate);
        let mut best = f64::INFINITY;
        let mut all = true;
        for (done, pair) in pairs.into_iter().enumerate() {
            if alone && (pair.distance < self.required || best < self.required) {
                demand::spared(Thing::WorstCases, Reason::AnotherOne, (count - done) as u64);
                if best >= self.required {
                    return Ok(Some((Searched::estimated(pair), Vec::new())));
                }
                all = false;
                break;
            }
            let enough = if alone { decisive } else { best };
            let mut tolerance = self.tolerance(enough, pair.distance);
            let mut searched = candidate.search(&found, pair, tolerance)?;
            best = best.min(searched.pair.distance);
            // A worst case below the estimate may leave a bound that does not reach what is enough.
            let short = |searched: &Searched, enough: f64, finest: f64| {
                let exact = searched.pair.distance * (1.0 - finest);
                let spared = if alone { 0.0 } else { finest };
                searched.lower_bound.is_some_and(|bound| bound < exact.min(enough * (1.0 - spared)))
            };
            let enough = if alone { decisive } else { best };
            let finest = self.finest(searched.pair.distance);
            while tolerance > finest && short(&searched, enough, finest) {
                let before = tolerance;
                tolerance = self.tolerance(enough, searched.pair.distance);
                if tolerance >= before {
                    break;
                }
                searched = candidate.search(&found, searched.pair, tolerance)?;
                best = best.min(searched.pair.distance);
            }
            found.push(searched);
            progress(done + 1);
        }
        let lower: Option<Vec<f64>> = found.iter().map(|searched| searched.lower_bound).collect();
        let lower = lower.map(|bounds| bounds.into_iter().fold(f64::INFINITY, f64::min));
        let pairs: Vec<Estimate> = found.iter().map(|searched| searched.pair.clone()).collect();
        let worst = found.into_iter().min_by(|a, b| a.pair.distance.total_cmp(&b.pair.distance));
        let Some(worst) = worst else { return Ok(None) };
        if !all {
            // A scene below the requirement, and other pairs not looked at.
            return Ok(Some((Searched::estimated(worst.pair), pairs)));
        }
        let (worst, lower) = match (candidate.between.is_empty(), worst.pair.distance > 0.0) {
            (false, true) => {
                let (worst, along) = self.between(candidate, worst, alone, counts)?;
                (worst, lower.zip(along).map(|(lower, along)| lower.min(along)))
            }
            _ => (worst, lower),
        };
        if alone && worst.pair.distance < self.required {
            return Ok(Some((Searched { lower_bound: None, certificate: None, ..worst }, pairs)));
        }
        let distance = worst.pair.distance;
        let certificate = match (worst.certificate, lower) {
            (Some(Certificate::Equilibrium), _) => Some(Certificate::Equilibrium),
            _ if distance == 0.0 => Some(Certificate::Equilibrium),
            (_, None) => Some(Certificate::DenseSearch { points: 0 }),
            (_, Some(bound)) if bound >= distance * (1.0 - TOLERANCE) => Some(Certificate::BranchAndBound),
            (_, Some(bound)) => Some(Certificate::Bounded { gap: 1.0 - bound / distance }),
        };
        let lower_bound = lower.map(|bound| bound * candidate.share);
        Ok(Some((Searched { lower_bound, certificate, ..worst }, pairs)))
    }

    /// What is to be proved where no more is asked for: the demand, whatever bunching that is left out would add to the variance.
    pub(super) fn decisive(&self, candidate: &Candidate) -> f64 {
        let occupancy = candidate.near.first().map_or(0.0, |near| {
            let bright =
                near.ranges(&self.envelope).map_or_else(|_| near.state.clone(), |all| brightest(&all));
            Study { state: bright, ..near.clone() }.occupancy()
        });
        self.required * (1.0 + occupancy).sqrt() * (1.0 + ROUNDING) / candidate.share
    }

    /// How far below the distance of a pair a bound may be, as a share of it, where so much is enough.
    fn tolerance(&self, enough: f64, distance: f64) -> f64 {
        (1.0 - enough / distance).clamp(self.finest(distance), 1.0 - TOLERANCE)
    }

    /// The same at least: no bound needs to be closer, but for a distance hardly above that demanded.
    fn finest(&self, distance: f64) -> f64 {
        let above = 0.5 * (1.0 - self.required / distance);
        if above > 0.0 { above.clamp(FINEST, TOLERANCE) } else { TOLERANCE }
    }

    /// The worst of the pairs that are more than two numbers, where one of numbers alone is the worst of all.
    fn without_placeholders(&self, candidate: &Candidate) -> Result<Option<WithoutPlaceholders>> {
        let known = |target: &Surface, other: &Surface| target.placeholders(other).is_none();
        Ok(self.worst(candidate, false, &known, &|_| ())?.map(|(worst, _)| {
            let Study { target, alternatives, .. } = &candidate.sighted[worst.pair.sighted].study;
            WithoutPlaceholders {
                margin: worst.pair.distance / self.required,
                statistical_distance: worst.pair.distance,
                target: target.name.clone(),
                alternative: alternatives[worst.pair.alternative].name.clone(),
            }
        }))
    }
}

fn limiting(
    distance_matters: bool,
    at: &Study,
    surface: &Surface,
    pair: &Estimate,
    environment: bool,
) -> LimitingScene {
    let State { temperature_k, lighting, environment_k, .. } = pair.state.clone();
    LimitingScene {
        target: at.target.name.clone(),
        alternative: surface.name.clone(),
        temperature_k,
        lighting,
        surroundings_k: environment_k,
        distance_m: at.scenario.target.distance_m,
        distance_matters,
        nearest_state: NearestState::of(&pair.nearest, environment),
        placeholders: at.target.placeholders(surface),
        hardware_m2_s: None,
    }
}
