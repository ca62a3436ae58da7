//! Files of spectra that are named on the command line, with or without a header.

use clap::Args;
use hadar::error::Result;
use hadar::material::{Library, Material};
use std::path::Path;

/// Where materials are drawn and shown: the paper's bands, cm⁻¹.
pub(super) const SHOWN_CM1: (f64, f64) = (715.0, 1250.0);

/// What columns are called in files without a header.
#[derive(Debug, Args)]
pub(super) struct Columns {
    /// What the columns of files without a header are, as their header would say: wavelength_um,emissivity
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    columns: Vec<String>,
}

impl Columns {
    /// All materials of a file.
    pub(super) fn read(&self, file: &Path) -> Result<Vec<Material>> {
        if self.columns.is_empty() {
            hadar_formats::spectra::from_file(file)
        } else {
            hadar_formats::spectra::from_file_with_columns(file, &self.columns)
        }
    }

    /// The material of a name, or the one of a file.
    pub(super) fn find(&self, library: &Library, name: &str) -> Result<Material> {
        if library.contains(name)
            || !(name.contains(['/', '\\']) || hadar::material::is_spectra(name) || Path::new(name).is_file())
        {
            return library.get(name).cloned();
        }
        match self.columns.is_empty() {
            true => hadar_formats::spectra::material(Path::new(name)),
            false => hadar_formats::spectra::the_one(self.read(Path::new(name))?, Path::new(name)),
        }
    }
}
