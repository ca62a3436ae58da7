//! Writes a decomposition scenario, as TOML and, in the same structure, for JSON.

use super::super::entries::{Document, Entries, Part, entries, text};
use super::super::paths::Paths;
use super::super::{BandsSpec, CameraSpec, camera, class};
use super::category::{category_written, segmentation_written};
use super::image::{spatial_written, vision_written};
use super::{
    CubeNoise, CubeUnit, DecomposeScenario, HeatCube, LightSource, PixelUnknown, SegmentationSpec, TruthSpec,
    VisionSpec,
};
use hadar::units::Dimension;
use serde::{Serialize, Serializer};
use std::path::Path;
use toml::Value;

impl DecomposeScenario {
    /// The scenario as TOML, with paths below `directory` written relative to it.
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
        document.extend(cube_written(
            &self.cube,
            self.bands.as_ref(),
            self.camera.as_ref(),
            &self.environment,
            paths,
        ));
        let library = &self.library;
        let names = |materials: &Vec<_>| materials.iter().map(|m| paths.material(m)).collect::<Vec<_>>();
        let written = Entries::default()
            .put_if("path", library.path.as_ref().map(|path| paths.file(path)))
            .put_if("materials", library.materials.as_ref().map(names))
            .put_if("prior", library.prior.clone())
            .put_if("emissivity_error", library.emissivity_error)
            .put_quantity(
                "emissivity_correlation",
                Dimension::Wavenumber,
                library.emissivity_correlation_cm1,
            );
        if !self.classes.is_empty() {
            let one = |(name, spec): (&String, &_)| (name.clone(), class::written(spec, paths));
            document.push(("class", Part::Named(self.classes.iter().map(one).collect())));
        }
        document.push(("library", Part::Table(written)));
        document.push(("unknown", Part::Table(unknown_written(&self.unknown))));
        if let Some(prior) = &self.spatial {
            document.push(("spatial", Part::Table(spatial_written(prior))));
        }
        if self.vision != VisionSpec::default() {
            document.push(("vision", Part::Table(vision_written(&self.vision))));
        }
        if !self.categories.is_empty() {
            document.push(("category", Part::Tables(self.categories.iter().map(category_written).collect())));
        }
        if self.segmentation != SegmentationSpec::default() {
            document.push(("segmentation", Part::Table(segmentation_written(self.segmentation))));
        }
        if let Some(truth) = &self.truth {
            document.push(("truth", Part::Table(truth_written(truth, paths))));
        }
        document
    }
}

/// `[cube]`, `[bands]`, `[camera]` and `[[environment]]`.
pub(crate) fn cube_written(
    cube: &HeatCube,
    bands: Option<&BandsSpec>,
    camera: Option<&CameraSpec>,
    environment: &[LightSource],
    paths: Paths<'_>,
) -> Document {
    let mut document = Vec::new();
    let (counts, unit) = match cube.unit {
        CubeUnit::CountsPerPhotonRadiance(counts) => (Some(counts), None),
        CubeUnit::Camera => (None, None),
        CubeUnit::Radiance => (None, Some("W m^-2 sr^-1 per cm^-1")),
    };
    let whole = |numbers: &[usize]| numbers.iter().map(|n| *n as i64).collect::<Vec<_>>();
    let written = Entries::default()
        .put("data", paths.file(&cube.data))
        .put_if("variable", cube.variable.clone())
        .put_if("axes", cube.axes.map(|axes| axes.to_string()))
        .put_if("counts_per_photon_radiance", counts)
        .put_if("unit", unit)
        .put_if(
            "noise",
            cube.noise.as_ref().map(|noise| match noise {
                CubeNoise::Uniform(sigma) => Value::from(*sigma),
                CubeNoise::File(path) => Value::from(paths.file(path)),
            }),
        )
        .put_if("bad_bands", (!cube.bad_bands.is_empty()).then(|| whole(&cube.bad_bands)));
    document.push(("cube", Part::Table(written)));
    if let Some(spec) = bands {
        document.push(("bands", Part::Table(spec.written(paths))));
    }
    if let Some(spec) = camera {
        document.push(("camera", Part::Table(camera::written(spec, paths))));
    }
    let lights = environment.iter().map(|light| match light {
        LightSource::Spectrum { path, column } => {
            Entries::default().put("spectrum", paths.file(path)).put("column", column.clone())
        }
        LightSource::Surface { material, temperature_k } => Entries::default()
            .put_if("material", material.as_ref().map(|material| paths.material(material)))
            .put_quantity("temperature", Dimension::Temperature, Some(*temperature_k)),
        LightSource::Rows(rows) => Entries::default().put("rows", whole(rows)),
    });
    document.push(("environment", Part::Tables(lights.collect())));
    document
}

/// `[unknown]`.
pub(crate) fn unknown_written(unknown: &PixelUnknown) -> Entries {
    Entries::default()
        .put_range("temperature", Dimension::Temperature, Some(unknown.temperature_k))
        .put_if("lighting_total", unknown.lighting_total)
        .put("gain", unknown.gain)
}

/// `[truth]`.
pub(crate) fn truth_written(truth: &TruthSpec, paths: Paths<'_>) -> Entries {
    let file = |path: &Option<_>| path.as_ref().map(|path: &std::path::PathBuf| paths.file(path));
    let lighting: Vec<String> = truth.lighting.iter().map(|path| paths.file(path)).collect();
    Entries::default()
        .put_if("material", file(&truth.material))
        .put_if("material_list", file(&truth.material_list))
        .put_if("temperature", file(&truth.temperature))
        .put_if("temperature_unit", truth.celsius.then_some("degC"))
        .put_if("lighting", (!lighting.is_empty()).then_some(lighting))
        .put_if("category", file(&truth.category))
}

/// The same keys as the TOML, quantities in the units used inside, with absolute paths.
impl Serialize for DecomposeScenario {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        entries(self.document(Paths { beside: None }), serializer)
    }
}
