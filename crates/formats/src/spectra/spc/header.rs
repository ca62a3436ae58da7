//! The header of an SPC file: flags, number of points and traces, ends of the axis, and what axis and ordinates are.

use super::super::bytes::{Bytes, FETCH_AGAIN};
use super::super::header::{self, Axis, Meaning, Quantity, Values};
use super::super::samples::Said;
use crate::envi_header::DataType;
use crate::spectral_unit::SpectralUnit;
use hadar::error::{Error, Result};

/// Bytes of the header of a trace.
pub(super) const TRACE_HEADER: usize = 32;

/// Bytes of the header of the new version.
pub(super) const NEW: usize = 512;
/// Bytes of the header of the old version, behind which the first trace's stands.
const OLD: usize = 224;
/// The exponent that says floats.
pub(super) const FLOATS: i32 = -128;

/// Bits of the first byte.
#[derive(Debug, Clone, Copy)]
pub(super) struct Flags(u8);

impl Flags {
    /// Ordinates of 16 bits.
    pub(super) const SHORT: u8 = 0x01;
    /// More than one trace.
    pub(super) const MANY: u8 = 0x04;
    /// Axes are named by labels.
    const LABELS: u8 = 0x20;
    /// Every trace has its own axis.
    pub(super) const AXIS_EACH: u8 = 0x40;
    /// The axis is a list.
    pub(super) const AXIS: u8 = 0x80;

    pub(super) const fn has(self, bit: u8) -> bool {
        self.0 & bit != 0
    }
}

/// What the header says.
pub(super) struct Header {
    pub(super) flags: Flags,
    pub(super) is_old: bool,
    pub(super) exponent: i32,
    /// Points of a trace; where every trace has its own axis, the place of a directory or 0.
    pub(super) points: usize,
    /// Traces; 0 where their number is not said.
    pub(super) traces: usize,
    first: f64,
    last: f64,
    /// Where the first trace or the axis begins.
    pub(super) end: usize,
    axis_code: usize,
    values_code: usize,
    axis_label: String,
    values_label: String,
    pub(super) comment: String,
}

impl Header {
    /// The header at the begin of a file.
    pub(super) fn read(bytes: Bytes<'_>) -> Result<Self> {
        let flags = Flags(bytes.count(0, DataType::U8)? as u8);
        let is_old = bytes.count(1, DataType::U8)? == usize::from(b'M');
        let (labels, comment) = if is_old { (194, 64) } else { (218, 88) };
        let labels = match flags.has(Flags::LABELS) {
            true => bytes.part(labels, 30)?.to_vec(),
            false => Vec::new(),
        };
        let mut labels =
            labels.split(|byte| *byte == 0).map(|label| label.iter().map(|&b| char::from(b)).collect());
        let (axis_label, values_label): (String, String) =
            (labels.next().unwrap_or_default(), labels.next().unwrap_or_default());
        let comment = bytes.text(comment, 130)?.trim().to_owned();
        if !is_old {
            // All of it must be there.
            bytes.part(0, NEW)?;
            return Ok(Self {
                flags,
                is_old,
                exponent: exponent(bytes, 3)?,
                points: bytes.count(4, DataType::U32)?,
                traces: bytes.count(24, DataType::U32)?.max(1),
                first: bytes.number(8, DataType::F64)?,
                last: bytes.number(16, DataType::F64)?,
                end: NEW,
                axis_code: bytes.count(28, DataType::U8)?,
                values_code: bytes.count(29, DataType::U8)?,
                axis_label,
                values_label,
                comment,
            });
        }
        if flags.has(Flags::AXIS) || flags.has(Flags::AXIS_EACH) {
            let found = "the old version of the format with an axis that is a list, which it does not have";
            return Err(Error::malformed(found, FETCH_AGAIN));
        }
        let code = bytes.number(2, DataType::I16)?;
        Ok(Self {
            flags,
            is_old,
            exponent: if code == 128.0 { FLOATS } else { code as i32 },
            points: bytes.count(4, DataType::F32)?,
            traces: usize::from(!flags.has(Flags::MANY)),
            first: bytes.number(8, DataType::F32)?,
            last: bytes.number(12, DataType::F32)?,
            end: OLD,
            axis_code: bytes.count(16, DataType::U8)?,
            values_code: bytes.count(17, DataType::U8)?,
            axis_label,
            values_label,
            comment,
        })
    }

    /// Whether there is another trace: of the number that is said, or as long as there are bytes.
    pub(super) const fn is_more(&self, read: usize, at: usize, length: usize) -> bool {
        if self.traces > 0 {
            read < self.traces
        } else {
            read == 0 || length.saturating_sub(at) >= TRACE_HEADER
        }
    }

