//! Skin against aluminium at one state of the skin: photons that the task takes by every reading.

use crate::reproduce::studies::paper_scene::PaperScene;
use hadar::error::Result;
use hadar::fisher::Nuisance;
use hadar::identifiability::bayes::{BayesianBound, Distances, Pair};
use hadar::identifiability::detection;
use hadar::identifiability::nearest::StateRange;
use hadar::material::Library;
use hadar::spectrum::Bands;
use hadar::statistics::Statistics;
use hadar_simulate::sequential::Plan;

/// Deviation of the prior of the curves, K.
pub(super) const PRIOR_K: f64 = 2.0;
/// Temperature of the surroundings, °C.
pub(super) const AMBIENT_CELSIUS: f64 = 20.0;

/// Photons for a statistical distance of 1, by every reading; none where no number suffices.
#[derive(Clone, Copy)]
pub(super) struct Photons {
    pub(super) nearest: Option<f64>,
    pub(super) local: Option<f64>,
    pub(super) bound: Option<f64>,
    pub(super) average_nearest: Option<f64>,
    pub(super) average_local: Option<f64>,
}

impl Photons {
    pub(super) fn all(&self) -> [Option<f64>; 5] {
        [self.nearest, self.local, self.bound, self.average_nearest, self.average_local]
    }
}

/// The scene and its two materials.
pub(super) struct Task {
    pub(super) scene: PaperScene,
    pub(super) skin: Vec<f64>,
    pub(super) aluminium: Vec<f64>,
}

impl Task {
    pub(super) fn new(library: &Library) -> Result<Self> {
        let mut scene = PaperScene::new(Bands::uniform(715.0, 1250.0, 1.0)?)?;
        scene.range = StateRange::default();
        let nodes = scene.bands.nodes_cm1();
        let skin = library.get("skin")?.emissivity(nodes)?;
        let aluminium = library.get("aluminium")?.emissivity(nodes)?;
        Ok(Self { scene, skin, aluminium })
    }

    pub(super) fn photons(&self, celsius: f64, lighting: f64, prior_k: f64) -> Result<Photons> {
        let scene = &self.scene;
        let state = scene.state(celsius, lighting)?;
        let plain = scene.distances(&self.skin, &self.aluminium, &state)?;
        // Distances below this are rounding.
        let required = |distance: f64| (distance > 1e-12).then(|| distance.powi(-2));
        let unknowns = scene.unknowns.clone().prior(Nuisance::Temperature, prior_k)?;
        // A single prior, to all digits.
        let bayes = BayesianBound::new(&scene.bands, &scene.surroundings, unknowns).with_order(32)?;
        let pair = Pair { emissivity: &self.skin, alternative: &self.aluminium, state: &state };
        let average = |distances| {
            let found =
                bayes.photons_for_average(pair, detection::probability(1.0), distances, &|_, _| ())?;
            Ok::<_, hadar::Error>(found.map(|found| found.photons))
        };
        Ok(Photons {
            nearest: required(plain.nearest),
            local: required(plain.local),
            bound: bayes.photons_required(pair, 1.0)?,
            average_nearest: average(Distances::Nearest(scene.range))?,
            average_local: average(Distances::Local)?,
        })
    }

    /// Share of right decisions with `photons` photons from a target at just this temperature, 95 % within ± 0.006.
    pub(super) fn simulated(&self, celsius: f64, lighting: f64, photons: f64, seed: u64) -> Result<f64> {
        let scene = PaperScene {
            unknowns: self.scene.unknowns.clone().prior(Nuisance::Temperature, PRIOR_K)?,
            ..self.scene.clone()
        };
        let state = scene.state(celsius, lighting)?;
        let kappa = photons / scene.signal(&self.skin, &state).iter().sum::<f64>();
        let plan = Plan::new(seed, 0.006, 100_000)?;
        let found = scene.decisions(kappa, &Statistics::Poisson).balanced(
            (&self.skin, &self.aluminium),
            &state,
            &plan,
        )?;
        Ok(found.probability)
    }
}

/// Photons at each value of what is varied.
pub(super) type Rows = [(Vec<f64>, Photons)];
