//! Nearest distance of a pair: with its proof, by the search alone, by lattices of states, and the local distance that stands for
//! it at times.

use super::chart::{Chart, Measured};
use super::item::off;
use super::scene::{Pair, unknowns};
use super::timing::{Budget, seconds_of};
use super::{Item, Order};
use hadar::error::Result;
use hadar::identifiability::local::LocalSolver;
use hadar::identifiability::nearest::{NearestSolver, StateRange};

/// Points of the lattice along temperature, and along lighting.
const MESHES: [usize; 6] = [8, 16, 32, 64, 128, 256];
/// Bands of 1 cm⁻¹.
const PAPER: usize = 536;
/// To what share of itself the distance is proved.
const PROOF: f64 = 1e-6;
/// Temperatures of the lattice, K.
const RANGE_K: [f64; 2] = [250.0, 450.0];

pub(super) fn measure(order: Order) -> Result<Chart> {
    let budget = Budget::of(order.quick);
    let pair = Pair::skin_and_aluminium(PAPER)?;
    let Pair { bands, surroundings, target, alternative, state } = &pair;
    let mut solver = NearestSolver::new(bands, surroundings, unknowns()?, StateRange::default());
    let mut search = || solver.per_photon(target, alternative, state, f64::INFINITY);
    let found = search()?;
    let truth = pair.nearest_from(found.state)?;
    let error = off(found.distance, &truth);
    let seconds = seconds_of(budget, search);
    let mut measured = vec![Measured::new("search alone", f64::NAN, seconds, error)];
    let mut solver = solver.proving(PROOF);
    let mut proof = || solver.per_photon(target, alternative, state, f64::INFINITY);
    let found = proof()?;
    let reported = 1.0 - found.lower / found.distance;
    let proof = Measured::new("proved", f64::NAN, seconds_of(budget, proof), off(found.distance, &truth));
    measured.push(proof.reporting(reported).default_if(true));
    let most = if order.quick { 64 } else { 256 };
    for mesh in MESHES.into_iter().filter(|mesh| *mesh <= most) {
        let lattice = || lattice(&pair, mesh);
        let error = off(lattice()?, &truth);
        let seconds = seconds_of(Budget::QUICK, lattice);
        measured.push(Measured::new("lattice of states (points a side)", mesh as f64, seconds, error));
    }
    let mut local = LocalSolver::new(bands, surroundings, unknowns()?);
    let mut local = || local.per_photon(target, alternative, state, f64::INFINITY);
    let error = off(local()?.distance, &truth);
    measured.push(Measured::new("local distance in its place", f64::NAN, seconds_of(budget, local), error));
    Ok(Chart {
        name: Item::Nearest.name(),
        title: "Nearest distance of skin from aluminium",
        timed: "one distance",
        effort: "points a side",
        error: "relative error against the same bands in extended precision",
        reference: "the minimum refined in extended precision",
        measured,
        remark: "The search alone proves nothing; the proof reports the share that the distance may be too large by. A lattice between 250 and 450 K, V from 0 to 1: its error falls with the square of the mesh once that \
                 is fine enough to hold the valley."
            .into(),
    })
}

/// The least distance over a lattice of temperatures and lighting factors.
fn lattice(pair: &Pair, mesh: usize) -> Result<f64> {
    let Pair { bands, surroundings, target, alternative, state } = pair;
    let own = bands.weigh(&surroundings.signal(target, state));
    let total = hadar::sum::sum(&own);
    let roots: Vec<f64> = own.iter().map(|signal| signal.sqrt()).collect();
    let mut least = f64::INFINITY;
    for i in 0..mesh {
        let share = i as f64 / (mesh - 1) as f64;
        let temperature_k = RANGE_K[0] + share * (RANGE_K[1] - RANGE_K[0]);
        for j in 0..mesh {
            let state = surroundings.state(temperature_k, &[j as f64 / (mesh - 1) as f64])?;
            let other = bands.weigh(&surroundings.signal(alternative, &state));
            let squares = roots.iter().zip(&other).map(|(root, other)| (root - other.sqrt()).powi(2));
            least = least.min(squares.sum::<f64>() / total);
        }
    }
    Ok(least.sqrt())
}
