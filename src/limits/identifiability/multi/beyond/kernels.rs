//! Sums over the bands of eight intervals side by side, and what they bound. Symbols as in [`super`].

use crate::identifiability::rectangle::OverRectangle;
use crate::simd::{Chunk, LANES, dispatched, fold, fused, padded};

/// Sums: four with e′² (r d², r d P, r P², r h²), two with e′(1 − e′) (r d a, r a P), two with e′ (r d (x − N), 2 r P (x − N)).
pub(super) const PRODUCTS: usize = 8;
pub(super) type Products = [Chunk; PRODUCTS];
/// Rounding of lengths and of sums, as shares of what they are made of.
const GRAIN: f64 = 1e-13;
const SUMS: f64 = 1e-12;

/// What of the quadratic hangs on the alternative and not on the interval: Σ r a²(1 − e′)², Σ r a (1 − e′)(x − N), Σ r (x − N)².
#[derive(Clone, Copy)]
pub(super) struct Level {
    pub(super) light: f64,
    pub(super) slope: f64,
    pub(super) rest: f64,
    pub(super) lighting: [f64; 2],
}

/// The sums over the bands, each with its power of e′.
#[inline(always)]
fn products(columns: &[Products], emissivity: &[f64]) -> Products {
    let mut sums = [[0.0; LANES]; PRODUCTS];
    for (columns, &e) in columns.iter().zip(emissivity) {
        // e′(1 − e′) as a product: the difference e′ − e′² would lose digits near 1, where light may be far brighter than emission.
        let (square, mixed) = (e * e, (1.0 - e) * e);
        let factors = [square, square, square, square, mixed, mixed, e, e];
        for i in 0..PRODUCTS {
            sums[i] = fused(factors[i], columns[i], sums[i]);
        }
    }
    sums
}

dispatched! {
    /// Σ r a²(1 − e′)², Σ r a (1 − e′)(x − N), Σ r (x − N)².
    pub(super) fn lit_sums<'a>(weight: &'a [f64], rest: &'a [f64], light: &'a [f64], emissivity: &'a [f64]) -> [f64; 3] {
        let mut sums = [[0.0; LANES]; 3];
        let chunks = |x: &'a [f64]| x.chunks(LANES).map(padded);
        let spectra = chunks(weight).zip(chunks(rest)).zip(chunks(light)).zip(chunks(emissivity));
        for (((weight, rest), light), e) in spectra {
            for k in 0..LANES {
                let lit = light[k] * (1.0 - e[k]);
                sums[0][k] = (weight[k] * lit).mul_add(lit, sums[0][k]);
                sums[1][k] = (weight[k] * lit).mul_add(rest[k], sums[1][k]);
                sums[2][k] = (weight[k] * rest[k]).mul_add(rest[k], sums[2][k]);
            }
        }
        sums.map(|sum| fold(&sum))
    }
}

dispatched! {
    /// A lower bound of √(Σ r (N′ − N)²) in each of eight intervals.
    pub(super) fn lengths<'a>(columns: &'a [Products], emissivity: &'a [f64], level: Level) -> Chunk {
        let sums = products(columns, emissivity);
        let Level { light: vv, slope, rest, lighting } = level;
        let mut lengths = [0.0; LANES];
        for k in 0..LANES {
            let (ss, sv, hh) = (sums[0][k], sums[4][k], sums[3][k]);
            let (s, v) = (sums[1][k] + sums[6][k], sums[5][k] + slope);
            let c = sums[2][k] + sums[7][k] + rest;
            let quadratic = OverRectangle { xx: ss, xy: sv, yy: vv, x: s, y: v, range: lighting };
            // What the sums are made of: each product is at most the squares of its factors.
            let size = sums[2][k] + rest + ss + lighting[1] * lighting[1] * vv;
            let square = c + quadratic.least() - SUMS * size;
            let square = if square > 0.0 { square } else { 0.0 };
            lengths[k] = square.sqrt() - hh.sqrt() * (1.0 + GRAIN) - GRAIN * size.sqrt();
        }
        lengths
    }
}
