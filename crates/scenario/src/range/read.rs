//! Reads a ranging scenario: every key checked, every error one line with file, line and key.

use super::super::keys::files;
use super::super::kind::Kind as FileKind;
use super::super::paths::{axes, file, is_cube, variable};
use super::super::read::document;
use super::super::scene::scene_of;
use super::super::scene_folder::{LEFT, RIGHT, cube_file};
use super::super::section::{Entry, Section};
use super::super::written::Written;
use super::super::{BandsSpec, Source, camera};
use super::{
    CubeSpec, Demand, DepthRequirement, DepthSource, Diffraction, NoiseSource, RangeScenario, Stereo, Subject,
};
use hadar::error::{Error, Result};
use hadar::ranging::derivative::Derivative;
use hadar::ranging::information::Window;
use hadar::ranging::noise::Joined;
use std::path::Path;

const MINIMUM: &str = "write [scene] for the built-in street or [cube] with left = \"left.npy\", \
                       and [stereo] with baseline = \"0.2 m\"";
/// δz/z that is demanded where nothing is said.
const RELATIVE_ERROR: f64 = 0.05;

impl RangeScenario {
    /// Reads a ranging scenario. Relative paths in it start from its directory.
    ///
    /// # Errors
    /// The first thing that is wrong, in one line with file, line and key, as [`crate::Scenario::from_file`].
    pub fn from_file(path: &Path) -> Result<Self> {
        Self::from_written(&Written::from_file(path)?)
    }

    /// Reads a ranging scenario from text; `path` as in [`crate::Scenario::from_toml`].
    ///
    /// # Errors
    /// As [`RangeScenario::from_file`], except those of the file itself.
    ///
    /// ```
    /// use hadar_scenario::RangeScenario;
    /// let text = r#"
    ///     [scene]
    ///     person_temperature = "37 degC"
    ///     [camera]
    ///     preset = "flir-a325sc"
    ///     [stereo]
    ///     baseline = "0.2 m"
    /// "#;
    /// let scenario = RangeScenario::from_toml(text, None)?;
    /// assert_eq!(scenario.stereo.window.rows(), 5);
    /// let error = RangeScenario::from_toml(&text.replace("0.2 m", "0 m"), None).unwrap_err();
    /// assert!(error.to_string().starts_with("line 7: stereo.baseline: `0 m` is out of range"));
    /// # Ok::<(), hadar::Error>(())
    /// ```
    pub fn from_toml(text: &str, path: Option<&Path>) -> Result<Self> {
        Self::from_written(&Written::of(text, path))
    }

    /// Reads it with values in the place of its own.
    ///
    /// # Errors
    /// As [`Self::from_toml`].
    pub fn from_written(written: &Written) -> Result<Self> {
        scenario(written)
    }
}

fn scenario(written: &Written) -> Result<RangeScenario> {
    let mut source = written.source();
    let document = document(written, (FileKind::Range, MINIMUM), &mut source)?;
    let root = Section::open(&document, "", &source, &files::RANGE)?;
    root.at_most_one(&["scene", "cube"])?;
    let subject = match (root.get("scene"), root.get("cube")) {
        (Some(entry), _) => Subject::Scene(Box::new(scene_of(&root, &entry)?)),
        (None, Some(entry)) => Subject::Cube(cube(&entry)?),
        (None, None) => {
            return Err(
                Error::malformed("there is neither a [scene] nor a [cube]", MINIMUM).at(source.place(""))
            );
        }
    };
    let camera = root.read("camera", camera::read)?;
    if matches!(subject, Subject::Scene(_)) && camera.is_none() {
        let found = Error::malformed("the table is missing", "write [camera] with preset = \"flir-a325sc\"");
        return Err(root.fail("camera", found));
    }
    let stereo = match root.get("stereo") {
        Some(entry) => stereo(&entry, camera.is_some(), matches!(subject, Subject::Scene(_)))?,
        None => {
            let found = Error::malformed("the table is missing", "write [stereo] with baseline = \"0.2 m\"");
            return Err(root.fail("stereo", found));
        }
    };
    let mut scenario = RangeScenario {
        title: root.read("title", |entry| Ok(entry.text("\"How far is the person?\"")?.to_owned()))?,
        bands: root.read("bands", BandsSpec::read)?,
        requirement: root.read("requirement", requirement)?.unwrap_or_default(),
        subject,
        camera,
        stereo,
        source: Source::default(),
    };
    if matches!(scenario.subject, Subject::Scene(_)) && scenario.bands.is_none() {
        scenario.bands = Some(BandsSpec::default());
    }
    scenario.source = source;
    Ok(scenario)
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
