//! A manifest whose materials are made as they are named: a scenario of two materials reads two spectra, not all.

use super::{Around, Entry, Model, classes, made, manifest};
use crate::error::Result;
use crate::inputs;
use crate::material::Material;
use crate::material::class::LibraryClass;
use crate::material::embedded::{self, Embedded};
use std::path::Path;
use std::sync::{Arc, OnceLock};

/// The entries of a manifest, and the materials that were made of them so far.
#[derive(Debug)]
pub(in crate::physics::material) struct Deferred {
    text: &'static str,
    path: &'static Path,
    entries: Vec<Entry>,
    classes: Vec<(String, LibraryClass)>,
    made: Vec<OnceLock<Material>>,
    /// What each is made of, once somebody notes what is used.
    definitions: Vec<OnceLock<Arc<[u8]>>>,
}

impl Deferred {
    /// Reads the entries, and none of their files.
    ///
    /// # Errors
    /// TOML or keys that are wrong, or another version.
    pub(in crate::physics::material) fn parse(text: &'static str, path: &'static Path) -> Result<Self> {
        let read = manifest(text, path)?;
        let classes = classes::of(read.class, path, Path::new(""))?;
        let made = read.material.iter().map(|_| OnceLock::new()).collect();
        let definitions = read.material.iter().map(|_| OnceLock::new()).collect();
        Ok(Self { text, path, entries: read.material, classes, made, definitions })
    }

    /// Names of the materials, in the order of the entries.
    pub(in crate::physics::material) fn names(&self) -> impl Iterator<Item = &str> {
        self.entries.iter().map(|entry| entry.name.as_str())
    }

    /// The classes by name.
    pub(in crate::physics::material) fn classes(&self) -> &[(String, LibraryClass)] {
        &self.classes
    }

    /// Whether a material was made.
    pub(in crate::physics::material) fn is_made(&self, index: usize) -> bool {
        self.made.get(index).is_some_and(|made| made.get().is_some())
    }

    /// The material of an entry, made of its files the first time it is asked for.
    ///
    /// # Errors
    /// A missing file or material, a parameter out of range; no entry of that index.
    pub(in crate::physics::material) fn material(&self, index: usize) -> Result<&Material> {
        let (Some(slot), Some(entry)) = (self.made.get(index), self.entries.get(index)) else {
            let names = self.names();
            return Err(crate::Error::unknown_name("entry of the manifest", &index.to_string(), names));
        };
        if let Some(material) = slot.get() {
            return Ok(material);
        }
        // Only entries further up count, so that none can be made of itself.
        let earlier = |name: &str| -> Option<Result<Arc<Model>>> {
            let found = self.entries[..index].iter().position(|entry| entry.name == name)?;
            Some(self.material(found).map(|material| material.model.clone()))
        };
        let known = |name: &str| Err(crate::Error::unknown_name("material", name, self.names()));
        let material =
            made(entry.clone(), self.path, &Around { earlier: &earlier, files: &Embedded, known: &known })?;
        Ok(slot.get_or_init(|| material))
    }

    /// The material of an entry that someone asked for by name, noted among what is used.
    ///
    /// # Errors
    /// As [`Deferred::material`].
    pub(in crate::physics::material) fn named(&self, index: usize) -> Result<&Material> {
        let material = self.material(index)?;
        inputs::built_in("material", material.name(), || {
            let made_of = || self.definition(index).into_bytes().into();
            self.definitions.get(index).map_or_else(made_of, |slot| Arc::clone(slot.get_or_init(made_of)))
        });
        Ok(material)
    }

    /// All that a material is made of, as text: its entry, the files that this names, and the same of every material further
    /// up that it is made of. It changes when one of these does, and not with other entries.
    fn definition(&self, index: usize) -> String {
        let entry = self.text.split("[[material]]\n").nth(index + 1).unwrap_or_default();
        // Classes stand behind the last material.
        let entry = entry.split("\n[class.").next().unwrap_or_default();
        let lines = entry.lines().filter(|line| !line.is_empty() && !line.starts_with('#'));
        let mut definition: String = lines.flat_map(|line| [line, "\n"]).collect();
        let quoted: Vec<&str> = entry.split('"').skip(1).step_by(2).collect();
        for name in quoted.iter().filter(|name| name.ends_with(".csv")) {
            definition.push_str(embedded::text(name).unwrap_or_default());
        }
        let made_of = |name: &str| entry.contains(&format!("material = \"{name}\""));
        for (earlier, _) in self.names().take(index).enumerate().filter(|(_, name)| made_of(name)) {
            definition.push_str(&self.definition(earlier));
        }
        definition
    }
}
