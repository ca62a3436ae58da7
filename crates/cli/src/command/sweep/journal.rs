//! What is done of a sweep: a line of JSON a row, in the hidden folder `.sweep` of its report.
//!
//! A line is written when its row is done, so that a process that is killed loses no more than the rows in work; what it left of a
//! line is no JSON and is passed over. Every process writes into a file of its own shard, which it holds locked. A row is found
//! again by what it was asked, not by its number; it counts as done as long as every file that it read is as it was: with a row stands
//! the hash of the bytes that were read for it.
//!
//! Anybody may have written a line. Those of this run are told from others by what it wrote; a sample of the others is computed again
//! before they are believed ([`super`]). No link is followed, neither of the folder nor of a file in it.

use hadar::error::{Error, Result};
use hadar::inputs::Inputs;
use hadar::material::is_spectra;
use hadar_formats::hash;
use hadar_report::folder::Inside;
use hadar_report::json;
use hadar_report::manifest::{Input, sha256, sha256_of_file};
use hadar_study::sweep::{Cell, Record};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File, TryLockError};
use std::io::{BufRead as _, BufReader, ErrorKind, Read as _, Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

const FOLDER: &str = ".sweep";
const ENDING: &str = "jsonl";
/// The longest line that is read as one, bytes.
const LONGEST_LINE: u64 = 1 << 28;

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
    ) -> Result<Self> {
        let absolute = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        let files = hash::of_all_read(read)?.into_iter().map(|(path, hash)| (absolute(&path), Some(hash)));
        let folders = read.folders.iter().map(|path| (absolute(path), names_in(path)));
        let built_in = read.built_in.iter().map(|((kind, name), content)| Input {
            path: format!("built-in: {kind} {name}"),
            sha256: Some(sha256(content)),
        });
        let (error, record) = match outcome {
            Ok(record) => (None, record),
            Err(message) => (Some(message), Record::new()),
        };
        let values = record.iter().map(|(name, cell)| (name.clone(), cell.to_json())).collect();
        Ok(Self { key, files: files.chain(folders).collect(), built_in: built_in.collect(), error, values })
    }

    /// Whether every file that it read is as it was.
    pub(super) fn holds(&self, hashes: &Hashes) -> bool {
        self.files.iter().all(|(path, hash)| hash.is_some() && hashes.of(path) == *hash)
    }

    /// A file that it read and that is not as it was, or that nothing tells to be.
    pub(super) fn changed(&self, hashes: &Hashes) -> Option<PathBuf> {
        let is_same = |path: &Path, hash: &Option<String>| hash.is_some() && hashes.of(path) == *hash;
        self.files.iter().find(|(path, hash)| !is_same(path, hash)).map(|(path, _)| path.clone())
    }

    /// Files that were read, with their hashes.
    pub(super) fn files(&self) -> impl Iterator<Item = (&Path, &str)> {
        let read = self.files.iter().filter_map(|(path, hash)| Some((path.as_path(), hash.as_deref()?)));
        read.filter(|(path, _)| !path.is_dir())
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

/// SHA-256 of files as they are at a time, each read once.
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
    inside: Inside,
    file: Mutex<File>,
    /// Held by whoever writes the report.
    report: File,
    /// Hashes of the lines that this run has written, by what was asked.
    own: Mutex<BTreeMap<String, String>>,
}

/// Whose row it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum By {
    /// Of this run.
    Own,
    /// Of an earlier one, of another shard, or of whoever wrote into the folder.
    Another,
}

impl Journal {
    /// Opens that of a shard in the folder of a report.
    ///
    /// # Errors
    /// Another process that has it open; a folder that cannot be written to.
    pub(super) fn open(out: &Path, [shard, shards]: [usize; 2]) -> Result<Self> {
        let folder = out.join(FOLDER);
        let failed =
            |error: std::io::Error| Error::file("write the rows of the sweep", &folder, told(&error));
        fs::create_dir_all(out).map_err(failed)?;
        let inside = Inside::open(out).and_then(|out| out.folder(FOLDER)).map_err(failed)?;
        let mut file = inside.appended(&format!("{shard}-of-{shards}.{ENDING}")).map_err(failed)?;
        match file.try_lock() {
            Err(TryLockError::WouldBlock) => {
                let reason =
                    "another process works on the same rows; wait for it, or share them out with --shard";
                return Err(Error::file("write the rows of the sweep", out, reason));
            }
            // Some file systems have no locks; two processes on one shard then do the same work twice.
            Ok(()) | Err(TryLockError::Error(_)) => {}
        }
        let report = inside.appended("report.lock").map_err(failed)?;
        // After what a process that was killed left of a line, the next one begins on a line of its own.
        let mut last = [b'\n'];
        if file.seek(SeekFrom::End(-1)).is_ok() {
            file.read_exact(&mut last).map_err(failed)?;
        }
        if last != [b'\n'] {
            file.write_all(b"\n").map_err(failed)?;
        }
        Ok(Self { folder, inside, file: Mutex::new(file), report, own: Mutex::default() })
    }

    /// Writes a row.
    ///
    /// # Errors
    /// A disk that is full.
    pub(super) fn write(&self, entry: &Entry) -> Result<()> {
        let line = format!("{}\n", json::value(entry)?);
        let failed = |reason: String| Error::file("write the rows of the sweep", &self.folder, reason);
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        file.write_all(line.as_bytes()).map_err(|error| failed(error.to_string()))?;
        let hash = sha256(line.trim_end().as_bytes());
        self.own.lock().unwrap_or_else(PoisonError::into_inner).insert(entry.key.clone(), hash);
        Ok(())
    }

    /// Hands on every row that any shard has written, in no order of meaning; of what this run computed its own rows alone.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub(super) fn read(&self, each: &mut dyn FnMut(Entry, By)) -> Result<()> {
        let failed =
            |error: std::io::Error| Error::file("read the rows of the sweep", &self.folder, told(&error));
        let mut names: Vec<String> = fs::read_dir(&self.folder)
            .map_err(failed)?
            .filter_map(|found| found.ok()?.file_name().into_string().ok())
            .filter(|name| Path::new(name).extension().is_some_and(|ending| ending == ENDING))
            .collect();
        names.sort();
        let own = self.own.lock().unwrap_or_else(PoisonError::into_inner);
        for name in names {
            let mut lines = BufReader::new(self.inside.file(&name).map_err(failed)?);
            let mut line = Vec::new();
            while (&mut lines).take(LONGEST_LINE).read_until(b'\n', &mut line).map_err(failed)? > 0 {
                if let Ok(entry) = serde_json::from_slice::<Entry>(&line) {
                    match own.get(&entry.key).map(|hash| *hash == sha256(line.trim_ascii_end())) {
                        None => each(entry, By::Another),
                        Some(true) => each(entry, By::Own),
                        Some(false) => {}
                    }
                }
                line.clear();
            }
        }
        Ok(())
    }

    /// Waits for others that write the report of the same rows; they wait until this is dropped.
    pub(super) fn lock_report(&self) {
        // Some file systems have no locks.
        let _ = self.report.lock();
    }
}

/// Why a file of the folder cannot be had.
fn told(error: &std::io::Error) -> String {
    match error.kind() {
        ErrorKind::NotADirectory | ErrorKind::InvalidInput => {
            "it, or a file in it, is a link or no ordinary file, which is not followed; remove it".to_owned()
        }
        _ => error.to_string(),
    }
}
