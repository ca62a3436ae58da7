//! How long the parts of the main job take: solving for every quantity, trade-off curves, what a verdict hangs on.
//!
//! `cargo bench --bench policy`. Skin against aluminium over 536 bands from 30 m, seen by the bolometer of the paper.

use criterion::{Criterion, criterion_group, criterion_main};
use hadar::material::Library;
use hadar_scenario::Scenario;
use hadar_study::Study;

fn policy(criterion: &mut Criterion) {
    let library = Library::embedded().expect("the library");
    let scenario = Scenario::from_toml(include_str!("../../../examples/human_vs_robot.toml"), None)
        .expect("the example");
    let study = Study::new(&scenario, &library).expect("a study");
    let result = study.size().expect("an answer");
    criterion.bench_function("verdict, solutions, elasticities, 64 pairs with errors", |bencher| {
        bencher.iter(|| study.size());
    });
    criterion.bench_function("trade-off curves, four of 41 points", |bencher| {
        bencher.iter(|| study.trade_offs(&result));
    });
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(20);
    targets = policy
}
criterion_main!(benches);
