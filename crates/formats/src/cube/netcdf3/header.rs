//! The header of a classic NetCDF file.

use crate::cube::attributes::{Attribute, Attributes};
use crate::cube::raw::read_at;
use crate::cube::stored::{Stored, decode};
use hadar::error::{Error, Result};
use std::fs::File;
use std::path::Path;

/// What files of this kind begin with, before a byte of the version.
pub(in crate::cube) const MAGIC: &[u8] = b"CDF";
/// Longest header that is read, bytes.
const LONGEST: u64 = 1 << 24;
/// Tags of lists.
const DIMENSIONS: u32 = 10;
const VARIABLES: u32 = 11;
const ATTRIBUTES: u32 = 12;
/// Text, one byte a letter.
const CHAR: u32 = 2;

/// What a file says of its numbers.
#[derive(Debug)]
pub(super) struct Header {
    /// Of the file as a whole.
    pub(super) attributes: Attributes,
    /// Names and lengths; the unlimited one has the number of records.
    dimensions: Vec<(String, usize)>,
    /// Which of them is unlimited.
    unlimited: Option<usize>,
    pub(super) variables: Vec<Variable>,
    /// From one record to the next, bytes.
    pub(super) record_bytes: u64,
}

/// An array of a file.
#[derive(Debug)]
pub(super) struct Variable {
    pub(super) name: String,
    /// Places of its dimensions in the list, outermost first.
    pub(super) dimensions: Vec<usize>,
    pub(super) attributes: Attributes,
    kind: u32,
    pub(super) begin: u64,
}

impl Variable {
    /// What is there where nothing was written and nothing else is said: NetCDF's own numbers.
    pub(super) fn filled(&self) -> Option<f64> {
        let said = ["_FillValue", "missing_value"].iter().any(|key| self.attributes.says(key));
        match self.stored() {
            Some(Stored::I16) if !said => Some(-32767.0),
            Some(Stored::I32) if !said => Some(-2_147_483_647.0),
            _ => None,
        }
    }

    /// How its numbers are stored; none of text.
    pub(super) fn stored(&self) -> Option<Stored> {
        stored(self.kind).map(|stored| self.attributes.stored(stored))
    }
}

const fn stored(kind: u32) -> Option<Stored> {
    Some(match kind {
        1 => Stored::I8,
        3 => Stored::I16,
        4 => Stored::I32,
        5 => Stored::F32,
        6 => Stored::F64,
        7 => Stored::U8,
        8 => Stored::U16,
        9 => Stored::U32,
        10 => Stored::I64,
        11 => Stored::U64,
        _ => return None,
    })
}

impl Header {
    pub(super) fn read(file: &File, path: &Path, len: u64) -> Result<Self> {
        let mut bytes = vec![0; usize::try_from(len.min(LONGEST)).unwrap_or(0)];
        read_at(file, path, &mut bytes, 0).map_err(damaged)?;
        let version = bytes.get(MAGIC.len()).copied().unwrap_or(0);
        if !matches!(version, 1 | 2 | 5) {
            return Err(damaged(format!("its version is {version}, which is none of 1, 2 and 5")));
        }
        let mut reader = Reader {
            rest: bytes.get(4..).unwrap_or_default(),
            wide: version == 5,
            wide_places: version != 1,
        };
        let records = reader.count()?;
        let mut dimensions: Vec<(String, usize)> = reader.list(DIMENSIONS, |reader| {
            Ok((reader.name()?, usize::try_from(reader.count()?).unwrap_or(usize::MAX)))
        })?;
        let unlimited = dimensions.iter().position(|(_, length)| *length == 0);
        let attributes = reader.attributes()?;
        let variables = reader.list(VARIABLES, Reader::variable)?;
        if variables.iter().flat_map(|variable| &variable.dimensions).any(|place| *place >= dimensions.len())
        {
            return Err(damaged("a variable has a dimension that is not there"));
        }
        let mut header = Self { attributes, dimensions: Vec::new(), unlimited, variables, record_bytes: 0 };
        let of_records: Vec<&Variable> =
            header.variables.iter().filter(|variable| header.is_record(variable)).collect();
        let slice = |variable: &Variable| {
            let size = stored(variable.kind).map_or(1, Stored::size) as u64;
            let sides = variable
                .dimensions
                .iter()
                .skip(1)
                .map(|place| dimensions.get(*place).map_or(0, |(_, side)| *side));
            sides.fold(size, |bytes, side| bytes.saturating_mul(side as u64))
        };
        // Slices end at a multiple of four bytes, but where they are the only ones.
        let record_bytes = match of_records.as_slice() {
            [only] => slice(only),
            many => many.iter().map(|one| slice(one).next_multiple_of(4)).fold(0, u64::saturating_add),
        };
        if let Some((_, length)) = unlimited.and_then(|place| dimensions.get_mut(place)) {
            // While it is written, a file may leave the number open.
            let open = if version == 5 { u64::MAX } else { u64::from(u32::MAX) };
            let begin = of_records.iter().map(|variable| variable.begin).min().unwrap_or(len);
            let held = len.saturating_sub(begin).checked_div(record_bytes).unwrap_or(0);
            let records = if records == open { held } else { records };
            *length = usize::try_from(records).unwrap_or(usize::MAX);
        }
        header.dimensions = dimensions;
        header.record_bytes = record_bytes;
        Ok(header)
    }

