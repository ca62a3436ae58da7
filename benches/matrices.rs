//! Milliseconds of distances of one pair and of matrices of 30, 300 and 1 000 smooth materials in 536 bands, with what they sum up to; and, of 12
//! materials, of nearest distances for each set of unknowns, with the share that is proved.
//!
//!     RAYON_NUM_THREADS=1 cargo bench --bench matrices [-- local|nearest|searched|apart|close|unknowns [pair|MATERIALS]]
//!
//! `nearest` is proved to 10⁻⁶, `searched` is not; `apart` counts the pairs that a camera tells apart at d = 1, `close` those at d = 20. The
//! same cases in NumPy are in `numpy_peer.py`.

mod made_up;

use hadar::fisher::{Counting, Nuisance, Unknowns};
use hadar::identifiability::local::LocalSolver;
use hadar::identifiability::multi::{LibraryScene, LocalMatrix, Skipping};
use hadar::identifiability::nearest::{NearestSolver, StateRange};
use hadar::planck::photon_radiance;
use hadar::scene::{EnvironmentObject, State, Surroundings};
use hadar::spectrum::Bands;
use made_up::library;
use std::time::Instant;

/// To what share of itself a nearest distance is proved.
const PROOF: f64 = 1e-6;

/// What the command line asks for: a case and a number, or all.
struct Asked(Vec<String>);

impl Asked {
    fn wants(&self, case: &str, number: &str) -> bool {
        self.0.iter().zip([case, number]).all(|(asked, one)| asked == one)
    }

    /// Prints the milliseconds of the fastest of the runs of half a second at these states in turn, and the result at the last of them.
    fn report(
        &self,
        case: &str,
        number: &str,
        states: &[State],
        mut run: impl FnMut(&State) -> hadar::Result<f64>,
    ) {
        if !self.wants(case, number) {
            return;
        }
        let (mut least, mut spent, mut result) = (f64::INFINITY, 0.0, 0.0);
        while spent < 0.5 {
            for state in states {
                let start = Instant::now();
                result = run(state).expect("a valid scene");
                let now = start.elapsed().as_secs_f64();
                (least, spent) = (now.min(least), spent + now);
            }
        }
        println!("{case} {number}: {:.4} ms, {result:.11e}", 1e3 * least);
    }
}

/// Skin at 37 °C and the robot of the paper.
fn one_pair(asked: &Asked, scene: &LibraryScene) {
    let place = |nu: f64| (nu - 985.0) / 265.0;
    let robot = |&nu: &f64| 0.49287 - 0.0782 * place(nu) + 0.00892 * place(nu) * place(nu);
    let (skin, robot) = (vec![0.95; scene.bands.len()], scene.bands.nodes_cm1().iter().map(robot));
    let robot: Vec<f64> = robot.collect();
    // In turn: nothing may be taken from the call before.
    let states = [311.15, 310.15].map(|t| scene.surroundings.state(t, &[0.5]).expect("valid state"));
    let (bands, surroundings, unknowns) = (scene.bands, scene.surroundings, scene.unknowns);
    let mut local = LocalSolver::new(bands, surroundings, unknowns.clone());
    asked.report("local", "pair", &states, |state| {
        Ok(local.per_photon(&skin, &robot, state, f64::INFINITY)?.distance)
    });
    let mut searching = NearestSolver::new(bands, surroundings, unknowns.clone(), scene.range);
    let mut proving = searching.clone().proving(PROOF);
    for (case, solver) in [("searched", &mut searching), ("nearest", &mut proving)] {
        asked.report(case, "pair", &states, |state| {
            Ok(solver.per_photon(&skin, &robot, state, f64::INFINITY)?.distance)
        });
    }
}

