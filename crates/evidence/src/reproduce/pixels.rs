//! Pixels of a street at night, drawn here: materials of the library under a clear winter sky and above a ground, S48.
//!
//! S = e(m)·B(T) + (1 − e)·[V S_sky + (1 − V) S_ground]: sky of the model atmosphere midlatitude winter over air of 272.2 K, ground a
//! blackbody of 5 °C; T from 270 to 310 K and V from 0 to 1, uniform and independent; 54 bands from 720 to 1250 cm⁻¹, shot noise.
//! Photons of a pixel are those that a blackbody of 290 K sends in all bands.

use hadar::cube::{Cube, MemoryCube, Shape};
use hadar::error::Result;
use hadar::fisher::precision::PrecisionSolver;
use hadar::fisher::{Counting, Nuisance, Unknowns};
use hadar::identifiability::nearest::StateRange;
use hadar::material::Library;
use hadar::planck::photon_radiance;
use hadar::scene::{EnvironmentObject, Parameter, State, Surroundings};
use hadar::spectrum::Bands;
use hadar::statistics::Statistics;
use hadar_estimate::decompose::{Light, Maps, Method, Options, Setting, decompose_by};
use hadar_estimate::separation::{Asked, Found, library_from_cube};
use hadar_simulate::draws::{Draws, generator};
use rand::RngExt;
use rayon::prelude::*;

/// Materials of a street.
const STREET: [&str; 20] = [
    "aluminium",
    "aluminium-rough",
    "asphalt",
    "brass-rough",
    "brick-red",
    "calcium-sulphate",
    "cinderblock",
    "concrete",
    "marble",
    "paint-matt-black",
    "pmma",
    "pvc-tape",
    "rubber-tyre",
    "sand-quartz",
    "slate",
    "soda-lime-glass",
    "soil-loam",
    "steel-rough",
    "vegetation-leaf",
    "water",
];
const SKY: (&str, f64) = ("sky-midlatitude-winter", 272.2);
const GROUND_K: f64 = 278.15;
/// Temperatures that are drawn, and those that a decomposition may find, K.
const DRAWN_K: [f64; 2] = [270.0, 310.0];
pub(super) const RANGE_K: [f64; 2] = [250.0, 340.0];
/// Temperature of the blackbody that photons are told by, K.
const BLACK_K: f64 = 290.0;

/// Materials, surroundings and bands.
pub(super) struct Street {
    pub(super) bands: Bands,
    pub(super) names: Vec<&'static str>,
    /// Emissivities at the nodes of the bands, one node each.
    pub(super) library: Vec<Vec<f64>>,
    pub(super) surroundings: Surroundings,
    lights: Vec<Light>,
}

/// What a pixel is.
#[derive(Debug, Clone)]
pub(super) struct Pixel {
    pub(super) material: usize,
    pub(super) state: State,
}

impl Street {
    pub(super) fn new(library: &Library) -> Result<Self> {
        Self::of(library, &STREET)
    }

