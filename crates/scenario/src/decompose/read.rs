//! Reads a decomposition scenario: every key checked, every error one line with file, line and key.

use super::super::emissivity_error;
use super::super::keys::files;
use super::super::kind::Kind;
use super::super::paths::{axes, file, is_path, material, variable};
use super::super::reader::file;
use super::super::scene_folder::{self, LEFT, cube_file};
use super::super::section::{Entry, Section};
use super::super::{AtmosphereSpec, BandsSpec, Source, camera, class};
use super::category::{Told, categories, segmentation};
use super::image::{spatial, vision};
use super::{
    AirOfCube, Bad, CubeNoise, CubeUnit, DecomposeScenario, HeatCube, LibrarySpec, LightLike, LightSource,
    PixelUnknown, SharedUnknown, TruthSpec,
};
use hadar::allowed::ABOVE_ZERO;
use hadar::error::{Error, Result};
use hadar::radiance_unit::RadianceUnit;
use hadar_formats::cube::TemperatureUnit;
use std::path::Path;

/// Maps of the truth in files of their own.
const MAPS: [&str; 5] = ["material", "material_list", "temperature", "temperature_unit", "lighting"];
const MINIMUM: &str =
    "write [cube] with data = \"counts.npy\", [bands], and [library] with path = \"library.csv\"";
/// Temperatures of a scene where nothing is said, K.
const TEMPERATURES_K: [f64; 2] = [200.0, 400.0];
const RADIANCE: &str = "W m^-2 sr^-1 per cm^-1";

file!(DecomposeScenario, source, (Kind::Decompose, MINIMUM, &files::DECOMPOSE));

impl DecomposeScenario {
    fn of_root(root: &Section<'_>) -> Result<Self> {
        let camera = root.read_once("camera", camera::read)?;
        let cube = root.table("cube", MINIMUM)?;
        let unknown = root.read("unknown", unknown)?.unwrap_or_default();
        let cube = heat_cube(&cube, camera.is_some())?;
        let data = cube.data.clone();
        let scenario = Self {
            title: root.title("\"What is in this street?\"")?,
            cube,
            bands: root.read_once("bands", BandsSpec::read)?,
            camera,
            atmosphere: root.read("atmosphere", air)?,
            environment: root
                .read("environment", |entry| entry.items("[[environment]]")?.iter().map(light).collect())?
                .unwrap_or_default(),
            classes: class::read(root)?,
            library: library(&root.table("library", MINIMUM)?)?,
            unknown,
            spatial: root.read("spatial", spatial)?,
            vision: root.read("vision", vision)?.unwrap_or_default(),
            categories: root.read("category", |entry| categories(entry, Told::ByLabels))?.unwrap_or_default(),
            segmentation: root.read("segmentation", segmentation)?.unwrap_or_default(),
            truth: root.read("truth", |entry| truth(entry, &data))?,
            source: Source::default(),
        };
        no_air_without(root, &scenario.unknown, scenario.atmosphere.is_some())?;
        if scenario.categories.is_empty()
            && let Some(key) = match &scenario.truth {
                _ if root.get("segmentation").is_some() => Some("segmentation"),
                Some(truth) if truth.category.is_some() => Some("truth.category"),
                _ => None,
            }
        {
            let found = "no category to find";
            let instead =
                "write [[category]] with name = \"car\" and materials = [\"pmma\"], or leave it out";
            return Err(root.fail(key, Error::malformed(found, instead)));
        }
        Ok(scenario)
    }
}

impl Default for PixelUnknown {
    fn default() -> Self {
        Self {
            temperature_k: TEMPERATURES_K,
            lighting_total: None,
            gain: false,
            shared: SharedUnknown::default(),
        }
    }
}

/// What is done with what is found to be bad.
pub(crate) const BAD: [(&str, Bad); 2] = [("leave-out", Bad::LeaveOut), ("keep", Bad::Keep)];

