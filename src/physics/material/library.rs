//! Named materials: the embedded ones, and a user's own from a directory or file.
//!
//! A user's material replaces one of the same name, with a warning. Where several files of one
//! directory define the same name, each is kept as `NAME@FILE`, and the bare name is an error that lists them.
//! Embedded materials are made of their files only when they are named.

#[cfg(feature = "library")]
mod manifests;

use super::Material;
use super::class::ClassSpec;
#[cfg(feature = "library")]
use super::manifest::Deferred;
use super::read::{self, Origin, qualified};
use crate::demand::{Reason, Thing, Work};
use crate::error::{Error, Result};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
#[cfg(feature = "library")]
use std::sync::Arc;

/// The name of a manifest within a directory.
const MANIFEST: &str = "manifest.toml";

/// Materials by name.
///
/// ```
/// use hadar::material::Library;
/// let library = Library::embedded()?;
/// assert!(library.iter().count() >= 30);
/// let error = library.get("aluminum").unwrap_err().to_string();
/// assert!(error.contains("`aluminium"), "{error}");
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone, Default)]
pub struct Library {
    materials: BTreeMap<String, Stored>,
    ambiguous: BTreeMap<String, Vec<String>>,
    classes: BTreeMap<String, ClassSpec>,
    warnings: Vec<String>,
    strict: bool,
}

/// A material, or where it can be made.
#[derive(Debug, Clone)]
enum Stored {
    Read(Box<Material>),
    #[cfg(feature = "library")]
    Embedded(Arc<Deferred>, usize),
}

impl Stored {
    fn material(&self) -> Result<&Material> {
        match self {
            Self::Read(material) => Ok(material),
            #[cfg(feature = "library")]
            Self::Embedded(manifest, index) => manifest.named(*index),
        }
    }

    fn is_made(&self) -> bool {
        match self {
            Self::Read(_) => true,
            #[cfg(feature = "library")]
            Self::Embedded(manifest, index) => manifest.is_made(*index),
        }
    }
}

impl Library {
    /// A library without materials.
    #[must_use]
    pub fn empty() -> Self {
        Self::default()
    }

    /// The same library, which from now on refuses a folder for any file in it that is no spectrum, and does not pass it over.
    #[must_use]
    pub fn strict(mut self, strict: bool) -> Self {
        self.strict = strict;
        self
    }

    /// Whether a folder is refused for any file in it that is no spectrum.
    pub(super) fn is_strict(&self) -> bool {
        self.strict
    }

    /// Adds the materials of a directory: those of its `manifest.toml` if it has one, else those of all its
    /// files of spectra ([`read::is_spectra`]). Of these, what cannot be read or holds no emissivity is passed over with a warning,
    /// unless the library is [`strict`](Self::strict).
    ///
    /// # Errors
    /// A directory that cannot be read or holds no material; in a strict library a file that is wrong (see [`read::from_file`]).
    pub fn add_directory(&mut self, directory: &Path) -> Result<()> {
        let path = directory.join(MANIFEST);
        if path.is_file() {
            return self.add_manifest(&path, directory);
        }
        let (mut sources, mut passed_over) = (Vec::new(), Vec::new());
        for file in read::spectra_in(directory)? {
            match read::from_file(&file) {
                Ok(materials) => sources.push((file, materials)),
                Err(error) if self.strict => return Err(error),
                Err(error) => passed_over.push(error),
            }
        }
        if sources.is_empty() {
            let found = match passed_over.first() {
                None => "the directory holds no spectra".to_owned(),
                Some(first) => format!("none of its {} files is a spectrum: {first}", passed_over.len()),
            };
            let instead = "put .csv, .txt, .jdx or .sli spectra or a manifest.toml into it";
            return Err(Error::malformed(found, instead).in_file(directory));
        }
        self.warnings.extend(passed_over.iter().map(|error| format!("passed over: {error}")));
        self.add_sources(sources);
        Ok(())
    }

