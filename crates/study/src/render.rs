//! A scene rendered as a heat cube with all that is true of it, and the scenario that takes it apart again.
//!
//! A pixel that is one surface of one emissivity is S = e B(T) + (1 − e) Σₖ VₖSₖ exactly, with the spectra Sₖ that leave the surfaces:
//! sky, ground and the
//! two others that light any such pixel most are the surroundings of the decomposition.

use super::range::{Overfull, camera_noise};
use super::stage::{self, Staged};
use super::{Warning, bands, camera, camera_bands};
use crate::budget::Takes;
use hadar::cube::Shape;
use hadar::error::{Error, Result};
use hadar::fisher::Counting;
use hadar::instrument::{Camera, View as OpticalView};
use hadar::material::Library;
use hadar::order;
use hadar::parallel;
use hadar::ranging::noise::NoiseVariance;
use hadar::spectrum::Bands;
use hadar::statistics::Statistics;
use hadar_estimate::decompose::NO_MATERIAL;
use hadar_scenario::RenderScenario;
use hadar_simulate::draws::{Draws, generator};
use hadar_simulate::render::{Emissivity, Part, Rig, View};
use rand::Rng;
use rand_distr::{Distribution, StandardNormal};
use serde::Serialize;

/// Lighting below which a surface is none of the surroundings.
const DARK: f64 = 0.01;
/// Surroundings that a decomposition is given: with each further one more of what is measured goes into what lights a pixel.
const SURROUNDINGS: usize = 4;
/// Distance of the two cameras where there is one, m: what a picture alone does not depend on.
const BASELINE_M: f64 = 1e-3;

/// A scene with everything looked up.
pub struct RenderStudy {
    scenario: RenderScenario,
    camera: Camera,
    bands: Bands,
    staged: Staged,
    rig: Rig,
    counting: Counting,
    /// What each pixel counts for itself, without what rows and columns share.
    alone: Counting,
}

/// How a scene is rendered.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RenderPlan {
    /// Seed of the noise; expected counts without.
    pub seed: Option<u64>,
}

/// A scene rendered.
#[derive(Debug, Serialize)]
pub struct Rendered {
    /// The question as it was asked, defaults filled in.
    pub scenario: RenderScenario,
    /// Numbers of rows, columns and bands of the cube.
    pub shape: Shape,
    /// Names of the materials, in the order of their indices.
    pub materials: Vec<String>,
    /// Names of the surroundings, in the order of the layers of `lighting.npy`.
    pub surroundings: Vec<String>,
    /// The most that surfaces beyond these light a pixel with.
    pub lighting_left_out: f64,
    /// What the camera sees of each surface.
    pub surfaces: Vec<SurfaceRow>,
    /// Pixels of one surface and one material.
    pub pure: usize,
    /// Median of the expected counts of a sample.
    pub counts_median: f64,
    /// Variance of the electronic noise of a sample, median over the bands.
    pub noise_variance: f64,
    /// Seed of the noise; expected counts without.
    pub seed: Option<u64>,
    /// What the reader must know.
    pub warnings: Vec<Warning>,
    /// What is written of each view, the left one first.
    #[serde(skip)]
    pub views: Vec<Picture>,
    /// Wavenumbers of the bands, cm⁻¹.
    #[serde(skip)]
    pub wavenumbers_cm1: Vec<f64>,
    /// Emissivities of the materials at these.
    #[serde(skip)]
    pub emissivities: Vec<Vec<f64>>,
    /// The bands.
    #[serde(skip)]
    pub bands: Bands,
    /// Counts for each unit of a band's radiance, m² sr s.
    #[serde(skip)]
    pub counts_per_radiance: f64,
    /// Variance of the electronic noise of a sample of each band, counts².
    #[serde(skip)]
    pub var_added: Vec<f64>,
    /// Radiances of the surroundings at these, photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹.
    #[serde(skip)]
    pub radiances: Vec<Vec<f64>>,
}

/// What is seen of a surface.
#[derive(Debug, Clone, Serialize)]
pub struct SurfaceRow {
    /// Name of the surface in the scene.
    pub name: String,
    /// Its materials; none of the sky.
    pub materials: Vec<String>,
    /// Pixels whose centre it has.
    pub pixels: usize,
    /// Pixels that are nothing else.
    pub pure: usize,
    /// Mean temperature of these, K.
    pub temperature_k: f64,
    /// Least and largest depth, m; none of the sky.
    pub depth_m: Option<[f64; 2]>,
}

