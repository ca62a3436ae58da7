//! The folder that a report takes: checked before the work, and then the old report or the new one, never a mix.
//!
//! A report owns what the [`Manifest`] in its folder lists, as long as it is as it was written, and replaces nothing else. Files of
//! others are refused, or left alone where that is asked for ([`Strangers`]), and what the run itself reads is never replaced. Hidden
//! files, and folders that are reports themselves, are nobody's concern and stay. No link in the folder is followed.
//!
//! What is found in a folder is never acted upon, since anybody may have put it there: a list of files, of a report that is whole or of
//! one that was begun, only says which files may be replaced, and only those that have the content that it gives.
//!
//! What is promised of a process that is killed at any time: a report of its own, in a folder that holds nothing else, is exchanged
//! for the new one in one step, where the file system has that step (those of Linux and macOS do). Where the folder itself must stay,
//! since other files are in it, or it is the current folder, a mount point or another user's, files are moved into it one by one;
//! `hadar.json` goes first and comes last, so that a folder with it is whole, and one without it is none until the next run that names
//! it has replaced what was moved. Of a computer that loses its power no more is promised than its file system does.

mod disk;
pub(crate) mod inside;
mod staging;

pub use self::inside::Inside;
use self::inside::if_there;
use self::staging::{Left, Staging, begun, clear, is_staging};
use crate::manifest::{self, Manifest, Provenance};
use hadar::error::{Error, Result};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// What to do about files in the folder that are not the report's own.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Strangers {
    /// Refuse the folder.
    #[default]
    Refuse,
    /// Leave them alone, but those whose names the report takes.
    KeepBesides,
}

/// What a file of a report holds.
#[derive(Debug, Clone)]
pub enum Held {
    /// These bytes.
    Bytes(Arc<Vec<u8>>),
    /// What another file holds, one of a [`Scratch`].
    File(PathBuf),
}

impl From<Vec<u8>> for Held {
    fn from(bytes: Vec<u8>) -> Self {
        Self::Bytes(Arc::new(bytes))
    }
}

impl Held {
    pub(crate) fn sha256(&self) -> io::Result<String> {
        match self {
            Self::Bytes(bytes) => Ok(manifest::sha256(bytes)),
            Self::File(path) => {
                manifest::sha256_of_file(path)?.ok_or_else(|| io::ErrorKind::InvalidInput.into())
            }
        }
    }

    /// Files on the same disk take no room twice.
    fn write(&self, path: &Path) -> io::Result<()> {
        match self {
            Self::Bytes(bytes) => disk::write(path, bytes),
            Self::File(own) => disk::link_or_copy(own, path),
        }
    }
}

/// Room for files of a report that are too large to be kept until it is written. It goes with what is left in it.
#[derive(Debug)]
pub struct Scratch {
    // Gone before the folders that it is in.
    staging: Staging,
    _above: Above,
}

/// Folders that were made for a [`Scratch`], the innermost first. They go with it if nothing else is in them.
#[derive(Debug)]
struct Above(Vec<PathBuf>);

impl Drop for Above {
    fn drop(&mut self) {
        for folder in &self.0 {
            let _ = disk::remove_dir(folder);
        }
    }
}

impl Scratch {
    /// Where temporary files of this machine are, for work without a report.
    ///
    /// # Errors
    /// A folder that cannot be written to.
    pub fn temporary() -> Result<Self> {
        let home = std::env::temp_dir();
        clear(&home, Left::Unfinished);
        Staging::in_folder(&home).map(|staging| Self { staging, _above: Above(Vec::new()) }).map_err(
            |error| {
                let reason = format!("{error}; name another folder by TMPDIR, or a report by --out");
                Error::file("keep the maps in", &home, reason)
            },
        )
    }

    /// A folder for them.
    #[must_use]
    pub fn place(&self) -> PathBuf {
        self.staging.new_report()
    }
}

