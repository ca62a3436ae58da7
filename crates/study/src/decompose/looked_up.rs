//! Names and files of a decomposition scenario looked up: cube, bands, library, spectra of the surroundings, truth.

use super::categories::parts;
use super::truth::Truth;
use crate::Warning;
use crate::air::Air;
use crate::budget::Takes;
use crate::cube_bad::BadFound;
use crate::heat_cube::{Measured, Said, columns};
use crate::light_found::LightFound;
use crate::shared_unknown::{air_of_cube, spectra};
use crate::surface::is_one_number;
use hadar::cube::Cube;
use hadar::error::{Error, Result};
use hadar::material::{Basis, Library, Material};
use hadar_estimate::decompose::{Alike, SpatialPrior, Spectra, Told};
use hadar_estimate::segmentation::Categories;
use hadar_formats::cube::Found;
use hadar_formats::spectra::measured;
use hadar_scenario::{DecomposeScenario, MaterialRef, Spread};
use std::sync::Arc;

/// Most probable materials of a pixel that are given where nothing is said.
pub const CANDIDATES: usize = 3;

/// A decomposition scenario with everything it names looked up and checked.
#[derive(Debug)]
pub struct DecomposeStudy {
    pub(super) scenario: DecomposeScenario,
    pub(super) cube: Cube,
    /// What its file was read as.
    pub(super) read: Found,
    /// What was found to be bad.
    pub(super) bad: BadFound,
    /// All that is told of the cube.
    pub(super) told: Told,
    /// What is said of surroundings that it shows itself.
    pub(super) found: Vec<LightFound>,
    /// Its spectra besides, for a shift of the bands.
    pub(super) spectra: Arc<Spectra>,
    /// The air before the camera, and the length of its path, m.
    pub(super) air: Option<(Air, f64)>,
    /// Names of the materials.
    pub(super) names: Vec<String>,
    /// What all bands and pixels are off by together, counts.
    pub(super) together: Option<Vec<f64>>,
    /// What all pixels are off by alike, each band for itself as well, counts.
    pub(super) alike: Alike,
    pub(super) truth: Option<Truth>,
    /// Prior probabilities of the materials in any scale; empty if they are equal.
    pub(super) prior: Vec<f64>,
    /// Classes by name, with the indices of their members.
    pub(super) classes: Vec<(String, Vec<usize>)>,
    /// What each material can be a part of.
    pub(super) categories: Categories,
    /// How many of the most probable materials of each pixel are given.
    pub(super) candidates: usize,
    pub(super) warnings: Vec<Warning>,
}

impl DecomposeStudy {
    /// Materials that are entered as one number for all wavenumbers, in the order of the library: no surface was measured to be so.
    pub(super) fn constants(&self) -> impl Iterator<Item = usize> {
        self.told.library.iter().enumerate().filter(|(_, e)| is_one_number(e)).map(|(m, _)| m)
    }

    /// What it takes at least.
    #[must_use]
    pub fn takes(&self) -> Takes {
        let shape = self.cube.shape();
        Takes::of_samples([shape.rows(), shape.columns(), shape.bands()])
    }

