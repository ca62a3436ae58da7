//! How well temperature and emissivity can be told apart where nothing is known of the emissivity but how smooth it is.
//!
//! A surface sends y_w = e_w B_w(T) + (1 − e_w) X_w in band w, read with a normal error of deviation σ_w; W bands and W + 1 unknowns
//! have no answer. A Gaussian prior e = m + A z, z of mean 0 and covariance 1 (K = A Aᵀ), makes one; T has none. The information on
//! (z, T) is RᵀR, R the triangular factor of the rows
//!
//! | rows | columns of z | column of T |
//! |---|---|---|
//! | prior | 1 | 0 |
//! | bands | (B_w − X_w) A_w/σ_w | e_w B′_w/σ_w |
//!
//! The column of T comes last, so that σ_T = 1/R_TT without a difference of nearly equal numbers; deviations of the emissivities are
//! the lengths of rows of [A 0] R⁻¹, by triangular solves. No inverse is formed.
//!
//! * At one emissivity ([`Separation::at`]): deviation of the posterior to first order, what a prior that is true achieves there.
//! * Averaged over the prior ([`Separation::averaged`]): E[e e'] = m m' + K stands in the information, the bound of van Trees with T
//!   unknown but not random; no estimate that is unbiased in T has a smaller mean square error, averaged over emissivities drawn from
//!   the prior. A single spectrum may come out better.
//!
//! | symbol | unit |
//! |---|---|
//! | y, B, X, σ | one unit of radiance or counts for all, as the caller likes |
//! | T | K |
//! | e, m, A | 1 |
//!
//! Assumptions: the light X is known; bands are independent; σ does not depend on the unknowns.
//!
//! Source: van Trees, 'Detection, Estimation, and Modulation Theory' I (1968), section 2.4; Rockah and Schultheiss, IEEE Trans.
//! ASSP 35, 286 (1987), doi:10.1109/TASSP.1987.1165144, for unknowns of which some are random.

use crate::correlation::{check_places, covariance, matern, modes};
use crate::error::{Error, Result, check};
use nalgebra::{DMatrix, DVector};

#[cfg(test)]
mod tests;

/// What is known of an emissivity beforehand but its values: how large it may be, how much it varies and how smoothly.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Smoothness {
    /// Mean of the emissivity over all bands, 0 to 1.
    pub mean: f64,
    /// Deviation that all bands have in common.
    pub magnitude: f64,
    /// Deviation of each band compared with that.
    pub shape: f64,
    /// Difference of wavenumbers at which the correlation of the shape has fallen to a quarter, cm⁻¹.
    pub correlation_cm1: f64,
}

/// A Gaussian prior of the emissivities of all bands: mean m, covariance A Aᵀ.
#[derive(Debug, Clone, PartialEq)]
pub struct EmissivityPrior {
    mean: Vec<f64>,
    factor: DMatrix<f64>,
}

impl EmissivityPrior {
    /// The prior of a smooth emissivity in bands at these wavenumbers.
    ///
    /// ```
    /// use hadar::fisher::emissivity::{EmissivityPrior, Smoothness};
    /// let known = Smoothness { mean: 0.9, magnitude: 0.3, shape: 0.1, correlation_cm1: 50.0 };
    /// let prior = EmissivityPrior::smooth(&[800.0, 850.0], known)?;
    /// assert!((prior.covariance(0, 0) - 0.1).abs() < 1e-8 && (prior.covariance(0, 1) - 0.0925).abs() < 1e-4);
    /// # Ok::<(), hadar::Error>(())
    /// ```
    ///
    /// # Errors
    /// No band; a mean that is no share; deviations or a length that are not positive.
    pub fn smooth(centres_cm1: &[f64], known: Smoothness) -> Result<Self> {
        check::unit_interval("mean emissivity", known.mean)?;
        check::positive("deviation of the emissivity's magnitude", known.magnitude, "")?;
        check::positive("deviation of the emissivity's shape", known.shape, "")?;
        check::positive("correlation of the emissivity", known.correlation_cm1, "cm^-1")?;
        let (magnitude, shape) = (known.magnitude * known.magnitude, known.shape * known.shape);
        let count = centres_cm1.len();
        let covariance = covariance(count, |v, w| {
            magnitude + shape * matern(centres_cm1[v] - centres_cm1[w], known.correlation_cm1)
        })?;
        Self::of_covariance(vec![known.mean; count], covariance)
    }

