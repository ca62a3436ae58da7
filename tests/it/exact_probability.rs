//! Exact probabilities against each other: direct enumeration, the lattice, the brackets and the distances.

use hadar::fisher::{Nuisance, Unknowns};
use hadar::identifiability::bracket::KnownStates;
use hadar::identifiability::detection;
use hadar::identifiability::lattice::{LatticeDetection, LatticeDetector, LatticeMesh, StateRange};
use hadar::identifiability::nearest::NearestSolver;
use hadar::scene::{EnvironmentObject, State, Surroundings};
use hadar::spectrum::Bands;
use hadar::statistics::Statistics;
use hadar_testing::seeded;
use proptest::prelude::*;
use statrs::function::gamma::ln_gamma;

/// Probabilities of 0, 1, 2, … counts, far enough that nothing is left.
fn masses(mean: f64, modes: Option<f64>) -> Vec<f64> {
    let sigma = (mean + modes.map_or(0.0, |m| mean * mean / m)).sqrt();
    let ln_mass = |n: f64| match modes {
        Some(m) => {
            ln_gamma(n + m) - ln_gamma(m) - ln_gamma(n + 1.0) + n * (mean / (mean + m)).ln()
                - m * (mean / m).ln_1p()
        }
        None => n * mean.ln() - mean - ln_gamma(n + 1.0),
    };
    (0..(mean + 25.0 * sigma + 40.0) as u32).map(|n| ln_mass(f64::from(n)).exp()).collect()
}

/// ½Σ min(p, q) over one or two bands.
fn exact_error(p: &[Vec<f64>], q: &[Vec<f64>]) -> f64 {
    let at = |masses: &[f64], n: usize| masses.get(n).copied().unwrap_or(0.0);
    let counts = |band: usize| p.get(band).map_or(1, |p| p.len().max(q[band].len()));
    let second = |masses: &[Vec<f64>], n: usize| masses.get(1).map_or(1.0, |masses| at(masses, n));
    let mut sum = 0.0;
    for n1 in 0..counts(0) {
        for n2 in 0..counts(1) {
            sum += (at(&p[0], n1) * second(p, n2)).min(at(&q[0], n1) * second(q, n2));
        }
    }
    0.5 * sum
}

proptest! {
    #![proptest_config(seeded(3, 150))]

    /// The likelihood-ratio error of 1–2 bands lies within the bracket, whatever the law.
    #[test]
    fn brackets_hold_the_exact_error(
        means in proptest::collection::vec((0.01..60.0_f64, 0.01..60.0_f64, 0.3..100.0_f64), 1..3),
        bunched in any::<bool>(),
    ) {
        let law = |i: usize| bunched.then_some(means[i].2);
        let p: Vec<Vec<f64>> = (0..means.len()).map(|i| masses(means[i].0, law(i))).collect();
        let q: Vec<Vec<f64>> = (0..means.len()).map(|i| masses(means[i].1, law(i))).collect();
        let exact = exact_error(&p, &q);
        let statistics = if bunched {
            Statistics::negative_binomial(means.iter().map(|m| m.2).collect()).unwrap()
        } else {
            Statistics::Poisson
        };
        let column = |pick: fn(&(f64, f64, f64)) -> f64| means.iter().map(pick).collect::<Vec<f64>>();
        let found = KnownStates::new(&column(|m| m.0), &column(|m| m.1), &statistics).unwrap().bracket();
        // 1e-9: what the enumeration leaves out and the rounding of ln Γ.
        prop_assert!(found.lower <= exact * (1.0 + 1e-9) && exact <= found.upper * (1.0 + 1e-9),
            "{exact:e} {found:?}");
        if !bunched {
            let d = means.iter().map(|m| (m.0.sqrt() - m.1.sqrt()).powi(2)).sum::<f64>().sqrt();
            let by_distance = detection::error_bracket(d);
            prop_assert!(found.lower >= by_distance.lower * (1.0 - 1e-12));
            prop_assert!(found.upper <= by_distance.upper * (1.0 + 1e-12));
        }
    }
}

struct Scene {
    bands: Bands,
    surroundings: Surroundings,
}

fn scene(centers: &[f64]) -> Scene {
    let bands = Bands::from_rows(centers.iter().map(|&nu| (nu, 40.0))).unwrap();
    let object = EnvironmentObject { temperature_k: 293.15, emissivity: None };
    let surroundings = Surroundings::new(bands.nodes_cm1(), vec![object]).unwrap();
    Scene { bands, surroundings }
}

