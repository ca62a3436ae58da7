//! A scene rendered, its heat cube taken apart, and its materials made categories: what Extended Data Figs. 7 and 8 do.

use hadar::cube::{Cube, MemoryCube, Shape};
use hadar::error::{Error, Result};
use hadar::fisher::{Nuisance, Unknowns};
use hadar::identifiability::detection;
use hadar::identifiability::nearest::{NearestSolver, StateRange};
use hadar::material::Library;
use hadar::planck::photon_radiance;
use hadar::scene::{State, Surroundings};
use hadar::statistics::Statistics;
use hadar_estimate::decompose::{Light, Maps, NO_MATERIAL, Options, Setting, decompose};
use hadar_estimate::segmentation::{
    Agreement, ByBrightness, Categories, NO_CATEGORY, Part, Rule, Told, claims, segment, smoothed,
};
use hadar_report::plot::{Axis, Painted, Picture, Rgb, categorical};
use hadar_report::table::Table;
use hadar_scenario::RenderScenario;
use hadar_scenario::decompose::CategorySpec;
use hadar_simulate::draws::{Draws, generator};
use hadar_study::render::{RenderPlan, RenderStudy, Rendered};
use rayon::prelude::*;

/// Temperatures that a pixel may have, K.
const RANGE_K: [f64; 2] = [240.0, 400.0];
/// Pixels whose limit is computed.
const LIMITS: usize = 40;
/// Counts drawn of each of them, and of the nearest state of the other material.
const DRAWS: usize = 40;
/// One in so many rows and columns is in the table beside a picture.
const TABLED: usize = 4;
/// The colour of no category.
const NONE: Rgb = (190, 190, 190);
/// Of what is undecided, and of what matters then.
const PALE: Rgb = (235, 235, 235);
const DARK: Rgb = (40, 40, 40);
/// Codes of [`Night::claimed`] beside those of the categories.
const UNDECIDED: u8 = 254;
const NOT_EXCLUDED: u8 = 253;

pub(super) struct Night {
    study: RenderStudy,
    pub(super) rendered: Rendered,
    pub(super) maps: Maps,
    /// All bands together, counts.
    pub(super) thermal: Vec<f32>,
    specs: Vec<CategorySpec>,
    categories: Categories,
    /// What is there.
    pub(super) truth: Vec<u8>,
    truth_material: Vec<u16>,
}

impl Night {
    pub(super) fn of(toml: &str, seed: u64) -> Result<Self> {
        let scenario = RenderScenario::from_toml(toml, None)?;
        let study = RenderStudy::new(&scenario, &Library::embedded()?)?;
        let rendered = study.render(RenderPlan { seed: Some(seed) }, &|_, _| ())?;
        let view = rendered.views.first().ok_or_else(|| Error::malformed("no view", "render one"))?;
        let bands = rendered.shape.bands();
        let thermal = view.counts.chunks(bands).map(|pixel| pixel.iter().sum()).collect();
        let place = |name: &String| rendered.materials.iter().position(|one| one == name);
        let parts = |spec: &CategorySpec| -> Vec<Part> {
            let part = |name| Some(Part { material: place(name)?, enclosed: spec.enclosed.contains(name) });
            spec.materials.iter().filter_map(part).collect()
        };
        let specs = scenario.categories.clone();
        let all: Vec<Vec<Part>> = specs.iter().map(parts).collect();
        let categories = Categories::new(rendered.materials.len(), &all)?;
        let of_surface = |surface: &u8| {
            let name = rendered.surfaces.get(usize::from(*surface)).map(|row| &row.name);
            let found = name.and_then(|name| specs.iter().position(|spec| spec.surfaces.contains(name)));
            found.and_then(|place| u8::try_from(place).ok()).unwrap_or(NO_CATEGORY)
        };
        let truth: Vec<u8> = view.surface.iter().map(of_surface).collect();
        // The sky is no surface of the renderer; the library has it as a material.
        let sky = rendered.materials.iter().position(|name| name.starts_with("sky-"));
        let sky = sky.and_then(|place| u16::try_from(place).ok()).unwrap_or(NO_MATERIAL);
        let material = |(material, surface): (&u16, &u8)| if *surface == 0 { sky } else { *material };
        let truth_material = view.material.iter().zip(&view.surface).map(material).collect();
        let counts = view.counts.clone();
        let options = Options { categories: categories.sets(), ..Options::default() };
        let scene = (&rendered.radiances[..], &rendered.emissivities[..]);
        let maps = taken_apart(&study, scene, rendered.shape, counts, &options)?;
        Ok(Self { study, maps, thermal, categories, truth, truth_material, specs, rendered })
    }

