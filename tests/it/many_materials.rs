//! Many materials at once: the same distances as pair by pair, the same decisions with and without shortcuts.

use crate::support::scenes::{Curve, Scene, curve, ever_more_unknowns, radiance, recipe};
use hadar::demand::{Reason, Skipping, Thing, ledger_of};
use hadar::fisher::{Counting, Nuisance, Unknowns};
use hadar::identifiability::local::LocalSolver;
use hadar::identifiability::multi::{LibraryScene, LocalMatrix};
use hadar::identifiability::nearest::{NearestSolver, StateRange};
use hadar::scene::{EnvironmentObject, State, Surroundings};
use hadar::spectrum::Bands;
use hadar_testing::seeded;
use proptest::prelude::*;

/// Pair by pair, as if there were no matrix.
fn one_by_one(
    scene: &Scene,
    materials: &[&[f64]],
    unknowns: &Unknowns,
    counting: Option<&Counting>,
) -> Vec<(f64, f64)> {
    let mut solver = LocalSolver::new(&scene.bands, &scene.surroundings, unknowns.clone());
    let mut found = Vec::new();
    for own in materials {
        for other in materials {
            let local = match counting {
                Some(counting) => solver.with_counting(own, other, &scene.state, counting),
                None => solver.per_photon(own, other, &scene.state, f64::INFINITY),
            };
            let local = local.unwrap();
            found.push((local.distance, local.distance_no_nuisance));
        }
    }
    found
}

fn check_matrix(
    scene: &Scene,
    materials: &[&[f64]],
    unknowns: &Unknowns,
    counting: Option<&Counting>,
) -> Result<(), TestCaseError> {
    let mut matrix = LocalMatrix::new(&scene.bands, &scene.surroundings, unknowns.clone());
    let found = match counting {
        Some(counting) => matrix.with_counting(materials, &scene.state, counting),
        None => matrix.per_photon(materials, &scene.state),
    }
    .unwrap();
    for ((found, (distance, none)), i) in
        found.iter().zip(one_by_one(scene, materials, unknowns, counting)).zip(0..)
    {
        // Each of the two is good to 1e-14 × (distance with nothing unknown), relative to that distance.
        prop_assert!(
            (found - distance).abs() <= 2e-14 * none,
            "pair {i}: {found:e} and {distance:e} of {none:e}"
        );
    }
    Ok(())
}

proptest! {
    #![proptest_config(seeded(20, 100))]

    /// Any bands, surroundings and unknowns, per √photon and with a camera's noise.
    #[test]
    fn a_matrix_holds_the_distances_of_its_pairs(
        recipe in recipe(),
        curves in proptest::collection::vec(curve(), 1..8),
        photons in 1e3..1e12_f64,
        gamma in 0.0..1e3_f64,
    ) {
        let scene = recipe.scene();
        let others: Vec<Vec<f64>> = curves.iter().map(|curve| curve.on(scene.bands.nodes_cm1())).collect();
        let mut materials: Vec<&[f64]> = vec![&scene.emissivity, &scene.alternative];
        materials.extend(others.iter().map(Vec::as_slice));
        let signal = scene.counts(&scene.emissivity, &scene.state);
        let mut counting = Counting::shot(photons, &signal);
        counting.var_added =
            signal.iter().map(|s| gamma * s * counting.counts_per_radiance).collect();
        for unknowns in ever_more_unknowns(recipe.count, recipe.objects.len()) {
            check_matrix(&scene, &materials, &unknowns, None)?;
            check_matrix(&scene, &materials, &unknowns, Some(&counting))?;
        }
    }
}

