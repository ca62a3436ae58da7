//! That a map is one of whole rows.

use hadar::error::{Error, Result};

/// Whether so many pixels are whole rows of so many columns.
pub(super) fn rectangle(pixels: usize, columns: usize) -> Result<()> {
    match pixels.checked_rem(columns) {
        Some(0) => Ok(()),
        _ if pixels == 0 => Ok(()),
        _ => Err(Error::malformed(
            format!("{pixels} pixels in rows of {columns} columns"),
            "give a map of whole rows",
        )),
    }
}
