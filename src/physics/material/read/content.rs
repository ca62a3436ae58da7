//! What the readers of all formats share: what a file holds, and how names are written.

use crate::error::Error;
use crate::material::Material;
use std::path::Path;

/// What a file turned out to hold.
pub(in crate::physics::material) enum Content {
    /// One or more materials.
    Materials(Vec<Material>),
    /// A file of a known format that has no emissivity in it, and why.
    NoEmissivity(Error),
}

/// A name in kebab-case: `tilePavement` → `tile-pavement`, `Fused silica` → `fused-silica`. Qualified
/// names keep their `@`.
pub(in crate::physics::material) fn kebab_case(name: &str) -> String {
    let mut kebab = String::with_capacity(name.len() + 2);
    let mut previous = ' ';
    for character in name.chars() {
        let boundary = !(character.is_alphanumeric() || character == '@');
        let hump = character.is_uppercase() && previous.is_lowercase();
        if (boundary || hump) && !kebab.is_empty() && !kebab.ends_with(['-', '@']) {
            kebab.push('-');
        }
        if !boundary {
            if character == '@' && kebab.ends_with('-') {
                kebab.pop();
            }
            kebab.extend(character.to_lowercase());
        }
        previous = character;
    }
    kebab.truncate(kebab.trim_end_matches('-').len());
    kebab
}

/// Text without line breaks and other control characters, nor more than one blank at a place.
pub(in crate::physics::material) fn one_line(text: &str) -> String {
    let words = text.split(|char: char| char.is_whitespace() || char.is_control());
    words.filter(|word| !word.is_empty()).collect::<Vec<_>>().join(" ")
}

/// The file's name without folders and extension, in kebab-case.
pub(in crate::physics::material) fn stem(path: &Path) -> String {
    let stem = path.file_stem().map(|stem| kebab_case(&stem.to_string_lossy())).unwrap_or_default();
    if stem.is_empty() { "unnamed".to_owned() } else { stem }
}
