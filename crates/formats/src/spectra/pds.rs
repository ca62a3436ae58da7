//! Tables with a label of the Planetary Data System beside them, as RELAB's spectra are distributed: `c1ls04.tab` with `c1ls04.xml`.
//!
//! The label (PDS4) says where the table begins, how many records it has, and of each field name, place, length and unit. One field is
//! a wavelength, wavenumber or frequency, one is a reflectance or an emissivity. A field may have a constant for what is missing.
//!
//! Source: PDS4 Standards Reference, 1.20 (2023), Table_Character.

use super::bytes::FETCH_AGAIN;
use super::content::{Content, joined, short_name, stem};
use super::header::{self, Axis, Meaning, Values};
use super::reading::Reading;
use super::relab;
use super::samples::{Origin, Said, Samples, told};
use crate::file;
use crate::spectral_unit::SpectralUnit;
use hadar::error::{Error, Result};
use hadar::grid::number;
use hadar::words::{kebab_case, one_line};
use std::path::{Path, PathBuf};

/// What a label begins with, somewhere.
const ROOT: &str = "<Product_Observational";

/// Whether a text is a label.
pub(super) fn is_label(text: &str) -> bool {
    text.trim_start().starts_with('<') && text.contains(ROOT)
}

/// The label beside a file: of its name, ending in `.xml`.
pub(super) fn label_of(path: &Path) -> Result<Option<String>> {
    let is_table = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("tab"));
    let labels = ["xml", "XML"].map(|ending| path.with_extension(ending));
    let Some(label) = labels.into_iter().find(|label| is_table && label.is_file()) else { return Ok(None) };
    let text = file::text_of_file(&label, file::READ_SPECTRUM)?;
    Ok(Some(text).filter(|text| is_label(text)))
}

/// The file that a label is of.
///
/// # Errors
/// A label that names none.
pub(super) fn table_of(label: &str, path: &Path) -> Result<PathBuf> {
    let name = inner(label, "file_name").next().map(str::trim);
    // A name alone: a label is not to lead elsewhere.
    match name.filter(|name| !name.is_empty() && !name.contains(['/', '\\'])) {
        Some(name) => Ok(path.with_file_name(name)),
        None => Err(Error::malformed("the label names no file beside it", FETCH_AGAIN)),
    }
}

/// What stands between all tags of a name, which may have a prefix.
fn inner<'a>(text: &'a str, tag: &'a str) -> impl Iterator<Item = &'a str> {
    let mut rest = text;
    std::iter::from_fn(move || {
        loop {
            let (_, after) = rest.split_once('<')?;
            rest = after;
            let (opening, body) = after.split_once('>')?;
            let name = opening.split([' ', '\t', '\r', '\n', '/']).next().unwrap_or_default();
            if name.rsplit(':').next() != Some(tag) || name.is_empty() || opening.ends_with('/') {
                continue;
            }
            let closing = format!("</{name}>");
            let (content, behind) = body.split_once(closing.as_str())?;
            rest = behind;
            return Some(content);
        }
    })
}

/// A field of a record.
struct Field<'a> {
    name: &'a str,
    unit: &'a str,
    /// First byte of a record, from 0, and how many.
    place: usize,
    length: usize,
    /// The number that stands for what is missing.
    missing: Option<f64>,
}

impl<'a> Field<'a> {
    fn read(text: &'a str) -> Result<Self> {
        let one = |tag: &'a str| inner(text, tag).next().map_or("", str::trim);
        let whole = |tag: &'a str| whole(one(tag), tag);
        // What is stored is not what is meant.
        if let Some(tag) = ["scaling_factor", "value_offset"].into_iter().find(|tag| !one(tag).is_empty()) {
            let found = format!("a {tag} of the field `{}`", one_line(one("name")));
            return Err(Error::malformed(found, "write a table wavelength_um,reflectance of it"));
        }
        let missing = one("missing_constant");
        Ok(Self {
            name: one("name"),
            unit: one("unit"),
            place: whole("field_location")?.saturating_sub(1),
            length: whole("field_length")?,
            missing: if missing.is_empty() { None } else { Some(number(missing)?) },
        })
    }

