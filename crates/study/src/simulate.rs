//! Classifiers put to the test: spectra of the target and of its nearest rivals drawn, judged, and held against the limit.
//!
//! The classes are the target in its state and an alternative in the state nearest to it, found anew for every number of
//! photons, since a camera's noise grows otherwise with the exposure than its photons. No rule is right more often,
//! averaged over the two states, than their likelihood ratio, whose accuracy is computed without any draw
//! (`identifiability::ratio`); at many photons it is Φ(d), d the statistical distance.
//!
//! Whether a classifier beats the limit is asked at a level that holds for all comparisons together (Bonferroni).

mod asked;
mod average;
mod experiment;
mod noise_curves;
mod photons;
mod standing;
mod thermometry;

pub use asked::{SimulationAsked, true_temperatures};
pub use average::{AveragePoint, AverageSimulation};
pub(super) use experiment::normal_error;
pub use noise_curves::{NoiseCurve, NoiseCurves};
pub use standing::{SimulatedPerformance, Standing};
pub use thermometry::{FIXED_EMISSIVITY, ImagerErrors, Reader, Thermometry, ThermometryRow};

use super::identify::SafetyOfTarget;
use super::{Study, Warning};
use hadar::demand::{self, Ledger, Thing, Work};
use hadar::error::{Error, Result};
use hadar::fisher::Unknowns;
use hadar::instrument::Camera;
use hadar::parallel;
use hadar_simulate::classifier::{SavedModel, Trained};
use hadar_simulate::draws::{GENERATOR, LARGEST_EXACT};
use hadar_simulate::experiment::Design;
use hadar_simulate::spectra::{LabelledSpectra, Parts};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Chance that an optimal classifier is called better than the limit anywhere in one simulation.
const FALSE_ALARM: f64 = 0.01;

/// How photons are counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum PhotonLaw {
    /// Independently, each on its own.
    Poisson,
    /// Bunched, as thermal light is.
    NegativeBinomial,
    /// As many in every spectrum, distributed over the bands: brightness tells nothing.
    FixedTotal,
}

/// What a simulation draws and who judges it.
#[derive(Debug, Clone, PartialEq)]
pub struct SimulationPlan {
    /// Photons of the target in all bands, one experiment each; the camera's where empty, or those required.
    pub photons: Vec<f64>,
    /// How photons are counted.
    pub law: PhotonLaw,
    /// Whether the camera's electronic noise is added.
    pub camera_noise: bool,
    /// Alternatives that are classes beside the target: the nearest one where empty.
    pub against: Vec<String>,
    /// Spectra, classifiers, seed.
    pub design: Design,
    /// Classifiers trained before.
    pub models: Vec<SavedModel>,
    /// Whether the spectra of the test come with the result.
    pub save_spectra: bool,
}

/// A class of spectra.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct SimulatedClass {
    /// Name of the material of the class.
    pub material: String,
    /// Temperature of the class, K.
    pub temperature_k: f64,
    /// Lighting factors of the class, 0 to 1.
    pub lighting: Vec<f64>,
    /// Its photons in all bands, on average.
    pub photons: f64,
}

/// One experiment.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct SimulatedPoint {
    /// Photons of the target in all bands, on average.
    pub photons: f64,
    /// N·d₀², d₀ the nearest distance per √photon without electronic noise.
    pub normalised_photons: f64,
    /// Electronic noise of a band over its photons, averaged over the bands: γ.
    pub gamma: f64,
    /// The classes, the target first.
    pub classes: Vec<SimulatedClass>,
    /// Half the separation of the target and the nearest other class, in units of the noise.
    pub statistical_distance: f64,
    /// The local statistical distance to the same material.
    pub statistical_distance_local: f64,
    /// Accuracy of the likelihood ratio of the two, without any draw; `None` for more classes, and for a fixed
    /// total, whose law is not that of independent bands.
    pub limit_accuracy: Option<f64>,
    /// Φ of the statistical distance: the limit at many photons.
    pub limit_accuracy_normal: f64,
    /// Φ of the local distance: what it would have promised.
    pub local_accuracy: f64,
    /// Where likelihoods take counts for normal: how far the distribution function of a band is from that, at most.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub normal_error: Option<f64>,
    /// What each classifier achieved on the test spectra.
    pub performances: Vec<SimulatedPerformance>,
    /// The spectra on which they were judged, where they were asked for.
    #[serde(skip)]
    pub spectra: Option<TestSpectra>,
}

/// Spectra of a test with all that a decision between their classes needs.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct TestSpectra {
    /// Counts, the classes in turn.
    pub counts: LabelledSpectra,
    /// Seed that this experiment has of its own.
    pub seed: u64,
    /// Mean counts of each class, band by band.
    pub means: Vec<Vec<f64>>,
    /// Variance of the reading noise of each band, counts².
    pub var_reading: Vec<f64>,
    /// Centres of the bands, cm⁻¹.
    pub centres_cm1: Vec<f64>,
}

