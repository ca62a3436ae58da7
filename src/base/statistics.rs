//! How the counts of a band scatter about their mean N.
//!
//! * Poisson: variance N; photons without bunching, a detector without noise.
//! * Gaussian: variance N + σ², σ² the electronic noise of the reading (S27).
//! * Negative binomial: variance N + N²/m, m the number of modes that the reading collects; thermal light of
//!   occupancy N/m per mode (S11, S12). m → ∞ is Poisson (S13).
//!
//! Symbols: N mean counts, n counts of one reading, σ² variance of electronic noise (counts²), m modes.
//!
//! Source: paper S11–S16; Mandel and Wolf, 'Optical Coherence and Quantum Optics' (1995), section 14.9.

mod distributions;

pub use self::distributions::{chi_square_quantile, chi_square_survival, erfc_inv, student_quantile};
use crate::error::{Error, Result, check};

/// A law of photon counting, with what it needs to know of every band.
///
/// ```
/// use hadar::statistics::Statistics;
/// let thermal = Statistics::negative_binomial(vec![1000.0])?;
/// assert_eq!(thermal.variance(0, 50.0), 50.0 + 2.5);
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub enum Statistics {
    /// Variance N.
    Poisson,
    /// Variance N + σ²; σ² of each band, counts².
    Gaussian {
        /// σ² of each band.
        var_added: Vec<f64>,
    },
    /// Variance N + N²/m; modes m of each band.
    NegativeBinomial {
        /// m of each band.
        modes: Vec<f64>,
    },
}

impl Statistics {
    /// Gaussian counts with electronic noise σ² of each band.
    ///
    /// # Errors
    /// A negative variance.
    pub fn gaussian(var_added: Vec<f64>) -> Result<Self> {
        var_added.iter().try_for_each(|&var| {
            check::non_negative("variance of electronic noise", var, "counts^2").map(drop)
        })?;
        Ok(Self::Gaussian { var_added })
    }

    /// Bunched photons in `modes` modes of each band.
    ///
    /// # Errors
    /// A number of modes that is not positive.
    pub fn negative_binomial(modes: Vec<f64>) -> Result<Self> {
        modes.iter().try_for_each(|&m| check::positive("modes of a band", m, "").map(drop))?;
        Ok(Self::NegativeBinomial { modes })
    }

    /// The name used on the command line and in results.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Poisson => "poisson",
            Self::Gaussian { .. } => "gaussian",
            Self::NegativeBinomial { .. } => "negative-binomial",
        }
    }

    /// Makes sure that there is one possible figure for each of `bands` bands.
    ///
    /// # Errors
    /// A list of another length, a negative variance, modes that are not positive, or no number.
    pub fn check_bands(&self, bands: usize) -> Result<()> {
        let (what, found) = match self {
            Self::Poisson => return Ok(()),
            Self::Gaussian { var_added } => {
                Self::gaussian(var_added.clone())?;
                ("variances of electronic noise", var_added.len())
            }
            Self::NegativeBinomial { modes } => {
                Self::negative_binomial(modes.clone())?;
                ("modes of the bands", modes.len())
            }
        };
        if found == bands {
            return Ok(());
        }
        Err(Error::Length { what: what.into(), found, expected: bands })
    }

    /// Variance of the counts of a band of mean `mean`.
    #[must_use]
    pub fn variance(&self, band: usize, mean: f64) -> f64 {
        match self {
            Self::Poisson => mean,
            Self::Gaussian { var_added } => mean + var_added[band],
            Self::NegativeBinomial { modes } => mean * (1.0 + mean / modes[band]),
        }
    }

    /// Log-likelihood of mean `mean` given `count`, without the terms that depend on the count alone.
    ///
    /// Poisson n ln N − N; Gaussian −½(n − N)²/(N + σ²) − ½ ln(N + σ²); negative binomial
    /// n ln N − (n + m) ln(1 + N/m).
    #[must_use]
    pub fn log_likelihood(&self, band: usize, count: f64, mean: f64) -> f64 {
        // n ln N, with 0 ln 0 = 0.
        let weighted_log = |x: f64| if count == 0.0 { 0.0 } else { count * x.ln() };
        match self {
            Self::Poisson => weighted_log(mean) - mean,
            Self::Gaussian { var_added } => {
                let variance = mean + var_added[band];
                let off = count - mean;
                -0.5 * (off * off / variance + variance.ln())
            }
            Self::NegativeBinomial { modes } => {
                let m = modes[band];
                weighted_log(mean) - (count + m) * (mean / m).ln_1p()
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Σₙ P(n) = 1 and Σₙ P(n)(n − N)² = variance, P from the likelihood and the terms left out of it.
    #[test]
    fn the_likelihoods_are_those_of_the_variances() {
        let (mean, modes) = (7.3, 4.1);
        let thermal = Statistics::negative_binomial(vec![modes]).unwrap();
        let moments = |statistics: &Statistics, rest: &dyn Fn(f64) -> f64| {
            (0..400).map(f64::from).fold((0.0, 0.0), |(sum, square), n| {
                let p = (statistics.log_likelihood(0, n, mean) + rest(n)).exp();
                (sum + p, square + p * (n - mean).powi(2))
            })
        };
        let factorial = |n: f64| statrs::function::gamma::ln_gamma(n + 1.0);
        let gamma = |x: f64| statrs::function::gamma::ln_gamma(x);
        let poisson = moments(&Statistics::Poisson, &|n| -factorial(n));
        let bunched = moments(&thermal, &|n| gamma(n + modes) - gamma(modes) - factorial(n) - n * modes.ln());
        for ((sum, square), variance) in [(poisson, mean), (bunched, thermal.variance(0, mean))] {
            assert!((sum - 1.0).abs() < 1e-11 && (square / variance - 1.0).abs() < 1e-10, "{sum} {square}");
        }
    }

    #[test]
    fn impossible_noise_is_refused() {
        assert!(Statistics::gaussian(vec![-1.0]).is_err());
        assert!(Statistics::negative_binomial(vec![0.0]).is_err());
        assert!(Statistics::gaussian(vec![1.0]).unwrap().check_bands(2).is_err());
    }
}
