//! Writing a material out again: as a CSV that [`super::read`] takes, and as a summary for lists.

use super::{Material, Provenance};
use crate::error::Result;
use serde::Serialize;
use std::fmt::Write;

/// What a line begins with that says what is to be known of a spectrum, in the files that are written here.
pub const WARNING: &str = "# warning: ";

/// What a list or an import says about a material.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Summary {
    /// Name under which the material is looked up.
    pub name: String,
    /// What it is and how it is known.
    pub provenance: Provenance,
    /// Rows of the tables it is computed from; 0 for a formula.
    pub rows: usize,
    /// Wavenumbers between which it is known, cm⁻¹; `None` is everywhere.
    pub range_cm1: Option<(f64, f64)>,
    /// As what the columns of its file were read, units and all.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub read_as: String,
    /// What a user should know before trusting it.
    pub warnings: Vec<String>,
}

impl Material {
    /// Name, provenance, rows, range and warnings.
    #[must_use]
    pub fn summary(&self) -> Summary {
        Summary {
            name: self.name.clone(),
            provenance: self.provenance.clone(),
            rows: self.rows(),
            range_cm1: self.range_cm1(),
            read_as: self.read_as.clone(),
            warnings: self.warnings.clone(),
        }
    }

    /// The two-column CSV of the emissivity at wavenumbers in cm⁻¹, with the provenance as comments. Reading it
    /// back gives every number to the last bit.
    ///
    /// # Errors
    /// As [`Material::emissivity`].
    pub fn to_csv(&self, wavenumbers_cm1: &[f64]) -> Result<String> {
        let emissivities = self.emissivity(wavenumbers_cm1)?;
        let provenance = &self.provenance;
        let mut text = String::new();
        let basis = provenance.basis.to_string();
        for (key, value) in [
            ("material", &self.name),
            ("description", &provenance.description),
            ("basis", &basis),
            ("source", &provenance.source),
            ("licence", &provenance.licence),
            ("note", &provenance.note),
        ] {
            if !value.is_empty() {
                let value = value.lines().collect::<Vec<_>>().join(" ");
                let _ = writeln!(text, "# {key}: {value}");
            }
        }
        // What is to be known of it stays with it.
        for warning in &self.warnings {
            let _ = writeln!(text, "{WARNING}{}", warning.lines().collect::<Vec<_>>().join(" "));
        }
        text.push_str("wavenumber_cm1,emissivity\n");
        for (wavenumber, emissivity) in wavenumbers_cm1.iter().zip(emissivities) {
            let _ = writeln!(text, "{wavenumber},{emissivity}");
        }
        Ok(text)
    }
}
