//! Sequences of Telops cameras (.hcc).
//!
//! A frame is two lines of header, as wide as the picture, and then its numbers, 16 bits, the least byte first. In the header, from byte 12 on:
//! an offset (f32), an exponent (i8), at 28 the mode of calibration, at 32 and 34 the width and height. A sample is number · 2^exponent + offset: of
//! mode 2 a temperature in K, of mode 3 an in-band radiance in W m⁻² sr⁻¹, of modes 0 and 1 counts of the detector. `variable` names a frame
//! by its number from 0.
//!
//! Source: Telops, HCC image header, as the packages fasthcc (MIT) and ir-telops describe it.

use super::axes::Axes;
use super::choice::one_of_frames;
use super::found::{Found, Opened};
use super::raw::{Raw, read_at};
use super::stored::Stored;
use super::values::{ALL_VALID, Values};
use hadar::cube::Shape;
use hadar::error::{Error, Result};
use std::fs::File;
use std::path::Path;

/// What a frame begins with.
pub(super) const MAGIC: &[u8] = b"TC";
/// Bytes of the header that are read.
const HEAD: usize = 48;
/// Versions of the header that are known.
const VERSIONS: std::ops::RangeInclusive<u8> = 5..=14;

/// Whether a file begins as such a one: two letters alone would be little.
pub(super) fn is_one(start: &[u8]) -> bool {
    let word = |at: usize| start.get(at..at + 2).map_or(0, |pair| u16::from_le_bytes([pair[0], pair[1]]));
    start.starts_with(MAGIC)
        && start.get(3).is_some_and(|major| VERSIONS.contains(major))
        && u32::from(word(4)) <= 4 * u32::from(word(32))
        && word(4) as usize >= HEAD
}

/// Opens a file whose first bytes have been seen.
pub(super) fn open(file: File, path: &Path, name: Option<&str>, axes: Option<Axes>) -> Result<Opened> {
    if let Some(axes) = axes {
        let found = format!("axes = \"{axes}\" of a picture");
        return Err(Error::malformed(found, "leave axes out: it has rows and columns of one band"));
    }
    let len = file.metadata().map_err(damaged)?.len();
    let head = head(&file, path, 0)?;
    let side = |at: usize| usize::from(u16::from_le_bytes([head[at], head[at + 1]]));
    let (columns, rows) = (side(32), side(34));
    let shape = Shape::new(rows, columns, 1)?;
    let before = 4 * columns as u64;
    let frame = before + 2 * (rows * columns) as u64;
    if !len.is_multiple_of(frame) {
        let found = format!("it has {len} bytes, which are no whole number of frames of {frame}");
        return Err(damaged(found));
    }
    let frames = usize::try_from(len / frame).unwrap_or(usize::MAX);
    let number = one_of_frames(name, frames)?;
    let place = number as u64 * frame;
    let own = self::head(&file, path, place)?;
    if own.get(32..36) != head.get(32..36) {
        return Err(damaged(format!("frame {number} has another size than the first")));
    }
    let offset = f64::from(f32::from_le_bytes([own[12], own[13], own[14], own[15]]));
    let gain = f64::from(own[16].cast_signed()).exp2();
    if !offset.is_finite() {
        return Err(damaged(format!("the offset of frame {number} is {offset}")));
    }
    let (gain, offset, unit) = match own[28] {
        2 => (gain, offset, "K"),
        3 => (gain, offset, "W m-2 sr-1"),
        0 | 1 => (1.0, 0.0, "DN"),
        mode => {
            let found = format!("frame {number} is calibrated in a way that is not read (mode {mode})");
            return Err(Error::malformed(found, "write it with calibration mode RT, NUC or raw"));
        }
    };
    let values = Values::new(Some(vec![gain]), Some(vec![offset]), Vec::new(), ALL_VALID);
    let found = Found::array("Telops HCC", shape, "u16", &[rows, columns]);
    let variable = (frames > 1).then(|| number.to_string());
    let mut found = Found { variable, unit: Some(unit.to_owned()), ..found };
    values.iter().for_each(|values| values.tell(&mut found));
    let raw = Raw {
        file,
        path: path.to_owned(),
        shape,
        start: place + before,
        order: Axes::default(),
        stored: Stored::U16,
        little_endian: true,
        values,
    };
    Ok(Opened { cube: raw.cube(), found })
}

/// The header of the frame at a place.
fn head(file: &File, path: &Path, place: u64) -> Result<[u8; HEAD]> {
    let mut head = [0; HEAD];
    read_at(file, path, &mut head, place).map_err(damaged)?;
    if !head.starts_with(MAGIC) {
        return Err(damaged("a frame does not begin with TC"));
    }
    Ok(head)
}

/// A file that cannot be read.
fn damaged(error: impl std::fmt::Display) -> Error {
    Error::malformed(format!("the HCC file cannot be read: {error}"), "copy it again from the camera")
}
