//! Paths of a scenario: what may stand at one, and what is written there where nothing was.

use hadar_scenario::keys::{FILES, Key, Silent, Table, Value};
use toml_edit::Item;

/// The root of the kind of file that `hadar size` reads.
pub(crate) fn root() -> Option<&'static Table> {
    FILES.iter().find(|kind| kind.commands.contains(&"size")).map(|kind| kind.root)
}

/// A path one step longer.
pub(crate) fn join(above: &str, name: &str) -> String {
    if above.is_empty() { name.to_owned() } else { format!("{above}.{name}") }
}

/// A path without places in lists.
pub(crate) fn word(path: &str) -> String {
    let parts = path.split('.').map(|part| part.split('[').next().unwrap_or(part));
    parts.collect::<Vec<_>>().join(".")
}

/// What may stand at a path of a scenario.
#[derive(Debug, Clone, Copy)]
pub(crate) struct At(Option<Value>);

/// What may stand at a path.
pub(crate) fn value_at(path: &str) -> At {
    At(find(path).map(|(value, _)| value))
}

impl At {
    /// What is typed into a field, as it is written: a text where a text is due, else TOML where it is some.
    pub(crate) fn parsed(self, typed: &str) -> toml_edit::Value {
        let is_text = matches!(
            self.0,
            Some(
                Value::Quantity(..)
                    | Value::Spectral
                    | Value::Text
                    | Value::Date
                    | Value::Choice(_)
                    | Value::Material
                    | Value::File
            )
        );
        let toml = (!is_text).then(|| typed.trim().parse::<toml_edit::Value>().ok()).flatten();
        toml.unwrap_or_else(|| typed.into())
    }
}

/// What is written where nothing was.
#[derive(Debug)]
pub(crate) enum Written {
    /// A value.
    Value(toml_edit::Value),
    /// A table.
    Table(toml_edit::Table),
    /// One entry of a list of tables.
    Entry(toml_edit::Table),
}

/// What is written at a path where nothing was: the value of its example, or a table of the keys that it must have.
pub(crate) fn new_at(path: &str) -> Option<Written> {
    let (value, example) = find(path)?;
    let filled = |table: &Table| {
        let mut new = toml_edit::Table::new();
        let due =
            |key: &Key| key.silent == Silent::Refused || DUE.contains(&join(&word(path), key.name).as_str());
        for key in table.keys().filter(due) {
            if let Ok(value) = key.example.parse::<toml_edit::Value>() {
                new.insert(key.name, Item::Value(value));
            }
        }
        new
    };
    match value {
        Value::Table(table) => Some(Written::Table(filled(table))),
        Value::Tables(table) => Some(Written::Entry(filled(table))),
        _ => example.parse().ok().map(Written::Value),
    }
}

/// Keys that a new table begins with although it may be silent about them.
const DUE: [&str; 3] = ["environment.lighting", "atmosphere.model", "camera.preset"];

/// What may stand at a path, and its example.
fn find(path: &str) -> Option<(Value, &'static str)> {
    let mut table = root()?;
    let mut found = None;
    let mut names = path.split('.').map(|part| part.split('[').next().unwrap_or(part));
    while let Some(name) = names.next() {
        let key = table.key(name)?;
        found = Some((key.value, key.example));
        if let Some(inner) = key.value.table() {
            table = inner;
            if matches!(key.value, Value::Named(_)) && names.next().is_none() {
                return found;
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_key_of_a_scenario_has_something_to_begin_with_and_is_read_back() {
        let root = root().unwrap();
        let mut seen = 0;
        for section in root.keys() {
            let Some(table) = section.value.table() else { continue };
            let above = match section.value {
                Value::Named(_) => format!("{}.own", section.name),
                _ => section.name.to_owned(),
            };
            for key in table.keys() {
                let path = join(&above, key.name);
                if key.value.table().is_some() {
                    assert!(matches!(new_at(&path), Some(Written::Table(_) | Written::Entry(_))), "{path}");
                    continue;
                }
                let Some(Written::Value(value)) = new_at(&path) else { panic!("{path}") };
                let text = value.as_str().map_or_else(|| value.to_string(), str::to_owned);
                let again = value_at(&path).parsed(&text);
                assert_eq!(again.to_string().trim(), value.to_string().trim(), "{path}");
                seen += 1;
            }
        }
        assert!(seen > 60, "{seen}");
    }
}
