//! Errors that all readings of an object share, which no number of them averages away.
//!
//! n readings y_i = μ + a + b_i of the same spectrum, b_i independent with the diagonal covariance S, a common to all with the
//! covariance C. Their mean is sufficient, its covariance S/n + C, and two spectra with the difference D have the separation
//!
//! d_n = ½ √(D′(S/n + C)⁻¹D),   P = Φ(d_n).
//!
//! The counts of the sum over all readings are D here, and their covariance is V + C, V diagonal. In the metric of the nearest
//! distance, r = √(N + σ²) − √(N′ + σ²) and D = 2 r s̄ with s̄ the mean of the two roots, V = s̄²,
//!
//! d² = r′(1 + s̄⁻¹ C s̄⁻¹)⁻¹ r.
//!
//! For a bound that holds for every D: C ≤ diag(c), c_w = Σ_v |C_wv| (diagonal dominance), so that d² is at least what the
//! nearest distance says with c added to the variance of the bands: √(a + c) + √(b + c) ≥ √((√a + √b)² + 4c).
//!
//! Errors along a chain, x_{w+1} = ρ x_w + √(1 − ρ²) z, of target and alternative take a Kalman filter of two states in the place of the
//! covariance: d² = ¼ Σ_w e_w²/S_w, e_w the part of D_w that the bands before do not tell and S_w its variance.
//!
//! Symbols: N, N′ counts of the sum, σ² its other variance, counts²; C counts².
//!
//! Assumptions: Gaussian; the common errors are known in law, not in value.
//!
//! Source: R. E. Kalman, J. Basic Eng. 82, 35 (1960) (innovations); H. H. Barrett and K. J. Myers, Foundations of Image Science (2004), 13.2.12 (the ideal linear observer).

use crate::error::{Error, Result};
use nalgebra::{Cholesky, DMatrix, DVector};

/// What such errors are called among the lines of a noise.
pub const EMISSIVITY_ERRORS: &str = "errors of the emissivities";

/// A covariance of the bands, counts², row by row.
#[derive(Debug, Clone, PartialEq)]
pub struct SharedCovariance {
    bands: usize,
    values: Vec<f64>,
}

impl SharedCovariance {
    /// No errors in so many bands.
    #[must_use]
    pub fn none(bands: usize) -> Self {
        Self { bands, values: vec![0.0; bands * bands] }
    }

    /// Adds to the covariance of two bands.
    pub fn add(&mut self, one: usize, other: usize, covariance: f64) {
        self.values[one * self.bands + other] += covariance;
    }

    /// Sum of the variances of all bands, counts².
    #[must_use]
    pub fn trace(&self) -> f64 {
        self.values.iter().step_by(self.bands + 1).sum()
    }

    /// Adds errors mm′ of one mode, counts.
    pub fn add_mode(&mut self, mode: &[f64]) {
        for (row, a) in self.values.chunks_mut(self.bands).zip(mode) {
            row.iter_mut().zip(mode).for_each(|(sum, b)| *sum += a * b);
        }
    }

    /// The separation d of two spectra by all readings together: `difference` N − N′, counts, which roots of large counts do not have the
    /// digits for, and `roots` √(N + σ²) of either.
    ///
    /// # Errors
    /// Lists of another length; a covariance that is none.
    ///
    /// ```
    /// use hadar::identifiability::shared::SharedCovariance;
    /// // One band, 100 and 104 counts: half of 4 counts over the deviation, here √(102 + 4).
    /// let mut errors = SharedCovariance::none(1);
    /// errors.add_mode(&[2.0]);
    /// let d = errors.separation(&[-4.0], [&[100f64.sqrt()], &[104f64.sqrt()]])?;
    /// assert!((d / (2.0 / 106f64.sqrt()) - 1.0).abs() < 1e-3);
    /// # Ok::<(), hadar::Error>(())
    /// ```
    pub fn separation(&self, difference: &[f64], roots: [&[f64]; 2]) -> Result<f64> {
        let bands = self.bands;
        if let Some(found) =
            [difference, roots[0], roots[1]].iter().map(|list| list.len()).find(|found| *found != bands)
        {
            return Err(Error::Length { what: "roots of counts".into(), found, expected: bands });
        }
        let mean: Vec<f64> = roots[0].iter().zip(roots[1]).map(|(a, b)| 0.5 * (a + b)).collect();
        let r = DVector::from_iterator(bands, difference.iter().zip(&mean).map(|(d, mean)| d / (2.0 * mean)));
        let scaled = |row: usize, column: usize| {
            let own = if row == column { 1.0 } else { 0.0 };
            own + self.values[row * bands + column] / (mean[row] * mean[column])
        };
        // 1 + K with K of no negative direction is solved to the last digits, however large K is: what is small of r′(1 + K)⁻¹r is where
        // K is large, and counts little.
        let factor = Cholesky::new(DMatrix::from_fn(bands, bands, scaled)).ok_or_else(|| {
            let found = "errors of the emissivities whose covariance has a negative direction, or no numbers";
            Error::malformed(found, "state other errors")
        })?;
        let solved = factor.l().solve_lower_triangular(&r).map_or(f64::NAN, |solved| solved.norm_squared());
        Ok(solved.sqrt())
    }
}

