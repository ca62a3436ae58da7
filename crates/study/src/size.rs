//! The main job: does the camera meet the requirement, and what would it have to be.

use super::identify::{NearestProof, PairResult, PhotonsRequired};
use super::{Check, ClassAnswer, Companion, Shortfall, Study, Surface, Warning};
use crate::condition::{Condition, Sureness, hardest_first};
use crate::rests_on::Reached;
use hadar::demand::{self, Ledger, Skipping, Work};
use hadar::error::Result;
use hadar::fisher::Nuisance;
use hadar::identifiability::{Status, detection};
use hadar::instrument::{Camera, NoiseLine, gamma_per_band};
use hadar::policy::caps::{self, Circumstances};
use hadar::policy::{self, CameraTask, Motion, Quantity, Solution, TradeOff, Trial};
use hadar_scenario::{DistanceKind, Scenario};
use serde::ser::{SerializeMap, Serializer};

mod curves;
mod reach;
pub(crate) mod sensitivity;
mod trade_offs;

pub(super) use curves::logarithmic;
pub use curves::{InformationCurves, PhotonMap, Spectra};
pub(super) use reach::{Reach, Solvers};
pub use sensitivity::{Elasticities, EmissivityErrors, ScatterOf, Sensitivity};

/// What a verdict is of.
const PIXEL: &str = "pixel";

/// The answer to 'can this camera do it'.
#[derive(Debug, Clone, serde::Serialize)]
#[non_exhaustive]
pub struct Sizing {
    /// The scenario with its defaults filled in.
    pub scenario: Scenario,
    /// Yes or no, in a sentence and in numbers.
    pub verdict: Verdict,
    /// What the task demands of any camera.
    pub requirement: RequirementResult,
    /// What this camera delivers; `None` without a camera.
    pub camera: Option<CameraResult>,
    /// Each hardware quantity with the others held, for the limiting alternative; `None` without a camera, or where it was not asked for.
    pub solve_for: Option<Solutions>,
    /// What the verdict hangs on; `None` without a camera, or where it was not asked for.
    pub sensitivity: Option<Sensitivity>,
    /// Two quantities at a time, where they were asked for ([`Study::trade_offs`]).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub trade_offs: Option<Vec<TradeOff>>,
    /// ΣS·Δν of the target, photons s⁻¹ m⁻² sr⁻¹.
    pub photon_radiance: f64,
    /// All alternatives.
    pub pairs: Vec<PairResult>,
    /// The alternative that is hardest to tell apart.
    pub limiting: String,
    /// What sizing practice says of the camera; `None` without a camera or without target.size.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub companion: Option<Companion>,
    /// What the members of classes say together, alternative by alternative; empty without classes.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub classes: Vec<ClassAnswer>,
    /// What the reader must know.
    pub warnings: Vec<Warning>,
    /// What it took.
    pub stats: Work,
}

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
    /// What it took.
    pub stats: Work,
}

/// Parts of a sizing beside its verdict; all of them where nobody says otherwise.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SizeAsked {
    /// Every quantity of the camera solved for.
    pub solutions: bool,
    /// What the verdict hangs on.
    pub sensitivity: bool,
}

impl Default for SizeAsked {
    fn default() -> Self {
        Self { solutions: true, sensitivity: true }
    }
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
    /// What it is of: one pixel.
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
    /// Statistical distance demanded.
    pub required_distance: f64,
    /// The least over that demanded.
    pub margin: Option<f64>,
    /// What a 'yes' rests on, hardest first; of a 'no' what was taken on the unfavourable side.
    pub conditions: Vec<Condition>,
    /// Codes of conditions that whoever asks accepts.
    pub accepted: Vec<String>,
    /// How sure it is; `None` without a camera.
    pub grade: Option<Sureness>,
}

hadar::named! {
    /// A verdict.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum YesNo {
        /// The requirement is met, under the conditions that are listed.
        Yes = "yes",
        /// It is not.
        No = "no",
        /// What is proved does not reach it, what was found does.
        Undecided = "undecided",
    }
    /// The name in JSON.
    name
}

