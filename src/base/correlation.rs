//! How alike a smooth curve is at two places.
//!
//! Matérn, 5/2: ρ = (1 + x + x²/3) e⁻ˣ, x = 3.55 |a − b|/ℓ, so that ρ has fallen to a quarter where the places are ℓ apart. Curves of
//! this correlation have two derivatives: smooth, but not without an end.
//!
//! A curve with kinks has the exponential one, ρ = 4^(−|a − b|/ℓ) (Matérn, 1/2): no derivative, and a quarter at the same ℓ.
//!
//! Source: Rasmussen and Williams, 'Gaussian Processes for Machine Learning' (2006), section 4.2.

use crate::error::{Error, Result};
use crate::order;
use nalgebra::{DMatrix, Dyn, SymmetricEigen};

/// Modes whose deviation is a smaller share of the largest one's are left out.
const SMALL_MODE: f64 = 1e-6;

/// Rounds of an eigenvalue or singular value decomposition for each row; two are usual, and NaN never ends.
pub(crate) const ROUNDS: usize = 100;

/// Most bands of a covariance: 128 MB.
const MOST_PLACES: usize = 4096;

/// x at which e⁻ˣ is 0, and x² infinite from some x on.
const FAR: f64 = 800.0;

/// x at which (1 + x + x²/3) e⁻ˣ is a quarter.
pub const QUARTER: f64 = 3.55;

/// The correlation of two places that are `apart`, with `length` where it is a quarter, in the same unit.
pub fn matern(apart: f64, length: f64) -> f64 {
    let x = QUARTER * apart.abs() / length;
    if x > FAR { 0.0 } else { (1.0 + x + x * x / 3.0) * libm::exp(-x) }
}

/// That of a curve with kinks: exponential, a quarter at the same `length`.
pub fn exponential(apart: f64, length: f64) -> f64 {
    libm::exp2(-2.0 * apart.abs() / length)
}

/// The covariance of `count` places, an element at a time.
///
/// # Errors
/// More than 4096 places, whose squares take as much memory as they take time.
pub fn covariance(count: usize, of: impl FnMut(usize, usize) -> f64) -> Result<DMatrix<f64>> {
    check_places(count)?;
    Ok(DMatrix::from_fn(count, count, of))
}

/// That a matrix of as many rows and columns is of a size to be worked with.
///
/// # Errors
/// More than 4096.
pub fn check_places(count: usize) -> Result<()> {
    if count <= MOST_PLACES {
        return Ok(());
    }
    let expected = format!("at most {MOST_PLACES} where errors of neighbours are alike: take wider bands");
    Err(Error::out_of_range("number of bands", count as f64, "", expected))
}

/// Eigenvalues and eigenvectors of a covariance.
///
/// # Errors
/// A covariance of no row, or with a number that is not finite: the decomposition would not end.
pub fn eigen(covariance: DMatrix<f64>) -> Result<SymmetricEigen<f64, Dyn>> {
    let unusable = || {
        let found = "a covariance with numbers that are not finite, or with none";
        Error::malformed(found, "write smaller deviations, or a longer correlation")
    };
    let rounds = ROUNDS * covariance.nrows();
    if rounds == 0 || covariance.iter().any(|x| !x.is_finite()) {
        return Err(unusable());
    }
    SymmetricEigen::try_new(covariance, f64::EPSILON, rounds).ok_or_else(unusable)
}

/// A of a covariance A Aᵀ: √eigenvalue × eigenvector of the largest few, a column each.
///
/// # Errors
/// As [`eigen`].
pub fn modes(covariance: DMatrix<f64>, most: usize) -> Result<DMatrix<f64>> {
    let eigen = eigen(covariance)?;
    let mut order: Vec<usize> = (0..eigen.eigenvalues.len()).collect();
    order::descending(&mut order, |b| eigen.eigenvalues[*b]);
    let least = SMALL_MODE * SMALL_MODE * eigen.eigenvalues.max();
    order.retain(|k| eigen.eigenvalues[*k] > least);
    order.truncate(most);
    Ok(DMatrix::from_fn(eigen.eigenvectors.nrows(), order.len(), |w, k| {
        eigen.eigenvalues[order[k]].sqrt() * eigen.eigenvectors[(w, order[k])]
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_one_at_a_place_and_a_quarter_at_the_length() {
        assert_eq!(matern(0.0, 50.0), 1.0);
        assert!((matern(-50.0, 50.0) - 0.25).abs() < 2e-3);
        assert_eq!(matern(10.0, f64::MIN_POSITIVE), 0.0);
        assert_eq!([0.0, -50.0, 100.0].map(|apart| exponential(apart, 50.0)), [1.0, 0.25, 0.0625]);
        assert_eq!(exponential(10.0, f64::MIN_POSITIVE), 0.0);
    }

    #[test]
    fn numbers_that_are_not_finite_are_refused() {
        for wrong in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let covariance = DMatrix::from_fn(4, 4, |i, j| if i == 2 && j == 1 { wrong } else { 1.0 });
            assert!(modes(covariance, 4).is_err(), "{wrong}");
        }
        assert!(eigen(DMatrix::zeros(0, 0)).is_err());
        assert!(covariance(MOST_PLACES + 1, |_, _| 1.0).is_err());
        assert_eq!(eigen(DMatrix::zeros(3, 3)).unwrap().eigenvalues.max(), 0.0);
    }
}