    /// Whether a variable is along the unlimited dimension.
    pub(super) fn is_record(&self, variable: &Variable) -> bool {
        self.unlimited.is_some() && variable.dimensions.first().copied() == self.unlimited
    }

    /// Lengths of the dimensions of a variable.
    pub(super) fn sides(&self, variable: &Variable) -> Vec<usize> {
        let side = |place: &usize| self.dimensions.get(*place).map_or(0, |(_, length)| *length);
        variable.dimensions.iter().map(side).collect()
    }

    /// The name of a dimension of a variable.
    pub(super) fn dimension(&self, variable: &Variable, place: usize) -> &str {
        let named = variable.dimensions.get(place).and_then(|place| self.dimensions.get(*place));
        named.map_or("", |(name, _)| name)
    }
}

/// Reads what follows.
struct Reader<'a> {
    rest: &'a [u8],
    /// Whether counts have eight bytes, and places.
    wide: bool,
    wide_places: bool,
}

impl<'a> Reader<'a> {
    fn bytes(&mut self, count: u64) -> Result<&'a [u8]> {
        let count = usize::try_from(count).unwrap_or(usize::MAX);
        let (bytes, rest) =
            self.rest.split_at_checked(count).ok_or_else(|| damaged("it ends within its header"))?;
        self.rest = rest;
        Ok(bytes)
    }

    /// Bytes that are filled up to a multiple of four.
    fn padded(&mut self, count: u64) -> Result<&'a [u8]> {
        let bytes = self.bytes(count)?;
        self.bytes(count.next_multiple_of(4) - count)?;
        Ok(bytes)
    }

    fn word(&mut self) -> Result<u32> {
        let bytes = self.bytes(4)?;
        Ok(bytes.first_chunk().map_or(0, |word| u32::from_be_bytes(*word)))
    }

    fn wide(&mut self, wide: bool) -> Result<u64> {
        if !wide {
            return self.word().map(u64::from);
        }
        let bytes = self.bytes(8)?;
        Ok(bytes.first_chunk().map_or(0, |word| u64::from_be_bytes(*word)))
    }

    fn count(&mut self) -> Result<u64> {
        self.wide(self.wide)
    }

    fn name(&mut self) -> Result<String> {
        let length = self.count()?;
        Ok(String::from_utf8_lossy(self.padded(length)?).into_owned())
    }

    /// A list with its tag, or two zeros for none.
    fn list<T>(&mut self, tag: u32, one: impl Fn(&mut Self) -> Result<T>) -> Result<Vec<T>> {
        let (found, count) = (self.word()?, self.count()?);
        if found != tag && (found, count) != (0, 0) {
            return Err(damaged(format!("a list has the tag {found} where {tag} is due")));
        }
        // No more than there are bytes of.
        let mut items = Vec::new();
        for _ in 0..count {
            items.push(one(self)?);
        }
        Ok(items)
    }

    fn attributes(&mut self) -> Result<Attributes> {
        let all = self.list(ATTRIBUTES, |reader| {
            let name = reader.name()?;
            let (kind, count) = (reader.word()?, reader.count()?);
            if kind == CHAR {
                let text = String::from_utf8_lossy(reader.padded(count)?);
                return Ok((name, Attribute::Text(text.trim_end_matches('\0').to_owned())));
            }
            let Some(stored) = stored(kind) else {
                return Err(damaged(format!("an attribute has the type {kind}")).for_key(name));
            };
            let bytes = reader.padded(count.saturating_mul(stored.size() as u64))?;
            let mut numbers = vec![0.0_f64; bytes.len() / stored.size()];
            decode(bytes, stored, false, &mut numbers);
            let is_floating = matches!(stored, Stored::F32 | Stored::F64);
            Ok((name, if is_floating { Attribute::Floating(numbers) } else { Attribute::Whole(numbers) }))
        })?;
        Ok(Attributes::of(all))
    }

    fn variable(&mut self) -> Result<Variable> {
        let name = self.name()?;
        let mut dimensions = Vec::new();
        for _ in 0..self.count()? {
            dimensions.push(usize::try_from(self.count()?).unwrap_or(usize::MAX));
        }
        let attributes = self.attributes()?;
        let kind = self.word()?;
        // Of large variables the size that is written is no size: it is not used.
        self.count()?;
        let begin = self.wide(self.wide_places)?;
        Ok(Variable { name, dimensions, attributes, kind, begin })
    }
}

/// A file that cannot be read.
pub(super) fn damaged(error: impl std::fmt::Display) -> Error {
    Error::malformed(format!("the NetCDF file cannot be read: {error}"), "write or copy it again")
}
