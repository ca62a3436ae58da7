//! What the columns of a table are: axis, then emissivity, reflectance, n and k, or materials.

use super::checked::{Checked, beyond, checked, clip_for};
use super::content::{joined, of_all, stem};
use super::header::{self, Axis, Meaning, Quantity, Values};
use super::holes;
use super::layout::{Sheet, is_index};
use super::reading::Reading;
use crate::spectral_unit::SpectralUnit;
use hadar::error::{Error, Result, check};
use hadar::grid::Grid;
use hadar::material::Material;
use hadar::material::OpticalConstants;
use hadar::material::Provenance;
use hadar::material::{Fault, Table, ascending};
use hadar::words::one_line;
use std::collections::BTreeSet;
use std::path::Path;

/// The longest name of a first column that is named in a message.
const LONGEST_AXIS: usize = 40;
/// By how much a second axis may differ from the first, which rounding explains (relative).
const ROUNDED: f64 = 0.01;

/// The columns of a table, told apart.
struct Columns<'a> {
    grid: &'a Grid,
    axis: usize,
    unit: SpectralUnit,
    /// What is said of how the axis was read.
    axis_in_words: String,
    /// Columns with values, and their headers.
    values: Vec<(usize, &'a str)>,
    /// Columns that say the axis again.
    twins: Vec<(usize, SpectralUnit)>,
}

/// A column of values, its header and what that says.
type Told<'a> = (usize, &'a str, Values);

/// All materials of a table.
pub(super) fn materials(sheet: &Sheet, source: &Path, reading: &Reading) -> Result<Vec<Material>> {
    let columns = Columns::of(sheet)?;
    let wavenumbers = columns.wavenumbers()?;
    let own = stem(source);
    let source = source.display().to_string();
    if columns.headers() == ["n", "k"] {
        let constants = columns.optical_constants(&wavenumbers)?;
        let note = "smooth opaque half-space at normal incidence";
        let provenance = Provenance::of_file(format!("spectrum of {own}"), source, note);
        let material = Material::of_constants(own, provenance, constants);
        return Ok(vec![material.reading(columns.read_as("n and k", sheet))]);
    }
    let (told, left_out) = columns.told()?;
    let alone = told.len() == 1;
    let mut names = BTreeSet::new();
    let mut materials = Vec::with_capacity(told.len());
    for one in &told {
        let (column, header, values) = one;
        let quantity = columns.quantity(one, alone, sheet)?;
        let name = if alone && values.name.is_empty() { &own } else { &values.name };
        if name.is_empty() {
            return Err(columns.nameless(header, &told));
        }
        if !names.insert(name) {
            let found = format!("two columns for the material `{name}`");
            let error = Error::malformed(found, "give every column its own name");
            return Err(error.on_line(sheet.grid.header_line));
        }
        let read = columns.emissivities(&wavenumbers, *column, (quantity, values.percent), sheet, reading)?;
        let count = read.rows().count();
        let Checked { table, note, .. } = checked(read, reading.clip())?;
        let description = match alone {
            true => format!("spectrum of {name}"),
            false => format!("column {}", one_line(header)),
        };
        let share = if values.percent { " in percent" } else { "" };
        let mut warnings: Vec<String> =
            Some(note.clone()).into_iter().filter(|note| !note.is_empty()).collect();
        if let Some((low, high)) = table.range_cm1()
            && count < sheet.grid.rows.len()
        {
            warnings.push(format!(
                "rows of exactly 0 at the ends were taken for padding: it reaches from {low:.0} to {high:.0} cm^-1"
            ));
        }
        if let Some((_, high)) = sheet.ranges.get(*column)
            && values.percent
        {
            warnings.extend(of_all(quantity.name(), *high, 100.0));
        }
        if let [column, ..] = left_out.as_slice() {
            warnings.push(format!("the errors in the column `{}` are not used", one_line(column)));
        }
        let note = joined(&[quantity.note(), &note], "; ");
        let provenance = Provenance::of_file(description, source.clone(), &note);
        let read_as = columns.read_as(&format!("{}{share}", quantity.name()), sheet);
        let material = Material::of_table(name.clone(), provenance, table);
        materials.push(material.reading(read_as).warn(warnings));
    }
    if materials.is_empty() {
        let error = Error::malformed("no column has emissivities", one_true(sheet));
        return Err(error.on_line(sheet.grid.header_line));
    }
    Ok(materials)
}

