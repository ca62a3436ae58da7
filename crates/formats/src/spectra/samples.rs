//! Samples of a spectrum as instruments and libraries store them, made into an emissivity.
//!
//! Values that are not known are no numbers: left out at the ends of a spectrum, between others an error once a band needs them, as
//! values below 0 or above 1 are.

use super::checked::{Checked, checked};
use super::content::{joined, of_all};
use super::header::{self, Meaning, Quantity, Values};
use super::reading::Reading;
use crate::spectral_unit::SpectralUnit;
use hadar::error::{Error, Result, check};
use hadar::material::{Material, Provenance, Table};
use hadar::words::one_line;
use std::path::Path;

/// What a file says of its values.
pub(super) enum Said {
    /// What they are, and whether in percent.
    Values(Quantity, bool),
    /// Something that leaves it open, in the file's words.
    Open(String),
    /// Something from which no emissivity follows, in the file's words.
    Other(String),
}

/// What is known of axis and values: the unit, the quantity, and whether in percent; or why there is no emissivity.
type Told = std::result::Result<(SpectralUnit, Quantity, bool), Error>;

/// What a file says of its axis and its values, and columns (`wavenumber_cm1,reflectance`) where it leaves something open.
///
/// # Errors
/// Something that nobody says, or the file other than the columns.
pub(super) fn told(unit: Option<SpectralUnit>, values: Said, reading: &Reading) -> Result<Told> {
    let columns = reading.columns_said();
    let axis = match columns.and_then(<[String]>::first) {
        Some(cell) => header::axis(cell)?.and_then(|axis| axis.unit),
        None => None,
    };
    let stated = columns.and_then(|columns| columns.get(1)).map(|cell| header::values(cell));
    let stated = match stated {
        Some(Meaning::Values(Values { quantity: Some(quantity), percent, .. })) => Some((quantity, percent)),
        _ => None,
    };
    if columns.is_some() && (axis.is_none() || stated.is_none()) {
        let found = "--columns names no unit of an axis, or neither emissivity nor reflectance";
        return Err(Error::malformed(found, "write --columns wavenumber_cm1,reflectance, whichever is true"));
    }
    let contradicts = |file: &str, columns: &str| {
        let found = format!("{file} by the file and {columns} by --columns");
        Err(Error::malformed(found, "leave --columns out, or correct it"))
    };
    let named = header::named_axis(unit.unwrap_or(SpectralUnit::PerCentimetre));
    let unit = match (unit, axis) {
        (Some(own), Some(other)) if own != other => return contradicts(own.name(), other.name()),
        (Some(unit), _) | (None, Some(unit)) => unit,
        (None, None) => {
            let found = "the file does not say in which unit its axis is";
            let instead = "import it with --columns wavenumber_cm1,reflectance, whichever is true";
            return Err(Error::malformed(found, instead));
        }
    };
    match (values, stated) {
        (Said::Other(name), _) => {
            let found = format!("`{}`, from which no emissivity follows", one_line(&name));
            let instead =
                "use a spectrum of the hemispherical reflectance, or the emissivity, of an opaque sample";
            Ok(Err(Error::malformed(found, instead)))
        }
        (Said::Values(own, _), Some((other, _))) if own != other => contradicts(own.name(), other.name()),
        (_, Some((quantity, percent))) | (Said::Values(quantity, percent), None) => {
            Ok(Ok((unit, quantity, percent)))
        }
        (Said::Open(name), None) => {
            let found = format!("`{}`, which may be reflectance, emissivity or neither", one_line(&name));
            let instead = format!(
                "if you know, import it with --columns {named},reflectance or {named},emissivity (reflectance_percent for percent)"
            );
            Err(Error::malformed(found, instead))
        }
    }
}

/// A spectrum as it was stored.
pub(super) struct Samples {
    pub(super) unit: SpectralUnit,
    pub(super) quantity: Quantity,
    pub(super) percent: bool,
    /// Place on the axis and value; no number where it is not known.
    pub(super) points: Vec<(f64, f64)>,
}

/// What a spectrum is called and where it is from.
pub(super) struct Origin<'a> {
    pub(super) name: String,
    pub(super) description: String,
    /// Name of the format, as `SPC`.
    pub(super) format: &'a str,
    pub(super) source: &'a Path,
    /// What its makers say of how it was measured that a user should know; may be empty.
    pub(super) remark: &'a str,
}

