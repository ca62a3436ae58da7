//! Sums whose rounding error does not grow with the number of terms.
//!
//! Terms are added in eight independent lanes over blocks of [`BLOCK`]; the lanes of the blocks are added
//! with the error-free transformation of Knuth (TwoSum), lane by lane, and folded once at the end, so the
//! error stays below about (BLOCK/8 + 3) u Σ|x| for any length, u = 2⁻⁵³. The lanes are written out, so
//! every processor adds in the same order and gives the same bits.
//!
//! Source: Ogita, Rump, Oishi, SIAM J. Sci. Comput. 26, 1955 (2005), doi:10.1137/030601818.

use crate::simd::{Chunk, LANES, added, dispatched, fold, padded};

/// Terms per block; a multiple of [`LANES`].
pub(crate) const BLOCK: usize = 128;

/// A running sum with the rounding errors of its additions kept beside it.
#[derive(Debug, Clone, Copy, Default)]
pub struct Compensated {
    sum: f64,
    error: f64,
}

impl Compensated {
    /// Adds a term.
    #[inline(always)]
    pub fn add(&mut self, term: f64) {
        let sum = self.sum + term;
        let virtual_term = sum - self.sum;
        self.error += (self.sum - (sum - virtual_term)) + (term - virtual_term);
        self.sum = sum;
    }

    /// The sum, its rounding errors added.
    #[inline(always)]
    pub fn value(self) -> f64 {
        // An infinite sum has no error to add (∞ − ∞).
        if self.sum.is_finite() { self.sum + self.error } else { self.sum }
    }
}

/// [`Compensated`] sums in every lane.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct CompensatedLanes {
    sum: Chunk,
    error: Chunk,
}

impl CompensatedLanes {
    #[inline(always)]
    pub(crate) fn add(&mut self, terms: Chunk) {
        let (old, error) = (self.sum, self.error);
        let sum: Chunk = std::array::from_fn(|i| old[i] + terms[i]);
        self.error = std::array::from_fn(|i| {
            let virtual_term = sum[i] - old[i];
            error[i] + ((old[i] - (sum[i] - virtual_term)) + (terms[i] - virtual_term))
        });
        self.sum = sum;
    }

    /// Never inlined: the sums then go through memory all at once, which keeps the loops before in
    /// full-width registers instead of the pairs that the folding asks for.
    #[inline(never)]
    pub(crate) fn value(&self) -> f64 {
        let sum = fold(&self.sum);
        if sum.is_finite() { sum + fold(&self.error) } else { sum }
    }
}

dispatched! {
    /// Σ aᵢ bᵢ over the shorter of the two.
    pub fn dot<'a>(a: &'a [f64], b: &'a [f64]) -> f64 {
        let n = a.len().min(b.len());
        let ((a8, a_rest), (b8, b_rest)) = (a[..n].as_chunks::<LANES>(), b[..n].as_chunks::<LANES>());
        let mut total = CompensatedLanes::default();
        for (a, b) in a8.chunks(BLOCK / LANES).zip(b8.chunks(BLOCK / LANES)) {
            let mut lanes = [0.0; LANES];
            for (a, b) in a.iter().zip(b) {
                lanes = added(*a, *b, lanes);
            }
            total.add(lanes);
        }
        total.add(added(padded(a_rest), padded(b_rest), [0.0; LANES]));
        total.value()
    }
}

dispatched! {
    /// Σ xᵢ.
    pub fn sum<'a>(x: &'a [f64]) -> f64 {
        let (eights, rest) = x.as_chunks::<LANES>();
        let mut total = CompensatedLanes::default();
        for block in eights.chunks(BLOCK / LANES) {
            let mut lanes: Chunk = [0.0; LANES];
            for x in block {
                lanes = std::array::from_fn(|i| lanes[i] + x[i]);
            }
            total.add(lanes);
        }
        total.add(padded(rest));
        total.value()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_error_does_not_grow_with_the_number_of_terms() {
        for n in [1_usize, 7, 8, 129, 536, 10_000, 1_000_003] {
            // Σ 0.1 n times: plain summation loses about n u/2; the bound here is 20 u.
            let terms = vec![0.1; n];
            let exact = 0.1 * n as f64;
            assert!((sum(&terms) / exact - 1.0).abs() < 20.0 * f64::EPSILON / 2.0, "{n}");
            assert!((dot(&terms, &vec![1.0; n]) / exact - 1.0).abs() < 20.0 * f64::EPSILON / 2.0, "{n}");
        }
    }
}