proptest! {
    #![proptest_config(seeded(20, 40))]

    /// Decisions by bounds, by few bands and by the first state found are those of full distances. Levels are drawn
    /// among the distances themselves, where decisions are closest. Rounding apart: no level within 1e-9 of one.
    #[test]
    fn shortcuts_never_change_a_decision(
        recipe in recipe(),
        curves in proptest::collection::vec(curve(), 2..6),
        log_photons in 2.0..8.0,
        share in 0.0..1.0,
        gamma in prop_oneof![Just(0.0), 0.1..1e3_f64],
    ) {
        let scene = recipe.scene();
        let others: Vec<Vec<f64>> = curves.iter().map(|curve| curve.on(scene.bands.nodes_cm1())).collect();
        let mut materials: Vec<&[f64]> = vec![&scene.emissivity, &scene.alternative];
        materials.extend(others.iter().map(Vec::as_slice));
        let unknowns = Unknowns::new([Nuisance::Temperature, Nuisance::Lighting]).unwrap();
        prop_assume!(recipe.count > unknowns.parameters(recipe.objects.len()).len());
        let library = LibraryScene {
            bands: &scene.bands,
            surroundings: &scene.surroundings,
            unknowns: &unknowns,
            range: StateRange::default(),
            state: &scene.state, tolerance: None
        };
        let signal = scene.counts(&scene.emissivity, &scene.state);
        let mut counting = Counting::shot(10f64.powf(log_photons), &signal);
        counting.var_added =
            signal.iter().map(|s| gamma * s * counting.counts_per_radiance).collect();
        let found = library.nearest_with_counting(&materials, &counting, &|_, _| ()).unwrap();
        let mut distances: Vec<f64> = {
            let off_diagonal = found.distance.iter().enumerate().filter(|(i, _)| i % (materials.len() + 1) != 0);
            off_diagonal.map(|(_, d)| *d).collect()
        };
        distances.sort_by(f64::total_cmp);
        let at = (share * (distances.len() - 1) as f64) as usize;
        let required = (0.5 * (distances[at] + distances[(at + 1).min(distances.len() - 1)])).max(1e-6);
        prop_assume!(distances.iter().all(|d| (d / required - 1.0).abs() > 1e-9));
        let told = |skipping| ledger_of(|| library.told_apart(&materials, &counting, required, skipping, &|_, _| ())).unwrap();
        let ((skipped, work), (full, work_in_full)) = (told(Skipping::On), told(Skipping::Off));
        let count = materials.len();
        for a in 0..count {
            for b in 0..count {
                prop_assert_eq!(skipped.told_apart(a, b), full.told_apart(a, b), "{} {}", a, b);
            }
            for skipping in [Skipping::On, Skipping::Off] {
                let ask = || library.first_not_told_from(a, &materials, &counting, required, skipping);
                let (failed, work) = ledger_of(ask).unwrap();
                let row = (0..count).filter(|&b| b != a);
                let row = row.map(|b| found.distance[a * count + b]);
                prop_assert_eq!(failed.is_some(), row.clone().any(|d| d < required));
                if let Some(failed) = failed {
                    prop_assert!(found.distance[a * count + failed] < required);
                }
                prop_assert_eq!(work.possible(Thing::NearestSearches), count as u64 - 1);
                prop_assert_eq!(work.computed(Thing::OwnStateDistances), count as u64 - 1);
            }
        }
        // Every distance is accounted for once.
        let distances = (count * (count - 1)) as u64;
        for work in [&work, &work_in_full] {
            prop_assert_eq!(work.possible(Thing::NearestSearches), distances);
        }
        prop_assert_eq!(work_in_full.computed(Thing::NearestSearches), distances);
        // What the distances in the own state decide, by the distances themselves: each is asked for unless the other
        // direction was nearer than required, and so is each after it.
        let mut solver = NearestSolver::new(&scene.bands, &scene.surroundings, unknowns.clone(), library.range);
        let (mut asked, mut decided) = (0, 0);
        for a in 0..count {
            for b in a + 1..count {
                for (own, other) in [(a, b), (b, a)] {
                    asked += 1;
                    let at_own = solver
                        .own_state_distance(materials[own], materials[other], library.state, &counting)
                        .unwrap();
                    decided += u64::from(at_own < required);
                    if found.distance[own * count + other] < required {
                        break;
                    }
                }
            }
        }
        // Some are not tried where the local distance leaves no hope that they decide, or a bound shared by all pairs of a target proves it.
        let hopeless = work.spared(Thing::OwnStateDistances, Reason::Hopeless);
        let shared = work.spared(Thing::OwnStateDistances, Reason::ProvedAbove);
        prop_assert_eq!(work.computed(Thing::OwnStateDistances) + hopeless + shared, asked);
        let by_own_state = work.spared(Thing::NearestSearches, Reason::OwnState);
        prop_assert!(by_own_state <= decided && by_own_state + hopeless >= decided);
        prop_assert_eq!(work.spared(Thing::NearestSearches, Reason::AnotherOne), distances - asked);
    }
}

