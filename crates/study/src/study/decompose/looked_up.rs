//! Names and files of a decomposition scenario looked up: cube, bands, library, spectra of the surroundings, truth.

use super::truth::Truth;
use crate::scenario::decompose::{CubeUnit, LightSource};
use crate::scenario::{DecomposeScenario, MaterialRef, Spread};
use crate::study::{Warning, bands, camera, camera_bands};
use hadar::decompose::{Light, SpatialPrior};
use hadar::error::{Error, Result};
use hadar::grid::{Grid, READ_SPECTRUM, text_of_file};
use hadar::instrument::View;
use hadar::material::{Basis, Library, Material};
use hadar::planck;
use hadar::ranging::cube::{Cube, Rows, Sample};
use hadar::spectrum::{Bands, interpolated};
use hadar::units::{PLANCK_J_S, SPEED_OF_LIGHT_M_S};
use std::path::Path;

/// Counts that stand for a squared deviation of a stated noise: so many that shot noise adds nothing to it.
const PER_VARIANCE: f64 = 1e6;

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
    /// Prior probabilities of the materials in any scale; empty if they are equal.
    pub(super) prior: Vec<f64>,
    /// Classes by name, with the indices of their members.
    pub(super) classes: Vec<(String, Vec<usize>)>,
    pub(super) warnings: Vec<Warning>,
}

