//! Maximum likelihood where the emissivities of the library are themselves not exact.
//!
//! With errors δ of the emissivity in each band, of covariance Σ, a pixel's counts have the covariance
//! C = diag(N′) + D Σ D, D_w = κ_w ∫ (B(T) − X) over band w: what a change of the emissivity changes. The cost is the Gaussian
//! rᵀC⁻¹r + ln det C, C at the state at hand. Σ is written as its few large modes and a remainder on the diagonal, so that
//! C = V + M Mᵀ with diagonal V: products with C⁻¹ are those with V⁻¹ less the squares of h = L⁻¹ Mᵀ V⁻¹ x, where
//! L Lᵀ = 1 + Mᵀ V⁻¹ M (Woodbury); nothing is inverted.
//!
//! Σ_vw = s² e_v e_w (1 + x + x²/3) e⁻ˣ, x = 3.55 |ν_v − ν_w|/ℓ (Matérn, 5/2): errors of laboratory spectra are smooth, but not
//! without an end. s: root mean square error as a share of the emissivity e, ℓ: where the correlation has fallen to a quarter.
//!
//! What is stated of s is the most that a spectrum is off; one material's may be better than another's. Among materials each is
//! therefore worth what its cost is at the best s between 0 and the stated one ([`LADDER`]): else a library that is better than its user
//! says would lose, by ln det C, against a mirror of surroundings that are taken for exact. Temperature, deviations and χ² are those at
//! the stated s.
//!
//! Assumptions: the errors of the materials are Gaussian and independent of each other; each pixel is taken for itself, so that what
//! pixels of one material share of an error does not average out in them.

use super::fit::{COMPARED, Fit, MOST_LOOKS};
use super::kernel::{Sums, weighted};
use super::model::{Hermite, Model};
use super::step::State;
use hadar::correlation::{covariance, eigen, matern};
use hadar::error::{Result, check};
use hadar::simd::{LANES, added, dispatched, fold};

/// Modes smaller than this share of the largest go to the diagonal.
const SMALL_MODE: f64 = 1e-3;
/// Shares of the stated error at which materials are compared, besides all of it and none.
const LADDER: [f64; 4] = [0.5, 0.25, 0.125, 0.0625];
/// Cost beyond the best one at which a first look is the last: a step may promise less than many of them bring.
const HOPELESS: f64 = 200.0;
/// Cost beyond the best one from which on the share of the errors is no matter: more than what counts ([`super::pixel::CUT`]).
const BESIDE: f64 = 30.0;
/// Fewest counts of a model.
const FEWEST: f64 = 1e-6;

/// How wrong the emissivities of a library may be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LibraryError {
    /// Root mean square error s of an emissivity, as a share of it.
    pub relative: f64,
    /// Difference ℓ of wavenumbers at which the correlation of errors has fallen to a quarter, cm⁻¹.
    pub correlation_cm1: f64,
}

/// Σ of a [`LibraryError`] in the bands that count.
#[derive(Debug)]
pub(super) struct Modes {
    /// √eigenvalue × eigenvector, one after the other, as wide as the model.
    modes: Vec<Vec<f64>>,
    /// Variance that they leave in each band.
    rest: Vec<f64>,
}

impl Modes {
    pub(super) fn new(model: &Model, error: LibraryError) -> Result<Self> {
        check::positive("error of the emissivities", error.relative, "")?;
        check::positive("correlation of the errors of the emissivities", error.correlation_cm1, "cm^-1")?;
        let nu = &model.centres_cm1;
        let s = error.relative;
        let eigen =
            eigen(covariance(nu.len(), |i, j| s * s * matern(nu[i] - nu[j], error.correlation_cm1))?)?;
        let largest = eigen.eigenvalues.max();
        let mut rest = vec![0.0; model.width];
        rest[..nu.len()].fill(s * s);
        let mut modes = Vec::new();
        for (k, &value) in eigen.eigenvalues.iter().enumerate() {
            if value > SMALL_MODE * largest {
                let mut mode = vec![0.0; model.width];
                for (w, mode) in mode[..nu.len()].iter_mut().enumerate() {
                    *mode = value.sqrt() * eigen.eigenvectors[(w, k)];
                    rest[w] = f64::max(rest[w] - *mode * *mode, 0.0);
                }
                modes.push(mode);
            }
        }
        Ok(Self { modes, rest })
    }

    /// Of a share of the error; of none, what costs next to nothing.
    fn smaller(&self, share: f64) -> Self {
        let of = |mode: &Vec<f64>| mode.iter().map(|x| share * x).collect();
        Self {
            modes: self.modes.iter().filter(|_| share > 0.0).map(of).collect(),
            rest: self.rest.iter().map(|var| share * share * var).collect(),
        }
    }
}