/// Errors of one surface along the bands in their order.
#[derive(Debug, Clone)]
pub struct ErrorChain {
    /// Counts of every band for one deviation.
    pub counts: Vec<f64>,
    /// Correlation of every band's error with that of the band before; 0 of the first.
    pub correlation: Vec<f64>,
}

/// The separation d by readings that share errors along two chains, arguments as of [`SharedCovariance::separation`].
///
/// # Errors
/// Lists of another length.
pub fn separation_along(difference: &[f64], roots: [&[f64]; 2], chains: [&ErrorChain; 2]) -> Result<f64> {
    let bands = difference.len();
    let lists = [roots[0], roots[1], &chains[0].counts, &chains[1].counts];
    let of_chains = chains.map(|chain| chain.correlation.as_slice());
    let wrong = lists.iter().chain(&of_chains).map(|list| list.len()).find(|found| *found != bands);
    if let Some(found) = wrong {
        return Err(Error::Length { what: "errors of bands".into(), found, expected: bands });
    }
    let (mut mean, mut var, mut sum) = ([0.0; 2], [[0.0; 2]; 2], 0.0);
    for w in 0..bands {
        let rho = of_chains.map(|correlation| correlation[w]);
        for i in 0..2 {
            mean[i] *= rho[i];
            for j in 0..2 {
                var[i][j] *= rho[i] * rho[j];
            }
            var[i][i] += (1.0 - rho[i]) * (1.0 + rho[i]);
        }
        let load = [chains[0].counts[w], chains[1].counts[w]];
        let seen = [0, 1].map(|i: usize| var[i][0] * load[0] + var[i][1] * load[1]);
        let root = 0.5 * (roots[0][w] + roots[1][w]);
        let all = root * root + load[0] * seen[0] + load[1] * seen[1];
        let new = difference[w] - load[0] * mean[0] - load[1] * mean[1];
        sum += new * (new / all);
        for i in 0..2 {
            mean[i] += seen[i] * (new / all);
            for j in 0..2 {
                var[i][j] -= seen[i] * (seen[j] / all);
            }
        }
    }
    Ok(0.5 * sum.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::rngs::ChaCha8Rng;
    use rand::{RngExt, SeedableRng};

    /// All readings of 5 pixels and 8 bands with their 40 × 40 covariance, against the sum over the pixels.
    #[test]
    fn the_sum_over_pixels_says_what_all_readings_say() {
        let (pixels, bands) = (5, 8);
        let mut random = ChaCha8Rng::seed_from_u64(5);
        for _ in 0..50 {
            let mut draw = |from: f64, to: f64| from + (to - from) * random.random::<f64>();
            let own: Vec<f64> = (0..bands).map(|_| draw(1.0, 3.0)).collect();
            let pattern: Vec<f64> = (0..bands).map(|_| draw(0.0, 1.0)).collect();
            let common = draw(0.0, 2.0);
            let modes: Vec<Vec<f64>> =
                (0..3).map(|_| (0..bands).map(|_| draw(-1.0, 1.0)).collect()).collect();
            let difference: Vec<f64> = (0..bands).map(|_| draw(-1.0, 1.0)).collect();
            let covariance = DMatrix::from_fn(pixels * bands, pixels * bands, |i, j| {
                let (w, v) = (i % bands, j % bands);
                let modes: f64 = modes.iter().map(|mode| mode[w] * mode[v]).sum();
                let band = if w == v { common } else { 0.0 };
                let own = if i == j { own[w] + pattern[w] } else { 0.0 };
                modes + band + own
            });
            let stacked = DVector::from_fn(pixels * bands, |i, _| difference[i % bands]);
            let solved = Cholesky::new(covariance).unwrap().solve(&stacked);
            let exact = 0.5 * stacked.dot(&solved).sqrt();

            // The sum: n own variances, n² of what is common.
            let n = pixels as f64;
            let mut shared = SharedCovariance::none(bands);
            for mode in &modes {
                shared.add_mode(&mode.iter().map(|m| n * m).collect::<Vec<_>>());
            }
            // Roots whose difference of squares is the difference of counts, about a mean square of the variance.
            let roots = [1.0, -1.0].map(|sign| {
                let root = |w: usize| {
                    let mean = (n * (own[w] + pattern[w]) + n * n * common).sqrt();
                    mean + sign * n * difference[w] / (4.0 * mean)
                };
                (0..bands).map(root).collect::<Vec<f64>>()
            });
            let sums: Vec<f64> = difference.iter().map(|d| n * d).collect();
            let found = shared.separation(&sums, [&roots[0], &roots[1]]).unwrap();
            assert!((found / exact - 1.0).abs() < 1e-9, "{found} {exact}");

            // The diagonal that dominates is a bound from below for it.
            let dominating = shared.values.chunks(bands).map(|row| row.iter().map(|c| c.abs()).sum::<f64>());
            let least: f64 = dominating
                .enumerate()
                .map(|(w, c)| {
                    let [a, b] = [roots[0][w], roots[1][w]];
                    ((a * a + c).sqrt() - (b * b + c).sqrt()).powi(2)
                })
                .sum();
            assert!(least.sqrt() <= found * (1.0 + 1e-12), "{} {found}", least.sqrt());
        }
    }

    /// Shared modes alone give no ceiling: what lies outside them grows as √n; a floor of full rank ends it.
    #[test]
    fn outside_the_modes_it_grows_as_the_root() {
        let separation = |n: f64, floor: f64| {
            let mut shared = SharedCovariance::none(3);
            shared.add_mode(&[n * 30.0, n * 30.0, n * 30.0]);
            let difference = [1.0, -1.0, 1.0];
            let roots = [1.0, -1.0].map(|sign| {
                difference
                    .map(|d| {
                        let mean = (n + n * n * floor).sqrt();
                        mean + sign * n * d / (4.0 * mean)
                    })
                    .to_vec()
            });
            shared.separation(&difference.map(|d| n * d), [&roots[0], &roots[1]]).unwrap()
        };
        assert!((separation(1e6, 0.0) / separation(1e4, 0.0) / 10.0 - 1.0).abs() < 1e-3);
        let ceiling = separation(1e12, 0.01);
        assert!((separation(1e8, 0.01) / ceiling - 1.0).abs() < 1e-5);
        // Of D′C⁻¹D with C = 900 J + 0.01: what is along the mode is (1/3)²·3 over 2700.01, the rest, 8/3, over 0.01.
        let exact = 0.5 * (8.0 / 3.0 / 0.01 + 1.0 / 3.0 / 2700.01f64).sqrt();
        assert!((ceiling / exact - 1.0).abs() < 1e-6, "{ceiling} {exact}");
    }

    #[test]
    fn a_chain_is_its_covariance() {
        let bands = 40;
        let mut random = ChaCha8Rng::seed_from_u64(8);
        for scale in [1e-3, 1.0, 1e6] {
            let mut draw = |from: f64, to: f64| from + (to - from) * random.random::<f64>();
            let mut list = |from: f64, to: f64| (0..bands).map(|_| draw(from, to)).collect::<Vec<f64>>();
            let (difference, own, other) = (list(-1.0, 1.0), list(1.0, 2.0), list(1.0, 2.0));
            let mut chains =
                [0, 1].map(|_| ErrorChain { counts: list(-scale, scale), correlation: list(0.0, 1.0) });
            chains.iter_mut().for_each(|chain| chain.correlation[0] = 0.0);
            let mut covariance = SharedCovariance::none(bands);
            for chain in &chains {
                for one in 0..bands {
                    let mut correlated = chain.counts[one];
                    covariance.add(one, one, correlated * chain.counts[one]);
                    for other in one + 1..bands {
                        correlated *= chain.correlation[other];
                        covariance.add(one, other, correlated * chain.counts[other]);
                        covariance.add(other, one, correlated * chain.counts[other]);
                    }
                }
            }
            let roots = [own.as_slice(), other.as_slice()];
            let exact = covariance.separation(&difference, roots).unwrap();
            let found = separation_along(&difference, roots, [&chains[0], &chains[1]]).unwrap();
            assert!((found / exact - 1.0).abs() < 1e-9, "{scale}: {found} {exact}");
        }
        let short = ErrorChain { counts: vec![1.0], correlation: vec![0.0] };
        assert!(separation_along(&[1.0, 1.0], [&[1.0, 1.0]; 2], [&short; 2]).is_err());
    }

    #[test]
    fn errors_that_are_none_are_refused() {
        let mut errors = SharedCovariance::none(2);
        errors.add(0, 1, 1e3);
        errors.add(1, 0, 1e3);
        assert!(errors.separation(&[1.0, 1.0], [&[1.0, 1.0], &[2.0, 1.0]]).is_err());
        assert!(errors.separation(&[1.0, 1.0], [&[1.0], &[2.0, 1.0]]).is_err());
    }
}
