//! The files of spectra in a folder.

use crate::foreign;
use hadar::error::{Error, Result};
use hadar::inputs;
use hadar::material::is_spectra;
use std::io::Read;
use std::path::{Path, PathBuf};

/// What a folder has.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Folder {
    /// Files that are called as spectra are ([`is_spectra`]), in the order of their names.
    pub files: Vec<PathBuf>,
    /// Why others that are called so are none: what macOS keeps beside a file (`._paint.csv`).
    pub passed_over: Vec<Error>,
}

/// The files of a folder that are called as spectra are.
///
/// # Errors
/// A folder that cannot be read.
pub fn spectra_in(directory: &Path) -> Result<Folder> {
    let failed = |error: std::io::Error| match error.kind() {
        std::io::ErrorKind::NotFound => {
            Error::file("read the library", directory, "there is no such directory; check the name")
        }
        _ => Error::file("read the library", directory, error),
    };
    inputs::folder(directory);
    let mut files = Vec::new();
    for entry in std::fs::read_dir(directory).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        let name = path.file_name().map(|name| name.to_string_lossy().into_owned());
        // A link to nothing is no folder: it is not passed over in silence.
        let is_folder = || path.metadata().is_ok_and(|found| found.is_dir());
        if name.is_some_and(|name| is_spectra(&name)) && !is_folder() {
            files.push(path);
        }
    }
    files.sort();
    let (forks, files): (Vec<PathBuf>, Vec<PathBuf>) = files.into_iter().partition(|file| is_fork(file));
    let why = |file: &PathBuf| {
        Error::malformed(format!("this is {}", foreign::A_FORK), "it may be deleted").in_file(file)
    };
    Ok(Folder { passed_over: forks.iter().map(why).collect(), files })
}

/// Whether a file is what macOS keeps beside another: called `._` and that by its first bytes.
fn is_fork(file: &Path) -> bool {
    let is_named = file.file_name().is_some_and(|name| name.to_string_lossy().starts_with("._"));
    // Only an ordinary file: a pipe would be waited for.
    if !is_named || !file.is_file() {
        return false;
    }
    let mut start = [0; 8];
    std::fs::File::open(file).is_ok_and(|mut file| file.read_exact(&mut start).is_ok())
        && foreign::is_fork(&start)
}