/// The scene of the tests below: the paper's, with smooth random materials.
fn library(count: usize, step_cm1: f64) -> (Bands, Surroundings, Vec<Vec<f64>>) {
    let bands = Bands::uniform(715.0, 1250.0, step_cm1).unwrap();
    let object = EnvironmentObject { temperature_k: 293.15, emissivity: None };
    let surroundings = Surroundings::new(bands.nodes_cm1(), vec![object]).unwrap();
    let wave = |i: usize, j: usize, t: f64| {
        (1.7 * (i * 5 + j + 1) as f64).sin() * ((j + 1) as f64 * std::f64::consts::PI * (t + 1.0)).cos()
    };
    let materials = (0..count)
        .map(|i| {
            let at = |nu: &f64| {
                let t = (nu - 985.0) / 265.0;
                (0.8 + 0.1 * (0..5).map(|j| wave(i, j, t)).sum::<f64>()).clamp(0.05, 0.99)
            };
            bands.nodes_cm1().iter().map(at).collect()
        })
        .collect();
    (bands, surroundings, materials)
}

/// Large enough to be spread over threads.
#[test]
fn the_number_of_threads_changes_no_bit() {
    let (bands, surroundings, materials) = library(70, 1.0);
    let materials: Vec<&[f64]> = materials.iter().map(Vec::as_slice).collect();
    let state = surroundings.state(333.15, &[0.5]).unwrap();
    let unknowns = Unknowns::new([Nuisance::Temperature, Nuisance::Lighting]).unwrap();
    let results = [1, 3].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let local = LocalMatrix::new(&bands, &surroundings, unknowns.clone())
                .per_photon(&materials, &state)
                .unwrap();
            let scene = LibraryScene {
                bands: &bands,
                surroundings: &surroundings,
                unknowns: &unknowns,
                range: StateRange::default(),
                state: &state,
                tolerance: None,
            };
            let nearest = scene.nearest_per_photon(&materials[..12], &|_, _| ()).unwrap();
            (local, nearest)
        })
    });
    assert_eq!(results[0], results[1]);
}

/// A surface that differs from another one by less and less: beyond what one pass can resolve, and what two can.
#[test]
fn nearly_blind_pairs_are_judged_on_their_own() {
    let (bands, surroundings, materials) = library(1, 1.0);
    let state = surroundings.state(333.15, &[0.5]).unwrap();
    let unknowns = Unknowns::new([Nuisance::Temperature, Nuisance::Lighting]).unwrap();
    let own = &materials[0];
    // What temperature and lighting imitate: e′ = e + αe∂B/∂T/C + β(1 − e)B₀/C, and a little of something else.
    let around = |nu: f64| radiance(nu, 293.15);
    let imitated = |nu: f64, e: f64, other: f64| {
        let body: f64 = radiance(nu, state.temperature_k);
        let slope = (radiance(nu, state.temperature_k + 1e-3) - body) / 1e-3;
        let contrast = body - 0.5 * around(nu);
        e + 0.5 * e * slope / contrast + 0.01 * (1.0 - e) * around(nu) / contrast + other * (nu / 30.0).sin()
    };
    let mut pair = LocalSolver::new(&bands, &surroundings, unknowns.clone());
    let mut matrix = LocalMatrix::new(&bands, &surroundings, unknowns);
    for other in [1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-10] {
        let near: Vec<f64> =
            bands.nodes_cm1().iter().zip(own).map(|(nu, e)| imitated(*nu, *e, other)).collect();
        let found = matrix.per_photon(&[own, &near], &state).unwrap();
        let local = pair.per_photon(own, &near, &state, f64::INFINITY).unwrap();
        let none = local.distance_no_nuisance;
        println!("{other:e}: none/d = {:.1e}, {:?}", none / local.distance, matrix.passes());
        assert!((found[1] - local.distance).abs() <= 2e-14 * none, "{other:e}: {found:?} {local:?}");
    }
}

