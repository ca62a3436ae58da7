//! Reads a scenario of ranging by air: every key checked, every error one line with file, line and key.

use super::super::emissivity_error;
use super::super::keys::files;
use super::super::kind::Kind;
use super::super::read::{environment, prior, target};
use super::super::reader::{file, from_file_and_text};
use super::super::section::{Entry, Section, without_repetition};
use super::super::written::Written;
use super::super::{
    Alternatives, AtmosphereSpec, BandsSpec, Nuisance, RangeScenario, Requirement, Scenario, Source, Unknown,
    camera,
};
use super::{AirRangingScenario, AirStereo, AirUnknown, Demand, RangingScenario, SmoothEmissivity};
use hadar::error::{Error, Result};
use std::collections::BTreeMap;

const MINIMUM: &str = "write signal = \"air\", [target] with material, temperature and distance, [atmosphere] with model = \
                       \"us-standard\", and [camera]";
/// Distances where nothing is said: so many from a tenth of the target's to three times it.
const POINTS: u32 = 25;
const AROUND: [f64; 2] = [0.1, 3.0];
/// Most distances.
const MOST_POINTS: u32 = 10_000;
/// Errors of an emissivity among the unknowns where nothing is said.
const SMOOTH: SmoothEmissivity = SmoothEmissivity { sigma: 0.01, correlation_cm1: 100.0 };
const WINDOW: [usize; 2] = [5, 5];
const MOST_PIXELS: usize = 1000;
const AIR_TEMPERATURE: &str = "air-temperature";
const EMISSIVITY: &str = "emissivity";

from_file_and_text!(RangingScenario);

impl RangingScenario {
    /// Reads a ranging scenario of either kind with values in the place of its own.
    ///
    /// # Errors
    /// As [`RangingScenario::from_file`], except those of the file itself.
    pub fn from_written(written: &Written) -> Result<Self> {
        let (parsed, _) = toml::de::DeTable::parse_recoverable(&written.text);
        if parsed.get_ref().contains_key("signal") {
            return AirRangingScenario::from_written(written).map(|air| Self::Air(Box::new(air)));
        }
        RangeScenario::from_written(written).map(|stereo| Self::Stereo(Box::new(stereo)))
    }
}

file!(AirRangingScenario, scene.source, (Kind::Range, MINIMUM, &files::AIR_RANGING));

impl AirRangingScenario {
    fn of_root(root: &Section<'_>) -> Result<Self> {
        root.require("signal")?.choice(&[("air", ())])?;
        let instead =
            "write [target] with material = \"skin\", temperature = \"37 degC\" and distance = \"50 m\"";
        let target = target(&root.table("target", instead)?)?;
        let Some(distance_m) = target.distance_m else {
            let found = "the key is missing, and the distance is what is asked for";
            let instead = "write distance = \"50 m\", the true one";
            return Err(Error::malformed(found, instead).at(root.source().place("target.distance")));
        };
        if target.size_m.is_some() {
            let found = "a size, but here the target fills its pixel";
            let instead = "leave it out; what is behind a smaller target would be one more distance";
            return Err(Error::malformed(found, instead).at(root.source().place("target.size")));
        }
        let Some(atmosphere) = root.read("atmosphere", AtmosphereSpec::read)? else {
            let found = "the table is missing, and without air on the path nothing tells the distance";
            let instead = "write [atmosphere] with model = \"us-standard\"";
            return Err(root.fail("atmosphere", Error::malformed(found, instead)));
        };
        let instead = "write [camera] with preset = \"flir-a325sc\", or figures of its own";
        let camera = camera::read(&root.table("camera", instead)?)?;
        let (nuisances, unknown) = root.read("unknown", unknown)?.unwrap_or_default();
        let environment = environment(root, nuisances.lighting_total)?;
        let scene = Scenario {
            classes: std::collections::BTreeMap::new(),
            title: root.title("\"How far is the wall?\"")?,
            // Nothing is to be told apart.
            alternatives: Alternatives {
                materials: Some(vec![target.material.clone()]),
                ..Alternatives::default()
            },
            target,
            background: None,
            environment,
            atmosphere: Some(atmosphere),
            bands: root.read("bands", BandsSpec::read)?.unwrap_or_default(),
            unknown: nuisances,
            camera: Some(camera),
            requirement: Requirement::default(),
            envelope: None,
            sensitivity: None,
            find: None,
            categories: Vec::new(),
            source: Source::default(),
        };
        let distances_m = match root.get("distances") {
            Some(entry) => distances(&entry)?,
            None => {
                spaced(AROUND.map(|share| (share * distance_m).clamp(f64::MIN_POSITIVE, f64::MAX)), POINTS)
            }
        };
        let stereo = root.read("stereo", stereo)?;
        let requirement = root.read("requirement", requirement)?;
        Ok(Self { scene, unknown, distances_m, stereo, requirement })
    }
}

/// Lengths from the first to the last, in equal steps of their logarithm.
fn spaced([from, to]: [f64; 2], points: u32) -> Vec<f64> {
    let last = points.saturating_sub(1).max(1);
    let (start, way) = (from.ln(), to.ln() - from.ln());
    // The ends are as they were written.
    let at = |i: u32| match i {
        0 => from,
        _ if i == last => to,
        _ => way.mul_add(f64::from(i) / f64::from(last), start).exp().clamp(from, to),
    };
    let mut lengths: Vec<f64> = (0..points).map(at).collect();
    lengths.dedup();
    lengths
}

