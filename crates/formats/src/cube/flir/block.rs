//! A block of records: its readings, and the constants of its camera.

use crate::cube::raw::{MAX_INFLATION, read_at};
use crate::cube::stored::{Stored, decode};
use hadar::error::{Error, Result};
use std::fs::File;
use std::path::PathBuf;

/// What a block begins with.
pub(in crate::cube) const BLOCK: &[u8] = b"FFF\0";
/// Bytes of the head of a block, and of a line of its list.
const HEAD: u64 = 64;
const LINE: u64 = 32;
/// Records that a block may have.
const MOST: u32 = 1000;
/// Bytes before the readings in their record.
const BEFORE: u64 = 32;
/// Bytes up to where the next block is looked for.
pub(super) const GAP: u64 = 1 << 16;
/// By how much the order of bytes that is meant is smoother than the other.
const CLEARLY: f64 = 3.0;
const READINGS: u16 = 1;
const CAMERA: u16 = 0x20;

/// Where the bytes of blocks are.
#[derive(Debug)]
pub(super) enum Bytes {
    Held(Vec<u8>),
    Of { file: File, path: PathBuf, len: u64 },
}

impl Bytes {
    fn len(&self) -> u64 {
        match self {
            Self::Held(bytes) => bytes.len() as u64,
            Self::Of { len, .. } => *len,
        }
    }

    /// So many bytes from a place on.
    fn at(&self, place: u64, count: u64) -> Result<Vec<u8>> {
        let cut = || damaged("it ends within a record");
        if place.checked_add(count).is_none_or(|end| end > self.len()) {
            return Err(cut());
        }
        let count = usize::try_from(count).map_err(|_| cut())?;
        match self {
            Self::Held(bytes) => {
                let rest =
                    usize::try_from(place).ok().and_then(|place| bytes.get(place..)).ok_or_else(cut)?;
                rest.get(..count).map(<[u8]>::to_vec).ok_or_else(cut)
            }
            Self::Of { file, path, .. } => {
                let mut bytes = vec![0; count];
                read_at(file, path, &mut bytes, place).map_err(damaged)?;
                Ok(bytes)
            }
        }
    }
}

/// A block: where its records are.
#[derive(Debug)]
pub(super) struct Block {
    records: Vec<Record>,
    /// The place behind its last record.
    pub(super) end: u64,
}

#[derive(Debug, Clone, Copy)]
struct Record {
    kind: u16,
    place: u64,
    length: u64,
}

/// What the detector read, `[row][column]`.
#[derive(Debug)]
pub(super) struct Readings {
    pub(super) rows: usize,
    pub(super) columns: usize,
    pub(super) numbers: Vec<f64>,
}

/// The constants of a camera.
#[derive(Debug, Clone, Copy)]
pub(super) struct Constants {
    r1: f64,
    r2: f64,
    b_k: f64,
    f: f64,
    o: f64,
}

impl Constants {
    /// What is in proportion to radiance: n + O.
    pub(super) fn offset(&self) -> f64 {
        self.o
    }

    /// T = B / ln(R1/(R2 (n + O)) + F), K; no number where no blackbody is read so.
    pub(super) fn temperature_k(&self, reading: f64) -> f64 {
        let inner = self.r1 / (self.r2 * (reading + self.o)) + self.f;
        let temperature_k = self.b_k / inner.ln();
        if temperature_k > 0.0 && temperature_k.is_finite() && inner > 1.0 { temperature_k } else { f64::NAN }
    }
}

impl Block {
    /// Where the next block begins, from a place on.
    pub(super) fn next(bytes: &Bytes, place: u64) -> Result<Option<u64>> {
        let head = BLOCK.len() as u64;
        if bytes.len().saturating_sub(place) >= head && bytes.at(place, head)? == BLOCK {
            return Ok(Some(place));
        }
        let count = GAP.min(bytes.len().saturating_sub(place));
        let window = bytes.at(place, count)?;
        let found = window.windows(BLOCK.len()).position(|bytes| bytes == BLOCK);
        Ok(found.map(|at| place + at as u64))
    }

    /// The list of the records of the block that begins at a place.
    pub(super) fn read(bytes: &Bytes, start: u64) -> Result<Self> {
        let head = bytes.at(start, HEAD)?;
        if !matches!(head.get(..4), Some(b"FFF\0" | b"AFF\0")) {
            return Err(damaged("its block does not begin with FFF"));
        }
        // The version, 100 to 199, says the order of its bytes.
        let version = |little_endian| u32_at(&head, 0x14, little_endian).unwrap_or(0);
        let little_endian =
            match [true, false].into_iter().find(|order| (100..200).contains(&version(*order))) {
                Some(order) => order,
                None => return Err(damaged(format!("a block of the version {}", version(true)))),
            };
        let number = |bytes: &[u8], at: usize| u32_at(bytes, at, little_endian).unwrap_or(0);
        let (list, count) = (u64::from(number(&head, 0x18)), number(&head, 0x1c));
        if count > MOST {
            return Err(damaged(format!("a block of {count} records")));
        }
        let lines = bytes.at(start.saturating_add(list), u64::from(count) * LINE)?;
        let listed = list.saturating_add(u64::from(count) * LINE);
        let mut block = Self { records: Vec::new(), end: start.saturating_add(listed.max(HEAD)) };
        for line in lines.chunks_exact(LINE as usize) {
            let kind = u16_at(line, 0, little_endian).unwrap_or(0);
            let (place, length) = (u64::from(number(line, 0x0c)), u64::from(number(line, 0x10)));
            // Free lines have no kind.
            if kind == 0 || length == 0 {
                continue;
            }
            let record = Record { kind, place: start.saturating_add(place), length };
            block.end = block.end.max(record.place.saturating_add(length));
            block.records.push(record);
        }
        Ok(block)
    }

