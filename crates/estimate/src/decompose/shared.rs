//! Unknowns that have one value for the whole cube, estimated together with the temperature and lighting of every pixel.
//!
//! The unknowns θ are amounts of some causes ([`super::cause`]), with prior deviations s about what is told. At the fit of all pixels, with
//! their own unknowns profiled out, s_θ the scores, J their information and V = J + Λ their variance (Λ of stated errors of the library,
//! [`super::judge()`]),
//!
//! C⁻¹ = J V⁻¹ J + diag(s⁻²),   δθ = C (J V⁻¹ s_θ − θ/s²),
//!
//! and the pixels are fitted again at θ + δθ, until it no longer moves by a part of its deviation: Gauss and Newton's method for the most
//! probable θ. What follows θ by a slope d has the variance dᵀ C d besides its own: the joint Cramér–Rao bound, with the prior.
//!
//! Errors that all pixels have alike ([`super::alike`]) are no noise of a pixel's own: with the columns E that they add to the scores, what
//! follows θ by d has the variance |dᵀ C J V⁻¹ E|² besides.
//!
//! In units of s the matrix is 1 + WᵀW and has a Cholesky factor whatever the pixels tell. A factor of all noise comes from χ² alone.
//!
//! Assumptions: materials of pixels with one candidate are right; where most pixels have several, nothing is estimated and the prior stays.

use super::cause::Cause;
use super::judge::{Judged, Together, sums};
use super::library_error::LibraryError;
use super::maps::{Maps, Options};
use super::method::decompose;
use super::pixel::flag;
use super::setting::Setting;
use super::told::Told;
use hadar::cube::{Cube, CubeRef};
use hadar::error::{Error, Result, check};
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

/// Fits of all pixels at most, for each sample.
const MOST_ROUNDS: usize = 24;
/// Part of its deviation by which a settled unknown moves.
const SETTLED: f64 = 0.1;
/// The same of the factor of the noise, as a share.
const SETTLED_NOISE: f64 = 1e-3;
/// Cosine from which on two unknowns are one.
const SAME: f64 = 0.9999;
/// What is added to a variance of 1, so that unknowns that are one have a factor too.
const RIDGE: f64 = 1e-10;
/// Least amount of a share: nothing is dimmer than a tenth of what it is told to be.
const LEAST_SHARE: f64 = -0.9;
/// Deviations that a factor of the noise may be from 1.
const FARTHEST: f64 = 5.0;

/// An unknown that the whole cube shares.
#[derive(Debug, Clone, PartialEq)]
pub struct Unknown {
    /// What it is an amount of.
    pub cause: Cause,
    /// Prior deviation of the amount.
    pub sigma: f64,
}

/// Unknowns that were estimated.
#[derive(Debug, Clone)]
pub struct Shared {
    /// What they are.
    pub unknowns: Vec<Unknown>,
    /// How much of each.
    pub amounts: Vec<f64>,
    /// By how much the deviation of all noise is larger than told.
    pub noise: f64,
    /// Pixels that they are estimated from; none where the prior is all that is known.
    pub pixels: usize,
    /// Whether the last round moved nothing.
    pub settled: bool,
    /// By how much χ² of a pixel is off on average as θ is not known; nothing where the prior is all that is known.
    pub off_chi_square_mean: Option<f64>,
    /// Pairs that the pixels do not tell apart.
    pub same: Vec<[usize; 2]>,
    factor: Cholesky<f64, Dyn>,
    /// What errors that all pixels have alike do to the amounts, in units of s: a column each.
    alike: DMatrix<f64>,
}

impl Shared {
    fn prior(unknowns: &[Unknown]) -> Result<Self> {
        unknowns.iter().try_for_each(|one| {
            check::positive("prior deviation of a shared unknown", one.sigma, "").map(|_| ())
        })?;
        let count = unknowns.len();
        Ok(Self {
            unknowns: unknowns.to_vec(),
            amounts: vec![0.0; count],
            noise: 1.0,
            pixels: 0,
            settled: false,
            off_chi_square_mean: None,
            same: Vec::new(),
            factor: factor(DMatrix::identity(count, count))?,
            alike: DMatrix::zeros(count, 1),
        })
    }

    /// The causes.
    #[must_use]
    pub fn causes(&self) -> Vec<Cause> {
        self.unknowns.iter().map(|one| one.cause.clone()).collect()
    }

    /// C x.
    pub(super) fn image(&self, x: &[f64]) -> Vec<f64> {
        let scaled =
            DVector::from_iterator(x.len(), x.iter().zip(&self.unknowns).map(|(x, one)| x * one.sigma));
        let solved = self.factor.solve(&scaled);
        solved.iter().zip(&self.unknowns).map(|(x, one)| x * one.sigma).collect()
    }

