//! Tables and values of a parsed scenario that know their full key, so that each error names file, line and key.

use std::collections::BTreeSet;

use toml::de::{DeTable, DeValue};
pub use toml::value::Date;
use toml::value::Datetime;

use super::keys::{self, Key, More, Table, Value};
use super::source::{Source, dotted};
use hadar::allowed::Allowed;
use hadar::error::{Error, Place, Result};
use hadar::units::{Dimension, decimal_comma};

const DATE: &str = "\"2029-09-01\"";

/// A day as `2029-09-01`.
#[must_use]
pub fn day(text: &str) -> Option<Date> {
    text.parse::<Datetime>().ok().filter(|read| read.time.is_none())?.date
}

/// One table: its entries, its name, and the file they stand in.
#[derive(Clone)]
pub(super) struct Section<'a> {
    table: &'a DeTable<'a>,
    known: Known,
    name: String,
    source: &'a Source,
    /// Where a key that is silent here is looked for.
    beneath: Option<Box<Section<'a>>>,
}

/// What may stand in a table.
#[derive(Clone, Copy)]
enum Known {
    /// These keys.
    Keys(&'static Table),
    /// Names of the author's own, each with such a value.
    Names(Value),
}

/// One value, with the full key it was written under and what may be written there.
pub(super) struct Entry<'a> {
    value: &'a DeValue<'a>,
    allowed: Value,
    key: String,
    source: &'a Source,
}

impl<'a> Section<'a> {
    /// Opens a table in which only its known keys may stand.
    pub(super) fn open(
        table: &'a DeTable<'a>,
        name: &str,
        source: &'a Source,
        known: &'static Table,
    ) -> Result<Self> {
        let section = Known::Keys(known);
        let is_known = |key: &str| matches!(known.more, More::Names(_)) || known.key(key).is_some();
        let unknown = table.keys().filter(|key| !is_known(key.get_ref().as_ref()));
        match unknown.min_by_key(|key| key.span().start) {
            None => Ok(Self { table, known: section, name: name.to_owned(), source, beneath: None }),
            Some(key) => {
                let own = dotted(name, key.get_ref());
                let place = match source.set_at(&own) {
                    Some(place) => place,
                    None => Place { line: source.place(&own).line, ..source.place(name) },
                };
                let names: Vec<&str> = known.keys().map(|key| key.name).collect();
                Err(unknown_key(key.get_ref(), &names).at(place))
            }
        }
    }

    /// The same, laid over another one whose entries hold where this one is silent.
    pub(super) fn over(self, beneath: &Self) -> Self {
        Self { beneath: Some(Box::new(beneath.clone())), ..self }
    }

