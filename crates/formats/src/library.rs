//! A user's own materials added to a library: those of a directory, a file or a manifest.

use crate::file::{text_of_file, text_within};
use crate::spectra::{self, Origin, qualified};
use hadar::error::{Error, Result};
use hadar::material::{Library, ManifestFiles, Material, OpticalConstants};
use std::path::{Path, PathBuf};

/// The name of a manifest within a directory.
const MANIFEST: &str = "manifest.toml";

/// A library that reads files.
pub trait ReadLibrary {
    /// Adds the materials of a directory: those of its `manifest.toml` if it has one, else those of all its files of spectra
    /// ([`is_spectra`](hadar::material::is_spectra)). Of these, what cannot be read or holds no emissivity is passed over with a
    /// warning, unless the library is [`strict`](Library::strict).
    ///
    /// # Errors
    /// A directory that cannot be read or holds no material; in a strict library a file that is wrong (see [`spectra::from_file`]).
    fn add_directory(&mut self, directory: &Path) -> Result<()>;

    /// Adds the materials of one file: a spectrum, a table of materials, or a manifest (`.toml`).
    ///
    /// # Errors
    /// As [`spectra::from_file`].
    fn add_file(&mut self, path: &Path) -> Result<()>;

    /// Adds a directory or a file, whichever it is.
    ///
    /// # Errors
    /// As [`ReadLibrary::add_directory`] and [`ReadLibrary::add_file`].
    fn add_path(&mut self, path: &Path) -> Result<()> {
        if path.is_dir() { self.add_directory(path) } else { self.add_file(path) }
    }
}

impl ReadLibrary for Library {
    fn add_directory(&mut self, directory: &Path) -> Result<()> {
        let path = directory.join(MANIFEST);
        let there = path.symlink_metadata();
        if !there.is_err_and(|error| error.kind() == std::io::ErrorKind::NotFound) {
            return add_manifest(self, &path, directory);
        }
        let spectra::Folder { files, mut passed_over } = spectra::spectra_in(directory)?;
        let mut sources = Vec::new();
        for file in files {
            hadar::stop::check();
            match spectra::from_file(&file) {
                Ok(materials) => sources.push((file, materials)),
                Err(error) if self.is_strict() => return Err(error),
                Err(error) => passed_over.push(error),
            }
        }
        if sources.is_empty() {
            let found = match passed_over.first() {
                None => "the directory holds no spectra".to_owned(),
                Some(first) => format!("none of its {} files is a spectrum: {first}", passed_over.len()),
            };
            let instead = "put .csv, .txt, .jdx or .sli spectra or a manifest.toml into it";
            return Err(Error::malformed(found, instead).in_file(directory));
        }
        self.warn(passed_over.iter().map(|error| format!("passed over: {error}")));
        add_sources(self, sources);
        Ok(())
    }

    fn add_file(&mut self, path: &Path) -> Result<()> {
        if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml")) {
            return add_manifest(self, path, path.parent().unwrap_or(Path::new("")));
        }
        let materials = spectra::from_file(path)?;
        add_sources(self, vec![(path.to_owned(), materials)]);
        Ok(())
    }
}

/// Adds the materials of files; names that several of them define are qualified with what tells them apart.
fn add_sources(library: &mut Library, sources: Vec<(PathBuf, Vec<Material>)>) {
    let of = |(file, materials): (PathBuf, Vec<Material>)| {
        materials.into_iter().map(move |material| {
            let (name, sample) = (material.name().to_owned(), material.sample().to_owned());
            (material, Origin { name, sample, file: file.clone() })
        })
    };
    let (materials, origins): (Vec<Material>, Vec<Origin>) = sources.into_iter().flat_map(of).unzip();
    library.add_qualified(materials.into_iter().zip(qualified(&origins)));
}

/// The longest manifest, bytes: some ten thousand materials.
const LONGEST_MANIFEST: u64 = 1 << 22;

fn add_manifest(library: &mut Library, path: &Path, directory: &Path) -> Result<()> {
    let text = text_within(path, "read the manifest", LONGEST_MANIFEST)?;
    library.add_manifest(&text, path, directory, &Folder(directory))
}

/// The files of a manifest, by their paths from its folder.
struct Folder<'a>(&'a Path);

impl Folder<'_> {
    fn text(&self, file: &str) -> Result<String> {
        text_of_file(&self.0.join(file), "read a file of the manifest")
    }
}

impl ManifestFiles for Folder<'_> {
    fn spectrum(&self, file: &str) -> Result<Material> {
        let mut materials = spectra::from_text(&self.text(file)?, Path::new(file))?;
        match (materials.len(), materials.pop()) {
            (1, Some(one)) => Ok(one),
            (many, _) => Err(Error::malformed(
                format!("{file} holds {many} materials"),
                "name a file with two columns",
            )),
        }
    }

    fn constants(&self, file: &str) -> Result<OpticalConstants> {
        spectra::optical_constants(&self.text(file)?, Path::new(file))
    }
}
