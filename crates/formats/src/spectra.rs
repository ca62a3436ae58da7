//! Reading spectra from files; the format is told from the content.
//!
//! 1. A table of an axis and the emissivity or reflectance of an opaque surface, e = 1 − R (Kirchhoff), in any customary
//!    layout: units and percent are told from the header, the sign between columns and the decimal sign from the lines.
//! 2. A table with more columns, each the emissivity (or what its header says) of the material it is named after.
//! 3. A table with the columns `n` and `k` behind the axis: optical constants of a half-space.
//! 4. ECOSTRESS or ASTER spectral library text: wavelength in µm, reflectance in percent.
//! 5. JCAMP-DX (`.jdx`, `.dx`) and ENVI spectral libraries (`.sli` with `.hdr`).
//! 6. USGS spectral libraries 6 and 7 and RELAB, as text; tables with a label of PDS4.
//! 7. SPC (GRAMS), OPUS (Bruker) and ASD, as bytes.
//!
//! The format is told from the first bytes or lines, never from the name alone. A file of another kind is named with what makes a table
//! of it.
//!
//! Rows may be in any order; `#` begins a comment line; a byte-order mark, any end of line and extra blanks do no harm. Bytes that
//! are not UTF-8 (or UTF-16 with its mark) are read as Latin-1. What is ambiguous is asked for: the message has the header to
//! write.

mod asd;
mod bytes;
mod checked;
mod columns;
mod content;
#[cfg(test)]
mod damage;
mod ecostress;
mod envi;
mod folder;
mod header;
mod holes;
mod jcamp;
mod layout;
mod names;
mod opus;
mod pds;
mod radiance;
mod reading;
mod relab;
mod samples;
mod spc;
mod splib;

use self::content::Content;
pub(crate) use self::content::stem;
pub use self::folder::{Folder, spectra_in};
pub(crate) use self::names::{Origin, differing, qualified};
pub use self::names::{tagged_name, unique_names};
pub use self::radiance::{atmosphere, radiance};
pub use self::reading::Reading;
pub use holes::measured;

use crate::file;
use crate::foreign;
use hadar::error::{Error, Result};
use hadar::material::{Material, OpticalConstants, WARNING};
use std::borrow::Cow;
use std::path::Path;

/// Reads all materials of a file. The names are those of the file's columns or header in kebab-case, else
/// the file's own.
///
/// # Errors
/// A file that cannot be read, is empty or of no known format; a cell that is not a finite number; an
/// emissivity outside [0, 1]; a wavenumber that is there twice; fewer than two rows; transmittance. Every
/// message names the file, and the line and column where there is one.
pub fn from_file(path: &Path) -> Result<Vec<Material>> {
    Reading::default().file(path)
}

/// As [`from_file`], from text; `source` gives the default name and the file in messages.
///
/// # Errors
/// As [`from_file`].
///
/// ```
/// use std::path::Path;
/// let text = "wavelength_um,reflectance\n8,0.1\n12.5,0.3\n";
/// let materials = hadar_formats::spectra::from_text(text, Path::new("Roof tile.csv"))?;
/// assert_eq!(materials[0].name(), "roof-tile");
/// assert_eq!(materials[0].emissivity(&[800.0])?, [0.7]);
/// # Ok::<(), hadar::Error>(())
/// ```
pub fn from_text(text: &str, source: &Path) -> Result<Vec<Material>> {
    content(text, source, None, &Reading::default())?.materials()
}

impl Reading {
    /// All materials of a file.
    ///
    /// # Errors
    /// As [`from_file`](from_file); columns of a file that has a header, or another number of columns.
    pub fn file(&self, path: &Path) -> Result<Vec<Material>> {
        content_of_file(path, self)?.materials()
    }
}

fn content_of_file(path: &Path, reading: &Reading) -> Result<Content> {
    if let Some((header, data)) = envi::files(path)? {
        return envi::read(&header, &data, reading).map(Content::noticed);
    }
    let bytes = file::short_bytes(path, file::READ_SPECTRUM)?;
    foreign::refuse(&bytes).map_err(|error| error.in_file(path))?;
    let parse = if spc::is_one(&bytes) {
        spc::parse
    } else if opus::is_one(&bytes) {
        opus::parse
    } else if asd::is_one(&bytes) {
        asd::parse
    } else {
        foreign::refuse_binary(&bytes).map_err(|error| error.in_file(path))?;
        return content_of_text(&file::text(bytes), path, reading);
    };
    placed(parse(&bytes, path, reading), path)
}

/// What a text file holds, with the files beside it that belong to it.
fn content_of_text(text: &str, path: &Path, reading: &Reading) -> Result<Content> {
    if pds::is_label(text) {
        let table = pds::table_of(text, path).map_err(|error| error.in_file(path))?;
        let rows = file::text_of_file(&table, file::READ_SPECTRUM)?;
        return placed(pds::parse(&rows, text, &table, reading), &table);
    }
    if let Some(label) = pds::label_of(path)? {
        return placed(pds::parse(text, &label, path, reading), path);
    }
    // A file that is named without its folder is in this one.
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    content(text, path, Some(folder), reading)
}

/// What a text holds; files that belong to it are looked for in the folder `beside`.
fn content(text: &str, source: &Path, beside: Option<&Path>, reading: &Reading) -> Result<Content> {
    let text = lines_of(text);
    let content = if ecostress::is_one(&text) {
        ecostress::parse(&text, source, reading)
    } else if jcamp::is_one(&text) {
        jcamp::parse(&text, source, reading)
    } else if splib::is_one(&text) {
        splib::parse(&text, source, beside, reading)
    } else if relab::is_one(&text) {
        relab::parse(&text, source, reading)
    } else {
        layout::read(&text, reading)
            .and_then(|sheet| columns::materials(&sheet, source, reading))
            .map(|materials| Content::Materials(warned(materials, &text)))
    };
    placed(content, source)
}

/// Materials with the warnings that a table has which was written here.
fn warned(materials: Vec<Material>, text: &str) -> Vec<Material> {
    let written: Vec<&str> =
        text.lines().filter_map(|line| line.strip_prefix(WARNING)).map(str::trim).collect();
    let warned = |material: Material| material.warn(written.iter().map(|one| (*one).to_owned()));
    materials.into_iter().map(warned).collect()
}

/// The same, with the file where something is wrong and what is to be noticed.
fn placed(content: Result<Content>, source: &Path) -> Result<Content> {
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
    layout::read(&lines_of(text), &Reading::default())
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
