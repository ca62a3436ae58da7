//! Where a report is made before it takes its place: a folder that nobody can foresee, that is this process's alone, and that the
//! next run clears away if this one dies.
//!
//! `.hadar-XXXXXXXXXXXX/` holds `new/`, the report, and `lock`, which stays locked as long as the process lives, whatever its number
//! and wherever it runs. It is made exclusively and open to its owner alone, so that no link planted before is followed. Once `new/`
//! is complete and must be moved file by file, it is called `ready/`: then whoever finds it without its process finishes the work.

use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::time::Duration;
use tempfile::TempDir;

const PREFIX: &str = ".hadar-";
/// Random characters of the name.
const RANDOM: usize = 12;
const LOCK: &str = "lock";
const UNLOCKED: &str = "unlocked";
const NEW: &str = "new";
const READY: &str = "ready";
/// A folder without a lock that can be asked is left alone so long: its process may only just have made it.
const DEAD_AFTER: Duration = Duration::from_secs(24 * 3600);

/// A folder of this process.
#[derive(Debug)]
pub(super) struct Staging {
    // Given back first: not every system removes a file that is open.
    _lock: File,
    folder: TempDir,
}

impl Staging {
    /// A new one in `home`, which must be there.
    pub(super) fn in_folder(home: &Path) -> io::Result<Self> {
        let mut builder = tempfile::Builder::new();
        builder.prefix(PREFIX).rand_bytes(RANDOM);
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o700));
        let folder = builder.tempdir_in(home)?;
        // Under its own name only once it is locked: a lock that is free is one of the dead.
        let (unlocked, locked) = (folder.path().join(UNLOCKED), folder.path().join(LOCK));
        let lock = File::create_new(&unlocked)?;
        // Without locks the folder is known by its age.
        let _ = lock.try_lock();
        fs::rename(unlocked, locked)?;
        fs::create_dir(folder.path().join(NEW))?;
        Ok(Self { folder, _lock: lock })
    }

    /// Where the report is made.
    pub(super) fn new_report(&self) -> PathBuf {
        self.folder.path().join(NEW)
    }

    /// From now on the report is moved into its folder, by this process or by the next; where it is.
    pub(super) fn commit(&mut self) -> io::Result<PathBuf> {
        let ready = self.folder.path().join(READY);
        fs::rename(self.new_report(), &ready)?;
        self.folder.disable_cleanup(true);
        Ok(ready)
    }

    /// The work is done, or was undone.
    pub(super) fn done(&mut self) {
        self.folder.disable_cleanup(false);
    }
}

/// Staging folders in `home` whose processes are dead: those that were complete are handed to `finish`, all are removed.
/// What cannot be removed stays, as what may still be in use.
pub(super) fn clear(home: &Path, finish: &dyn Fn(&Path) -> io::Result<()>) -> io::Result<()> {
    let Ok(entries) = fs::read_dir(home) else { return Ok(()) };
    for folder in entries.filter_map(|entry| Some(entry.ok()?.path())).filter(|path| is_staging(path)) {
        let lock = folder.join(LOCK);
        if !lock.symlink_metadata().is_ok_and(|found| found.is_file()) {
            // Its process ended within the first instructions, and left nothing in it.
            if is_old(&folder) {
                let _ = fs::remove_file(folder.join(UNLOCKED));
                let _ = fs::remove_dir(&folder);
            }
            continue;
        }
        let Ok(lock) = File::options().read(true).write(true).open(lock) else { continue };
        let dead = match lock.try_lock() {
            Ok(()) => true,
            Err(TryLockError::WouldBlock) => false,
            Err(TryLockError::Error(_)) => is_old(&folder),
        };
        if dead {
            let ready = folder.join(READY);
            if ready.is_dir() {
                finish(&ready)?;
            }
            let _ = fs::remove_dir_all(&folder);
        }
    }
    Ok(())
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
