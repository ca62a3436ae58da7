//! Spectra of what surroundings send: a column of a table, or of what MODTRAN and LBLRTM write, as photon radiance.
//!
//! A column without a unit is photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹; one of another unit has it behind its name, `sky [W m^-2 sr^-1 um^-1]`
//! ([`RadianceUnit`]), and each row is converted at its own wavenumber. A brightness temperature, `brightness temperature [K]`, becomes
//! the radiance of the blackbody that has it; another temperature is none.
//!
//! Nothing between a few kelvin and the sun sends more or less than bodies of these temperatures do: numbers of a column without unit
//! that would are of another unit.

mod column;
mod simulated;

use self::column::{Column, Unit};
use super::header;
use crate::cube::TemperatureUnit;
use crate::file;
use crate::foreign;
use hadar::atmosphere::Atmosphere;
use hadar::error::{Error, Result, check};
use hadar::grid::Grid;
use hadar::planck::{brightness_temperature, photon_radiance};
use hadar::radiance_unit::RadianceUnit;
use hadar::words::one_line;
use std::path::Path;

/// Brightness temperatures of the brightest row of any light, K.
const BRIGHTEST_K: (f64, f64) = (40.0, 2e4);
/// How a unit is written, in messages.
const EXAMPLE: &str = "write its unit behind its name, as in `sky [W m^-2 sr^-1 um^-1]`";

/// Wavenumber (cm⁻¹) and photon radiance (photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹) of the rows of a column, in the order of the file.
///
/// # Errors
/// A file that cannot be read, no such column, a column of something else or of an unknown unit; a row whose wavenumber is not
/// above 0; numbers that no light has in the unit they are taken for.
///
/// ```
/// use hadar::planck::photon_radiance;
/// let folder = std::env::temp_dir().join(format!("hadar-radiance-{}", std::process::id()));
/// # std::fs::create_dir_all(&folder).unwrap();
/// let file = folder.join("sky.csv");
/// std::fs::write(&file, "wavenumber_cm1,sky,at night [brightness temperature in K]\n800,2e18,250\n1200,1e18,230\n").unwrap();
/// assert_eq!(hadar_formats::spectra::radiance(&file, "sky")?[1], (1200.0, 1e18));
/// assert_eq!(hadar_formats::spectra::radiance(&file, "at night")?[0], (800.0, photon_radiance(800.0, 250.0)));
/// # std::fs::remove_dir_all(&folder).unwrap();
/// # Ok::<(), hadar::Error>(())
/// ```
pub fn radiance(path: &Path, column: &str) -> Result<Vec<(f64, f64)>> {
    text(path, file::READ_SPECTRUM)
        .and_then(|text| of_text(&text, column))
        .map_err(|error| error.in_file(path))
}

/// Transmittances of the air by length of the path ([`Atmosphere::from_csv`]).
///
/// # Errors
/// As [`Atmosphere::from_csv`]; what MODTRAN or LBLRTM wrote, which is of one path.
pub fn atmosphere(path: &Path) -> Result<Atmosphere> {
    let text = text(path, "read the transmittances")?;
    match simulated::program(&text) {
        None => Atmosphere::from_csv(&text, path),
        Some(program) => {
            let found = format!(
                "this is what {program} writes of one path, which does not say how absorption grows with length"
            );
            let instead = "write transmittances of runs of at least two lengths side by side, as wavenumber_cm1,tau_100m,tau_1km";
            Err(Error::malformed(found, instead).in_file(path))
        }
    }
}

/// The text of a file, if it is text.
fn text(path: &Path, action: &str) -> Result<String> {
    let bytes = file::short_bytes(path, action)?;
    let is_text = foreign::refuse(&bytes)
        .and_then(|()| simulated::refuse_unformatted(&bytes))
        .and_then(|()| foreign::refuse_binary(&bytes));
    is_text.map(|()| file::text(bytes)).map_err(|error| error.in_file(path))
}

fn of_text(text: &str, column: &str) -> Result<Vec<(f64, f64)>> {
    let text = super::lines_of(text);
    match simulated::column(&text, column)? {
        Some(column) => column.photons(),
        None => tabled(&text, column)?.photons(),
    }
}

