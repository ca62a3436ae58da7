//! All keys by the paths that lead to them.

use super::files::FILES;
use super::key::{Key, Table, Value};

/// A key, wherever it stands.
#[derive(Debug, Clone)]
pub struct Place {
    /// The key.
    pub key: Key,
    /// Its paths, the shortest first, such as `environment.temperature` and `clause.environment.temperature`.
    pub paths: Vec<String>,
    /// Commands that read it.
    pub commands: Vec<&'static str>,
}

/// All keys of all files, those of one table together; what stands in several places in the same meaning is one.
#[must_use]
pub fn all() -> Vec<Place> {
    let mut found = Vec::new();
    for file in FILES {
        collect(file.root, "", file.commands, &mut found);
    }
    for place in &mut found {
        place.paths.sort_by_key(|path| path.matches('.').count());
    }
    found
}

fn collect(table: &Table, above: &str, commands: &[&'static str], found: &mut Vec<Place>) {
    for key in table.keys() {
        let path = if above.is_empty() { key.name.to_owned() } else { format!("{above}.{}", key.name) };
        let same = |place: &&mut Place| {
            let other = &place.key;
            (other.name, other.meaning, other.enters, other.example)
                == (key.name, key.meaning, key.enters, key.example)
        };
        match found.iter_mut().find(same) {
            Some(place) => {
                if !place.paths.contains(&path) {
                    place.paths.push(path.clone());
                }
                let new = commands.iter().filter(|command| !place.commands.contains(command));
                let new: Vec<_> = new.copied().collect();
                place.commands.extend(new);
            }
            None => found.push(Place { key, paths: vec![path.clone()], commands: commands.to_vec() }),
        }
        inside(key.value, &path, commands, found);
    }
}

fn inside(value: Value, path: &str, commands: &[&'static str], found: &mut Vec<Place>) {
    match value {
        Value::Table(table) | Value::Tables(table) => collect(table, path, commands, found),
        Value::Named(table) => collect(table, &format!("{path}.NAME"), commands, found),
        Value::Either(kinds) => kinds.iter().for_each(|kind| inside(*kind, path, commands, found)),
        _ => {}
    }
}

/// The keys that a word means: one by its path, with or without the index of a list, or all of that name.
///
/// ```
/// use hadar_scenario::keys::find;
/// assert_eq!(find("environment[0].lighting").len(), 1);
/// assert_eq!(find("class.robot.mixtures")[0].paths, ["class.NAME.mixtures"]);
/// assert!(find("temperature").len() > 5 && find("noise_bandwith").is_empty());
/// ```
#[must_use]
pub fn find(word: &str) -> Vec<Place> {
    let path = plain(word);
    let all = all();
    let exact: Vec<Place> =
        all.iter().filter(|place| place.paths.iter().any(|own| is_path(own, &path))).cloned().collect();
    if !exact.is_empty() {
        return exact;
    }
    let end = format!(".{path}");
    all.into_iter().filter(|place| place.paths.iter().any(|own| own.ends_with(&end))).collect()
}

/// A path without brackets, those of a `[table]` and those of a place in a list.
fn plain(word: &str) -> String {
    let word = word.trim().trim_start_matches('[');
    let mut path = String::new();
    let mut inside = false;
    for letter in word.chars() {
        match letter {
            '[' => inside = true,
            ']' => inside = false,
            _ if !inside => path.push(letter),
            _ => {}
        }
    }
    path
}

/// Whether a path is that of a key, whose `NAME` stands for any.
fn is_path(own: &str, path: &str) -> bool {
    let (mut own, mut path) = (own.split('.'), path.split('.'));
    loop {
        match (own.next(), path.next()) {
            (None, None) => return true,
            (Some(own), Some(path)) if own == path || own == "NAME" => {}
            _ => return false,
        }
    }
}
