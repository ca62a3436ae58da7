//! Writes a ranging scenario with every default filled in, as TOML and, in the same structure, for JSON.

use super::super::camera;
use super::super::decompose::{Bad, read::BAD};
use super::super::entries::{Document, Entries};
use super::super::paths::Paths;
use super::super::scene::scene_document;
use super::{
    CubeSpec, Demand, DepthRequirement, DepthSource, Diffraction, NoiseSource, RangeScenario, Stereo, Subject,
};
use hadar::units::Dimension;

impl RangeScenario {
    pub(super) fn document(&self, paths: Paths<'_>) -> Document {
        let document = Document::titled(self.title.as_ref());
        let document = match &self.subject {
            Subject::Scene(spec) => document.and(scene_document(spec, paths)),
            Subject::Cube(spec) => document.put("cube", cube(spec, paths)),
        };
        document
            .put_if("bands", self.bands.as_ref().map(|spec| spec.written(paths)))
            .put_if("camera", self.camera.as_ref().map(|spec| camera::written(spec, paths)))
            .put("stereo", stereo(&self.stereo))
            .put("requirement", requirement(self.requirement))
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
    let bad = BAD.iter().find(|(_, one)| *one == spec.bad && spec.bad != Bad::default());
    let entries = entries.put_if("bad", bad.map(|(name, _)| *name));
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
