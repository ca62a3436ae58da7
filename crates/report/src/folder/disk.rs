//! The calls that publishing a report makes to the file system, one a function. Tests count them and end the process before any of them
//! (`tests/calls.rs`); the product only passes them on.

use std::fs::{self, DirEntry, File, TryLockError};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

#[cfg(test)]
pub(super) use super::tests::calls::call;

/// A place where a process can be ended.
#[cfg(not(test))]
pub(super) const fn call() -> io::Result<()> {
    Ok(())
}

/// Makes a folder of a name that starts so and goes on with random characters, open to its owner alone. No file that is there is taken.
pub(super) fn private_folder(home: &Path, prefix: &str, random: usize) -> io::Result<PathBuf> {
    call()?;
    let mut builder = tempfile::Builder::new();
    builder.prefix(prefix).rand_bytes(random);
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o700));
    builder.tempdir_in(home).map(tempfile::TempDir::keep)
}

/// Whether a folder is this user's and open to nobody else, as [`private_folder`] makes it.
pub(super) fn is_private(folder: &Path) -> bool {
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt as _;
        let own = rustix::process::geteuid().as_raw();
        let is_own =
            |found: fs::Metadata| found.is_dir() && found.uid() == own && found.mode() & 0o777 == 0o700;
        folder.symlink_metadata().is_ok_and(is_own)
    }
    #[cfg(not(unix))]
    {
        folder.is_dir()
    }
}

pub(super) fn create_dir(path: &Path) -> io::Result<()> {
    call()?;
    fs::create_dir(path)
}

/// Makes a folder and those above it that are missing.
pub(super) fn create_dir_all(path: &Path) -> io::Result<()> {
    let missing: Vec<&Path> = path.ancestors().take_while(|part| !part.is_dir()).collect();
    missing.into_iter().rev().try_for_each(|part| {
        call()?;
        fs::create_dir_all(part)
    })
}

pub(super) fn create_new(path: &Path) -> io::Result<File> {
    call()?;
    File::create_new(path)
}

/// Opens a file to ask for its lock. `None` if there is no ordinary file of this name.
pub(super) fn open_lock(path: &Path) -> io::Result<Option<File>> {
    call()?;
    if !path.symlink_metadata().is_ok_and(|found| found.is_file()) {
        return Ok(None);
    }
    File::options().read(true).write(true).open(path).map(Some)
}

pub(super) fn try_lock(file: &File) -> Result<(), TryLockError> {
    call().map_err(TryLockError::Error)?;
    file.try_lock()
}

/// What is in a folder, by name: nothing depends on the order of the disk.
pub(super) fn entries(folder: &Path) -> io::Result<Vec<DirEntry>> {
    call()?;
    let mut entries = fs::read_dir(folder)?.collect::<io::Result<Vec<_>>>()?;
    entries.sort_by_key(DirEntry::file_name);
    Ok(entries)
}

pub(super) fn rename(from: &Path, to: &Path) -> io::Result<()> {
    call()?;
    fs::rename(from, to)
}

pub(super) fn remove_file(path: &Path) -> io::Result<()> {
    call()?;
    fs::remove_file(path)
}

/// Removes an empty folder.
pub(super) fn remove_dir(path: &Path) -> io::Result<()> {
    call()?;
    fs::remove_dir(path)
}

/// Removes a folder with what is in it, in no particular order. No link is followed.
pub(super) fn remove_dir_all(path: &Path) -> io::Result<()> {
    // The library makes a call for each thing in it.
    #[cfg(test)]
    super::tests::calls::emptied(path)?;
    call()?;
    fs::remove_dir_all(path)
}

pub(super) fn write(path: &Path, bytes: &[u8]) -> io::Result<()> {
    call()?;
    let mut file = File::create(path)?;
    call()?;
    file.write_all(bytes)
}

/// A second name for a file, or a copy where the file system has none.
pub(super) fn link_or_copy(from: &Path, to: &Path) -> io::Result<()> {
    call()?;
    fs::hard_link(from, to).or_else(|_| fs::copy(from, to).map(drop))
}

/// Gives a folder the permissions of another one.
#[cfg(any(target_vendor = "apple", target_os = "linux", target_os = "android"))]
fn set_permissions_of(from: &Path, to: &Path) -> io::Result<()> {
    call()?;
    fs::set_permissions(to, from.metadata()?.permissions())
}

/// Puts a new folder in the place of an old one with its permissions, and the old one in the place of the new one, in one step.
#[cfg(any(target_vendor = "apple", target_os = "linux", target_os = "android"))]
pub(super) fn exchange(new: &Path, old: &Path) -> io::Result<()> {
    use rustix::fs::{CWD, RenameFlags, renameat_with};
    set_permissions_of(old, new)?;
    call()?;
    #[cfg(test)]
    super::tests::calls::exchange_is_possible()?;
    Ok(renameat_with(CWD, new, CWD, old, RenameFlags::EXCHANGE)?)
}

#[cfg(not(any(target_vendor = "apple", target_os = "linux", target_os = "android")))]
pub(super) fn exchange(_: &Path, _: &Path) -> io::Result<()> {
    Err(io::ErrorKind::Unsupported.into())
}
