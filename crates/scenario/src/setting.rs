//! A value that stands in the place of that of a file, such as one that a flag names.
//!
//! Its key is the path that messages use (`camera.exposure`, `environment[0].temperature`); tables on the way are made where the file has
//! none. Its value is TOML (`0.5`, `true`, `["skin", "pmma"]`, `"37 degC"`); what is no TOML is text, so that quotes around it may be
//! left out (`37 degC`). It is checked exactly as the file is; messages about it name what set it instead of file and line.

use hadar::error::{Error, Place, Result};
use std::borrow::Cow;
use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

/// The longest key of a setting, bytes.
const LONGEST_KEY: usize = 200;

/// A value in the place of that of a file.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub struct Setting {
    /// Path of the key whose value is replaced.
    pub key: String,
    /// The value that replaces it, as it is written in a file.
    pub value: String,
    /// What set it, for messages, e.g. `--vary`.
    #[serde(skip)]
    pub by: &'static str,
}

impl Setting {
    /// That of `KEY=VALUE`, as a flag such as `by` has it.
    ///
    /// # Errors
    /// Text without a key or a value.
    ///
    /// ```
    /// use hadar_scenario::Setting;
    /// let setting = Setting::parse("camera.exposure=5 ms", "--set")?;
    /// assert_eq!((&*setting.key, &*setting.value), ("camera.exposure", "5 ms"));
    /// assert!(Setting::parse("camera.exposure", "--set").is_err());
    /// # Ok::<(), hadar::Error>(())
    /// ```
    pub fn parse(text: &str, by: &'static str) -> Result<Self> {
        let parts = text.split_once('=').map(|(key, value)| (key.trim(), value.trim()));
        match parts.filter(|(key, value)| !key.is_empty() && !value.is_empty()) {
            Some((key, value)) => Ok(Self { key: key.to_owned(), value: value.to_owned(), by }),
            None => {
                let instead = "write a key and its value, as in camera.exposure=\"5 ms\"";
                Err(Error::malformed(format!("`{text}` sets nothing"), instead))
            }
        }
    }

    /// Whether it is what stands at a key.
    pub(super) fn covers(&self, key: &str) -> bool {
        key.strip_prefix(self.key.as_str())
            .is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
    }

    /// Whether it stands in what stands at a key.
    pub(super) fn is_in(&self, key: &str) -> bool {
        !key.is_empty() && self.key.strip_prefix(key).is_some_and(|rest| rest.starts_with(['.', '[']))
    }

    /// Where it was set, for a message about `key`.
    pub(super) fn place(&self, key: &str) -> Place {
        Place { key: Some(format!("{} {key}", self.by)), ..Place::default() }
    }

    /// Puts its value into a document.
    pub(super) fn put<'t>(&'t self, document: &mut DeTable<'t>) -> Result<()> {
        let path = self.path();
        let put = path.and_then(|path| put(document, "", &path, self.toml()));
        put.map_err(|error| error.at(self.place(&self.key)))
    }

    /// Its value as TOML, or as text where it is none.
    pub(super) fn toml(&self) -> DeValue<'_> {
        let text = self.value.trim();
        DeValue::parse(text).map_or_else(|_| DeValue::String(Cow::Borrowed(text)), Spanned::into_inner)
    }

    /// The names and indices that lead to it.
    fn path(&self) -> Result<Vec<Step>> {
        let mut steps = Vec::new();
        for part in self.key.split('.') {
            let (name, mut rest) = part.split_at(part.find('[').unwrap_or(part.len()));
            if name.is_empty() || name.contains(|char: char| char.is_whitespace() || char.is_control()) {
                return Err(no_key());
            }
            steps.push(Step::Name(name.to_owned()));
            while !rest.is_empty() {
                let inside =
                    rest.strip_prefix('[').and_then(|rest| rest.split_once(']')).ok_or_else(no_key)?;
                steps.push(Step::Item(inside.0.parse().map_err(|_| no_key())?));
                rest = inside.1;
            }
        }
        if self.key.len() > LONGEST_KEY { Err(no_key()) } else { Ok(steps) }
    }
}

/// One step into a document.
enum Step {
    Name(String),
    Item(usize),
}

fn no_key() -> Error {
    Error::malformed("this is no key", "write its path, as in camera.exposure or environment[0].temperature")
}

/// Puts a value at the end of a path through a table of that name; tables on the way that are not there are made.
fn put<'t>(table: &mut DeTable<'t>, name: &str, path: &[Step], value: DeValue<'t>) -> Result<()> {
    let [Step::Name(key), rest @ ..] = path else { return Err(no_key()) };
    let full = dotted(name, key);
    if !table.contains_key(key.as_str()) {
        let made = match rest {
            [] => value.clone(),
            [Step::Name(_), ..] => DeValue::Table(DeTable::new()),
            [Step::Item(_), ..] => DeValue::Array(DeArray::new()),
        };
        table.insert(Spanned::new(0..0, Cow::Owned(key.clone())), Spanned::new(0..0, made));
    }
    match table.get_mut(key.as_str()) {
        Some(slot) => put_value(slot.get_mut(), &full, rest, value),
        None => Ok(()),
    }
}

fn put_value<'t>(slot: &mut DeValue<'t>, name: &str, path: &[Step], value: DeValue<'t>) -> Result<()> {
    match (path, slot) {
        ([], slot) => {
            *slot = value;
            Ok(())
        }
        ([Step::Name(_), ..], DeValue::Table(table)) => put(table, name, path, value),
        ([Step::Item(index), rest @ ..], DeValue::Array(items)) => {
            let count = items.len();
            match items.get_mut(*index) {
                Some(item) => put_value(item.get_mut(), &format!("{name}[{index}]"), rest, value),
                None => {
                    let found = format!("there is no {name}[{index}]");
                    let instead = match count {
                        0 => "write it into the file first, which has none".to_owned(),
                        count => format!("count from 0 to {}, as the file has {count}", count - 1),
                    };
                    Err(Error::malformed(found, instead))
                }
            }
        }
        ([Step::Name(_), ..], DeValue::Array(_)) => {
            Err(Error::malformed(format!("{name} is a list"), format!("say which, as in {name}[0]")))
        }
        ([Step::Name(_), ..], _) => {
            Err(Error::malformed(format!("{name} is a value and no table"), "name a key that is"))
        }
        ([Step::Item(_), ..], _) => {
            Err(Error::malformed(format!("{name} is no list"), format!("write {name} without an index")))
        }
    }
}

/// `table.key`, or the key alone at the root.
pub(super) fn dotted(table: &str, key: &str) -> String {
    if table.is_empty() { key.to_owned() } else { format!("{table}.{key}") }
}
