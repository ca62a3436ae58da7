//! What the columns of a CSV file mean: axis first, then emissivity, reflectance, n and k, or materials.

use super::content::{kebab_case, one_line, stem};
use crate::error::{Error, Result, check};
use crate::grid::Grid;
use crate::material::Material;
use crate::material::dielectric::{Dielectric, OpticalConstants};
use crate::material::model::Model;
use crate::material::provenance::{Basis, Provenance};
use crate::material::table::{Fault, Table, ascending};
use std::collections::BTreeSet;
use std::path::Path;

/// The longest name of a first column that is named in a message.
const LONGEST_AXIS: usize = 40;
const HEADERS: &str =
    "the first column must be wavenumber_cm1 or wavelength_um, the second emissivity or reflectance";
const FRACTION: &str = "a fraction between 0 and 1 (divide percent by 100)";

/// All materials of a table.
pub(super) fn materials(grid: &Grid, source: &Path) -> Result<Vec<Material>> {
    let axis = wavenumbers(grid)?;
    let described = |description: String, note: &str| Provenance {
        description,
        category: "user".to_owned(),
        basis: Basis::UserFile,
        source: source.display().to_string(),
        licence: String::new(),
        note: note.to_owned(),
    };
    let named = |name: &str| format!("spectrum of {name}");
    match value_columns(grid).as_slice() {
        ["emissivity"] => {
            let model = Model::Table(emissivities(grid, &axis, 1, |e| e)?);
            Ok(vec![Material::of(stem(source), described(named(&stem(source)), ""), model)])
        }
        ["reflectance"] => {
            let model = Model::Table(emissivities(grid, &axis, 1, |reflectance| 1.0 - reflectance)?);
            let note = "emissivity = 1 - reflectance (Kirchhoff), taken as opaque";
            Ok(vec![Material::of(stem(source), described(named(&stem(source)), note), model)])
        }
        ["n", "k"] => {
            let model = Model::HalfSpace(Dielectric::Constants(optical_constants(grid)?));
            let note = "smooth opaque half-space at normal incidence";
            Ok(vec![Material::of(stem(source), described(named(&stem(source)), note), model)])
        }
        [one] => Err(Error::malformed(format!("a column `{one}`"), HEADERS)
            .for_key(*one)
            .on_line(grid.header_line)),
        many => {
            let mut names = BTreeSet::new();
            many.iter()
                .enumerate()
                .map(|(index, column)| {
                    let name =
                        material_name(column, &mut names).map_err(|error| error.on_line(grid.header_line))?;
                    let model = Model::Table(emissivities(grid, &axis, index + 1, |e| e)?);
                    Ok(Material::of(name, described(format!("column {}", one_line(column)), ""), model))
                })
                .collect()
        }
    }
}

/// The columns `n` and `k`.
pub(super) fn optical_constants(grid: &Grid) -> Result<OpticalConstants> {
    if value_columns(grid) != ["n", "k"] {
        return Err(Error::malformed(
            format!("columns {}", grid.header.join(",")),
            "optical constants need the columns wavelength_um,n,k",
        )
        .on_line(grid.header_line));
    }
    let axis = wavenumbers(grid)?;
    let rows: Vec<(f64, [f64; 2])> = axis
        .iter()
        .zip(&grid.rows)
        .filter_map(|(&wavenumber, (_, cells))| match cells[..] {
            [_, n, k] => Some((wavenumber, [n, k])),
            _ => None,
        })
        .collect();
    for ((_, [n, k]), (line, _)) in rows.iter().zip(&grid.rows) {
        check::positive("n", *n, "")
            .and_then(|_| check::non_negative("k", *k, ""))
            .map_err(|error| error.on_line(*line))?;
    }
    OpticalConstants::new(&rows)
}

fn value_columns(grid: &Grid) -> Vec<&str> {
    grid.header.iter().skip(1).map(String::as_str).collect()
}

/// The wavenumbers of the rows, cm⁻¹; each only once.
fn wavenumbers(grid: &Grid) -> Result<Vec<f64>> {
    let axis = grid.header.first().map_or("", String::as_str);
    let to_wavenumber: fn(f64) -> f64 = match axis {
        "wavenumber_cm1" => |x| x,
        "wavelength_um" => |x| 1e4 / x,
        // Nothing of a file is repeated that may be anything; this one is meant for a spectrum.
        other if other.len() <= LONGEST_AXIS && other.starts_with("wave") => {
            return Err(Error::malformed(format!("a first column `{other}`"), HEADERS)
                .for_key(other)
                .on_line(grid.header_line));
        }
        _ => {
            return Err(
                Error::malformed("this is not the header of a spectrum", HEADERS).on_line(grid.header_line)
            );
        }
    };
    let unit = if axis == "wavelength_um" { "um" } else { "cm^-1" };
    let wavenumbers = grid
        .rows
        .iter()
        .map(|(line, cells)| {
            let value = cells.first().copied().unwrap_or(f64::NAN);
            check::positive(axis, value, unit)
                .and_then(|value| check::positive("wavenumber", to_wavenumber(value), "cm^-1"))
                .map_err(|error| error.for_key(axis).on_line(*line))
        })
        .collect::<Result<Vec<f64>>>()?;
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
            let line = |row: usize| grid.rows.get(row).map_or(0, |(line, _)| *line);
            let value = grid.rows.get(second).and_then(|(_, cells)| cells.first()).copied();
            Err(Error::malformed(
                format!("{} {unit} is there already on line {}", value.unwrap_or(f64::NAN), line(first)),
                "keep one of the two rows",
            )
            .for_key(axis)
            .on_line(line(second)))
        }
    }
}

fn emissivities(grid: &Grid, axis: &[f64], column: usize, rule: fn(f64) -> f64) -> Result<Table<1>> {
    let name = grid.header.get(column).map_or("", String::as_str);
    let rows = axis
        .iter()
        .zip(&grid.rows)
        .map(|(&wavenumber, (line, cells))| {
            let value = cells.get(column).copied().unwrap_or(f64::NAN);
            if (0.0..=1.0).contains(&value) {
                Ok((wavenumber, [rule(value)]))
            } else {
                let quantity = if name == "reflectance" { name } else { "emissivity" };
                Err(Error::out_of_range(quantity, value, "", FRACTION).for_key(name).on_line(*line))
            }
        })
        .collect::<Result<Vec<_>>>()?;
    Table::new(&rows)
}

/// The name of a material's column, which no other column may share; it is added to the `names` there are.
fn material_name(column: &str, names: &mut BTreeSet<String>) -> Result<String> {
    let name = kebab_case(column);
    if name.is_empty() || matches!(column, "n" | "k" | "reflectance" | "emissivity" | "transmittance") {
        return Err(Error::malformed(
            format!("a column `{column}` in a table of materials"),
            "name each column after its material; its cells are emissivities",
        ));
    }
    if !names.insert(name.clone()) {
        return Err(Error::malformed(
            format!("two columns for the material `{name}`"),
            "give every column its own name",
        ));
    }
    Ok(name)
}
