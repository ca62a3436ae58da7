//! The `[stand_in]` of a rule: what is to pass for a person where cameras are tested, and how exactly its emissivity is known.
//!
//! `clause` names the one whose limit is turned round, where several tell people apart; `materials` it may be made of (silent: those of the rule's target), its `temperature` (silent: that of the target), and
//! `emissivity`: tolerances, the same at all wavenumbers, for each of which the tolerance of its temperature is found. `emissivity_error` and
//! `correlation` say how far the shape of its spectrum may be from the material's, as those of `[sensitivity]` do of what is measured.

use crate::emissivity_error;
use crate::entries::Entries;
use crate::paths::{Paths, material};
use crate::section::{Entry, without_repetition};
use crate::{MaterialRef, SensitivitySpec};
use hadar::error::{Error, Result};
use hadar::units::Dimension;

/// Tolerances of an emissivity where nothing is said.
const EMISSIVITY: [f64; 6] = [0.0, 0.005, 0.01, 0.02, 0.03, 0.05];
/// Most tolerances.
const MOST: usize = 64;

/// A stand-in (`[stand_in]`).
#[derive(Debug, Clone, PartialEq)]
pub struct StandInSpec {
    /// The clause whose limit is turned round, by its name; the only one that tells people apart where `None`.
    pub clause: Option<String>,
    /// What it may be made of; the materials of the target where `None`.
    pub materials: Option<Vec<MaterialRef>>,
    /// Its temperature, K; that of the target where `None`.
    pub temperature_k: Option<f64>,
    /// Tolerances of its emissivity, in ascending order.
    pub emissivity: Vec<f64>,
    /// How far the shape of its spectrum may be from that of its material; it has that very shape where `None`.
    pub shape: Option<SensitivitySpec>,
}

impl Default for StandInSpec {
    fn default() -> Self {
        Self {
            clause: None,
            materials: None,
            temperature_k: None,
            emissivity: EMISSIVITY.to_vec(),
            shape: None,
        }
    }
}

impl StandInSpec {
    pub(super) fn read(entry: &Entry<'_>) -> Result<Self> {
        let section = entry.section()?;
        let clause = section.text("clause", "\"crossing\"")?;
        let materials = section.read("materials", |entry| {
            let items = entry.items("materials = [\"skin\"]")?;
            if items.is_empty() {
                let instead = "name some, or leave the key out to take those of the target";
                return Err(entry.fail(Error::malformed("the list is empty", instead)));
            }
            without_repetition(&items, material)
        })?;
        let emissivity = section.read("emissivity", |entry| {
            let example = "emissivity = [0.0, 0.01, 0.02]";
            let items = entry.items(example)?;
            if !(1..=MOST).contains(&items.len()) {
                let found = format!("a list of {} tolerances", items.len());
                return Err(
                    entry.fail(Error::malformed(found, format!("write 1 to {MOST}, as in {example}")))
                );
            }
            let mut values = items.iter().map(|item| item.number("0.01")).collect::<Result<Vec<f64>>>()?;
            values.sort_by(f64::total_cmp);
            values.dedup();
            Ok(values)
        })?;
        let error = emissivity_error::read(&section, emissivity_error::Of::Absolute)?;
        let correlation_cm1 = section.quantity("correlation")?;
        let shape = match (error.filter(|error| *error > 0.0), correlation_cm1) {
            (None, _) if error.is_some() => None,
            (None, None) => None,
            (None, Some(_)) => {
                let found = "how far errors of a shape reach, and not how large they are";
                let error = Error::malformed(found, "write emissivity_error = \"0.005 absolute\" too");
                return Err(section.fail("emissivity_error", error));
            }
            (Some(emissivity_error), correlation_cm1) => Some(SensitivitySpec {
                emissivity_error,
                correlation_cm1: correlation_cm1.unwrap_or(SensitivitySpec::default().correlation_cm1),
            }),
        };
        Ok(Self {
            clause,
            materials,
            shape,
            temperature_k: section.quantity("temperature")?,
            emissivity: emissivity.unwrap_or_else(|| EMISSIVITY.to_vec()),
        })
    }

    pub(super) fn written(&self, paths: Paths<'_>) -> Entries {
        let names = |materials: &Vec<MaterialRef>| -> Vec<String> {
            materials.iter().map(|material| paths.material(material)).collect()
        };
        Entries::default()
            .put_if("clause", self.clause.as_deref())
            .put_if("materials", self.materials.as_ref().map(names))
            .put_quantity("temperature", Dimension::Temperature, self.temperature_k)
            .put("emissivity", self.emissivity.clone())
            .put_if("emissivity_error", self.shape.map(|shape| shape.emissivity_error))
            .put_quantity("correlation", Dimension::Wavenumber, self.shape.map(|shape| shape.correlation_cm1))
    }
}
