//! Writes a decomposition scenario, as TOML and, in the same structure, for JSON.

use super::super::entries::{Document, Entries};
use super::super::paths::Paths;
use super::super::{BandsSpec, CameraSpec, camera, class};
use super::category::{categories_written, segmentation_written};
use super::image::{spatial_written, vision_written};
use super::read::{BAD, LIKE};
use super::{
    AirOfCube, Bad, CubeNoise, CubeUnit, DecomposeScenario, HeatCube, LightSource, PixelUnknown,
    SegmentationSpec, TruthSpec, VisionSpec,
};
use hadar::units::Dimension;
use toml::Value;

impl DecomposeScenario {
    pub(super) fn document(&self, paths: Paths<'_>) -> Document {
        let library = &self.library;
        let names = |materials: &Vec<_>| materials.iter().map(|m| paths.material(m)).collect::<Vec<_>>();
        let written = Entries::default()
            .put_if("path", library.path.as_ref().map(|path| paths.file(path)))
            .put_if("materials", library.materials.as_ref().map(names))
            .put_if("prior", library.prior.clone())
            .put_if("none_of_these", library.none_of_these)
            .put_if("mixed", library.mixed)
            .put_if("emissivity_error", library.emissivity_error)
            .put_quantity(
                "emissivity_correlation",
                Dimension::Wavenumber,
                library.emissivity_correlation_cm1,
            );
        let (vision, segmentation) = (VisionSpec::default(), SegmentationSpec::default());
        let segmentation =
            (self.segmentation != segmentation).then(|| segmentation_written(self.segmentation));
        let cube =
            cube_written(&self.cube, self.bands.as_ref(), self.camera.as_ref(), &self.environment, paths);
        Document::titled(self.title.as_ref())
            .and(cube)
            .put_if("atmosphere", self.atmosphere.as_ref().map(|one| air_written(one, paths)))
            .put_if("class", class::all_written(&self.classes, paths))
            .put("library", written)
            .put("unknown", unknown_written(&self.unknown))
            .put_if("spatial", self.spatial.as_ref().map(spatial_written))
            .put_if("vision", (self.vision != vision).then(|| vision_written(&self.vision)))
            .put_if("category", categories_written(&self.categories))
            .put_if("segmentation", segmentation)
            .put_if("truth", self.truth.as_ref().map(|truth| truth_written(truth, paths)))
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
    let (counts, unit) = match &cube.unit {
        CubeUnit::CountsPerPhotonRadiance(counts) => (Some(*counts), None),
        CubeUnit::Camera => (None, None),
        CubeUnit::Radiance { written, .. } | CubeUnit::BrightnessTemperature { written, .. } => {
            (None, Some(written.as_str()))
        }
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
        .put_if("bad_bands", (!cube.bad_bands.is_empty()).then(|| whole(&cube.bad_bands)))
        .put_if("bad_pixels", cube.bad_pixels.as_ref().map(|path| paths.file(path)))
        .put_if(
            "bad",
            BAD.iter().find(|(_, one)| *one == cube.bad && cube.bad != Bad::default()).map(|(name, _)| *name),
        );
    let lights = environment.iter().map(|light| match light {
        LightSource::Spectrum { path, column } => {
            Entries::default().put("spectrum", paths.file(path)).put("column", column.clone())
        }
        LightSource::Surface { material, temperature_k } => Entries::default()
            .put_if("material", material.as_ref().map(|material| paths.material(material)))
            .put_quantity("temperature", Dimension::Temperature, Some(*temperature_k)),
        LightSource::Rows(rows) => Entries::default().put("rows", whole(rows)),
        LightSource::Found { like, rows } => Entries::default()
            .put_if("found", LIKE.iter().find(|(_, one)| one == like).map(|(name, _)| *name))
            .put_if("rows", rows.map(|rows| whole(&rows))),
    });
    Document::default()
        .put("cube", written)
        .put_if("bands", bands.map(|spec| spec.written(paths)))
        .put_if("camera", camera.map(|spec| camera::written(spec, paths)))
        .put("environment", lights.collect::<Vec<_>>())
}

/// `[atmosphere]`.
pub(crate) fn air_written(one: &AirOfCube, paths: Paths<'_>) -> Entries {
    one.air.written(paths).put_quantity("distance", Dimension::Length, Some(one.distance_m))
}

/// `[unknown]`.
pub(crate) fn unknown_written(unknown: &PixelUnknown) -> Entries {
    let shared = &unknown.shared;
    Entries::default()
        .put_range("temperature", Dimension::Temperature, Some(unknown.temperature_k))
        .put_if("lighting_total", unknown.lighting_total)
        .put("gain", shared.gain.map_or(Value::from(unknown.gain), Value::from))
        .put_quantity("wavelength_shift", Dimension::Wavenumber, shared.wavelength_shift_cm1)
        .put_if("sky_scale", shared.sky_scale)
        .put_if("sky_shape", shared.sky_shape)
        .put_if("sky_path", shared.sky_path)
        .put_quantity("light_temperature", Dimension::TemperatureDifference, shared.light_temperature_k)
        .put_if("missing_light", shared.missing_light)
        .put_quantity("air", Dimension::Length, shared.air_m)
        .put_if("noise_scale", shared.noise_scale)
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
