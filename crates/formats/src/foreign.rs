//! Files that are not read, by what they begin with: what each is, and what makes one of it that is read.

/// A kind of file: what stands at a place in it, what it is, and what to do.
struct Row(usize, &'static [u8], &'static str, &'static str);

const LOAD_PICTURE: &str =
    "if it holds readings of 16 bits: np.save('cube.npy', np.asarray(PIL.Image.open('it.png')))";
const UNPACK: &str = "unpack it first";
const VIDEO: &str = "a film has no readings: take the radiometric sequence of the camera (SEQ, HCC, TIFF)";

const KINDS: &[Row] = &[
    Row(0, b"\x89PNG", "a PNG picture", LOAD_PICTURE),
    Row(0, b"GIF8", "a GIF picture", LOAD_PICTURE),
    Row(0, b"BM", "a BMP picture", LOAD_PICTURE),
    Row(
        0,
        b"\xffIRB",
        "a file of InfraTec's cameras (IRB)",
        "export it from IRBIS as a table or as a 16-bit TIFF of temperatures",
    ),
    Row(
        0,
        b"CED",
        "a sequence of Cedip's or FLIR's cameras (PTW)",
        "export it from Altair or ResearchIR as TIFF or MATLAB",
    ),
    Row(
        0,
        b"AFF\0",
        "a sequence of FLIR's cameras of the older kind (AFF)",
        "export it from ResearchIR as SEQ, TIFF or MATLAB",
    ),
    Row(
        0,
        b"FPF Public Image Format",
        "a file of FLIR's public format (FPF)",
        "write the radiometric JPEG or FFF of the same picture",
    ),
    Row(0, b"\x0e\x03\x13\x01", "an HDF4 file", "turn it into HDF5: h4toh5convert it.hdf it.h5"),
    Row(0, b"GRIB", "a GRIB file", "xarray.open_dataset('it.grib', engine='cfgrib').to_netcdf('it.nc')"),
    Row(0, b"PAR1", "a Parquet file", "np.save('cube.npy', pandas.read_parquet('it.parquet').to_numpy())"),
    Row(0, b"ARROW1", "an Arrow file", "np.save('cube.npy', pandas.read_feather('it.arrow').to_numpy())"),
    Row(
        0,
        b"\x80\x04",
        "a pickle of Python",
        "np.save('cube.npy', np.asarray(pickle.load(open('it.pkl', 'rb'))))",
    ),
    Row(
        0,
        b"\x80\x05",
        "a pickle of Python",
        "np.save('cube.npy', np.asarray(pickle.load(open('it.pkl', 'rb'))))",
    ),
    Row(0, b"SQLite format 3\0", "an SQLite database", "np.save('cube.npy', a) of the array that it holds"),
    Row(0, b"%PDF", "a PDF document", "take the file of measurements itself"),
    Row(0, b"\xd0\xcf\x11\xe0", "a file of an older Office program", "save its table as CSV"),
    Row(0, b"\x1f\x8b", "a file packed with gzip", "unpack it first: gunzip it.gz"),
    Row(0, b"BZh", "a file packed with bzip2", UNPACK),
    Row(0, b"\xfd7zXZ\0", "a file packed with xz", UNPACK),
    Row(0, b"\x28\xb5\x2f\xfd", "a file packed with zstd", UNPACK),
    Row(0, b"7z\xbc\xaf\x27\x1c", "a 7z archive", UNPACK),
    Row(0, b"Rar!", "a RAR archive", UNPACK),
    Row(257, b"ustar", "a tar archive", UNPACK),
    Row(0, b"RIFF", "a film (AVI)", VIDEO),
    Row(4, b"ftyp", "a film (MP4)", VIDEO),
    Row(0, b"\x1aE\xdf\xa3", "a film (Matroska)", VIDEO),
    Row(0, b"\x30\x26\xb2\x75\x8e\x66\xcf\x11", "a film (WMV)", VIDEO),
];

/// What a file is that begins so, and what to do; none of a kind that is not known.
pub(crate) fn kind(start: &[u8]) -> Option<(&'static str, &'static str)> {
    let begins =
        |Row(place, bytes, ..): &&Row| start.get(*place..).is_some_and(|rest| rest.starts_with(bytes));
    KINDS.iter().find(begins).map(|Row(_, _, what, instead)| (*what, *instead))
}
