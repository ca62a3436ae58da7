//! How long simulated spectra, their judgement and the training of classifiers take.
//!
//! `cargo bench --bench witnesses`. Skin at 37 °C against the nearest robot, 536 bands, 1.276e6 photons (d = 1). NumPy's
//! draws (case `judged` of `numpy_peer.py`) are of the same means.

use criterion::{Criterion, criterion_group, criterion_main};
use hadar::fisher::{Nuisance, Unknowns};
use hadar::identifiability::nearest::{NearestSolver, StateRange};
use hadar::identifiability::ratio::{RatioLaw, State};
use hadar::material::Library;
use hadar::scene::{EnvironmentObject, Surroundings};
use hadar::spectrum::Bands;
use hadar::statistics::Statistics;
use hadar_simulate::classifier::{Confusion, LikelihoodRatio, Method};
use hadar_simulate::draws::Draws;
use hadar_simulate::ratio::RatioDraws;
use hadar_simulate::spectra::Split;
use std::hint::black_box;

/// Spectra of each of two classes that are drawn and judged at once, and values of the ratio.
const SPECTRA: usize = 5000;
const VALUES: usize = 750_000;

/// Mean counts of the person and of the nearest robot in every band.
fn means() -> hadar::Result<[Vec<f64>; 2]> {
    let bands = Bands::uniform(715.0, 1250.0, 1.0)?;
    let object = EnvironmentObject { temperature_k: 293.15, emissivity: None };
    let surroundings = Surroundings::new(bands.nodes_cm1(), vec![object])?;
    let state = surroundings.state(310.15, &[0.5])?;
    let library = Library::embedded()?;
    let of = |name: &str| library.get(name)?.emissivity(bands.nodes_cm1());
    let (person, robot) = (of("skin")?, of("aluminium")?);
    let unknowns = Unknowns::new([Nuisance::Temperature, Nuisance::Lighting])?;
    let mut solver = NearestSolver::new(&bands, &surroundings, unknowns, StateRange::default());
    let nearest = solver.per_photon(&person, &robot, &state, f64::INFINITY)?;
    let radiances = [(&person, &state), (&robot, &nearest.state)]
        .map(|(e, state)| bands.weigh(&surroundings.signal(e, state)));
    let photons = nearest.distance.powi(-2) / radiances[0].iter().sum::<f64>();
    Ok(radiances.map(|radiance| radiance.iter().map(|s| s * photons).collect()))
}

fn witnesses(criterion: &mut Criterion) {
    let means = means().expect("the scenario of the example");
    let law = Statistics::Poisson;
    let draws = means.each_ref().map(|means| Draws::new(&law, means).expect("means to draw about"));
    let rule = LikelihoodRatio::new(&law, &means).expect("two classes");
    let judged = || Confusion::of_draws(&[&rule], &draws, 0..SPECTRA as u64, 1).expect("classes that fit");
    println!("likelihood ratio, {SPECTRA} spectra of each class: {:.4} right", judged()[0].accuracy());
    criterion.bench_function("10 000 spectra of 536 bands drawn and judged", |bencher| {
        bencher.iter(|| black_box(judged()));
    });

    let values = || {
        let state = RatioDraws::new(&means[0], &means[1], &law, State::First).expect("two states");
        let values = state.values(1, 0, VALUES);
        values.iter().filter(|ratio| **ratio < 0.0).count() as f64 / VALUES as f64
    };
    println!("likelihood ratio, {VALUES} values without spectra: {:.4} right", values());
    criterion.bench_function("750 000 likelihood ratios without spectra, set-up included", |bencher| {
        bencher.iter(|| black_box(values()));
    });

    let exact = || RatioLaw::new(&means[0], &means[1], &law).expect("two states").accuracy();
    println!("accuracy of the likelihood ratio, no draw: {:.10}", exact());
    criterion.bench_function("accuracy of the likelihood ratio, no draw", |bencher| {
        bencher.iter(|| black_box(exact()));
    });

    let split = Split::draw(&draws, SPECTRA, 1).expect("parts of the spectra");
    let mut group = criterion.benchmark_group("training with 2500 spectra of 536 bands");
    group.sample_size(10);
    for method in [Method::Discriminant, Method::Logistic, Method::Network] {
        let train = || method.train(&split.training, &split.validation, 1).expect("spectra of two classes");
        group.bench_function(method.name(), |bencher| bencher.iter(|| black_box(train())));
    }
    group.finish();
}

criterion_group!(benches, witnesses);
criterion_main!(benches);
