//! Writes a scenario with every default filled in, as TOML and, in the same structure, for JSON.
//!
//! Quantities are strings, in the TOML as their author wrote them, else and in JSON in the unit used inside with all
//! digits: reading gives the same bits back.

use toml::Value;

use super::decompose::category::categories_written;
use super::entries::{Document, Entries};
use super::paths::Paths;
use super::{
    Alternatives, Background, EnvironmentObject, Extrapolation, MaterialRef, Nuisance, PixelsFilled,
    Reliability, Requirement, Scenario, Scope, Target, Unknown, camera, class,
};
use hadar::units::Dimension;

impl Scenario {
    pub(super) fn document(&self, paths: Paths<'_>) -> Document {
        let objects: Vec<Entries> =
            self.environment.iter().map(|object| environment(object, paths)).collect();
        Document::titled(self.title.as_ref())
            .put_if("class", class::all_written(&self.classes, paths))
            .put("target", target(&self.target, paths))
            .put_if("background", self.background.as_ref().map(|behind| background(behind, paths)))
            .put("environment", objects)
            .put("alternatives", alternatives(&self.alternatives, paths))
            .put_if("atmosphere", self.atmosphere.as_ref().map(|spec| spec.written(paths)))
            .put("bands", self.bands.written(paths))
            .put("unknown", unknown(&self.unknown, &[], None))
            .put_if("camera", self.camera.as_ref().map(|spec| camera::written(spec, paths)))
            .put("requirement", requirement(&self.requirement))
            .put_if("envelope", self.envelope.as_ref().map(|envelope| envelope.written(paths)))
            .put_if("sensitivity", self.sensitivity.map(|spec| spec.entries()))
            .put_if("find", self.find.as_ref().map(|spec| spec.written(paths)))
            .put_if("category", categories_written(&self.categories))
    }
}

fn target(target: &Target, paths: Paths<'_>) -> Entries {
    let pixels = target.pixels.map(|pixels| match pixels {
        PixelsFilled::All(all) => Value::from(i64::from(all)),
        PixelsFilled::Sides(sides) => Value::from(sides.map(i64::from).to_vec()),
    });
    Entries::default()
        .put("material", paths.material(&target.material))
        .put_quantity("temperature", Dimension::Temperature, Some(target.temperature_k))
        .put_quantity("distance", Dimension::Length, target.distance_m)
        .put_quantity("size", Dimension::Length, target.size_m)
        .put_if("pixels", pixels)
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
    entries
        .put("by", requirement.by.name())
        .put_if("of", requirement.of.map(Scope::name))
        .put_quantity("speed", Dimension::Speed, requirement.speed_m_s)
        .put_quantity("time", Dimension::Time, requirement.time_s)
}
