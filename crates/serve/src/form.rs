//! A scenario as fields: the tables and keys that its text has, and those that it could have, from the table of keys.

use crate::place::{join, root, word};
use crate::slider::{Slider, slider};
use hadar::atmosphere::Atmosphere;
use hadar_scenario::keys::{Key, Silent, Table, Value};
use serde::Serialize;
use toml_edit::{DocumentMut, Item, TableLike};

/// The fields of a scenario.
#[derive(Debug, Serialize)]
pub(crate) struct Form {
    /// Tables in the order of the table of keys; keys above all tables stand in the first.
    sections: Vec<Section>,
    /// Tables that it could have: its path, what it is called and what it means.
    absent: Vec<Absent>,
}

/// A table.
#[derive(Debug, Serialize)]
struct Section {
    path: String,
    /// The same without the place in a list, by which it is explained.
    word: String,
    meaning: &'static str,
    /// Whether the scenario can do without it.
    removable: bool,
    fields: Vec<Field>,
    absent: Vec<Absent>,
}

/// A key that is not written.
#[derive(Debug, Serialize)]
struct Absent {
    path: String,
    name: String,
    meaning: &'static str,
}

/// A key that is written.
#[derive(Debug, Serialize)]
struct Field {
    path: String,
    word: String,
    name: String,
    meaning: &'static str,
    /// How it is shown: `quantity`, `number`, `choice`, `flag`, `material`, `materials`, `text` or `toml`.
    kind: &'static str,
    /// What is written, quotes of a text left out.
    value: String,
    /// Items of a list of materials.
    items: Vec<String>,
    choices: Vec<String>,
    slider: Option<Slider>,
    removable: bool,
}

/// The fields of a text that may name these cameras; none where it is no TOML.
pub(crate) fn of(text: &str, presets: &[String]) -> Option<Form> {
    let document: DocumentMut = text.parse().ok()?;
    let root = root()?;
    let (table, mut sections) = (document.as_table(), Vec::new());
    sections.push(Section {
        path: String::new(),
        word: String::new(),
        meaning: "",
        removable: false,
        fields: fields(root, table, "", presets),
        absent: absent(root, table, "")
            .filter(|(key, _)| key.value.table().is_none())
            .map(|(_, one)| one)
            .collect(),
    });
    below(root, table, "", presets, &mut sections);
    let more = absent(root, table, "").filter(|(key, _)| key.value.table().is_some());
    Some(Form { absent: more.map(|(_, one)| one).collect(), sections })
}

/// The tables within a table.
fn below(
    table: &Table,
    written: &dyn TableLike,
    above: &str,
    presets: &[String],
    sections: &mut Vec<Section>,
) {
    for key in table.keys() {
        let (Some(inner), Some(item)) = (key.value.table(), written.get(key.name)) else { continue };
        let path = join(above, key.name);
        let mut add = |path: String, item: &Item| {
            let Some(found) = item.as_table_like() else { return };
            sections.push(Section {
                word: word(&path),
                meaning: key.meaning,
                removable: key.silent != Silent::Refused,
                fields: fields(inner, found, &path, presets),
                absent: absent(inner, found, &path).map(|(_, one)| one).collect(),
                path: path.clone(),
            });
            below(inner, found, &path, presets, sections);
        };
        match key.value {
            Value::Tables(_) => {
                let items = (0..).map_while(|index| item.get(index));
                items.enumerate().for_each(|(index, item)| add(format!("{path}[{index}]"), item));
            }
            Value::Named(_) => {
                let own = item.as_table_like().into_iter().flat_map(TableLike::iter);
                own.for_each(|(name, item)| add(join(&path, name), item));
            }
            _ => add(path, item),
        }
    }
}

fn fields(table: &Table, written: &dyn TableLike, above: &str, presets: &[String]) -> Vec<Field> {
    let value =
        |key: &Key| written.get(key.name).and_then(Item::as_value).filter(|_| key.value.table().is_none());
    table.keys().filter_map(|key| Some(field(&key, value(&key)?, above, presets))).collect()
}

fn field(key: &Key, value: &toml_edit::Value, above: &str, presets: &[String]) -> Field {
    let path = join(above, key.name);
    let text = match value.as_str() {
        Some(text) => text.to_owned(),
        None => value.clone().decorated("", "").to_string(),
    };
    let items = value.as_array().into_iter().flatten().filter_map(|item| item.as_str().map(str::to_owned));
    let choices = choices(key, &path, presets);
    let kind = match key.value {
        _ if !choices.is_empty() => "choice",
        Value::Quantity(..) | Value::Spectral => "quantity",
        Value::Number(_) | Value::NumberOrFile(_) | Value::Count(_) => "number",
        Value::Flag => "flag",
        Value::Material => "material",
        Value::List(Value::Material) => "materials",
        Value::Text | Value::Date | Value::File | Value::Choice(_) => "text",
        _ => "toml",
    };
    Field {
        word: word(&path),
        name: key.name.replace('_', " "),
        meaning: key.meaning,
        slider: slider(key, &text),
        removable: key.silent != Silent::Refused,
        items: items.collect(),
        value: text,
        path,
        kind,
        choices,
    }
}

/// The words that may stand at a key, where they are few.
fn choices(key: &Key, path: &str, presets: &[String]) -> Vec<String> {
    let names = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect();
    match (key.value, path) {
        (Value::Choice(words), _) => names(words),
        (_, "atmosphere.model") => names(Atmosphere::names()),
        (_, "camera.preset") => presets.to_vec(),
        _ => Vec::new(),
    }
}

/// The keys that are not written, those of lists of tables always: there may be one more. Tables of the author's own names are
/// named in the text.
fn absent<'a>(
    table: &'a Table,
    written: &'a dyn TableLike,
    above: &'a str,
) -> impl Iterator<Item = (Key, Absent)> + 'a {
    let could_be = |key: &Key| match key.value {
        // Files are read by the command alone.
        Value::File | Value::Named(_) => false,
        Value::Tables(_) => true,
        _ => written.get(key.name).is_none_or(Item::is_none),
    };
    table.keys().filter(could_be).map(move |key| {
        let one =
            Absent { path: join(above, key.name), name: key.name.replace('_', " "), meaning: key.meaning };
        (key, one)
    })
}