    /// The places of an axis that is evenly spaced.
    pub(super) fn even(&self) -> Result<Vec<f64>> {
        let Self { first, last, points, .. } = *self;
        let is_one = first.is_finite() && last.is_finite() && first != last && points > 1;
        if !is_one {
            let found = format!("an axis of {points} points from {first} to {last}");
            return Err(Error::malformed(found, FETCH_AGAIN));
        }
        let step = (last - first) / (points - 1) as f64;
        Ok((0..points).map(|at| first + step * at as f64).collect())
    }

    /// The unit of the axis; none where it is arbitrary.
    pub(super) fn unit(&self) -> Result<Option<SpectralUnit>> {
        if !self.axis_label.trim().is_empty() {
            let label = self.axis_label.trim();
            if let Some(unit) = SpectralUnit::spelt(label) {
                return Ok(Some(unit));
            }
            match header::axis(label)? {
                Some(Axis { unit: Some(unit), .. }) => return Ok(Some(unit)),
                // What is counted, and the code has its unit.
                Some(Axis { unit: None, quantity }) => {
                    return Ok(self.coded_unit()?.filter(|unit| unit.quantity() == quantity));
                }
                None => return Ok(None),
            }
        }
        self.coded_unit()
    }

    fn coded_unit(&self) -> Result<Option<SpectralUnit>> {
        Ok(Some(match self.axis_code {
            0 => return Ok(None),
            1 => SpectralUnit::PerCentimetre,
            2 => SpectralUnit::Micrometre,
            3 => SpectralUnit::Nanometre,
            6 => SpectralUnit::Hertz,
            26 => SpectralUnit::Gigahertz,
            28 => SpectralUnit::Metre,
            29 => SpectralUnit::Millimetre,
            other => {
                let name =
                    AXES.iter().find(|(code, _)| *code == other).map_or("an unknown one", |known| known.1);
                let found = format!("the axis is {name} (code {other}), no wavelength or wavenumber");
                return Err(Error::malformed(found, "use a spectrum over wavenumber or wavelength"));
            }
        }))
    }

    /// What the ordinates are.
    pub(super) fn values(&self) -> Said {
        let label = self.values_label.trim();
        if !label.is_empty() {
            match header::values(label) {
                Meaning::Values(Values { quantity: Some(quantity), percent, .. }) => {
                    return Said::Values(quantity, percent);
                }
                Meaning::Other | Meaning::Deviation => return Said::Other(label.to_owned()),
                _ => return Said::Open(label.to_owned()),
            }
        }
        match self.values_code {
            129 => Said::Values(Quantity::Reflectance, false),
            code => match VALUES.iter().find(|(known, _)| *known == code) {
                Some((_, name)) if OPEN.contains(&code) => Said::Open((*name).to_owned()),
                Some((_, name)) => Said::Other((*name).to_owned()),
                None => Said::Open(format!("type {code}")),
            },
        }
    }
}

/// The exponent of ordinates, with its sign.
pub(super) fn exponent(bytes: Bytes<'_>, at: usize) -> Result<i32> {
    let code = bytes.count(at, DataType::U8)? as u8;
    Ok(i32::from(code.cast_signed()))
}

/// Axes that are none of a spectrum of light.
const AXES: [(usize, &str); 13] = [
    (4, "time in seconds"),
    (5, "time in minutes"),
    (7, "frequency in kHz"),
    (8, "frequency in MHz"),
    (9, "mass"),
    (10, "parts per million"),
    (13, "a Raman shift"),
    (14, "energy in eV"),
    (16, "numbers of diodes"),
    (17, "numbers of channels"),
    (22, "numbers of points"),
    (27, "a length in cm"),
    (255, "that of an interferogram"),
];
/// What ordinates may be, by their codes.
const VALUES: [(usize, &str); 17] = [
    (0, "arbitrary intensity"),
    (1, "interferogram"),
    (2, "absorbance"),
    (3, "Kubelka-Munk"),
    (4, "counts"),
    (5, "volts"),
    (10, "log(1/R)"),
    (11, "percent"),
    (12, "intensity"),
    (13, "relative intensity"),
    (14, "energy"),
    (22, "index of refraction"),
    (23, "extinction coefficient"),
    (128, "transmission"),
    (130, "single beam"),
    (131, "emission"),
    (255, "reference energy"),
];
/// Those that may be reflectance or emissivity.
const OPEN: [usize; 3] = [0, 11, 131];