    /// What stands at a key; nothing at one that the table has no row for.
    pub(super) fn get(&self, key: &str) -> Option<Entry<'a>> {
        let allowed = || match self.known {
            Known::Keys(table) => table.value(key),
            Known::Names(value) => Some(value),
        };
        match self.table.get(key).and_then(|value| Some((value, allowed()?))) {
            Some((value, allowed)) => Some(Entry {
                value: value.get_ref(),
                allowed,
                key: dotted(&self.name, key),
                source: self.source,
            }),
            None => self.beneath.as_ref()?.get(key),
        }
    }

    /// The row of a key.
    fn row(&self, key: &str) -> Result<Key> {
        let row = match self.known {
            Known::Keys(table) => table.key(key),
            Known::Names(_) => None,
        };
        row.ok_or_else(|| self.fail(key, no_row()))
    }

    /// The table itself.
    pub(super) fn document(&self) -> &'a DeTable<'a> {
        self.table
    }

    pub(super) fn source(&self) -> &'a Source {
        self.source
    }

    /// The keys of the table itself.
    pub(super) fn keys(&self) -> impl Iterator<Item = &'a str> {
        self.table.keys().map(|key| key.get_ref().as_ref())
    }

    /// Whether the key stands in the table itself.
    pub(super) fn has_own(&self, key: &str) -> bool {
        self.table.contains_key(key)
    }

    /// A key that must be there.
    pub(super) fn require(&self, key: &str) -> Result<Entry<'a>> {
        match self.get(key) {
            Some(entry) => Ok(entry),
            None => {
                let instead = format!("write {key} = {}", self.row(key)?.example);
                Err(self.fail(key, Error::malformed("the key is missing", instead)))
            }
        }
    }

    /// The value of `key` as `read` takes it, if the key is there.
    pub(super) fn read<T>(&self, key: &str, read: impl FnOnce(&Entry<'a>) -> Result<T>) -> Result<Option<T>> {
        self.get(key).map(|entry| read(&entry)).transpose()
    }

    /// The same for a table of the root, read once for all readings of a text that set nothing in it.
    pub(super) fn read_once<T: Clone + Send + Sync + 'static>(
        &self,
        key: &'static str,
        read: impl FnOnce(&Entry<'a>) -> Result<T>,
    ) -> Result<Option<T>> {
        self.read_once_beside(key, &[], read)
    }

    /// The same for a table that is read by what `others` of the root say.
    pub(super) fn read_once_beside<T: Clone + Send + Sync + 'static>(
        &self,
        key: &'static str,
        others: &[&str],
        read: impl FnOnce(&Entry<'a>) -> Result<T>,
    ) -> Result<Option<T>> {
        let is_set = || self.source.is_set_in(key) || others.iter().any(|other| self.source.is_set_in(other));
        match self.source.kept.as_ref().filter(|_| self.name.is_empty() && !is_set()) {
            Some(kept) => kept.or_read(key, || self.read(key, read)),
            None => self.read(key, read),
        }
    }

    /// A table that must be there; `instead` is what to write.
    pub(super) fn table(&self, key: &str, instead: &str) -> Result<Entry<'a>> {
        self.get(key).ok_or_else(|| self.no_table(key, instead))
    }

    /// The same, read once for all readings of a text that set nothing in it.
    pub(super) fn table_once<T: Clone + Send + Sync + 'static>(
        &self,
        key: &'static str,
        instead: &str,
        read: impl FnOnce(&Entry<'a>) -> Result<T>,
    ) -> Result<T> {
        self.read_once(key, read)?.ok_or_else(|| self.no_table(key, instead))
    }

    fn no_table(&self, key: &str, instead: &str) -> Error {
        self.fail(key, Error::malformed("the table is missing", instead))
    }

    /// The title of a file.
    pub(super) fn title(&self, example: &str) -> Result<Option<String>> {
        self.read("title", |entry| Ok(entry.text(example)?.to_owned()))
    }

    /// Text without the blanks around it; `example` is one to write.
    pub(super) fn text(&self, key: &str, example: &str) -> Result<Option<String>> {
        self.read(key, |entry| entry.name(example))
    }

    /// A quantity with its unit.
    pub(super) fn quantity(&self, key: &str) -> Result<Option<f64>> {
        self.row(key)?;
        self.read(key, Entry::quantity)
    }

    /// A plain number.
    pub(super) fn number(&self, key: &str) -> Result<Option<f64>> {
        let row = self.row(key)?;
        self.read(key, |entry| entry.number(row.example))
    }

    /// One of a few words.
    pub(super) fn choice<T: Copy>(&self, key: &str, choices: &[(&str, T)]) -> Result<Option<T>> {
        self.read(key, |entry| entry.choice(choices))
    }

    /// Refuses a second one of `keys`, which say the same thing in different ways; gives back the one there is.
    pub(super) fn at_most_one<'k>(&self, keys: &[&'k str]) -> Result<Option<&'k str>> {
        let mut given = keys.iter().copied().filter(|key| self.table.contains_key(*key));
        match (given.next(), given.next()) {
            (Some(first), Some(second)) => Err(self.fail(
                second,
                Error::malformed(format!("`{first}` is given as well"), "keep only one of the two"),
            )),
            (first, _) => Ok(first),
        }
    }

    /// Adds the place of one of the section's keys to an error.
    pub(super) fn fail(&self, key: &str, error: Error) -> Error {
        error.at(self.source.place(&dotted(&self.name, key)))
    }
}

