//! Kinds of files and what tells them apart, so that a file given to the wrong command is sent to the right one.

use toml::de::{DeTable, DeValue};

use super::source::Source;
use super::written::STDIN;
use hadar::error::{Error, Result};
use std::path::Path;

/// A kind of file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Scenario,
    Rule,
    Range,
    Decompose,
    Library,
    Calibrate,
    Materials,
    Cameras,
}

/// How a key stands in a file.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Form {
    Any,
    /// `[[key]]`.
    Tables,
    /// `[key]` with a key `left`: of two views, which only ranging has.
    WithLeft,
}

/// What a file is, by one of the keys of which only it has any; those of an earlier row win.
struct Row {
    kind: Kind,
    told_by: &'static [(&'static str, Form)],
    name: &'static str,
}

const TABLE: &[Row] = &[
    Row { kind: Kind::Materials, told_by: &[("material", Form::Tables)], name: "a manifest of materials" },
    Row { kind: Kind::Library, told_by: &[("clusters", Form::Any)], name: "what a library is made from" },
    Row {
        kind: Kind::Calibrate,
        told_by: &[
            ("response", Form::Any),
            ("blackbody", Form::Any),
            ("noise", Form::Any),
            ("stripes", Form::Any),
        ],
        name: "a calibration",
    },
    Row {
        kind: Kind::Decompose,
        told_by: &[("library", Form::Any), ("truth", Form::Any)],
        name: "a decomposition scenario",
    },
    Row {
        kind: Kind::Range,
        told_by: &[
            ("signal", Form::Any),
            ("scene", Form::Any),
            ("cube", Form::WithLeft),
            ("stereo", Form::Any),
        ],
        name: "a ranging scenario",
    },
    Row {
        kind: Kind::Rule,
        told_by: &[
            ("cameras", Form::Any),
            ("rule", Form::Any),
            ("clause", Form::Any),
            ("stop", Form::Any),
            ("camera", Form::Tables),
        ],
        name: "a rule",
    },
    Row {
        kind: Kind::Scenario,
        told_by: &[
            ("target", Form::Any),
            ("environment", Form::Any),
            ("alternatives", Form::Any),
            ("background", Form::Any),
            ("atmosphere", Form::Any),
            ("unknown", Form::Any),
            ("sensitivity", Form::Any),
        ],
        name: "a scenario of a target",
    },
];

impl Kind {
    /// The kind of a file, and the key that tells it; none of one that has the keys of several, or of none.
    fn of(document: &DeTable<'_>) -> Option<(Self, &'static Row, &'static str)> {
        let found = |row: &'static Row| {
            let is_there = |(key, form): &&(&str, Form)| {
                let value = document.get(*key).map(toml::Spanned::get_ref);
                let tables = |value: &DeValue<'_>| {
                    matches!(value, DeValue::Array(items)
                        if items.iter().any(|item| matches!(item.get_ref(), DeValue::Table(_))))
                };
                let with_left = |value: &DeValue<'_>| matches!(value, DeValue::Table(table) if table.contains_key("left"));
                value.is_some_and(|value| match form {
                    Form::Any => true,
                    Form::Tables => tables(value),
                    Form::WithLeft => with_left(value),
                })
            };
            row.told_by.iter().find(is_there).map(|(key, _)| (row, *key))
        };
        let kinds: Vec<_> = TABLE.iter().filter_map(found).collect();
        let has = |kind| kinds.iter().any(|(row, _)| row.kind == kind);
        let (row, key) = *kinds.first()?;
        match row.kind {
            // A list of cameras alone is no rule.
            Kind::Rule if key == "camera" && !has(Kind::Scenario) => Some((Kind::Cameras, row, key)),
            // The air between has a target before it.
            Kind::Range if key == "signal" => Some((Kind::Range, row, key)),
            // Whoever mixes a target with a scene to range in is told by the keys that do not belong.
            Kind::Range | Kind::Materials if kinds.len() > 1 => None,
            kind => Some((kind, row, key)),
        }
    }

    /// The command that answers a file, if there is one for its kind.
    pub(super) fn command_for(document: &DeTable<'_>) -> Option<&'static str> {
        match Self::of(document)?.0 {
            Self::Scenario => Some("size"),
            Self::Rule => Some("rule"),
            Self::Range => Some("range"),
            Self::Decompose => Some("decompose"),
            Self::Library => Some("library"),
            Self::Calibrate | Self::Materials | Self::Cameras => None,
        }
    }

    /// Refuses a file of another kind than this one, which a command asks for, and names the command it is for.
    pub(super) fn check(self, document: &DeTable<'_>, source: &Source) -> Result<()> {
        let Some((kind, row, key)) = Self::of(document) else { return Ok(()) };
        // An envelope is all that a rule without cameras has of its own.
        if kind == self || (self == Kind::Rule && kind == Kind::Scenario && document.contains_key("envelope"))
        {
            return Ok(());
        }
        let file = match &source.path {
            None => "FILE".into(),
            Some(path) if path == Path::new(STDIN) => "-".into(),
            Some(path) => path.display().to_string(),
        };
        let (name, instead) = match kind {
            Kind::Scenario if self == Kind::Rule => (
                row.name,
                format!(
                    "hadar size {file}, or write cameras = [\"flir-a325sc\"] above the first [table] to make it a rule"
                ),
            ),
            Kind::Scenario => (row.name, format!("hadar size {file}")),
            Kind::Rule => (row.name, format!("hadar rule {file}")),
            Kind::Range => (row.name, format!("hadar range {file}")),
            Kind::Decompose => (row.name, format!("hadar decompose {file}")),
            Kind::Library => (row.name, format!("hadar library {file}")),
            Kind::Calibrate => (row.name, format!("hadar calibrate {key} {file}")),
            Kind::Materials => (row.name, "name a scenario, and give its folder to --library".into()),
            Kind::Cameras => {
                ("a list of cameras", "write one as [camera] of a scenario that has a [target]".into())
            }
        };
        let mut place = source.place(key);
        place.key = None;
        Err(Error::malformed(format!("this is {name}"), instead).at(place))
    }
}
