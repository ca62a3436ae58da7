//! Objects: connected parts of a map of categories.

use super::categories::NO_CATEGORY;
use super::components::{NO_PART, Neighbours, components};
use super::rectangle::rectangle;
use hadar::error::Result;
use serde::Serialize;

/// A connected part of a category (pixels that share a side or a corner).
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Object {
    /// Its category.
    pub category: u8,
    /// Its pixels.
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
    rectangle(category.len(), columns)?;
    let value = |i: usize| Some(category[i]).filter(|one| *one != NO_CATEGORY);
    let (part, count) = components(category.len(), columns, Neighbours::Eight, value);
    let mut parts: Vec<Option<Object>> = vec![None; count];
    for (i, part) in part.iter().enumerate().filter(|(_, part)| **part != NO_PART) {
        let (row, column) = (i / columns, i % columns);
        let object = parts[*part as usize].get_or_insert(Object {
            category: category[i],
            pixels: 0,
            rows: [row, row + 1],
            columns: [column, column + 1],
        });
        object.pixels += 1;
        object.rows[1] = row + 1;
        object.columns = [object.columns[0].min(column), object.columns[1].max(column + 1)];
    }
    let mut kept: Vec<(usize, Object)> = parts
        .into_iter()
        .enumerate()
        .filter_map(|(place, object)| Some((place, object.filter(|one| one.pixels >= smallest)?)))
        .collect();
    kept.sort_by_key(|(place, object)| (std::cmp::Reverse(object.pixels), *place));
    let mut place_of = vec![None; count];
    for (place, (part, _)) in kept.iter().enumerate() {
        place_of[*part] = u32::try_from(place).ok();
    }
    let of_pixel = part.iter().map(|part| place_of.get(*part as usize).copied().flatten()).collect();
    Ok(Objects { all: kept.into_iter().map(|(_, object)| object).collect(), of_pixel })
}
