//! One experiment of a simulation: classes, laws, limits, and what each classifier achieved.

use super::photons::seed_of;
use super::standing::held_against;
use super::{NORMAL, PhotonLaw, SimulatedClass, SimulatedPoint, SimulationPlan, TestSpectra};
use crate::{Study, Surface};
use hadar::error::{Error, Result};
use hadar::fisher::Counting;
use hadar::identifiability::detection::{half_separation, probability};
use hadar::identifiability::local::LocalSolver;
use hadar::identifiability::nearest::NearestSolver;
use hadar::identifiability::ratio::RatioLaw;
use hadar::instrument::gamma_per_band;
use hadar::scene::State;
use hadar::statistics::Statistics;
use hadar_simulate::classifier::{Method, Trained};
use hadar_simulate::decision::DecisionScene;
use hadar_simulate::draws::Draws;
use hadar_simulate::draws::gaussian::gaussian_distance;
use hadar_simulate::experiment::{Design, Experiment};

/// A class: material, state, and distance from the target in units of the noise.
struct Class<'s> {
    surface: &'s Surface,
    state: State,
    distance: f64,
    /// Mean counts of each band.
    means: Vec<f64>,
}

impl Study {
    /// Draws, trains and judges with so many photons; `together` is the level at which all comparisons of the simulation
    /// hold together.
    pub(super) fn experiment(
        &self,
        plan: &SimulationPlan,
        rivals: &[&Surface],
        photons: f64,
        together: f64,
    ) -> Result<(SimulatedPoint, Vec<Trained>)> {
        let counting = self.counting_at(photons, plan.camera_noise);
        let scale = counting.counts_per_radiance;
        let statistics = self.judged_as(plan.law, &counting)?;
        // What the distances take for noise beyond that of the photons.
        let signal = self.target_signal();
        let excess = match &statistics {
            Statistics::Poisson => Vec::new(),
            law => signal.iter().enumerate().map(|(w, s)| law.variance(w, s * scale) - s * scale).collect(),
        };
        let noise = Counting { counts_per_radiance: scale, var_added: excess };
        let classes = self.classes(plan.law, rivals, photons, &noise)?;
        let (Some(target), Some(rival)) =
            (classes.first(), classes.iter().skip(1).min_by(|a, b| a.distance.total_cmp(&b.distance)))
        else {
            return Err(Error::malformed(
                "there is no alternative to distinguish the target from",
                "name one",
            ));
        };

        let means: Vec<Vec<f64>> = classes.iter().map(|class| class.means.clone()).collect();
        let draws = means.iter().map(|means| self.draws(plan.law, photons, means, &counting));
        let draws: Vec<Draws> = draws.collect::<Result<_>>()?;
        let scene = DecisionScene {
            bands: &self.bands,
            surroundings: &self.surroundings,
            unknowns: &self.unknowns,
            range: self.range,
            counts_per_radiance: scale,
            statistics: &statistics,
        };
        let states: Vec<(&[f64], &State)> =
            classes.iter().map(|class| (class.surface.emissivity.as_slice(), &class.state)).collect();
        let fitted = plan.design.methods.contains(&Method::BestFits);
        let best_fits = fitted.then(|| scene.best_fits(&states)).transpose()?;
        let trained: Vec<Trained> = plan.models.iter().map(|saved| saved.model.clone()).collect();
        let experiment = Experiment {
            draws: &draws,
            means: &means,
            statistics: &statistics,
            best_fits: best_fits.as_ref(),
            trained: &trained,
        };
        let error = normal_error(&statistics, &means)?;
        if plan.design.skip_spectra
            && (plan.law == PhotonLaw::FixedTotal || error.is_some_and(|e| e > NORMAL))
        {
            let found = "the likelihood ratio judges by another law than that of the counts";
            return Err(Error::malformed(found, "draw spectra: leave out --skip-spectra"));
        }
        let seed = seed_of(plan.design.seed, photons);
        let design = Design { seed, ..plan.design.clone() };
        let (performances, learnt) = experiment.run(&design)?;
        let spectra = plan.save_spectra.then(|| experiment.test_spectra(&design)).transpose()?;
        let spectra = spectra.map(|counts| TestSpectra {
            counts,
            seed,
            means: means.clone(),
            var_reading: (0..self.bands.len()).map(|band| counting.var_added(band)).collect(),
            centres_cm1: self.band_centres_cm1(),
        });

        let statistical_distance = match plan.law {
            PhotonLaw::FixedTotal => half_separation(&target.means, &rival.means, &noise),
            PhotonLaw::Poisson | PhotonLaw::NegativeBinomial => rival.distance,
        };
        let is_pair = classes.len() == 2;
        let limit_accuracy = match plan.law {
            PhotonLaw::Poisson | PhotonLaw::NegativeBinomial if is_pair => {
                Some(RatioLaw::new(&target.means, &rival.means, &statistics)?.accuracy())
            }
            _ => None,
        };
        let levels = (together, plan.design.level);
        let gamma = gamma_per_band(&counting, &signal);
        let of_photons = limit_accuracy.and((gamma == 0.0).then_some(statistical_distance));
        let held = |performance| held_against(performance, limit_accuracy, of_photons, levels);
        let (own, other) = (&self.target.emissivity, &rival.surface.emissivity);
        let local = LocalSolver::new(&self.bands, &self.surroundings, self.unknowns.clone())
            .with_counting(own, other, &self.state, &noise)?
            .distance;
        let silent = self.counting_at(photons, false);
        let normalised = self.solver().with_counting(own, other, &self.state, &silent)?.distance.powi(2);
        let point = SimulatedPoint {
            photons,
            normalised_photons: normalised,
            gamma,
            classes: classes.iter().map(Class::as_result).collect(),
            statistical_distance,
            statistical_distance_local: local,
            limit_accuracy,
            limit_accuracy_normal: probability(statistical_distance),
            local_accuracy: probability(local),
            normal_error: error,
            performances: performances.into_iter().map(held).collect::<Result<_>>()?,
            spectra,
        };
        Ok((point, learnt))
    }

