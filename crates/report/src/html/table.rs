//! The table of a file, folded until it is asked for; of a long one the beginning.

use super::element::{self, escape, wide};
use crate::table::Table;
use crate::text::significant;
use crate::words::page;

/// Most columns that are set at all.
const WIDEST: usize = 30;
/// Most rows.
const ROWS: usize = 60;
/// Digits of a number; the file has all of them.
const DIGITS: usize = 4;

fn text(row: &[String], column: usize) -> &str {
    row.get(column).map_or("", String::as_str)
}

/// The table of a file.
pub(super) fn html(name: &str, table: &Table) -> String {
    let (header, rows) = (table.header(), table.rows());
    let Some((first, others)) = header.split_first() else { return String::new() };
    if rows.is_empty() {
        return String::new();
    }
    // Numbers stand below each other, and their heads above them.
    let is_number = |text: &str| text.is_empty() || text.parse::<f64>().is_ok();
    let numeric = (0..header.len()).map(|i| rows.iter().all(|row| is_number(text(row, i))));
    let classes: Vec<&str> = numeric.map(|yes| if yes { " class=\"number\"" } else { "" }).collect();
    if header.len() > WIDEST {
        return format!("<p>{}</p>\n", page::too_wide(&escape(name), header.len()));
    }
    let shown = page::shown(ROWS, rows.len());
    let caption = format!("{} ({}){shown}", escape(&title(name)), escape(name));
    let heads: String = others
        .iter()
        .zip(classes.iter().skip(1))
        .map(|(name, class)| format!("<th scope=\"col\"{class}>{}</th>", head(name)))
        .collect();
    let cells = |row: &Vec<String>| {
        let cell = |(i, class): (usize, &&str)| format!("<td{class}>{}</td>", escape(&short(text(row, i))));
        (escape(&short(text(row, 0))), classes.iter().enumerate().skip(1).map(cell).collect())
    };
    let rows = rows.iter().take(ROWS).map(cells);
    let table = element::table("", &caption, (&head(first), &heads), rows);
    format!("<details>\n<summary>{caption}</summary>\n{}</details>\n", wide(&caption, &table))
}

/// `noise_budget.csv` as it is spoken.
fn title(name: &str) -> String {
    let words = name.strip_suffix(".csv").unwrap_or(name).replace('_', " ");
    let mut letters = words.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// The head of a column, which may break where its words end.
fn head(name: &str) -> String {
    escape(name).replace('_', "_<wbr>")
}

/// A number with the digits that are read.
fn short(text: &str) -> String {
    match text.parse::<f64>() {
        Ok(value) if text.len() > DIGITS + 2 => significant(value, DIGITS),
        _ => text.to_owned(),
    }
}
