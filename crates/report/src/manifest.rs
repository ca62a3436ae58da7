//! `hadar.json`: what a folder of files is, who made it of what, and which files in it are its own.
//!
//! Nothing in it depends on when or where it was made: no time, no machine, no folder of the one who ran it. The same program with
//! the same command and inputs writes the same bytes, so that anyone can check a report by making it again.

use crate::folder::inside::{self, Inside};
use crate::json;
use hadar::error::Result;
use hadar::inputs::Inputs;
use hadar_formats::hash;
pub use hadar_formats::hash::sha256;
pub(crate) use hadar_formats::hash::sha256_of;
use hadar_scenario::Setting;
use hadar_study::warning::Warning;
use serde::{Deserialize, Serialize};
use std::fs::File;
use std::io::Read;
use std::path::{Component, Path, PathBuf};

/// The name of the file.
pub const NAME: &str = "hadar.json";

/// What is read of a manifest at most, bytes.
const LONGEST: u64 = 1 << 26;

/// The version of this program.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

/// The number of the form of every JSON that is printed or written. It rises when a key goes or changes its meaning; keys may be
/// added without.
pub const SCHEMA: u32 = 2;

/// A result as a program reads it: its keys behind the version of this program, the number of its form, what is said of the
/// library and what stands in the place of the file's own values, where there is something to say.
///
/// # Errors
/// A result that is no JSON, which would be a bug.
pub fn answer_json(
    answer: &impl Serialize,
    library_warnings: &[Warning],
    settings: &[Setting],
) -> Result<String> {
    #[derive(Serialize)]
    struct Versioned<'a, T> {
        hadar: &'static str,
        schema: u32,
        #[serde(skip_serializing_if = "<[Warning]>::is_empty")]
        library_warnings: &'a [Warning],
        #[serde(skip_serializing_if = "<[Setting]>::is_empty")]
        set: &'a [Setting],
        #[serde(flatten)]
        answer: &'a T,
    }
    let versioned = Versioned { hadar: VERSION, schema: SCHEMA, library_warnings, set: settings, answer };
    json::pretty(&versioned)
}

/// Who made a report of what.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Provenance {
    /// Commit of the program's source, with `-dirty` if that was changed since; `unknown` where it was built without a repository.
    pub commit: String,
    /// The command without what changes no answer, such as the folder it is written to.
    pub command: Vec<String>,
    /// Seed of random numbers.
    pub seed: u64,
    /// All that was read, in the order of reading; then what is built in.
    pub inputs: Vec<Input>,
}

/// A file or something built in, by its content.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Input {
    /// Where it is, from the scenario's folder, with `..` where it is not in it; `built-in: material skin` of what comes with the program.
    pub path: String,
    /// SHA-256 of it; none of what can be read only once.
    pub sha256: Option<String>,
}

/// A file of the folder, by its content.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Written {
    /// Its name.
    pub name: String,
    /// SHA-256 of it.
    pub sha256: String,
}

/// The content of `hadar.json`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Manifest {
    /// Version of the program.
    pub hadar: String,
    /// See [`SCHEMA`].
    pub schema: u32,
    /// Who made it of what.
    #[serde(flatten)]
    pub provenance: Provenance,
    /// Every other file that was written.
    pub files: Vec<Written>,
}

impl Provenance {
    /// That of a run which read `inputs`, the scenario first.
    ///
    /// # Errors
    /// A file that can no longer be read, or that was changed while it was read.
    pub fn of(commit: &str, command: Vec<String>, seed: u64, inputs: &Inputs) -> Result<Self> {
        // What is no file names others from the current directory.
        let first = match inputs.streams.first() {
            Some((name, _)) => Some(Path::new(name)),
            None => inputs.files.first().map(|file| file.path.as_path()),
        };
        let home = first.and_then(|file| std::path::absolute(file).ok());
        let home = home.as_deref().and_then(Path::parent);
        let mut listed: Vec<Input> = inputs
            .streams
            .iter()
            .map(|(name, content)| Input { path: name.clone(), sha256: Some(sha256(content)) })
            .collect();
        for (file, sha256) in hash::of_all_read(inputs)? {
            let beside = home.and_then(|home| from(home, &file));
            let path = slashed(beside.as_deref().unwrap_or(&file));
            listed.push(Input { path, sha256: Some(sha256) });
        }
        for ((kind, name), content) in &inputs.built_in {
            listed.push(Input { path: format!("built-in: {kind} {name}"), sha256: Some(sha256(content)) });
        }
        Ok(Self { commit: commit.to_owned(), command, seed, inputs: listed })
    }

    /// The command as it can be typed again.
    #[must_use]
    pub fn command_line(&self) -> String {
        let plain = |char: char| char.is_alphanumeric() || "-_./=,:+@%".contains(char);
        let quoted = self.command.iter().map(|word| match word.as_str() {
            word if !word.is_empty() && word.chars().all(plain) => word.to_owned(),
            word => format!("'{}'", word.replace('\'', "'\\''")),
        });
        quoted.collect::<Vec<_>>().join(" ")
    }
}

