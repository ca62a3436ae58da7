//! An emissivity that is known but for smooth errors: a Gaussian process, in as many modes as the photons can tell.
//!
//! Errors δ of two bands that lie Δν apart have the covariance Σ = s² (1 + x + x²/3) e⁻ˣ, x = 3.55 |Δν|/ℓ (Matérn, 5/2): s
//! deviation of the emissivity, ℓ (cm⁻¹) where the correlation has fallen to a quarter. With the eigenvalues λ and eigenvectors
//! u of Σ it is δ = Σ_m a_m √λ_m u_m, the a_m independent and standard normal: each mode is one unknown with a prior of deviation 1.
//!
//! Modes are kept, the largest first, until what the rest of them adds to the variance of any band is [`LEFT_OUT`] of its noise: leaving
//! them out changes a bound by no more than about that share of it. An error is constant over a band.
//!
//! Source: Rasmussen and Williams, 'Gaussian Processes for Machine Learning' (2006), section 4.2.

use crate::correlation::{eigen, matern};
use crate::error::{Error, Result, check};
use crate::order;
use crate::spectrum::Bands;
use nalgebra::DMatrix;

/// Variance that modes may leave out, in variances of the noise of a band.
const LEFT_OUT: f64 = 1e-4;
/// Bands whose covariance is taken apart, at most: that takes their third power.
const MOST_BANDS: usize = 1000;

/// How wrong an emissivity may be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SmoothEmissivity {
    /// Deviation s of the emissivity in any band.
    pub sigma: f64,
    /// Difference ℓ of wavenumbers at which the correlation has fallen to a quarter, cm⁻¹.
    pub correlation_cm1: f64,
}

/// All modes of its errors in some bands, the largest first.
#[derive(Debug, Clone, PartialEq)]
pub struct SmoothModes {
    /// √λ u, one value for each band.
    modes: Vec<Vec<f64>>,
    /// s².
    var: f64,
}

impl SmoothModes {
    /// The modes in `bands`.
    ///
    /// # Errors
    /// A deviation or correlation that is not positive; more than 1000 bands.
    pub fn new(bands: &Bands, emissivity: SmoothEmissivity) -> Result<Self> {
        if bands.len() > MOST_BANDS {
            let expected = format!("at most {MOST_BANDS} where the emissivity is unknown: take wider bands");
            return Err(Error::out_of_range("number of bands", bands.len() as f64, "", expected));
        }
        check::positive("error of the emissivity", emissivity.sigma, "")?;
        check::positive("correlation of the errors of the emissivity", emissivity.correlation_cm1, "cm^-1")?;
        let centres: Vec<f64> = bands.bands().iter().map(|band| band.center_cm1).collect();
        let correlation = DMatrix::from_fn(centres.len(), centres.len(), |i, j| {
            matern(centres[i] - centres[j], emissivity.correlation_cm1)
        });
        let eigen = eigen(correlation)?;
        let mut order: Vec<usize> = (0..centres.len()).collect();
        order::descending(&mut order, |b| eigen.eigenvalues[*b]);
        let mode = |&k: &usize| {
            let size = emissivity.sigma * eigen.eigenvalues[k].max(0.0).sqrt();
            let vector: Vec<f64> = eigen.eigenvectors.column(k).iter().copied().collect();
            // Which of its two signs a vector comes with is chance.
            let sign = vector.iter().sum::<f64>().signum();
            vector.iter().map(|u| sign * size * u).collect()
        };
        Ok(Self { modes: order.iter().map(mode).collect(), var: emissivity.sigma * emissivity.sigma })
    }

    /// As many as tell anything where a change of the emissivity by 1 changes the counts of each band by `reach` deviations of their noise.
    #[must_use]
    pub fn that_matter(&self, reach: &[f64]) -> &[Vec<f64>] {
        let mut rest = vec![self.var; reach.len()];
        for (kept, mode) in self.modes.iter().enumerate() {
            if rest.iter().zip(reach).all(|(rest, reach)| rest * reach * reach <= LEFT_OUT) {
                return &self.modes[..kept];
            }
            rest.iter_mut().zip(mode).for_each(|(rest, mode)| *rest -= mode * mode);
        }
        &self.modes
    }

    /// All of them.
    #[must_use]
    pub fn all(&self) -> &[Vec<f64>] {
        &self.modes
    }
}
