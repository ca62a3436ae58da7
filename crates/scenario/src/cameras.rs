//! A file of cameras of one's own: `[[camera]]` tables with a `name` and the keys of `[camera]` of a scenario.
//!
//! `description`, `document` and `provenance = ["…"]` say where its figures are from; `preset` lays it over a known camera. What is left
//! out is asked for where nothing can stand for it, as of a camera of the program.

use super::camera::read;
use super::keys::files;
use super::kind::Kind;
use super::read::document;
use super::section::{Entry, Section};
use super::stated_camera::StatedCamera;
use super::{Source, Written};
use hadar::error::{Place, Result};

const MINIMUM: &str = "write [[camera]] with name = \"ours\" and the keys of [camera] of a scenario";

/// The cameras of a file.
#[derive(Debug, Clone)]
pub struct StatedCameras {
    /// In the order of the file.
    pub cameras: Vec<StatedCamera>,
    /// Where they are from.
    pub source: Source,
}

impl StatedCameras {
    /// Reads a file of cameras.
    ///
    /// # Errors
    /// The first thing that is wrong, with file, line and key.
    pub fn from_written(written: &Written) -> Result<Self> {
        let mut source = written.source();
        let document = document(written, (Kind::Cameras, MINIMUM), &mut source)?;
        let root = Section::open(&document, "", &source, &files::CAMERAS)?;
        let items = root.require("camera")?.items("each camera as [[camera]], in double brackets")?;
        let cameras = items.iter().map(camera).collect::<Result<_>>()?;
        Ok(Self { cameras, source })
    }

    /// Where a key of a camera stands.
    #[must_use]
    pub fn place(&self, index: usize, key: &str) -> Place {
        self.source.place(&format!("camera[{index}].{key}"))
    }
}

fn camera(item: &Entry<'_>) -> Result<StatedCamera> {
    let spec = read(item)?;
    let section = item.table()?;
    let text = |entry: &Entry<'_>| Ok(entry.text("\"…\"")?.trim().to_owned());
    let provenance = section.read("provenance", |entry| {
        entry.items("provenance = [\"data sheet of 2024\"]")?.iter().map(text).collect::<Result<Vec<_>>>()
    })?;
    Ok(StatedCamera {
        name: section.require("name")?.text("\"ours\"")?.trim().to_owned(),
        description: section.read("description", text)?.unwrap_or_default(),
        document: section.read("document", text)?,
        provenance: provenance.unwrap_or_default(),
        spec,
    })
}
