//! A folder by its handle, and files in it by names that lead to no other place: no part of a way below it may be a link, whoever
//! put it there and whenever (`openat` with `O_NOFOLLOW`, part by part). Where a system has no such handles, parts are looked at before.

#[cfg(not(unix))]
use super::disk;
use super::disk::call;
use std::fs::File;
use std::io;
use std::path::{Component, Path};

#[cfg(unix)]
use rustix::fs::{AtFlags, CWD, Mode, OFlags, mkdirat, openat, renameat, unlinkat};

/// Whether a name is one of a file below the folder that it is told in.
pub(crate) fn is_within(name: &str) -> bool {
    let plain = |part: Component<'_>| matches!(part, Component::Normal(_));
    !name.is_empty() && Path::new(name).components().all(plain)
}

/// What was found: `None` where nothing of the name is, or nothing but a link or a folder. That the system could not look is neither.
///
/// # Errors
/// What the system says where it could not look.
pub(crate) fn if_there<T>(found: io::Result<T>) -> io::Result<Option<T>> {
    use io::ErrorKind::{InvalidFilename, InvalidInput, IsADirectory, NotADirectory, NotFound};
    match found {
        Ok(found) => Ok(Some(found)),
        Err(error)
            if [InvalidFilename, InvalidInput, IsADirectory, NotADirectory, NotFound]
                .contains(&error.kind()) =>
        {
            Ok(None)
        }
        Err(error) => Err(error),
    }
}

/// A folder.
#[derive(Debug)]
pub struct Inside {
    #[cfg(unix)]
    handle: std::os::fd::OwnedFd,
    #[cfg(not(unix))]
    path: std::path::PathBuf,
}

/// The folders on the way to a file, and its own name.
fn split(name: &str) -> io::Result<(Vec<&str>, &str)> {
    let parts = if is_within(name) {
        Path::new(name).iter().filter_map(|part| part.to_str()).collect()
    } else {
        Vec::new()
    };
    let mut parts: Vec<&str> = parts;
    let last = parts.pop().ok_or(io::ErrorKind::InvalidFilename)?;
    Ok((parts, last))
}

/// What was opened, if it is an ordinary file; a link was not followed.
#[cfg(unix)]
fn ordinary(opened: rustix::io::Result<std::os::fd::OwnedFd>) -> io::Result<File> {
    let file = match opened {
        Ok(opened) => File::from(opened),
        Err(rustix::io::Errno::LOOP) => return Err(io::ErrorKind::InvalidInput.into()),
        Err(error) => return Err(error.into()),
    };
    if file.metadata()?.is_file() { Ok(file) } else { Err(io::ErrorKind::InvalidInput.into()) }
}

#[cfg(unix)]
impl Inside {
    /// The folder of this path, whose own links are followed: it is the one that the user named.
    ///
    /// # Errors
    /// No folder of this name, or one that may not be opened.
    pub fn open(folder: &Path) -> io::Result<Self> {
        call()?;
        let handle = openat(CWD, folder, OFlags::DIRECTORY | OFlags::CLOEXEC, Mode::empty())?;
        Ok(Self { handle })
    }

    /// The folder that a file is in; with `make` it is there.
    fn above(&self, folders: &[&str], make: bool) -> io::Result<std::os::fd::OwnedFd> {
        let mut at = self.handle.try_clone()?;
        for folder in folders {
            if make {
                call()?;
                match mkdirat(&at, *folder, Mode::from_raw_mode(0o777)) {
                    Ok(()) | Err(rustix::io::Errno::EXIST) => {}
                    Err(error) => return Err(error.into()),
                }
            }
            let only_a_folder = OFlags::DIRECTORY | OFlags::NOFOLLOW | OFlags::CLOEXEC;
            at = openat(&at, *folder, only_a_folder, Mode::empty())?;
        }
        Ok(at)
    }

