//! Which counts and variances can be used, and what is said of one that cannot.
//!
//! A count is 0 or lies between [`LEAST`] and [`MOST`]: far beyond any detector on both sides, and such that products
//! of the seven sums over the largest windows still are ordinary doubles.

use crate::cube::Shape;
use crate::error::{Error, Result};
use crate::ranging::noise::NoiseVariance;

/// The largest count and variance.
pub(super) const MOST: f64 = 1e27;

/// The least sum of a count and its variance.
pub(super) const LEAST: f64 = 1e-27;

/// Checks the variances that are the same in all pixels.
pub(super) fn variances(noise: &NoiseVariance, shape: Shape) -> Result<()> {
    noise.check(shape)?;
    let too_large = |var: &f64| {
        let expected = format!("at most {MOST:e}");
        Err(Error::out_of_range("noise variance", *var, "counts^2", expected))
    };
    match noise {
        NoiseVariance::Uniform(var) if *var > MOST => too_large(var),
        NoiseVariance::PerBand(var) => var.iter().find(|var| **var > MOST).map_or(Ok(()), too_large),
        _ => Ok(()),
    }
}

/// A sample of a cube.
pub(super) struct Place {
    pub(super) row: usize,
    pub(super) column: usize,
    pub(super) band: usize,
}

impl Place {
    fn name(&self, what: &str) -> String {
        format!("{what} at row {}, column {}, band {} (from 0)", self.row, self.column, self.band)
    }

    /// Checks its count, and the variance of its electronic noise.
    pub(super) fn check(&self, count: f64, var: f64) -> Result<()> {
        if !(0.0..=MOST).contains(&count) {
            let expected = format!(
                "a number of photons from 0 to {MOST:e}; mask or fill bad pixels, subtract no background from counts"
            );
            return Err(Error::out_of_range(self.name("the count"), count, "", expected));
        }
        if !(0.0..=MOST).contains(&var) {
            let expected = format!("from 0 to {MOST:e}");
            return Err(Error::out_of_range(self.name("the noise variance"), var, "counts^2", expected));
        }
        if count + var < LEAST {
            let expected = format!(
                "at least {LEAST:e} where there is no electronic noise; give a noise variance above 0"
            );
            return Err(Error::out_of_range(self.name("the count"), count, "", expected));
        }
        Ok(())
    }
}
