//! How many numbers of a smooth curve readings determine.
//!
//! Unknown are W values r of a curve, in units of its peak; S are their scores, ∂(mean reading)/∂r over the deviation of the reading, from
//! which the span of all other unknowns has been removed, so that the information is J = SᵀS. With S = U D Vᵀ:
//!
//! * a direction v_i (orthonormal, a combination of the W values) is known to σ_i = 1/D_i;
//! * *determined* is a direction with σ_i ≤ [`SHARE`] = 0.1, a tenth of the peak. The count of these is the number of values that the
//!   readings determine of themselves. It is one of the curve at these W values: a curve of twice the values has directions of the
//!   same shape whose coefficient is √2 as large;
//! * numerical rank: singular values above rounding, max(rows, W)·ε·D_1;
//! * deviation of a value alone, √Σ(V_ji/D_i)², infinite below full rank.
//!
//! With a Gaussian prior r = m + A z ([`CurvePrior`]: how smooth the curve is), S A = U D Vᵀ:
//!
//! * deviations of the posterior are the lengths of rows of A V/√(1 + D²);
//! * effective number tr[J(J + P)⁻¹] = Σ D²/(1 + D²), P the information of the prior: how many numbers of the estimate come from the
//!   readings and not from the prior;
//! * resolving kernels K = A V [D/(1 + D²)] Uᵀ S: row j is what value j of the estimate sees of the true curve, E[r̂ − m] = K (r − m).
//!
//! No inverse is formed. Assumptions: normal readings of known deviation, linear in r.
//!
//! Source: Backus and Gilbert, Phil. Trans. R. Soc. A 266, 123 (1970), doi:10.1098/rsta.1970.0005 (resolving kernels); Rodgers,
//! 'Inverse Methods for Atmospheric Sounding' (2000), section 2.4 (degrees of freedom for signal).

use crate::correlation::{ROUNDS, covariance, exponential, matern, modes};
use crate::error::{Error, Result, check};
use crate::order;
use nalgebra::{DMatrix, DVector};

/// A direction is determined if its coefficient is known to this share of the curve's peak.
pub const SHARE: f64 = 0.1;

/// What is known of a curve beforehand: about which one it lies, its scale, and how much and how smoothly its shape may differ.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct CurveSmoothness {
    /// Relative deviation of the scale of the whole curve.
    pub scale: f64,
    /// Deviation of each value compared with that, in units of the peak.
    pub shape: f64,
    /// Difference of wavenumbers at which the correlation of the shape has fallen to a quarter, cm⁻¹.
    pub correlation_cm1: f64,
}

/// A Gaussian prior of a curve: mean m, covariance A Aᵀ.
#[derive(Debug, Clone, PartialEq)]
pub struct CurvePrior {
    mean: Vec<f64>,
    factor: DMatrix<f64>,
}

impl CurvePrior {
    /// Curves about `typical`, given at these wavenumbers.
    ///
    /// # Errors
    /// No value, another number of them, deviations or a length that are not positive.
    pub fn smooth(centres_cm1: &[f64], typical: &[f64], known: CurveSmoothness) -> Result<Self> {
        Self::correlated(centres_cm1, typical, known, matern)
    }

    /// The same for curves with kinks, of exponential correlation at the same length: what smoothness is worth.
    ///
    /// # Errors
    /// As [`Self::smooth`].
    pub fn kinked(centres_cm1: &[f64], typical: &[f64], known: CurveSmoothness) -> Result<Self> {
        Self::correlated(centres_cm1, typical, known, exponential)
    }

    fn correlated(
        centres_cm1: &[f64],
        typical: &[f64],
        known: CurveSmoothness,
        correlation: fn(f64, f64) -> f64,
    ) -> Result<Self> {
        check::positive("relative deviation of the response's scale", known.scale, "")?;
        check::positive("deviation of the response's shape", known.shape, "")?;
        check::positive("correlation of the response", known.correlation_cm1, "cm^-1")?;
        typical.iter().try_for_each(|value| check::finite("typical response", *value, "").map(drop))?;
        let count = centres_cm1.len();
        if typical.len() != count || count == 0 {
            let what = "values of a typical response".into();
            return Err(Error::Length { what, found: typical.len(), expected: count.max(1) });
        }
        let (scale, shape) = (known.scale * known.scale, known.shape * known.shape);
        let covariance = covariance(count, |i, j| {
            let apart = centres_cm1[i] - centres_cm1[j];
            scale * typical[i] * typical[j] + shape * correlation(apart, known.correlation_cm1)
        })?;
        Ok(Self { mean: typical.to_vec(), factor: modes(covariance, count)? })
    }

