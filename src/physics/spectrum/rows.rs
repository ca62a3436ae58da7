//! Rows of ascending wavenumber.

use crate::error::{Error, Result};

/// Refuses a wavenumber that comes twice in `what`.
pub(super) fn distinct(ascending: impl Iterator<Item = f64>, what: &str) -> Result<()> {
    let mut last = f64::NAN;
    for value in ascending {
        if value == last {
            return Err(Error::malformed(
                format!("wavenumber {value} cm^-1 comes twice in {what}"),
                "keep one of the rows",
            ));
        }
        last = value;
    }
    Ok(())
}

/// The value at x on straight lines between rows of ascending x; beyond them that of the last one.
#[must_use]
pub fn interpolated(xs: &[f64], ys: &[f64], x: f64) -> f64 {
    let right = xs.partition_point(|&row| row < x);
    match (xs.get(right), ys.get(right)) {
        (Some(&row), Some(&value)) if row == x || right == 0 => value,
        (Some(&high), Some(&value_high)) => {
            let (low, value_low) = (xs[right - 1], ys[right - 1]);
            value_low + (value_high - value_low) * ((x - low) / (high - low))
        }
        _ => ys.last().copied().unwrap_or(0.0),
    }
}
