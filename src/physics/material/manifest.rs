//! The manifest of a library: one `[[material]]` of a TOML file for each material.
//!
//! ```toml
//! version = 1
//!
//! [[material]]
//! name = "brass-rough"
//! description = "sand-blasted brass"      # this and the next five may be left out
//! category = "metal"
//! basis = "model surface"
//! source = "…"
//! licence = "…"
//! note = "…"
//! range_cm1 = [690.0, 1362.0]             # only where the model is vouched for in a narrower range than it has
//! model = { cavity = { area_ratio = 6.0, of = { half-space = { nk = "nk/brass.csv" } } } }
//! ```
//!
//! A model is one of `constant = e`, `polynomial = {…}`, `table = "file.csv"`, `half-space = medium`,
//! `film = { film = medium, thickness_um, substrate = medium }`, `slab = { medium, thickness_um }`,
//! `cavity = { area_ratio, of = model }`, `mixture = [{ parts, of = model }, …]`, `material = "name"` (one
//! further up, or of a library added before). A medium is one of `nk = "file.csv"`, `drude`, `lorentz`,
//! `factorised`, `gaussian`. Files are sought beside the manifest.
//!
//! A class of several of them (`class.rs`) has a table of its own, after the materials:
//!
//! ```toml
//! [class.bare-metal]
//! materials = ["gold", "iron", "my_steel.csv", "steels/"]   # names, files, folders, patterns
//! weights = [1.0, 2.0, 1.0, 1.0]                            # this and the next may be left out
//! mixtures = true
//! covariance = "sample"                                     # or emissivity_error = 0.01, correlation_cm1 = 50.0
//! description = "…"
//! also = ["metal"]                                          # words in whose place this class is to be written
//! ```

mod classes;
mod deferred;

pub(super) use deferred::Deferred;

use super::class::LibraryClass;
use super::dielectric::Dielectric;
use super::gaussian::Gaussian;
use super::model::{Model, Polynomial};
use super::oscillator::{Drude, Factorised, Lorentz};
use super::provenance::{Basis, Provenance};
use super::{Material, OpticalConstants};
use crate::error::{Error, Result};
use crate::words::{kebab_case, one_line};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

/// The version of the format that this reads.
const VERSION: u32 = 1;

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Manifest {
    version: u32,
    #[serde(default)]
    material: Vec<Entry>,
    #[serde(default)]
    class: BTreeMap<String, classes::ClassEntry>,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    name: String,
    #[serde(default)]
    description: String,
    #[serde(default = "user")]
    category: String,
    #[serde(default = "user_file")]
    basis: Basis,
    #[serde(default)]
    source: String,
    #[serde(default)]
    licence: String,
    #[serde(default)]
    note: String,
    range_cm1: Option<[f64; 2]>,
    model: ModelEntry,
}

fn user() -> String {
    "user".to_owned()
}

fn user_file() -> Basis {
    Basis::UserFile
}