/// The stated errors, and the smaller ones at which materials are compared.
#[derive(Debug)]
pub(super) struct Errors {
    pub(super) stated: Modes,
    smaller: Vec<Modes>,
    none: Modes,
}

impl Errors {
    pub(super) fn new(model: &Model, error: LibraryError) -> Result<Self> {
        let stated = Modes::new(model, error)?;
        let smaller = LADDER.iter().map(|share| stated.smaller(*share)).collect();
        let none = stated.smaller(0.0);
        Ok(Self { stated, smaller, none })
    }
}

/// Room for one pixel's work.
#[derive(Debug, Default)]
pub(super) struct Workplace {
    mean: Vec<f64>,
    /// Σ ln of the counts: ln det C were there no errors.
    least_logarithm: f64,
    /// 1/V.
    weight: Vec<f64>,
    /// r, then the columns.
    vectors: Vec<Vec<f64>>,
    /// M, mode by mode.
    scaled: Vec<Vec<f64>>,
    /// L, row by row, with zeros behind each.
    factor: Vec<Vec<f64>>,
    /// h of each vector.
    images: Vec<Vec<f64>>,
}

dispatched! {
    /// Cost, slope and information at a state.
    fn look<'a>(
        place: &'a mut Workplace,
        model: &'a Model,
        modes: &'a Modes,
        m: usize,
        shifted: &'a [f64],
        state: &'a State,
        to: &'a mut Sums,
    ) {
        place.sums(model, modes, m, shifted, state, to);
    }
}

impl Workplace {
    #[inline(always)]
    fn sums(
        &mut self,
        model: &Model,
        modes: &Modes,
        m: usize,
        shifted: &[f64],
        state: &State,
        to: &mut Sums,
    ) {
        let width = model.width;
        let used = model.used.len();
        let mixture = &state.mixture[..model.vertices];
        let place = model.place(state.temperature_k);
        let hermite = Hermite::at(place.share);
        let [v0, s0, v1, s1, factor] = model.emission(m, place.row);
        let scale = model.scale(mixture);
        let blackbody = model.blackbody(state.temperature_k);
        let count = model.unknowns();
        self.mean.resize(width, 0.0);
        self.weight.resize(width, 0.0);
        self.vectors.resize_with(count + 1, Vec::new);
        self.vectors.iter_mut().for_each(|vector| vector.resize(width, 0.0));
        let mut deviance = 0.0;
        self.least_logarithm = 0.0;
        let mut reach = vec![0.0; width];
        for w in 0..used {
            let mix = |[a, b, c, d]: [f64; 4]| factor[w] * (a * v0[w] + b * s0[w] + c * v1[w] + d * s1[w]);
            let value = mix(hermite.value);
            self.vectors[1][w] = scale * mix(hermite.slope) / place.step_k;
            let (mut mean, mut surroundings) = (scale.mul_add(value, model.var_added[w]), 0.0);
            for (j, u) in mixture.iter().enumerate() {
                mean = u.mul_add(model.scattered_of(m, j)[w], mean);
                surroundings = u.mul_add(model.light(j)[w], surroundings);
            }
            for (i, column) in model.columns(m).enumerate() {
                self.vectors[2 + i][w] = column[w] + if model.gain { value } else { 0.0 };
            }
            let mean = mean.max(FEWEST);
            reach[w] = model.emissivity(m)[w] * scale.mul_add(blackbody[w], -surroundings);
            let variance = (modes.rest[w] * reach[w]).mul_add(reach[w], mean);
            self.vectors[0][w] = shifted[w] - mean;
            self.weight[w] = 1.0 / variance;
            deviance += libm::log(variance);
            self.least_logarithm += libm::log(mean);
        }
        let rank = modes.modes.len();
        self.scaled.resize_with(rank, Vec::new);
        for (scaled, mode) in self.scaled.iter_mut().zip(&modes.modes) {
            scaled.clear();
            scaled.extend(mode.iter().zip(&reach).map(|(mode, reach)| mode * reach));
        }
        // Rows are filled up with zeros to whole chunks.
        let padded = rank.next_multiple_of(LANES);
        self.factor.resize_with(rank, Vec::new);
        for i in 0..rank {
            let mut row = std::mem::take(&mut self.factor[i]);
            row.clear();
            row.resize(padded, 0.0);
            for j in 0..=i {
                let own =
                    weighted(&self.scaled[i], &self.scaled[j], &self.weight) + f64::from(u8::from(i == j));
                let other: &[f64] = if j == i { &row } else { &self.factor[j] };
                let rest = own - dot(&row, other, j);
                // At least 1 on the diagonal: Mᵀ V⁻¹ M adds no less than nothing.
                row[j] = if i == j { rest.max(1.0).sqrt() } else { rest / self.factor[j][j] };
            }
            deviance += 2.0 * libm::log(row[i]);
            self.factor[i] = row;
        }
        self.images.resize_with(count + 1, Vec::new);
        for (image, vector) in self.images.iter_mut().zip(&self.vectors) {
            image.clear();
            image.resize(padded, 0.0);
            for i in 0..rank {
                let along = weighted(&self.scaled[i], vector, &self.weight);
                image[i] = (along - dot(&self.factor[i], image, i)) / self.factor[i][i];
            }
        }
        to.chi_square = self.product(0, 0);
        to.deviance = to.chi_square + deviance;
        for i in 0..count {
            to.slope[i] = self.product(0, i + 1);
            for j in 0..=i {
                let each = self.product(i + 1, j + 1);
                (to.information[i][j], to.information[j][i]) = (each, each);
            }
        }
    }

