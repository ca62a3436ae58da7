//! Objects: connected parts of a map of categories.

use super::categories::{NO_CATEGORY, bit};
use super::groups::{Group, groups};
use hadar::error::Result;
use serde::Serialize;

/// A connected part of a category (pixels that share a side or a corner).
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Object {
    /// The category to which its pixels belong.
    pub category: u8,
    /// Number of pixels of the object.
    pub pixels: usize,
    /// Its first row, and the one after its last.
    pub rows: [usize; 2],
    /// Its first column, and the one after its last.
    pub columns: [usize; 2],
}

/// Objects, the largest first, and which one every pixel is of.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Objects {
    /// What is there.
    pub all: Vec<Object>,
    /// Place among them, `None` for a pixel of no category and of parts that are too small.
    pub of_pixel: Vec<Option<u32>>,
}

/// The connected parts of a map of categories `[row][column]` that have so many pixels at least.
///
/// # Errors
/// A map that is no rectangle of so many columns.
pub fn objects(category: &[u8], columns: usize, smallest: usize) -> Result<Objects> {
    let one_bit = |one: &u8| if *one == NO_CATEGORY { 0 } else { bit(*one) };
    let sets: Vec<u64> = category.iter().map(one_bit).collect();
    let found = groups(&sets, &vec![false; sets.len()], columns, smallest)?;
    let object = |group: Group| Object {
        category: group.possible.trailing_zeros() as u8,
        pixels: group.pixels,
        rows: group.rows,
        columns: group.columns,
    };
    Ok(Objects { all: found.all.into_iter().map(object).collect(), of_pixel: found.of_pixel })
}
