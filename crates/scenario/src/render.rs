//! A scenario to be rendered: a scene, bands, a camera; two views where there is a pair of cameras (`[stereo]`).
//!
//! It is a ranging scenario whose pair of cameras may be left out; one file serves both.

use super::decompose::CategorySpec;
use super::decompose::category::{Told, categories, categories_written};
use super::entries::Document;
use super::keys::files;
use super::kind::Kind;
use super::paths::Paths;
use super::range::{Stereo, read::stereo_of_scene, write::stereo};
use super::reader::file;
use super::scene::{SceneSpec, scene_document, scene_of};
use super::section::Section;
use super::{BandsSpec, CameraSpec, Source, camera};
use hadar::error::Result;

const MINIMUM: &str =
    "write [scene], [camera] with preset = \"flir-a325sc\", and an [[object]] for all that stands there";

/// Everything that is said of a picture.
///
/// ```
/// use hadar_scenario::RenderScenario;
/// let text = r#"
///     [scene]
///     sky_temperature = "-15 degC"
///     [[object]]
///     shape = "person"
///     material = "skin"
///     temperature = "33 degC"
///     at = ["-0.9 m", "8 m"]
///     [camera]
///     preset = "flir-a325sc"
/// "#;
/// let scenario = RenderScenario::from_toml(text, None)?;
/// assert_eq!(scenario.scene.objects.as_ref().map(Vec::len), Some(1));
/// let error = RenderScenario::from_toml(&text.replace("-0.9 m", "left"), None).unwrap_err();
/// assert!(error.to_string().starts_with("line 8: object[0].at[0]: "), "{error}");
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct RenderScenario {
    /// What it is about, for headings.
    pub title: Option<String>,
    /// The scene that is to be rendered.
    pub scene: SceneSpec,
    /// The spectral bands in which it is rendered.
    pub bands: BandsSpec,
    /// The camera that records the scene.
    pub camera: CameraSpec,
    /// The pair of cameras; one view where nothing is stated.
    pub stereo: Option<Stereo>,
    /// What its materials are parts of, for the decomposition.
    pub categories: Vec<CategorySpec>,
    /// Where it was read from.
    pub source: Source,
}

file!(RenderScenario, source, (Kind::Range, MINIMUM, &files::RENDER));

impl RenderScenario {
    fn of_root(root: &Section<'_>) -> Result<Self> {
        let entry = root.table("scene", MINIMUM)?;
        Ok(Self {
            title: root.title("\"A street at night\"")?,
            scene: scene_of(root, &entry)?,
            bands: root.read("bands", BandsSpec::read)?.unwrap_or_default(),
            camera: camera::read(&root.table("camera", MINIMUM)?)?,
            stereo: root.read("stereo", stereo_of_scene)?,
            categories: root
                .read("category", |entry| categories(entry, Told::BySurfaces))?
                .unwrap_or_default(),
            source: Source::default(),
        })
    }

    fn document(&self, paths: Paths<'_>) -> Document {
        Document::titled(self.title.as_ref())
            .and(scene_document(&self.scene, paths))
            .put("bands", self.bands.written(paths))
            .put("camera", camera::written(&self.camera, paths))
            .put_if("stereo", self.stereo.as_ref().map(stereo))
            .put_if("category", categories_written(&self.categories))
    }
}
