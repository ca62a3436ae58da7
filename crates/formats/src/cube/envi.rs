//! ENVI images: raw samples in one file, their header in another.
//!
//! A sample is gain · number + offset (`data gain values`, `data offset values`), or number / `reflectance scale factor`; what
//! equals `data ignore value` is NaN.
//!
//! Source: NV5 Geospatial, ENVI Header Files (documentation of ENVI).

mod write;

pub use write::{EnviBands, envi_files};

use super::READ_CUBE;
use super::axes::Axes;
use super::band_list;
use super::found::{Found, Opened};
use super::raw::Raw;
use super::scaling;
use super::stored::Stored;
use super::text_unit;
use super::values::{ALL_VALID, Values};
use crate::envi_header::{ByteOrder, DataType, EnviHeader, Interleave};
use hadar::cube::Shape;
use hadar::error::{Error, Result};
use std::fs::File;
use std::path::Path;

const SCALE: &str = "reflectance scale factor";
const GAINS: &str = "data gain values";
const OFFSETS: &str = "data offset values";
const IGNORED: &str = "data ignore value";
const TITLES: &str = "z plot titles";
const UNITS: [&str; 4] = ["data units", "data unit", "units", "unit"];

/// Opens the data at a path by their header.
pub(super) fn open(file: File, path: &Path, header_path: &Path, axes: Option<Axes>) -> Result<Opened> {
    if let Some(axes) = axes {
        let found = format!("axes = \"{axes}\" of an ENVI file");
        return Err(Error::malformed(found, "leave axes out: its header says them by the interleave"));
    }
    let len = file.metadata().map_err(|error| Error::file(READ_CUBE, path, error))?.len();
    let header = EnviHeader::from_file(header_path)?;
    let in_header = |error: Error| error.in_file(header_path);
    let layout = header.layout().map_err(in_header)?;
    let shape = Shape::new(layout.lines, layout.samples, layout.bands).map_err(in_header)?;
    match layout.bytes() {
        Some(bytes) if bytes == len => {}
        bytes => {
            let bytes =
                bytes.map_or_else(|| "more than can be counted".to_owned(), |bytes| bytes.to_string());
            let found = format!("the file has {len} bytes, where its header announces {bytes}");
            let instead = "copy it to its end, or mend samples, lines, bands, data type or header offset";
            return Err(Error::malformed(found, instead));
        }
    }
    let values = values(&header, shape.bands()).map_err(in_header)?;
    let told = values.clone();
    let (order, format) = match layout.interleave {
        Interleave::Bsq => (Axes::IMAGES, "ENVI BSQ"),
        Interleave::Bil => (Axes::LINES, "ENVI BIL"),
        Interleave::Bip => (Axes::default(), "ENVI BIP"),
    };
    let stored = stored(layout.data_type);
    let raw = Raw {
        file,
        path: path.to_owned(),
        shape,
        start: layout.header_offset,
        order,
        stored,
        little_endian: layout.byte_order == ByteOrder::Little,
        values,
    };
    let cube = raw.cube();
    let [centres_cm1, widths_cm1] = bands(&header, shape.bands()).map_err(in_header)?;
    let good = header.good_bands(shape.bands()).map_err(in_header)?.unwrap_or_default();
    let bad_bands = good.iter().enumerate().filter(|(_, good)| !**good).map(|(band, _)| band).collect();
    // The header says which axis is which: there is no side to wonder about.
    let found = Found::array(format, shape, stored.name(), &[]);
    let axis_without_unit = centres_cm1.is_none() && header.text("wavelength").is_some();
    let mut found =
        Found { bad_bands, centres_cm1, widths_cm1, axis_without_unit, unit: unit(&header), ..found };
    told.iter().for_each(|values| values.tell(&mut found));
    Ok(Opened { found, cube })
}

const fn stored(data_type: DataType) -> Stored {
    match data_type {
        DataType::U8 => Stored::U8,
        DataType::I16 => Stored::I16,
        DataType::I32 => Stored::I32,
        DataType::F32 => Stored::F32,
        DataType::F64 => Stored::F64,
        DataType::U16 => Stored::U16,
        DataType::U32 => Stored::U32,
        DataType::I64 => Stored::I64,
        DataType::U64 => Stored::U64,
    }
}

