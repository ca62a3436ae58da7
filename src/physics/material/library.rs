//! Named materials: the embedded ones, and a user's own.
//!
//! A user's material replaces one of the same name, with a warning. Where several files of one
//! directory define the same name, each is kept as `NAME@FILE`, and the bare name is an error that lists them.
//! Embedded materials are made of their files only when they are named.

#[cfg(feature = "library")]
mod manifests;

use super::Material;
use super::class::{ClassSpec, LibraryClass};
#[cfg(feature = "library")]
use super::manifest::Deferred;
use crate::demand::{Reason, Thing, Work};
use crate::error::{Error, Result};
use std::collections::{BTreeMap, BTreeSet};
#[cfg(feature = "library")]
use std::sync::Arc;

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
    classes: BTreeMap<String, LibraryClass>,
    warnings: Vec<String>,
    /// Names that now mean another material or class than before.
    replaced: Vec<String>,
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
    #[must_use]
    pub fn is_strict(&self) -> bool {
        self.strict
    }

    /// Adds one material. It replaces one of the same name, with a warning.
    pub fn add(&mut self, material: Material) {
        let name = material.name().to_owned();
        self.ambiguous.remove(&name);
        if self.materials.contains_key(&name) {
            let source = &material.provenance().source;
            self.warnings.push(format!("the material `{name}` is replaced by that of {source}"));
            self.replaced.push(name.clone());
        }
        if self.classes.remove(&name).is_some() {
            let source = &material.provenance().source;
            self.warnings.push(format!("the class `{name}` is replaced by the material of {source}"));
            self.replaced.push(name.clone());
        }
        self.materials.insert(name, Stored::Read(Box::new(material)));
    }

    /// The material of a name.
    ///
    /// # Errors
    /// An unknown name, with the nearest ones or the class that is meant; a class; a name that several files define, with the
    /// qualified names.
    pub fn get(&self, name: &str) -> Result<&Material> {
        if let Some(qualified) = self.ambiguous.get(name) {
            return Err(Error::malformed(
                format!("the material `{name}` is defined by {} files", qualified.len()),
                format!("write one of `{}`", qualified.join("`, `")),
            ));
        }
        match self.materials.get(name) {
            Some(stored) => stored.material(),
            None => Err(self.is_no_material(name)),
        }
    }

    /// What to write in the place of a name that no material has.
    fn is_no_material(&self, name: &str) -> Error {
        if self.class(name).is_some() {
            let found = format!("`{name}` is a class of several spectra, and one is needed here");
            return Error::malformed(found, "name a material");
        }
        let word = name.to_lowercase();
        let meant = self.classes.iter().find(|(_, class)| class.also.contains(&word));
        if let Some((class, LibraryClass { description, .. })) = meant {
            let said = if description.is_empty() { String::new() } else { format!(" ({description})") };
            return Error::malformed(
                format!("there is no material `{name}`"),
                format!("write `{class}`, the class of the library for it{said}"),
            );
        }
        Error::unknown_name("material", name, self.names().chain(self.classes.keys().map(String::as_str)))
    }

    /// The class of a name, if a manifest has one.
    #[must_use]
    pub fn class(&self, name: &str) -> Option<&ClassSpec> {
        self.classes.get(name).map(|class| &class.spec)
    }

    /// What belongs to the class of that name and is not in it.
    #[must_use]
    pub fn without(&self, name: &str) -> &[String] {
        self.classes.get(name).map_or(&[], |class| &class.without)
    }

    /// All classes by name.
    pub fn classes(&self) -> impl Iterator<Item = (&str, &LibraryClass)> {
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

    /// Notes what was passed over while adding.
    pub fn warn(&mut self, warnings: impl IntoIterator<Item = String>) {
        self.warnings.extend(warnings);
    }

    /// What was replaced or passed over while adding.
    #[must_use]
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// Names that now mean another material or class than before something was added.
    #[must_use]
    pub fn replaced(&self) -> &[String] {
        &self.replaced
    }

    /// Adds materials by names that may differ from their own, which is then ambiguous: it is an error that lists those names.
    pub fn add_qualified(&mut self, materials: impl IntoIterator<Item = (Material, String)>) {
        let mut ambiguous: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
        for (material, name) in materials {
            if material.name != name {
                ambiguous.entry(material.name.clone()).or_default().insert(name.clone());
            }
            self.add(material.with_name(name));
        }
        for (name, qualified) in ambiguous {
            let qualified: Vec<String> = qualified.into_iter().collect();
            if self.materials.remove(&name).is_some() {
                let listed = qualified.join("`, `");
                self.warnings.push(format!("the material `{name}` is replaced by `{listed}`"));
                self.replaced.push(name.clone());
            }
            self.ambiguous.insert(name, qualified);
        }
    }
}
