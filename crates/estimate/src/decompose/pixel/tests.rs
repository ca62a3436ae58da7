//! Deviations of lighting and texture against drawn counts and against least squares written out; ranks of the materials.

mod priors;

use super::{NO_MATERIAL, flag};
use crate::decompose::{Light, Maps, Options, Setting, decompose};
use hadar::cube::{Cube, MemoryCube, Shape};
use hadar::demand::Skipping;
use hadar::planck::photon_radiance;
use hadar::random::generator;
use hadar::spectrum::Bands;
use nalgebra::{DMatrix, DVector};
use rand::RngExt;
use rand_distr::{Distribution, Poisson};

const RANKS: usize = 5;

/// Material, temperature and lighting of a pixel.
type State = (usize, f64, Vec<f64>);

/// A scene of two lights, of which some are said to be there and their sum may be known.
struct Scene {
    bands: Bands,
    library: Vec<Vec<f64>>,
    lights: Vec<Light>,
    kappa: f64,
    total: Option<f64>,
    gain: bool,
}

impl Scene {
    fn new(kappa: f64, lights: usize, total: Option<f64>) -> Self {
        let bands = Bands::uniform(750.0, 1250.0, 12.5).unwrap();
        let nodes = bands.nodes_cm1().to_vec();
        let of = |f: &dyn Fn(f64) -> f64| -> Vec<f64> { nodes.iter().map(|nu| f(*nu)).collect() };
        let library = (0..4).map(|m| {
            let m = f64::from(m);
            of(&|nu| {
                0.72 - 0.06 * m + 0.12 * (nu / 190.0 + 1.7 * m).sin() + 0.05 * ((5.0 + m) * nu / 600.0).cos()
            })
        });
        let all = [of(&|nu| 0.7 * photon_radiance(nu, 255.0)), of(&|nu| photon_radiance(nu, 310.0))];
        Self {
            library: library.collect(),
            lights: all.into_iter().take(lights).map(Light::Radiance).collect(),
            bands,
            kappa,
            total,
            gain: false,
        }
    }

