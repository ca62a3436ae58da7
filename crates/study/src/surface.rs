//! A material where the bands look at it.

use hadar::error::Result;
use hadar::material::{Basis, Material};

/// Emissivities that differ by no more are one number with its rounding: no surface was measured to be so flat.
const FLAT: f64 = 1e-5;

/// Whether an emissivity is entered as one number for all of several wavenumbers.
pub(crate) fn is_one_number(emissivity: &[f64]) -> bool {
    let least = emissivity.iter().copied().fold(f64::INFINITY, f64::min);
    emissivity.len() > 1 && emissivity.iter().all(|e| e - least <= FLAT)
}

/// A material on the nodes of the bands.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    /// Name.
    pub name: String,
    /// Emissivity at the nodes.
    pub emissivity: Vec<f64>,
    /// The one number that it is entered as, where nothing is known of its spectrum.
    pub one_number: Option<f64>,
}

impl Surface {
    /// A material at `nodes_cm1`.
    ///
    /// # Errors
    /// As [`Material::emissivity`].
    pub fn of(material: &Material, nodes_cm1: &[f64]) -> Result<Self> {
        hadar::stop::check();
        let emissivity = material.emissivity(nodes_cm1)?;
        let flat = match emissivity.len() {
            1 => material.provenance().basis == Basis::Constant,
            _ => is_one_number(&emissivity),
        };
        let one_number = emissivity.first().copied().filter(|_| flat);
        Ok(Self { name: material.name().to_owned(), emissivity, one_number })
    }

    /// What a pair is entered as where nothing is known of either spectrum: what then tells the two apart is not in the
    /// entries.
    #[must_use]
    pub fn placeholders(&self, other: &Self) -> Option<[f64; 2]> {
        Some([self.one_number?, other.one_number?])
    }
}
