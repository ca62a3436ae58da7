//! The rows of a sweep, column by column.

use crate::parquet::Column;
use hadar::error::{Error, Result};
use hadar_study::sweep::{Cell, Input, Record, is_within};
use std::collections::BTreeMap;

/// What is there of the rows of a sweep.
#[derive(Debug)]
pub struct Gathered {
    /// What is varied.
    pub inputs: Vec<Input>,
    /// Rows that were answered, that failed with a message, that are not there.
    status: Vec<Option<std::result::Result<(), String>>>,
    /// Values of the answers by the name of their column, row by row.
    values: BTreeMap<String, Vec<Cell>>,
}

impl Gathered {
    /// So many rows, of which none is there.
    #[must_use]
    pub fn new(inputs: Vec<Input>, rows: usize) -> Self {
        Self { inputs, status: vec![None; rows], values: BTreeMap::new() }
    }

    /// Puts an answer, or the message of a row that failed; an answer stays.
    pub fn put(&mut self, row: usize, outcome: std::result::Result<Record, String>) {
        let rows = self.status.len();
        let Some(status) = self.status.get_mut(row).filter(|status| !matches!(status, Some(Ok(())))) else {
            return;
        };
        match outcome {
            Err(message) => *status = Some(Err(message)),
            Ok(record) => {
                *status = Some(Ok(()));
                for (name, cell) in record {
                    let column = self.values.entry(name).or_insert_with(|| vec![Cell::Empty; rows]);
                    // What many rows say, such as conditions, is kept once.
                    let before = row.checked_sub(1).and_then(|before| column.get(before));
                    let cell = before.filter(|before| **before == cell).cloned().unwrap_or(cell);
                    if let Some(slot) = column.get_mut(row) {
                        *slot = cell;
                    }
                }
            }
        }
    }

    /// What a row answers.
    #[must_use]
    pub fn record(&self, row: usize) -> Record {
        let cell = |(name, cells): (&String, &Vec<Cell>)| Some((name.clone(), cells.get(row)?.clone()));
        self.values.iter().filter_map(cell).filter(|(_, cell)| *cell != Cell::Empty).collect()
    }

    /// How many rows there are to be.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.status.len()
    }

    /// How many were answered.
    #[must_use]
    pub fn answered(&self) -> usize {
        self.status.iter().filter(|status| matches!(status, Some(Ok(())))).count()
    }

    /// Rows that failed, with their messages.
    pub fn failed(&self) -> impl Iterator<Item = (usize, &str)> {
        self.status.iter().enumerate().filter_map(|(row, status)| match status {
            Some(Err(message)) => Some((row, message.as_str())),
            _ => None,
        })
    }

    /// The values of a column of the answers.
    #[must_use]
    pub fn values(&self, name: &str) -> Option<&[Cell]> {
        self.values.get(name).map(Vec::as_slice)
    }

    /// Names of the columns of the answers that are chosen, all where nothing is: those of the verdict first.
    ///
    /// # Errors
    /// A name that no row has.
    pub fn names(&self, chosen: &[String]) -> Result<Vec<&str>> {
        let mut names: Vec<&str> = Vec::new();
        if chosen.is_empty() {
            names.extend(self.values.keys().map(String::as_str));
            names.sort_by_key(|name| !name.starts_with("verdict."));
            return Ok(names);
        }
        for asked in chosen {
            let all = self.values.keys().map(String::as_str);
            let found: Vec<&str> = all.filter(|name| is_within(name, asked)).collect();
            // Where every row failed nothing is known of the columns.
            if found.is_empty() && self.answered() > 0 {
                let known = self.values.keys().map(String::as_str);
                return Err(Error::unknown_name("column", asked, known).for_key("--columns"));
            }
            for name in found {
                if !names.contains(&name) {
                    names.push(name);
                }
            }
        }
        Ok(names)
    }

    /// The table of the rows that are there. A column of the answers that is called as one of what is varied is that.
    ///
    /// # Errors
    /// As [`Gathered::names`].
    pub fn columns(&self, chosen: &[String]) -> Result<Vec<Column>> {
        let names = self.names(chosen)?;
        let rows: Vec<usize> =
            (0..self.rows()).filter(|row| self.status.get(*row).is_some_and(Option::is_some)).collect();
        let column = |name: &str, cell: &dyn Fn(usize) -> Cell| Column {
            name: name.to_owned(),
            cells: rows.iter().map(|row| cell(*row)).collect(),
            is_text: ["status", "message", "warnings"].contains(&name),
        };
        let mut columns = vec![column("row", &|row| i64::try_from(row).map_or(Cell::Empty, Cell::Integer))];
        columns.extend(self.inputs.iter().map(|input| column(&input.name, &|row| input.cell(row))));
        let failed = |row: usize| {
            self.status.get(row).and_then(Option::as_ref).and_then(|status| status.as_ref().err())
        };
        let [ok, error] = ["ok", "error"].map(|status| Cell::Text(status.into()));
        columns.push(column("status", &|row| if failed(row).is_some() { error.clone() } else { ok.clone() }));
        columns.push(column("message", &|row| {
            failed(row).map_or(Cell::Empty, |message| Cell::Text(message.as_str().into()))
        }));
        for name in names {
            if columns.iter().all(|column| column.name != name) {
                let values = self.values(name).unwrap_or_default();
                columns.push(column(name, &|row| values.get(row).cloned().unwrap_or_default()));
            }
        }
        Ok(columns)
    }
}