#[derive(Debug, Clone, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum ModelEntry {
    Constant(f64),
    Polynomial(Polynomial),
    Table(String),
    HalfSpace(Medium),
    Film(FilmEntry),
    Slab(SlabEntry),
    Cavity(CavityEntry),
    Mixture(Vec<PartEntry>),
    Material(String),
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct FilmEntry {
    film: Medium,
    thickness_um: f64,
    substrate: Medium,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct SlabEntry {
    medium: Medium,
    thickness_um: f64,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct CavityEntry {
    area_ratio: f64,
    of: Box<ModelEntry>,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct PartEntry {
    parts: f64,
    of: ModelEntry,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Medium {
    Nk(String),
    Drude(Drude),
    Lorentz(Lorentz),
    Factorised(Factorised),
    Gaussian(Gaussian),
}

/// The files that a manifest names.
pub trait ManifestFiles {
    /// The one spectrum of a file.
    ///
    /// # Errors
    /// A file that cannot be read, or does not hold one spectrum.
    fn spectrum(&self, file: &str) -> Result<Material>;

    /// The optical constants of a file.
    ///
    /// # Errors
    /// A file that cannot be read, or holds no columns `n` and `k`.
    fn constants(&self, file: &str) -> Result<OpticalConstants>;
}

/// Where a manifest's files and earlier materials come from.
pub(super) struct Surroundings<'a> {
    /// The files named in the manifest.
    pub(super) files: &'a dyn ManifestFiles,
    /// The model of a material of a library added before.
    pub(super) known: &'a dyn Fn(&str) -> Result<Arc<Model>>,
}

/// The same, with the materials further up.
struct Around<'a> {
    /// The model of a material further up, if there is one of that name.
    earlier: &'a dyn Fn(&str) -> Option<Result<Arc<Model>>>,
    /// See [`Surroundings`].
    files: &'a dyn ManifestFiles,
    /// See [`Surroundings`].
    known: &'a dyn Fn(&str) -> Result<Arc<Model>>,
}

/// Reads a manifest; `path` is what errors call it.
///
/// # Errors
/// TOML or keys that are wrong, another version, a missing file or material, a parameter out of range; each
/// with the line or the material it is in.
pub(super) fn parse(text: &str, path: &Path, around: &Surroundings<'_>) -> Result<Vec<Material>> {
    let mut materials = Vec::new();
    let mut models: BTreeMap<String, Arc<Model>> = BTreeMap::new();
    for entry in entries(text, path)? {
        let name = entry.name.clone();
        let earlier = |name: &str| models.get(name).map(|model| Ok(model.clone()));
        let around = Around { earlier: &earlier, files: around.files, known: around.known };
        let built = made(entry, path, &around)?;
        models.insert(name, built.model.clone());
        materials.push(built);
    }
    Ok(materials)
}

/// The entries of a manifest.
fn entries(text: &str, path: &Path) -> Result<Vec<Entry>> {
    manifest(text, path).map(|manifest| manifest.material)
}

/// The classes of a manifest by name; `directory` is where its files are.
///
/// # Errors
/// As [`parse`]; a name that is not in kebab-case, covariances that contradict each other or are out of range.
pub(super) fn classes(text: &str, path: &Path, directory: &Path) -> Result<Vec<(String, LibraryClass)>> {
    classes::of(manifest(text, path)?.class, path, directory)
}

fn manifest(text: &str, path: &Path) -> Result<Manifest> {
    let manifest: Manifest = toml::from_str(text).map_err(|error| syntax(text, &error).in_file(path))?;
    if manifest.version == VERSION {
        return Ok(manifest);
    }
    Err(Error::malformed(
        format!("version {} of the manifest format", manifest.version),
        format!("write version = {VERSION}"),
    )
    .for_key("version")
    .in_file(path))
}

/// The material of an entry.
fn made(entry: Entry, path: &Path, around: &Around<'_>) -> Result<Material> {
    let name = entry.name.clone();
    build(entry, around).map_err(|error| error.for_key(format!("material `{name}`")).in_file(path))
}

/// A TOML error on one line, with its place.
fn syntax(text: &str, error: &toml::de::Error) -> Error {
    let message = error.message().lines().collect::<Vec<_>>().join(", ");
    let wrong = Error::malformed(message, "see the keys of a manifest in spectra/README.md");
    match error.span().and_then(|span| text.get(..span.start)) {
        Some(before) => wrong.on_line(before.matches('\n').count() + 1),
        None => wrong,
    }
}

fn build(entry: Entry, around: &Around<'_>) -> Result<Material> {
    if entry.name != kebab_case(&entry.name) || entry.name.is_empty() {
        let instead = match kebab_case(&entry.name) {
            kebab if kebab.is_empty() => "write letters and digits, such as `my-paint`".to_owned(),
            kebab => format!("write `{kebab}`"),
        };
        let found = format!("the name `{}` is not in kebab-case", entry.name);
        return Err(Error::malformed(found, instead));
    }
    if (around.earlier)(&entry.name).is_some() {
        return Err(Error::malformed("this name is there twice", "give every material its own name"));
    }
    let builder = Builder { around };
    let mut model = builder.model(entry.model)?;
    if let Some([low, high]) = entry.range_cm1 {
        model = Arc::new(Model::within(low, high, model)?);
    }
    // In TOML a text may have several lines; a list of materials has one for each.
    let line = |text: String| one_line(&text);
    Ok(Material {
        name: entry.name,
        provenance: Provenance {
            description: line(entry.description),
            category: line(entry.category),
            basis: entry.basis,
            source: line(entry.source),
            licence: line(entry.licence),
            note: line(entry.note),
        },
        model,
        extrapolation: None,
        warnings: Vec::new(),
        read_as: String::new(),
        sample: String::new(),
    })
}

struct Builder<'a> {
    around: &'a Around<'a>,
}

impl Builder<'_> {
    fn model(&self, entry: ModelEntry) -> Result<Arc<Model>> {
        let model = match entry {
            ModelEntry::Constant(emissivity) => Model::constant(emissivity)?,
            ModelEntry::Polynomial(polynomial) => Model::polynomial(polynomial)?,
            ModelEntry::Table(file) => {
                return self.around.files.spectrum(&file).map(|one| one.model);
            }
            ModelEntry::HalfSpace(medium) => Model::HalfSpace(self.medium(medium)?),
            ModelEntry::Film(FilmEntry { film, thickness_um, substrate }) => {
                Model::film(self.medium(film)?, thickness_um, self.medium(substrate)?)?
            }
            ModelEntry::Slab(SlabEntry { medium, thickness_um }) => {
                Model::slab(self.medium(medium)?, thickness_um)?
            }
            ModelEntry::Cavity(CavityEntry { area_ratio, of }) => {
                Model::cavity(area_ratio, self.model(*of)?)?
            }
            ModelEntry::Mixture(parts) => Model::mean(
                parts
                    .into_iter()
                    .map(|PartEntry { parts, of }| Ok((parts, self.model(of)?)))
                    .collect::<Result<_>>()?,
            )?,
            ModelEntry::Material(name) => {
                return (self.around.earlier)(&name).unwrap_or_else(|| (self.around.known)(&name));
            }
        };
        Ok(Arc::new(model))
    }

    fn medium(&self, medium: Medium) -> Result<Dielectric> {
        Ok(match medium {
            Medium::Nk(file) => Dielectric::Constants(self.around.files.constants(&file)?),
            Medium::Drude(drude) => Dielectric::Drude(drude),
            Medium::Lorentz(lorentz) => Dielectric::Lorentz(lorentz),
            Medium::Factorised(factorised) => Dielectric::Factorised(factorised),
            Medium::Gaussian(gaussian) => Dielectric::Gaussian(gaussian),
        })
    }
}
