//! Tables as programs write them: which sign stands between the columns, which one is the decimal sign, which line is the header.
//!
//! Commas, semicolons, tabs, bars or blanks; decimal points or commas; cells in quotes; comment lines that begin with `#`, `%`, `!`
//! or `//`. Of all ways to read the lines that one is taken by which most of them are numbers; where two of them give other numbers,
//! or `1,500` may be 1.5 or 1500, it is asked for. The header is the last line above the numbers that names an axis, in a
//! comment too, as NumPy writes it; a line of units may follow it.

use super::header;
use super::reading::Reading;
use crate::spectral_unit::SpectralUnit;
use hadar::error::{Error, Result};
use hadar::grid::{EXAMPLE, Grid, number};
use std::borrow::Cow;

/// Lines that are tried to tell the form, from the start and from the middle.
const TRIED: usize = 20;
const COMMENTS: [&str; 4] = ["#", "%", "!", "//"];
/// Delimiters that are tried; a blank stands for any number of them. Of those that say the same the first is taken.
const DELIMITERS: [(char, &str); 5] =
    [('\t', "tabs"), (';', "semicolons"), ('|', "bars"), (',', "commas"), (' ', "blanks")];

/// How numbers stand in a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Form {
    delimiter: char,
    decimal: char,
}

impl Form {
    /// In words, where it is not the plain one.
    pub(super) fn in_words(self) -> String {
        let between =
            DELIMITERS.iter().find(|(delimiter, _)| *delimiter == self.delimiter).map_or("", |known| known.1);
        match self {
            Self { delimiter: ',', decimal: '.' } => String::new(),
            Self { decimal: '.', .. } => format!("{between} between columns"),
            _ => format!("{between} between columns, decimal commas"),
        }
    }

    /// Cells of a line, without their quotes.
    fn cells(self, line: &str) -> Vec<&str> {
        split(line, self.delimiter)
    }

    fn number(self, cell: &str) -> Result<f64> {
        number(&self.with_point(cell))
    }

    /// A number with a decimal point, if it has this form's decimal comma.
    fn with_point(self, cell: &str) -> Cow<'_, str> {
        match cell.split_once(',') {
            Some((whole, rest))
                if self.decimal == ',' && rest.starts_with(|char: char| char.is_ascii_digit()) =>
            {
                Cow::Owned(format!("{whole}.{rest}"))
            }
            _ => Cow::Borrowed(cell),
        }
    }

    /// All numbers of a line of at least two, if it has nothing else.
    fn numbers(self, line: &str) -> Option<Vec<f64>> {
        let mut cells = self.cells(line);
        // Some programs end lines with a delimiter.
        if cells.len() > 2 {
            cells.pop_if(|cell| cell.is_empty());
        }
        let point_is_there = |cell: &&str| self.decimal == ',' && cell.contains('.');
        if cells.len() < 2 || cells.iter().any(point_is_there) {
            return None;
        }
        cells
            .iter()
            .map(|cell| self.with_point(cell).parse().ok().filter(|value: &f64| value.is_finite()))
            .collect()
    }
}

/// Most spectra of one file: each takes a thousand bytes of memory, however short it is.
pub(super) const MOST_SPECTRA: usize = 100_000;

/// Whether a line has more columns than are read, in any form.
fn too_wide(line: &str) -> bool {
    let marks = |line: &str| line.matches(['\t', ';', '|', ',']).count();
    line.len() > MOST_SPECTRA && marks(line).max(line.split_whitespace().count()) > MOST_SPECTRA
}

/// Cells of a line between delimiters that are not in quotes.
fn split(line: &str, delimiter: char) -> Vec<&str> {
    let (mut cells, mut start, mut quoted) = (Vec::new(), 0, false);
    for (at, char) in line.char_indices() {
        let ends = if delimiter == ' ' { char.is_whitespace() } else { char == delimiter };
        if char == '"' {
            quoted = !quoted;
        } else if ends && !quoted {
            cells.push(line.get(start..at).unwrap_or_default());
            start = at + char.len_utf8();
        }
    }
    cells.push(line.get(start..).unwrap_or_default());
    let plain = cells.into_iter().map(|cell| cell.trim().trim_matches(['"', '\'']).trim());
    if delimiter == ' ' { plain.filter(|cell| !cell.is_empty()).collect() } else { plain.collect() }
}

/// A table, and how it was written.
#[derive(Debug)]
pub(super) struct Sheet {
    pub(super) grid: Grid,
    pub(super) form: Form,
    /// Lowest and highest number of every column.
    pub(super) ranges: Vec<(f64, f64)>,
}

