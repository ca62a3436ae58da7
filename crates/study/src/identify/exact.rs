//! What a test that knows no state achieves, by simulation, beside the limits it is held against.
//!
//! The maximum-likelihood decision over all states of two materials is drawn many times; its balanced accuracy
//! (target in its state, alternative in its nearest) stands beside the limit Φ(d), the estimate for tests of best fits
//! and the rigorous bracket. In up to three bands Algorithm 1 of the paper gives the same decision on a lattice.

mod results;

pub use results::{Exact, ExactLibrary, ExactPair};

use crate::simulate::normal_error;
use crate::{Study, Surface};
use hadar::demand::{self, Reason, Thing};
use hadar::error::{Error, Result, check};
use hadar::fisher::{Counting, Nuisance};
use hadar::identifiability::bracket::KnownStates;
use hadar::identifiability::detection;
use hadar::identifiability::lattice::{LatticeDetection, LatticeDetector, LatticeMesh};
use hadar::identifiability::local::LocalSolver;
use hadar::identifiability::nearest::StateRange;
use hadar::order;
use hadar::parallel;
use hadar::policy;
use hadar::statistics::Statistics;
use hadar_simulate::decision::{Balanced, DecisionScene};
use hadar_simulate::draws::{GENERATOR, LARGEST_MEAN};
use hadar_simulate::sequential::Plan;

/// Most photons for which the lattice of counts is laid.
const LATTICE_PHOTONS: f64 = 1e5;
/// Cells along the counts of each of three bands, the coarse mesh of two: decision boundaries cross their square, and
/// with electronic noise, whose counts are continuous, no box is too small to be divided.
const CELLS_OF_THREE_BANDS: [usize; 2] = [256, 24];

/// Law of counting by its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Law {
    /// Shot noise alone.
    Poisson,
    /// Shot noise and the camera's electronic noise.
    Gaussian,
    /// Bunched photons of thermal light.
    NegativeBinomial,
}

/// How the simulation is to be made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Trial {
    /// Law of counting; where `None` Gaussian with a camera's electronic noise, else Poisson.
    pub law: Option<Law>,
    /// Photons of the target in all bands; the camera's where `None`, or without a camera those at which the
    /// nearest distance meets the requirement.
    pub photons: Option<f64>,
    /// Seed, interval and limit of trials.
    pub plan: Plan,
}

impl Trial {
    /// A simulation as it is asked for: seed, half width of the 95 % interval at which it stops, most trials. Messages name the flags
    /// of the command line.
    ///
    /// # Errors
    /// Photons that are not positive; what [`Plan::new`] refuses.
    pub fn asked(
        law: Option<Law>,
        photons: Option<f64>,
        (seed, half_width, trials): (u64, f64, u64),
    ) -> Result<Self> {
        if let Some(photons) = photons {
            check::positive("--photons", photons, "")?;
        }
        let flag = if trials == 0 { "--trials" } else { "--half-width" };
        let plan = Plan::new(seed, half_width, trials).map_err(|error| error.for_key(flag))?;
        Ok(Self { law, photons, plan })
    }
}

