//! Intervals of temperature, eight side by side, and their products with a target. Symbols as in [`super`].

use super::kernels::Products;
use crate::simd::{Chunk, LANES};

/// Eight intervals side by side, of each band p, d and h.
pub(super) struct Eight {
    low: Vec<Chunk>,
    rise: Vec<Chunk>,
    half: Vec<Chunk>,
}

/// p, d and h of one interval.
pub(super) struct Interval {
    pub(super) low: Vec<f64>,
    pub(super) rise: Vec<f64>,
    pub(super) half: Vec<f64>,
}

impl Interval {
    pub(super) fn zeros(bands: usize) -> Self {
        Self { low: vec![0.0; bands], rise: vec![0.0; bands], half: vec![0.0; bands] }
    }
}

impl Eight {
    pub(super) fn of(some: &[Interval]) -> Self {
        Self::of_all(&some.iter().collect::<Vec<_>>())
    }

    /// Of at most eight intervals; where there are fewer the last one stands again.
    pub(super) fn of_all(some: &[&Interval]) -> Self {
        let side = |of: fn(&Interval) -> &[f64]| -> Vec<Chunk> {
            let bands = some.first().map_or(0, |one| of(one).len());
            (0..bands).map(|w| std::array::from_fn(|k| of(some[k.min(some.len() - 1)])[w])).collect()
        };
        Self { low: side(|one| &one.low), rise: side(|one| &one.rise), half: side(|one| &one.half) }
    }

    /// Its products with a target, band by band, from r, x − N, a and x: N′ − N = e′(P + σd) + (1 − e′)V′a + (x − N) with P = p − x.
    pub(super) fn products(&self, [weight, rest, light, known]: [&[f64]; 4]) -> Vec<Products> {
        crate::stop::check();
        let times =
            |factor: f64, a: Chunk, b: Chunk| -> Chunk { std::array::from_fn(|k| factor * a[k] * b[k]) };
        let one = [1.0; LANES];
        let of_band = |w: usize| {
            let (r, rest, light) = (weight[w], rest[w], light[w]);
            let (rise, half) = (self.rise[w], self.half[w]);
            let above: Chunk = std::array::from_fn(|k| self.low[w][k] - known[w]);
            [
                times(r, rise, rise),
                times(r, rise, above),
                times(r, above, above),
                times(r, half, half),
                times(r * light, rise, one),
                times(r * light, above, one),
                times(r * rest, rise, one),
                times(2.0 * r * rest, above, one),
            ]
        };
        (0..weight.len()).map(of_band).collect()
    }
}