impl Scene {
    fn means(&self, emissivity: &[f64], state: &State) -> Vec<f64> {
        self.surroundings.signal(emissivity, state).iter().map(|s| 40.0 * s).collect()
    }

    fn detect(
        &self,
        unknowns: &Unknowns,
        range: StateRange,
        library: &[Vec<f64>],
        target: usize,
        state: &State,
        photons: f64,
    ) -> LatticeDetection {
        let mesh = LatticeMesh { temperatures: 60, lightings: 20, ..LatticeMesh::default() };
        LatticeDetector::new(&self.bands, &self.surroundings, unknowns.clone(), range, Statistics::Poisson)
            .and_then(|detector| detector.with_mesh(mesh))
            .and_then(|detector| detector.detect(library, target, state, photons))
            .unwrap()
    }
}

/// Nothing unknown: the lattice's two correct decisions average to 1 − ½Σ min(p, q).
#[test]
fn the_lattice_of_known_states_is_the_likelihood_ratio() {
    let scene = scene(&[850.0, 1150.0]);
    let library = [vec![0.95, 0.9], vec![0.6, 0.8]];
    let state = scene.surroundings.state(320.0, &[0.4]).unwrap();
    let all: Vec<Vec<f64>> = library.iter().map(|e| scene.means(e, &state)).collect();
    let counts = 150.0 / all[0].iter().sum::<f64>();
    let law = |i: usize| all[i].iter().map(|s| masses(counts * s, None)).collect::<Vec<_>>();
    let exact = exact_error(&law(0), &law(1));
    let unknowns = Unknowns::new([]).unwrap();
    let right: f64 = (0..2)
        .map(|i| {
            let photons = counts * all[i].iter().sum::<f64>();
            let found = scene.detect(&unknowns, StateRange::default(), &library, i, &state, photons);
            found.probabilities[i]
        })
        .sum();
    assert!(exact > 0.05 && (0.5 * right - (1.0 - exact)).abs() < 1e-8, "{right} {exact}");
}

/// Temperature and lighting unknown, three bands: no rule, averaged over the target and its nearest state, is
/// right more often than the best test of the two known states. A narrow range of states helps.
#[test]
fn best_fits_stay_below_the_limit_of_the_nearest_state() {
    let scene = scene(&[800.0, 1000.0, 1200.0]);
    let unknowns = Unknowns::new([Nuisance::Temperature, Nuisance::Lighting]).unwrap();
    let range = StateRange { temperature_k: [280.0, 360.0], ..StateRange::default() };
    let library = [vec![0.95, 0.9, 0.92], vec![0.75, 0.6, 0.8]];
    let state = scene.surroundings.state(318.0, &[0.5]).unwrap();
    let photons = 3000.0;
    let nearest = NearestSolver::new(&scene.bands, &scene.surroundings, unknowns.clone(), range)
        .per_photon(&library[0], &library[1], &state, f64::INFINITY)
        .unwrap();
    let own = scene.means(&library[0], &state);
    let counts = photons / own.iter().sum::<f64>();
    let of = |means: &[f64]| means.iter().map(|s| counts * s).collect::<Vec<f64>>();
    let other = of(&scene.means(&library[1], &nearest.state));
    let bracket = KnownStates::new(&of(&own), &other, &Statistics::Poisson).unwrap().bracket();
    // −ln ρ = d²/2 with d the nearest distance at these photons.
    assert!((bracket.bhattacharyya / (0.5 * photons * nearest.distance.powi(2)) - 1.0).abs() < 1e-9);

    let right = |target: usize, state: &State, photons: f64, range| {
        scene.detect(&unknowns, range, &library, target, state, photons).probabilities[target]
    };
    let back = right(1, &nearest.state, other.iter().sum(), range);
    let average = 0.5 * (right(0, &state, photons, range) + back);
    let limit = detection::probability(photons.sqrt() * nearest.distance);
    println!("best fits {average:.4}, limit {limit:.4}, bracket {:.4}", 1.0 - bracket.lower);
    assert!(average <= 1.0 - bracket.lower && average <= limit + 0.005 && average > 0.6, "{average} {limit}");

    // Known to 2 K and 0.02 the same target is found more often.
    let narrow = StateRange { temperature_k: [317.0, 319.0], lighting: [0.49, 0.51], lighting_sum: 1.0 };
    let (wide, near) = (right(0, &state, photons, range), right(0, &state, photons, narrow));
    println!("wide range {wide:.4}, narrow range {near:.4}");
    assert!(near > wide + 0.01);
}
