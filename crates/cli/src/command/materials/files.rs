//! Files of spectra that are named on the command line, with or without a header.

use clap::Args;
use hadar::error::Result;
use hadar::material::{Library, Material};
use hadar_formats::spectra::Reading;
use std::path::Path;

/// Where materials are drawn and shown: the paper's bands, cm⁻¹.
pub(super) const SHOWN_CM1: (f64, f64) = (715.0, 1250.0);

/// What columns are called in files without a header.
#[derive(Debug, Args)]
pub(super) struct Columns {
    /// What the columns of files without a header are, as their header would say: wavelength_um,emissivity
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    columns: Vec<String>,
    /// Sets emissivities outside 0 to 1 by at most this to 0 or 1, and leaves out rows without a number
    #[arg(long, value_name = "EMISSIVITY")]
    clip: Option<f64>,
}

impl Columns {
    /// All materials of a file.
    pub(super) fn read(&self, file: &Path) -> Result<Vec<Material>> {
        self.reading()?.file(file)
    }

    fn reading(&self) -> Result<Reading> {
        let reading = Reading::default().columns(self.columns.iter().cloned());
        match self.clip {
            Some(by) => reading.clipping(by),
            None => Ok(reading),
        }
    }

    /// The material of a name, or the one of a file.
    pub(super) fn find(&self, library: &Library, name: &str) -> Result<Material> {
        if library.contains(name)
            || !(name.contains(['/', '\\']) || hadar::material::is_spectra(name) || Path::new(name).is_file())
        {
            return library.get(name).cloned();
        }
        hadar_formats::spectra::the_one(self.read(Path::new(name))?, Path::new(name))
    }
}
