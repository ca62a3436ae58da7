//! Bands and filters from CSV files.
//!
//! Rows: `wavenumber_cm1` or `wavelength_um`, and optionally `width_cm1` or `width_um`, one band per row in
//! any order. Filters: the same first column, then one column of transmittances per filter.

use crate::file::text_of_file;
use hadar::error::{Error, Result, check};
use hadar::grid::Grid;
use hadar::spectrum::{Bands, FilterCurve};
use std::collections::HashSet;
use std::path::Path;

/// Reads a file with one row per band.
///
/// # Errors
/// A file that cannot be read, columns of another name, cells that are not numbers above 0, a centre
/// that comes twice; with file and line.
///
/// ```no_run
/// let bands = hadar_formats::bands("my_bands.csv".as_ref())?;
/// println!("{} bands from {} cm^-1", bands.len(), bands.nodes_cm1()[0]);
/// # Ok::<(), hadar::Error>(())
/// ```
pub fn bands(path: &Path) -> Result<Bands> {
    listed_bands(path).map(|(bands, _)| bands)
}

/// The same with their centres in the order of the rows, cm⁻¹.
///
/// # Errors
/// As [`bands`].
pub fn listed_bands(path: &Path) -> Result<(Bands, Vec<f64>)> {
    let text = text_of_file(path, "read the bands")?;
    rows(&text).map_err(|error| error.in_file(path))
}

/// Reads a file with one column per filter.
///
/// # Errors
/// As [`bands`], and a transmittance outside [0, 1].
pub fn filters(path: &Path) -> Result<Bands> {
    filter_curves(path).and_then(|curves| Bands::from_filters(curves).map_err(|error| error.in_file(path)))
}

/// The curves of such a file, in the order of its columns.
///
/// # Errors
/// As [`filters`]; two filters of one name.
pub fn filter_curves(path: &Path) -> Result<Vec<FilterCurve>> {
    let text = text_of_file(path, "read the filters")?;
    curves(&text).map_err(|error| error.in_file(path))
}

fn rows(text: &str) -> Result<(Bands, Vec<f64>)> {
    // A single column has no comma, so the widths' column is what tells a table from a list.
    let listed = text.lines().find(|line| !line.trim().is_empty() && !line.starts_with('#'));
    let padded;
    let text = if listed.is_some_and(|header| !header.contains(',')) {
        padded = text
            .lines()
            .map(|line| {
                if line.trim().is_empty() || line.starts_with('#') {
                    line.to_owned()
                } else {
                    format!("{line},{line}")
                }
            })
            .collect::<Vec<_>>()
            .join("\n");
        padded.as_str()
    } else {
        text
    };
    let grid = Grid::parse(text)?;
    let centers = grid.wavenumbers_cm1()?;
    let width = grid.header.get(1).map_or("", String::as_str);
    match width {
        "width_cm1" | "width_um" => {}
        same if grid.header.first().is_some_and(|first| first == same) => {
            return Ok((Bands::from_centers(&centers)?, centers));
        }
        other => {
            return Err(Error::malformed(
                format!("a second column `{other}`"),
                "name it width_cm1 or width_um",
            )
            .for_key(other)
            .on_line(grid.header_line));
        }
    }
    let banded = centers.iter().zip(&grid.rows).map(|(&center, (line, cells))| {
        let value = cells.get(1).copied().unwrap_or(f64::NAN);
        check::positive(width, value, "").map_err(|error| error.for_key(width).on_line(*line))?;
        // dν = 10⁴ dλ/λ² = ν² dλ/10⁴.
        let width_cm1 = if width == "width_um" { center * center * value / 1e4 } else { value };
        check::positive("band width", width_cm1, "cm^-1")
            .map_err(|error| error.for_key(width).on_line(*line))?;
        Ok((center, width_cm1))
    });
    let bands = Bands::from_rows(banded.collect::<Result<Vec<_>>>()?)?;
    Ok((bands, centers))
}

/// What a header holds that says of its numbers that they are something else.
const NO_TRANSMITTANCE: [&str; 7] =
    ["%", "percent", "pct", "absorbance", "absorptance", "reflectance", "optical density"];
/// A word that says so where it stands alone: an optical density.
const OPTICAL_DENSITY: &str = "od";
/// A column of this ending is the reflectance of the filter before it.
const REFLECTANCE: &str = ":reflectance";