    pub(super) fn columns(&self) -> usize {
        self.rendered.shape.columns()
    }

    pub(super) fn names(&self) -> Vec<&str> {
        self.specs.iter().map(|spec| spec.name.as_str()).collect()
    }

    pub(super) fn category(&self, name: &str) -> Option<u8> {
        let place = self.specs.iter().position(|spec| spec.name == name)?;
        u8::try_from(place).ok()
    }

    /// By the materials that were found.
    pub(super) fn by_found(&self, rule: Rule) -> Result<Vec<u8>> {
        smoothed(
            &segment(&self.maps.fitting_material(), self.columns(), &self.categories, rule)?,
            self.columns(),
        )
    }

    /// What the materials that are left by 95 % tell, and no more: [`UNDECIDED`] where that is nothing, [`NOT_EXCLUDED`] where a category is among
    /// what 99 % leave besides.
    pub(super) fn claimed(&self, not_excluded: &str) -> Result<Vec<u8>> {
        let safety = self.category(not_excluded).map_or(0, |place| 1 << place);
        let Maps { possible_95, common_95, possible_99, .. } = &self.maps;
        let found = claims(possible_95, common_95, self.columns(), &self.categories, Rule::Regions, safety)?;
        let one = |(i, category): (usize, &u8)| match found.told[i] {
            Told::Undecided if possible_99[i] & safety != 0 => NOT_EXCLUDED,
            Told::Undecided => UNDECIDED,
            _ => *category,
        };
        Ok(found.category.iter().enumerate().map(one).collect())
    }

    /// By the materials that are there; pixels of several have none.
    pub(super) fn by_true(&self, rule: Rule) -> Result<Vec<u8>> {
        smoothed(&segment(&self.truth_material, self.columns(), &self.categories, rule)?, self.columns())
    }

    /// By the thermal image alone, at its best.
    pub(super) fn by_thermal(&self) -> Result<Vec<u8>> {
        smoothed(&ByBrightness::learned(&self.thermal, &self.truth).of(&self.thermal), self.columns())
    }

    /// By the thermal image alone, as another scene teaches it; what this one does not have is no category here.
    pub(super) fn by_thermal_of(&self, teacher: &Self) -> Result<Vec<u8>> {
        let own: Vec<u8> =
            teacher.names().into_iter().map(|name| self.category(name).unwrap_or(NO_CATEGORY)).collect();
        let taught = ByBrightness::learned(&teacher.thermal, &teacher.truth).of(&self.thermal);
        let here: Vec<u8> =
            taught.iter().map(|one| own.get(usize::from(*one)).copied().unwrap_or(NO_CATEGORY)).collect();
        smoothed(&here, self.columns())
    }

    pub(super) fn agreement(&self, found: &[u8]) -> Agreement {
        Agreement::of(found, self.truth.iter().map(|one| Some(*one)), self.specs.len())
    }

    /// Share of pixels whose material was found, of those of one material.
    pub(super) fn right_material(&self) -> f64 {
        let known = || {
            self.truth_material.iter().zip(&self.maps.material).filter(|(there, _)| **there != NO_MATERIAL)
        };
        known().filter(|(there, found)| there == found).count() as f64 / known().count().max(1) as f64
    }