    /// Looks up everything that `scenario` names, materials in `library`, and opens its cube.
    ///
    /// # Errors
    /// A cube and bands that do not agree, spectra that do not cover the bands, unknown materials, files that cannot be used; each
    /// with file, line and key.
    pub fn new(scenario: &DecomposeScenario, library: &Library) -> Result<Self> {
        let said = Said {
            cube: &scenario.cube,
            bands: scenario.bands.as_ref(),
            camera: scenario.camera.as_ref(),
            environment: &scenario.environment,
            source: &scenario.source,
            temperature_k: scenario.unknown.temperature_k,
            gain: scenario.unknown.gain,
        };
        let at = |key: &str| said.at(key);
        let measured = said.measured(library)?;
        let Measured { cube, read, bad_bands, bad, mut warnings, bands, lights, found, .. } = measured;
        let Measured { counts_per_radiance, var_added, together, common, units_per_count, .. } = measured;
        let materials =
            materials(scenario, library, &mut warnings).map_err(|(key, error)| at(&key)(error))?;
        let nodes = bands.nodes_cm1();
        let emissivities = materials.iter().map(|Listed { material, entry, .. }| {
            let key = match &scenario.library.materials {
                Some(_) => format!("library.materials[{entry}]"),
                None => "library.path".into(),
            };
            material.emissivity(nodes).map_err(|error| error.at(scenario.place(&key)))
        });
        let emissivities = emissivities.collect::<Result<Vec<_>>>()?;
        let (air, path) =
            air_of_cube(scenario.atmosphere.as_ref(), (nodes, &lights), &scenario.source)?.unzip();
        let each: Vec<&Material> = materials.iter().map(|one| &one.material).collect();
        let of = (&each[..], &scenario.environment[..], library);
        let spectra = spectra((&bands, &emissivities, &lights), of, air.as_ref());
        let names: Vec<String> = materials.iter().map(|one| one.material.name().to_owned()).collect();
        let entries = materials.last().map_or(0, |last| last.entry + 1);
        if let Some(prior) = &scenario.library.prior
            && prior.len() != entries
        {
            let found = format!("{} probabilities for {entries} materials", prior.len());
            return Err(at("library.prior")(Error::malformed(found, "write one for each")));
        }
        let stated = scenario.library.prior.as_deref();
        // A class shares its probability among its members.
        let weigh = |one: &Listed| stated.map_or(1.0, |prior| prior[one.entry]) * one.weight;
        let is_weighed = stated.is_some() || materials.iter().any(|one| one.class.is_some());
        let prior = if is_weighed { materials.iter().map(weigh).collect() } else { Vec::new() };
        let mut classes: Vec<(String, Vec<usize>)> = Vec::new();
        for (place, one) in materials.iter().enumerate() {
            let Some(class) = &one.class else { continue };
            match classes.iter_mut().find(|(name, _)| name == class) {
                Some((_, members)) => members.push(place),
                None => classes.push((class.clone(), vec![place])),
            }
        }
        check(scenario, &names, lights.len()).map_err(|(key, error)| at(&key)(error))?;
        let categories =
            parts(&scenario.categories, &names, &classes).map_err(|(key, error)| at(&key)(error))?;
        let truth = scenario.truth.as_ref();
        let truth = truth
            .map(|spec| {
                Truth::open(spec, cube.shape(), lights.len(), names.len()).map_err(|(k, e)| at(&k)(e))
            })
            .transpose()?;
        Ok(Self {
            scenario: scenario.clone(),
            cube,
            read,
            bad,
            told: Told {
                bands,
                library: emissivities,
                surroundings: lights,
                counts_per_radiance,
                var_added,
                units_per_count,
                temperature_k: scenario.unknown.temperature_k,
                lighting_total: scenario.unknown.lighting_total,
                gain: scenario.unknown.gain,
                bad_bands,
                path,
                light_besides: Vec::new(),
            },
            found,
            spectra: Arc::new(spectra),
            air,
            names,
            alike: Alike { of_bands: common, together: together.clone().unwrap_or_default() },
            together,
            truth,
            prior,
            classes,
            categories,
            candidates: CANDIDATES,
            warnings,
        })
    }

    /// The scenario.
    #[must_use]
    pub fn scenario(&self) -> &DecomposeScenario {
        &self.scenario
    }

    pub(super) fn at_cube(&self, error: Error) -> Error {
        match &error {
            Error::At { place, .. } if place.path.is_some() => error,
            _ => error.in_file(&self.scenario.cube.data),
        }
    }
}

/// What of a scenario does not go together, with the key that it is about.
fn check(
    scenario: &DecomposeScenario,
    names: &[String],
    lights: usize,
) -> std::result::Result<(), (String, Error)> {
    if scenario.unknown.lighting_total.is_some() && lights == 0 {
        let found = Error::malformed("a total of no lighting", "write [[environment]], or leave it out");
        return Err(("unknown.lighting_total".into(), found));
    }
    if let Some(other) = scenario.vision.hues_deg.keys().find(|name| !names.contains(name)) {
        let found = Error::unknown_name("material", other, names.iter().map(String::as_str));
        return Err((format!("vision.hues.{other}"), found));
    }
    if let Some(sky) = scenario.vision.sky.filter(|sky| *sky >= lights) {
        let found = format!("environment {sky} as the sky, of {}", lights);
        let error = Error::malformed(found, "count the [[environment]] tables from 0");
        return Err(("vision.sky".into(), error));
    }
    if scenario.vision.sky.is_some() && scenario.unknown.gain {
        let found = "the light of a sky in counts of unknown scale";
        return Err(("vision.sky".into(), Error::malformed(found, "write unknown.gain = false")));
    }
    if scenario.spatial.is_some() && scenario.library.none_of_these.is_some() {
        let found = "it knows no surface that is none of the library";
        let instead = "leave [spatial] or library.none_of_these out";
        return Err(("spatial".into(), Error::malformed(found, instead)));
    }
    let library = &scenario.library;
    if let Some(probability) = library.mixed {
        let key = "library.mixed";
        let refused = |found: &str, instead: &str| Err((key.to_owned(), Error::malformed(found, instead)));
        if scenario.spatial.is_some() {
            return refused("it knows no prior over the image", "leave [spatial] or library.mixed out");
        }
        if library.emissivity_error.is_some_and(|error| error > 0.0) {
            let instead = "leave library.emissivity_error or library.mixed out";
            return refused("it knows no errors of the library", instead);
        }
        if scenario.unknown.gain {
            return refused(
                "it knows no gain of each pixel",
                "write unknown.gain = false, or leave library.mixed out",
            );
        }
        let both = probability + library.none_of_these.unwrap_or(0.0);
        if both >= 1.0 {
            let quantity = "probability of two surfaces and of none of these together";
            return Err((key.to_owned(), Error::out_of_range(quantity, both, "", "below 1")));
        }
    }
    if matches!(scenario.spatial, Some(SpatialPrior::TexSgd { .. }))
        && scenario.library.emissivity_error.is_some_and(|error| error > 0.0)
    {
        let found = "its cost knows no errors of the library";
        let instead = "write prior = \"potts\", or leave library.emissivity_error out";
        return Err(("spatial.prior".into(), Error::malformed(found, instead)));
    }
    Ok(())
}

