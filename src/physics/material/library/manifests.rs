//! What of a library is made of manifests: the embedded materials, and those of a user's own manifest.

use super::{Library, Stored};
use crate::error::{Error, Result};
use crate::grid::text_of_file;
use crate::material::manifest::{self, Deferred, Surroundings};
use crate::material::{Material, embedded};
use std::borrow::Cow;
use std::path::Path;
use std::sync::Arc;

impl Library {
    /// The materials that come with the crate: `spectra/manifest.toml`.
    ///
    /// # Errors
    /// None that a release can have: the embedded data are tested.
    pub fn embedded() -> Result<Self> {
        let file = |name: &str| {
            let text = embedded::FILES.iter().find(|(path, _)| *path == name).map(|(_, text)| *text);
            text.map(Cow::Borrowed).ok_or_else(|| {
                Error::unknown_name("embedded file", name, embedded::FILES.iter().map(|(path, _)| *path))
            })
        };
        let path = Path::new("spectra/manifest.toml");
        let manifest = Arc::new(Deferred::parse(embedded::MANIFEST, path, file)?);
        let stored =
            |(index, name): (usize, &str)| (name.to_owned(), Stored::Embedded(Arc::clone(&manifest), index));
        Ok(Self {
            materials: manifest.names().enumerate().map(stored).collect(),
            classes: manifest.classes().iter().cloned().collect(),
            ..Self::empty()
        })
    }

    pub(super) fn add_manifest(&mut self, path: &Path, directory: &Path) -> Result<()> {
        let text = text_of_file(path, "read the manifest")?;
        let file =
            |name: &str| text_of_file(&directory.join(name), "read a file of the manifest").map(Cow::Owned);
        for material in self.manifest(&text, path, &file)? {
            self.add(material);
        }
        for (name, class) in manifest::classes(&text, path, directory)? {
            if self.contains(&name) {
                let found = format!("`{name}` is a class and a material");
                let error = Error::malformed(found, "call one of them otherwise");
                return Err(error.for_key(format!("class.{name}")).in_file(path));
            }
            if self.classes.insert(name.clone(), class).is_some() {
                self.warnings.push(format!("the class `{name}` is replaced by that of {}", path.display()));
            }
        }
        Ok(())
    }

    fn manifest(
        &self,
        text: &str,
        path: &Path,
        file: &dyn Fn(&str) -> Result<Cow<'static, str>>,
    ) -> Result<Vec<Material>> {
        let known = |name: &str| self.get(name).map(|material| material.model.clone());
        manifest::parse(text, path, &Surroundings { file, known: &known })
    }
}
