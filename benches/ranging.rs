//! How long the information of all windows of a heat cube takes, and whether it reaches a requirement.
//!
//! `cargo bench --bench ranging`: 540 × 960 × 54 samples in memory, and 1080 × 1920 × 54 read from a file by rows, beside a copy
//! of as many samples in memory. The case `windows` of `numpy_peer.py` is the full cell with windows of 5 × 5: the sums of both
//! are printed.

mod made_up;

use criterion::{Criterion, criterion_group, criterion_main};
use hadar::cube::{Cube, MemoryCube, Shape};
use hadar::ranging::derivative::Derivative;
use hadar::ranging::information::decide::decide;
use hadar::ranging::information::{Cell, Request, Window, information, information_by_rows};
use hadar::ranging::noise::{Joined, NoiseVariance};
use hadar_formats::cube::write_npy;
use made_up::counts;
use std::hint::black_box;
use std::ops::Range;

fn request<'a>(window: usize, noise: &'a NoiseVariance, cells: &'a [Cell]) -> Request<'a> {
    Request {
        window: Window::new(window, window).expect("odd"),
        derivative: Derivative::Central,
        noise,
        joined: Joined::SumOfReadings,
        cells,
        centres: 0..usize::MAX,
    }
}

fn in_memory(criterion: &mut Criterion) {
    let shape = Shape::new(540, 960, 54).expect("a shape");
    let noise = NoiseVariance::None;
    let textured = counts(shape.len(), shape.bands());
    // Level, but for a patch.
    let level_but = |rows: Range<usize>, columns: Range<usize>| {
        let mut level = vec![1e4_f32; shape.len()];
        for row in rows {
            let start = row * shape.row_len();
            let patch = start + columns.start * shape.bands()..start + columns.end * shape.bands();
            level[patch.clone()].copy_from_slice(&textured[patch]);
        }
        level
    };
    let (patch, half) = (level_but(100..160, 200..300), level_but(0..540, 0..480));
    let cube =
        |samples| Cube::from(MemoryCube::new(shape, samples).expect("as many samples as the shape has"));
    let (textured, patch, half) = (cube(textured), cube(patch), cube(half));
    let mut group = criterion.benchmark_group("540 x 960 x 54");
    group.sample_size(20);
    for window in [5, 31] {
        group.bench_function(format!("all cells, windows of {window} x {window}"), |bencher| {
            bencher.iter(|| information(black_box(&textured), &request(window, &noise, &Cell::ALL)));
        });
    }
    for cell in Cell::ALL {
        group.bench_function(format!("{cell:?} alone, windows of 5 x 5"), |bencher| {
            bencher.iter(|| information(black_box(&textured), &request(5, &noise, &[cell])));
        });
    }
    for (name, cube) in [("textured", &textured), ("level but for a patch", &patch), ("half textured", &half)]
    {
        let map = information(cube, &request(5, &noise, &[Cell::Full])).expect("sound counts");
        println!("sum of the windows, {name}: {:.11e}", map.cell(Cell::Full).iter().sum::<f64>());
        let required = 0.05 * map.cell(Cell::Full).iter().fold(0.0, |most: f64, j| most.max(*j));
        let decision = decide(cube, &request(5, &noise, &[]), required).expect("sound counts");
        println!("{name}: {:?}", decision.stats);
        group.bench_function(format!("decide, {name}"), |bencher| {
            bencher.iter(|| decide(black_box(cube), &request(5, &noise, &[]), required));
        });
    }
    group.finish();
}

fn from_a_file(criterion: &mut Criterion) {
    let shape = Shape::new(1080, 1920, 54).expect("a shape");
    let noise = NoiseVariance::None;
    let samples = counts(shape.len(), shape.bands());
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("cube.npy");
    write_npy(&path, shape, &samples).expect("room for the file");
    let mut group = criterion.benchmark_group("1080 x 1920 x 54");
    group.sample_size(10);
    let mut copy = samples.clone();
    group.bench_function("copied in memory by one thread", |bencher| {
        bencher.iter(|| copy.copy_from_slice(black_box(&samples)));
    });
    drop((samples, copy));
    let cube = hadar_formats::cube::open(&path, None).expect("the file just written");
    group.bench_function("all cells, from a file", |bencher| {
        bencher.iter(|| information(black_box(&cube), &request(5, &noise, &Cell::ALL)));
    });
    group.bench_function("all cells, from a file, by rows", |bencher| {
        let request = request(5, &noise, &Cell::ALL);
        bencher.iter(|| {
            information_by_rows(black_box(&cube), &request, &|map| {
                black_box(map);
                Ok(())
            })
        });
    });
    group.finish();
}

criterion_group!(benches, in_memory, from_a_file);
criterion_main!(benches);
