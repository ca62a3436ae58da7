//! Algorithm 4 of the paper, pixel by pixel from the first row; what it leaves open as [`super::Rule::Raster`] says.

use super::categories::{Candidate, Categories, NO_CATEGORY};
use super::own::Own;

pub(super) fn segment(material: &[u16], columns: usize, categories: &Categories) -> Vec<u8> {
    let mut found = vec![NO_CATEGORY; material.len()];
    for i in 0..material.len() {
        let candidates = categories.of(material[i]);
        found[i] = match candidates {
            [] => NO_CATEGORY,
            [only] => only.category,
            several => {
                let left = (!i.is_multiple_of(columns)).then(|| i - 1);
                let above = i.checked_sub(columns);
                neighbour(several, material, &found, i, [left, above]).unwrap_or_else(|| {
                    let open = several.iter().find(|one| !one.enclosed);
                    open.map_or(NO_CATEGORY, |one| one.category)
                })
            }
        };
    }
    // What is enclosed in all its categories and comes before what encloses it.
    for i in (0..material.len()).rev().filter(|i| categories.of(material[*i]).len() > 1).collect::<Vec<_>>() {
        if found[i] == NO_CATEGORY {
            let right = ((i + 1) % columns != 0).then_some(i + 1);
            let below = Some(i + columns).filter(|below| *below < material.len());
            let said = neighbour(categories.of(material[i]), material, &found, i, [right, below]);
            found[i] = said.unwrap_or(NO_CATEGORY);
        }
    }
    found
}

/// The category of one of two neighbours that is among the candidates.
fn neighbour(
    candidates: &[Candidate],
    material: &[u16],
    found: &[u8],
    i: usize,
    neighbours: [Option<usize>; 2],
) -> Option<u8> {
    let can_be = |j: &usize| candidates.iter().any(|one| one.category == found[*j]);
    let [first, second] = neighbours.map(|j| j.filter(can_be));
    match (first, second) {
        (Some(a), Some(b)) if material[a] != material[i] && material[b] == material[i] => Some(found[b]),
        (Some(one), _) | (None, Some(one)) => Some(found[one]),
        (None, None) => None,
    }
}

/// The same of what pixels are told to be: a pixel of several categories is given one only where those to its left and above have one or
/// are of none, so that nothing unknown is passed over; there is no pass back.
pub(super) fn claimed(own: &[Own], shared: &[&[Candidate]], columns: usize) -> Vec<Option<u8>> {
    let mut found: Vec<Option<u8>> = vec![None; own.len()];
    for i in 0..own.len() {
        found[i] = match own[i] {
            Own::Category(category) => Some(category),
            Own::None => Some(NO_CATEGORY),
            Own::Unknown => None,
            Own::Shared(place) => {
                let left = (!i.is_multiple_of(columns)).then(|| i - 1);
                let before = [left, i.checked_sub(columns)];
                let is_known = before.iter().flatten().all(|j| found[*j].is_some());
                let can_be = |j: &usize| shared[place].iter().any(|one| Some(one.category) == found[*j]);
                let said = match before.map(|j| j.filter(can_be)) {
                    [Some(a), Some(b)] if own[a] != own[i] && own[b] == own[i] => found[b],
                    [Some(one), _] | [None, Some(one)] => found[one],
                    [None, None] => shared[place].iter().find(|one| !one.enclosed).map(|one| one.category),
                };
                said.filter(|_| is_known)
            }
        };
    }
    found
}
