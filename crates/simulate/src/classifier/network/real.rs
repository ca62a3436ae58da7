//! Numbers of several spectra side by side, in single or double precision.
//!
//! Vectors are written out with `pulp`: left to itself, the compiler turns these loops into gathers, at a third of the
//! speed.

use pulp::Simd;
use std::ops::{Add, Div, Mul, Sub};

/// Single precision for the product, double to check gradients with.
pub(super) trait Real:
    Copy
    + PartialOrd
    + Send
    + Sync
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
{
    const ZERO: Self;
    fn of(value: f64) -> Self;
    fn to_f64(self) -> f64;
    /// a·b + c.
    fn fused(self, b: Self, c: Self) -> Self;
    /// a·b + c in every lane, for one `a`.
    fn scaled<S: Simd, const L: usize>(simd: S, a: Self, b: &[Self; L], c: &mut [Self; L]);
    /// a·b + c in every lane.
    fn product<S: Simd, const L: usize>(simd: S, a: &[Self; L], b: &[Self; L], c: &mut [Self; L]);
    fn exp(self) -> Self;
    fn ln(self) -> Self;
    fn sqrt(self) -> Self;
}

macro_rules! real {
    ($t:ty, $as_simd:ident, $as_mut_simd:ident, $splat:ident, $mul_add:ident) => {
        impl Real for $t {
            const ZERO: Self = 0.0;
            #[inline(always)]
            fn of(value: f64) -> Self {
                value as $t
            }
            #[inline(always)]
            fn to_f64(self) -> f64 {
                f64::from(self)
            }
            #[inline(always)]
            fn fused(self, b: Self, c: Self) -> Self {
                self.mul_add(b, c)
            }
            #[inline(always)]
            fn scaled<S: Simd, const L: usize>(simd: S, a: Self, b: &[Self; L], c: &mut [Self; L]) {
                let ((b, b_rest), (c, c_rest)) = (S::$as_simd(b), S::$as_mut_simd(c));
                for (b, c) in b.iter().zip(c) {
                    *c = simd.$mul_add(simd.$splat(a), *b, *c);
                }
                for (b, c) in b_rest.iter().zip(c_rest) {
                    *c = a.mul_add(*b, *c);
                }
            }
            #[inline(always)]
            fn product<S: Simd, const L: usize>(simd: S, a: &[Self; L], b: &[Self; L], c: &mut [Self; L]) {
                let ((a, a_rest), (b, b_rest)) = (S::$as_simd(a), S::$as_simd(b));
                let (c, c_rest) = S::$as_mut_simd(c);
                for ((a, b), c) in a.iter().zip(b).zip(c) {
                    *c = simd.$mul_add(*a, *b, *c);
                }
                for ((a, b), c) in a_rest.iter().zip(b_rest).zip(c_rest) {
                    *c = a.mul_add(*b, *c);
                }
            }
            #[inline(always)]
            fn exp(self) -> Self {
                self.exp()
            }
            #[inline(always)]
            fn ln(self) -> Self {
                self.ln()
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                self.sqrt()
            }
        }
    };
}
real!(f32, as_simd_f32s, as_mut_simd_f32s, splat_f32s, mul_add_f32s);
real!(f64, as_simd_f64s, as_mut_simd_f64s, splat_f64s, mul_add_f64s);

/// One number of `L` spectra.
pub(super) type Lanes<T, const L: usize> = [T; L];

/// Sum of the lanes, pairwise.
#[inline(always)]
pub(super) fn total<T: Real, const L: usize>(mut x: Lanes<T, L>) -> T {
    let mut width = L;
    while width > 1 {
        let half = width.div_ceil(2);
        for i in half..width {
            x[i - half] = x[i - half] + x[i];
        }
        width = half;
    }
    x.first().copied().unwrap_or(T::ZERO)
}

/// ReLU lets gradients through where its output is above 0.
#[inline(always)]
pub(super) fn mask<T: Real, const L: usize>(x: &[Lanes<T, L>], g: &mut [Lanes<T, L>]) {
    for (g, x) in g.iter_mut().zip(x) {
        *g = std::array::from_fn(|i| if x[i] > T::ZERO { g[i] } else { T::ZERO });
    }
}
