//! Reading spectra from files; the format is told from the content.
//!
//! 1. A table of an axis and the emissivity or reflectance of an opaque surface, e = 1 − R (Kirchhoff), in any customary
//!    layout: units and percent are told from the header, the sign between columns and the decimal sign from the lines.
//! 2. A table with more columns, each the emissivity (or what its header says) of the material it is named after.
//! 3. A table with the columns `n` and `k` behind the axis: optical constants of a half-space.
//! 4. ECOSTRESS or ASTER spectral library text: wavelength in µm, reflectance in percent.
//! 5. JCAMP-DX (`.jdx`, `.dx`) and ENVI spectral libraries (`.sli` with `.hdr`).
//!
//! Rows may be in any order; `#` begins a comment line; a byte-order mark, any end of line and extra blanks do no harm. Bytes that
//! are not UTF-8 (or UTF-16 with its mark) are read as Latin-1. What is ambiguous is asked for: the message has the header to
//! write.

mod columns;
mod content;
mod ecostress;
mod envi;
mod header;
mod holes;
mod jcamp;
mod layout;
mod names;

use self::content::Content;
pub(crate) use self::content::stem;
pub(crate) use self::names::{Origin, differing, qualified};
pub use self::names::{tagged_name, unique_names};
pub use holes::measured;

use crate::file::text_of_file;
use hadar::error::{Error, Result};
use hadar::inputs;
use hadar::material::{Material, OpticalConstants, is_spectra};
use std::borrow::Cow;
use std::path::{Path, PathBuf};

/// The files of a directory that are called as spectra are ([`is_spectra`]), in the order of their names.
///
/// # Errors
/// A directory that cannot be read.
pub fn spectra_in(directory: &Path) -> Result<Vec<PathBuf>> {
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
    Ok(files)
}

/// Reads all materials of a file. The names are those of the file's columns or header in kebab-case, else
/// the file's own.
///
/// # Errors
/// A file that cannot be read, is empty or of no known format; a cell that is not a finite number; an
/// emissivity outside [0, 1]; a wavenumber that is there twice; fewer than two rows; transmittance. Every
/// message names the file, and the line and column where there is one.
pub fn from_file(path: &Path) -> Result<Vec<Material>> {
    content_of_file(path)?.materials()
}

/// As [`from_file`], of a file without header; `columns` are what its header would say, as in `wavelength_um`, `emissivity`.
///
/// # Errors
/// As [`from_file`]; a file that has a header, or another number of columns.
pub fn from_file_with_columns(path: &Path, columns: &[String]) -> Result<Vec<Material>> {
    content_with_columns(path, Some(columns))?.materials()
}

/// As [`from_file`], from text; `source` gives the default name and the file in messages.
///
/// # Errors
/// As [`from_file`].
///
/// ```
/// use std::path::{Path, PathBuf};
/// let text = "wavelength_um,reflectance\n8,0.1\n12.5,0.3\n";
/// let materials = hadar_formats::spectra::from_text(text, Path::new("Roof tile.csv"))?;
/// assert_eq!(materials[0].name(), "roof-tile");
/// assert_eq!(materials[0].emissivity(&[800.0])?, [0.7]);
/// # Ok::<(), hadar::Error>(())
/// ```
pub fn from_text(text: &str, source: &Path) -> Result<Vec<Material>> {
    content(text, source, None)?.materials()
}

fn content_of_file(path: &Path) -> Result<Content> {
    content_with_columns(path, None)
}

fn content_with_columns(path: &Path, columns: Option<&[String]>) -> Result<Content> {
    match envi::files(path)? {
        Some((header, data)) => envi::read(&header, &data, columns).map(Content::noticed),
        None => content(&text_of_file(path, crate::file::READ_SPECTRUM)?, path, columns),
    }
}

fn content(text: &str, source: &Path, columns: Option<&[String]>) -> Result<Content> {
    let text = lines_of(text);
    let content = if ecostress::is_one(&text) {
        ecostress::parse(&text, source)
    } else if jcamp::is_one(&text) {
        jcamp::parse(&text, source)
    } else {
        layout::read(&text, columns)
            .and_then(|sheet| columns::materials(&sheet, source))
            .map(Content::Materials)
    };
    match content {
        Ok(Content::NoEmissivity(error)) => Ok(Content::NoEmissivity(error.in_file(source))),
        other => other.map(Content::noticed).map_err(|error| error.in_file(source)),
    }
}

/// A text without byte-order mark, its lines ending as they do everywhere.
fn lines_of(text: &str) -> Cow<'_, str> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    // Old programs end lines with a carriage return alone.
    if text.contains('\r') && !text.contains('\n') {
        Cow::Owned(text.replace('\r', "\n"))
    } else {
        Cow::Borrowed(text)
    }
}

/// Reads the columns `n` and `k`.
pub(crate) fn optical_constants(text: &str, source: &Path) -> Result<OpticalConstants> {
    layout::read(&lines_of(text), None)
        .and_then(|sheet| columns::optical_constants(&sheet))
        .map_err(|error| error.in_file(source))
}

/// The one material of a file in any format that is read here.
///
/// # Errors
/// As [`from_file`]; also a table of several materials, which must be added to a [`Library`](hadar::material::Library).
pub fn material(path: &Path) -> Result<Material> {
    the_one(from_file(path)?, path)
}

/// The one material that was read from a file.
///
/// # Errors
/// Several, with their names.
pub fn the_one(mut read: Vec<Material>, path: &Path) -> Result<Material> {
    if read.len() > 1 {
        let names: Vec<&str> = read.iter().map(Material::name).collect();
        let found = format!("a table of {} materials where one is needed", names.len());
        let instead = format!("give the file to --library and name one of them: {}", names.join(", "));
        return Err(Error::malformed(found, instead).in_file(path));
    }
    read.pop().ok_or_else(|| Error::malformed("the file has no rows", hadar::grid::EXAMPLE).in_file(path))
}

#[cfg(test)]
mod tests;