    /// The prior that some spectra of as many bands make: their mean, the largest principal components of what they differ by, each
    /// with the deviation it has among them, and what these leave as a deviation of each band for itself.
    ///
    /// # Errors
    /// Fewer than two spectra, spectra of different lengths, no component.
    pub fn of_spectra(spectra: &[&[f64]], components: usize) -> Result<Self> {
        let (Some(first), true) = (spectra.first(), spectra.len() > 1 && components > 0) else {
            let found = format!("{} spectra and {components} components", spectra.len());
            return Err(Error::malformed(found, "give two spectra or more, and a component"));
        };
        let bands = first.len();
        check_places(bands)?;
        if let Some(other) = spectra.iter().find(|one| one.len() != bands) {
            return Err(Error::Length {
                what: "bands of a spectrum".into(),
                found: other.len(),
                expected: bands,
            });
        }
        let count = spectra.len() as f64;
        let mean: Vec<f64> =
            (0..bands).map(|w| spectra.iter().map(|one| one[w]).sum::<f64>() / count).collect();
        let apart = DMatrix::from_fn(spectra.len(), bands, |i, w| spectra[i][w] - mean[w]);
        let covariance = apart.tr_mul(&apart) / (count - 1.0);
        let left: Vec<f64> = covariance.diagonal().iter().copied().collect();
        let modes = modes(covariance, components)?;
        let kept = modes.ncols();
        let mut factor = modes.resize_horizontally(kept + bands, 0.0);
        for (w, var) in left.iter().enumerate() {
            let rest = var - (0..kept).map(|k| factor[(w, k)].powi(2)).sum::<f64>();
            factor[(w, kept + w)] = rest.max(0.0).sqrt();
        }
        Ok(Self { mean, factor })
    }

    fn of_covariance(mean: Vec<f64>, covariance: DMatrix<f64>) -> Result<Self> {
        if mean.is_empty() {
            return Err(Error::malformed("an emissivity of no band", "give at least one"));
        }
        let most = mean.len();
        Ok(Self { mean, factor: modes(covariance, most)? })
    }

    /// m.
    #[must_use]
    pub fn mean(&self) -> &[f64] {
        &self.mean
    }

    /// A, a row for each band.
    #[must_use]
    pub fn factor(&self) -> &DMatrix<f64> {
        &self.factor
    }

    /// Covariance of bands v and w.
    #[must_use]
    pub fn covariance(&self, v: usize, w: usize) -> f64 {
        self.factor.row(v).dot(&self.factor.row(w))
    }

    /// The emissivity that belongs to a z, for instance a drawn one; what is missing of it is 0.
    #[must_use]
    pub fn at(&self, z: &[f64]) -> Vec<f64> {
        let apart = &self.factor * DVector::from_fn(self.unknowns(), |k, _| z.get(k).copied().unwrap_or(0.0));
        self.mean.iter().zip(apart.iter()).map(|(mean, more)| mean + more).collect()
    }

    /// Numbers of z.
    #[must_use]
    pub fn unknowns(&self) -> usize {
        self.factor.ncols()
    }
}

/// What is seen of a surface, one value for each band.
#[derive(Debug, Clone, Copy)]
pub struct Seen<'a> {
    /// B(T).
    pub blackbody: &'a [f64],
    /// ∂B/∂T, per K.
    pub slope: &'a [f64],
    /// X, what comes from around.
    pub light: &'a [f64],
    /// σ, of one reading.
    pub sigma: &'a [f64],
}

