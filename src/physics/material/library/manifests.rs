//! What of a library is made of manifests: the embedded materials, and those of a user's own manifest.

use super::{Library, Stored};
use crate::error::{Error, Result};
use crate::material::embedded;
use crate::material::manifest::{self, Deferred, ManifestFiles, Surroundings};
use std::path::Path;
use std::sync::Arc;

impl Library {
    /// The materials that come with the crate: `spectra/manifest.toml`.
    ///
    /// # Errors
    /// None that a release can have: the embedded data are tested.
    pub fn embedded() -> Result<Self> {
        let path = Path::new("spectra/manifest.toml");
        let manifest = Arc::new(Deferred::parse(embedded::MANIFEST, path)?);
        let stored =
            |(index, name): (usize, &str)| (name.to_owned(), Stored::Embedded(Arc::clone(&manifest), index));
        Ok(Self {
            materials: manifest.names().enumerate().map(stored).collect(),
            classes: manifest.classes().iter().cloned().collect(),
            ..Self::empty()
        })
    }

    /// Adds the materials and classes of a manifest: its text, the path that errors call it by, the directory that paths in it are
    /// relative to, and the files that it names.
    ///
    /// # Errors
    /// A manifest that is wrong, or files of it; a class of the name of a material.
    pub fn add_manifest(
        &mut self,
        text: &str,
        path: &Path,
        directory: &Path,
        files: &dyn ManifestFiles,
    ) -> Result<()> {
        let known = |name: &str| self.get(name).map(|material| material.model.clone());
        for material in manifest::parse(text, path, &Surroundings { files, known: &known })? {
            self.add(material);
        }
        for (name, class) in manifest::classes(text, path, directory)? {
            if self.contains(&name) {
                let found = format!("`{name}` is a class and a material");
                let error = Error::malformed(found, "call one of them otherwise");
                return Err(error.for_key(format!("class.{name}")).in_file(path));
            }
            if self.classes.insert(name.clone(), class).is_some() {
                self.warnings.push(format!("the class `{name}` is replaced by that of {}", path.display()));
                self.replaced.push(name.clone());
            }
        }
        Ok(())
    }
}
