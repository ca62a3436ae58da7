//! A clause that tells materials apart: every camera against a distance that must hold in all scenes of an envelope.
//!
//! A camera meets it if its least statistical distance over the envelope, over all materials of the target and all
//! alternatives, is at least that demanded, if nothing moves by a pixel while all bands are exposed, if the brightest scene
//! does not fill its well, and if it has read its frames before the decision must stand (`approach`). It fails as soon
//! as one scene below the requirement is known; that it meets it is proved where the lower bound of the search is above.
//!
//! Distances are nearest distances with the camera's own noise (`envelope`); gray areas are said: what was only
//! searched is called so.

use super::approach::{Approach, Moving};
use super::cameras::Named;
use super::envelope::Sighted;
use super::results::{CameraVerdict, EnvelopeResult, LimitingScene, Quotable, RuleRequirement, StopResult};
use crate::companion::{Companion, Given, Told};
use crate::{ClassSide, Study, Warning};
use hadar::error::{Error, Result};
use hadar::identifiability::detection;
use hadar::material::Library;
use hadar_scenario::rule::{Clause, Demand, StopSpec};
use hadar_scenario::{CameraSpec, DistanceKind, Envelope, MaterialRef, Rule, Scenario};

/// Relative difference of counts or variance from which on a distance matters.
const NOTICEABLE: f64 = 1e-3;
/// Distances that are searched where one between the ends may be the worst, both ends among them.
pub(super) const DISTANCES: usize = 9;

/// A camera of a rule, before every material and from the distances that may be the worst.
#[derive(Debug, Clone)]
pub(super) struct Candidate {
    pub(super) named: Named,
    /// From where it looks, the least distance first, m.
    pub(super) distance_m: Option<[f64; 2]>,
    /// How the vehicle comes nearer, if that is said.
    pub(super) approach: Option<Approach>,
    pub(super) sighted: Vec<Sighted>,
    /// Whether what is counted depends on the distance.
    pub(super) distance_matters: bool,
    /// The materials for which a distance between the ends may be the worst, from the least distance.
    pub(super) between: Vec<Sighted>,
    /// Of the others: no distance between has less than this share of the statistical distance from the farthest.
    pub(super) share: f64,
    /// From the least distance, every material in turn.
    pub(super) near: Vec<Study>,
}

impl Candidate {
    /// Pairs of materials that are searched, from every distance.
    pub(super) fn pairs(&self) -> usize {
        self.sighted.iter().map(|sighted| sighted.study.alternatives.len()).sum()
    }
}

/// A clause of a rule with everything it names looked up and checked.
#[derive(Debug, Clone)]
pub(super) struct TellApart {
    /// The rule, which knows where its cameras stand.
    pub(super) rule: Rule,
    /// With the defaults filled in that all cameras share.
    pub(super) scenario: Scenario,
    pub(super) stop: Option<StopSpec>,
    pub(super) moving: Option<Moving>,
    pub(super) envelope: Envelope,
    pub(super) candidates: Vec<Candidate>,
    pub(super) required: f64,
    pub(super) warnings: Vec<Warning>,
}

