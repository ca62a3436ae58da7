//! Files of other kinds, by what they begin with: what each is, and what makes of it what is read, a cube or a table of a spectrum.

use hadar::error::{Error, Result};

/// A kind of file: what stands at a place in it, what it is, what makes a cube of it, and what a table of a spectrum; silent where
/// it is read as one.
struct Row {
    place: usize,
    bytes: &'static [u8],
    what: &'static str,
    cube: &'static str,
    spectrum: &'static str,
}

const fn row(bytes: &'static [u8], what: &'static str, cube: &'static str, spectrum: &'static str) -> Row {
    Row { place: 0, bytes, what, cube, spectrum }
}

const PICTURE: &str =
    "if it holds readings of 16 bits: np.save('cube.npy', np.asarray(PIL.Image.open('it.png')))";
const CURVE: &str = "write its curve as a table of wavelength_um,emissivity";
const DATASET: &str =
    "write the spectrum out as a table of wavelength_um,emissivity, as xarray's to_dataframe().to_csv() does";
const UNPACK: &str = "unpack it first";
const VIDEO: &str = "a film has no readings: take the radiometric sequence of the camera (SEQ, HCC, TIFF)";
const NO_SPECTRUM: &str = "give the table of a spectrum";
const AS_ARRAY: &str = "np.save('cube.npy', a) of the array that it holds";
const PICKLE: &str = "np.save('cube.npy', np.asarray(pickle.load(open('it.pkl', 'rb'))))";
const EXPORT: &str = "export it as a 16-bit TIFF or as MATLAB";

