//! The arrows of use point down: between packages, between the storeys of the numerical crate, and in no circle of files.
//!
//! Read are `use` lines and paths that begin with `crate`, `self`, `super` or a child module, macros included; a name is
//! followed through re-exports to the file that has it. Test modules are left out. A file that only hands on what its own
//! children have (`mod child`, `pub use child::Thing`) does not use them; what it does itself with such a name is not seen.

use crate::support::uses::{File, above, join};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Packages and storeys from the ground up; each uses only those before it.
const PACKAGES: [(&str, &str); 11] = [
    ("hadar", "."),
    ("hadar-formats", "crates/formats"),
    ("hadar-estimate", "crates/estimate"),
    ("hadar-simulate", "crates/simulate"),
    ("hadar-scenario", "crates/scenario"),
    ("hadar-study", "crates/study"),
    ("hadar-report", "crates/report"),
    ("hadar-serve", "crates/serve"),
    ("hadar-elementary", "crates/elementary"),
    ("hadar-cli", "crates/cli"),
    ("hadar-evidence", "crates/evidence"),
];
const STOREYS: [&str; 4] = ["base", "physics", "instrument", "limits"];

/// The files of a package by their module; the root has no name.
#[derive(Default)]
struct Package(BTreeMap<String, File>);

impl Package {
    fn made_up(files: &[(&str, &str)]) -> Self {
        Self(files.iter().map(|(module, text)| ((*module).to_owned(), File::read(module, text))).collect())
    }

    fn of(package: &str) -> Self {
        let mut files = Self::default();
        files.add(&hadar_testing::repository().join(package).join("src"), "");
        files
    }

    fn add(&mut self, folder: &Path, within: &str) {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_stem().unwrap().to_string_lossy();
            // A program beside a library is a file of its own.
            let root = if folder.join("lib.rs").exists() { "lib" } else { "main" };
            let module = if name == root { within.to_owned() } else { join(within, &name) };
            if name != "tests" && path.is_dir() {
                self.add(&path, &module);
            } else if name != "tests" && path.extension().is_some_and(|kind| kind == "rs") {
                let file = File::read(&module, &std::fs::read_to_string(&path).unwrap());
                self.0.insert(module, file);
            }
        }
    }

    /// The file that a path leads to from a module, re-exports followed; `None` where that is another package.
    fn file(&self, from: &str, path: &str) -> Option<String> {
        let first = path.split("::").next()?;
        if !["crate", "self", "super"].contains(&first) && !self.0.contains_key(&join(from, first)) {
            return None;
        }
        let mut at = from.to_owned();
        let mut rest = path;
        while let Some(name) = rest.split("::").next().filter(|name| !name.is_empty()) {
            rest = rest[name.len()..].trim_start_matches("::");
            match name {
                "crate" => at.clear(),
                "self" => {}
                "super" => at = above(&at).to_owned(),
                _ if self.0.contains_key(&join(&at, name)) => at = join(&at, name),
                _ => {
                    let exported = self.0.get(&at).and_then(|file| file.exported.get(name));
                    let origin = exported.and_then(|origin| self.file(&at, &join(origin, rest)));
                    return Some(origin.unwrap_or_else(|| self.written(at)));
                }
            }
        }
        Some(self.written(at))
    }

    /// The file that a module is written in.
    fn written(&self, mut module: String) -> String {
        while !self.0.contains_key(&module) && !module.is_empty() {
            module = above(&module).to_owned();
        }
        module
    }

    /// Every arrow: the file that uses, the file used, and as what.
    fn arrows(&self) -> BTreeMap<(&str, String), BTreeSet<&str>> {
        let mut arrows: BTreeMap<_, BTreeSet<_>> = BTreeMap::new();
        for (module, file) in &self.0 {
            for (place, path, handed_on) in &file.used {
                let Some(used) = self.file(place, path).filter(|used| used != module) else { continue };
                if !(*handed_on && (module.is_empty() || used.starts_with(&format!("{module}::")))) {
                    arrows.entry((module.as_str(), used)).or_default().insert(path.as_str());
                }
            }
        }
        arrows
    }

    /// Arrows from a storey to a later one; what is in none stands above all.
    fn upward(&self) -> Vec<String> {
        let first = |module: &str| module.split("::").next().unwrap_or_default().to_owned();
        let storey = |module: &str| STOREYS.iter().position(|storey| *storey == first(module)).unwrap_or(9);
        let arrows = self.arrows().into_iter().filter(|((from, to), _)| storey(to) > storey(from));
        arrows.map(|((from, to), paths)| format!("{from} -> {to} {paths:?}")).collect()
    }

    /// Circles of files, each as the arrows that make it.
    fn circles(&self) -> Vec<String> {
        let arrows = self.arrows();
        let reached = |start: &str| {
            let (mut reached, mut open) = (BTreeSet::new(), vec![start.to_owned()]);
            while let Some(file) = open.pop() {
                let next = arrows.keys().filter(|(from, _)| *from == file).map(|(_, to)| to);
                open.extend(next.filter(|to| reached.insert((*to).clone())).cloned());
            }
            reached
        };
        let reached: BTreeMap<&str, BTreeSet<String>> =
            self.0.keys().map(|file| (&**file, reached(file))).collect();
        let round = |a: &str, b: &str| reached[a].contains(b) && reached[b].contains(a);
        let first = |file: &&str| reached.keys().find(|other| round(other, file)) == Some(file);
        let circle = |file: &str| {
            let inside = arrows.iter().filter(|((from, to), _)| round(file, from) && round(file, to));
            inside.map(|((from, to), paths)| format!("    {from} -> {to} {paths:?}\n")).collect()
        };
        reached.keys().copied().filter(first).map(circle).collect()
    }
}