impl Study {
    /// Simulates the decision between the target and every alternative, and among all of them. `progress` is
    /// called with the pairs done and their number.
    ///
    /// # Errors
    /// A scene without photons, or too many of them to draw; electronic noise without a camera.
    pub fn exact(&self, trial: &Trial, progress: &dyn Fn(usize, usize)) -> Result<Exact> {
        let hardest_first = self.hardest_first(trial)?;
        let photons = match (trial.photons, self.counting()) {
            (Some(photons), _) => photons,
            (None, Some(counting)) => counting.counts_per_radiance * self.photon_radiance(),
            (None, None) => self.photons_for_the_hardest(&hardest_first)?,
        };
        let hardest_first: Vec<&Surface> =
            hardest_first.into_iter().map(|(_, alternative)| alternative).collect();
        if photons > LARGEST_MEAN {
            let found = format!("{photons:.2e} photons are too many to draw");
            let instead = format!("ask for at most {LARGEST_MEAN:e} with --photons");
            return Err(Error::malformed(found, instead));
        }
        let counts_per_radiance = photons / self.photon_radiance();
        let statistics = self.statistics(trial.law, counts_per_radiance)?;
        let scene = DecisionScene {
            bands: &self.bands,
            surroundings: &self.surroundings,
            unknowns: &self.unknowns,
            range: self.range,
            counts_per_radiance,
            statistics: &statistics,
        };
        let total = hardest_first.len();
        let mut pairs = Vec::with_capacity(total);
        for (done, alternative) in hardest_first.iter().enumerate() {
            progress(done, total);
            pairs.push(self.exact_pair(alternative, &scene, photons, &trial.plan)?);
        }
        progress(total, total);
        let library = if total > 1 {
            Some(self.exact_library(&hardest_first, &pairs, &scene, &trial.plan)?)
        } else {
            None
        };
        for pair in &pairs {
            // From the nearest state back, and the local distance.
            demand::computed(Thing::NearestSearches, 1);
            self.book_local(&self.unknowns, 1);
            book_trials(pair.trials, 2, &trial.plan);
        }
        library.iter().for_each(|library: &ExactLibrary| book_trials(library.trials, 1, &trial.plan));
        Ok(Exact {
            statistics: statistics.name(),
            normal_error: normal_error(
                &statistics,
                &[self.target_signal().iter().map(|s| s * counts_per_radiance).collect()],
            )?,
            generator: GENERATOR,
            seed: trial.plan.seed(),
            level: trial.plan.level(),
            pairs,
            library,
        })
    }

    /// The alternatives with their nearest distances per √photon, nearest first; a single one whose distance nobody
    /// asks for has none.
    fn hardest_first(&self, trial: &Trial) -> Result<Vec<(f64, &Surface)>> {
        let photons_are_known = trial.photons.is_some() || self.camera.is_some();
        if let ([only], true) = (self.alternatives.as_slice(), photons_are_known) {
            demand::spared(Thing::NearestSearches, Reason::NotAsked, 1);
            return Ok(vec![(f64::NAN, only)]);
        }
        let mut ranked = parallel::booked(self.alternatives.len(), |i| {
            let alternative = &self.alternatives[i];
            Ok((self.nearest(alternative, f64::INFINITY)?.distance, alternative))
        })?;
        order::ascending(&mut ranked, |(distance, _)| *distance);
        Ok(ranked)
    }

    /// Photons at which the nearest alternative that differs at all is told apart as required.
    fn photons_for_the_hardest(&self, hardest_first: &[(f64, &Surface)]) -> Result<f64> {
        let photons =
            hardest_first.iter().find_map(|(distance, _)| policy::photons_required(self.required, *distance));
        photons.ok_or_else(|| {
            let found = "no number of photons distinguishes the target from any alternative";
            Error::malformed(found, "change the scene or the alternatives").at(self.scenario.place("target"))
        })
    }

    fn statistics(&self, law: Option<Law>, counts_per_radiance: f64) -> Result<Statistics> {
        let noisy = self.counting().filter(|counting| counting.var_added.iter().any(|&var| var > 0.0));
        let silent = if noisy.is_some() { Law::Gaussian } else { Law::Poisson };
        match law.unwrap_or(silent) {
            Law::Poisson => Ok(Statistics::Poisson),
            Law::Gaussian => {
                let Some(counting) = noisy else {
                    let found =
                        "gaussian statistics are those of a camera's electronic noise, and there is none";
                    let instead = "add a [camera] with noise, or use --statistics poisson";
                    return Err(Error::malformed(found, instead).at(self.scenario.place("camera")));
                };
                Statistics::gaussian(counting.var_added)
            }
            Law::NegativeBinomial => self.bunched(counts_per_radiance),
        }
    }