/// A view with its truth, `[row][column]` if nothing else is said.
#[derive(Debug, Default)]
pub struct Picture {
    /// Counts `[row][column][band]`.
    pub counts: Vec<f32>,
    /// Place of the material; [`NO_MATERIAL`] of sky and of mixed pixels.
    pub material: Vec<u16>,
    /// Temperature, K; NaN of sky and of mixed pixels.
    pub temperature_k: Vec<f32>,
    /// Lighting factors `[row][column][surroundings]`.
    pub lighting: Vec<f32>,
    /// X = ΣVS, mean over the bands, photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹.
    pub incident: Vec<f32>,
    /// Depth, m; infinite in the sky.
    pub depth_m: Vec<f32>,
    /// Place of the surface.
    pub surface: Vec<u8>,
}

impl RenderStudy {
    /// What it takes at least.
    #[must_use]
    pub fn takes(&self) -> Takes {
        Takes::of_samples([self.rig.rows, self.rig.columns, self.bands.len()])
    }

    /// Looks up everything that `scenario` names, materials in `library`.
    ///
    /// # Errors
    /// An unknown material or camera, a file that cannot be used; each with file, line and key.
    pub fn new(scenario: &RenderScenario, library: &Library) -> Result<Self> {
        let source = &scenario.source;
        let camera = camera::resolved(&scenario.camera, source)?;
        let mut scenario = scenario.clone();
        let asked = camera_bands::asked(&scenario.bands.source, Some((&camera, &scenario.camera)));
        let bands = bands::at_centres(&asked, source)?;
        camera_bands::check(&camera, &scenario.camera, &asked, &bands, &|key| scenario.place(key))?;
        scenario.bands.source = asked;
        let bands = camera.received(&bands);
        let place = |key: &str| scenario.place(key);
        let staged = stage::staged(&scenario.scene, &bands, library, &place)?;
        let baseline_m = scenario.stereo.as_ref().map_or(BASELINE_M, |stereo| stereo.baseline_m);
        let rig = stage::rig(&scenario.scene, &camera, baseline_m, &bands, &place)?;
        let counting = camera.counting(&bands, &OpticalView::default());
        let own = Camera { pattern: camera.pattern.of_pixels(), ..camera.clone() };
        let alone = own.counting(&bands, &OpticalView::default());
        let surfaces = || staged.scene.surfaces().iter().map(|surface| surface.name.as_str());
        for (i, category) in scenario.categories.iter().enumerate() {
            if let Some(j) = category.surfaces.iter().position(|one| surfaces().all(|name| name != one)) {
                let error = Error::unknown_name("surface", &category.surfaces[j], surfaces());
                return Err(error.at(scenario.place(&format!("category[{i}].surfaces[{j}]"))));
            }
        }
        let study = Self { scenario, camera, bands, staged, rig, counting, alone };
        let (materials, _) = study.materials();
        for (i, category) in study.scenario.categories.iter().enumerate() {
            let is_there = |one: &String| materials.iter().any(|(name, _)| name == one);
            if let Some(j) = category.materials.iter().position(|one| !is_there(one)) {
                let names = materials.iter().map(|(name, _)| name.as_str());
                let error = Error::unknown_name(
                    "material of the scene or of scene.library",
                    &category.materials[j],
                    names,
                );
                return Err(error.at(study.scenario.place(&format!("category[{i}].materials[{j}]"))));
            }
        }
        Ok(study)
    }

    /// Its camera.
    #[must_use]
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// Its bands, as the camera receives them.
    #[must_use]
    pub fn bands(&self) -> &Bands {
        &self.bands
    }

    /// What the camera counts of them.
    #[must_use]
    pub fn counting(&self) -> &Counting {
        &self.counting
    }

