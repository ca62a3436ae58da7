//! Tables as CSV, with the unit in every header, and as Markdown.

use hadar::error::{Error, Result};
use hadar::words::visible;
use std::borrow::Cow;

/// A column: its name, and its cell in a row.
pub type Column<'a, T, C = String> = (&'a str, &'a dyn Fn(&T) -> C);

/// A table of text cells.
#[derive(Debug, Clone, Default)]
pub struct Table {
    header: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Table {
    /// A table with these column headers (unit included, e.g. `wavenumber_cm1`).
    #[must_use]
    pub fn new<S: Into<String>>(header: impl IntoIterator<Item = S>) -> Self {
        Self { header: header.into_iter().map(Into::into).collect(), rows: Vec::new() }
    }

    /// A row for each of `rows`, from columns that each have a name and make a cell of a row.
    #[must_use]
    pub fn of<T>(rows: &[T], columns: &[Column<'_, T>]) -> Self {
        let header = columns.iter().map(|(name, _)| (*name).to_owned()).collect();
        let row = |row| columns.iter().map(|(_, cell)| cell(row)).collect();
        Self { header, rows: rows.iter().map(row).collect() }
    }

    /// The same of numbers.
    #[must_use]
    pub fn of_numbers<T>(rows: &[T], columns: &[Column<'_, T, f64>]) -> Self {
        let header = columns.iter().map(|(name, _)| (*name).to_owned()).collect();
        let row = |row| columns.iter().map(|(_, of)| number(of(row))).collect();
        Self { header, rows: rows.iter().map(row).collect() }
    }

    /// A table of whole columns of numbers, which must be equally long ([`Table::to_csv`]).
    #[must_use]
    pub fn of_columns<S: Into<String>>(columns: impl IntoIterator<Item = (S, impl AsRef<[f64]>)>) -> Self {
        let (header, columns): (Vec<String>, Vec<_>) =
            columns.into_iter().map(|(name, values)| (name.into(), values)).unzip();
        let rows = columns.iter().map(|values| values.as_ref().len()).max().unwrap_or(0);
        let cell = |values: &[f64], row: usize| values.get(row).copied().map(number);
        let row = |row: usize| columns.iter().filter_map(|column| cell(column.as_ref(), row)).collect();
        Self { header, rows: (0..rows).map(row).collect() }
    }

    /// Adds a row of text cells.
    pub fn push(&mut self, row: Vec<String>) {
        self.rows.push(row);
    }

    /// Adds a row of numbers with all their digits.
    pub fn push_numbers(&mut self, row: &[f64]) {
        self.rows.push(row.iter().map(|&value| number(value)).collect());
    }

    /// Names of the columns.
    #[must_use]
    pub fn header(&self) -> &[String] {
        &self.header
    }

    /// All rows.
    #[must_use]
    pub fn rows(&self) -> &[Vec<String>] {
        &self.rows
    }

    /// The table as CSV text. A text that a spreadsheet would compute (`=1+1`, `@SUM(A1)`, `-2+3`) has an apostrophe before it, by which
    /// it is taken for text; numbers are as they are. Letters that are not seen are written out ([`visible`]).
    ///
    /// # Errors
    /// A row whose length is not the header's.
    pub fn to_csv(&self) -> Result<String> {
        csv_of(std::iter::once(&self.header).chain(&self.rows))
    }
}

/// The same of rows that are made one by one, the header first.
///
/// # Errors
/// As [`Table::to_csv`].
pub(crate) fn csv_of<R: IntoIterator<Item: AsRef<str>>>(rows: impl Iterator<Item = R>) -> Result<String> {
    let mut writer = csv::WriterBuilder::new().from_writer(Vec::new());
    let failed = |error: String| Error::malformed(error, "report this as a bug");
    for row in rows {
        for cell in row {
            writer.write_field(inert(cell.as_ref()).as_bytes()).map_err(|error| failed(error.to_string()))?;
        }
        writer.write_record(None::<&[u8]>).map_err(|error| failed(error.to_string()))?;
    }
    let bytes = writer.into_inner().map_err(|error| failed(error.to_string()))?;
    String::from_utf8(bytes).map_err(|error| failed(error.to_string()))
}

/// Whether a spreadsheet would take a cell for a formula, behind apostrophes that were before it. A dash alone is none, nor is what
/// begins with a number and has no operator in it, such as several numbers or `-20 to 50 degC`.
fn is_formula(cell: &str) -> bool {
    // Most begin with a letter or a digit.
    if cell.starts_with(|letter: char| letter.is_ascii_alphanumeric()) {
        return false;
    }
    let cell = cell.trim_start_matches('\'');
    let signed = cell.starts_with(['+', '-']) && cell != "-";
    let harmless = || {
        let first = cell.split(' ').next().unwrap_or_default().trim_end_matches([';', ',']);
        first.parse::<f64>().is_ok_and(f64::is_finite)
            && !cell.chars().skip(1).any(|letter| "*/^&=<>|!(\"'@".contains(letter))
            && !cell.contains(" +")
    };
    cell.starts_with(['=', '@', '\t', '\r', '\n', '\u{FF1D}', '\u{FF0B}', '\u{FF0D}', '\u{FF20}'])
        || signed && !harmless()
}

/// A cell as it is written, which no spreadsheet computes and in which all letters are seen.
fn inert(cell: &str) -> Cow<'_, str> {
    if is_formula(cell) { format!("'{}", visible(cell)).into() } else { visible(cell) }
}

/// A cell as it was before it was written.
#[must_use]
pub fn as_given(cell: &str) -> &str {
    cell.strip_prefix('\'').filter(|cell| is_formula(cell)).unwrap_or(cell)
}

/// A table in Markdown: its head, and a line for each row.
#[must_use]
pub fn markdown<R>(head: &[&str], rows: impl IntoIterator<Item = R>) -> String
where
    R: IntoIterator,
    R::Item: AsRef<str>,
{
    ruled_markdown("---", head, rows)
}

/// The same with another rule below the head of a column.
#[must_use]
pub fn ruled_markdown<R>(rule: &str, head: &[&str], rows: impl IntoIterator<Item = R>) -> String
where
    R: IntoIterator,
    R::Item: AsRef<str>,
{
    let line = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
    // A stroke would end the cell.
    let cells = |row: R| row.into_iter().map(|cell| cell.as_ref().replace('|', "\\|")).collect();
    let rule = format!("|{}\n", format!("{rule}|").repeat(head.len()));
    line(head.iter().map(|name| (*name).to_owned()).collect())
        + &rule
        + &rows.into_iter().map(|row| line(cells(row))).collect::<String>()
}

/// A number with the digits that give it back; empty where there is none.
#[must_use]
pub fn number(value: f64) -> String {
    let size = value.abs();
    if !value.is_finite() {
        String::new()
    } else if size != 0.0 && !(1e-4..1e7).contains(&size) {
        format!("{value:e}")
    } else {
        format!("{value}")
    }
}

/// Numbers in one cell.
#[must_use]
pub fn joined(values: &[f64]) -> String {
    values.iter().map(|value| number(*value)).collect::<Vec<_>>().join(" ")
}

/// Yes or no.
#[must_use]
pub fn yes_no(yes: bool) -> String {
    if yes { "yes" } else { "no" }.to_owned()
}

/// An optional number; empty where there is none.
#[must_use]
pub fn optional(value: Option<f64>) -> String {
    value.map_or_else(String::new, number)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stroke_ends_no_cell() {
        let expected = "| a | b |\n|---|---|\n| 1 | x \\| y |\n";
        assert_eq!(markdown(&["a", "b"], [["1", "x | y"]]), expected);
    }

    #[test]
    fn no_cell_is_a_formula() {
        for (cell, written) in [
            ("=HYPERLINK(\"x\")", "'=HYPERLINK(\"x\")"),
            ("@SUM(A1)", "'@SUM(A1)"),
            ("+1+cmd|' /C calc'!A0", "'+1+cmd|' /C calc'!A0"),
            ("-2+3", "'-2+3"),
            ("\t=1", "'\t=1"),
            ("'=1", "''=1"),
            ("\u{FF1D}1", "'\u{FF1D}1"),
            // Numbers, one or several, and what is no formula.
            ("-2.5e-3", "-2.5e-3"),
            ("+7", "+7"),
            ("-1 2 -3.5", "-1 2 -3.5"),
            ("-20 to 50 degC", "-20 to 50 degC"),
            ("-1 +cmd|' /C calc'!A0", "'-1 +cmd|' /C calc'!A0"),
            ("-A1", "'-A1"),
            ("-inf degC", "'-inf degC"),
            ("-", "-"),
            ("skin@wet", "skin@wet"),
            ("'tis", "'tis"),
            ("", ""),
        ] {
            assert_eq!(inert(cell), written);
            assert_eq!(as_given(&inert(cell)), cell);
        }
        assert_eq!(inert("=gold\u{202e}x"), "'=gold\\u{202e}x");
        let mut table = Table::new(["=name", "x"]);
        table.push(vec!["@a".into(), number(-1.0)]);
        assert_eq!(table.to_csv().unwrap(), "'=name,x\n'@a,-1\n");
    }

    #[test]
    fn numbers_survive_and_text_is_quoted() {
        let mut table = Table::new(["name", "photons"]);
        table.push(vec!["skin, wet".into(), number(1.276_123_456_789_012_3e6)]);
        table.push(vec!["none".into(), optional(None)]);
        assert_eq!(table.to_csv().unwrap(), "name,photons\n\"skin, wet\",1276123.4567890123\nnone,\n");
        assert!(
            Table { header: vec!["a".into()], rows: vec![vec!["1".into(), "2".into()]] }.to_csv().is_err()
        );
        let columns =
            |second: &[f64]| Table::of_columns([("a", vec![1.0, 2.0]), ("b", second.to_vec())]).to_csv();
        assert_eq!(columns(&[3.0, f64::NAN]).unwrap(), "a,b\n1,3\n2,\n");
        assert!(columns(&[3.0]).is_err() && columns(&[3.0, 4.0, 5.0]).is_err());
    }
}
