//! A file of cameras of one's own: `[[camera]]` tables with a `name` and the keys of `[camera]` of a scenario.
//!
//! `description`, `document` and `provenance = ["…"]` say where its figures are from; `preset` lays it over a known camera. What is left
//! out is asked for where nothing can stand for it, as of a camera of the program.

use super::camera::read;
use super::find::price;
use super::keys::files;
use super::kind::Kind;
use super::reader::open;
use super::section::Entry;
use super::stated_camera::StatedCamera;
use super::{Source, Written};
use hadar::error::{Place, Result};
use hadar::instrument::presets::Cooling;

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
        let (cameras, source) = open(written, (Kind::Cameras, MINIMUM, &files::CAMERAS), |root| {
            let items = root.require("camera")?.items("each camera as [[camera]], in double brackets")?;
            items.iter().map(camera).collect()
        })?;
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
    let text = |entry: &Entry<'_>| entry.name("\"…\"");
    let provenance = section.read("provenance", |entry| {
        entry.items("provenance = [\"data sheet of 2024\"]")?.iter().map(text).collect::<Result<Vec<_>>>()
    })?;
    Ok(StatedCamera {
        name: section.require("name")?.name("\"ours\"")?,
        description: section.read("description", text)?.unwrap_or_default(),
        document: section.read("document", text)?,
        provenance: provenance.unwrap_or_default(),
        kind: section.choice("kind", &Cooling::ALL.map(|kind| (kind.name(), kind)))?,
        price: price(&section)?,
        spec,
    })
}
