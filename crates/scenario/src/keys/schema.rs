//! The keys of a kind of file as a JSON schema (draft 2020-12), for editors that complete and check TOML by one.
//!
//! It is never stricter than the reader; what hangs on several keys at once the reader alone knows.

use super::files::{FILES, FileKind};
use super::key::{Key, More, Silent, Table, Value};
use super::rule::UNCERTAIN;
use hadar::allowed::{ABOVE_ZERO, Allowed, FROM_ZERO, SHARE};
use hadar::units::Dimension;
use serde_json::{Map, Value as Json, json};

const DRAFT: &str = "https://json-schema.org/draft/2020-12/schema";
const NUMBER: &str = r"^\s*[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?\s*";

/// The schema of these kinds of files; a file is one of them.
///
/// ```
/// use hadar_scenario::keys::{FILES, schema};
/// let schema = schema(FILES);
/// assert_eq!(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
/// assert_eq!(schema["$defs"]["target"]["properties"]["material"]["examples"][0], "skin");
/// ```
#[must_use]
pub fn schema<'k>(kinds: impl IntoIterator<Item = &'k FileKind>) -> Json {
    let mut defs = Defs::default();
    let mut roots: Vec<Json> = kinds
        .into_iter()
        .map(|kind| {
            let commands: Vec<String> = kind.commands.iter().map(|name| format!("hadar {name}")).collect();
            let mut root = object(kind.root, kind.name, &mut defs);
            root.insert("title".into(), format!("{}: {}", kind.name, commands.join(", ")).into());
            Json::Object(root)
        })
        .collect();
    let mut whole = Map::new();
    whole.insert("$schema".into(), DRAFT.into());
    if roots.len() == 1
        && let Some(Json::Object(root)) = roots.pop()
    {
        whole.extend(root);
    } else {
        whole.insert("title".into(), "A file of hadar".into());
        whole.insert("type".into(), "object".into());
        whole.insert("anyOf".into(), roots.into());
    }
    whole.insert("$defs".into(), Json::Object(defs.made));
    Json::Object(whole)
}

/// Whether a command, or a kind by its name, is that of a file.
#[must_use]
pub fn kinds_of(word: &str) -> Vec<&'static FileKind> {
    FILES.iter().filter(|kind| kind.name == word || kind.commands.contains(&word)).collect()
}