/// Reads a table; its headers are those of the reading where the file has none.
///
/// # Errors
/// No rows, no header, a form that two readings fit, rows of another length than the header, a cell that is no finite number.
pub(super) fn read(text: &str, reading: &Reading) -> Result<Sheet> {
    let columns = reading.columns_said();
    let lines: Vec<(usize, &str)> = text
        .lines()
        .enumerate()
        // A tab at an end belongs to an empty cell.
        .map(|(index, line)| (index + 1, line.trim_matches([' ', '\r'])))
        .filter(|(_, line)| !line.trim().is_empty())
        .collect();
    let is_comment = |line: &str| COMMENTS.iter().any(|sign| line.starts_with(sign)) || is_excel_hint(line);
    let (comments, table): (Vec<_>, Vec<_>) = lines.into_iter().partition(|(_, line)| is_comment(line));
    let Some(&(first_line, first)) = table.first() else {
        return Err(Error::malformed("the file has no rows", EXAMPLE));
    };
    if let Some((line, _)) = table.iter().find(|(_, row)| too_wide(row)) {
        let found = format!("more than {MOST_SPECTRA} columns");
        return Err(Error::malformed(found, "write the spectra into several files").on_line(*line));
    }
    let form = form(&table)?;
    let begin = table.iter().position(|(_, line)| form.numbers(line).is_some());
    let ranges = |from: usize| ranges(form, table.get(from..).unwrap_or_default());
    let (header, header_line, begin) = match (columns, begin) {
        (Some(columns), Some(0)) => (columns.to_vec(), first_line, 0),
        (Some(_), _) => {
            let found = "--columns says what the columns are, and the file has a header or other text above its numbers";
            return Err(
                Error::malformed(found, "leave --columns out, or delete the text").on_line(first_line)
            );
        }
        (None, Some(0)) => {
            match comments.iter().filter_map(|comment| commented_header(*comment, form, first)).next_back() {
                Some((line, header)) => (header, line, 0),
                None => {
                    let found = "there is no header, only numbers";
                    let header = header::suggested(&[], &ranges(0));
                    let instead = format!(
                        "write above them the line that is true of this file, such as {header}, or import it with --columns {header}"
                    );
                    return Err(Error::malformed(found, instead).on_line(first_line));
                }
            }
        }
        (None, _) => header_above(form, &table, begin)?,
    };
    let rows = table.get(begin..).unwrap_or_default().iter();
    let rows = rows
        .map(|&(line, row)| {
            Ok((line, numbers(form, row, &header, reading).map_err(|error| error.on_line(line))?))
        })
        .collect::<Result<Vec<_>>>()?;
    let ranges = ranges_of(rows.iter().map(|(_, cells)| cells.as_slice()));
    Ok(Sheet { grid: Grid { header, header_line, rows }, form, ranges })
}

/// A first line by which Excel is told the delimiter.
fn is_excel_hint(line: &str) -> bool {
    line.get(..4).is_some_and(|start| start.eq_ignore_ascii_case("sep=")) && line.len() < 8
}

/// The numbers of the lines that are tried, where they are numbers.
type Tried = Vec<Option<Vec<f64>>>;

/// The form by which most lines are numbers.
fn form(table: &[(usize, &str)]) -> Result<Form> {
    let middle = table.len() / 2;
    let tried = table.iter().take(TRIED).chain(table.iter().skip(middle.max(TRIED)).take(TRIED));
    let tried: Vec<(usize, &str)> = tried.copied().collect();
    let mut best: Option<(usize, Form, Tried)> = None;
    for (delimiter, _) in DELIMITERS {
        for decimal in ['.', ','] {
            let form = Form { delimiter, decimal };
            let read: Tried = tried.iter().map(|(_, line)| form.numbers(line)).collect();
            let count = read.iter().flatten().count();
            match &best {
                Some((most, _, numbers)) if count == *most && count > 0 => {
                    if *numbers != read {
                        let found = "the numbers may be read in two ways";
                        return Err(Error::malformed(
                            found,
                            "write decimal points and commas between the columns",
                        ));
                    }
                }
                Some((most, ..)) if count <= *most => {}
                _ if count == 0 => {}
                _ => best = Some((count, form, read)),
            }
        }
    }
    let Some((_, form, _)) = best else {
        // No line is numbers: the delimiter that the first line has most of.
        let first = table.first().map_or("", |(_, line)| *line);
        let cells = |delimiter: char| split(first, delimiter).len();
        let most = DELIMITERS.iter().rev().max_by_key(|(delimiter, _)| cells(*delimiter));
        return Ok(Form { delimiter: most.map_or(',', |known| known.0), decimal: '.' });
    };
    if form.decimal == ',' {
        let cells =
            tried.iter().flat_map(|(line, row)| form.cells(row).into_iter().map(|cell| (*line, cell)));
        let with_comma: Vec<(usize, &str)> = cells.filter(|(_, cell)| cell.contains(',')).collect();
        if let Some((line, cell)) = with_comma.first()
            && with_comma.iter().all(|(_, cell)| may_be_thousands(cell) || form.number(cell).is_err())
        {
            let (point, none) = (cell.replace(',', "."), cell.replace(',', ""));
            let found = format!("`{cell}` may be {point} or {none}");
            return Err(
                Error::malformed(found, "write decimal points, and nothing between thousands").on_line(*line)
            );
        }
    }
    Ok(form)
}