    fn solver(&self) -> NearestSolver<'_> {
        self.nearest_solver()
    }

    /// The target in its state and each rival in its nearest, with their mean counts.
    fn classes<'s>(
        &'s self,
        law: PhotonLaw,
        rivals: &[&'s Surface],
        photons: f64,
        noise: &Counting,
    ) -> Result<Vec<Class<'s>>> {
        let class = |surface: &'s Surface, state: State, distance: f64| {
            let signal = self.bands.weigh(&self.surroundings.signal(&surface.emissivity, &state));
            let mut means: Vec<f64> = signal.iter().map(|s| s * noise.counts_per_radiance).collect();
            if law == PhotonLaw::FixedTotal {
                let brightness = photons / means.iter().sum::<f64>();
                means.iter_mut().for_each(|mean| *mean *= brightness);
            }
            Class { surface, state, distance, means }
        };
        let mut classes = vec![class(&self.target, self.state.clone(), f64::INFINITY)];
        for &rival in rivals {
            let (own, other) = (&self.target.emissivity, &rival.emissivity);
            let found = self.solver().with_counting(own, other, &self.state, noise)?;
            classes.push(class(rival, found.state, found.distance));
        }
        Ok(classes)
    }

    pub(super) fn draws(
        &self,
        law: PhotonLaw,
        photons: f64,
        means: &[f64],
        counting: &Counting,
    ) -> Result<Draws> {
        let draws = match law {
            PhotonLaw::Poisson => Draws::new(&Statistics::Poisson, means)?,
            PhotonLaw::NegativeBinomial => Draws::new(&self.bunched(counting.counts_per_radiance)?, means)?,
            PhotonLaw::FixedTotal => Draws::fixed_total(photons, means)?,
        };
        match counting.var_added.as_slice() {
            [] => Ok(draws),
            var_added => draws.with_electronic_noise(var_added),
        }
    }

    /// The law by which likelihoods judge: that of the photons, or a normal one where electronic noise comes on top.
    pub(super) fn judged_as(&self, law: PhotonLaw, counting: &Counting) -> Result<Statistics> {
        let photons = match law {
            PhotonLaw::Poisson | PhotonLaw::FixedTotal => Statistics::Poisson,
            PhotonLaw::NegativeBinomial => self.bunched(counting.counts_per_radiance)?,
        };
        if counting.var_added.iter().all(|&var| var == 0.0) {
            return Ok(photons);
        }
        let signal = self.target_signal();
        let variance = signal.iter().enumerate().map(|(band, s)| {
            let mean = s * counting.counts_per_radiance;
            counting.var_added(band) + (photons.variance(band, mean) - mean).max(0.0)
        });
        Statistics::gaussian(variance.collect())
    }
}

impl Class<'_> {
    fn as_result(&self) -> SimulatedClass {
        SimulatedClass {
            material: self.surface.name.clone(),
            temperature_k: self.state.temperature_k,
            lighting: self.state.lighting.clone(),
            photons: self.means.iter().sum(),
        }
    }
}

/// How far the distribution function of a band is from the normal one that likelihoods take it for, at most; `None`
/// where they do not.
pub(crate) fn normal_error(statistics: &Statistics, means: &[Vec<f64>]) -> Result<Option<f64>> {
    let Statistics::Gaussian { var_added } = statistics else { return Ok(None) };
    let mut largest = 0.0_f64;
    for means in means {
        for (&mean, &var) in means.iter().zip(var_added) {
            largest = largest.max(gaussian_distance(mean, var)?.largest);
        }
    }
    Ok(Some(largest))
}
