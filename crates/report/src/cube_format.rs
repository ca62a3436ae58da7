//! Cubes among the files of an answer: NPY, or ENVI with a header that says the bands.

use crate::bundle::Bundle;
use hadar::cube::{Sample, Shape};
use hadar::error::Result;
use hadar_formats::cube::{EnviBands, envi_files, write_npy_to};
use hadar_formats::envi_header::Interleave;

/// File format of written cubes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum CubeFormat {
    /// One file, `name.npy`.
    #[default]
    Npy,
    /// Two, `name.hdr` and `name.img`, bands by pixel.
    Envi,
}

impl CubeFormat {
    /// The file that a scenario names.
    #[must_use]
    pub fn file(self, name: &str) -> String {
        match self {
            Self::Npy => format!("{name}.npy"),
            Self::Envi => format!("{name}.hdr"),
        }
    }

    /// Adds a cube `[row][column][band]`; the centres are said where there is one for each band.
    pub(crate) fn add<S: Sample>(
        self,
        bundle: &mut Bundle,
        name: &str,
        shape: Shape,
        samples: &[S],
        centres_cm1: &[f64],
    ) -> Result<()> {
        match self {
            Self::Npy => {
                let mut file = Vec::with_capacity(size_of_val(samples) + 128);
                write_npy_to(&mut file, shape, samples)?;
                bundle.add(self.file(name), file);
            }
            Self::Envi => {
                let bands = EnviBands { centres_cm1, widths_cm1: None };
                let bands = (centres_cm1.len() == shape.bands()).then_some(bands);
                let (header, data) = envi_files(shape, samples, Interleave::Bip, bands)?;
                bundle.add(self.file(name), header);
                bundle.add(format!("{name}.img"), data);
            }
        }
        Ok(())
    }
}
