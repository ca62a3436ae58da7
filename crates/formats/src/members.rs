//! The members of a class, found in a library or in files ([`ClassSpec`]).
//!
//! Names are unique in a class: where several files define the same, it is told by what tells the files' names apart.

use crate::spectra as read;
use hadar::error::{Error, Result, check};
use hadar::material::{ClassSpec, Library, Material, MaterialRef, Spread};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// A member of a class.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Member {
    /// The material, by a name that no other member has.
    pub material: Material,
    /// Its share of the class.
    pub weight: f64,
}

/// A class with its spectra.
#[derive(Debug, Clone)]
pub struct Class {
    /// Its members; at least one.
    pub members: Vec<Member>,
    /// Files of folders that were passed over since they hold no emissivity, and why.
    pub passed_over: Vec<String>,
}

/// Reads the members of a class, names in `library`.
///
/// # Errors
/// No members, as many weights as there are not materials, weights of nothing, an unknown name, a file that cannot be used.
pub fn members(class: &ClassSpec, library: &Library) -> Result<Class> {
    if class.materials.is_empty() {
        return Err(Error::malformed("the class has no members", "write materials = [\"my_skin.csv\"]"));
    }
    let weights = class.weights.clone().unwrap_or_else(|| vec![1.0; class.materials.len()]);
    if weights.len() != class.materials.len() {
        let found = format!("{} weights for {} materials", weights.len(), class.materials.len());
        return Err(Error::malformed(found, "write one for each"));
    }
    weights.iter().try_for_each(|weight| check::non_negative("weight of a class", *weight, "").map(drop))?;
    let (mut found, mut passed_over, mut known) = (Vec::new(), Vec::new(), BTreeSet::new());
    for (reference, weight) in class.materials.iter().zip(weights) {
        let mut own = Vec::new();
        match reference {
            MaterialRef::Name(pattern) if pattern.contains(['*', '?']) => {
                let names = library.names().filter(|name| matches(pattern.as_bytes(), name.as_bytes()));
                for name in names {
                    let material = library.get(name)?;
                    // A sky is no surface, whatever it is called.
                    if material.provenance().category != "sky" {
                        own.push((material.clone(), None));
                    }
                }
                if own.is_empty() {
                    let found = format!("no material of the library is called like `{pattern}`");
                    return Err(Error::malformed(
                        found,
                        "correct the pattern, or add spectra with --library",
                    ));
                }
            }
            MaterialRef::Name(name) if library.class(name).is_some() => {
                let found = format!("`{name}` is a class itself");
                return Err(Error::malformed(found, "name its members"));
            }
            MaterialRef::Name(name) => own.push((library.get(name)?.clone(), None)),
            MaterialRef::File(path) => {
                let read::Folder { files, passed_over: forks } = files(path)?;
                passed_over.extend(forks.iter().map(Error::to_string));
                for file in files {
                    if !known.insert(file.clone()) {
                        let found = format!("`{}` is in the class twice", file.display());
                        return Err(Error::malformed(found, "name every spectrum once"));
                    }
                    match read::from_file(&file) {
                        Ok(all) => own.extend(all.into_iter().map(|material| (material, Some(file.clone())))),
                        // A file that was named itself must hold a spectrum.
                        Err(error) if file == *path || library.is_strict() => return Err(error),
                        Err(error) => passed_over.push(error.to_string()),
                    }
                }
            }
        }
        let share = weight / own.len() as f64;
        found.extend(own.into_iter().map(|(material, file)| (material, file, share)));
    }
    let total: f64 = found.iter().map(|(.., weight)| weight).sum();
    if found.is_empty() {
        return Err(Error::malformed(
            "the class has no members: none of its files holds a spectrum",
            "name files of emissivity or reflectance",
        ));
    }
    if !(total > 0.0 && total.is_finite()) {
        return Err(Error::malformed(
            "the weights of the class add up to nothing",
            "write numbers of at least 0, one of them above",
        ));
    }
    let names = unique_names(&found)?;
    let members = found.into_iter().zip(names).map(|((material, _, weight), name)| Member {
        material: material.with_name(name),
        weight: weight / total,
    });
    let members: Vec<Member> = members.collect();
    let squares: f64 = members.iter().map(|member| member.weight * member.weight).sum();
    if class.spread == Some(Spread::Sample) && (members.len() < 2 || squares > 1.0 - 1e-9) {
        let found = "the covariance of a sample of one spectrum";
        return Err(Error::malformed(found, "add spectra, or state emissivity_error and correlation"));
    }
    if class.spread == Some(Spread::Sample) && class.mixtures {
        let found = "mixtures of a class that stands as its mean";
        return Err(Error::malformed(found, "keep mixtures or covariance"));
    }
    Ok(Class { members, passed_over })
}

/// The files of a path: of a folder all its spectra, of a pattern those that match, else the one.
fn files(path: &Path) -> Result<read::Folder> {
    if path.is_dir() {
        return some(read::spectra_in(path)?, path);
    }
    let pattern = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    if !pattern.contains(['*', '?']) {
        return Ok(read::Folder { files: vec![path.to_owned()], ..read::Folder::default() });
    }
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut found = read::spectra_in(folder)?;
    found.files.retain(|file| {
        file.file_name().is_some_and(|name| matches(pattern.as_bytes(), name.to_string_lossy().as_bytes()))
    });
    some(found, path)
}

