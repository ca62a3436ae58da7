//! Materials and files as they are named in a scenario, read and written.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::MaterialRef;
use super::section::{Entry, Section};
use super::source::Source;
use hadar::error::{Error, Result};
use hadar::inputs::{called, slashed};
use hadar::material::is_spectra;
use hadar_formats::cube::Axes;

/// How file paths are written: as in the scenario, so that a copy beside it asks the same, and the same wherever it lies.
#[derive(Clone, Copy)]
pub(super) struct Paths<'a> {
    /// The folder that relative paths of the scenario start from.
    home: &'a Path,
    /// Files outside of it that stood there with their whole path, by the name that they have been given.
    outside: &'a Outside,
}

/// See [`Paths`].
pub(super) type Outside = RefCell<BTreeMap<String, PathBuf>>;

/// Lays out a document with the paths of what was read from a source.
pub(super) fn from_home<T>(source: &Source, lay: impl FnOnce(Paths<'_>) -> T) -> T {
    let directory = source.directory();
    let home = std::path::absolute(if directory == Path::new("") { Path::new(".") } else { directory });
    lay(Paths { home: &home.unwrap_or_default(), outside: &Outside::default() })
}

impl Paths<'_> {
    pub(super) fn file(self, path: &Path) -> String {
        let text = match path.strip_prefix(self.home) {
            // As it was written, `..` among it.
            Ok(way) => slashed(way),
            // Of a report, beside the file that names it.
            Err(_) if path.is_relative() => return format!("./{}", slashed(path)),
            Err(_) => self.named(path),
        };
        // A bare `skin` would be read as a name of the library, and a blank at the beginning would be lost.
        if is_path(&text) && !text.starts_with(char::is_whitespace) { text } else { format!("./{text}") }
    }

    /// A file that was written with its whole path; two of a name stay two.
    fn named(self, path: &Path) -> String {
        let name = called(Some(self.home), path);
        let mut known = self.outside.borrow_mut();
        let numbered = (2..).map(|number| format!("{number}/{name}"));
        let real = |path: &Path| path.canonicalize().ok();
        let is_free = |name: &String| {
            let there = real(&self.home.join(name));
            known.get(name).is_none_or(|other| other == path) && (there.is_none() || there == real(path))
        };
        let name = std::iter::once(name.clone()).chain(numbered).find(is_free).unwrap_or(name);
        known.insert(name.clone(), path.to_owned());
        name
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

/// A path, from the scenario's directory, made absolute.
pub(super) fn file(entry: &Entry<'_>) -> Result<PathBuf> {
    let text = entry.text("\"my_data.csv\"")?.trim();
    if entry.source().files_refused {
        let found = format!("`{text}` is a file, and no files are read here");
        let instead = "name a material or write a number; files are read by the command on your own machine";
        return Err(entry.fail(Error::malformed(found, instead)));
    }
    let path = entry.source().located(text).map_err(|error| entry.fail(error))?;
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
