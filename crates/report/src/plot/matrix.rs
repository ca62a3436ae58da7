//! What a matrix of named rows and columns consists of, as plain data.

use super::axis::Axis;
use hadar::{Error, Result};

/// A value from which on cells are as they should be; those below it are marked.
#[derive(Debug, Clone, PartialEq)]
pub struct Threshold {
    /// The least value that is good enough, in the unit of the colour axis.
    pub value: f64,
    /// What a marked cell means, for the legend.
    pub meaning: String,
}

/// A quantity for every pair of names, such as the distance of each material from each other one.
///
/// The first row is at the top. Cells whose row and column have the same name are left blank, whatever their
/// value. A value that is not finite is drawn as "no value"; one of zero or below on a logarithmic colour scale has the
/// colour of its lower end.
#[derive(Debug, Clone, PartialEq)]
pub struct Matrix {
    /// One line that says what is shown; wraps when long.
    pub title: String,
    /// Small print under the title; wraps when long, nothing where empty.
    pub subtitle: String,
    /// What the rows are, e.g. `target`.
    pub row_title: String,
    /// Names of the rows, from the top.
    pub rows: Vec<String>,
    /// What the columns are, e.g. `alternative`.
    pub column_title: String,
    /// Names of the columns, from the left.
    pub columns: Vec<String>,
    /// The colour axis: title with unit, scale, range; colours of values outside the range are those at
    /// its ends.
    pub colour: Axis,
    /// Values, row after row: the one of row i and column j is at `i * columns.len() + j`.
    pub values: Vec<f64>,
    /// Cells below this value are marked.
    pub threshold: Option<Threshold>,
    /// Cells that are marked whatever their value, in the order of the values; those below the threshold where empty.
    pub marked: Vec<bool>,
    /// Rows at which a new group begins, rising; a line is drawn above each.
    pub row_groups: Vec<usize>,
    /// Columns at which a new group begins, rising; a line is drawn at the left of each.
    pub column_groups: Vec<usize>,
    /// What a cell without value means, for the legend.
    pub no_value: String,
}

impl Matrix {
    /// A matrix without threshold or groups; rows and columns come with what they are.
    pub fn new(
        title: impl Into<String>,
        (row_title, rows): (impl Into<String>, Vec<String>),
        (column_title, columns): (impl Into<String>, Vec<String>),
        (colour, values): (Axis, Vec<f64>),
    ) -> Self {
        Self {
            title: title.into(),
            subtitle: String::new(),
            row_title: row_title.into(),
            rows,
            column_title: column_title.into(),
            columns,
            colour,
            values,
            threshold: None,
            marked: vec![],
            row_groups: vec![],
            column_groups: vec![],
            no_value: "no value".to_owned(),
        }
    }

    /// Sets the small print under the title.
    #[must_use]
    pub fn subtitle(mut self, subtitle: impl Into<String>) -> Self {
        self.subtitle = subtitle.into();
        self
    }

    /// Marks the cells below a value, and says what that means.
    #[must_use]
    pub fn threshold(mut self, value: f64, meaning: impl Into<String>) -> Self {
        self.threshold = Some(Threshold { value, meaning: meaning.into() });
        self
    }

    /// Marks these cells, in the order of the values, in the place of those below the threshold.
    #[must_use]
    pub fn marked(mut self, marked: Vec<bool>) -> Self {
        self.marked = marked;
        self
    }

    /// Whether a cell is marked.
    pub(super) fn is_marked(&self, row: usize, column: usize, value: f64) -> bool {
        match self.marked.as_slice() {
            [] => self.threshold.as_ref().is_some_and(|threshold| value < threshold.value),
            marked => marked.get(row * self.columns.len() + column).copied().unwrap_or(false),
        }
    }

    /// Separates groups that begin at these rows, and at the same columns.
    #[must_use]
    pub fn groups(mut self, starts: Vec<usize>) -> Self {
        self.column_groups.clone_from(&starts);
        self.row_groups = starts;
        self
    }

    /// Says what a cell without value means.
    #[must_use]
    pub fn no_value(mut self, meaning: impl Into<String>) -> Self {
        self.no_value = meaning.into();
        self
    }

    pub(super) fn check(&self) -> Result<()> {
        let expected = self.columns.len().saturating_mul(self.rows.len());
        if self.values.len() != expected {
            let what = format!("cells of the matrix `{}`", self.title);
            return Err(Error::Length { what, found: self.values.len(), expected });
        }
        grouped("rows", &self.row_groups, self.rows.len())?;
        grouped("columns", &self.column_groups, self.columns.len())
    }

    /// Values of the cells that are not blank, with their row and column.
    pub(super) fn cells(&self) -> impl Iterator<Item = (usize, usize, f64)> {
        let width = self.columns.len().max(1);
        let places = self.values.iter().enumerate().map(move |(i, value)| (i / width, i % width, *value));
        places.filter(|(row, column, _)| self.rows.get(*row) != self.columns.get(*column))
    }
}

fn grouped(what: &str, starts: &[usize], count: usize) -> Result<()> {
    let rising = starts.windows(2).all(|pair| pair[0] < pair[1]);
    if rising && starts.iter().all(|start| *start < count) {
        return Ok(());
    }
    Err(Error::malformed(
        format!("the groups of the {what} of a matrix begin at {starts:?}"),
        format!("give rising numbers below the number of {what}, {count}"),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matrix(names: &[&str], values: Vec<f64>) -> Matrix {
        let names: Vec<String> = names.iter().map(|name| (*name).to_owned()).collect();
        Matrix::new("matrix", ("target", names.clone()), ("alternative", names), (Axis::log("d"), values))
    }

    #[test]
    fn wrong_lengths_and_groups_are_errors() {
        assert!(matrix(&["a", "b"], vec![1.0; 4]).check().is_ok());
        let error = matrix(&["a", "b"], vec![1.0; 3]).check().unwrap_err().to_string();
        assert_eq!(error, "cells of the matrix `matrix`: 3 values where 4 are needed");
        for groups in [vec![1, 1], vec![1, 0], vec![2]] {
            assert!(matrix(&["a", "b"], vec![1.0; 4]).groups(groups).check().is_err());
        }
        assert!(matrix(&["a", "b"], vec![1.0; 4]).groups(vec![1]).check().is_ok());
    }

    #[test]
    fn a_name_is_not_compared_with_itself() {
        let cells: Vec<_> = matrix(&["a", "b"], vec![1.0, 2.0, 3.0, 4.0]).cells().collect();
        assert_eq!(cells, [(0, 1, 2.0), (1, 0, 3.0)]);
    }
}
