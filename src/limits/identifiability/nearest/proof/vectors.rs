//! Loops over the bands that a proof spends its time in.

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
