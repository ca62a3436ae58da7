//! Reads `[scene]` and `[[object]]`.

use super::super::paths::{file, material};
use super::super::section::{Entry, Section};
use super::{Form, GroundSpec, ObjectSpec, SceneSpec, SkySpec, SurfaceSpec};
use hadar::allowed::{ABOVE_ZERO, ABSOLUTE_TEMPERATURE, Allowed, FROM_ZERO, SHARE};
use hadar::error::{Error, Result};
use hadar::units::Dimension;

/// Most rows or columns of a rendered image, and most bounces.
const MOST_PIXELS: u32 = 16_384;
const MOST_BOUNCES: u32 = 64;
/// Keys of the built-in street's car and person.
const BUILT_IN: &[&str] =
    &["car", "car_temperature", "car_distance", "person", "person_temperature", "person_distance"];
const SURFACE: &[&str] =
    &["material", "temperature", "variation", "variation_size", "roughness", "roughness_size"];

/// The scene with the built-in car and person.
pub(in crate::scenario) fn scene(entry: &Entry<'_>) -> Result<SceneSpec> {
    let section = entry.section(&[
        "ground_temperature",
        "sky_temperature",
        "car_temperature",
        "person_temperature",
        "ground_emissivity",
        "car",
        "person",
        "car_distance",
        "person_distance",
        "sky",
        "ground",
        "library",
        "camera_height",
        "camera_pitch",
        "bounces",
        "size",
    ])?;
    let temperature = |key| section.quantity(key, Dimension::Temperature, ABSOLUTE_TEMPERATURE);
    let length = |key| section.quantity(key, Dimension::Length, ABOVE_ZERO);
    section.at_most_one(&["sky", "sky_temperature"])?;
    section.at_most_one(&["ground", "ground_temperature"])?;
    section.at_most_one(&["ground", "ground_emissivity"])?;
    Ok(SceneSpec {
        ground_temperature_k: temperature("ground_temperature")?,
        sky_temperature_k: temperature("sky_temperature")?,
        car_temperature_k: temperature("car_temperature")?,
        person_temperature_k: temperature("person_temperature")?,
        ground_emissivity: section.read("ground_emissivity", |entry| {
            entry.range("[0.8, 1.0]", |end| end.number("0.8", SHARE), |share| share)
        })?,
        car: section.read("car", material)?,
        person: section.read("person", material)?,
        car_distance_m: length("car_distance")?,
        person_distance_m: length("person_distance")?,
        sky: section.read("sky", sky)?,
        ground: section.read("ground", ground)?,
        objects: None,
        library: section.read("library", |entry| {
            entry.items("library = [\"brick-red\"]")?.iter().map(material).collect()
        })?,
        camera_height_m: length("camera_height")?,
        camera_pitch_rad: section.quantity("camera_pitch", Dimension::Angle, ANY)?,
        bounces: section.read("bounces", |entry| at_most(entry, "8", MOST_BOUNCES))?,
        size: section.read("size", |entry| {
            let [rows, columns] = entry.pair("[480, 640]")?;
            Ok([rows, columns].map(|side| at_most(&side, "480", MOST_PIXELS).map(|n| n as usize)))
                .and_then(|[rows, columns]| Ok([rows?, columns?]))
        })?,
    })
}

/// The scene of a file with its objects.
pub(in crate::scenario) fn scene_of(root: &Section<'_>, entry: &Entry<'_>) -> Result<SceneSpec> {
    let mut spec = scene(entry)?;
    spec.objects = root.read("object", objects)?;
    if spec.objects.is_some() {
        let section = entry.table()?;
        if let Some(key) = BUILT_IN.iter().find(|key| section.get(key).is_some()) {
            let found = "a key of the built-in street beside [[object]]";
            let instead =
                "write an [[object]] with shape = \"car\" or \"person\", or leave out all [[object]]";
            return Err(section.fail(key, Error::malformed(found, instead)));
        }
    }
    Ok(spec)
}

/// The objects of a file.
pub(in crate::scenario) fn objects(entry: &Entry<'_>) -> Result<Vec<ObjectSpec>> {
    entry.items("[[object]]")?.iter().map(object).collect()
}

fn at_most(entry: &Entry<'_>, example: &str, most: u32) -> Result<u32> {
    let count = entry.count(example)?;
    if count <= most {
        return Ok(count);
    }
    let found = Error::malformed(format!("{count} is too many"), format!("write at most {most}"));
    Err(entry.fail(found))
}

fn sky(entry: &Entry<'_>) -> Result<SkySpec> {
    let section = entry.section(&["spectrum", "column", "material", "temperature"])?;
    if section.at_most_one(&["spectrum", "temperature"])? == Some("spectrum") {
        return Ok(SkySpec::Spectrum {
            path: file(&section.require("spectrum", "\"sky.csv\"")?)?,
            column: section.require("column", "\"sky\"")?.text("\"sky\"")?.trim().to_owned(),
        });
    }
    Ok(SkySpec::Surface {
        material: section.read("material", material)?,
        temperature_k: section
            .require("temperature", "\"-15 degC\"")?
            .quantity(Dimension::Temperature, ABSOLUTE_TEMPERATURE)?,
    })
}

