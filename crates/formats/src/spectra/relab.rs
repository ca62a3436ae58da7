//! Text files of RELAB, the library of Brown University: the number of rows, the rows, then what the sample is.
//!
//! A row is wavelength, reflectance and, in some, its deviation; a line of names may stand between number and rows. The unit of
//! wavelengths is that of the line of names, else the only one that is possible (µm in older files, nm in newer ones). Reflectance is of
//! one direction to another, relative to a white panel.
//!
//! Source: Pieters & Hiroi, LPSC XXXV, 1720 (2004); the files of <http://www.planetary.brown.edu/relabdata>.

use super::bytes::FETCH_AGAIN;
use super::content::{Content, stem};
use super::header::{self, Axis, Quantity};
use super::reading::Reading;
use super::samples::{Origin, Said, Samples, told};
use hadar::error::{Error, Result};
use hadar::words::one_line;
use std::path::Path;

/// What is said of all of them.
pub(super) const REMARK: &str = "RELAB measures from one direction to another, relative to a white panel: emissivity is 1 - reflectance of \
                      hemispherical reflectance alone, so these values may be wrong";

/// Wavelength and reflectance of a row of two or three numbers.
fn row(line: &str) -> Option<(f64, f64)> {
    let cells = line.split([' ', '\t', ',']).filter(|cell| !cell.is_empty());
    let numbers = cells.map(|cell| cell.parse().ok().filter(|value: &f64| value.is_finite()));
    match numbers.collect::<Option<Vec<f64>>>()?[..] {
        [wavelength, reflectance] | [wavelength, reflectance, _] => Some((wavelength, reflectance)),
        _ => None,
    }
}

/// What such a file consists of.
struct Parts<'a> {
    /// Number of rows, as the file says.
    count: usize,
    /// The line of names, if there is one.
    names: Option<&'a str>,
    /// The lines behind.
    lines: Vec<&'a str>,
}

fn parts(text: &str) -> Option<Parts<'_>> {
    let mut lines = text.lines().map(str::trim).filter(|line| !line.is_empty());
    let count = lines.next()?.parse::<usize>().ok().filter(|count| *count > 1)?;
    let mut lines: Vec<&str> = lines.collect();
    let second = *lines.first()?;
    if row(second).is_some() {
        return Some(Parts { count, names: None, lines });
    }
    let is_named = lines.get(1).is_some_and(|third| row(third).is_some());
    is_named.then(|| {
        lines.remove(0);
        Parts { count, names: Some(second), lines }
    })
}

/// Whether the text looks like one: a whole number alone, then rows of two or three numbers.
pub(super) fn is_one(text: &str) -> bool {
    parts(text).is_some()
}

pub(super) fn parse(text: &str, source: &Path, reading: &Reading) -> Result<Content> {
    let Some(Parts { count, names, lines }) = parts(text) else {
        return Err(Error::malformed("there are no rows below a number of rows", FETCH_AGAIN));
    };
    let points: Vec<(f64, f64)> = lines.iter().map_while(|line| row(line)).collect();
    if points.len() != count {
        let found = format!("{} rows where the first line announces {count}", points.len());
        return Err(Error::malformed(found, FETCH_AGAIN).on_line(1));
    }
    let named = match names.and_then(|names| names.split(['\t', ',']).next()) {
        Some(cell) => header::axis(cell)?,
        None => None,
    };
    let range =
        points.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), &(x, _)| (low.min(x), high.max(x)));
    let unit = match named {
        Some(Axis { unit: Some(unit), .. }) => Some(unit),
        _ => header::unit_of_range("wavelength", range),
    };
    let values = Said::Values(Quantity::Reflectance, names.is_some_and(|names| names.contains('%')));
    let (unit, quantity, percent) = match told(unit, values, reading)? {
        Ok(told) => told,
        Err(reason) => return Ok(Content::NoEmissivity(reason)),
    };
    let points = points
        .into_iter()
        .map(|(wavelength, value)| (wavelength, if value < -1e30 { f64::NAN } else { value }));
    let below = lines.iter().skip(count).map(|line| one_line(line)).collect::<Vec<_>>().join("; ");
    let name = stem(source);
    let description = if below.is_empty() { format!("spectrum of {name}") } else { below };
    let origin = Origin { name, description, format: "RELAB", source, remark: REMARK };
    let samples = Samples { unit, quantity, percent, points: points.collect() };
    Ok(Content::Materials(vec![samples.material(origin, reading)?]))
}

#[cfg(test)]
mod tests;