    /// By how much χ² of what follows the unknowns by slopes is off on average, tr(C G), G their products `gram`.
    pub(super) fn off_chi_square(&self, gram: &dyn Fn(usize, usize) -> f64) -> f64 {
        let count = self.unknowns.len();
        let column = |j: usize| -> Vec<f64> { (0..count).map(|i| gram(i, j)).collect() };
        (0..count).map(|j| self.image(&column(j))[j]).sum()
    }

    /// Scores with those of the prior.
    pub(super) fn rest(&self, score: &[f64]) -> Vec<f64> {
        let each = score.iter().zip(&self.amounts).zip(&self.unknowns);
        each.map(|((score, amount), one)| score - amount / one.sigma / one.sigma).collect()
    }

    /// Deviation of what follows the unknowns by slopes.
    #[must_use]
    pub fn sigma_of(&self, slopes: &[f64]) -> f64 {
        let scaled = DVector::from_iterator(
            slopes.len(),
            slopes.iter().zip(&self.unknowns).map(|(d, one)| d * one.sigma),
        );
        self.sigma_of_own(slopes).hypot(self.alike.tr_mul(&scaled).norm())
    }

    /// The same but for what all pixels are off by alike.
    fn sigma_of_own(&self, slopes: &[f64]) -> f64 {
        slopes.iter().zip(self.image(slopes)).map(|(d, image)| d * image).sum::<f64>().max(0.0).sqrt()
    }

    /// Deviation of an unknown.
    #[must_use]
    pub fn sigma(&self, unknown: usize) -> f64 {
        self.sigma_of(&self.along(unknown))
    }

    fn along(&self, unknown: usize) -> Vec<f64> {
        (0..self.unknowns.len()).map(|i| f64::from(u8::from(i == unknown))).collect()
    }

    /// The setting with what is found put into it: the shift first, which reads the spectra anew.
    ///
    /// # Errors
    /// Amounts with which nothing can be seen.
    pub fn put_into(&self, told: &Told) -> Result<Told> {
        let is_shift = |cause: &Cause| matches!(cause, Cause::WavelengthShift(_));
        let each = || self.unknowns.iter().map(|one| &one.cause).zip(&self.amounts);
        let order =
            each().filter(|(cause, _)| is_shift(cause)).chain(each().filter(|(cause, _)| !is_shift(cause)));
        let mut all = order.filter(|(_, amount)| **amount != 0.0);
        let told = all.try_fold(told.clone(), |told, (cause, amount)| told.with(cause, *amount))?;
        Ok(told.with_noise(self.noise))
    }

    /// One round: the sums of the pixels at what is known so far. Whether it has settled.
    fn step(&mut self, sums: &Together, noise_sigma: Option<f64>, alike: &DMatrix<f64>) -> Result<bool> {
        let count = self.unknowns.len();
        let first = sums.score.len() - count;
        let s: Vec<f64> = self.unknowns.iter().map(|one| one.sigma).collect();
        let of =
            |all: &[f64]| DMatrix::from_fn(count, count, |i, j| s[i] * all[(first + i) * count + j] * s[j]);
        let information = of(&sums.cross.information);
        let score = DVector::from_fn(count, |i, _| s[i] * sums.score[first + i]);
        let prior = DVector::from_fn(count, |i, _| self.amounts[i] / s[i]);
        // What no pixel tells has a variance of 0 and no information: any number divides it.
        let mut var = &information + of(&sums.cross.of_library);
        let scale: Vec<f64> =
            (0..count).map(|i| if var[(i, i)] > 0.0 { var[(i, i)].sqrt() } else { 1.0 }).collect();
        for i in 0..count {
            for j in 0..count {
                var[(i, j)] /= scale[i] * scale[j];
            }
            var[(i, i)] = var[(i, i)].max(1.0) * (1.0 + RIDGE);
        }
        let var = factor(var)?;
        let scaled = DMatrix::from_fn(count, count, |i, j| information[(i, j)] / scale[i]);
        let score = DVector::from_fn(count, |i, _| score[i] / scale[i]);
        let own = scaled.transpose() * var.solve(&scaled);
        let towards = scaled.transpose() * var.solve(&score) - prior;
        let own = 0.5 * (&own + own.transpose());
        self.factor = factor(own + DMatrix::identity(count, count))?;
        let step = self.factor.solve(&towards);
        let off = DMatrix::from_fn(count, alike.ncols(), |i, k| s[i] * alike[(i, k)] / scale[i]);
        self.alike = self.factor.solve(&(scaled.transpose() * var.solve(&off)));
        // Far from the best fit pixels have wrong materials: no further than a prior deviation at once.
        let longest = step.amax();
        let step = if longest > 1.0 { step / longest } else { step };
        let mut settled = true;
        for (i, step) in step.iter().enumerate() {
            self.amounts[i] += step * s[i];
            if self.unknowns[i].cause.is_share() {
                self.amounts[i] = self.amounts[i].max(LEAST_SHARE);
            }
            settled &= (step * s[i]).abs() <= SETTLED * self.sigma_of_own(&self.along(i));
        }
        if let Some(noise_sigma) = noise_sigma {
            let ratio = (sums.chi_square / sums.freedom).sqrt();
            if ratio.is_finite() && ratio > 0.0 {
                let farthest = FARTHEST * noise_sigma;
                self.noise = (self.noise * ratio).clamp(1.0 / (1.0 + farthest), 1.0 + farthest);
                settled &= (ratio - 1.0).abs() < SETTLED_NOISE;
            }
        }
        self.pixels = sums.pixels;
        let unscaled = |i: usize, j: usize| information[(i, j)] / s[i] / s[j];
        self.off_chi_square_mean = Some(self.off_chi_square(&unscaled) / sums.pixels.max(1) as f64);
        let cosine = |i: usize, j: usize| {
            let length = (information[(i, i)] * information[(j, j)]).sqrt();
            if length > 0.0 { information[(i, j)].abs() / length } else { 0.0 }
        };
        let pairs = (0..count).flat_map(|i| (i + 1..count).map(move |j| [i, j]));
        self.same = pairs.filter(|[i, j]| cosine(*i, *j) > SAME).collect();
        Ok(settled)
    }
}