    /// Two materials told apart, by a pixel alone: the share that is right of maximum likelihood over counts drawn of pixels' states and
    /// of the nearest states of the other material, half of each; and the mean of Φ(d), which no test exceeds between them.
    pub(super) fn pair(&self, names: [&str; 2], seed: u64) -> Result<[f64; 2]> {
        let place = |name: &str| {
            let known = self.rendered.materials.iter().position(|one| one == name);
            known.ok_or_else(|| {
                Error::malformed(format!("no {name} in the scene"), "name one of its materials")
            })
        };
        let places = [place(names[0])?, place(names[1])?];
        let Some(view) = self.rendered.views.first() else { return Ok([f64::NAN; 2]) };
        let library = places.map(|place| self.rendered.emissivities[place].clone());
        let (bands, counting) = (self.study.bands(), self.study.counting());
        let surroundings = Surroundings::of_radiances(bands.nodes_cm1(), &self.rendered.radiances)?;
        let lights = self.rendered.radiances.len();
        let unknowns = Unknowns::new([Nuisance::Temperature, Nuisance::Lighting])?;
        let range = StateRange { temperature_k: RANGE_K, ..StateRange::default() };
        let var: Vec<f64> = (0..bands.len()).map(|band| counting.var_added(band)).collect();
        let mean = |emissivity: &[f64], state: &State| -> Vec<f64> {
            let signal = bands.nodes_cm1().iter().zip(emissivity).enumerate().map(|(w, (nu, e))| {
                let lit = state.lighting.iter().zip(&self.rendered.radiances);
                let scattered: f64 = lit.map(|(v, radiance)| v * radiance[w]).sum();
                e * photon_radiance(*nu, state.temperature_k) + (1.0 - e) * scattered
            });
            let signal: Vec<f64> = signal.collect();
            bands.weigh(&signal).iter().map(|s| s * counting.counts_per_radiance).collect()
        };
        let (mut right, mut limit) = (0.0, 0.0);
        for own in 0..2 {
            let pixels: Vec<usize> =
                (0..view.material.len()).filter(|i| usize::from(view.material[*i]) == places[own]).collect();
            let chosen: Vec<usize> =
                pixels.iter().copied().step_by(pixels.len().div_ceil(LIMITS).max(1)).collect();
            let solver = || NearestSolver::new(bands, &surroundings, unknowns.clone(), range);
            let one = |solver: &mut NearestSolver<'_>, (k, i): (usize, &usize)| {
                let lighting: Vec<f64> =
                    view.lighting[i * lights..][..lights].iter().map(|v| f64::from(*v)).collect();
                // Rounded to 32 bits they may be more than all.
                let all = lighting.iter().sum::<f64>().max(1.0);
                let lighting: Vec<f64> = lighting.iter().map(|v| v / all).collect();
                let state = surroundings.state(f64::from(view.temperature_k[*i]), &lighting)?;
                let (emissivity, other) = (&library[own], &library[1 - own]);
                let found = solver.with_counting(emissivity, other, &state, counting)?;
                let mut counts = Vec::new();
                for (side, mean) in [mean(emissivity, &state), mean(other, &found.state)].iter().enumerate() {
                    let draws = Draws::new(&Statistics::Poisson, mean)?.with_electronic_noise(&var)?;
                    let mut random = generator(seed, ((own * LIMITS + k) * 2 + side) as u64);
                    let mut drawn = vec![0.0; bands.len()];
                    for _ in 0..DRAWS {
                        draws.draw_into(&mut random, &mut drawn);
                        counts.extend(drawn.iter().map(|n| *n as f32));
                    }
                }
                Ok((detection::probability(found.distance), counts))
            };
            let all = chosen.par_iter().enumerate().map_init(solver, one).collect::<Result<Vec<_>>>()?;
            let counts: Vec<f32> = all.iter().flat_map(|(_, counts)| counts).copied().collect();
            let shape = Shape::new(2 * all.len(), DRAWS, bands.len())?;
            let scene = (&self.rendered.radiances[..], &library[..]);
            let maps = taken_apart(&self.study, scene, shape, counts, &Options::default())?;
            let is_right = |(i, found): (usize, &u16)| usize::from(*found) == (own + i / DRAWS % 2) % 2;
            let told = maps.material.iter().enumerate().filter(|one| is_right(*one)).count();
            right += 0.5 * told as f64 / maps.material.len() as f64;
            limit += 0.5 * all.iter().map(|(limit, _)| limit).sum::<f64>() / all.len() as f64;
        }
        Ok([right, limit])
    }

    /// A map of categories as an image.
    pub(super) fn painted(&self, title: impl Into<String>, map: &[u8]) -> Picture {
        let colour = |category: &u8| match usize::from(*category) {
            place if place < self.specs.len() => categorical(place),
            _ if *category == NOT_EXCLUDED => DARK,
            _ if *category == UNDECIDED => PALE,
            _ => NONE,
        };
        let pixels = map.iter().map(colour).collect();
        Picture::painted(title, Axis::linear(""), self.columns(), Painted { pixels, ramp: None })
    }

    /// The thermal image, as temperatures of the blackbody that sends as much.
    pub(super) fn thermal_picture(&self) -> Picture {
        let values = self.thermal.iter().map(|n| f64::from(*n)).collect();
        Picture::new("Thermal image, all bands together", Axis::linear("counts"), self.columns(), values)
    }

    /// Colours of the categories.
    pub(super) fn keys(&self) -> Vec<(Rgb, String)> {
        let keys = self.specs.iter().enumerate().map(|(place, spec)| (categorical(place), spec.name.clone()));
        keys.chain([(NONE, "none".to_owned())]).collect()
    }

    /// The same with those of [`Night::claimed`].
    pub(super) fn keys_of_claimed(&self, not_excluded: &str) -> Vec<(Rgb, String)> {
        let mut keys = self.keys();
        keys.extend([
            (PALE, "undecided".to_owned()),
            (DARK, format!("undecided: a {not_excluded} cannot be excluded")),
        ]);
        keys
    }

    /// Maps of categories, a row for one in [`TABLED`] rows and columns.
    pub(super) fn table(&self, maps: &[(&str, &[u8])]) -> Table {
        let header = ["row", "column", "thermal_counts"].into_iter().chain(maps.iter().map(|map| map.0));
        let mut table = Table::new(header);
        let names = self.names();
        for (i, thermal) in self.thermal.iter().enumerate() {
            if [i / self.columns(), i % self.columns()].iter().any(|at| !at.is_multiple_of(TABLED)) {
                continue;
            }
            let of = |(_, map): &(&str, &[u8])| {
                let name = match map[i] {
                    UNDECIDED => Some("undecided"),
                    NOT_EXCLUDED => Some("undecided, not excluded"),
                    place => names.get(usize::from(place)).copied(),
                };
                name.unwrap_or_default().to_owned()
            };
            let place = [(i / self.columns()).to_string(), (i % self.columns()).to_string()];
            table.push(
                place.into_iter().chain([format!("{thermal:.0}")]).chain(maps.iter().map(of)).collect(),
            );
        }
        table
    }
}

fn taken_apart(
    study: &RenderStudy,
    (radiances, library): (&[Vec<f64>], &[Vec<f64>]),
    shape: Shape,
    counts: Vec<f32>,
    options: &Options,
) -> Result<Maps> {
    let cube = Cube::F32(Box::new(MemoryCube::new(shape, counts)?));
    let lights: Vec<Light> = radiances.iter().cloned().map(Light::Radiance).collect();
    let counting = study.counting();
    let var: Vec<f64> = (0..shape.bands()).map(|band| counting.var_added(band)).collect();
    let setting = Setting {
        bands: study.bands(),
        library,
        surroundings: &lights,
        counts_per_radiance: &vec![counting.counts_per_radiance; shape.bands()],
        var_added: &var,
        units_per_count: 1.0,
        temperature_k: RANGE_K,
        lighting_total: None,
        gain: false,
        bad_bands: &[],
        path: None,
        light_besides: &[],
    };
    decompose(&setting, options, &cube, &|_| ())
}
