//! Neighbouring bands counted as one.

use crate::aligned::Aligned;
use crate::simd::{Chunk, LANES, added, dispatched, fold, padded, product};

/// How many values whole chunks take for so many bands: those beyond are 0 everywhere.
pub(super) fn whole(bands: usize) -> usize {
    bands.next_multiple_of(LANES)
}

/// So many neighbours summed each, in whole chunks.
pub(super) fn neighbours_summed(bands: &[f64], count: usize) -> Aligned {
    summed(bands, None, count)
}

/// Sums of so many neighbouring products each, in whole chunks.
pub(super) fn products_summed([a, b]: [&[f64]; 2], count: usize) -> Aligned {
    summed(a, Some(b), count)
}

fn summed(bands: &[f64], factor: Option<&[f64]>, count: usize) -> Aligned {
    let mut all = Aligned::unset(whole(bands.len().div_ceil(count)));
    summed_into(bands, factor, count, &mut all);
    all
}

dispatched! {
    /// The sums of so many neighbours each, times a factor if there is any.
    fn summed_into<'a>(bands: &'a [f64], factor: Option<&'a [f64]>, count: usize, sums: &'a mut [f64]) -> () {
        let (chunks, per_group) = (bands.as_chunks::<LANES>().0, count / LANES);
        let whole = if per_group * LANES == count { (chunks.len() / per_group).min(sums.len()) } else { 0 };
        let (in_chunks, others) = sums.split_at_mut(whole);
        // Loops written out: a closure need not be inlined, and would then be compiled for the oldest processor.
        match factor {
            Some(factor) => {
                let factor: &[Chunk] = factor.as_chunks().0;
                let groups = chunks.chunks_exact(per_group.max(1)).zip(factor.chunks_exact(per_group.max(1)));
                for (sum, (a, b)) in in_chunks.iter_mut().zip(groups) {
                    let mut lanes = product(a[0], b[0]);
                    for (a, b) in a[1..].iter().zip(&b[1..]) {
                        lanes = added(*a, *b, lanes);
                    }
                    *sum = fold(&lanes);
                }
            }
            None => {
                for (sum, a) in in_chunks.iter_mut().zip(chunks.chunks_exact(per_group.max(1))) {
                    let mut lanes = a[0];
                    for a in &a[1..] {
                        lanes = added([1.0; LANES], *a, lanes);
                    }
                    *sum = fold(&lanes);
                }
            }
        }
        // Groups that are no whole chunks, the last one, and those beyond it.
        let mut rest = (whole * count).min(bands.len());
        for sum in others {
            let mut lanes = [0.0; LANES];
            let end = (rest + count).min(bands.len());
            for i in (rest..end).step_by(LANES) {
                let part = i..(i + LANES).min(end);
                let by = factor.map_or([1.0; LANES], |factor| padded(&factor[part.clone()]));
                lanes = added(padded(&bands[part]), by, lanes);
            }
            *sum = fold(&lanes);
            rest = end;
        }
    }
}

/// Values by their place in groups of so many neighbours: the first of every group, then the second of every one and so on, each in
/// whole chunks; 0 where the last group has none. Sums over neighbours are then sums of whole lanes.
pub(in super::super) fn by_place(values: &[f64], count: usize) -> Aligned {
    let groups = whole(values.len().div_ceil(count));
    let mut placed = Aligned::unset(count * groups);
    let full = values.chunks_exact(count);
    for (place, row) in placed.chunks_exact_mut(groups.max(1)).enumerate() {
        let (own, others) = row.split_at_mut(full.len());
        own.iter_mut().zip(full.clone()).for_each(|(to, group)| *to = group[place]);
        others.fill(0.0);
        if let (Some(to), Some(value)) = (others.first_mut(), full.remainder().get(place)) {
            *to = *value;
        }
    }
    placed
}

dispatched! {
    /// [`products_summed`] of values by their place.
    pub(super) fn products_by_place_into<'a>(a: &'a [f64], b: &'a [f64], sums: &'a mut [f64]) -> () {
        let (a, b): (&[Chunk], &[Chunk]) = (a.as_chunks().0, b.as_chunks().0);
        let sums = sums.as_chunks_mut::<LANES>().0;
        let groups = sums.len();
        for (g, sum) in sums.iter_mut().enumerate() {
            let mut lanes = product(a[g], b[g]);
            let mut next = g + groups;
            while next < a.len() {
                lanes = added(a[next], b[next], lanes);
                next += groups;
            }
            *sum = lanes;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against sums written out, for groups below a chunk, of whole chunks and beyond, the last one full or not.
    #[test]
    fn sums_of_neighbours_are_what_they_are_defined_as() {
        for bands in [1_usize, 7, 8, 27, 64, 130, 536] {
            let [a, b] =
                [0.3, 0.7].map(|x| (0..bands).map(|i| 1.0 + (x * i as f64).sin()).collect::<Vec<f64>>());
            for count in (1..=20).chain([32, 100]) {
                let found = products_summed([&a, &b], count);
                assert_eq!(found.len(), whole(bands.div_ceil(count)));
                for (group, sum) in found.iter().enumerate() {
                    let places = (group * count).min(bands)..((group + 1) * count).min(bands);
                    let expected: f64 = places.map(|i| a[i] * b[i]).sum();
                    assert!((sum - expected).abs() <= 1e-14 * expected, "{bands} {count} {group}");
                }
                assert_eq!(
                    neighbours_summed(&a, count)[..],
                    products_summed([&a, &vec![1.0; bands]], count)[..]
                );
                let mut by_places = Aligned::zeros(found.len());
                products_by_place_into(&by_place(&a, count), &by_place(&b, count), &mut by_places);
                for (one, other) in by_places.iter().zip(&found) {
                    assert!((one - other).abs() <= 1e-14 * other, "{bands} {count}: {one} {other}");
                }
            }
        }
    }
}