    /// Adds the materials of one file: a spectrum, a table of materials, or a manifest (`.toml`).
    ///
    /// # Errors
    /// As [`read::from_file`].
    pub fn add_file(&mut self, path: &Path) -> Result<()> {
        if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml")) {
            return self.add_manifest(path, path.parent().unwrap_or(Path::new("")));
        }
        let materials = read::from_file(path)?;
        self.add_sources(vec![(path.to_owned(), materials)]);
        Ok(())
    }

    /// Adds a directory or a file, whichever it is.
    ///
    /// # Errors
    /// As [`Library::add_directory`] and [`Library::add_file`].
    pub fn add_path(&mut self, path: &Path) -> Result<()> {
        if path.is_dir() { self.add_directory(path) } else { self.add_file(path) }
    }

    /// Adds one material. It replaces one of the same name, with a warning.
    pub fn add(&mut self, material: Material) {
        let name = material.name().to_owned();
        self.ambiguous.remove(&name);
        if self.materials.contains_key(&name) {
            let source = &material.provenance().source;
            self.warnings.push(format!("the material `{name}` is replaced by that of {source}"));
        }
        if self.classes.remove(&name).is_some() {
            let source = &material.provenance().source;
            self.warnings.push(format!("the class `{name}` is replaced by the material of {source}"));
        }
        self.materials.insert(name, Stored::Read(Box::new(material)));
    }

    /// The material of a name.
    ///
    /// # Errors
    /// An unknown name, with the nearest ones; a name that several files define, with the qualified names.
    pub fn get(&self, name: &str) -> Result<&Material> {
        if let Some(qualified) = self.ambiguous.get(name) {
            return Err(Error::malformed(
                format!("the material `{name}` is defined by {} files", qualified.len()),
                format!("write one of `{}`", qualified.join("`, `")),
            ));
        }
        match self.materials.get(name) {
            Some(stored) => stored.material(),
            None => Err(Error::unknown_name("material", name, self.names())),
        }
    }

    /// The class of a name, if a manifest has one.
    #[must_use]
    pub fn class(&self, name: &str) -> Option<&ClassSpec> {
        self.classes.get(name)
    }

    /// All classes by name.
    pub fn classes(&self) -> impl Iterator<Item = (&str, &ClassSpec)> {
        self.classes.iter().map(|(name, class)| (name.as_str(), class))
    }

    /// Whether a material has this name, made or not.
    #[must_use]
    pub fn contains(&self, name: &str) -> bool {
        self.materials.contains_key(name) || self.ambiguous.contains_key(name)
    }

    /// All materials, in the order of their names. Where names will do, [`Library::names`] makes none of them.
    pub fn iter(&self) -> impl Iterator<Item = &Material> {
        // An embedded material that cannot be made is kept from a release by tests.
        self.materials.values().filter_map(|stored| stored.material().ok())
    }

    /// Whether there is no material.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.materials.is_empty()
    }

    /// How many of the spectra were made so far, and how many nobody asked for.
    #[must_use]
    pub fn work(&self) -> Work {
        let made = self.materials.values().filter(|stored| stored.is_made()).count();
        let mut work = Work::default();
        work.compute(Thing::LibrarySpectra, made as u64);
        work.spare(Thing::LibrarySpectra, Reason::NotAsked, (self.materials.len() - made) as u64);
        work
    }

    /// All names, in order.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.materials.keys().map(String::as_str)
    }

    /// What was replaced or passed over while adding.
    #[must_use]
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// Adds the materials of files; names that several of them define are qualified with what tells them apart.
    fn add_sources(&mut self, sources: Vec<(PathBuf, Vec<Material>)>) {
        let of = |(file, materials): (PathBuf, Vec<Material>)| {
            materials.into_iter().map(move |material| {
                let (name, sample) = (material.name.clone(), material.sample.clone());
                (material, Origin { name, sample, file: file.clone() })
            })
        };
        let (materials, origins): (Vec<Material>, Vec<Origin>) = sources.into_iter().flat_map(of).unzip();
        let names = qualified(&origins);
        let mut ambiguous: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
        for ((material, origin), name) in materials.into_iter().zip(&origins).zip(names) {
            if origin.name != name {
                ambiguous.entry(origin.name.clone()).or_default().insert(name.clone());
            }
            self.add(material.with_name(name));
        }
        for (name, qualified) in ambiguous {
            let qualified: Vec<String> = qualified.into_iter().collect();
            if self.materials.remove(&name).is_some() {
                let listed = qualified.join("`, `");
                self.warnings.push(format!("the material `{name}` is replaced by `{listed}`"));
            }
            self.ambiguous.insert(name, qualified);
        }
    }
}

#[cfg(not(feature = "library"))]
impl Library {
    fn add_manifest(&mut self, path: &Path, _: &Path) -> Result<()> {
        let instead = "build the crate with its feature `library`, or name the spectra themselves";
        Err(Error::malformed("this build reads no manifests", instead).in_file(path))
    }
}