/// Estimates unknowns, and a factor of the noise where it has a prior deviation, with all pixels of one sample after the other.
///
/// # Errors
/// A prior without a width, what [`decompose()`] refuses.
pub fn estimate(
    told: &Told,
    unknowns: &[Unknown],
    noise_sigma: Option<f64>,
    options: &Options,
    samples: &[Cube],
) -> Result<Shared> {
    noise_sigma.map_or(Ok(()), |sigma| {
        check::positive("prior deviation of the scale of the noise", sigma, "").map(|_| ())
    })?;
    let mut shared = Shared::prior(unknowns)?;
    for cube in samples {
        shared.settled = false;
        for _ in 0..MOST_ROUNDS {
            let here = shared.put_into(told)?;
            let setting = here.setting();
            let maps = decompose(&setting, options, cube, &|_| ())?;
            let found = sums(&setting, (&[], &shared.causes()), options.library_error, &maps, cube)?;
            let Some(sums) = telling(&found, &maps) else {
                return Shared::prior(unknowns);
            };
            let alike = options.alike.of_scores(&sums.alike, &found.bands);
            if shared.step(sums, noise_sigma, &alike)? {
                shared.settled = true;
                break;
            }
        }
    }
    Ok(shared)
}

/// What pixels `[row][column]` with their `maps` say together of a setting and of `causes`; errors of the library as stated, and beside
/// what was estimated with the pixels, where `setting` is that of these estimates.
///
/// # Errors
/// Maps or a cube of another setting, a cube that cannot be read, an unknown gain of every pixel.
pub fn judge<'c>(
    setting: &Setting<'_>,
    causes: &[Cause],
    (error, shared): (Option<LibraryError>, Option<&Shared>),
    maps: &Maps,
    cube: impl Into<CubeRef<'c>>,
) -> Result<Judged> {
    let also: Vec<Cause> = shared.map_or_else(Vec::new, Shared::causes);
    let mut found = sums(setting, (causes, &also), error, maps, cube)?;
    if let Some(shared) = shared {
        [&mut found.fitting, &mut found.all]
            .into_iter()
            .for_each(|sums| sums.beside(&|score| shared.rest(score), &|x| shared.image(x)));
    }
    Ok(found)
}

/// The sums that tell of what is shared: of pixels that fit, unless most do not; nothing where few pixels are decided, which are those that
/// their noise made clear.
fn telling<'a>(judged: &'a Judged, maps: &Maps) -> Option<&'a Together> {
    let told =
        |i: usize| maps.flags[i] & (flag::SKIPPED | flag::NO_INFORMATION) == 0 && !maps.p_value[i].is_nan();
    let asked = (0..maps.material.len()).filter(|i| told(*i)).count();
    let most_fit = 2 * judged.fitting.pixels >= judged.all.pixels;
    (2 * judged.all.pixels > asked).then_some(if most_fit { &judged.fitting } else { &judged.all })
}

fn factor(matrix: DMatrix<f64>) -> Result<Cholesky<f64, Dyn>> {
    Cholesky::new(matrix).ok_or_else(|| {
        Error::malformed(
            "what pixels tell of the shared unknowns has no finite covariance",
            "state smaller deviations",
        )
    })
}

#[cfg(test)]
mod tests;
