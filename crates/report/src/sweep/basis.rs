//! What a row of a sweep rests on: files with the hash of the bytes that were read for it, what is built in, which columns were asked for.

use crate::manifest::{Input, sha256, sha256_of_file};
use hadar::error::Result;
use hadar::inputs::Inputs;
use hadar::material::is_spectra;
use hadar_formats::hash;
use hadar_study::sweep::is_within;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// What a row rests on, which it has in common with many others.
#[derive(Debug, Clone, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Basis {
    /// Files that were read, with their SHA-256, and folders in which files were looked for, with that of the names in them.
    files: Vec<(PathBuf, Option<String>)>,
    /// What is built in and was used.
    pub built_in: Vec<Input>,
    /// Columns that its rows have; all where none is named.
    columns: Option<Vec<String>>,
}

impl Basis {
    /// That of a row which read `read`, and of which these columns are kept.
    ///
    /// # Errors
    /// A file that was changed while it was read.
    pub fn of(read: &Inputs, columns: Option<&[String]>, hashes: &Hashes) -> Result<Self> {
        let absolute = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        let files = hash::of_all_read(read)?.into_iter().map(|(path, hash)| (absolute(&path), Some(hash)));
        let folders = read.folders.iter().map(|path| (absolute(path), names_in(path)));
        let built_in = read.built_in.iter().map(|((kind, name), content)| Input {
            path: format!("built-in: {kind} {name}"),
            sha256: Some(hashes.of_built_in(kind, name, content)),
        });
        Ok(Self {
            files: files.chain(folders).collect(),
            built_in: built_in.collect(),
            columns: columns.map(<[String]>::to_vec),
        })
    }

    /// Whether its rows have what is asked for; all where nothing is named.
    #[must_use]
    pub fn covers(&self, asked: &[String]) -> bool {
        let has = |kept: &[String], column: &String| kept.iter().any(|kept| is_within(column, kept));
        let kept = self.columns.as_deref();
        kept.is_none_or(|kept| !asked.is_empty() && asked.iter().all(|column| has(kept, column)))
    }

    /// Whether every file is as it was.
    #[must_use]
    pub fn holds(&self, hashes: &Hashes) -> bool {
        self.changed(hashes).is_none()
    }

    /// A file that is not as it was, or that nothing tells to be.
    #[must_use]
    pub fn changed(&self, hashes: &Hashes) -> Option<&Path> {
        let is_same = |path: &Path, hash: &Option<String>| hash.is_some() && hashes.of(path) == *hash;
        self.files.iter().find(|(path, hash)| !is_same(path, hash)).map(|(path, _)| path.as_path())
    }

    /// Files that were read, with their hashes.
    pub fn files(&self) -> impl Iterator<Item = (&Path, &str)> {
        let read = self.files.iter().filter_map(|(path, hash)| Some((path.as_path(), hash.as_deref()?)));
        read.filter(|(path, _)| !path.is_dir())
    }
}

/// A thing that is built in, by kind and name.
type BuiltIn = (&'static str, String);

/// SHA-256 of files as they are at a time, each read once; and of what is built in.
#[derive(Debug, Default)]
pub struct Hashes {
    files: Mutex<BTreeMap<PathBuf, Option<String>>>,
    built_in: Mutex<HashMap<BuiltIn, (Vec<u8>, String)>>,
}

impl Hashes {
    /// That of a file, or of the names in a folder; none where it cannot be read, or only once.
    fn of(&self, path: &Path) -> Option<String> {
        let mut known = self.files.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(hash) = known.get(path) {
            return hash.clone();
        }
        let hash = if path.is_dir() { names_in(path) } else { sha256_of_file(path).ok().flatten() };
        known.insert(path.to_owned(), hash.clone());
        hash
    }

    fn of_built_in(&self, kind: &'static str, name: &str, content: &[u8]) -> String {
        let mut known = self.built_in.lock().unwrap_or_else(PoisonError::into_inner);
        let key = (kind, name.to_owned());
        match known.get(&key) {
            Some((same, hash)) if same == content => hash.clone(),
            _ => {
                let hash = sha256(content);
                known.insert(key, (content.to_vec(), hash.clone()));
                hash
            }
        }
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
