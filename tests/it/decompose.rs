//! Heat cubes with known truth, made without this program, decomposed: shares, errors and intervals against what is known of them.

use hadar::decompose::{Light, Maps, NO_MATERIAL, Options, Setting, decompose, flag};
use hadar::ranging::cube::{Cube, Rows};
use hadar::spectrum::Bands;
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
        match Cube::open(&path, None).unwrap() {
            Cube::F32(rows) => read(rows.as_ref()),
            Cube::F64(rows) => read(rows.as_ref()),
        }
    }

    fn decomposed(&self, total: Option<f64>, no_skip: bool) -> Maps {
        let bands = Bands::uniform(720.0, 1250.0, 10.0).unwrap();
        let widths = bands.widths_cm1();
        let cube = Cube::open(&self.folder.join(format!("{}_counts.npy", self.name)), None).unwrap();
        let setting = Setting {
            bands: &bands,
            library: &self.library,
            surroundings: &self.light.iter().map(|s| Light::Radiance(s.clone())).collect::<Vec<_>>(),
            counts_per_radiance: &widths.iter().map(|width| self.scale / width).collect::<Vec<_>>(),
            var_added: &[],
            temperature_k: [250.0, 340.0],
            lighting_total: total,
            gain: false,
            bad_bands: &[],
        };
        decompose(&setting, &Options { no_skip, ..Options::default() }, &cube, &|_| ()).unwrap()
    }
}

fn read<S: hadar::ranging::cube::Sample>(rows: &dyn Rows<S>) -> Vec<f64> {
    let mut buffer = Vec::new();
    rows.read(0..rows.shape().rows(), &mut buffer).unwrap().iter().map(|x| (*x).into()).collect()
}

struct Found {
    right: f64,
    error_over_sigma: f64,
    covered: f64,
    counted: usize,
    candidates_hold: f64,
}

impl Found {
    fn of(reference: &Reference, maps: &Maps) -> Self {
        let (material, temperature) = (reference.map("material"), reference.map("T"));
        let pixels = material.len();
        let (mut right, mut square, mut covered, mut counted) = (0, 0.0, 0, 0);
        for i in 0..pixels {
            if f64::from(maps.material[i]) != material[i] {
                continue;
            }
            right += 1;
            if maps.flags[i] & (flag::LIGHTING_AT_LIMIT | flag::TEMPERATURE_AT_LIMIT) != 0 {
                continue;
            }
            let off =
                (f64::from(maps.temperature_k[i]) - temperature[i]) / f64::from(maps.temperature_sigma_k[i]);
            counted += 1;
            square += off * off;
            covered += usize::from(off.abs() < 1.959_964);
        }
        let share = |count: usize, of: usize| count as f64 / of as f64;
        Self {
            right: share(right, pixels),
            error_over_sigma: (square / counted as f64).sqrt(),
            covered: share(covered, counted),
            counted,
            candidates_hold: 0.0,
        }
    }
}

#[test]
fn reference_cubes() {
    for (name, total) in [("one", Some(1.0)), ("two", None), ("mismatch", Some(1.0))] {
        let Some(reference) = Reference::open(name) else { return };
        let start = std::time::Instant::now();
        let maps = reference.decomposed(total, false);
        let time = start.elapsed().as_secs_f64();
        let found = Found::of(&reference, &maps);
        println!(
            "{name}: right {} error {} covered {} of {} {} {:?} {:.3} s {}",
            found.right,
            found.error_over_sigma,
            found.covered,
            found.counted,
            found.candidates_hold,
            maps.spared,
            time,
            maps.material.iter().filter(|m| **m == NO_MATERIAL).count()
        );
        let start = std::time::Instant::now();
        let all = reference.decomposed(total, true);
        println!("{:.3} s {:?}", start.elapsed().as_secs_f64(), all.spared);
        assert_eq!(all.material, maps.material);
        assert_eq!(all.temperature_k, maps.temperature_k);
        assert_eq!(all.posterior, maps.posterior);
    }
}

#[test]
#[ignore]
fn speed() {
    use hadar::ranging::cube::{MemoryCube, Shape};
    use rand::{RngExt, SeedableRng};
    let reference = Reference::open("one").unwrap();
    let bands = Bands::uniform(720.0, 1250.0, 10.0).unwrap();
    let mut random = rand::rngs::ChaCha8Rng::seed_from_u64(7);
    let (sky, ground): (Vec<f64>, Vec<f64>) = bands
        .nodes_cm1()
        .iter()
        .map(|v| (hadar::planck::photon_radiance(*v, 263.15), hadar::planck::photon_radiance(*v, 293.15)))
        .unzip();
    let pixels = 100_000;
    for level in [1e4, 1e5, 1e6] {
        let scale = level / 5e18;
        let mut samples = Vec::new();
        let mut truth = Vec::new();
        for _ in 0..pixels {
            let m = random.random_range(0..27usize);
            let (t, v): (f64, f64) = (random.random_range(275.0..315.0), random.random());
            truth.push(m);
            for (w, nu) in bands.nodes_cm1().iter().enumerate() {
                let e = reference.library[m][w];
                let n = scale
                    * (e * hadar::planck::photon_radiance(*nu, t)
                        + (1.0 - e) * (v * sky[w] + (1.0 - v) * ground[w]));
                let z: f64 = {
                    let (a, b): (f64, f64) = (random.random(), random.random());
                    (-2.0 * (1.0 - a).ln()).sqrt() * (std::f64::consts::TAU * b).cos()
                };
                samples.push((n + n.sqrt() * z).round() as f32);
            }
        }
        let cube = Cube::F32(Box::new(
            MemoryCube::new(Shape::new(100, pixels / 100, 54).unwrap(), samples).unwrap(),
        ));
        let widths = bands.widths_cm1();
        let setting = Setting {
            bands: &bands,
            library: &reference.library,
            surroundings: &[Light::Radiance(sky.clone()), Light::Radiance(ground.clone())],
            counts_per_radiance: &widths.iter().map(|width| scale / width).collect::<Vec<_>>(),
            var_added: &[],
            temperature_k: [265.0, 330.0],
            lighting_total: Some(1.0),
            gain: false,
            bad_bands: &[],
        };
        let start = std::time::Instant::now();
        let maps = decompose(&setting, &Options::default(), &cube, &|_| ()).unwrap();
        let time = start.elapsed().as_secs_f64();
        let right = maps.material.iter().zip(&truth).filter(|(a, b)| usize::from(**a) == **b).count() as f64
            / pixels as f64;
        println!("{level:e}: {:.2} us a pixel, right {right} {:?}", 1e6 * time / pixels as f64, maps.spared);
    }
}
