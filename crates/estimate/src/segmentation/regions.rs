//! Regions of one material as wholes: enclosed by a category, or on the outside ([`super::Rule::Regions`]).
//!
//! The border of a region are the pairs of one of its pixels and a neighbour (by a side) that is not of it; pairs with a pixel that has
//! no category, and the edge of the image, are no part of it. A region is decided as soon as the neighbours that are not yet decided
//! cannot change it; what is left when no round changes anything, or after [`ROUNDS`], without them. All regions of a round are decided at
//! once, so that an image and its mirror image have the same categories.

use super::categories::{Candidate, Categories, NO_CATEGORY};
use super::components::{NO_PART, Neighbours, components};
use rayon::prelude::*;

/// Share of a border from which on what is behind it encloses.
const ENCLOSES: f64 = 0.75;
const ROUNDS: usize = 8;

/// What is beyond a border.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Beyond {
    Category(u8),
    Region(u32),
}

pub(super) fn segment(material: &[u16], columns: usize, categories: &Categories) -> Vec<u8> {
    let candidates = |i: usize| categories.of(material[i]);
    let mut found: Vec<u8> = (0..material.len())
        .into_par_iter()
        .map(|i| match candidates(i) {
            [only] => only.category,
            _ => NO_CATEGORY,
        })
        .collect();
    let ambiguous = |i: usize| (candidates(i).len() > 1).then(|| material[i]);
    let (region, count) = components(material.len(), columns, Neighbours::Four, ambiguous);
    if count == 0 {
        return found;
    }
    let mut of_region: Vec<&[Candidate]> = vec![&[]; count];
    for (i, region) in region.iter().enumerate().filter(|(_, region)| **region != NO_PART) {
        of_region[*region as usize] = candidates(i);
    }
    let border = border(&region, &found, columns);
    // From one region's pairs to the next one's.
    let starts: Vec<usize> =
        (0..=count).map(|one| border.partition_point(|(region, ..)| (*region as usize) < one)).collect();
    let mut decided: Vec<Option<u8>> = vec![None; count];
    for wait in [true, false] {
        for _ in 0..ROUNDS {
            hadar::stop::check();
            let say = |one: usize| {
                hadar::stop::check();
                let border = Border::of(&border[starts[one]..starts[one + 1]], &decided);
                decided[one].or_else(|| decision(of_region[one], &border, wait))
            };
            let next: Vec<Option<u8>> = (0..count).into_par_iter().map(say).collect();
            if next == decided {
                break;
            }
            decided = next;
        }
    }
    for (category, region) in found.iter_mut().zip(&region).filter(|(_, region)| **region != NO_PART) {
        *category = decided[*region as usize].unwrap_or(NO_CATEGORY);
    }
    found
}

/// Pairs across the border of every region, sorted by region: region, what is beyond, how many.
fn border(region: &[u32], found: &[u8], columns: usize) -> Vec<(u32, Beyond, u32)> {
    let beyond = |j: usize| match (region[j], found[j]) {
        (NO_PART, NO_CATEGORY) => None,
        (NO_PART, category) => Some(Beyond::Category(category)),
        (other, _) => Some(Beyond::Region(other)),
    };
    let mut pairs = Vec::new();
    let mut pair = |i: usize, j: usize| {
        if region[i] != NO_PART && region[i] != region[j] {
            pairs.extend(beyond(j).map(|beyond| (region[i], beyond)));
        }
    };
    for i in 0..region.len() {
        let right = ((i + 1) % columns != 0).then_some(i + 1);
        let below = Some(i + columns).filter(|below| *below < region.len());
        for j in right.into_iter().chain(below) {
            pair(i, j);
            pair(j, i);
        }
    }
    pairs.par_sort_unstable();
    let mut counted: Vec<(u32, Beyond, u32)> = Vec::new();
    for (region, beyond) in pairs {
        match counted.last_mut() {
            Some(last) if (last.0, last.1) == (region, beyond) => last.2 += 1,
            _ => counted.push((region, beyond, 1)),
        }
    }
    counted
}

/// What a region borders on: pairs of pixels of each category, and those not yet known.
struct Border {
    known: Vec<(u8, u32)>,
    unknown: u32,
}

impl Border {
    fn of(pairs: &[(u32, Beyond, u32)], decided: &[Option<u8>]) -> Self {
        let mut border = Self { known: Vec::new(), unknown: 0 };
        for (_, beyond, count) in pairs {
            let category = match beyond {
                Beyond::Category(category) => Some(*category),
                Beyond::Region(other) => decided[*other as usize],
            };
            match category {
                Some(category) => match border.known.iter_mut().find(|(one, _)| *one == category) {
                    Some((_, sum)) => *sum += count,
                    None => border.known.push((category, *count)),
                },
                None => border.unknown += count,
            }
        }
        border
    }

    fn with(&self, category: u8) -> u32 {
        self.known.iter().find(|(one, _)| *one == category).map_or(0, |(_, count)| *count)
    }

    /// Of some categories the one along which it is longest, the first of equals, and by how much longer than along the next.
    fn longest<'a>(&self, among: impl Iterator<Item = &'a Candidate>) -> Option<(u8, u32, u32)> {
        among.fold(None, |best, one| {
            let length = self.with(one.category);
            match best {
                Some((category, most, lead)) if length <= most => {
                    Some((category, most, lead.min(most - length)))
                }
                Some((_, most, _)) => Some((one.category, length, length - most)),
                None => Some((one.category, length, u32::MAX)),
            }
        })
    }
}

/// The category of a region; `None` where it is not decided: as long as what is unknown could change it (`wait`), or for good.
fn decision(candidates: &[Candidate], border: &Border, wait: bool) -> Option<u8> {
    let unknown = if wait { border.unknown } else { 0 };
    let all = border.known.iter().map(|(_, count)| count).sum::<u32>() + unknown;
    let encloses = |length: u32| all > 0 && f64::from(length) >= ENCLOSES * f64::from(all);
    let enclosing = border.longest(candidates.iter().filter(|one| one.enclosed));
    if let Some((category, length, _)) = enclosing {
        if encloses(length) {
            return Some(category);
        }
        // Any of them may still get what is unknown.
        if unknown > 0 && encloses(length + unknown) {
            return None;
        }
    }
    let mut open = candidates.iter().filter(|one| !one.enclosed).peekable();
    if open.peek().is_some() {
        let (category, _, lead) = border.longest(open)?;
        return (lead > unknown || unknown == 0).then_some(category);
    }
    let (category, length, lead) = enclosing?;
    (length > 0 && (lead > unknown || unknown == 0)).then_some(category)
}