/// A material of the library, or a member of a class that stands there.
struct Listed {
    material: Material,
    /// Which of the listed ones it is of.
    entry: usize,
    weight: f64,
    class: Option<String>,
}

impl Listed {
    fn alone(entry: usize, material: Material) -> Self {
        Self { material, entry, weight: 1.0, class: None }
    }
}

/// What a name or file of the list is, with all members of a class.
fn listed(
    scenario: &DecomposeScenario,
    library: &Library,
    (entry, reference): (usize, &MaterialRef),
    warnings: &mut Vec<Warning>,
) -> Result<Vec<Listed>> {
    let name = match reference {
        MaterialRef::File(path) => {
            return Ok(vec![Listed::alone(entry, hadar_formats::spectra::material(path)?)]);
        }
        MaterialRef::Name(name) => name,
    };
    let Some(spec) = scenario.classes.get(name).or_else(|| library.class(name)) else {
        return Ok(vec![Listed::alone(entry, library.get(name)?.clone())]);
    };
    let is_placeholder = library.get(name).is_ok_and(|one| one.provenance().basis == Basis::Constant);
    if scenario.classes.contains_key(name) && library.contains(name) && !is_placeholder {
        let found = format!("`{name}` is a class here and a material of the library");
        return Err(Error::malformed(found, format!("call the class otherwise, such as `any-{name}`")));
    }
    if matches!(spec.spread, Some(Spread::Stated { .. })) && scenario.library.emissivity_error.is_none() {
        let found = format!("errors that the class `{name}` states");
        let instead = "write them as library.emissivity_error, which is a share of the emissivities of all";
        return Err(Error::malformed(found, instead));
    }
    if spec.mixtures {
        let found = format!("mixtures of the class `{name}`");
        return Err(Error::malformed(found, "leave mixtures out: a pixel is taken to be of one member"));
    }
    let class = hadar_formats::members(spec, library)?;
    let remark = |reason: &String| Warning::Material {
        material: name.clone(),
        remark: format!("passed over: {reason}"),
    };
    warnings.extend(class.passed_over.iter().map(remark));
    let member = |member: hadar_formats::Member| {
        let own = format!("{name}/{}", member.material.name());
        let material = member.material.with_name(own);
        Listed { material, entry, weight: member.weight, class: Some(name.clone()) }
    };
    // What is never met is not looked for.
    Ok(class.members.into_iter().filter(|member| member.weight > 0.0).map(member).collect())
}

/// The materials in the order of the file or list; an error with the key it is about.
fn materials(
    scenario: &DecomposeScenario,
    library: &Library,
    warnings: &mut Vec<Warning>,
) -> std::result::Result<Vec<Listed>, (String, Error)> {
    let spec = &scenario.library;
    let Some(path) = &spec.path else {
        let mut all = Vec::new();
        for (i, reference) in spec.materials.iter().flatten().enumerate() {
            let found = listed(scenario, library, (i, reference), warnings);
            let of_class = match reference {
                MaterialRef::Name(name) if scenario.classes.contains_key(name) => {
                    Some(format!("class.{name}"))
                }
                _ => None,
            };
            let key = of_class.unwrap_or_else(|| format!("library.materials[{i}]"));
            all.extend(found.map_err(|error| (key, error))?);
        }
        let mut names = std::collections::BTreeSet::new();
        return match all.iter().find(|one| !names.insert(one.material.name())) {
            Some(twice) => {
                let found = format!("`{}` stands in the library twice", twice.material.name());
                let error = Error::malformed(found, "name it once");
                Err((format!("library.materials[{}]", twice.entry), error))
            }
            None => Ok(all),
        };
    };
    let table = columns(path).map_err(|error| ("library.path".to_owned(), error))?;
    let made = |name: &str, rows: &[(f64, f64)]| {
        measured(rows, 1.0)
            .and_then(|rows| Material::from_table(name, rows))
            .map_err(|error| ("library.path".to_owned(), error.for_key(name).in_file(path)))
    };
    let Some(wanted) = &spec.materials else {
        let all = table.iter().enumerate();
        return all.map(|(i, (name, rows))| Ok(Listed::alone(i, made(name, rows)?))).collect();
    };
    let picked = wanted.iter().enumerate().map(|(i, reference)| {
        let key = format!("library.materials[{i}]");
        let MaterialRef::Name(wanted) = reference else {
            let found = Error::malformed("a file beside library.path", "name a column of the table");
            return Err((key, found));
        };
        match table.iter().find(|(name, _)| name == wanted) {
            Some((name, rows)) => Ok(Listed::alone(i, made(name, rows)?)),
            None => {
                let names = table.iter().map(|(name, _)| name.as_str());
                Err((key, Error::unknown_name("column", wanted, names)))
            }
        }
    });
    picked.collect()
}
