//! A report held against itself made again: every file of it, byte by byte.
//!
//! `hadar.json` says which command made the report of which inputs. The command is given again, with the scenario that the report has
//! in its folder, and what it writes elsewhere is compared. Nothing of the report is believed: its list only says what to compare.

use crate::folder::inside::{Inside, if_there};
use crate::manifest::{self, Input, Manifest, Provenance, VERSION, sha256, sha256_of};
use crate::rule::AS_READ;
use hadar::error::{Error, Result};
use std::collections::BTreeMap;
use std::io::Read as _;
use std::path::Path;

mod demands;
mod verified;

pub use crate::words::verify::text;
pub use demands::Demands;
pub use verified::{Difference, EnvelopeFault, Verified};

/// Files that ask again what a report answers.
const ASKED: [&str; 3] = ["scenario.toml", AS_READ, "rule.toml"];
/// The longest of them, bytes.
const LONGEST_ASKED: u64 = 1 << 24;

/// A report in its folder.
#[derive(Debug)]
pub struct Stored {
    manifest: Manifest,
    /// What it answers, as a file that asks it again.
    pub asked: Option<String>,
    /// SHA-256 of that file where it is the one that was read, word by word.
    pub asked_as_read: Option<String>,
}

impl Stored {
    /// The report in a folder.
    ///
    /// # Errors
    /// A folder without one.
    pub fn read(folder: &Path) -> Result<Self> {
        let unread = |error: std::io::Error| Error::file("read the report", folder, error.kind());
        let Some(manifest) = Manifest::in_folder(folder).map_err(unread)? else {
            let instead = "name a folder that --out made";
            return Err(Error::malformed("there is no report in this folder", instead).in_file(folder));
        };
        let listed = ASKED.into_iter().find(|asked| manifest.files.iter().any(|file| file.name == *asked));
        let asked = listed.map(|name| -> Result<String> {
            let mut text = String::new();
            let read = Inside::open(folder).and_then(|inside| inside.file(name));
            let read = read.and_then(|file| file.take(LONGEST_ASKED).read_to_string(&mut text));
            read.map_err(|error| Error::file("read the report", &folder.join(name), error.kind()))?;
            Ok(text)
        });
        let asked = asked.transpose()?;
        let asked_as_read = asked.as_ref().filter(|_| listed == Some(AS_READ));
        Ok(Self { asked_as_read: asked_as_read.map(|text| sha256(text.as_bytes())), asked, manifest })
    }

    /// Who made it of what, as it says.
    #[must_use]
    pub fn provenance(&self) -> &Provenance {
        &self.manifest.provenance
    }

    /// Holds the report in `folder` against the one that its command has `made` elsewhere, of the inputs `now`. `asked` says whether the
    /// file of the question was found, and with which hash; the statement of the folder is held against the `demands`.
    ///
    /// # Errors
    /// A folder that cannot be read; a command that made no report.
    pub fn against(
        &self,
        folder: &Path,
        made: &Path,
        now: &[Input],
        asked: Option<&str>,
        commit: &str,
        demands: &Demands,
    ) -> Result<Verified> {
        let unread = |error: std::io::Error| Error::file("read the report", made, error.kind());
        let Some(again) = Manifest::in_folder(made).map_err(unread)? else {
            let found = format!("its command, {}, writes no report", self.provenance().command_line());
            return Err(Error::malformed(found, "make the report again").in_file(folder));
        };
        let mut differences = Vec::new();
        let program = |version: &str, commit: &str| format!("hadar {version}, commit {commit}");
        let [was, is] = [program(&self.manifest.hadar, &self.provenance().commit), program(VERSION, commit)];
        if was != is {
            differences.push(Difference::Program { was, is });
        }
        let inputs = self.compare_inputs(now, asked, &mut differences);
        self.compare_files(folder, &again, &mut differences)?;
        let strangers = self.strangers(folder)?;
        let (unmet, signed_by) = if demands.is_none() {
            Default::default()
        } else {
            demands.unmet(folder, self.manifest.lists(crate::rule::STATEMENT))?
        };
        differences.extend(unmet);
        let is_none = |difference: &Difference| matches!(difference, Difference::Program { .. });
        Ok(Verified {
            verified: differences.iter().all(is_none),
            files: self.manifest.files.len() + 1,
            inputs,
            command: self.provenance().command_line(),
            differences,
            strangers,
            signed_by,
            question_compared: self.asked.is_none() || asked.is_some(),
        })
    }

