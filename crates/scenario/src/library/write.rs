//! Writes what a library is made from, as TOML and, in the same structure, for JSON.

use super::super::decompose::write::{cube_written, truth_written, unknown_written};
use super::super::entries::{Document, Entries, Part, entries, text};
use super::super::paths::Paths;
use super::LibraryScenario;
use hadar::units::Dimension;
use serde::{Serialize, Serializer};
use std::path::Path;

impl LibraryScenario {
    /// The file again, with paths below `directory` written relative to it.
    #[must_use]
    pub fn to_toml_beside(&self, directory: &Path) -> String {
        let absolute = std::path::absolute(directory).ok();
        text(self.document(Paths { beside: absolute.as_deref() }), &self.source)
    }

    fn document(&self, paths: Paths<'_>) -> Document {
        let mut document = Vec::new();
        if let Some(title) = &self.title {
            document.push(("title", Part::Value(title.as_str().into())));
        }
        document.extend(cube_written(
            &self.cube,
            self.bands.as_ref(),
            self.camera.as_ref(),
            &self.environment,
            paths,
        ));
        let [low, high] = self.clusters.count.map(|count| count as i64);
        let clusters = Entries::default();
        let clusters =
            if low == high { clusters.put("count", low) } else { clusters.put("count", vec![low, high]) };
        document
            .push(("clusters", Part::Table(clusters.put("max_emissivity", self.clusters.max_emissivity))));
        let known = self.emissivity;
        let written = Entries::default()
            .put("mean", known.mean)
            .put("magnitude_error", known.magnitude)
            .put("shape_error", known.shape)
            .put_quantity("correlation", Dimension::Wavenumber, Some(known.correlation_cm1));
        document.push(("emissivity", Part::Table(written)));
        document.push(("unknown", Part::Table(unknown_written(&self.unknown))));
        if let Some(truth) = &self.truth {
            document.push(("truth", Part::Table(truth_written(truth, paths))));
        }
        document
    }
}

/// The same keys as the TOML, quantities in the units used inside, with absolute paths.
impl Serialize for LibraryScenario {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        entries(self.document(Paths { beside: None }), serializer)
    }
}
