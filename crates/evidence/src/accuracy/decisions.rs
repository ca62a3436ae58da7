//! Detection probability of the best fits, states unknown: Algorithm 1 on a lattice against simulated decisions.
//!
//! Three bands, temperature unknown, two materials. Errors are differences of probability. The truth is the lattice
//! with the finest meshes; that it agrees with the simulated decisions, which have no mesh, is seen in the chart.

use super::chart::{Chart, Measured};
use super::timing::{Budget, seconds_of};
use super::{Item, Order};
use hadar::error::Result;
use hadar::fisher::{Nuisance, Unknowns};
use hadar::identifiability::detection;
use hadar::identifiability::lattice::{LatticeDetector, LatticeMesh};
use hadar::identifiability::nearest::{NearestSolver, StateRange};
use hadar::scene::{EnvironmentObject, Surroundings};
use hadar::spectrum::Bands;
use hadar::statistics::Statistics;
use hadar_simulate::decision::DecisionScene;
use hadar_simulate::sequential::Plan;

/// States of the mesh of temperature.
const MESHES: [usize; 5] = [8, 16, 32, 64, 128];
const FINEST: usize = 1024;
const HALF_WIDTHS: [f64; 5] = [0.05, 0.02, 0.01, 0.005, 0.002];
/// Half width of `--exact` where nothing else is asked for.
const DEFAULT_HALF_WIDTH: f64 = 0.01;
const PHOTONS: f64 = 150.0;
const SEEDS: u64 = 8;

pub(super) fn measure(order: Order) -> Result<Chart> {
    let bands = Bands::from_rows([(800.0, 50.0), (1000.0, 50.0), (1200.0, 50.0)])?;
    let object = EnvironmentObject { temperature_k: 293.15, emissivity: None };
    let surroundings = Surroundings::new(bands.nodes_cm1(), vec![object])?;
    let unknowns = Unknowns::new([Nuisance::Temperature])?;
    let range = StateRange { temperature_k: [270.0, 350.0], ..StateRange::default() };
    let materials = [vec![0.95, 0.95, 0.95], vec![0.9, 0.6, 0.75]];
    let state = surroundings.state(310.15, &[0.5])?;
    let statistics = Statistics::Poisson;
    let lattice = |temperatures: usize| -> Result<f64> {
        let mesh = LatticeMesh { temperatures, lightings: 1, gains: 1, ..LatticeMesh::default() };
        let detector =
            LatticeDetector::new(&bands, &surroundings, unknowns.clone(), range, Statistics::Poisson)?
                .with_mesh(mesh)?;
        Ok(detector.detect(&materials, 0, &state, PHOTONS)?.probabilities[0])
    };
    let truth = lattice(if order.quick { FINEST / 4 } else { FINEST })?;
    let mut measured = Vec::new();
    for mesh in order.some(&MESHES) {
        let error = (lattice(mesh)? - truth).abs();
        let seconds = seconds_of(Budget::QUICK, || lattice(mesh));
        measured.push(Measured::new("lattice (Algorithm 1)", mesh as f64, seconds, error));
    }

    let signal = bands.weigh(&surroundings.signal(&materials[0], &state));
    let scene = DecisionScene {
        bands: &bands,
        surroundings: &surroundings,
        unknowns: &unknowns,
        range,
        counts_per_radiance: PHOTONS / signal.iter().sum::<f64>(),
        statistics: &statistics,
    };
    let pair = [materials[0].as_slice(), materials[1].as_slice()];
    for half_width in order.some(&HALF_WIDTHS) {
        let once = |seed: u64| scene.detection(&pair, 0, &state, &Plan::new(seed, half_width, 1_000_000)?);
        let mut squares = 0.0;
        for seed in 0..SEEDS {
            squares += (once(order.seed + seed)?.probability - truth).powi(2);
        }
        // Trials are spread over threads; the chart is of one.
        let seconds = super::timing::one_thread(|| seconds_of(Budget::QUICK, || once(order.seed)));
        measured.push(
            Measured::new("simulated decisions", half_width, seconds, (squares / SEEDS as f64).sqrt())
                .default_if(half_width == DEFAULT_HALF_WIDTH)
                .reporting(half_width),
        );
    }

    let limit = || -> Result<f64> {
        let nearest = NearestSolver::new(&bands, &surroundings, unknowns.clone(), range).per_photon(
            &materials[0],
            &materials[1],
            &state,
            f64::INFINITY,
        )?;
        Ok(detection::probability(PHOTONS.sqrt() * nearest.distance))
    };
    let error = (limit()? - truth).abs();
    let seconds = seconds_of(Budget::of(order.quick), limit);
    measured.push(Measured::new("limit by the nearest distance", f64::NAN, seconds, error));
    Ok(Chart {
        name: Item::Decisions.name(),
        title: "Detection probability, temperature unknown",
        timed: "one probability",
        effort: "states of the mesh, or half width of the interval",
        error: "difference of the probability (of simulations: root mean square over 8 seeds)",
        reference: "the lattice with 1024 temperatures and twice as many",
        measured,
        remark: "The lattice serves up to three bands, simulated decisions any number, which is why they are the default. \
                 The limit is that of the best test averaged over two known states: what it is off by here is what not \
                 knowing the temperature costs, and that only one of the two states is looked at."
            .into(),
    })
}