/// A folder to be written to.
#[derive(Debug, Clone)]
pub struct Folder {
    named: PathBuf,
    strangers: Strangers,
}

/// What is in a folder.
struct Content {
    /// The list of the report that is there; then those of what was begun and not finished.
    manifests: Vec<Manifest>,
    /// Whether nothing but that report is in it.
    alone: bool,
}

impl Content {
    /// Whether a file or folder is listed, and whether it is as it was listed.
    fn knows(&self, place: &Path, name: &str) -> io::Result<(bool, bool)> {
        let mut owned = false;
        for manifest in &self.manifests {
            owned = owned || manifest.owns(place, name)? || manifest.owns_folder(place, name)?;
        }
        Ok((self.manifests.iter().any(|manifest| manifest.lists(name)), owned))
    }
}

impl Folder {
    /// The folder of this name.
    #[must_use]
    pub fn new(named: impl Into<PathBuf>, strangers: Strangers) -> Self {
        Self { named: named.into(), strangers }
    }

    /// Its name, as it was given.
    #[must_use]
    pub fn named(&self) -> &Path {
        &self.named
    }

    /// Whether another name is one of the same folder.
    #[must_use]
    pub fn is(&self, other: &Self) -> bool {
        self.place().ok().zip(other.place().ok()).is_some_and(|(own, other)| own == other)
    }

    /// Makes sure that a report can be written, before any work is done for it. Then clears away what dead runs have left beside it.
    ///
    /// # Errors
    /// A path that is a file or a link to nothing, where nothing may be written, with a name that is too long, or with files of
    /// others in it.
    pub fn check(&self) -> Result<()> {
        let place = self.place()?;
        self.content(&place)?;
        clear_beside(&place);
        clear(&place, Left::Unfinished);
        let home = nearest_folder(&place).unwrap_or_else(|| PathBuf::from("."));
        Staging::in_folder(&home).map(drop).map_err(|error| self.refused(&error))
    }

    /// Room for large files, on the disk of the report if it may be written to: beside its folder, else in it.
    ///
    /// # Errors
    /// As [`Folder::check`].
    pub fn scratch(&self) -> Result<Scratch> {
        let place = self.place()?;
        // No further up: a run that finds the parent there does not look above it for what this one leaves.
        let beside = place.parent().map_or(Err(io::ErrorKind::NotFound.into()), |parent| {
            let missing = parent.ancestors().take_while(|part| !part.exists());
            let above = Above(missing.map(Path::to_owned).collect());
            disk::create_dir_all(parent)?;
            Ok(Scratch { staging: Staging::in_folder(parent)?, _above: above })
        });
        let within = |_: io::Error| {
            let home = nearest_folder(&place).unwrap_or_else(|| PathBuf::from("."));
            Ok(Scratch { staging: Staging::in_folder(&home)?, _above: Above(Vec::new()) })
        };
        beside.or_else(within).map_err(|error| self.refused(&error))
    }

    /// Makes sure that none of the `inputs` is where the report, or what it replaces, has a file of these names.
    ///
    /// # Errors
    /// The first one that is.
    pub fn check_inputs(&self, inputs: &[PathBuf], names: &[&str]) -> Result<()> {
        let place = self.place()?;
        let listed = Manifest::in_folder(&place).map_err(|error| self.refused(&error))?;
        let listed = listed.iter().flat_map(|manifest| &manifest.files).map(|file| file.name.as_str());
        for name in names.iter().copied().chain([manifest::NAME]).chain(listed) {
            let path = place.join(name);
            if let Some(input) = inputs.iter().find(|input| is_same(input, &path)) {
                let reason = format!(
                    "`{name}` in it is read by this run as {}, and would be replaced; name another folder",
                    input.display()
                );
                return Err(Error::file("write the report", &self.named, reason));
            }
        }
        Ok(())
    }

