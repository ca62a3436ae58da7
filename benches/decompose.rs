//! How long it takes to take heat cubes apart, and to render one.
//!
//! `cargo bench --bench decompose`: 4000 spectra of 54 bands and 27 materials of the library, temperature and one lighting factor unknown,
//! 1e7 photons in all bands; with errors of the library, a few of them; the street in 54 bands, 240 × 320 pixels; and a map of
//! 1080 × 1920 materials as categories, a tenth of its pixels wrong. The case `tex` of
//! another program is a grid of 1 K with matrix products, 14 µs a spectrum on one thread at 0.80 right.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use hadar::cube::{Cube, MemoryCube, Shape};
use hadar::material::Library;
use hadar::planck::photon_radiance_into;
use hadar::spectrum::Bands;
use hadar::statistics::Statistics;
use hadar_estimate::decompose::{LibraryError, Light, Options, Setting, decompose};
use hadar_estimate::segmentation::{Categories, Part, Rule, objects, segment, smoothed};
use hadar_simulate::draws::{Draws, generator};
use hadar_simulate::render::{self, Rig, Scene, StreetSpec};

const PHOTONS: f64 = 1e7;

struct Case {
    bands: Bands,
    library: Vec<Vec<f64>>,
    lights: Vec<Light>,
    counts_per_radiance: Vec<f64>,
    var_added: Vec<f64>,
}

impl Case {
    fn new() -> Self {
        let bands = Bands::uniform(720.0, 1250.0, 10.0).expect("bands");
        let nodes = bands.nodes_cm1().to_vec();
        let embedded = Library::embedded().expect("the library");
        let library: Vec<Vec<f64>> = embedded
            .names()
            .filter_map(|name| embedded.get(name).ok()?.emissivity(&nodes).ok())
            .take(27)
            .collect();
        let blackbody = |kelvin: f64| {
            let mut radiance = vec![0.0; nodes.len()];
            photon_radiance_into(&nodes, kelvin, &mut radiance);
            radiance
        };
        let lights = [230.0, 290.0].map(|kelvin| Light::Radiance(blackbody(kelvin))).to_vec();
        let scale = PHOTONS / bands.weigh(&blackbody(290.0)).iter().sum::<f64>();
        let counts_per_radiance = vec![scale; bands.len()];
        let var_added = vec![0.0; bands.len()];
        Self { bands, library, lights, counts_per_radiance, var_added }
    }

    fn setting(&self) -> Setting<'_> {
        Setting {
            bands: &self.bands,
            library: &self.library,
            surroundings: &self.lights,
            counts_per_radiance: &self.counts_per_radiance,
            var_added: &self.var_added,
            units_per_count: 1.0,
            temperature_k: [250.0, 340.0],
            lighting_total: Some(1.0),
            gain: false,
            bad_bands: &[],
            path: None,
            light_besides: &[],
        }
    }

    fn cube(&self, rows: usize, columns: usize) -> Cube {
        let (nodes, mut rng) = (self.bands.nodes_cm1(), generator(1, 0));
        let mut samples = Vec::new();
        for i in 0..rows * columns {
            let share = |step: f64| (i as f64 * step).fract();
            let mut own = vec![0.0; nodes.len()];
            photon_radiance_into(nodes, 270.0 + 40.0 * share(0.618_034), &mut own);
            let v = share(0.414_214);
            let lit = |w: usize| match (&self.lights[0], &self.lights[1]) {
                (Light::Radiance(sky), Light::Radiance(ground)) => v * sky[w] + (1.0 - v) * ground[w],
                _ => 0.0,
            };
            let e = &self.library[i % self.library.len()];
            let signal: Vec<f64> = (0..nodes.len()).map(|w| e[w] * own[w] + (1.0 - e[w]) * lit(w)).collect();
            let mut counts: Vec<f64> =
                self.bands.weigh(&signal).iter().zip(&self.counts_per_radiance).map(|(s, k)| s * k).collect();
            let draws = Draws::new(&Statistics::Poisson, &counts).expect("counts");
            draws.draw_into(&mut rng, &mut counts);
            samples.extend(counts.iter().map(|n| *n as f32));
        }
        let shape = Shape::new(rows, columns, self.bands.len()).expect("a shape");
        Cube::from(MemoryCube::new(shape, samples).expect("as many samples as the shape has"))
    }
}

fn taken_apart(criterion: &mut Criterion) {
    let case = Case::new();
    let mut group = criterion.benchmark_group("decompose");
    group.sample_size(10);
    let mut measure = |name: &str, rows: usize, library_error: Option<LibraryError>| {
        let (cube, options) = (case.cube(rows, 100), Options { library_error, ..Options::default() });
        group.throughput(Throughput::Elements(100 * rows as u64));
        group.bench_function(name, |bencher| {
            bencher.iter(|| decompose(&case.setting(), &options, &cube, &|_| ()).expect("maps"));
        });
    };
    measure("exact library", 40, None);
    measure("library off by 1 %", 2, Some(LibraryError { relative: 0.01, correlation_cm1: 50.0 }));
    group.finish();
}

fn rendered(criterion: &mut Criterion) {
    let bands = Bands::uniform(720.0, 1250.0, 10.0).expect("bands");
    let street = Scene::street(&StreetSpec::default()).expect("a street");
    let rig = Rig { rows: 240, columns: 320, pixel_m: 24e-6, ..Rig::default() };
    let mut group = criterion.benchmark_group("render");
    group.sample_size(10).throughput(Throughput::Elements((rig.rows * rig.columns) as u64));
    group.bench_function("street", |bencher| {
        bencher.iter(|| street.view(&rig, &bands, &render::Options::default(), &|_, _| ()).expect("a view"));
    });
    group.finish();
}

/// Categories and objects of a map of 24 materials: 12 categories, half of the materials in two of them, blocks with noise.
fn segmented(criterion: &mut Criterion) {
    let (rows, columns) = (1080_usize, 1920_usize);
    let parts = |category: usize| {
        let own = [Part::open(2 * category), Part::open(2 * category + 1)];
        own.into_iter().chain([Part::enclosed((2 * category + 3) % 24)]).collect::<Vec<_>>()
    };
    let categories = Categories::new(24, &(0..12).map(parts).collect::<Vec<_>>()).expect("categories");
    let material = |i: usize| {
        let (row, column) = (i / columns, i % columns);
        let is_noise = (i as f64 * 0.618_034).fract() < 0.1;
        let block = if is_noise {
            (i as f64 * 0.414_214).fract() * 24.0
        } else {
            (row / 37 * 7 + column / 53) as f64 % 24.0
        };
        block as u16
    };
    let map: Vec<u16> = (0..rows * columns).map(material).collect();
    let mut group = criterion.benchmark_group("segmentation");
    group.sample_size(10).throughput(Throughput::Elements((rows * columns) as u64));
    for (name, rule) in [("regions", Rule::Regions), ("raster", Rule::Raster)] {
        group.bench_function(name, |bencher| {
            bencher.iter(|| {
                let found = segment(&map, columns, &categories, rule).expect("categories");
                objects(&smoothed(&found, columns).expect("a map"), columns, 25).expect("objects")
            });
        });
    }
    group.finish();
}

criterion_group!(benches, taken_apart, rendered, segmented);
criterion_main!(benches);