pub(crate) fn heat_cube(entry: &Entry<'_>, camera: bool) -> Result<HeatCube> {
    let section = entry.section()?;
    section.at_most_one(&["counts_per_photon_radiance", "unit"])?;
    let counts = section.number("counts_per_photon_radiance")?;
    let radiance = section.read("unit", |entry| {
        let written = entry.name("\"W m^-2 sr^-1 um^-1\"")?;
        match TemperatureUnit::spelt(&written) {
            Some(unit) => Ok(CubeUnit::BrightnessTemperature { unit, written }),
            None => {
                let unit = RadianceUnit::spelt(&written).map_err(|error| entry.fail(error))?;
                Ok(CubeUnit::Radiance { unit, written })
            }
        }
    })?;
    let noise = section.read("noise", |entry| match entry.text("\"noise.csv\"") {
        Ok(text) if is_path(text) => file(entry).map(CubeNoise::File),
        _ => entry.number("1e-4").map(CubeNoise::Uniform),
    })?;
    let unit = match (counts, radiance, camera) {
        (Some(_), _, true) | (_, Some(_), true) => {
            let found = "a [camera] and a unit both state the scale of a sample";
            return Err(entry.fail(Error::malformed(found, "leave one of them out")));
        }
        (Some(counts), ..) => CubeUnit::CountsPerPhotonRadiance(counts),
        (None, Some(unit), _) if noise.is_none() => {
            let found = match unit {
                CubeUnit::BrightnessTemperature { .. } => "brightness temperatures without their noise",
                _ => "radiances without their noise",
            };
            let instead = "write noise = 1e-4, the deviation of a sample in that unit";
            return Err(section.fail("unit", Error::malformed(found, instead)));
        }
        (None, Some(radiance), _) => radiance,
        (None, None, true) => CubeUnit::Camera,
        (None, None, false) => {
            let found = "the scale of the samples is not stated";
            let instead = format!(
                "write counts_per_photon_radiance = 2.2e-14, unit = \"{RADIANCE}\" with a noise, or a [camera]"
            );
            return Err(entry.fail(Error::malformed(found, instead)));
        }
    };
    Ok(HeatCube {
        data: cube_file(&section.require("data")?, LEFT)?,
        variable: variable(&section)?,
        axes: axes(&section)?,
        unit,
        noise,
        bad_bands: bad_bands(&section)?,
        bad_pixels: section.read("bad_pixels", file)?,
        bad: section.choice("bad", &BAD)?.unwrap_or_default(),
    })
}

/// Bands that are left out (`bad_bands`).
pub(crate) fn bad_bands(section: &Section<'_>) -> Result<Vec<usize>> {
    let bands = section.read("bad_bands", |entry| {
        let items = entry.items("bad_bands = [0, 53]")?;
        items.iter().map(|item| place(item, "53")).collect()
    })?;
    Ok(bands.unwrap_or_default())
}

/// A place in a list that is counted from 0.
pub(crate) fn place(entry: &Entry<'_>, example: &str) -> Result<usize> {
    entry.number(example).map(|place| place as usize)
}

/// What pixels may be like.
pub(crate) const LIKE: [(&str, LightLike); 2] = [("sky", LightLike::Sky), ("ground", LightLike::Ground)];

pub(crate) fn light(entry: &Entry<'_>) -> Result<LightSource> {
    let section = entry.section()?;
    let rows = || {
        section.read("rows", |entry| {
            let [first, last] = entry.pair("[0, 540]")?;
            let [first, last] = [place(&first, "0")?, place(&last, "540")?];
            if first < last {
                return Ok([first, last]);
            }
            let found = format!("no row from {first} up to {last}");
            Err(entry.fail(Error::malformed(found, "write the first row, and the one after the last")))
        })
    };
    // Rows beside it say where.
    if let Some(like) = section.choice("found", &LIKE)? {
        section.at_most_one(&["found", "spectrum"])?;
        section.at_most_one(&["found", "temperature"])?;
        return Ok(LightSource::Found { like, rows: rows()? });
    }
    let kinds = ["spectrum", "rows", "temperature"];
    let instead = "write temperature = \"-10 degC\", spectrum = \"light.csv\" with column = \"sky\", rows = [0, 540], or found = \"sky\"";
    match section.at_most_one(&kinds)? {
        Some("spectrum") => Ok(LightSource::Spectrum {
            path: file(&section.require("spectrum")?)?,
            column: section.require("column")?.name("\"sky\"")?,
        }),
        Some("rows") => Ok(LightSource::Rows(rows()?.unwrap_or_default())),
        Some(_) => Ok(LightSource::Surface {
            material: section.read("material", material)?,
            temperature_k: section.require("temperature")?.quantity()?,
        }),
        None => {
            Err(entry.fail(Error::malformed("the radiation of these surroundings is not stated", instead)))
        }
    }
}

