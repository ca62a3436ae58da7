//! A spectrometer before blackbodies (`hadar calibrate blackbody`): its channels, the blackbodies, the noise, a cube to be calibrated.

use super::super::entries::{Document, Entries, Part, entries, text};
use super::super::keys::files;
use super::super::kind::Kind;
use super::super::paths::Paths;
use super::super::read::document;
use super::super::section::Section;
use super::super::written::Written;
use super::super::{BandsSpec, Source};
use super::blackbodies::{BlackbodySpec, CubeFile, blackbodies, noise};
use hadar::error::{Error, Result};
use serde::{Serialize, Serializer};
use std::path::Path;

const MINIMUM: &str = "write [bands], [[blackbody]] twice with temperature = \"10 degC\" and data = \"cold.npy\", and [noise] with sample = 1.5";

/// Everything that the file says.
#[derive(Debug, Clone)]
pub struct BlackbodyScenario {
    /// What it is about, for headings.
    pub title: Option<String>,
    /// The channels, bands of one wavenumber each.
    pub bands: BandsSpec,
    /// The blackbodies (`[[blackbody]]`).
    pub blackbodies: Vec<BlackbodySpec>,
    /// Deviation of one sample, in the unit of the cubes (`[noise] sample`).
    pub noise: f64,
    /// The cube to be calibrated (`[scene]`).
    pub scene: Option<SpectralScene>,
    /// Where it was read from.
    pub source: Source,
}

/// A cube to be calibrated (`[scene]`).
#[derive(Debug, Clone, PartialEq)]
pub struct SpectralScene {
    /// The cube.
    pub data: CubeFile,
    /// Whether each pixel has a response and an offset of its own, which cubes of blackbodies of the same size tell.
    pub each_pixel: bool,
}

const RESPONSES: [(&str, bool); 2] = [("common", false), ("each-pixel", true)];

impl BlackbodyScenario {
    /// Reads the file. Relative paths in it start from its directory.
    ///
    /// # Errors
    /// The first thing that is wrong, in one line with file, line and key.
    pub fn from_file(path: &Path) -> Result<Self> {
        Self::from_written(&Written::from_file(path)?)
    }

    /// Reads it from text; `path` as in [`crate::Scenario::from_toml`].
    ///
    /// # Errors
    /// As [`BlackbodyScenario::from_file`], except those of the file itself.
    ///
    /// ```
    /// use hadar_scenario::calibrate::BlackbodyScenario;
    /// let text = r#"
    ///     [bands]
    ///     start = "700 cm^-1"
    ///     stop = "1400 cm^-1"
    ///     step = "10 cm^-1"
    ///     [[blackbody]]
    ///     temperature = "10 degC"
    ///     data = "cold.npy"
    ///     [[blackbody]]
    ///     temperature = "60 degC"
    ///     data = "warm.npy"
    ///     [noise]
    ///     sample = 1.5
    /// "#;
    /// assert_eq!(BlackbodyScenario::from_toml(text, None)?.blackbodies.len(), 2);
    /// let error = BlackbodyScenario::from_toml(&text.replace("60", "10"), None).unwrap_err().to_string();
    /// assert!(error.contains("blackbody[0] and blackbody[1] are both at 283.15 K"), "{error}");
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
        let document = document(written, (Kind::Calibrate, MINIMUM), &mut source)?;
        let root = Section::open(&document, "", &source, &files::BLACKBODY)?;
        let missing = |key: &str| root.fail(key, Error::malformed("the table is missing", MINIMUM));
        let scenario = Self {
            title: root.read("title", |entry| Ok(entry.text("\"FTIR of today\"")?.to_owned()))?,
            bands: root.read("bands", BandsSpec::read)?.ok_or_else(|| missing("bands"))?,
            blackbodies: blackbodies(&root)?,
            noise: noise(&root)?,
            scene: root.read("scene", |entry| {
                let section = entry.section()?;
                Ok(SpectralScene {
                    data: CubeFile::read(&section)?,
                    each_pixel: section.choice("response", &RESPONSES)?.unwrap_or(false),
                })
            })?,
            source: Source::default(),
        };
        Ok(Self { source, ..scenario })
    }

    /// The file again, with paths below `directory` written relative to it.
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
        document.push(("bands", Part::Table(self.bands.written(paths))));
        document.push((
            "blackbody",
            Part::Tables(self.blackbodies.iter().map(|spec| spec.written(paths)).collect()),
        ));
        document.push(("noise", Part::Table(Entries::default().put("sample", self.noise))));
        if let Some(scene) = &self.scene {
            let response = RESPONSES[usize::from(scene.each_pixel)].0;
            document.push(("scene", Part::Table(scene.data.written(paths).put("response", response))));
        }
        document
    }
}

/// The same keys as the TOML, quantities in the units used inside, with absolute paths.
impl Serialize for BlackbodyScenario {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        entries(self.document(Paths { beside: None }), serializer)
    }
}
