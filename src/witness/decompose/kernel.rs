//! Deviance of a pixel's counts at one state of one material, and the Fisher information there.
//!
//! With n′ = n + σ², N′ = N + σ² (counts and electronic noise σ² together as one Poisson variate: variance N + σ² from the model, not
//! from the count) and r = n′ − N′:
//!
//! * deviance D = 2 Σ [n′ ln(n′/N′) − r], what a likelihood lacks of its most; with x = r/(n′ + N′) it is Σ (r²/N′)·s(x),
//!   s = (1 − x)[1 + x(1 + x)(1/3 + x²/5 + x⁴/7 + …)], in which nothing cancels;
//! * Pearson's χ² = Σ r²/N′;
//! * slope Σ r ∂ᵢN/N′ and information Σ ∂ᵢN ∂ⱼN/N′ (S27): the root of the one is that of the Poisson likelihood.
//!
//! Source: Snyder, Hammoud and White, J. Opt. Soc. Am. A 10, 1014 (1993), doi:10.1364/JOSAA.10.001014, for σ² in the count.

use super::model::{Hermite, MOST_SURROUNDINGS, Model};
use crate::simd::{Chunk, LANES, Largest, added, dispatched, fold, fused, product};

/// Most unknown numbers: the temperature, and a weight of each vertex.
pub(super) const MOST: usize = MOST_SURROUNDINGS + 2;
/// |x| up to which the series is taken: the first term left out is x¹⁶/19 of 1/3.
const SMALL: f64 = 0.25;
/// Coefficients of the series in x².
const SERIES: [f64; 8] =
    [1.0 / 3.0, 1.0 / 5.0, 1.0 / 7.0, 1.0 / 9.0, 1.0 / 11.0, 1.0 / 13.0, 1.0 / 15.0, 1.0 / 17.0];
/// Fewest counts that a model sends: less than that cannot be told from nothing.
const FEWEST: f64 = 1e-6;

/// Sums over the bands. Unknown 0 is the temperature (K), unknown 1 + j the weight of vertex j; of a calibrated camera that weight
/// is taken off vertex 0, which is no unknown.
#[derive(Debug, Clone, Default)]
pub(super) struct Sums {
    pub(super) information: [[f64; MOST]; MOST],
    pub(super) slope: [f64; MOST],
    pub(super) chi_square: f64,
    pub(super) deviance: f64,
}

/// A state of a material before the counts n′ of a pixel.
#[derive(Debug, Clone, Copy)]
pub(super) struct Asked<'a> {
    pub(super) m: usize,
    pub(super) shifted: &'a [f64],
    pub(super) temperature_k: f64,
    pub(super) mixture: &'a [f64],
}

/// The sums at a state.
pub(super) fn sums(model: &Model, asked: Asked<'_>, sums: &mut Sums) {
    if accumulate(model, asked, sums) > SMALL {
        sums.deviance = far_deviance(model, asked);
    }
}

/// N′ of every band at a state.
fn mean_counts(model: &Model, asked: Asked<'_>) -> Vec<f64> {
    let (mut mean, _) = model.emitted(asked.m, asked.temperature_k);
    let scale = model.scale(asked.mixture);
    mean.iter_mut().zip(&*model.var_added).for_each(|(n, var)| *n = scale.mul_add(*n, *var));
    for (u, column) in asked.mixture.iter().zip(model.scattered(asked.m).chunks(model.width)) {
        mean.iter_mut().zip(column).for_each(|(n, c)| *n = u.mul_add(*c, *n));
    }
    mean.iter_mut().for_each(|n| *n = n.max(FEWEST));
    mean
}

dispatched! {
    /// Σ (N − X)²/N′ with X what the surroundings would send in the pixel's place: whether they differ at all.
    pub(super) fn contrast<'a>(model: &'a Model, asked: Asked<'a>) -> f64 {
        let count = model.width / LANES;
        let place = model.place(asked.temperature_k);
        let shares = Hermite::at(place.share).value;
        let [v0, s0, v1, s1, factor] = model.emission(asked.m, place.row);
        let (v0, s0, v1) = (in_chunks(v0, count), in_chunks(s0, count), in_chunks(v1, count));
        let (s1, factor) = (in_chunks(s1, count), in_chunks(factor, count));
        let scale = model.scale(asked.mixture);
        let noise = in_chunks(&model.var_added, count);
        let mut total = [0.0; LANES];
        for c in 0..count {
            let value = product(factor[c], mixed(shares, [v0[c], s0[c], v1[c], s1[c]]));
            let (mut mean, mut off) = (fused(scale, value, noise[c]), product([scale; LANES], value));
            for (j, u) in asked.mixture.iter().enumerate() {
                let scattered = in_chunks(model.scattered_of(asked.m, j), count)[c];
                let light = in_chunks(model.light(j), count)[c];
                mean = fused(*u, scattered, mean);
                off = fused(*u, std::array::from_fn(|i| scattered[i] - light[i]), off);
            }
            let relative: Chunk = std::array::from_fn(|i| off[i] / f64::max(mean[i], FEWEST));
            total = added(off, relative, total);
        }
        fold(&total)
    }
}

/// D where some band is off by more than half.
fn far_deviance(model: &Model, asked: Asked<'_>) -> f64 {
    let mean = mean_counts(model, asked);
    let each = asked.shifted.iter().zip(&mean).map(|(n, mean)| {
        let logarithm = if *n > 0.0 { n * libm::log(n / mean) } else { 0.0 };
        2.0 * (logarithm - (n - mean))
    });
    each.sum()
}

