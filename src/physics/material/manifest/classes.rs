//! The classes of a manifest.

use crate::error::{Error, Result};
use crate::material::class::{ClassSpec, MaterialRef, Spread};
use crate::material::is_spectra;
use crate::words::kebab_case;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::Path;

/// A table `[class.NAME]`.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ClassEntry {
    /// Said for readers of the manifest.
    #[serde(rename = "description")]
    _description: Option<String>,
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
) -> Result<Vec<(String, ClassSpec)>> {
    let of = |(name, entry): (String, ClassEntry)| {
        let spec = entry.spec(&name, directory);
        spec.map(|spec| (name.clone(), spec))
            .map_err(|error| error.for_key(format!("class.{name}")).in_file(path))
    };
    read.into_iter().map(of).collect()
}

impl ClassEntry {
    fn spec(self, name: &str, directory: &Path) -> Result<ClassSpec> {
        if name != kebab_case(name) || name.is_empty() {
            let found = format!("the name `{name}` is not in kebab-case");
            return Err(Error::malformed(found, "write small letters, digits and hyphens"));
        }
        let reference = |text: String| {
            let is_path = text.contains(['/', '\\']) || is_spectra(&text);
            if is_path { MaterialRef::File(directory.join(text)) } else { MaterialRef::Name(text) }
        };
        Ok(ClassSpec {
            materials: self.materials.into_iter().map(reference).collect(),
            weights: self.weights,
            mixtures: self.mixtures,
            spread: Spread::stated(self.covariance.is_some(), self.emissivity_error, self.correlation_cm1)?,
        })
    }
}