/// How a value just outside 0 to 1 becomes one that is not, if it is noise.
fn or_clipped(fraction: f64, clip: Option<f64>) -> String {
    match (clip, clip_for(beyond(fraction))) {
        (Some(by), _) => format!(", or outside by no more than the clip of {by}"),
        (None, Some(by)) => format!("; if it is noise, `hadar materials import --clip {by}` cuts it off"),
        (None, None) => String::new(),
    }
}

/// What to write where no header says what its column is.
fn one_true(sheet: &Sheet) -> String {
    let line = header::suggested(&sheet.grid.header, &sheet.ranges);
    format!("write the header that is true, such as {line}")
}

/// The columns `n` and `k`.
pub(super) fn optical_constants(sheet: &Sheet) -> Result<OpticalConstants> {
    let columns = Columns::of(sheet)?;
    if columns.headers() != ["n", "k"] {
        return Err(Error::malformed(
            format!("columns {}", sheet.grid.header.join(",")),
            "optical constants need the columns wavelength_um,n,k",
        )
        .on_line(sheet.grid.header_line));
    }
    columns.optical_constants(&columns.wavenumbers()?)
}

impl<'a> Columns<'a> {
    fn of(sheet: &'a Sheet) -> Result<Self> {
        let grid = &sheet.grid;
        let at = |column: usize| grid.header.get(column).map_or("", String::as_str);
        let counts = |column: usize| {
            let numbers = grid.rows.iter().enumerate();
            let mut numbers =
                numbers.map(|(row, (_, cells))| cells.get(column).is_some_and(|cell| *cell == row as f64));
            !grid.rows.is_empty() && numbers.all(|counts| counts)
        };
        let start = usize::from(is_index(at(0)) && counts(0));
        // Where the first column is none, one that says so in full.
        let is_axis = |column: &usize| !matches!(header::axis(at(*column)), Ok(None));
        let in_full = |column: &usize| header::says_in_full(at(*column));
        let axis =
            Some(start).filter(is_axis).or_else(|| (start..grid.header.len()).find(in_full)).unwrap_or(start);
        let first = at(axis);
        let on_header = |error: Error| {
            let named = first.len() <= LONGEST_AXIS && first.to_lowercase().starts_with("wave");
            let error = if named { error.for_key(first) } else { error };
            error.on_line(grid.header_line)
        };
        let suggested = || {
            let line = header::suggested(
                grid.header.get(start..).unwrap_or_default(),
                sheet.ranges.get(start..).unwrap_or_default(),
            );
            format!("write the header that is true of this file, such as {line}")
        };
        let (unit, axis_in_words) = match header::axis(first).map_err(on_header)? {
            Some(Axis { unit: Some(unit), quantity }) => (unit, format!("{quantity} in {}", unit.name())),
            Some(Axis { unit: None, quantity }) => {
                let range = sheet.ranges.get(axis).copied().unwrap_or((f64::NAN, f64::NAN));
                match header::unit_of_range(quantity, range) {
                    Some(unit) => {
                        (unit, format!("{quantity} in {} (not stated; no other unit fits)", unit.name()))
                    }
                    None => {
                        let found = format!("a {quantity} without its unit, and more than one is possible");
                        return Err(on_header(Error::malformed(found, suggested())));
                    }
                }
            }
            None => {
                return Err(on_header(Error::malformed("this is not the header of a spectrum", suggested())));
            }
        };
        let (mut values, mut twins) = (Vec::new(), Vec::new());
        for column in (start..grid.header.len()).filter(|column| *column != axis) {
            match header::axis(at(column)) {
                Ok(Some(Axis { unit: Some(unit), .. })) if in_full(&column) => twins.push((column, unit)),
                _ => values.push((column, at(column))),
            }
        }
        Ok(Self { grid, axis, unit, axis_in_words, values, twins })
    }