fn library(entry: &Entry<'_>) -> Result<LibrarySpec> {
    let section = entry.section()?;
    let spec = LibrarySpec {
        path: section.read("path", file)?,
        materials: section.read("materials", |entry| {
            entry.items("materials = [\"skin\", \"aluminium\"]")?.iter().map(material).collect()
        })?,
        prior: section.read("prior", |entry| {
            entry.items("prior = [1.0, 0.2]")?.iter().map(|item| item.number("1.0")).collect()
        })?,
        none_of_these: section.number("none_of_these")?,
        mixed: section.number("mixed")?,
        emissivity_error: emissivity_error::read(&section, emissivity_error::Of::Share)?,
        emissivity_correlation_cm1: section.quantity("emissivity_correlation")?,
    };
    if spec.path.is_none() && spec.materials.is_none() {
        let instead = "write path = \"library.csv\" or materials = [\"skin\", \"aluminium\"]";
        return Err(entry.fail(Error::malformed("no materials", instead)));
    }
    if spec.emissivity_correlation_cm1.is_some() && spec.emissivity_error.is_none() {
        let found = Error::malformed("a correlation of no error", "write emissivity_error = 0.01 too");
        return Err(section.fail("emissivity_correlation", found));
    }
    Ok(spec)
}

/// What is said of the scale of the counts.
#[derive(Clone, Copy, PartialEq)]
enum Gain {
    Known,
    OfEachPixel,
    Shared(f64),
}

/// Refuses a length of air that nothing says.
pub(crate) fn no_air_without(root: &Section<'_>, unknown: &PixelUnknown, is_said: bool) -> Result<()> {
    if unknown.shared.air_m.is_none() || is_said {
        return Ok(());
    }
    let found = Error::malformed("a length of no air", "write [atmosphere] too, or leave it out");
    Err(root.fail("unknown.air", found))
}

/// The air of a cube.
pub(crate) fn air(entry: &Entry<'_>) -> Result<AirOfCube> {
    let air = AtmosphereSpec::read(entry)?;
    let distance_m = entry.section()?.require("distance")?.quantity()?;
    Ok(AirOfCube { air, distance_m })
}

pub(crate) fn unknown(entry: &Entry<'_>) -> Result<PixelUnknown> {
    let section = entry.section()?;
    let gain = section.read("gain", |entry| match entry.boolean() {
        Ok(unknown) => Ok(if unknown { Gain::OfEachPixel } else { Gain::Known }),
        Err(_) => entry.number_as("0.02", ABOVE_ZERO).map(Gain::Shared),
    })?;
    let temperature = |end: &Entry<'_>| end.quantity();
    let default = PixelUnknown::default();
    Ok(PixelUnknown {
        temperature_k: section
            .read("temperature", |entry| {
                let ends = entry.range("[\"250 K\", \"340 K\"]", temperature, |k| k)?;
                if ends[0] < ends[1] {
                    return Ok(ends);
                }
                Err(entry.fail(Error::malformed("a range of one temperature", "write two that differ")))
            })?
            .unwrap_or(default.temperature_k),
        lighting_total: section.number("lighting_total")?,
        gain: gain.is_some_and(|gain| gain == Gain::OfEachPixel),
        shared: SharedUnknown {
            gain: gain.and_then(|gain| match gain {
                Gain::Shared(sigma) => Some(sigma),
                _ => None,
            }),
            wavelength_shift_cm1: section.quantity("wavelength_shift")?,
            sky_scale: section.number("sky_scale")?,
            sky_shape: section.number("sky_shape")?,
            sky_path: section.number("sky_path")?,
            light_temperature_k: section.quantity("light_temperature")?,
            missing_light: section.number("missing_light")?,
            air_m: section.quantity("air")?,
            noise_scale: section.number("noise_scale")?,
        },
    })
}

/// The truth of a cube.
pub(crate) fn truth(entry: &Entry<'_>, cube: &Path) -> Result<TruthSpec> {
    let section = entry.section()?;
    if let Some(scene) = section.get("scene") {
        for key in MAPS {
            section.at_most_one(&["scene", key])?;
        }
        let category = section.read("category", file)?;
        return Ok(TruthSpec { category, ..scene_folder::truth(&scene, cube)? });
    }
    for (key, of) in [("material_list", "material"), ("temperature_unit", "temperature")] {
        if section.get(key).is_some() && section.get(of).is_none() {
            let found =
                Error::malformed(format!("there is no {of} that it is said of"), format!("write {of} too"));
            return Err(section.fail(key, found));
        }
    }
    Ok(TruthSpec {
        material: section.read("material", file)?,
        material_list: section.read("material_list", file)?,
        temperature: section.read("temperature", file)?,
        celsius: section.choice("temperature_unit", &[("K", false), ("degC", true)])?.unwrap_or(false),
        category: section.read("category", file)?,
        lighting: section
            .read("lighting", |entry| match entry.is_list() {
                true => entry.items("[\"v1.npy\"]")?.iter().map(file).collect(),
                false => Ok(vec![file(entry)?]),
            })?
            .unwrap_or_default(),
    })
}