/// What the numbers stand for.
fn values(header: &EnviHeader, bands: usize) -> Result<Option<Values>> {
    for (key, text) in header.all().filter(|(key, _)| ![SCALE, GAINS, OFFSETS].contains(key)) {
        let numbers: Option<Vec<f64>> = text.split(',').map(|item| item.trim().parse().ok()).collect();
        scaling::check(key, "", &numbers.unwrap_or_default()).map_err(|error| header.wrong(key, error))?;
    }
    let for_bands = |key: &str| header.numbers_for(key, bands, "bands");
    let (gains, offsets) = (for_bands(GAINS)?, for_bands(OFFSETS)?);
    let gain = match (header.number(SCALE)?, gains) {
        (Some(_), Some(_)) => {
            let found = format!("a {SCALE} beside {GAINS}");
            return Err(header.wrong(SCALE, Error::malformed(found, "keep the one that holds")));
        }
        (Some(scale), None) if scale > 0.0 => Some(vec![1.0 / scale]),
        (Some(scale), None) => {
            return Err(header.wrong(SCALE, Error::out_of_range(SCALE, scale, "", "above 0")));
        }
        (None, gains) => gains,
    };
    if let Some(0.0) = gain.iter().flatten().copied().find(|gain| *gain == 0.0) {
        return Err(header.wrong(GAINS, Error::out_of_range("gain", 0.0, "", "another number than 0")));
    }
    let is_nan = |text: &str| text.trim_start_matches(['-', '+']).eq_ignore_ascii_case("nan");
    // What is no number is missing without being told.
    let missing = match header.text(IGNORED) {
        Some(text) if is_nan(text) => None,
        _ => header.number(IGNORED)?,
    };
    Ok(Values::new(gain, offsets, missing.into_iter().collect(), ALL_VALID))
}

/// The unit of the samples, which has no key of its own in the format: as other programs write it.
fn unit(header: &EnviHeader) -> Option<String> {
    let said = UNITS.iter().find_map(|key| header.text(key)).filter(|unit| !unit.is_empty());
    let said = said.or_else(|| header.text(SCALE).map(|_| "reflectance")).map(str::to_owned);
    said.or_else(|| text_unit::of_title(header.text(TITLES)?))
}

/// Centres and widths of the bands, cm⁻¹; none without a unit, which is not guessed.
fn bands(header: &EnviHeader, bands: usize) -> Result<[Option<Vec<f64>>; 2]> {
    let (Some(unit), Some(centres)) =
        (header.wavelength_unit()?, header.numbers_for("wavelength", bands, "bands")?)
    else {
        return Ok([None, None]);
    };
    let positive = |key: &str, numbers: &[f64]| match numbers.iter().find(|number| **number <= 0.0) {
        None => Ok(()),
        Some(wrong) => Err(header.wrong(key, Error::out_of_range(key, *wrong, unit.name(), "above 0"))),
    };
    positive("wavelength", &centres)?;
    let widths = header.numbers_for("fwhm", bands, "bands")?;
    positive("fwhm", widths.as_deref().unwrap_or_default())?;
    let centres_cm1: Vec<f64> = centres.iter().map(|centre| unit.wavenumber_cm1(*centre)).collect();
    let widths_cm1 = widths.as_deref().map(|widths| band_list::widths_cm1(unit, &centres, widths));
    // Such as bands that reach below 0, or beyond what numbers can tell apart.
    let sound = centres_cm1.iter().all(|value| value.is_finite() && *value > 0.0);
    if !sound || widths_cm1 == Some(None) {
        let found =
            Error::malformed("these are no bands", "give wavelength and fwhm in the unit that is named");
        return Err(header.wrong("wavelength", found));
    }
    let widths_cm1 = widths_cm1.flatten();
    Ok([Some(centres_cm1), widths_cm1])
}
