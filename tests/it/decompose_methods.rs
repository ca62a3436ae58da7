//! The methods that a decomposition is compared with, against closed forms, and errors of the inverse functions against drawn counts.

use hadar::cube::{Cube, MemoryCube, Shape};
use hadar::planck::{brightness_temperature, photon_radiance};
use hadar::spectrum::Bands;
use hadar_estimate::decompose::{
    Light, Maps, Method, NO_MATERIAL, Options, Setting, decompose_by, flag, inverse_error,
};

const SCALE: f64 = 1e-12;
const STEP_CM1: f64 = 10.0;
const AMBIENT_K: f64 = 285.0;

/// A library under black surroundings, one node a band.
struct Scene {
    bands: Bands,
    library: Vec<Vec<f64>>,
}

impl Scene {
    fn new(emissivities: &[&dyn Fn(f64) -> f64]) -> Self {
        let bands = Bands::uniform(800.0, 1200.0, STEP_CM1).unwrap();
        let library =
            emissivities.iter().map(|e| bands.nodes_cm1().iter().map(|nu| e(*nu)).collect()).collect();
        Self { bands, library }
    }

    fn light(&self) -> Vec<f64> {
        self.bands.nodes_cm1().iter().map(|nu| photon_radiance(*nu, AMBIENT_K)).collect()
    }

    /// Mean counts of material `m`.
    fn counts(&self, m: usize, temperature_k: f64, v: f64) -> Vec<f64> {
        let each = self.bands.nodes_cm1().iter().zip(&self.library[m]).zip(self.light());
        each.map(|((nu, e), light)| SCALE * (e * photon_radiance(*nu, temperature_k) + (1.0 - e) * v * light))
            .collect()
    }

