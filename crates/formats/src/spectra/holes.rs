//! Rows of a spectrum that hold exactly 0 where nothing was measured.
//!
//! Tables of many spectra are filled up with 0 where one of them ends, and instruments write 0 for what they did not read. No surface
//! jumps from 0 to a twentieth from one row to the next: such zeros, two or more, are no values. At the ends they are left off, so
//! that bands beyond are asked for in vain; in between they are an error.

use hadar::error::{Error, Result};
use std::ops::Range;

/// From exactly 0 to at least this, of all, no spectrum jumps.
const JUMP: f64 = 0.05;
/// Zeros that are no accident.
const RUN: usize = 2;

/// Rows (place, value) of a spectrum without zeros that fill it up at its ends; `all` is the value that a share is of, such as the largest.
///
/// # Errors
/// Zeros between values where none can be.
pub fn measured(rows: &[(f64, f64)], all: f64) -> Result<&[(f64, f64)]> {
    let values: Vec<f64> = rows.iter().map(|(_, value)| *value).collect();
    let held = without_padding(&values, all);
    match hole(&values, held.clone(), all) {
        Some(hole) => Err(error(&hole)),
        None => Ok(rows.get(held).unwrap_or(rows)),
    }
}

/// What is said of a hole.
pub(super) fn error(hole: &Range<usize>) -> Error {
    let found = format!("{} rows of exactly 0 between values that are not", hole.len());
    Error::malformed(found, "leave rows out where nothing was measured, or write what is there")
}

/// The rows without zeros that fill them up at their ends; all of them where there are none, or nothing else.
pub(super) fn without_padding(values: &[f64], all: f64) -> Range<usize> {
    let zeros = |values: &mut dyn Iterator<Item = &f64>| values.take_while(|value| **value == 0.0).count();
    let (before, after) = (zeros(&mut values.iter()), zeros(&mut values.iter().rev()));
    let jumps =
        |at: Option<usize>| at.and_then(|at| values.get(at)).is_some_and(|value| *value >= JUMP * all);
    let first = if before >= RUN && jumps(Some(before)) { before } else { 0 };
    let last = values.len() - after;
    let last = if after >= RUN && jumps(last.checked_sub(1)) { last } else { values.len() };
    if first < last { first..last } else { 0..values.len() }
}

/// The first run of zeros between rows from which no spectrum falls to 0.
pub(super) fn hole(values: &[f64], within: Range<usize>, all: f64) -> Option<Range<usize>> {
    let mut at = within.start;
    while at < within.end {
        let run = values[at..within.end].iter().take_while(|value| **value == 0.0).count();
        if run >= RUN && at > within.start && at + run < within.end {
            let beside = [values[at - 1], values[at + run]];
            if beside.iter().all(|value| *value >= JUMP * all) {
                return Some(at..at + run);
            }
        }
        at += run.max(1);
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn padding_is_told_from_values_that_fall_to_nothing() {
        assert_eq!(without_padding(&[0.0, 0.0, 0.7, 0.8, 0.0, 0.0, 0.0], 1.0), 2..4);
        assert_eq!(without_padding(&[0.0, 0.7, 0.8, 0.0], 1.0), 0..4);
        assert_eq!(without_padding(&[0.0, 0.0, 0.01, 0.8], 1.0), 0..4);
        assert_eq!(without_padding(&[0.0, 0.0, 0.0], 1.0), 0..3);
        assert_eq!(without_padding(&[], 1.0), 0..0);
        assert_eq!(without_padding(&[0.0, 0.0, 70.0, 80.0], 100.0), 2..4);
    }

    #[test]
    fn a_hole_is_found_between_values() {
        assert_eq!(hole(&[0.7, 0.0, 0.0, 0.8], 0..4, 1.0), Some(1..3));
        assert_eq!(hole(&[0.7, 0.0, 0.8, 0.02, 0.0, 0.0, 0.03], 0..7, 1.0), None);
        assert_eq!(hole(&[0.0, 0.0, 0.8], 2..3, 1.0), None);
    }
}