    fn with<T>(&self, then: impl FnOnce(&Setting<'_>) -> T) -> T {
        then(&Setting {
            bands: &self.bands,
            library: &self.library,
            surroundings: &self.lights,
            counts_per_radiance: &vec![self.kappa; self.bands.len()],
            var_added: &[],
            units_per_count: 1.0,
            temperature_k: [260.0, 345.0],
            lighting_total: self.total,
            gain: self.gain,
            bad_bands: &[3],
            path: None,
            light_besides: &[],
        })
    }

    fn mean(&self, m: usize, t: f64, lighting: &[f64]) -> Vec<f64> {
        let e = &self.library[m];
        let sent = self.bands.nodes_cm1().iter().enumerate().map(|(i, nu)| {
            let lit = self.lights.iter().zip(lighting).map(|(light, v)| match light {
                Light::Radiance(radiance) => v * radiance[i],
                Light::Counts(_) => 0.0,
            });
            e[i] * photon_radiance(*nu, t) + (1.0 - e[i]) * lit.sum::<f64>()
        });
        self.bands.weigh(&sent.collect::<Vec<_>>()).iter().map(|signal| self.kappa * signal).collect()
    }

    fn maps(&self, counts: Vec<f64>, skipping: Skipping) -> Maps {
        let shape = Shape::new(1, counts.len() / self.bands.len(), self.bands.len()).unwrap();
        let cube = Cube::F64(Box::new(MemoryCube::new(shape, counts).unwrap()));
        let options = Options { skipping, ranked: RANKS, ..Options::default() };
        self.with(|setting| decompose(setting, &options, &cube, &|_| ()).unwrap())
    }

    /// Pixels of random states with drawn counts; lighting whose sum is known, or is below 1.
    fn drawn(&self, pixels: usize, seed: u64) -> (Vec<f64>, Vec<State>) {
        let mut random = generator(seed, 0);
        let (mut counts, mut truth) = (Vec::new(), Vec::new());
        for _ in 0..pixels {
            let (m, t) = (random.random_range(0..4), random.random_range(280.0..320.0));
            let v: f64 = random.random_range(0.1..0.6);
            let lighting = match (self.lights.len(), self.total) {
                (1, _) => vec![v],
                (_, Some(total)) => vec![v, total - v],
                _ => vec![v, random.random_range(0.1..0.9 - v)],
            };
            let mean = self.mean(m, t, &lighting);
            counts.extend(mean.iter().map(|n| Poisson::new(*n).unwrap().sample(&mut random)));
            truth.push((m, t, lighting));
        }
        (counts, truth)
    }

    fn texture(&self, lighting: &[f64]) -> f64 {
        self.with(|setting| setting.textures()).iter().zip(lighting).map(|(light, v)| light * v).sum()
    }

    /// Deviations of the lighting factors and of the texture: least squares with slopes by differences. The unknowns are the temperature, the
    /// lighting factors that are free, and a factor of all counts.
    fn least_squares(&self, m: usize, t: f64, lighting: &[f64]) -> (Vec<f64>, f64) {
        let fixed = usize::from(self.total.is_some());
        let free = lighting.len() - fixed;
        let at = |x: &[f64]| {
            let mut v = vec![0.0; lighting.len()];
            v[fixed..].copy_from_slice(&x[1..=free]);
            if let Some(total) = self.total {
                v[0] = total - v[1..].iter().sum::<f64>();
            }
            let scale = if self.gain { x[free + 1] } else { 1.0 };
            let mut mean: Vec<f64> = self.mean(m, x[0], &v).iter().map(|n| scale * n).collect();
            mean.remove(3);
            DVector::from_vec(mean)
        };
        let x: Vec<f64> = [t].into_iter().chain(lighting[fixed..].iter().copied()).chain([1.0]).collect();
        let unknowns = 1 + free + usize::from(self.gain);
        let mean = at(&x);
        let columns: Vec<DVector<f64>> = (0..unknowns)
            .map(|i| {
                let step = if i == 0 { 1e-2 } else { 1e-4 };
                let moved = |by: f64| {
                    let mut to = x.clone();
                    to[i] += by;
                    at(&to)
                };
                (moved(step) - moved(-step)).component_div(&mean.map(f64::sqrt)) / (2.0 * step)
            })
            .collect();
        let slopes = DMatrix::from_columns(&columns);
        let covariance = (slopes.transpose() * slopes).try_inverse().unwrap();
        let sigma = |a: &dyn Fn(usize) -> f64| {
            let form = DVector::from_fn(unknowns, |i, _| match i {
                i if i == 0 || i > free => 0.0,
                i => a(i - 1 + fixed) - if fixed > 0 { a(0) } else { 0.0 },
            });
            form.dot(&(&covariance * &form)).max(0.0).sqrt()
        };
        let one = |k: usize| sigma(&|j| f64::from(u8::from(j == k)));
        let textures = self.with(|setting| setting.textures());
        ((0..lighting.len()).map(one).collect(), sigma(&|k| textures[k]))
    }
}

/// One light and two, their sum known and not, and an unknown factor of the counts.
fn scenes(kappa: f64) -> [Scene; 4] {
    let mut gain = Scene::new(10.0 * kappa, 2, Some(0.8));
    gain.gain = true;
    [Scene::new(kappa, 1, None), Scene::new(kappa, 2, None), Scene::new(kappa, 2, Some(0.8)), gain]
}

#[test]
fn deviations_of_lighting_and_texture_are_those_of_least_squares() {
    for scene in scenes(1e-13) {
        let lighting = if scene.lights.len() == 1 { vec![0.55] } else { vec![0.35, 0.45] };
        for m in 0..4 {
            let maps = scene.maps(scene.mean(m, 301.3, &lighting), Skipping::On);
            assert_eq!(usize::from(maps.material[0]), m);
            let (of_lighting, of_texture) = scene.least_squares(m, 301.3, &lighting);
            let close = |found: f32, exact: f64| {
                assert!((f64::from(found) / exact - 1.0).abs() < 0.01, "{found} is not {exact}");
            };
            maps.lighting_sigma.iter().zip(of_lighting).for_each(|(found, exact)| close(*found, exact));
            close(maps.texture_sigma[0], of_texture);
        }
    }
}

/// 95 % intervals of 4000 pixels each: five deviations are .017.
#[test]
fn intervals_of_lighting_and_texture_hold_what_they_say() {
    for (i, scene) in scenes(1e-13).iter().enumerate() {
        let (counts, truth) = scene.drawn(4000, 70 + i as u64);
        let maps = scene.maps(counts, Skipping::On);
        let lights = scene.lights.len();
        let (mut open, mut covered) = (0, vec![0; lights + 1]);
        for (i, (m, _, lighting)) in truth.iter().enumerate() {
            let held = flag::LIGHTING_AT_LIMIT | flag::TEMPERATURE_AT_LIMIT | flag::NO_INFORMATION;
            if usize::from(maps.material[i]) != *m || maps.flags[i] & held != 0 {
                continue;
            }
            open += 1;
            let own = i * lights..(i + 1) * lights;
            let found: Vec<f64> = maps.lighting[own.clone()].iter().map(|v| f64::from(*v)).collect();
            let off = found.iter().zip(lighting).map(|(found, v)| found - v);
            let off = off.chain([scene.texture(&found) - scene.texture(lighting)]);
            let sigmas = maps.lighting_sigma[own].iter().chain([&maps.texture_sigma[i]]);
            for (covered, (off, sigma)) in covered.iter_mut().zip(off.zip(sigmas)) {
                *covered += usize::from(off.abs() <= 1.959_964 * f64::from(*sigma));
            }
        }
        let shares: Vec<f64> =
            covered.iter().map(|covered| f64::from(*covered as u32) / f64::from(open)).collect();
        assert!(open > 3000 && shares.iter().all(|share| (0.93..0.97).contains(share)), "{open} {shares:?}");
    }
}

/// From few photons to many: a lighting factor that is given errs by clearly less than a blind guess.
#[test]
fn lighting_that_is_given_is_known() {
    let (mut unknown, mut given) = (0, 0);
    for (i, kappa) in [1e-17, 1e-16, 3e-16, 1e-15, 1e-14].into_iter().enumerate() {
        let scene = Scene::new(kappa, 1, None);
        let (counts, truth) = scene.drawn(1000, 80 + i as u64);
        let mut maps = scene.maps(counts, Skipping::On);
        let raised: Vec<u8> = maps.flags.clone();
        maps.leave_out_unknown_lighting(None);
        assert_eq!(raised, maps.flags);
        let mut off = Vec::new();
        for (i, (m, _, lighting)) in truth.iter().enumerate() {
            let is_unknown = maps.flags[i] & flag::LIGHTING_UNKNOWN != 0;
            assert_eq!(is_unknown, maps.lighting[i].is_nan());
            assert!(
                is_unknown == maps.texture_sigma[i].is_nan() && is_unknown == maps.lighting_sigma[i].is_nan()
            );
            unknown += usize::from(is_unknown);
            if !is_unknown && usize::from(maps.material[i]) == *m {
                off.push((f64::from(maps.lighting[i]) - lighting[0]).powi(2));
            }
        }
        given += off.len();
        let rms = (off.iter().sum::<f64>() / off.len().max(1) as f64).sqrt();
        assert!(rms < 0.2, "{kappa:e}: {} given, rms {rms}", off.len());
    }
    assert!(unknown > 500 && given > 1000, "{unknown} {given}");
}

/// The first is the material itself, all add up to 1 at most in falling order, and bounds change nothing; equal materials stand side by side.
#[test]
fn materials_are_ranked() {
    let mut scene = Scene::new(3e-16, 2, Some(0.8));
    scene.library.push(scene.library[1].clone());
    let (counts, _) = scene.drawn(400, 90);
    let [maps, whole] = [Skipping::On, Skipping::Off].map(|skipping| scene.maps(counts.clone(), skipping));
    assert_eq!(maps.ranked, whole.ranked);
    let bits = |all: &[f32]| all.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&maps.ranked_posterior), bits(&whole.ranked_posterior));
    assert_eq!(bits(&maps.lighting_sigma), bits(&whole.lighting_sigma));
    assert_eq!(bits(&maps.texture_sigma), bits(&whole.texture_sigma));
    let each = maps.ranked.chunks(RANKS).zip(maps.ranked_posterior.chunks(RANKS)).enumerate();
    let mut several = 0;
    for (i, (materials, posteriors)) in each {
        assert_eq!(materials[0], maps.material[i]);
        if materials[0] == NO_MATERIAL {
            assert!(posteriors.iter().all(|p| *p == 0.0));
            continue;
        }
        assert_eq!(posteriors[0], maps.posterior[i]);
        assert!(posteriors.windows(2).all(|pair| pair[0] >= pair[1]), "{posteriors:?}");
        assert!(posteriors.iter().sum::<f32>() < 1.0 + 1e-6, "{posteriors:?}");
        assert!(materials.iter().zip(posteriors).all(|(m, p)| (*m == NO_MATERIAL) == (*p == 0.0)));
        several += usize::from(maps.candidates[i] > 1);
        if let Some(at) = materials.iter().position(|m| *m == 1).filter(|at| *at + 1 < RANKS) {
            assert_eq!((materials[at + 1], posteriors[at + 1]), (4, posteriors[at]));
        }
    }
    assert!(several > 100, "{several}");
}

