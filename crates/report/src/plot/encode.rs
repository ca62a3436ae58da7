//! PNG files (ISO/IEC 15948), written by hand: a header, a palette where the colours fit into one, the pixels, an end.
//!
//! `miniz_oxide` compresses. It is called without an intermediary, since `flate2` changes the compressor with the features that other
//! packages ask of it: the same pixels are the same bytes in every build.

use std::collections::HashMap;
use std::io::Write;

use miniz_oxide::deflate::core::{
    CompressorOxide, TDEFLFlush, TDEFLStatus, compress_to_output, create_comp_flags_from_zip_params,
};

use hadar::Result;
use hadar::error::Error;

/// Red, green and blue.
type Rgb = (u8, u8, u8);

const SIGNATURE: [u8; 8] = [0x89, b'P', b'N', b'G', b'\r', b'\n', 0x1A, b'\n'];
/// Colours that a palette holds.
const MOST: usize = 256;
/// Bytes of compressed pixels in one chunk.
const CHUNK: usize = 1 << 16;
/// Effort of the compressor for whole images, and for those that come row after row.
const LEVEL: i32 = 9;
const LEVEL_BY_ROWS: i32 = 6;

/// An image in memory. Up to 256 colours make a palette, up to 16 of them half a byte a pixel.
pub(super) fn file(pixels: &[Rgb], columns: usize) -> Result<Vec<u8>> {
    let rows = pixels.len().checked_div(columns).unwrap_or(0);
    let mut file = Vec::new();
    let Some(palette) = palette(pixels) else {
        let mut data = Data::begin(&mut file, [rows, columns], Kind::Colours, LEVEL)?;
        for row in pixels.chunks(columns.max(1)) {
            data.row(&flat(row))?;
        }
        data.end()?;
        return Ok(file);
    };
    let places: HashMap<Rgb, u8> = palette.iter().copied().zip(0..=u8::MAX).collect();
    let packed = palette.len() <= 16;
    let kind = Kind::Palette { colours: &palette, packed };
    let mut data = Data::begin(&mut file, [rows, columns], kind, LEVEL)?;
    let (mut last, mut place) = ((0, 0, 0), places.get(&(0, 0, 0)).copied().unwrap_or(0));
    for row in pixels.chunks(columns.max(1)) {
        let indices = row.iter().map(|colour| {
            if *colour != last {
                (last, place) = (*colour, places.get(colour).copied().unwrap_or(0));
            }
            place
        });
        let indices: Vec<u8> = indices.collect();
        if packed {
            let pair = |pair: &[u8]| pair[0] << 4 | pair.get(1).copied().unwrap_or(0);
            data.row(&indices.chunks(2).map(pair).collect::<Vec<u8>>())?;
        } else {
            data.row(&indices)?;
        }
    }
    data.end()?;
    Ok(file)
}

/// An image whose pixels come row after row, whole rows at a time.
pub(super) struct Rows<W: Write> {
    data: Data<W>,
    columns: usize,
}

impl<W: Write> Rows<W> {
    /// Of so many rows and columns.
    pub(super) fn begin(to: W, size: [usize; 2]) -> Result<Self> {
        Ok(Self { data: Data::begin(to, size, Kind::Colours, LEVEL_BY_ROWS)?, columns: size[1] })
    }

    /// The next rows.
    pub(super) fn put(&mut self, pixels: &[Rgb]) -> Result<()> {
        pixels.chunks(self.columns).try_for_each(|row| self.data.row(&flat(row)))
    }

    /// After the last row.
    pub(super) fn end(self) -> Result<()> {
        self.data.end()
    }
}

/// All colours of an image in their order, unless they are too many.
fn palette(pixels: &[Rgb]) -> Option<Vec<Rgb>> {
    let (mut known, mut last) = (HashMap::new(), None);
    for colour in pixels {
        if last != Some(colour) {
            known.insert(*colour, ());
            last = Some(colour);
            if known.len() > MOST {
                return None;
            }
        }
    }
    let mut colours: Vec<Rgb> = known.into_keys().collect();
    colours.sort_unstable();
    Some(colours)
}

fn flat(colours: &[Rgb]) -> Vec<u8> {
    colours.iter().flat_map(|&(r, g, b)| [r, g, b]).collect()
}

/// What a pixel is.
enum Kind<'a> {
    /// Three bytes.
    Colours,
    /// A place among these colours: a byte, or half of one.
    Palette { colours: &'a [Rgb], packed: bool },
}

/// The pixels of a file that is being written.
struct Data<W: Write> {
    to: W,
    compressor: Box<CompressorOxide>,
    /// Compressed, and not yet written.
    held: Vec<u8>,
    rows_left: usize,
    row_bytes: usize,
}