    /// What was read now against what the report says; how many inputs could be compared.
    fn compare_inputs(&self, now: &[Input], asked: Option<&str>, to: &mut Vec<Difference>) -> usize {
        let mut before: BTreeMap<&str, Option<&str>> = BTreeMap::new();
        for input in &self.provenance().inputs {
            before.insert(&input.path, input.sha256.as_deref());
        }
        let mut after: BTreeMap<&str, Option<&str>> = BTreeMap::new();
        for input in now {
            after.insert(&input.path, input.sha256.as_deref());
        }
        if let (Some(first), Some(_)) = (self.provenance().inputs.first(), &self.asked) {
            // The scenario of the folder was read in its place.
            match asked {
                Some(hash) => after.insert(&first.path, Some(hash)),
                None => {
                    before.remove(first.path.as_str());
                    after.remove(first.path.as_str())
                }
            };
        }
        let compared = before.len();
        let names: std::collections::BTreeSet<&str> = before.keys().chain(after.keys()).copied().collect();
        for name in names {
            let [was, is] = [&before, &after].map(|all| all.get(name).copied().flatten().map(str::to_owned));
            if was != is || before.contains_key(name) != after.contains_key(name) {
                to.push(Difference::Input { path: name.to_owned(), was, is });
            }
        }
        compared
    }

    /// Every file as it is, as it is listed and as it was made again.
    fn compare_files(&self, folder: &Path, again: &Manifest, to: &mut Vec<Difference>) -> Result<()> {
        let failed = |error: std::io::Error| Error::file("read the report", folder, error.kind());
        let inside = Inside::open(folder).map_err(failed)?;
        for listed in &self.manifest.files {
            let file = listed.name.clone();
            let made = again.files.iter().find(|made| made.name == file).map(|made| made.sha256.as_str());
            let is = if_there(inside.file(&file).and_then(sha256_of)).map_err(failed)?;
            to.extend(match (is, made) {
                (None, _) => Some(Difference::Missing { file }),
                (Some(is), _) if is != listed.sha256 => Some(Difference::Changed { file }),
                (Some(_), None) => Some(Difference::NotMade { file }),
                (Some(is), Some(made)) if is != made => Some(Difference::Differs { file }),
                _ => None,
            });
        }
        for made in again.files.iter().filter(|made| !self.manifest.lists(&made.name)) {
            to.push(Difference::Unlisted { file: made.name.clone() });
        }
        // The list itself, where all that it lists is the same: not a byte of it may be another.
        let same = to.iter().all(|difference| matches!(difference, Difference::Program { .. }));
        if same {
            let again = Manifest { hadar: self.manifest.hadar.clone(), ..again.clone() };
            let mut text = String::new();
            let read = inside.file(manifest::NAME).and_then(|mut file| file.read_to_string(&mut text));
            read.map_err(failed)?;
            if text != again.to_json()? {
                to.push(Difference::Differs { file: manifest::NAME.to_owned() });
            }
        }
        Ok(())
    }

    /// Files beside those of the report.
    fn strangers(&self, folder: &Path) -> Result<Vec<String>> {
        let failed = |error: std::io::Error| Error::file("read the report", folder, error.kind());
        let entries = std::fs::read_dir(folder).and_then(Iterator::collect::<std::io::Result<Vec<_>>>);
        let names = entries.map_err(failed)?.into_iter().map(|entry| entry.file_name());
        let mut names: Vec<String> = names.map(|name| name.to_string_lossy().into_owned()).collect();
        // Hidden ones are nobody's concern, as where a report is written.
        names.retain(|name| !name.starts_with('.') && !self.manifest.lists(name));
        names.sort();
        let mut strangers = Vec::new();
        for name in names {
            if !self.manifest.owns_folder(folder, &name).map_err(failed)? {
                strangers.push(name);
            }
        }
        Ok(strangers)
    }
}