    /// Renders it; `progress` is told rows done, and how many there are.
    ///
    /// # Errors
    /// A scene that cannot be rendered: a camera inside an object.
    pub fn render(&self, plan: RenderPlan, progress: &(dyn Fn(usize, usize) + Sync)) -> Result<Rendered> {
        let at = |error: Error| error.at(self.scenario.place("scene"));
        let options = stage::options(&self.scenario.scene);
        let scene = &self.staged.scene;
        let (left, right) = match self.scenario.stereo {
            None => (scene.view(&self.rig, &self.bands, &options, progress).map_err(at)?, None),
            Some(_) => {
                let pair = scene.render(&self.rig, &self.bands, &options, progress).map_err(at)?;
                (pair.left, Some(pair.right))
            }
        };
        let (materials, places) = self.materials();
        let (chosen, lighting_left_out) = surroundings(&left, scene.surfaces().len());
        let views = std::iter::once(&left).chain(&right).enumerate();
        let views = views
            .map(|(side, view)| {
                self.picture(view, &places, &chosen, plan.seed.map(|seed| (seed, side as u64)))
            })
            .collect::<Result<Vec<_>>>()?;
        let bands = self.bands.len();
        let expected = left.cube(Part::Total, self.counting.counts_per_radiance)?;
        let mut sorted: Vec<f64> =
            expected.samples().iter().copied().step_by(1 + expected.samples().len() / 100_000).collect();
        sorted.sort_by(f64::total_cmp);
        let brightest =
            expected.samples().iter().copied().fold(0.0, f64::max) / f64::from(self.camera.frames);
        let mut warnings = Vec::new();
        warnings.extend(Overfull::of(brightest, &self.camera).map(Overfull::remark));
        let mut noise: Vec<f64> = (0..bands).map(|band| self.counting.var_added(band)).collect();
        noise.sort_by(f64::total_cmp);
        let nodes = self.bands.nodes_cm1();
        let named = |surface: usize| scene.surfaces()[surface].name.clone();
        Ok(Rendered {
            scenario: self.scenario.clone(),
            shape: left.shape(),
            surroundings: chosen.iter().map(|surface| named(*surface)).collect(),
            lighting_left_out,
            surfaces: self.rows(&left),
            pure: views.first().map_or(0, |view| view.material.iter().filter(|m| **m != NO_MATERIAL).count()),
            counts_median: sorted.get(sorted.len() / 2).copied().unwrap_or(f64::NAN),
            noise_variance: noise.get(bands / 2).copied().unwrap_or(f64::NAN),
            seed: plan.seed,
            warnings,
            views,
            wavenumbers_cm1: nodes.to_vec(),
            bands: self.bands.clone(),
            counts_per_radiance: self.counting.counts_per_radiance,
            var_added: (0..bands).map(|band| self.counting.var_added(band)).collect(),
            emissivities: materials.iter().map(|(_, emissivity)| at_nodes(emissivity, nodes.len())).collect(),
            materials: materials.into_iter().map(|(name, _)| name).collect(),
            radiances: chosen.iter().map(|surface| left.leaving()[*surface].clone()).collect(),
        })
    }

    /// All materials once, and of each surface the places of its two among them.
    fn materials(&self) -> (Vec<(String, &Emissivity)>, Vec<[u16; 2]>) {
        let mut all: Vec<(String, &Emissivity)> = Vec::new();
        let surfaces = self.staged.scene.surfaces().iter().zip(&self.staged.materials);
        let places = surfaces
            .map(|(surface, names)| {
                let mut place = |kind: usize| {
                    let (Some(name), emissivity) = (names[kind].clone(), &surface.emissivity[kind]) else {
                        return NO_MATERIAL;
                    };
                    let known = all.iter().position(|(other, own)| *other == name && *own == emissivity);
                    let place = known.unwrap_or_else(|| {
                        all.push((name, emissivity));
                        all.len() - 1
                    });
                    u16::try_from(place).unwrap_or(NO_MATERIAL)
                };
                [place(0), place(usize::from(surface.emissivity[0] != surface.emissivity[1]))]
            })
            .collect();
        for (name, emissivity) in &self.staged.further {
            if !all.iter().any(|(other, own)| other == name && *own == emissivity) {
                all.push((name.clone(), emissivity));
            }
        }
        (all, places)
    }

