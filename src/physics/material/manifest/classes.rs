//! The classes of a manifest.

use crate::error::{Error, Result};
use crate::material::class::{ClassSpec, LibraryClass, MaterialRef, Spread};
use crate::material::is_spectra;
use crate::words::{kebab_case, one_line};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::Path;

/// A table `[class.NAME]`.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ClassEntry {
    #[serde(default)]
    description: String,
    #[serde(default)]
    also: Vec<String>,
    #[serde(default)]
    without: Vec<String>,
    materials: Vec<String>,
    weights: Option<Vec<f64>>,
    #[serde(default)]
    mixtures: bool,
    covariance: Option<Covariance>,
    emissivity_error: Option<f64>,
    correlation_cm1: Option<f64>,
}

#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Covariance {
    Sample,
}

/// The classes of a manifest by name; `directory` is where its files are.
///
/// # Errors
/// A name that is not in kebab-case, covariances that contradict each other or are out of range.
pub(super) fn of(
    read: BTreeMap<String, ClassEntry>,
    path: &Path,
    directory: &Path,
) -> Result<Vec<(String, LibraryClass)>> {
    let of = |(name, entry): (String, ClassEntry)| {
        let class = entry.class(&name, directory);
        class
            .map(|class| (name.clone(), class))
            .map_err(|error| error.for_key(format!("class.{name}")).in_file(path))
    };
    read.into_iter().map(of).collect()
}

impl ClassEntry {
    fn class(self, name: &str, directory: &Path) -> Result<LibraryClass> {
        if name != kebab_case(name) || name.is_empty() {
            let found = format!("the name `{name}` is not in kebab-case");
            return Err(Error::malformed(found, "write small letters, digits and hyphens"));
        }
        let reference = |text: String| {
            let is_path = text.contains(['/', '\\']) || is_spectra(&text);
            if is_path { MaterialRef::File(directory.join(text)) } else { MaterialRef::Name(text) }
        };
        let spec = ClassSpec {
            materials: self.materials.into_iter().map(reference).collect(),
            weights: self.weights,
            mixtures: self.mixtures,
            spread: Spread::stated(self.covariance.is_some(), self.emissivity_error, self.correlation_cm1)?,
        };
        Ok(LibraryClass {
            spec,
            description: one_line(&self.description),
            also: self.also,
            without: self.without,
        })
    }
}
