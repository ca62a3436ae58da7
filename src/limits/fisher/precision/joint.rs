//! The least covariance of several estimates at once, kept as a triangular factor.
//!
//! Either the information J = RᵀR (R upper) or the covariance C = D L Lᵀ D (L lower, D the deviations). Both make the
//! bound the unit ball: z = Rx or z = L⁻¹D⁻¹x has covariance 1 for an estimate x that reaches it. Covariances come from
//! triangular solves, C_ij = y_i·y_j with Rᵀy_i = e_i; no inverse is formed.

use crate::error::{Error, Result, check};

/// Cramér–Rao bound of the covariance of several parameters.
///
/// ```
/// use hadar::fisher::precision::JointBound;
/// let bound = JointBound::from_covariance(2, &[4.0, 1.0, 1.0, 9.0])?;
/// assert!((bound.sigma(0) - 2.0).abs() < 1e-14 && (bound.covariance(1, 0) - 1.0).abs() < 1e-14);
/// let z = bound.whitened(&[2.0, 0.0]);
/// // xᵀC⁻¹x = 4·9/35.
/// assert!((z[0] * z[0] + z[1] * z[1] - 36.0 / 35.0).abs() < 1e-14);
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct JointBound {
    /// Rows of Rᵀ, or of L: the lower triangle, full rows.
    lower: Vec<f64>,
    /// Deviations D; empty where `lower` is Rᵀ.
    sigma: Vec<f64>,
    parameters: usize,
}

impl JointBound {
    /// The bound of a covariance given row by row.
    ///
    /// # Errors
    /// Not `parameters`² numbers, or no positive definite matrix.
    pub fn from_covariance(parameters: usize, rows: &[f64]) -> Result<Self> {
        let n = parameters;
        if n == 0 || n.checked_mul(n) != Some(rows.len()) {
            let expected = n.max(1).saturating_mul(n.max(1));
            return Err(Error::Length {
                what: "elements of the covariance".into(),
                found: rows.len(),
                expected,
            });
        }
        let at = |i: usize, j: usize| rows.get(i * n + j).copied().unwrap_or(f64::NAN);
        let mut sigma = Vec::with_capacity(n);
        for i in 0..n {
            sigma.push(check::positive("variance of a bound", at(i, i), "")?.sqrt());
        }
        let mut lower = vec![0.0; n * n];
        for i in 0..n {
            for j in 0..=i {
                if (at(i, j) - at(j, i)).abs() > 1e-9 * sigma[i] * sigma[j] {
                    return Err(Error::malformed("a covariance that is not symmetric", "give C_ij = C_ji"));
                }
                let known: f64 = (0..j).map(|k| lower[i * n + k] * lower[j * n + k]).sum();
                let left = at(i, j) / sigma[i] / sigma[j] - known;
                lower[i * n + j] = if i == j { left.sqrt() } else { left / lower[j * n + j] };
            }
            if !(lower[i * n + i] > 0.0 && lower[i * n + i].is_finite()) {
                let found = "a covariance that is not positive definite";
                return Err(Error::malformed(found, "leave out what the others determine"));
            }
        }
        Ok(Self { lower, sigma, parameters })
    }

    /// The bound of a single parameter.
    ///
    /// # Errors
    /// A deviation that is not positive.
    pub fn from_sigma(sigma: f64) -> Result<Self> {
        check::positive("deviation of a bound", sigma, "")?;
        Ok(Self { lower: vec![1.0], sigma: vec![sigma], parameters: 1 })
    }

    /// J = RᵀR from the unit upper triangle and lengths of a factorisation whose columns were divided by `scales`.
    pub(super) fn from_factor(triangle: &[f64], norms: &[f64], scales: &[f64]) -> Self {
        let n = norms.len();
        let mut lower = vec![0.0; n * n];
        for row in 0..n {
            for column in row..n {
                lower[column * n + row] = norms[row] * triangle[row * n + column] * scales[column];
            }
        }
        Self { lower, sigma: Vec::new(), parameters: n }
    }

    /// How many parameters there are.
    #[must_use]
    pub fn parameters(&self) -> usize {
        self.parameters
    }

    /// Least deviation of parameter i; NaN if there is none.
    #[must_use]
    pub fn sigma(&self, i: usize) -> f64 {
        self.covariance(i, i).sqrt()
    }

    /// Least covariance of parameters i and j; NaN if there are no such.
    #[must_use]
    pub fn covariance(&self, i: usize, j: usize) -> f64 {
        let n = self.parameters;
        if i >= n || j >= n {
            return f64::NAN;
        }
        if let (Some(a), Some(b)) = (self.sigma.get(i), self.sigma.get(j)) {
            let product: f64 = (0..=i.min(j)).map(|k| self.lower[i * n + k] * self.lower[j * n + k]).sum();
            return a * b * product;
        }
        let column = |own: usize| {
            let mut unit = vec![0.0; n];
            unit[own] = 1.0;
            self.solve(unit)
        };
        column(i).iter().zip(column(j)).map(|(a, b)| a * b).sum()
    }

    /// z of a deviation x from the mean, one value for each parameter: covariance 1 if x reaches the bound.
    #[must_use]
    pub fn whitened(&self, deviation: &[f64]) -> Vec<f64> {
        let n = self.parameters;
        if self.sigma.is_empty() {
            let row = |i: usize| deviation.iter().enumerate().skip(i).take(n - i);
            return (0..n).map(|i| row(i).map(|(j, x)| self.lower[j * n + i] * x).sum()).collect();
        }
        let mut scaled: Vec<f64> = deviation.iter().zip(&self.sigma).map(|(x, sigma)| x / sigma).collect();
        scaled.resize(n, 0.0);
        self.solve(scaled)
    }

    /// Forward substitution with the lower triangle.
    fn solve(&self, mut right: Vec<f64>) -> Vec<f64> {
        let n = self.parameters;
        for i in 0..n {
            let known: f64 = (0..i).map(|k| self.lower[i * n + k] * right[k]).sum();
            right[i] = (right[i] - known) / self.lower[i * n + i];
        }
        right
    }
}
