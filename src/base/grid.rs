//! Text of numbers: CSV with comment lines, one header line, and rows as long as the header.

use crate::error::{Error, Result, check};
use crate::units::decimal_comma;

/// What a file should begin with, for messages.
pub const EXAMPLE: &str = "begin the file with a line such as wavenumber_cm1,emissivity";

/// The header and the numbers, with the line (from 1) that each row stands on.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    /// Names of the columns.
    pub header: Vec<String>,
    /// Line of the names, counted from 1.
    pub header_line: usize,
    /// Line and cells of every row.
    pub rows: Vec<(usize, Vec<f64>)>,
}

impl Grid {
    /// Reads the text of a CSV file.
    ///
    /// # Errors
    /// No header, a row of another length, a cell that is not a finite number.
    pub fn parse(text: &str) -> Result<Self> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let mut lines = text
            .lines()
            .enumerate()
            .map(|(index, line)| (index + 1, line.trim()))
            .filter(|(_, line)| !line.is_empty() && !line.starts_with('#'));
        let Some((header_line, first)) = lines.next() else {
            return Err(Error::malformed("the file has no rows", EXAMPLE));
        };
        let header: Vec<String> = cells(first).map(str::to_owned).collect();
        check_header(&header, first).map_err(|error| error.on_line(header_line))?;
        let rows = lines
            .map(|(line, row)| Ok((line, numbers(row, &header).map_err(|error| error.on_line(line))?)))
            .collect::<Result<_>>()?;
        Ok(Self { header, header_line, rows })
    }

    /// Wavenumbers of the rows, cm⁻¹, each only once.
    ///
    /// # Errors
    /// A first column of another name, a value that is not positive or comes twice.
    pub fn wavenumbers_cm1(&self) -> Result<Vec<f64>> {
        let name = self.header.first().map_or("", String::as_str);
        if !matches!(name, "wavenumber_cm1" | "wavelength_um") {
            let found = "the first column has another name";
            return Err(
                Error::malformed(found, "name it wavenumber_cm1 or wavelength_um").on_line(self.header_line)
            );
        }
        let mut seen: Vec<(f64, usize)> = Vec::new();
        for (line, cells) in &self.rows {
            let value = cells.first().copied().unwrap_or(f64::NAN);
            let wavenumber = if name == "wavelength_um" { 1e4 / value } else { value };
            check::positive(name, value, "")
                .and_then(|_| check::positive("wavenumber", wavenumber, "cm^-1"))
                .map_err(|error| error.for_key(name).on_line(*line))?;
            seen.push((wavenumber, *line));
        }
        let axis = seen.iter().map(|row| row.0).collect();
        seen.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        if let Some(twins) = seen.windows(2).find(|pair| pair[0].0 == pair[1].0) {
            return Err(Error::malformed(
                format!("wavenumber {} cm^-1 is there already on line {}", twins[1].0, twins[0].1),
                "keep one of the two rows",
            )
            .for_key(name)
            .on_line(twins[1].1));
        }
        Ok(axis)
    }
}

/// Cells of a line; a comma between two quotes is a part of its cell.
fn cells(line: &str) -> impl Iterator<Item = &str> {
    let mut is_quoted = false;
    let parts = line.split(move |sign| {
        is_quoted ^= sign == '"';
        sign == ',' && !is_quoted
    });
    parts.map(|cell| cell.trim().trim_matches('"').trim())
}

fn check_header(header: &[String], line: &str) -> Result<()> {
    if header.first().is_some_and(|cell| cell.parse::<f64>().is_ok()) {
        return Err(Error::malformed("there is no header, only numbers", EXAMPLE));
    }
    if header.len() < 2 {
        // What the line says is not repeated: the file may be anything that a scenario names.
        let instead = if line.contains(';') {
            "write commas between the columns and decimal points, as in wavenumber_cm1,emissivity and 715,0.95"
        } else if line.contains(['\t', ' ']) {
            "write commas between the columns, as in wavenumber_cm1,emissivity"
        } else {
            EXAMPLE
        };
        return Err(Error::malformed("this is not the header of a spectrum", instead));
    }
    Ok(())
}

fn numbers(row: &str, header: &[String]) -> Result<Vec<f64>> {
    let found = cells(row).count();
    if found != header.len() {
        let found = format!("{found} cells where the header has {}", header.len());
        // A decimal comma makes two cells of a number.
        let instead = match cells(row).count() > header.len() {
            true => "write one number for every column, with a decimal point: 0.95, not 0,95",
            false => "write one number for every column",
        };
        return Err(Error::malformed(found, instead));
    }
    cells(row).zip(header).map(|(cell, column)| number(cell).map_err(|error| error.for_key(column))).collect()
}

/// A finite number.
pub fn number(cell: &str) -> Result<f64> {
    match cell.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ if cell.is_empty() => {
            Err(Error::malformed("the cell is empty", "write a number or delete the row"))
        }
        _ => {
            let shown: String = cell.chars().take(40).collect();
            if let Some(error) = decimal_comma(&shown) {
                return Err(error);
            }
            Err(Error::malformed(
                format!("`{shown}` is not a finite number"),
                "write a number such as 0.95 or delete the row",
            ))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_comma_between_quotes_is_a_part_of_the_name() {
        let grid = Grid::parse("wavenumber_cm1,\"road, texture 0\",car\n720,0.9,0.95\n").unwrap();
        assert_eq!(grid.header, ["wavenumber_cm1", "road, texture 0", "car"]);
        assert_eq!(grid.rows[0].1, [720.0, 0.9, 0.95]);
    }
}