fn distances(entry: &Entry<'_>) -> Result<Vec<f64>> {
    let section = entry.section()?;
    for key in ["from", "to", "points"] {
        section.at_most_one(&["list", key])?;
    }
    let length = |entry: &Entry<'_>| entry.quantity();
    if let Some(list) = section.get("list") {
        let mut lengths =
            list.items("list = [\"15 m\", \"150 m\"]")?.iter().map(length).collect::<Result<Vec<f64>>>()?;
        if lengths.is_empty() {
            return Err(
                list.fail(Error::malformed("the list is empty", "write list = [\"15 m\", \"150 m\"]"))
            );
        }
        lengths.sort_by(f64::total_cmp);
        lengths.dedup();
        return Ok(lengths);
    }
    let [from, to] = ["from", "to"].map(|key| section.require(key).and_then(|entry| length(&entry)));
    let (from, to) = (from?, to?);
    if to <= from {
        let found = format!("to ({to} m) is not above from ({from} m)");
        return Err(section.fail("to", Error::malformed(found, "write the shorter distance as from")));
    }
    let points = section.read("points", |entry| entry.count("25"))?.unwrap_or(POINTS);
    if !(2..=MOST_POINTS).contains(&points) {
        let expected = format!("from 2 to {MOST_POINTS}");
        return Err(section.fail("points", Error::out_of_range("points", f64::from(points), "", expected)));
    }
    Ok(spaced([from, to], points))
}

fn unknown(entry: &Entry<'_>) -> Result<(Unknown, AirUnknown)> {
    let section = entry.section()?;
    let names: Vec<&str> =
        Nuisance::ALL.into_iter().map(Nuisance::name).chain([AIR_TEMPERATURE, EMISSIVITY]).collect();
    let choices: Vec<(&str, &str)> = names.iter().map(|name| (*name, *name)).collect();
    let named = section
        .read("nuisances", |entry| {
            let items = entry.items("nuisances = [\"temperature\", \"lighting\"]")?;
            without_repetition(&items, |item| item.choice(&choices))
        })?
        .unwrap_or_else(|| Unknown::default().nuisances.into_iter().map(Nuisance::name).collect());
    let nuisances: Vec<Nuisance> = named
        .iter()
        .filter_map(|name| Nuisance::ALL.into_iter().find(|nuisance| nuisance.name() == *name))
        .collect();
    let mut priors = BTreeMap::new();
    let mut air_prior_k = None;
    if let Some(entry) = section.get("priors") {
        let table = entry.section()?;
        for name in &names[..names.len() - 1] {
            let Some(sigma) = table.get(name) else { continue };
            if !named.contains(name) {
                let found = format!("`{name}` is not among unknown.nuisances");
                return Err(sigma.fail(Error::malformed(found, "add it there, or remove its prior")));
            }
            match nuisances.iter().find(|nuisance| nuisance.name() == *name) {
                Some(nuisance) => drop(priors.insert(*nuisance, prior(&sigma, *nuisance)?)),
                None => air_prior_k = Some(prior(&sigma, Nuisance::Temperature)?),
            }
        }
    }
    let error = emissivity_error::read(&section, emissivity_error::Of::Absolute)?;
    let correlation = section.quantity("emissivity_correlation")?;
    let is_unknown = named.contains(&EMISSIVITY);
    for (key, given) in [("emissivity_error", error), ("emissivity_correlation", correlation)] {
        if given.is_some() && !is_unknown {
            let found = format!("{key}, but the emissivity is not among unknown.nuisances");
            return Err(
                section.fail(key, Error::malformed(found, "add \"emissivity\" there, or leave it out"))
            );
        }
    }
    let emissivity = is_unknown.then(|| SmoothEmissivity {
        sigma: error.unwrap_or(SMOOTH.sigma),
        correlation_cm1: correlation.unwrap_or(SMOOTH.correlation_cm1),
    });
    let lighting_total = section.number("lighting_total")?;
    let air_temperature = named.contains(&AIR_TEMPERATURE).then_some(air_prior_k);
    Ok((Unknown { nuisances, priors, lighting_total }, AirUnknown { air_temperature, emissivity }))
}

fn stereo(entry: &Entry<'_>) -> Result<AirStereo> {
    let section = entry.section()?;
    let window = section.read("window", |entry| {
        let [rows, columns] = entry.pair("[5, 5]")?;
        let side = |end: &Entry<'_>| {
            let pixels = end.count("5")? as usize;
            if pixels > MOST_PIXELS {
                let expected = format!("at most {MOST_PIXELS}");
                return Err(end.fail(Error::out_of_range(
                    "side of the window",
                    pixels as f64,
                    "pixels",
                    expected,
                )));
            }
            Ok(pixels)
        };
        Ok([side(&rows)?, side(&columns)?])
    })?;
    Ok(AirStereo {
        baseline_m: section.require("baseline")?.quantity()?,
        window: window.unwrap_or(WINDOW),
        texture: section.require("texture")?.number("0.01")?,
    })
}

fn requirement(entry: &Entry<'_>) -> Result<Demand> {
    let section = entry.section()?;
    section.at_most_one(&["distance_error", "relative_distance_error"])?;
    let absolute = section.quantity("distance_error")?;
    let relative = section.number("relative_distance_error")?;
    match (absolute, relative) {
        (Some(error_m), _) => Ok(Demand::Absolute(error_m)),
        (None, Some(share)) => Ok(Demand::Relative(share)),
        (None, None) => {
            let instead =
                "write distance_error = \"5 m\" or relative_distance_error = 0.05, or leave the table out";
            Err(entry.fail(Error::malformed("nothing is demanded", instead)))
        }
    }
}