    /// m.
    #[must_use]
    pub fn mean(&self) -> &[f64] {
        &self.mean
    }

    /// A, a row for each value.
    #[must_use]
    pub fn factor(&self) -> &DMatrix<f64> {
        &self.factor
    }

    /// The curve that belongs to a z, for instance a drawn one; what is missing of it is 0.
    #[must_use]
    pub fn at(&self, z: &[f64]) -> Vec<f64> {
        let z = DVector::from_fn(self.factor.ncols(), |k, _| z.get(k).copied().unwrap_or(0.0));
        let apart = &self.factor * z;
        self.mean.iter().zip(apart.iter()).map(|(mean, more)| mean + more).collect()
    }

    /// Numbers of z.
    #[must_use]
    pub fn unknowns(&self) -> usize {
        self.factor.ncols()
    }
}

/// What readings tell of a curve.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Determined {
    /// D, the largest first: 1/σ of each direction.
    pub singular: Vec<f64>,
    /// V, a column for each direction.
    pub directions: DMatrix<f64>,
    /// Singular values above rounding.
    pub rank: usize,
    /// Directions known to a tenth of the peak.
    pub number: usize,
    /// tr[J(J + P)⁻¹].
    pub effective: f64,
    /// Deviation of each value without the prior; infinite below full rank.
    pub sigma_free: Vec<f64>,
    /// Deviation of each value with the prior.
    pub sigma_smooth: Vec<f64>,
    /// Deviation of each value by the prior alone.
    pub sigma_prior: Vec<f64>,
    /// K, a row for each value.
    pub kernels: DMatrix<f64>,
}

impl Determined {
    /// Of scores that have lost the span of the other unknowns.
    ///
    /// # Errors
    /// Another number of values than the prior's, scores that are not finite.
    pub fn of(scores: &DMatrix<f64>, prior: &CurvePrior) -> Result<Self> {
        let values = prior.mean.len();
        if scores.ncols() != values {
            let what = "scores of a reading".into();
            return Err(Error::Length { what, found: scores.ncols(), expected: values });
        }
        scores.iter().try_for_each(|score| check::finite("score of a response", *score, "").map(drop))?;
        let Some((singular, directions)) = right_vectors(scores.clone()) else { return Err(no_values()) };
        let rounding = scores.nrows().max(values) as f64 * f64::EPSILON * singular.first().unwrap_or(&0.0);
        let rank = singular.iter().filter(|d| **d > rounding).count();
        let number = singular.iter().filter(|d| **d * SHARE >= 1.0 && **d > rounding).count();
        let free = |j: usize| {
            if rank < values {
                return f64::INFINITY;
            }
            (0..rank).map(|i| (directions[(j, i)] / singular[i]).powi(2)).sum::<f64>().sqrt()
        };
        let a = &prior.factor;
        let Some((d, v)) = right_vectors(scores * a) else { return Err(no_values()) };
        let av = a * &v;
        let modes = d.len();
        let smooth =
            |j: usize| (0..modes).map(|i| av[(j, i)].powi(2) / (1.0 + d[i] * d[i])).sum::<f64>().sqrt();
        // D Uᵀ S = Vᵀ (S A)ᵀ S, so that the left vectors are not needed.
        let mut seen = v.tr_mul(&(scores * a).tr_mul(scores));
        for (mut row, d) in seen.row_iter_mut().zip(&d) {
            row.scale_mut(1.0 / (1.0 + d * d));
        }
        Ok(Self {
            sigma_free: (0..values).map(free).collect(),
            sigma_smooth: (0..values).map(smooth).collect(),
            sigma_prior: (0..values).map(|j| a.row(j).norm()).collect(),
            effective: d.iter().map(|d| d * d / (1.0 + d * d)).sum(),
            kernels: &av * seen,
            singular,
            directions,
            rank,
            number,
        })
    }
}

fn no_values() -> Error {
    Error::malformed("scores of a response have no singular values", "give readings of finite numbers")
}