impl DecomposeStudy {
    /// Looks up everything that `scenario` names, materials in `library`, and opens its cube.
    ///
    /// # Errors
    /// A cube and bands that do not agree, spectra that do not cover the bands, unknown materials, files that cannot be used; each
    /// with file, line and key.
    pub fn new(scenario: &DecomposeScenario, library: &Library) -> Result<Self> {
        let at = |key: &str| {
            let key = key.to_owned();
            move |error: Error| match &error {
                Error::At { place, .. } if place.path.is_some() => error.for_key(key),
                _ => error.at(scenario.place(&key)),
            }
        };
        let camera =
            scenario.camera.as_ref().map(|spec| camera::resolved(spec, &scenario.source)).transpose()?;
        let asked =
            camera_bands::asked(&scenario.bands.source, camera.as_ref().zip(scenario.camera.as_ref()));
        if scenario.bands.integrate {
            let found = "integrals over bands are not made here";
            let instead = "leave bands.integrate out: a filter is sampled at the rows of its curve";
            return Err(at("bands.integrate")(Error::malformed(found, instead)));
        }
        let mut bands = bands::at_centres(&asked, &scenario.source)?;
        if let (Some(camera), Some(spec)) = (&camera, &scenario.camera) {
            camera_bands::check(camera, spec, &asked, &bands, &|key| scenario.place(key))?;
            bands = camera.received(&bands);
        }
        let cube =
            Cube::open(&scenario.cube.data, scenario.cube.variable.as_deref()).map_err(at("cube.data"))?;
        check_shape(&cube, &bands).map_err(at("cube.data"))?;
        if let Some(bad) = scenario.cube.bad_bands.iter().find(|band| **band >= bands.len()) {
            let found = format!("band {bad} of {}", bands.len());
            let instead = format!("count from 0 up to {}", bands.len() - 1);
            return Err(at("cube.bad_bands")(Error::malformed(found, instead)));
        }
        let mut warnings = Vec::new();
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
        let emissivities = emissivities.collect::<Result<_>>()?;
        let widths = bands.widths_cm1();
        let centres: Vec<f64> =
            bands.weigh(nodes).iter().zip(&widths).map(|(sum, width)| sum / width).collect();
        let mut units_per_count = 1.0;
        let noise = scenario.cube.noise;
        let (counts_per_radiance, var_added) = match scenario.cube.unit {
            CubeUnit::CountsPerPhotonRadiance(counts) => {
                let var = noise.map_or(0.0, |noise| noise * noise);
                (widths.iter().map(|width| counts / width).collect(), vec![var; bands.len()])
            }
            CubeUnit::Radiance => {
                // A variance so much larger than that of the photons that the noise alone counts.
                let deviation = noise.unwrap_or(f64::NAN);
                units_per_count = deviation * deviation / (PER_VARIANCE * largest(&cube)?.max(deviation));
                let joules = |nu: &f64| PLANCK_J_S * SPEED_OF_LIGHT_M_S * 100.0 * nu;
                let scale = |(nu, width): (&f64, &f64)| joules(nu) / (units_per_count * width);
                let var = (deviation / units_per_count).powi(2);
                (centres.iter().zip(&widths).map(scale).collect(), vec![var; bands.len()])
            }
            CubeUnit::Camera => {
                let Some(camera) = &camera else {
                    return Err(at("camera")(Error::malformed("the table is missing", "write [camera]")));
                };
                let counting = camera.counting(&bands, &View::default());
                let var = (0..bands.len()).map(|w| counting.var_added(w) + noise.map_or(0.0, |n| n * n));
                (vec![counting.counts_per_radiance; bands.len()], var.collect())
            }
        };
        let lights = scenario.environment.iter().enumerate().map(|(k, light)| {
            let key = format!("environment[{k}]");
            lit(light, &cube, &bands, library, units_per_count).map_err(at(&key))
        });
        let lights = lights.collect::<Result<Vec<_>>>()?;
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
            prior,
            classes,
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

fn check_shape(cube: &Cube, bands: &Bands) -> Result<()> {
    let shape = cube.shape();
    if shape.bands() == bands.len() {
        return Ok(());
    }
    let found = format!(
        "the cube is {} x {} x {} (rows, columns, bands), but [bands] are {}",
        shape.rows(),
        shape.columns(),
        shape.bands(),
        bands.len()
    );
    let instead = match (shape.rows() == bands.len(), shape.columns() == bands.len()) {
        (true, _) => "its first axis seems to be the bands: write it with np.moveaxis(a, 0, 2)",
        (_, true) => "its second axis seems to be the bands: write it with np.moveaxis(a, 1, 2)",
        _ => "make [bands] those of the cube",
    };
    Err(Error::malformed(found, instead))
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
        MaterialRef::File(path) => return Ok(vec![Listed::alone(entry, Material::from_file(path)?)]),
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
    let class = spec.read(library)?;
    let remark = |reason: &String| Warning::Material {
        material: name.clone(),
        remark: format!("passed over: {reason}"),
    };
    warnings.extend(class.passed_over.iter().map(remark));
    let member = |member: hadar::material::Member| {
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
        Material::from_table(name, rows)
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

/// Name and rows (cm⁻¹, value) of a column.
type Column = (String, Vec<(f64, f64)>);

/// The columns of a table beside its wavenumbers.
fn columns(path: &Path) -> Result<Vec<Column>> {
    let text = text_of_file(path, READ_SPECTRUM)?;
    let read = || -> Result<Vec<Column>> {
        let grid = Grid::parse(&text)?;
        let axis = grid.wavenumbers_cm1()?;
        let column = |(i, name): (usize, &String)| {
            let rows = axis.iter().zip(&grid.rows).map(|(nu, (_, cells))| (*nu, cells[i])).collect();
            (name.clone(), rows)
        };
        Ok(grid.header.iter().enumerate().skip(1).map(column).collect())
    };
    read().map_err(|error| error.in_file(path))
}

/// The spectrum of one of the surroundings.
fn lit(light: &LightSource, cube: &Cube, bands: &Bands, library: &Library, unit: f64) -> Result<Light> {
    let nodes = bands.nodes_cm1();
    match light {
        LightSource::Surface { material, temperature_k } => {
            let mut radiance = vec![0.0; nodes.len()];
            planck::photon_radiance_into(nodes, *temperature_k, &mut radiance);
            let emissivity = match material {
                None => return Ok(Light::Radiance(radiance)),
                Some(MaterialRef::Name(name)) => library.get(name)?.emissivity(nodes)?,
                Some(MaterialRef::File(path)) => Material::from_file(path)?.emissivity(nodes)?,
            };
            radiance.iter_mut().zip(&emissivity).for_each(|(radiance, e)| *radiance *= e);
            Ok(Light::Radiance(radiance))
        }
        LightSource::Spectrum { path, column } => Ok(Light::Radiance(spectrum(path, column, nodes)?)),
        LightSource::Rows([first, last]) => {
            let counts = match cube {
                Cube::F32(rows) => mean_of(rows.as_ref(), *first, *last),
                Cube::F64(rows) => mean_of(rows.as_ref(), *first, *last),
            }?;
            Ok(Light::Counts(counts.iter().map(|n| n / unit).collect()))
        }
    }
}

/// A column of a table of photon radiances at the nodes.
pub(in crate::study) fn spectrum(path: &Path, column: &str, nodes_cm1: &[f64]) -> Result<Vec<f64>> {
    let table = columns(path)?;
    let Some((_, rows)) = table.iter().find(|(name, _)| name == column) else {
        let names = table.iter().map(|(name, _)| name.as_str());
        return Err(Error::unknown_name("column", column, names).for_key("column").in_file(path));
    };
    let mut rows = rows.clone();
    rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    on_nodes(&rows, nodes_cm1).map_err(|error| error.in_file(path))
}

/// A spectrum on straight lines between its rows, which must reach over all nodes.
fn on_nodes(rows: &[(f64, f64)], nodes_cm1: &[f64]) -> Result<Vec<f64>> {
    let (Some((low, _)), Some((high, _))) = (rows.first(), rows.last()) else {
        return Err(Error::malformed("the table has no rows", "write one for every wavenumber"));
    };
    let (xs, ys): (Vec<f64>, Vec<f64>) = rows.iter().copied().unzip();
    let at = |nu: &f64| {
        if !(*low..=*high).contains(nu) {
            let found = format!("the spectrum reaches from {low} to {high} cm^-1, the bands to {nu} cm^-1");
            return Err(Error::malformed(found, "give rows that cover the bands"));
        }
        let value = interpolated(&xs, &ys, *nu);
        if value < 0.0 {
            let found = format!("a radiance of {value} at {nu} cm^-1");
            return Err(Error::malformed(found, "write photons s^-1 m^-2 sr^-1 per cm^-1, from 0"));
        }
        Ok(value)
    };
    nodes_cm1.iter().map(at).collect()
}

fn mean_of<S: Sample>(cube: &dyn Rows<S>, first: usize, last: usize) -> Result<Vec<f64>> {
    let shape = cube.shape();
    if last > shape.rows() {
        let found = format!("rows {first} to {last} of a cube of {}", shape.rows());
        return Err(Error::malformed(found, format!("write rows up to {}", shape.rows())));
    }
    let (mut sum, mut count, mut buffer) = (vec![0.0; shape.bands()], 0.0, Vec::new());
    for row in first..last {
        for pixel in cube.read(row..row + 1, &mut buffer)?.chunks(shape.bands()) {
            if pixel.iter().all(|sample| (*sample).into().is_finite()) {
                pixel.iter().zip(&mut sum).for_each(|(sample, sum)| *sum += (*sample).into());
                count += 1.0;
            }
        }
    }
    if count == 0.0 {
        return Err(Error::malformed("these rows hold no pixel with all its samples", "name other rows"));
    }
    sum.iter_mut().for_each(|sum| *sum /= count);
    Ok(sum)
}

/// The largest sample of a cube.
fn largest(cube: &Cube) -> Result<f64> {
    fn of<S: Sample>(cube: &dyn Rows<S>) -> Result<f64> {
        let mut buffer = Vec::new();
        (0..cube.shape().rows()).try_fold(0.0, |most, row| {
            let samples = cube.read(row..row + 1, &mut buffer)?;
            let finite =
                samples.iter().map(|sample| (*sample).into()).filter(|sample: &f64| sample.is_finite());
            Ok(finite.fold(most, f64::max))
        })
    }
    match cube {
        Cube::F32(rows) => of(rows.as_ref()),
        Cube::F64(rows) => of(rows.as_ref()),
    }
}
