//! Files of other kinds that are given as spectra: what they are, by their first bytes, and how to make a table of them.

use hadar::error::{Error, Result};

/// First bytes of files, what such a file is, and how its spectrum becomes a table.
const KINDS: &[(&[u8], &str, &str)] = &[
    (b"SIMPLE  =", "a FITS file", "write its table out: astropy.table.Table.read(FILE).write(\"x.csv\")"),
    (b"II*\0", "a TIFF or GeoTIFF image", AN_IMAGE),
    (b"MM\0*", "a TIFF or GeoTIFF image", AN_IMAGE),
    (b"II+\0", "a BigTIFF image", AN_IMAGE),
    (b"\x89HDF\r\n\x1a\n", "an HDF5, NetCDF-4 or MATLAB 7.3 file", A_DATASET),
    (b"CDF\x01", "a NetCDF file", A_DATASET),
    (b"CDF\x02", "a NetCDF file", A_DATASET),
    (b"CDF\x05", "a NetCDF file", A_DATASET),
    (b"\x0e\x03\x13\x01", "an HDF4 file", A_DATASET),
    (
        b"MATLAB 5.0 MAT-file",
        "a MATLAB file",
        "write it out in MATLAB: writematrix([wavelength_um, emissivity], \"x.csv\")",
    ),
    (
        b"\x93NUMPY",
        "a NumPy array",
        "write it out: numpy.savetxt(\"x.csv\", numpy.load(FILE), delimiter=\",\")",
    ),
    (b"PAR1", "a Parquet file", "write it out: pandas.read_parquet(FILE).to_csv(\"x.csv\", index=False)"),
    (b"%PDF", "a PDF document", "copy its numbers into a table"),
    (b"\x89PNG", "a PNG picture", A_PICTURE),
    (b"\xff\xd8\xff", "a JPEG picture", A_PICTURE),
    (b"GIF8", "a GIF picture", A_PICTURE),
    (b"\x1f\x8b", "compressed with gzip", "unpack it: gunzip FILE"),
    (b"7z\xbc\xaf\x27\x1c", "a 7z archive", "unpack it"),
    (b"SQLite format 3\0", "an SQLite database", "write the spectrum out as a table"),
    (
        b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1",
        "an Excel workbook (.xls) or a JASCO file",
        "save it there as CSV or JCAMP-DX",
    ),
    (b"Spectral Data File", "an OMNIC spectrum (.spa)", "save it in OMNIC as JCAMP-DX, SPC or CSV"),
    (b"PEPE", "a PerkinElmer spectrum (.sp)", "save it there as JCAMP-DX or ASCII"),
    (b"WDF1", "a Renishaw file (.wdf)", "save it there as SPC or text"),
    (b"\0\x05\x16\x07", A_FORK, "name the file beside it, whose name has no `._`; this one may be deleted"),
    (b"\0\x05\x16\0", A_FORK, "copy the file itself from the Mac"),
];
const AN_IMAGE: &str =
    "a cube is read as ENVI, NPY, MATLAB or HDF5; write its spectrum as a table of wavelength_um,emissivity";
const A_DATASET: &str = "write the spectrum out as a table of wavelength_um,emissivity, as with h5dump or xarray's to_dataframe().to_csv()";
const A_PICTURE: &str = "write its curve as a table of wavelength_um,emissivity";
pub(super) const A_FORK: &str = "what macOS keeps beside a file on foreign disks, not the file itself";
/// How archives begin, of which spreadsheets and NumPy's are some.
const ZIP: &[u8] = b"PK\x03\x04";
/// Bytes that are looked at.
const LOOKED_AT: usize = 4096;

/// Whether bytes are what macOS keeps beside a file.
pub(super) fn is_fork(bytes: &[u8]) -> bool {
    bytes.starts_with(b"\0\x05\x16\x07")
}

/// Refuses what is known to be something else.
///
/// # Errors
/// A file of another kind, with its name and how a table is made of it.
pub(super) fn refuse(bytes: &[u8]) -> Result<()> {
    let known = KINDS.iter().find(|(magic, ..)| bytes.starts_with(magic));
    let (what, instead) = match known {
        Some(&(_, what, instead)) => (what, instead),
        None if bytes.starts_with(ZIP) => zip(bytes),
        None => return Ok(()),
    };
    Err(Error::malformed(format!("this is {what}"), instead))
}

/// Refuses bytes that are no text.
///
/// # Errors
/// A byte of 0, which no text has but UTF-16 with its mark.
pub(super) fn refuse_binary(bytes: &[u8]) -> Result<()> {
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
        assert!(refuse_binary(b"a\0b").is_err() && refuse_binary(&[0xff, 0xfe, b'a', 0]).is_ok());
    }
}