    /// The files that a run wrote here, as they were written.
    ///
    /// # Errors
    /// As [`Folder::check`].
    pub fn own_files(&self) -> Result<Vec<(String, Vec<u8>)>> {
        let place = self.place()?;
        let own = || -> io::Result<_> {
            let Some(manifest) = Manifest::in_folder(&place)? else { return Ok(Vec::new()) };
            let mut own = Vec::new();
            for file in &manifest.files {
                if manifest.owns(&place, &file.name)? {
                    own.push((file.name.clone(), fs::read(place.join(&file.name))?));
                }
            }
            Ok(own)
        };
        own().map_err(|error| self.refused(&error))
    }

    /// Writes files and the manifest that lists them. None of `inputs` is replaced.
    ///
    /// # Errors
    /// As [`Folder::check`] and [`Folder::check_inputs`]; a disk that is full. Then what was there is there unchanged.
    pub fn write(&self, files: &[(String, Held)], provenance: &Provenance, inputs: &[PathBuf]) -> Result<()> {
        let place = self.place()?;
        let content = self.content(&place)?;
        let names: Vec<&str> = files.iter().map(|(name, _)| name.as_str()).collect();
        self.check_inputs(inputs, &names)?;
        if let Some(twice) = names.iter().enumerate().find(|(at, name)| names[..*at].contains(name)) {
            let found = format!("it has two files `{}`; report this as a bug", twice.1);
            return Err(Error::file("write the report", &self.named, found));
        }
        // Found out before the first one is moved.
        self.check_ways(&place, &names)?;
        let hashes = files.iter().map(|(name, held)| Ok((name.as_str(), held.sha256()?)));
        let hashes: io::Result<Vec<_>> = hashes.collect();
        let manifest = Manifest::of(provenance, hashes.map_err(|error| self.refused(&error))?);
        let fill = |report: &Path| -> io::Result<()> {
            files.iter().try_for_each(|(name, held)| {
                let path = report.join(name);
                path.parent().map_or(Ok(()), disk::create_dir_all)?;
                held.write(&path)
            })?;
            disk::write(
                &report.join(manifest::NAME),
                manifest.to_json().map_err(io::Error::other)?.as_bytes(),
            )
        };
        let whole = match place.parent().filter(|_| content.alone) {
            Some(parent) => exchanged(&place, parent, content.manifests.first(), &fill),
            None => Ok(false),
        };
        let written = match whole {
            Ok(true) => Ok(()),
            Ok(false) => moved(&place, &manifest, &content.manifests, &fill),
            Err(error) => Err(error),
        };
        written.map_err(|error| self.refused(&error))?;
        clear_beside(&place);
        clear(&place, Left::Replaced);
        Ok(())
    }

    /// Makes sure that every name is one of a file in the folder: no folder is in its place, and no file or link where it has a folder.
    fn check_ways(&self, place: &Path, names: &[&str]) -> Result<()> {
        let refuse = |found: String| {
            let reason = format!("{found}; name another folder");
            Err(Error::file("write the report", &self.named, reason))
        };
        for name in names {
            if place.join(name).is_dir() {
                return refuse(format!("its `{name}` is a folder, which no file may replace"));
            }
            for above in Path::new(name).ancestors().skip(1).filter(|above| !above.as_os_str().is_empty()) {
                let found = place.join(above).symlink_metadata();
                if found.is_ok_and(|found| !found.is_dir()) {
                    let above = above.display();
                    return refuse(format!(
                        "its `{above}` is a file or a link, where the report has a folder"
                    ));
                }
            }
        }
        Ok(())
    }

