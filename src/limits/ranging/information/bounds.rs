//! An upper bound of the information of pixels that takes a third of the operations and one division.
//!
//! With the bands of a pixel dealt out to [`LANES`] lanes, Σ_b (∂N)²/(N + σ²) ≤ Σ_lane Σ(∂N)²/(min N + min σ²). Sums
//! and minima are taken in the precision of the samples. The last vector may reach into the next column: terms more
//! and a smaller minimum only raise the bound.
//!
//! Rounding: a difference of two samples, its square and the sum of n squares are at most n + 3 roundings of 2⁻²⁴
//! below, a square that underflows some n times the smallest number; both are made good. Where a count is negative
//! the bound is infinite, where one is NaN or infinite it is NaN: neither proves anything.

use super::direct::{Stretch, last};
use crate::cube::Sample;
use crate::simd::{Chunk, LANES, dispatched, fold_all};

/// Samples that bounds can be taken of.
pub(super) trait Bounded: Sample {
    /// Bounds for all columns but the first and the last of a stretch of two more than there is room for in `to`.
    fn bounds(of: Stretch<'_, Self>, var_least: f64, lanes: &mut Vec<Chunk>, to: &mut [f64]);
}

macro_rules! bounded {
    ($sample:ty, $name:ident) => {
        dispatched! {
            fn $name<'a>(
                of: Stretch<'a, $sample>, var_least: f64, lanes: &'a mut Vec<Chunk>, to: &'a mut [f64]
            ) -> () {
                let Stretch { samples, bands } = of;
                let (mut left_spare, mut right_spare, mut own_spare) =
                    ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
                lanes.resize(to.len(), [0.0; LANES]);
                for (x, lane) in lanes.iter_mut().enumerate() {
                    let column = |x: usize| &samples[x * bands..];
                    let (left, own, right) = (column(x), column(x + 1), column(x + 2));
                    let whole = |column: &'a [$sample]| column[..bands].as_chunks::<LANES>().0.iter();
                    let mut sum = [<$sample>::MIN_POSITIVE; LANES];
                    let mut least = [<$sample>::INFINITY; LANES];
                    for (own, (left, right)) in whole(own).zip(whole(left).zip(whole(right))) {
                        (sum, least) = take(*left, *own, *right, (sum, least));
                    }
                    if bands % LANES > 0 {
                        let left = *last(left, bands, &mut left_spare);
                        let right = *last(right, bands, &mut right_spare);
                        (sum, least) = take(left, *last(own, bands, &mut own_spare), right, (sum, least));
                    }
                    *lane = std::array::from_fn(|i| {
                        let below = if least[i] < 0.0 { 0.0 } else { f64::from(least[i]) + var_least };
                        f64::from(sum[i]) / below
                    });
                }
                fold_all(lanes, 0.25 * (1.0 + (bands + 16) as f64 * f64::from(f32::EPSILON)), to);

                #[inline(always)]
                fn take(
                    left: [$sample; LANES],
                    own: [$sample; LANES],
                    right: [$sample; LANES],
                    (sum, least): ([$sample; LANES], [$sample; LANES]),
                ) -> ([$sample; LANES], [$sample; LANES]) {
                    let d: [$sample; LANES] = std::array::from_fn(|i| right[i] - left[i]);
                    (
                        // 0, but NaN if the count is NaN or infinite.
                        std::array::from_fn(|i| d[i].mul_add(d[i], own[i].mul_add(0.0, sum[i]))),
                        std::array::from_fn(|i| if own[i] < least[i] { own[i] } else { least[i] }),
                    )
                }
            }
        }

        impl Bounded for $sample {
            fn bounds(of: Stretch<'_, Self>, var_least: f64, lanes: &mut Vec<Chunk>, to: &mut [f64]) {
                $name(of, var_least, lanes, to);
            }
        }
    };
}

bounded!(f32, bounds_f32);
bounded!(f64, bounds_f64);