    fn exact_pair(
        &self,
        alternative: &Surface,
        scene: &DecisionScene<'_>,
        photons: f64,
        plan: &Plan,
    ) -> Result<ExactPair> {
        let (own, other) = (&self.target.emissivity, &alternative.emissivity);
        // All noise beyond that of the photons: electronic, or that of bunching about the state's own means.
        let counting = |means: &[f64]| Counting {
            counts_per_radiance: scene.counts_per_radiance,
            var_added: means
                .iter()
                .enumerate()
                .map(|(band, mean)| (scene.statistics.variance(band, *mean) - mean).max(0.0))
                .collect(),
        };
        let Balanced { probability, interval, classes, alternative_state, distance } =
            scene.balanced((own, other), &self.state, plan)?;
        let means = |emissivity: &[f64], state| -> Vec<f64> {
            let signal = self.bands.weigh(&self.surroundings.signal(emissivity, state));
            signal.iter().map(|s| s * scene.counts_per_radiance).collect()
        };
        let states = [means(own, &self.state), means(other, &alternative_state)];
        let mut solver = self.nearest_solver();
        let back = solver.with_counting(other, own, &alternative_state, &counting(&states[1]))?;
        let ratio = if distance > 0.0 { (back.distance / distance).min(1.0) } else { 1.0 };
        let local = LocalSolver::new(&self.bands, &self.surroundings, self.unknowns.clone()).with_counting(
            own,
            other,
            &self.state,
            &counting(&states[0]),
        )?;
        let bracket = KnownStates::new(&states[0], &states[1], scene.statistics)?.bracket();
        Ok(ExactPair {
            alternative: alternative.name.clone(),
            photons,
            statistical_distance_nearest: distance,
            statistical_distance_local: local.distance,
            limit: detection::probability(distance),
            local: detection::probability(local.distance),
            two_sided: detection::two_sided_probability(distance, ratio),
            error_lower: bracket.lower,
            error_upper: bracket.upper,
            balanced: probability,
            balanced_interval: interval,
            trials: classes.iter().map(|class| class.trials).sum(),
            unconverged: classes.iter().map(|class| class.unconverged).sum(),
            classes: classes.map(|class| class.probability),
            lattice: self.lattice(alternative, scene.statistics, photons)?,
        })
    }

    /// Algorithm 1 where it is feasible: up to three bands, few photons, and a range of temperatures to mesh.
    fn lattice(
        &self,
        alternative: &Surface,
        statistics: &Statistics,
        photons: f64,
    ) -> Result<Option<LatticeDetection>> {
        let unbounded = self.range.temperature_k == StateRange::default().temperature_k
            && self.is_unknown(Nuisance::Temperature);
        // With noise above all the light every state looks alike, and there is nothing to decide.
        let drowned = match statistics {
            Statistics::Gaussian { var_added } => var_added.iter().any(|var| var.sqrt() > photons),
            Statistics::Poisson | Statistics::NegativeBinomial { .. } => false,
        };
        if self.bands.len() > 3 || photons > LATTICE_PHOTONS || unbounded || drowned {
            return Ok(None);
        }
        let library = [self.target.emissivity.clone(), alternative.emissivity.clone()];
        let unknowns = self.unknowns.clone();
        let [whole, continuous] = CELLS_OF_THREE_BANDS;
        let mesh = match (self.bands.len(), statistics) {
            (3, Statistics::Gaussian { .. }) => LatticeMesh { cells: continuous, ..LatticeMesh::default() },
            (3, _) => LatticeMesh { cells: whole, ..LatticeMesh::default() },
            _ => LatticeMesh::default(),
        };
        LatticeDetector::new(&self.bands, &self.surroundings, unknowns, self.range, statistics.clone())?
            .with_mesh(mesh)?
            .detect(&library, 0, &self.state, photons)
            .map(Some)
    }

    fn exact_library(
        &self,
        alternatives: &[&Surface],
        pairs: &[ExactPair],
        scene: &DecisionScene<'_>,
        plan: &Plan,
    ) -> Result<ExactLibrary> {
        let all = || std::iter::once(&self.target).chain(alternatives.iter().copied());
        let emissivities: Vec<&[f64]> = all().map(|surface| surface.emissivity.as_slice()).collect();
        let found = scene.detection(&emissivities, 0, &self.state, plan)?;
        let trials = found.trials as f64;
        let decisions = all().zip(&found.decisions).map(|(surface, n)| (surface.name.clone(), n / trials));
        let confused: f64 = pairs.iter().map(|pair| 2.0 * pair.error_upper).sum();
        Ok(ExactLibrary {
            probability: found.probability,
            interval: found.interval,
            decisions: decisions.collect(),
            union_bound_known_states: (1.0 - confused).max(0.0),
            trials: found.trials,
        })
    }
}

/// Trials of so many truths, of each as many as the plan has at most.
fn book_trials(trials: u64, truths: u64, plan: &Plan) {
    demand::computed(Thing::Trials, trials);
    let most = truths.saturating_mul(plan.most_trials());
    demand::spared(Thing::Trials, Reason::NarrowEnough, most.saturating_sub(trials));
}
