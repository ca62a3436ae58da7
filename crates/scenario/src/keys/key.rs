//! A key of a file, the table that it stands in, and the kinds of values.

use hadar::allowed::{ABOVE_ZERO, ABSOLUTE_TEMPERATURE, Allowed, FROM_ZERO, SHARE};
use hadar::instrument::Readout;
use hadar::instrument::figures::{self, Row};
use hadar::units::Dimension;

/// A key and all that is to be known of it.
#[derive(Debug, Clone, Copy)]
pub struct Key {
    /// How it is written.
    pub name: &'static str,
    /// What may be written.
    pub value: Value,
    /// What it means that nothing is.
    pub silent: Silent,
    /// A value to write, quotes included.
    pub example: &'static str,
    /// What it means, in a sentence.
    pub meaning: &'static str,
    /// Where it enters: an equation of the paper, or what is done with it.
    pub enters: &'static str,
}

/// What a silent key means.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Silent {
    /// It must be there.
    Refused,
    /// This value, as it would be written.
    Is(&'static str),
    /// Something that takes words.
    Means(&'static str),
}

/// What may be written.
#[derive(Debug, Clone, Copy)]
pub enum Value {
    /// A number with its unit, in quotes.
    Quantity(Dimension, Allowed),
    /// A wavenumber or a wavelength above 0.
    Spectral,
    /// A plain number.
    Number(Allowed),
    /// A plain number, or a file of it over wavenumber.
    NumberOrFile(Allowed),
    /// A whole number within these.
    Count([u32; 2]),
    /// True or false.
    Flag,
    /// Words.
    Text,
    /// A day.
    Date,
    /// One of these words.
    Choice(&'static [&'static str]),
    /// A material or class by its name, or a file of a spectrum.
    Material,
    /// A file.
    File,
    /// A list of two: a range, lower end first, or two numbers.
    Pair(&'static Value),
    /// A list of three.
    Triple(&'static Value),
    /// A list.
    List(&'static Value),
    /// One of several kinds.
    Either(&'static [Value]),
    /// A figure of a camera, as its own key takes it.
    Figure,
    /// A table.
    Table(&'static Table),
    /// Tables in double brackets, one for each.
    Tables(&'static Table),
    /// Tables of the author's own names, each of which is one of these.
    Named(&'static Table),
}

/// A table of a file.
#[derive(Debug)]
pub struct Table {
    /// What it is.
    pub meaning: &'static str,
    /// Its keys.
    pub keys: &'static [&'static [Key]],
    /// What else may stand in it.
    pub more: More,
}

/// What may stand in a table besides its keys.
#[derive(Debug, Clone, Copy)]
pub enum More {
    /// Nothing.
    Nothing,
    /// The figures of a camera ([`figures::TABLE`]).
    Figures,
    /// These, each of which may be a table of a value and its standard uncertainty.
    UncertainFigures,
    /// Names of the author's own, each with such a value.
    Names(&'static Value),
}

impl Table {
    /// A table of these keys and no others.
    #[must_use]
    pub const fn of(meaning: &'static str, keys: &'static [&'static [Key]]) -> Self {
        Self { meaning, keys, more: More::Nothing }
    }

    /// Its keys, those of a camera's figures included.
    pub fn keys(&self) -> impl Iterator<Item = Key> + '_ {
        self.keys.iter().copied().flatten().copied().chain(self.figures().iter().map(Key::of_figure))
    }

    /// The figures of a camera that may stand in it.
    fn figures(&self) -> &'static [Row] {
        let has_figures = matches!(self.more, More::Figures | More::UncertainFigures);
        if has_figures { figures::TABLE } else { &[] }
    }

    /// A key of it by its name.
    #[must_use]
    pub fn key(&self, name: &str) -> Option<Key> {
        let own = self.keys.iter().copied().flatten().find(|key| key.name == name).copied();
        own.or_else(|| self.figures().iter().find(|row| row.key == name).map(Key::of_figure))
    }

    /// What may be written at a name.
    #[must_use]
    pub fn value(&self, name: &str) -> Option<Value> {
        match self.more {
            More::Names(value) => Some(*value),
            _ => self.key(name).map(|key| key.value),
        }
    }
}

impl Key {
    /// Whether it is written as a `[table]`.
    #[must_use]
    pub fn is_table(&self) -> bool {
        matches!(self.value, Value::Tables(_) | Value::Named(_)) || self.example == "a table"
    }

    /// The key of a camera's figure.
    fn of_figure(row: &Row) -> Self {
        let value = match row.kind {
            figures::Kind::Quantity(dimension, allowed, _) => Value::Quantity(dimension, allowed),
            figures::Kind::Number(allowed, _) => Value::Number(allowed),
            figures::Kind::Efficiency(allowed, _) => Value::NumberOrFile(allowed),
            figures::Kind::Count(_) => COUNT,
            figures::Kind::Flag(_) => Value::Flag,
            figures::Kind::Readout(_) => Value::Choice(&READOUTS),
            figures::Kind::Span(_) => Value::Pair(&Value::Spectral),
            figures::Kind::File(_) => Value::File,
            figures::Kind::Name(_) => Value::Text,
        };
        Self {
            name: row.key,
            value,
            silent: Silent::Means(match row.kind {
                figures::Kind::Name(_) => "no preset: what the other keys say",
                _ => "that of the preset, if there is one",
            }),
            example: row.example,
            meaning: row.meaning,
            enters: row.enters,
        }
    }

    /// A row of a table.
    pub(super) const fn row(
        name: &'static str,
        value: Value,
        silent: Silent,
        example: &'static str,
        meaning: &'static str,
        enters: &'static str,
    ) -> Self {
        Self { name, value, silent, example, meaning, enters }
    }
}

impl Value {
    /// What may be written, in a few words.
    #[must_use]
    pub fn words(&self) -> String {
        match *self {
            Self::Quantity(dimension, allowed) => {
                let units = dimension.spellings().collect::<Vec<_>>().join(", ");
                format!("{} in quotes with its unit ({units}), {}", dimension.name(), allowed.expected)
            }
            Self::Spectral => {
                "wavenumber (cm^-1) or wavelength (um, nm) in quotes with its unit, above 0".into()
            }
            Self::Number(Allowed { expected, .. }) if expected.contains("number") => {
                expected.trim_start_matches("a ").into()
            }
            Self::Number(allowed) => format!("number, {}", allowed.expected),
            Self::NumberOrFile(allowed) => format!("number, {}, or a file of rows", allowed.expected),
            Self::Count([least, u32::MAX]) => format!("whole number, at least {least}"),
            Self::Count([least, most]) => format!("whole number from {least} to {most}"),
            Self::Flag => "true or false".into(),
            Self::Text => "text in quotes".into(),
            Self::Date => "day, as \"2029-09-01\"".into(),
            Self::Choice(names) => {
                names.iter().map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(" or ")
            }
            Self::Material => {
                "name of a material or class (`hadar materials list`), or a file of a spectrum".into()
            }
            Self::File => "path of a file, from the folder of this one".into(),
            Self::Pair(of) => format!("list of two: {}", of.words()),
            Self::Triple(of) => format!("list of three: {}", of.words()),
            Self::List(of) => format!("list: {}", of.words()),
            Self::Either(kinds) => {
                let mut words: Vec<_> = kinds.iter().map(Self::words).collect();
                words.dedup();
                words.join("; or ")
            }
            Self::Figure => "as the key of the camera itself takes it".into(),
            Self::Table(_) => "table".into(),
            Self::Tables(_) => "tables in double brackets, one for each".into(),
            Self::Named(_) => "a table for each, of a name of your own".into(),
        }
    }

    /// The quantity that may stand here, of a dimension if that is asked for.
    pub(crate) fn quantity(&self, of: Option<Dimension>) -> Option<(Dimension, Allowed)> {
        match *self {
            Self::Quantity(dimension, allowed) if of.is_none_or(|of| of == dimension) => {
                Some((dimension, allowed))
            }
            Self::Either(kinds) => kinds.iter().find_map(|kind| kind.quantity(of)),
            _ => None,
        }
    }

    /// What is allowed of the plain number that may stand here.
    pub(crate) fn number(&self) -> Option<Allowed> {
        match *self {
            Self::Number(allowed) | Self::NumberOrFile(allowed) => Some(allowed),
            Self::Either(kinds) => kinds.iter().find_map(Self::number),
            _ => None,
        }
    }

    /// The ends of the whole number that may stand here.
    pub(crate) fn count(&self) -> Option<[u32; 2]> {
        match *self {
            Self::Count(within) => Some(within),
            Self::Either(kinds) => kinds.iter().find_map(Self::count),
            _ => None,
        }
    }

    /// The words that may stand here.
    pub(crate) fn choices(&self) -> Option<&'static [&'static str]> {
        match *self {
            Self::Choice(names) => Some(names),
            Self::Either(kinds) => kinds.iter().find_map(Self::choices),
            _ => None,
        }
    }

    /// What the items of the list that may stand here are; of several kinds of lists the one of lists, or of anything else.
    pub(crate) fn item(&self, of_lists: bool) -> Option<Self> {
        match *self {
            Self::Pair(of) | Self::Triple(of) | Self::List(of) => Some(*of),
            Self::Tables(table) => Some(Self::Table(table)),
            Self::Either(kinds) => {
                let mut items = kinds.iter().filter_map(|kind| kind.item(of_lists));
                let first = items.clone().next();
                items.find(|item| item.item(false).is_some() == of_lists).or(first)
            }
            _ => None,
        }
    }

    /// Keys of the tables that may stand here, each once.
    #[must_use]
    pub fn keys_inside(&self) -> Vec<Key> {
        let mut found: Vec<Key> = Vec::new();
        let kinds = match self {
            Self::Either(kinds) => kinds,
            one => std::slice::from_ref(one),
        };
        for key in kinds.iter().filter_map(Self::table).flat_map(Table::keys) {
            if found.iter().all(|other| other.name != key.name) {
                found.push(key);
            }
        }
        found
    }

    /// The table that may stand here.
    #[must_use]
    pub fn table(&self) -> Option<&'static Table> {
        match *self {
            Self::Table(table) | Self::Tables(table) | Self::Named(table) => Some(table),
            Self::Either(kinds) => kinds.iter().find_map(Self::table),
            _ => None,
        }
    }
}

const READOUTS: [&str; Readout::ALL.len()] = {
    let mut names = [""; Readout::ALL.len()];
    let mut at = 0;
    while at < names.len() {
        names[at] = Readout::ALL[at].name();
        at += 1;
    }
    names
};

pub(super) const KELVIN: Value = Value::Quantity(Dimension::Temperature, ABSOLUTE_TEMPERATURE);
pub(super) const KELVIN_APART: Value = Value::Quantity(Dimension::TemperatureDifference, ABOVE_ZERO);
pub(super) const KELVIN_FROM_ZERO: Value = Value::Quantity(Dimension::TemperatureDifference, FROM_ZERO);
pub(super) const LENGTH: Value = Value::Quantity(Dimension::Length, ABOVE_ZERO);
pub(super) const LENGTH_FROM_ZERO: Value = Value::Quantity(Dimension::Length, FROM_ZERO);
pub(super) const TIME: Value = Value::Quantity(Dimension::Time, ABOVE_ZERO);
pub(super) const SPEED: Value = Value::Quantity(Dimension::Speed, ABOVE_ZERO);
pub(super) const WAVENUMBER: Value = Value::Quantity(Dimension::Wavenumber, ABOVE_ZERO);
pub(super) const A_SHARE: Value = Value::Number(SHARE);
pub(super) const POSITIVE: Value = Value::Number(ABOVE_ZERO);
pub(super) const SHARE_ABOVE_ZERO: Allowed =
    Allowed { holds: |value| value > 0.0 && value <= 1.0, expected: "above 0, at most 1" };
pub(super) const POSITIVE_SHARE: Value = Value::Number(SHARE_ABOVE_ZERO);
pub(super) const WHOLE: Value = Value::Number(Allowed {
    holds: |value| value >= 0.0 && value.fract() == 0.0 && value <= 1e9,
    expected: "a whole number from 0",
});
pub(super) const COUNT: Value = Value::Count([1, u32::MAX]);
pub(super) const MATERIALS: Value = Value::List(&Value::Material);
pub(super) const TITLE: Key = Key::row(
    "title",
    Value::Text,
    Silent::Means("no heading"),
    "\"Person or robot?\"",
    "What it is about, in the heading of the answer.",
    "the heading of text and report",
);
