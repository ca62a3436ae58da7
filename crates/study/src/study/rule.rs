//! A rule answered: every camera against a requirement that must hold in all scenes of an envelope.
//!
//! A camera meets a rule if its least statistical distance over the envelope, over all materials of the target and all
//! alternatives, is at least that demanded, if nothing moves by a pixel during an exposure at the rule's speed
//! and the least distance (Δ < 1), and if the brightest scene does not fill its well. It fails as soon as one scene below
//! the requirement is known; that it meets the rule is proved where the lower bound of the search is above.
//!
//! Distances are nearest distances with the camera's own noise ([`envelope`]); gray areas are said: what was only
//! searched is called so.

mod between;
mod envelope;
mod ideal;
mod results;
mod search;
mod wording;

pub use results::{
    CameraVerdict, Certified, EmissivityError, EnvelopeResult, Fixes, IdealCamera, LightTime, LimitingScene,
    Neighbourhood, NotIdentifiable, Proof, Proviso, Quotable, RuleAnswer, RuleRequirement, WhoMeets,
    WithoutPlaceholders,
};

use self::envelope::Sighted;
use super::{Study, Warning};
use crate::scenario::rule::RuleCamera;
use crate::scenario::{DistanceKind, Envelope, MaterialRef, Rule};
use hadar::demand::{self, Ledger, Reason, Skipping, Thing, Work};
use hadar::error::{Error, Result};
use hadar::identifiability::detection;
use hadar::instrument::presets;
use hadar::material::Library;

/// Relative difference of counts or variance from which on a distance matters.
const NOTICEABLE: f64 = 1e-3;
/// Distances that are searched where one between the ends may be the worst, both ends among them.
const DISTANCES: usize = 9;

/// What is asked of a rule.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct RuleAsked {
    /// Only which cameras meet it: a camera that fails is left at the first scene that shows it.
    pub verdict_only: bool,
    /// Whether proofs may spare work.
    pub skipping: Skipping,
    /// Seed of the scenes that are drawn for the share no camera can do.
    pub seed: u64,
}

/// A camera of a rule, before every material and from the distances that may be the worst.
#[derive(Debug, Clone)]
struct Candidate {
    name: String,
    sighted: Vec<Sighted>,
    /// Whether what is counted depends on the distance.
    distance_matters: bool,
    /// The materials for which a distance between the ends may be the worst, from the least distance.
    between: Vec<Sighted>,
    /// Of the others: no distance between has less than this share of the statistical distance from the farthest.
    share: f64,
    /// From the least distance, every material in turn.
    near: Vec<Study>,
}

impl Candidate {
    /// Pairs of materials that are searched, from every distance.
    fn pairs(&self) -> usize {
        self.sighted.iter().map(|sighted| sighted.study.alternatives.len()).sum()
    }
}

/// A rule with everything it names looked up and checked.
#[derive(Debug, Clone)]
pub struct RuleStudy {
    rule: Rule,
    envelope: Envelope,
    candidates: Vec<Candidate>,
    required: f64,
    warnings: Vec<Warning>,
    looked_up: Work,
}

