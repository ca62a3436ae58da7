//! Radiometric files of FLIR's cameras: JPEG pictures with what the detector read, FFF, and sequences of them (SEQ).
//!
//! A block begins with `FFF`, and lists records with their kind, place and length: the readings (kind 1) as 16-bit numbers or a PNG
//! picture of them, and the camera (kind 0x20) with the constants R1, R2, B, F and O of its calibration,
//!
//!   n + O = R1 / (R2 (exp(B/T) − F)),      T = B / ln(R1/(R2 (n + O)) + F):
//!
//! T is the temperature of a blackbody that is read as n, K. In a JPEG the block stands in pieces, in APP1 segments that begin with `FLIR`.
//! The arrays of a file are `signal` (n + O, which is in proportion to radiance) and `temperature` (T, of the radiance as it arrives: what the
//! camera was told of emissivity, air and surroundings is not used); of a sequence `signal[0]`, `temperature[0]` and so on.
//!
//! Sources: tags of ExifTool ('FLIR Tags', P. Harvey), FLIR's A3xx/A6xx streaming format.

mod block;

pub(super) use self::block::BLOCK;
use self::block::{Block, Bytes, damaged};
use super::axes::Axes;
use super::found::{Found, Opened};
use super::image::Image;
use super::stored::Stored;
use super::values::{ALL_VALID, Values};
use hadar::error::{Error, Result};
use std::fs::File;
use std::path::Path;

/// What a JPEG picture and a segment with a part of a block begin with.
pub(super) const JPEG: &[u8] = b"\xff\xd8\xff";
const SEGMENT: &[u8] = b"FLIR\0";
/// Longest picture, bytes.
const LONGEST: u64 = 1 << 28;
/// Frames that are counted.
const MOST: usize = 1_000_000;

const SIGNAL: &str = "signal";
const TEMPERATURE: &str = "temperature";

/// Opens a JPEG picture.
pub(super) fn open_jpeg(file: File, path: &Path, name: Option<&str>, axes: Option<Axes>) -> Result<Opened> {
    let len = file.metadata().map_err(damaged)?.len();
    if len > LONGEST {
        return Err(damaged("it is longer than any picture"));
    }
    let mut bytes = vec![0; usize::try_from(len).unwrap_or(0)];
    super::raw::read_at(&file, path, &mut bytes, 0).map_err(damaged)?;
    let block = assembled(&bytes)?;
    if block.is_empty() {
        return Err(Error::malformed(
            "this is a JPEG picture without radiometry: its colours say no temperature",
            "take the radiometric file of the camera (R-JPEG of FLIR, SEQ or FFF; for other makers their 16-bit TIFF), not an export or a screenshot",
        ));
    }
    frame("FLIR radiometric JPEG", Bytes::Held(block), &[0], name, axes)
}

/// Opens a block, or a sequence of them.
pub(super) fn open(file: File, path: &Path, name: Option<&str>, axes: Option<Axes>) -> Result<Opened> {
    let len = file.metadata().map_err(damaged)?.len();
    let bytes = Bytes::Of { file, path: path.to_owned(), len };
    let mut starts = Vec::new();
    let mut place = 0;
    while place < len && starts.len() < MOST {
        let Some(start) = Block::next(&bytes, place)? else {
            // What is behind the last frame is short; more may be frames that are not found.
            if len - place > block::GAP {
                let found = format!("{} bytes behind frame {} are no frame", len - place, starts.len());
                return Err(damaged(found));
            }
            break;
        };
        place = Block::read(&bytes, start)?.end;
        starts.push(start);
    }
    let format = if starts.len() > 1 { "FLIR SEQ" } else { "FLIR FFF" };
    frame(format, bytes, &starts, name, axes)
}