/// Tables that were made, by the name of their definition.
#[derive(Default)]
struct Defs {
    made: Map<String, Json>,
    names: Vec<(&'static Table, String)>,
}

impl Defs {
    /// A reference to a table, which is made where it was not.
    fn of(&mut self, table: &'static Table, name: &str) -> Json {
        let known = self.names.iter().find(|(other, _)| std::ptr::eq(*other, table));
        let name = match known {
            Some((_, name)) => name.clone(),
            None => {
                let taken = |name: &String| self.names.iter().any(|(_, other)| other == name);
                let numbered = (2..).map(|number| format!("{name}-{number}"));
                let free = std::iter::once(name.to_owned()).chain(numbered).find(|name| !taken(name));
                let free = free.unwrap_or_default();
                self.names.push((table, free.clone()));
                let made = object(table, &free, self);
                self.made.insert(free.clone(), Json::Object(made));
                free
            }
        };
        json!({ "$ref": format!("#/$defs/{name}") })
    }
}

fn object(table: &'static Table, name: &str, defs: &mut Defs) -> Map<String, Json> {
    let mut properties = Map::new();
    let figures = table.keys.iter().map(|keys| keys.len()).sum::<usize>();
    for (index, key) in table.keys().enumerate() {
        let mut property = property(&key, defs);
        if matches!(table.more, More::UncertainFigures) && index >= figures {
            property = json!({ "anyOf": [property, defs.of(&UNCERTAIN, "uncertain")] });
        }
        properties.insert(key.name.to_owned(), property);
    }
    let required: Vec<&str> =
        table.keys().filter(|key| key.silent == Silent::Refused).map(|key| key.name).collect();
    let mut made = Map::new();
    made.insert("title".into(), name.into());
    made.insert("description".into(), table.meaning.into());
    made.insert("type".into(), "object".into());
    made.insert("properties".into(), Json::Object(properties));
    if !required.is_empty() {
        made.insert("required".into(), required.into());
    }
    let more = match table.more {
        More::Names(value) => of_value(*value, name, defs),
        _ => false.into(),
    };
    made.insert("additionalProperties".into(), more);
    made
}

fn property(key: &Key, defs: &mut Defs) -> Json {
    let mut made = match of_value(key.value, key.name, defs) {
        Json::Object(made) => made,
        _ => Map::new(),
    };
    let silent = match key.silent {
        Silent::Refused => String::new(),
        Silent::Is(value) => format!(" Silent: {value}."),
        Silent::Means(words) => format!(" Silent: {words}."),
    };
    made.insert("title".into(), key.name.into());
    let description =
        format!("{}{silent} Written: {}. Used in: {}.", key.meaning, key.value.words(), key.enters);
    made.insert("description".into(), description.into());
    if let Silent::Is(text) = key.silent
        && let Some(value) = written(text)
    {
        made.insert("default".into(), value);
    }
    if let Some(example) = written(key.example) {
        made.insert("examples".into(), vec![example].into());
    }
    Json::Object(made)
}

/// A value of TOML as JSON.
fn written(text: &str) -> Option<Json> {
    let mut table: toml::Table = toml::from_str(&format!("value = {text}")).ok()?;
    serde_json::to_value(table.remove("value")?).ok()
}

fn of_value(value: Value, name: &str, defs: &mut Defs) -> Json {
    match value {
        Value::Quantity(dimension, _) => quantity(&[dimension]),
        Value::Spectral => quantity(&[Dimension::Wavenumber, Dimension::Wavelength]),
        Value::Number(allowed) => number(allowed),
        Value::NumberOrFile(allowed) => json!({ "anyOf": [number(allowed), text()] }),
        Value::Count([least, u32::MAX]) => json!({ "type": "integer", "minimum": least }),
        Value::Count([least, most]) => json!({ "type": "integer", "minimum": least, "maximum": most }),
        Value::Flag => json!({ "type": "boolean" }),
        Value::Text | Value::Material | Value::File => text(),
        Value::Date => json!({ "type": "string", "pattern": r"^\s*[0-9]{4}-[0-9]{2}-[0-9]{2}\s*$" }),
        Value::Choice(names) => json!({ "enum": names }),
        Value::Pair(of) => list(*of, [2, 2], name, defs),
        Value::Triple(of) => list(*of, [3, 3], name, defs),
        Value::List(of) => list(*of, [0, usize::MAX], name, defs),
        Value::Either(kinds) => {
            let kinds: Vec<Json> = kinds.iter().map(|kind| of_value(*kind, name, defs)).collect();
            json!({ "anyOf": kinds })
        }
        Value::Figure => json!({ "type": ["number", "string"] }),
        Value::Table(table) => defs.of(table, name),
        Value::Tables(table) => json!({ "type": "array", "items": defs.of(table, name) }),
        Value::Named(table) => {
            let names = json!({ "pattern": r"^[^A-Z\s.]+$" });
            json!({ "type": "object", "propertyNames": names, "additionalProperties": defs.of(table, name) })
        }
    }
}

fn list(of: Value, [least, most]: [usize; 2], name: &str, defs: &mut Defs) -> Json {
    let items = of_value(of, name, defs);
    match most {
        usize::MAX => json!({ "type": "array", "items": items }),
        _ => json!({ "type": "array", "items": items, "minItems": least, "maxItems": most }),
    }
}

fn text() -> Json {
    json!({ "type": "string", "minLength": 1 })
}

fn quantity(dimensions: &[Dimension]) -> Json {
    let units: Vec<String> =
        dimensions.iter().flat_map(|dimension| dimension.spellings()).map(escaped).collect();
    json!({ "type": "string", "pattern": format!("{NUMBER}({})\\s*$", units.join("|")) })
}

/// A unit inside a pattern; `u` may be written as any micro.
fn escaped(unit: &str) -> String {
    let mut escaped = String::new();
    for letter in unit.chars() {
        match letter {
            'u' => escaped.push_str("[u\u{b5}\u{3bc}]"),
            '^' | '.' | '/' | '-' | '+' => escaped.extend(['\\', letter]),
            _ => escaped.push(letter),
        }
    }
    escaped
}

/// A plain number, with the ends that a schema can say.
fn number(allowed: Allowed) -> Json {
    let ends = [
        (ABOVE_ZERO, json!({ "type": "number", "exclusiveMinimum": 0 })),
        (FROM_ZERO, json!({ "type": "number", "minimum": 0 })),
        (SHARE, json!({ "type": "number", "minimum": 0, "maximum": 1 })),
        (super::key::SHARE_ABOVE_ZERO, json!({ "type": "number", "exclusiveMinimum": 0, "maximum": 1 })),
    ];
    let known = ends.into_iter().find(|(known, _)| known.expected == allowed.expected);
    known.map_or_else(|| json!({ "type": "number" }), |(_, ends)| ends)
}
