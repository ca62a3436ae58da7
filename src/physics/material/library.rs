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
use super::read::{self, Content};
use crate::demand::{Reason, Thing, Work};
use crate::error::{Error, Result};
use std::collections::BTreeMap;
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
}

/// A material, or where it can be made.
#[derive(Debug, Clone)]
enum Stored {
    Read(Material),
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

    /// Adds the materials of a directory: those of its `manifest.toml` if it has one, else those of all its
    /// `.csv` and `.txt` files. Files that hold no emissivity (transmittance, notes) are passed over with a warning.
    ///
    /// # Errors
    /// A directory that cannot be read or holds no material; a file that is wrong (see [`read::from_file`]).
    pub fn add_directory(&mut self, directory: &Path) -> Result<()> {
        let path = directory.join(MANIFEST);
        if path.is_file() {
            return self.add_manifest(&path, directory);
        }
        let mut sources = Vec::new();
        for file in spectra_in(directory)? {
            match read::content_of_file(&file)? {
                Content::Materials(materials) => sources.push((read::stem(&file), materials)),
                Content::NoEmissivity(reason) => self.warnings.push(format!("passed over: {reason}")),
            }
        }
        if sources.is_empty() {
            let instead = "put .csv or .txt spectra or a manifest.toml into it";
            return Err(Error::malformed("the directory holds no spectra", instead).in_file(directory));
        }
        self.add_sources(sources).map_err(|error| error.in_file(directory))
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
        self.add_sources(vec![(read::stem(path), materials)]).map_err(|error| error.in_file(path))
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
        self.materials.insert(name, Stored::Read(material));
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

    /// Adds the materials of files; names that more than one of them defines are qualified with the file's.
    fn add_sources(&mut self, sources: Vec<(String, Vec<Material>)>) -> Result<()> {
        let mut files_of: BTreeMap<String, Vec<String>> = BTreeMap::new();
        for (stem, materials) in &sources {
            for material in materials {
                files_of.entry(material.name().to_owned()).or_default().push(stem.clone());
            }
        }
        files_of.retain(|_, files| files.len() > 1);
        for (name, files) in &mut files_of {
            files.sort();
            for pair in files.windows(2) {
                if let [a, b] = pair
                    && a == b
                {
                    return Err(Error::malformed(
                        format!("two files called `{a}` define the material `{name}`"),
                        "rename one of them",
                    ));
                }
            }
        }
        for (stem, materials) in sources {
            for material in materials {
                if files_of.contains_key(material.name()) {
                    let qualified = format!("{}@{stem}", material.name());
                    self.add(material.with_name(qualified));
                } else {
                    self.add(material);
                }
            }
        }
        for (name, files) in files_of {
            let qualified = files.iter().map(|stem| format!("{name}@{stem}")).collect::<Vec<_>>();
            if self.materials.remove(&name).is_some() {
                let listed = qualified.join("`, `");
                self.warnings.push(format!("the material `{name}` is replaced by `{listed}`"));
            }
            self.ambiguous.insert(name, qualified);
        }
        Ok(())
    }
}

#[cfg(not(feature = "library"))]
impl Library {
    fn add_manifest(&mut self, path: &Path, _: &Path) -> Result<()> {
        let instead = "build the crate with its feature `library`, or name the spectra themselves";
        Err(Error::malformed("this build reads no manifests", instead).in_file(path))
    }
}

/// The `.csv` and `.txt` files of a directory, in the order of their names.
pub(super) fn spectra_in(directory: &Path) -> Result<Vec<PathBuf>> {
    let failed = |error: std::io::Error| match error.kind() {
        std::io::ErrorKind::NotFound => {
            Error::file("read the library", directory, "there is no such directory; check the name")
        }
        _ => Error::file("read the library", directory, error),
    };
    let mut files = Vec::new();
    for entry in std::fs::read_dir(directory).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        let known = |extension: &std::ffi::OsStr| {
            extension.eq_ignore_ascii_case("csv") || extension.eq_ignore_ascii_case("txt")
        };
        if path.is_file() && path.extension().is_some_and(known) {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}
