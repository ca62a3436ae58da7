use super::super::maps::Maps;
use super::super::setting::{Light, Setting};
use super::super::{Options, decompose};
use super::*;
use hadar::correlation::matern;
use hadar::cube::{Cube, MemoryCube, Shape};
use hadar::demand::Skipping;
use hadar::planck::photon_radiance;
use hadar::random::generator;
use hadar::spectrum::Bands;
use nalgebra::{DMatrix, DVector};
use rand_distr::{Distribution, Poisson, StandardNormal};

const STATED: LibraryError = LibraryError { relative: 0.01, correlation_cm1: 50.0 };

/// Materials before a sky and a ground.
pub(in crate::decompose) struct Scene {
    pub(in crate::decompose) bands: Bands,
    library: Vec<Vec<f64>>,
    pub(super) lights: Vec<Vec<f64>>,
    pub(super) per_radiance: Vec<f64>,
    /// Lower triangle of the covariance of relative errors of size 1.
    law: DMatrix<f64>,
}

impl Scene {
    /// With about so many counts in each band.
    pub(in crate::decompose) fn new(materials: usize, bands: usize, counts: f64) -> Self {
        let step = 400.0 / (bands - 1) as f64;
        let of = Bands::uniform(800.0, 1200.0 + 0.25 * step, step).unwrap();
        let nu = of.nodes_cm1().to_vec();
        let emissivity = |m: usize| {
            let k = m as f64;
            let at = |nu: &f64| {
                let x = (nu - 700.0) / 600.0;
                0.75 + 0.15 * ((6.0 + 1.3 * k) * x + 1.7 * k).sin() - 0.012 * k
                    + 0.05 * (31.0 * x + k * k).cos()
            };
            nu.iter().map(at).collect()
        };
        let sky = |nu: &f64| (0.35 + 0.25 * (0.021 * nu).sin()) * photon_radiance(*nu, 262.0);
        let lights = vec![
            nu.iter().map(sky).collect(),
            nu.iter().map(|nu| photon_radiance(*nu, 288.0)).collect::<Vec<f64>>(),
        ];
        let mean = nu.iter().map(|nu| photon_radiance(*nu, 300.0)).sum::<f64>() / nu.len() as f64;
        let law = DMatrix::from_fn(nu.len(), nu.len(), |i, j| {
            matern(nu[i] - nu[j], STATED.correlation_cm1) + if i == j { 1e-12 } else { 0.0 }
        });
        Self {
            library: (0..materials).map(emissivity).collect(),
            lights,
            per_radiance: vec![counts / (mean * step); nu.len()],
            law: law.cholesky().unwrap().l(),
            bands: of,
        }
    }

