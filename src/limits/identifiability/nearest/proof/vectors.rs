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
    /// a times a factor, in place of a.
    pub(super) fn scale<'a>(a: &'a mut [f64], factor: f64) {
        for a in a {
            *a *= factor;
        }
    }
}

dispatched! {
    /// a over a divisor, in place of a.
    pub(super) fn divide<'a>(a: &'a mut [f64], divisor: f64) {
        for a in a {
            *a /= divisor;
        }
    }
}

dispatched! {
    /// |a|.
    pub(super) fn sizes_into<'a>(a: &'a [f64], out: &'a mut [f64]) {
        for (out, a) in out.iter_mut().zip(a) {
            *out = a.abs();
        }
    }
}

dispatched! {
    /// 1 − a.
    pub(super) fn rest_into<'a>(a: &'a [f64], out: &'a mut [f64]) {
        for (out, a) in out.iter_mut().zip(a) {
            *out = 1.0 - a;
        }
    }
}

dispatched! {
    /// The least that is above 0, of whole chunks.
    pub(super) fn least_above_nothing<'a>(a: &'a [f64]) -> f64 {
        let mut least = [f64::INFINITY; LANES];
        for a in a.as_chunks::<LANES>().0 {
            for k in 0..LANES {
                let own = if a[k] > 0.0 { a[k] } else { f64::INFINITY };
                least[k] = if own < least[k] { own } else { least[k] };
            }
        }
        least.iter().copied().fold(f64::INFINITY, f64::min)
    }
}

dispatched! {
    /// The largest a/b where b is above 0, none below `least`; of whole chunks.
    pub(super) fn largest_quotient<'a>(a: &'a [f64], b: &'a [f64], least: f64) -> f64 {
        let mut largest = [least; LANES];
        for (a, b) in a.as_chunks::<LANES>().0.iter().zip(b.as_chunks::<LANES>().0) {
            let (own, before) = (quotient(*a, *b, least), largest);
            largest = std::array::from_fn(|k| if own[k] > before[k] { own[k] } else { before[k] });
        }
        largest.iter().copied().fold(least, f64::max)
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
        for (a, b) in a.iter().zip(b) {
            let both = quotient(*a, *b, 0.0);
            lanes = added(both, both, lanes);
        }
        let both = quotient(padded(a_rest), padded(b_rest), 0.0);
        fold(&added(both, both, lanes))
    }
}

/// a/b where b is above 0, elsewhere `other`. Divided is first: where it hangs on a condition it is done one by one.
#[inline(always)]
fn quotient(a: Chunk, b: Chunk, other: f64) -> Chunk {
    let all: Chunk = std::array::from_fn(|k| a[k] / b[k]);
    std::array::from_fn(|k| if b[k] > 0.0 { all[k] } else { other })
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
    /// The counts that each band can have within reach: (y + reach)² − v, and a little more.
    pub(super) fn brightest_into<'a>(root: &'a [f64], noise: &'a [f64], reach: f64, out: &'a mut [f64]) {
        for ((out, y), v) in out.iter_mut().zip(root).zip(noise) {
            *out = (y + reach) * (y + reach) * (1.0 + 1e-9) - v;
        }
    }
}

dispatched! {
    /// N − N₀ = r(y + s) of every band, r = −p s; whether no s is 0.
    pub(super) fn differences_into<'a>(pull: &'a [f64], root: &'a [f64], other: &'a [f64], out: &'a mut [f64]) -> bool {
        let mut is_known = true;
        for ((out, p), (y, s)) in out.iter_mut().zip(pull).zip(root.iter().zip(other)) {
            *out = -p * s * (y + s);
            is_known &= *s != 0.0;
        }
        is_known
    }
}

dispatched! {
    /// −r/s, s and r of every band in whole chunks, 0 where y or s is.
    pub(super) fn pulls_into<'a>(residual: &'a [f64], other: &'a [f64], root: &'a [f64], out: [&'a mut [f64]; 3]) {
        let [pull, seen, kept] = out.map(|out| out.as_chunks_mut::<LANES>().0);
        let ((r, r_rest), (s, s_rest)) = (residual.as_chunks::<LANES>(), other.as_chunks::<LANES>());
        for (c, y) in root.as_chunks::<LANES>().0.iter().enumerate() {
            let (r, s) = if c < r.len() { (r[c], s[c]) } else { (padded(r_rest), padded(s_rest)) };
            [pull[c], seen[c], kept[c]] = pulls(r, s, *y);
        }
    }
}

/// −r/s, s and r of a chunk of bands.
#[inline(always)]
fn pulls(r: Chunk, s: Chunk, y: Chunk) -> [Chunk; 3] {
    let counts = |k: usize| s[k] > 1e-150 && y[k] > 0.0;
    let all: Chunk = std::array::from_fn(|k| -r[k] / s[k]);
    let pull = std::array::from_fn(|k| if counts(k) { all[k] } else { 0.0 });
    let seen = std::array::from_fn(|k| if counts(k) { s[k] } else { 0.0 });
    [pull, seen, std::array::from_fn(|k| if counts(k) { r[k] } else { 0.0 })]
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
