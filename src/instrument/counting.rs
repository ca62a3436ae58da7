//! Counts of a scene and the noise beside them, as limits and simulations take them from a camera.
//!
//! N_w = κ S_w counts of band w, κ counts per unit of band signal; variance N_w + σ²_w.

use crate::error::{Error, Result, check};

/// How many photons there are and what other noise is added to theirs.
#[derive(Debug, Clone, PartialEq)]
pub struct Counting {
    /// Counts per unit of band signal: étendue × efficiency × time, m² sr s.
    pub counts_per_radiance: f64,
    /// Variance σ²_w of all noise that does not depend on what the target is, of each band, counts²: electronic noise,
    /// dark counts, photons of the path, of filters and of the background; empty for none.
    pub var_added: Vec<f64>,
}

impl Counting {
    /// Shot noise alone, at a total of `photons` photons from a scene whose band signals are `signal`.
    #[must_use]
    pub fn shot(photons: f64, signal: &[f64]) -> Self {
        Self { counts_per_radiance: photons / crate::sum::sum(signal), var_added: Vec::new() }
    }

    /// Makes sure that the noise is possible: of every band, or of none.
    ///
    /// # Errors
    /// A list of another length, a variance that is negative or no number, counts that are not positive.
    pub fn check(&self, bands: usize) -> Result<()> {
        check::positive("counts per radiance", self.counts_per_radiance, "m^2 sr s")?;
        let found = self.var_added.len();
        if found != 0 && found != bands {
            let what = "variances of added noise".into();
            return Err(Error::Length { what, found, expected: bands });
        }
        let one = |var| check::non_negative("variance of added noise", var, "counts^2");
        check::each(&self.var_added, |var| (0.0..f64::INFINITY).contains(&var), one)
    }

    /// σ²_w of band w.
    #[must_use]
    pub fn var_added(&self, band: usize) -> f64 {
        self.var_added.get(band).copied().unwrap_or(0.0)
    }
}
