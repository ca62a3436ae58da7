//! One array of a MATLAB file: flags, dimensions and name, then numbers.

use crate::cube::READ_CUBE;
use crate::cube::raw::MAX_INFLATION;
use crate::cube::stored::{Stored, decode_next};
use flate2::read::ZlibDecoder;
use hadar::cube::Sample;
use hadar::error::{Error, Result};
use std::fmt;
use std::io::Read;

/// The type of an element that is an array, and of one that is a zlib stream of one.
pub(super) const MATRIX: u32 = 14;
pub(super) const COMPRESSED: u32 = 15;

/// The longest name and the most dimensions that are looked at, bytes.
const MAX_SHORT: u32 = 4096;

const TOO_LONG: &str = "an array is longer than the element that holds it";

/// The class of an array, as numbered in the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Class(u8);

impl Class {
    const OPAQUE: Self = Self(17);

    pub(super) const fn is_text(self) -> bool {
        self.0 == 4
    }

    pub(super) const fn is_numeric(self) -> bool {
        matches!(self.0, 6..=15)
    }

    /// Whether `f64` is needed to hold what `f32` would round: doubles, and integers of 32 and 64 bits.
    pub(super) const fn is_double(self) -> bool {
        matches!(self.0, 6 | 12..=15)
    }

    pub(super) const fn name(self) -> &'static str {
        match self.0 {
            1 => "cell",
            2 => "struct",
            3 => "object",
            4 => "char",
            5 => "sparse",
            6 => "double",
            7 => "single",
            8 => "int8",
            9 => "uint8",
            10 => "int16",
            11 => "uint16",
            12 => "int32",
            13 => "uint32",
            14 => "int64",
            15 => "uint64",
            16 => "function",
            _ => "object",
        }
    }
}

/// What stands before the numbers of an array.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct Head {
    pub(super) name: String,
    pub(super) class: Option<Class>,
    pub(super) dimensions: Vec<u32>,
    pub(super) complex: bool,
    pub(super) logical: bool,
}

impl Head {
    pub(super) fn class_name(&self) -> String {
        format!("of class {}", self.class.map_or("unknown", Class::name))
    }
}

impl fmt::Display for Head {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sides = self.dimensions.iter().map(u32::to_string).collect::<Vec<_>>().join(" x ");
        let class = if self.logical { "logical" } else { self.class.map_or("unknown", Class::name) };
        let gap = if sides.is_empty() { "" } else { " " };
        write!(f, "`{}` ({sides}{gap}{class})", self.name)
    }
}

/// The content of an array, read from front to back.
#[derive(Debug)]
pub(super) struct Element<R: Read> {
    content: Content<R>,
    /// Bytes that are left, or could be left in a zlib stream.
    left: u64,
    little_endian: bool,
}

#[derive(Debug)]
enum Content<R: Read> {
    Plain(R),
    Zlib(ZlibDecoder<R>),
}

impl<R: Read> Element<R> {
    /// The array in `content`, `len` bytes.
    pub(super) fn of(content: R, compressed: bool, len: u64, little_endian: bool) -> Result<Self> {
        if !compressed {
            return Ok(Self { content: Content::Plain(content), left: len, little_endian });
        }
        let most = len.saturating_mul(MAX_INFLATION);
        let content = Content::Zlib(ZlibDecoder::new(content));
        let mut element = Self { content, left: most, little_endian };
        let [kind, bytes] = element.pair()?;
        if kind != MATRIX {
            let what = if kind == COMPRESSED { "another stream" } else { "something else than an array" };
            return Err(damaged(&format!("a compressed array holds {what}")));
        }
        if u64::from(bytes) > element.left {
            return Err(damaged("a compressed array announces more than its bytes can stand for"));
        }
        element.left = u64::from(bytes);
        Ok(element)
    }

    /// What stands before the numbers.
    pub(super) fn head(&mut self) -> Result<Head> {
        // MATLAB writes an empty element for what it cannot save.
        if self.left == 0 {
            return Ok(Head::default());
        }
        let [kind, len] = self.pair()?;
        if (kind, len) != (6, 8) {
            return Err(damaged("an array does not begin with its flags"));
        }
        let [flags, _] = self.pair()?;
        let class = Some(Class(flags as u8));
        let (complex, logical) = (flags & 0x800 != 0, flags & 0x200 != 0);
        if class == Some(Class::OPAQUE) {
            // An opaque object has its name first and no dimensions.
            let name = self.name()?;
            return Ok(Head { name, class, dimensions: Vec::new(), complex, logical });
        }
        let (kind, bytes) = self.short()?;
        if kind != 5 || bytes.len() % 4 != 0 || bytes.len() < 8 {
            return Err(damaged("an array has no dimensions"));
        }
        let (sides, _) = bytes.as_chunks::<4>();
        let dimensions: Vec<u32> = sides
            .iter()
            .map(
                |side| if self.little_endian { u32::from_le_bytes(*side) } else { u32::from_be_bytes(*side) },
            )
            .collect();
        if dimensions.iter().any(|&side| side > i32::MAX as u32) {
            return Err(damaged("an array has a negative dimension"));
        }
        let name = self.name()?;
        Ok(Head { name, class, dimensions, complex, logical })
    }

