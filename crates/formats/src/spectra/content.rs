//! What the readers of all formats share: what a file holds, and how names are written.

use hadar::error::{Error, Result};
use hadar::material::Material;
use hadar::words::{kebab_case, one_line, significant};
use std::path::Path;

/// The thermal infrared, cm⁻¹ (20 to 3 µm): beyond it nothing is seen by heat at the temperatures around us.
const THERMAL_CM1: (f64, f64) = (500.0, 1e4 / 3.0);
/// Characters of a name that was made of a title, which may be a sentence.
const LONGEST_NAME: usize = 40;

/// What a file turned out to hold.
pub(crate) enum Content {
    /// One or more materials.
    Materials(Vec<Material>),
    /// A file of a known format that has no emissivity in it, and why.
    NoEmissivity(Error),
}

impl Content {
    /// The same, materials that say nothing of the thermal infrared with a warning: the unit of their axis may be another.
    pub(super) fn noticed(self) -> Self {
        let noticed = |material: Material| match material.range_cm1().filter(|range| is_elsewhere(*range)) {
            None => material,
            Some((low, high)) => {
                let remark = format!(
                    "all its rows lie outside the thermal infrared of 3 to 20 um: they go from {} to {} um ({} to {} cm^-1), \
                     read as {}; if they were measured elsewhere, correct the unit in the file",
                    significant(1e4 / high, 3),
                    significant(1e4 / low, 3),
                    significant(low, 3),
                    significant(high, 3),
                    material.read_as(),
                );
                material.warn([remark])
            }
        };
        match self {
            Self::Materials(materials) => Self::Materials(materials.into_iter().map(noticed).collect()),
            other => other,
        }
    }

    /// The materials, or why there are none as an error.
    pub(super) fn materials(self) -> Result<Vec<Material>> {
        match self {
            Self::Materials(materials) => Ok(materials),
            Self::NoEmissivity(reason) => Err(reason),
        }
    }
}

/// The file's name without folders and extension, in kebab-case.
pub(crate) fn stem(path: &Path) -> String {
    let stem = path.file_stem().map(|stem| kebab_case(&stem.to_string_lossy())).unwrap_or_default();
    if stem.is_empty() { "unnamed".to_owned() } else { stem }
}

/// Non-empty parts without doubled blanks.
pub(super) fn joined(parts: &[&str], separator: &str) -> String {
    let parts = parts.iter().map(|part| one_line(part)).filter(|part| !part.is_empty());
    parts.collect::<Vec<_>>().join(separator)
}

/// A name without the words at its end that make it longer than a name should be.
pub(super) fn short_name(name: &str) -> String {
    let mut short = String::new();
    for word in name.split('-') {
        if !short.is_empty() {
            if short.chars().count() + word.chars().count() >= LONGEST_NAME {
                break;
            }
            short.push('-');
        }
        short.extend(word.chars().take(LONGEST_NAME));
    }
    short
}

/// Whether a range of wavenumbers, cm⁻¹, has nothing of the thermal infrared.
pub(super) fn is_elsewhere((low, high): (f64, f64)) -> bool {
    high < THERMAL_CM1.0 || low > THERMAL_CM1.1
}

/// What is to be said of numbers that are fractions by their size, and parts of a larger `whole` by their header.
pub(super) fn of_all(quantity: &str, most: f64, whole: f64) -> Option<String> {
    let unit = if whole == 100.0 { "percent".to_owned() } else { format!("of {whole}") };
    (whole > 1.0 && most <= 1.0).then(|| {
        format!(
            "the {quantity} is at most {} {unit}, as its header says; as a fraction it would be another",
            significant(most, 3)
        )
    })
}
