//! Reads a scenario: every key checked, every error one line with file, line and key.

use std::collections::BTreeMap;

use super::decompose::category::{Told, categories};
use super::envelope::LIGHTING_ROUNDING;
use super::keys::files;
use super::kind::Kind;
use super::paths::material;
use super::reader::file;
use super::section::{Entry, Section, without_repetition};
use super::{
    Alternatives, AtmosphereSpec, Background, BandsSpec, DistanceKind, Envelope, EnvironmentObject,
    Extrapolation, FindSpec, Nuisance, Reliability, Requirement, Scenario, SensitivitySpec, Source, Target,
    Unknown,
};
use super::{PixelsFilled, Scope, camera, class};
use hadar::error::{Error, Result};

pub(super) const MINIMUM: &str = "write [target] with material = \"skin\" and temperature = \"37 degC\"";

file!(Scenario, source, (Kind::Scenario, MINIMUM, &files::SCENARIO));

impl Scenario {
    fn of_root(root: &Section<'_>) -> Result<Self> {
        let scenario = of_root(root, requirement)?;
        Ok(Self { camera: root.read_once("camera", camera::read)?, ..scenario })
    }
}

/// All of a scenario but its camera and its source, what is demanded as `requirement` reads it.
pub(super) fn of_root(
    root: &Section<'_>,
    requirement: impl FnOnce(&Entry<'_>) -> Result<Requirement>,
) -> Result<Scenario> {
    let target = root.table_once("target", MINIMUM, target)?;
    let unknown = root.read_once("unknown", unknown)?.unwrap_or_default();
    let environment = environment(root, unknown.lighting_total)?;
    Ok(Scenario {
        title: root.title("\"Person or robot?\"")?,
        classes: class::read(root)?,
        target,
        envelope: root.read("envelope", |entry| Envelope::read(entry, environment.len()))?,
        environment,
        background: root.read_once("background", background)?,
        alternatives: root.read_once("alternatives", alternatives)?.unwrap_or_default(),
        atmosphere: root.read_once("atmosphere", AtmosphereSpec::read)?,
        bands: root.read_once("bands", BandsSpec::read)?.unwrap_or_default(),
        unknown,
        camera: None,
        requirement: root.read("requirement", requirement)?.unwrap_or_default(),
        sensitivity: root.read_once("sensitivity", SensitivitySpec::read)?,
        find: root.read_once("find", FindSpec::read)?,
        categories: root.read("category", |entry| categories(entry, Told::ByLabels))?.unwrap_or_default(),
        source: Source::default(),
    })
}

pub(super) fn target(entry: &Entry<'_>) -> Result<Target> {
    let section = entry.section()?;
    section.at_most_one(&["size", "pixels"])?;
    Ok(Target {
        material: material(&section.require("material")?)?,
        temperature_k: section.require("temperature")?.quantity()?,
        distance_m: section.quantity("distance")?,
        size_m: section.quantity("size")?,
        pixels: section.read("pixels", pixels_filled)?,
        extrapolate: extrapolation(&section)?,
    })
}

fn pixels_filled(entry: &Entry<'_>) -> Result<PixelsFilled> {
    if entry.is_list() {
        let items = entry.items("pixels = [40, 10]")?;
        let [rows, columns] = items.as_slice() else {
            let found = format!("rows and columns are two numbers, but the list has {}", items.len());
            return Err(entry.fail(Error::malformed(found, "write pixels = [40, 10], or pixels = 400")));
        };
        return Ok(PixelsFilled::Sides([rows.count("40")?, columns.count("10")?]));
    }
    Ok(PixelsFilled::All(entry.count("400")?))
}

fn background(entry: &Entry<'_>) -> Result<Background> {
    let section = entry.section()?;
    Ok(Background {
        temperature_k: section.require("temperature")?.quantity()?,
        material: section.read("material", material)?,
        extrapolate: extrapolation(&section)?,
    })
}

pub(super) fn environment(root: &Section<'_>, total: Option<f64>) -> Result<Vec<EnvironmentObject>> {
    let read = |entry: &Entry<'_>| environment_objects(entry, total);
    let objects = root.read_once_beside("environment", &["unknown"], read)?.unwrap_or_default();
    if objects.is_empty() && total.is_some() {
        let found = "there is no [[environment]] whose lighting this could be";
        return Err(root.fail("unknown.lighting_total", Error::malformed(found, "add one")));
    }
    Ok(objects)
}

fn environment_objects(entry: &Entry<'_>, total: Option<f64>) -> Result<Vec<EnvironmentObject>> {
    let items = entry.items("[[environment]], in double brackets, once for each object")?;
    let mut objects = Vec::with_capacity(items.len());
    let mut sum = 0.0;
    for (index, item) in items.iter().enumerate() {
        let section = item.section()?;
        let written = section.number("lighting")?;
        let lighting = match total {
            Some(total) if index + 1 == items.len() => {
                rest_of_lighting(total, sum, written).map_err(|error| section.fail("lighting", error))?
            }
            _ => match written {
                Some(lighting) => lighting,
                None => section.require("lighting")?.number("0.5")?,
            },
        };
        sum += lighting;
        if sum > 1.0 + LIGHTING_ROUNDING {
            let found = format!("the lighting factors add up to {}", rounded(sum));
            let instead = "lower them to a sum of at most 1, as they share one hemisphere";
            return Err(section.fail("lighting", Error::malformed(found, instead)));
        }
        objects.push(EnvironmentObject {
            temperature_k: section.require("temperature")?.quantity()?,
            lighting,
            material: section.read("material", material)?,
            extrapolate: extrapolation(&section)?,
        });
    }
    Ok(objects)
}

/// The last object's lighting factor where the total is known: what the others leave.
fn rest_of_lighting(total: f64, others: f64, written: Option<f64>) -> Result<f64> {
    if others > total + LIGHTING_ROUNDING {
        return Err(Error::malformed(
            format!("the other lighting factors add up to {}, lighting_total is {total}", rounded(others)),
            "lower them, or raise unknown.lighting_total",
        ));
    }
    let rest = (total - others).max(0.0);
    match written {
        Some(written) if (written - rest).abs() > LIGHTING_ROUNDING => Err(Error::malformed(
            format!("the others and lighting_total = {total} leave {}, not {written}", rounded(rest)),
            "leave this one out",
        )),
        _ => Ok(rest),
    }
}

/// A sum as one would write it, without the last bits of its rounding.
fn rounded(sum: f64) -> f64 {
    (sum * 1e12).round() / 1e12
}

fn alternatives(entry: &Entry<'_>) -> Result<Alternatives> {
    let section = entry.section()?;
    let materials = section.read("materials", |entry| {
        let items = entry.items("materials = [\"aluminium\"]")?;
        if items.is_empty() {
            let instead = "name some, or leave the key out to take every other material of the library";
            return Err(entry.fail(Error::malformed("the list is empty", instead)));
        }
        without_repetition(&items, material)
    })?;
    Ok(Alternatives {
        materials,
        temperature_range_k: section.read("temperature", |entry| {
            let kelvin = |end: &Entry<'_>| end.quantity();
            entry.wide_range("[\"0 degC\", \"120 degC\"]", kelvin, |kelvin| kelvin)
        })?,
        lighting_range: section.read("lighting", |entry| {
            entry.wide_range("[0.0, 1.0]", |end| end.number("0.5"), |share| share)
        })?,
        extrapolate: extrapolation(&section)?,
        skip_uncovered: section.read("skip_uncovered", Entry::boolean)?.unwrap_or(false),
        own_too: false,
    })
}

fn unknown(entry: &Entry<'_>) -> Result<Unknown> {
    let section = entry.section()?;
    let choices = Nuisance::ALL.map(|nuisance| (nuisance.name(), nuisance));
    let nuisances = section
        .read("nuisances", |entry| {
            let items = entry.items("nuisances = [\"temperature\", \"lighting\"]")?;
            without_repetition(&items, |item| item.choice(&choices))
        })?
        .unwrap_or_else(|| Unknown::default().nuisances);
    let priors = section.read("priors", |entry| priors(entry, &nuisances))?.unwrap_or_default();
    Ok(Unknown { priors, lighting_total: section.number("lighting_total")?, nuisances })
}

fn priors(entry: &Entry<'_>, nuisances: &[Nuisance]) -> Result<BTreeMap<Nuisance, f64>> {
    let section = entry.section()?;
    let mut priors = BTreeMap::new();
    for nuisance in Nuisance::ALL {
        let Some(sigma) = section.get(nuisance.name()) else { continue };
        if !nuisances.contains(&nuisance) {
            let found = format!("`{}` is not among unknown.nuisances", nuisance.name());
            return Err(sigma.fail(Error::malformed(found, "add it there, or remove its prior")));
        }
        priors.insert(nuisance, prior(&sigma, nuisance)?);
    }
    Ok(priors)
}

/// Deviation of the prior on an unknown.
pub(super) fn prior(entry: &Entry<'_>, nuisance: Nuisance) -> Result<f64> {
    match nuisance {
        Nuisance::Temperature | Nuisance::EnvironmentTemperature => entry.quantity(),
        Nuisance::Lighting | Nuisance::Gain => entry.number("0.1"),
    }
}

pub(super) fn requirement(entry: &Entry<'_>) -> Result<Requirement> {
    let section = entry.section()?;
    section.at_most_one(&["detection_probability", "distance"])?;
    let detection = section.number("detection_probability")?;
    let false_alarm = section.number("false_alarm_probability")?;
    let distance = section.number("distance")?;
    let default = Requirement::default();
    Ok(Requirement {
        reliability: match (detection, false_alarm, distance) {
            (Some(detection), Some(false_alarm), _) => Reliability::Rates { detection, false_alarm },
            (Some(probability), None, _) => Reliability::DetectionProbability(probability),
            (None, Some(_), _) => {
                let found =
                    "false alarms without a detection_probability: a test that finds nothing has none";
                let instead = "write detection_probability = 0.9 beside it";
                return Err(section.fail("false_alarm_probability", Error::malformed(found, instead)));
            }
            (None, None, Some(distance)) => Reliability::Distance(distance),
            (None, None, None) => default.reliability,
        },
        by: section.choice("by", &DistanceKind::ALL.map(|kind| (kind.name(), kind)))?.unwrap_or(default.by),
        of: section.choice("of", &Scope::ALL.map(|scope| (scope.name(), scope)))?,
        speed_m_s: section.quantity("speed")?,
        time_s: section.quantity("time")?,
    })
}

fn extrapolation(section: &Section<'_>) -> Result<Option<Extrapolation>> {
    section.choice("extrapolate", &Extrapolation::ALL.map(|kind| (kind.name(), kind)))
}