/// What came of a simulation.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Simulation {
    /// Law by which the photons are distributed.
    pub photon_law: PhotonLaw,
    /// Whether electronic noise was added.
    pub camera_noise: bool,
    /// The law that the likelihood ratio takes the counts to follow.
    pub judged_as: &'static str,
    /// Name of the generator of random numbers.
    pub generator: &'static str,
    /// Seed from which the spectra were drawn.
    pub seed: u64,
    /// Spectra of each class; half of them are for the test.
    pub spectra_per_class: usize,
    /// Whether the likelihood ratio itself was drawn instead of spectra.
    pub skipped_spectra: bool,
    /// Confidence level of all intervals, 0 to 1.
    pub level: f64,
    /// The experiments, one for each number of photons.
    pub points: Vec<SimulatedPoint>,
    /// Comparisons with the limit, and whether all kept it.
    pub comparisons: usize,
    /// No classifier was right more often than the limit allows.
    pub limit_holds: bool,
    /// Whether what is proved of the scenario's camera excludes each category with `safety = true` where the target is; no draw has a part
    /// in it. Empty without such categories.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub safety: Vec<SafetyOfTarget>,
    /// What the reader must know.
    pub warnings: Vec<Warning>,
    /// What was computed and what was skipped, with the time.
    pub stats: Work,
}

impl Study {
    /// Draws, trains and judges. `progress` is called with the experiments done and their number. The trained
    /// classifiers of the last experiment come with the result.
    ///
    /// # Errors
    /// Photons that are not positive or too many to draw, an unknown alternative, a saved model of other bands or
    /// classes, too few spectra.
    pub fn simulate(
        &self,
        plan: &SimulationPlan,
        progress: &(dyn Fn(usize, usize) + Sync),
    ) -> Result<(Simulation, Vec<SavedModel>)> {
        let (mut result, models) = self.simulated(plan, progress)?;
        if self.scenario.categories.iter().any(|spec| spec.safety) {
            // Of the camera as it stands in the scenario, whatever is drawn.
            let identification = self.identify()?;
            result.stats.add(&identification.stats);
            result.safety = identification.safety;
        }
        Ok((result, models))
    }

    fn simulated(
        &self,
        plan: &SimulationPlan,
        progress: &(dyn Fn(usize, usize) + Sync),
    ) -> Result<(Simulation, Vec<SavedModel>)> {
        if self.unknowns.has_priors() {
            let (mut result, models) = self.without_priors()?.simulated(plan, progress)?;
            result.warnings.push(Warning::PriorsLeftOut);
            return Ok((result, models));
        }
        if plan.law == PhotonLaw::NegativeBinomial
            && self.camera.as_ref().is_some_and(|camera| camera.photon_bunching)
        {
            // Drawn as it is, bunching is no noise to be added.
            let camera = self.camera.clone().map(|camera| Camera { photon_bunching: false, ..camera });
            return Self { camera, ..self.clone() }.simulated(plan, progress);
        }
        if let Some(index) = self.paired_with(&plan.against)
            && let std::borrow::Cow::Owned(own) = self.against(index)
        {
            return own.simulated(plan, progress);
        }
        let ledger = Ledger::open();
        demand::add(&self.looked_up);
        let rivals = self.rivals(&plan.against)?;
        let photons = self.photon_numbers(plan, &rivals)?;
        if plan.save_spectra {
            self.check_saved(plan, photons.len(), rivals.len() + 1)?;
        }
        let names: Vec<String> =
            std::iter::once(&self.target).chain(rivals.iter().copied()).map(|s| s.name.clone()).collect();
        let centres = self.band_centres_cm1();
        plan.models.iter().try_for_each(|model| model.check_fits(&centres, &names))?;
        // Comparisons of all experiments together.
        let judged = plan.design.methods.len() + plan.models.len();
        let is_limited = rivals.len() == 1 && plan.law != PhotonLaw::FixedTotal;
        let comparisons = if is_limited { photons.len() * judged } else { 0 };
        let level = 1.0 - 2.0 * FALSE_ALARM / comparisons.max(1) as f64;
        let done = AtomicUsize::new(0);
        progress(0, photons.len());
        let experiments: Vec<(SimulatedPoint, Vec<Trained>)> = parallel::try_map(photons.len(), |i| {
            let outcome = self.experiment(plan, &rivals, photons[i], level)?;
            progress(done.fetch_add(1, Ordering::Relaxed) + 1, photons.len());
            Ok(outcome)
        })?;
        for _ in &photons {
            // States of the rivals, and the nearest of them once more without electronic noise.
            demand::computed(Thing::NearestSearches, rivals.len() as u64 + 1);
            self.book_local(&self.unknowns, 1);
            demand::add(&plan.design.work(names.len())?);
        }
        let (points, mut trained): (Vec<_>, Vec<_>) = experiments.into_iter().unzip();
        let last = photons.last().copied().unwrap_or(0.0);
        let models = trained.pop().unwrap_or_default();
        let save = |model| SavedModel::new(model, centres.clone(), names.clone(), last, plan.design.seed);
        let mut warnings = self.warnings.clone();
        warnings.extend(self.simulation_warnings(plan, &points));
        let noisy = points.iter().any(|point| point.gamma > 0.0);
        Ok((
            Simulation {
                photon_law: plan.law,
                camera_noise: noisy,
                judged_as: self.judged_as(plan.law, &self.counting_at(last, plan.camera_noise))?.name(),
                generator: GENERATOR,
                seed: plan.design.seed,
                spectra_per_class: plan.design.per_class,
                skipped_spectra: plan.design.skip_spectra,
                level: plan.design.level,
                comparisons,
                limit_holds: !points
                    .iter()
                    .flat_map(|point| &point.performances)
                    .any(|found| found.standing == Some(Standing::Beyond)),
                points,
                safety: Vec::new(),
                warnings,
                stats: ledger.close(),
            },
            models.into_iter().map(save).collect::<Result<_>>()?,
        ))
    }

