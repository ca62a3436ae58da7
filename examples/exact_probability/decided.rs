//! A pair at one photon number: every reading of its distance, and simulated decisions.

use crate::paper_scene::PaperScene;
use crate::{HALF_WIDTH, MISLEADS, SEED};
use hadar::fisher::{Counting, Unknowns};
use hadar::identifiability::bracket::KnownStates;
use hadar::identifiability::detection;
use hadar::identifiability::local::LocalSolver;
use hadar::identifiability::nearest::NearestSolver;
use hadar::material::Library;
use hadar::scene::State;
use hadar::simulate::sequential::Plan;
use hadar::statistics::Statistics;

/// A probability with the ends of its interval.
#[derive(Clone, Copy)]
pub struct Estimate {
    pub value: f64,
    pub low: f64,
    pub high: f64,
}

impl Estimate {
    pub fn print(self) -> String {
        format!("{:.3} ± {:.3}", self.value, 0.5 * (self.high - self.low))
    }
}

/// A pair at one photon number.
pub struct Line {
    pub names: [&'static str; 2],
    pub celsius: f64,
    pub law: &'static str,
    pub photons: f64,
    /// √N times local, local with unknown gain (none with other laws), nearest.
    pub local: f64,
    pub unknown_gain: f64,
    pub nearest: f64,
    pub return_ratio: f64,
    pub nearest_state: State,
    /// The test of best fits, averaged over the two states, and for each of them.
    pub fitted: Estimate,
    pub classes: [f64; 2],
    pub known: Estimate,
    /// Rigorous limits of the best test between the two states.
    pub bracket: [f64; 2],
}

impl Line {
    pub fn promised(&self) -> f64 {
        detection::probability(self.local)
    }

    pub fn limit(&self) -> f64 {
        detection::probability(self.nearest)
    }

    pub fn two_sided(&self) -> f64 {
        detection::two_sided_probability(self.nearest, self.return_ratio)
    }

    pub fn verdict(&self) -> &'static str {
        let off = self.promised() - self.fitted.value;
        if off > MISLEADS {
            "local misleads: too optimistic"
        } else if off < -MISLEADS {
            "local misleads: too pessimistic"
        } else {
            "local agrees"
        }
    }
}

pub struct Materials {
    pub library: Library,
    pub scene: PaperScene,
}

impl Materials {
    pub fn new(scene: PaperScene) -> hadar::Result<Self> {
        Ok(Self { library: Library::embedded()?, scene })
    }

    pub fn emissivity(&self, name: &str) -> hadar::Result<Vec<f64>> {
        self.library.get(name)?.emissivity(self.scene.bands.nodes_cm1())
    }
}

/// A law of counting whose excess over Poisson is a fixed share of each band of the target.
pub fn statistics(law: &str, means: &[f64]) -> hadar::Result<Statistics> {
    match law {
        "gaussian" => Statistics::gaussian(means.to_vec()),
        "negative-binomial" => Statistics::negative_binomial(means.iter().map(|n| 2.0 * n).collect()),
        _ => Ok(Statistics::Poisson),
    }
}

/// Everything about a pair where √N d_nearest is `level`, d_nearest by the noise of the law.
pub fn line(
    all: &Materials,
    (a, b, celsius): (&'static str, &'static str, f64),
    law: &'static str,
    level: f64,
) -> hadar::Result<Line> {
    let scene = &all.scene;
    let (target, other) = (all.emissivity(a)?, all.emissivity(b)?);
    let state = scene.state(celsius, 0.5)?;
    let poisson = scene.distances(&target, &other, &state)?;
    let signal = scene.signal(&target, &state);
    let counted = |kappa: f64| -> hadar::Result<(Statistics, Counting)> {
        let means: Vec<f64> = signal.iter().map(|s| kappa * s).collect();
        let statistics = statistics(law, &means)?;
        let excess = means.iter().enumerate().map(|(w, &n)| statistics.variance(w, n) - n).collect();
        Ok((statistics, Counting { counts_per_radiance: kappa, var_added: excess }))
    };
    let solver =
        || NearestSolver::new(&scene.bands, &scene.surroundings, scene.unknowns.clone(), scene.range);
    // All noise grows with the photons as shot noise does, so that d goes with √N.
    let (_, one) = counted(1.0 / poisson.photon_radiance)?;
    let photons = (level / solver().with_counting(&target, &other, &state, &one)?.distance).powi(2);
    let kappa = photons / poisson.photon_radiance;
    let (statistics, counting) = counted(kappa)?;
    let nearest = solver().with_counting(&target, &other, &state, &counting)?;
    let back = solver().with_counting(&other, &target, &nearest.state, &counting)?.distance;
    let local = |unknowns: Unknowns| {
        LocalSolver::new(&scene.bands, &scene.surroundings, unknowns)
            .with_counting(&target, &other, &state, &counting)
            .map(|found| found.distance)
    };
    let decisions = scene.decisions(kappa, &statistics);
    let plan = Plan::new(SEED, HALF_WIDTH, 100_000)?;
    let fitted = decisions.balanced((&target, &other), &state, &plan)?;
    let known = decisions.known_states((&target, &state), (&other, &nearest.state), &plan)?;
    let means = |emissivity: &[f64], state: &State| -> Vec<f64> {
        scene.signal(emissivity, state).iter().map(|s| kappa * s).collect()
    };
    let bracket =
        KnownStates::new(&means(&target, &state), &means(&other, &nearest.state), &statistics)?.bracket();
    Ok(Line {
        names: [a, b],
        celsius,
        law,
        photons,
        local: local(scene.unknowns.clone())?,
        unknown_gain: photons.sqrt() * poisson.local_unknown_gain,
        nearest: nearest.distance,
        return_ratio: back / nearest.distance,
        nearest_state: nearest.state,
        fitted: Estimate { value: fitted.probability, low: fitted.interval.low, high: fitted.interval.high },
        classes: [fitted.classes[0].probability, fitted.classes[1].probability],
        known: Estimate { value: known.probability, low: known.interval.low, high: known.interval.high },
        bracket: [1.0 - bracket.upper, 1.0 - bracket.lower],
    })
}
