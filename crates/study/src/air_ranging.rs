//! A scenario of ranging by air answered: the least error of the distance over distances, what each band tells of it, the few best
//! bands, what a model without sky gets wrong, an estimator beside its bound, and stereo beside it all.
//!
//! Everything is of one pixel and one reading of all bands. The light of the path is part of the counts. The window of a second camera
//! has pixels of which each has its own temperature, lighting and emissivity, so that their informations add up.

mod bias;
mod point;
mod results;
mod stereo;
mod verdict;
mod warn;
mod witness;

pub use results::{
    AirBand, AirBest, AirFinding, AirPoint, AirRanging, AirSight, AirVerdict, AirWitness, BlindChange,
};

use super::Study;
use hadar::error::{Error, Result};
use hadar::fisher::{Counting, Unknowns};
use hadar::instrument::{Camera, View};
use hadar::material::Library;
use hadar::ranging::air::{AirScene, AirSolver, AirState, AirUnknowns};
use hadar::scene::Parameter;
use hadar::spectrum::Bands;
use hadar_scenario::{AirRangingScenario, Nuisance};

/// Halvings of the stretch in which the error passes what is demanded.
const HALVINGS: usize = 40;

/// How a study is to be answered.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct AirPlan {
    /// Spectra that are drawn and fitted at each of some distances; none for the bounds alone.
    pub trials: usize,
    /// Seed of the draws.
    pub seed: u64,
    /// How many of the bands are to be chosen, if any.
    pub bands: Option<usize>,
}

/// A scenario of ranging by air with everything it names looked up and checked.
#[derive(Debug)]
pub struct AirRangingStudy {
    scenario: AirRangingScenario,
    /// The scene at the target's own distance.
    study: Study,
    /// Bands as the camera weighs them, without the air.
    bands: Bands,
    camera: Camera,
    air_k: f64,
}

/// Solvers of the questions that are asked at every distance.
struct Solvers<'a> {
    asked: AirSolver<'a>,
    emissivity_known: Option<AirSolver<'a>>,
    lighting_known: Option<AirSolver<'a>>,
    without_sky: Option<AirSolver<'a>>,
}

impl AirRangingStudy {
    /// Looks up everything that `scenario` names, materials in `library`.
    ///
    /// # Errors
    /// An unknown material, camera or air, a file that cannot be used, air that does not cover the bands or the distances; each with file,
    /// line and key.
    pub fn new(scenario: &AirRangingScenario, library: &Library) -> Result<Self> {
        let study = Study::new(&scenario.scene, library).map_err(|error| match error {
            // Of the air on the nodes of the bands: it is the bands that can be changed.
            Error::At { ref place, source: ref inner }
                if place.key.as_deref() == Some("target.distance")
                    && matches!(&**inner, Error::OutOfRange { quantity, .. } if quantity == "wavenumber") =>
            {
                inner.as_ref().clone().at(scenario.place("bands"))
            }
            error => error,
        })?;
        if study.has_classes() {
            let found = "a class of several spectra, and a distance is bounded for one material";
            let error = Error::malformed(found, "name one of its members");
            return Err(error.at(scenario.place("target.material")));
        }
        let (Some(camera), Some(air)) = (study.camera.clone(), study.atmosphere.clone()) else {
            let found = Error::malformed("there is no camera or no air", "write [camera] and [atmosphere]");
            return Err(found.at(scenario.place("camera")));
        };
        let bands = camera.received(&study.open_bands);
        if let Some(beyond) = scenario.distances_m.iter().find(|z| **z > air.table.longest_m()) {
            let expected = format!(
                "at most {} m, the longest path in the air of `{}`",
                air.table.longest_m(),
                air.table.name()
            );
            let error = Error::out_of_range("distance", *beyond, "m", expected);
            return Err(error.at(scenario.place("distances")));
        }
        let mut filled = scenario.clone();
        filled.scene.bands = study.scenario.bands.clone();
        filled.scene.camera.clone_from(&study.scenario.camera);
        filled.scene.atmosphere.clone_from(&study.scenario.atmosphere);
        Ok(Self { scenario: filled, study, bands, camera, air_k: air.temperature_k })
    }