/// Whether the comma may stand between thousands: one to three digits, not 0, before it and three behind.
fn may_be_thousands(cell: &str) -> bool {
    let digits = |part: &str| part.bytes().all(|byte| byte.is_ascii_digit());
    cell.split_once(',').is_some_and(|(whole, rest)| {
        (1..=3).contains(&whole.len())
            && digits(whole)
            && !whole.starts_with('0')
            && rest.len() == 3
            && digits(rest)
    })
}

/// Lowest and highest number of each column, as far as lines are numbers.
fn ranges(form: Form, table: &[(usize, &str)]) -> Vec<(f64, f64)> {
    let rows: Vec<Vec<f64>> = table.iter().filter_map(|(_, line)| form.numbers(line)).collect();
    ranges_of(rows.iter().map(Vec::as_slice))
}

fn ranges_of<'a>(rows: impl Iterator<Item = &'a [f64]>) -> Vec<(f64, f64)> {
    let mut ranges: Vec<(f64, f64)> = Vec::new();
    for row in rows {
        if ranges.is_empty() {
            ranges = vec![(f64::INFINITY, f64::NEG_INFINITY); row.len()];
        }
        for ((low, high), number) in ranges.iter_mut().zip(row) {
            (*low, *high) = (low.min(*number), high.max(*number));
        }
    }
    ranges
}

/// Whether cells begin with an axis, or with an index and an axis, or have one that is said in full.
fn names_an_axis(cells: &[String]) -> bool {
    let axis = |at: usize| cells.get(at).is_some_and(|cell| !matches!(header::axis(cell), Ok(None)));
    axis(0)
        || cells.first().is_some_and(|cell| is_index(cell)) && axis(1)
        || cells.iter().any(|cell| header::says_in_full(cell))
}

/// Whether a header is that of row numbers.
pub(super) fn is_index(cell: &str) -> bool {
    cell.is_empty() || matches!(cell.to_lowercase().as_str(), "index" | "unnamed: 0" | "#" | "no" | "row")
}

/// A header in a comment above the numbers: of as many columns, and the first of them an axis.
fn commented_header((line, comment): (usize, &str), form: Form, row: &str) -> Option<(usize, Vec<String>)> {
    let text = comment.trim_start_matches(['#', '%', '!', '/']).trim();
    let count = form.numbers(row)?.len();
    let cells = header_cells(form, text, count).filter(|cells| names_an_axis(cells))?;
    Some((line, cells))
}

/// Cells of a header of `count` columns, which may have another delimiter than the rows.
fn header_cells(form: Form, line: &str, count: usize) -> Option<Vec<String>> {
    let of = |cells: Vec<&str>| -> Vec<String> { cells.into_iter().map(str::to_owned).collect() };
    let own = if form.delimiter == ' ' { blank_cells(line) } else { of(form.cells(line)) };
    let others =
        DELIMITERS.iter().filter(|(delimiter, _)| *delimiter != form.delimiter).map(|(delimiter, _)| {
            if *delimiter == ' ' { blank_cells(line) } else { of(split(line, *delimiter)) }
        });
    let without_empty_end = |mut cells: Vec<String>| {
        if cells.len() == count + 1 {
            cells.pop_if(|cell| cell.is_empty());
        }
        cells
    };
    std::iter::once(own).chain(others).map(without_empty_end).find(|cells| cells.len() == count)
}

/// Cells between blanks: by two or more of them if there are such, units with the name before them.
fn blank_cells(line: &str) -> Vec<String> {
    let wide: Vec<String> = line
        .split("  ")
        .flat_map(|part| part.split('\t'))
        .map(|cell| cell.trim().to_owned())
        .filter(|cell| !cell.is_empty())
        .collect();
    if wide.len() > 1 {
        return wide;
    }
    let mut cells: Vec<String> = Vec::new();
    for word in split(line, ' ') {
        let is_unit = word.starts_with(['(', '[', '%']) && word.len() > 1 && !word.starts_with("%R")
            || matches!(word, "%" | "percent")
            || SpectralUnit::spelt(word).is_some_and(|_| !word.to_lowercase().starts_with("wavenumber"));
        match cells.last_mut() {
            Some(before) if is_unit => {
                before.push(' ');
                before.push_str(word);
            }
            _ => cells.push(word.to_owned()),
        }
    }
    cells
}

