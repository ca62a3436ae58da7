//! Yes, no or undecided, with what it rests on and how sure it is.

use crate::condition::{Condition, hardest_first};
use crate::decision::YesNo;
use crate::grade::Grade;
use crate::identify::NearestProof;
use crate::rests_on::Reached;
use crate::size::RequirementResult;
use crate::{Check, ClassAnswer, Shortfall, Study};
use hadar::demand::{Skipping, Work};
use hadar::error::Result;
use hadar::fisher::Nuisance;
use hadar::identifiability::Status;
use hadar::identifiability::decision::DecisionLaw;
use hadar::instrument::Camera;
use hadar_scenario::{DistanceKind, Scenario};

/// The answer to 'can this camera do it' by the cheapest proofs, and no more.
#[derive(Debug, Clone, serde::Serialize)]
#[non_exhaustive]
pub struct VerdictAlone {
    /// The scenario with its defaults filled in.
    pub scenario: Scenario,
    /// Yes or no; the distance reached is not known.
    pub verdict: Verdict,
    /// The first alternative found that the camera does not tell; there may be more.
    pub not_told_from: Option<String>,
    /// What was computed and what was skipped, with the time.
    pub stats: Work,
}

/// Yes or no.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Verdict {
    /// Whether the requirement is met; `None` without a camera.
    pub met: Option<bool>,
    /// What it is not met by; empty if it is met or there is no camera.
    pub fails_by: Vec<Shortfall>,
    /// Yes, no, or that neither is shown; `None` without a camera.
    pub answer: Option<YesNo>,
    /// What it is of: one pixel, or the object.
    pub scope: &'static str,
    /// The answer, in JSON a sentence.
    pub sentence: Finding,
    /// Statistical distance that the camera reaches against the limiting alternative.
    pub statistical_distance: Option<f64>,
    /// The limit of it, whichever distance decides: that of the nearest.
    pub statistical_distance_nearest: Option<f64>,
    /// What the distance is at least: proved.
    pub lower: Option<f64>,
    /// What it is at most: a state that was found shows it.
    pub upper: Option<f64>,
    /// Statistical distance d that is required of the camera.
    pub required_distance: f64,
    /// The least over that demanded.
    pub margin: Option<f64>,
    /// What a 'yes' rests on, hardest first; of a 'no' what was taken on the unfavourable side.
    pub conditions: Vec<Condition>,
    /// Codes of conditions that whoever asks accepts.
    pub accepted: Vec<String>,
    /// How sure it is; `None` without a camera.
    pub grade: Option<Grade>,
}

impl Verdict {
    /// Conditions that are favourable and not among the accepted codes: with one of them, a 'yes' is none that a program may rely on.
    pub fn open(&self) -> impl Iterator<Item = &Condition> {
        Condition::unaccepted(&self.conditions, &self.accepted)
    }
}

/// What there is to be said of a camera, target and alternative.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// Name of the camera; empty without one.
    pub camera: String,
    /// The target.
    pub target: String,
    /// What it is to be told from; every alternative where `None`.
    pub alternative: Option<String>,
    /// Statistical distance demanded.
    pub required: f64,
    /// Which distance decides: only the nearest is a limit.
    pub by: DistanceKind,
    /// What was found.
    pub answer: Answer,
    /// Emissivities of the two, where each is entered as one number.
    pub placeholders: Option<[f64; 2]>,
    /// Where target or alternative is a class, what its members say together.
    pub classes: Option<Box<ClassAnswer>>,
    /// What a 'yes' rests on, hardest first.
    pub conditions: Vec<Condition>,
    /// Pixels on the target, where it is more than one.
    pub pixels: Option<f64>,
    /// Whether all of them decide together.
    pub of_object: bool,
}

/// What was found.
#[derive(Debug, Clone, PartialEq)]
pub enum Answer {
    /// No photons suffice: the spectra are equal.
    NothingDiffers,
    /// No photons suffice: the unknowns imitate the other material.
    UnknownsExplain,
    /// The unknowns are as many as the bands, and so imitate the other material.
    TooFewBands {
        /// Number of bands.
        bands: usize,
        /// What is unknown.
        unknowns: Vec<Nuisance>,
    },
    /// There is no camera to judge.
    Takes {
        /// Photons by the distance that decides, as it was found: fewer do not suffice.
        photons: f64,
        /// Photons by what is proved of it; `None` where nothing is.
        enough: Option<f64>,
        /// Photons that any camera needs, by the nearest; none suffice where `None`.
        limit: Option<f64>,
    },
    /// The camera was judged.
    Judged {
        /// Whether the statistical distance is reached.
        enough: bool,
        /// Whether what is proved does not reach it and what was found does.
        undecided: bool,
        /// What is wrong with the image.
        spoiled: Vec<Shortfall>,
        /// Statistical distance that a state which was found allows, where it is known.
        reached: Option<f64>,
        /// What is proved of it.
        proved: Option<f64>,
        /// Whether counts are so few that their own law decides.
        few_counts: bool,
        /// That of the nearest distance, where it is known.
        limit: Option<f64>,
    },
}

