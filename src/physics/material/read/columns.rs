//! What the columns of a table are: axis, then emissivity, reflectance, n and k, or materials.

use super::content::{of_all, one_line, stem};
use super::header::{self, Axis, Meaning, Quantity, Values};
use super::layout::{Sheet, is_index};
use crate::error::{Error, Result, check};
use crate::grid::Grid;
use crate::material::Material;
use crate::material::dielectric::{Dielectric, OpticalConstants};
use crate::material::model::Model;
use crate::material::provenance::{Basis, Provenance};
use crate::material::table::{Fault, Table, ascending};
use crate::spectral_unit::SpectralUnit;
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

/// All materials of a table.
pub(super) fn materials(sheet: &Sheet, source: &Path) -> Result<Vec<Material>> {
    let columns = Columns::of(sheet)?;
    let grid = &sheet.grid;
    let wavenumbers = columns.wavenumbers()?;
    let described = |description: String, note: &str| Provenance {
        description,
        category: "user".to_owned(),
        basis: Basis::UserFile,
        source: source.display().to_string(),
        licence: String::new(),
        note: note.to_owned(),
    };
    let read_as = |values: &str| {
        let form = sheet.form.in_words();
        [columns.axis_in_words.as_str(), values, &form]
            .into_iter()
            .filter(|part| !part.is_empty())
            .collect::<Vec<_>>()
            .join(", ")
    };
    let own = stem(source);
    let headers: Vec<&str> = columns.values.iter().map(|(_, header)| *header).collect();
    if headers == ["n", "k"] {
        let model = Model::HalfSpace(Dielectric::Constants(columns.optical_constants(&wavenumbers)?));
        let note = "smooth opaque half-space at normal incidence";
        let material = Material::of(own.clone(), described(format!("spectrum of {own}"), note), model);
        return Ok(vec![material.reading(read_as("n and k"))]);
    }
    let at = |error: Error, header: &str| error.for_key(header).on_line(grid.header_line);
    let (mut told, mut left_out): (Vec<(usize, &str, Values)>, Vec<&str>) = (Vec::new(), Vec::new());
    for &(column, header) in &columns.values {
        match header::values(header) {
            Meaning::Values(values) => told.push((column, header, values)),
            Meaning::Deviation => left_out.push(header),
            Meaning::Unclear => {
                let found =
                    format!("a column `{0}`, which may be what its numbers are or a name", one_line(header));
                let instead =
                    "end its header with what they are, as in `panel 2 reflectance` or `panel 2 emissivity`";
                return Err(at(Error::malformed(found, instead), header));
            }
            Meaning::Other => {
                let found = format!("a column `{}`, from which no emissivity follows", one_line(header));
                let instead = "use emissivity, or the hemispherical reflectance of an opaque sample, or delete the column";
                return Err(at(Error::malformed(found, instead), header));
            }
        }
    }
    let alone = told.len() == 1;
    let has = |quantity: Quantity| {
        told.iter().any(|(_, _, values)| values.quantity == Some(quantity) && values.name.is_empty())
    };
    let both = has(Quantity::Emissivity) && has(Quantity::Reflectance);
    let mut names = BTreeSet::new();
    let mut materials = Vec::with_capacity(told.len());
    for (column, header, values) in told {
        let quantity = match values.quantity {
            Some(quantity) => quantity,
            // In a table of materials a name alone stands for emissivity.
            None if !alone => Quantity::Emissivity,
            None => {
                let found = format!(
                    "a column `{}` of which nothing says whether it is emissivity or reflectance",
                    one_line(header)
                );
                let line = header::suggested(&grid.header, &sheet.ranges);
                return Err(at(
                    Error::malformed(found, format!("write the header that is true, such as {line}")),
                    header,
                ));
            }
        };
        let name = if alone && values.name.is_empty() { own.clone() } else { values.name.clone() };
        if name.is_empty() {
            let (found, instead) = match both {
                true => (
                    "columns of emissivity and of reflectance without the name of a material".to_owned(),
                    "delete one of them if they are of one surface; else name each column after its material, as in skin_emissivity",
                ),
                false => (
                    format!("a column `{}` in a table of materials", one_line(header)),
                    "name each column after its material, as in skin or skin_reflectance",
                ),
            };
            return Err(at(Error::malformed(found, instead), header));
        }
        if !names.insert(name.clone()) {
            let found = format!("two columns for the material `{name}`");
            return Err(Error::malformed(found, "give every column its own name").on_line(grid.header_line));
        }
        let table = columns.emissivities(&wavenumbers, column, quantity, values.percent, sheet)?;
        let note = match quantity {
            Quantity::Emissivity => "",
            Quantity::Reflectance => "emissivity = 1 - reflectance (Kirchhoff), taken as opaque",
        };
        let description = match alone {
            true => format!("spectrum of {name}"),
            false => format!("column {}", one_line(header)),
        };
        let share = if values.percent { " in percent" } else { "" };
        let mut warnings = Vec::new();
        if let Some((_, high)) = sheet.ranges.get(column)
            && values.percent
        {
            warnings.extend(of_all(quantity.name(), *high, 100.0));
        }
        if let [column, ..] = left_out.as_slice() {
            warnings.push(format!("the errors in the column `{}` are not used", one_line(column)));
        }
        let read_as = read_as(&format!("{}{share}", quantity.name()));
        materials.push(
            Material::of(name, described(description, note), Model::Table(table))
                .reading(read_as)
                .warn(warnings),
        );
    }
    if materials.is_empty() {
        let found = "no column has emissivities";
        let line = header::suggested(&grid.header, &sheet.ranges);
        return Err(Error::malformed(found, format!("write the header that is true, such as {line}"))
            .on_line(grid.header_line));
    }
    Ok(materials)
}

/// The columns `n` and `k`.
pub(super) fn optical_constants(sheet: &Sheet) -> Result<OpticalConstants> {
    let columns = Columns::of(sheet)?;
    let headers: Vec<&str> = columns.values.iter().map(|(_, header)| *header).collect();
    if headers != ["n", "k"] {
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
        quantity: Quantity,
        percent: bool,
        sheet: &Sheet,
    ) -> Result<Table<1>> {
        let key = self.grid.header.get(column).map_or("", String::as_str);
        let rows = wavenumbers
            .iter()
            .zip(&self.grid.rows)
            .map(|(&wavenumber, (line, cells))| {
                let value = cells.get(column).copied().unwrap_or(f64::NAN);
                let fraction = if percent { value / 100.0 } else { value };
                if (0.0..=1.0).contains(&fraction) {
                    return Ok((wavenumber, [quantity.emissivity(fraction)]));
                }
                let error = match percent {
                    true => {
                        Error::out_of_range(quantity.name(), value, "percent", "between 0 and 100 percent")
                    }
                    false => {
                        Error::out_of_range(quantity.name(), value, "", self.fraction(column, key, sheet))
                    }
                };
                Err(error.for_key(key).on_line(*line))
            })
            .collect::<Result<Vec<_>>>()?;
        Table::new(&rows)
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