/// So many materials against each other.
fn matrices(asked: &Asked, scene: LibraryScene, count: usize) {
    let number = count.to_string();
    let materials = library(scene.bands.nodes_cm1(), count);
    let materials: Vec<&[f64]> = materials.iter().map(Vec::as_slice).collect();
    let states = std::slice::from_ref(scene.state);
    let mut local = LocalMatrix::new(scene.bands, scene.surroundings, scene.unknowns.clone());
    asked.report("local", &number, states, |state| Ok(local.per_photon(&materials, state)?.iter().sum()));
    if count <= 300 {
        for (case, tolerance) in [("searched", None), ("nearest", Some(PROOF))] {
            let scene = LibraryScene { tolerance, ..scene };
            let sum = |_: &State| Ok(scene.nearest_per_photon(&materials, &|_, _| ())?.distance.iter().sum());
            asked.report(case, &number, states, sum);
        }
    }
    // 10⁶ photons from a blackbody in the target's place, 10 electrons of noise in every band.
    let black: f64 = scene.bands.nodes_cm1().iter().map(|&nu| photon_radiance(nu, 333.15)).sum();
    let counting = Counting { counts_per_radiance: 1e6 / black, var_added: vec![100.0; scene.bands.len()] };
    for (case, required) in [("apart", 1.0), ("close", 20.0)] {
        if case == "apart" || count <= 300 {
            asked.report(case, &number, states, |_| {
                let told = scene.told_apart(&materials, &counting, required, Skipping::On, &|_, _| ())?;
                let apart = |a: usize| (a + 1..count).filter(|&b| told.told_apart(a, b)).count();
                Ok((0..count).map(apart).sum::<usize>() as f64)
            });
        }
    }
}

/// Nearest distances of so many materials with each set of unknowns.
fn sets_of_unknowns(scene: LibraryScene, count: usize) {
    let all = [Nuisance::Temperature, Nuisance::Lighting, Nuisance::Gain, Nuisance::EnvironmentTemperature];
    let materials = library(scene.bands.nodes_cm1(), count);
    let materials: Vec<&[f64]> = materials.iter().map(Vec::as_slice).collect();
    let pairs = count * (count - 1);
    for set in 1..16_usize {
        let unknown: Vec<Nuisance> = (0..4).filter(|i| set >> i & 1 == 1).map(|i| all[i]).collect();
        let unknowns = &Unknowns::new(unknown.iter().copied()).expect("distinct");
        let start = Instant::now();
        let found = LibraryScene { unknowns, ..scene }.nearest_per_photon(&materials, &|_, _| ());
        let time = 1e3 * start.elapsed().as_secs_f64() / pairs as f64;
        let found = found.expect("a valid scene");
        let places = (0..count * count).filter(|place| place / count != place % count);
        let proved = places.filter(|&place| found.is_proved_to(place, PROOF)).count();
        println!(
            "unknowns {count}, {unknown:?}: {time:.3} ms a pair, {proved} of {pairs} proved to {PROOF:e}"
        );
    }
}

fn main() {
    let asked = Asked(std::env::args().skip(1).filter(|one| !one.starts_with("--")).collect());
    let bands = Bands::uniform(715.0, 1250.0, 1.0).expect("valid bands");
    let object = EnvironmentObject { temperature_k: 293.15, emissivity: None };
    let surroundings = Surroundings::new(bands.nodes_cm1(), vec![object]).expect("valid surroundings");
    let unknowns = Unknowns::new([Nuisance::Temperature, Nuisance::Lighting]).expect("distinct");
    let state = surroundings.state(333.15, &[0.5]).expect("valid state");
    let scene = LibraryScene {
        bands: &bands,
        surroundings: &surroundings,
        unknowns: &unknowns,
        range: StateRange::default(),
        state: &state,
        tolerance: Some(PROOF),
    };
    one_pair(&asked, &scene);
    for count in [30, 300, 1000] {
        matrices(&asked, scene, count);
    }
    if asked.wants("unknowns", asked.0.get(1).map_or("", String::as_str)) {
        let count = asked.0.get(1).and_then(|count| count.parse().ok()).unwrap_or(12);
        sets_of_unknowns(scene, count);
    }
}
