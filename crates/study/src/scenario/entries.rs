//! A document of keys and tables to be written, as TOML and, in the same structure, for JSON.

use serde::Serialize;
use serde::ser::{SerializeMap, Serializer};
use toml::Value;

use hadar::units::Dimension;

/// One entry of the document.
pub(super) enum Part {
    Value(Value),
    Table(Entries),
    Tables(Vec<Entries>),
}

/// Keys in the order in which they are written; a silent one is not there.
#[derive(Default)]
pub(super) struct Entries(Vec<(&'static str, Value)>);

/// The parts of a scenario in the order in which they are written.
pub(super) type Document = Vec<(&'static str, Part)>;

/// A document as TOML.
pub(super) fn text(document: Document) -> String {
    let mut text = String::new();
    for (name, part) in document {
        match part {
            Part::Value(value) => text.push_str(&format!("{name} = {value}\n")),
            Part::Table(entries) => entries.write(&mut text, &format!("[{name}]")),
            Part::Tables(tables) => {
                tables.iter().for_each(|entries| entries.write(&mut text, &format!("[[{name}]]")));
            }
        }
    }
    text
}

/// A document as a map.
pub(super) fn entries<S: Serializer>(document: Document, serializer: S) -> Result<S::Ok, S::Error> {
    let mut map = serializer.serialize_map(None)?;
    for (name, part) in document {
        match part {
            Part::Value(value) => map.serialize_entry(name, &value)?,
            Part::Table(entries) => map.serialize_entry(name, &entries)?,
            Part::Tables(tables) => map.serialize_entry(name, &tables)?,
        }
    }
    map.end()
}

impl Serialize for Entries {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(key, value)| (key, value)))
    }
}

impl Entries {
    pub(super) fn put(mut self, key: &'static str, value: impl Into<Value>) -> Self {
        self.0.push((key, value.into()));
        self
    }

    pub(super) fn put_if(self, key: &'static str, value: Option<impl Into<Value>>) -> Self {
        match value {
            Some(value) => self.put(key, value),
            None => self,
        }
    }

    pub(super) fn put_quantity(self, key: &'static str, dimension: Dimension, value: Option<f64>) -> Self {
        self.put_if(key, value.map(|value| dimension.format(value)))
    }

    /// These, then others.
    pub(super) fn and(mut self, other: Self) -> Self {
        self.0.extend(other.0);
        self
    }

    fn write(&self, text: &mut String, header: &str) {
        if !text.is_empty() {
            text.push('\n');
        }
        text.push_str(&format!("{header}\n"));
        for (key, value) in &self.0 {
            text.push_str(&format!("{key} = {value}\n"));
        }
    }
}
