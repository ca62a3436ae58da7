//! Heat cubes with known truth, made without this program, decomposed: shares, errors and intervals against what is known of them.

use hadar::cube::{Cube, MemoryCube, Rows, Shape};
use hadar::demand::Skipping;
use hadar::fisher::precision::PrecisionSolver;
use hadar::fisher::{Counting, Nuisance, Unknowns};
use hadar::planck::photon_radiance;
use hadar::scene::{EnvironmentObject, Parameter, Surroundings};
use hadar::spectrum::Bands;
use hadar_estimate::decompose::{LibraryError, Light, Maps, NO_MATERIAL, Options, Setting, decompose, flag};
use hadar_simulate::draws::generator;
use rand_distr::{Distribution, StandardNormal};
use serde_json::Value;
use std::path::PathBuf;

struct Reference {
    folder: PathBuf,
    name: &'static str,
    scale: f64,
    library: Vec<Vec<f64>>,
    light: Vec<Vec<f64>>,
}

/// Columns of a table of numbers below a line of names.
fn columns(path: &std::path::Path) -> (Vec<String>, Vec<Vec<f64>>) {
    let text = std::fs::read_to_string(path).unwrap();
    let mut lines = text.lines().filter(|line| !line.starts_with('#'));
    let names: Vec<String> = lines.next().unwrap().split(',').map(str::to_owned).collect();
    let mut columns = vec![Vec::new(); names.len()];
    for line in lines {
        line.split(',').zip(&mut columns).for_each(|(cell, column)| column.push(cell.parse().unwrap()));
    }
    (names, columns)
}

impl Reference {
    fn open(name: &'static str) -> Option<Self> {
        let folder = hadar_testing::shared("reference/tex")?;
        let (names, table) = columns(&hadar_testing::shared("hadar-library/emissivity_54.csv")?);
        let about: Value =
            serde_json::from_str(&std::fs::read_to_string(folder.join("reference.json")).unwrap()).unwrap();
        let about = &about[name];
        let of = |material: &Value| {
            let at = names.iter().position(|one| Some(one.as_str()) == material.as_str()).unwrap();
            table[at].clone()
        };
        let (_, light) = columns(&folder.join(format!("{name}_light.csv")));
        Some(Self {
            scale: about["counts_per_photon_radiance"].as_f64().unwrap(),
            library: about["materials"].as_array().unwrap().iter().map(of).collect(),
            light: light[1..].to_vec(),
            folder,
            name,
        })
    }

    fn map(&self, what: &str) -> Vec<f64> {
        let path = self.folder.join(format!("{}_{what}.npy", self.name));
        match hadar_formats::cube::open(&path, None).unwrap() {
            Cube::F32(rows) => read(rows.as_ref()),
            Cube::F64(rows) => read(rows.as_ref()),
        }
    }

    fn decomposed(&self, options: &Options) -> Maps {
        let bands = Bands::uniform(720.0, 1250.0, 10.0).unwrap();
        let widths = bands.widths_cm1();
        let cube =
            hadar_formats::cube::open(&self.folder.join(format!("{}_counts.npy", self.name)), None).unwrap();
        let setting = Setting {
            bands: &bands,
            library: &self.library,
            surroundings: &self.light.iter().map(|s| Light::Radiance(s.clone())).collect::<Vec<_>>(),
            counts_per_radiance: &widths.iter().map(|width| self.scale / width).collect::<Vec<_>>(),
            var_added: &[],
            units_per_count: 1.0,
            temperature_k: [250.0, 340.0],
            lighting_total: (self.name != "two").then_some(1.0),
            gain: false,
            bad_bands: &[],
            path: None,
            light_besides: &[],
        };
        decompose(&setting, options, &cube, &|_| ()).unwrap()
    }
}

fn read<S: hadar::cube::Sample>(rows: &dyn Rows<S>) -> Vec<f64> {
    let mut buffer = Vec::new();
    rows.read(0..rows.shape().rows(), &mut buffer).unwrap().iter().map(|x| (*x).into()).collect()
}

