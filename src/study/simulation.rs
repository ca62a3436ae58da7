//! Classifiers put to the test: spectra of the target and of its nearest rivals drawn, judged, and held against the limit.
//!
//! The classes are the target in its state and an alternative in the state nearest to it, found anew for every number of
//! photons, since a camera's noise grows otherwise with the exposure than its photons. No rule is right more often,
//! averaged over the two states, than their likelihood ratio, whose accuracy is computed without any draw
//! (`identifiability::ratio`); at many photons it is Φ(d), d the statistical distance.
//!
//! Whether a classifier beats the limit is asked at a level that holds for all comparisons together (Bonferroni).

use super::curves::logarithmic;
use super::{Study, Surface, Warning};
use crate::error::{Error, Result};
use crate::fisher::Counting;
use crate::identifiability::local::LocalSolver;
use crate::identifiability::nearest::NearestSolver;
use crate::identifiability::{detection, ratio};
use crate::instrument::Camera;
use crate::planck;
use crate::policy;
use crate::scenario::DistanceKind;
use crate::scene::State;
use crate::simulate::classifier::{Method, SavedModel, Trained};
use crate::simulate::decision::DecisionScene;
use crate::simulate::draws::{Draws, GENERATOR, LARGEST_EXACT, LARGEST_MEAN};
use crate::simulate::efficiency::PhotonShare;
use crate::simulate::experiment::{Design, Experiment, Performance};
use crate::statistics::Statistics;
use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};

/// An interval with a half width above this is too wide to say that a limit is reached.
const NARROW: f64 = 0.02;
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
}

/// A class of spectra.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct SimulatedClass {
    /// Material.
    pub material: String,
    /// Its temperature, K.
    pub temperature_k: f64,
    /// Its lighting factors.
    pub lighting: Vec<f64>,
    /// Its photons in all bands, on average.
    pub photons: f64,
}

/// One experiment.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
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
    /// Accuracy of the likelihood ratio of the two, without any draw; `None` for more classes.
    pub limit: Option<f64>,
    /// Φ of the statistical distance: the limit at many photons.
    pub limit_normal: f64,
    /// Φ of the local distance: what it would have promised.
    pub local: f64,
    /// What each classifier achieved.
    pub performances: Vec<SimulatedPerformance>,
}

/// What one classifier achieved, held against the limit.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct SimulatedPerformance {
    /// How often it was right.
    #[serde(flatten)]
    pub performance: Performance,
    /// Information log₂ 2P of its balanced accuracy P, bits.
    pub information_bits: f64,
    /// Share of the photons with which an ideal classifier of known states would have been as accurate, with its
    /// interval; `None` for more than two classes, and where every decision was right.
    pub photon_share: Option<f64>,
    /// Lower end of its interval.
    pub photon_share_low: Option<f64>,
    /// Upper end of its interval.
    pub photon_share_high: Option<f64>,
    /// How its accuracy compares with the limit; `None` for more than two classes.
    pub standing: Option<Standing>,
}

impl Standing {
    /// The name in tables.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Beyond => "beyond",
            Self::Reaches => "reaches",
            Self::Undecided => "undecided",
            Self::Below => "below",
        }
    }
}

/// An accuracy against the limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Standing {
    /// Above it by more than chance explains in all comparisons together: the limit would be wrong.
    Beyond,
    /// The limit lies within an interval that is narrow enough to mean something.
    Reaches,
    /// The limit lies within the interval, which is too wide to mean much.
    Undecided,
    /// Below it.
    Below,
}

