//! Where a report is made before it takes its place: a folder that nobody can foresee, that is this process's alone, and that the
//! next run clears away if this one dies.
//!
//! `.hadar-XXXXXXXXXXXX/` holds `new/`, the report, and `lock`, which stays locked as long as the process lives, whatever its number
//! and wherever it runs. It is made exclusively and open to its owner alone, so that no link planted before is followed. Once `new/`
//! is complete and must be moved file by file, it is called `ready/`, and `old/` has the list of the report that goes: whoever finds
//! them without their process knows by the two lists which files in the folder are hadar's, and replaces them by its own.
//!
//! A folder of the name that is another user's, or open to others, is nobody's here: it is neither read nor removed.
//!
//! A process can be killed between any two calls. The lock has the name `unlocked` until it is locked, it is removed after everything
//! else, and the folder after it. A dead process thus leaves one of three states, each of which is recognised: a `lock` that can be
//! had, an `unlocked` that can be had, or an empty folder. The latter two are also those of a process that has only begun: it makes
//! another folder if it finds the first one cleared away by somebody else.

use super::disk;
use crate::manifest;
use std::fs::{File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::time::Duration;

const PREFIX: &str = ".hadar-";
/// Random characters of the name.
const RANDOM: usize = 12;
const LOCK: &str = "lock";
const UNLOCKED: &str = "unlocked";
const NEW: &str = "new";
const READY: &str = "ready";
const OLD: &str = "old";
/// Room for the name of a file with its folder.
const LONGEST_NAME: usize = 100;
/// A folder without a lock that can be asked is left alone so long: its process may only just have made it.
const DEAD_AFTER: Duration = Duration::from_secs(24 * 3600);
/// Folders that are made until one is not taken for that of a dead process.
const ATTEMPTS: usize = 100;

/// Which folders of dead processes go.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Left {
    /// Those that nothing was moved out of.
    Unfinished,
    /// All, since a report has taken the place of what was moved.
    Replaced,
}

/// A folder of this process.
#[derive(Debug)]
pub(super) struct Staging {
    folder: PathBuf,
    /// `None` once it is given back.
    lock: Option<File>,
    /// Whether it stays for the next run.
    kept: bool,
}

impl Staging {
    /// A new one in `home`, which must be there.
    pub(super) fn in_folder(home: &Path) -> io::Result<Self> {
        let mut taken = io::Error::from(io::ErrorKind::NotFound);
        for _ in 0..ATTEMPTS {
            let mut staging =
                Self { folder: disk::private_folder(home, PREFIX, RANDOM)?, lock: None, kept: false };
            match staging.begin() {
                Ok(()) => return Ok(staging),
                // Cleared away, or about to be.
                Err(error)
                    if [io::ErrorKind::NotFound, io::ErrorKind::WouldBlock].contains(&error.kind()) =>
                {
                    taken = error;
                }
                Err(error) => return Err(error),
            }
        }
        Err(taken)
    }

    /// Locks the folder and makes what it holds.
    fn begin(&mut self) -> io::Result<()> {
        // Under its own name only once it is locked: a lock that is free is one of the dead.
        let unlocked = self.folder.join(UNLOCKED);
        let lock = self.lock.insert(disk::create_new(&unlocked)?);
        // Without locks the folder is known by its age.
        if let Err(TryLockError::WouldBlock) = disk::try_lock(lock) {
            return Err(io::ErrorKind::WouldBlock.into());
        }
        disk::rename(&unlocked, &self.folder.join(LOCK))?;
        disk::create_dir(&self.new_report())
    }

    /// Where the report is made.
    pub(super) fn new_report(&self) -> PathBuf {
        self.folder.join(NEW)
    }

    /// From now on the report is moved into its folder; where it is, and where the list of the old one goes.
    pub(super) fn commit(&mut self) -> io::Result<[PathBuf; 2]> {
        let [ready, old] = [READY, OLD].map(|name| self.folder.join(name));
        disk::rename(&self.new_report(), &ready)?;
        self.kept = true;
        Ok([ready, old])
    }

    /// The work is done, or was undone.
    pub(super) fn done(&mut self) {
        self.kept = false;
    }
}

impl Drop for Staging {
    fn drop(&mut self) {
        if !self.kept {
            remove(&self.folder, &mut self.lock);
        }
    }
}

