//! Materials and files as they are named in a scenario, read and written.

use std::path::{Path, PathBuf};

use super::MaterialRef;
use super::section::{Entry, Section};
use hadar::error::{Error, Result};
use hadar::material::is_spectra;
use hadar_formats::cube::Axes;

/// How file paths are written.
#[derive(Clone, Copy)]
pub(super) struct Paths<'a> {
    pub(super) beside: Option<&'a Path>,
}

impl Paths<'_> {
    pub(super) fn file(self, path: &Path) -> String {
        let inside = self.beside.and_then(|directory| path.strip_prefix(directory).ok());
        let text = inside.unwrap_or(path).to_string_lossy().into_owned();
        // A bare `skin` would be read as a name of the library, and a blank at the beginning would be lost.
        if is_path(&text) && !text.starts_with(char::is_whitespace) { text } else { format!("./{text}") }
    }

    pub(super) fn material(self, material: &MaterialRef) -> String {
        match material {
            MaterialRef::Name(name) => name.clone(),
            MaterialRef::File(path) => self.file(path),
        }
    }
}

pub(super) fn material(entry: &Entry<'_>) -> Result<MaterialRef> {
    let text = entry.text("\"skin\"")?.trim();
    if is_path(text) { file(entry).map(MaterialRef::File) } else { Ok(MaterialRef::Name(text.to_owned())) }
}

/// A path has a separator in it, or the ending of a data file; a name has neither.
pub(super) fn is_path(text: &str) -> bool {
    text.contains(['/', '\\']) || is_spectra(text)
}

/// The name of an array in a file of several (`variable`).
pub(super) fn variable(section: &Section<'_>) -> Result<Option<String>> {
    section.text("variable", "\"S\"")
}

/// Which dimension of an array is which (`axes`).
pub(super) fn axes(section: &Section<'_>) -> Result<Option<Axes>> {
    section.read("axes", |entry| {
        Axes::named(entry.text("\"bands,rows,columns\"")?).map_err(|error| entry.fail(error))
    })
}

/// Endings of files that hold a cube and nothing else.
pub(super) const CUBES: [&str; 13] =
    ["npy", "npz", "mat", "hdr", "img", "dat", "bsq", "bil", "bip", "h5", "hdf5", "nc", "nc4"];

/// Whether a path names a cube by its ending.
pub(super) fn is_cube(path: &Path) -> bool {
    let end = path.extension().and_then(|end| end.to_str()).map(str::to_ascii_lowercase);
    end.is_some_and(|end| CUBES.contains(&end.as_str()))
}

/// A path, from the scenario's directory, made absolute.
pub(super) fn file(entry: &Entry<'_>) -> Result<PathBuf> {
    let text = entry.text("\"my_data.csv\"")?.trim();
    if entry.source().files_refused {
        let found = format!("`{text}` is a file, and no files are read here");
        let instead = "name a material or write a number; files are read by the command on your own machine";
        return Err(entry.fail(Error::malformed(found, instead)));
    }
    let path = entry.source().directory().join(text);
    let path = std::path::absolute(&path).map_err(|error| {
        entry
            .fail(Error::malformed(format!("`{text}` is not a usable path ({error})"), "write the full path"))
    })?;
    // As in `x /.`: written again, it would be another path.
    if path.file_name().is_some_and(|name| name.to_string_lossy().ends_with(char::is_whitespace)) {
        let found = format!("`{text}` is a path that ends in a blank");
        return Err(entry.fail(Error::malformed(found, "rename the file")));
    }
    Ok(path)
}
