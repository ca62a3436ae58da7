//! Reads a ranging scenario: every key checked, every error one line with file, line and key.

use super::super::decompose::read::BAD;
use super::super::keys::files;
use super::super::kind::Kind as FileKind;
use super::super::paths::{axes, file, variable};
use super::super::reader::file;
use super::super::scene::scene_of;
use super::super::scene_folder::{LEFT, RIGHT, cube_file};
use super::super::section::{Entry, Section};
use super::super::{BandsSpec, Source, camera};
use super::{
    CubeSpec, Demand, DepthRequirement, DepthSource, Diffraction, NoiseSource, RangeScenario, Stereo, Subject,
};
use hadar::error::{Error, Result};
use hadar::ranging::derivative::Derivative;
use hadar::ranging::information::Window;
use hadar::ranging::noise::Joined;
use hadar_formats::cube::is_called_so as is_cube;
use std::path::Path;

const MINIMUM: &str = "write [scene] for the built-in street or [cube] with left = \"left.npy\", \
                       and [stereo] with baseline = \"0.2 m\"";
/// δz/z that is demanded where nothing is said.
const RELATIVE_ERROR: f64 = 0.05;

file!(RangeScenario, source, (FileKind::Range, MINIMUM, &files::RANGE));

impl RangeScenario {
    fn of_root(root: &Section<'_>) -> Result<Self> {
        root.at_most_one(&["scene", "cube"])?;
        let subject = match (root.get("scene"), root.get("cube")) {
            (Some(entry), _) => Subject::Scene(Box::new(scene_of(root, &entry)?)),
            (None, Some(entry)) => Subject::Cube(cube(&entry)?),
            (None, None) => {
                return Err(Error::malformed("there is neither a [scene] nor a [cube]", MINIMUM)
                    .at(root.source().place("")));
            }
        };
        let camera = root.read_once("camera", camera::read)?;
        let rendered = matches!(subject, Subject::Scene(_));
        if rendered {
            root.table("camera", "write [camera] with preset = \"flir-a325sc\"")?;
        }
        let pair = root.table("stereo", "write [stereo] with baseline = \"0.2 m\"")?;
        let stereo = stereo(&pair, camera.is_some(), rendered)?;
        Ok(Self {
            title: root.title("\"How far is the person?\"")?,
            bands: root.read_once("bands", BandsSpec::read)?.or_else(|| rendered.then(BandsSpec::default)),
            requirement: root.read("requirement", requirement)?.unwrap_or_default(),
            subject,
            camera,
            stereo,
            source: Source::default(),
        })
    }
}

impl Default for DepthRequirement {
    fn default() -> Self {
        Self { error: Demand::Relative(RELATIVE_ERROR), share: 0.5 }
    }
}

fn cube(entry: &Entry<'_>) -> Result<CubeSpec> {
    let section = entry.section()?;
    Ok(CubeSpec {
        left: cube_file(&section.require("left")?, LEFT)?,
        right: section.read("right", |entry| cube_file(entry, RIGHT))?,
        variable: variable(&section)?,
        axes: axes(&section)?,
        photons_per_unit: section.number("photons_per_unit")?,
        noise: section.read("noise_variance", |entry| match entry.text("\"noise.csv\"") {
            Ok(_) => file(entry).map(NoiseSource::File),
            Err(_) => entry.number("50.0").map(NoiseSource::Uniform),
        })?,
        bad: section.choice("bad", &BAD)?.unwrap_or_default(),
        depth: section.read("depth", |entry| {
            let text = entry.text("\"12 m\" or \"depth.npy\"")?.trim();
            if is_cube(Path::new(text)) {
                return file(entry).map(DepthSource::File);
            }
            entry.quantity().map(DepthSource::Uniform)
        })?,
    })
}

/// The pair of cameras before a rendered scene, whose camera is known.
pub(crate) fn stereo_of_scene(entry: &Entry<'_>) -> Result<Stereo> {
    stereo(entry, true, true)
}