/// What came of a simulation.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Simulation {
    /// Law of the photons.
    pub photon_law: PhotonLaw,
    /// Whether electronic noise was added.
    pub camera_noise: bool,
    /// The law that the likelihood ratio takes the counts to follow.
    pub judged_as: &'static str,
    /// Generator of the draws.
    pub generator: &'static str,
    /// Its seed.
    pub seed: u64,
    /// Spectra of each class; half of them are for the test.
    pub spectra_per_class: usize,
    /// Level of the intervals.
    pub level: f64,
    /// Experiments.
    pub points: Vec<SimulatedPoint>,
    /// Comparisons with the limit, and whether all kept it.
    pub comparisons: usize,
    /// No classifier was right more often than the limit allows.
    pub limit_holds: bool,
    /// What the reader must know.
    pub warnings: Vec<Warning>,
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
        let rivals = self.rivals(&plan.against)?;
        let photons = self.photon_numbers(plan, &rivals)?;
        let rivals: Vec<&Surface> = rivals.into_iter().map(|(_, rival)| rival).collect();
        let names: Vec<String> =
            std::iter::once(&self.target).chain(rivals.iter().copied()).map(|s| s.name.clone()).collect();
        let centres: Vec<f64> = self.bands.bands().iter().map(|band| band.center_cm1).collect();
        plan.models.iter().try_for_each(|model| model.check_fits(&centres, &names))?;
        // Comparisons of all experiments together.
        let judged = plan.design.methods.len() + plan.models.len();
        let comparisons = if rivals.len() == 1 { photons.len() * judged } else { 0 };
        let level = 1.0 - 2.0 * FALSE_ALARM / comparisons.max(1) as f64;
        let done = AtomicUsize::new(0);
        progress(0, photons.len());
        let experiments: Vec<(SimulatedPoint, Vec<Trained>)> = photons
            .par_iter()
            .map(|&photons_here| {
                let outcome = self.experiment(plan, &rivals, photons_here, level)?;
                progress(done.fetch_add(1, Ordering::Relaxed) + 1, photons.len());
                Ok(outcome)
            })
            .collect::<Result<_>>()?;
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
                judged_as: self.judged_as(plan, &self.counting_at(last, plan.camera_noise))?.name(),
                generator: GENERATOR,
                seed: plan.design.seed,
                spectra_per_class: plan.design.per_class,
                level: plan.design.level,
                comparisons,
                limit_holds: !points
                    .iter()
                    .flat_map(|point| &point.performances)
                    .any(|found| found.standing == Some(Standing::Beyond)),
                points,
                warnings,
            },
            models.into_iter().map(save).collect::<Result<_>>()?,
        ))
    }

    /// The alternatives that are classes, with their nearest distances per √photon in shot noise.
    fn rivals(&self, against: &[String]) -> Result<Vec<(f64, &Surface)>> {
        let with_distance = |alternative| {
            let distance = self.distance_per_photon(DistanceKind::Nearest, alternative, f64::INFINITY)?;
            Ok((distance, alternative))
        };
        if against.is_empty() {
            let all: Vec<(f64, &Surface)> =
                self.alternatives.iter().map(with_distance).collect::<Result<_>>()?;
            return Ok(all.into_iter().min_by(|a, b| a.0.total_cmp(&b.0)).into_iter().collect());
        }
        let find = |name: &String| {
            let found = self.alternative(name).ok_or_else(|| {
                let names: Vec<&str> =
                    self.alternatives.iter().map(|surface| surface.name.as_str()).collect();
                let found = format!("`{name}` is none of the alternatives");
                Error::malformed(found, format!("choose among {}", names.join(", ")))
            });
            with_distance(found?)
        };
        against.iter().map(find).collect()
    }

    /// Photons of each experiment.
    fn photon_numbers(&self, plan: &SimulationPlan, rivals: &[(f64, &Surface)]) -> Result<Vec<f64>> {
        let numbers = match (plan.photons.as_slice(), self.counting()) {
            ([], Some(counting)) => vec![counting.counts_per_radiance * self.photon_radiance()],
            ([], None) => vec![self.photons_for(rivals)?],
            (given, _) => given.to_vec(),
        };
        for &photons in &numbers {
            crate::error::check::positive("number of photons", photons, "")?;
            if photons > LARGEST_MEAN {
                let expected = format!("at most {LARGEST_MEAN:e}");
                return Err(Error::out_of_range("number of photons", photons, "", expected));
            }
        }
        Ok(numbers)
    }

    /// Photons at which the nearest of the rivals that differs at all is told apart as required.
    fn photons_for(&self, rivals: &[(f64, &Surface)]) -> Result<f64> {
        let needed =
            rivals.iter().filter_map(|(distance, _)| policy::photons_required(self.required, *distance));
        let most = needed.fold(0.0, f64::max);
        if most > 0.0 {
            return Ok(most);
        }
        let found = "no number of photons tells the target from the alternative";
        let instead = "change the scene or the alternatives, or name a number of photons";
        Err(Error::malformed(found, instead).at(self.scenario.place("target")))
    }

    /// Photons at which N d₀² has `experiments` values spread evenly in the logarithm over `normalised`, d₀ the
    /// nearest distance in shot noise to the nearest of the alternatives `against` (of all where empty).
    ///
    /// # Errors
    /// An unknown alternative; one that no number of photons tells from the target.
    pub fn sweep(&self, normalised: [f64; 2], experiments: usize, against: &[String]) -> Result<Vec<f64>> {
        let least = self.rivals(against)?.iter().map(|rival| rival.0).fold(f64::INFINITY, f64::min);
        if !(least > 0.0 && least.is_finite()) {
            let found = "no number of photons tells the target from the alternative";
            return Err(Error::malformed(found, "change the scene, or name the photons instead of a sweep"));
        }
        Ok(logarithmic(normalised, experiments).iter().map(|n| n / (least * least)).collect())
    }

    /// Counts and noise when the target sends so many photons: the exposure is made as long as that takes.
    pub(super) fn counting_at(&self, photons: f64, camera_noise: bool) -> Counting {
        let counts_per_radiance = photons / self.photon_radiance();
        let silent = Counting { counts_per_radiance, var_electronic: Vec::new() };
        match self.camera.as_ref().filter(|_| camera_noise) {
            Some(camera) => self.counting_with(camera, photons),
            None => silent,
        }
    }

    /// The same with the noise of `camera`.
    pub(super) fn counting_with(&self, camera: &Camera, photons: f64) -> Counting {
        let counts_per_radiance = photons / self.photon_radiance();
        let distance_m = self.scenario.target.distance_m;
        let second = Camera { exposure_s: 1.0, frames: 1, ..camera.clone() };
        let exposure_s = counts_per_radiance / second.counting(&self.bands, distance_m).counts_per_radiance;
        let exposed = Camera { exposure_s, ..second };
        Counting { counts_per_radiance, ..exposed.counting(&self.bands, distance_m) }
    }

    /// The law of the photons alone.
    fn photon_statistics(&self, law: PhotonLaw, counts_per_radiance: f64) -> Result<Statistics> {
        match law {
            PhotonLaw::Poisson | PhotonLaw::FixedTotal => Ok(Statistics::Poisson),
            PhotonLaw::NegativeBinomial => {
                let nodes = self.bands.nodes_cm1();
                let density: Vec<f64> = nodes.iter().map(|&nu| planck::mode_density(nu)).collect();
                let modes = self.bands.weigh(&density).iter().map(|m| counts_per_radiance * m).collect();
                Statistics::negative_binomial(modes)
            }
        }
    }

    /// The law by which likelihoods judge: that of the photons, or a normal one where electronic noise comes on top.
    fn judged_as(&self, plan: &SimulationPlan, counting: &Counting) -> Result<Statistics> {
        let photons = self.photon_statistics(plan.law, counting.counts_per_radiance)?;
        if counting.var_electronic.iter().all(|&var| var == 0.0) {
            return Ok(photons);
        }
        let signal = self.target_signal();
        let variance = signal.iter().enumerate().map(|(band, s)| {
            let mean = s * counting.counts_per_radiance;
            counting.var_electronic(band) + (photons.variance(band, mean) - mean).max(0.0)
        });
        Statistics::gaussian(variance.collect())
    }

    fn experiment(
        &self,
        plan: &SimulationPlan,
        rivals: &[&Surface],
        photons: f64,
        level: f64,
    ) -> Result<(SimulatedPoint, Vec<Trained>)> {
        let counting = self.counting_at(photons, plan.camera_noise);
        let statistics = self.judged_as(plan, &counting)?;
        let scale = counting.counts_per_radiance;
        // What the nearest distance takes for noise beyond that of the photons.
        let signal = self.target_signal();
        let excess = match &statistics {
            Statistics::Poisson => Vec::new(),
            law => signal.iter().enumerate().map(|(w, s)| law.variance(w, s * scale) - s * scale).collect(),
        };
        let noise = Counting { counts_per_radiance: scale, var_electronic: excess };
        let mut surfaces: Vec<(&Surface, State, f64)> =
            vec![(&self.target, self.state.clone(), f64::INFINITY)];
        let (own, silent) = (&self.target.emissivity, self.counting_at(photons, false));
        for &rival in rivals {
            let mut solver =
                NearestSolver::new(&self.bands, &self.surroundings, self.unknowns.clone(), self.range);
            let found = solver.with_counting(own, &rival.emissivity, &self.state, &noise)?;
            surfaces.push((rival, found.state, found.distance));
        }
        let mut means: Vec<Vec<f64>> = Vec::with_capacity(surfaces.len());
        for (surface, state, _) in &surfaces {
            let signal = self.bands.weigh(&self.surroundings.signal(&surface.emissivity, state));
            let counts: Vec<f64> = signal.iter().map(|s| s * scale).collect();
            let brightness = match plan.law {
                PhotonLaw::FixedTotal => photons / counts.iter().sum::<f64>(),
                PhotonLaw::Poisson | PhotonLaw::NegativeBinomial => 1.0,
            };
            means.push(counts.iter().map(|n| n * brightness).collect());
        }
        let law = self.photon_statistics(plan.law, scale)?;
        let draw = |means: &Vec<f64>| -> Result<Draws> {
            let draws = match plan.law {
                PhotonLaw::FixedTotal => Draws::fixed_total(photons, means)?,
                PhotonLaw::Poisson | PhotonLaw::NegativeBinomial => Draws::new(&law, means)?,
            };
            match counting.var_electronic.as_slice() {
                [] => Ok(draws),
                var_electronic => draws.with_electronic_noise(var_electronic),
            }
        };
        let draws: Vec<Draws> = means.iter().map(draw).collect::<Result<_>>()?;
        let scene = DecisionScene {
            bands: &self.bands,
            surroundings: &self.surroundings,
            unknowns: &self.unknowns,
            range: self.range,
            counts_per_radiance: scale,
            statistics: &statistics,
        };
        let states: Vec<(&[f64], &State)> =
            surfaces.iter().map(|(surface, state, _)| (surface.emissivity.as_slice(), state)).collect();
        let fitted = plan.design.methods.contains(&Method::BestFits);
        let best_fits = fitted.then(|| scene.best_fits(&states)).transpose()?;
        let trained: Vec<Trained> = plan.models.iter().map(|saved| saved.model.clone()).collect();
        let (performances, learnt) = Experiment {
            draws: &draws,
            means: &means,
            statistics: &statistics,
            best_fits: best_fits.as_ref(),
            trained: &trained,
        }
        .run(&Design { seed: seed_of(plan.design.seed, photons), ..plan.design.clone() })?;

        let hardest = surfaces.iter().skip(1).min_by(|a, b| a.2.total_cmp(&b.2));
        let Some((rival, _, distance)) = hardest else {
            return Err(Error::malformed("there is no alternative to tell the target from", "name one"));
        };
        let statistical_distance = match plan.law {
            PhotonLaw::FixedTotal => half_separation(&means[0], &means[1], &noise),
            PhotonLaw::Poisson | PhotonLaw::NegativeBinomial => *distance,
        };
        let local = LocalSolver::new(&self.bands, &self.surroundings, self.unknowns.clone()).with_counting(
            own,
            &rival.emissivity,
            &self.state,
            &noise,
        )?;
        let mut quiet =
            NearestSolver::new(&self.bands, &self.surroundings, self.unknowns.clone(), self.range);
        let normalised = quiet.with_counting(own, &rival.emissivity, &self.state, &silent)?.distance.powi(2);
        let limit = match (means.as_slice(), plan.law) {
            ([target, rival], PhotonLaw::Poisson | PhotonLaw::NegativeBinomial) => {
                Some(ratio::RatioLaw::new(target, rival, &statistics)?.accuracy())
            }
            _ => None,
        };
        let classes = surfaces.iter().zip(&means).map(|((surface, state, _), means)| SimulatedClass {
            material: surface.name.clone(),
            temperature_k: state.temperature_k,
            lighting: state.lighting.clone(),
            photons: means.iter().sum(),
        });
        let gamma = crate::instrument::gamma_per_band(&counting, &signal);
        let pair = (rivals.len() == 1).then(|| limit.unwrap_or(detection::probability(statistical_distance)));
        let held =
            |performance| held_against(performance, pair, statistical_distance, (level, plan.design.level));
        let performances = performances.into_iter().map(held).collect::<Result<_>>()?;
        Ok((
            SimulatedPoint {
                photons,
                normalised_photons: normalised,
                gamma,
                classes: classes.collect(),
                statistical_distance,
                statistical_distance_local: local.distance,
                limit,
                limit_normal: detection::probability(statistical_distance),
                local: detection::probability(local.distance),
                performances,
            },
            learnt,
        ))
    }

    /// What of a simulation is not as simple as it looks.
    fn simulation_warnings(&self, plan: &SimulationPlan, points: &[SimulatedPoint]) -> Vec<Warning> {
        let mut warnings = Vec::new();
        let bands = self.bands.len() as f64;
        let fewest = points.iter().map(|point| point.photons).fold(f64::INFINITY, f64::min);
        let most = points.iter().map(|point| point.photons).fold(0.0, f64::max);
        if fewest < 1.0 {
            let message = format!("with {fewest:.2e} photons most spectra are empty in every band");
            warnings.push(Warning::new("spectra-empty", message));
        }
        if most / bands > LARGEST_EXACT {
            let message = format!(
                "with {most:.1e} photons counts of a band leave the whole numbers that 64-bit floating point holds: \
                 they are rounded to it"
            );
            warnings.push(Warning::new("counts-rounded", message));
        }
        let noisy = points.iter().any(|point| point.gamma > 0.0);
        if noisy && fewest / bands < FEW_COUNTS {
            let message = "likelihoods take counts of few photons with electronic noise for normal; \
                           draws do not, so the likelihood ratio may fall short of the optimum";
            warnings.push(Warning::new("normal-likelihood", message));
        }
        if plan.law == PhotonLaw::FixedTotal && noisy {
            let message = "with a fixed total and electronic noise the limit is that of many photons";
            warnings.push(Warning::new("limit-normal", message));
        }
        warnings
    }
}