impl TellApart {
    /// Looks up everything that a clause of a rule with these cameras names.
    pub(super) fn new(rule: &Rule, clause: &Clause, cameras: &[Named], library: &Library) -> Result<Self> {
        let mut scenario = clause.scenario.clone();
        if scenario.requirement.by != DistanceKind::Nearest {
            let found = "an envelope is searched by the nearest distance only";
            let error = Error::malformed(found, "write by = \"nearest\", or leave the key out");
            return Err(error.at(scenario.place("requirement.by")));
        }
        let envelope = clause.envelope();
        if scenario.target.pixels.is_some() && envelope.distance_m.is_some_and(|[near, far]| near < far) {
            let found = "so many pixels at every distance of the envelope, where the farther it is the fewer they are";
            let error =
                Error::malformed(found, "write size = \"0.5 m\" in the place of pixels, or one distance");
            return Err(error.at(scenario.place("target.pixels")));
        }
        let materials = envelope.materials.clone().unwrap_or_default();
        for (index, material) in materials.iter().enumerate() {
            if let MaterialRef::Name(name) = material
                && !scenario.classes.contains_key(name)
                && library.class(name).is_none()
            {
                let key = format!("envelope.materials[{index}]");
                library.get(name).map_err(|error| error.at(scenario.place(&key)))?;
            }
        }
        scenario.envelope = Some(envelope.clone());
        let mut candidates: Vec<Candidate> = Vec::with_capacity(cameras.len());
        let mut warnings: Vec<Warning> = Vec::new();
        let mut alternatives: Vec<MaterialRef> = Vec::new();
        for named in cameras.iter().enumerate() {
            let candidate = candidate(rule, clause, named, &envelope, library)?;
            for study in &candidate.near {
                let new = study.warnings.iter().filter(|warning| !warnings.contains(warning));
                let new: Vec<Warning> = new.cloned().collect();
                warnings.extend(new);
                for material in study.scenario.alternatives.materials.iter().flatten() {
                    if !alternatives.contains(material) {
                        alternatives.push(material.clone());
                    }
                }
            }
            if let Some(study) = candidate.near.first() {
                // What the scenario left silent.
                scenario.alternatives = study.scenario.alternatives.clone();
            }
            candidates.push(candidate);
        }
        // Errors that classes state are those of all their members; the largest, of the rule's own too, guard all.
        let near = candidates.iter().flat_map(|candidate| &candidate.near);
        let stated = near.flat_map(Study::stated_spreads).chain(scenario.sensitivity);
        scenario.sensitivity = stated.max_by(|a, b| {
            let [a, b] = [a, b].map(|spec| (spec.emissivity_error, spec.correlation_cm1));
            a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1))
        });
        scenario.alternatives.materials = Some(alternatives);
        // Where nothing is said of them, cameras may have bands of their own.
        let near = || candidates.iter().flat_map(|candidate| &candidate.near);
        let source = near().next().map(|study| study.scenario.bands.source.clone());
        if let Some(source) = source.filter(|one| near().all(|study| study.scenario.bands.source == *one)) {
            scenario.bands.source = source;
        }
        let first = candidates.first().and_then(|candidate| candidate.near.first());
        let required = first.map_or(1.0, |study| study.required);
        let (rule, stop, moving) = (rule.clone(), clause.stop, Moving::of(clause));
        Ok(Self { rule, scenario, stop, moving, envelope, candidates, required, warnings })
    }

    /// The first camera before the first material, from the least distance: what all of them share.
    pub(super) fn study(&self) -> Option<&Study> {
        self.candidates.first().and_then(|candidate| candidate.near.first())
    }

    /// Every camera with its defaults.
    pub(super) fn specs(&self) -> impl Iterator<Item = CameraSpec> {
        let near = self.candidates.iter().map(|candidate| candidate.near.first());
        near.map(|near| near.and_then(|study| study.scenario.camera.clone()).unwrap_or_default())
    }

    /// Pairs of materials before all cameras.
    pub(super) fn pairs(&self) -> usize {
        self.candidates.iter().map(Candidate::pairs).sum()
    }

    /// What sizing practice says of the cameras, each at the distance of its limiting scene, if the rule says how large a target is.
    pub(super) fn companions(&self, cameras: &[CameraVerdict]) -> Result<Vec<Companion>> {
        let of_clause = self.rule.clauses.iter().find_map(|clause| match clause.demand {
            Demand::Resolution { size_m, .. } => Some(size_m),
            _ => None,
        });
        let Some(size_m) = self.scenario.target.size_m.or(of_clause) else { return Ok(Vec::new()) };
        let companion = |(candidate, verdict): (&Candidate, &CameraVerdict)| {
            let study = candidate.near.first()?;
            let LimitingScene { target, alternative, distance_m, .. } = &verdict.limiting;
            // Where the distance does not matter to the limit it does to a picture: the farthest is the hardest.
            let farthest_m = candidate.distance_m.map(|[_, most]| most);
            let told = Told {
                target,
                alternative,
                statistical_distance: verdict.statistical_distance,
                pixels: study.pixels_of_object(*distance_m),
            };
            let companion = Companion::of(&Given {
                camera: study.camera.as_ref(),
                bands: &study.bands,
                size_m: Some(size_m),
                distance_m: farthest_m.or(*distance_m),
                told: Some(told),
            });
            Some(companion.map(|found| Companion { camera: Some(verdict.name.clone()), ..found }))
        };
        self.candidates.iter().zip(cameras).filter_map(companion).collect()
    }

    /// How fast the vehicle drives at most, m s⁻¹.
    pub(super) fn speed_m_s(&self) -> Option<f64> {
        let stop = self.stop.map(|spec| spec.stop().decisions()[1].speed_m_s);
        stop.or(self.scenario.requirement.speed_m_s)
    }

    /// How fast the way between vehicle and target may change, m s⁻¹.
    pub(super) fn pace_m_s(&self) -> Option<f64> {
        let stop = self.stop.map(|spec| spec.stop().decisions()[1]);
        stop.map(|one| one.speed_m_s.max(one.closing_m_s)).or(self.scenario.requirement.speed_m_s)
    }

    pub(super) fn envelope_result(&self) -> EnvelopeResult {
        let point = |value: f64| [value; 2];
        let scenario = &self.scenario;
        let objects = &scenario.environment;
        let studies = self.candidates.iter().flat_map(|candidate| &candidate.near);
        let (mut materials, mut alternatives): (Vec<String>, Vec<String>) = (Vec::new(), Vec::new());
        let mut classes: Vec<ClassSide> = Vec::new();
        for study in studies {
            let add = |names: &mut Vec<String>, name: &str| {
                if !names.iter().any(|known| known == name) {
                    names.push(name.to_owned());
                }
            };
            let [targets, others] = &study.members;
            targets.iter().for_each(|members| add(&mut materials, &members.name));
            others.iter().for_each(|members| add(&mut alternatives, &members.name));
            for side in study.class_sides() {
                if !classes.contains(&side) {
                    classes.push(side);
                }
            }
        }
        let Envelope { temperature_k, lighting, surroundings_k, distance_m, .. } = self.envelope.clone();
        EnvelopeResult {
            temperature_k: temperature_k.unwrap_or(point(scenario.target.temperature_k)),
            lighting: lighting.unwrap_or_else(|| objects.iter().map(|o| point(o.lighting)).collect()),
            surroundings_k: surroundings_k
                .unwrap_or_else(|| objects.iter().map(|o| point(o.temperature_k)).collect()),
            distance_m: self
                .stop
                .map(|spec| spec.stop().decisions().map(|one| one.distance_m))
                .or(distance_m),
            materials,
            alternatives,
            classes,
        }
    }

    /// Temperatures that alternatives may have, where the clause says so.
    fn stated_alternatives_k(&self) -> Option<[f64; 2]> {
        let stated = self.scenario.source.states("alternatives.temperature");
        self.scenario.alternatives.temperature_range_k.filter(|_| stated)
    }

    pub(super) fn requirement(
        &self,
        cameras: &[CameraVerdict],
        envelope: &EnvelopeResult,
        alone: bool,
    ) -> RuleRequirement {
        let hardware: Option<Vec<f64>> = cameras.iter().map(|camera| camera.limiting.hardware_m2_s).collect();
        let hardware = hardware.filter(|_| !alone);
        let hardware_m2_s = hardware.map(|each| each.into_iter().fold(0.0, f64::max));
        let speed_m_s = self.speed_m_s();
        // A target smaller than its pixel, or air, takes light away that the figure of the hardware does not know of.
        let plain = self.scenario.target.size_m.is_none()
            && self.scenario.atmosphere.is_none()
            && !self.scenario.is_of_object();
        let quotable = Quotable {
            envelope: envelope.clone(),
            alternatives_k: self.stated_alternatives_k(),
            required: self.required,
            speed_m_s,
            stop: self.stop.as_ref().map(StopResult::of),
            hardware_m2_s: hardware_m2_s.filter(|_| plain),
            of_object: self.scenario.is_of_object(),
            units: self.scenario.units(),
        };
        RuleRequirement {
            distance: self.required,
            detection_probability: detection::probability(self.required),
            speed_m_s,
            hardware_m2_s,
            quotable,
        }
    }
}