fn curves(text: &str) -> Result<Vec<FilterCurve>> {
    let grid = Grid::parse(text)?;
    let axis = grid.wavenumbers_cm1()?;
    let rows = |column: usize, what: &str| -> Result<Vec<(f64, f64)>> {
        let row = |(&wavenumber, (line, cells)): (&f64, &(usize, Vec<f64>))| {
            let value = cells.get(column).copied().unwrap_or(f64::NAN);
            check::unit_interval(what, value)
                .map(|value| (wavenumber, value))
                .map_err(|error| error.for_key(grid.header[column].clone()).on_line(*line))
        };
        axis.iter().zip(&grid.rows).map(row).collect()
    };
    let mut filters: Vec<FilterCurve> = Vec::new();
    let mut names: HashSet<&str> = HashSet::new();
    for (column, header) in grid.header.iter().enumerate().skip(1) {
        let at_column = |error: Error| error.for_key(header.clone()).on_line(grid.header_line);
        let Some(of) = header.strip_suffix(REFLECTANCE) else {
            let lower = header.to_lowercase();
            let is_density = lower.split(|c: char| !c.is_alphanumeric()).any(|word| word == OPTICAL_DENSITY);
            let density = is_density.then_some(&OPTICAL_DENSITY);
            if let Some(word) = NO_TRANSMITTANCE.iter().find(|word| lower.contains(**word)).or(density) {
                let found = format!("the numbers of `{header}` are no transmittances by its name (`{word}`)");
                let instead =
                    "write shares from 0 to 1 that are transmitted, under the name of the filter alone";
                return Err(at_column(Error::malformed(found, instead)));
            }
            if !names.insert(header) {
                let found = format!("another filter is called `{header}` too");
                return Err(at_column(Error::malformed(found, "give each a name of its own")));
            }
            filters.push(FilterCurve::new(header.clone(), rows(column, "transmittance")?)?);
            continue;
        };
        let Some(filter) = filters.iter_mut().find(|filter| filter.name() == of) else {
            let found = format!("a reflectance of `{of}`, which is no filter before it");
            return Err(at_column(Error::malformed(found, format!("write a column `{of}` to its left"))));
        };
        let reflectance = rows(column, "reflectance")?;
        // In its place: the order of the filters is that of the bands of a cube.
        *filter = filter.clone().with_reflectance(reflectance).map_err(at_column)?;
    }
    Ok(filters)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_with_and_without_widths_in_either_unit() {
        let (bands, listed) = rows("wavenumber_cm1,width_cm1\n900,2\n800,4\n").unwrap();
        assert_eq!(listed, [900.0, 800.0]);
        assert_eq!((bands.nodes_cm1(), bands.widths_cm1()), ([800.0, 900.0].as_slice(), vec![4.0, 2.0]));
        let (bands, _) = rows("# centres\nwavenumber_cm1\n800\n810\n").unwrap();
        assert_eq!(bands.widths_cm1(), [10.0, 10.0]);
        let (bands, _) = rows("wavelength_um,width_um\n10,0.1\n").unwrap();
        assert!((bands.widths_cm1()[0] - 10.0).abs() < 1e-12);
    }

    #[test]
    fn filters_column_by_column_and_their_mistakes() {
        let two = curves("wavelength_um,a,b\n8,0,1\n9,1,0\n10,0,0\n").unwrap();
        assert_eq!(two.len(), 2);
        for (text, found) in [
            (
                "wavelength_um,a\n8,0\n8,1\n",
                "line 3: wavelength_um: wavenumber 1250 cm^-1 is there already on line 2; keep one of the two rows",
            ),
            ("wavelength_um,a\n8,0\n9,1.2\n", "line 3: a: transmittance is 1.2; it must be between 0 and 1"),
            (
                "wavelength_um,a,a\n8,0,1\n9,1,0\n",
                "line 1: a: another filter is called `a` too; give each a name of its own",
            ),
            (
                "wavelength_um,a (%)\n8,0\n9,0.9\n",
                "line 1: a (%): the numbers of `a (%)` are no transmittances by its name (`%`); write shares from 0 to 1 that are transmitted, under the name of the filter alone",
            ),
            (
                "wavelength_um,a,OD [b]\n8,0,4\n9,0.9,0.1\n",
                "line 1: OD [b]: the numbers of `OD [b]` are no transmittances by its name (`od`); write shares from 0 to 1 that are transmitted, under the name of the filter alone",
            ),
            (
                "nm,a\n8,0\n",
                "line 1: the first column has another name; name it wavenumber_cm1 or wavelength_um",
            ),
        ] {
            assert_eq!(curves(text).unwrap_err().to_string(), found);
        }
        let names = |text: &str| -> Vec<String> {
            curves(text).unwrap().iter().map(|filter| filter.name().to_owned()).collect()
        };
        assert_eq!(names("wavelength_um,wood,model,c\n8,0,0,0\n9,1,1,1\n"), ["wood", "model", "c"]);
        // Whatever the order of the columns of reflectances.
        let text = "wavelength_um,a,b,c,a:reflectance,c:reflectance\n8,0,0,0,1,1\n9,0.9,0.9,0.9,0.1,0.1\n";
        assert_eq!(names(text), ["a", "b", "c"]);
    }
}
