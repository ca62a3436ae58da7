//! Textures distilled from cubes drawn of the model: closed forms, coverage of the deviations, what a residue is worth.

use hadar::cube::{Cube, MemoryCube, Shape};
use hadar::planck::photon_radiance;
use hadar::spectrum::Bands;
use hadar::statistics::Statistics;
use hadar_estimate::decompose::{
    Distilled, Light, Maps, Options, Setting, Sky, decompose, distil, texture_information,
};
use hadar_simulate::draws::{Draws, generator};
use rand::RngExt;

const COLUMNS: usize = 60;
const ROWS: usize = 50;

/// Two materials under a sky with lines and a black ground.
struct Scene {
    bands: Bands,
    library: Vec<Vec<f64>>,
    lights: Vec<Light>,
    kappa: Vec<f64>,
}

impl Scene {
    fn new(photons: f64) -> Self {
        let bands = Bands::uniform(720.0, 1250.0, 10.0).unwrap();
        let nodes = bands.nodes_cm1().to_vec();
        let of = |f: &dyn Fn(f64) -> f64| nodes.iter().map(|nu| f(*nu)).collect::<Vec<f64>>();
        let library = vec![
            of(&|nu| 0.85 + 0.08 * (nu / 60.0).sin()),
            of(&|nu| 0.6 + 0.2 * ((nu - 985.0) / 265.0) + 0.05 * (nu / 35.0).cos()),
        ];
        let sky = of(&|nu| (0.35 + 0.3 * (nu / 25.0).sin().powi(2)) * photon_radiance(nu, 270.0));
        let ground = of(&|nu| photon_radiance(nu, 285.0));
        let black: Vec<f64> = of(&|nu| photon_radiance(nu, 290.0));
        let kappa = photons / bands.weigh(&black).iter().sum::<f64>();
        let kappa = vec![kappa; bands.len()];
        Self { library, lights: vec![Light::Radiance(sky), Light::Radiance(ground)], kappa, bands }
    }

    fn setting(&self) -> Setting<'_> {
        Setting {
            bands: &self.bands,
            library: &self.library,
            surroundings: &self.lights,
            counts_per_radiance: &self.kappa,
            var_added: &[],
            units_per_count: 1.0,
            temperature_k: [250.0, 340.0],
            lighting_total: Some(1.0),
            gain: false,
            bad_bands: &[],
            path: None,
            light_besides: &[],
        }
    }

    fn light(&self, k: usize) -> &[f64] {
        match &self.lights[k] {
            Light::Radiance(light) | Light::Counts(light) => light,
        }
    }

    /// Light of the sky over all bands.
    fn sky(&self) -> f64 {
        self.bands.weigh(self.light(0)).iter().sum()
    }

    /// Mean counts, with `more` light on the surface at each node.
    fn means(&self, m: usize, kelvin: f64, v: f64, more: &dyn Fn(usize) -> f64) -> Vec<f64> {
        let signal = self.bands.nodes_cm1().iter().enumerate().map(|(w, nu)| {
            let e = self.library[m][w];
            let light = v * self.light(0)[w] + (1.0 - v) * self.light(1)[w] + more(w);
            e * photon_radiance(*nu, kelvin) + (1.0 - e) * light
        });
        self.bands.weigh(&signal.collect::<Vec<_>>()).iter().zip(&self.kappa).map(|(s, k)| s * k).collect()
    }
}

fn drawn(means: Vec<Vec<f64>>, seed: u64) -> Cube {
    let bands = means[0].len();
    let mut counts = means.concat();
    for (i, pixel) in counts.chunks_mut(bands).enumerate() {
        let draws = Draws::new(&Statistics::Poisson, pixel).unwrap();
        draws.draw_into(&mut generator(seed, i as u64), pixel);
    }
    Cube::F64(Box::new(MemoryCube::new(Shape::new(ROWS, COLUMNS, bands).unwrap(), counts).unwrap()))
}

fn distilled(scene: &Scene, cube: &Cube, shown_by: &[Vec<usize>]) -> (Maps, Distilled) {
    let setting = scene.setting();
    let maps = decompose(&setting, &Options::default(), cube, &|_| ()).unwrap();
    let found = distil(&setting, &maps, cube, Sky { place: 0, shown_by }).unwrap();
    (maps, found)
}

fn rms(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(s, n), x| (x.mul_add(x, s), n + 1.0));
    f64::sqrt(sum / count)
}

