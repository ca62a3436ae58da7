//! The files of a scenario that a report wrote (`scenario.toml`, `rule.toml`, `decompose.toml`).
//!
//! Such a scenario names them from the folder of the one that the report was made from, which it is not in. The report's list of what it
//! read (`hadar.json`, `inputs`) has each by that name with its SHA-256: a file of that name and content is looked for beside the scenario,
//! in the folders above it and in those beside them, nearest first, so that a report near its inputs can be asked again where it is. Of the
//! list only the hashes are used: whoever forged one could but name another file of the same name there.

use hadar::error::{Error, Result};
use hadar_formats::hash::{nearest_folder, sha256_of_file};
use serde::Deserialize;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

const LIST: &str = "hadar.json";

/// The longest list that is read, bytes.
const LONGEST_LIST: u64 = 1 << 26;

/// What a report read and wrote.
#[derive(Debug, Deserialize)]
pub(super) struct ReportInputs {
    inputs: Vec<Noted>,
    files: Vec<Written>,
}

#[derive(Debug, Deserialize)]
struct Noted {
    path: String,
    sha256: Option<String>,
}

#[derive(Debug, Deserialize)]
struct Written {
    name: String,
}

impl ReportInputs {
    /// Those of the report that wrote the scenario at `path`, if one did.
    pub(super) fn beside(path: &Path) -> Option<Self> {
        let list = path.with_file_name(LIST);
        let found = list.symlink_metadata().ok().filter(std::fs::Metadata::is_file)?;
        if found.len() > LONGEST_LIST {
            return None;
        }
        let mut text = Vec::new();
        File::open(list).ok()?.take(LONGEST_LIST).read_to_end(&mut text).ok()?;
        let report: Self = serde_json::from_slice(&text).ok()?;
        report.wrote(path.file_name()?.to_str()?).then_some(report)
    }

    fn wrote(&self, name: &str) -> bool {
        self.files.iter().any(|file| file.name == name)
    }

    /// Where a file or a folder is that the scenario in `own` names; `inputs` is the folder to look in where one is given.
    ///
    /// # Errors
    /// What the report has read and is nowhere as it was.
    pub(super) fn located(&self, name: &str, own: &Path, inputs: Option<&Path>) -> Result<PathBuf> {
        // `./library.csv` of the report's own files.
        let of_report = name.strip_prefix("./").is_some_and(|name| self.wrote(name));
        if of_report {
            return Ok(own.join(name));
        }
        if let Some(inputs) = inputs {
            return Ok(inputs.join(name));
        }
        let bare = name.strip_prefix("./").unwrap_or(name);
        let within =
            |path: &str| path.strip_prefix(bare).is_some_and(|rest| rest.is_empty() || rest.starts_with('/'));
        let mut read: Vec<(&str, &Noted)> =
            self.inputs.iter().filter(|one| within(&one.path)).map(|one| (one.path.as_str(), one)).collect();
        // What is not in the folder of the scenario is listed by its name alone.
        if read.is_empty() && bare.contains("..") {
            let last = bare.rsplit('/').next();
            read.extend(
                self.inputs.iter().find(|one| Some(one.path.as_str()) == last).map(|one| (bare, one)),
            );
        }
        if read.is_empty() {
            return Ok(own.join(name));
        }
        let is_it = |folder: &Path| {
            read.iter().all(|(path, noted)| {
                let there = sha256_of_file(&folder.join(path)).ok().flatten();
                there.is_some() && there == noted.sha256
            })
        };
        let own = std::path::absolute(own.join(name)).ok();
        let folder = own.as_deref().and_then(Path::parent).and_then(|own| nearest_folder(own, is_it));
        folder.map(|folder| folder.join(bare)).ok_or_else(|| {
            let found = format!("`{bare}` as the report has read it is neither here nor in a folder near by");
            Error::malformed(
                found,
                "name the folder that it is in with --inputs, or put this file there without the report",
            )
        })
    }
}
