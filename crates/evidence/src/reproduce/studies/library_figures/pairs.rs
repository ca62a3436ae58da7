//! The pairs of a library: their distances, and simulated decisions of some.

use crate::reproduce::studies::paper_scene::{Distances, PaperScene};
use hadar::error::Result;
use hadar::identifiability::detection;
use hadar::material::Library;
use hadar::statistics::Statistics;
use hadar_simulate::sequential::{Interval, Plan};

/// Two materials, by their place in the library, and the distances between them.
pub(super) struct Pair {
    pub(super) names: [String; 2],
    pub(super) materials: [usize; 2],
    pub(super) distances: Distances,
}

impl Pair {
    /// The local distance over the nearest.
    pub(super) fn ratio(&self) -> f64 {
        self.distances.local / self.distances.nearest
    }
}

/// A pair where √N d_nearest = 1.
pub(super) struct Decided {
    pub(super) names: [String; 2],
    pub(super) photons: f64,
    /// √N d_local.
    pub(super) local: f64,
    pub(super) return_ratio: f64,
    pub(super) probability: f64,
    pub(super) interval: Interval,
    pub(super) known: f64,
    pub(super) trials: u64,
    pub(super) unconverged: u64,
}

impl Decided {
    /// What the local distance calls the limit.
    pub(super) fn promised(&self) -> f64 {
        detection::probability(self.local)
    }

    pub(super) fn two_sided(&self) -> f64 {
        detection::two_sided_probability(1.0, self.return_ratio)
    }
}

/// The spectra, and all ordered pairs of them.
pub(super) fn all_pairs(scene: &PaperScene, library: &Library) -> Result<(Vec<Vec<f64>>, Vec<Pair>)> {
    let names: Vec<&str> = library.names().collect();
    let nodes = scene.bands.nodes_cm1();
    let materials: Vec<Vec<f64>> =
        names.iter().map(|name| library.get(name)?.emissivity(nodes)).collect::<Result<_>>()?;
    let state = scene.state(60.0, 0.5)?;
    let mut pairs = Vec::new();
    for (i, target) in materials.iter().enumerate() {
        for (j, other) in materials.iter().enumerate().filter(|(j, _)| *j != i) {
            let distances = scene.distances(target, other, &state)?;
            let names = [names[i].to_owned(), names[j].to_owned()];
            pairs.push(Pair { names, materials: [i, j], distances });
        }
    }
    Ok((materials, pairs))
}

/// Decisions between two materials with the photons at which √N d_nearest = 1.
pub(super) fn decide(
    scene: &PaperScene,
    materials: &[Vec<f64>],
    pair: &Pair,
    plan: &Plan,
) -> Result<Decided> {
    let [target, other] = pair.materials.map(|i| materials[i].as_slice());
    let state = scene.state(60.0, 0.5)?;
    let (photons, kappa) = pair.distances.photons_at(1.0);
    let decisions = scene.decisions(kappa, &Statistics::Poisson);
    let found = decisions.balanced((target, other), &state, plan)?;
    let known =
        decisions.known_states((target, &state), (other, &pair.distances.nearest_state), plan)?.probability;
    Ok(Decided {
        names: pair.names.clone(),
        photons,
        local: pair.ratio(),
        return_ratio: pair.distances.back / pair.distances.nearest,
        probability: found.probability,
        interval: found.interval,
        known,
        trials: found.classes.iter().map(|class| class.trials).sum(),
        unconverged: found.classes.iter().map(|class| class.unconverged).sum(),
    })
}