/// Where the model is right the texture is V S_sky within its deviation, and hardly any residue is added. Of 3000 pixels the share
/// within 1.96 σ is off by 3 of its deviations (0.012) once in 400 seeds; this seed is fixed.
#[test]
fn deviations_hold_where_the_model_is_right() {
    let scene = Scene::new(3e7);
    let mut random = generator(5, 1 << 40);
    let (mut truth, mut means) = (Vec::new(), Vec::new());
    for _ in 0..ROWS * COLUMNS {
        // Away from the ends of its range, which cut estimates off.
        let v = random.random_range(0.3..0.7);
        truth.push(v * scene.sky());
        means.push(scene.means(random.random_range(0..2), random.random_range(280.0..300.0), v, &|_| 0.0));
    }
    let (maps, found) = distilled(&scene, &drawn(means, 5), &[vec![], vec![]]);
    assert!(maps.material.iter().all(|m| *m < 2));
    let off = |i: usize| (f64::from(found.texture[i]) - truth[i]) / f64::from(found.sigma[i]);
    let covered = (0..truth.len()).filter(|i| off(*i).abs() < 1.96).count() as f64 / truth.len() as f64;
    assert!((covered - 0.95).abs() < 0.012, "{covered}");
    assert!((rms((0..truth.len()).map(off)) - 1.0).abs() < 0.04);
    for of in &found.residues {
        assert!(of.light < 0.15 * of.noise, "{of:?}");
    }
    let of_model = (0..truth.len()).map(|i| f64::from(found.of_model[i]) / truth[i] - 1.0);
    let whole = (0..truth.len()).map(|i| f64::from(found.with_all_residue[i]) / truth[i] - 1.0);
    assert!(rms(whole) > rms(of_model), "a residue that is noise is worth nothing");
}

/// Light that the model lacks and that comes and goes in single bands is found in the residue: the fusion is nearer to it than the model
/// alone, and than with all of the residue, and its deviations hold.
#[test]
fn a_residue_is_taken_as_far_as_it_is_light() {
    let scene = Scene::new(1e7);
    let mut random = generator(6, 1 << 40);
    let (mut truth, mut means) = (Vec::new(), Vec::new());
    let strength = 0.03 * scene.light(0)[20];
    for _ in 0..ROWS * COLUMNS {
        let v = random.random_range(0.3..0.7);
        // In a third of the bands only: the others are noise.
        let more: Vec<f64> = (0..54)
            .map(|w| if w % 3 == 0 { strength * random.random_range(-1.7..1.7) } else { 0.0 })
            .collect();
        truth.push(v * scene.sky() + scene.bands.weigh(&more).iter().sum::<f64>());
        let kelvin = random.random_range(280.0..300.0);
        means.push(scene.means(1, kelvin, v, &|w| more[w]));
    }
    let (_, found) = distilled(&scene, &drawn(means, 6), &[vec![], vec![]]);
    let error = |of: &[f32]| rms(of.iter().zip(&truth).map(|(x, truth)| f64::from(*x) - truth));
    let [fused, alone, whole] = [&found.texture, &found.of_model, &found.with_all_residue].map(|x| error(x));
    assert!(fused < 0.97 * alone && fused < 0.97 * whole, "{fused} {alone} {whole}");
    let over =
        rms((0..truth.len()).map(|i| (f64::from(found.texture[i]) - truth[i]) / f64::from(found.sigma[i])));
    assert!((over - 1.0).abs() < 0.1, "{over}");
}

/// A ground that lights its own walls: S̄ = (1 − e)[V S_sky + (1 − V) S̄], so that X̄ = V S_sky/[1 − (1 − V)(1 − e)] in each band.
#[test]
fn scatterings_sum_up_to_their_closed_form() {
    let scene = Scene::new(1e9);
    let v = 0.4;
    let means = vec![scene.means(1, 288.0, v, &|_| 0.0); ROWS * COLUMNS];
    let (_, found) = distilled(&scene, &drawn(means, 7), &[vec![], (0..ROWS * COLUMNS).collect()]);
    let closed = scene
        .bands
        .nodes_cm1()
        .iter()
        .enumerate()
        .map(|(w, _)| v * scene.light(0)[w] / (1.0 - (1.0 - v) * (1.0 - scene.library[1][w])));
    let closed: f64 = scene.bands.weigh(&closed.collect::<Vec<_>>()).iter().sum();
    let mean = found.of_model.iter().map(|x| f64::from(*x)).sum::<f64>() / found.of_model.len() as f64;
    assert!((mean / closed - 1.0).abs() < 1e-3, "{mean} {closed}");
    // Once only it would be V S_sky.
    assert!(closed > 1.1 * v * scene.sky() && found.scatterings > 3);
}