    /// The folder without links, so that what is beside it is beside it.
    fn place(&self) -> Result<PathBuf> {
        let refuse = |reason: &str| Error::file("write the report", &self.named, reason);
        if self.named.as_os_str().is_empty() {
            return Err(refuse("the name is empty; name a folder"));
        }
        if self.named.is_file() {
            return Err(refuse("this is a file; name a folder"));
        }
        let home = match nearest_folder(&self.named) {
            Some(home) if home.is_dir() => home,
            Some(_) => return Err(self.refused(&io::ErrorKind::NotADirectory.into())),
            None => PathBuf::from("."),
        };
        if self.named.ancestors().take_while(|part| *part != home).any(Path::is_symlink) {
            return Err(refuse("it is a link to nothing; name a folder, or remove the link"));
        }
        let rest = self.named.strip_prefix(&home).unwrap_or(&self.named);
        let home = home.canonicalize().map_err(|error| self.refused(&error))?;
        // A system that meets a missing folder first does not tell that a name below it is too long.
        let too_long = |path: PathBuf| {
            path.symlink_metadata().is_err_and(|error| error.kind() == io::ErrorKind::InvalidFilename)
        };
        let room = staging::longest_way(&home.join(rest));
        if rest.components().any(|part| too_long(home.join(part))) || too_long(room) {
            return Err(refuse("the name is longer than its file system takes; name another folder"));
        }
        Ok(if rest.as_os_str().is_empty() { home } else { home.join(rest) })
    }

    /// What is in the folder, if it may be written to.
    fn content(&self, place: &Path) -> Result<Content> {
        let refused = |error: io::Error| self.refused(&error);
        let mut content = Content { manifests: Vec::new(), alone: true };
        if if_there(place.metadata()).map_err(refused)?.is_none() {
            return Ok(content);
        }
        let begun = begun(place).map_err(refused)?;
        for folder in std::iter::once(place).chain(begun.iter().flatten().map(PathBuf::as_path)) {
            content.manifests.extend(Manifest::in_folder(folder).map_err(refused)?);
        }
        let entries = fs::read_dir(place).and_then(Iterator::collect::<io::Result<Vec<_>>>);
        let mut names: Vec<_> = entries.map_err(refused)?.iter().map(fs::DirEntry::file_name).collect();
        names.sort();
        for name in names {
            let (name, path) = (name.to_string_lossy().into_owned(), place.join(&name));
            let (listed, owned) = content.knows(place, &name).map_err(refused)?;
            if owned {
                continue;
            }
            content.alone = false;
            let bystander = !listed
                && (is_staging(&path)
                    || is_hidden(&name)
                    || (!path.is_symlink() && matches!(Manifest::in_folder(&path), Ok(Some(_)))));
            if !bystander && self.strangers == Strangers::Refuse {
                let found = match (listed, content.manifests.is_empty()) {
                    (true, _) => format!("its `{name}` was changed since hadar wrote it"),
                    (false, false) => {
                        format!("`{name}` in it was not written by the run of hadar that wrote the rest")
                    }
                    (false, true) => {
                        format!("it holds `{name}`, and no {} says that hadar wrote it", manifest::NAME)
                    }
                };
                let instead =
                    "name another folder, or add --force to keep what is not in the way and replace what is";
                return Err(Error::file("write the report", &self.named, format!("{found}; {instead}")));
            }
        }
        Ok(content)
    }

    fn refused(&self, error: &io::Error) -> Error {
        let reason = match error.kind() {
            io::ErrorKind::PermissionDenied => "no permission; name a folder you may write to".to_owned(),
            io::ErrorKind::ReadOnlyFilesystem => "read-only; name a folder you may write to".to_owned(),
            io::ErrorKind::NotADirectory => "part of the path is a file; name a folder".to_owned(),
            _ => format!("{error}; name a folder you may write to"),
        };
        Error::file("write the report", &self.named, reason)
    }
}