/// Lights that are not there, or alone: the deviations are no smaller than the errors but for a fifth, and at most three times as large, rms.
#[test]
fn deviations_beside_a_limit_are_as_large_as_errors() {
    for (kappa, lit) in [(3e-16, 0.0), (3e-16, 1.0), (3e-16, 0.5), (3e-15, 0.0), (3e-14, 0.0)] {
        let scene = Scene::new(kappa, 2, None);
        let mut random = generator(95, 0);
        let mut counts = Vec::new();
        for i in 0..1000 {
            let mean = scene.mean(i % 4, 300.0, &[lit, 0.0]);
            counts.extend(mean.iter().map(|n| Poisson::new(*n).unwrap().sample(&mut random)));
        }
        let maps = scene.maps(counts, Skipping::On);
        for k in 0..2 {
            let (mut off, mut sigma, mut count) = (0.0, 0.0, 0.0);
            for i in (0..1000).filter(|i| usize::from(maps.material[*i]) == i % 4) {
                let truth = if k == 0 { lit } else { 0.0 };
                off += (f64::from(maps.lighting[2 * i + k]) - truth).powi(2);
                sigma += f64::from(maps.lighting_sigma[2 * i + k]).powi(2);
                count += 1.0;
            }
            let (off, sigma) = (f64::sqrt(off / count), f64::sqrt(sigma / count));
            assert!(sigma > 0.8 * off && sigma < 3.0 * off, "{kappa:e} {lit} {k}: off {off}, said {sigma}");
        }
    }
}
