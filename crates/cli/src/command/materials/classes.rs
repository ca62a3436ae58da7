//! The classes of the library: their members, and which of these have no spectrum.

use super::super::global::Global;
use hadar::error::Result;
use hadar::material::{Basis, Library, LibraryClass, MaterialRef, Summary};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// The members of all classes.
pub(super) fn members(library: &Library) -> BTreeMap<&str, Vec<String>> {
    library.classes().map(|(name, class)| (name, class.spec.materials.iter().map(member).collect())).collect()
}

/// All classes as text.
pub(super) fn listed(library: &Library) -> String {
    let mut out = String::new();
    for (name, class) in library.classes() {
        if out.is_empty() {
            out.push_str("\nClasses of several materials, which may be named as target, alternative or part of a library\n");
        }
        let members = class.spec.materials.iter().map(|of| match is_one_number(library, of) {
            true => format!("{} (one number)", member(of)),
            false => member(of),
        });
        let _ = writeln!(out, "  {name}: {}", members.collect::<Vec<_>>().join(", "));
    }
    out
}

/// One class: its members, and how each is known.
pub(super) fn show(name: &str, class: &LibraryClass, library: &Library, global: &Global) -> Result<()> {
    let known = |of: &MaterialRef| match of {
        MaterialRef::Name(name) if library.contains(name) => library.get(name).map(|one| Some(one.summary())),
        _ => Ok(None),
    };
    let summaries = class.spec.materials.iter().map(known).collect::<Result<Vec<Option<Summary>>>>()?;
    let names: Vec<String> = class.spec.materials.iter().map(member).collect();
    let width = names.iter().map(|name| name.chars().count()).max().unwrap_or(0);
    let mut out = format!("{name}: {}\n\n", class.description);
    for ((member, summary), of) in names.iter().zip(&summaries).zip(&class.spec.materials) {
        let about = summary.as_ref().map_or_else(String::new, |summary| {
            let provenance = &summary.provenance;
            let number = if is_one_number(library, of) { ", one number for all wavenumbers" } else { "" };
            format!("{:<26}  {}{number}", provenance.basis.to_string(), provenance.description)
        });
        let _ = writeln!(out, "{}", format!("  {member:<width$}  {about}").trim_end());
    }
    let known: Vec<Summary> = summaries.into_iter().flatten().collect();
    let json = serde_json::json!({
        "name": name, "description": class.description, "also": class.also, "members": names, "materials": known,
    });
    global.answer_with(json, &out, &library.work())
}

/// Whether a member is entered as one number: nothing is known of its spectrum.
fn is_one_number(library: &Library, of: &MaterialRef) -> bool {
    let MaterialRef::Name(name) = of else { return false };
    library.contains(name) && library.get(name).is_ok_and(|one| one.provenance().basis == Basis::Constant)
}

/// What a class names: a material, or where its spectra are.
fn member(member: &MaterialRef) -> String {
    match member {
        MaterialRef::Name(name) => name.clone(),
        MaterialRef::File(path) => path.display().to_string(),
    }
}
