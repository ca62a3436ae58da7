//! Libraries made out of random cubes: what is said of their errors, and what is found without noise.

use hadar::cube::{Cube, MemoryCube, Shape};
use hadar::fisher::emissivity::{EmissivityPrior, Smoothness};
use hadar::planck::photon_radiance;
use hadar::spectrum::Bands;
use hadar_estimate::decompose::{Light, Setting, flag};
use hadar_estimate::separation::{Asked, Found, library_from_cube, ratio};
use hadar_simulate::draws::generator;
use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};

const KNOWN: Smoothness = Smoothness { mean: 0.7, magnitude: 0.08, shape: 0.08, correlation_cm1: 60.0 };
const MATERIALS: usize = 3;
const PIXELS: usize = 360;

/// Pixels of a few materials that are drawn, under a sky with lines and above a ground.
struct Scene {
    bands: Bands,
    materials: Vec<Vec<f64>>,
    lights: Vec<Light>,
    counts: Vec<f64>,
    material: Vec<usize>,
    temperature_k: Vec<f64>,
    per: Vec<f64>,
}

impl Scene {
    /// `scale`: counts of a blackbody of 300 K at 900 cm⁻¹; without noise where it is not drawn.
    fn new(seed: u64, scale: f64, noise: bool) -> Self {
        let bands = Bands::uniform(780.0, 1240.0, 20.0).unwrap();
        let nu = bands.nodes_cm1().to_vec();
        let prior = EmissivityPrior::smooth(&nu, KNOWN).unwrap();
        let mut random = generator(seed, 0);
        let mut materials: Vec<Vec<f64>> = Vec::new();
        while materials.len() < MATERIALS {
            let z: Vec<f64> = (0..prior.unknowns()).map(|_| StandardNormal.sample(&mut random)).collect();
            let e = prior.at(&z);
            // Groups are told by their profiles: what differs in magnitude alone is one group.
            let (mine, count) = (ratio(&e), nu.len() as f64);
            let apart =
                |other: &Vec<f64>| mine.iter().zip(ratio(other)).map(|(a, b)| (a - b).abs()).sum::<f64>();
            let apart = materials.iter().all(|other| apart(other) > 0.05 * count);
            if apart && e.iter().all(|e| (0.0..=1.0).contains(e)) {
                materials.push(e);
            }
        }
        let sky: Vec<f64> = nu
            .iter()
            .enumerate()
            .map(|(w, nu)| [0.25, 0.7, 0.4, 0.9, 0.3][w % 5] * photon_radiance(*nu, 275.0))
            .collect();
        let ground: Vec<f64> = nu.iter().map(|nu| photon_radiance(*nu, 290.0)).collect();
        let per = scale / photon_radiance(900.0, 300.0) / 20.0;
        let (mut counts, mut material, mut temperatures) = (Vec::new(), Vec::new(), Vec::new());
        for i in 0..PIXELS {
            let (own, t) = (i % MATERIALS, random.random_range(285.0..320.0));
            let v: f64 = random.random_range(0.1..0.9);
            for w in 0..nu.len() {
                let e = materials[own][w];
                let light = v * sky[w] + (1.0 - v) * ground[w];
                let mean = 20.0 * per * (e * photon_radiance(nu[w], t) + (1.0 - e) * light);
                let normal: f64 = StandardNormal.sample(&mut random);
                counts.push(if noise { (mean + mean.sqrt() * normal).max(0.0) } else { mean });
            }
            material.push(own);
            temperatures.push(t);
        }
        Self {
            per: vec![per; bands.len()],
            lights: vec![Light::Radiance(sky), Light::Radiance(ground)],
            temperature_k: temperatures,
            bands,
            materials,
            counts,
            material,
        }
    }

    fn setting(&self) -> Setting<'_> {
        Setting {
            bands: &self.bands,
            library: &[],
            surroundings: &self.lights,
            counts_per_radiance: &self.per,
            var_added: &[],
            units_per_count: 1.0,
            temperature_k: [250.0, 350.0],
            lighting_total: Some(1.0),
            gain: false,
            bad_bands: &[],
            path: None,
            light_besides: &[],
        }
    }

    fn cube(&self) -> Cube {
        let bands = self.bands.len();
        let shape = Shape::new(1, self.counts.len() / bands, bands).unwrap();
        Cube::from(MemoryCube::new(shape, self.counts.clone()).unwrap())
    }

    fn library(&self, count: [usize; 2]) -> Found {
        let asked = Asked { count, max_emissivity: 0.95, prior: KNOWN, seed: 1 };
        library_from_cube(&self.setting(), &asked, &self.cube(), &|_| ()).unwrap()
    }

    /// The material of each cluster, and whether every pixel went to that of its own.
    fn materials_of(&self, found: &Found) -> (Vec<usize>, bool) {
        let of: Vec<usize> = (0..found.clusters.len())
            .map(|i| {
                let mut votes = [0; MATERIALS];
                let own =
                    found.maps.material.iter().zip(&self.material).filter(|(m, _)| usize::from(**m) == i);
                own.for_each(|(_, there)| votes[*there] += 1);
                (0..MATERIALS).max_by_key(|m| votes[*m]).unwrap()
            })
            .collect();
        let right = found.maps.material.iter().zip(&self.material);
        let right = right.filter(|(m, there)| of.get(usize::from(**m)) == Some(there)).count();
        (of, right == self.material.len())
    }
}

