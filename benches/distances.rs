//! How long a distance takes: one pair, nearest states, a library of materials.
//!
//! `cargo bench --bench distances`. The cases are those a NumPy user would vectorise; the first includes
//! everything (Planck, scores, orthogonalisation), with temperature and lighting unknown over 536 bands.
//! The results are printed first, to be compared with those of `numpy_peer.py` beside this file.

use criterion::{Criterion, criterion_group, criterion_main};
use hadar::demand::ledger_of;
use hadar::fisher::{Counting, Nuisance, Unknowns};
use hadar::identifiability::local::LocalSolver;
use hadar::identifiability::multi::{LibraryScene, LocalMatrix, Skipping};
use hadar::identifiability::nearest::{NearestSolver, StateRange};
use hadar::planck::photon_radiance;
use hadar::scene::{EnvironmentObject, Surroundings};
use hadar::spectrum::Bands;
use std::hint::black_box;

fn aluminium(bands: &Bands) -> Vec<f64> {
    let t = |nu: f64| (nu - 985.0) / 265.0;
    bands.nodes_cm1().iter().map(|&nu| 0.49287 - 0.0782 * t(nu) + 0.00892 * t(nu) * t(nu)).collect()
}

fn distances(criterion: &mut Criterion) {
    let bands = Bands::uniform(715.0, 1250.0, 1.0).expect("valid bands");
    let object = EnvironmentObject { temperature_k: 293.15, emissivity: None };
    let surroundings = Surroundings::new(bands.nodes_cm1(), vec![object]).expect("valid surroundings");
    let (skin, robot) = (vec![0.95; bands.len()], aluminium(&bands));
    let unknowns = Unknowns::new([Nuisance::Temperature, Nuisance::Lighting]).expect("distinct");
    let mut state = surroundings.state(310.15, &[0.5]).expect("valid state");

    let mut solver = LocalSolver::new(&bands, &surroundings, unknowns.clone());
    let mut flip = false;
    criterion.bench_function("local distance, one pair, 536 bands", |bencher| {
        bencher.iter(|| {
            // Another temperature every time: nothing may be taken from the call before.
            flip = !flip;
            state.temperature_k = if flip { 310.15 } else { 311.15 };
            solver.per_photon(black_box(&skin), black_box(&robot), &state, f64::INFINITY)
        });
    });
    state.temperature_k = 310.15;

    let mut nearest = NearestSolver::new(&bands, &surroundings, unknowns.clone(), StateRange::default());
    criterion.bench_function("nearest distance, one pair, 536 bands", |bencher| {
        bencher.iter(|| nearest.per_photon(black_box(&skin), black_box(&robot), &state, f64::INFINITY));
    });

    let mut proved = nearest.clone().proving(PROOF);
    criterion.bench_function("nearest distance with its proof, one pair, 536 bands", |bencher| {
        bencher.iter(|| proved.per_photon(black_box(&skin), black_box(&robot), &state, f64::INFINITY));
    });

    let result =
        |name: &str, value: hadar::Result<f64>| println!("{name}: {:.12}", value.expect("a valid scene"));
    let mut once = LocalSolver::new(&bands, &surroundings, unknowns.clone());
    result("local", once.per_photon(&skin, &robot, &state, f64::INFINITY).map(|local| local.distance));
    result(
        "nearest",
        nearest.per_photon(&skin, &robot, &state, f64::INFINITY).map(|nearest| nearest.distance),
    );
}

/// To what share of itself a nearest distance is proved.
const PROOF: f64 = 1e-6;

/// Thirty made-up materials.
fn library(bands: &Bands) -> Vec<Vec<f64>> {
    let emissivity = |material: i32, nu: f64| {
        let place = (nu - 985.0) / 265.0;
        let waves = (1..=5).map(|j| {
            let phase = f64::from(j) * std::f64::consts::PI * (place + 1.0);
            0.1 * (1.7 * f64::from(material * 5 + j)).sin() * phase.cos()
        });
        (0.8 + waves.sum::<f64>()).clamp(0.05, 0.99)
    };
    (0..30).map(|material| bands.nodes_cm1().iter().map(|&nu| emissivity(material, nu)).collect()).collect()
}

fn libraries(criterion: &mut Criterion) {
    let bands = Bands::uniform(715.0, 1250.0, 1.0).expect("valid bands");
    let object = EnvironmentObject { temperature_k: 293.15, emissivity: None };
    let surroundings = Surroundings::new(bands.nodes_cm1(), vec![object]).expect("valid surroundings");
    let unknowns = Unknowns::new([Nuisance::Temperature, Nuisance::Lighting]).expect("distinct");
    let state = surroundings.state(333.15, &[0.5]).expect("valid state");
    let materials = library(&bands);
    let materials: Vec<&[f64]> = materials.iter().map(Vec::as_slice).collect();
    // 1e6 photons from a blackbody in the target's place, 10 electrons of noise in every band.
    let black: f64 = bands.nodes_cm1().iter().map(|&nu| photon_radiance(nu, 333.15)).sum();
    let counting = Counting { counts_per_radiance: 1e6 / black, var_added: vec![100.0; bands.len()] };
    let range = StateRange::default();
    let scene = LibraryScene {
        bands: &bands,
        surroundings: &surroundings,
        unknowns: &unknowns,
        range,
        state: &state,
        tolerance: None,
    };

    let mut local = LocalMatrix::new(&bands, &surroundings, unknowns.clone());
    let sum: f64 = local.per_photon(&materials, &state).expect("a valid scene").iter().sum();
    println!("sum of the local matrix: {sum:.12}");
    let nearest = scene.nearest_per_photon(&materials, &|_, _| ()).expect("a valid scene");
    let sum: f64 = nearest.distance.iter().sum();
    println!("sum of the nearest matrix: {sum:.12}");
    for required in [1.0, 40.0] {
        let told = || scene.told_apart(&materials, &counting, required, Skipping::On, &|_, _| ());
        let (told, work) = ledger_of(told).expect("a valid scene");
        let apart = |a: usize| (a + 1..30).filter(|&b| told.told_apart(a, b)).count();
        println!("told apart at d = {required}: {}, {:?}", (0..30).map(apart).sum::<usize>(), work);
    }

    criterion.bench_function("30 x 30 local matrix, 536 bands", |bencher| {
        let mut warmer = state.clone();
        warmer.temperature_k += 1.0;
        let mut flip = false;
        bencher.iter(|| {
            flip = !flip;
            local.per_photon(black_box(&materials), if flip { &warmer } else { &state })
        });
    });
    let mut group = criterion.benchmark_group("libraries");
    group.sample_size(20);
    group.bench_function("30 x 30 nearest matrix, 536 bands", |bencher| {
        bencher.iter(|| scene.nearest_per_photon(black_box(&materials), &|_, _| ()));
    });
    let proving = LibraryScene { tolerance: Some(PROOF), ..scene };
    group.bench_function("30 x 30 nearest matrix with proofs, 536 bands", |bencher| {
        bencher.iter(|| proving.nearest_per_photon(black_box(&materials), &|_, _| ()));
    });
    for (required, skipping) in
        [(1.0, Skipping::On), (1.0, Skipping::Off), (40.0, Skipping::On), (40.0, Skipping::Off)]
    {
        let name = format!("which of 30 can be told apart at d = {required}, skipping {skipping:?}");
        group.bench_function(name, |bencher| {
            bencher
                .iter(|| scene.told_apart(black_box(&materials), &counting, required, skipping, &|_, _| ()));
        });
    }
    group.finish();
}

criterion_group!(benches, distances, libraries);
criterion_main!(benches);
