//! How long the worst case over an envelope of scenes takes, with its proof.
//!
//! `cargo bench --bench envelope`. Target at 30 to 40 °C, lighting 0.1 to 0.9, surroundings at −10 to 30 °C, 536 bands;
//! temperature and lighting of the alternative unknown. Five dimensions: the same for three targets against three
//! alternatives, at the farthest distance, beyond which nothing is worse. Distances, bounds and boxes are printed first.

use criterion::{Criterion, criterion_group, criterion_main};
use hadar::fisher::{Nuisance, Unknowns};
use hadar::identifiability::nearest::StateRange;
use hadar::instrument::{View, presets};
use hadar::material::Library;
use hadar::policy::envelope::{Effort, EnvelopeScene, Ranges, worst_case};
use hadar::scene::{EnvironmentObject, Surroundings};
use hadar::spectrum::Bands;
use std::hint::black_box;

fn envelopes(criterion: &mut Criterion) {
    let bands = Bands::uniform(715.0, 1250.0, 1.0).expect("valid bands");
    let object = EnvironmentObject { temperature_k: 293.15, emissivity: None };
    let surroundings = Surroundings::new(bands.nodes_cm1(), vec![object]).expect("valid surroundings");
    let library = Library::embedded().expect("valid library");
    let of = |name: &str| {
        let material = library.get(name).expect("a known material");
        material.emissivity(bands.nodes_cm1()).expect("known in these bands")
    };
    let targets = ["skin", "concrete", "vegetation-leaf"].map(of);
    let alternatives = ["aluminium", "fused-silica", "brass"].map(of);
    let unknowns = Unknowns::new([Nuisance::Temperature, Nuisance::Lighting]).expect("distinct");
    let ranges =
        Ranges::new([303.15, 313.15], vec![[0.1, 0.9]], vec![[263.15, 303.15]]).expect("a valid envelope");

    let mut group = criterion.benchmark_group("envelope");
    group.sample_size(10);
    for camera in ["flir-a325sc", "ideal-pnrd"] {
        let counting = presets::get(camera).expect("a known camera").counting(&bands, &View::at(Some(30.0)));
        let worst = |target: usize, alternative: usize| {
            let scene = EnvelopeScene {
                bands: &bands,
                surroundings: &surroundings,
                emissivity: &targets[target],
                alternative: &alternatives[alternative],
                counting: &counting,
                unknowns: &unknowns,
                range: StateRange::default(),
            };
            worst_case(&scene, black_box(&ranges), &Effort::default()).expect("a valid scene")
        };
        let pairs = || (0..9).map(|pair| worst(pair / 3, pair % 3));
        for worst in pairs() {
            let (bound, boxes) = (worst.lower_bound, worst.boxes);
            println!("{camera}: {:.6} {bound:?} {boxes} boxes, {:?}", worst.distance, worst.certificate);
        }
        group.bench_function(format!("three dimensions, {camera}"), |bencher| bencher.iter(|| worst(0, 0)));
        group.bench_function(format!("five dimensions, {camera}"), |bencher| {
            bencher.iter(|| pairs().map(|worst| worst.distance).fold(f64::INFINITY, f64::min));
        });
    }
    group.finish();
}

criterion_group!(benches, envelopes);
criterion_main!(benches);