    /// The same with other materials.
    pub(super) fn of(library: &Library, names: &[&'static str]) -> Result<Self> {
        let bands = Bands::uniform(720.0, 1250.0, 10.0)?;
        let nodes = bands.nodes_cm1();
        let emissivity = |name: &str| library.get(name)?.emissivity(nodes);
        let sky = emissivity(SKY.0)?;
        let radiance = |e: &dyn Fn(usize) -> f64, temperature_k: f64| {
            let each = nodes.iter().enumerate().map(|(w, nu)| e(w) * photon_radiance(*nu, temperature_k));
            Light::Radiance(each.collect())
        };
        let lights = vec![radiance(&|w| sky[w], SKY.1), radiance(&|_| 1.0, GROUND_K)];
        let objects = vec![
            EnvironmentObject { temperature_k: SKY.1, emissivity: Some(sky) },
            EnvironmentObject { temperature_k: GROUND_K, emissivity: None },
        ];
        Ok(Self {
            surroundings: Surroundings::new(nodes, objects)?,
            library: names.iter().map(|name| emissivity(name)).collect::<Result<_>>()?,
            names: names.to_vec(),
            lights,
            bands,
        })
    }

    /// Pixels of random material, temperature and lighting.
    pub(super) fn pixels(&self, count: usize, seed: u64) -> Result<Vec<Pixel>> {
        let mut random = generator(seed, 0);
        let one = |_| {
            let material = random.random_range(0..self.library.len());
            let temperature_k = random.random_range(DRAWN_K[0]..DRAWN_K[1]);
            let v = random.random_range(0.0..1.0);
            Ok(Pixel { material, state: self.surroundings.state(temperature_k, &[v, 1.0 - v])? })
        };
        (0..count).map(one).collect()
    }

    /// Counts for each unit of band signal at so many photons of a pixel, m² sr s.
    pub(super) fn counts_per_radiance(&self, photons: f64) -> f64 {
        let black: Vec<f64> = self.bands.nodes_cm1().iter().map(|nu| photon_radiance(*nu, BLACK_K)).collect();
        photons / self.bands.weigh(&black).iter().sum::<f64>()
    }

    pub(super) fn counting(&self, photons: f64) -> Counting {
        Counting { counts_per_radiance: self.counts_per_radiance(photons), var_added: Vec::new() }
    }

    /// Mean counts of a pixel in each band.
    pub(super) fn means(&self, pixel: &Pixel, photons: f64) -> Vec<f64> {
        let Pixel { material, state } = pixel;
        self.counts_of(&self.library[*material], state.temperature_k, &state.lighting, photons)
    }

    /// Counts of all pixels, one after the other, each of its own stream of random numbers from `stream` on.
    pub(super) fn drawn(&self, pixels: &[Pixel], photons: f64, seed: u64, stream: u64) -> Result<Vec<f64>> {
        let one = |(i, pixel): (usize, &Pixel)| {
            let draws = Draws::new(&Statistics::Poisson, &self.means(pixel, photons))?;
            let mut counts = vec![0.0; self.bands.len()];
            draws.draw_into(&mut generator(seed, stream + i as u64), &mut counts);
            Ok(counts)
        };
        Ok(pixels.par_iter().enumerate().map(one).collect::<Result<Vec<_>>>()?.concat())
    }

    /// Mean counts of an emissivity at a temperature under any lighting factors, within their range or not.
    pub(super) fn counts_of(
        &self,
        emissivity: &[f64],
        temperature_k: f64,
        lighting: &[f64],
        photons: f64,
    ) -> Vec<f64> {
        let scale = self.counts_per_radiance(photons);
        let nodes = self.bands.nodes_cm1();
        let signal = nodes.iter().zip(emissivity).enumerate().map(|(w, (nu, e))| {
            let light = |(light, v): (&Light, &f64)| match light {
                Light::Radiance(radiance) | Light::Counts(radiance) => v * radiance[w],
            };
            let scattered: f64 = self.lights.iter().zip(lighting).map(light).sum();
            e * photon_radiance(*nu, temperature_k) + (1.0 - e) * scattered
        });
        self.bands.weigh(&signal.collect::<Vec<_>>()).iter().map(|s| scale * s).collect()
    }

    /// Mean counts of a material at a temperature (any where it is NaN), under the lighting that is nearest to counts of a pixel.
    pub(super) fn lit_best(
        &self,
        emissivity: &[f64],
        temperature_k: f64,
        counts: &[f64],
        photons: f64,
    ) -> Vec<f64> {
        let temperature_k = if temperature_k.is_finite() { temperature_k } else { BLACK_K };
        let under = |v: f64| self.counts_of(emissivity, temperature_k, &[v, 1.0 - v], photons);
        let (ground, sky) = (under(0.0), under(1.0));
        let mut v = 0.5;
        // Weighted by what is expected there.
        for _ in 0..3 {
            let (mut along, mut square) = (0.0, 0.0);
            for ((a, b), n) in ground.iter().zip(&sky).zip(counts) {
                let weight = 1.0 / (a + v * (b - a));
                along += weight * (b - a) * (n - a);
                square += weight * (b - a) * (b - a);
            }
            v = if square > 0.0 { (along / square).clamp(0.0, 1.0) } else { 0.5 };
        }
        ground.iter().zip(&sky).map(|(a, b)| a + v * (b - a)).collect()
    }

    /// Counts decomposed by a library.
    pub(super) fn decomposed(
        &self,
        method: Method,
        library: &[Vec<f64>],
        counts: Vec<f64>,
        photons: f64,
    ) -> Result<Maps> {
        let per = vec![self.counts_per_radiance(photons); self.bands.len()];
        let (setting, cube) = (self.setting(library, &per), self.cube(counts)?);
        decompose_by(method, &setting, &Options::default(), &cube, &|_| ())
    }

    /// A library made of counts alone.
    pub(super) fn library_of(&self, asked: &Asked, counts: Vec<f64>, photons: f64) -> Result<Found> {
        let per = vec![self.counts_per_radiance(photons); self.bands.len()];
        let (setting, cube) = (self.setting(&[], &per), self.cube(counts)?);
        library_from_cube(&setting, asked, &cube, &|_| ())
    }

    fn cube(&self, counts: Vec<f64>) -> Result<Cube> {
        let shape = Shape::new(1, counts.len() / self.bands.len(), self.bands.len())?;
        Ok(Cube::F64(Box::new(MemoryCube::new(shape, counts)?)))
    }

    fn setting<'a>(&'a self, library: &'a [Vec<f64>], counts_per_radiance: &'a [f64]) -> Setting<'a> {
        Setting {
            bands: &self.bands,
            library,
            surroundings: &self.lights,
            counts_per_radiance,
            var_added: &[],
            units_per_count: 1.0,
            temperature_k: RANGE_K,
            lighting_total: Some(1.0),
            gain: false,
            bad_bands: &[],
            path: None,
            light_besides: &[],
        }
    }

    /// Temperatures of the pixels, K, with their material known to the method.
    pub(super) fn temperatures_of_known(
        &self,
        method: Method,
        pixels: &[Pixel],
        counts: &[f64],
        photons: f64,
    ) -> Result<Vec<f64>> {
        let mut temperatures = vec![f64::NAN; pixels.len()];
        for (m, emissivity) in self.library.iter().enumerate() {
            let own: Vec<usize> = (0..pixels.len()).filter(|i| pixels[*i].material == m).collect();
            if own.is_empty() {
                continue;
            }
            let spectra: Vec<&[f64]> = counts.chunks(self.bands.len()).collect();
            let chosen: Vec<f64> = own.iter().flat_map(|i| spectra[*i]).copied().collect();
            let maps = self.decomposed(method, std::slice::from_ref(emissivity), chosen, photons)?;
            own.iter().zip(&maps.temperature_k).for_each(|(i, k)| temperatures[*i] = f64::from(*k));
        }
        Ok(temperatures)
    }

    pub(super) fn unknowns(&self) -> Result<Unknowns> {
        Unknowns::new([Nuisance::Temperature, Nuisance::Lighting])?.lighting_total(Some(1.0))
    }

    pub(super) fn range(&self) -> StateRange {
        StateRange { temperature_k: RANGE_K, ..StateRange::default() }
    }

    /// Cramér–Rao bound of the temperature of every pixel, its material known, K.
    pub(super) fn bounds_k(&self, pixels: &[Pixel], photons: f64) -> Result<Vec<f64>> {
        let (unknowns, counting) = (self.unknowns()?, self.counting(photons));
        let solver = || PrecisionSolver::new(&self.bands, &self.surroundings, unknowns.clone());
        let one = |solver: &mut PrecisionSolver<'_>, pixel: &Pixel| {
            let emissivity = &self.library[pixel.material];
            solver.bound(emissivity, &pixel.state, &counting, Parameter::Temperature).map(|found| found.sigma)
        };
        pixels.par_iter().map_init(solver, one).collect()
    }
}

/// Root mean square of what is finite.
pub(super) fn rms(values: impl Iterator<Item = f64>) -> f64 {
    let finite = values.filter(|x| x.is_finite());
    let (sum, count) = finite.fold((0.0, 0.0), |(sum, count), x| (x.mul_add(x, sum), count + 1.0));
    f64::sqrt(sum / count)
}

/// Pearson's χ² of counts for each band.
pub(super) fn loss(counts: &[f64], means: &[f64]) -> f64 {
    let each = counts.iter().zip(means).map(|(n, mean)| (n - mean).powi(2) / mean);
    each.sum::<f64>() / counts.len() as f64
}
