//! The materials that a scenario names, found in the library or in files.

use super::super::Warning;
use hadar::error::{Error, Result};
use hadar::material::{Basis, Extrapolation, Library, Material};
use hadar::spectrum::Bands;
use hadar_scenario::{ClassSpec, MaterialRef, Scenario};
use std::borrow::Cow;

/// Looks materials up and collects what is to be said about them.
pub(super) struct Finder<'a> {
    scenario: &'a Scenario,
    library: &'a Library,
    pub(super) warnings: Vec<Warning>,
    /// Skies of the library that were left out of the alternatives.
    pub(super) skies: Vec<String>,
    /// Materials that do not cover the bands and were left out.
    pub(super) left_out: Vec<String>,
}

impl<'a> Finder<'a> {
    /// Before anything was looked up.
    pub(super) const fn new(scenario: &'a Scenario, library: &'a Library) -> Self {
        Self { scenario, library, warnings: Vec::new(), skies: Vec::new(), left_out: Vec::new() }
    }

    pub(super) fn find(
        &mut self,
        key: &str,
        reference: &MaterialRef,
        extrapolate: Option<Extrapolation>,
    ) -> Result<Cow<'a, Material>> {
        let found = match reference {
            MaterialRef::Name(name) if self.class(reference).is_some() => {
                let found = format!("`{name}` is a class of several spectra, and one is needed here");
                return Err(Error::malformed(found, "name a material").at(self.scenario.place(key)));
            }
            MaterialRef::Name(name) => self.library.get(name).map(Cow::Borrowed),
            // A file's own mistakes are told with the file's place, not the scenario's.
            MaterialRef::File(path) => {
                return hadar_formats::spectra::material(path)
                    .map(|m| self.accept(Cow::Owned(m), extrapolate));
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
            let (material, remark) = (material.name().to_owned(), warning.clone());
            self.warnings.push(Warning::Material { material, remark });
        }
        match extrapolate {
            Some(extrapolation) => Cow::Owned(material.into_owned().with_extrapolation(extrapolation)),
            None => material,
        }
    }

