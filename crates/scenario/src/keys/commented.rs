//! A file with what each of its keys means written above it.

use super::found::find;
use super::key::{Silent, Value};
use std::fmt::Write as _;

/// Keys that are named at the end of a table, at most.
const MOST_NAMED: usize = 12;

/// Plain TOML with a comment above every table and key, and the other keys of a table named below it.
///
/// ```
/// use hadar_scenario::keys::commented;
/// let text = commented("[target]\nmaterial = \"skin\"\n");
/// assert!(text.contains("# What the target is made of.\nmaterial = \"skin\"\n"));
/// assert!(text.ends_with("# Also: temperature, distance, size, pixels, extrapolate (hadar explain target)\n"), "{text}");
/// ```
#[must_use]
pub fn commented(toml: &str) -> String {
    let (mut text, mut table, mut written) = (String::new(), String::new(), Vec::new());
    for line in toml.lines() {
        if let Some(name) = line.strip_prefix('[') {
            also(&mut text, &table, &written);
            table = name.trim_matches(['[', ']']).to_owned();
            written.clear();
            if let Some(place) = find(&table).first() {
                let _ = writeln!(text, "\n# {}", place.key.meaning);
            }
        } else if let Some((name, _)) = line.split_once(" = ").filter(|_| !line.starts_with('#')) {
            let path = if table.is_empty() { name.to_owned() } else { format!("{table}.{name}") };
            if let Some(place) = find(&path).first() {
                let _ = write!(text, "# {}", place.key.meaning);
                match (place.key.value, place.key.silent) {
                    (Value::Choice(_), _) => {
                        let _ = write!(text, " {}.", place.key.value.words());
                    }
                    (_, Silent::Is(value)) => {
                        let _ = write!(text, " Silent: {value}.");
                    }
                    _ => {}
                }
                text.push('\n');
            }
            written.push(name.to_owned());
        }
        if !line.is_empty() {
            let _ = writeln!(text, "{line}");
        }
    }
    also(&mut text, &table, &written);
    text
}

/// The keys of a table that were not written.
fn also(text: &mut String, table: &str, written: &[String]) {
    let places = find(table);
    let Some(table_of) = places.first().and_then(|place| place.key.value.table()) else { return };
    let others: Vec<&str> =
        table_of.keys().map(|key| key.name).filter(|name| !written.iter().any(|own| own == name)).collect();
    if !others.is_empty() {
        let (shown, more) = others.split_at(others.len().min(MOST_NAMED));
        let dots = if more.is_empty() { "" } else { ", …" };
        let _ = writeln!(text, "# Also: {}{dots} (hadar explain {table})", shown.join(", "));
    }
}
