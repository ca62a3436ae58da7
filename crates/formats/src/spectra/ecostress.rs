//! Text files of the ECOSTRESS and ASTER spectral libraries.
//!
//! `Key: value` lines, a blank line, then two columns: wavelength in µm and reflectance in percent, ascending or
//! descending. Directional-hemispherical reflectance R of an opaque sample, so that e = 1 − R/100 (Kirchhoff).
//!
//! Calibration leaves some reflectances below 0 or above 100 %. Such a row is kept as it is, reported as a
//! warning, and an error once a band needs it. Transmittance files and the `ancillary` files (notes
//! without columns) are recognised and refused.
//!
//! Source: Meerdink et al., Remote Sens. Environ. 230, 111196 (2019), doi:10.1016/j.rse.2019.05.015; Baldridge et al.,
//! Remote Sens. Environ. 113, 711 (2009), doi:10.1016/j.rse.2008.11.007. Layout from the files themselves.

use super::checked::{Checked, checked};
use super::content::{Content, joined, of_all, short_name, stem};
use super::header::Quantity;
use super::reading::Reading;
use hadar::error::{Error, Result, check};
use hadar::grid;
use hadar::material::Material;
use hadar::material::Provenance;
use hadar::material::{Fault, Table, ascending};
use hadar::words::{kebab_case, one_line};
use std::collections::BTreeMap;
use std::path::Path;

/// Whether the text looks like one: its first line is `Name: …`.
pub(super) fn is_one(text: &str) -> bool {
    let first = text.lines().find(|line| !line.trim().is_empty()).unwrap_or_default();
    first.trim_start().get(..5).is_some_and(|key| key.eq_ignore_ascii_case("name:"))
}

/// Keys in lower case, with the line each is on; and the numbered rows.
struct Parts {
    keys: BTreeMap<String, (usize, String)>,
    rows: Vec<(usize, f64, f64)>,
}

pub(super) fn parse(text: &str, source: &Path, reading: &Reading) -> Result<Content> {
    let parts = split(text)?;
    let value = |key: &str| parts.keys.get(key).map_or("", |(_, value)| value.as_str());
    let at = |error: Error, key: &str| match parts.keys.get(key) {
        Some((line, _)) => error.for_key(key).on_line(*line),
        None => error,
    };

    let quantity = value("y units").to_lowercase();
    if quantity.is_empty() {
        return Ok(Content::NoEmissivity(Error::malformed(
            "there is no line `Y Units:`, so this is no spectrum (an ancillary file?)",
            "use the file that ends in spectrum.txt",
        )));
    }
    if quantity.starts_with("trans") {
        let refusal = Error::malformed(
            format!("this is transmittance (`{}`), from which no emissivity follows", value("y units")),
            "use a reflectance file of an opaque sample",
        );
        return Ok(Content::NoEmissivity(at(refusal, "y units")));
    }
    if !(quantity.starts_with("reflect") && quantity.contains("percent")) {
        let found = format!("`{}` is not reflectance in percent", value("y units"));
        let instead = "give the file of reflectance in percent, or its rows as a table that begins with wavelength_um,emissivity";
        return Err(at(Error::malformed(found, instead), "y units"));
    }
    if !value("x units").to_lowercase().contains("micromet") {
        let found = format!("`{}` is not a wavelength in micrometers", value("x units"));
        return Err(at(Error::malformed(found, "write `X Units: Wavelength (micrometers)`"), "x units"));
    }
    let announced = value("number of x values");
    if !announced.is_empty() && announced.parse() != Ok(parts.rows.len()) {
        let found = format!("{} rows where the header announces {announced}", parts.rows.len());
        let error = Error::malformed(found, "fetch the file again: it is cut short or damaged");
        return Err(at(error, "number of x values"));
    }

    let Checked { table, mut warnings, note: clipped } = checked(table(&parts.rows)?, reading.clip())?;
    let most = parts.rows.iter().map(|(.., percent)| *percent).fold(f64::NEG_INFINITY, f64::max);
    warnings.extend(of_all("reflectance", most, 100.0));
    let measurement = value("measurement");
    if !measurement.is_empty() && !measurement.to_lowercase().contains("hemispherical") {
        warnings.push(format!(
            "measured as `{}`: emissivity is 1 - reflectance of hemispherical reflectance alone, so these values may be wrong",
            one_line(measurement)
        ));
    }
    let title = value("name");
    let own = short_name(&kebab_case(title));
    let name = if own.is_empty() { stem(source) } else { own };
    let description = joined(&[title, value("description")], "; ");
    let source = joined(&[&source.display().to_string(), value("owner")], "; ");
    let note = joined(&[measurement, Quantity::Reflectance.note(), &clipped], "; ");
    let category = one_line(&value("type").to_lowercase());
    let provenance = Provenance { category, ..Provenance::of_file(description, source, &note) };
    let material = Material::of_table(name, provenance, table).warn(warnings);
    let sample = kebab_case(value("sample no."));
    let read_as = "ECOSTRESS, wavelength in um, reflectance in percent";
    Ok(Content::Materials(vec![material.reading(read_as).of_sample(sample)]))
}

fn split(text: &str) -> Result<Parts> {
    let mut parts = Parts { keys: BTreeMap::new(), rows: Vec::new() };
    let mut in_header = true;
    for (index, line) in text.lines().enumerate() {
        let (number, line) = (index + 1, line.trim());
        if line.is_empty() {
            in_header &= !parts.keys.contains_key("y units");
        } else if in_header && let Some((key, value)) = line.split_once(':') {
            parts.keys.entry(key.trim().to_lowercase()).or_insert((number, value.trim().to_owned()));
        } else if !in_header {
            let (wavelength, percent) = row(line).map_err(|error| error.on_line(number))?;
            parts.rows.push((number, wavelength, percent));
        }
    }
    Ok(parts)
}

fn row(line: &str) -> Result<(f64, f64)> {
    let cells: Vec<&str> = line.split_whitespace().collect();
    let [wavelength, percent] = cells[..] else {
        return Err(Error::malformed(
            format!("{} numbers on the line", cells.len()),
            "write a wavelength in um and a reflectance in percent",
        ));
    };
    let wavelength = grid::number(wavelength)
        .and_then(|value| check::positive("wavelength", value, "um"))
        .map_err(|error| error.for_key("wavelength"))?;
    let percent = grid::number(percent).map_err(|error| error.for_key("reflectance"))?;
    Ok((wavelength, percent))
}

fn table(rows: &[(usize, f64, f64)]) -> Result<Table<1>> {
    let wavenumbers: Vec<f64> = rows.iter().map(|(_, wavelength, _)| 1e4 / wavelength).collect();
    match ascending(&wavenumbers) {
        Ok(_) => {}
        Err(Fault::TooFew) => {
            return Err(Error::malformed(
                format!("{} rows below the header", rows.len()),
                "a spectrum needs at least 2",
            ));
        }
        Err(Fault::Duplicate(first, second)) => {
            let line = |row: usize| rows.get(row).map_or(0, |(line, ..)| *line);
            let found = format!("this wavelength is there already on line {}", line(first));
            return Err(Error::malformed(found, "keep one of the two rows").on_line(line(second)));
        }
    }
    let emissivities: Vec<(f64, [f64; 1])> = wavenumbers
        .into_iter()
        .zip(rows)
        .map(|(wavenumber, (_, _, percent))| (wavenumber, [1.0 - percent / 100.0]))
        .collect();
    Table::new(&emissivities)
}