#[test]
fn packages_depend_on_those_before() {
    for (place, package) in PACKAGES.into_iter().enumerate() {
        let manifest = hadar_testing::repository().join(package.1).join("Cargo.toml");
        let manifest = std::fs::read_to_string(manifest).unwrap();
        let section = manifest.split("\n[dependencies]\n").nth(1).unwrap().split("\n[").next().unwrap();
        let used = section.lines().filter_map(|line| line.split(['.', ' ', '=']).next());
        for used in used.filter(|used| used.starts_with("hadar") && *used != "hadar-testing") {
            assert!(PACKAGES[..place].iter().any(|below| below.0 == used), "{} depends on {used}", package.0);
        }
    }
}

#[test]
fn no_files_in_the_numerical_crate() {
    let opens = |file: &File| file.used.iter().any(|(_, path, _)| path.starts_with("std::fs"));
    let files = Package::of(".").0;
    let found: Vec<&str> =
        files.iter().filter(|(_, file)| opens(file)).map(|(module, _)| module.as_str()).collect();
    assert!(found.is_empty(), "{found:?}");
}

#[test]
fn storeys_use_those_below() {
    let upward = Package::of(".").upward();
    assert!(upward.is_empty(), "{} arrows upward:\n{}", upward.len(), upward.join("\n"));
}

#[test]
fn files_use_each_other_in_no_circle() {
    let found = PACKAGES.map(|(name, folder)| (name, Package::of(folder).circles()));
    let said = found
        .iter()
        .flat_map(|(name, circles)| circles.iter().map(move |circle| format!("{name}\n{circle}")));
    let said: Vec<String> = said.collect();
    assert!(said.is_empty(), "{} circles of files\n{}", said.len(), said.join("\n"));
}

const HANDED_ON: (&str, &str) =
    ("", "mod base; mod limits; pub use limits::fisher; pub(crate) use base::sum::{self, Sum as Total};");

#[test]
fn an_arrow_upward_is_seen_through_re_exports_macros_and_renaming() {
    for text in [
        "use crate::fisher::Bound;",
        "fn f() { let x = vec![crate::limits::fisher::bound(1)]; }",
        "use super::{super::fisher as g};",
    ] {
        let package = Package::made_up(&[
            HANDED_ON,
            ("base", ""),
            ("base::sum", text),
            ("limits", ""),
            ("limits::fisher", "use crate::Total;"),
        ]);
        let upward = package.upward();
        assert!(
            upward.len() == 1 && upward[0].starts_with("base::sum -> limits::fisher"),
            "{text} {upward:?}"
        );
        assert_eq!(package.circles().len(), 1);
    }
    let above_all = Package::made_up(&[("", "pub struct Own;"), ("base", "use crate::Own;")]);
    assert_eq!(above_all.upward().len(), 1);
}

#[test]
fn a_circle_is_seen_between_neighbours_and_between_parent_and_child() {
    let circles = |files: &[(&str, &str)]| Package::made_up(files).circles().len();
    let third = ("c", "use super::a::A;");
    assert_eq!(circles(&[("", ""), ("a", "use crate::b::{B, other::*};"), ("b", "use crate::c;"), third]), 1);
    assert_eq!(circles(&[("", ""), ("a", "use crate::b::B;"), ("b", "use crate::d;"), third, ("d", "")]), 0);
    let child = ("a::child", "fn f() { super::LIMIT; }");
    for (parent, count) in [
        ("mod child; pub use child::Thing;", 0),
        ("mod child; use child::Thing;", 1),
        ("fn f() { child::thing::<u8>(); }", 1),
    ] {
        assert_eq!(circles(&[("", ""), ("a", parent), child]), count, "{parent}");
    }
    assert_eq!(
        circles(&[("", ""), ("a", "use b::B; // a::b\nmod b;"), ("a::b", "mod inner { use super::X; }")]),
        0
    );
}

#[test]
fn tests_comments_and_other_crates_are_left_out() {
    let text = "#[cfg(test)] mod tests { use crate::limits::X; } //! crate::limits\n\
                pub(in crate::limits) const A: &str = \"crate::limits::X\"; use std::limits::Y;";
    assert!(Package::made_up(&[("", ""), ("base", text), ("limits", "")]).arrows().is_empty());
}