/// Removes a staging folder: its lock after everything else, so that whoever is killed meanwhile leaves what [`clear`] removes. What
/// cannot be removed stays.
fn remove(folder: &Path, lock: &mut Option<File>) {
    let is_lock = |name: &std::ffi::OsStr| name == LOCK || name == UNLOCKED;
    let Ok(entries) = disk::entries(folder) else { return };
    let mut empty = true;
    for entry in entries.into_iter().filter(|entry| !is_lock(&entry.file_name())) {
        let is_folder = entry.file_type().is_ok_and(|found| found.is_dir());
        let removed =
            if is_folder { disk::remove_dir_all(&entry.path()) } else { disk::remove_file(&entry.path()) };
        empty &= removed.is_ok();
    }
    if empty {
        // Given back first: not every system removes a file that is open.
        drop(lock.take());
        let _ = disk::remove_file(&folder.join(LOCK));
        let _ = disk::remove_file(&folder.join(UNLOCKED));
        let _ = disk::remove_dir(folder);
    }
}

/// Removes the staging folders in `home` whose processes are dead. What cannot be removed stays, as what may still be in use.
pub(super) fn clear(home: &Path, left: Left) {
    for folder in own(home).into_iter().flatten() {
        let Ok(lock) = disk::open_lock(&folder.join(LOCK)) else { continue };
        let Some(lock) = lock else {
            clear_begun(&folder);
            continue;
        };
        if is_dead(&folder, &lock) && (left == Left::Replaced || !is_begun(&folder)) {
            remove(&folder, &mut Some(lock));
        }
    }
}

/// Folders of a process whose report was begun to be moved out of them into `home`: of the new report and of the old one.
pub(super) fn begun(home: &Path) -> io::Result<Vec<[PathBuf; 2]>> {
    let begun = own(home)?.into_iter().filter(|folder| is_begun(folder));
    Ok(begun.map(|folder| [READY, OLD].map(|name| folder.join(name))).collect())
}

/// Whether a report waits to be moved: its list goes last.
fn is_begun(folder: &Path) -> bool {
    let ready = folder.join(READY);
    ready.symlink_metadata().is_ok_and(|found| found.is_dir()) && ready.join(manifest::NAME).exists()
}

/// Staging folders in `home` that are this user's.
fn own(home: &Path) -> io::Result<Vec<PathBuf>> {
    let entries = disk::entries(home)?.into_iter().map(|entry| entry.path());
    Ok(entries.filter(|path| is_staging(path) && disk::is_private(path)).collect())
}

/// The longest way that a report takes to its folder.
pub(super) fn longest_way(place: &Path) -> PathBuf {
    let staging = format!("{PREFIX}{}", "x".repeat(RANDOM));
    place.join(staging).join(READY).join("x".repeat(LONGEST_NAME))
}

/// Removes a staging folder that has no lock yet, or none any more. Nothing but an empty file and an empty folder is ever removed.
fn clear_begun(folder: &Path) {
    match disk::open_lock(&folder.join(UNLOCKED)) {
        Ok(Some(lock)) if is_dead(folder, &lock) && lock.metadata().is_ok_and(|found| found.len() == 0) => {
            // As long as it is held here, its process cannot give it its name.
            let _ = disk::remove_file(&folder.join(UNLOCKED));
            let _ = disk::remove_dir(folder);
        }
        // Its process makes another one if it was about to go on.
        Ok(None) => drop(disk::remove_dir(folder)),
        _ => {}
    }
}

/// Whether the process that made a folder is dead: its lock can be had, and is held by `lock` from now on.
fn is_dead(folder: &Path, lock: &File) -> bool {
    match disk::try_lock(lock) {
        Ok(()) => true,
        Err(TryLockError::WouldBlock) => false,
        Err(TryLockError::Error(_)) => is_old(folder),
    }
}

/// Whether a path is a staging folder of someone, dead or alive.
pub(super) fn is_staging(path: &Path) -> bool {
    let name = path.file_name().map(|name| name.to_string_lossy());
    let random = name.as_deref().and_then(|name| name.strip_prefix(PREFIX));
    random.is_some_and(|random| {
        random.len() == RANDOM && random.chars().all(|char| char.is_ascii_alphanumeric())
    }) && path.symlink_metadata().is_ok_and(|found| found.is_dir())
}

fn is_old(folder: &Path) -> bool {
    let made = folder.symlink_metadata().and_then(|found| found.modified());
    made.is_ok_and(|made| made.elapsed().is_ok_and(|age| age > DEAD_AFTER))
}