    fn headers(&self) -> Vec<&'a str> {
        self.values.iter().map(|(_, header)| *header).collect()
    }

    /// How the file was read, given what the values are.
    fn read_as(&self, values: &str, sheet: &Sheet) -> String {
        let parts = [self.axis_in_words.as_str(), values, &sheet.form.in_words()];
        parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(", ")
    }

    fn at(&self, error: Error, header: &str) -> Error {
        error.for_key(header).on_line(self.grid.header_line)
    }

    /// The columns of which something follows, and the headers of those with errors, which are left out.
    fn told(&self) -> Result<(Vec<Told<'a>>, Vec<&'a str>)> {
        let (mut told, mut left_out) = (Vec::new(), Vec::new());
        for &(column, header) in &self.values {
            let (found, instead) = match header::values(header) {
                Meaning::Values(values) => {
                    told.push((column, header, values));
                    continue;
                }
                Meaning::Deviation => {
                    left_out.push(header);
                    continue;
                }
                Meaning::Unclear => (
                    "which may be what its numbers are or a name",
                    "end its header with what they are, as in `panel 2 reflectance` or `panel 2 emissivity`",
                ),
                Meaning::Other => (
                    "from which no emissivity follows",
                    "use emissivity, or the hemispherical reflectance of an opaque sample, or delete the column",
                ),
            };
            let found = format!("a column `{}`, {found}", one_line(header));
            return Err(self.at(Error::malformed(found, instead), header));
        }
        Ok((told, left_out))
    }

    /// What the values of a column are.
    fn quantity(&self, (_, header, values): &Told<'_>, alone: bool, sheet: &Sheet) -> Result<Quantity> {
        match values.quantity {
            Some(quantity) => Ok(quantity),
            // In a table of materials a name alone stands for emissivity.
            None if !alone => Ok(Quantity::Emissivity),
            None => {
                let found = format!(
                    "a column `{}` of which nothing says whether it is emissivity or reflectance",
                    one_line(header)
                );
                Err(self.at(Error::malformed(found, one_true(sheet)), header))
            }
        }
    }

    /// Why a column of several needs a name.
    fn nameless(&self, header: &str, told: &[Told<'_>]) -> Error {
        let has = |quantity: Quantity| {
            told.iter().any(|(_, _, values)| values.quantity == Some(quantity) && values.name.is_empty())
        };
        let (found, instead) = match has(Quantity::Emissivity) && has(Quantity::Reflectance) {
            true => (
                "columns of emissivity and of reflectance without the name of a material".to_owned(),
                "delete one of them if they are of one surface; else name each column after its material, as in skin_emissivity",
            ),
            false => (
                format!("a column `{}` in a table of materials", one_line(header)),
                "name each column after its material, as in skin or skin_reflectance",
            ),
        };
        self.at(Error::malformed(found, instead), header)
    }

    /// The wavenumbers of the rows, cm⁻¹; each only once.
    fn wavenumbers(&self) -> Result<Vec<f64>> {
        let key = self.grid.header.get(self.axis).map_or("", String::as_str);
        let unit = self.unit.name();
        let value = |cells: &[f64], column: usize| cells.get(column).copied().unwrap_or(f64::NAN);
        let of = |(line, cells): &(usize, Vec<f64>)| {
            let own = value(cells, self.axis);
            let wavenumber = check::positive(key, own, unit)
                .and_then(|own| check::positive("wavenumber", self.unit.wavenumber_cm1(own), "cm^-1"))
                .map_err(|error| error.for_key(key).on_line(*line))?;
            for &(column, unit) in &self.twins {
                let again = unit.wavenumber_cm1(value(cells, column));
                let agrees = (again - wavenumber).abs() <= ROUNDED * wavenumber;
                if !agrees {
                    let found = format!(
                        "this row is at {wavenumber:.2} cm^-1 by one column and at {again:.2} by another"
                    );
                    let error = Error::malformed(found, "correct the columns, or delete one of them");
                    return Err(error.on_line(*line));
                }
            }
            Ok(wavenumber)
        };
        let wavenumbers = self.grid.rows.iter().map(of).collect::<Result<Vec<f64>>>()?;
        match ascending(&wavenumbers) {
            Ok(_) => Ok(wavenumbers),
            Err(Fault::TooFew) => Err(Error::malformed(
                match wavenumbers.len() {
                    0 => "there are no rows below the header".to_owned(),
                    rows => format!("there is only {rows} row"),
                },
                "a spectrum needs at least 2",
            )),
            Err(Fault::Duplicate(first, second)) => {
                let line = |row: usize| self.grid.rows.get(row).map_or(0, |(line, _)| *line);
                let own = self.grid.rows.get(second).map_or(f64::NAN, |(_, cells)| value(cells, self.axis));
                Err(Error::malformed(
                    format!("{own} {unit} is there already on line {}", line(first)),
                    "keep one of the two rows",
                )
                .for_key(key)
                .on_line(line(second)))
            }
        }
    }

    fn optical_constants(&self, wavenumbers: &[f64]) -> Result<OpticalConstants> {
        let columns: Vec<usize> = self.values.iter().map(|(column, _)| *column).collect();
        let mut rows = Vec::with_capacity(wavenumbers.len());
        for (&wavenumber, (line, cells)) in wavenumbers.iter().zip(&self.grid.rows) {
            let mut found = columns.iter().map(|column| cells.get(*column).copied().unwrap_or(f64::NAN));
            let (n, k) = (found.next().unwrap_or(f64::NAN), found.next().unwrap_or(f64::NAN));
            check::positive("n", n, "")
                .and_then(|_| check::non_negative("k", k, ""))
                .map_err(|error| error.on_line(*line))?;
            rows.push((wavenumber, [n, k]));
        }
        OpticalConstants::new(&rows)
    }

    fn emissivities(
        &self,
        wavenumbers: &[f64],
        column: usize,
        (quantity, percent): (Quantity, bool),
        sheet: &Sheet,
        reading: &Reading,
    ) -> Result<Table<1>> {
        let clip = reading.clip();
        let key = self.grid.header.get(column).map_or("", String::as_str);
        let rows = wavenumbers
            .iter()
            .zip(&self.grid.rows)
            .map(|(&wavenumber, (line, cells))| {
                let value = cells.get(column).copied().unwrap_or(f64::NAN);
                let fraction = if percent { value / 100.0 } else { value };
                let by = clip.unwrap_or(0.0);
                if (-by..=1.0 + by).contains(&fraction) || clip.is_some() && fraction.is_nan() {
                    return Ok((wavenumber, [quantity.emissivity(fraction)]));
                }
                let (unit, due) = match percent {
                    true => ("percent", "between 0 and 100 percent".to_owned()),
                    false => ("", self.fraction(column, key, sheet)),
                };
                let due = due + &or_clipped(fraction, clip);
                let error = Error::out_of_range(quantity.name(), value, unit, due);
                Err(error.for_key(key).on_line(*line))
            })
            .collect::<Result<Vec<_>>>()?;
        let fractions: Vec<f64> =
            self.grid.rows.iter().map(|(_, cells)| cells.get(column).copied().unwrap_or(f64::NAN)).collect();
        let held = holes::without_padding(&fractions, if percent { 100.0 } else { 1.0 });
        if let Some(hole) = holes::hole(&fractions, held.clone(), if percent { 100.0 } else { 1.0 }) {
            let line = self.grid.rows.get(hole.start).map_or(0, |(line, _)| *line);
            let error = holes::error(&hole);
            return Err(error.for_key(key).on_line(line));
        }
        Table::new(rows.get(held).unwrap_or(&rows))
    }

    /// What a fraction must be, and what to write if it is percent.
    fn fraction(&self, column: usize, key: &str, sheet: &Sheet) -> String {
        let most = sheet.ranges.get(column).map_or(f64::NAN, |range| range.1);
        let axis = self.grid.header.get(self.axis).map_or("", String::as_str);
        match self.values.len() {
            // Nearer to 1 than percent usually are, it may be noise.
            _ if most <= 1.5 => "a fraction between 0 and 1 (divide percent by 100)".to_owned(),
            1 => format!("a fraction between 0 and 1; if it is percent, write the header {axis},{key} (%)"),
            _ => format!("a fraction between 0 and 1; if it is percent, call the column `{key} (%)`"),
        }
    }
}