const KINDS: &[Row] = &[
    row(b"\x89PNG", "a PNG picture", PICTURE, CURVE),
    row(b"GIF8", "a GIF picture", PICTURE, CURVE),
    row(b"BM", "a BMP picture", PICTURE, CURVE),
    row(b"\xff\xd8\xff", "a JPEG picture", "", CURVE),
    row(
        b"SIMPLE  =",
        "a FITS file",
        "",
        "write its table out: astropy.table.Table.read('it.fits').write('x.csv')",
    ),
    row(b"II*\0", "a TIFF picture", "", CURVE),
    row(b"MM\0*", "a TIFF picture", "", CURVE),
    row(b"II+\0", "a TIFF picture", "", CURVE),
    row(b"\x89HDF\r\n\x1a\n", "an HDF5, NetCDF-4 or MATLAB 7.3 file", "", DATASET),
    row(b"CDF\x01", "a NetCDF file", "", DATASET),
    row(b"CDF\x02", "a NetCDF file", "", DATASET),
    row(b"CDF\x05", "a NetCDF file", "", DATASET),
    row(
        b"MATLAB 5.0 MAT-file",
        "a MATLAB file",
        "",
        "write it out in MATLAB: writematrix([wavelength_um, emissivity], 'x.csv')",
    ),
    row(
        b"\x93NUMPY",
        "a NumPy array",
        "",
        "write it out: np.savetxt('x.csv', np.load('it.npy'), delimiter=',')",
    ),
    row(b"\x0e\x03\x13\x01", "an HDF4 file", "turn it into HDF5: h4toh5convert it.hdf it.h5", DATASET),
    row(
        b"\xffIRB",
        "a file of InfraTec's cameras (IRB)",
        "export it from IRBIS as a table or as a 16-bit TIFF of temperatures",
        NO_SPECTRUM,
    ),
    row(b"CED", "a sequence of Cedip's or FLIR's cameras (PTW)", EXPORT, NO_SPECTRUM),
    row(b"AFF\0", "a sequence of FLIR's cameras of the older kind (AFF)", EXPORT, NO_SPECTRUM),
    row(
        b"FPF Public Image Format",
        "a file of FLIR's public format (FPF)",
        "write the radiometric JPEG or FFF of the same picture",
        NO_SPECTRUM,
    ),
    row(
        b"GRIB",
        "a GRIB file",
        "xarray.open_dataset('it.grib', engine='cfgrib').to_netcdf('it.nc')",
        DATASET,
    ),
    row(
        b"PAR1",
        "a Parquet file",
        "np.save('cube.npy', pandas.read_parquet('it.parquet').to_numpy())",
        "write it out: pandas.read_parquet('it.parquet').to_csv('x.csv', index=False)",
    ),
    row(
        b"ARROW1",
        "an Arrow file",
        "np.save('cube.npy', pandas.read_feather('it.arrow').to_numpy())",
        "write it out: pandas.read_feather('it.arrow').to_csv('x.csv', index=False)",
    ),
    row(b"\x80\x04", "a pickle of Python", PICKLE, NO_SPECTRUM),
    row(b"\x80\x05", "a pickle of Python", PICKLE, NO_SPECTRUM),
    row(b"SQLite format 3\0", "an SQLite database", AS_ARRAY, "write the spectrum out as a table"),
    row(b"%PDF", "a PDF document", "take the file of measurements itself", "copy its numbers into a table"),
    row(
        b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1",
        "an Excel workbook (.xls) or a JASCO file",
        "save its table as CSV",
        "save it there as CSV or JCAMP-DX",
    ),
    row(
        b"Spectral Data File",
        "an OMNIC spectrum (.spa)",
        AS_ARRAY,
        "save it in OMNIC as JCAMP-DX, SPC or CSV",
    ),
    row(b"PEPE", "a PerkinElmer spectrum (.sp)", AS_ARRAY, "save it there as JCAMP-DX or ASCII"),
    row(b"WDF1", "a Renishaw file (.wdf)", AS_ARRAY, "save it there as SPC or text"),
    row(
        b"\0\x05\x16\x07",
        A_FORK,
        "name the file beside it, whose name has no `._`; this one may be deleted",
        "name the file beside it, whose name has no `._`; this one may be deleted",
    ),
    row(b"\0\x05\x16\0", A_FORK, "copy the file itself from the Mac", "copy the file itself from the Mac"),
    row(
        b"\x1f\x8b",
        "a file packed with gzip",
        "unpack it first: gunzip it.gz",
        "unpack it first: gunzip it.gz",
    ),
    row(b"BZh", "a file packed with bzip2", UNPACK, UNPACK),
    row(b"\xfd7zXZ\0", "a file packed with xz", UNPACK, UNPACK),
    row(b"\x28\xb5\x2f\xfd", "a file packed with zstd", UNPACK, UNPACK),
    row(b"7z\xbc\xaf\x27\x1c", "a 7z archive", UNPACK, UNPACK),
    row(b"Rar!", "a RAR archive", UNPACK, UNPACK),
    Row { place: 257, bytes: b"ustar", what: "a tar archive", cube: UNPACK, spectrum: UNPACK },
    row(b"RIFF", "a film (AVI)", VIDEO, NO_SPECTRUM),
    Row { place: 4, bytes: b"ftyp", what: "a film (MP4)", cube: VIDEO, spectrum: NO_SPECTRUM },
    row(b"\x1aE\xdf\xa3", "a film (Matroska)", VIDEO, NO_SPECTRUM),
    row(b"\x30\x26\xb2\x75\x8e\x66\xcf\x11", "a film (WMV)", VIDEO, NO_SPECTRUM),
];

/// What macOS keeps beside files on disks of others.
pub(crate) const A_FORK: &str = "what macOS keeps beside a file on foreign disks, not the file itself";
/// How archives begin, of which spreadsheets and NumPy's are some.
const ZIP: &[u8] = b"PK\x03\x04";
/// So many letters may be those of a word.
const LETTERS: usize = 5;
/// Bytes that are looked at.
const LOOKED_AT: usize = 4096;

fn kind(start: &[u8]) -> Option<&'static Row> {
    KINDS.iter().find(|row| start.get(row.place..).is_some_and(|rest| rest.starts_with(row.bytes)))
}

