//! What cubes are called, and those of a folder.

use crate::envi_header;
use hadar::error::{Error, Result};
use std::path::{Path, PathBuf};

/// Whether a folder is a Zarr array or a group of them.
#[must_use]
pub fn is_zarr(path: &Path) -> bool {
    path.is_dir() && [".zarray", ".zgroup", "zarr.json"].iter().any(|name| path.join(name).is_file())
}

/// Endings of files that hold a cube and nothing else.
pub const ENDINGS: [&str; 26] = [
    "npy", "npz", "mat", "hdr", "img", "dat", "bsq", "bil", "bip", "h5", "hdf5", "nc", "nc4", "cdf", "zarr",
    "fits", "fit", "fts", "tif", "tiff", "jpg", "jpeg", "fff", "seq", "csq", "hcc",
];

/// Whether a path names a cube by its ending.
#[must_use]
pub fn is_called_so(path: &Path) -> bool {
    let end = path.extension().and_then(|end| end.to_str()).map(str::to_ascii_lowercase);
    end.is_some_and(|end| ENDINGS.contains(&end.as_str()))
}

/// The cubes of a folder by the endings of their names, in the order of these; data beside an ENVI header are those of the header.
///
/// # Errors
/// A folder that cannot be read.
pub fn cubes_in(folder: &Path) -> Result<Vec<PathBuf>> {
    let failed = |error: std::io::Error| Error::file("read the cubes of a folder", folder, error);
    let mut cubes = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        let hidden = path.file_name().is_none_or(|name| name.to_string_lossy().starts_with('.'));
        // Of several files of one stem only that is left out which the header is of.
        let header = envi_header::header_of(&path).filter(|header| *header != path);
        let is_data =
            header.is_some_and(|header| envi_header::data_of(&header).is_ok_and(|data| data == path));
        if !hidden && is_called_so(&path) && !is_data && (path.is_file() || is_zarr(&path)) {
            cubes.push(path);
        }
    }
    cubes.sort();
    Ok(cubes)
}
