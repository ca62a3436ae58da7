//! The `[atmosphere]` of a scenario: the air on the path from target to camera, a known model or a file.

use std::path::PathBuf;

use super::entries::Entries;
use super::paths::{Paths, file};
use super::section::Entry;
use hadar::error::{Error, Result};
use hadar::units::Dimension;

/// The air between target and camera (`[atmosphere]`).
#[derive(Debug, Clone, PartialEq)]
pub struct AtmosphereSpec {
    /// Where its transmittance comes from.
    pub source: AtmosphereSource,
    /// Temperature of the air, K; above 0. `None` is the model's own; a table always has one.
    pub temperature_k: Option<f64>,
}

/// Where the transmittance of the air comes from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum AtmosphereSource {
    /// Name of an embedded model atmosphere, e.g. `us-standard`.
    Model(String),
    /// Absolute path of a CSV with transmittances by wavenumber and length of the path.
    Table(PathBuf),
}

impl AtmosphereSpec {
    pub(super) fn read(entry: &Entry<'_>) -> Result<Self> {
        let section = entry.section()?;
        section.at_most_one(&["model", "table"])?;
        let temperature_k = section.quantity("temperature")?;
        let model = section.text("model", "\"us-standard\"")?;
        let source = match (model, section.read("table", file)?) {
            (Some(name), _) => AtmosphereSource::Model(name),
            (None, Some(path)) => AtmosphereSource::Table(path),
            (None, None) => {
                let found = "neither model nor table is given";
                let instead = "write model = \"us-standard\" or table = \"my_path.csv\"";
                return Err(entry.fail(Error::malformed(found, instead)));
            }
        };
        if temperature_k.is_none() && matches!(source, AtmosphereSource::Table(_)) {
            let found = "the key is missing, and a table of transmittances does not know it";
            let instead = "write temperature = \"15 degC\", that of the air";
            return Err(section.fail("temperature", Error::malformed(found, instead)));
        }
        Ok(Self { source, temperature_k })
    }

    pub(super) fn written(&self, paths: Paths<'_>) -> Entries {
        let entries = match &self.source {
            AtmosphereSource::Model(name) => Entries::default().put("model", name.as_str()),
            AtmosphereSource::Table(path) => Entries::default().put("table", paths.file(path)),
        };
        entries.put_quantity("temperature", Dimension::Temperature, self.temperature_k)
    }
}
