//! The `[camera]` of a scenario: a preset, and the figures that override it, read and written by the table of figures.

use super::bands::{range, wavenumbers};
use super::entries::Entries;
use super::keys::rule::UNCERTAIN;
use super::paths::{Paths, file};
use super::section::{Entry, Section};
use super::setting::Setting;
use hadar::error::Result;
use hadar::instrument::Readout;
use hadar::instrument::figures::{CameraSpec, Efficiency, Kind, NOISES, Row, TABLE};
use hadar::instrument::presets::Preset;
use hadar::units::Spectral;
use std::collections::BTreeMap;
use std::sync::Arc;
use toml::Value;

/// Figures that a noise is stated for, where it does not state them itself.
const OF_NOISE: [&str; 5] = ["exposure", "frame_rate", "f_number", "optics_efficiency", "pixel"];

/// Whether a setting moves one of these over the file.
pub(super) fn moves_noise(setting: &Setting) -> bool {
    setting.key.rsplit_once('.').is_some_and(|(table, figure)| {
        (table == "camera" || table.starts_with("camera[")) && OF_NOISE.contains(&figure)
    })
}

/// The cameras of a file by their keys, `camera` or `camera[0]`; one that cannot be read is left out.
pub(super) fn filed(root: &Section<'_>) -> BTreeMap<String, Arc<CameraSpec>> {
    let Some(entry) = root.get("camera") else { return BTreeMap::new() };
    let items = if entry.is_list() { entry.items("").unwrap_or_default() } else { vec![entry] };
    let spec = |item: &Entry<'_>| read_with(item, &mut |_, entry| Ok(entry.is_table())).ok();
    items.iter().filter_map(|item| Some((item.key().to_owned(), Arc::new(spec(item)?)))).collect()
}

pub(super) fn read(entry: &Entry<'_>) -> Result<CameraSpec> {
    read_with(entry, &mut |_, _| Ok(false))
}

/// The same; what `uncertain` takes, a figure with its uncertainty, is not read.
pub(super) fn read_with(
    entry: &Entry<'_>,
    uncertain: &mut dyn FnMut(&'static Row, &Entry<'_>) -> Result<bool>,
) -> Result<CameraSpec> {
    let section = entry.section()?;
    section.at_most_one(&NOISES)?;
    let mut stated = CameraSpec::default();
    let spec = &mut stated;
    let own: Vec<&str> = section.keys().collect();
    for row in TABLE.iter().filter(|row| own.contains(&row.key)) {
        let (key, example) = (row.key, row.example);
        let Some(entry) = section.get(key) else { continue };
        if uncertain(row, &entry)? {
            // Its value alone, if it has one of its own.
            let table = entry.section_of(&UNCERTAIN)?;
            let value = ["value", "at_most"].into_iter().find_map(|key| table.get(key));
            if let Some(value) = value {
                let number = match row.kind {
                    Kind::Quantity(dimension, allowed, _) => value.quantity_as(dimension, allowed)?,
                    Kind::Number(allowed, _) | Kind::Efficiency(allowed, _) => {
                        value.number_as(example, allowed)?
                    }
                    _ => continue,
                };
                row.put_number(spec, number);
            }
            continue;
        }
        match row.kind {
            Kind::Quantity(_, _, slot) => *(slot.at)(spec) = Some(entry.quantity()?),
            Kind::Number(_, slot) => *(slot.at)(spec) = Some(entry.number(example)?),
            Kind::Efficiency(_, slot) => {
                *(slot.at)(spec) = Some(match entry.is_text() {
                    true => Efficiency::File(file(&entry)?),
                    false => Efficiency::Number(entry.number(example)?),
                });
            }
            Kind::Count(slot) => *(slot.at)(spec) = Some(entry.count(example)?),
            Kind::Flag(slot) => *(slot.at)(spec) = Some(entry.boolean()?),
            Kind::Readout(slot) => {
                let choices = Readout::ALL.map(|readout| (readout.name(), readout));
                *(slot.at)(spec) = Some(entry.choice(&choices)?);
            }
            Kind::Span(slot) => *(slot.at)(spec) = Some(wavenumbers(range(&entry)?)),
            Kind::File(slot) => *(slot.at)(spec) = Some(file(&entry)?),
            Kind::Name(slot) => *(slot.at)(spec) = Some(entry.name(example)?),
        }
    }
    stated.own = stated.preset.as_deref().and_then(|name| entry.source().own_camera(name));
    stated.filed = entry.source().filed.get(entry.key()).cloned();
    Ok(stated)
}

/// A noise of the file's own is written with the conditions of the file, where figures were moved over it.
pub(super) fn written(spec: &CameraSpec, paths: Paths<'_>) -> Entries {
    let mut stated = spec.clone();
    if let Some(filed) = spec.filed.as_ref().filter(|filed| filed.states_noise() && filed.preset.is_none()) {
        let figures = CameraSpec { noise: spec.noise.clone(), ..CameraSpec::clone(filed) };
        let full = Preset { figures, ..Preset::default() };
        let (noise, exposure_s) = full.noise_in_full();
        (stated.noise, stated.noise_exposure_s) = (noise, spec.noise_exposure_s.or(exposure_s));
    }
    let spec = &stated;
    TABLE.iter().fold(Entries::default(), |entries, row| {
        let value = match row.kind {
            Kind::Quantity(dimension, _, slot) => {
                return entries.put_quantity(row.key, dimension, *(slot.of)(spec));
            }
            Kind::Number(_, slot) => (slot.of)(spec).map(Value::from),
            Kind::Efficiency(_, slot) => (slot.of)(spec).as_ref().map(|efficiency| match efficiency {
                Efficiency::Number(value) => Value::from(*value),
                Efficiency::File(path) => Value::from(paths.file(path)),
            }),
            Kind::Count(slot) => (slot.of)(spec).map(Value::from),
            Kind::Flag(slot) => (slot.of)(spec).map(Value::from),
            Kind::Readout(slot) => (slot.of)(spec).map(|readout| Value::from(readout.name())),
            Kind::Span(slot) => (slot.of)(spec).map(|ends| {
                let ends = ends.map(|end| Value::from(Spectral::Wavenumber(end).format()));
                Value::from(ends.to_vec())
            }),
            Kind::File(slot) => (slot.of)(spec).as_ref().map(|path| Value::from(paths.file(path))),
            Kind::Name(slot) => (slot.of)(spec).as_deref().map(Value::from),
        };
        entries.put_if(row.key, value)
    })
}