impl Study {
    /// Whether the camera misses the requirement, ending at the first proof; `None` without a camera, and where it meets it: what a 'yes'
    /// rests on takes the whole answer.
    ///
    /// # Errors
    /// As [`Study::told_apart`].
    pub fn no_alone(&self) -> Result<Option<VerdictAlone>> {
        let Some(camera) = &self.camera else { return Ok(None) };
        let check = self.check(Skipping::On)?;
        let result = self.camera_result(self.photon_radiance());
        let spoiled = self.spoiled(result.as_ref());
        // Where it is no proof that ends the check, what is not told may be undecided.
        let by_proof = self.scenario.requirement.by == DistanceKind::Nearest
            && !self.proof_leaves_priors_out()
            && check.failed.is_some();
        if spoiled.is_empty() && (check.identifiable || !by_proof) {
            return Ok(None);
        }
        let mut is_apart = false;
        if let (true, Some(index), Some(counting)) = (spoiled.is_empty(), check.failed, self.counting()) {
            // Not to be proved is not to be impossible: a state that was found has to show it.
            let own = self.against(index);
            let kind = self.scenario.requirement.by;
            let decision = own.decided(kind, &own.alternatives[index], &counting)?;
            if decision.told != YesNo::No {
                return Ok(None);
            }
            is_apart = kind == DistanceKind::Nearest && decision.found.distance > 0.0;
        }
        let alternative = match (&check.not_told_from, self.alternatives.as_slice()) {
            (Some(name), _) => Some(name.clone()),
            (None, [only]) => Some(only.name.clone()),
            (None, _) => None,
        };
        let index = check.failed.or((self.alternatives.len() == 1).then_some(0));
        let judged = Answer::Judged {
            enough: check.identifiable,
            undecided: false,
            spoiled: spoiled.clone(),
            reached: None,
            proved: None,
            few_counts: false,
            limit: None,
        };
        let brightest = self.brightest_member(camera);
        let mut conditions = self.unstated(camera, brightest);
        conditions.retain(|one| one.counts(false));
        hardest_first(&mut conditions);
        let sentence = Finding {
            camera: camera.name.clone(),
            target: self.target.name.clone(),
            required: self.required,
            by: self.scenario.requirement.by,
            answer: self.too_few_bands().filter(|_| !check.identifiable && !is_apart).unwrap_or(judged),
            placeholders: alternative.as_deref().and_then(|name| self.one_numbers(name)),
            classes: index.and_then(|index| self.classes.get(index)).cloned().map(Box::new),
            alternative,
            conditions: conditions.clone(),
            pixels: self.pixels_on_target(camera),
            of_object: self.scenario.is_of_object(),
        };
        let by_distance = (!check.identifiable).then_some(Shortfall::Distance);
        let verdict = Verdict {
            met: Some(false),
            fails_by: by_distance.into_iter().chain(spoiled).collect(),
            answer: Some(YesNo::No),
            scope: self.scenario.scope().name(),
            sentence,
            statistical_distance: None,
            statistical_distance_nearest: None,
            lower: None,
            upper: None,
            required_distance: self.required,
            margin: None,
            grade: Some(Grade::Proved.under(&conditions)),
            conditions,
            accepted: Vec::new(),
        };
        let Check { scenario, not_told_from, stats, .. } = check;
        Ok(Some(VerdictAlone { scenario, verdict, not_told_from, stats }))
    }

