//! Cubes from files: which kind of file it is, by its first bytes.

use super::axes::Axes;
use super::found::{Found, Opened};
#[cfg(feature = "tiff")]
use super::geotiff;
#[cfg(feature = "hdf5")]
use super::hdf5;
use super::names::is_zarr;
#[cfg(feature = "zarr")]
use super::zarr;
use super::{READ_CUBE, envi, fits, flir, mat, netcdf3, npy, npz, telops};
use crate::envi_header;
use crate::file;
use crate::foreign;
use hadar::cube::Cube;
use hadar::error::{Error, Result};
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// What a file begins with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Npy,
    Mat5 {
        little_endian: bool,
    },
    /// Version 7.3 of MATLAB is one too, behind a header of its own.
    Hdf5,
    Zip,
    NetCdf3,
    Fits,
    Tiff,
    FlirJpeg,
    FlirBlock,
    Telops,
    EnviHeader,
    Other,
}

/// Places at which an HDF5 file may begin, behind what another program has put before it.
const HDF5_PLACES: [usize; 2] = [0, 512];
/// TIFF files, of either order of bytes and either size of places.
const TIFF: [&[u8]; 4] = [b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"];
/// Bytes that are looked at.
const START: u64 = 520;

impl Kind {
    fn of(start: &[u8]) -> Self {
        let hdf5 =
            |place: &usize| start.get(*place..).is_some_and(|rest| rest.starts_with(b"\x89HDF\r\n\x1a\n"));
        // Bytes 124 to 127 of a MATLAB file are its version, 0x0100 or 0x0200, and `MI` in the writer's order.
        match start.get(124..128) {
            _ if start.starts_with(npy::MAGIC) => Self::Npy,
            _ if start.starts_with(b"PK\x03\x04") => Self::Zip,
            _ if HDF5_PLACES.iter().any(hdf5) => Self::Hdf5,
            Some([0, 1, b'I', b'M']) => Self::Mat5 { little_endian: true },
            Some([1, 0, b'M', b'I']) => Self::Mat5 { little_endian: false },
            _ if start.starts_with(netcdf3::MAGIC) => Self::NetCdf3,
            _ if start.starts_with(fits::MAGIC) => Self::Fits,
            _ if TIFF.iter().any(|magic| start.starts_with(magic)) => Self::Tiff,
            _ if start.starts_with(flir::JPEG) => Self::FlirJpeg,
            _ if start.starts_with(flir::BLOCK) => Self::FlirBlock,
            _ if telops::is_one(start) => Self::Telops,
            _ if start.starts_with(b"ENVI") => Self::EnviHeader,
            _ => Self::Other,
        }
    }
}

/// Opens the cube of a file, its array `[row][column][band]`; see [`open_as`].
///
/// # Errors
/// As [`open_as`].
///
/// ```no_run
/// use hadar_formats::cube;
/// let cube = cube::open("street.npy".as_ref(), None)?;
/// assert_eq!(cube.shape().bands(), 54);
/// let cube = cube::open("street.mat".as_ref(), Some("S"))?;
/// # Ok::<(), hadar::Error>(())
/// ```
pub fn open(path: &Path, variable: Option<&str>) -> Result<Cube> {
    open_as(path, variable, None).map(|opened| opened.cube)
}

/// Opens the cube of a file and says what it was read as. The file's first bytes tell its kind, not its name:
///
/// * NPY (versions 1 to 3, either order) and NPZ of NumPy;
/// * ENVI (BSQ, BIL, BIP), by its header or by the data beside one: numbers to be ignored become NaN, gains and offsets
///   are applied, the bands' wavelengths and the list of bad ones are read;
/// * FITS, the image of the file or an extension: `BSCALE`, `BZERO`, `BLANK`, `BUNIT` and a linear spectral axis are read;
/// * NetCDF of the classic kinds and Zarr of versions 2 and 3, with the attributes of NetCDF;
/// * TIFF and GeoTIFF: samples of a page, or pages, are bands;
/// * radiometric JPEG, FFF and SEQ of FLIR (`variable` is `signal` or `temperature`), HCC of Telops: one frame is one band;
/// * MATLAB of version 5 (`save` with `-v6` or `-v7`); in NPZ and MATLAB a list `wavelengths_um`, `wavenumbers_cm1` or in another
///   unit, of as many numbers as there are bands, says where they are;
/// * with the feature `hdf5`, HDF5, NetCDF-4 and MATLAB of version 7.3: `_FillValue`, `scale_factor` and `add_offset` are
///   applied.
///
/// `variable` names the array in a file of several; it may be left out where only one is three-dimensional, or only one is
/// there. `axes` says which of its dimensions is which; silent, they are rows, columns and, where there is a third, bands.
///
/// Samples are whole or floating-point numbers of either order of bytes: those of more than 32 bits and whole ones of
/// more than 16 become `f64` (above 2⁵³ rounded), the others `f32`. What is not packed is read by rows where they are asked
/// for; what is packed, and arrays of MATLAB files, take their own size of memory ([`Found::memory_bytes`]).
///
/// The values themselves are not checked; see [`first_invalid`](hadar::cube::first_invalid).
///
/// # Errors
/// No such file, one of another kind (it is named if it is known), one that is shorter or longer than its header says, samples of another
/// type, a number of dimensions other than 2 or 3, a dimension of 0, no array or several to choose from.
pub fn open_as(path: &Path, variable: Option<&str>, axes: Option<Axes>) -> Result<Opened> {
    let name = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    if is_zarr(path) {
        #[cfg(feature = "zarr")]
        let opened = zarr::open(path, variable, axes);
        #[cfg(not(feature = "zarr"))]
        let opened = Err::<Opened, _>(Error::malformed(
            "this is a Zarr array",
            "build with the feature zarr, or write it with np.save('cube.npy', zarr.open('cube.zarr')[:])",
        ));
        let opened = opened.map_err(|error| error.in_file(path))?;
        return Ok(Opened { found: Found { file: name, ..opened.found }, ..opened });
    }
    let (file, start) = opened(path)?;
    let kind = Kind::of(&start);
    let alone = |what: &str| match variable {
        None => Ok(()),
        Some(name) => Err(Error::malformed(
            format!("a variable `{name}` is named, but {what} has one array without a name"),
            "leave the name out",
        )),
    };
    let opened = match kind {
        Kind::Npy => alone("an NPY file").and_then(|()| {
            let len = file.metadata().map_err(|error| Error::file(READ_CUBE, path, error))?.len();
            npy::open(file, path, (0, len), axes, "NPY")
        }),
        Kind::Zip => npz::open(file, path, variable, axes),
        Kind::Mat5 { little_endian } => mat::open(file, little_endian, variable, axes),
        #[cfg(feature = "hdf5")]
        Kind::Hdf5 => hdf5::open(file, path, variable, axes),
        #[cfg(not(feature = "hdf5"))]
        Kind::Hdf5 => Err(Error::malformed(
            "this is an HDF5 file, such as MATLAB writes with -v7.3",
            "build with the feature hdf5, or write it with save('cube.mat', 'name', '-v7') or np.save('cube.npy', a)",
        )),
        Kind::NetCdf3 => netcdf3::open(file, path, variable, axes),
        Kind::Fits => fits::open(file, path, variable, axes),
        #[cfg(feature = "tiff")]
        Kind::Tiff => geotiff::open(file, variable, axes),
        #[cfg(not(feature = "tiff"))]
        Kind::Tiff => Err(Error::malformed(
            "this is a TIFF file",
            "build with the feature tiff, or write it with np.save('cube.npy', tifffile.imread('cube.tif'))",
        )),
        Kind::FlirJpeg => flir::open_jpeg(file, path, variable, axes),
        Kind::FlirBlock => flir::open(file, path, variable, axes),
        Kind::Telops => telops::open(file, path, variable, axes),
        Kind::EnviHeader => alone("an ENVI file").and_then(|()| {
            let data = envi_header::data_of(path)?;
            envi::open(file::open(&data, READ_CUBE)?, &data, path, axes)
        }),
        Kind::Other => match envi_header::header_of(path) {
            Some(header) => alone("an ENVI file").and_then(|()| envi::open(file, path, &header, axes)),
            None => Err(unknown(path, &start)),
        },
    }
    .map_err(|error| error.in_file(path))?;
    Ok(Opened { found: Found { file: name, ..opened.found }, ..opened })
}

/// Whether a file begins as one that [`open`] has a word about, and not as text.
///
/// # Errors
/// No such file, or none that can be read.
pub(crate) fn is_cube(path: &Path) -> Result<bool> {
    let (_, start) = opened(path)?;
    Ok(Kind::of(&start) != Kind::Other)
}

fn opened(path: &Path) -> Result<(File, Vec<u8>)> {
    let file = file::open(path, READ_CUBE)?;
    let mut start = Vec::with_capacity(START as usize);
    (&file).take(START).read_to_end(&mut start).map_err(|error| Error::file(READ_CUBE, path, error))?;
    Ok((file, start))
}

fn unknown(path: &Path, start: &[u8]) -> Error {
    const WRITE: &str =
        "write one with np.save('cube.npy', a), or in MATLAB with save('cube.mat', 'name', '-v7')";
    if let Some(error) = foreign::no_cube(start) {
        return error;
    }
    let extension = path.extension().and_then(|end| end.to_str()).map(str::to_ascii_lowercase);
    // A table of text: letters, numbers and what stands between them.
    let is_text =
        !start.is_empty() && start.iter().all(|byte| matches!(byte, b'\t' | b'\n' | b'\r' | 0x20..0x7f));
    let found = match extension.as_deref() {
        _ if start.is_empty() => "the file is empty",
        Some("npy") => "this is not an NPY file: it does not begin with \\x93NUMPY",
        Some("mat") => "this is not a MATLAB file of version 5 or 7.3",
        Some("hdr") => "this is not an ENVI header: its first line is not ENVI",
        Some("img" | "dat" | "bsq" | "bil" | "bip" | "raw" | "sc") => {
            "there is no ENVI header beside this file, of the same name with .hdr"
        }
        _ if is_text => {
            let instead = "write its numbers as an array: np.save('cube.npy', np.loadtxt('it.csv', delimiter=',', skiprows=1))";
            return Error::malformed("this is text, not an array of a cube", instead);
        }
        _ => {
            "this is none of the files a cube is read from: NPY, NPZ, ENVI, MATLAB, HDF5, NetCDF, Zarr, FITS, TIFF, \
             radiometric JPEG, SEQ and FFF of FLIR, HCC of Telops"
        }
    };
    Error::malformed(found, WRITE)
}
