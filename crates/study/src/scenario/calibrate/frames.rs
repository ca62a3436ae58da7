//! Cubes as they were measured (`[cube]` of a calibration): one, or several frames of the same scene.

use super::super::entries::Entries;
use super::super::paths::{Paths, file};
use super::super::section::Entry;
use hadar::error::Result;
use std::path::{Path, PathBuf};
use toml::Value;

/// Cubes in files. Paths are absolute.
#[derive(Debug, Clone, PartialEq)]
pub struct Frames {
    /// Samples `[row][column][band]` of each.
    pub data: Vec<PathBuf>,
    /// Name of the variable in a .mat file.
    pub variable: Option<String>,
}

impl Frames {
    /// Whether a path names a cube and no scenario.
    #[must_use]
    pub fn is_bare(path: &Path) -> bool {
        let end = path.extension().and_then(|end| end.to_str()).map(str::to_ascii_lowercase);
        end.is_some_and(|end| ["npy", "mat"].contains(&end.as_str()))
    }

    /// Bare cubes.
    #[must_use]
    pub fn bare(paths: &[PathBuf]) -> Self {
        let absolute = |path: &PathBuf| std::path::absolute(path).unwrap_or_else(|_| path.clone());
        Self { data: paths.iter().map(absolute).collect(), variable: None }
    }

    /// `data`, one or a list, and `variable`.
    pub(in crate::scenario) fn read(entry: &Entry<'_>) -> Result<Self> {
        let section = entry.section(&["data", "variable"])?;
        let data = section.require("data", "\"counts.npy\"")?;
        Ok(Self {
            data: match data.is_list() {
                true => data
                    .items("data = [\"frame_1.npy\", \"frame_2.npy\"]")?
                    .iter()
                    .map(file)
                    .collect::<Result<_>>()?,
                false => vec![file(&data)?],
            },
            variable: section.read("variable", |entry| Ok(entry.text("\"S\"")?.trim().to_owned()))?,
        })
    }

    pub(in crate::scenario) fn written(&self, paths: Paths<'_>) -> Entries {
        let data = match self.data.as_slice() {
            [one] => Value::from(paths.file(one)),
            several => Value::from(several.iter().map(|path| paths.file(path)).collect::<Vec<_>>()),
        };
        Entries::default().put("data", data).put_if("variable", self.variable.clone())
    }
}
