//! Tables as Parquet: columns of one type each, a missing value is null, Snappy.
//!
//! Numbers are doubles, whole numbers int64, yes and no boolean, texts UTF-8; a column whose values are of several kinds is text, one
//! without a value double. Format: [Apache Parquet](https://parquet.apache.org/docs/file-format/), version 2.

use super::table;
use hadar::error::{Error, Result};
use hadar_study::sweep::Cell;

/// A column of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Its head, with the unit.
    pub name: String,
    /// Its values, row by row.
    pub cells: Vec<Cell>,
    /// Whether it is of texts, even where it has none.
    pub is_text: bool,
}

/// A value as text, numbers with all digits; empty where there is none.
#[must_use]
pub fn text(cell: &Cell) -> String {
    match cell {
        Cell::Empty => String::new(),
        Cell::Boolean(value) => value.to_string(),
        Cell::Integer(whole) => whole.to_string(),
        Cell::Number(number) => table::number(*number),
        Cell::Text(text) => text.as_ref().to_owned(),
    }
}

/// The columns of a CSV text that this program wrote.
///
/// # Errors
/// A text that is no table.
pub fn of_csv(text: &str) -> Result<Vec<Column>> {
    let failed = |error: csv::Error| Error::malformed(error.to_string(), "report this as a bug");
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let header = reader.headers().map_err(failed)?.clone();
    let mut columns: Vec<Column> = header
        .iter()
        .map(|name| Column { name: table::as_given(name).to_owned(), cells: Vec::new(), is_text: false })
        .collect();
    for record in reader.records() {
        let record = record.map_err(failed)?;
        for (column, cell) in columns.iter_mut().zip(record.iter()) {
            column.cells.push(match (cell, cell.parse::<i64>(), cell.parse::<f64>()) {
                ("", ..) => Cell::Empty,
                ("true" | "false", ..) => Cell::Boolean(cell == "true"),
                (_, Ok(whole), _) => Cell::Integer(whole),
                (_, _, Ok(number)) if number.is_finite() => Cell::Number(number),
                _ => Cell::Text(table::as_given(cell).into()),
            });
        }
    }
    Ok(columns)
}

/// The columns as a file.
///
/// # Errors
/// Columns of different lengths, or of one name; a program that was built without Parquet.
#[cfg(not(feature = "parquet"))]
pub fn file(_: &[Column]) -> Result<Vec<u8>> {
    let found = "this program was built without Parquet";
    Err(Error::malformed(found, "build it with --features parquet, or read the CSV"))
}

#[cfg(feature = "parquet")]
pub use written::file;

#[cfg(feature = "parquet")]
mod written;
