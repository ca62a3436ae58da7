//! Writes a scenario of ranging by air with every default filled in, as TOML and, in the same structure, for JSON.

use super::super::entries::{Document, Entries, Part, entries, text};
use super::super::paths::Paths;
use super::super::write::unknown;
use super::{AirRangingScenario, AirStereo, Demand};
use hadar::units::Dimension;
use serde::{Serialize, Serializer};
use std::path::Path;

impl AirRangingScenario {
    /// The scenario as TOML, with absolute paths; reading it gives the same question.
    #[must_use]
    pub fn to_toml(&self) -> String {
        text(self.document(Paths { beside: None }), self.source())
    }

    /// As [`AirRangingScenario::to_toml`], with paths below `directory` written relative to it.
    #[must_use]
    pub fn to_toml_beside(&self, directory: &Path) -> String {
        let absolute = std::path::absolute(directory).ok();
        text(self.document(Paths { beside: absolute.as_deref() }), self.source())
    }

    fn document(&self, paths: Paths<'_>) -> Document {
        let mut document = vec![("signal", Part::Value("air".into()))];
        for (name, part) in self.scene.document(paths) {
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
        document.push(("unknown", Part::Table(written)));
        let lengths: Vec<String> = self.distances_m.iter().map(|m| Dimension::Length.format(*m)).collect();
        document.push((
            "distances",
            Part::Table(Entries::default().put_written("list", Dimension::Length, lengths)),
        ));
        if let Some(spec) = &self.stereo {
            document.push(("stereo", Part::Table(stereo(spec))));
        }
        if let Some(demand) = self.requirement {
            let entries = Entries::default();
            let entries = match demand {
                Demand::Absolute(error_m) => {
                    entries.put_quantity("distance_error", Dimension::Length, Some(error_m))
                }
                Demand::Relative(share) => entries.put("relative_distance_error", share),
            };
            document.push(("requirement", Part::Table(entries)));
        }
        document
    }
}

/// The same keys as the TOML, quantities in the units used inside, with absolute paths.
impl Serialize for AirRangingScenario {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        entries(self.document(Paths { beside: None }), serializer)
    }
}

fn stereo(spec: &AirStereo) -> Entries {
    Entries::default()
        .put_quantity("baseline", Dimension::Length, Some(spec.baseline_m))
        .put("window", spec.window.map(|side| side as i64).to_vec())
        .put("texture", spec.texture)
}
