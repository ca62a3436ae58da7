//! Writes what a library is made from, as TOML and, in the same structure, for JSON.

use super::super::decompose::write::{air_written, cube_written, truth_written, unknown_written};
use super::super::entries::{Document, Entries};
use super::super::paths::Paths;
use super::LibraryScenario;
use hadar::units::Dimension;

impl LibraryScenario {
    pub(super) fn document(&self, paths: Paths<'_>) -> Document {
        let [low, high] = self.clusters.count.map(|count| count as i64);
        let clusters = Entries::default();
        let clusters =
            if low == high { clusters.put("count", low) } else { clusters.put("count", vec![low, high]) };
        let known = self.emissivity;
        let emissivity = Entries::default()
            .put("mean", known.mean)
            .put("magnitude_error", known.magnitude)
            .put("shape_error", known.shape)
            .put_quantity("correlation", Dimension::Wavenumber, Some(known.correlation_cm1));
        let cube =
            cube_written(&self.cube, self.bands.as_ref(), self.camera.as_ref(), &self.environment, paths);
        Document::titled(self.title.as_ref())
            .and(cube)
            .put_if("atmosphere", self.atmosphere.as_ref().map(|one| air_written(one, paths)))
            .put("clusters", clusters.put("max_emissivity", self.clusters.max_emissivity))
            .put("emissivity", emissivity)
            .put("unknown", unknown_written(&self.unknown))
            .put_if("truth", self.truth.as_ref().map(|truth| truth_written(truth, paths)))
    }
}
