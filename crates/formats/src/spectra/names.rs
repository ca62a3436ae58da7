//! Names that no two materials of several files share: their own where that will do, else `NAME@TAG`.
//!
//! The tag is the number of the measured sample; where that is missing or the same, what the file's name has that the others' have not;
//! where that is the same too, what its path has. It depends on which files share the name, not on their order.

use super::content::stem;
use hadar::material::Material;
use hadar::words::kebab_case;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Stems of files that are short enough to tell whole.
const SHORT: usize = 24;

/// What tells a material from others of its name.
#[derive(Debug, Clone)]
pub(crate) struct Origin {
    /// Its own name.
    pub(crate) name: String,
    /// Number of the sample, if there is one.
    pub(crate) sample: String,
    /// Its file.
    pub(crate) file: PathBuf,
}

/// Names of materials with the files they were read from, each only once.
///
/// ```
/// use hadar_formats::spectra::{from_text, unique_names};
/// use std::path::Path;
/// let file = |sample: &str| {
///     let text = format!(
///         "Name: Black paint\nSample No.: {sample}\nX Units: Wavelength (micrometers)\n\
///          Y Units: Reflectance (percent)\n\n7\t5\n14\t6\n"
///     );
///     from_text(&text, Path::new("paint.txt")).map(|mut read| read.remove(0))
/// };
/// let materials = [file("0402UUU")?, file("0403UUU")?];
/// let names = unique_names(&materials.each_ref().map(|material| (material, Path::new("paint.txt"))));
/// assert_eq!(names, ["black-paint@0402uuu", "black-paint@0403uuu"]);
/// # Ok::<(), hadar::Error>(())
/// ```
#[must_use]
pub fn unique_names(materials: &[(&Material, &Path)]) -> Vec<String> {
    let origin = |(material, file): &(&Material, &Path)| Origin {
        name: material.name().to_owned(),
        sample: material.sample().to_owned(),
        file: file.to_path_buf(),
    };
    qualified(&materials.iter().map(origin).collect::<Vec<_>>())
}

/// The name of a material that stands beside others of its name, `NAME@TAG`; the tag is its sample's number, else its file's name.
#[must_use]
pub fn tagged_name(material: &Material, file: &Path) -> String {
    let tag = if material.sample().is_empty() { stem(file) } else { material.sample().to_owned() };
    format!("{}@{tag}", material.name())
}

/// The names, those that several have with what tells them apart; a number does where nothing else does.
pub(crate) fn qualified(origins: &[Origin]) -> Vec<String> {
    let mut places: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    for (at, origin) in origins.iter().enumerate() {
        places.entry(&origin.name).or_default().push(at);
    }
    let mut names: Vec<String> = origins.iter().map(|origin| origin.name.clone()).collect();
    for same in places.values().filter(|same| same.len() > 1) {
        let group: Vec<&Origin> = same.iter().filter_map(|at| origins.get(*at)).collect();
        let samples: Vec<String> = group.iter().map(|origin| origin.sample.clone()).collect();
        let stems: Vec<String> = group.iter().map(|origin| stem(&origin.file)).collect();
        let tags = if all_differ(&samples) && samples.iter().all(|sample| !sample.is_empty()) {
            samples
        } else if !all_differ(&stems) {
            let paths = group.iter().map(|origin| kebab_case(&origin.file.to_string_lossy()));
            differing(&paths.collect::<Vec<_>>())
        } else if stems.iter().all(|stem| stem.chars().count() <= SHORT) {
            stems
        } else {
            differing(&stems)
        };
        for (at, tag) in same.iter().zip(tags) {
            if let Some(name) = names.get_mut(*at) {
                *name = format!("{name}@{tag}").trim_end_matches('@').to_owned();
            }
        }
    }
    let mut in_order: Vec<usize> = (0..origins.len()).collect();
    in_order.sort_by_key(|at| origins.get(*at).map(|origin| &origin.file));
    let mut taken = BTreeSet::new();
    for at in in_order {
        let Some(name) = names.get_mut(at) else { continue };
        let own = name.clone();
        let mut number = 1_usize;
        while !taken.insert(name.clone()) {
            number += 1;
            *name = format!("{own}-{number}");
        }
    }
    names
}

fn all_differ(texts: &[String]) -> bool {
    texts.iter().collect::<BTreeSet<_>>().len() == texts.len()
}

/// What each stem has between the parts that all begin and end with.
pub(crate) fn differing(stems: &[String]) -> Vec<String> {
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