    fn picture(
        &self,
        view: &View,
        materials: &[[u16; 2]],
        chosen: &[usize],
        draw: Option<(u64, u64)>,
    ) -> Result<Picture> {
        let (shape, surfaces) = (view.shape(), self.staged.scene.surfaces().len());
        let common = self.camera.var_in_common(shape.bands());
        let var: Vec<f64> = (0..shape.bands()).map(|band| self.alone.var_added(band)).collect();
        let noisy = !matches!(camera_noise(&self.alone, shape.bands()), NoiseVariance::None);
        // A pattern of one array in every band: what a row, a column and the picture have in common.
        let [of_row, of_column, of_all] = common.map(|[fixed, temporal]| (fixed + temporal).sqrt());
        let mut alike = vec![0.0; shape.row_len()];
        if let (Some((seed, side)), true) = (draw, of_column.max(of_all) > 0.0) {
            let mut rng = generator(seed, (side << 32) + (1 << 31));
            let all = normals(&mut rng, of_all, shape.bands());
            for pixel in alike.chunks_mut(shape.bands()) {
                let own = normals(&mut rng, of_column, shape.bands());
                pixel.iter_mut().zip(all.iter().zip(own)).for_each(|(sum, (all, own))| *sum = all + own);
            }
        }
        let mut counts = vec![0.0_f32; shape.len()];
        parallel::fill(&mut counts, shape.row_len(), Vec::new, |row_of: &mut Vec<f64>, row, out| {
            view.rows_into(Part::Total, self.counting.counts_per_radiance, row..row + 1, row_of);
            if let Some((seed, side)) = draw {
                let mut rng = generator(seed, (side << 32) + row as u64);
                for pixel in row_of.chunks_mut(shape.bands()) {
                    let mut draws = Draws::new(&Statistics::Poisson, pixel)?;
                    if noisy {
                        draws = draws.with_electronic_noise(&var)?;
                    }
                    draws.draw_into(&mut rng, pixel);
                }
                if of_row > 0.0 {
                    let own = normals(&mut rng, of_row, shape.bands());
                    let all = row_of.iter_mut().zip(own.iter().cycle());
                    all.for_each(|(count, own)| *count += own);
                }
                row_of.iter_mut().zip(&alike).for_each(|(count, common)| *count += common);
            }
            out.iter_mut().zip(row_of.iter()).for_each(|(to, from)| *to = *from as f32);
            Ok::<(), Error>(())
        })?;
        let material = |i: usize| {
            let own = materials.get(usize::from(view.surface[i]));
            own.filter(|_| view.pure[i]).map_or(NO_MATERIAL, |own| own[usize::from(view.texture[i] > 0.5)])
        };
        let pixels = view.surface.len();
        let means: Vec<f64> =
            view.leaving().iter().map(|s| s.iter().sum::<f64>() / s.len().max(1) as f64).collect();
        let lit = |i: usize| &view.lighting[i * surfaces..(i + 1) * surfaces];
        let f32s = |of: &[f64]| of.iter().map(|x| *x as f32).collect();
        Ok(Picture {
            counts,
            material: (0..pixels).map(material).collect(),
            temperature_k: (0..pixels)
                .map(|i| if material(i) == NO_MATERIAL { f32::NAN } else { view.temperature_k[i] as f32 })
                .collect(),
            lighting: (0..pixels).flat_map(|i| chosen.iter().map(move |k| lit(i)[*k] as f32)).collect(),
            incident: (0..pixels)
                .map(|i| lit(i).iter().zip(&means).map(|(v, s)| v * s).sum::<f64>() as f32)
                .collect(),
            depth_m: f32s(&view.depth_m),
            surface: view.surface.clone(),
        })
    }

    fn rows(&self, view: &View) -> Vec<SurfaceRow> {
        let surfaces = self.staged.scene.surfaces().iter().zip(&self.staged.materials).enumerate();
        surfaces
            .map(|(k, (surface, names))| {
                let own: Vec<usize> =
                    (0..view.surface.len()).filter(|i| usize::from(view.surface[*i]) == k).collect();
                let pure: Vec<usize> = own.iter().copied().filter(|i| view.pure[*i]).collect();
                let depth = own.iter().map(|i| view.depth_m[*i]).filter(|z| z.is_finite());
                let ends = depth.fold([f64::INFINITY, 0.0_f64], |[low, high], z| [low.min(z), high.max(z)]);
                let mut materials: Vec<String> = names.iter().flatten().cloned().collect();
                materials.dedup();
                SurfaceRow {
                    name: surface.name.clone(),
                    materials,
                    pixels: own.len(),
                    pure: pure.len(),
                    temperature_k: pure.iter().map(|i| view.temperature_k[*i]).sum::<f64>()
                        / pure.len().max(1) as f64,
                    depth_m: (ends[0] <= ends[1]).then_some(ends),
                }
            })
            .collect()
    }
}

/// Surfaces whose light counts, sky and ground first, then those that light the most; and the most that the others give a pixel.
fn surroundings(view: &View, surfaces: usize) -> (Vec<usize>, f64) {
    let mut most = vec![0.0_f64; surfaces];
    for (lit, _) in view.lighting.chunks_exact(surfaces).zip(&view.pure).filter(|(_, pure)| **pure) {
        most.iter_mut().zip(lit).for_each(|(most, v)| *most = most.max(*v));
    }
    let mut others: Vec<usize> = (2..surfaces).filter(|k| most[*k] > DARK).collect();
    order::descending(&mut others, |b| most[*b]);
    others.truncate(SURROUNDINGS - 2);
    let chosen: Vec<usize> = [0, 1].into_iter().chain(others).collect();
    let left_out = |lit: &[f64]| -> f64 {
        lit.iter().enumerate().filter(|(k, _)| !chosen.contains(k)).map(|(_, v)| v).sum()
    };
    let largest = view
        .lighting
        .chunks_exact(surfaces)
        .zip(&view.pure)
        .filter(|(_, pure)| **pure)
        .map(|(lit, _)| left_out(lit))
        .fold(0.0, f64::max);
    (chosen, largest)
}

/// So many normal numbers of one deviation.
fn normals(rng: &mut impl Rng, sigma: f64, count: usize) -> Vec<f64> {
    StandardNormal.sample_iter(rng).take(count).map(|z: f64| sigma * z).collect()
}

fn at_nodes(emissivity: &Emissivity, nodes: usize) -> Vec<f64> {
    match emissivity {
        Emissivity::Constant(value) => vec![*value; nodes],
        Emissivity::Spectrum(values) => values.clone(),
    }
}