/// Shares of right materials, rms of temperature error over its bound, share within 1.96 of it; that share where the lighting is at
/// its limit.
fn worth(reference: &Reference, maps: &Maps) -> [f64; 4] {
    let (material, temperature) = (reference.map("material"), reference.map("T"));
    let right = |i: &usize| f64::from(maps.material[*i]) == material[*i];
    let is_open = |i: &usize| maps.flags[*i] & (flag::LIGHTING_AT_LIMIT | flag::TEMPERATURE_AT_LIMIT) == 0;
    let all: Vec<usize> = (0..material.len()).filter(right).collect();
    let off = |i: &usize| {
        (f64::from(maps.temperature_k[*i]) - temperature[*i]) / f64::from(maps.temperature_sigma_k[*i])
    };
    let over: Vec<f64> = all.iter().filter(|i| is_open(i)).map(off).collect();
    let held: Vec<f64> = all.iter().filter(|i| !is_open(i)).map(off).collect();
    let covered =
        |over: &[f64]| over.iter().filter(|x| x.abs() < 1.959_964).count() as f64 / over.len() as f64;
    [
        all.len() as f64 / material.len() as f64,
        (over.iter().map(|x| x * x).sum::<f64>() / over.len() as f64).sqrt(),
        covered(&over),
        covered(&held),
    ]
}

/// What weighted least squares reaches there by another program is reached, intervals hold what they say, and what a bound
/// excludes changes nothing.
#[test]
fn reference_cubes_are_decomposed_to_their_bounds() {
    for (name, least) in [("one", 0.966), ("two", 0.9995)] {
        let Some(reference) = Reference::open(name) else { return };
        let maps = reference.decomposed(&Options::default());
        let [right, ratio, covered, held] = worth(&reference, &maps);
        assert!(right >= least, "{name}: {right}");
        assert!(
            (0.97..=1.05).contains(&ratio) && (0.93..=0.97).contains(&covered),
            "{name}: {ratio} {covered}"
        );
        // A truth near the limit is not missed because the fit lies on it.
        assert!(held >= 0.93, "{name}: {held}");
        let all = reference.decomposed(&Options { skipping: Skipping::Off, ..Options::default() });
        assert!(2 * maps.spared.fitted < all.spared.fitted);
        assert_eq!(Maps { spared: all.spared, ..maps }, all, "{name}");
    }
}

/// A library that is off by 1 %: intervals that know it hold what they say, those that do not are 19 times too narrow. All pixels of a material share
/// its one error, so that errors over deviations are those of a few draws (0.6 to 1.4) and a share of pixels above 95 % is no fault; shares over
/// many drawn libraries are tested beside the estimator.
#[test]
fn errors_of_the_library_widen_the_intervals() {
    let Some(reference) = Reference::open("mismatch") else { return };
    let exact = worth(&reference, &reference.decomposed(&Options::default()));
    assert!(exact[1] > 15.0 && exact[2] < 0.1, "{exact:?}");
    let error = LibraryError { relative: 0.01, correlation_cm1: 50.0 };
    let [right, ratio, covered, _] = worth(
        &reference,
        &reference.decomposed(&Options { library_error: Some(error), ..Options::default() }),
    );
    assert!(right >= 0.9425 && covered >= 0.93 && (0.6..1.4).contains(&ratio), "{right} {ratio} {covered}");
}

/// A library, a sky and a ground of no particular shape.
struct Scene {
    bands: Bands,
    library: Vec<Vec<f64>>,
    lights: Vec<Vec<f64>>,
    scale: f64,
    var_added: Vec<f64>,
}

impl Scene {
    fn new() -> Self {
        let bands = Bands::uniform(720.0, 1250.0, 10.0).unwrap();
        let over = |f: &dyn Fn(f64) -> f64| bands.nodes_cm1().iter().map(|nu| f(*nu)).collect::<Vec<f64>>();
        let library = vec![
            over(&|nu| 0.90 + 0.05 * (nu / 40.0).sin()),
            over(&|nu| 0.60 + 0.30 * (-((nu - 1000.0) / 60.0).powi(2)).exp()),
            over(&|nu| 0.30 + 0.10 * (nu / 90.0).cos()),
        ];
        let lights = vec![
            over(&|nu| (0.6 + 0.3 * (nu / 70.0).sin()) * photon_radiance(nu, 265.0)),
            over(&|nu| photon_radiance(nu, 290.0)),
            over(&|nu| 0.8 * photon_radiance(nu, 320.0)),
        ];
        Self { bands, library, lights, scale: 2e-13, var_added: Vec::new() }
    }

