//! A scenario to be rendered: a scene, bands, a camera; two views where there is a pair of cameras (`[stereo]`).
//!
//! It is a ranging scenario whose pair of cameras may be left out; one file serves both.

use super::decompose::CategorySpec;
use super::decompose::category::{Told, categories, category_written};
use super::entries::{Document, Part, entries, text};
use super::keys::files;
use super::kind::Kind;
use super::paths::Paths;
use super::range::{Stereo, read::stereo_of_scene, write::stereo};
use super::read::document;
use super::scene::{SceneSpec, objects_written, scene_of, scene_written};
use super::section::Section;
use super::written::Written;
use super::{BandsSpec, CameraSpec, Source, camera};
use hadar::error::{Error, Place, Result};
use serde::{Serialize, Serializer};
use std::path::Path;

const MINIMUM: &str =
    "write [scene], [camera] with preset = \"flir-a325sc\", and an [[object]] for all that stands there";

/// Everything that is said of a picture.
#[derive(Debug, Clone)]
pub struct RenderScenario {
    /// What it is about, for headings.
    pub title: Option<String>,
    /// What is there.
    pub scene: SceneSpec,
    /// The spectral bands.
    pub bands: BandsSpec,
    /// The camera.
    pub camera: CameraSpec,
    /// The pair of cameras; one view if silent.
    pub stereo: Option<Stereo>,
    /// What its materials are parts of, for the decomposition.
    pub categories: Vec<CategorySpec>,
    /// Where it was read from.
    pub source: Source,
}

impl RenderScenario {
    /// Reads a scenario to be rendered. Relative paths in it start from its directory.
    ///
    /// # Errors
    /// The first thing that is wrong, in one line with file, line and key, as [`crate::Scenario::from_file`].
    pub fn from_file(path: &Path) -> Result<Self> {
        Self::from_written(&Written::from_file(path)?)
    }

    /// Reads it from text; `path` as in [`crate::Scenario::from_toml`].
    ///
    /// # Errors
    /// As [`RenderScenario::from_file`], except those of the file itself.
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
    pub fn from_toml(text: &str, path: Option<&Path>) -> Result<Self> {
        Self::from_written(&Written::of(text, path))
    }

    /// Reads it with values in the place of its own.
    ///
    /// # Errors
    /// As [`Self::from_toml`].
    pub fn from_written(written: &Written) -> Result<Self> {
        let mut source = written.source();
        let document = document(written, (Kind::Range, MINIMUM), &mut source)?;
        let root = Section::open(&document, "", &source, &files::RENDER)?;
        let missing = |key: &str| root.fail(key, Error::malformed("the table is missing", MINIMUM));
        let entry = root.get("scene").ok_or_else(|| missing("scene"))?;
        let scenario = Self {
            title: root.read("title", |entry| Ok(entry.text("\"A street at night\"")?.to_owned()))?,
            scene: scene_of(&root, &entry)?,
            bands: root.read("bands", BandsSpec::read)?.unwrap_or_default(),
            camera: root.read("camera", camera::read)?.ok_or_else(|| missing("camera"))?,
            stereo: root.read("stereo", stereo_of_scene)?,
            categories: root
                .read("category", |entry| categories(entry, Told::BySurfaces))?
                .unwrap_or_default(),
            source: Source::default(),
        };
        Ok(Self { source, ..scenario })
    }

    /// Where a key stands, as [`super::Scenario::place`].
    #[must_use]
    pub fn place(&self, key: &str) -> Place {
        self.source.place(key)
    }

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
        document.push(("scene", Part::Table(scene_written(&self.scene, paths))));
        if let Some(objects) = &self.scene.objects {
            document.push(("object", Part::Tables(objects_written(objects, paths))));
        }
        document.push(("bands", Part::Table(self.bands.written(paths))));
        document.push(("camera", Part::Table(camera::written(&self.camera, paths))));
        if let Some(pair) = &self.stereo {
            document.push(("stereo", Part::Table(stereo(pair))));
        }
        if !self.categories.is_empty() {
            document.push(("category", Part::Tables(self.categories.iter().map(category_written).collect())));
        }
        document
    }
}

/// The same keys as the TOML, quantities in the units used inside, with absolute paths.
impl Serialize for RenderScenario {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        entries(self.document(Paths { beside: None }), serializer)
    }
}
