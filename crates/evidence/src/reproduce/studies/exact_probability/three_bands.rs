//! Three bands: Algorithm 1 of the paper beside Monte Carlo.

use super::decided::{Estimate, Materials};
use hadar::error::Result;
use hadar::identifiability::detection;
use hadar::identifiability::lattice::{LatticeDetector, LatticeMesh};
use hadar::statistics::Statistics;

/// Algorithm 1 and Monte Carlo for one pair in three bands.
pub(super) struct LatticeLine {
    pub(super) names: [&'static str; 2],
    pub(super) photons: f64,
    pub(super) promised: f64,
    pub(super) lattice: [f64; 2],
    pub(super) mesh_change: f64,
    pub(super) classes: [Estimate; 2],
    pub(super) mean: Estimate,
}

pub(super) fn lattice_line(all: &Materials<'_>, names: [&'static str; 2]) -> Result<LatticeLine> {
    let scene = &all.scene;
    let library = [all.emissivity(names[0])?, all.emissivity(names[1])?];
    let state = scene.state(60.0, 0.5)?;
    let distances = scene.distances(&library[0], &library[1], &state)?;
    let (photons, kappa) = distances.photons_at(1.0);
    let law = Statistics::Poisson;
    let mesh = LatticeMesh { temperatures: 129, lightings: 65, ..LatticeMesh::default() };
    let detector = LatticeDetector::new(
        &scene.bands,
        &scene.surroundings,
        scene.unknowns.clone(),
        scene.range,
        law.clone(),
    )?
    .with_mesh(mesh)?;
    let nearest = &distances.nearest_state;
    let theirs: f64 = scene.signal(&library[1], nearest).iter().map(|s| kappa * s).sum();
    let first = detector.detect(&library, 0, &state, photons)?;
    let second = detector.detect(&library, 1, nearest, theirs)?;
    let drawn = scene.decisions(kappa, &law).balanced((&library[0], &library[1]), &state, &all.plan)?;
    let classes = [0, 1].map(|i| {
        let class = &drawn.classes[i];
        Estimate { value: class.probability, low: class.interval.low, high: class.interval.high }
    });
    Ok(LatticeLine {
        names,
        photons,
        promised: detection::probability(photons.sqrt() * distances.local),
        lattice: [first.probabilities[0], second.probabilities[1]],
        mesh_change: first.mesh_change.max(second.mesh_change),
        classes,
        mean: Estimate { value: drawn.probability, low: drawn.interval.low, high: drawn.interval.high },
    })
}