/// 95 % intervals of the emissivities hold what was drawn from the prior: 40 cubes of 3 materials and 24 bands. Bands of a material
/// err together, some four ways each: 480 chances know 0.95 to 0.01, and the seed is fixed. The magnitude alone: 120 values know
/// their rms to 6 %; three of these.
#[test]
#[ignore = "19 s of processor time: .ci/evidence runs it"]
fn stated_errors_of_a_library_hold() {
    library_errors_hold(40, [8.0, 0.02, 0.2]);
}

/// The same of 8 cubes, which know half as much.
#[test]
fn stated_errors_of_a_library_hold_in_few_cubes() {
    library_errors_hold(8, [3.0, 0.045, 0.45]);
}

fn library_errors_hold(cubes: u64, [most_mixed, off_share, off_rms]: [f64; 3]) {
    let (mut held, mut all, mut magnitudes, mut clusters, mut mixed) = (0, 0, 0.0, 0, 0);
    for seed in 0..cubes {
        let scene = Scene::new(100 + seed, 1e5, true);
        let found = scene.library([MATERIALS; 2]);
        let (of, right) = scene.materials_of(&found);
        // Errors are said of a group of one material.
        if !right || found.clusters.len() != MATERIALS {
            mixed += 1;
            continue;
        }
        for (one, m) in found.clusters.iter().zip(of) {
            let truth = &scene.materials[m];
            for ((found, sigma), truth) in one.emissivity.iter().zip(&one.sigma).zip(truth) {
                held += usize::from((found - truth).abs() < 1.96 * sigma);
                all += 1;
            }
            let off: f64 =
                one.emissivity.iter().zip(truth).map(|(a, b)| a - b).sum::<f64>() / truth.len() as f64;
            magnitudes += (off / one.sigma_mean).powi(2);
            clusters += 1;
            assert!((0.8..1.2).contains(&one.chi_square_reduced), "{}", one.chi_square_reduced);
        }
    }
    assert!(f64::from(mixed) <= most_mixed, "{mixed}");
    let share = held as f64 / all as f64;
    assert!((share - 0.95).abs() <= off_share, "{share}");
    let rms = f64::sqrt(magnitudes / f64::from(clusters));
    assert!((rms - 1.0).abs() < off_rms, "{rms}");
}

/// Without noise the emissivities and temperatures come back, and a range of counts finds how many there are.
#[test]
fn without_noise_all_comes_back() {
    let scene = Scene::new(7, 1e9, false);
    let found = scene.library([2, 5]);
    let (of, right) = scene.materials_of(&found);
    assert!(right && found.clusters.len() == MATERIALS, "{:?}", found.tried);
    for (one, m) in found.clusters.iter().zip(&of) {
        let truth = &scene.materials[*m];
        let worst = one.emissivity.iter().zip(truth).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(worst < 2e-4, "{worst}");
    }
    for (found, there) in found.maps.temperature_k.iter().zip(&scene.temperature_k) {
        assert!((f64::from(*found) - there).abs() < 0.02, "{found} {there}");
    }
}

/// What sends what it is lit by has no emissivity; missing samples are left out; threads change nothing.
#[test]
fn what_tells_nothing_is_declared() {
    let mut scene = Scene::new(9, 1e5, true);
    let bands = scene.bands.len();
    let Light::Radiance(ground) = &scene.lights[1] else { panic!() };
    for pixel in 0..20 {
        for (w, ground) in ground.iter().enumerate() {
            scene.counts[pixel * bands + w] = (20.0 * scene.per[w] * ground).round();
        }
    }
    scene.counts[20 * bands] = f64::NAN;
    let by = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| scene.library([MATERIALS; 2]))
    };
    let found = by(1);
    assert_eq!(found.drawn, PIXELS - 1);
    let equilibrium = (0..20).filter(|i| found.maps.flags[*i] & flag::NO_INFORMATION != 0).count();
    assert!(equilibrium == 20, "{equilibrium}");
    assert!(found.maps.flags[20] & flag::SKIPPED != 0);
    let other = by(3);
    assert_eq!(found.clusters, other.clusters);
    assert_eq!(found.maps.material, other.maps.material);
}

#[test]
fn impossible_libraries_are_refused() {
    let scene = Scene::new(3, 1e5, true);
    let asked = |count| Asked { count, max_emissivity: 0.95, prior: KNOWN, seed: 1 };
    let run = |setting: Setting<'_>, count| {
        library_from_cube(&setting, &asked(count), &scene.cube(), &|_| ()).unwrap_err().to_string()
    };
    assert!(run(scene.setting(), [PIXELS + 1; 2]).contains("ask for fewer clusters than pixels"));
    assert!(run(scene.setting(), [0, 2]).contains("ask for one at least"));
    assert!(run(Setting { gain: true, ..scene.setting() }, [2, 2]).contains("an unknown gain"));
}