impl<'a> Entry<'a> {
    pub(super) fn source(&self) -> &'a Source {
        self.source
    }

    /// The full key.
    pub(super) fn key(&self) -> &str {
        &self.key
    }

    pub(super) fn fail(&self, error: Error) -> Error {
        error.at(self.source.place(&self.key))
    }

    fn wrong_type(&self, instead: String) -> Error {
        self.fail(Error::malformed(format!("{} was found", describe(self.value)), instead))
    }

    /// The last part of the key, without an index.
    fn leaf(&self) -> &str {
        let key = self.key.rsplit('.').next().unwrap_or(&self.key);
        key.split('[').next().unwrap_or(key)
    }

    /// What to write: `key = example`, or the example alone for an item of a list.
    fn written(&self, example: &str) -> String {
        if self.key.ends_with(']') { example.to_owned() } else { format!("{} = {example}", self.leaf()) }
    }

    /// A table, under its header `[name]`.
    pub(super) fn section(&self) -> Result<Section<'a>> {
        self.section_of(self.allowed.table().ok_or_else(|| self.fail(no_row()))?)
    }

    /// One of several tables that may stand here.
    pub(super) fn section_of(&self, known: &'static Table) -> Result<Section<'a>> {
        let Section { table, name, source, .. } = self.table()?;
        Section::open(table, &name, source, known)
    }

    /// A table whose keys were checked before.
    pub(super) fn table(&self) -> Result<Section<'a>> {
        let known = match self.allowed {
            Value::Named(table) => Known::Names(Value::Table(table)),
            ref other => other.table().map_or(Known::Names(self.allowed), Known::Keys),
        };
        match self.value {
            DeValue::Table(table) => {
                Ok(Section { table, known, name: self.key.clone(), source: self.source, beneath: None })
            }
            _ => Err(self.wrong_type(format!("write the table as [{}], once", self.key))),
        }
    }

    /// The items of a list; `example` is what to write.
    pub(super) fn items(&self, example: &str) -> Result<Vec<Entry<'a>>> {
        let DeValue::Array(items) = self.value else {
            return Err(self.wrong_type(format!("write {example}")));
        };
        let of_lists = matches!(items.first().map(|item| item.get_ref()), Some(DeValue::Array(_)));
        let allowed = self.allowed.item(of_lists).ok_or_else(|| self.fail(no_row()))?;
        let entry = |(index, value): (usize, &'a toml::Spanned<DeValue<'a>>)| Entry {
            value: value.get_ref(),
            allowed,
            key: format!("{}[{index}]", self.key),
            source: self.source,
        };
        Ok(items.iter().enumerate().map(entry).collect())
    }

    /// The two items of a range; `example` is one to write.
    pub(super) fn pair(&self, example: &str) -> Result<[Entry<'a>; 2]> {
        let example = self.written(example);
        let items = self.items(&example)?;
        let found = items.len();
        <[Entry<'a>; 2]>::try_from(items).map_err(|_| {
            let found = format!("a range has two ends, but the list has {found}");
            self.fail(Error::malformed(found, format!("write {example}")))
        })
    }

    /// A range, its lower end first, as `read` takes an end; `number` is what ends are compared by. A scene may be held
    /// at one value by two ends that are the same.
    pub(super) fn range<T: Copy>(
        &self,
        example: &str,
        read: impl Fn(&Entry<'a>) -> Result<T>,
        number: impl Fn(T) -> f64,
    ) -> Result<[T; 2]> {
        let [low, high] = self.pair(example)?;
        let range = [read(&low)?, read(&high)?];
        if number(range[0]) <= number(range[1]) {
            return Ok(range);
        }
        let [low, high] = [low, high].map(|end| match end.value {
            DeValue::String(text) => (text.trim().to_owned(), format!("\"{}\"", text.trim())),
            value => {
                let number = describe(value).trim_start_matches("the number ").to_owned();
                (number.clone(), number)
            }
        });
        let found = format!("the range goes from {} to {}", low.0, high.0);
        Err(self.fail(Error::malformed(found, format!("write the lower end first: [{}, {}]", high.1, low.1))))
    }

    /// The same where the ends must differ, since there is something to search between them.
    pub(super) fn wide_range<T: Copy>(
        &self,
        example: &str,
        read: impl Fn(&Entry<'a>) -> Result<T>,
        number: impl Fn(T) -> f64,
    ) -> Result<[T; 2]> {
        let range = self.range(example, read, &number)?;
        if number(range[0]) < number(range[1]) {
            return Ok(range);
        }
        let found = "the two ends of the range are the same";
        Err(self.fail(Error::malformed(found, format!("write two that differ, as in {example}"))))
    }

    /// Text on one line, not empty; `example` is what to write, quotes included.
    pub(super) fn text(&self, example: &str) -> Result<&'a str> {
        let DeValue::String(text) = self.value else {
            return Err(self.wrong_type(format!("write text in quotes, e.g. {}", self.written(example))));
        };
        self.one_line(text)?;
        if text.trim().is_empty() {
            let instead = format!("write for example {}", self.written(example));
            return Err(self.fail(Error::malformed("the text is empty", instead)));
        }
        Ok(text)
    }

    /// The same without the blanks around it.
    pub(super) fn name(&self, example: &str) -> Result<String> {
        Ok(self.text(example)?.trim().to_owned())
    }

    /// A message is one line, so what it repeats must be.
    fn one_line(&self, text: &str) -> Result<()> {
        if text.chars().any(char::is_control) {
            let found = "the text contains a line break or control character";
            return Err(self.fail(Error::malformed(found, "write it on one line")));
        }
        Ok(())
    }

    /// The text of what should be a quantity. A bare number is passed on as it was written, so that the
    /// parser of the dimension says what to write.
    pub(super) fn quantity_text(&self) -> Result<String> {
        match self.value {
            DeValue::String(text) => self.one_line(text).map(|()| text.to_string()),
            DeValue::Integer(number) => Ok(number.to_string()),
            DeValue::Float(number) => Ok(number.to_string()),
            _ => Err(self.wrong_type("write a number and its unit in quotes".to_owned())),
        }
    }

    /// A quantity with its unit, in the unit used inside.
    pub(super) fn quantity(&self) -> Result<f64> {
        let (dimension, allowed) = self.allowed.quantity(None).ok_or_else(|| self.fail(no_row()))?;
        self.quantity_as(dimension, allowed)
    }

    /// The one of several quantities that is of a dimension.
    pub(super) fn quantity_of(&self, dimension: Dimension) -> Result<f64> {
        let (dimension, allowed) =
            self.allowed.quantity(Some(dimension)).ok_or_else(|| self.fail(no_row()))?;
        self.quantity_as(dimension, allowed)
    }

    /// A quantity whose dimension hangs on another key.
    pub(super) fn quantity_as(&self, dimension: Dimension, allowed: Allowed) -> Result<f64> {
        let text = self.quantity_text()?;
        let value = dimension.parse(&text).map_err(|error| self.fail(error))?;
        if allowed.allows(value) {
            return Ok(value);
        }
        let expected = if value.is_finite() { allowed.expected } else { "a finite number" };
        Err(self.fail(Error::malformed(
            format!("`{}` is out of range", text.trim()),
            format!("it must be {expected}"),
        )))
    }

    /// A finite plain number, whole or not; `example` is one to write.
    pub(super) fn number(&self, example: &str) -> Result<f64> {
        self.number_as(example, self.allowed.number().ok_or_else(|| self.fail(no_row()))?)
    }

    /// A number whose range hangs on another key.
    pub(super) fn number_as(&self, example: &str, allowed: Allowed) -> Result<f64> {
        let value = match self.value {
            DeValue::Integer(digits) if digits.radix() == 10 => digits.as_str().parse().ok(),
            // The digits alone, without 0x, 0o or 0b before them.
            DeValue::Integer(digits) => {
                i64::from_str_radix(digits.as_str(), digits.radix()).ok().map(|value| value as f64)
            }
            DeValue::Float(digits) => digits.as_str().parse().ok(),
            _ => None,
        };
        let Some(value) = value else {
            if let DeValue::String(text) = self.value
                && let Some(error) = decimal_comma(text)
            {
                return Err(self.fail(error));
            }
            let instead = format!("write a plain number without quotes, e.g. {}", self.written(example));
            return Err(self.wrong_type(instead));
        };
        if allowed.allows(value) {
            return Ok(value);
        }
        Err(self.fail(Error::out_of_range(self.leaf(), value, "", allowed.expected)))
    }

    /// A whole number; `example` is one to write.
    pub(super) fn count(&self, example: &str) -> Result<u32> {
        let [least, most] = self.allowed.count().ok_or_else(|| self.fail(no_row()))?;
        let whole = match self.value {
            DeValue::Integer(digits) => u32::from_str_radix(digits.as_str(), digits.radix()).ok(),
            _ => None,
        };
        whole.filter(|count| (least..=most).contains(count)).ok_or_else(|| {
            let instead =
                format!("write a whole number from {least} to {most}, e.g. {} = {example}", self.leaf());
            self.wrong_type(instead)
        })
    }

    /// A date, as text or as TOML has it.
    pub(super) fn date(&self) -> Result<Date> {
        let text = match self.value {
            DeValue::String(text) => text.trim().to_owned(),
            DeValue::Datetime(date) => date.to_string(),
            _ => return Err(self.wrong_type(format!("write {}", self.written(DATE)))),
        };
        self.one_line(&text)?;
        day(&text).ok_or_else(|| {
            let instead = format!("write year, month and day, as in {}", self.written(DATE));
            self.fail(Error::malformed(format!("`{}` is no date", text.escape_debug()), instead))
        })
    }

    /// Whether the value is text.
    pub(super) fn is_text(&self) -> bool {
        matches!(self.value, DeValue::String(_))
    }

    /// Whether the value is a table.
    pub(super) fn is_table(&self) -> bool {
        matches!(self.value, DeValue::Table(_))
    }

    /// Whether the value is a list.
    pub(super) fn is_list(&self) -> bool {
        matches!(self.value, DeValue::Array(_))
    }

    /// `true` or `false`.
    pub(super) fn boolean(&self) -> Result<bool> {
        match self.value {
            DeValue::Boolean(value) => Ok(*value),
            _ => {
                Err(self.wrong_type(format!("write {0} = true or {0} = false, without quotes", self.leaf())))
            }
        }
    }

    /// One of a few words.
    pub(super) fn choice<T: Copy>(&self, choices: &[(&str, T)]) -> Result<T> {
        let known = self.allowed.choices().unwrap_or_default();
        if !known.iter().eq(choices.iter().map(|(name, _)| name)) {
            return Err(self.fail(no_row()));
        }
        let names: Vec<String> = choices.iter().map(|(name, _)| format!("\"{name}\"")).collect();
        let listed = listing(&names, " or ");
        let text = match self.value {
            DeValue::String(text) => text.as_ref(),
            _ => return Err(self.wrong_type(format!("write {listed}"))),
        };
        self.one_line(text)?;
        choices.iter().find(|(name, _)| *name == text).map(|(_, choice)| *choice).ok_or_else(|| {
            self.fail(Error::malformed(format!("`{text}` is not known here"), format!("write {listed}")))
        })
    }
}

