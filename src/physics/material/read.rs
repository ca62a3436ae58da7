//! Reading spectra from files; the format is told from the content.
//!
//! 1. CSV with two columns, `wavenumber_cm1` or `wavelength_um`, then `emissivity` or `reflectance`, as
//!    fractions; opaque, so that e = 1 − R (Kirchhoff).
//! 2. CSV with more columns, the first as above, every other one the emissivity of the material it is named after.
//! 3. CSV with the columns `wavelength_um` (or `wavenumber_cm1`), `n`, `k`: optical constants of a half-space.
//! 4. ECOSTRESS or ASTER spectral library text: wavelength in µm, reflectance in percent.
//!
//! CSV rows may be in any order; `#` begins a comment line; a byte-order mark, CRLF and extra blanks
//! do no harm. Bytes that are not UTF-8 are read as Latin-1.

mod columns;
mod content;
mod ecostress;

pub(super) use self::content::{Content, kebab_case, one_line, stem};

use super::Material;
use super::dielectric::OpticalConstants;
use crate::error::{Error, Result};
use crate::grid::{Grid, text_of_file};
use std::path::Path;

/// Reads all materials of a file. The names are those of the file's columns or header in kebab-case, else
/// the file's own.
///
/// # Errors
/// A file that cannot be read, is empty or of no known format; a cell that is not a finite number; an
/// emissivity outside [0, 1]; a wavenumber that is there twice; fewer than two rows; transmittance. Every
/// message names the file, and the line and column where there is one.
pub fn from_file(path: &Path) -> Result<Vec<Material>> {
    match content_of_file(path)? {
        Content::Materials(materials) => Ok(materials),
        Content::NoEmissivity(error) => Err(error),
    }
}

/// As [`from_file`], from text; `source` gives the default name and the file in messages.
///
/// # Errors
/// As [`from_file`].
///
/// ```
/// use std::path::Path;
/// let text = "wavelength_um,reflectance\n8,0.1\n12.5,0.3\n";
/// let materials = hadar::material::read::from_text(text, Path::new("Roof tile.csv"))?;
/// assert_eq!(materials[0].name(), "roof-tile");
/// assert_eq!(materials[0].emissivity(&[800.0])?, [0.7]);
/// # Ok::<(), hadar::Error>(())
/// ```
pub fn from_text(text: &str, source: &Path) -> Result<Vec<Material>> {
    match content(text, source)? {
        Content::Materials(materials) => Ok(materials),
        Content::NoEmissivity(error) => Err(error),
    }
}

pub(super) fn content_of_file(path: &Path) -> Result<Content> {
    content(&text_of_file(path, crate::grid::READ_SPECTRUM)?, path)
}

fn content(text: &str, source: &Path) -> Result<Content> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let content = if ecostress::is_one(text) {
        ecostress::parse(text, source)
    } else {
        Grid::parse(text).and_then(|grid| columns::materials(&grid, source)).map(Content::Materials)
    };
    match content {
        Ok(Content::NoEmissivity(error)) => Ok(Content::NoEmissivity(error.in_file(source))),
        other => other.map_err(|error| error.in_file(source)),
    }
}

/// Reads the columns `n` and `k`.
pub(super) fn optical_constants(text: &str, source: &Path) -> Result<OpticalConstants> {
    Grid::parse(text)
        .and_then(|grid| columns::optical_constants(&grid))
        .map_err(|error| error.in_file(source))
}

impl Material {
    /// The one material of a file in any format that [`read`](self) knows.
    ///
    /// # Errors
    /// As [`from_file`]; also a table of several materials, which must be added to a [`Library`](super::Library).
    pub fn from_file(path: &Path) -> Result<Self> {
        let mut materials = from_file(path)?;
        match (materials.pop(), materials.len()) {
            (Some(material), 0) => Ok(material),
            (_, others) => Err(Error::malformed(
                format!("a table of {} materials where one is needed", others + 1),
                "give the file to --library and name the material",
            )
            .in_file(path)),
        }
    }
}

#[cfg(test)]
mod tests;