    fn name(&mut self) -> Result<String> {
        let (kind, bytes) = self.short()?;
        if !matches!(kind, 1 | 2 | 16) {
            return Err(damaged("an array has no name"));
        }
        Ok(String::from_utf8_lossy(&bytes).into_owned())
    }

    /// The characters of an array of them, which is where they begin; none of a kind that no text has.
    pub(super) fn text(&mut self) -> Option<String> {
        const UTF8: [u32; 3] = [1, 2, 16];
        const UTF16: [u32; 2] = [4, 17];
        let (kind, bytes) = self.short().ok()?;
        if UTF8.contains(&kind) {
            return Some(String::from_utf8_lossy(&bytes).into_owned());
        }
        let (pairs, _) = bytes.as_chunks::<2>();
        let unit = |pair: &[u8; 2]| {
            if self.little_endian { u16::from_le_bytes(*pair) } else { u16::from_be_bytes(*pair) }
        };
        UTF16.contains(&kind).then(|| String::from_utf16_lossy(&pairs.iter().map(unit).collect::<Vec<_>>()))
    }

    /// The tag of `count` numbers, which is where [`Self::fill`] begins.
    pub(super) fn numbers(&mut self, count: u64) -> Result<Stored> {
        let (kind, len, inline) = self.tag()?;
        let stored =
            Stored::of_mat(kind).ok_or_else(|| damaged(&format!("its numbers are of type {kind}")))?;
        let needed = count.checked_mul(stored.size() as u64);
        let left = if inline { 4 } else { self.left };
        if needed != Some(u64::from(len)) || u64::from(len) > left {
            return Err(damaged(&format!("it has {len} bytes of numbers, not {count} numbers")));
        }
        Ok(stored)
    }

    /// The next numbers.
    pub(super) fn fill<S: Sample>(&mut self, stored: Stored, numbers: &mut [S]) -> Result<()> {
        let little_endian = self.little_endian;
        decode_next(|bytes| self.exact(bytes), stored, little_endian, numbers)
    }

    /// Reads a zlib stream to its end, so that its checksum is looked at.
    pub(super) fn finish(&mut self) -> Result<()> {
        let Content::Zlib(stream) = &mut self.content else { return Ok(()) };
        let mut rest = [0; 512];
        // Padding is not always counted; more than that would be unpacked for nothing.
        let mut most = self.left + rest.len() as u64;
        loop {
            match stream.read(&mut rest).map_err(unreadable)? as u64 {
                0 => return Ok(()),
                found => most = most.checked_sub(found).ok_or_else(|| damaged(TOO_LONG))?,
            }
        }
    }

    /// A subelement of few bytes, and its type.
    fn short(&mut self) -> Result<(u32, Vec<u8>)> {
        let (kind, len, inline) = self.tag()?;
        if len > MAX_SHORT {
            return Err(damaged("its name or the list of its dimensions is too long"));
        }
        let padded = if inline { 4 } else { len.next_multiple_of(8) };
        let mut bytes = vec![0; padded as usize];
        self.exact(&mut bytes)?;
        bytes.truncate(len as usize);
        Ok((kind, bytes))
    }

    /// Type and bytes of a subelement; up to four bytes may stand within the tag itself.
    fn tag(&mut self) -> Result<(u32, u32, bool)> {
        let first = self.word()?;
        match first >> 16 {
            0 => Ok((first, self.word()?, false)),
            len @ 1..=4 => Ok((first & 0xffff, len, true)),
            _ => Err(damaged("the tag of a part of it cannot be")),
        }
    }

    fn pair(&mut self) -> Result<[u32; 2]> {
        Ok([self.word()?, self.word()?])
    }

    fn word(&mut self) -> Result<u32> {
        let mut bytes = [0; 4];
        self.exact(&mut bytes)?;
        Ok(if self.little_endian { u32::from_le_bytes(bytes) } else { u32::from_be_bytes(bytes) })
    }

    fn exact(&mut self, bytes: &mut [u8]) -> Result<()> {
        let too_long = || damaged(TOO_LONG);
        self.left = self.left.checked_sub(bytes.len() as u64).ok_or_else(too_long)?;
        match &mut self.content {
            Content::Plain(content) => content.read_exact(bytes),
            Content::Zlib(content) => content.read_exact(bytes),
        }
        .map_err(unreadable)
    }
}

/// Two words of a tag.
pub(super) fn words(tag: [u8; 8], little_endian: bool) -> [u32; 2] {
    let [a, b, c, d, e, f, g, h] = tag;
    [[a, b, c, d], [e, f, g, h]]
        .map(|word| if little_endian { u32::from_le_bytes(word) } else { u32::from_be_bytes(word) })
}

/// Something that no MATLAB writes.
pub(super) fn damaged(found: &str) -> Error {
    Error::malformed(format!("the file is damaged: {found}"), "write or copy it again")
}

/// A file, or a zlib stream in it, that cannot be read on.
pub(super) fn unreadable(error: std::io::Error) -> Error {
    match error.kind() {
        std::io::ErrorKind::UnexpectedEof => damaged("an array ends too early"),
        std::io::ErrorKind::InvalidInput | std::io::ErrorKind::InvalidData => {
            damaged("a compressed array cannot be unpacked")
        }
        _ => Error::File { action: READ_CUBE.to_owned(), reason: error.to_string() },
    }
}