    /// Makes sure that the spectra of the test are not too many to be saved.
    fn check_saved(&self, plan: &SimulationPlan, experiments: usize, classes: usize) -> Result<()> {
        if plan.design.skip_spectra {
            let found = "--save-spectra with --skip-spectra, which draws none";
            return Err(Error::malformed(found, "leave out one of them"));
        }
        let Parts { test, .. } = Parts::of(plan.design.per_class)?;
        let each = (experiments * classes * self.bands.len()) as u64;
        let counts = each.saturating_mul(test.end - test.start);
        if counts > MOST_SAVED {
            let found = format!("{counts} counts are too many to be saved, more than {MOST_SAVED}");
            let instead = format!(
                "ask for at most {} with --spectra, or for fewer experiments",
                2 * (MOST_SAVED / each)
            );
            return Err(Error::malformed(found, instead));
        }
        Ok(())
    }

    /// Makes sure that a saved model is one of these bands, and of the target against these alternatives.
    ///
    /// # Errors
    /// Other bands or classes; an unknown alternative.
    pub fn check_model(&self, saved: &SavedModel, against: &[String]) -> Result<()> {
        let rivals = self.rivals(against)?;
        let all = std::iter::once(&self.target).chain(rivals);
        let names: Vec<String> = all.map(|surface| surface.name.clone()).collect();
        saved.check_fits(&self.band_centres_cm1(), &names)
    }

    pub(super) fn band_centres_cm1(&self) -> Vec<f64> {
        self.bands.bands().iter().map(|band| band.center_cm1).collect()
    }

    /// The same without priors.
    fn without_priors(&self) -> Result<Self> {
        let unknowns = Unknowns::new(self.unknowns.nuisances().iter().copied())?
            .lighting_total(self.unknowns.known_lighting_total())?;
        Ok(Self { unknowns, ..self.clone() })
    }

    /// What of a simulation is not as simple as it looks.
    fn simulation_warnings(&self, plan: &SimulationPlan, points: &[SimulatedPoint]) -> Vec<Warning> {
        let mut warnings = Vec::new();
        warnings.extend(self.worst_members_alone(&plan.against));
        if self.scenario.envelope.is_some() {
            warnings.push(Warning::EnvelopeNotSearched);
        }
        let bands = self.bands.len() as f64;
        let fewest = points.iter().map(|point| point.photons).fold(f64::INFINITY, f64::min);
        let most = points.iter().map(|point| point.photons).fold(0.0, f64::max);
        warnings.extend(self.image_warnings_at(most));
        if fewest < 1.0 {
            warnings.push(Warning::SpectraEmpty { photons: fewest });
        }
        if most / bands > LARGEST_EXACT {
            warnings.push(Warning::CountsRounded { photons: most });
        }
        let learns = plan.design.methods.iter().any(|method| method.is_trained());
        if learns && plan.design.per_class / 4 < FEW_SPECTRA {
            warnings.push(Warning::FewSpectra { training: plan.design.per_class / 4 });
        }
        for saved in &plan.models {
            if points.iter().any(|point| (point.photons / saved.photons).ln().abs() > OTHER_PHOTONS) {
                let (method, photons) = (saved.model.method(), saved.photons);
                warnings.push(Warning::ModelPhotons { method, photons });
            }
        }
        let error = points.iter().filter_map(|point| point.normal_error).fold(0.0, f64::max);
        if error > NORMAL {
            warnings.push(Warning::NormalLikelihood { error });
        }
        if plan.law == PhotonLaw::FixedTotal {
            warnings.push(Warning::LimitNormal);
        }
        warnings
    }
}

/// Most counts of spectra that are saved, 160 MB.
const MOST_SAVED: u64 = 20_000_000;
/// Fewer training spectra of a class than this get a warning, and so does a saved model whose photons differ by more.
const FEW_SPECTRA: usize = 20;
const OTHER_PHOTONS: f64 = 0.01;
/// Error of the distribution function above which normal likelihoods are worth a warning.
pub(crate) const NORMAL: f64 = 1e-3;
