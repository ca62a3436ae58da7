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
mod ecostress;

use super::Material;
use super::dielectric::OpticalConstants;
use crate::error::{Error, Result};
use crate::grid::{Grid, text_of_file};
use std::path::Path;

/// What a file turned out to hold.
pub(super) enum Content {
    /// One or more materials.
    Materials(Vec<Material>),
    /// A file of a known format that has no emissivity in it, and why.
    NoEmissivity(Error),
}

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

/// A name in kebab-case: `tilePavement` → `tile-pavement`, `Fused silica` → `fused-silica`. Qualified
/// names keep their `@`.
pub(super) fn kebab_case(name: &str) -> String {
    let mut kebab = String::with_capacity(name.len() + 2);
    let mut previous = ' ';
    for character in name.chars() {
        let boundary = !(character.is_alphanumeric() || character == '@');
        let hump = character.is_uppercase() && previous.is_lowercase();
        if (boundary || hump) && !kebab.is_empty() && !kebab.ends_with(['-', '@']) {
            kebab.push('-');
        }
        if !boundary {
            if character == '@' && kebab.ends_with('-') {
                kebab.pop();
            }
            kebab.extend(character.to_lowercase());
        }
        previous = character;
    }
    kebab.truncate(kebab.trim_end_matches('-').len());
    kebab
}

/// Text without line breaks and other control characters, nor more than one blank at a place.
pub(super) fn one_line(text: &str) -> String {
    let words = text.split(|char: char| char.is_whitespace() || char.is_control());
    words.filter(|word| !word.is_empty()).collect::<Vec<_>>().join(" ")
}

/// The file's name without folders and extension, in kebab-case.
pub(super) fn stem(path: &Path) -> String {
    let stem = path.file_stem().map(|stem| kebab_case(&stem.to_string_lossy())).unwrap_or_default();
    if stem.is_empty() { "unnamed".to_owned() } else { stem }
}

#[cfg(test)]
mod tests;