impl Samples {
    /// The material.
    ///
    /// # Errors
    /// A place on the axis that is not above 0 or there twice, less than two known values, values that are percent where fractions
    /// are announced.
    pub(super) fn material(&self, origin: Origin<'_>, reading: &Reading) -> Result<Material> {
        let scale = if self.percent { 100.0 } else { 1.0 };
        let fractions = || self.points.iter().map(|(_, value)| value / scale);
        too_large(self.quantity, fractions())?;
        let mut rows = Vec::with_capacity(self.points.len());
        for (&(place, _), fraction) in self.points.iter().zip(fractions()) {
            let wavenumber = check::positive(self.unit.quantity(), place, self.unit.name())
                .and_then(|place| check::positive("wavenumber", self.unit.wavenumber_cm1(place), "cm^-1"))?;
            let known = if fraction.is_finite() { fraction } else { f64::NAN };
            rows.push((wavenumber, [self.quantity.emissivity(known)]));
        }
        let count = rows.len();
        let usable = rows.iter().filter(|(_, [e])| !e.is_nan()).count();
        if usable < 2 {
            let found = format!("{usable} of {count} values are known");
            return Err(Error::malformed(found, "a spectrum needs at least 2"));
        }
        let Checked { table, mut warnings, note } = checked(of_known(rows)?, reading.clip())?;
        let left = table.rows().filter(|(_, [e])| e.is_nan()).count();
        warnings.extend(unknown(count - usable, count, left));
        let most = fractions().fold(f64::NEG_INFINITY, f64::max);
        warnings.extend(of_all(self.quantity.name(), most * scale, scale));
        if !origin.remark.is_empty() {
            warnings.push(origin.remark.to_owned());
        }
        let note = joined(&[self.quantity.note(), origin.remark, &note], "; ");
        let source = origin.source.display().to_string();
        let provenance = Provenance::of_file(one_line(&origin.description), source, &note);
        let share = if self.percent { " in percent" } else { "" };
        let (axis, unit, values) = (self.unit.quantity(), self.unit.name(), self.quantity.name());
        let read_as = format!("{}, {axis} in {unit}, {values}{share}", origin.format);
        Ok(Material::of_table(origin.name, provenance, table).reading(read_as).warn(warnings))
    }
}

/// Refuses fractions most of which are above all there is: noise goes beyond 1 here and there, percent does nearly everywhere.
fn too_large(quantity: Quantity, fractions: impl Iterator<Item = f64>) -> Result<()> {
    match most_beyond(fractions) {
        None => Ok(()),
        Some(most) => {
            let found = format!("{} up to {most} where 1 is all there is", quantity.name());
            let name = quantity.name();
            let instead = format!("if it is percent, import it with --columns wavenumber_cm1,{name}_percent");
            Err(Error::malformed(found, instead))
        }
    }
}

/// The largest of fractions, if more than half of them are well above 1.
pub(super) fn most_beyond(fractions: impl Iterator<Item = f64>) -> Option<f64> {
    let (all, beyond, most) = fractions.fold((0_usize, 0_usize, 0.0_f64), |(all, beyond, most), value| {
        (all + 1, beyond + usize::from(value > 1.5), most.max(value))
    });
    (2 * beyond > all).then_some(most)
}

/// The rows from the first known value to the last.
///
/// # Errors
/// A wavenumber that is there twice, whether known or not.
pub(super) fn of_known(mut rows: Vec<(f64, [f64; 1])>) -> Result<Table<1>> {
    // All of them first, so that a channel that is there twice is found wherever it is.
    let all = Table::new(&rows)?;
    let known_cm1 = |(wavenumber, [e]): (f64, [f64; 1])| (!e.is_nan()).then_some(wavenumber);
    let (low, high) = all
        .rows()
        .filter_map(known_cm1)
        .fold((f64::INFINITY, 0.0_f64), |(low, high), x| (low.min(x), high.max(x)));
    rows.retain(|(wavenumber, _)| (low..=high).contains(wavenumber));
    Table::new(&rows)
}

/// What is said of values that are not known, of which some may be `left` between others.
pub(super) fn unknown(count: usize, of: usize, left: usize) -> Option<String> {
    let bands = match left {
        0 => "left out".to_owned(),
        _ => "bands that use them are an error".to_owned(),
    };
    (count > 0).then(|| format!("{count} of {of} channels are bad or not known; {bands}"))
}
