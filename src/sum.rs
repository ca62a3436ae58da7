//! Sums whose rounding error does not grow with the number of terms.
//!
//! Terms are added in eight independent lanes over blocks of [`BLOCK`] and the block sums are added with
//! the error-free transformation of Knuth (TwoSum), so the error stays below about
//! (BLOCK/8 + 3) u Σ|x| for any length, u = 2⁻⁵³. The lanes are written out, so every processor
//! adds in the same order and gives the same bits.
//!
//! Source: Ogita, Rump, Oishi, SIAM J. Sci. Comput. 26, 1955 (2005), doi:10.1137/030601818.

/// Independent partial sums.
pub(crate) const LANES: usize = 8;
/// Terms per block; a multiple of [`LANES`].
pub(crate) const BLOCK: usize = 128;

/// A running sum with the rounding errors of its additions kept beside it.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Compensated {
    sum: f64,
    error: f64,
}

impl Compensated {
    #[inline(always)]
    pub(crate) fn add(&mut self, term: f64) {
        let sum = self.sum + term;
        let virtual_term = sum - self.sum;
        self.error += (self.sum - (sum - virtual_term)) + (term - virtual_term);
        self.sum = sum;
    }

    #[inline(always)]
    pub(crate) fn value(self) -> f64 {
        // An infinite sum has no error to add (∞ − ∞).
        if self.sum.is_finite() { self.sum + self.error } else { self.sum }
    }
}

/// Adds the lanes pairwise.
#[inline(always)]
pub(crate) fn fold(lanes: [f64; LANES]) -> f64 {
    ((lanes[0] + lanes[4]) + (lanes[2] + lanes[6])) + ((lanes[1] + lanes[5]) + (lanes[3] + lanes[7]))
}

/// Σ aᵢ bᵢ over the shorter of the two.
#[inline(always)]
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut total = Compensated::default();
    for (a, b) in a.chunks(BLOCK).zip(b.chunks(BLOCK)) {
        let mut lanes = [0.0; LANES];
        let (a8, b8) = (a.chunks_exact(LANES), b.chunks_exact(LANES));
        let tail = a8.remainder().iter().zip(b8.remainder());
        for (lane, (x, y)) in lanes.iter_mut().zip(tail) {
            *lane = x * y;
        }
        for (x, y) in a8.zip(b8) {
            for i in 0..LANES {
                lanes[i] = x[i].mul_add(y[i], lanes[i]);
            }
        }
        total.add(fold(lanes));
    }
    total.value()
}

/// Σ xᵢ.
#[inline(always)]
pub(crate) fn sum(x: &[f64]) -> f64 {
    let mut total = Compensated::default();
    for block in x.chunks(BLOCK) {
        let mut lanes = [0.0; LANES];
        let eights = block.chunks_exact(LANES);
        for (lane, x) in lanes.iter_mut().zip(eights.remainder()) {
            *lane = *x;
        }
        for x in eights {
            for i in 0..LANES {
                lanes[i] += x[i];
            }
        }
        total.add(fold(lanes));
    }
    total.value()
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
