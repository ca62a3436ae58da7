//! Categories that never claim: a pixel has one where it is told, by itself or by neighbours that are themselves decided.
//!
//! | pixel | |
//! |---|---|
//! | told by itself | all its candidates are of one category |
//! | of no category | all its candidates are in none |
//! | shared | all its candidates are of the same several categories: its neighbours may settle it |
//! | unknown | all else: candidates of several categories, nothing that fits, nothing that tells, left out |
//!
//! By regions: a cloud U are connected pixels that are shared or unknown, a region R those of it that are shared by the same categories.
//! With n(R, c) the pairs across sides of a pixel of R and one that is told to be c by itself, n(U, c) the same for the cloud, and
//! u = 4·(unknown pixels of U) + pairs of different regions of U + sides of U at the edge of the image
//! (all that could turn out to be a border of any kind):
//!
//! * enclosed in c: n(R, c) ≥ [`ENCLOSED`]·(Σ n(U, not c) + u);
//! * not enclosed in c: [`OPEN`]·n(R, not c) > n(U, c) + u;
//! * R is c where it is enclosed in c if it is enclosed there, where it is enclosed nowhere and c is the only category in which it is open,
//!   or that along which it has the longest border of those: n(R, c) > n(U, other) + u.
//!
//! What is unknown counts against every claim and never for one. Whatever the unknown pixels are, U only shrinks when they are told, n(R, c)
//! grows, and a pixel that is told no longer counts 4 but the sides that it has: so a pixel that becomes unknown takes claims away, and gives none.
//! All regions are decided at once, by pixels that are told by themselves, never by one another: a mirrored image has mirrored categories.
//!
//! With a category for safety a shared pixel that may be of it is not given another one by its neighbours.

use super::categories::{Candidate, Categories, NO_CATEGORY, bit};
use super::components::{NO_PART, Neighbours, components};
use super::own::Own;
use super::raster;
use super::rectangle::rectangle;
use super::rule::Rule;
use crate::decompose::possible::OTHER;
use hadar::error::{Error, Result};
use rayon::prelude::*;

/// How many times longer than all else a border with a category is that encloses.
pub(super) const ENCLOSED: usize = 9;
/// How many times longer than all else a border with a category is that may enclose.
pub(super) const OPEN: usize = 3;

/// How a pixel has its category.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Told {
    /// By itself: all its candidates are of that category alone.
    ByItself,
    /// All its candidates are of the same several categories, and its neighbours settle which.
    ByNeighbours,
    /// All its candidates are of no category.
    OfNone,
    /// It has none: it is undecided.
    Undecided,
}

/// What pixels are told to be.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Claims {
    /// Their categories, [`NO_CATEGORY`] where they are of none or undecided.
    pub category: Vec<u8>,
    /// How they have them.
    pub told: Vec<Told>,
}

/// Categories that pixels `[row][column]` are told to be, of the sets of the categories of any and of all of their candidates
/// ([`crate::decompose::possible`]); `safety` is the set of the categories that no neighbour takes away.
///
/// # Errors
/// Sets of different numbers of pixels; a map that is no rectangle of so many columns.
///
/// ```
/// use hadar_estimate::segmentation::{Categories, NO_CATEGORY, Part, Rule, Told, claims};
/// // 0 paint of a car, 1 fabric: a person, or the seats of the car; 2 the road.
/// let (paint, road) = (Part::open(0), Part::open(2));
/// let categories = Categories::new(3, &[vec![Part::open(1)], vec![paint, Part::enclosed(1)], vec![road]])?;
/// let (f, r) = (0b011, 0b100);
/// let alone = [r, r, r, r, f, r, r, r, r];
/// let found = claims(&alone, &alone, 3, &categories, Rule::Regions, 0)?;
/// assert_eq!((found.category[4], found.told[4]), (0, Told::ByNeighbours));
/// // Where most of what is around it is not told, it may be the seat of a car.
/// let any = u64::MAX;
/// let unknown = [r, any, r, any, f, any, r, r, r];
/// let found = claims(&unknown, &unknown, 3, &categories, Rule::Regions, 0)?;
/// assert_eq!((found.category[4], found.told[4]), (NO_CATEGORY, Told::Undecided));
/// # Ok::<(), hadar::Error>(())
/// ```
pub fn claims(
    possible: &[u64],
    common: &[u64],
    columns: usize,
    categories: &Categories,
    rule: Rule,
    safety: u64,
) -> Result<Claims> {
    rectangle(possible.len(), columns)?;
    if common.len() != possible.len() {
        let (found, expected) = (common.len(), possible.len());
        return Err(Error::Length { what: "sets of what all candidates are".into(), found, expected });
    }
    let (own, shared) = own(possible, common, categories);
    let said = match rule {
        Rule::Raster => raster::claimed(&own, &shared, columns),
        Rule::Regions => by_regions(&own, &shared, columns),
    };
    let one = |(i, own): (usize, &Own)| match *own {
        Own::Category(category) => (category, Told::ByItself),
        Own::None => (NO_CATEGORY, Told::OfNone),
        Own::Unknown => (NO_CATEGORY, Told::Undecided),
        Own::Shared(_) => match said[i].filter(|category| possible[i] & safety & !bit(*category) == 0) {
            Some(category) => (category, Told::ByNeighbours),
            None => (NO_CATEGORY, Told::Undecided),
        },
    };
    let (category, told) = own.iter().enumerate().map(one).unzip();
    Ok(Claims { category, told })
}

