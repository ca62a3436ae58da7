//! A pair at one photon number: every reading of its distance, and simulated decisions.

use crate::reproduce::studies::paper_scene::PaperScene;
use hadar::error::Result;
use hadar::fisher::{Counting, Unknowns};
use hadar::identifiability::bracket::KnownStates;
use hadar::identifiability::detection;
use hadar::identifiability::local::LocalSolver;
use hadar::identifiability::nearest::NearestSolver;
use hadar::material::Library;
use hadar::scene::State;
use hadar::statistics::Statistics;
use hadar_simulate::sequential::Plan;

/// Half of the 95 % interval of every simulated probability.
pub(super) const HALF_WIDTH: f64 = 0.006;
/// A probability that the local distance promises misleads if it is off by more than this.
pub(super) const MISLEADS: f64 = 0.02;

/// A probability with the ends of its interval.
#[derive(Clone, Copy)]
pub(super) struct Estimate {
    pub(super) value: f64,
    pub(super) low: f64,
    pub(super) high: f64,
}

impl Estimate {
    pub(super) fn print(self) -> String {
        format!("{:.3} ± {:.3}", self.value, 0.5 * (self.high - self.low))
    }
}

/// A pair at one photon number.
pub(super) struct Line {
    pub(super) names: [&'static str; 2],
    pub(super) celsius: f64,
    pub(super) law: &'static str,
    pub(super) photons: f64,
    /// √N times local, local with unknown gain (none with other laws), nearest.
    pub(super) local: f64,
    pub(super) unknown_gain: f64,
    pub(super) nearest: f64,
    pub(super) return_ratio: f64,
    pub(super) nearest_state: State,
    /// The test of best fits, averaged over the two states, and for each of them.
    pub(super) fitted: Estimate,
    pub(super) classes: [f64; 2],
    pub(super) known: Estimate,
    /// Rigorous limits of the best test between the two states.
    pub(super) bracket: [f64; 2],
}

impl Line {
    pub(super) fn promised(&self) -> f64 {
        detection::probability(self.local)
    }

    pub(super) fn limit(&self) -> f64 {
        detection::probability(self.nearest)
    }

    pub(super) fn two_sided(&self) -> f64 {
        detection::two_sided_probability(self.nearest, self.return_ratio)
    }

    pub(super) fn verdict(&self) -> &'static str {
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

/// What every pair shares: spectra by name, the scene, how long decisions are drawn.
pub(super) struct Materials<'a> {
    pub(super) library: &'a Library,
    pub(super) scene: PaperScene,
    pub(super) plan: Plan,
}

impl Materials<'_> {
    pub(super) fn emissivity(&self, name: &str) -> Result<Vec<f64>> {
        self.library.get(name)?.emissivity(self.scene.bands.nodes_cm1())
    }
}

/// A law of counting whose excess over Poisson is a fixed share of each band of the target.
pub(super) fn statistics(law: &str, means: &[f64]) -> Result<Statistics> {
    match law {
        "gaussian" => Statistics::gaussian(means.to_vec()),
        "negative-binomial" => Statistics::negative_binomial(means.iter().map(|n| 2.0 * n).collect()),
        _ => Ok(Statistics::Poisson),
    }
}

/// Everything about a pair where √N d_nearest is `level`, d_nearest by the noise of the law.
pub(super) fn line(
    all: &Materials<'_>,
    (a, b, celsius): (&'static str, &'static str, f64),
    law: &'static str,
    level: f64,
) -> Result<Line> {
    let scene = &all.scene;
    let (target, other) = (all.emissivity(a)?, all.emissivity(b)?);
    let state = scene.state(celsius, 0.5)?;
    let poisson = scene.distances(&target, &other, &state)?;
    let signal = scene.signal(&target, &state);
    let counted = |kappa: f64| -> Result<(Statistics, Counting)> {
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
    let fitted = decisions.balanced((&target, &other), &state, &all.plan)?;
    let known = decisions.known_states((&target, &state), (&other, &nearest.state), &all.plan)?;
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