    /// Materials of the surroundings, of those that have one.
    pub(super) fn environment(&mut self) -> Result<Vec<Option<Cow<'a, Material>>>> {
        let found = self.scenario.environment.iter().enumerate().map(|(k, object)| {
            let material = object.material.as_ref()?;
            Some(self.find(&format!("environment[{k}].material"), material, object.extrapolate))
        });
        found.map(Option::transpose).collect()
    }

    /// Temperature and material of what is behind the target, where it is stated; without a material it is a blackbody.
    pub(super) fn behind(&mut self) -> Result<Option<(f64, Option<Cow<'a, Material>>)>> {
        let Some(behind) = &self.scenario.background else { return Ok(None) };
        let found = behind.material.as_ref();
        let found = found.map(|material| self.find("background.material", material, behind.extrapolate));
        Ok(Some((behind.temperature_k, found.transpose()?)))
    }

    /// What a key names: a class with all its members, or a material.
    pub(super) fn group(
        &mut self,
        key: &str,
        reference: &MaterialRef,
        extrapolate: Option<Extrapolation>,
    ) -> Result<Group<'a>> {
        let Some((name, spec)) = self.class(reference) else {
            let material = self.find(key, reference, extrapolate)?;
            return Ok(Group::of_one(material, key));
        };
        let class = hadar_formats::members(&spec, self.library).map_err(|error| match &error {
            // A file's own mistakes are told with the file's place.
            Error::At { place, .. } if place.path.is_some() => error,
            _ => error.at(self.scenario.place(&format!("class.{name}"))),
        })?;
        for reason in class.passed_over {
            let remark = format!("passed over: {reason}");
            self.warnings.push(Warning::Material { material: name.clone(), remark });
        }
        let members = class.members.into_iter().map(|member| {
            let own = format!("{name}/{}", member.material.name());
            let material = self.accept(Cow::Owned(member.material.with_name(own)), extrapolate);
            (material, member.weight)
        });
        let members = members.collect();
        Ok(Group { name, key: key.to_owned(), spec: Some(spec), members })
    }

    /// Refuses classes of the scenario that are called as materials of the library are; what is entered as one number is no spectrum,
    /// so that a class may stand in its place.
    pub(super) fn check_names(&self) -> Result<()> {
        let is_placeholder =
            |name: &str| self.library.get(name).is_ok_and(|one| one.provenance().basis == Basis::Constant);
        let mut names = self.scenario.classes.keys();
        match names.find(|name| self.library.contains(name) && !is_placeholder(name)) {
            None => Ok(()),
            Some(name) => {
                let found = format!("`{name}` is a class here and a material of the library");
                let instead = format!("call the class otherwise, such as `any-{name}`");
                Err(Error::malformed(found, instead).at(self.scenario.place(&format!("class.{name}"))))
            }
        }
    }

    /// The class that a key names, if it is one.
    fn class(&mut self, reference: &MaterialRef) -> Option<(String, ClassSpec)> {
        let MaterialRef::Name(name) = reference else { return None };
        let own = self.scenario.classes.get(name);
        let spec = own.or_else(|| self.library.class(name))?;
        if own.is_some() && self.library.contains(name) {
            let warning = Warning::ClassReplacesPlaceholder { class: name.clone() };
            if !self.warnings.contains(&warning) {
                self.warnings.push(warning);
            }
        }
        if own.is_none() {
            self.left_out.extend_from_slice(self.library.without(name));
        }
        Some((name.clone(), spec.clone()))
    }

    /// A class without the members that do not cover the bands: refused, or left out with a warning where that is asked for.
    pub(super) fn covering(
        &mut self,
        group: Group<'a>,
        bands: &Bands,
        extrapolate: Option<Extrapolation>,
    ) -> Result<Group<'a>> {
        if group.spec.is_none() {
            return Ok(group);
        }
        let (low, high) = bands.range_cm1();
        let of = group.members.len();
        let (kept, left): (Vec<_>, Vec<_>) =
            group.members.into_iter().partition(|(material, _)| covers(material, bands, extrapolate));
        let names: Vec<&str> = left.iter().map(|(material, _)| material.name()).collect();
        if !names.is_empty() && (kept.is_empty() || !self.scenario.alternatives.skip_uncovered) {
            let (count, shown) = (names.len(), shortened(&names));
            let found = format!(
                "{count} of {of} members of `{}` do not cover the bands ({low} to {high} cm^-1): {shown}",
                group.name
            );
            let instead = if kept.is_empty() {
                "choose bands that the spectra cover, or extrapolate = \"hold\""
            } else {
                "leave them out with --skip-uncovered, name others, or choose other bands"
            };
            return Err(Error::malformed(found, instead).at(self.scenario.place(&group.key)));
        }
        self.leave_out(&names);
        let total: f64 = kept.iter().map(|(_, weight)| weight).sum();
        let share = |weight: f64| if total > 0.0 { weight / total } else { 1.0 / kept.len() as f64 };
        let weights: Vec<f64> = kept.iter().map(|(_, weight)| share(*weight)).collect();
        let members = kept.into_iter().map(|(material, _)| material).zip(weights).collect();
        Ok(Group { members, ..group })
    }

    /// The alternatives named, or every other surface of the library. Those that do not cover the bands are
    /// refused, or left out with a warning where the scenario asks for it.
    pub(super) fn alternatives(&mut self, target: &Group<'_>, bands: &Bands) -> Result<Vec<Group<'a>>> {
        let wanted = &self.scenario.alternatives;
        let found: Vec<Group<'a>> = match &wanted.materials {
            Some(materials) => {
                let found = materials.iter().enumerate().map(|(i, material)| {
                    self.group(&format!("alternatives.materials[{i}]"), material, wanted.extrapolate)
                });
                let mut found: Vec<Group<'a>> = found.collect::<Result<_>>()?;
                // The target cannot be told from itself; alone it stays, so that the answer says so.
                let own = materials.iter().position(|material| *material == self.scenario.target.material);
                if let Some(own) = own
                    && found.len() > 1
                    && !wanted.own_too
                {
                    found.remove(own);
                    let target = target.name.clone();
                    self.left_out.push(target.clone());
                    self.warnings.push(Warning::TargetAmongAlternatives { target });
                }
                found
            }
            None => {
                let is_target = |name: &str| {
                    // Members of a class are called after it; a class may stand in the place of a material.
                    let own = |(own, _): &(Cow<'_, Material>, f64)| {
                        own.name() == name
                            || own.name().strip_prefix(&format!("{}/", target.name)) == Some(name)
                    };
                    target.name == name || target.members.iter().any(own)
                };
                let others = self.library.names().filter(|name| !is_target(name));
                let (surfaces, skies): (Vec<_>, Vec<_>) = others.partition(|name| is_surface(name));
                self.skies = skies.into_iter().map(str::to_owned).collect();
                let library = self.library;
                let accepted = surfaces.into_iter().map(|name| {
                    let material = self.accept(Cow::Borrowed(library.get(name)?), wanted.extrapolate);
                    Ok(Group::of_one(material, "alternatives"))
                });
                accepted.collect::<Result<_>>()?
            }
        };
        if found.is_empty() {
            let instead = "name alternatives.materials, or add spectra with --library";
            let error = Error::malformed("the library has no other material than the target", instead);
            return Err(error.at(self.scenario.place("alternatives")));
        }
        let found = found.into_iter().map(|group| self.covering(group, bands, wanted.extrapolate));
        let found = found.collect::<Result<Vec<_>>>()?;
        if wanted.materials.is_some() && !wanted.skip_uncovered {
            // Said of each by name and key when it is sampled.
            return Ok(found);
        }
        let (low, high) = bands.range_cm1();
        let (kept, left): (Vec<_>, Vec<_>) = found.into_iter().partition(|group| {
            group.members.iter().all(|(material, _)| covers(material, bands, wanted.extrapolate))
        });
        let names: Vec<&str> = left.iter().map(|group| group.name.as_str()).collect();
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
        self.leave_out(&names);
        Ok(kept)
    }

    /// Materials that do not cover the bands.
    fn leave_out(&mut self, names: &[&str]) {
        for name in names {
            self.left_out.push((*name).to_owned());
            self.warnings.push(Warning::MaterialSkipped { material: (*name).to_owned() });
        }
    }
}