/// What every pixel is by its own candidates, and what the shared ones may be a part of.
fn own<'c>(possible: &[u64], common: &[u64], categories: &'c Categories) -> (Vec<Own>, Vec<&'c [Candidate]>) {
    let mut sets: Vec<(u64, Option<usize>)> = Vec::new();
    let mut shared: Vec<&[Candidate]> = Vec::new();
    let mut place = |set: u64| {
        if let Some((_, place)) = sets.iter().find(|(one, _)| *one == set) {
            return *place;
        }
        let place = categories.alike(set).map(|candidates| {
            shared.push(candidates);
            shared.len() - 1
        });
        sets.push((set, place));
        place
    };
    let one = |(possible, common): (&u64, &u64)| match *possible {
        0 | OTHER => Own::None,
        one if one.is_power_of_two() => Own::Category(one.trailing_zeros() as u8),
        several if several == *common => place(several).map_or(Own::Unknown, Own::Shared),
        _ => Own::Unknown,
    };
    let own = possible.iter().zip(common).map(one).collect();
    (own, shared)
}

/// Pairs across the border of a region or cloud: with each category, and in all with what is told.
#[derive(Debug, Clone, Default)]
struct Border {
    with: Vec<(u8, usize)>,
    all: usize,
}

impl Border {
    fn add(&mut self, beyond: Own) {
        self.all += 1;
        if let Own::Category(category) = beyond {
            match self.with.iter_mut().find(|(one, _)| *one == category) {
                Some((_, count)) => *count += 1,
                None => self.with.push((category, 1)),
            }
        }
    }

    fn with(&self, category: u8) -> usize {
        self.with.iter().find(|(one, _)| *one == category).map_or(0, |(_, count)| *count)
    }

    fn without(&self, category: u8) -> usize {
        self.all - self.with(category)
    }
}

/// What the neighbours of every shared pixel settle.
fn by_regions(own: &[Own], shared: &[&[Candidate]], columns: usize) -> Vec<Option<u8>> {
    let region_of = |i: usize| match own[i] {
        Own::Shared(place) => Some(place),
        _ => None,
    };
    let is_open = |i: usize| matches!(own[i], Own::Shared(_) | Own::Unknown).then_some(());
    let (region, regions) = components(own.len(), columns, Neighbours::Four, region_of);
    if regions == 0 {
        return vec![None; own.len()];
    }
    let (cloud, clouds) = components(own.len(), columns, Neighbours::Four, is_open);
    let mut of_region: Vec<(Border, usize, usize)> = vec![(Border::default(), 0, 0); regions];
    let mut of_cloud: Vec<(Border, usize)> = vec![(Border::default(), 0); clouds];
    for i in (0..own.len()).filter(|i| cloud[*i] != NO_PART) {
        hadar::stop::check();
        let place = cloud[i] as usize;
        let neighbours = beside(i, columns, own.len());
        let unknown = &mut of_cloud[place].1;
        *unknown += neighbours.iter().filter(|j| j.is_none()).count();
        match region_of(i) {
            None => *unknown += 4,
            Some(kind) => {
                of_region[region[i] as usize].1 = place;
                of_region[region[i] as usize].2 = kind;
            }
        }
        for j in neighbours.into_iter().flatten() {
            if cloud[j] == NO_PART {
                of_cloud[place].0.add(own[j]);
                if let Some((border, ..)) = of_region.get_mut(region[i] as usize) {
                    border.add(own[j]);
                }
            } else if j > i && region_of(i).zip(region_of(j)).is_some_and(|(a, b)| a != b) {
                of_cloud[place].1 += 1;
            }
        }
    }
    let settled: Vec<Option<u8>> = of_region
        .par_iter()
        .map(|(border, cloud, kind)| settled(shared[*kind], border, &of_cloud[*cloud]))
        .collect();
    region.iter().map(|region| settled.get(*region as usize).copied().flatten()).collect()
}

/// The neighbours of a pixel by a side, `None` where the image ends.
fn beside(i: usize, columns: usize, pixels: usize) -> [Option<usize>; 4] {
    [
        i.checked_sub(columns),
        (!i.is_multiple_of(columns)).then(|| i - 1),
        (!(i + 1).is_multiple_of(columns)).then_some(i + 1),
        Some(i + columns).filter(|below| *below < pixels),
    ]
}

/// The category of a region that may be these, in a cloud with so much that is unknown; `None` where its neighbours do not settle it.
fn settled(candidates: &[Candidate], region: &Border, (cloud, unknown): &(Border, usize)) -> Option<u8> {
    let is_enclosed = |c: u8| {
        let length = region.with(c);
        length > 0 && length >= ENCLOSED * (cloud.without(c) + unknown)
    };
    let is_open = |c: u8| OPEN * region.without(c) > cloud.with(c) + unknown;
    let enclosed = || candidates.iter().filter(|one| one.enclosed).map(|one| one.category);
    if let Some(category) = enclosed().find(|c| is_enclosed(*c)) {
        return Some(category);
    }
    if !enclosed().all(is_open) {
        return None;
    }
    let open = || candidates.iter().filter(|one| !one.enclosed).map(|one| one.category);
    let is_longest = |c: u8| {
        let others = open().filter(|other| *other != c).map(|other| cloud.with(other)).max();
        others.is_none_or(|most| region.with(c) > most + unknown)
    };
    open().find(|c| is_longest(*c))
}

#[cfg(test)]
mod tests;