/// The header among the lines above the numbers, its line, and where the numbers begin.
fn header_above(
    form: Form,
    table: &[(usize, &str)],
    begin: Option<usize>,
) -> Result<(Vec<String>, usize, usize)> {
    let above = table.get(..begin.unwrap_or(1)).unwrap_or_default();
    let count = begin.and_then(|begin| form.numbers(table.get(begin)?.1)).map(|row| row.len());
    let cells = |line: &str| match count {
        Some(count) => header_cells(form, line, count),
        None => Some(form.cells(line).into_iter().map(str::to_owned).collect()),
    };
    let found = above.iter().enumerate().find_map(|(at, &(line, text))| {
        cells(text).filter(|cells| names_an_axis(cells)).map(|header| (at, line, header))
    });
    let Some((at, line, mut header)) = found else {
        let Some(&(line, text)) = above.last() else {
            return Err(Error::malformed("the file has no rows", EXAMPLE));
        };
        // One that names an axis, but not as many columns as there are.
        let loose: Vec<String> = form.cells(text).into_iter().map(str::to_owned).collect();
        if let Some(count) = count
            && names_an_axis(&loose)
        {
            let row = table.get(above.len()).map_or(line, |(row, _)| *row);
            return Err(wrong_count(count, loose.len()).on_line(row));
        }
        let ranges = ranges(form, table);
        let header = cells(text).unwrap_or_default();
        let meant = header::suggested(if header.len() == ranges.len() { &header } else { &[] }, &ranges);
        // What the line says is not repeated: the file may be anything that a scenario names.
        let found = "this is not the header of a spectrum";
        let instead = match ranges.is_empty() {
            true => format!(
                "{EXAMPLE}; the first column must be wavenumber_cm1 or wavelength_um, or have its unit in brackets"
            ),
            false => format!("write here the line that is true of this file, such as {meant}"),
        };
        return Err(Error::malformed(found, instead).on_line(line));
    };
    let between = above.get(at + 1..).unwrap_or_default();
    if let [(_, units)] = between
        && let Some(units) =
            cells(units).filter(|units| units.first().is_some_and(|unit| SpectralUnit::spelt(unit).is_some()))
    {
        for (cell, unit) in header.iter_mut().zip(units) {
            *cell = format!("{cell} ({unit})");
        }
        return Ok((header, line, above.len()));
    }
    // What stands below the header are rows, good or bad.
    Ok((header, line, at + 1))
}

fn wrong_count(found: usize, due: usize) -> Error {
    let found_text = format!("{found} cells where the header has {due}");
    // A decimal comma makes two cells of a number.
    let instead = match found > due {
        true => {
            "write one number for every column, with a decimal point: 0.95, not 0,95 (or semicolons between the columns)"
        }
        false => "write one number for every column",
    };
    Error::malformed(found_text, instead)
}

/// A row in which one number has a decimal point and another a comma: neither may be changed alone.
fn mixed_signs(cells: &[&str]) -> Option<Error> {
    let with = |own: char, other: char| {
        let mut cells = cells.iter().filter(|cell| cell.starts_with(|char: char| char.is_ascii_digit()));
        cells.find(|cell| cell.contains(own) && !cell.contains(other))
    };
    let (point, comma) = (with('.', ',')?, with(',', '.')?);
    let found = format!("`{point}` has a point and `{comma}` a comma");
    Some(Error::malformed(found, "write decimal points in all numbers, and nothing between thousands"))
}

/// Cells for what is not known.
const HOLES: [&str; 8] = ["", "-", "--", "nan", "na", "n/a", "null", "none"];

fn numbers(form: Form, row: &str, header: &[String], reading: &Reading) -> Result<Vec<f64>> {
    let mut cells = form.cells(row);
    while cells.len() > header.len() && cells.pop_if(|cell| cell.is_empty()).is_some() {}
    if cells.len() != header.len() {
        return Err(wrong_count(cells.len(), header.len()));
    }
    let mixed = mixed_signs(&cells);
    let read = |(cell, column): (&str, &String)| {
        if form.decimal == ',' && cell.contains('.') {
            let found = format!("`{cell}` has a decimal point where other numbers have commas");
            return Err(
                Error::malformed(found, "write the same sign in all numbers").for_key(column.as_str())
            );
        }
        let is_hole = HOLES.contains(&cell.to_lowercase().as_str());
        if is_hole && reading.clip().is_some() {
            return Ok(f64::NAN);
        }
        form.number(cell).map_err(|error| {
            let hole = is_hole.then(|| {
                let instead =
                    "write a number, or leave the row out, as `hadar materials import --clip 0` does";
                let found = match cell.is_empty() {
                    true => "the cell is empty".to_owned(),
                    false => format!("`{cell}` is not a finite number"),
                };
                Error::malformed(found, instead)
            });
            hole.or_else(|| mixed.clone()).unwrap_or(error).for_key(column.as_str())
        })
    };
    cells.into_iter().zip(header).map(read).collect()
}
