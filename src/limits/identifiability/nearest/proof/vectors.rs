//! Loops over the bands that a proof spends its time in.

use crate::aligned::Aligned;
use crate::simd::{Chunk, LANES, added, dispatched, fold, padded, product};

dispatched! {
    /// a·b, element by element.
    pub(super) fn product_into<'a>(a: &'a [f64], b: &'a [f64], out: &'a mut [f64]) {
        for ((out, a), b) in out.iter_mut().zip(a).zip(b) {
            *out = a * b;
        }
    }
}

dispatched! {
    /// a·b, element by element, in place of a.
    pub(super) fn multiply<'a>(a: &'a mut [f64], b: &'a [f64]) {
        for (a, b) in a.iter_mut().zip(b) {
            *a *= b;
        }
    }
}

dispatched! {
    /// Σ (aᵢbᵢ)².
    pub(super) fn square_of_product<'a>(a: &'a [f64], b: &'a [f64]) -> f64 {
        let mut lanes = [0.0; LANES];
        let ((a, a_rest), (b, b_rest)) = (a.as_chunks(), b.as_chunks());
        for (a, b) in a.iter().zip(b) {
            let both = product(*a, *b);
            lanes = added(both, both, lanes);
        }
        let both = product(padded(a_rest), padded(b_rest));
        fold(&added(both, both, lanes))
    }
}

dispatched! {
    /// to += factor · x.
    pub(super) fn add_into<'a>(factor: f64, x: &'a [f64], to: &'a mut [f64]) {
        for (to, x) in to.iter_mut().zip(x) {
            *to = factor.mul_add(*x, *to);
        }
    }
}

dispatched! {
    /// The least limit/(value + width · slope), none below 0; of whole chunks.
    pub(super) fn largest_share<'a>(limit: &'a [f64], value: &'a [f64], slope: &'a [f64], width: f64) -> f64 {
        let mut least = [f64::INFINITY; LANES];
        let [limit, value, slope] = [limit, value, slope].map(|x| -> &'a [Chunk] { x.as_chunks().0 });
        for ((limit, value), slope) in limit.iter().zip(value).zip(slope) {
            for k in 0..LANES {
                let share = limit[k] / width.mul_add(slope[k], value[k]);
                least[k] = if share < least[k] { share } else { least[k] };
            }
        }
        least.iter().copied().fold(f64::INFINITY, f64::min).max(0.0)
    }
}

dispatched! {
    /// Σ (a/b)² over bands in which b is above 0.
    pub(super) fn square_of_quotient<'a>(a: &'a [f64], b: &'a [f64]) -> f64 {
        let mut lanes = [0.0; LANES];
        let ((a, a_rest), (b, b_rest)) = (a.as_chunks(), b.as_chunks());
        let rest = [(&padded(a_rest), &padded(b_rest))];
        for (a, b) in a.iter().zip(b).chain(rest) {
            for k in 0..LANES {
                let quotient = if b[k] > 0.0 { a[k] / b[k] } else { 0.0 };
                lanes[k] = quotient.mul_add(quotient, lanes[k]);
            }
        }
        fold(&lanes)
    }
}

dispatched! {
    /// s² − v, none below 0.
    pub(super) fn counts_into<'a>(root: &'a [f64], noise: &'a [f64], out: &'a mut [f64]) {
        for ((out, s), v) in out.iter_mut().zip(root).zip(noise) {
            let counts = s * s - v;
            *out = if counts > 0.0 { counts } else { 0.0 };
        }
    }
}

dispatched! {
    /// −r/s, s and r of every band, 0 where y or s is.
    pub(super) fn pulls_into<'a>(residual: &'a [f64], other: &'a [f64], root: &'a [f64], out: [&'a mut [f64]; 3]) {
        let [pull, seen, kept] = out;
        let out = pull.iter_mut().zip(seen).zip(kept);
        for ((r, s), (y, ((pull, seen), kept))) in residual.iter().zip(other).zip(root.iter().zip(out)) {
            let counts = *s > 1e-150 && *y > 0.0;
            *pull = if counts { -r / s } else { 0.0 };
            *seen = if counts { *s } else { 0.0 };
            *kept = if counts { *r } else { 0.0 };
        }
    }
}

dispatched! {
    /// to += factor · |x|.
    pub(super) fn add_size_into<'a>(factor: f64, x: &'a [f64], to: &'a mut [f64]) {
        for (to, x) in to.iter_mut().zip(x) {
            *to = factor.mul_add(x.abs(), *to);
        }
    }
}

dispatched! {
    /// to += x².
    pub(super) fn add_square_into<'a>(x: &'a [f64], to: &'a mut [f64]) {
        for (to, x) in to.iter_mut().zip(x) {
            *to = x.mul_add(*x, *to);
        }
    }
}

dispatched! {
    /// to += factor · √x.
    pub(super) fn add_root_into<'a>(factor: f64, x: &'a [f64], to: &'a mut [f64]) {
        for (to, x) in to.iter_mut().zip(x) {
            *to = factor.mul_add(x.sqrt(), *to);
        }
    }
}

/// What [`weights_into`] reads and writes.
pub(super) struct Weights<'a> {
    /// y and s.
    pub(super) root: &'a [f64],
    pub(super) other: &'a [f64],
    pub(super) reach: f64,
    /// ‖W ΔN‖ of each band alone at most, by the weights before.
    pub(super) most: Option<&'a [f64]>,
    pub(super) weight: &'a mut [f64],
}

dispatched! {
    /// √(y/s)/(s + s′) of every band, s′ the brightest that it can become: y + reach, and √(s² + most/weight) at most. 0 where
    /// s is.
    pub(super) fn weights_into<'a>(weights: Weights<'a>) -> () {
        let Weights { root, other, reach, most, weight } = weights;
        if let Some(most) = most {
            for ((w, most), (y, s)) in weight.iter_mut().zip(most).zip(root.iter().zip(other)) {
                let bright = (s * s + most / *w).sqrt().min(y + reach);
                let better = (y / s).sqrt() / (s + bright);
                *w = if *w > 0.0 { better } else { 0.0 };
            }
            return;
        }
        for (w, (y, s)) in weight.iter_mut().zip(root.iter().zip(other)) {
            let weight = (y / s).sqrt() / (s + y + reach);
            *w = if *s > 0.0 { weight } else { 0.0 };
        }
    }
}

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
    for (place, row) in placed.chunks_exact_mut(groups.max(1)).enumerate() {
        let mut next = place;
        for to in row {
            *to = values.get(next).copied().unwrap_or(0.0);
            next += count;
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
