//! Tables in texts: columns below their heads.

/// A column: its head, the characters that it has at least, and whether its cells stand at the right.
pub(crate) struct Column<'a> {
    head: &'a str,
    width: usize,
    right: bool,
}

/// A column of names.
pub(crate) const fn left(head: &str, width: usize) -> Column<'_> {
    Column { head, width, right: false }
}

/// A column of numbers.
pub(crate) const fn right(head: &str, width: usize) -> Column<'_> {
    Column { head, width, right: true }
}

/// A table whose columns have the widths that they are given, set off from the margin by two blanks.
pub(crate) struct Columns<'a> {
    columns: Vec<Column<'a>>,
    gap: &'static str,
    text: String,
}

impl<'a> Columns<'a> {
    /// With two blanks between columns, and a line of heads.
    pub(crate) fn new(columns: impl IntoIterator<Item = Column<'a>>) -> Self {
        let mut table = Self { gap: "  ", ..Self::headless(columns) };
        table.heads();
        table
    }

    /// With one blank between columns, and a line of heads. A column without width makes two of it.
    pub(crate) fn narrow(columns: impl IntoIterator<Item = Column<'a>>) -> Self {
        let mut table = Self { gap: " ", ..Self::headless(columns) };
        table.heads();
        table
    }

    /// Without a line of heads.
    pub(crate) fn headless(columns: impl IntoIterator<Item = Column<'a>>) -> Self {
        Self { columns: columns.into_iter().collect(), gap: "  ", text: String::new() }
    }

    fn heads(&mut self) {
        let heads: Vec<&str> = self.columns.iter().map(|column| column.head).collect();
        self.row(heads);
    }

    /// Adds a row, which may have fewer cells than there are columns.
    pub(crate) fn row<S: AsRef<str>>(&mut self, cells: impl IntoIterator<Item = S>) {
        let cells: Vec<S> = cells.into_iter().collect();
        for (i, (cell, Column { width, right, .. })) in cells.iter().zip(&self.columns).enumerate() {
            let (cell, gap) = (cell.as_ref(), if i == 0 { "  " } else { self.gap });
            self.text += &match right {
                true => format!("{gap}{cell:>width$}"),
                false if i + 1 == cells.len() => format!("{gap}{cell}"),
                false => format!("{gap}{cell:<width$}"),
            };
        }
        self.text.push('\n');
    }

    /// Adds what is said between rows.
    pub(crate) fn line(&mut self, text: &str) {
        self.text += text;
        self.text.push('\n');
    }

    /// The table.
    pub(crate) fn text(self) -> String {
        self.text
    }
}

/// Rows of which each column is as wide as its widest cell, those of numbers to the right; the last cell of a row that is shorter than the
/// first is as long as it is.
pub(crate) fn aligned<R: AsRef<[String]>>(rows: &[R], numbers: &[usize]) -> String {
    let all = rows.first().map_or(0, |row| row.as_ref().len());
    let width = |column: usize| {
        let cells = rows.iter().map(AsRef::as_ref).filter(|row| row.len() == all || column + 1 < row.len());
        cells.filter_map(|row| row.get(column)).map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..all).map(width).collect();
    let mut out = String::new();
    for row in rows {
        let cells = row.as_ref().iter().zip(&widths).enumerate().map(|(column, (cell, width))| {
            if numbers.contains(&column) { format!("{cell:>width$}") } else { format!("{cell:<width$}") }
        });
        out.push_str(cells.collect::<Vec<_>>().join("  ").trim_end());
        out.push('\n');
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_stand_below_their_heads() {
        let mut table = Columns::new([left("name", 6), right("photons", 9), left("from", 8)]);
        table.row(["skin", "12", "a"]);
        table.row(["aluminium", "3"]);
        table.line("    said of it");
        assert_eq!(
            table.text(),
            "  name      photons  from\n  skin           12  a\n  aluminium          3\n    said of it\n"
        );
        let mut narrow = Columns::narrow([right("row", 4), left("", 0), left("signal", 7), right("rmse", 6)]);
        narrow.row(["1", "", "cube", "0.5"]);
        assert_eq!(narrow.text(), "   row  signal    rmse\n     1  cube       0.5\n");
    }
}
