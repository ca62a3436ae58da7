//! A yard at night with rough surfaces, rendered as a pair of heat cubes, once more with only the sky on, and taken apart.
//!
//! What is true of it is known: material, temperature, lighting and depth of every pixel, and X̄, the light of the sky alone, from a second
//! rendering in which everything but the sky is at 3 K and sends nothing, scatterings included.

use hadar::cube::{Cube, MemoryCube, Shape};
use hadar::error::{Error, Result};
use hadar::material::Library;
use hadar::planck::{photon_radiance, photon_radiance_slope};
use hadar_estimate::decompose::{
    Distilled, Light, Maps, NO_MATERIAL, Options, Setting, Sky, decompose, distil,
};
use hadar_scenario::RenderScenario;
use hadar_scenario::scene::{Form, SurfaceSpec};
use hadar_study::range;
use hadar_study::render::{Picture, RenderPlan, RenderStudy, Rendered};

/// Exposure of the yard, as it stands there.
pub(super) const EXPOSURE: &str = "200 us";
/// What sends nothing, K.
const DARK_K: f64 = 3.0;
/// Temperatures that a decomposition may find, K.
const RANGE_K: [f64; 2] = [250.0, 340.0];
/// The sky is the first of the surroundings of a rendering, the ground the second.
pub(super) const SKY: usize = 0;
const GROUND: usize = 1;
const GROUND_K: f64 = 285.15;
/// Of the yard: distance of the cameras, m, and focal length over pixel.
const BASELINE_M: f64 = 0.2;
const FOCAL_PX: f64 = 14e-3 / 28e-6;

/// The yard.
const YARD: &str = r#"title = "A yard at night: rough ground, a wall of bricks, a car, a person"

[scene]
sky = { material = "sky-us-standard", temperature = "288 K" }
ground = { material = "asphalt", temperature = "12 degC", variation = "0.05 K", variation_size = "1 m", roughness = 0.4, roughness_size = "0.25 m" }
size = [200, 280]
library = ["fabric", "concrete", "steel-rough", "soda-lime-glass", "grass-dry", "marble"]

[[object]]
shape = "person"
material = "skin"
temperature = "33 degC"
variation = "0.5 K"
at = ["-1.3 m", "7 m"]
roughness = 0.3

[[object]]
shape = "car"
material = "pmma"
temperature = "25 degC"
variation = "0.3 K"
tyres = { material = "rubber-tyre", temperature = "20 degC" }
at = ["1.5 m", "9 m"]
roughness = 0.1

[[object]]
shape = "block"
name = "wall"
material = "brick-red"
temperature = "14 degC"
variation = "0.05 K"
variation_size = "1 m"
size = ["0.3 m", "9 m", "1.6 m"]
at = ["0 m", "15 m"]
roughness = 0.4
roughness_size = "0.3 m"

[bands]
start = "720 cm^-1"
stop = "1250 cm^-1"
step = "10 cm^-1"

[camera]
exposure = "200 us"
pixel = "28 um"
f_number = 1.4
focal_length = "14 mm"
noise_electrons = 0

[stereo]
baseline = "0.2 m"
"#;

/// A pair of cubes with all that is true of them.
pub(super) struct Textured {
    /// ΣVₖ as it is told.
    pub(super) lighting_total: Option<f64>,
    pub(super) scenario: RenderScenario,
    pub(super) shape: Shape,
    /// Expected counts with all of the truth, and as drawn.
    pub(super) expected: Rendered,
    pub(super) drawn: Rendered,
    lights: Vec<Light>,
    kappa: Vec<f64>,
    /// Distance of the cameras, m, and focal length, pixels.
    pub(super) baseline_m: f64,
    pub(super) focal_px: f64,
    /// Width of all bands, cm⁻¹.
    pub(super) width_cm1: f64,
}

impl Textured {
    /// The yard at an exposure, drawn with a seed.
    pub(super) fn new(exposure: &str, seed: u64) -> Result<Self> {
        let toml = YARD.replace(EXPOSURE, exposure);
        let library = Library::embedded()?;
        let scenario = RenderScenario::from_toml(&toml, None)?;
        let render = |scenario: &RenderScenario, seed: Option<u64>| {
            RenderStudy::new(scenario, &library)?.render(RenderPlan { seed }, &|_, _| ())
        };
        let expected = render(&scenario, None)?;
        let drawn = render(&scenario, Some(seed))?;
        Ok(Self {
            lighting_total: Some(1.0),
            shape: expected.shape,
            lights: expected.radiances.iter().cloned().map(Light::Radiance).collect(),
            kappa: vec![expected.counts_per_radiance; expected.shape.bands()],
            width_cm1: expected.bands.widths_cm1().iter().sum(),
            baseline_m: BASELINE_M,
            focal_px: FOCAL_PX,
            scenario,
            expected,
            drawn,
        })
    }