    pub(super) fn verdict(
        &self,
        reached: &Reached<'_>,
        index: usize,
        requirement: &RequirementResult,
        spoiled: Vec<Shortfall>,
    ) -> Result<Verdict> {
        let pair = reached.pair;
        let (distance, limit) = (pair.statistical_distance, pair.statistical_distance_nearest);
        let mixtures = self.classes.get(index).and_then(|answer| answer.mixtures.as_ref());
        let proved = mixtures.map(|found| found.distance_lower);
        let far_enough = pair.told_apart;
        let met = far_enough.map(|enough| enough && spoiled.is_empty());
        let few_counts = pair.decided_by.is_some_and(|law| law != DecisionLaw::Gaussian);
        let bounds = pair.statistical_distance_bounds;
        let lower = bounds.map(|[lower, _]| proved.map_or(lower, |proved| lower.min(proved)));
        let upper = bounds.map(|[_, upper]| mixtures.map_or(upper, |found| upper.min(found.distance)));
        let answer = pair.told.map(|told| if spoiled.is_empty() { told } else { YesNo::No });
        let conditions = match &self.camera {
            Some(camera) => self.conditions(camera, met == Some(true), reached)?,
            None => Vec::new(),
        };
        let mut fails_by = if far_enough == Some(false) { vec![Shortfall::Distance] } else { Vec::new() };
        fails_by.extend(&spoiled);
        // Ranges of the unknowns may leave a distance where bands are no more than these.
        let by_nearest = self.scenario.requirement.by == DistanceKind::Nearest;
        let is_apart = by_nearest && limit.is_some_and(|limit| limit > 0.0);
        let few = self.too_few_bands().filter(|_| far_enough != Some(true) && !is_apart);
        let [least, enough] = requirement.photons_bounds;
        let found = match (distance, least, pair.status) {
            (_, None, Status::Identical | Status::Equilibrium) => Answer::NothingDiffers,
            (_, _, Status::Blind) if few.is_some() => few.unwrap_or(Answer::UnknownsExplain),
            (_, None, Status::Ok | Status::Blind) if !(is_apart && distance.is_some()) => {
                Answer::UnknownsExplain
            }
            (None, Some(photons), _) => {
                Answer::Takes { photons, enough, limit: requirement.photons_by.nearest }
            }
            _ => Answer::Judged {
                enough: far_enough == Some(true),
                undecided: pair.told == Some(YesNo::Undecided),
                spoiled,
                reached: upper,
                proved: lower,
                few_counts,
                limit,
            },
        };
        let proved =
            pair.proof == NearestProof::Proved && self.scenario.requirement.by == DistanceKind::Nearest;
        // What few counts decide is bounded between two states by photons alone, without what priors say of these.
        let proved = proved && !(few_counts && self.unknowns.has_priors());
        // With shared errors the contrast of one state stands for those of all.
        let proved = proved && self.errors_shared().is_none();
        let found_by = if proved { Grade::Proved } else { Grade::Searched };
        let grade = answer.map(|_| found_by.under(&conditions));
        let sentence = Finding {
            camera: self.camera.as_ref().map_or_else(String::new, |camera| camera.name.clone()),
            target: pair.target.clone(),
            alternative: Some(pair.alternative.clone()),
            required: self.required,
            by: self.scenario.requirement.by,
            answer: found,
            placeholders: self.one_numbers(&pair.alternative),
            classes: self.classes.get(index).cloned().map(Box::new),
            conditions: conditions.clone(),
            pixels: self.camera.as_ref().and_then(|camera| self.pixels_on_target(camera)),
            of_object: self.scenario.is_of_object(),
        };
        Ok(Verdict {
            met,
            fails_by,
            answer,
            scope: self.scenario.scope().name(),
            sentence,
            statistical_distance: distance,
            statistical_distance_nearest: limit,
            lower,
            upper,
            required_distance: self.required,
            margin: lower.map(|lower| lower / self.required),
            conditions,
            accepted: Vec::new(),
            grade,
        })
    }

    /// Pixels on a target of a known size, where it is more than one.
    fn pixels_on_target(&self, camera: &Camera) -> Option<f64> {
        let target = &self.scenario.target;
        if self.scenario.is_of_object() {
            return Some(self.extent(camera, target.distance_m).pixels());
        }
        let across = target.size_m? / camera.footprint_m(target.distance_m?);
        (across > 1.0).then_some(across * across)
    }

    /// Emissivities of the target and of an alternative by its name, where each is entered as one number.
    pub(crate) fn one_numbers(&self, alternative: &str) -> Option<[f64; 2]> {
        self.target.placeholders(self.alternative(alternative)?)
    }

    /// That there are no more bands than unknowns, where it is so.
    fn too_few_bands(&self) -> Option<Answer> {
        let unknowns = self.decisive_unknowns();
        (!self.enough_bands(&unknowns)).then(|| {
            let named = Nuisance::ALL.into_iter().filter(|nuisance| unknowns.contains(*nuisance));
            Answer::TooFewBands { bands: self.bands.len(), unknowns: named.collect() }
        })
    }
}