    fn value(&self, record: &str) -> Result<f64> {
        let cell = record.get(self.place..self.place.saturating_add(self.length).min(record.len()));
        let value = number(cell.unwrap_or_default().trim()).map_err(|error| error.for_key(self.name))?;
        Ok(if self.missing == Some(value) || value < -1e30 { f64::NAN } else { value })
    }
}

fn whole(text: &str, tag: &str) -> Result<usize> {
    let wrong = |_| Error::malformed(format!("`{}` as {tag} of the label", one_line(text)), FETCH_AGAIN);
    text.parse().map_err(wrong)
}

/// The spectrum of a table with its label.
pub(super) fn parse(text: &str, label: &str, source: &Path, reading: &Reading) -> Result<Content> {
    let mut tables = inner(label, "Table_Character");
    let (Some(table), None) = (tables.next(), tables.next()) else {
        let found = "a label that is not of one table of characters";
        return Err(Error::malformed(found, "write a table wavelength_um,reflectance of it"));
    };
    let one = |tag: &'static str| inner(table, tag).next().map_or("", str::trim);
    let (offset, records) = (whole(one("offset"), "offset")?, whole(one("records"), "records")?);
    let fields = inner(table, "Field_Character").map(Field::read).collect::<Result<Vec<_>>>()?;
    let mut axes = Vec::new();
    let mut values = Vec::new();
    for field in &fields {
        match header::axis(&format!("{} ({})", field.name, field.unit)) {
            Ok(Some(Axis { unit: Some(unit), .. })) => axes.push((field, unit)),
            _ => {
                if let Meaning::Values(Values { quantity: Some(quantity), percent, .. }) =
                    header::values(field.name)
                {
                    values.push((field, quantity, percent || field.unit.contains('%')));
                }
            }
        }
    }
    let (&[(axis, unit)], &[(field, quantity, percent)]) = (axes.as_slice(), values.as_slice()) else {
        let names: Vec<&str> = fields.iter().map(|field| field.name).collect();
        let found =
            format!("fields {} where one axis and one reflectance or emissivity are due", names.join(", "));
        return Err(Error::malformed(one_line(&found), "write a table wavelength_um,reflectance of it"));
    };
    let rows = text.get(offset..).unwrap_or_default().lines().take(records);
    let points = rows.enumerate().map(|(at, record)| {
        let point = axis.value(record).and_then(|place| Ok((place, field.value(record)?)));
        point.map_err(|error| error.for_key(format!("record {}", at + 1)))
    });
    let points = points.collect::<Result<Vec<(f64, f64)>>>()?;
    if points.len() != records {
        let found = format!("{} records where the label announces {records}", points.len());
        return Err(Error::malformed(found, FETCH_AGAIN));
    }
    let (unit, quantity, percent): (SpectralUnit, _, _) =
        match told(Some(unit), Said::Values(quantity, percent), reading)? {
            Ok(told) => told,
            Err(reason) => return Ok(Content::NoEmissivity(reason)),
        };
    let of = |tag: &'static str| inner(label, tag).next().map(one_line).unwrap_or_default();
    let (specimen, title) = (of("specimen_name"), of("title"));
    let own = short_name(&kebab_case(&specimen));
    let name = if own.is_empty() { stem(source) } else { own };
    let description = joined(&[&title, &specimen, &of("specimen_description")], "; ");
    let remark = if label.to_lowercase().contains("relab") { relab::REMARK } else { "" };
    let origin = Origin { name, description, format: "PDS4", source, remark };
    let samples = Samples { unit, quantity, percent, points };
    Ok(Content::Materials(vec![samples.material(origin, reading)?]))
}

#[cfg(test)]
mod tests;
