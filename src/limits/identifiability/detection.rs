//! From a statistical distance to probabilities, information and brackets.
//!
//! * detection probability P = Φ(d) = ½ erfc(−d/√2), miss probability ½ erfc(d/√2) (S20);
//! * information log₂ 2P (paper, eq. 2), which is not a mutual information; the mutual information of the
//!   binary decision, 1 − H₂(P), stands beside it;
//! * bracket of the error of the best test between two equally likely states, from the Bhattacharyya
//!   coefficient ρ = exp(−d²/2): ½(1 − √(1−ρ²)) ≤ error ≤ ½ρ (Kailath, IEEE Trans. Commun. 15, 52 (1967),
//!   doi:10.1109/TCOM.1967.1089532).
//!
//! Relative errors stay below 1e-15·(10 + d²), also of miss probabilities down to 1e-300.

use crate::error::{Error, Result};
use crate::fisher::Counting;
use crate::statistics::erfc_inv;
use libm::{erf, erfc};
use std::f64::consts::{FRAC_1_SQRT_2, LN_2, SQRT_2};

/// Detection probability Φ(d).
///
/// ```
/// let p = hadar::identifiability::detection::probability(1.0);
/// assert!((p - 0.841_344_746_068_542_9).abs() < 1e-15);
/// ```
#[must_use]
pub fn probability(distance: f64) -> f64 {
    0.5 * erfc(-distance * FRAC_1_SQRT_2)
}

/// Miss probability 1 − Φ(d), to full relative precision in the tail.
#[must_use]
pub fn miss_probability(distance: f64) -> f64 {
    0.5 * erfc(distance * FRAC_1_SQRT_2)
}

/// Information log₂ 2P in bits (paper, eq. 2); d ≥ 0.
#[must_use]
pub fn information_bits(distance: f64) -> f64 {
    erf(distance * FRAC_1_SQRT_2).ln_1p() / LN_2
}

/// Mutual information of the binary decision, 1 − H₂(P) in bits; d ≥ 0.
#[must_use]
pub fn mutual_information_bits(distance: f64) -> f64 {
    let excess = erf(distance * FRAC_1_SQRT_2);
    if excess < 0.4 {
        // [(1+δ)ln(1+δ) + (1−δ)ln(1−δ)]/2 = Σ δ²ⁿ/(2n(2n−1)), without its cancelling parts.
        let square = excess * excess;
        let term = |n: u32| 1.0 / f64::from(2 * n * (2 * n - 1));
        return (1..=20).rev().fold(0.0, |sum, n| (sum + term(n)) * square) / LN_2;
    }
    let miss = miss_probability(distance);
    let entropy = |p: f64| if p > 0.0 { -p * p.log2() } else { 0.0 };
    let hit = -(1.0 - miss) * (-miss).ln_1p() / LN_2;
    1.0 - entropy(miss) - hit
}

/// The statistical distance at which the detection probability is `probability`, in (½, 1).
///
/// # Errors
/// A probability outside (½, 1).
pub fn distance_for_probability(probability: f64) -> Result<f64> {
    if !(probability > 0.5 && probability < 1.0) {
        return Err(Error::out_of_range("detection probability", probability, "", "above 0.5 and below 1"));
    }
    distance_for_miss(1.0 - probability)
}

/// The statistical distance at which the miss probability is `probability`, in (0, ½).
///
/// # Errors
/// A probability outside (0, ½).
pub fn distance_for_miss(probability: f64) -> Result<f64> {
    if !(probability > 0.0 && probability < 0.5) {
        return Err(Error::out_of_range("miss probability", probability, "", "above 0 and below 0.5"));
    }
    Ok(SQRT_2 * erfc_inv(2.0 * probability))
}

/// The statistical distance at which the best test can find what is there with the probability `detection` and take the other
/// for it with no more than `false_alarm`: half of Φ⁻¹(P) + Φ⁻¹(1 − α), since the two states are 2d apart (Neyman and Pearson).
/// With α = 1 − P it is [`distance_for_probability`].
///
/// # Errors
/// Probabilities outside (½, 1) and (0, ½).
///
/// ```
/// // 90 % found, one false alarm in a thousand: (1.2816 + 3.0902)/2.
/// let d = hadar::identifiability::detection::distance_for_rates(0.9, 1e-3)?;
/// assert!((d / 2.185_9 - 1.0).abs() < 1e-4);
/// # Ok::<(), hadar::Error>(())
/// ```
pub fn distance_for_rates(detection: f64, false_alarm: f64) -> Result<f64> {
    Ok(0.5 * (distance_for_probability(detection)? + distance_for_miss(false_alarm)?))
}