impl Manifest {
    /// That of files with the hashes of their content.
    pub(crate) fn of<'a>(
        provenance: &Provenance,
        files: impl IntoIterator<Item = (&'a str, String)>,
    ) -> Self {
        let files = files.into_iter().map(|(name, sha256)| Written { name: name.into(), sha256 }).collect();
        Self { hadar: VERSION.into(), schema: SCHEMA, provenance: provenance.clone(), files }
    }

    /// The manifest in a folder; `None` where there is none, or none of this program.
    pub(crate) fn in_folder(folder: &Path) -> Option<Self> {
        let file = Inside::open(folder).ok()?.file(NAME).ok()?;
        let mut text = Vec::new();
        file.take(LONGEST).read_to_end(&mut text).ok()?;
        let manifest: Self = serde_json::from_slice(&text).ok()?;
        // Names of files in this folder and below: whoever changed the list reaches no others by it.
        let inside = |name: &str| inside::is_within(name) && name != NAME;
        manifest.files.iter().all(|file| inside(&file.name)).then_some(manifest)
    }

    /// Whether a file of the folder is listed and as it was written. No link on the way is followed.
    pub(crate) fn owns(&self, folder: &Path, name: &str) -> bool {
        let Ok(file) = Inside::open(folder).and_then(|inside| inside.file(name)) else { return false };
        let listed = self.files.iter().find(|file| file.name == name);
        name == NAME || listed.is_some_and(|listed| sha256_of(file).is_ok_and(|now| now == listed.sha256))
    }

    /// Whether a folder in it holds files of the run alone, unchanged.
    pub(crate) fn owns_folder(&self, folder: &Path, name: &str) -> bool {
        let path = folder.join(name);
        let real = path.symlink_metadata().is_ok_and(|found| found.is_dir());
        let Ok(entries) = std::fs::read_dir(&path) else { return false };
        let own = |entry: std::io::Result<std::fs::DirEntry>| {
            let Ok(entry) = entry else { return false };
            let inner = format!("{name}/{}", entry.file_name().to_string_lossy());
            self.owns(folder, &inner) || self.owns_folder(folder, &inner)
        };
        real && self.files.iter().any(|file| file.name.starts_with(&format!("{name}/")))
            && entries.into_iter().all(own)
    }

    /// Whether a file is listed, changed or not.
    pub(crate) fn lists(&self, name: &str) -> bool {
        name == NAME || self.files.iter().any(|file| file.name == name)
    }

    /// As it is written.
    pub(crate) fn to_json(&self) -> Result<String> {
        Ok(json::pretty(self)? + "\n")
    }
}

/// The way from a folder to a file, `None` where there is none.
fn from(home: &Path, file: &Path) -> Option<PathBuf> {
    let absolute = std::path::absolute(file).ok()?;
    let plain = |inside: &&Path| inside.components().all(|part| part != Component::ParentDir);
    if let Some(inside) = absolute.strip_prefix(home).ok().filter(plain) {
        return Some(inside.to_owned());
    }
    // Links are followed, as they are by whoever goes up from there.
    let (home, file) = (home.canonicalize().ok()?, absolute.canonicalize().ok()?);
    let shared = home.components().zip(file.components()).take_while(|(one, other)| one == other).count();
    let up = home.components().skip(shared).map(|_| Component::ParentDir);
    (shared > 0).then(|| up.chain(file.components().skip(shared)).collect())
}

/// A path as it is written on every system.
fn slashed(path: &Path) -> String {
    path.to_string_lossy().replace(std::path::MAIN_SEPARATOR, "/")
}

/// SHA-256 of a file's content; `None` of what is no ordinary file, which may have been read up.
///
/// # Errors
/// A file that cannot be read.
pub fn sha256_of_file(path: &Path) -> std::io::Result<Option<String>> {
    if !path.metadata()?.is_file() {
        return Ok(None);
    }
    sha256_of(File::open(path)?).map(Some)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_ordinary_file_has_no_hash() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("abc"), "abc").unwrap();
        let of = |name: &str| sha256_of_file(&folder.path().join(name)).unwrap();
        assert_eq!((of("abc"), of("")), (Some(sha256(b"abc")), None));
    }

    #[test]
    fn a_list_that_reaches_out_of_its_folder_is_none() {
        let folder = tempfile::tempdir().unwrap();
        for (name, good) in
            [("a.csv", true), ("../a.csv", false), ("/etc/a.csv", false), ("..", false), ("", false)]
        {
            let mut manifest = Manifest::of(&Provenance::default(), [("x", sha256(b"1"))]);
            manifest.files[0].name = name.into();
            std::fs::write(folder.path().join(NAME), manifest.to_json().unwrap()).unwrap();
            assert_eq!(Manifest::in_folder(folder.path()).is_some(), good, "{name}");
        }
    }

    #[test]
    fn a_command_can_be_typed_again() {
        let command = ["hadar", "size", "my scene.toml", "--by", "local", "it's"].map(str::to_owned).to_vec();
        let provenance = Provenance { command, ..Provenance::default() };
        assert_eq!(provenance.command_line(), r"hadar size 'my scene.toml' --by local 'it'\''s'");
    }
}
