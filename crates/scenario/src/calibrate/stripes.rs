//! Which stripes are to be taken out of a cube (`hadar calibrate stripes`): the cube, and how they lie (`[stripes]`).

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
use hadar_estimate::calibrate::{Axis, Sought};
use serde::{Serialize, Serializer};
use std::path::Path;

const MINIMUM: &str = "write [cube] with data = \"counts.npy\", and [stripes] with axis = \"rows\"";

/// Where nothing is said: rows, gains that differ by some percent.
const SOUGHT: Sought = Sought { axis: Axis::Rows, gain_deviation: 0.1, in_all_bands: false };

/// Everything that the file says.
#[derive(Debug, Clone)]
pub struct StripesScenario {
    /// What it is about, for headings.
    pub title: Option<String>,
    /// The cube (`[cube]`).
    pub cube: Frames,
    /// How stripes lie (`[stripes]`).
    pub stripes: Sought,
    /// Where it was read from.
    pub source: Source,
}

impl StripesScenario {
    /// A bare cube, with what holds where nothing is said.
    #[must_use]
    pub fn bare(path: &Path) -> Self {
        let cube = Frames::bare(&[path.to_owned()]);
        Self { title: None, cube, stripes: SOUGHT, source: Source::default() }
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
    /// As [`StripesScenario::from_file`], except those of the file itself.
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
        let root = Section::open(&document, "", &source, &files::STRIPES)?;
        let missing = |key: &str| root.fail(key, Error::malformed("the table is missing", MINIMUM));
        let scenario = Self {
            title: root.read("title", |entry| Ok(entry.text("\"A striped cube\"")?.to_owned()))?,
            cube: root.read("cube", Frames::read)?.ok_or_else(|| missing("cube"))?,
            stripes: root.read("stripes", stripes)?.unwrap_or(SOUGHT),
            source: Source::default(),
        };
        if scenario.cube.data.len() != 1 {
            let found = format!("{} cubes", scenario.cube.data.len());
            return Err(root.fail("cube.data", Error::malformed(found, "write one: data = \"counts.npy\"")));
        }
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
        let stripes = Entries::default()
            .put("axis", self.stripes.axis.name())
            .put("gain_deviation", self.stripes.gain_deviation)
            .put("in_all_bands", self.stripes.in_all_bands);
        document.push(("stripes", Part::Table(stripes)));
        document
    }
}

fn stripes(entry: &Entry<'_>) -> Result<Sought> {
    let section = entry.section()?;
    let axes = [Axis::Rows, Axis::Columns].map(|axis| (axis.name(), axis));
    Ok(Sought {
        axis: section.choice("axis", &axes)?.unwrap_or(SOUGHT.axis),
        gain_deviation: section.number("gain_deviation")?.unwrap_or(SOUGHT.gain_deviation),
        in_all_bands: section.read("in_all_bands", Entry::boolean)?.unwrap_or(SOUGHT.in_all_bands),
    })
}

/// The same keys as the TOML, quantities in the units used inside, with absolute paths.
impl Serialize for StripesScenario {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        entries(self.document(Paths { beside: None }), serializer)
    }
}
