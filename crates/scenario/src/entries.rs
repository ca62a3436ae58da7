//! A document of keys and tables to be written, as TOML and, in the same structure, for JSON.

use serde::Serialize;
use serde::ser::{SerializeMap, Serializer};
use std::collections::BTreeMap;
use toml::Value;

use super::rule::known::{Known, Uncertainty};
use super::source::{Source, dotted};
use hadar::units::Dimension;

/// One entry of the document.
#[derive(PartialEq)]
pub(super) enum Part {
    Value(Value),
    Table(Entries),
    Tables(Vec<Entries>),
    /// Tables by name, below one of their own.
    Named(Vec<(String, Entries)>),
    /// Tables with tables of their own.
    Documents(Vec<(Entries, Document)>),
}

/// Keys in the order in which they are written; one that is not stated is absent.
#[derive(Default, PartialEq)]
pub(super) struct Entries {
    entries: Vec<Entry>,
    /// Where the table was read from, if that is not where it is written.
    read_from: Option<String>,
}

#[derive(PartialEq)]
struct Entry {
    key: &'static str,
    value: Value,
    /// What its texts measure, where they are quantities.
    dimension: Option<Dimension>,
}

/// The parts of a file in the order in which they are written.
#[derive(Default, PartialEq)]
pub(super) struct Document(pub(super) Vec<(&'static str, Part)>);

impl Document {
    /// A document that begins with a title, if there is one.
    pub(super) fn titled(title: Option<&String>) -> Self {
        Self(title.map(|title| ("title", Part::Value(title.as_str().into()))).into_iter().collect())
    }

    /// With a table, or tables.
    pub(super) fn put(mut self, name: &'static str, part: impl Into<Part>) -> Self {
        self.0.push((name, part.into()));
        self
    }

    pub(super) fn put_if(self, name: &'static str, part: Option<impl Into<Part>>) -> Self {
        match part {
            Some(part) => self.put(name, part),
            None => self,
        }
    }

    /// These, then others.
    pub(super) fn and(mut self, other: Self) -> Self {
        self.0.extend(other.0);
        self
    }
}

impl From<Entries> for Part {
    fn from(table: Entries) -> Self {
        Self::Table(table)
    }
}

impl From<Vec<Entries>> for Part {
    fn from(tables: Vec<Entries>) -> Self {
        Self::Tables(tables)
    }
}

/// A document as TOML, quantities as their author wrote them in `source`.
pub(super) fn text(document: Document, source: &Source) -> String {
    let mut text = String::new();
    lay(&mut text, document, ["", ""], source);
    text
}

/// A document below the table of a header, read from the table of a name.
fn lay(text: &mut String, document: Document, [header, read]: [&str; 2], source: &Source) {
    for (name, part) in document.0 {
        let (header, read) = (dotted(header, name), dotted(read, name));
        match part {
            Part::Value(value) => text.push_str(&format!("{name} = {value}\n")),
            Part::Table(entries) => entries.write(text, &format!("[{header}]"), &read, source),
            Part::Tables(tables) => {
                for (index, entries) in tables.iter().enumerate() {
                    entries.write(text, &format!("[[{header}]]"), &format!("{read}[{index}]"), source);
                }
            }
            Part::Named(tables) => {
                for (name, entries) in tables {
                    entries.write(text, &format!("[{header}.{name}]"), &dotted(&read, &name), source);
                }
            }
            Part::Documents(documents) => {
                for (index, (entries, inner)) in documents.into_iter().enumerate() {
                    let read = format!("{read}[{index}]");
                    entries.write(text, &format!("[[{header}]]"), &read, source);
                    lay(text, inner, [&header, &read], source);
                }
            }
        }
    }
}

/// A value in the unit in which it was written under that key, if it is still the same to the last bit.
fn as_written(value: &Value, key: &str, dimension: Dimension, source: &Source) -> Value {
    let written = |inside: &str| {
        let same =
            |text: &&str| dimension.parse(text).is_ok_and(|value| dimension.parse(inside) == Ok(value));
        // One range may stand for the ranges of all objects.
        let of_all = || key.rsplit_once('[').and_then(|(list, end)| Some((list.rsplit_once('[')?.0, end)));
        let found = source.written(key).filter(same);
        found.or_else(|| {
            of_all().and_then(|(list, end)| source.written(&format!("{list}[{end}"))).filter(same)
        })
    };
    match value {
        Value::String(inside) => written(inside).map_or_else(|| value.clone(), Value::from),
        Value::Array(items) => {
            let item = |(index, item)| as_written(item, &format!("{key}[{index}]"), dimension, source);
            Value::Array(items.iter().enumerate().map(item).collect())
        }
        Value::Table(table) => {
            let inner = |(name, item): (&String, &Value)| {
                (name.clone(), as_written(item, &dotted(key, name), dimension, source))
            };
            Value::Table(table.iter().map(inner).collect())
        }
        other => other.clone(),
    }
}

/// A document as a map.
pub(super) fn entries<S: Serializer>(document: Document, serializer: S) -> Result<S::Ok, S::Error> {
    Map(&[], &document).serialize(serializer)
}

/// Entries, then a document.
struct Map<'a>(&'a [Entry], &'a Document);

impl Serialize for Map<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        for entry in self.0 {
            map.serialize_entry(entry.key, &entry.value)?;
        }
        for (name, part) in &self.1.0 {
            match part {
                Part::Value(value) => map.serialize_entry(name, value)?,
                Part::Table(entries) => map.serialize_entry(name, entries)?,
                Part::Tables(tables) => map.serialize_entry(name, tables)?,
                Part::Named(tables) => {
                    let named: BTreeMap<&str, &Entries> =
                        tables.iter().map(|(n, t)| (n.as_str(), t)).collect();
                    map.serialize_entry(name, &named)?;
                }
                Part::Documents(documents) => {
                    let each = documents.iter().map(|(own, inner)| Map(&own.entries, inner));
                    map.serialize_entry(name, &each.collect::<Vec<_>>())?;
                }
            }
        }
        map.end()
    }
}

