//! Cubes as they were measured (`[cube]` of a calibration): one, or several frames of the same scene.

use super::super::decompose::read::bad_bands;
use super::super::entries::Entries;
use super::super::paths::{Paths, axes, file, variable};
use super::super::section::Entry;
use crate::Source;
use hadar::error::Result;
use hadar_formats::cube::Axes;
use hadar_formats::cube::is_called_so as is_cube;
use std::path::{Path, PathBuf};
use toml::Value;

/// Cubes in files. Paths are absolute.
#[derive(Debug, Clone, PartialEq)]
pub struct Frames {
    /// Samples `[row][column][band]` of each.
    pub data: Vec<PathBuf>,
    /// Name of the array in files of several.
    pub variable: Option<String>,
    /// Which of their dimensions is which.
    pub axes: Option<Axes>,
    /// Bands that are left out, counted from 0 in the order of the file.
    pub bad_bands: Vec<usize>,
}

impl Frames {
    /// Whether a path names a cube and no scenario.
    #[must_use]
    pub fn is_bare(path: &Path) -> bool {
        is_cube(path)
    }

    /// Bare cubes.
    #[must_use]
    pub fn bare(paths: &[PathBuf]) -> Self {
        let absolute = |path: &PathBuf| std::path::absolute(path).unwrap_or_else(|_| path.clone());
        Self { data: paths.iter().map(absolute).collect(), variable: None, axes: None, bad_bands: Vec::new() }
    }

    /// Where frames that no file names are named from: the folder of the first of them.
    pub(crate) fn home(&self) -> Source {
        let folder = self.data.first().and_then(|path| path.parent());
        Source { inputs: folder.map(std::path::Path::to_owned), ..Source::default() }
    }

    /// `data`, one or a list, and `variable`.
    pub(crate) fn read(entry: &Entry<'_>) -> Result<Self> {
        let section = entry.section()?;
        let data = section.require("data")?;
        Ok(Self {
            data: match data.is_list() {
                true => data
                    .items("data = [\"frame_1.npy\", \"frame_2.npy\"]")?
                    .iter()
                    .map(file)
                    .collect::<Result<_>>()?,
                false => vec![file(&data)?],
            },
            variable: variable(&section)?,
            axes: axes(&section)?,
            bad_bands: bad_bands(&section)?,
        })
    }

    pub(crate) fn written(&self, paths: Paths<'_>) -> Entries {
        let data = match self.data.as_slice() {
            [one] => Value::from(paths.file(one)),
            several => Value::from(several.iter().map(|path| paths.file(path)).collect::<Vec<_>>()),
        };
        let written = |bands: &[usize]| bands.iter().map(|band| *band as i64).collect::<Vec<_>>();
        Entries::default()
            .put("data", data)
            .put_if("variable", self.variable.clone())
            .put_if("axes", self.axes.map(|axes| axes.to_string()))
            .put_if("bad_bands", (!self.bad_bands.is_empty()).then(|| written(&self.bad_bands)))
    }
}