dispatched! {
    /// Fills `sums`; the largest |x|.
    fn accumulate<'a>(model: &'a Model, asked: Asked<'a>, sums: &'a mut Sums) -> f64 {
        // Compiled for the few unknowns of most scenes; with more of them columns of zeros fill up.
        match (model.unknowns(), model.gain) {
            (1, false) => pass::<1, false>(model, asked, sums),
            (2, false) => pass::<2, false>(model, asked, sums),
            (3, false) => pass::<3, false>(model, asked, sums),
            (_, false) => pass::<MOST, false>(model, asked, sums),
            (2, true) => pass::<2, true>(model, asked, sums),
            (3, true) => pass::<3, true>(model, asked, sums),
            (_, true) => pass::<MOST, true>(model, asked, sums),
        }
    }
}

/// Four values in these shares. A function, since a closure's body need not be compiled for the same processor.
#[inline(always)]
fn mixed(shares: [f64; 4], of: [Chunk; 4]) -> Chunk {
    let last = product([shares[3]; LANES], of[3]);
    fused(shares[0], of[0], fused(shares[1], of[1], fused(shares[2], of[2], last)))
}

#[inline(always)]
fn in_chunks(values: &[f64], count: usize) -> &[Chunk] {
    &values.as_chunks::<LANES>().0[..count]
}

/// The sums for `P` unknowns.
#[inline(always)]
fn pass<const P: usize, const GAIN: bool>(model: &Model, asked: Asked<'_>, sums: &mut Sums) -> f64 {
    let count = model.width / LANES;
    let place = model.place(asked.temperature_k);
    let hermite = Hermite::at(place.share);
    let [v0, s0, v1, s1, factor] = model.emission(asked.m, place.row);
    let (v0, s0, v1) = (in_chunks(v0, count), in_chunks(s0, count), in_chunks(v1, count));
    let (s1, factor) = (in_chunks(s1, count), in_chunks(factor, count));
    let scale = model.scale(asked.mixture);
    let per_kelvin = scale / place.step_k;
    let base = in_chunks(model.base(asked.m), count);
    let (noise, counts) = (in_chunks(&model.var_added, count), in_chunks(asked.shifted, count));
    let mut columns = [base; P];
    let mut weights = [0.0; P];
    for (j, (column, u)) in model.columns(asked.m).zip(&asked.mixture[usize::from(!GAIN)..]).enumerate() {
        columns[j + 1] = in_chunks(column, count);
        weights[j + 1] = *u;
    }
    let filled = model.unknowns();
    let (mut chi, mut deviance, mut worst) = ([0.0; LANES], [0.0; LANES], Largest::default());
    let (mut slope, mut information) = ([[0.0; LANES]; P], [[[0.0; LANES]; P]; P]);
    for c in 0..count {
        let ends = [v0[c], s0[c], v1[c], s1[c]];
        let value = product(factor[c], mixed(hermite.value, ends));
        let rise = product(factor[c], mixed(hermite.slope, ends));
        let mut mean = fused(scale, value, noise[c]);
        if !GAIN {
            mean = std::array::from_fn(|i| mean[i] + base[c][i]);
        }
        let mut derivative = [[0.0; LANES]; P];
        derivative[0] = product([per_kelvin; LANES], rise);
        for j in 1..P {
            if P < MOST || j < filled {
                mean = fused(weights[j], columns[j][c], mean);
                derivative[j] = columns[j][c];
                if GAIN {
                    derivative[j] = std::array::from_fn(|i| derivative[j][i] + value[i]);
                }
            }
        }
        let mean: Chunk = std::array::from_fn(|i| if mean[i] > FEWEST { mean[i] } else { FEWEST });
        let n = counts[c];
        let sum: Chunk = std::array::from_fn(|i| n[i] + mean[i]);
        let both: Chunk = std::array::from_fn(|i| 1.0 / (mean[i] * sum[i]));
        let weight = product(both, sum);
        let residual: Chunk = std::array::from_fn(|i| n[i] - mean[i]);
        let x = product(residual, product(both, mean));
        worst.see(x);
        let relative = product(residual, weight);
        let square = product(x, x);
        let mut series = [SERIES[7]; LANES];
        for a in SERIES[..7].iter().rev() {
            series = added(series, square, [*a; LANES]);
        }
        // s = (1 − x)(1 + (x + x²) series)
        let odd: Chunk = std::array::from_fn(|i| x[i] + square[i]);
        let inner = added(odd, series, [1.0; LANES]);
        let s: Chunk = std::array::from_fn(|i| (-x[i]).mul_add(inner[i], inner[i]));
        let squared = product(residual, relative);
        chi = std::array::from_fn(|i| chi[i] + squared[i]);
        deviance = added(squared, s, deviance);
        for i in 0..P {
            if P < MOST || i < filled {
                slope[i] = added(derivative[i], relative, slope[i]);
                let weighted = product(derivative[i], weight);
                for j in 0..=i {
                    information[i][j] = added(derivative[j], weighted, information[i][j]);
                }
            }
        }
    }
    for i in 0..P {
        sums.slope[i] = fold(&slope[i]);
        for j in 0..=i {
            let dot = fold(&information[i][j]);
            (sums.information[i][j], sums.information[j][i]) = (dot, dot);
        }
    }
    sums.chi_square = fold(&chi);
    sums.deviance = fold(&deviance);
    worst.value()
}
