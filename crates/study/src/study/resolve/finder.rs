//! The materials that a scenario names, found in the library or in files.

use super::super::Warning;
use crate::scenario::{MaterialRef, Scenario};
use hadar::error::{Error, Result};
use hadar::material::{Extrapolation, Library, Material};
use hadar::spectrum::Bands;
use std::borrow::Cow;

/// Looks materials up and collects what is to be said about them.
pub(super) struct Finder<'a> {
    pub(super) scenario: &'a Scenario,
    pub(super) library: &'a Library,
    pub(super) warnings: Vec<Warning>,
    /// Skies of the library that were left out of the alternatives.
    pub(super) skies: Vec<String>,
}

impl<'a> Finder<'a> {
    pub(super) fn find(
        &mut self,
        key: &str,
        reference: &MaterialRef,
        extrapolate: Option<Extrapolation>,
    ) -> Result<Cow<'a, Material>> {
        let found = match reference {
            MaterialRef::Name(name) => self.library.get(name).map(Cow::Borrowed),
            // A file's own mistakes are told with the file's place, not the scenario's.
            MaterialRef::File(path) => {
                return Material::from_file(path).map(|m| self.accept(Cow::Owned(m), extrapolate));
            }
        };
        found
            .map(|material| self.accept(material, extrapolate))
            .map_err(|error| error.at(self.scenario.place(key)))
    }

    fn accept(
        &mut self,
        material: Cow<'a, Material>,
        extrapolate: Option<Extrapolation>,
    ) -> Cow<'a, Material> {
        for warning in material.warnings() {
            self.warnings.push(Warning::new("material", format!("{}: {warning}", material.name())));
        }
        match extrapolate {
            Some(extrapolation) => Cow::Owned(material.into_owned().with_extrapolation(extrapolation)),
            None => material,
        }
    }

    /// The alternatives named, or every other surface of the library. Those that do not cover the bands are
    /// refused, or left out with a warning where the scenario asks for it.
    pub(super) fn alternatives(
        &mut self,
        target: &Material,
        bands: &Bands,
    ) -> Result<Vec<Cow<'a, Material>>> {
        let wanted = &self.scenario.alternatives;
        let found: Vec<Cow<'a, Material>> = match &wanted.materials {
            Some(materials) => {
                let found = materials.iter().enumerate().map(|(i, material)| {
                    self.find(&format!("alternatives.materials[{i}]"), material, wanted.extrapolate)
                });
                let mut found: Vec<Cow<'a, Material>> = found.collect::<Result<_>>()?;
                // The target cannot be told from itself; alone it stays, so that the answer says so.
                let own = materials.iter().position(|material| *material == self.scenario.target.material);
                if let Some(own) = own
                    && found.len() > 1
                {
                    found.remove(own);
                    let message =
                        format!("{} is left out of the alternatives: it is the target", target.name());
                    self.warnings.push(Warning::new("target-among-alternatives", message));
                }
                found
            }
            None => {
                let others = self.library.names().filter(|name| *name != target.name());
                let (surfaces, skies): (Vec<_>, Vec<_>) = others.partition(|name| is_surface(name));
                self.skies = skies.into_iter().map(str::to_owned).collect();
                let library = self.library;
                let accepted = surfaces
                    .into_iter()
                    .map(|name| Ok(self.accept(Cow::Borrowed(library.get(name)?), wanted.extrapolate)));
                accepted.collect::<Result<_>>()?
            }
        };
        if found.is_empty() {
            let instead = "name alternatives.materials, or add spectra with --library";
            let error = Error::malformed("the library has no other material than the target", instead);
            return Err(error.at(self.scenario.place("alternatives")));
        }
        if wanted.materials.is_some() && !wanted.skip_uncovered {
            // Said of each by name and key when it is sampled.
            return Ok(found);
        }
        let (low, high) = bands.range_cm1();
        let (kept, left): (Vec<_>, Vec<_>) = found.into_iter().partition(|material| {
            let range = material.range_cm1();
            wanted.extrapolate.is_some() || range.is_none_or(|(first, last)| first <= low && last >= high)
        });
        let names: Vec<&str> = left.iter().map(|material| material.name()).collect();
        if names.is_empty() {
            return Ok(kept);
        }
        if !wanted.skip_uncovered || kept.is_empty() {
            let found = format!(
                "{} of {} alternatives do not cover the bands ({low} to {high} cm^-1): {}",
                names.len(),
                names.len() + kept.len(),
                shortened(&names)
            );
            let instead = if kept.is_empty() {
                "choose bands that the spectra cover, or alternatives.extrapolate = \"hold\""
            } else {
                "leave them out with --skip-uncovered, name alternatives.materials, or choose other bands"
            };
            return Err(Error::malformed(found, instead).at(self.scenario.place("alternatives")));
        }
        for name in names {
            let message = format!("{name} is left out: its spectrum does not cover the bands");
            self.warnings.push(Warning::new("material-skipped", message));
        }
        Ok(kept)
    }
}

/// The first few of many names.
fn shortened(names: &[&str]) -> String {
    const SHOWN: usize = 6;
    let shown = names.iter().take(SHOWN).copied().collect::<Vec<_>>().join(", ");
    match names.len().checked_sub(SHOWN) {
        Some(more) if more > 0 => format!("{shown} and {more} more"),
        _ => shown,
    }
}

/// Skies are surroundings, not something a target could be made of.
fn is_surface(name: &str) -> bool {
    !name.starts_with("sky-") && name != "sky"
}