/// One of the frames, the first unless another is named.
fn frame(
    format: &'static str,
    bytes: Bytes,
    starts: &[u64],
    name: Option<&str>,
    axes: Option<Axes>,
) -> Result<Opened> {
    if let Some(axes) = axes {
        let found = format!("axes = \"{axes}\" of a picture");
        return Err(Error::malformed(found, "leave axes out: it has rows and columns of one band"));
    }
    let (what, number) = asked(name, starts.len())?;
    let start = starts.get(number).copied().unwrap_or(0);
    let block = Block::read(&bytes, start)?;
    let readings = block.readings(&bytes)?;
    let sides = [readings.rows, readings.columns];
    let shape = Axes::default().shape(&sides)?;
    let camera = block.camera(&bytes)?;
    let mut values = None;
    let (numbers, stored, unit) = match what {
        SIGNAL => {
            values = Values::new(None, Some(vec![camera.offset()]), Vec::new(), ALL_VALID);
            (readings.numbers, Stored::U16, "DN")
        }
        _ => {
            let kelvin = readings.numbers.iter().map(|number| camera.temperature_k(*number)).collect();
            (kelvin, Stored::F64, "K")
        }
    };
    let image = Image { format, shape, order: Axes::default(), stored, numbers, values };
    let opened = image.opened(&sides)?;
    let variable = if starts.len() > 1 { format!("{what}[{number}]") } else { what.to_owned() };
    let found = Found { variable: Some(variable), unit: Some(unit.to_owned()), ..opened.found };
    Ok(Opened { found, ..opened })
}

/// What is asked for, and of which frame.
fn asked(name: Option<&str>, frames: usize) -> Result<(&'static str, usize)> {
    let asked = |name: &str| {
        let what = [SIGNAL, TEMPERATURE].into_iter().find(|what| name.starts_with(what))?;
        let rest = name.strip_prefix(what)?;
        let number = match rest {
            "" if frames <= 1 => Some(0),
            _ if frames <= 1 => None,
            _ => rest.strip_prefix('[')?.strip_suffix(']')?.parse().ok(),
        };
        number.filter(|number| *number < frames.max(1)).map(|number| (what, number))
    };
    let last = frames.saturating_sub(1);
    match name {
        None if frames <= 1 => Ok((SIGNAL, 0)),
        None => Err(Error::malformed(
            format!("the file has {frames} frames"),
            format!("name one as the variable, as in \"{SIGNAL}[0]\" or \"{TEMPERATURE}[{last}]\""),
        )),
        Some(name) => asked(name).ok_or_else(|| {
            let known = match frames {
                0 | 1 => format!("`{SIGNAL}` and `{TEMPERATURE}`"),
                _ => format!(
                    "`{SIGNAL}[0]` to `{SIGNAL}[{last}]`, and `{TEMPERATURE}[0]` to `{TEMPERATURE}[{last}]`"
                ),
            };
            Error::malformed(
                format!("there is no variable `{}`", name.escape_debug()),
                format!("the file has {known}"),
            )
        }),
    }
}

/// The block that stands in the segments of a picture, put together by their numbers; empty where there is none.
fn assembled(jpeg: &[u8]) -> Result<Vec<u8>> {
    let mut parts: Vec<(u8, &[u8])> = Vec::new();
    let mut rest = jpeg.get(2..).unwrap_or_default();
    while let [0xff, marker, after @ ..] = rest {
        // Fill bytes, and what has no length; the picture itself begins with SOS.
        match marker {
            0xff => rest = rest.get(1..).unwrap_or_default(),
            0x01 | 0xd0..=0xd8 => rest = after,
            0xd9 | 0xda => break,
            _ => {
                let Some((length, _)) = after.split_first_chunk::<2>() else { break };
                let length = usize::from(u16::from_be_bytes(*length));
                let Some((segment, after)) = after.split_at_checked(length) else {
                    return Err(damaged("it ends within a segment"));
                };
                let content = segment.get(2..).unwrap_or_default();
                if let (0xe1, Some([_, number, last, part @ ..])) = (*marker, content.strip_prefix(SEGMENT)) {
                    if number > last {
                        return Err(damaged("a part of its radiometry has a number beyond the last"));
                    }
                    parts.push((*number, part));
                    if parts.len() > 1 + usize::from(*last) {
                        return Err(damaged("a part of its radiometry is there twice"));
                    }
                }
                rest = after;
            }
        }
    }
    parts.sort_by_key(|(number, _)| *number);
    for (due, (number, _)) in parts.iter().enumerate() {
        if usize::from(*number) != due {
            return Err(damaged("a part of its radiometry is missing or there twice"));
        }
    }
    Ok(parts.into_iter().flat_map(|(_, part)| part.iter().copied()).collect())
}
