//! Objects of what pixels may be: connected pixels of the same set of categories.

use super::categories::{NO_CATEGORY, bit};
use super::claims::{Claims, Told};
use super::components::{NO_PART, Neighbours, components};
use super::rectangle::rectangle;
use crate::decompose::possible::ANYTHING;
use hadar::error::{Error, Result};

/// Connected pixels (by a side or a corner) that may be the same.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Group {
    /// The set of the categories that it may be of, a bit each; one bit where it has a category.
    pub possible: u64,
    /// Its pixels.
    pub pixels: usize,
    /// Those of them that are decided by themselves.
    pub decided: usize,
    /// Its first row, and the one after its last.
    pub rows: [usize; 2],
    /// Its first column, and the one after its last.
    pub columns: [usize; 2],
}

/// Groups, the largest first, and which one every pixel is of.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Groups {
    /// What is there.
    pub all: Vec<Group>,
    /// Place among them; `None` for a pixel without a set, and of groups that are too small.
    pub of_pixel: Vec<Option<u32>>,
    /// Groups that are not listed: too small, and no pixel of them is decided.
    pub left_out: usize,
}

impl Claims {
    /// For each pixel the set of the categories that its object may be of: its own where it has one, else all that are possible; empty where it
    /// is of none, or nothing tells what it is.
    #[must_use]
    pub fn sets(&self, possible: &[u64]) -> Vec<u64> {
        let one = |((category, told), possible): ((&u8, &Told), &u64)| match (*category, told) {
            (NO_CATEGORY, Told::Undecided) if *possible != ANYTHING => *possible,
            (NO_CATEGORY, _) => 0,
            (category, _) => bit(category),
        };
        self.category.iter().zip(&self.told).zip(possible).map(one).collect()
    }
}

/// The connected parts of a map of sets `[row][column]` that have so many pixels at least, or a pixel that is decided.
///
/// # Errors
/// A map that is no rectangle of so many columns; another number of decisions.
pub fn groups(sets: &[u64], is_decided: &[bool], columns: usize, smallest: usize) -> Result<Groups> {
    rectangle(sets.len(), columns)?;
    if is_decided.len() != sets.len() {
        let (found, expected) = (is_decided.len(), sets.len());
        return Err(Error::Length { what: "decisions of pixels".into(), found, expected });
    }
    let value = |i: usize| Some(sets[i]).filter(|set| *set != 0);
    let (part, count) = components(sets.len(), columns, Neighbours::Eight, value);
    let mut parts: Vec<Option<Group>> = vec![None; count];
    for (i, part) in part.iter().enumerate().filter(|(_, part)| **part != NO_PART) {
        let (row, column) = (i / columns, i % columns);
        let group = parts[*part as usize].get_or_insert(Group {
            possible: sets[i],
            pixels: 0,
            decided: 0,
            rows: [row, row + 1],
            columns: [column, column + 1],
        });
        group.pixels += 1;
        group.decided += usize::from(is_decided[i]);
        group.rows[1] = row + 1;
        group.columns = [group.columns[0].min(column), group.columns[1].max(column + 1)];
    }
    let is_listed = |group: &Group| group.pixels >= smallest || group.decided > 0;
    let mut kept: Vec<(usize, Group)> = parts
        .into_iter()
        .enumerate()
        .filter_map(|(place, group)| Some((place, group.filter(is_listed)?)))
        .collect();
    kept.sort_by_key(|(place, group)| (std::cmp::Reverse(group.pixels), *place));
    let mut place_of = vec![None; count];
    for (place, (part, _)) in kept.iter().enumerate() {
        place_of[*part] = u32::try_from(place).ok();
    }
    let of_pixel = part.iter().map(|part| place_of.get(*part as usize).copied().flatten()).collect();
    let left_out = count - kept.len();
    Ok(Groups { all: kept.into_iter().map(|(_, group)| group).collect(), of_pixel, left_out })
}