/// A class or a material that a key names.
pub(super) struct Group<'a> {
    /// Name of the class, or of the material.
    pub(super) name: String,
    /// Where it stands.
    pub(super) key: String,
    /// What the class is, if it is one.
    pub(super) spec: Option<ClassSpec>,
    /// Its spectra with their weights.
    pub(super) members: Vec<(Cow<'a, Material>, f64)>,
}

impl<'a> Group<'a> {
    /// That a member is not known at the edges of all bands, by its key.
    pub(super) fn short_of(&self, bands: &Bands, scenario: &Scenario) -> Option<Error> {
        let ends: Vec<f64> = bands.bands().iter().flat_map(|band| [band.low_cm1, band.high_cm1]).collect();
        let error = self.members.iter().find_map(|(material, _)| material.emissivity(&ends).err())?;
        Some(error.at(scenario.place(&self.key)))
    }

    fn of_one(material: Cow<'a, Material>, key: &str) -> Self {
        let (name, key) = (material.name().to_owned(), key.to_owned());
        Self { name, key, spec: None, members: vec![(material, 1.0)] }
    }
}

pub(super) fn covers(material: &Material, bands: &Bands, extrapolate: Option<Extrapolation>) -> bool {
    let (low, high) = bands.range_cm1();
    let range = material.range_cm1();
    extrapolate.is_some() || range.is_none_or(|(first, last)| first <= low && last >= high)
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
