//! Writes a scenario of ranging by air with every default filled in, as TOML and, in the same structure, for JSON.

use super::super::entries::{Document, Entries, Part};
use super::super::paths::Paths;
use super::super::write::unknown;
use super::{AirRangingScenario, AirStereo, Demand};
use hadar::units::Dimension;

impl AirRangingScenario {
    pub(super) fn document(&self, paths: Paths<'_>) -> Document {
        let mut document = vec![("signal", Part::Value("air".into()))];
        for (name, part) in self.scene.document(paths).0 {
            match name {
                "title" => document.insert(0, (name, part)),
                "target" | "environment" | "atmosphere" | "bands" | "camera" => document.push((name, part)),
                _ => {}
            }
        }
        let air = &self.unknown;
        let more = air.air_temperature.map(|_| "air-temperature").into_iter();
        let more: Vec<&str> = more.chain(air.emissivity.map(|_| "emissivity")).collect();
        let written = unknown(&self.scene.unknown, &more, air.air_temperature.flatten());
        let written = match air.emissivity {
            Some(errors) => written.put("emissivity_error", errors.sigma).put_quantity(
                "emissivity_correlation",
                Dimension::Wavenumber,
                Some(errors.correlation_cm1),
            ),
            None => written,
        };
        let lengths: Vec<String> = self.distances_m.iter().map(|m| Dimension::Length.format(*m)).collect();
        let requirement = |demand: Demand| match demand {
            Demand::Absolute(error_m) => {
                Entries::default().put_quantity("distance_error", Dimension::Length, Some(error_m))
            }
            Demand::Relative(share) => Entries::default().put("relative_distance_error", share),
        };
        Document(document)
            .put("unknown", written)
            .put("distances", Entries::default().put_written("list", Dimension::Length, lengths))
            .put_if("stereo", self.stereo.as_ref().map(stereo))
            .put_if("requirement", self.requirement.map(requirement))
    }
}

fn stereo(spec: &AirStereo) -> Entries {
    Entries::default()
        .put_quantity("baseline", Dimension::Length, Some(spec.baseline_m))
        .put("window", spec.window.map(|side| side as i64).to_vec())
        .put("texture", spec.texture)
}