/// A camera before every material of the envelope.
fn candidate(
    rule: &Rule,
    clause: &Clause,
    (index, named): (usize, &Named),
    envelope: &Envelope,
    library: &Library,
) -> Result<Candidate> {
    let mut scenario = rule.with_camera(clause, index);
    let mut approach = None;
    let (mut sighted, mut near, mut distance_matters) = (Vec::new(), Vec::new(), false);
    let (mut between, mut share) = (Vec::new(), 1.0_f64);
    for material in envelope.materials.iter().flatten() {
        scenario.target.material = material.clone();
        // Every member of a class is a material of the target.
        let mut at = |distance_m: Option<f64>| -> Result<Vec<Sighted>> {
            scenario.target.distance_m = distance_m;
            let all = Study::of_each_target(&scenario, library)?.into_iter();
            all.map(|study| Sighted::new(study, envelope)).collect()
        };
        let stop = clause.stop.as_ref().map(StopSpec::stop);
        let least = match stop {
            Some(stop) => Some(stop.decisions()[0].distance_m),
            None => envelope.distance_m.map(|[least, _]| least),
        };
        let all_close = at(least)?;
        near.extend(all_close.iter().map(|close| close.study.clone()));
        let bands = all_close.first().map_or(1, |close| close.study.bands.len());
        let own = clause.stop.as_ref().map(|spec| Approach::of(spec, &named.camera, bands));
        let most = own.as_ref().map(|own| own.distance_m[1]).or(envelope.distance_m.map(|[_, most]| most));
        approach = own.or(approach);
        if least == most {
            sighted.extend(all_close);
            continue;
        }
        let air = all_close.first().and_then(|close| close.study.atmosphere.clone()).zip(least.zip(most));
        if let Some((air, (_, most))) = &air {
            let key = if stop.is_some() { "stop" } else { "envelope.distance" };
            let place = |error: Error| error.at(clause.scenario.place(key));
            air.table.optical_depth(&[], *most).map_err(place)?;
        }
        for (close, far) in all_close.into_iter().zip(at(most)?) {
            distance_matters |= far.differs_from(&close, NOTICEABLE);
            if let Some((_, (least, most))) = &air {
                match close.share_of_far(&far, [*least, *most])? {
                    Some(one) => share = share.min(one),
                    None => {
                        let inner = steps([*least, *most]).skip(1).take(DISTANCES - 2);
                        let seen = inner.map(|z| Sighted::new(close.study.at_distance(z)?, envelope));
                        sighted.extend(seen.collect::<Result<Vec<_>>>()?);
                        between.push(close.clone());
                        sighted.extend([close, far]);
                        continue;
                    }
                }
            }
            match (far.is_worse_than(&close), close.is_worse_than(&far)) {
                (true, _) => sighted.push(far),
                (false, true) => sighted.push(close),
                (false, false) => sighted.extend([far, close]),
            }
        }
    }
    let distance_m = approach.as_ref().map(|own: &Approach| own.distance_m).or(envelope.distance_m);
    let named = named.clone();
    Ok(Candidate { named, distance_m, approach, sighted, distance_matters, between, share, near })
}

/// Distances of a range that are searched, equal steps of ln z apart.
pub(super) fn steps([least, most]: [f64; 2]) -> impl Iterator<Item = f64> {
    let share = |i: usize| i as f64 / (DISTANCES - 1) as f64;
    (0..DISTANCES).map(move |i| least * (most / least).powf(share(i)))
}
