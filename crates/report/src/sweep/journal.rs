//! What is done of a sweep: a line of JSON a row, in the hidden folder `.sweep` of its report.
//!
//! A line is written when its row is done, so that a process that is killed loses no more than the rows in work; what it left of a
//! line is no JSON and is passed over. What many rows rest on ([`Basis`]) has a line of its own before the first of them. Every process
//! writes into a file of its own shard, which it holds locked. A row is found again by what it was asked ([`Keys`]), not by
//! its number; it counts as done as long as every file that it read is as it was.
//!
//! Anybody may have written a line. Rows of this run are not read from here; a sample of the others is computed again before they are
//! believed. No link is followed, neither of the folder nor of a file in it.

use super::basis::{Basis, Hashes};
use super::keys::Keys;
use crate::folder::Inside;
use crate::json;
use crate::manifest::sha256;
use hadar::error::{Error, Result};
use hadar_study::sweep::{Cell, Record};
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::fs::{self, File, TryLockError};
use std::io::{BufRead as _, BufReader, ErrorKind, Read as _, Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

const FOLDER: &str = ".sweep";
const ENDING: &str = "jsonl";
/// The longest line that is read as one, bytes.
const LONGEST_LINE: u64 = 1 << 28;

/// A line of the journal: a row, or what rows rest on.
#[derive(Debug, Default, Serialize, Deserialize)]
struct Line {
    /// What a basis is called.
    #[serde(skip_serializing_if = "Option::is_none")]
    id: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    basis: Option<Basis>,
    /// What was asked of whom.
    #[serde(skip_serializing_if = "Option::is_none")]
    key: Option<String>,
    /// The basis of the row.
    #[serde(skip_serializing_if = "Option::is_none")]
    on: Option<String>,
    /// The error message of a row that failed.
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<String>,
    /// Values that were answered, by column.
    #[serde(default, skip_serializing_if = "serde_json::Map::is_empty")]
    values: serde_json::Map<String, serde_json::Value>,
}

/// A row that stands in the journal.
#[derive(Debug)]
pub struct Row<'a> {
    /// The rows of the sweep that ask it.
    pub rows: &'a [usize],
    /// What it rests on.
    pub basis: &'a Arc<Basis>,
    /// What was answered, or why it failed.
    pub outcome: std::result::Result<Record, String>,
}

/// What is done, and where more is written.
#[derive(Debug)]
pub struct Journal {
    folder: PathBuf,
    inside: Inside,
    written: Mutex<Written>,
    /// Held by whoever writes the report.
    report: File,
}

/// The file of this run's shard, and what rows in it may rest on.
#[derive(Debug)]
struct Written {
    file: File,
    known: HashMap<Arc<Basis>, String>,
}

impl Journal {
    /// Opens that of a shard in the folder of a report.
    ///
    /// # Errors
    /// Another process that has it open; a folder that cannot be written to.
    pub fn open(out: &Path, [shard, shards]: [usize; 2]) -> Result<Self> {
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
        let written = Mutex::new(Written { file, known: HashMap::new() });
        Ok(Self { folder, inside, written, report })
    }

    /// Writes a row, and what it rests on before the first one that does; gives back the basis that it has in common with others.
    ///
    /// # Errors
    /// A disk that is full.
    pub fn write(
        &self,
        key: &str,
        basis: Basis,
        outcome: &std::result::Result<Record, String>,
    ) -> Result<Arc<Basis>> {
        let (basis, on) = self.noted(basis)?;
        let values = outcome.iter().flatten().map(|(name, cell)| (name.clone(), cell.to_json())).collect();
        let error = outcome.as_ref().err().cloned();
        let line = Line { key: Some(key.to_owned()), on: Some(on), error, values, ..Line::default() };
        let text = json::line(&line)? + "\n";
        self.put(&mut self.written.lock().unwrap_or_else(PoisonError::into_inner).file, &text)?;
        Ok(basis)
    }

    /// A basis and what it is called, written if no row of this run rested on it before.
    fn noted(&self, basis: Basis) -> Result<(Arc<Basis>, String)> {
        let mut written = self.written.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((known, id)) = written.known.get_key_value(&basis) {
            return Ok((Arc::clone(known), id.clone()));
        }
        let mut id = sha256(json::line(&basis)?.as_bytes());
        // A quarter of it tells the few of a file apart.
        id.truncate(16);
        let line = Line { id: Some(id.clone()), basis: Some(basis), ..Line::default() };
        let text = json::line(&line)? + "\n";
        self.put(&mut written.file, &text)?;
        let basis = Arc::new(line.basis.unwrap_or_default());
        written.known.insert(Arc::clone(&basis), id.clone());
        Ok((basis, id))
    }

    fn put(&self, file: &mut File, text: &str) -> Result<()> {
        file.write_all(text.as_bytes())
            .map_err(|error| Error::file("write the rows of the sweep", &self.folder, error.to_string()))
    }

    /// Hands on every row that is `wanted` and whose files are as `hashes` finds them, whichever shard has written it, in no
    /// order of meaning.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub fn read(
        &self,
        keys: &Keys,
        wanted: &dyn Fn(&[usize]) -> bool,
        hashes: &Hashes,
        each: &mut dyn FnMut(Row<'_>),
    ) -> Result<()> {
        let failed =
            |error: std::io::Error| Error::file("read the rows of the sweep", &self.folder, told(&error));
        let mut names: Vec<String> = fs::read_dir(&self.folder)
            .map_err(failed)?
            .filter_map(|found| found.ok()?.file_name().into_string().ok())
            .filter(|name| Path::new(name).extension().is_some_and(|ending| ending == ENDING))
            .collect();
        names.sort();
        for name in names {
            let mut lines = BufReader::new(self.inside.file(&name).map_err(failed)?);
            let mut line = Vec::new();
            // Of each basis whether it holds, once a row asks for it.
            let mut known: HashMap<String, (Arc<Basis>, Option<bool>)> = HashMap::new();
            while (&mut lines).take(LONGEST_LINE).read_until(b'\n', &mut line).map_err(failed)? > 0 {
                match serde_json::from_slice(&line) {
                    Ok(Line { id: Some(id), basis: Some(basis), .. }) => {
                        known.insert(id, (Arc::new(basis), None));
                    }
                    Ok(Line { key: Some(key), on: Some(on), error, values, .. }) => {
                        let rows = keys.rows(&key);
                        if !rows.is_empty()
                            && wanted(rows)
                            && let Some((basis, holds)) = known.get_mut(&on)
                            && *holds.get_or_insert_with(|| basis.holds(hashes))
                        {
                            let cell = |(name, value)| Some((name, Cell::of_json(&value)?));
                            let record = || values.into_iter().filter_map(cell).collect();
                            let outcome = error.map_or_else(|| Ok(record()), Err);
                            each(Row { rows, basis, outcome });
                        }
                    }
                    _ => {}
                }
                line.clear();
            }
        }
        Ok(())
    }

    /// Waits for others that write the report of the same rows; they wait until this is dropped.
    pub fn lock_report(&self) {
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
