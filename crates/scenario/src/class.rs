//! The `[class.NAME]` tables of a scenario: several spectra that stand for one kind of surface ([`ClassSpec`]).
//!
//! A class may stand wherever a material of target, alternatives, envelope or library may. Its members are names of the library,
//! patterns for these, files, folders, or patterns for the files of a folder.

use super::emissivity_error;
use super::entries::{Entries, Part};
use super::paths::{Paths, file, is_path};
use super::section::{Entry, Section, without_repetition};
use super::{ClassSpec, MaterialRef, Spread};
use hadar::error::{Error, Result};
use hadar::units::Dimension;
use std::collections::BTreeMap;

const EXAMPLE: &str = "materials = [\"my_skin.csv\", \"skins/\", \"ecostress/*paint*\"]";

/// The classes of a scenario by name.
pub(super) fn read(root: &Section<'_>) -> Result<BTreeMap<String, ClassSpec>> {
    let Some(entry) = root.get("class") else { return Ok(BTreeMap::new()) };
    let all = entry.table()?;
    let mut classes = BTreeMap::new();
    for name in all.keys() {
        let Some(entry) = all.get(name) else { continue };
        let plain = |c: char| c.is_lowercase() || c.is_numeric() || c == '-';
        if name.is_empty() || !name.chars().all(plain) {
            let found = format!("`{}` is no name for a class", name.escape_debug());
            return Err(entry.fail(Error::malformed(found, "write small letters, digits and hyphens")));
        }
        classes.insert(name.to_owned(), one(&entry)?);
    }
    Ok(classes)
}

fn one(entry: &Entry<'_>) -> Result<ClassSpec> {
    let section = entry.section()?;
    let listed = section.require("materials")?;
    let items = listed.items(EXAMPLE)?;
    if items.is_empty() {
        return Err(listed.fail(Error::malformed("the class has no members", format!("write {EXAMPLE}"))));
    }
    let materials = without_repetition(&items, member)?;
    let weights = section.read("weights", |entry| {
        let weights = entry.items("weights = [2.0, 1.0]")?;
        if weights.len() != materials.len() {
            let found = format!("{} weights for {} materials", weights.len(), materials.len());
            return Err(entry.fail(Error::malformed(found, "write one for each")));
        }
        weights.iter().map(|weight| weight.number("1.0")).collect::<Result<Vec<f64>>>()
    })?;
    let sample = section.choice("covariance", &[("sample", ())])?.is_some();
    let error = emissivity_error::read(&section, emissivity_error::Of::Absolute)?;
    let length = section.quantity("correlation")?;
    let spread = Spread::stated(sample, error, length).map_err(|error| entry.fail(error))?;
    let mixtures = section.read("mixtures", Entry::boolean)?.unwrap_or(false);
    Ok(ClassSpec { materials, weights, mixtures, spread })
}

fn member(entry: &Entry<'_>) -> Result<MaterialRef> {
    let text = entry.text("\"my_skin.csv\"")?.trim();
    // A pattern without a path is one of names in the library.
    if is_path(text) { file(entry).map(MaterialRef::File) } else { Ok(MaterialRef::Name(text.to_owned())) }
}

/// The tables of classes, if there are any.
pub(super) fn all_written(classes: &BTreeMap<String, ClassSpec>, paths: Paths<'_>) -> Option<Part> {
    let one = |(name, spec): (&String, &_)| (name.clone(), written(spec, paths));
    (!classes.is_empty()).then(|| Part::Named(classes.iter().map(one).collect()))
}

fn written(class: &ClassSpec, paths: Paths<'_>) -> Entries {
    let names: Vec<String> = class.materials.iter().map(|material| paths.material(material)).collect();
    let (error, length) = match class.spread {
        Some(Spread::Stated { emissivity_error, correlation_cm1 }) => {
            (Some(emissivity_error), Some(correlation_cm1))
        }
        Some(Spread::Sample) | None => (None, None),
    };
    Entries::default()
        .put("materials", names)
        .put_if("weights", class.weights.clone())
        .put_if("mixtures", class.mixtures.then_some(true))
        .put_if("covariance", (class.spread == Some(Spread::Sample)).then_some("sample"))
        .put_if("emissivity_error", error)
        .put_quantity("correlation", Dimension::Wavenumber, length)
}
