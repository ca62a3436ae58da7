//! The main job: does the camera meet the requirement, and what would it have to be.

use super::identify::{PairResult, PhotonsRequired, SafetyOfTarget};
use super::{ClassAnswer, Companion, Shortfall, Study, Surface, Warning};
use crate::rests_on::Reached;
use hadar::demand::{self, Ledger, Work};
use hadar::error::Result;
use hadar::identifiability::detection;
use hadar::instrument::{Camera, NoiseLine, View, gamma_per_band};
use hadar::policy::{self, CameraTask, Motion, Quantity, Solution, TradeOff, Trial};
use hadar::spectrum::Bands;
use hadar_scenario::{DistanceKind, Scenario};
use serde::ser::{SerializeMap, Serializer};

mod curves;
mod object;
mod reach;
pub(crate) mod sensitivity;
mod solved;
mod trade_offs;
mod verdict;

pub(super) use curves::logarithmic;
pub use curves::{InformationCurves, PhotonMap, Spectra};
pub use object::{CeilingShare, ObjectAnswer, ObjectCurve};
pub(super) use reach::{Reach, Solvers};
pub use sensitivity::{Elasticities, EmissivityErrors, ScatterOf, Sensitivity};
pub use verdict::{Answer, Finding, Verdict, VerdictAlone};

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
    /// What all pixels of the object say together, and where that ends; `None` of a pixel.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub object: Option<ObjectAnswer>,
    /// Each hardware quantity with the others held, for the limiting alternative; `None` without a camera, or where it was not asked for.
    pub solve_for: Option<Solutions>,
    /// What the verdict depends on; `None` without a camera, or where it was not asked for.
    pub sensitivity: Option<Sensitivity>,
    /// Two quantities at a time, where they were asked for ([`Study::trade_offs`]).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub trade_offs: Option<Vec<TradeOff>>,
    /// ΣS·Δν of the target, photons s⁻¹ m⁻² sr⁻¹.
    pub photon_radiance: f64,
    /// The target against each of its alternatives.
    pub pairs: Vec<PairResult>,
    /// The alternative that is hardest to distinguish.
    pub limiting: String,
    /// What sizing practice says of the camera; `None` without a camera or without target.size.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub companion: Option<Companion>,
    /// What the members of classes say together, alternative by alternative; empty without classes.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub classes: Vec<ClassAnswer>,
    /// Whether each category with `safety = true` is excluded where the target is; empty without such categories.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub safety: Vec<SafetyOfTarget>,
    /// What the reader must know.
    pub warnings: Vec<Warning>,
    /// What was computed and what was skipped, with the time.
    pub stats: Work,
}

/// Parts of a sizing beside its verdict; all of them where nobody says otherwise.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SizeAsked {
    /// Every quantity of the camera solved for.
    pub solutions: bool,
    /// What the verdict hangs on.
    pub sensitivity: bool,
    /// What errors of the emissivities do to a verdict that is met, which rests on them; known with the sensitivity.
    pub emissivity_errors: bool,
}

impl Default for SizeAsked {
    fn default() -> Self {
        Self { solutions: true, sensitivity: true, emissivity_errors: true }
    }
}