/// Whether bytes are what macOS keeps beside a file.
pub(crate) fn is_fork(bytes: &[u8]) -> bool {
    kind(bytes).is_some_and(|row| row.what == A_FORK)
}

/// What a file is that is no cube, and what makes one of it; none of a kind that is not known.
pub(crate) fn no_cube(start: &[u8]) -> Option<Error> {
    let row = kind(start).filter(|row| !row.cube.is_empty())?;
    Some(Error::malformed(format!("this is {}, which is not read", row.what), row.cube))
}

/// Refuses what is known to be something else.
///
/// # Errors
/// A file of another kind, with its name and how a table is made of it.
pub(crate) fn refuse(bytes: &[u8]) -> Result<()> {
    // A few letters may begin a table, too; what they are the mark of has bytes that no text has.
    let is_text = |byte: &u8| matches!(byte, b'\t' | b'\n' | b'\r' | 0x20..0x7f);
    let looks_so = bytes.get(..LOOKED_AT).unwrap_or(bytes).iter().all(is_text);
    let (what, instead) = match kind(bytes).filter(|row| row.bytes.len() > LETTERS || !looks_so) {
        Some(row) => (row.what, row.spectrum),
        None if bytes.starts_with(ZIP) => zip(bytes),
        None => return Ok(()),
    };
    Err(Error::malformed(format!("this is {what}"), instead))
}

/// Refuses bytes that are no text.
///
/// # Errors
/// A byte of 0, which no text has but UTF-16 with its mark.
pub(crate) fn refuse_binary(bytes: &[u8]) -> Result<()> {
    let is_utf_16 = bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]);
    match bytes.get(..LOOKED_AT).unwrap_or(bytes).contains(&0) && !is_utf_16 {
        true => Err(Error::malformed(
            "this is a binary file of no kind that is known here (or text in UTF-16 without its mark)",
            "save the spectrum as JCAMP-DX, SPC or CSV",
        )),
        false => Ok(()),
    }
}

/// What an archive is, by the names in it.
fn zip(bytes: &[u8]) -> (&'static str, &'static str) {
    let start = bytes.get(..LOOKED_AT).unwrap_or(bytes);
    let has = |name: &[u8]| start.windows(name.len()).any(|part| part == name);
    if has(b"[Content_Types].xml") || has(b"xl/") {
        ("an Excel workbook (.xlsx)", "save the sheet as `CSV UTF-8`")
    } else if has(b"mimetypeapplication/vnd.oasis") {
        ("an OpenDocument spreadsheet", "save the sheet as CSV")
    } else if has(b".npy") {
        (
            "an archive of NumPy arrays",
            "write one out: numpy.savetxt(\"x.csv\", numpy.load(FILE)[NAME], delimiter=\",\")",
        )
    } else {
        ("a ZIP archive", "unpack it, and give the folder to --library")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn other_kinds_are_named() {
        for (bytes, what) in [
            (&b"SIMPLE  =                    T"[..], "a FITS file"),
            (b"MM\0*\0\0\0\x08", "TIFF"),
            (b"PK\x03\x04\x14\0\x06\0[Content_Types].xml", "an Excel workbook (.xlsx)"),
            (b"PK\x03\x04\x14\0\0\0emissivity.npy\x93NUMPY", "NumPy"),
            (b"PK\x03\x04abc", "a ZIP archive"),
            (b"\0\x05\x16\x07\0\x02\0\0Mac OS X", "macOS"),
        ] {
            let message = refuse(bytes).unwrap_err().to_string();
            assert!(message.contains(what) && message.contains("; "), "{message}");
        }
        assert!(refuse(b"wavelength_um,emissivity\n8,0.9\n").is_ok() && refuse(b"").is_ok());
        assert!(refuse(b"BM 7 red,emissivity\n8,0.9\n").is_ok() && refuse(b"BM\0\0").is_err());
        assert!(refuse_binary(b"a\0b").is_err() && refuse_binary(&[0xff, 0xfe, b'a', 0]).is_ok());
    }
}