/// The column of a table.
fn tabled(text: &str, wanted: &str) -> Result<Column> {
    let grid = Grid::parse(text)?;
    let on_header = |error: Error| error.on_line(grid.header_line);
    let parts: Vec<(&str, &str)> = grid.header.iter().skip(1).map(|cell| parts(cell)).collect();
    let whole = grid.header.iter().skip(1).position(|cell| cell == wanted);
    let named: Vec<usize> =
        (0..parts.len()).filter(|at| parts.get(*at).is_some_and(|part| part.0 == wanted)).collect();
    let at = match (whole, &named[..]) {
        (Some(at), _) | (None, &[at]) => at,
        (None, []) => {
            let names = parts.iter().map(|part| part.0);
            return Err(Error::unknown_name("column", wanted, names).for_key("column"));
        }
        (None, many) => {
            let found = format!("{} columns called `{wanted}`", many.len());
            return Err(on_header(Error::malformed(found, "give each its own name")));
        }
    };
    let (name, unit) = parts.get(at).copied().unwrap_or_default();
    let unit = unit_of(name, unit).map_err(|error| on_header(error.for_key(wanted)))?;
    let axis = axis(&grid)?;
    let value = |cells: &Vec<f64>| cells.get(at + 1).copied().unwrap_or(f64::NAN);
    let rows = axis.into_iter().zip(grid.rows.iter().map(|(_, cells)| value(cells))).collect();
    let lines = grid.rows.iter().map(|(line, _)| *line).collect();
    Ok(Column { name: name.to_owned(), unit, lines, rows })
}

/// Wavenumbers of the rows, whatever unit the first column is in.
fn axis(grid: &Grid) -> Result<Vec<f64>> {
    let first = grid.header.first().map_or("", String::as_str);
    let unit = match header::axis(first).map_err(|error| error.on_line(grid.header_line))? {
        Some(header::Axis { unit: Some(unit), .. }) => unit,
        _ => return grid.wavenumbers_cm1(),
    };
    let mut own = grid.clone();
    if let Some(cell) = own.header.first_mut() {
        "wavenumber_cm1".clone_into(cell);
    }
    for (line, cells) in &mut own.rows {
        if let Some(cell) = cells.first_mut() {
            let place = check::positive(first, *cell, unit.name()).map_err(|error| error.on_line(*line))?;
            *cell = unit.wavenumber_cm1(place);
        }
    }
    own.wavenumbers_cm1()
}

/// Name and unit of `sky [W m^-2 sr^-1 um^-1]` or `sky (K)`; no unit where none is in brackets at the end.
fn parts(cell: &str) -> (&str, &str) {
    let cell = cell.trim();
    for (opens, closes) in [('[', ']'), ('(', ')')] {
        if let Some(inner) = cell.strip_suffix(closes)
            && let Some((name, unit)) = inner.split_once(opens)
        {
            return (name.trim(), unit.trim());
        }
    }
    (cell, "")
}

/// What the numbers of a column of this name and unit are.
fn unit_of(name: &str, unit: &str) -> Result<Unit> {
    let lower = format!("{name} {unit}").to_lowercase();
    let is_brightness = lower.contains("brightness");
    let temperature = TemperatureUnit::spelt(unit);
    match (unit, temperature) {
        ("", _) if is_brightness && lower.contains("temp") => Err(Error::malformed(
            "a brightness temperature without its unit",
            "write `brightness temperature [K]`",
        )),
        ("", _) => Ok(Unit::Silent),
        (_, Some(unit)) if is_brightness => Ok(Unit::Brightness(unit)),
        (_, Some(_)) => {
            let found = format!("`{}`, a temperature and no radiance", one_line(unit));
            let instead = "write temperature = \"…\" for a blackbody; if these are brightness temperatures, call the column `brightness temperature [K]`";
            Err(Error::malformed(found, instead))
        }
        _ => RadianceUnit::spelt(unit).map(Unit::Stated),
    }
}

impl Column {
    /// The rows as photon radiances.
    fn photons(self) -> Result<Vec<(f64, f64)>> {
        let unit = self.unit;
        let converted = |((nu, value), line): (&(f64, f64), &usize)| {
            let radiance = match unit {
                Unit::Silent => *value,
                Unit::Stated(unit) => value * unit.photons_per_cm1(*nu),
                Unit::Brightness(unit) => {
                    let at = |error: Error| error.for_key(self.name.as_str()).on_line(*line);
                    let kelvin = check::positive("brightness temperature", unit.kelvin(*value), "K");
                    photon_radiance(*nu, kelvin.map_err(at)?)
                }
            };
            Ok((*nu, radiance))
        };
        let rows: Vec<(f64, f64)> =
            self.rows.iter().zip(&self.lines).map(converted).collect::<Result<_>>()?;
        let brightness =
            rows.iter().filter(|row| row.1 > 0.0).map(|(nu, value)| brightness_temperature(*nu, *value));
        let brightest = brightness.fold(0.0, f64::max);
        let (low, high) = BRIGHTEST_K;
        if brightest == 0.0 || (low..=high).contains(&brightest) {
            return Ok(rows);
        }
        let found = format!("nothing in it is brighter than a blackbody of {brightest:.0} K");
        let found = if brightest > high {
            format!("it is as bright as a blackbody of {brightest:.0} K")
        } else {
            found
        };
        let (found, instead) = match unit {
            Unit::Silent => (format!("as photons s^-1 m^-2 sr^-1 per cm^-1 {found}"), EXAMPLE),
            _ => (found, "correct its unit"),
        };
        Err(Error::malformed(found, instead).for_key(self.name))
    }
}

#[cfg(test)]
mod tests;