    /// Light of the sky alone on the left view, X̄, by a rendering with nothing else on.
    pub(super) fn light_of_sky(&self) -> Result<Vec<f64>> {
        let dark = with_only_the_sky(&self.scenario);
        let study = RenderStudy::new(&dark, &Library::embedded()?)?;
        let found = study.render(RenderPlan { seed: None }, &|_, _| ())?;
        Ok(found.views.first().map_or_else(Vec::new, |view| self.light(view)))
    }

    pub(super) fn pixels(&self) -> usize {
        self.shape.rows() * self.shape.columns()
    }

    /// What is known when so many of the surroundings are, the sky and the ground first.
    pub(super) fn setting(&self, surroundings: usize) -> Setting<'_> {
        Setting {
            bands: &self.expected.bands,
            library: &self.expected.emissivities,
            surroundings: &self.lights[..surroundings.min(self.lights.len())],
            counts_per_radiance: &self.kappa,
            var_added: &self.expected.var_added,
            units_per_count: 1.0,
            temperature_k: RANGE_K,
            lighting_total: self.lighting_total,
            gain: false,
            bad_bands: &[],
            path: None,
            light_besides: &[],
        }
    }

    /// Counts of a view as a cube.
    pub(super) fn cube(&self, picture: &Picture) -> Result<Cube> {
        Ok(Cube::F32(Box::new(MemoryCube::new(self.shape, picture.counts.clone())?)))
    }

    /// A view taken apart, and its distilled texture, when so many of the surroundings are known.
    pub(super) fn apart(&self, picture: &Picture, surroundings: usize) -> Result<(Maps, Distilled)> {
        let (setting, cube) = (self.setting(surroundings), self.cube(picture)?);
        let maps = decompose(&setting, &Options::default(), &cube, &|_| ())?;
        let distilled = self.distilled(&maps, &cube, surroundings)?;
        Ok((maps, distilled))
    }

    /// The texture distilled of a view in a state.
    pub(super) fn distilled(&self, maps: &Maps, cube: &Cube, surroundings: usize) -> Result<Distilled> {
        let own = |k: usize| -> Vec<usize> {
            let name = self.expected.surroundings.get(k);
            let material = self.material_of(name.map_or("", String::as_str));
            (0..maps.material.len()).filter(|i| Some(maps.material[*i]) == material).collect()
        };
        let shown_by: Vec<Vec<usize>> =
            (0..surroundings).map(|k| if k == SKY { Vec::new() } else { own(k) }).collect();
        distil(&self.setting(surroundings), maps, cube, Sky { place: SKY, shown_by: &shown_by })
    }

    /// How many of the surroundings are known: all that light anything.
    pub(super) fn all(&self) -> usize {
        self.lights.len()
    }

    /// Place of the material of a surface.
    fn material_of(&self, surface: &str) -> Option<u16> {
        let row = self.expected.surfaces.iter().find(|row| row.name == surface)?;
        let own = row.materials.first()?;
        let place = self.expected.materials.iter().position(|name| name == own)?;
        u16::try_from(place).ok()
    }

    /// Texture of the true light, photons s⁻¹ m⁻² sr⁻¹ over all bands; nothing in the sky.
    pub(super) fn light(&self, picture: &Picture) -> Vec<f64> {
        picture.incident.iter().map(|x| f64::from(*x) * self.width_cm1).collect()
    }

    /// Texture X of maps, photons s⁻¹ m⁻² sr⁻¹.
    pub(super) fn texture(&self, maps: &Maps) -> Vec<f64> {
        let sums: Vec<f64> = self
            .expected
            .radiances
            .iter()
            .map(|light| self.expected.bands.weigh(light).iter().sum())
            .collect();
        let of = |v: &[f32]| v.iter().zip(&sums).map(|(v, s)| f64::from(*v) * s).sum();
        maps.lighting.chunks(maps.lighting.len() / self.pixels()).map(of).collect()
    }

    /// Counts of all bands together.
    pub(super) fn thermal(&self, picture: &Picture) -> Vec<f64> {
        picture.counts.chunks(self.shape.bands()).map(|n| n.iter().map(|n| f64::from(*n)).sum()).collect()
    }

    /// Noise of a pixel in temperature, K: of all counts together on the ground.
    pub(super) fn netd_k(&self) -> f64 {
        let ground = self.of_ground();
        let counts = self.thermal(self.left());
        let mean = median(counts.iter().zip(&ground).filter(|(_, own)| **own).map(|(n, _)| *n));
        let nodes = self.expected.bands.nodes_cm1();
        let sums = [photon_radiance, photon_radiance_slope].map(|of| {
            let each: Vec<f64> = nodes.iter().map(|nu| of(*nu, GROUND_K)).collect();
            self.expected.bands.weigh(&each).iter().sum::<f64>()
        });
        let added: f64 = self.expected.var_added.iter().sum();
        (mean + added).sqrt() / mean * sums[0] / sums[1]
    }

    /// Pixels of one surface, one material.
    pub(super) fn pure(&self) -> Vec<bool> {
        self.left().material.iter().map(|m| *m != NO_MATERIAL).collect()
    }

    pub(super) fn left(&self) -> &Picture {
        &self.expected.views[0]
    }

    /// The right view.
    pub(super) fn right<'a>(&self, of: &'a Rendered) -> Result<&'a Picture> {
        of.views.get(1).ok_or_else(|| Error::malformed("a scene of one view", "write [stereo]"))
    }

    /// Disparity of a depth, pixels; 0 infinitely far away.
    pub(super) fn disparity_px(&self, depth_m: f64) -> f64 {
        self.baseline_m * self.focal_px / depth_m
    }

    /// Pixels of the ground alone.
    pub(super) fn of_ground(&self) -> Vec<bool> {
        let left = self.left();
        let own = |i: usize| left.material[i] != NO_MATERIAL && usize::from(left.surface[i]) == GROUND;
        (0..self.pixels()).map(own).collect()
    }
}