/// What the task demands of any camera, against the limiting alternative.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct RequirementResult {
    /// Name of the distance that decides: nearest or local.
    pub by: &'static str,
    /// Statistical distance d that is required of any camera.
    pub distance: f64,
    /// Probability of a correct decision demanded, Φ of it.
    pub detection_probability: f64,
    /// Photons at the detector by what is proved, shot noise only; `None` where none suffice, or where nothing is proved.
    pub photons: Option<f64>,
    /// The least number that may do, as a state that was found shows, and that which is proved to do.
    pub photons_bounds: [Option<f64>; 2],
    /// H_req = t A_p/((1+γ)F²) by the paper's inequality, m² s, lossless optics; of the photons.
    pub hardware_m2_s: Option<f64>,
    /// The same of their bounds.
    pub hardware_bounds_m2_s: [Option<f64>; 2],
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
        let object = own.object(surface)?;
        let solve_for = match &own.camera {
            // With errors that readings share every trial takes a proof of its own.
            Some(camera) if asked.solutions && own.errors_shared().is_none() => {
                Some(own.solutions(camera, surface)?)
            }
            _ => None,
        };
        let sensitivity = match &own.camera {
            Some(camera) if asked.sensitivity && own.errors_shared().is_none() => {
                Some(own.sensitivity(camera, surface, index)?)
            }
            _ => None,
        };
        if let Some(camera) = &camera {
            warnings.extend(own.camera_result_warnings(camera, pair));
        }
        if solve_for.is_some() && self.classes.get(index).is_some_and(|answer| answer.mixtures.is_some()) {
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
        let brightest = camera.as_ref().map_or(0.0, |camera| own.brightest_member(&camera.camera));
        let spoiled = camera.as_ref().map_or_else(Vec::new, |camera| own.spoiled_at(camera, brightest));
        let met = pair.told_apart == Some(true) && spoiled.is_empty();
        let errors = match (&sensitivity, &own.camera) {
            (Some(found), _) => Some([found.emissivity.error, found.emissivity.share_met]),
            // Of an object's pixels they are shared, which is another condition.
            (None, Some(camera)) if asked.emissivity_errors && met && !own.scenario.is_of_object() => {
                let found = own.emissivity_errors(camera, surface, index)?;
                Some([found.error, found.share_met])
            }
            _ => None,
        };
        if errors.is_some() {
            scenario.sensitivity.get_or_insert_default();
        }
        let reached = Reached { pair, errors, brightest };
        let verdict = own.verdict(&reached, index, &requirement, spoiled)?;
        Ok(Sizing {
            scenario,
            verdict,
            requirement,
            camera,
            object,
            solve_for,
            sensitivity,
            trade_offs: None,
            photon_radiance,
            pairs: identification.pairs,
            limiting: identification.limiting,
            companion,
            classes: identification.classes,
            safety: identification.safety,
            warnings,
            stats: ledger.close(),
        })
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
            photons_bounds: pair.photons_required_bounds,
            hardware_m2_s: hardware(pair.photons_required.map(photons_of_any)),
            hardware_bounds_m2_s: pair.photons_required_bounds.map(|one| hardware(one.map(photons_of_any))),
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
        let view = self.view_of(camera);
        let counting = camera.counting(&self.bands, &view);
        let photons = counting.counts_per_radiance * photon_radiance;
        let gamma = gamma_per_band(&counting, &view.signal);
        let distance_m = self.scenario.target.distance_m;
        let blur = self.scenario.requirement.speed_m_s.and_then(|speed| {
            let time_s = camera.sweep_s(self.bands.len());
            Motion::of(camera, distance_m).map(|motion| motion.blur_pixels(speed, time_s))
        });
        let var: f64 = (0..self.bands.len()).map(|w| counting.var_added(w)).sum();
        Some(CameraResult {
            photons,
            brightest_reading: camera.brightest_reading(&view.signal, &view),
            noise_counts: (var / self.bands.len() as f64).sqrt(),
            gamma_per_band: gamma,
            etendue_m2_sr: camera.etendue_m2_sr(distance_m),
            hardware_m2_s: self.extent(camera, distance_m).pixels() * camera.hardware_m2_s(gamma),
            least_distance: policy::least_distance(self.required, photons, gamma),
            acquisition_s: camera.acquisition_s(self.bands.len()),
            footprint_m: distance_m.map(|z| camera.footprint_m(z)),
            motion_blur_pixels: blur,
            noise_budget: camera.noise_budget(&self.bands, &view.signal, &view),
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
            of_object: self.scenario.is_of_object(),
        }
    }

    /// Counts of the fullest reading of a trial.
    pub(super) fn brightest(&self, trial: &Trial) -> Result<f64> {
        // From its own distance the bands are those of the scene.
        if trial.distance_m == self.scenario.target.distance_m {
            return Ok(self.brightest_member(&trial.camera));
        }
        let sight = self.sight_at(&trial.camera, trial.distance_m)?;
        Ok(self.fullest_reading(&trial.camera, &sight.bands, &sight.view))
    }

    /// Counts of the fullest reading that any member of the target's class gives.
    pub(crate) fn brightest_member(&self, camera: &Camera) -> f64 {
        self.fullest_reading(camera, &self.bands, &self.view_of(camera))
    }

    /// The same through bands and with a view, which has the signal of the target itself.
    fn fullest_reading(&self, camera: &Camera, bands: &Bands, view: &View) -> f64 {
        let own = camera.brightest_reading(&view.signal, view);
        let others = self.targets().filter(|surface| surface.emissivity != self.target.emissivity);
        let reading = |surface: &Surface| {
            let signal = bands.weigh(&self.surroundings.signal(&surface.emissivity, &self.state));
            camera.brightest_reading(&signal, view)
        };
        others.map(reading).fold(own.max(0.0), f64::max)
    }

    /// What spoils the camera's image whatever the distance: the demanded speed, the full well.
    pub(crate) fn spoiled(&self, camera: Option<&CameraResult>) -> Vec<Shortfall> {
        camera.map_or_else(Vec::new, |camera| self.spoiled_at(camera, self.brightest_member(&camera.camera)))
    }

    /// The same where the fullest reading of a member of the target's class is so many counts: of a class every member must fit into the well.
    fn spoiled_at(&self, camera: &CameraResult, brightest: f64) -> Vec<Shortfall> {
        let brightest = brightest.max(camera.brightest_reading);
        self.spoiled_by(&camera.camera, self.scenario.target.distance_m, brightest)
    }

    /// The same of a camera at a distance, whose fullest reading is so many counts.
    pub(crate) fn spoiled_by(
        &self,
        camera: &Camera,
        distance_m: Option<f64>,
        brightest: f64,
    ) -> Vec<Shortfall> {
        let (requirement, bands) = (&self.scenario.requirement, self.bands.len());
        let mut spoiled = Vec::new();
        if let Some(speed) = requirement.speed_m_s {
            let time_s = camera.sweep_s(bands);
            match Motion::of(camera, distance_m).map(|motion| motion.blur_pixels(speed, time_s)) {
                None => spoiled.push(Shortfall::MotionUnknown),
                Some(blur) if blur >= 1.0 => spoiled.push(Shortfall::MotionBlur),
                Some(_) => {}
            }
        }
        if requirement.time_s.is_some_and(|time_s| camera.acquisition_s(bands) > time_s) {
            spoiled.push(Shortfall::DecisionTime);
        }
        if camera.full_well.is_some_and(|full| brightest > full) {
            spoiled.push(Shortfall::FullWell);
        }
        spoiled
    }
}