    /// Opens an ordinary file to be read; no link is followed, and a pipe that nobody writes is not waited for.
    ///
    /// # Errors
    /// No ordinary file of this name.
    pub fn file(&self, name: &str) -> io::Result<File> {
        call()?;
        let (folders, last) = split(name)?;
        let plain = OFlags::NOFOLLOW | OFlags::NONBLOCK | OFlags::CLOEXEC;
        ordinary(openat(&self.above(&folders, false)?, last, plain, Mode::empty()))
    }

    /// A folder in it, which is made if it is not there.
    ///
    /// # Errors
    /// A link or a file of this name.
    pub fn folder(&self, name: &str) -> io::Result<Self> {
        Ok(Self { handle: self.above(&[split(name)?.1], true)? })
    }

    /// Opens an ordinary file to be read and written at its end; it is made if it is not there.
    ///
    /// # Errors
    /// A link, a folder or a pipe of this name; a file that has another name elsewhere as well.
    pub fn appended(&self, name: &str) -> io::Result<File> {
        let (folders, last) = split(name)?;
        let flags = OFlags::RDWR | OFlags::CREATE | OFlags::APPEND;
        let plain = flags | OFlags::NOFOLLOW | OFlags::NONBLOCK | OFlags::CLOEXEC;
        let above = self.above(&folders, false)?;
        let file = ordinary(openat(&above, last, plain, Mode::from_raw_mode(0o666)))?;
        let names = std::os::unix::fs::MetadataExt::nlink(&file.metadata()?);
        if names == 1 { Ok(file) } else { Err(io::ErrorKind::InvalidInput.into()) }
    }

    /// Moves a file from elsewhere to a name, in whose place a file or link may be.
    pub(super) fn take(&self, from: &Path, name: &str) -> io::Result<()> {
        let (folders, last) = split(name)?;
        let above = self.above(&folders, true)?;
        call()?;
        Ok(renameat(CWD, from, above, last)?)
    }

    /// Removes a file.
    pub(super) fn remove(&self, name: &str) -> io::Result<()> {
        let (folders, last) = split(name)?;
        let above = self.above(&folders, false)?;
        call()?;
        Ok(unlinkat(above, last, AtFlags::empty())?)
    }
}

#[cfg(not(unix))]
impl Inside {
    pub fn open(folder: &Path) -> io::Result<Self> {
        call()?;
        Ok(Self { path: folder.canonicalize()? })
    }

    fn way(&self, name: &str) -> io::Result<std::path::PathBuf> {
        let (folders, last) = split(name)?;
        let mut path = self.path.clone();
        for folder in folders {
            path.push(folder);
            if path.symlink_metadata().is_ok_and(|found| !found.is_dir()) {
                return Err(io::ErrorKind::NotADirectory.into());
            }
        }
        Ok(path.join(last))
    }

    pub fn file(&self, name: &str) -> io::Result<File> {
        call()?;
        let path = self.way(name)?;
        if path.symlink_metadata()?.is_file() {
            File::open(path)
        } else {
            Err(io::ErrorKind::InvalidInput.into())
        }
    }

    pub fn folder(&self, name: &str) -> io::Result<Self> {
        let path = self.way(name)?;
        disk::create_dir_all(&path)?;
        if path.symlink_metadata()?.is_dir() {
            Ok(Self { path })
        } else {
            Err(io::ErrorKind::NotADirectory.into())
        }
    }

    pub fn appended(&self, name: &str) -> io::Result<File> {
        let path = self.way(name)?;
        if path.symlink_metadata().is_ok_and(|found| !found.is_file()) {
            return Err(io::ErrorKind::InvalidInput.into());
        }
        File::options().create(true).read(true).append(true).open(path)
    }

    pub(super) fn take(&self, from: &Path, name: &str) -> io::Result<()> {
        let path = self.way(name)?;
        path.parent().map_or(Ok(()), disk::create_dir_all)?;
        disk::rename(from, &path)
    }

    pub(super) fn remove(&self, name: &str) -> io::Result<()> {
        disk::remove_file(&self.way(name)?)
    }
}