fn stereo(entry: &Entry<'_>, camera: bool, rendered: bool) -> Result<Stereo> {
    let section = entry.section()?;
    let length = |key| section.quantity(key);
    let (focal_length_m, pixel_m) = (length("focal_length")?, length("pixel")?);
    for (key, given, example) in
        [("focal_length", focal_length_m, "\"1.4 cm\""), ("pixel", pixel_m, "\"12 um\"")]
    {
        if camera && given.is_some() {
            let found = Error::malformed(format!("{key} is the camera's"), "write it in [camera]");
            return Err(section.fail(key, found));
        }
        if !camera && given.is_none() {
            let instead = format!("write {key} = {example}, or a [camera]");
            return Err(section.fail(key, Error::malformed("the key is missing", instead)));
        }
    }
    let sigma = length("psf_sigma")?;
    let kinds = [("none", Kind::None), ("airy", Kind::Airy), ("gaussian", Kind::Gaussian)];
    let silent = if rendered { Kind::Airy } else { Kind::None };
    let diffraction = match (section.choice("diffraction", &kinds)?.unwrap_or(silent), sigma) {
        (Kind::Gaussian, Some(sigma)) => Diffraction::Gaussian(sigma),
        (Kind::Gaussian, None) => {
            let found = Error::malformed("the key is missing", "write psf_sigma = \"5 um\"");
            return Err(section.fail("psf_sigma", found));
        }
        (_, Some(_)) => {
            let found = "psf_sigma without diffraction = \"gaussian\"";
            return Err(section.fail("psf_sigma", Error::malformed(found, "add that, or leave it out")));
        }
        (Kind::Airy, None) if !camera => {
            let found = "an Airy pattern needs a camera, whose aperture makes it";
            return Err(
                section.fail("diffraction", Error::malformed(found, "add [camera], or write \"none\""))
            );
        }
        (Kind::Airy, None) => Diffraction::Airy,
        (Kind::None, None) => Diffraction::None,
    };
    let schemes = Derivative::ALL.map(|scheme| (scheme.name(), scheme));
    let joined = Joined::ALL.map(|joined| (joined.name(), joined));
    Ok(Stereo {
        baseline_m: section.require("baseline")?.quantity()?,
        focal_length_m,
        pixel_m,
        window: section.read("window", window)?.map_or_else(|| Window::new(5, 5), Ok)?,
        // Central differences see too little of fine texture, and their bound comes out too large; splines see more, of noise too, which
        // only the counts of a file have.
        derivative: section.choice("derivative", &schemes)?.unwrap_or(match rendered {
            true => Derivative::CubicSpline,
            false => Derivative::Central,
        }),
        joined: section.choice("joined", &joined)?.unwrap_or_default(),
        lines: section
            .read("lines", |entry| {
                let items = entry.items("lines = [300]")?;
                items.iter().map(|item| item.count("300").map(|row| row as usize)).collect()
            })?
            .unwrap_or_default(),
        diffraction,
    })
}

#[derive(Clone, Copy)]
enum Kind {
    None,
    Airy,
    Gaussian,
}

fn window(entry: &Entry<'_>) -> Result<Window> {
    let [rows, columns] = entry.pair("[5, 5]")?;
    let (rows, columns) = (rows.count("5")?, columns.count("5")?);
    Window::new(rows as usize, columns as usize).map_err(|error| entry.fail(error))
}

pub(crate) fn requirement(entry: &Entry<'_>) -> Result<DepthRequirement> {
    let section = entry.section()?;
    section.at_most_one(&["depth_error", "relative_depth_error"])?;
    let default = DepthRequirement::default();
    let absolute = section.quantity("depth_error")?;
    let relative = section.number("relative_depth_error")?;
    Ok(DepthRequirement {
        error: match (absolute, relative) {
            (Some(error_m), _) => Demand::Absolute(error_m),
            (None, Some(share)) => Demand::Relative(share),
            (None, None) => default.error,
        },
        share: section.number("share")?.unwrap_or(default.share),
    })
}
