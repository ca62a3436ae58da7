//! Where a scenario was read from: its file, the directory of its relative paths, the line of each key.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::Scenario;
use crate::error::Place;

/// Where a scenario was read from.
#[derive(Debug, Clone, Default)]
pub struct Source {
    /// The scenario file as it was named, `None` for text from elsewhere.
    pub path: Option<PathBuf>,
    /// Line of each key that was written, e.g. `target.material` or `environment[0].lighting`.
    pub lines: BTreeMap<String, usize>,
}

impl Source {
    /// The directory that relative paths of the scenario start from; empty for the current one.
    #[must_use]
    pub fn directory(&self) -> &Path {
        self.path.as_deref().and_then(Path::parent).unwrap_or(Path::new(""))
    }
}

impl Scenario {
    /// Where `key` stands (`target.material`, `environment[0].material`, `alternatives.materials[1]`), to be
    /// put on an error with [`crate::Error::at`]. A key that was not written has the line of its table.
    #[must_use]
    pub fn place(&self, key: &str) -> Place {
        let mut known = key;
        let line = loop {
            match self.source.lines.get(known) {
                Some(line) => break Some(*line),
                None => match known.rfind(['.', '[']) {
                    Some(end) => known = known.get(..end).unwrap_or_default(),
                    None => break None,
                },
            }
        };
        Place { path: self.source.path.clone(), line, key: Some(key.to_owned()) }
    }
}
