//! How long simulated spectra, their judgement and the training of classifiers take.
//!
//! `cargo bench --bench witnesses`. Skin at 37 °C against the nearest robot, 536 bands, 1.276e6 photons (d = 1). NumPy's
//! draws (case `draws` of `numpy_peer.py`) are of the same means.

use criterion::{Criterion, criterion_group, criterion_main};
use hadar::identifiability::ratio::{RatioLaw, State};
use hadar::material::Library;
use hadar::scenario::Scenario;
use hadar::simulate::classifier::{Confusion, LikelihoodRatio, Method};
use hadar::simulate::draws::Draws;
use hadar::simulate::ratio::RatioDraws;
use hadar::simulate::spectra::Split;
use hadar::statistics::Statistics;
use hadar::study::Study;
use std::hint::black_box;
use std::path::Path;

/// Spectra of each of two classes that are drawn and judged at once, and values of the ratio.
const SPECTRA: usize = 5000;
const VALUES: usize = 750_000;

/// Mean counts of the person and of the nearest robot in every band.
fn means() -> hadar::Result<[Vec<f64>; 2]> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/human_vs_robot.toml");
    let study = Study::new(&Scenario::from_file(&path)?, &Library::embedded()?)?;
    let (robot, pair) = (&study.alternatives()[0], &study.identify()?.pairs[0]);
    let state = study.surroundings().state(pair.nearest_state.temperature_k, &pair.nearest_state.lighting)?;
    let photons = pair.distance_nearest.powi(-2) / study.photon_radiance();
    let counts = |emissivity: &[f64], state| -> Vec<f64> {
        let signal = study.bands().weigh(&study.surroundings().signal(emissivity, state));
        signal.iter().map(|s| s * photons).collect()
    };
    Ok([counts(&study.target().emissivity, study.state()), counts(&robot.emissivity, &state)])
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
