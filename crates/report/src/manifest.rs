//! `hadar.json`: what a folder of files is, who made it of what, and which files in it are its own.
//!
//! Nothing in it depends on when or where it was made: no time, no machine, no folder of the one who ran it. The same program with
//! the same command and inputs writes the same bytes, so that anyone can check a report by making it again.

use crate::folder::inside::{self, Inside, if_there};
use crate::json;
use hadar::error::Result;
use hadar::inputs::{Inputs, called};
use hadar_formats::hash;
pub(crate) use hadar_formats::hash::sha256_of;
use hadar_scenario::Setting;
use hadar_study::warning::Warning;
use serde::{Deserialize, Serialize};
use std::io::{self, Read as _};
use std::path::Path;

pub use hadar_formats::hash::{sha256, sha256_of_file};

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
    /// The command without what changes no answer, such as the folder it is written to; paths in it as those of `inputs`.
    pub command: Vec<String>,
    /// Seed of all random numbers of the report.
    pub seed: u64,
    /// All that was read, in the order of reading; then what is built in.
    pub inputs: Vec<Input>,
}

/// A file or something built in, by its content.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Input {
    /// The way to it from the scenario's folder, of what is not in it its name alone; `built-in: material skin` of what comes with the program.
    pub path: String,
    /// SHA-256 of it; none of what can be read only once.
    pub sha256: Option<String>,
}

/// A file of the folder, by its content.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Written {
    /// Name of the file within the folder.
    pub name: String,
    /// SHA-256 of the content of the file, in hexadecimal digits.
    pub sha256: String,
}

/// The content of `hadar.json`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Manifest {
    /// Version of the program that wrote the report.
    pub hadar: String,
    /// Version of the form of `hadar.json`, a whole number.
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
        let home = inputs.home();
        let home = home.as_deref();
        let command = without_places(command, home);
        let mut listed: Vec<Input> = inputs
            .streams
            .iter()
            .map(|(name, content)| Input { path: name.clone(), sha256: Some(sha256(content)) })
            .collect();
        for (file, sha256) in hash::of_all_read(inputs)? {
            listed.push(Input { path: called(home, &file), sha256: Some(sha256) });
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
    ///
    /// # Errors
    /// One that cannot be read.
    pub(crate) fn in_folder(folder: &Path) -> io::Result<Option<Self>> {
        let file = Inside::open(folder).and_then(|inside| inside.file(NAME));
        let Some(file) = if_there(file)? else { return Ok(None) };
        let mut text = Vec::new();
        file.take(LONGEST).read_to_end(&mut text)?;
        let Ok(manifest) = serde_json::from_slice::<Self>(&text) else { return Ok(None) };
        // Names of files in this folder and below: whoever changed the list reaches no others by it.
        let inside = |name: &str| inside::is_within(name) && name != NAME;
        Ok(manifest.files.iter().all(|file| inside(&file.name)).then_some(manifest))
    }

    /// Whether a file of the folder is listed and as it was written. No link on the way is followed.
    ///
    /// # Errors
    /// A listed file that cannot be read.
    pub(crate) fn owns(&self, folder: &Path, name: &str) -> io::Result<bool> {
        let listed = self.files.iter().find(|file| file.name == name).map(|file| file.sha256.as_str());
        if listed.is_none() && name != NAME {
            return Ok(false);
        }
        let Some(file) = if_there(Inside::open(folder).and_then(|inside| inside.file(name)))? else {
            return Ok(false);
        };
        listed.map_or(Ok(true), |listed| Ok(sha256_of(file)? == listed))
    }

    /// Whether a folder in it holds files of the run alone, unchanged.
    ///
    /// # Errors
    /// A folder that files of the run are listed in, or one of these, that cannot be read.
    pub(crate) fn owns_folder(&self, folder: &Path, name: &str) -> io::Result<bool> {
        let path = folder.join(name);
        if !self.files.iter().any(|file| file.name.starts_with(&format!("{name}/"))) {
            return Ok(false);
        }
        if !if_there(path.symlink_metadata())?.is_some_and(|found| found.is_dir()) {
            return Ok(false);
        }
        for entry in std::fs::read_dir(&path)? {
            let inner = format!("{name}/{}", entry?.file_name().to_string_lossy());
            if !self.owns(folder, &inner)? && !self.owns_folder(folder, &inner)? {
                return Ok(false);
            }
        }
        Ok(true)
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

/// A command without where its files are. A word that may be a name (`skin`) is no file, unless an option has it.
fn without_places(command: Vec<String>, home: Option<&Path>) -> Vec<String> {
    let mut of_option = false;
    let word = |word: String| {
        let (key, value) =
            word.split_once('=').map_or((None, word.as_str()), |(key, value)| (Some(key), value));
        let bare = value.trim_matches('"');
        let may_be =
            of_option || key.is_some() || bare.contains('.') || bare.contains(std::path::is_separator);
        of_option = key.is_none() && word.starts_with("--");
        if bare.is_empty() || !may_be || !Path::new(bare).exists() {
            return word;
        }
        let named = value.replace(bare, &called(home, Path::new(bare)));
        key.map_or_else(|| named.clone(), |key| format!("{key}={named}"))
    };
    command.into_iter().map(word).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_list_that_reaches_out_of_its_folder_is_none() {
        let folder = tempfile::tempdir().unwrap();
        for (name, good) in
            [("a.csv", true), ("../a.csv", false), ("/etc/a.csv", false), ("..", false), ("", false)]
        {
            let mut manifest = Manifest::of(&Provenance::default(), [("x", sha256(b"1"))]);
            manifest.files[0].name = name.into();
            std::fs::write(folder.path().join(NAME), manifest.to_json().unwrap()).unwrap();
            assert_eq!(Manifest::in_folder(folder.path()).unwrap().is_some(), good, "{name}");
        }
    }

    #[test]
    fn a_command_can_be_typed_again() {
        let command = ["hadar", "size", "my scene.toml", "--by", "local", "it's"].map(str::to_owned).to_vec();
        let provenance = Provenance { command, ..Provenance::default() };
        assert_eq!(provenance.command_line(), r"hadar size 'my scene.toml' --by local 'it'\''s'");
    }
}