/// Nothing that is computed from a cube tells more of a place than the cube, and what is left of temperature and lighting together is
/// at least as much as of each of them; of two bands and two unknowns it is all.
#[test]
fn no_reading_tells_more_than_the_cube() {
    let scene = Scene::new(1e7);
    let mut random = generator(8, 1 << 40);
    let means: Vec<Vec<f64>> = (0..ROWS * COLUMNS)
        .map(|_| {
            let (m, v) = (random.random_range(0..2), random.random_range(0.1..0.9));
            scene.means(m, random.random_range(280.0..300.0), v, &|_| 0.0)
        })
        .collect();
    let (maps, found) = distilled(&scene, &drawn(means.clone(), 8), &[vec![], vec![]]);
    let shape = Shape::new(ROWS, COLUMNS, 54).unwrap();
    let expected = Cube::F64(Box::new(MemoryCube::new(shape, means.concat()).unwrap()));
    let of = texture_information(&scene.setting(), &maps, &expected, &found).unwrap();
    let mut told = 0;
    for i in 0..ROWS * COLUMNS {
        let most = of.cube[i] * (1.0 + 1e-9);
        let less = [of.thermal[i], of.together[i], of.distilled[i]];
        assert!(less.iter().all(|j| *j <= most), "{i}: {less:?} {most}");
        assert!(of.temperature[i].max(of.texture[i]) <= of.together[i] * (1.0 + 1e-9) + 1e-12);
        told += usize::from(of.texture[i] > 0.01 * of.cube[i]);
    }
    assert!(told > 100);
    let two: Vec<usize> = (0..54).filter(|w| ![10, 40].contains(w)).collect();
    let setting = Setting { bad_bands: &two, ..scene.setting() };
    let found = distil(&setting, &maps, &expected, Sky { place: 0, shown_by: &[vec![], vec![]] }).unwrap();
    let of = texture_information(&setting, &maps, &expected, &found).unwrap();
    let seen = (0..ROWS * COLUMNS).filter(|i| of.cube[*i] > 0.0 && maps.temperature_k[*i].is_finite());
    for i in seen.filter(|i| maps.lighting[2 * i].is_finite()) {
        assert!((of.together[i] / of.cube[i] - 1.0).abs() < 1e-6, "{i}: {} {}", of.together[i], of.cube[i]);
    }
}

#[test]
fn mistakes_are_named() {
    let scene = Scene::new(1e6);
    let cube = drawn(vec![scene.means(0, 290.0, 0.5, &|_| 0.0); ROWS * COLUMNS], 9);
    let setting = scene.setting();
    let maps = decompose(&setting, &Options::default(), &cube, &|_| ()).unwrap();
    let none = vec![vec![], vec![]];
    let said = |setting: &Setting<'_>, place: usize, shown_by: &[Vec<usize>]| {
        distil(setting, &maps, &cube, Sky { place, shown_by }).unwrap_err().to_string()
    };
    assert!(said(&setting, 2, &none).starts_with("surroundings 2 as the sky"));
    assert!(
        said(&setting, 0, &none[..1]).starts_with("lists of pixels that show the surroundings: 1 values")
    );
    assert!(said(&setting, 0, &[vec![], vec![3000]]).contains("pixel 3000 of 3000"));
    let short = Maps { temperature_k: vec![290.0], ..maps.clone() };
    let error = distil(&setting, &short, &cube, Sky { place: 0, shown_by: &none }).unwrap_err().to_string();
    assert!(error.starts_with("temperatures of the maps: 1 values"), "{error}");
    let found = distil(&setting, &maps, &cube, Sky { place: 0, shown_by: &none }).unwrap();
    let dark = Setting { surroundings: &[], lighting_total: None, ..setting };
    let error = texture_information(&dark, &maps, &cube, &found).unwrap_err().to_string();
    assert!(error.starts_with("lighting factors: 6000 values where 0 are needed"), "{error}");
    assert!(said(&Setting { gain: true, ..setting }, 0, &none).contains("calibrate the camera"));
}
