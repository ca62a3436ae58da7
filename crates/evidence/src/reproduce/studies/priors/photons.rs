//! Skin against aluminium at one state of the skin: photons that the task takes by every reading.

use crate::reproduce::studies::paper_scene::PaperScene;
use hadar::error::Result;
use hadar::fisher::{Nuisance, Unknowns};
use hadar::identifiability::bayes::{BayesianBound, Pair, PriorSpace};
use hadar::identifiability::detection;
use hadar::identifiability::nearest::StateRange;
use hadar::material::Library;
use hadar::scene::State;
use hadar::spectrum::Bands;
use hadar::statistics::Statistics;
use hadar_simulate::average::AverageScene;
use hadar_simulate::draws::Draws;

/// Deviation of the prior of the curves, K.
pub(super) const PRIOR_K: f64 = 2.0;
/// Deviation of the prior on the lighting of the curves.
pub(super) const PRIOR_LIGHTING: f64 = 0.1;
/// Temperature of the surroundings, °C.
pub(super) const AMBIENT_CELSIUS: f64 = 20.0;

/// Photons for a statistical distance of 1, by every reading; none where no number suffices.
#[derive(Clone, Copy)]
pub(super) struct Photons {
    pub(super) nearest: Option<f64>,
    pub(super) local: Option<f64>,
    pub(super) bound: Option<f64>,
    pub(super) average_lower: Option<f64>,
    pub(super) average_upper: Option<f64>,
}

impl Photons {
    pub(super) fn all(&self) -> [Option<f64>; 5] {
        [self.nearest, self.local, self.bound, self.average_lower, self.average_upper]
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

    /// With priors of `prior_k` on the temperature and, where it is not known, of `prior_lighting` on the lighting.
    pub(super) fn photons(
        &self,
        celsius: f64,
        lighting: f64,
        prior_k: f64,
        prior_lighting: Option<f64>,
    ) -> Result<Photons> {
        let scene = &self.scene;
        let state = scene.state(celsius, lighting)?;
        let plain = scene.distances(&self.skin, &self.aluminium, &state)?;
        // Distances below this are rounding.
        let required = |distance: f64| (distance > 1e-12).then(|| distance.powi(-2));
        let bayes = BayesianBound::new(&scene.bands, &scene.surroundings, unknowns(prior_k, prior_lighting)?);
        let pair = self.pair(&state);
        let average = bayes.photons_for_average(pair, detection::probability(1.0), &|_, _| ())?;
        Ok(Photons {
            nearest: required(plain.nearest),
            local: required(plain.local),
            bound: bayes.photons_required(pair, 1.0)?,
            average_lower: average.map(|average| average.lower),
            average_upper: average.and_then(|average| average.upper),
        })
    }

    fn pair<'t>(&'t self, state: &'t State) -> Pair<'t> {
        Pair { emissivity: &self.skin, alternative: &self.aluminium, state }
    }

    /// Share of correct decisions of the Bayes test with `photons` photons, both states drawn from the priors: ± 0.005, 95 %.
    pub(super) fn simulated(&self, celsius: f64, lighting: f64, photons: f64, seed: u64) -> Result<f64> {
        let scene = &self.scene;
        let state = scene.state(celsius, lighting)?;
        let prior =
            PriorSpace::new(&unknowns(PRIOR_K, Some(PRIOR_LIGHTING))?, &state, &StateRange::default())?;
        let test = AverageScene {
            bands: &scene.bands,
            surroundings: &scene.surroundings,
            pair: self.pair(&state),
            priors: &[prior.clone(), prior],
            lighting_total_known: false,
            counts_per_radiance: photons / scene.signal(&self.skin, &state).iter().sum::<f64>(),
            statistics: &Statistics::Poisson,
        };
        let draws = |means: &[f64]| Draws::new(&Statistics::Poisson, means);
        Ok(test.decide(seed, 10_000, &draws)?.probability)
    }
}

fn unknowns(prior_k: f64, prior_lighting: Option<f64>) -> Result<Unknowns> {
    let temperature = Unknowns::new([Nuisance::Temperature])?.prior(Nuisance::Temperature, prior_k)?;
    match prior_lighting {
        Some(sigma) => temperature.with(Nuisance::Lighting).prior(Nuisance::Lighting, sigma),
        None => Ok(temperature),
    }
}

/// Photons at each value of what is varied.
pub(super) type Rows = [(Vec<f64>, Photons)];