impl Verdict {
    /// Conditions that are favourable and not among the accepted codes: with one of them, a 'yes' is none that a program may rely on.
    pub fn open(&self) -> impl Iterator<Item = &Condition> {
        Condition::open(&self.conditions).filter(|one| !self.accepted.contains(&one.code()))
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
        /// Photons by the distance that decides.
        photons: f64,
        /// Photons that any camera needs, by the nearest; none suffice where `None`.
        limit: Option<f64>,
    },
    /// The camera was judged.
    Judged {
        /// Whether the statistical distance is reached.
        enough: bool,
        /// What is wrong with the image.
        spoiled: Vec<Shortfall>,
        /// Statistical distance reached, where it is known.
        reached: Option<f64>,
        /// That of the nearest distance, where it is known.
        limit: Option<f64>,
    },
}

/// What the task demands of any camera, against the limiting alternative.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct RequirementResult {
    /// Which distance decides.
    pub by: &'static str,
    /// Statistical distance demanded.
    pub distance: f64,
    /// Detection probability demanded, Φ of it.
    pub detection_probability: f64,
    /// Photons at the detector, shot noise only.
    pub photons: Option<f64>,
    /// H_req = t A_p/((1+γ)F²) by the paper's inequality, m² s, lossless optics.
    pub hardware_m2_s: Option<f64>,
    /// Photons by each reading of the distance.
    pub photons_by: PhotonsRequired,
    /// H_req by each reading, m² s.
    pub hardware_by_m2_s: PhotonsRequired,
}

/// What the camera delivers in the scene.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct CameraResult {
    /// Its figures.
    #[serde(flatten)]
    pub camera: Camera,
    /// Photons of the target in all bands of all frames.
    pub photons: f64,
    /// Photons of the brightest band in one exposure: what the full well must hold.
    pub brightest_reading: f64,
    /// Electronic noise of a band (root mean square over the bands, all frames), counts.
    pub noise_counts: f64,
    /// γ = Σσ²/ΣN of the scene.
    pub gamma_per_band: f64,
    /// Étendue of a pixel, m² sr.
    pub etendue_m2_sr: f64,
    /// H = t A_p/((1+γ)F²), m² s.
    pub hardware_m2_s: f64,
    /// Least distance per √photon it resolves, d_req √((1+γ)/N).
    pub least_distance: f64,
    /// Time until all bands of all frames are read, s.
    pub acquisition_s: f64,
    /// Side of a pixel's footprint at the target, m.
    pub footprint_m: Option<f64>,
    /// Apparent motion during an exposure, pixels.
    pub motion_blur_pixels: Option<f64>,
    /// Variance of an average band, line by line.
    pub noise_budget: Vec<NoiseLine>,
}

/// Solutions by quantity, in the order of [`Quantity::ALL`].
#[derive(Debug, Clone, PartialEq)]
pub struct Solutions(pub Vec<(Quantity, Solution)>);

impl serde::Serialize for Solutions {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.0.len()))?;
        for (quantity, solution) in &self.0 {
            map.serialize_entry(quantity.key(), solution)?;
        }
        map.end()
    }
}

impl Study {
    /// The verdict on the scenario's camera, the requirement, and every hardware quantity solved for.
    ///
    /// # Errors
    /// As [`Study::identify`].
    pub fn size(&self) -> Result<Sizing> {
        self.size_with(SizeAsked::default())
    }

    /// The same with its trade-offs.
    ///
    /// # Errors
    /// As [`Study::identify`].
    pub fn size_with_curves(&self) -> Result<Sizing> {
        let mut result = self.size()?;
        let (trade_offs, work) = demand::ledger_of(|| self.trade_offs(&result))?;
        result.trade_offs = Some(trade_offs);
        result.stats.add(&work);
        Ok(result)
    }