/// Singular values, as many as columns, the largest first, with the right vectors.
pub(crate) fn right_vectors(matrix: DMatrix<f64>) -> Option<(Vec<f64>, DMatrix<f64>)> {
    let columns = matrix.ncols();
    // A triangle has as many rows as columns, whatever the readings; it has their singular values.
    let tall = if matrix.nrows() < columns { matrix.resize_vertically(columns, 0.0) } else { matrix };
    let svd = tall.qr().r().try_svd(false, true, f64::EPSILON, ROUNDS * (columns + 1))?;
    let v = svd.v_t?.transpose();
    let mut order: Vec<usize> = (0..columns).collect();
    order::descending(&mut order, |b| svd.singular_values[*b]);
    let values = order.iter().map(|i| svd.singular_values[*i]).collect();
    Some((values, DMatrix::from_fn(columns, columns, |j, i| v[(j, order[i])])))
}

/// Scores without what the span of others has of them: S − Q QᵀS, Q an orthonormal basis of the others. Others that are dependent are
/// left out.
#[must_use]
pub fn without(scores: &DMatrix<f64>, others: &DMatrix<f64>) -> DMatrix<f64> {
    let mut basis: Vec<DVector<f64>> = Vec::new();
    for column in others.column_iter() {
        let mut rest = column.clone_owned();
        let length = rest.norm();
        // Twice is enough (Kahan).
        for _ in 0..2 {
            for q in &basis {
                let along = q.dot(&rest);
                rest.axpy(-along, q, 1.0);
            }
        }
        let left = rest.norm();
        if left > 1e-12 * length {
            basis.push(rest / left);
        }
    }
    let mut out = scores.clone();
    for mut column in out.column_iter_mut() {
        for _ in 0..2 {
            for q in &basis {
                let along = q.dot(&column);
                column.axpy(-along, q, 1.0);
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn centres() -> Vec<f64> {
        (0..6).map(|j| 700.0 + 100.0 * f64::from(j)).collect()
    }

    fn prior() -> CurvePrior {
        let known = CurveSmoothness { scale: 0.3, shape: 0.2, correlation_cm1: 150.0 };
        CurvePrior::smooth(&centres(), &[0.2, 0.6, 1.0, 0.9, 0.7, 0.3], known).unwrap()
    }

    /// Values read one by one, each with its own deviation: nothing has to be computed.
    #[test]
    fn values_read_alone_are_counted_by_their_own_deviation() {
        let sigma = [0.01, 0.05, 0.099, 0.101, 0.5, 3.0];
        let scores = DMatrix::from_fn(6, 6, |i, j| if i == j { 1.0 / sigma[i] } else { 0.0 });
        let found = Determined::of(&scores, &prior()).unwrap();
        assert_eq!((found.number, found.rank), (3, 6));
        for (found, sigma) in found.sigma_free.iter().zip(sigma) {
            assert!((found / sigma - 1.0).abs() < 1e-12);
        }
    }

    /// By inverses of the textbook, which agree where nothing is nearly singular.
    #[test]
    fn posterior_and_effective_number_are_those_of_inverses() {
        let scores = DMatrix::from_fn(9, 6, |i, j| ((1 + i * i + 3 * j * (i + 1)) as f64).sin() * 4.0);
        let prior = prior();
        let found = Determined::of(&scores, &prior).unwrap();
        let j = scores.tr_mul(&scores);
        let p = (prior.factor() * prior.factor().transpose()).try_inverse().unwrap();
        let both = (&j + &p).try_inverse().unwrap();
        let kernels = &both * &j;
        assert!((found.effective / kernels.trace() - 1.0).abs() < 1e-9);
        for a in 0..6 {
            assert!((found.sigma_smooth[a] / both[(a, a)].sqrt() - 1.0).abs() < 1e-9);
            for b in 0..6 {
                assert!((found.kernels[(a, b)] - kernels[(a, b)]).abs() < 1e-9);
            }
        }
        let free = j.try_inverse().unwrap();
        assert!((found.sigma_free[2] / free[(2, 2)].sqrt() - 1.0).abs() < 1e-9);
    }

    /// Two filters that read the same: one direction less, and no value alone.
    #[test]
    fn what_cannot_be_told_is_infinite_and_not_a_number_of_rounding() {
        let scores = DMatrix::from_fn(6, 6, |i, j| {
            let row = i.min(4);
            ((1 + row * row + 3 * j * (row + 1)) as f64).sin() * 1e6
        });
        let found = Determined::of(&scores, &prior()).unwrap();
        assert_eq!((found.rank, found.number), (5, 5));
        assert!(found.sigma_free.iter().all(|sigma| sigma.is_infinite()));
        assert!(found.sigma_smooth.iter().zip(&found.sigma_prior).all(|(after, before)| after < before));
    }
}
