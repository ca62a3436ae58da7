//! How far the Gaussian law of counts, variance N + σ², is from the law it stands for.
//!
//! The law it stands for: Poisson counts of mean N plus a normal reading error of variance σ². With v = N + σ²,
//! skewness γ = N/v^{3/2} and the standard normal density φ, the distribution functions differ by
//!
//! F − Φ = −(γ/6)(x² − 1)φ(x) + (steps of whole counts) + O(1/v),
//!
//! whose first term is largest at x = 0, γ/(6√(2π)). Steps of height φ(x)/√v leave half of it on either side, smoothed
//! by the reading error to e^{−2π²σ²}/π of a sawtooth's. Source: Esseen, Acta Math. 77, 1 (1945),
//! doi:10.1007/BF02392223 (expansion for lattices); no bound: next order is 1/v.

use hadar::error::{Result, check};
use std::f64::consts::PI;

/// Largest distance between the distribution functions of the Gaussian law and of the law that it approximates.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct GaussianDistance {
    /// Between the laws as they are.
    pub largest: f64,
    /// The part of it that stays if the normal counts are rounded to whole ones: the missing skewness.
    pub skewness: f64,
}

/// The distance for counts of mean `mean` and electronic noise of variance `var_added`, counts²; leading order in
/// 1/√v, never above 1. Good to 5 % for v above 10, to 0.1 % for v above 10⁴.
///
/// ```
/// use hadar_simulate::draws::gaussian::gaussian_distance;
/// let hundred = gaussian_distance(100.0, 0.0)?;
/// assert!((hundred.largest - 0.0266).abs() < 1e-4 && (hundred.skewness - 0.00665).abs() < 1e-5);
/// # Ok::<(), hadar::Error>(())
/// ```
///
/// # Errors
/// A mean or a variance that is negative or not finite.
pub fn gaussian_distance(mean: f64, var_added: f64) -> Result<GaussianDistance> {
    check::non_negative("mean counts of a band", mean, "counts")?;
    check::non_negative("variance of electronic noise", var_added, "counts^2")?;
    if mean == 0.0 {
        return Ok(GaussianDistance { largest: 0.0, skewness: 0.0 });
    }
    let var = mean + var_added;
    let peak = (2.0 * PI * var).sqrt().recip();
    let skewness = (peak * (mean / var) / 6.0).min(1.0);
    let step = sawtooth(var_added) * peak;
    Ok(GaussianDistance { largest: (skewness + step).min(1.0), skewness })
}

/// Largest value of ½ − x, 0 < x < 1, repeated, after a normal of variance `var`: Σ e^{−2π²k²var} sin(2πkx)/(πk).
fn sawtooth(var: f64) -> f64 {
    let damping = 2.0 * PI * PI * var;
    if damping > 2.0 {
        // The first term is all there is to 1e-3 of it.
        return (-damping).exp() / PI;
    }
    let at = |x: f64| -> f64 {
        // ½ − x with the steps at whole numbers smoothed; far steps are complete.
        let sigma = var.sqrt();
        let step = |to: f64| {
            if sigma > 0.0 {
                hadar::identifiability::detection::probability(to / sigma)
            } else {
                f64::from(u8::from(to >= 0.0))
            }
        };
        (-3..=4).map(|k| step(x - f64::from(k))).sum::<f64>() - 4.0 + 0.5 - x
    };
    (0..=200).map(|k| at(f64::from(k) / 400.0)).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use hadar::identifiability::detection::probability;

    /// Distance by going through all counts, Poisson probabilities by their ratios from the likeliest.
    fn exact(mean: f64, sigma: f64) -> f64 {
        let reach = 12.0 * mean.sqrt() + 20.0;
        let low = (mean - reach).max(0.0).floor();
        let mode = mean.floor();
        let mut masses = vec![(mode, 1.0)];
        let (mut n, mut p) = (mode, 1.0);
        while n > low {
            p *= n / mean;
            n -= 1.0;
            masses.push((n, p));
        }
        masses.reverse();
        (n, p) = (mode, 1.0);
        while n < mean + reach {
            n += 1.0;
            p *= mean / n;
            masses.push((n, p));
        }
        let total: f64 = masses.iter().map(|mass| mass.1).sum();
        let normal = |x: f64| probability((x - mean) / (mean + sigma * sigma).sqrt());
        if sigma == 0.0 {
            let (mut sum, mut largest) = (0.0, 0.0_f64);
            for (n, p) in masses {
                largest = largest.max((sum - normal(n)).abs());
                sum += p / total;
                largest = largest.max((sum - normal(n)).abs());
            }
            return largest;
        }
        let spread = (mean + sigma * sigma).sqrt();
        let at = |x: f64| masses.iter().map(|(n, p)| p / total * probability((x - n) / sigma)).sum::<f64>();
        (-2000..=2000)
            .map(|k| mean + 2.0 * spread * f64::from(k) / 2000.0)
            .map(|x| (at(x) - normal(x)).abs())
            .fold(0.0, f64::max)
    }

    #[test]
    fn the_distance_is_that_of_the_distribution_functions() {
        for (mean, tolerance) in [(10.0, 0.05), (100.0, 0.01), (1e4, 1e-3), (1e6, 1e-4), (12345.6, 1e-3)] {
            let (found, exact) = (gaussian_distance(mean, 0.0).unwrap().largest, exact(mean, 0.0));
            assert!((found / exact - 1.0).abs() < tolerance, "{mean} {found} {exact}");
        }
        for (mean, sigma) in [(30.0_f64, 0.1_f64), (30.0, 0.3), (30.0, 1.0), (50.0, 6.0)] {
            let (found, exact) =
                (gaussian_distance(mean, sigma * sigma).unwrap().largest, exact(mean, sigma));
            assert!((found / exact - 1.0).abs() < 0.05, "{mean} {sigma} {found} {exact}");
        }
        for wrong in [-1.0, f64::NAN, f64::INFINITY] {
            assert!(gaussian_distance(wrong, 0.0).is_err() && gaussian_distance(1.0, wrong).is_err());
        }
        assert_eq!(gaussian_distance(1e-9, 0.0).unwrap().largest, 1.0);
    }
}