    /// The same with those parts alone that are asked for.
    ///
    /// # Errors
    /// As [`Study::identify`].
    pub fn size_with(&self, asked: SizeAsked) -> Result<Sizing> {
        let identification = self.identify()?;
        let ledger = Ledger::open();
        demand::add(&identification.stats);
        let mut warnings = identification.warnings.clone();
        let limiting = self.limiting(&identification.pairs);
        let Some((index, pair)) = limiting.and_then(|index| Some((index, identification.pairs.get(index)?)))
        else {
            return Err(hadar::Error::malformed(
                "there is no alternative",
                "name one in alternatives.materials",
            ));
        };
        // Of a class the member that is nearest to this alternative.
        let own = self.against(index);
        let (surface, photon_radiance) = (&own.alternatives[index], own.photon_radiance());
        let requirement = own.requirement(pair, index, photon_radiance);
        let camera = own.camera_result(photon_radiance);
        let solve_for = match &own.camera {
            Some(camera) if asked.solutions => Some(own.solutions(camera, surface)?),
            _ => None,
        };
        let sensitivity = match &own.camera {
            Some(camera) if asked.sensitivity => Some(own.sensitivity(camera, surface, index)?),
            _ => None,
        };
        if let Some(camera) = &camera {
            warnings.extend(own.camera_result_warnings(camera, pair));
        }
        if solve_for.is_some() && self.classes.get(index).is_some_and(|answer| answer.pairs > 1) {
            warnings.push(Warning::SolvedForOnePair {
                target: pair.target.clone(),
                alternative: pair.alternative.clone(),
            });
        }
        let companion = match (&own.camera, own.scenario.target.size_m) {
            (Some(_), Some(_)) => Some(own.companion(pair, None)?),
            _ => None,
        };
        let mut scenario = identification.scenario;
        if sensitivity.is_some() {
            scenario.sensitivity.get_or_insert_default();
        }
        let brightest = camera.as_ref().map_or(0.0, |camera| own.brightest_member(&camera.camera));
        let errors = sensitivity.as_ref().map(|found| [found.emissivity.error, found.emissivity.share_met]);
        let reached = Reached { pair, errors, brightest };
        let verdict = own.verdict(&reached, index, &requirement, own.spoiled(camera.as_ref()))?;
        Ok(Sizing {
            scenario,
            verdict,
            requirement,
            camera,
            solve_for,
            sensitivity,
            trade_offs: None,
            photon_radiance,
            pairs: identification.pairs,
            limiting: identification.limiting,
            companion,
            classes: identification.classes,
            warnings,
            stats: ledger.close(),
        })
    }

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
        if check.identifiable && spoiled.is_empty() {
            return Ok(None);
        }
        let alternative = match (&check.not_told_from, self.alternatives.as_slice()) {
            (Some(name), _) => Some(name.clone()),
            (None, [only]) => Some(only.name.clone()),
            (None, _) => None,
        };
        let index = check.failed.or((self.alternatives.len() == 1).then_some(0));
        let judged = Answer::Judged {
            enough: check.identifiable,
            spoiled: spoiled.clone(),
            reached: None,
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
            answer: self.too_few_bands().filter(|_| !check.identifiable).unwrap_or(judged),
            placeholders: alternative.as_deref().and_then(|name| self.one_numbers(name)),
            classes: index.and_then(|index| self.classes.get(index)).cloned().map(Box::new),
            alternative,
            conditions: conditions.clone(),
            pixels: self.pixels_on_target(camera),
        };
        let by_distance = (!check.identifiable).then_some(Shortfall::Distance);
        let verdict = Verdict {
            met: Some(false),
            fails_by: by_distance.into_iter().chain(spoiled).collect(),
            answer: Some(YesNo::No),
            scope: PIXEL,
            sentence,
            statistical_distance: None,
            statistical_distance_nearest: None,
            lower: None,
            upper: None,
            required_distance: self.required,
            margin: None,
            conditions,
            accepted: Vec::new(),
            grade: Some(Sureness::Proved),
        };
        let Check { scenario, not_told_from, stats, .. } = check;
        Ok(Some(VerdictAlone { scenario, verdict, not_told_from, stats }))
    }

    fn requirement(&self, pair: &PairResult, index: usize, photon_radiance: f64) -> RequirementResult {
        let hardware = |photons: Option<f64>| {
            photons.map(|photons| policy::hardware_required_m2_s(photons, photon_radiance))
        };
        // Of classes the pair that asks for the most photons may be a bright one: that which asks for the most hardware decides that.
        let least = self.classes.get(index).and_then(|answer| answer.least_information);
        let photons_of_any = |photons: f64| match least {
            Some(least) if self.scenario.requirement.by == DistanceKind::Nearest => {
                photons.max(self.required.powi(2) * photon_radiance / least)
            }
            _ => photons,
        };
        let by = pair.photons_required_by;
        RequirementResult {
            by: self.scenario.requirement.by.name(),
            distance: self.required,
            detection_probability: detection::probability(self.required),
            photons: pair.photons_required,
            hardware_m2_s: hardware(pair.photons_required.map(photons_of_any)),
            photons_by: by,
            hardware_by_m2_s: PhotonsRequired {
                nearest: hardware(by.nearest.map(photons_of_any)),
                local: hardware(by.local),
                local_unknown_gain: hardware(by.local_unknown_gain),
            },
        }
    }

    pub(super) fn camera_result(&self, photon_radiance: f64) -> Option<CameraResult> {
        let camera = self.camera.as_ref()?;
        let counting = self.counting()?;
        let signal = self.target_signal();
        let photons = counting.counts_per_radiance * photon_radiance;
        let gamma = gamma_per_band(&counting, &signal);
        let distance_m = self.scenario.target.distance_m;
        let blur = self.scenario.requirement.speed_m_s.and_then(|speed| {
            let time_s = camera.sweep_s(self.bands.len());
            Motion::of(camera, distance_m).map(|motion| motion.blur_pixels(speed, time_s))
        });
        let var: f64 = (0..self.bands.len()).map(|w| counting.var_added(w)).sum();
        Some(CameraResult {
            photons,
            brightest_reading: camera.brightest_reading(&self.bands, &signal, &self.view_of(camera)),
            noise_counts: (var / self.bands.len() as f64).sqrt(),
            gamma_per_band: gamma,
            etendue_m2_sr: camera.etendue_m2_sr(distance_m),
            hardware_m2_s: camera.hardware_m2_s(gamma),
            least_distance: policy::least_distance(self.required, photons, gamma),
            acquisition_s: camera.acquisition_s(self.bands.len()),
            footprint_m: distance_m.map(|z| camera.footprint_m(z)),
            motion_blur_pixels: blur,
            noise_budget: camera.noise_budget(&self.bands, &signal, &self.view_of(camera)),
            camera: camera.clone(),
        })
    }

    /// What the scenario demands of its camera.
    pub(super) fn task<'a>(&'a self, camera: &'a Camera) -> CameraTask<'a> {
        let distance_m = self.scenario.target.distance_m;
        CameraTask {
            camera,
            bands: &self.bands,
            required: self.required,
            distance_m,
            farthest_m: self.atmosphere.as_ref().map(|air| air.table.longest_m()),
            size_m: self.scenario.target.size_m,
        }
    }

    /// Counts of the fullest reading of a trial.
    pub(super) fn brightest(&self, trial: &Trial) -> Result<f64> {
        // From its own distance the bands are those of the scene.
        if trial.distance_m == self.scenario.target.distance_m {
            return Ok(self.brightest_member(&trial.camera));
        }
        let sight = self.sight_at(&trial.camera, trial.distance_m)?;
        let reading = |surface: &Surface| {
            let signal = sight.bands.weigh(&self.surroundings.signal(&surface.emissivity, &self.state));
            trial.camera.brightest_reading(&sight.bands, &signal, &sight.view)
        };
        Ok(self.targets().map(reading).fold(0.0, f64::max))
    }

    /// Counts of the fullest reading that any member of the target's class gives.
    pub(crate) fn brightest_member(&self, camera: &Camera) -> f64 {
        let reading = |surface: &Surface| {
            let signal = self.bands.weigh(&self.surroundings.signal(&surface.emissivity, &self.state));
            camera.brightest_reading(&self.bands, &signal, &self.view_of(camera))
        };
        self.targets().map(reading).fold(0.0, f64::max)
    }

    pub(super) fn solutions(&self, camera: &Camera, alternative: &Surface) -> Result<Solutions> {
        let task = self.task(camera);
        let brightest = |trial: &Trial| self.brightest(trial);
        let speed_m_s = self.scenario.requirement.speed_m_s;
        let given = Circumstances { bands: &self.bands, speed_m_s, brightest: &brightest };
        let mut reach = Reach::new(self, alternative);
        let mut solved = Vec::with_capacity(Quantity::ALL.len());
        for quantity in Quantity::ALL {
            let mut solution = reach.solve(&task, quantity)?;
            if let Some(value) = solution.value {
                solution.caps = caps::broken(quantity, value, &task, &given)?;
            }
            solved.push((quantity, solution));
        }
        Ok(Solutions(solved))
    }

    fn verdict(
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
        let bounds = pair.statistical_distance_bounds;
        let lower = bounds.map(|[lower, _]| proved.map_or(lower, |proved| lower.min(proved)));
        let upper = bounds.map(|[_, upper]| mixtures.map_or(upper, |found| upper.min(found.distance)));
        let answer = far_enough.map(|enough| match upper {
            _ if enough && spoiled.is_empty() => YesNo::Yes,
            Some(upper) if !enough && spoiled.is_empty() && upper >= self.required => YesNo::Undecided,
            _ => YesNo::No,
        });
        let conditions = match &self.camera {
            Some(camera) => self.conditions(camera, met == Some(true), reached)?,
            None => Vec::new(),
        };
        let mut fails_by = if far_enough == Some(false) { vec![Shortfall::Distance] } else { Vec::new() };
        fails_by.extend(&spoiled);
        let few = self.too_few_bands().filter(|_| far_enough != Some(true));
        let found = match (distance, requirement.photons, pair.status) {
            (_, None, Status::Identical | Status::Equilibrium) => Answer::NothingDiffers,
            (_, _, Status::Blind) if few.is_some() => few.unwrap_or(Answer::UnknownsExplain),
            (_, None, Status::Ok | Status::Blind) => Answer::UnknownsExplain,
            (None, Some(photons), _) => Answer::Takes { photons, limit: requirement.photons_by.nearest },
            (Some(_), Some(_), _) => {
                Answer::Judged { enough: far_enough == Some(true), spoiled, reached: upper, limit }
            }
        };
        let proved =
            pair.proof == NearestProof::Proved && self.scenario.requirement.by == DistanceKind::Nearest;
        let grade = answer.map(|_| match proved && !self.unknowns.has_priors() {
            _ if conditions.iter().any(Condition::favourable) => Sureness::Assumed,
            true => Sureness::Proved,
            false => Sureness::Searched,
        });
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
        };
        Ok(Verdict {
            met,
            fails_by,
            answer,
            scope: PIXEL,
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

    /// What spoils the camera's image whatever the distance: the demanded speed, the full well.
    fn spoiled(&self, camera: Option<&CameraResult>) -> Vec<Shortfall> {
        let Some(camera) = camera else { return Vec::new() };
        let mut spoiled = Vec::new();
        match (self.scenario.requirement.speed_m_s, camera.motion_blur_pixels) {
            (Some(_), None) => spoiled.push(Shortfall::MotionUnknown),
            (_, Some(blur)) if blur >= 1.0 => spoiled.push(Shortfall::MotionBlur),
            _ => {}
        }
        if self.scenario.requirement.time_s.is_some_and(|time_s| camera.acquisition_s > time_s) {
            spoiled.push(Shortfall::DecisionTime);
        }
        // Of a class every member must fit into the well.
        let brightest = self.brightest_member(&camera.camera).max(camera.brightest_reading);
        if camera.camera.full_well.is_some_and(|full| brightest > full) {
            spoiled.push(Shortfall::FullWell);
        }
        spoiled
    }
}