/// Least deviations of a temperature and an emissivity that are unknown together.
#[derive(Debug, Clone, PartialEq)]
pub struct Separation {
    /// Of the temperature, K; infinite where no band tells it.
    pub sigma_temperature_k: f64,
    /// Of the emissivity in each band.
    pub sigma_emissivity: Vec<f64>,
}

impl Separation {
    /// At one emissivity.
    ///
    /// # Errors
    /// Another number of bands, a σ that is not positive.
    pub fn at(prior: &EmissivityPrior, emissivity: &[f64], seen: &Seen<'_>) -> Result<Self> {
        Self::of(prior, emissivity, seen, 0.0)
    }

    /// Averaged over the prior.
    ///
    /// # Errors
    /// As [`Separation::at`].
    pub fn averaged(prior: &EmissivityPrior, seen: &Seen<'_>) -> Result<Self> {
        check_lengths(prior, prior.mean(), seen)?;
        let each = seen.slope.iter().zip(seen.sigma).enumerate();
        let more = each.map(|(w, (slope, sigma))| prior.covariance(w, w) * (slope / sigma).powi(2)).sum();
        Self::of(prior, prior.mean(), seen, more)
    }

    /// Root mean square of the deviations of the emissivity.
    #[must_use]
    pub fn emissivity_rms(&self) -> f64 {
        let square: f64 = self.sigma_emissivity.iter().map(|sigma| sigma * sigma).sum();
        (square / self.sigma_emissivity.len().max(1) as f64).sqrt()
    }

    /// `more`: information on the temperature that no other unknown has a part in.
    fn of(prior: &EmissivityPrior, emissivity: &[f64], seen: &Seen<'_>, more: f64) -> Result<Self> {
        check_lengths(prior, emissivity, seen)?;
        let (bands, unknowns) = (emissivity.len(), prior.unknowns());
        let mut rows = DMatrix::zeros(unknowns + bands + 1, unknowns + 1);
        for k in 0..unknowns {
            rows[(k, k)] = 1.0;
        }
        for (w, e) in emissivity.iter().enumerate() {
            let contrast = (seen.blackbody[w] - seen.light[w]) / seen.sigma[w];
            for k in 0..unknowns {
                rows[(unknowns + w, k)] = contrast * prior.factor[(w, k)];
            }
            rows[(unknowns + w, unknowns)] = e * seen.slope[w] / seen.sigma[w];
        }
        rows[(unknowns + bands, unknowns)] = more.sqrt();
        let scale = rows.column(unknowns).amax();
        if scale > 0.0 {
            rows.column_mut(unknowns).iter_mut().for_each(|x| *x /= scale);
        }
        let factor = rows.qr().r();
        let own = factor[(unknowns, unknowns)].abs();
        // What rounding leaves of a column of length 1 or more is no information.
        if scale == 0.0 || own < 1e-13 {
            return Ok(Self {
                sigma_temperature_k: f64::INFINITY,
                sigma_emissivity: (0..bands).map(|w| prior.covariance(w, w).sqrt()).collect(),
            });
        }
        let deviation = |w: usize| {
            let mut row =
                DVector::from_fn(unknowns + 1, |k, _| if k < unknowns { prior.factor[(w, k)] } else { 0.0 });
            factor.tr_solve_upper_triangular_mut(&mut row);
            row.norm()
        };
        Ok(Self {
            sigma_temperature_k: 1.0 / own / scale,
            sigma_emissivity: (0..bands).map(deviation).collect(),
        })
    }
}

fn check_lengths(prior: &EmissivityPrior, emissivity: &[f64], seen: &Seen<'_>) -> Result<()> {
    let expected = prior.mean.len();
    for (what, found) in [
        ("emissivities", emissivity.len()),
        ("radiances of a blackbody", seen.blackbody.len()),
        ("slopes of a blackbody", seen.slope.len()),
        ("radiances around", seen.light.len()),
        ("deviations", seen.sigma.len()),
    ] {
        if found != expected {
            return Err(Error::Length { what: what.into(), found, expected });
        }
    }
    seen.sigma.iter().try_for_each(|sigma| check::positive("deviation of a reading", *sigma, "").map(|_| ()))
}