fn some(found: read::Folder, path: &Path) -> Result<read::Folder> {
    if found.files.is_empty() {
        let found = "no file of spectra is here";
        return Err(Error::malformed(found, "correct the path or the pattern").in_file(path));
    }
    Ok(found)
}

/// Whether a name matches a pattern of `*` (any characters) and `?` (one).
fn matches(pattern: &[u8], name: &[u8]) -> bool {
    // Where the last star stands, and how much of the name it has taken.
    let (mut p, mut n, mut star) = (0, 0, None);
    while n < name.len() {
        match pattern.get(p) {
            Some(b'*') => {
                star = Some((p, n));
                p += 1;
            }
            Some(&c) if c == b'?' || c == name[n] => (p, n) = (p + 1, n + 1),
            _ => match &mut star {
                Some((at, taken)) => {
                    *taken += 1;
                    (p, n) = (*at + 1, *taken);
                }
                None => return false,
            },
        }
    }
    pattern[p..].iter().all(|c| *c == b'*')
}

/// The materials' own names; where several have the same, with what tells their files apart.
fn unique_names(found: &[(Material, Option<PathBuf>, f64)]) -> Result<Vec<String>> {
    // A library qualifies names that several files define with those of the files.
    let own = |material: &Material| -> (String, Option<String>) {
        match material.name().split_once('@') {
            Some((name, file)) => (name.to_owned(), Some(file.to_owned())),
            None => (material.name().to_owned(), None),
        }
    };
    let mut places: BTreeMap<String, Vec<usize>> = BTreeMap::new();
    for (i, (material, ..)) in found.iter().enumerate() {
        places.entry(own(material).0).or_default().push(i);
    }
    let mut names: Vec<String> = found.iter().map(|(material, ..)| own(material).0).collect();
    for same in places.values().filter(|same| same.len() > 1) {
        let stem = |i: &usize| {
            let (material, file, _) = &found[*i];
            own(material).1.or_else(|| file.as_deref().map(read::stem)).unwrap_or_default()
        };
        let stems: Vec<String> = same.iter().map(stem).collect();
        let tags = read::differing(&stems);
        for (i, tag) in same.iter().zip(tags) {
            names[*i] = format!("{}@{tag}", names[*i]).trim_end_matches('@').to_owned();
        }
    }
    let mut seen = BTreeSet::new();
    match names.iter().find(|name| !seen.insert(name.as_str())) {
        None => Ok(names),
        Some(twice) => {
            Err(Error::malformed(format!("`{twice}` is in the class twice"), "name every spectrum once"))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_match_names() {
        let cases = [
            ("vegetation.*", "vegetation.grass.txt", true),
            ("*paint*.txt", "manmade.paint.385.txt", true),
            ("*paint*.txt", "manmade.paint.385.csv", false),
            ("a?c*", "abcd", true),
            ("a?c*", "acd", false),
            ("*", "", true),
            ("*ab", "aab", true),
            ("a", "ab", false),
        ];
        for (pattern, name, expected) in cases {
            assert_eq!(matches(pattern.as_bytes(), name.as_bytes()), expected, "{pattern} {name}");
        }
    }

    #[test]
    fn names_that_are_the_same_are_told_by_their_files() {
        let paint =
            |file: &str| (Material::constant("black-paint", 0.9).unwrap(), Some(PathBuf::from(file)), 1.0);
        let found = [paint("x/solid.0402uuu.jhu.txt"), paint("x/solid.0403uuu.jhu.txt")];
        assert_eq!(unique_names(&found).unwrap(), ["black-paint@0402uuu", "black-paint@0403uuu"]);
        assert!(unique_names(&[paint("a.txt"), paint("a.txt")]).unwrap_err().to_string().contains("twice"));
    }

    #[test]
    fn weights_are_shares() {
        let library = Library::embedded().unwrap();
        let named = |names: &[&str], weights: Option<Vec<f64>>| ClassSpec {
            materials: names.iter().map(|name| MaterialRef::Name((*name).to_owned())).collect(),
            weights,
            mixtures: false,
            spread: None,
        };
        let class = members(&named(&["gold", "iron"], Some(vec![3.0, 1.0])), &library).unwrap();
        assert_eq!(class.members.iter().map(|member| member.weight).collect::<Vec<_>>(), [0.75, 0.25]);
        for (spec, found) in [
            (named(&[], None), "no members"),
            (named(&["gold"], Some(vec![])), "0 weights for 1 materials"),
            (named(&["gold"], Some(vec![0.0])), "add up to nothing"),
            (named(&["gold", "gold"], None), "`gold` is in the class twice"),
            (named(&["golf"], None), "golf"),
        ] {
            let error = members(&spec, &library).unwrap_err().to_string();
            assert!(error.contains(found), "{error}");
        }
    }
}
