//! The `[envelope]` of a scenario: ranges of scenes that a requirement must hold in, instead of one scene.
//!
//! A range that is silent is the scenario's own value. Lighting and temperature of the surroundings have one range for
//! every environment object, or one pair that holds for each of them. Both ends of a range may be the same.

use super::entries::Entries;
use super::paths::{Paths, material};
use super::section::{Entry, Section, without_repetition};
use super::{MaterialRef, Scenario};
use hadar::error::{Error, Result};
use hadar::units::Dimension;

/// Lighting factors that should add up to a value may miss it by this: rounding, not meaning.
pub(super) const LIGHTING_ROUNDING: f64 = 1e-12;

/// Ranges of scenes (`[envelope]`), lower end first.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Envelope {
    /// Temperature of the target, K; above 0.
    pub temperature_k: Option<[f64; 2]>,
    /// Thermal lighting factor of every environment object, within [0, 1]; lower ends add up to at most 1.
    pub lighting: Option<Vec<[f64; 2]>>,
    /// Temperature of every environment object, K; above 0.
    pub surroundings_k: Option<Vec<[f64; 2]>>,
    /// Distance of the target from the camera, m; above 0.
    pub distance_m: Option<[f64; 2]>,
    /// Materials of the target, each in turn.
    pub materials: Option<Vec<MaterialRef>>,
}

impl Envelope {
    /// Reads the table, for a scenario with so many environment objects.
    pub(super) fn read(entry: &Entry<'_>, objects: usize) -> Result<Self> {
        let section = entry.section()?;
        let kelvin = |end: &Entry<'_>| end.quantity();
        let envelope = Self {
            temperature_k: section
                .read("temperature", |entry| closed(entry, "[\"30 degC\", \"40 degC\"]", kelvin))?,
            distance_m: section
                .read("distance", |entry| closed(entry, "[\"5 m\", \"30 m\"]", |end| end.quantity()))?,
            materials: section.read("materials", |entry| {
                let items = entry.items("materials = [\"skin\", \"fabric\"]")?;
                if items.is_empty() {
                    let instead = "name some, or leave the key out to take the target's material alone";
                    return Err(entry.fail(Error::malformed("the list is empty", instead)));
                }
                without_repetition(&items, material)
            })?,
            ..Self::lit(&section, objects)?
        };
        if envelope == Self::default() {
            let instead = "write at least one range, such as temperature = [\"30 degC\", \"40 degC\"], or leave the table out";
            return Err(entry.fail(Error::malformed("the envelope is empty", instead)));
        }
        Ok(envelope)
    }

    /// What lights the scene, from a table with `lighting` and `surroundings`; all else is silent.
    pub(super) fn lit(section: &Section<'_>, objects: usize) -> Result<Self> {
        let share = |end: &Entry<'_>| end.number("0.5");
        let kelvin = |end: &Entry<'_>| end.quantity();
        let envelope = Self {
            lighting: of_objects(section, "lighting", objects, "[0.1, 0.9]", share)?,
            surroundings_k: of_objects(
                section,
                "surroundings",
                objects,
                "[\"-10 degC\", \"30 degC\"]",
                kelvin,
            )?,
            ..Self::default()
        };
        let least: f64 = envelope.lighting.iter().flatten().map(|range| range[0]).sum();
        if least > 1.0 + LIGHTING_ROUNDING {
            let least = (least * 1e12).round() / 1e12;
            let found =
                format!("the envelope is empty: the least lighting of all objects adds up to {least}");
            let instead = "lower the first ends to a sum of at most 1, as the objects share one hemisphere";
            return Err(section.fail("lighting", Error::malformed(found, instead)));
        }
        Ok(envelope)
    }

    pub(super) fn written(&self, paths: Paths<'_>) -> Entries {
        let names = |materials: &Vec<MaterialRef>| -> Vec<String> {
            materials.iter().map(|material| paths.material(material)).collect()
        };
        let entries = Entries::default()
            .put_range("temperature", Dimension::Temperature, self.temperature_k)
            .and(self.lights());
        entries
            .put_range("distance", Dimension::Length, self.distance_m)
            .put_if("materials", self.materials.as_ref().map(names))
    }

    /// What lights the scene.
    pub(super) fn lights(&self) -> Entries {
        let pairs = |ranges: &Vec<[f64; 2]>| ranges.iter().map(|range| range.to_vec()).collect::<Vec<_>>();
        let kelvins = |range: &[f64; 2]| range.map(|end| Dimension::Temperature.format(end)).to_vec();
        let entries = Entries::default().put_if("lighting", self.lighting.as_ref().map(pairs));
        match &self.surroundings_k {
            Some(ranges) => {
                let ranges: Vec<_> = ranges.iter().map(kelvins).collect();
                entries.put_written("surroundings", Dimension::Temperature, ranges)
            }
            None => entries,
        }
    }

    /// The same with what is silent filled in from the scenario's own scene.
    #[must_use]
    pub fn filled(&self, scenario: &Scenario) -> Self {
        let point = |value: f64| [value, value];
        let objects = &scenario.environment;
        Self {
            temperature_k: self.temperature_k.or(Some(point(scenario.target.temperature_k))),
            lighting: self
                .lighting
                .clone()
                .or_else(|| Some(objects.iter().map(|object| point(object.lighting)).collect())),
            surroundings_k: self
                .surroundings_k
                .clone()
                .or_else(|| Some(objects.iter().map(|object| point(object.temperature_k)).collect())),
            distance_m: self.distance_m.or(scenario.target.distance_m.map(point)),
            materials: self.materials.clone().or_else(|| Some(vec![scenario.target.material.clone()])),
        }
    }
}

/// A range whose ends may be the same.
fn closed<'a>(
    entry: &Entry<'a>,
    example: &str,
    read: impl Fn(&Entry<'a>) -> Result<f64>,
) -> Result<[f64; 2]> {
    entry.range(example, read, |end| end)
}

/// One range for every object: a list of them, or one that holds for each.
fn of_objects<'a>(
    section: &Section<'a>,
    key: &str,
    objects: usize,
    example: &str,
    read: impl Fn(&Entry<'a>) -> Result<f64>,
) -> Result<Option<Vec<[f64; 2]>>> {
    section.read(key, |entry| {
        if objects == 0 {
            let found = "there is no [[environment]] whose range this could be";
            return Err(entry.fail(Error::malformed(found, "add one, or leave the key out")));
        }
        let items = entry.items(&format!("{key} = {example}"))?;
        if !items.first().is_some_and(Entry::is_list) {
            return Ok(vec![closed(entry, example, read)?; objects]);
        }
        if items.len() != objects {
            let found = format!("there are {} ranges for {objects} environment objects", items.len());
            let instead = format!("write one for each [[environment]], or {key} = {example} for all of them");
            return Err(entry.fail(Error::malformed(found, instead)));
        }
        items.iter().map(|item| closed(item, example, &read)).collect()
    })
}
