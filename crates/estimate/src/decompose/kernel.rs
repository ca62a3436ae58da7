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

mod over_bands;

pub(super) use self::over_bands::{Bent, Compared, Fitting, over_bands};

use super::model::{Hermite, MOST, Model};
use hadar::simd::dispatched;

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
    room: Vec<f64>,
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
    if accumulate(model, asked, sums) {
        sums.deviance = far_deviance(asked.shifted, &mean_counts(model, asked));
    }
}

/// N′ of every band at a state.
pub(super) fn mean_counts(model: &Model, asked: Asked<'_>) -> Vec<f64> {
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
    /// Σ (N − X)²/N′ with X what the surroundings would send in the pixel's place: whether they differ at all. N is left in `mean`.
    pub(super) fn contrast<'a>(model: &'a Model, asked: Asked<'a>, mean: &'a mut [f64]) -> f64 {
        let place = model.place(asked.temperature_k);
        emit(Hermite::at(place.share).value, model.emission(asked.m, place.row), mean);
        let scale = model.scale(asked.mixture);
        mean.iter_mut().for_each(|n| *n *= scale);
        for (j, u) in asked.mixture.iter().enumerate() {
            mean.iter_mut().zip(model.scattered_of(asked.m, j)).for_each(|(n, c)| *n = u.mul_add(*c, *n));
        }
        let mut total = 0.0;
        for (w, n) in mean.iter().enumerate().take(model.used.len()) {
            let mut off = *n;
            for (j, u) in asked.mixture.iter().enumerate() {
                off -= u * model.light(j)[w];
            }
            total += off * off / f64::max(n + model.var_added[w], FEWEST);
        }
        total
    }
}

/// D of counts n′ and their means where some band is off by more than half.
pub(super) fn far_deviance(shifted: &[f64], mean: &[f64]) -> f64 {
    let each = shifted.iter().zip(mean).map(|(n, mean)| {
        let logarithm = if *n > 0.0 { n * libm::log(n / mean) } else { 0.0 };
        2.0 * (logarithm - (n - mean))
    });
    each.sum()
}

dispatched! {
    /// Fills `sums`; whether the series does not hold. Loops over all bands for what is each band's own, and chunks for what is
    /// added up: the compiler makes whole vectors of both.
    fn accumulate<'a>(model: &'a Model, asked: Asked<'a>, sums: &'a mut Sums) -> bool {
        let (width, count) = (model.width, model.unknowns());
        let place = model.place(asked.temperature_k);
        let hermite = Hermite::at(place.share);
        let scale = model.scale(asked.mixture);
        let per_kelvin = scale / place.step_k;
        sums.room.resize(width * (count + 4), 0.0);
        let (mean, rest) = sums.room.split_at_mut(width);
        let (weight, rest) = rest.split_at_mut(width);
        let (relative, rest) = rest.split_at_mut(width);
        let (series, columns) = rest.split_at_mut(width);
        let [v0, s0, v1, s1, factor] = model.emission(asked.m, place.row);
        emit(hermite.value, [v0, s0, v1, s1, factor], mean);
        let (first, weights) = match model.gain {
            true => (None, asked.mixture),
            false => (Some(model.base(asked.m)), &asked.mixture[1..]),
        };
        for (to, from) in columns[width..].chunks_exact_mut(width).zip(model.columns(asked.m)) {
            match model.gain {
                true => to.iter_mut().zip(from.iter().zip(&*mean)).for_each(|(to, (c, value))| *to = c + value),
                false => to.copy_from_slice(from),
            }
        }
        for (mean, noise) in mean.iter_mut().zip(&*model.var_added) {
            *mean = scale.mul_add(*mean, *noise);
        }
        if let Some(base) = first {
            mean.iter_mut().zip(base).for_each(|(mean, base)| *mean += base);
        }
        for (u, column) in weights.iter().zip(model.columns(asked.m)) {
            mean.iter_mut().zip(column).for_each(|(mean, c)| *mean = u.mul_add(*c, *mean));
        }
        let slope = &mut columns[..width];
        emit(hermite.slope, [v0, s0, v1, s1, factor], slope);
        slope.iter_mut().for_each(|slope| *slope *= per_kelvin);
        compare(asked.shifted, mean, weight, relative, series);
        let compared = Compared { counts: asked.shifted, mean, weight, relative, series, columns };
        let Fitting { deviance, chi_square, is_far } =
            over_bands(compared, count, Bent { slope: &mut sums.slope, information: &mut sums.information });
        (sums.deviance, sums.chi_square) = (deviance, chi_square);
        is_far
    }
}

/// Values or slopes of the table, mixed in these shares, times the factors.
#[inline(always)]
pub(super) fn emit(shares: [f64; 4], [a, b, c, d, factor]: [&[f64]; 5], to: &mut [f64]) {
    let [p, q, r, s] = shares;
    let ends = a.iter().zip(b).zip(c.iter().zip(d));
    for ((to, factor), ((a, b), (c, d))) in to.iter_mut().zip(factor).zip(ends) {
        *to = factor * p.mul_add(*a, q.mul_add(*b, r.mul_add(*c, s * d)));
    }
}

/// 1/N′, r/N′ and s(x) of every band; N′ at least [`FEWEST`].
#[inline(always)]
pub(super) fn compare(
    counts: &[f64],
    mean: &mut [f64],
    weight: &mut [f64],
    relative: &mut [f64],
    series: &mut [f64],
) {
    let out = weight.iter_mut().zip(relative).zip(series);
    for ((n, mean), ((weight, relative), series)) in counts.iter().zip(mean).zip(out) {
        *mean = if *mean > FEWEST { *mean } else { FEWEST };
        let sum = n + *mean;
        let both = 1.0 / (*mean * sum);
        let residual = n - *mean;
        *weight = both * sum;
        *relative = residual * *weight;
        let x = residual * (both * *mean);
        let square = x * x;
        let mut inner = SERIES[7];
        for a in SERIES[..7].iter().rev() {
            inner = inner.mul_add(square, *a);
        }
        // s = (1 − x)(1 + (x + x²) series)
        let inner = (x + square).mul_add(inner, 1.0);
        *series = (-x).mul_add(inner, inner);
    }
}
