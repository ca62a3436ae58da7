//! Names that no two materials of several files share: their own where that will do, else `NAME@TAG`.
//!
//! The tag is the number of the measured sample; where that is missing or the same, what the file's name has that the others' have not. It depends on
//! which files share the name, not on their order.

use super::content::stem;
use crate::error::{Error, Result};
use crate::material::Material;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Stems of files that are short enough to tell whole.
const SHORT: usize = 24;

/// What tells a material from others of its name.
#[derive(Debug, Clone)]
pub(in crate::physics::material) struct Origin {
    /// Its own name.
    pub(in crate::physics::material) name: String,
    /// Number of the sample, if there is one.
    pub(in crate::physics::material) sample: String,
    /// Name of its file, in kebab-case.
    pub(in crate::physics::material) stem: String,
}

/// Names of materials with the files they were read from.
///
/// # Errors
/// Materials of one name and sample in files that are called alike.
///
/// ```
/// use hadar::material::read::{from_text, unique_names};
/// use std::path::Path;
/// let file = |sample: &str| {
///     let text = format!(
///         "Name: Black paint\nSample No.: {sample}\nX Units: Wavelength (micrometers)\n\
///          Y Units: Reflectance (percent)\n\n7\t5\n14\t6\n"
///     );
///     from_text(&text, Path::new("paint.txt")).map(|mut read| read.remove(0))
/// };
/// let materials = [file("0402UUU")?, file("0403UUU")?];
/// let names = unique_names(&materials.each_ref().map(|material| (material, Path::new("paint.txt"))))?;
/// assert_eq!(names, ["black-paint@0402uuu", "black-paint@0403uuu"]);
/// # Ok::<(), hadar::Error>(())
/// ```
pub fn unique_names(materials: &[(&Material, &Path)]) -> Result<Vec<String>> {
    let origin = |(material, file): &(&Material, &Path)| Origin {
        name: material.name.clone(),
        sample: material.sample.clone(),
        stem: stem(file),
    };
    let origins: Vec<Origin> = materials.iter().map(origin).collect();
    let names = qualified(&origins);
    let mut seen: BTreeMap<&str, usize> = BTreeMap::new();
    for (at, name) in names.iter().enumerate() {
        if let Some(before) = seen.insert(name, at) {
            let shown = |at: usize| {
                materials.get(at).map_or_else(String::new, |(_, file)| file.display().to_string())
            };
            let found = format!("`{name}` is defined by {} and by {}", shown(before), shown(at));
            return Err(Error::malformed(found, "rename one of the files, or leave one out"));
        }
    }
    Ok(names)
}

/// The name of a material that stands beside others of its name, `NAME@TAG`; the tag is its sample's number, else its file's name.
#[must_use]
pub fn tagged_name(material: &Material, file: &Path) -> String {
    let tag = if material.sample.is_empty() { stem(file) } else { material.sample.clone() };
    format!("{}@{tag}", material.name)
}

/// The names, those that several have with what tells them apart; the same name twice where nothing does.
pub(in crate::physics::material) fn qualified(origins: &[Origin]) -> Vec<String> {
    let mut places: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    for (at, origin) in origins.iter().enumerate() {
        places.entry(&origin.name).or_default().push(at);
    }
    let mut names: Vec<String> = origins.iter().map(|origin| origin.name.clone()).collect();
    for same in places.values().filter(|same| same.len() > 1) {
        let group: Vec<&Origin> = same.iter().filter_map(|at| origins.get(*at)).collect();
        let samples: BTreeSet<&str> = group.iter().map(|origin| origin.sample.as_str()).collect();
        let tags = if samples.len() == group.len() && !samples.contains("") {
            group.iter().map(|origin| origin.sample.clone()).collect()
        } else if group.iter().all(|origin| origin.stem.chars().count() <= SHORT) {
            group.iter().map(|origin| origin.stem.clone()).collect()
        } else {
            differing(&group.iter().map(|origin| origin.stem.as_str()).collect::<Vec<_>>())
        };
        for (at, tag) in same.iter().zip(tags) {
            if let Some(name) = names.get_mut(*at) {
                *name = format!("{name}@{tag}").trim_end_matches('@').to_owned();
            }
        }
    }
    names
}

/// What each stem has between the parts that all begin and end with.
pub(in crate::physics::material) fn differing(stems: &[&str]) -> Vec<String> {
    let parts: Vec<Vec<&str>> =
        stems.iter().map(|stem| stem.split('-').filter(|part| !part.is_empty()).collect()).collect();
    let shortest = parts.iter().map(Vec::len).min().unwrap_or(0);
    let alike = |part: &dyn Fn(&Vec<&str>, usize) -> Option<String>| {
        let same = |k: &usize| {
            let mut all = parts.iter().map(|parts| part(parts, *k));
            let first = all.next();
            all.all(|other| Some(other) == first)
        };
        (0..shortest).take_while(same).count()
    };
    let first = alike(&|parts, k| parts.get(k).map(|part| (*part).to_owned()));
    let last = alike(&|parts, k| {
        parts.len().checked_sub(k + 1).and_then(|at| parts.get(at)).map(|part| (*part).to_owned())
    });
    let own = |parts: &Vec<&str>| {
        parts.get(first..parts.len().saturating_sub(last).max(first)).unwrap_or_default().join("-")
    };
    parts.iter().map(own).collect()
}