    /// Mean counts of a pixel.
    fn counts(&self, emissivity: &[f64], temperature_k: f64, lighting: &[f64]) -> Vec<f64> {
        let at = |w: usize| {
            let light: f64 = lighting.iter().zip(&self.lights).map(|(v, light)| v * light[w]).sum();
            let nu = self.bands.nodes_cm1()[w];
            self.scale * (emissivity[w] * photon_radiance(nu, temperature_k) + (1.0 - emissivity[w]) * light)
        };
        (0..self.bands.len()).map(at).collect()
    }

    /// What is made of pixels under the first lights.
    fn found(
        &self,
        pixels: &[Vec<f64>],
        lights: usize,
        change: &dyn Fn(&mut Setting<'_>),
    ) -> hadar::Result<Maps> {
        let shape = Shape::new(1, pixels.len(), self.bands.len())?;
        let cube = Cube::F64(Box::new(MemoryCube::new(shape, pixels.concat())?));
        let surroundings: Vec<Light> =
            self.lights[..lights].iter().map(|s| Light::Radiance(s.clone())).collect();
        let mut setting = Setting {
            bands: &self.bands,
            library: &self.library,
            surroundings: &surroundings,
            counts_per_radiance: &vec![self.scale / 10.0; self.bands.len()],
            var_added: &self.var_added,
            units_per_count: 1.0,
            temperature_k: [250.0, 340.0],
            lighting_total: None,
            gain: false,
            bad_bands: &[],
            path: None,
            light_besides: &[],
        };
        change(&mut setting);
        decompose(&setting, &Options::default(), &cube, &|_| ())
    }
}

/// Counts without noise give back what they were made of, with the deviation that the Fisher information of another module says.
#[test]
fn counts_without_noise_are_taken_apart_again() {
    let scene = Scene::new();
    for (lights, lighting, temperature_k) in
        [(1, vec![0.7], 301.3), (2, vec![0.3, 0.55], 295.7), (3, vec![0.2, 0.3, 0.4], 322.2)]
    {
        for m in 0..scene.library.len() {
            let pixel = scene.counts(&scene.library[m], temperature_k, &lighting);
            let maps = scene.found(std::slice::from_ref(&pixel), lights, &|_| ()).unwrap();
            assert_eq!(usize::from(maps.material[0]), m);
            assert!(
                (f64::from(maps.temperature_k[0]) - temperature_k).abs() < 1e-4,
                "{}",
                maps.temperature_k[0]
            );
            for (found, v) in maps.lighting.iter().zip(&lighting) {
                assert!((f64::from(*found) - v).abs() < 1e-4, "{found} {v}");
            }
            // The surroundings as shares of a blackbody of 330 K.
            let object = |light: &Vec<f64>| EnvironmentObject {
                temperature_k: 330.0,
                emissivity: Some(
                    light
                        .iter()
                        .zip(scene.bands.nodes_cm1())
                        .map(|(s, nu)| s / photon_radiance(*nu, 330.0))
                        .collect(),
                ),
            };
            let objects = scene.lights[..lights].iter().map(object).collect();
            let surroundings = Surroundings::new(scene.bands.nodes_cm1(), objects).unwrap();
            let unknowns = Unknowns::new([Nuisance::Temperature, Nuisance::Lighting]).unwrap();
            let state = surroundings.state(temperature_k, &lighting).unwrap();
            let counting = Counting { counts_per_radiance: scene.scale / 10.0, var_added: Vec::new() };
            let mut solver = PrecisionSolver::new(&scene.bands, &surroundings, unknowns);
            let bound = solver.bound(&scene.library[m], &state, &counting, Parameter::Temperature).unwrap();
            let sigma = bound.sigma;
            assert!((f64::from(maps.temperature_sigma_k[0]) / sigma - 1.0).abs() < 1e-4, "{lights} {m}");
            // The scale of the counts unknown: the same state again, less well known.
            let doubled: Vec<f64> = pixel.iter().map(|n| 2.0 * n).collect();
            let maps = scene.found(&[doubled], lights, &|setting| setting.gain = true).unwrap();
            assert!(
                (f64::from(maps.temperature_k[0]) - temperature_k).abs() < 1e-2,
                "{} {m}",
                maps.temperature_k[0]
            );
        }
    }
}

/// A mirror of surroundings that are known exactly has no errors worth the name, so that ln det C speaks for it. However much better
/// the library is than its user says, a material is not decided wrongly, nor is one that fits given up for it.
#[test]
fn a_mirror_of_what_is_around_does_not_win_over_a_library_better_than_is_said() {
    let bands = Bands::uniform(720.0, 1250.0, 10.0).unwrap();
    let nu = bands.nodes_cm1().to_vec();
    let road: Vec<f64> = nu.iter().map(|nu| 0.95 + 0.02 * (nu / 55.0).sin()).collect();
    let mirror: Vec<f64> = nu.iter().map(|nu| 0.12 + 0.01 * (nu / 90.0).cos()).collect();
    let sky: Vec<f64> =
        nu.iter().map(|nu| (0.5 + 0.3 * (nu / 70.0).sin()) * photon_radiance(*nu, 270.0)).collect();
    let scale = 1e5 / photon_radiance(900.0, 285.0);
    let sent = |e: &[f64], temperature_k: f64, light: &dyn Fn(usize) -> f64| -> Vec<f64> {
        let each = |w: usize| e[w] * photon_radiance(nu[w], temperature_k) + (1.0 - e[w]) * light(w);
        (0..nu.len()).map(each).collect()
    };
    // What the road sends on the whole, with a slope of its own that no mirror of it has at another temperature.
    let around = sent(&road, 285.0, &|w| 0.6 * sky[w]);
    let library = [road.clone(), mirror.clone()];
    let mut random = generator(11, 0);
    let mut normal = || -> f64 { StandardNormal.sample(&mut random) };
    // Of what is said, how much the library is off.
    for share in [0.0, 0.2, 1.0] {
        let (mut pixels, mut truth) = (Vec::new(), Vec::new());
        for i in 0..120 {
            let (own, temperature_k) = (i % 2, 285.0 + 0.5 * normal());
            // Smooth over some 80 cm^-1: two waves of random size.
            let (a, b) = (0.02 * share * normal(), 0.02 * share * normal());
            let e: Vec<f64> = (0..nu.len())
                .map(|w| library[own][w] * (1.0 + a * (nu[w] / 30.0).sin() + b * (nu[w] / 30.0).cos()))
                .collect();
            let mean = sent(&e, temperature_k, &|w| 0.5 * sky[w] + 0.3 * around[w]);
            pixels.extend(mean.iter().map(|s| {
                let n = scale * s;
                (n + n.sqrt() * normal()).round()
            }));
            truth.push(own as u16);
        }
        let cube = MemoryCube::new(Shape::new(1, 120, nu.len()).unwrap(), pixels).unwrap();
        let error = LibraryError { relative: 0.02, correlation_cm1: 50.0 };
        let setting = Setting {
            bands: &bands,
            library: &library,
            surroundings: &[Light::Radiance(sky.clone()), Light::Radiance(around.clone())],
            counts_per_radiance: &vec![scale / 10.0; nu.len()],
            var_added: &[],
            units_per_count: 1.0,
            temperature_k: [250.0, 340.0],
            lighting_total: None,
            gain: false,
            bad_bands: &[],
            path: None,
            light_besides: &[],
        };
        let by = |skipping| {
            let options = Options { library_error: Some(error), skipping, ..Options::default() };
            decompose(&setting, &options, &Cube::F64(Box::new(cube.clone())), &|_| ()).unwrap()
        };
        let maps = by(Skipping::On);
        let decided: Vec<usize> = (0..truth.len()).filter(|i| maps.is_decided(*i)).collect();
        let wrong = decided.iter().filter(|i| maps.material[**i] != truth[**i]).count();
        assert!(wrong == 0 && decided.len() >= 60, "{share}: {} decided, {wrong} wrong", decided.len());
        let all = by(Skipping::Off);
        assert_eq!(Maps { spared: all.spared, ..maps }, all, "{share}");
    }
}

/// Neighbours of the same counts, as in a dark or saturated corner, are fitted once and told alike.
#[test]
fn neighbours_of_the_same_counts_are_fitted_once() {
    let scene = Scene::new();
    let [a, b] = [0, 1].map(|m| scene.counts(&scene.library[m], 301.3, &[0.7]));
    let dark = vec![0.0; scene.bands.len()];
    let few = scene.found(&[a.clone(), dark.clone(), b.clone()], 1, &|_| ()).unwrap();
    let many = [&a, &a, &dark, &dark, &dark, &b].map(Clone::clone);
    let maps = scene.found(&many, 1, &|_| ()).unwrap();
    // The mean of the cube moves the bounds, and no answer.
    for (i, same) in [0, 0, 1, 1, 1, 2].into_iter().enumerate() {
        assert_eq!((maps.material[i], maps.flags[i]), (few.material[same], few.flags[same]), "{i}");
        assert_eq!(maps.temperature_k[i], few.temperature_k[same], "{i}");
    }
    assert_eq!(maps.spared.equal - few.spared.equal, 3 * scene.library.len() as u64);
    let pairs = |maps: &Maps| maps.spared.fitted + maps.spared.excluded + maps.spared.equal;
    assert_eq!(pairs(&maps), 2 * pairs(&few));
}

/// What nothing can be known of is said, and not filled in.
#[test]
fn what_the_photons_do_not_tell_is_declared() {
    let mut scene = Scene::new();
    // In equilibrium: all that is sent is a blackbody's at the temperature of what is around.
    let still = scene.counts(&scene.library[0], 290.0, &[0.0, 1.0]);
    let total = |setting: &mut Setting<'_>| setting.lighting_total = Some(1.0);
    let maps = scene.found(std::slice::from_ref(&still), 2, &total).unwrap();
    assert_eq!((maps.material[0], maps.flags[0] & flag::NO_INFORMATION), (NO_MATERIAL, flag::NO_INFORMATION));
    assert!((maps.temperature_k[0] - 290.0).abs() < 1.0 && maps.temperature_sigma_k[0].is_finite());
    // One band alone tells nothing, and no fit has a place to begin from.
    static OTHERS: [usize; 53] = {
        let mut others = [0; 53];
        let mut i = 0;
        while i < 53 {
            others[i] = i + 1;
            i += 1;
        }
        others
    };
    let one_band =
        |setting: &mut Setting<'_>| (setting.lighting_total, setting.bad_bands) = (Some(1.0), &OTHERS);
    let maps = scene.found(std::slice::from_ref(&still), 2, &one_band).unwrap();
    assert!(!maps.is_decided(0) && maps.p_value[0].is_nan());
    // A missing sample, a dead band, and one that is left out.
    let mut missing = scene.counts(&scene.library[1], 300.0, &[0.5]);
    missing[7] = f64::NAN;
    let maps = scene.found(std::slice::from_ref(&missing), 1, &|_| ()).unwrap();
    assert_eq!((maps.flags[0], maps.material[0], maps.candidates[0]), (flag::SKIPPED, NO_MATERIAL, 0));
    let maps = scene.found(std::slice::from_ref(&missing), 1, &|setting| setting.bad_bands = &[7]).unwrap();
    assert_eq!((maps.material[0], maps.flags[0]), (1, 0));
    missing[7] = -1.0;
    let error = scene.found(&[missing], 1, &|_| ()).unwrap_err().to_string();
    assert!(error.starts_with("row 0, column 0, band 7 holds -1"), "{error}");
    // What fits no material is said: a spectrum of spikes.
    let spikes: Vec<f64> =
        still.iter().enumerate().map(|(w, n)| if w % 2 == 0 { 0.5 * n } else { *n }).collect();
    let maps = scene.found(&[spikes], 2, &total).unwrap();
    assert!(maps.flags[0] & flag::NO_FIT != 0 && maps.p_value[0] < 1e-6);
    // Two materials of one spectrum, and a black one.
    scene.library = vec![scene.library[1].clone(), scene.library[1].clone(), vec![1.0; scene.bands.len()]];
    let grey = scene.counts(&scene.library[0], 300.0, &[0.5]);
    let black = scene.counts(&scene.library[2], 300.0, &[0.5]);
    let maps = scene.found(&[grey, black], 1, &|_| ()).unwrap();
    assert_eq!((maps.material[0], maps.candidates[0], maps.posterior[0]), (0, 2, 0.5));
    assert_eq!(maps.flags[0] & flag::UNDECIDED, flag::UNDECIDED);
    assert_eq!((maps.material[1], maps.flags[1]), (2, flag::LIGHTING_UNKNOWN));
    assert!((maps.temperature_k[1] - 300.0).abs() < 1e-3 && maps.lighting_sigma[1] == f32::INFINITY);
    let mut told = maps.clone();
    told.leave_out_unknown_lighting(None);
    assert!(told.lighting[1].is_nan() && told.lighting_sigma[1].is_nan() && told.texture_sigma[1].is_nan());
    assert_eq!((told.lighting[0], &told.flags), (maps.lighting[0], &maps.flags));
}

/// Counts drawn about pixels of random states: 95 % intervals and candidates hold what they say, from some hundred counts a band to a
/// million, with electronic noise as large as that of the photons, and with unknown gain. Of 2000 pixels five deviations are 0.024.
#[test]
fn intervals_hold_what_they_say_from_few_counts_to_many() {
    use rand::{RngExt, SeedableRng, rngs::ChaCha8Rng};
    use rand_distr::{Distribution, Normal, Poisson};
    let mut scene = Scene::new();
    let level = scene.counts(&scene.library[0], 295.0, &[0.5, 0.5])[27];
    for (i, (counts, noise, gain)) in
        [(3e2, 0.0, false), (1e4, 0.0, false), (1e4, 1.0, false), (1e6, 0.0, false), (1e6, 0.0, true)]
            .into_iter()
            .enumerate()
    {
        scene.scale = 2e-13 * counts / level;
        let var = noise * counts;
        let mut random = ChaCha8Rng::seed_from_u64(20 + i as u64);
        let mut truth = Vec::new();
        let pixels: Vec<Vec<f64>> = (0..2000)
            .map(|_| {
                let m = random.random_range(0..scene.library.len());
                let (t, v) = (random.random_range(275.0..315.0), random.random_range(0.1..0.9));
                truth.push((m, t));
                let mean = scene.counts(&scene.library[m], t, &[v, 1.0 - v]);
                let drawn = mean.iter().map(|n| {
                    let electrons = Normal::new(0.0, f64::sqrt(var)).unwrap().sample(&mut random);
                    Poisson::new(*n).unwrap().sample(&mut random) + electrons
                });
                drawn.collect()
            })
            .collect();
        scene.var_added = vec![var; scene.bands.len()];
        let maps = scene.found(&pixels, 2, &|setting| {
            setting.lighting_total = Some(1.0);
            setting.gain = gain;
        });
        let maps = maps.unwrap();
        let (mut open, mut covered, mut fits) = (0, 0, 0);
        for (i, (m, t)) in truth.iter().enumerate() {
            fits += usize::from(maps.p_value[i] > 0.05);
            let held = flag::LIGHTING_AT_LIMIT | flag::TEMPERATURE_AT_LIMIT | flag::NO_INFORMATION;
            if usize::from(maps.material[i]) != *m || maps.flags[i] & held != 0 {
                continue;
            }
            open += 1;
            let off = (f64::from(maps.temperature_k[i]) - t) / f64::from(maps.temperature_sigma_k[i]);
            covered += usize::from(off.abs() < 1.959_964);
        }
        let (covered, fits) = (covered as f64 / open as f64, fits as f64 / 2000.0);
        assert!(open > 500 && (covered - 0.95).abs() < 0.03, "{counts} {noise} {gain}: {open} {covered}");
        assert!((fits - 0.95).abs() < 0.03, "{counts} {noise} {gain}: {fits}");
    }
}