/// The items of a list, each of which may stand there once.
pub(super) fn without_repetition<'a, T: Ord + Clone>(
    items: &[Entry<'a>],
    read: impl Fn(&Entry<'a>) -> Result<T>,
) -> Result<Vec<T>> {
    let mut values = Vec::with_capacity(items.len());
    let mut seen = BTreeSet::new();
    for item in items {
        let value = read(item)?;
        if !seen.insert(value.clone()) {
            let found = "the same is already in the list";
            return Err(item.fail(Error::malformed(found, "name it once")));
        }
        values.push(value);
    }
    Ok(values)
}

/// `a, b or c`.
fn listing(names: &[String], last: &str) -> String {
    match names {
        [] => String::new(),
        [one] => one.clone(),
        [first @ .., end] => format!("{}{last}{end}", first.join(", ")),
    }
}

/// A reader that asks for something else than the row of its key says, which no file is to blame for.
fn no_row() -> Error {
    Error::malformed("the program reads this otherwise than its table of keys says", "report this as a bug")
}

/// Other tables that are named for a key which stands in a wrong one.
const MOST_TABLES: usize = 3;

fn unknown_key(key: &str, known: &[&str]) -> Error {
    let shown: String = key.escape_debug().collect();
    let all: Vec<String> = keys::all()
        .into_iter()
        .filter(|place| place.key.name == key)
        .filter_map(|place| place.paths.first().filter(|path| path.contains('.')).cloned())
        .collect();
    // Tables of other kinds of files are not meant.
    let is_below = |path: &&String| known.iter().any(|table| path.split('.').next() == Some(table));
    let elsewhere: Vec<String> = all.iter().filter(is_below).map(|path| format!("`{path}`")).collect();
    if !elsewhere.is_empty() {
        let more = if elsewhere.len() > MOST_TABLES { ", …" } else { "" };
        let named: Vec<String> = elsewhere.into_iter().take(MOST_TABLES).collect();
        return Error::malformed(
            format!("there is no key `{shown}`"),
            format!("it is a key of another table: write {}{more}", listing(&named, " or ")),
        );
    }
    match Error::unknown_name("key", &shown, known.iter().copied()) {
        Error::UnknownName { nearest, .. } if nearest.is_empty() => {
            let names: Vec<String> = known.iter().map(|name| format!("`{name}`")).collect();
            Error::malformed(
                format!("there is no key `{shown}`"),
                format!("what may stand here is {}", listing(&names, " or ")),
            )
        }
        error => error,
    }
}

/// A value in a few words, on one line.
fn describe(value: &DeValue<'_>) -> String {
    match value {
        DeValue::String(text) => format!("the text \"{}\"", text.escape_debug()),
        DeValue::Integer(number) => format!("the number {number}"),
        DeValue::Float(number) => format!("the number {number}"),
        DeValue::Boolean(value) => format!("the value {value}"),
        DeValue::Datetime(date) => format!("the date {date}"),
        DeValue::Array(_) => "a list".to_owned(),
        DeValue::Table(_) => "a table".to_owned(),
    }
}
