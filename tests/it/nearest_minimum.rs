//! The global minimum behind the nearest distance, where there are several.

use crate::support::scenes::recipe;
use hadar::fisher::{Counting, Nuisance, Unknowns};
use hadar::identifiability::nearest::{NearestSolver, StateRange};
use hadar::material::Library;
use hadar::scene::{EnvironmentObject, State, Surroundings};
use hadar::spectrum::Bands;
use hadar_testing::seeded;
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::{RngAlgorithm, TestRng, TestRunner};

/// Nearest distance per √photon as it is found, and the least that starts all over the range lead to.
fn found_and_least(
    solver: &mut NearestSolver<'_>,
    (emissivity, alternative): (&[f64], &[f64]),
    state: &State,
    signal: &[f64],
    free: &Unknowns,
) -> (f64, f64) {
    let photons: f64 = 1e7;
    let counting = Counting::shot(photons, signal);
    let found = solver.with_counting(emissivity, alternative, state, &counting).unwrap().distance;
    let mut least = found;
    for temperature_k in [200.0, 260.0, 280.0, 290.0, 300.0, 320.0, 350.0, 420.0, 700.0] {
        for lit in [0.0, 0.3, 0.6, 0.9, 1.0] {
            let mut start = state.clone();
            if free.contains(Nuisance::Temperature) {
                start.temperature_k = temperature_k;
            }
            if free.contains(Nuisance::Lighting) {
                let count = start.lighting.len() as f64;
                start.lighting.iter_mut().for_each(|factor| *factor = lit / count);
            }
            let refined = solver.refine_with_counting(emissivity, alternative, state, &counting, &start);
            least = least.min(refined.unwrap().distance);
        }
    }
    (found / photons.sqrt(), least / photons.sqrt())
}

/// The paper's pair around the temperature of its surroundings: below it a cold, well-lit robot competes with a hot,
/// dim one. Found to 1e-9 of the least of 45 starts, at each of 11 × 11 states.
#[test]
fn the_papers_pair_around_equilibrium() {
    let bands = Bands::uniform(715.0, 1250.0, 5.0).unwrap();
    let library = Library::embedded().unwrap();
    let on_bands = |name| library.get(name).unwrap().emissivity(bands.nodes_cm1()).unwrap();
    let (skin, robot) = (on_bands("skin"), on_bands("aluminium"));
    let object = EnvironmentObject { temperature_k: 293.15, emissivity: None };
    let surroundings = Surroundings::new(bands.nodes_cm1(), vec![object]).unwrap();
    let free = Unknowns::new([Nuisance::Temperature, Nuisance::Lighting]).unwrap();
    let mut solver = NearestSolver::new(&bands, &surroundings, free.clone(), StateRange::default());
    let mut missed = Vec::new();
    for celsius in (10..=30).step_by(2) {
        for tenth in 0..=10 {
            let (temperature_k, lighting) = (f64::from(celsius) + 273.15, 0.1 * f64::from(tenth));
            let state = surroundings.state(temperature_k, &[lighting]).unwrap();
            let signal = bands.weigh(&surroundings.signal(&skin, &state));
            let (found, least) = found_and_least(&mut solver, (&skin, &robot), &state, &signal, &free);
            if found > least * (1.0 + 1e-9) + 1e-15 {
                missed.push(format!("{celsius} degC, V = {lighting:.1}: {found:e}, not {least:e}"));
            }
        }
    }
    assert!(missed.is_empty(), "{} of 121 missed:\n{}", missed.len(), missed.join("\n"));
}

proptest! {
    #![proptest_config(seeded(20, 60))]

    /// Up to temperature and lighting unknown, smooth random spectra.
    #[test]
    fn no_start_leads_to_a_nearer_state(recipe in recipe(), count in 0usize..3) {
        let scene = recipe.scene();
        let free = Unknowns::new(Nuisance::ALL.into_iter().take(count)).unwrap();
        let mut solver = NearestSolver::new(&scene.bands, &scene.surroundings, free.clone(), StateRange::default());
        let signal = scene.counts(&scene.emissivity, &scene.state);
        let pair = (&scene.emissivity[..], &scene.alternative[..]);
        let (found, least) = found_and_least(&mut solver, pair, &scene.state, &signal, &free);
        prop_assert!(found <= least * (1.0 + 1e-9) + 1e-15, "{found:e}, not {least:e}");
    }
}

/// The same with gain, environment temperatures, or both unknown too: more valleys, and some that run out to
/// endless gain. Of 100 scenes each (fixed seed, so no false alarms), at most so many may miss the least of 45
/// starts by more than a thousandth; `nearest-search` is the warning that users get.
#[test]
fn few_searches_miss_with_more_unknown() {
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &[3; 32]);
    let mut runner = TestRunner::new_with_rng(seeded(20, 1), rng);
    let sets = [
        (vec![Nuisance::Gain], 0),
        (vec![Nuisance::EnvironmentTemperature], 20),
        (vec![Nuisance::Gain, Nuisance::EnvironmentTemperature], 28),
    ];
    for (more, most) in sets {
        let kinds = [Nuisance::Temperature, Nuisance::Lighting].into_iter().chain(more.clone());
        let free = Unknowns::new(kinds).unwrap();
        let (mut tried, mut missed) = (0, 0);
        while tried < 100 {
            let recipe = recipe().new_tree(&mut runner).unwrap().current();
            if free.parameters(recipe.objects.len()).len() >= recipe.count {
                continue;
            }
            let scene = recipe.scene();
            let mut solver =
                NearestSolver::new(&scene.bands, &scene.surroundings, free.clone(), StateRange::default());
            let signal = scene.counts(&scene.emissivity, &scene.state);
            let pair = (&scene.emissivity[..], &scene.alternative[..]);
            let (found, least) = found_and_least(&mut solver, pair, &scene.state, &signal, &free);
            tried += 1;
            missed += usize::from(found > least * 1.001 + 1e-12);
        }
        println!("{more:?}: {missed} of {tried} miss by more than a thousandth");
        assert!(missed <= most, "{missed} of {tried} miss with {more:?} unknown too");
    }
}