    /// The scenario, defaults filled in.
    #[must_use]
    pub fn scenario(&self) -> &AirRangingScenario {
        &self.scenario
    }

    /// Target, surroundings and air.
    fn scene(&self) -> Result<AirScene<'_>> {
        let Some(air) = &self.study.atmosphere else {
            return Err(Error::malformed("there is no air", "write [atmosphere]"));
        };
        Ok(AirScene {
            bands: &self.bands,
            surroundings: &self.study.surroundings,
            emissivity: &self.study.target.emissivity,
            air: &air.table,
        })
    }

    /// The scene with the target at a distance.
    fn state(&self, distance_m: f64) -> AirState {
        AirState { distance_m, target: self.study.state.clone(), air_k: self.air_k }
    }

    /// Counts and noise of the camera before that.
    fn counting(&self, state: &AirState) -> Result<Counting> {
        let scene = self.scene()?;
        let signal = scene.evaluate(scene.emissivity, state, &[], &[], false)?.signal;
        // The light of the path is part of what is measured.
        let mut view = View { signal, ..View::at(Some(state.distance_m)) };
        if self.camera.photon_bunching {
            view.occupancy = self.camera.counts_per_mode(&self.study.open_bands, &view);
        }
        Ok(self.camera.counting(&self.bands, &view))
    }

    fn solvers(&self) -> Result<Solvers<'_>> {
        let scene = self.scene()?;
        let unknown = self.scenario.unknown;
        let asked = AirUnknowns {
            scene: self.study.unknowns.clone(),
            air_temperature: unknown.air_temperature,
            emissivity: unknown.emissivity,
        };
        let is_lit = !self.study.surroundings.objects().is_empty();
        let without_lighting = |also: &[Nuisance]| -> Result<AirUnknowns> {
            Ok(AirUnknowns { scene: self.unknowns_without(also)?, ..asked.clone() })
        };
        let lighting_known = (is_lit && asked.scene.contains(Nuisance::Lighting))
            .then(|| AirSolver::new(scene, without_lighting(&[Nuisance::Lighting])?));
        let lit = self.study.state.lighting.iter().any(|lighting| *lighting > 0.0);
        let no_sky = [Nuisance::Lighting, Nuisance::EnvironmentTemperature];
        let without_sky = lit.then(|| AirSolver::new(scene, without_lighting(&no_sky)?));
        let known = AirUnknowns { emissivity: None, ..asked.clone() };
        Ok(Solvers {
            emissivity_known: unknown.emissivity.map(|_| AirSolver::new(scene, known)).transpose()?,
            lighting_known: lighting_known.transpose()?,
            without_sky: without_sky.transpose()?,
            asked: AirSolver::new(scene, asked)?,
        })
    }

    /// The unknowns of the scene but some.
    fn unknowns_without(&self, left_out: &[Nuisance]) -> Result<Unknowns> {
        let all = &self.study.unknowns;
        let kept = all.nuisances().iter().copied().filter(|nuisance| !left_out.contains(nuisance));
        let mut unknowns = Unknowns::new(kept)?;
        for nuisance in unknowns.nuisances().to_vec() {
            let parameter = match nuisance {
                Nuisance::Temperature => Parameter::Temperature,
                Nuisance::Lighting => Parameter::Lighting(0),
                Nuisance::Gain => Parameter::Gain,
                Nuisance::EnvironmentTemperature => Parameter::EnvironmentTemperature(0),
            };
            if let Some(sigma) = all.sigma_prior(parameter) {
                unknowns = unknowns.prior(nuisance, sigma)?;
            }
        }
        Ok(unknowns)
    }

    /// The answer. `progress` is told how many of how many distances are done.
    ///
    /// # Errors
    /// Scores that are no numbers; fewer bands to be chosen than there are unknowns; counts that cannot be drawn.
    pub fn range(&self, plan: &AirPlan, progress: &dyn Fn(usize, usize)) -> Result<AirRanging> {
        let solvers = self.solvers()?;
        let distance_m = self.scenario.scene.target.distance_m.unwrap_or(f64::NAN);
        let best = plan.bands.map(|count| self.best_bands(&solvers.asked, distance_m, count)).transpose()?;
        let witnesses = self.witness_distances(plan);
        let jobs = self.scenario.distances_m.len() + witnesses.len();
        let at = self.point(&solvers, distance_m)?;
        let mut curve = Vec::with_capacity(self.scenario.distances_m.len());
        for (i, z) in self.scenario.distances_m.iter().enumerate() {
            curve.push(self.point(&solvers, *z)?);
            progress(i + 1, jobs);
        }
        let mut witness = Vec::with_capacity(witnesses.len());
        for (i, z) in witnesses.iter().enumerate() {
            witness.extend(self.witness(&solvers.asked, plan, (i, *z))?);
            progress(curve.len() + i + 1, jobs);
        }
        let sight = self.sight(&solvers.asked, distance_m)?;
        let met_between_m = self.met_between(&solvers.asked, &curve, distance_m)?;
        let stereo_crossing_m = results::crossing(&curve);
        let verdict = self.verdict(&at, &sight, met_between_m)?;
        let bands = self.band_information(&solvers.asked, distance_m)?;
        let mut stats = self.study.looked_up.clone();
        stats.compute(hadar::demand::Thing::Readings, witness.iter().map(|one| one.trials as u64).sum());
        let mut result = AirRanging {
            scenario: self.scenario.clone(),
            verdict,
            target: self.study.target.name.clone(),
            camera: self.camera.name.clone(),
            air: self.scene()?.air.name().to_owned(),
            air_temperature_k: self.air_k,
            sight,
            at,
            curve,
            met_between_m,
            stereo_crossing_m,
            bands,
            best_bands: best,
            witness,
            trials: plan.trials,
            seed: plan.seed,
            warnings: Vec::new(),
            stats,
        };
        result.warnings = self.warnings(&result)?;
        Ok(result)
    }

    /// The stretch of distances in which the error is no more than is demanded: that about the target, else the nearest one.
    fn met_between(&self, solver: &AirSolver<'_>, curve: &[AirPoint], at_m: f64) -> Result<Option<[f64; 2]>> {
        let Some(demand) = self.scenario.requirement else { return Ok(None) };
        let meets =
            |point: &AirPoint| point.sigma_m.is_some_and(|sigma| sigma <= demand.at(point.distance_m));
        let stretches =
            || curve.chunk_by(|a, b| meets(a) == meets(b)).filter(|stretch| stretch.iter().all(meets));
        let holds = |stretch: &&[AirPoint]| {
            let ends = stretch.first().zip(stretch.last());
            ends.is_some_and(|(near, far)| near.distance_m <= at_m && at_m <= far.distance_m)
        };
        let Some(stretch) = stretches().find(holds).or_else(|| stretches().next()) else { return Ok(None) };
        let ends = stretch.first().zip(stretch.last()).map(|(near, far)| [near.distance_m, far.distance_m]);
        let Some([near, far]) = ends else { return Ok(None) };
        let before = curve.iter().rev().find(|point| point.distance_m < near);
        let after = curve.iter().find(|point| point.distance_m > far);
        // Between a distance that does and one that does not.
        let limit = |inside: f64, outside: Option<&AirPoint>| -> Result<f64> {
            let Some(outside) = outside else { return Ok(inside) };
            let (mut inside, mut outside) = (inside, outside.distance_m);
            for _ in 0..HALVINGS {
                let middle = (inside * outside).sqrt();
                let state = self.state(middle);
                match solver.bound(&state, &self.counting(&state)?)?.sigma_m <= demand.at(middle) {
                    true => inside = middle,
                    false => outside = middle,
                }
            }
            Ok(inside)
        };
        Ok(Some([limit(near, before)?, limit(far, after)?]))
    }
}