/// Makes a report beside its folder, which holds nothing but the `old` one, and puts it there in one step. `false` where the folder
/// itself has to stay.
fn exchanged(
    place: &Path,
    parent: &Path,
    old: Option<&Manifest>,
    fill: &dyn Fn(&Path) -> io::Result<()>,
) -> io::Result<bool> {
    let there = place.is_dir();
    if there && std::env::current_dir().is_ok_and(|here| here.starts_with(place)) {
        return Ok(false);
    }
    if !there {
        disk::create_dir_all(parent)?;
    }
    let staging = match Staging::in_folder(parent) {
        Ok(staging) => staging,
        Err(_) if there => return Ok(false),
        Err(error) => return Err(error),
    };
    let new = staging.new_report();
    fill(&new)?;
    if !there {
        return disk::rename(&new, place).map(|()| true);
    }
    if !same_owner(place, &new) || disk::exchange(&new, place).is_err() {
        return Ok(false);
    }
    // What came into the old folder at the last moment is not the report's: it goes where it was meant to go.
    for entry in fs::read_dir(&new).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let own = old.is_some_and(|old| old.lists(&name.to_string_lossy()));
        if !own && !place.join(&name).exists() {
            let _ = disk::rename(&entry.path(), &place.join(&name));
        }
    }
    Ok(true)
}

/// Makes a report within its folder, and moves its files one by one.
fn moved(
    place: &Path,
    new: &Manifest,
    before: &[Manifest],
    fill: &dyn Fn(&Path) -> io::Result<()>,
) -> io::Result<()> {
    disk::create_dir_all(place)?;
    let mut staging = Staging::in_folder(place)?;
    fill(&staging.new_report())?;
    let [ready, old] = staging.commit()?;
    let inside = Inside::open(place)?;
    // From here on the folder is no whole report, and says so.
    if if_there(inside.file(manifest::NAME))?.is_some() {
        disk::create_dir_all(&old)?;
        disk::rename(&place.join(manifest::NAME), &old.join(manifest::NAME))?;
    }
    for old in before {
        let obsolete = old.files.iter().map(|file| &file.name).filter(|name| !new.lists(name));
        for name in obsolete {
            if old.owns(place, name)? {
                inside.remove(name)?;
            }
        }
    }
    let names = new.files.iter().map(|file| file.name.as_str()).chain([manifest::NAME]);
    names.into_iter().try_for_each(|name| inside.take(&ready.join(name), name))?;
    staging.done();
    Ok(())
}

/// Folders above a report in which a run that had to make the last of them may have begun.
const BEGUN_ABOVE: usize = 4;

/// Clears what dead runs have left beside a folder, or above it: runs begin in the nearest folder that is there.
fn clear_beside(place: &Path) {
    for home in place.ancestors().skip(1).filter(|home| home.is_dir()).take(BEGUN_ABOVE) {
        clear(home, Left::Unfinished);
    }
}

/// Whether two paths belong to the same user and group.
#[cfg(unix)]
fn same_owner(a: &Path, b: &Path) -> bool {
    use std::os::unix::fs::MetadataExt as _;
    let of = |path: &Path| path.metadata().map(|found| (found.uid(), found.gid())).ok();
    of(a).is_some() && of(a) == of(b)
}

#[cfg(not(unix))]
fn same_owner(_: &Path, _: &Path) -> bool {
    true
}

/// Whether two paths lead to one file.
fn is_same(a: &Path, b: &Path) -> bool {
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt as _;
        let of = |path: &Path| path.metadata().map(|found| (found.dev(), found.ino())).ok();
        of(a).is_some() && of(a) == of(b)
    }
    #[cfg(not(unix))]
    {
        let of = |path: &Path| path.canonicalize().ok();
        of(a).is_some() && of(a) == of(b)
    }
}

/// What file managers and version control leave behind.
fn is_hidden(name: &str) -> bool {
    name.starts_with('.') || ["Thumbs.db", "desktop.ini"].contains(&name)
}

/// The part of a path that is there already.
fn nearest_folder(path: &Path) -> Option<PathBuf> {
    path.ancestors().find(|part| part.exists()).map(Path::to_owned)
}

#[cfg(test)]
mod tests;
