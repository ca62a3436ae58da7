//! What is done of a sweep: a line of JSON a row, in the hidden folder `.sweep` of its report.
//!
//! A line is written when its row is done, so that a process that is killed loses no more than the rows in work; what it left of a
//! line is no JSON and is passed over. Every process writes into a file of its own shard, which it holds locked. A row is found
//! again by what it was asked, not by its number; it counts as done as long as every file that it read is as it was.

use hadar::error::{Error, Result};
use hadar::inputs::Inputs;
use hadar::material::is_spectra;
use hadar_report::json;
use hadar_report::manifest::{Input, sha256, sha256_of_file};
use hadar_study::sweep::{Cell, Record};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{BufRead as _, BufReader, Read as _, Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

const FOLDER: &str = ".sweep";
const ENDING: &str = "jsonl";

/// A row that was asked.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Entry {
    /// What was asked of whom.
    pub(super) key: String,
    /// Files that were read, with their SHA-256, and folders in which files were looked for, with that of the names in them.
    files: Vec<(PathBuf, Option<String>)>,
    /// What is built in and was used.
    pub(super) built_in: Vec<Input>,
    /// Why it failed.
    pub(super) error: Option<String>,
    /// What was answered.
    values: serde_json::Map<String, serde_json::Value>,
}

impl Entry {
    pub(super) fn new(
        key: String,
        read: &Inputs,
        outcome: std::result::Result<Record, String>,
        hashes: &Hashes,
    ) -> Self {
        let files = read.files.iter().chain(&read.folders).map(|path| {
            let path = std::path::absolute(path).unwrap_or_else(|_| path.clone());
            let hash = hashes.of(&path);
            (path, hash)
        });
        let built_in = read.built_in.iter().map(|((kind, name), content)| Input {
            path: format!("built-in: {kind} {name}"),
            sha256: Some(sha256(content)),
        });
        let (error, record) = match outcome {
            Ok(record) => (None, record),
            Err(message) => (Some(message), Record::new()),
        };
        let values = record.iter().map(|(name, cell)| (name.clone(), cell.to_json())).collect();
        Self { key, files: files.collect(), built_in: built_in.collect(), error, values }
    }

    /// Whether every file that it read is as it was.
    pub(super) fn holds(&self, hashes: &Hashes) -> bool {
        self.files.iter().all(|(path, hash)| hash.is_some() && hashes.of(path) == *hash)
    }

    /// Files that were read.
    pub(super) fn files(&self) -> impl Iterator<Item = &Path> {
        self.files.iter().map(|(path, _)| path.as_path()).filter(|path| !path.is_dir())
    }

    /// What it says.
    pub(super) fn outcome(self) -> std::result::Result<Record, String> {
        match self.error {
            Some(message) => Err(message),
            None => {
                let cell = |(name, value)| Some((name, Cell::of_json(&value)?));
                Ok(self.values.into_iter().filter_map(cell).collect())
            }
        }
    }
}

/// SHA-256 of files, each read once.
#[derive(Debug, Default)]
pub(super) struct Hashes(Mutex<BTreeMap<PathBuf, Option<String>>>);

impl Hashes {
    /// That of a file, or of the names in a folder; none where it cannot be read, or only once.
    pub(super) fn of(&self, path: &Path) -> Option<String> {
        let Ok(mut known) = self.0.lock() else { return None };
        if let Some(hash) = known.get(path) {
            return hash.clone();
        }
        let hash = if path.is_dir() { names_in(path) } else { sha256_of_file(path).ok().flatten() };
        known.insert(path.to_owned(), hash.clone());
        hash
    }
}

/// The hash of the names of the files in a folder that are called as spectra are.
fn names_in(folder: &Path) -> Option<String> {
    let entries = fs::read_dir(folder).ok()?;
    let names: BTreeSet<_> = entries.map(|entry| Some(entry.ok()?.file_name())).collect::<Option<_>>()?;
    let names: Vec<_> =
        names.iter().map(|name| name.to_string_lossy()).filter(|name| is_spectra(name)).collect();
    Some(sha256(names.join("\0").as_bytes()))
}

/// What is done, and where more is written.
#[derive(Debug)]
pub(super) struct Journal {
    folder: PathBuf,
    file: Mutex<File>,
}

impl Journal {
    /// Opens that of a shard in the folder of a report.
    ///
    /// # Errors
    /// Another process that has it open; a folder that cannot be written to.
    pub(super) fn open(out: &Path, [shard, shards]: [usize; 2]) -> Result<Self> {
        let folder = out.join(FOLDER);
        let failed = |error: std::io::Error| Error::file("write the rows of the sweep", &folder, error);
        fs::create_dir_all(&folder).map_err(failed)?;
        let path = folder.join(format!("{shard}-of-{shards}.{ENDING}"));
        let mut file = OpenOptions::new().create(true).read(true).append(true).open(&path).map_err(failed)?;
        match file.try_lock() {
            Err(TryLockError::WouldBlock) => {
                let reason =
                    "another process works on the same rows; wait for it, or share them out with --shard";
                return Err(Error::file("write the rows of the sweep", out, reason));
            }
            // Some file systems have no locks; two processes on one shard then do the same work twice.
            Ok(()) | Err(TryLockError::Error(_)) => {}
        }
        // After what a process that was killed left of a line, the next one begins on a line of its own.
        let mut last = [b'\n'];
        if file.seek(SeekFrom::End(-1)).is_ok() {
            file.read_exact(&mut last).map_err(failed)?;
        }
        if last != [b'\n'] {
            file.write_all(b"\n").map_err(failed)?;
        }
        Ok(Self { folder, file: Mutex::new(file) })
    }

    /// Writes a row.
    ///
    /// # Errors
    /// A disk that is full.
    pub(super) fn write(&self, entry: &Entry) -> Result<()> {
        let line = format!("{}\n", json::value(entry)?);
        let failed = |reason: String| Error::file("write the rows of the sweep", &self.folder, reason);
        let mut file = self.file.lock().map_err(|error| failed(error.to_string()))?;
        file.write_all(line.as_bytes()).map_err(|error| failed(error.to_string()))
    }

    /// Hands on every row that any shard has written, in no order of meaning.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub(super) fn read(&self, each: &mut dyn FnMut(Entry)) -> Result<()> {
        let failed = |error: std::io::Error| Error::file("read the rows of the sweep", &self.folder, error);
        let mut paths: Vec<PathBuf> = fs::read_dir(&self.folder)
            .map_err(failed)?
            .filter_map(|found| Some(found.ok()?.path()))
            .filter(|path| path.extension().is_some_and(|ending| ending == ENDING))
            .collect();
        paths.sort();
        for path in paths {
            let mut lines = BufReader::new(File::open(path).map_err(failed)?);
            let mut line = Vec::new();
            while lines.read_until(b'\n', &mut line).map_err(failed)? > 0 {
                if let Ok(entry) = serde_json::from_slice(&line) {
                    each(entry);
                }
                line.clear();
            }
        }
        Ok(())
    }

    /// Waits for others that write the report of the same rows; they wait as long as the lock is held.
    pub(super) fn lock_report(&self) -> Result<File> {
        let failed = |error: std::io::Error| Error::file("write the report", &self.folder, error);
        let file = OpenOptions::new()
            .create(true)
            .append(true)
            .open(self.folder.join("report.lock"))
            .map_err(failed)?;
        drop(file.lock());
        Ok(file)
    }
}