/// The same scene at 3 K under the same sky.
fn with_only_the_sky(scenario: &RenderScenario) -> RenderScenario {
    let mut dark = scenario.clone();
    let cool = |surface: &mut SurfaceSpec| {
        surface.temperature_k = DARK_K;
        surface.variation_k = 0.0;
    };
    if let Some(ground) = &mut dark.scene.ground {
        cool(&mut ground.surface);
    }
    for object in dark.scene.objects.iter_mut().flatten() {
        cool(&mut object.surface);
        if let Form::Car(_, Some(tyres)) = &mut object.form {
            cool(tyres);
        }
    }
    dark
}

/// Median of what is finite.
pub(super) fn median(values: impl Iterator<Item = f64>) -> f64 {
    range::median(&values.filter(|x| x.is_finite()).collect::<Vec<_>>())
}

/// Correlation of two images where both are finite.
pub(super) fn correlation(pairs: impl Iterator<Item = (f64, f64)>) -> f64 {
    let all: Vec<(f64, f64)> = pairs.filter(|(a, b)| a.is_finite() && b.is_finite()).collect();
    let n = all.len() as f64;
    let [a, b] = [all.iter().map(|p| p.0).sum::<f64>() / n, all.iter().map(|p| p.1).sum::<f64>() / n];
    let sum = |f: &dyn Fn(f64, f64) -> f64| all.iter().map(|p| f(p.0 - a, p.1 - b)).sum::<f64>();
    sum(&|x, y| x * y) / (sum(&|x, _| x * x) * sum(&|_, y| y * y)).sqrt()
}

/// Sums over windows of (2 half + 1)² pixels; NaN at the edges.
pub(super) fn window_sums(values: &[f64], shape: Shape, half: usize) -> Vec<f64> {
    let (rows, columns) = (shape.rows(), shape.columns());
    let along = |line: &dyn Fn(usize) -> f64, len: usize, at: usize| -> f64 {
        if at < half || at + half >= len { f64::NAN } else { (at - half..=at + half).map(line).sum() }
    };
    let wide: Vec<f64> = (0..rows * columns)
        .map(|i| along(&|x| values[i / columns * columns + x], columns, i % columns))
        .collect();
    (0..rows * columns).map(|i| along(&|y| wide[y * columns + i % columns], rows, i / columns)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_sum_what_is_in_them() {
        let shape = Shape::new(4, 5, 2).unwrap();
        let values: Vec<f64> = (0..20).map(f64::from).collect();
        let found = window_sums(&values, shape, 1);
        assert_eq!((found[6], found[13]), (54.0, 9.0 * 13.0));
        assert!(found[..6].iter().all(|x| x.is_nan()) && found[9].is_nan() && found[14].is_nan());
    }

    #[test]
    fn correlation_knows_gain_and_sign() {
        let pairs = |f: &dyn Fn(f64) -> f64| correlation((0..9).map(|i| (f64::from(i), f(f64::from(i)))));
        assert!((pairs(&|x| 3.0 - 2.0 * x) + 1.0).abs() < 1e-12);
        assert!(pairs(&|x| (x - 4.0).powi(2)).abs() < 1e-12);
        assert!((correlation([(1.0, 2.0), (f64::NAN, 0.0), (2.0, 3.0)].into_iter()) - 1.0).abs() < 1e-12);
    }
}
