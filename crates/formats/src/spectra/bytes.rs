//! Numbers and text at places in a file of bytes. None that reaches beyond the end is taken: the file is damaged.

use crate::envi_header::{ByteOrder, DataType};
use hadar::error::{Error, Result};

/// What to do with a file that is damaged.
pub(super) const FETCH_AGAIN: &str = "fetch the file again: it is cut short or damaged";

/// The bytes of a file and which byte of a number comes first.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bytes<'a> {
    pub(super) all: &'a [u8],
    pub(super) order: ByteOrder,
}

impl Bytes<'_> {
    /// The bytes from `at` on, `count` of them.
    pub(super) fn part(&self, at: usize, count: usize) -> Result<&[u8]> {
        let part = at.checked_add(count).and_then(|end| self.all.get(at..end));
        part.ok_or_else(|| {
            let found =
                format!("the file ends at byte {} where {count} are announced from {at} on", self.all.len());
            Error::malformed(found, FETCH_AGAIN)
        })
    }

    /// Numbers that stand one behind the other.
    pub(super) fn numbers(&self, at: usize, count: usize, kind: DataType) -> Result<Vec<f64>> {
        let bytes = count.saturating_mul(kind.size());
        Ok(kind.samples(self.part(at, bytes)?, self.order))
    }

    /// One number.
    pub(super) fn number(&self, at: usize, kind: DataType) -> Result<f64> {
        Ok(self.numbers(at, 1, kind)?.first().copied().unwrap_or(f64::NAN))
    }

    /// One number that counts or is a place.
    pub(super) fn count(&self, at: usize, kind: DataType) -> Result<usize> {
        let number = self.number(at, kind)?;
        if number >= 0.0 && number.fract() == 0.0 && number <= f64::from(u32::MAX) {
            return Ok(number as usize);
        }
        Err(Error::malformed(format!("{number} at byte {at} where a count is due"), FETCH_AGAIN))
    }

    /// Whether the number is of these bits.
    pub(super) fn has(&self, at: usize, bits: u8) -> Result<bool> {
        Ok(self.part(at, 1)?.iter().any(|byte| byte & bits != 0))
    }

    /// Text of at most this many bytes, up to the first that is 0.
    pub(super) fn text(&self, at: usize, most: usize) -> Result<String> {
        let part = self.part(at, most)?;
        Ok(part.iter().take_while(|byte| **byte != 0).map(|byte| char::from(*byte)).collect())
    }
}
