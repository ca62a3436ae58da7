//! Binary files of ASD field spectrometers (Malvern Panalytical), of every revision from `ASD` to `as8`.
//!
//! A header of 484 bytes, little-endian: at 186 what the samples are, at 191 and 195 the first wavelength and the step in nm, at 199
//! the kind of number, at 204 the number of channels. Then the samples, and from revision 2 on the white reference: 2 bytes say whether there is
//! one, 16 are times, then a text with its length, and its samples. What stands there as reflectance, radiance or counts is
//! divided by the white reference of the same channel, whose gains and times are the same: reflectance relative to the white panel.
//!
//! Nearly all are from 350 to 2500 nm, outside the thermal infrared, as the reading says.
//!
//! Source: ASD File Format, Version 8, Revision B (ASD Inc.).

use super::bytes::{Bytes, FETCH_AGAIN};
use super::content::{Content, stem};
use super::header::Quantity;
use super::reading::Reading;
use super::samples::{Origin, Said, Samples, told};
use crate::envi_header::{ByteOrder, DataType};
use crate::spectral_unit::SpectralUnit;
use hadar::error::{Error, Result, check};
use std::path::Path;

/// Where the samples begin.
const SAMPLES: usize = 484;
/// The first revisions, which have no white reference.
const OLDEST: [&[u8]; 2] = [b"ASD", b"asd"];
/// What samples are, by the number at byte 186.
const TYPES: [&str; 9] = [
    "counts",
    "reflectance",
    "radiance",
    "no unit",
    "irradiance",
    "quality index",
    "transmittance",
    "unknown",
    "absorbance",
];

/// Whether bytes are such a file: its revision, and behind it some that no text has.
pub(super) fn is_one(bytes: &[u8]) -> bool {
    let is_revision = match bytes {
        [b'a', b's', revision, ..] => (b'2'..=b'8').contains(revision) || *revision == b'd',
        _ => bytes.starts_with(OLDEST[0]),
    };
    is_revision && bytes.get(..SAMPLES).unwrap_or(bytes).contains(&0)
}

pub(super) fn parse(all: &[u8], source: &Path, reading: &Reading) -> Result<Content> {
    let bytes = Bytes { all, order: ByteOrder::Little };
    let code = bytes.count(186, DataType::U8)?;
    let kind = match bytes.count(199, DataType::U8)? {
        0 => DataType::F32,
        1 => DataType::I32,
        2 => DataType::F64,
        other => {
            let found = format!("samples of an unknown kind ({other})");
            return Err(Error::malformed(found, FETCH_AGAIN));
        }
    };
    let channels = bytes.count(204, DataType::U16)?;
    let first = check::positive("first wavelength", bytes.number(191, DataType::F32)?, "nm")?;
    let step = check::positive("step of the wavelength", bytes.number(195, DataType::F32)?, "nm")?;
    let values = bytes.numbers(SAMPLES, channels, kind)?;
    let name = TYPES.get(code).copied().unwrap_or("unknown");
    let white = white(bytes, SAMPLES + channels * kind.size(), channels, kind)?;
    let (values, remark) = match (code, white) {
        (0..=2, Some(white)) => (
            values.iter().zip(&white).map(|(value, white)| value / white).collect(),
            "relative to a white panel: emissivity is 1 - reflectance as far as the panel reflects all and the reflectance is hemispherical",
        ),
        (1, None) => (
            values,
            "nothing says of what the reflectance is a part: emissivity is 1 - reflectance of hemispherical reflectance alone",
        ),
        (0 | 2, None) => {
            let found = format!("{name} without a white reference, from which no emissivity follows");
            let instead = "measure a white reference first, or export the reflectance";
            return Ok(Content::NoEmissivity(Error::malformed(found, instead)));
        }
        _ => (values, ""),
    };
    let said = match code {
        0..=2 => Said::Values(Quantity::Reflectance, false),
        _ => Said::Other(name.to_owned()),
    };
    let (unit, quantity, percent) = match told(Some(SpectralUnit::Nanometre), said, reading)? {
        Ok(told) => told,
        Err(reason) => return Ok(Content::NoEmissivity(reason)),
    };
    let points: Vec<(f64, f64)> =
        values.into_iter().enumerate().map(|(at, value)| (first + step * at as f64, value)).collect();
    let comment = bytes.text(3, 157)?;
    let name = stem(source);
    let description = if comment.trim().is_empty() { format!("spectrum of {name}") } else { comment };
    let origin = Origin { name, description, format: "ASD", source, remark };
    let samples = Samples { unit, quantity, percent, points };
    Ok(Content::Materials(vec![samples.material(origin, reading)?]))
}

/// The samples of the white reference that stands at `at`, if there is one.
fn white(bytes: Bytes<'_>, at: usize, channels: usize, kind: DataType) -> Result<Option<Vec<f64>>> {
    let is_oldest = OLDEST.iter().any(|oldest| bytes.all.starts_with(oldest));
    if is_oldest || bytes.all.len() == at || !bytes.has(at, 0xff)? {
        return Ok(None);
    }
    let text = bytes.count(at + 18, DataType::U16)?;
    let white = bytes.numbers(at + 20 + text, channels, kind)?;
    Ok(Some(white).filter(|white| white.iter().any(|value| *value != 0.0)))
}

#[cfg(test)]
mod tests;
