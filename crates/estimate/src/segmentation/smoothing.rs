//! The commonest category of every pixel's surroundings.
//!
//! 5 × 5 pixels, the image mirrored at its edges (its outermost row twice), as Algorithm 4 has it. Of categories that are equally common
//! the pixel's own counts, else the first; [`NO_CATEGORY`] counts like any other, and as the last.

use super::categories::NO_CATEGORY;
use super::rectangle::rectangle;
use hadar::error::Result;
use rayon::prelude::*;

/// From the middle of the window to its edge.
const REACH: usize = 2;
/// Pixels of the window.
const WINDOW: usize = (2 * REACH + 1) * (2 * REACH + 1);

/// A map of categories `[row][column]`, smoothed.
///
/// # Errors
/// A map that is no rectangle of so many columns.
pub fn smoothed(category: &[u8], columns: usize) -> Result<Vec<u8>> {
    rectangle(category.len(), columns)?;
    if category.is_empty() {
        return Ok(Vec::new());
    }
    let rows = category.len() / columns;
    let mirrored = |at: isize, length: usize| {
        let length = length as isize;
        let at = at.rem_euclid(2 * length);
        at.min(2 * length - 1 - at) as usize
    };
    let reach = REACH as isize;
    let mut out = vec![0; category.len()];
    out.par_chunks_mut(columns).enumerate().for_each(|(row, out)| {
        hadar::stop::check();
        // The rows of the window, each with its mirrored ends.
        let padded: Vec<Vec<u8>> = (-reach..=reach)
            .map(|down| {
                let from = mirrored(row as isize + down, rows) * columns;
                (-reach..columns as isize + reach)
                    .map(|across| category[from + mirrored(across, columns)])
                    .collect()
            })
            .collect();
        for (column, out) in out.iter_mut().enumerate() {
            let own = padded[REACH][column + REACH];
            let window = padded.iter().flat_map(|row| &row[column..=column + 2 * REACH]);
            let same = window.clone().filter(|one| **one == own).count();
            *out = if 2 * same > WINDOW { own } else { commonest(window, own) };
        }
    });
    Ok(out)
}

fn commonest<'a>(window: impl Iterator<Item = &'a u8>, own: u8) -> u8 {
    let mut counts = [0_u8; NO_CATEGORY as usize + 1];
    let mut most = 0;
    let mut seen = [0_u8; WINDOW];
    for (place, one) in window.enumerate() {
        counts[usize::from(*one)] += 1;
        most = most.max(counts[usize::from(*one)]);
        seen[place] = *one;
    }
    if counts[usize::from(own)] == most {
        return own;
    }
    seen.into_iter().filter(|one| counts[usize::from(*one)] == most).min().unwrap_or(own)
}
