//! Names and files of a decomposition scenario looked up: cube, bands, library, spectra of the surroundings, truth.

use super::truth::Truth;
use crate::scenario::{DecomposeScenario, MaterialRef};
use crate::study::Warning;
use crate::study::heat_cube::{Measured, Said, columns};
use hadar::decompose::{Light, SpatialPrior};
use hadar::error::{Error, Result};
use hadar::material::{Library, Material};
use hadar::ranging::cube::Cube;
use hadar::spectrum::Bands;

/// A decomposition scenario with everything it names looked up and checked.
#[derive(Debug)]
pub struct DecomposeStudy {
    pub(super) scenario: DecomposeScenario,
    pub(super) cube: Cube,
    pub(super) bands: Bands,
    /// Names of the materials, and their emissivities at the nodes of the bands.
    pub(super) names: Vec<String>,
    pub(super) library: Vec<Vec<f64>>,
    pub(super) lights: Vec<Light>,
    pub(super) counts_per_radiance: Vec<f64>,
    pub(super) var_added: Vec<f64>,
    /// What one count is in the unit of the cube.
    pub(super) units_per_count: f64,
    pub(super) truth: Option<Truth>,
    pub(super) warnings: Vec<Warning>,
}

impl DecomposeStudy {
    /// Looks up everything that `scenario` names, materials in `library`, and opens its cube.
    ///
    /// # Errors
    /// A cube and bands that do not agree, spectra that do not cover the bands, unknown materials, files that cannot be used; each
    /// with file, line and key.
    pub fn new(scenario: &DecomposeScenario, library: &Library) -> Result<Self> {
        let said = Said {
            cube: &scenario.cube,
            bands: &scenario.bands,
            camera: scenario.camera.as_ref(),
            environment: &scenario.environment,
            source: &scenario.source,
        };
        let at = |key: &str| said.at(key);
        let measured = said.measured(library)?;
        let Measured { cube, bands, lights, counts_per_radiance, var_added, units_per_count } = measured;
        let materials = materials(scenario, library).map_err(|(key, error)| at(&key)(error))?;
        let nodes = bands.nodes_cm1();
        let emissivities = materials.iter().enumerate().map(|(i, material)| {
            let key = match &scenario.library.materials {
                Some(_) => format!("library.materials[{i}]"),
                None => "library.path".into(),
            };
            material.emissivity(nodes).map_err(|error| error.at(scenario.place(&key)))
        });
        let emissivities = emissivities.collect::<Result<_>>()?;
        let names: Vec<String> = materials.iter().map(|material| material.name().to_owned()).collect();
        if let Some(prior) = &scenario.library.prior
            && prior.len() != names.len()
        {
            let found = format!("{} probabilities for {} materials", prior.len(), names.len());
            return Err(at("library.prior")(Error::malformed(found, "write one for each")));
        }
        if scenario.unknown.lighting_total.is_some() && lights.is_empty() {
            let found = Error::malformed("a total of no lighting", "write [[environment]], or leave it out");
            return Err(at("unknown.lighting_total")(found));
        }
        if let Some(other) = scenario.vision.hues_deg.keys().find(|name| !names.contains(name)) {
            let found = Error::unknown_name("material", other, names.iter().map(String::as_str));
            return Err(at(&format!("vision.hues.{other}"))(found));
        }
        if matches!(scenario.spatial, Some(SpatialPrior::TexSgd { .. }))
            && scenario.library.emissivity_error.is_some_and(|error| error > 0.0)
        {
            let found = "its cost knows no errors of the library";
            let instead = "write prior = \"potts\", or leave library.emissivity_error out";
            return Err(at("spatial.prior")(Error::malformed(found, instead)));
        }
        let truth = scenario.truth.as_ref();
        let truth = truth
            .map(|spec| {
                Truth::open(spec, cube.shape(), lights.len(), names.len()).map_err(|(k, e)| at(&k)(e))
            })
            .transpose()?;
        Ok(Self {
            scenario: scenario.clone(),
            cube,
            bands,
            names,
            library: emissivities,
            lights,
            counts_per_radiance,
            var_added,
            units_per_count,
            truth,
            warnings: Vec::new(),
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

/// The materials in the order of the file or list; an error with the key it is about.
fn materials(
    scenario: &DecomposeScenario,
    library: &Library,
) -> std::result::Result<Vec<Material>, (String, Error)> {
    let spec = &scenario.library;
    let Some(path) = &spec.path else {
        let named = spec.materials.iter().flatten().enumerate().map(|(i, reference)| {
            let found = match reference {
                MaterialRef::Name(name) => library.get(name).cloned(),
                MaterialRef::File(path) => Material::from_file(path),
            };
            found.map_err(|error| (format!("library.materials[{i}]"), error))
        });
        return named.collect();
    };
    let table = columns(path).map_err(|error| ("library.path".to_owned(), error))?;
    let made = |name: &str, rows: &[(f64, f64)]| {
        Material::from_table(name, rows)
            .map_err(|error| ("library.path".to_owned(), error.for_key(name).in_file(path)))
    };
    let Some(wanted) = &spec.materials else {
        return table.iter().map(|(name, rows)| made(name, rows)).collect();
    };
    let picked = wanted.iter().enumerate().map(|(i, reference)| {
        let key = format!("library.materials[{i}]");
        let MaterialRef::Name(wanted) = reference else {
            let found = Error::malformed("a file beside library.path", "name a column of the table");
            return Err((key, found));
        };
        match table.iter().find(|(name, _)| name == wanted) {
            Some((name, rows)) => made(name, rows),
            None => {
                let names = table.iter().map(|(name, _)| name.as_str());
                Err((key, Error::unknown_name("column", wanted, names)))
            }
        }
    });
    picked.collect()
}
