//! How alike a smooth curve is at two places.
//!
//! Matérn, 5/2: ρ = (1 + x + x²/3) e⁻ˣ, x = 3.55 |a − b|/ℓ, so that ρ has fallen to a quarter where the places are ℓ apart. Curves of
//! this correlation have two derivatives: smooth, but not without an end.
//!
//! Source: Rasmussen and Williams, 'Gaussian Processes for Machine Learning' (2006), section 4.2.

use crate::order;
use nalgebra::{DMatrix, SymmetricEigen};

/// Modes whose deviation is a smaller share of the largest one's are left out.
const SMALL_MODE: f64 = 1e-6;

/// x at which (1 + x + x²/3) e⁻ˣ is a quarter.
const QUARTER: f64 = 3.55;

/// The correlation of two places that are `apart`, with `length` where it is a quarter, in the same unit.
pub fn matern(apart: f64, length: f64) -> f64 {
    let x = QUARTER * apart.abs() / length;
    (1.0 + x + x * x / 3.0) * libm::exp(-x)
}

/// A of a covariance A Aᵀ: √eigenvalue × eigenvector of the largest few, a column each.
pub fn modes(covariance: DMatrix<f64>, most: usize) -> DMatrix<f64> {
    let eigen = SymmetricEigen::new(covariance);
    let mut order: Vec<usize> = (0..eigen.eigenvalues.len()).collect();
    order::descending(&mut order, |b| eigen.eigenvalues[*b]);
    let least = SMALL_MODE * SMALL_MODE * eigen.eigenvalues.max();
    order.retain(|k| eigen.eigenvalues[*k] > least);
    order.truncate(most);
    DMatrix::from_fn(eigen.eigenvectors.nrows(), order.len(), |w, k| {
        eigen.eigenvalues[order[k]].sqrt() * eigen.eigenvectors[(w, order[k])]
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_one_at_a_place_and_a_quarter_at_the_length() {
        assert_eq!(matern(0.0, 50.0), 1.0);
        assert!((matern(-50.0, 50.0) - 0.25).abs() < 2e-3);
    }
}