    fn record(&self, kind: u16, bytes: &Bytes) -> Result<Vec<u8>> {
        let record = self.records.iter().find(|record| record.kind == kind).ok_or_else(|| {
            let what = if kind == READINGS { "readings" } else { "constants of a camera" };
            damaged(format!("it has no {what}"))
        })?;
        bytes.at(record.place, record.length)
    }

    pub(super) fn readings(&self, bytes: &Bytes) -> Result<Readings> {
        let record = self.record(READINGS, bytes)?;
        let little_endian = order_of(&record)?;
        let side = |at: usize| usize::from(u16_at(&record, at, little_endian).unwrap_or(0));
        let (columns, rows) = (side(2), side(4));
        let content = record.get(BEFORE as usize..).unwrap_or_default();
        let numbers = match content {
            [0x89, b'P', b'N', b'G', ..] => of_png(content, rows, columns)?,
            [0xff, 0xd8, ..] => {
                return Err(Error::malformed(
                    "its readings are packed as JPEG-LS, as in a CSQ file",
                    "write it as SEQ or as radiometric JPEG pictures with FLIR's own program",
                ));
            }
            _ => {
                let count = rows * columns;
                let plain = content.get(..2 * count).ok_or_else(|| damaged("it ends within its readings"))?;
                let mut numbers = vec![0.0; count];
                decode(plain, Stored::U16, little_endian, &mut numbers);
                numbers
            }
        };
        Ok(Readings { rows, columns, numbers })
    }

    pub(super) fn camera(&self, bytes: &Bytes) -> Result<Constants> {
        let record = self.record(CAMERA, bytes)?;
        let little_endian = order_of(&record)?;
        let word = |at: usize| u32_at(&record, at, little_endian);
        let float = |at: usize| word(at).map_or(f64::NAN, |bits| f64::from(f32::from_bits(bits)));
        let offset = word(0x308).map_or(f64::NAN, |bits| f64::from(bits.cast_signed()));
        let constants =
            Constants { r1: float(0x58), b_k: float(0x5c), f: float(0x60), o: offset, r2: float(0x30c) };
        let Constants { r1, r2, b_k, f, o } = constants;
        // B is hc/(kλ) of the middle of the band: 14 388 µm K by 2 to 20 µm.
        if !(700.0..8000.0).contains(&b_k) {
            return Err(damaged(format!(
                "its constant B is {b_k} K, of a camera that sees at {:.2} um",
                14387.8 / b_k
            )));
        }
        if [r1, r2, b_k].iter().any(|one| !(*one > 0.0 && one.is_finite()))
            || !f.is_finite()
            || !o.is_finite()
        {
            return Err(damaged(format!(
                "its constants are R1 = {r1}, R2 = {r2}, B = {b_k}, F = {f}, O = {o}"
            )));
        }
        Ok(constants)
    }
}

/// The numbers of a PNG picture, whose bytes most cameras write in the other order than PNG has them.
fn of_png(png: &[u8], rows: usize, columns: usize) -> Result<Vec<f64>> {
    let mut reader = png::Decoder::new(png).read_info().map_err(damaged)?;
    let info = reader.info();
    let is_such = (info.color_type, info.bit_depth) == (png::ColorType::Grayscale, png::BitDepth::Sixteen);
    if (info.width as usize, info.height as usize) != (columns, rows) || !is_such {
        return Err(damaged("the picture of its readings is no grey one of 16 bits and their size"));
    }
    if (2 * rows * columns) as u64 > (png.len() as u64).saturating_mul(MAX_INFLATION) {
        return Err(damaged("it announces more readings than it can stand for"));
    }
    let mut bytes = vec![0; 2 * rows * columns];
    reader.next_frame(&mut bytes).map_err(damaged)?;
    let numbers = |little_endian| {
        let mut numbers = vec![0.0; rows * columns];
        decode(&bytes, Stored::U16, little_endian, &mut numbers);
        numbers
    };
    // Neighbours are alike in the order that is meant: their greater bytes change less.
    let uneven = |numbers: &[f64]| numbers.windows(2).map(|pair| (pair[1] - pair[0]).abs()).sum::<f64>();
    let [little, big] = [numbers(true), numbers(false)];
    match (uneven(&little), uneven(&big)) {
        (own, other) if own < other && CLEARLY * own <= other => Ok(little),
        (other, own) if own < other && CLEARLY * own <= other => Ok(big),
        _ => Err(Error::malformed(
            "its readings are a PNG picture of which neither order of bytes is the smoother one by far",
            "write them as 16-bit TIFF with FLIR's own program",
        )),
    }
}

/// The order of bytes in a record, whose first number is small.
fn order_of(record: &[u8]) -> Result<bool> {
    match record.first_chunk::<2>() {
        Some(number) => Ok(u16::from_le_bytes(*number) < 0x100),
        None => Err(damaged("a record is empty")),
    }
}

fn u16_at(bytes: &[u8], at: usize, little_endian: bool) -> Option<u16> {
    let word = *bytes.get(at..)?.first_chunk::<2>()?;
    Some(if little_endian { u16::from_le_bytes(word) } else { u16::from_be_bytes(word) })
}

fn u32_at(bytes: &[u8], at: usize, little_endian: bool) -> Option<u32> {
    let word = *bytes.get(at..)?.first_chunk::<4>()?;
    Some(if little_endian { u32::from_le_bytes(word) } else { u32::from_be_bytes(word) })
}

/// A file that cannot be read.
pub(super) fn damaged(error: impl std::fmt::Display) -> Error {
    Error::malformed(format!("the radiometric file cannot be read: {error}"), "copy it again from the camera")
}
