//! Reads `[scene]` and `[[object]]`.

use super::super::paths::{file, material};
use super::super::section::{Entry, Section};
use super::{Form, GroundSpec, ObjectSpec, SceneSpec, SkySpec, SurfaceSpec};
use hadar::allowed::ABOVE_ZERO;
use hadar::error::{Error, Result};
use hadar::units::Dimension;

/// Keys of the built-in street's car and person.
const BUILT_IN: &[&str] =
    &["car", "car_temperature", "car_distance", "person", "person_temperature", "person_distance"];

/// The scene with the built-in car and person.
pub(crate) fn scene(entry: &Entry<'_>) -> Result<SceneSpec> {
    let section = entry.section()?;
    let temperature = |key| section.quantity(key);
    let length = |key| section.quantity(key);
    section.at_most_one(&["sky", "sky_temperature"])?;
    section.at_most_one(&["ground", "ground_temperature"])?;
    section.at_most_one(&["ground", "ground_emissivity"])?;
    Ok(SceneSpec {
        ground_temperature_k: temperature("ground_temperature")?,
        sky_temperature_k: temperature("sky_temperature")?,
        car_temperature_k: temperature("car_temperature")?,
        person_temperature_k: temperature("person_temperature")?,
        ground_emissivity: section.read("ground_emissivity", |entry| {
            entry.range("[0.8, 1.0]", |end| end.number("0.8"), |share| share)
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
        camera_pitch_rad: section.quantity("camera_pitch")?,
        bounces: section.read("bounces", |entry| entry.count("8"))?,
        size: section.read("size", |entry| {
            let [rows, columns] = entry.pair("[480, 640]")?;
            Ok([rows.count("480")? as usize, columns.count("480")? as usize])
        })?,
    })
}

/// The scene of a file with its objects.
pub(crate) fn scene_of(root: &Section<'_>, entry: &Entry<'_>) -> Result<SceneSpec> {
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
pub(crate) fn objects(entry: &Entry<'_>) -> Result<Vec<ObjectSpec>> {
    entry.items("[[object]]")?.iter().map(object).collect()
}

fn sky(entry: &Entry<'_>) -> Result<SkySpec> {
    let section = entry.section()?;
    if section.at_most_one(&["spectrum", "temperature"])? == Some("spectrum") {
        return Ok(SkySpec::Spectrum {
            path: file(&section.require("spectrum")?)?,
            column: section.require("column")?.name("\"sky\"")?,
        });
    }
    Ok(SkySpec::Surface {
        material: section.read("material", material)?,
        temperature_k: section.require("temperature")?.quantity()?,
    })
}

fn ground(entry: &Entry<'_>) -> Result<GroundSpec> {
    let section = entry.section()?;
    Ok(GroundSpec { surface: surface(&section)?, marks: section.read("marks", material)? })
}

fn surface(section: &Section<'_>) -> Result<SurfaceSpec> {
    let length = |key| section.quantity(key);
    Ok(SurfaceSpec {
        material: material(&section.require("material")?)?,
        temperature_k: section.require("temperature")?.quantity()?,
        variation_k: section.quantity("variation")?.unwrap_or(0.0),
        variation_size_m: length("variation_size")?,
        roughness: section.number("roughness")?.unwrap_or(0.0),
        roughness_size_m: length("roughness_size")?,
    })
}

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
    let whole = entry.section()?;
    let kinds = [
        ("person", Shape::Person),
        ("robot", Shape::Robot),
        ("car", Shape::Car),
        ("block", Shape::Block),
        ("post", Shape::Post),
        ("ball", Shape::Ball),
    ];
    whole.require("shape")?;
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
    let length = |key| whole.quantity(key);
    let size = |key: &str| whole.read(key, lengths);
    let form = match shape {
        Shape::Person => Form::Person(length("height")?),
        Shape::Robot => Form::Robot(length("height")?),
        Shape::Car => Form::Car(size("size")?, whole.read("tyres", |entry| surface(&entry.section()?))?),
        Shape::Block => Form::Block(lengths(&whole.require("size")?)?),
        Shape::Post => {
            Form::Post([whole.require("height")?.quantity()?, whole.require("radius")?.quantity()?])
        }
        Shape::Ball => Form::Ball(lengths(&whole.require("size")?)?, whole.quantity("above")?.unwrap_or(0.0)),
    };
    let [across, ahead] = whole.require("at")?.pair(PLACE)?;
    Ok(ObjectSpec {
        name: whole.text("name", "\"guard\"")?,
        form,
        at_m: [across.quantity()?, ahead.quantity_as(Dimension::Length, ABOVE_ZERO)?],
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
    let one = |entry: &Entry<'_>| entry.quantity();
    Ok([one(length)?, one(width)?, one(height)?])
}