    pub(in crate::decompose) fn with<T>(&self, then: impl FnOnce(&Setting<'_>) -> T) -> T {
        let lights: Vec<Light> = self.lights.iter().cloned().map(Light::Radiance).collect();
        then(&Setting {
            bands: &self.bands,
            library: &self.library,
            surroundings: &lights,
            counts_per_radiance: &self.per_radiance,
            var_added: &[],
            units_per_count: 1.0,
            temperature_k: [270.0, 335.0],
            lighting_total: Some(1.0),
            gain: false,
            bad_bands: &[],
            path: None,
            light_besides: &[],
        })
    }

    /// Mean counts, and what they change with the temperature, the share of the ground, and the relative error of each emissivity.
    pub(in crate::decompose) fn mean(&self, m: usize, t: f64, v: f64) -> [DVector<f64>; 4] {
        let widths = self.bands.widths_cm1();
        let (nu, e) = (self.bands.nodes_cm1(), &self.library[m]);
        let of = |f: &dyn Fn(usize) -> f64| {
            DVector::from_fn(nu.len(), |w, _| f(w) * self.per_radiance[w] * widths[w])
        };
        let light = |w: usize, v: f64| (1.0 - v) * self.lights[0][w] + v * self.lights[1][w];
        let planck = |w: usize, t: f64| photon_radiance(nu[w], t);
        [
            of(&|w| e[w] * planck(w, t) + (1.0 - e[w]) * light(w, v)),
            of(&|w| e[w] * (planck(w, t + 0.01) - planck(w, t - 0.01)) / 0.02),
            of(&|w| (1.0 - e[w]) * (self.lights[1][w] - self.lights[0][w])),
            of(&|w| e[w] * (planck(w, t) - light(w, v))),
        ]
    }

    fn covariance(&self, m: usize, t: f64, v: f64, share: f64) -> DMatrix<f64> {
        let [mean, _, _, reach] = self.mean(m, t, v);
        let size = share * STATED.relative;
        let errors = DMatrix::from_diagonal(&reach) * &self.law * size;
        DMatrix::from_diagonal(&mean) + &errors * errors.transpose()
    }

    /// Counts of pixels, each with errors of its own of this share of what is stated; temperatures and shares of the ground.
    pub(in crate::decompose) fn draw(
        &self,
        pixels: usize,
        share: f64,
        seed: u64,
    ) -> (Vec<f64>, Vec<(usize, f64, f64)>) {
        let mut random = generator(seed, 0);
        let mut counts = Vec::new();
        let truth = |i: usize| {
            let at = |step: f64| (i as f64 * step).fract();
            (i % self.library.len(), 285.0 + 30.0 * at(0.618_034), 0.25 + 0.5 * at(0.414_214))
        };
        for i in 0..pixels {
            let (m, t, v) = truth(i);
            let [mean, _, _, reach] = self.mean(m, t, v);
            let normal = DVector::from_fn(mean.len(), |_, _| StandardNormal.sample(&mut random));
            let drawn: DVector<f64> = &self.law * normal * (share * STATED.relative);
            let sent = mean + drawn.component_mul(&reach);
            counts.extend(sent.iter().map(|n| Poisson::new(*n).unwrap().sample(&mut random)));
        }
        (counts, (0..pixels).map(truth).collect())
    }

    fn maps(&self, counts: &[f64], library_error: Option<LibraryError>, skipping: Skipping) -> Maps {
        let bands = self.bands.len();
        let shape = Shape::new(1, counts.len() / bands, bands).unwrap();
        let cube = Cube::F64(Box::new(MemoryCube::new(shape, counts.to_vec()).unwrap()));
        let options = Options { library_error, skipping, ..Options::default() };
        self.with(|setting| decompose(setting, &options, &cube, &|_| ()).unwrap())
    }
}

fn close(found: f64, exact: f64, tolerance: f64) {
    assert!((found / exact - 1.0).abs() < tolerance, "{found} is not {exact}");
}

/// Cost, slope and information against matrices that are written out and factored whole, at few and many counts and smaller errors.
#[test]
fn the_filter_gives_what_the_whole_covariance_gives() {
    for (counts, share) in [(1e2, 1.0), (1e4, 0.25), (1e6, 1.0), (1e8, 1.0), (1e8, 0.0)] {
        let scene = Scene::new(3, 41, counts);
        let (m, t, v) = (1, 301.7, 0.6);
        let [n, slope, ground, _] = scene.mean(m, t, v);
        let seen = DVector::from_fn(n.len(), |w, _| n[w] * (1.0 + 0.01 * (1.3 * w as f64).cos()));
        let model = scene.with(|setting| Model::new(setting).unwrap());
        let mut shifted = vec![0.0; model.width];
        shifted[..seen.len()].copy_from_slice(seen.as_slice());
        let mut state = State::at(t);
        (state.mixture[0], state.mixture[1]) = (1.0 - v, v);
        let errors = Errors::new(&model, STATED).unwrap();
        let mut place = Workplace::default();
        let asked = Asked { kind: 0, m, share, start: state, short: f64::INFINITY, beside: 0.0, worse: 0.0 };
        place.queue.push(asked);
        let mut found = Sums::default();
        assert_eq!(place.run(&model, &errors, &shifted, &mut found), 1);
        let factor = scene.covariance(m, t, v, share).cholesky().unwrap();
        let off = &seen - &n;
        close(found.chi_square, off.dot(&factor.solve(&off)), 1e-6);
        let logarithm: f64 = factor.l().diagonal().iter().map(|x| 2.0 * x.ln()).sum();
        assert!((found.deviance - found.chi_square - logarithm).abs() < 1e-6);
        assert!((place.done[0].2 - n.iter().map(|n| n.ln()).sum::<f64>()).abs() < 1e-6);
        for (i, a) in [&slope, &ground].into_iter().enumerate() {
            close(found.slope[i], off.dot(&factor.solve(a)), 1e-5);
            for (j, b) in [&slope, &ground].into_iter().enumerate() {
                close(found.information[i][j], a.dot(&factor.solve(b)), 1e-6);
            }
        }
    }
}

/// Temperatures and deviations against generalised least squares with the whole covariance, factored at every step.
#[test]
fn a_fit_is_that_of_generalised_least_squares() {
    for counts in [1e3, 1e6, 1e8] {
        let scene = Scene::new(1, 41, counts);
        let (seen, truths) = scene.draw(24, 1.0, 3);
        let maps = scene.maps(&seen, Some(STATED), Skipping::default());
        for (i, n) in seen.chunks(41).enumerate() {
            let (m, mut t, mut v) = truths[i];
            let (mut sigma, mut of_lighting) = (0.0, 0.0);
            for _ in 0..20 {
                let [mean, slope, ground, _] = scene.mean(m, t, v);
                let factor = scene.covariance(m, t, v, 1.0).cholesky().unwrap();
                let columns = DMatrix::from_columns(&[slope, ground]);
                let white = factor.solve(&columns);
                let inverse = (columns.transpose() * &white).try_inverse().unwrap();
                let step = &inverse * (white.transpose() * (DVector::from_column_slice(n) - mean));
                (t, v) = (t + step[0], v + step[1]);
                (sigma, of_lighting) = (inverse[(0, 0)].sqrt(), inverse[(1, 1)].sqrt());
            }
            if !(0.0..=1.0).contains(&v) {
                continue;
            }
            let found = f64::from(maps.temperature_k[i]);
            // Half a step of the maps' numbers of single precision, and the last step.
            assert!((found - t).abs() < 2e-5 + 0.01 * sigma, "{counts}: {found} is not {t} ± {sigma}");
            close(f64::from(maps.temperature_sigma_k[i]), sigma, 1e-2);
            close(f64::from(maps.lighting_sigma[2 * i + 1]), of_lighting, 1e-2);
        }
    }
}

/// Errors drawn from the law that is stated: 95 % intervals hold 95 %, at any counts. 2000 pixels: a deviation is 0.5 %.
#[test]
fn intervals_hold_what_they_say_at_any_counts() {
    for counts in [1e3, 1e4, 1e6, 1e8] {
        let scene = Scene::new(4, 41, counts);
        let (mut held, mut all) = (0.0, 0.0);
        let seeds = 4;
        for seed in 0..seeds {
            let (seen, truths) = scene.draw(500, 1.0, 100 + seed);
            let maps = scene.maps(&seen, Some(STATED), Skipping::default());
            for (i, (m, t, _)) in truths.iter().enumerate() {
                if usize::from(maps.material[i]) == *m {
                    let off = (f64::from(maps.temperature_k[i]) - t).abs();
                    held += f64::from(u8::from(off <= 1.96 * f64::from(maps.temperature_sigma_k[i])));
                    all += 1.0;
                }
            }
        }
        let share = held / all;
        println!("{counts:e}: {share:.4} of {all}");
        assert!(all > 0.95 * 500.0 * seeds as f64, "{counts}: {all} of the right material");
        assert!((0.93..0.97).contains(&share), "{counts}: {share}");
    }
}

/// Whatever the errors really are, what a bound excludes changes no map.
#[test]
fn skipping_changes_no_map() {
    for (counts, share) in
        [(1e3, 1.0), (1e4, 0.0), (1e5, 1.0), (1e6, 0.1), (1e6, 1.0), (1e8, 1.0), (1e8, 4.0)]
    {
        let scene = Scene::new(20, 41, counts);
        let (seen, _) = scene.draw(200, share, 7);
        let [skipped, whole] =
            [Skipping::default(), Skipping::Off].map(|skip| scene.maps(&seen, Some(STATED), skip));
        let bits = |values: &[f32]| values.iter().map(|x| x.to_bits()).collect::<Vec<u32>>();
        assert_eq!(skipped.material, whole.material);
        assert_eq!(skipped.candidates, whole.candidates);
        assert_eq!(skipped.flags, whole.flags);
        assert_eq!(bits(&skipped.temperature_k), bits(&whole.temperature_k));
        assert_eq!(bits(&skipped.temperature_sigma_k), bits(&whole.temperature_sigma_k));
        assert_eq!(bits(&skipped.p_value), bits(&whole.p_value));
        assert_eq!(bits(&skipped.lighting), bits(&whole.lighting));
        assert_eq!(bits(&skipped.posterior), bits(&whole.posterior), "{counts} {share}");
    }
}

/// Time beside that of an exact library, on one thread: `--ignored --nocapture`.
#[test]
#[ignore = "a measurement"]
fn time_beside_the_exact_fit() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    for (materials, bands) in [(20, 41), (27, 54)] {
        for counts in [1e3, 1e4, 1e6, 1e8] {
            let scene = Scene::new(materials, bands, counts);
            let (seen, truths) = scene.draw(4000, 1.0, 5);
            let time = |error: Option<LibraryError>| {
                let run = || {
                    let start = std::time::Instant::now();
                    let maps = pool.install(|| scene.maps(&seen, error, Skipping::default()));
                    (start.elapsed().as_secs_f64() / truths.len() as f64 * 1e6, maps)
                };
                (0..3).map(|_| run()).min_by(|a, b| a.0.total_cmp(&b.0)).unwrap()
            };
            let [(exact, a), (errors, b)] = [None, Some(STATED)].map(time);
            println!(
                "{materials} x {bands}, {counts:e}: {exact:.1} us, with errors {errors:.1} us: {:.2}; {:?} {:?}",
                errors / exact,
                a.spared,
                b.spared
            );
        }
    }
}
