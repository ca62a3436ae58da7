//! CPU seconds of matrices of distances of 30, 300 and 1 000 smooth materials in 536 bands, one thread; and, of 20, of nearest distances for each
//! set of unknowns, with the share that is proved.
//!
//!     RAYON_NUM_THREADS=1 cargo bench --bench matrices [-- local|nearest|unknowns|apart [MATERIALS]]

use hadar::fisher::{Counting, Nuisance, Unknowns};
use hadar::identifiability::multi::{LibraryScene, LocalMatrix, Skipping};
use hadar::identifiability::nearest::StateRange;
use hadar::planck::photon_radiance;
use hadar::scene::{EnvironmentObject, Surroundings};
use hadar::spectrum::Bands;
use std::time::Instant;

/// Numbers between 0 and 1 that are spread evenly (Weyl).
fn spread(place: usize, irrational: f64) -> f64 {
    ((place + 1) as f64 * irrational).fract()
}

fn library(bands: &Bands, count: usize) -> Vec<Vec<f64>> {
    let emissivity = |m: usize, nu: f64| {
        let wave = (nu / (20.0 + 100.0 * spread(m, 3f64.sqrt())) + 6.0 * spread(m, 5f64.sqrt())).sin();
        (0.3 + 0.68 * spread(m, 2f64.sqrt()) + 0.1 * wave).clamp(0.02, 0.99)
    };
    (0..count).map(|m| bands.nodes_cm1().iter().map(|&nu| emissivity(m, nu)).collect()).collect()
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|one| !one.starts_with("--")).collect();
    let wanted = |name: &str| arguments.first().is_none_or(|only| only == name);
    let only: Option<usize> = arguments.get(1).and_then(|count| count.parse().ok());
    let sizes = |all: &[usize]| -> Vec<usize> { only.map_or(all.to_vec(), |one| vec![one]) };
    let bands = Bands::uniform(715.0, 1250.0, 1.0).expect("valid bands");
    let object = EnvironmentObject { temperature_k: 293.15, emissivity: None };
    let surroundings = Surroundings::new(bands.nodes_cm1(), vec![object]).expect("valid surroundings");
    let unknowns = Unknowns::new([Nuisance::Temperature, Nuisance::Lighting]).expect("distinct");
    let state = surroundings.state(333.15, &[0.5]).expect("valid state");
    let range = StateRange::default();
    let (bands, surroundings, unknowns, state) = (&bands, &surroundings, &unknowns, &state);
    let scene = LibraryScene { bands, surroundings, unknowns, range, state, tolerance: Some(1e-6) };
    let least = |runs: usize, run: &mut dyn FnMut()| {
        let times = (0..runs).map(|_| {
            let start = Instant::now();
            run();
            start.elapsed().as_secs_f64()
        });
        times.fold(f64::INFINITY, f64::min)
    };
    if wanted("local") {
        for count in sizes(&[30, 300, 1000]) {
            let materials = library(bands, count);
            let materials: Vec<&[f64]> = materials.iter().map(Vec::as_slice).collect();
            let mut local = LocalMatrix::new(bands, surroundings, unknowns.clone());
            let (mut sum, mut worst) = (0.0, 0.0_f64);
            let time = least(if count > 300 { 3 } else { 10 }, &mut || {
                let distances = local.per_photon(&materials, state).expect("a valid scene");
                worst = local.relative_errors(&distances).into_iter().fold(0.0, f64::max);
                sum = distances.iter().sum();
            });
            println!(
                "local {count}: {:.3} ms, sum {sum:.12e}, worst error {worst:.1e}, {:?}",
                1e3 * time,
                local.passes()
            );
        }
    }
    if wanted("nearest") {
        for count in sizes(&[30, 300]) {
            let materials = library(bands, count);
            let materials: Vec<&[f64]> = materials.iter().map(Vec::as_slice).collect();
            let mut sum = 0.0;
            let time = least(1, &mut || {
                sum = scene
                    .nearest_per_photon(&materials, &|_, _| ())
                    .expect("a valid scene")
                    .distance
                    .iter()
                    .sum();
            });
            println!("nearest, proved, {count}: {:.1} ms, sum {sum:.12e}", 1e3 * time);
        }
    }
    if wanted("unknowns") {
        let all =
            [Nuisance::Temperature, Nuisance::Lighting, Nuisance::Gain, Nuisance::EnvironmentTemperature];
        for count in sizes(&[20]) {
            let materials = library(bands, count);
            let materials: Vec<&[f64]> = materials.iter().map(Vec::as_slice).collect();
            for set in 1..16_usize {
                let unknown: Vec<Nuisance> = (0..4).filter(|i| set >> i & 1 == 1).map(|i| all[i]).collect();
                let unknowns = &Unknowns::new(unknown.iter().copied()).expect("distinct");
                let scene = LibraryScene { unknowns, ..scene };
                let (mut proved, mut pairs) = (0, 0);
                let time = least(1, &mut || {
                    let found = scene.nearest_per_photon(&materials, &|_, _| ()).expect("a valid scene");
                    let places = (0..count * count).filter(|place| place / count != place % count);
                    pairs = count * (count - 1);
                    proved = places.filter(|&place| found.is_proved_to(place, 1e-6)).count();
                });
                println!(
                    "nearest, {count}, {unknown:?}: {:.3} ms a pair, {proved} of {pairs} proved to 1e-6",
                    1e3 * time / pairs as f64
                );
            }
        }
    }
    if wanted("apart") {
        let black: f64 = bands.nodes_cm1().iter().map(|&nu| photon_radiance(nu, 333.15)).sum();
        let counting = Counting { counts_per_radiance: 1e6 / black, var_added: vec![100.0; bands.len()] };
        for count in sizes(&[30, 300, 1000]) {
            let materials = library(bands, count);
            let materials: Vec<&[f64]> = materials.iter().map(Vec::as_slice).collect();
            let mut apart = 0;
            let time = least(1, &mut || {
                let told = scene
                    .told_apart(&materials, &counting, 1.0, Skipping::On, &|_, _| ())
                    .expect("a valid scene");
                apart = (0..count).map(|a| (a + 1..count).filter(|&b| told.told_apart(a, b)).count()).sum();
            });
            println!(
                "told apart at d = 1, {count}: {:.1} ms, {apart} of {} pairs",
                1e3 * time,
                count * (count - 1) / 2
            );
        }
    }
}
