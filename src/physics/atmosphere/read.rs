//! Reads a table of transmittances: `wavenumber_cm1`, then a column for each length of the path, `tau_<length>km` or
//! `tau_<length>m`.

use super::growth::{Growth, Lengths};
use crate::error::{Error, Result, check};
use crate::grid::Grid;
use crate::order;
use crate::spectrum::{Gaps, same};

const COLUMNS: &str =
    "name the columns wavenumber_cm1,tau_0.1km,tau_1km or wavenumber_cm1,tau_100m,tau_1000m";

/// Growth of the optical depth with length, one row for each wavenumber.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Table {
    pub(super) lengths: Lengths,
    /// Ascending, at least two.
    pub(super) wavenumbers_cm1: Vec<f64>,
    pub(super) rows: Vec<Growth>,
    /// Where rows are missing.
    pub(super) gaps: Gaps,
}

/// The table in `text`.
pub(super) fn table(text: &str) -> Result<Table> {
    let grid = Grid::parse(text)?;
    let in_header = |error: Error| error.on_line(grid.header_line);
    let first = grid.header.first().map_or("", String::as_str);
    if first != "wavenumber_cm1" {
        return Err(in_header(Error::malformed(format!("the first column is `{first}`"), COLUMNS)));
    }
    // Columns by length, each with its place in the file.
    let mut columns = Vec::with_capacity(grid.header.len());
    for (index, column) in grid.header.iter().enumerate().skip(1) {
        let length_m = length_m(column).map_err(|error| in_header(error.for_key(column)))?;
        columns.push((length_m, index));
    }
    order::ascending(&mut columns, |a| a.0);
    if columns.len() < 2 {
        let found = "there is one path length, which does not say how absorption grows with it";
        return Err(in_header(Error::malformed(found, "give at least two")));
    }
    if let Some(pair) = columns.windows(2).find(|pair| same(pair[0].0, pair[1].0)) {
        let found = format!("the length {} m is there twice", pair[0].0);
        return Err(in_header(Error::malformed(found, "keep one column for each length")));
    }
    let lengths = Lengths::new(columns.iter().map(|column| column.0).collect());
    let mut rows = Vec::with_capacity(grid.rows.len());
    for (line, cells) in &grid.rows {
        rows.push(row(&lengths, &columns, cells, &grid.header).map_err(|error| error.on_line(*line))?);
    }
    order::ascending(&mut rows, |a| a.0);
    if rows.len() < 2 {
        return Err(Error::malformed(format!("{} rows", rows.len()), "a spectrum needs at least 2 rows"));
    }
    if let Some(pair) = rows.windows(2).find(|pair| same(pair[0].0, pair[1].0)) {
        let found = format!("the wavenumber {} cm^-1 is there twice", pair[1].0);
        return Err(Error::malformed(found, "keep one row for each wavenumber"));
    }
    let (wavenumbers_cm1, rows) = rows.into_iter().unzip();
    let wavenumbers_cm1: Vec<f64> = wavenumbers_cm1;
    Ok(Table { lengths, gaps: Gaps::of(&wavenumbers_cm1), wavenumbers_cm1, rows })
}

/// The length in `tau_0.1km` or `tau_100m`, m.
fn length_m(column: &str) -> Result<f64> {
    let unknown = || Error::malformed(format!("a column `{column}`"), COLUMNS);
    let length = column.strip_prefix("tau_").ok_or_else(unknown)?;
    // The exponent is written, so that 0.07 km is 70 m to the last bit.
    let length = match (length.strip_suffix("km"), length.strip_suffix('m')) {
        (Some(km), _) if !km.contains(['e', 'E']) => format!("{km}e3"),
        (None, Some(m)) => m.to_owned(),
        _ => return Err(unknown()),
    };
    let length_m = length.parse::<f64>().map_err(|_| unknown())?;
    check::positive("length of the path", length_m, "m")
}

fn row(
    lengths: &Lengths,
    columns: &[(f64, usize)],
    cells: &[f64],
    header: &[String],
) -> Result<(f64, Growth)> {
    let wavenumber = cells.first().copied().unwrap_or(f64::NAN);
    check::positive("wavenumber", wavenumber, "cm^-1")?;
    let mut transmittances: Vec<f64> = Vec::with_capacity(columns.len());
    for &(_, index) in columns {
        let column = header.get(index).map_or("", String::as_str);
        let tau = cells.get(index).copied().unwrap_or(f64::NAN);
        check::unit_interval("transmittance", tau).map_err(|error| error.for_key(column))?;
        if let Some(&shorter) = transmittances.last()
            && tau > shorter
        {
            let found = format!("the transmittance {tau} is above the {shorter} of the next shorter path");
            return Err(Error::malformed(found, "it must fall with length").for_key(column));
        }
        transmittances.push(tau);
    }
    Ok((wavenumber, Growth::new(lengths, &transmittances)))
}