impl RuleStudy {
    /// Looks up everything that `rule` names, materials in `library`.
    ///
    /// # Errors
    /// As [`Study::new`]; two cameras of one name; a requirement by another than the nearest distance.
    ///
    /// ```
    /// use hadar::material::Library;
    /// use hadar_study::{scenario::Rule, study::{RuleAsked, RuleStudy}};
    /// let text = r#"
    ///     cameras = ["ideal-pnrd"]
    ///     [target]
    ///     material = "skin"
    ///     temperature = "37 degC"
    ///     [[environment]]
    ///     temperature = "20 degC"
    ///     lighting = 0.5
    ///     [alternatives]
    ///     materials = ["pmma"]
    ///     [bands]
    ///     start = "750 cm^-1"
    ///     stop = "1250 cm^-1"
    ///     step = "100 cm^-1"
    ///     [envelope]
    ///     temperature = ["30 degC", "37 degC"]
    /// "#;
    /// let study = RuleStudy::new(&Rule::from_toml(text, None)?, &Library::embedded()?)?;
    /// let answer = study.answer(&RuleAsked::default(), &|_, _| ())?;
    /// assert!(answer.cameras[0].passes);
    /// assert!(answer.cameras[0].limiting.temperature_k < 304.0);
    /// # Ok::<(), hadar::Error>(())
    /// ```
    pub fn new(rule: &Rule, library: &Library) -> Result<Self> {
        let place = |key: &str| rule.scenario.place(key);
        if rule.scenario.requirement.by != DistanceKind::Nearest {
            let found = "an envelope is searched by the nearest distance only";
            let error = Error::malformed(found, "write by = \"nearest\", or leave the key out");
            return Err(error.at(place("requirement.by")));
        }
        let envelope = rule.envelope();
        let materials = envelope.materials.clone().unwrap_or_default();
        for (index, material) in materials.iter().enumerate() {
            if let MaterialRef::Name(name) = material {
                let key = format!("envelope.materials[{index}]");
                library.get(name).map_err(|error| error.at(place(&key)))?;
            }
        }
        let mut filled = rule.clone();
        filled.scenario.envelope = Some(envelope.clone());
        let mut candidates: Vec<Candidate> = Vec::with_capacity(rule.cameras.len());
        let mut warnings: Vec<Warning> = Vec::new();
        let mut alternatives: Vec<MaterialRef> = Vec::new();
        for index in 0..rule.cameras.len() {
            let candidate = candidate(rule, index, &envelope, library)?;
            if candidates.iter().any(|other| other.name == candidate.name) {
                let found = format!("another camera is called {} too", candidate.name);
                let error = Error::malformed(found, "give it a name of its own, as in name = \"ours\"");
                return Err(error.at(rule.camera_place(index, "name")));
            }
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
                // Every default of the camera, and what the scenario left silent.
                filled.cameras[index].spec = study.scenario.camera.clone().unwrap_or_default();
                let Study { scenario, .. } = study;
                filled.scenario.alternatives = scenario.alternatives.clone();
            }
            candidates.push(candidate);
        }
        filled.scenario.alternatives.materials = Some(alternatives);
        // Where nothing is said of them, cameras may have bands of their own.
        let near = || candidates.iter().flat_map(|candidate| &candidate.near);
        let source = near().next().map(|study| study.scenario.bands.source.clone());
        if let Some(source) = source.filter(|one| near().all(|study| study.scenario.bands.source == *one)) {
            filled.scenario.bands.source = source;
        }
        let first = candidates.first().and_then(|candidate| candidate.near.first());
        let required = first.map_or(1.0, |study| study.required);
        let looked_up = library.work();
        Ok(Self { rule: filled, envelope, candidates, required, warnings, looked_up })
    }

    /// The rule with its defaults filled in.
    #[must_use]
    pub fn rule(&self) -> &Rule {
        &self.rule
    }

    /// The first camera before the first material, from the least distance: what all of them share.
    #[must_use]
    pub fn study(&self) -> Option<&Study> {
        self.candidates.first().and_then(|candidate| candidate.near.first())
    }

    /// What the rule says of every camera; `progress` is told how many pairs of materials before a camera are done.
    ///
    /// # Errors
    /// A scene without photons; a file that can no longer be read.
    pub fn answer(&self, asked: &RuleAsked, progress: &dyn Fn(usize, usize)) -> Result<RuleAnswer> {
        let ledger = Ledger::open();
        demand::add(&self.looked_up);
        let alone = asked.verdict_only && asked.skipping == Skipping::On;
        let mut cameras = Vec::with_capacity(self.candidates.len());
        let all = self.candidates.iter().map(Candidate::pairs).sum();
        let mut before = 0;
        for candidate in &self.candidates {
            let pairs = candidate.pairs();
            cameras.push(self.judged(candidate, alone, &|done| progress(before + done.min(pairs), all))?);
            before += pairs;
            progress(before, all);
        }
        let not_identifiable = if alone {
            demand::spared(Thing::Sections, Reason::NotAsked, 1);
            None
        } else {
            demand::computed(Thing::Sections, 1);
            Some(self.not_identifiable(asked.seed)?)
        };
        let envelope = self.envelope_result();
        let requirement = self.requirement(&cameras, &envelope, alone);
        Ok(RuleAnswer {
            rule: self.rule.clone(),
            sentence: who_meets(&cameras),
            requirement,
            envelope,
            cameras,
            not_identifiable,
            warnings: self.warnings.clone(),
            stats: ledger.close(),
        })
    }

    fn envelope_result(&self) -> EnvelopeResult {
        let point = |value: f64| [value; 2];
        let scenario = &self.rule.scenario;
        let objects = &scenario.environment;
        let studies = self.candidates.iter().flat_map(|candidate| &candidate.near);
        let (mut materials, mut alternatives): (Vec<String>, Vec<String>) = (Vec::new(), Vec::new());
        for study in studies {
            let add = |names: &mut Vec<String>, name: &str| {
                if !names.iter().any(|known| known == name) {
                    names.push(name.to_owned());
                }
            };
            add(&mut materials, &study.target.name);
            study.alternatives.iter().for_each(|surface| add(&mut alternatives, &surface.name));
        }
        let Envelope { temperature_k, lighting, surroundings_k, distance_m, .. } = self.envelope.clone();
        EnvelopeResult {
            temperature_k: temperature_k.unwrap_or(point(scenario.target.temperature_k)),
            lighting: lighting.unwrap_or_else(|| objects.iter().map(|o| point(o.lighting)).collect()),
            surroundings_k: surroundings_k
                .unwrap_or_else(|| objects.iter().map(|o| point(o.temperature_k)).collect()),
            distance_m,
            materials,
            alternatives,
        }
    }

    fn requirement(
        &self,
        cameras: &[CameraVerdict],
        envelope: &EnvelopeResult,
        alone: bool,
    ) -> RuleRequirement {
        let hardware: Option<Vec<f64>> = cameras.iter().map(|camera| camera.limiting.hardware_m2_s).collect();
        let hardware = hardware.filter(|_| !alone);
        let hardware_m2_s = hardware.map(|each| each.into_iter().fold(0.0, f64::max));
        let speed_m_s = self.rule.scenario.requirement.speed_m_s;
        // A target smaller than its pixel, or air, takes light away that the figure of the hardware does not know of.
        let plain = self.rule.scenario.target.size_m.is_none() && self.rule.scenario.atmosphere.is_none();
        let quotable = Quotable {
            envelope: envelope.clone(),
            required: self.required,
            speed_m_s,
            hardware_m2_s: hardware_m2_s.filter(|_| plain),
            units: self.rule.scenario.units(),
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
fn candidate(rule: &Rule, index: usize, envelope: &Envelope, library: &Library) -> Result<Candidate> {
    // Mistakes of the camera are told by the key that it has in the rule.
    let spec = rule.cameras.get(index).map(|camera| &camera.spec);
    if let Some(camera) = rule.cameras.get(index).filter(|camera| camera.is_listed()) {
        complete(camera).map_err(|error| error.at(rule.camera_place(index, "preset")))?;
    }
    let camera = spec.map(|spec| super::camera::resolved_at(spec, &|key| rule.camera_place(index, key)));
    let camera = camera.transpose()?;
    let mut scenario = rule.with_camera(index);
    let (mut sighted, mut near, mut distance_matters) = (Vec::new(), Vec::new(), false);
    let (mut between, mut share) = (Vec::new(), 1.0_f64);
    for material in envelope.materials.iter().flatten() {
        scenario.target.material = material.clone();
        let mut at = |distance_m: Option<f64>| {
            scenario.target.distance_m = distance_m;
            Study::new(&scenario, library).and_then(|study| Sighted::new(study, envelope))
        };
        let [least, most] = match envelope.distance_m {
            Some([least, most]) => [Some(least), Some(most)],
            None => [None; 2],
        };
        let close = at(least)?;
        near.push(close.study.clone());
        if least == most {
            sighted.push(close);
            continue;
        }
        let air = close.study.atmosphere.as_ref().zip(least.zip(most));
        if let Some((air, (_, most))) = air {
            let place = |error: Error| error.at(rule.scenario.place("envelope.distance"));
            air.table.optical_depth(&[], most).map_err(place)?;
        }
        let far = at(most)?;
        distance_matters |= far.differs_from(&close, NOTICEABLE);
        if let Some((_, (least, most))) = air {
            match close.share_of_far(&far, [least, most])? {
                Some(one) => share = share.min(one),
                None => {
                    let inner = steps([least, most]).skip(1).take(DISTANCES - 2);
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
    let given = rule.cameras.get(index).and_then(|camera| camera.name.clone());
    let own = camera.map(|camera| camera.name).filter(|_| spec.is_some_and(|spec| spec.preset.is_some()));
    let name = given.or(own).unwrap_or_else(|| format!("camera {}", index + 1));
    Ok(Candidate { name, sighted, distance_matters, between, share, near })
}

/// Distances of a range that are searched, equal steps of ln z apart.
fn steps([least, most]: [f64; 2]) -> impl Iterator<Item = f64> {
    let share = |i: usize| i as f64 / (DISTANCES - 1) as f64;
    (0..DISTANCES).map(move |i| least * (most / least).powf(share(i)))
}

/// Refuses a known camera, named alone, of which no document states all that is needed.
fn complete(camera: &RuleCamera) -> Result<()> {
    let Some(name) = &camera.spec.preset else { return Ok(()) };
    let Err(missing) = presets::find(name)?.camera() else { return Ok(()) };
    let found = format!("no document that was read states {} of {name}", missing.0.join(", "));
    let instead = "write it as a table of its own, with what the camera has in place of the dots:".into();
    let head = [String::from("[[camera]]"), format!("preset = {name:?}")];
    Err(Error::Incomplete { found, instead, lines: head.into_iter().chain(missing.lines()).collect() })
}

/// Which cameras meet the rule.
fn who_meets(cameras: &[CameraVerdict]) -> WhoMeets {
    let mut who =
        WhoMeets { meet: Vec::new(), unproved: Vec::new(), fail: Vec::new(), placeholders: Vec::new() };
    for camera in cameras {
        match camera.passes {
            true => who.meet.push((camera.name.clone(), camera.provided)),
            false => who.fail.push(camera.name.clone()),
        }
        if camera.warnings.contains(&Warning::NotProved) {
            who.unproved.push(camera.name.clone());
        }
        let LimitingScene { target, alternative, placeholders, .. } = &camera.limiting;
        if let Some(numbers) = placeholders {
            let pair = (target.clone(), alternative.clone(), *numbers);
            if !who.placeholders.contains(&pair) {
                who.placeholders.push(pair);
            }
        }
    }
    who
}