impl Serialize for Entries {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.entries.iter().map(|entry| (entry.key, &entry.value)))
    }
}

impl Entries {
    pub(super) fn put(mut self, key: &'static str, value: impl Into<Value>) -> Self {
        self.entries.push(Entry { key, value: value.into(), dimension: None });
        self
    }

    /// Quantities: one, a range, a list of ranges, a table of some.
    pub(super) fn put_written(
        mut self,
        key: &'static str,
        dimension: Dimension,
        value: impl Into<Value>,
    ) -> Self {
        self.entries.push(Entry { key, value: value.into(), dimension: Some(dimension) });
        self
    }

    pub(super) fn put_if(self, key: &'static str, value: Option<impl Into<Value>>) -> Self {
        match value {
            Some(value) => self.put(key, value),
            None => self,
        }
    }

    pub(super) fn put_quantity(self, key: &'static str, dimension: Dimension, value: Option<f64>) -> Self {
        match value {
            Some(value) => self.put_written(key, dimension, dimension.format(value)),
            None => self,
        }
    }

    /// A range of quantities.
    pub(super) fn put_range(self, key: &'static str, dimension: Dimension, range: Option<[f64; 2]>) -> Self {
        match range {
            Some(range) => self.put_written(key, dimension, range.map(|end| dimension.format(end)).to_vec()),
            None => self,
        }
    }

    /// The same, each of these keys with how well its value is known beside it.
    pub(super) fn with_uncertainty(mut self, uncertainty: &BTreeMap<&'static str, Known>) -> Self {
        for entry in &mut self.entries {
            let Some(known) = uncertainty.get(entry.key) else { continue };
            let mut both = toml::Table::new();
            match known {
                Known::AtMost => both.insert("at_most".to_owned(), entry.value.clone()),
                Known::Within(_) => both.insert("value".to_owned(), entry.value.clone()),
            };
            if let Known::Within(Uncertainty { sigma, rectangular, same }) = known {
                let difference = match entry.dimension {
                    Some(Dimension::Temperature) => Some(Dimension::TemperatureDifference),
                    other => other,
                };
                let u = difference
                    .map_or_else(|| Value::from(*sigma), |dimension| dimension.format(*sigma).into());
                both.insert("u".to_owned(), u);
                if *rectangular {
                    both.insert("law".to_owned(), "rectangular".into());
                }
                if let Some(same) = same {
                    both.insert("same".to_owned(), same.as_str().into());
                }
            }
            entry.value = Value::Table(both);
        }
        self
    }

    /// As the value of a key.
    pub(super) fn table(self) -> Value {
        Value::Table(self.entries.into_iter().map(|entry| (entry.key.to_owned(), entry.value)).collect())
    }

    /// The same, read from a table of that name.
    pub(super) fn read_from(self, key: &str) -> Self {
        Self { read_from: Some(key.to_owned()), ..self }
    }

    /// These, then others.
    pub(super) fn and(mut self, other: Self) -> Self {
        self.entries.extend(other.entries);
        self
    }

    fn write(&self, text: &mut String, header: &str, name: &str, source: &Source) {
        if !text.is_empty() {
            text.push('\n');
        }
        text.push_str(&format!("{header}\n"));
        let name = self.read_from.as_deref().unwrap_or(name);
        for Entry { key, value, dimension } in &self.entries {
            let value = match dimension {
                Some(dimension) => &as_written(value, &dotted(name, key), *dimension, source),
                None => value,
            };
            text.push_str(&format!("{key} = {value}\n"));
        }
    }
}
