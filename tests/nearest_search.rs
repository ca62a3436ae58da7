//! The search for the nearest state against refinements from a very dense set of starts.

use hadar::fisher::{Counting, Nuisance, Unknowns};
use hadar::identifiability::nearest::{NearestSolver, StateRange};
use hadar::scene::{EnvironmentObject, State, Surroundings};
use hadar::spectrum::Bands;

/// SplitMix64 (Steele, Lea, Flood 2014): the same numbers everywhere.
struct Draws(u64);

impl Draws {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// A smooth random emissivity: a level and four cosines over the window.
    fn emissivity(&mut self, nodes: &[f64]) -> Vec<f64> {
        let level = self.between(0.1, 0.95);
        let waves: Vec<f64> = (0..4).map(|_| self.between(-0.15, 0.15)).collect();
        let at = |nu: f64| {
            let t = std::f64::consts::PI * (nu - 715.0) / 535.0;
            (1..).zip(&waves).map(|(i, a)| a * (f64::from(i) * t).cos()).sum::<f64>() + level
        };
        nodes.iter().map(|&nu| at(nu).clamp(0.02, 0.99)).collect()
    }
}

struct Case {
    bands: Bands,
    surroundings: Surroundings,
    emissivity: Vec<f64>,
    alternative: Vec<f64>,
    state: State,
    unknowns: Unknowns,
    name: String,
}

fn case(draws: &mut Draws, index: usize) -> Case {
    let count = [4, 7, 16, 54, 120][index % 5];
    let bands = Bands::uniform(715.0, 1250.0, 535.0 / f64::from(count - 1)).unwrap();
    let nodes = bands.nodes_cm1().to_vec();
    let objects: Vec<EnvironmentObject> = (0..1 + index % 2)
        .map(|k| EnvironmentObject {
            temperature_k: draws.between(220.0, 320.0),
            emissivity: (k == 1).then(|| draws.emissivity(&nodes)),
        })
        .collect();
    let surroundings = Surroundings::new(&nodes, objects).unwrap();
    let lighting: Vec<f64> = surroundings
        .objects()
        .iter()
        .map(|_| draws.between(0.02, 0.98 / surroundings.objects().len() as f64))
        .collect();
    let state = surroundings.state(draws.between(250.0, 360.0), &lighting).unwrap();
    let mut unknowns = Unknowns::new([Nuisance::Temperature, Nuisance::Lighting]).unwrap();
    if index % 3 == 2 {
        unknowns = unknowns.with(Nuisance::Gain);
    }
    let name = format!("case {index}: {count} bands, {} objects, {:?}", lighting.len(), unknowns.nuisances());
    let (emissivity, alternative) = (draws.emissivity(&nodes), draws.emissivity(&nodes));
    Case { bands, surroundings, emissivity, alternative, state, unknowns, name }
}

/// Best of refinements from `starts` temperatures over four octaves around the target's, each with low, equal
/// and high lighting.
fn dense(case: &Case, starts: u32) -> f64 {
    let mut solver =
        NearestSolver::new(&case.bands, &case.surroundings, case.unknowns.clone(), StateRange::default());
    let counting = Counting::shot(1.0, &case.surroundings_signal());
    let mut best = f64::INFINITY;
    for i in 0..starts {
        let octave = 4.0 * f64::from(i) / f64::from(starts - 1) - 1.5;
        let share = [0.05, 0.5, 0.95][i as usize % 3];
        let objects = case.state.lighting.len() as f64;
        let start = State {
            temperature_k: case.state.temperature_k * octave.exp2(),
            lighting: vec![share / objects; case.state.lighting.len()],
            ..case.state.clone()
        };
        let found = solver
            .refine_with_counting(&case.emissivity, &case.alternative, &case.state, &counting, &start)
            .unwrap();
        // With the gain free some pairs have a valley that leads to no temperature at endless gain.
        if (0.01..100.0).contains(&found.state.gain) {
            best = best.min(found.distance);
        }
    }
    best
}

impl Case {
    fn surroundings_signal(&self) -> Vec<f64> {
        self.bands.weigh(&self.surroundings.signal(&self.emissivity, &self.state))
    }
}

/// Tolerance 1e-7: along a valley of no temperature and much gain the last digits take thousands of steps.
#[test]
fn the_search_finds_what_dense_starts_find() {
    let mut draws = Draws(20_260_722);
    // Without optimisation the same cases would take minutes.
    let cases = if cfg!(debug_assertions) { 20 } else { 240 };
    let mut failures = Vec::new();
    for index in 0..cases {
        let case = case(&mut draws, index);
        let mut solver =
            NearestSolver::new(&case.bands, &case.surroundings, case.unknowns.clone(), StateRange::default());
        let found =
            solver.per_photon(&case.emissivity, &case.alternative, &case.state, f64::INFINITY).unwrap();
        let best = dense(&case, 200);
        if found.distance > best * (1.0 + 1e-7) + 1e-13 {
            failures.push(format!(
                "{}: {:e} instead of {best:e}, converged {}, at {:?}",
                case.name, found.distance, found.converged, found.state
            ));
        }
    }
    assert!(failures.is_empty(), "{} of {cases} fail\n{}", failures.len(), failures.join("\n"));
}
