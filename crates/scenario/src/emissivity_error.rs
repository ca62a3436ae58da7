//! `emissivity_error`: how wrong an emissivity may be, as a share of it or as an absolute number of 1.
//!
//! A library of a cube states shares (δe = s e), everything else absolute numbers (δe = s). In quotes the key says which: `"1 %"` or
//! `"0.01 relative"` is a share everywhere, `"0.01 absolute"` an absolute number everywhere; where the other is computed with, the file is
//! refused instead of read in another sense. A bare number keeps the sense of its table.

use super::section::{Entry, Section};
use hadar::error::{Error, Result};

/// What an error is of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Of {
    /// A share of each emissivity.
    Share,
    /// A number of the range from 0 to 1 of an emissivity.
    Absolute,
}

/// The key of a section that computes with one of the two.
pub(super) fn read(section: &Section<'_>, of: Of) -> Result<Option<f64>> {
    section.read("emissivity_error", |entry| match entry.text("\"1 %\"") {
        Ok(text) => {
            let (own, value) = parsed(entry, text.trim())?;
            if own == of {
                return Ok(value);
            }
            let (found, instead) = match of {
                Of::Share => (
                    "an absolute error",
                    "write a share of each emissivity, e.g. \"1 %\": it is 0.009 where the emissivity is 0.9",
                ),
                Of::Absolute => (
                    "a share of the emissivity",
                    "write an absolute error, e.g. \"0.01 absolute\": 0.01 at any emissivity",
                ),
            };
            Err(entry.fail(Error::malformed(
                format!("`{text}` is {found}, the other is computed with here"),
                instead,
            )))
        }
        Err(_) => entry.number("0.01"),
    })
}

fn parsed(entry: &Entry<'_>, text: &str) -> Result<(Of, f64)> {
    let said = [("%", Of::Share, 0.01), ("relative", Of::Share, 1.0), ("absolute", Of::Absolute, 1.0)];
    let found = said.into_iter().find_map(|(word, of, scale)| {
        let value: f64 = text.strip_suffix(word)?.trim().parse().ok()?;
        Some((of, value * scale))
    });
    match found {
        Some((of, value)) if value > 0.0 && value <= 1.0 => Ok((of, value)),
        Some(_) => Err(entry.fail(Error::malformed(
            format!("`{text}` is out of range"),
            "write an error above 0, of 1 at most, e.g. \"1 %\" or \"0.01 absolute\"",
        ))),
        None => Err(entry.fail(Error::malformed(
            format!("`{text}` does not say what it is of"),
            "write \"1 %\" for a share of each emissivity, \"0.01 absolute\" for a number of 1",
        ))),
    }
}
