//! Cubes from files: which kind of file it is, by its first bytes.

use super::{Cube, READ_CUBE, mat, npy};
use crate::error::{Error, Result};
use crate::file;
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// What a file begins with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Npy,
    Mat5 { little_endian: bool },
    Mat73,
    Hdf5,
    Zip,
    Other,
}

impl Kind {
    fn of(start: &[u8]) -> Self {
        // Bytes 124 to 127 of a MATLAB file are its version, 0x0100 or 0x0200, and `MI` in the writer's order.
        match start.get(124..128) {
            _ if start.starts_with(npy::MAGIC) => Self::Npy,
            _ if start.starts_with(b"\x89HDF\r\n\x1a\n") => Self::Hdf5,
            _ if start.starts_with(b"PK\x03\x04") => Self::Zip,
            Some([0, 1, b'I', b'M']) => Self::Mat5 { little_endian: true },
            Some([1, 0, b'M', b'I']) => Self::Mat5 { little_endian: false },
            Some([0, 2, b'I', b'M'] | [2, 0, b'M', b'I']) => Self::Mat73,
            _ => Self::Other,
        }
    }
}

impl Cube {
    /// Opens an NPY file (NumPy's `np.save`; versions 1 to 3) or a MATLAB file (version 5: `save` with `-v6` or
    /// `-v7`) of samples `[row][column][band]` or, with one band, `[row][column]`. The file's first bytes tell which it
    /// is, not its name. `variable` names the array in a MATLAB file; it may be left out where only one array is
    /// three-dimensional, or only one is there.
    ///
    /// An NPY file is read by rows where they are asked for, in C order: `f4`, `f8` or whole numbers of either byte order,
    /// those of more than 16 bits as `f64` (above 2⁵³ rounded), the others as `f32`. An array
    /// of a MATLAB file is read whole; it takes its own size of memory and, until this returns, that of up to
    /// 16 bands more. Its doubles and integers of more than 16 bits become `f64` (integers above 2⁵³ are rounded),
    /// singles and smaller integers `f32`.
    ///
    /// The values themselves are not checked; see [`first_invalid`](super::first_invalid).
    ///
    /// # Errors
    /// No such file, one of another kind, one that is shorter or longer than its header says, samples of another
    /// type, a number of dimensions other than 2 or 3, a dimension of 0, no array or several to choose from.
    ///
    /// ```no_run
    /// use hadar::cube::Cube;
    /// let cube = Cube::open("street.npy".as_ref(), None)?;
    /// assert_eq!(cube.shape().bands(), 54);
    /// let cube = Cube::open("street.mat".as_ref(), Some("S"))?;
    /// # Ok::<(), hadar::Error>(())
    /// ```
    pub fn open(path: &Path, variable: Option<&str>) -> Result<Self> {
        let (file, start) = opened(path)?;
        match Kind::of(&start) {
            Kind::Npy => match variable {
                None => npy::open(file, path),
                Some(name) => Err(Error::malformed(
                    format!("a variable `{name}` is named, but an NPY file has one array without a name"),
                    "leave the name out",
                )),
            },
            Kind::Mat5 { little_endian } => mat::open(file, little_endian, variable),
            Kind::Mat73 | Kind::Hdf5 => Err(Error::malformed(
                "this is an HDF5 file, such as MATLAB writes with -v7.3",
                "write it with save('cube.mat', 'name', '-v7') or, from Python, with np.save('cube.npy', a)",
            )),
            Kind::Zip => Err(Error::malformed(
                "this is a ZIP archive, such as np.savez writes",
                "write the array alone with np.save('cube.npy', a)",
            )),
            Kind::Other => Err(unknown(path, &start)),
        }
        .map_err(|error| error.in_file(path))
    }
}

/// Whether a file begins as one that [`Cube::open`] has a word about, and not as text.
///
/// # Errors
/// No such file, or none that can be read.
pub(crate) fn is_cube(path: &Path) -> Result<bool> {
    let (_, start) = opened(path)?;
    Ok(Kind::of(&start) != Kind::Other)
}

fn opened(path: &Path) -> Result<(File, Vec<u8>)> {
    let file = file::open(path, READ_CUBE)?;
    let mut start = Vec::with_capacity(128);
    (&file).take(128).read_to_end(&mut start).map_err(|error| Error::file(READ_CUBE, path, error))?;
    Ok((file, start))
}

fn unknown(path: &Path, start: &[u8]) -> Error {
    let extension = path.extension().and_then(|end| end.to_str()).map(str::to_ascii_lowercase);
    let found = match extension.as_deref() {
        _ if start.is_empty() => "the file is empty",
        Some("npy") => "this is not an NPY file: it does not begin with \\x93NUMPY",
        Some("mat") => "this is not a MATLAB file of version 5",
        _ => "this is neither an NPY file nor a MATLAB file of version 5",
    };
    Error::malformed(
        found,
        "write one with np.save('cube.npy', a), or in MATLAB with save('cube.mat', 'name', '-v7')",
    )
}