fn ground(entry: &Entry<'_>) -> Result<GroundSpec> {
    let section = entry.section(&[SURFACE, &["marks"]].concat())?;
    Ok(GroundSpec { surface: surface(&section)?, marks: section.read("marks", material)? })
}

fn surface(section: &Section<'_>) -> Result<SurfaceSpec> {
    let length = |key| section.quantity(key, Dimension::Length, ABOVE_ZERO);
    Ok(SurfaceSpec {
        material: material(&section.require("material", "\"skin\"")?)?,
        temperature_k: section
            .require("temperature", "\"12 degC\"")?
            .quantity(Dimension::Temperature, ABSOLUTE_TEMPERATURE)?,
        variation_k: section
            .quantity("variation", Dimension::TemperatureDifference, FROM_ZERO)?
            .unwrap_or(0.0),
        variation_size_m: length("variation_size")?,
        roughness: section.number("roughness", "0.1", ROUGHNESS)?.unwrap_or(0.0),
        roughness_size_m: length("roughness_size")?,
    })
}

const ANY: Allowed = Allowed { holds: |_| true, expected: "a number" };
const ROUGHNESS: Allowed =
    Allowed { holds: |slope| (0.0..=1.0).contains(&slope), expected: "a slope from 0 to 1" };

#[derive(Clone, Copy)]
enum Shape {
    Person,
    Robot,
    Car,
    Block,
    Post,
    Ball,
}

fn object(entry: &Entry<'_>) -> Result<ObjectSpec> {
    let whole = entry.section(
        &[SURFACE, &["name", "shape", "at", "height", "size", "radius", "above", "tyres"]].concat(),
    )?;
    let kinds = [
        ("person", Shape::Person),
        ("robot", Shape::Robot),
        ("car", Shape::Car),
        ("block", Shape::Block),
        ("post", Shape::Post),
        ("ball", Shape::Ball),
    ];
    whole.require("shape", "\"person\"")?;
    let Some(shape) = whole.choice("shape", &kinds)? else {
        return Err(entry.fail(Error::malformed("no shape", "write shape = \"person\"")));
    };
    let own: &[&str] = match shape {
        Shape::Person | Shape::Robot => &["height"],
        Shape::Car => &["size", "tyres"],
        Shape::Block => &["size"],
        Shape::Post => &["height", "radius"],
        Shape::Ball => &["size", "above"],
    };
    for key in ["height", "size", "radius", "above", "tyres"] {
        if !own.contains(&key) && whole.get(key).is_some() {
            let found = format!("this shape has no {key}");
            let instead = format!("it has {}; leave this out", own.join(", "));
            return Err(whole.fail(key, Error::malformed(found, instead)));
        }
    }
    let length = |key| whole.quantity(key, Dimension::Length, ABOVE_ZERO);
    let size = |key: &str| whole.read(key, lengths);
    let needed = |key: &str, example: &str| whole.require(key, example);
    let form = match shape {
        Shape::Person => Form::Person(length("height")?),
        Shape::Robot => Form::Robot(length("height")?),
        Shape::Car => {
            Form::Car(size("size")?, whole.read("tyres", |entry| surface(&entry.section(SURFACE)?))?)
        }
        Shape::Block => Form::Block(lengths(&needed("size", SIZE)?)?),
        Shape::Post => Form::Post([
            needed("height", "\"3 m\"")?.quantity(Dimension::Length, ABOVE_ZERO)?,
            needed("radius", "\"10 cm\"")?.quantity(Dimension::Length, ABOVE_ZERO)?,
        ]),
        Shape::Ball => Form::Ball(
            lengths(&needed("size", SIZE)?)?,
            whole.quantity("above", Dimension::Length, FROM_ZERO)?.unwrap_or(0.0),
        ),
    };
    let [across, ahead] = whole.require("at", PLACE)?.pair(PLACE)?;
    Ok(ObjectSpec {
        name: whole.read("name", |entry| Ok(entry.text("\"guard\"")?.trim().to_owned()))?,
        form,
        at_m: [across.quantity(Dimension::Length, ANY)?, ahead.quantity(Dimension::Length, ABOVE_ZERO)?],
        surface: surface(&whole)?,
    })
}

const SIZE: &str = "[\"4.2 m\", \"1.8 m\", \"1.45 m\"]";
const PLACE: &str = "[\"-0.9 m\", \"8 m\"]";

/// Length, width and height.
fn lengths(entry: &Entry<'_>) -> Result<[f64; 3]> {
    let items = entry.items(SIZE)?;
    let [length, width, height] = items.as_slice() else {
        let found = format!("{} lengths", items.len());
        let instead = format!("write length, width and height, as {SIZE}");
        return Err(entry.fail(Error::malformed(found, instead)));
    };
    let one = |entry: &Entry<'_>| entry.quantity(Dimension::Length, ABOVE_ZERO);
    Ok([one(length)?, one(width)?, one(height)?])
}
