//! Writes a scenario with every default filled in, as TOML and, in the same structure, for JSON.
//!
//! Quantities are strings, in the TOML as their author wrote them, else and in JSON in the unit used inside with all
//! digits: reading gives the same bits back.

use std::path::Path;

use serde::ser::{Serialize, Serializer};
use toml::Value;

use super::entries::{Document, Entries, Part, entries, text};
use super::paths::Paths;
use super::{
    Alternatives, Background, EnvironmentObject, Extrapolation, MaterialRef, Nuisance, Reliability,
    Requirement, Scenario, Target, Unknown, camera, class,
};
use hadar::units::Dimension;

impl Scenario {
    /// The scenario as TOML, every default filled in; reading it gives an equal scenario. What stays silent
    /// has no value (a distance, an atmosphere, a camera) or one that others know (a preset's fields, the library's
    /// materials). Paths of files are absolute, so that it may be put anywhere on the same machine.
    ///
    /// ```
    /// use hadar_scenario::Scenario;
    /// let text = "[target]\nmaterial = \"skin\"\ntemperature = \"37 degC\"";
    /// let scenario = Scenario::from_toml(text, None).unwrap();
    /// let filled = scenario.to_toml();
    /// assert!(filled.contains("nuisances = [\"temperature\", \"lighting\"]"));
    /// assert_eq!(Scenario::from_toml(&filled, None).unwrap(), scenario);
    /// ```
    #[must_use]
    pub fn to_toml(&self) -> String {
        self.text(Paths { beside: None })
    }

    /// As [`Scenario::to_toml`], for a file in `directory` that may be moved along with its neighbours: paths
    /// below `directory` are written relative to it, others absolute.
    #[must_use]
    pub fn to_toml_beside(&self, directory: &Path) -> String {
        let absolute = std::path::absolute(directory).ok();
        self.text(Paths { beside: absolute.as_deref() })
    }

    fn text(&self, paths: Paths<'_>) -> String {
        text(self.document(paths), &self.source)
    }

    pub(super) fn document(&self, paths: Paths<'_>) -> Document {
        let mut document = Vec::new();
        if let Some(title) = &self.title {
            document.push(("title", Part::Value(title.as_str().into())));
        }
        if !self.classes.is_empty() {
            let one = |(name, spec): (&String, &_)| (name.clone(), class::written(spec, paths));
            document.push(("class", Part::Named(self.classes.iter().map(one).collect())));
        }
        document.push(("target", Part::Table(target(&self.target, paths))));
        if let Some(behind) = &self.background {
            document.push(("background", Part::Table(background(behind, paths))));
        }
        let objects = self.environment.iter().map(|object| environment(object, paths)).collect();
        document.push(("environment", Part::Tables(objects)));
        document.push(("alternatives", Part::Table(alternatives(&self.alternatives, paths))));
        if let Some(spec) = &self.atmosphere {
            document.push(("atmosphere", Part::Table(spec.written(paths))));
        }
        document.push(("bands", Part::Table(self.bands.written(paths))));
        document.push(("unknown", Part::Table(unknown(&self.unknown, &[], None))));
        if let Some(spec) = &self.camera {
            document.push(("camera", Part::Table(camera::written(spec, paths))));
        }
        document.push(("requirement", Part::Table(requirement(&self.requirement))));
        if let Some(envelope) = &self.envelope {
            document.push(("envelope", Part::Table(envelope.written(paths))));
        }
        if let Some(spec) = self.sensitivity {
            document.push(("sensitivity", Part::Table(spec.entries())));
        }
        document
    }
}

/// The same keys as the TOML, quantities in the units used inside, with absolute paths.
impl Serialize for Scenario {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        entries(self.document(Paths { beside: None }), serializer)
    }
}

fn target(target: &Target, paths: Paths<'_>) -> Entries {
    Entries::default()
        .put("material", paths.material(&target.material))
        .put_quantity("temperature", Dimension::Temperature, Some(target.temperature_k))
        .put_quantity("distance", Dimension::Length, target.distance_m)
        .put_quantity("size", Dimension::Length, target.size_m)
        .put_if("extrapolate", target.extrapolate.map(Extrapolation::name))
}

fn background(behind: &Background, paths: Paths<'_>) -> Entries {
    Entries::default()
        .put_quantity("temperature", Dimension::Temperature, Some(behind.temperature_k))
        .put_if("material", behind.material.as_ref().map(|material| paths.material(material)))
        .put_if("extrapolate", behind.extrapolate.map(Extrapolation::name))
}

fn environment(object: &EnvironmentObject, paths: Paths<'_>) -> Entries {
    Entries::default()
        .put_quantity("temperature", Dimension::Temperature, Some(object.temperature_k))
        .put("lighting", object.lighting)
        .put_if("material", object.material.as_ref().map(|material| paths.material(material)))
        .put_if("extrapolate", object.extrapolate.map(Extrapolation::name))
}

fn alternatives(alternatives: &Alternatives, paths: Paths<'_>) -> Entries {
    let names = |materials: &Vec<MaterialRef>| -> Vec<String> {
        materials.iter().map(|material| paths.material(material)).collect()
    };
    Entries::default()
        .put_if("materials", alternatives.materials.as_ref().map(names))
        .put_range("temperature", Dimension::Temperature, alternatives.temperature_range_k)
        .put_if("lighting", alternatives.lighting_range.map(|range| range.to_vec()))
        .put_if("extrapolate", alternatives.extrapolate.map(Extrapolation::name))
        .put_if("skip_uncovered", alternatives.skip_uncovered.then_some(true))
}

/// With names of more unknowns, and the deviation of a prior on the temperature of the air, K.
pub(super) fn unknown(unknown: &Unknown, more: &[&str], air_prior_k: Option<f64>) -> Entries {
    let names = unknown.nuisances.iter().map(|nuisance| nuisance.name());
    let names: Vec<&str> = names.chain(more.iter().copied()).collect();
    let of_air =
        |sigma: f64| ("air-temperature".to_owned(), Dimension::TemperatureDifference.format(sigma).into());
    let prior = |(nuisance, sigma): (&Nuisance, &f64)| {
        let value = match nuisance {
            Nuisance::Temperature | Nuisance::EnvironmentTemperature => {
                Dimension::TemperatureDifference.format(*sigma).into()
            }
            Nuisance::Lighting | Nuisance::Gain => Value::from(*sigma),
        };
        (nuisance.name().to_owned(), value)
    };
    let priors: toml::Table = unknown.priors.iter().map(prior).chain(air_prior_k.map(of_air)).collect();
    Entries::default()
        .put("nuisances", names)
        .put_written("priors", Dimension::TemperatureDifference, priors)
        .put_if("lighting_total", unknown.lighting_total)
}

pub(super) fn requirement(requirement: &Requirement) -> Entries {
    let entries = match requirement.reliability {
        Reliability::DetectionProbability(value) => Entries::default().put("detection_probability", value),
        Reliability::Distance(value) => Entries::default().put("distance", value),
        Reliability::Rates { detection, false_alarm } => Entries::default()
            .put("detection_probability", detection)
            .put("false_alarm_probability", false_alarm),
    };
    entries.put("by", requirement.by.name()).put_quantity("speed", Dimension::Speed, requirement.speed_m_s)
}