    /// aᵀ C⁻¹ b of two vectors.
    #[inline(always)]
    fn product(&self, a: usize, b: usize) -> f64 {
        weighted(&self.vectors[a], &self.vectors[b], &self.weight)
            - dot(&self.images[a], &self.images[b], usize::MAX)
    }

    /// The best state of a material with the stated errors from one that is best without any; its `deviance` is the cost at the
    /// best share of the errors. Not looked for to the end where it cannot come near `best`, the cost of another material.
    pub(super) fn compared(
        &mut self,
        model: &Model,
        errors: &Errors,
        m: usize,
        shifted: &[f64],
        (start, best): (State, f64),
        to: &mut Sums,
    ) -> (Fit, usize) {
        let (mut found, mut looks) =
            self.fit(model, &errors.stated, m, shifted, (start, best + HOPELESS), to);
        // χ² is least with all of the errors, ln det C without any.
        if found.chi_square + self.least_logarithm > best + BESIDE {
            return (found, looks);
        }
        let (exact, more) = self.fit(model, &errors.none, m, shifted, (start, f64::INFINITY), to);
        looks += more;
        let (mut before, mut state) = (found.deviance, found.state);
        for modes in &errors.smaller {
            let (less, more) = self.fit(model, modes, m, shifted, (state, f64::INFINITY), to);
            looks += more;
            found.deviance = found.deviance.min(less.deviance);
            if less.deviance > before {
                break;
            }
            (before, state) = (less.deviance, less.state);
        }
        found.deviance = found.deviance.min(exact.deviance);
        (found, looks)
    }

    /// The best state of a material from a start, or the first one where even the best that a step promises costs more than
    /// `hopeless` whatever the share of the errors; its `deviance` is the cost. The sums are those before the last step.
    pub(super) fn fit(
        &mut self,
        model: &Model,
        modes: &Modes,
        m: usize,
        shifted: &[f64],
        (start, hopeless): (State, f64),
        to: &mut Sums,
    ) -> (Fit, usize) {
        let limits = model.limits();
        let mut state = start;
        let mut best: Option<Fit> = None;
        let mut looks = 0;
        loop {
            hadar::stop::check();
            look(self, model, modes, m, shifted, &state, to);
            looks += 1;
            let mut next = state;
            let step = next.step(to, &limits);
            let less = step.square.max(0.0);
            let (deviance, chi_square) = (to.deviance - less, to.chi_square - less);
            let here = Fit { state: next, deviance, chi_square };
            let is_hopeless = chi_square + self.least_logarithm > hopeless;
            let short = step.square.is_nan() || step.square < 0.01 * COMPARED || is_hopeless;
            if short || looks >= MOST_LOOKS || best.is_some_and(|best| to.deviance > best.deviance + 1.0) {
                // C is that of the state at hand: where a step raises the cost, what was found before it stays.
                return (best.filter(|best| best.deviance < here.deviance).unwrap_or(here), looks);
            }
            best = Some(Fit { state, deviance: to.deviance, chi_square: to.chi_square });
            state = next;
        }
    }
}

/// Σ a b of the first `count` of two rows of whole chunks, of which one is 0 in the rest of the last chunk.
#[inline(always)]
fn dot(a: &[f64], b: &[f64], count: usize) -> f64 {
    let mut sum = [0.0; LANES];
    for (a, b) in a.as_chunks::<LANES>().0.iter().zip(b.as_chunks::<LANES>().0).take(count.div_ceil(LANES)) {
        sum = added(*a, *b, sum);
    }
    fold(&sum)
}

#[cfg(test)]
mod tests;
