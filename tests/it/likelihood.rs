//! Fits of a material's state to counts, against brute force: fits from a lattice of states.

use crate::support::scenes;
use hadar::fisher::{Nuisance, Unknowns};
use hadar::identifiability::likelihood::{Fit, MaximumLikelihood};
use hadar::identifiability::nearest::{NearestSolver, StateRange};
use hadar::scene::State;
use hadar::statistics::Statistics;
use hadar_simulate::decision::DecisionScene;
use hadar_simulate::draws::{Draws, generator};
use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};

/// Likelihoods that differ by less are the same to any decision.
const SAME: f64 = 1e-6;

struct Outcome {
    /// ln L by brute force less ln L from the starts of a decision.
    missed: f64,
    /// The first fit.
    fit: Fit,
}

/// One draw in one scene at nearest distance `distance`, fitted by both materials.
fn compare(
    recipe: &scenes::Recipe,
    law: usize,
    gain: bool,
    distance: f64,
    seed: u64,
    tried: &mut Vec<Outcome>,
) {
    let scene = recipe.scene();
    let mut set = vec![Nuisance::Temperature, Nuisance::Lighting];
    set.extend(gain.then_some(Nuisance::Gain));
    let unknowns = Unknowns::new(set).unwrap();
    let range = StateRange::default();
    let (bands, surroundings, state) = (&scene.bands, &scene.surroundings, &scene.state);
    let mut solver = NearestSolver::new(bands, surroundings, unknowns.clone(), range);
    let nearest = solver.per_photon(&scene.emissivity, &scene.alternative, state, 1e12).unwrap().distance;
    let signal = scene.counts(&scene.emissivity, state);
    let photons = (distance / nearest).powi(2).min(1e14);
    let counts_per_radiance = photons / signal.iter().sum::<f64>();
    let means: Vec<f64> = signal.iter().map(|s| s * counts_per_radiance).collect();
    let average = photons / means.len() as f64;
    let statistics = match law {
        0 => Statistics::Poisson,
        1 => Statistics::gaussian(vec![average; means.len()]).unwrap(),
        _ => Statistics::negative_binomial(vec![average.max(1e-3); means.len()]).unwrap(),
    };
    let decision = DecisionScene {
        bands,
        surroundings,
        unknowns: &unknowns,
        range,
        counts_per_radiance,
        statistics: &statistics,
    };
    let draws = Draws::new(&statistics, &means).unwrap();
    let mut fits = MaximumLikelihood::new(
        bands,
        surroundings,
        unknowns.clone(),
        range,
        counts_per_radiance,
        statistics.clone(),
    )
    .unwrap();
    let mut counts = means.clone();
    draws.draw_into(&mut generator(seed, 0), &mut counts);
    for (own, surface) in [(true, &scene.emissivity), (false, &scene.alternative)] {
        let mut starts = decision.starts(&scene.emissivity, surface, state).unwrap();
        if own && !starts.contains(state) {
            starts.insert(0, state.clone());
        }
        let fit = fits.fit(surface, &counts, state, &starts);
        let dark = state.lighting.len() as f64;
        let mut lattice = Vec::new();
        for i in 0..24 {
            for share in [0.02, 0.5, 0.95] {
                lattice.push(State {
                    temperature_k: 170.0 * 1.06_f64.powi(i),
                    lighting: vec![share / dark; state.lighting.len()],
                    ..state.clone()
                });
            }
        }
        let brute = fits.fit(surface, &counts, state, &lattice);
        tried.push(Outcome { missed: brute.log_likelihood - fit.log_likelihood, fit });
    }
}

/// All three laws, distances from 0.7 to 5, temperature and lighting unknown and every fourth time gain. Of 6000 such
/// fits 9 ended below the lattice and 2 did not converge; of these 240 (48 where the code is not
/// optimised; fixed seed) at most one each.
#[test]
fn fits_are_as_good_as_those_from_a_lattice_of_starts() {
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &[13; 32]);
    let mut runner = TestRunner::new_with_rng(Config::default(), rng);
    let mut tried = Vec::new();
    let cases = if cfg!(debug_assertions) { 24 } else { 120 };
    for case in 0..cases {
        let recipe = scenes::recipe()
            .prop_map(|mut recipe| {
                recipe.step_cm1 *= (recipe.count - 1) as f64;
                recipe.count = recipe.count.min(60);
                recipe.step_cm1 /= (recipe.count - 1) as f64;
                recipe
            })
            .new_tree(&mut runner)
            .unwrap()
            .current();
        let distance = [0.7, 1.0, 2.0, 5.0][case % 4];
        compare(&recipe, case % 3, case % 16 >= 12, distance, case as u64, &mut tried);
    }
    let worse: Vec<f64> = tried.iter().map(|outcome| outcome.missed).filter(|m| *m > SAME).collect();
    let unconverged = tried.iter().filter(|outcome| !outcome.fit.converged).count();
    let iterations: usize = tried.iter().map(|outcome| outcome.fit.iterations).sum();
    println!(
        "{} fits: {worse:?} below the lattice, {unconverged} not converged, {:.1} iterations",
        tried.len(),
        iterations as f64 / tried.len() as f64
    );
    assert!(worse.len() <= 1 && unconverged <= 1);
}
