//! Which noise is asked for (`hadar calibrate noise`): frames, and what is known of the camera (`[noise]`).

use super::super::entries::{Document, Entries, Part, entries, text};
use super::super::keys::files;
use super::super::kind::Kind;
use super::super::paths::Paths;
use super::super::read::document;
use super::super::section::{Entry, Section};
use super::super::source::Source;
use super::super::written::Written;
use super::frames::Frames;
use hadar::error::{Error, Result};
use hadar::units::Dimension;
use serde::{Serialize, Serializer};
use std::path::Path;

const MINIMUM: &str = "write [cube] with data = [\"frame_1.npy\", \"frame_2.npy\"], and [noise]";

/// Everything that the file says.
#[derive(Debug, Clone)]
pub struct NoiseScenario {
    /// What it is about, for headings.
    pub title: Option<String>,
    /// Frames of one scene, or one frame (`[cube]`).
    pub cube: Frames,
    /// What is known of the camera (`[noise]`).
    pub noise: NoiseSpec,
    /// Where it was read from.
    pub source: Source,
}

/// What is known of the camera (`[noise]`).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct NoiseSpec {
    /// Sample without light, in the unit of the cube.
    pub dark_level: f64,
    /// Whether gains of pixels differ by an unknown share.
    pub gain_spread: bool,
    /// Exposure of a frame, s.
    pub exposure_s: Option<f64>,
}

impl NoiseScenario {
    /// Bare cubes, with what holds where nothing is said.
    #[must_use]
    pub fn bare(paths: &[std::path::PathBuf]) -> Self {
        Self {
            title: None,
            cube: Frames::bare(paths),
            noise: NoiseSpec::default(),
            source: Source::default(),
        }
    }

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
    /// As [`NoiseScenario::from_file`], except those of the file itself.
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
        let root = Section::open(&document, "", &source, &files::NOISE)?;
        let missing = |key: &str| root.fail(key, Error::malformed("the table is missing", MINIMUM));
        let scenario = Self {
            title: root.read("title", |entry| Ok(entry.text("\"Noise of the camera\"")?.to_owned()))?,
            cube: root.read("cube", Frames::read)?.ok_or_else(|| missing("cube"))?,
            noise: root.read("noise", noise)?.unwrap_or_default(),
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
        document.push(("cube", Part::Table(self.cube.written(paths))));
        let noise = Entries::default()
            .put("dark_level", self.noise.dark_level)
            .put("gain_spread", self.noise.gain_spread)
            .put_quantity("exposure", Dimension::Time, self.noise.exposure_s);
        document.push(("noise", Part::Table(noise)));
        document
    }
}

fn noise(entry: &Entry<'_>) -> Result<NoiseSpec> {
    let section = entry.section()?;
    Ok(NoiseSpec {
        dark_level: section.number("dark_level")?.unwrap_or(0.0),
        gain_spread: section.read("gain_spread", Entry::boolean)?.unwrap_or(false),
        exposure_s: section.quantity("exposure")?,
    })
}

/// The same keys as the TOML, quantities in the units used inside, with absolute paths.
impl Serialize for NoiseScenario {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        entries(self.document(Paths { beside: None }), serializer)
    }
}