/// Distance between two spectra of counts, from its definition.
fn half_separation(target: &[f64], other: &[f64]) -> f64 {
    let total: f64 = target.iter().sum();
    let square: f64 = target.iter().zip(other).map(|(a, b)| (a.sqrt() - b.sqrt()).powi(2)).sum();
    (square / total).sqrt()
}

/// 50 random pairs against 700 × 201 states written down without the crate: none is nearer. A minimum lies below
/// every point of any grid, so only the rounding of two square roots (1e-13) is allowed for.
#[test]
fn no_state_of_a_dense_grid_is_nearer_than_the_nearest() {
    use proptest::strategy::ValueTree;
    use proptest::test_runner::{RngAlgorithm, TestRng, TestRunner};
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &[31; 32]);
    let mut runner = TestRunner::new_with_rng(seeded(20, 1), rng);
    let bands = Bands::uniform(720.0, 1250.0, 10.0).unwrap();
    let nodes = bands.nodes_cm1();
    let unknowns = Unknowns::new([Nuisance::Temperature, Nuisance::Lighting]).unwrap();
    let grid_k: Vec<f64> = (0..700).map(|i| 60.0 * 1.005_f64.powi(i)).collect();
    let bodies: Vec<Vec<f64>> =
        grid_k.iter().map(|&t| nodes.iter().map(|&nu| radiance(nu, t)).collect()).collect();
    let draw = (curve(), curve(), 255.0..380.0_f64, 255.0..340.0_f64, 0.0..1.0_f64);
    let mut closest = f64::INFINITY;
    for case in 0..50 {
        let drawn: (Curve, Curve, f64, f64, f64) = draw.new_tree(&mut runner).unwrap().current();
        let (own, other, temperature_k, around_k, lighting) = drawn;
        let (own, other) = (own.on(nodes), other.on(nodes));
        let around: Vec<f64> = nodes.iter().map(|&nu| radiance(nu, around_k)).collect();
        let target: Vec<f64> = (0..nodes.len())
            .map(|j| own[j] * radiance(nodes[j], temperature_k) + (1.0 - own[j]) * lighting * around[j])
            .collect();
        let object = EnvironmentObject { temperature_k: around_k, emissivity: None };
        let surroundings = Surroundings::new(nodes, vec![object]).unwrap();
        let state: State = surroundings.state(temperature_k, &[lighting]).unwrap();
        let mut solver = NearestSolver::new(&bands, &surroundings, unknowns.clone(), StateRange::default());
        let found = solver.per_photon(&own, &other, &state, f64::INFINITY).unwrap();
        let mut least = f64::INFINITY;
        let mut signal = vec![0.0; nodes.len()];
        for body in &bodies {
            for step in 0..=200 {
                let v = f64::from(step) / 200.0;
                for j in 0..nodes.len() {
                    signal[j] = other[j] * body[j] + (1.0 - other[j]) * v * around[j];
                }
                least = least.min(half_separation(&target, &signal));
            }
        }
        closest = closest.min(least / found.distance - 1.0);
        assert!(found.distance <= least * (1.0 + 1e-13), "case {case}: {} found, {least}", found.distance);
    }
    println!("the nearest point of a grid is {closest:.1e} farther than the nearest state");
}