/// The seed of the experiment with so many photons: experiments of one simulation share no random numbers, and each is
/// the same alone and among others. (Odd constant: 2⁶⁴ over the golden ratio, which spreads neighbouring values.)
fn seed_of(seed: u64, photons: f64) -> u64 {
    seed.wrapping_add(photons.to_bits().wrapping_mul(0x9E37_79B9_7F4A_7C15))
}

/// A performance beside the limit of the accuracy, for a pair of classes so far apart; levels are those of all
/// comparisons together and of one.
fn held_against(
    performance: Performance,
    limit: Option<f64>,
    distance: f64,
    (together, level): (f64, f64),
) -> Result<SimulatedPerformance> {
    let confusion = &performance.confusion;
    let spectra: f64 = confusion.spectra().iter().sum();
    let right = performance.accuracy * spectra;
    let share = match limit {
        Some(_) if distance > 0.0 => Some(PhotonShare::of(right, spectra as u64, distance, level)?),
        _ => None,
    };
    let standing = limit.map(|limit| {
        let interval = performance.interval;
        if confusion.interval(together).low > limit {
            Standing::Beyond
        } else if interval.high < limit {
            Standing::Below
        } else if interval.half_width() > NARROW {
            Standing::Undecided
        } else {
            Standing::Reaches
        }
    });
    Ok(SimulatedPerformance {
        information_bits: (2.0 * performance.accuracy).log2(),
        photon_share: share.and_then(|share| share.share),
        photon_share_low: share.map(|share| share.share_low),
        photon_share_high: share.and_then(|share| share.share_high),
        standing,
        performance,
    })
}

/// Below it a normal law is a poor likelihood for a band's photons.
const FEW_COUNTS: f64 = 100.0;

/// Half the separation of two mean spectra in units of the noise: ‖√(N + σ²) − √(N′ + σ²)‖.
fn half_separation(means: &[f64], others: &[f64], noise: &Counting) -> f64 {
    let band = |(w, (a, b)): (usize, (&f64, &f64))| {
        let var = noise.var_electronic(w);
        ((a - b) / ((a + var).sqrt() + (b + var).sqrt()).max(f64::MIN_POSITIVE)).powi(2)
    };
    means.iter().zip(others).enumerate().map(band).sum::<f64>().sqrt()
}