    fn with<T>(&self, bad_bands: &[usize], use_it: impl FnOnce(&Setting<'_>) -> T) -> T {
        use_it(&Setting {
            bands: &self.bands,
            library: &self.library,
            surroundings: &[Light::Radiance(self.light())],
            counts_per_radiance: &vec![SCALE / STEP_CM1; self.bands.len()],
            var_added: &[],
            units_per_count: 1.0,
            temperature_k: [250.0, 340.0],
            lighting_total: None,
            gain: false,
            bad_bands,
            path: None,
            light_besides: &[],
        })
    }

    fn found(&self, method: Method, pixels: &[Vec<f64>], bad_bands: &[usize]) -> Maps {
        let shape = Shape::new(1, pixels.len(), self.bands.len()).unwrap();
        let cube = Cube::F64(Box::new(MemoryCube::new(shape, pixels.concat()).unwrap()));
        self.with(bad_bands, |setting| {
            decompose_by(method, setting, &Options::default(), &cube, &|_| ()).unwrap()
        })
    }

    /// All bands but these.
    fn others(&self, bands: &[usize]) -> Vec<usize> {
        (0..self.bands.len()).filter(|w| !bands.contains(w)).collect()
    }
}

/// A blackbody is read right at any temperature; one band says its brightness temperature, whatever the library; nothing else is said.
#[test]
fn a_grey_body_is_a_brightness_temperature() {
    let scene = Scene::new(&[&|nu| 0.5 + 0.3 * (nu / 50.0).sin(), &|_| 1.0]);
    let pixels = [scene.counts(1, 190.0, 0.0), scene.counts(1, 300.0, 0.0), scene.counts(0, 310.0, 0.4)];
    let maps = scene.found(Method::GreyBody, &pixels, &[]);
    for (found, k) in maps.temperature_k.iter().zip([190.0, 300.0]) {
        assert!((f64::from(*found) - k).abs() < 1e-4, "{found}");
    }
    assert!(maps.material.iter().all(|m| *m == NO_MATERIAL) && maps.candidates == [0; 3]);
    assert!(maps.temperature_sigma_k.iter().chain(&maps.p_value).chain(&maps.lighting).all(|x| x.is_nan()));
    // 190 K is no temperature of the targets.
    assert_eq!((maps.lighting.len(), &maps.flags), (3, &vec![flag::TEMPERATURE_AT_LIMIT, 0, 0]));
    let maps = scene.found(Method::GreyBody, &pixels, &scene.others(&[17]));
    let brightness = brightness_temperature(scene.bands.nodes_cm1()[17], pixels[2][17] / SCALE);
    assert!((f64::from(maps.temperature_k[2]) - brightness).abs() < 1e-4);
    // Less than any body sends, and a missing count.
    let mut missing = pixels[0].clone();
    missing[3] = f64::NAN;
    let maps = scene.found(Method::GreyBody, &[vec![0.0; scene.bands.len()], missing], &[]);
    assert_eq!(maps.flags, [flag::TEMPERATURE_UNKNOWN, flag::SKIPPED]);
    assert!(maps.temperature_k.iter().all(|k| k.is_nan()));
}

/// Without light TE is right; with light one band of a grey material says B⁻¹(S/e), and many bands fit no material.
#[test]
fn te_takes_scattered_light_for_emission() {
    let scene = Scene::new(&[&|nu| 0.7 + 0.2 * (nu / 40.0).sin(), &|_| 0.5]);
    let dark = scene.counts(0, 305.0, 0.0);
    let lit = scene.counts(1, 290.0, 0.4);
    let maps = scene.found(Method::Te, &[dark, lit.clone()], &[]);
    assert!(maps.material[0] == 0 && (f64::from(maps.temperature_k[0]) - 305.0).abs() < 1e-4);
    assert!(maps.flags[0] & flag::NO_FIT == 0 && maps.temperature_sigma_k[0] > 0.0);
    assert!(maps.flags[1] & flag::NO_FIT != 0);
    assert!(maps.lighting.len() == 2 && maps.lighting.iter().all(|v| v.is_nan()));
    let grey = Scene { library: vec![scene.library[1].clone()], ..scene };
    let maps = grey.found(Method::Te, std::slice::from_ref(&lit), &grey.others(&[9]));
    let expected = brightness_temperature(grey.bands.nodes_cm1()[9], lit[9] / SCALE / 0.5);
    assert!((f64::from(maps.temperature_k[0]) - expected).abs() < 1e-3, "{expected}");
}

/// Two bands: S46 has one solution, B̄(T) = ΔF/ΔG, and V is the weighted mean of S47, whatever the truth.
#[test]
fn inverse_functions_solve_s46_and_s47() {
    let scene = Scene::new(&[&|nu| if nu < 1000.0 { 0.5 } else { 0.8 }]);
    let pair = [19, 20];
    let counts = scene.counts(0, 300.0, 0.6);
    let maps = scene.found(Method::AnalyticInverse, std::slice::from_ref(&counts), &scene.others(&pair));
    let e = pair.map(|w| scene.library[0][w]);
    let signal = pair.map(|w| counts[w] / SCALE);
    let nu = pair.map(|w| scene.bands.nodes_cm1()[w]);
    let ratio =
        (signal[1] / (1.0 - e[1]) - signal[0] / (1.0 - e[0])) / (e[1] / (1.0 - e[1]) - e[0] / (1.0 - e[0]));
    let found = f64::from(maps.temperature_k[0]);
    let mean = 0.5 * (photon_radiance(nu[0], found) + photon_radiance(nu[1], found));
    assert!((mean / ratio - 1.0).abs() < 1e-6, "{found}: {mean} {ratio}");
    // S46 leaves out the slopes of B and of the light: not the truth.
    assert!((found - 300.0).abs() > 0.5 && maps.flags[0] == 0 && maps.temperature_sigma_k[0].is_nan());
    let (mut along, mut square) = (0.0, 0.0);
    for i in 0..2 {
        let light = (1.0 - e[i]) * photon_radiance(nu[i], AMBIENT_K);
        along += light * (signal[i] - e[i] * photon_radiance(nu[i], found)) / signal[i];
        square += light * light / signal[i];
    }
    assert!((f64::from(maps.lighting[0]) / (along / square) - 1.0).abs() < 1e-5);
    // A grey material has no slope, a black one no S46: nothing is said of them.
    for e in [0.5, 1.0] {
        let grey = Scene::new(&[&|_| e]);
        let maps = grey.found(Method::AnalyticInverse, &[grey.counts(0, 300.0, 0.6)], &[]);
        assert_eq!((maps.material[0], maps.flags[0]), (NO_MATERIAL, flag::TEMPERATURE_UNKNOWN));
        assert!(maps.temperature_k[0].is_nan());
    }
    // An unknown gain is refused.
    let shape = Shape::new(1, 1, scene.bands.len()).unwrap();
    let cube = Cube::F64(Box::new(MemoryCube::new(shape, counts).unwrap()));
    for method in [Method::AnalyticInverse, Method::GreyBody] {
        let error = scene.with(&[], |setting| {
            let setting = Setting { gain: true, ..*setting };
            decompose_by(method, &setting, &Options::default(), &cube, &|_| ()).unwrap_err().to_string()
        });
        assert!(error.contains(&format!("an unknown gain and the method {}", method.name())), "{error}");
    }
}

/// Bias and deviation by first order against 4000 drawn spectra: the deviation of their deviation is 1.1 %, of their mean 1.6 % of it.
#[test]
fn errors_of_the_inverse_functions_are_those_of_drawn_counts() {
    use rand::SeedableRng;
    use rand_distr::{Distribution, Poisson};
    let scene = Scene::new(&[&|nu| 0.6 + 0.3 * (nu / 12.0).sin()]);
    let (temperature_k, v) = (300.0, 0.7);
    let mean = scene.counts(0, temperature_k, v);
    let mut random = rand::rngs::ChaCha8Rng::seed_from_u64(46);
    let pixels: Vec<Vec<f64>> = (0..4000)
        .map(|_| mean.iter().map(|n| Poisson::new(*n).unwrap().sample(&mut random)).collect())
        .collect();
    let maps = scene.found(Method::AnalyticInverse, &pixels, &[]);
    let off: Vec<f64> = maps.temperature_k.iter().map(|k| f64::from(*k) - temperature_k).collect();
    let bias_k = off.iter().sum::<f64>() / 4000.0;
    let sigma_k = (off.iter().map(|x| (x - bias_k).powi(2)).sum::<f64>() / 3999.0).sqrt();
    let error = scene.with(&[], |setting| inverse_error(setting, 0, temperature_k, &[v]).unwrap());
    assert!((sigma_k / error.sigma_k - 1.0).abs() < 0.04, "{sigma_k} {error:?}");
    assert!((bias_k - error.bias_k).abs() < 0.02 * bias_k.abs() + 0.05 * sigma_k, "{bias_k} {error:?}");
    assert!(error.pair_sigma_k > error.sigma_k);
    // Noise of one pair alone, by the same draws.
    let single = scene.others(&[20, 21]);
    let alone = scene.with(&single, |setting| inverse_error(setting, 0, temperature_k, &[v]).unwrap());
    assert!((alone.pair_sigma_k / alone.sigma_k - 1.0).abs() < 1e-12);
    // Bad questions.
    let message = |m: usize, lighting: &[f64]| {
        scene.with(&[], |setting| inverse_error(setting, m, 300.0, lighting).unwrap_err().to_string())
    };
    assert!(message(1, &[0.5]).contains("material 1 of 1") && message(0, &[]).contains("lighting factors"));
}
