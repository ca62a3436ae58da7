//! Which rows there are: every case with every combination of the axes, the last axis changing first.

use super::axis::{Axis, MOST_VALUES, column, with_unit};
use super::cases::Cases;
use super::cell::Cell;
use hadar::error::{Error, Result};
use hadar_scenario::{Setting, Written};
use std::collections::BTreeMap;

/// The rows of a sweep.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    cases: Option<Cases>,
    axes: Vec<Axis>,
    rows: usize,
}

/// What is varied, as a column: a cell for each of its values that differ.
#[derive(Debug, Clone, PartialEq)]
pub struct Input {
    /// The key.
    pub key: String,
    /// Unit of its numbers; empty where they have none.
    pub unit: String,
    /// Head of the column: the key, with the unit where all values have the same one.
    pub name: String,
    /// What each value says.
    pub cells: Vec<Cell>,
    /// Whether the values are spread logarithmically.
    pub logarithmic: bool,
    /// Which of them each case, or each place of the axis, has.
    places: Vec<usize>,
    /// Rows until the next place.
    stride: usize,
}

impl Input {
    /// Index of its value in a row.
    #[must_use]
    pub fn index(&self, row: usize) -> usize {
        let place = row / self.stride.max(1) % self.places.len().max(1);
        self.places.get(place).copied().unwrap_or(0)
    }

    /// What it is in a row.
    #[must_use]
    pub fn cell(&self, row: usize) -> Cell {
        self.cells.get(self.index(row)).cloned().unwrap_or_default()
    }
}

impl Plan {
    /// All cases with all combinations of the axes.
    ///
    /// # Errors
    /// Nothing that is varied, a key that is varied twice, more rows than a table can have.
    pub fn new(axes: Vec<Axis>, cases: Option<Cases>) -> Result<Self> {
        let mut keys: Vec<&str> = cases.iter().flat_map(|cases| &cases.keys).map(String::as_str).collect();
        if axes.is_empty() && keys.is_empty() {
            let instead = "write --vary camera.exposure=\"1 ms..100 ms:40:log\", or --cases cases.csv";
            return Err(Error::malformed("nothing is varied", instead));
        }
        for axis in &axes {
            if keys.contains(&axis.key.as_str()) {
                let found = format!("`{}` is varied twice", axis.key);
                return Err(Error::malformed(found, "name all its values in one place"));
            }
            keys.push(&axis.key);
        }
        let counts =
            cases.iter().map(|cases| cases.rows.len()).chain(axes.iter().map(|axis| axis.values.len()));
        let rows = counts.clone().try_fold(1_usize, |rows, count| rows.checked_mul(count));
        match rows.filter(|rows| *rows <= MOST_VALUES) {
            Some(rows) => Ok(Self { cases, axes, rows }),
            None => {
                let counts: Vec<String> = counts.map(|count| count.to_string()).collect();
                let found = format!("{} rows", counts.join(" x "));
                Err(Error::malformed(found, format!("vary less, for {MOST_VALUES} rows at most")))
            }
        }
    }

    /// How many rows there are.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// What is set in a row.
    #[must_use]
    pub fn settings(&self, row: usize) -> Vec<Setting> {
        let mut stride = self.rows;
        let mut digit = |count: usize| {
            stride /= count.max(1);
            row / stride.max(1) % count.max(1)
        };
        let mut settings = Vec::new();
        if let Some(cases) = &self.cases {
            let index = digit(cases.rows.len());
            let values = cases.rows.get(index).into_iter().flatten();
            let given = cases.keys.iter().zip(values).filter(|(_, value)| !value.is_empty());
            settings.extend(given.map(|(key, value)| setting("--cases", key, value)));
        }
        for axis in &self.axes {
            let index = digit(axis.values.len());
            settings.extend(axis.values.get(index).map(|value| setting("--vary", &axis.key, value)));
        }
        settings
    }

    /// What is varied, as columns.
    #[must_use]
    pub fn inputs(&self) -> Vec<Input> {
        let mut inputs = Vec::new();
        let mut stride = self.rows;
        if let Some(cases) = &self.cases {
            stride /= cases.rows.len().max(1);
            for (i, key) in cases.keys.iter().enumerate() {
                let values = cases.rows.iter().map(|row| row.get(i).map_or("", String::as_str));
                inputs.push(Input { stride, ..input(key, values) });
            }
        }
        for axis in &self.axes {
            stride /= axis.values.len().max(1);
            let input = input(&axis.key, axis.values.iter().map(String::as_str));
            inputs.push(Input { logarithmic: axis.logarithmic, stride, ..input });
        }
        inputs
    }

    /// Refuses, before any work, keys of which no value can be read: of each the first message, where all are about it.
    ///
    /// # Errors
    /// Such a message.
    pub fn check(&self, file: &Written, read: &dyn Fn(&Written) -> Result<()>) -> Result<()> {
        let first = self.settings(0);
        let mut columns: Vec<(&str, &'static str, Vec<&str>)> = Vec::new();
        for (i, key) in self.cases.iter().flat_map(|cases| cases.keys.iter().enumerate()) {
            let rows = self.cases.iter().flat_map(|cases| &cases.rows);
            let values = rows.filter_map(|row| row.get(i)).map(String::as_str);
            columns.push((key, "--cases", values.filter(|value| !value.is_empty()).collect()));
        }
        for axis in &self.axes {
            columns.push((&axis.key, "--vary", axis.values.iter().map(String::as_str).collect()));
        }
        for (key, by, values) in columns {
            let own = format!("{by} {key}");
            let mut refused = None;
            for value in values {
                let others = first.iter().filter(|setting| setting.key != key).cloned();
                let error = read(&file.with(others.chain([setting(by, key, value)]))).err();
                // One that is read, or a message about something else: it is the rows' business.
                let about = error.filter(|error| is_about(error, &own));
                if about.is_none() {
                    refused = None;
                    break;
                }
                refused = refused.or(about);
            }
            if let Some(error) = refused {
                return Err(error);
            }
        }
        Ok(())
    }
}

/// Whether an error is about a key that was set, which has no place in a file.
fn is_about(error: &Error, own: &str) -> bool {
    let Error::At { place, .. } = error else { return false };
    let key = place.key.as_ref().filter(|_| place.path.is_none() && place.line.is_none());
    key.is_some_and(|key| key.starts_with(own))
}

fn input<'v>(key: &str, values: impl Iterator<Item = &'v str> + Clone) -> Input {
    let (unit, of_places) = column(key, values);
    let (mut cells, mut known) = (Vec::new(), BTreeMap::new());
    let mut place = |cell: Cell| {
        // Numbers have no order of their own; each text gives its number back.
        *known.entry(format!("{cell:?}")).or_insert_with(|| {
            cells.push(cell);
            cells.len() - 1
        })
    };
    let places = of_places.into_iter().map(&mut place).collect();
    Input {
        key: key.to_owned(),
        name: with_unit(key, &unit),
        unit,
        cells,
        logarithmic: false,
        places,
        stride: 1,
    }
}

fn setting(by: &'static str, key: &str, value: &str) -> Setting {
    Setting { key: key.to_owned(), value: value.to_owned(), by }
}