/// Rigorous bounds on the error of the best test between the target and its closest confuser, at statistical distance d.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct ErrorBracket {
    /// No test errs less often.
    pub lower: f64,
    /// A likelihood-ratio test errs no more often.
    pub upper: f64,
}

/// The Bhattacharyya bracket at statistical distance d.
#[must_use]
pub fn error_bracket(distance: f64) -> ErrorBracket {
    let rho = (-0.5 * distance * distance).exp();
    // 1 − √(1−ρ²) = ρ²/(1 + √(1−ρ²)), and 1 − ρ² by expm1 where ρ → 1.
    let root = (-(-distance * distance).exp_m1()).sqrt();
    ErrorBracket { lower: 0.5 * rho * rho / (1.0 + root), upper: 0.5 * rho }
}

/// Probability that a test which must fit temperature and lighting is right, averaged over the target's
/// state and the nearest one: ½[Φ(d/h) + Φ(ρ d/h)], ρ = d′/d the ratio of return to nearest distance,
/// h = √((1+ρ)/2). An estimate (rms 0.03 over pairs of a measured library), not a bound.
#[must_use]
pub fn two_sided_probability(distance: f64, return_ratio: f64) -> f64 {
    let h = (0.5 * (1.0 + return_ratio)).sqrt();
    0.5 * (probability(distance / h) + probability(return_ratio * distance / h))
}

/// Half the separation of two mean spectra in units of the noise: ‖√(N + σ²) − √(N′ + σ²)‖, σ² that of `counting`.
#[must_use]
pub fn half_separation(means: &[f64], others: &[f64], counting: &Counting) -> f64 {
    let band = |(w, (a, b)): (usize, (&f64, &f64))| {
        let var = counting.var_added(w);
        ((a - b) / ((a + var).sqrt() + (b + var).sqrt()).max(f64::MIN_POSITIVE)).powi(2)
    };
    means.iter().zip(others).enumerate().map(band).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distance_and_probability_are_inverse() {
        for d in [1e-3, 0.1, 1.0, 3.0, 5.0] {
            let back = distance_for_probability(probability(d)).unwrap();
            // P near 1 holds few digits of the miss probability: u/φ(d) is what is lost.
            let lost = f64::EPSILON / ((-0.5 * d * d).exp() * 0.4 * d);
            assert!((back / d - 1.0).abs() < 4.0 * lost + 1e-13, "{d} {back}");
        }
        assert!(distance_for_probability(0.5).is_err());
        assert!(distance_for_probability(1.0).is_err());
        assert!(distance_for_probability(f64::NAN).is_err());
        assert!([0.0, 0.5, f64::NAN].iter().all(|miss| distance_for_miss(*miss).is_err()));
        // Rare false alarms keep their digits: Φ⁻¹(1 − 1e-20) = 9.262340089798408.
        let rare = distance_for_rates(0.9, 1e-20).unwrap() - 0.5 * distance_for_probability(0.9).unwrap();
        assert!((2.0 * rare / 9.262_340_089_798_408 - 1.0).abs() < 1e-12, "{rare}");
        let even = distance_for_rates(0.95, 0.05).unwrap();
        assert!((even / distance_for_probability(0.95).unwrap() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn the_bracket_holds_the_gaussian_error() {
        for i in 0..400 {
            let d = 0.05 * f64::from(i);
            let bracket = error_bracket(d);
            let miss = miss_probability(d);
            assert!(bracket.lower <= miss * (1.0 + 1e-14) && miss <= bracket.upper * (1.0 + 1e-14), "{d}");
        }
    }

    #[test]
    fn mutual_information_of_a_binary_channel() {
        // Published: 0.369 bit at d = 1; series and direct form must meet.
        assert!((mutual_information_bits(1.0) - 0.3689).abs() < 1e-4);
        // mpmath at 60 digits; δ = 0.4 between the last two.
        for (d, exact) in
            [(0.05, 0.0011474082955650238), (0.52, 0.11684470723239425), (0.53, 0.12109847177944612)]
        {
            assert!((mutual_information_bits(d) / exact - 1.0).abs() < 1e-14, "{d}");
        }
    }
}