impl<W: Write> Data<W> {
    /// Writes what stands before the pixels.
    fn begin(mut to: W, [rows, columns]: [usize; 2], kind: Kind<'_>, level: i32) -> Result<Self> {
        let side = |side: usize| u32::try_from(side).ok().filter(|side| (1..1 << 31).contains(side));
        let (Some(width), Some(height)) = (side(columns), side(rows)) else {
            return Err(failure(&format!("{rows} x {columns} pixels")));
        };
        let (depth, colour, row_bytes) = match kind {
            Kind::Colours => (8, 2, 3 * columns),
            Kind::Palette { packed: false, .. } => (8, 3, columns),
            Kind::Palette { packed: true, .. } => (4, 3, columns.div_ceil(2)),
        };
        let mut header = [width.to_be_bytes(), height.to_be_bytes()].concat();
        header.extend([depth, colour, 0, 0, 0]);
        to.write_all(&SIGNATURE).map_err(|error| failure(&error))?;
        chunk(&mut to, *b"IHDR", &header)?;
        if let Kind::Palette { colours, .. } = kind {
            chunk(&mut to, *b"PLTE", &flat(colours))?;
        }
        let compressor = Box::new(CompressorOxide::new(create_comp_flags_from_zip_params(level, 15, 0)));
        Ok(Self { to, compressor, held: Vec::new(), rows_left: rows, row_bytes })
    }

    /// The next row. White ground and flat colours: whole rows repeat, which a filter would hide from the compressor.
    fn row(&mut self, bytes: &[u8]) -> Result<()> {
        hadar::stop::check();
        if self.rows_left == 0 || bytes.len() != self.row_bytes {
            return Err(failure(&"more or fewer pixels than the image has"));
        }
        self.rows_left -= 1;
        self.compress(&[0], TDEFLFlush::None)?;
        self.compress(bytes, TDEFLFlush::None)
    }

    fn compress(&mut self, mut bytes: &[u8], flush: TDEFLFlush) -> Result<()> {
        hadar::stop::check();
        loop {
            let held = &mut self.held;
            let (status, used) = compress_to_output(&mut self.compressor, bytes, flush, |out| {
                held.extend_from_slice(out);
                true
            });
            bytes = bytes.get(used..).unwrap_or_default();
            while self.held.len() >= CHUNK {
                let rest = self.held.split_off(CHUNK);
                chunk(&mut self.to, *b"IDAT", &std::mem::replace(&mut self.held, rest))?;
            }
            match status {
                TDEFLStatus::Done => return Ok(()),
                TDEFLStatus::Okay if bytes.is_empty() && flush == TDEFLFlush::None => return Ok(()),
                TDEFLStatus::Okay if used > 0 => {}
                _ => return Err(failure(&"its pixels cannot be compressed")),
            }
        }
    }

    fn end(mut self) -> Result<()> {
        if self.rows_left > 0 {
            return Err(failure(&"fewer pixels than the image has"));
        }
        self.compress(&[], TDEFLFlush::Finish)?;
        chunk(&mut self.to, *b"IDAT", &std::mem::take(&mut self.held))?;
        chunk(&mut self.to, *b"IEND", &[])?;
        self.to.flush().map_err(|error| failure(&error))
    }
}

fn chunk(to: &mut impl Write, kind: [u8; 4], data: &[u8]) -> Result<()> {
    let length = u32::try_from(data.len()).map_err(|error| failure(&error))?;
    let sum = !data.iter().fold(kind.iter().fold(u32::MAX, check), check);
    let parts: [&[u8]; 4] = [&length.to_be_bytes(), &kind, data, &sum.to_be_bytes()];
    parts.iter().try_for_each(|part| to.write_all(part)).map_err(|error| failure(&error))
}

/// The cyclic redundancy check of the format with one more byte.
fn check(sum: u32, byte: &u8) -> u32 {
    const TABLE: [u32; 256] = {
        let mut table = [0; 256];
        let mut i = 0;
        while i < 256 {
            let (mut sum, mut bit) = (i as u32, 0);
            while bit < 8 {
                sum = if sum & 1 == 1 { 0xEDB8_8320 ^ (sum >> 1) } else { sum >> 1 };
                bit += 1;
            }
            table[i] = sum;
            i += 1;
        }
        table
    };
    TABLE[usize::from(sum as u8 ^ byte)] ^ (sum >> 8)
}

fn failure(reason: &impl std::fmt::Display) -> Error {
    Error::malformed(format!("the picture cannot be written ({reason})"), "report this as an error")
}
