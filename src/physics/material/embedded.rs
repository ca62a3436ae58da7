//! The text of `spectra/`, compiled into the library so that it needs no files at run time.

use super::manifest::ManifestFiles;
use super::{Basis, Material, OpticalConstants, Provenance, Table};
use crate::error::{Error, Result};
use crate::grid::Grid;

/// The manifest.
pub(super) const MANIFEST: &str = include_str!("../../../spectra/manifest.toml");

/// The text of each file in the list, with its path in `spectra/`.
macro_rules! files {
    ($($path:literal),* $(,)?) => {
        &[$(($path, include_str!(concat!("../../../spectra/", $path)))),*]
    };
}

/// Every file that the manifest names.
const FILES: &[(&str, &str)] = files![
    "nk/aluminium-oxide.csv",
    "nk/bk7-glass.csv",
    "nk/blood.csv",
    "nk/brass.csv",
    "nk/calcium-sulphate-alpha.csv",
    "nk/calcium-sulphate-beta.csv",
    "nk/calcium-sulphate-gamma.csv",
    "nk/copper.csv",
    "nk/dolomite-extraordinary.csv",
    "nk/dolomite-ordinary.csv",
    "nk/gold.csv",
    "nk/graphite.csv",
    "nk/hematite-extraordinary.csv",
    "nk/hematite-ordinary.csv",
    "nk/ice.csv",
    "nk/illite.csv",
    "nk/iron.csv",
    "nk/kaolinite.csv",
    "nk/magnesium-oxide.csv",
    "nk/montmorillonite.csv",
    "nk/nickel.csv",
    "nk/pdms.csv",
    "nk/pei.csv",
    "nk/pet.csv",
    "nk/polycarbonate.csv",
    "nk/polystyrene.csv",
    "nk/pvc.csv",
    "nk/silicon-nitride.csv",
    "nk/silicon.csv",
    "nk/silver.csv",
    "nk/soda-lime-glass.csv",
    "nk/titanium-dioxide.csv",
    "nk/titanium.csv",
    "nk/tungsten.csv",
    "nk/water.csv",
    "nk/zinc-oxide.csv",
    "nk/zinc.csv",
    "sky/midlatitude-summer.csv",
    "sky/midlatitude-winter.csv",
    "sky/subarctic-summer.csv",
    "sky/tropical.csv",
    "sky/us-standard.csv",
];

/// The text of a file by its path in `spectra/`.
pub(super) fn text(name: &str) -> Result<&'static str> {
    let text = FILES.iter().find(|(path, _)| *path == name).map(|(_, text)| *text);
    text.ok_or_else(|| Error::unknown_name("embedded file", name, FILES.iter().map(|(path, _)| *path)))
}

/// The files that are compiled in: columns of a wavenumber or wavelength, then of emissivity or of n and k.
#[derive(Debug)]
pub(super) struct Embedded;

impl Embedded {
    fn rows<const N: usize>(file: &str) -> Result<Vec<(f64, [f64; N])>> {
        let grid = Grid::parse(text(file)?)?;
        let cells = grid.rows.iter().map(|(_, cells)| {
            std::array::from_fn(|column| cells.get(column + 1).copied().unwrap_or(f64::NAN))
        });
        Ok(grid.wavenumbers_cm1()?.into_iter().zip(cells).collect())
    }
}

impl ManifestFiles for Embedded {
    fn spectrum(&self, file: &str) -> Result<Material> {
        let provenance = Provenance::given(Basis::UserFile, "rows of a file");
        Ok(Material::of_table(file.to_owned(), provenance, Table::new(&Self::rows(file)?)?))
    }

    fn constants(&self, file: &str) -> Result<OpticalConstants> {
        OpticalConstants::new(&Self::rows(file)?)
    }
}
