//! A table of a page. One too wide for paper is set in several, each with the first column; of a long one the beginning.

use super::element::{self, escape, wide};
use crate::table::Table;
use crate::text::significant;
use crate::words::page;

/// Most columns beside the first.
const COLUMNS: usize = 6;
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
    let parts = others.len().div_ceil(COLUMNS).max(1);
    let mut out = String::new();
    for part in 0..parts {
        let columns = part * COLUMNS + 1..(part * COLUMNS + 1 + COLUMNS).min(header.len());
        let shown = page::shown(part + 1, parts, ROWS, rows.len());
        let caption = format!("{} ({}){shown}", escape(&title(name)), escape(name));
        let heads: String = columns
            .clone()
            .map(|i| format!("<th scope=\"col\"{}>{}</th>", classes[i], head(&header[i])))
            .collect();
        let cells = |row: &Vec<String>| {
            let cell = |i: usize| format!("<td{}>{}</td>", classes[i], escape(&short(text(row, i))));
            (escape(&short(text(row, 0))), columns.clone().map(cell).collect())
        };
        let rows = rows.iter().take(ROWS).map(cells);
        out.push_str(&wide(&caption, &element::table("", &caption, (&head(first), &heads), rows)));
    }
    out
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
