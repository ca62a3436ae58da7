//! Writes a ranging scenario with every default filled in, as TOML and, in the same structure, for JSON.

use super::super::camera;
use super::super::entries::{Document, Entries, Part, entries, text};
use super::super::paths::Paths;
use super::super::scene::{objects_written, scene_written};
use super::{
    CubeSpec, Demand, DepthRequirement, DepthSource, Diffraction, NoiseSource, RangeScenario, Stereo, Subject,
};
use hadar::units::Dimension;
use serde::{Serialize, Serializer};
use std::path::Path;

impl RangeScenario {
    /// The scenario as TOML, with absolute paths; reading it gives the same question.
    ///
    /// ```
    /// use hadar_scenario::RangeScenario;
    /// let text = "[cube]\nleft = \"/data/left.npy\"\n[stereo]\nbaseline = \"0.2 m\"\nfocal_length = \"14 mm\"\npixel = \"12 um\"\n";
    /// let scenario = RangeScenario::from_toml(text, None)?;
    /// let again = RangeScenario::from_toml(&scenario.to_toml(), None)?;
    /// assert_eq!((&again.subject, &again.stereo), (&scenario.subject, &scenario.stereo));
    /// # Ok::<(), hadar::Error>(())
    /// ```
    #[must_use]
    pub fn to_toml(&self) -> String {
        text(self.document(Paths { beside: None }), &self.source)
    }

    /// As [`RangeScenario::to_toml`], with paths below `directory` written relative to it.
    #[must_use]
    pub fn to_toml_beside(&self, directory: &Path) -> String {
        let absolute = std::path::absolute(directory).ok();
        text(self.document(Paths { beside: absolute.as_deref() }), &self.source)
    }

    fn document(&self, paths: Paths<'_>) -> Document {
        let mut document = Vec::new();
        if let Some(title) = &self.title {
            document.push(("title", Part::Value(title.as_str().into())));
        }
        match &self.subject {
            Subject::Scene(spec) => {
                document.push(("scene", Part::Table(scene_written(spec, paths))));
                if let Some(objects) = &spec.objects {
                    document.push(("object", Part::Tables(objects_written(objects, paths))));
                }
            }
            Subject::Cube(spec) => document.push(("cube", Part::Table(cube(spec, paths)))),
        }
        if let Some(spec) = &self.bands {
            document.push(("bands", Part::Table(spec.written(paths))));
        }
        if let Some(spec) = &self.camera {
            document.push(("camera", Part::Table(camera::written(spec, paths))));
        }
        document.push(("stereo", Part::Table(stereo(&self.stereo))));
        document.push(("requirement", Part::Table(requirement(self.requirement))));
        document
    }
}

/// The same keys as the TOML, quantities in the units used inside, with absolute paths.
impl Serialize for RangeScenario {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        entries(self.document(Paths { beside: None }), serializer)
    }
}

fn cube(spec: &CubeSpec, paths: Paths<'_>) -> Entries {
    let entries = Entries::default()
        .put("left", paths.file(&spec.left))
        .put_if("right", spec.right.as_ref().map(|path| paths.file(path)))
        .put_if("variable", spec.variable.as_deref())
        .put_if("axes", spec.axes.map(|axes| axes.to_string()))
        .put_if("photons_per_unit", spec.photons_per_unit);
    let entries = match &spec.noise {
        None => entries,
        Some(NoiseSource::Uniform(var)) => entries.put("noise_variance", *var),
        Some(NoiseSource::File(path)) => entries.put("noise_variance", paths.file(path)),
    };
    match &spec.depth {
        None => entries,
        Some(DepthSource::Uniform(depth_m)) => {
            entries.put_quantity("depth", Dimension::Length, Some(*depth_m))
        }
        Some(DepthSource::File(path)) => entries.put("depth", paths.file(path)),
    }
}

pub(crate) fn stereo(stereo: &Stereo) -> Entries {
    let entries = Entries::default()
        .put_quantity("baseline", Dimension::Length, Some(stereo.baseline_m))
        .put_quantity("focal_length", Dimension::Length, stereo.focal_length_m)
        .put_quantity("pixel", Dimension::Length, stereo.pixel_m)
        .put("window", [stereo.window.rows(), stereo.window.columns()].map(whole).to_vec())
        .put("derivative", stereo.derivative.name())
        .put("joined", stereo.joined.name())
        .put_if("lines", (!stereo.lines.is_empty()).then(|| lines(&stereo.lines)));
    match stereo.diffraction {
        Diffraction::None => entries.put("diffraction", "none"),
        Diffraction::Airy => entries.put("diffraction", "airy"),
        Diffraction::Gaussian(sigma_m) => {
            entries.put("diffraction", "gaussian").put_quantity("psf_sigma", Dimension::Length, Some(sigma_m))
        }
    }
}

fn lines(lines: &[usize]) -> Vec<i64> {
    lines.iter().map(|row| whole(*row)).collect()
}

/// As TOML has whole numbers; what was read from it fits.
fn whole(number: usize) -> i64 {
    i64::try_from(number).unwrap_or(i64::MAX)
}

pub(crate) fn requirement(requirement: DepthRequirement) -> Entries {
    let entries = match requirement.error {
        Demand::Absolute(error_m) => {
            Entries::default().put_quantity("depth_error", Dimension::Length, Some(error_m))
        }
        Demand::Relative(share) => Entries::default().put("relative_depth_error", share),
    };
    entries.put("share", requirement.share)
}
