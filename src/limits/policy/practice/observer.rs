//! How often an observer is right who has so many cycles on a target.
//!
//! * target transfer probability function: P = x^E/(1 + x^E), E = 2.7 + 0.7 x, x = N/N50 the cycles across the target over those
//!   with which one half of all observers are right ([`super::ObserverTask::johnson_cycles`]);
//! * targeting task performance: P = x^1.5/(1 + x^1.5), x = V/V50, V the integral of the root of contrast over the threshold of
//!   the eye, which is not computed here.
//!
//! Computed as 1/(1 + exp(−E ln x)), which loses nothing at either end. The inverse is the crossing in u = ln x of the increasing
//! (2.7 + 0.7 eᵘ) u and ln(P/(1 − P)): its slope is 2.605 or more everywhere, which brackets it.
//!
//! Assumptions: fitted to trained observers before a display, with time enough; the mean over targets. An algorithm is no observer.
//! With N = n/2 of [`super::Subtense`] for the cycles that can be resolved, noise, contrast and blur are left out and P is too high.
//!
//! Sources, and how sure they are. Function and exponent: seen in two public programs (a simulation framework's image processor, and
//! a range calculator that prints 1.452 and 2.041 for P = 0.8 and 0.95); the report of the Night Vision Laboratory that they go back
//! to was not seen. Exponent 1.5: claim 2 of US patent 9 152 880 B1 (excerpt).

use crate::error::{Error, Result};
use crate::root::crossing;

/// Exponent of the target transfer probability function at x = 0, and what it grows by.
const EXPONENT: f64 = 2.7;
const GROWTH: f64 = 0.7;
/// Below the least slope of (2.7 + 0.7 eᵘ) u, which is 2.7 − 0.7 e⁻² at u = −2.
const LEAST_SLOPE: f64 = 2.6;
/// Exponent of the targeting task performance.
const TTP_EXPONENT: f64 = 1.5;

/// A law of the share of observers who are right.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Law {
    /// Target transfer probability function, of cycles over N50.
    Ttpf,
    /// Targeting task performance, of V over V50.
    Ttp,
}

impl Law {
    /// Share of observers who are right with `ratio` times what one half of them needs; no number for a ratio below 0.
    ///
    /// ```
    /// use hadar::policy::practice::observer::Law;
    /// assert_eq!(Law::Ttpf.probability(1.0), 0.5);
    /// // Twice the cycles: 2^4.1/(1 + 2^4.1).
    /// assert!((Law::Ttpf.probability(2.0) - 0.944_898_6).abs() < 1e-7);
    /// ```
    #[must_use]
    pub fn probability(self, ratio: f64) -> f64 {
        let exponent = match self {
            Self::Ttpf => GROWTH.mul_add(ratio, EXPONENT),
            Self::Ttp => TTP_EXPONENT,
        };
        1.0 / (1.0 + (-exponent * ratio.ln()).exp())
    }

    /// How many times what one half of the observers needs makes the share `probability` of them right.
    ///
    /// # Errors
    /// A probability that is not above 0 and below 1.
    ///
    /// ```
    /// use hadar::policy::practice::observer::Law;
    /// assert!((Law::Ttpf.ratio(0.95)? - 2.041).abs() < 1e-3);
    /// # Ok::<(), hadar::Error>(())
    /// ```
    pub fn ratio(self, probability: f64) -> Result<f64> {
        if !(probability > 0.0 && probability < 1.0) {
            let quantity = "probability of an observer";
            return Err(Error::out_of_range(quantity, probability, "", "above 0 and below 1"));
        }
        let log_odds = probability.ln() - (-probability).ln_1p();
        let log = match self {
            Self::Ttp => log_odds / TTP_EXPONENT,
            Self::Ttpf => {
                let far = log_odds.abs() / LEAST_SLOPE;
                crossing(-far, far, |log| Ok(GROWTH.mul_add(log.exp(), EXPONENT) * log - log_odds))?
            }
        };
        Ok(log.exp())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ratios_of_three_probabilities() {
        // As printed by another's program for 0.8 and 0.95, computed for 0.9, all to the last digit.
        for (probability, ratio) in [(0.8, 1.4521), (0.9, 1.7503), (0.95, 2.0405)] {
            let found = Law::Ttpf.ratio(probability).unwrap();
            assert!((found - ratio).abs() < 6e-5, "{probability}: {found}");
        }
        assert_eq!(Law::Ttpf.ratio(0.5).unwrap(), 1.0);
    }

    #[test]
    fn the_laws_at_whole_numbers() {
        // 2^4.1 = 17.148375, 0.5^3.05 = 1/8.282119; 4^1.5 = 8.
        let near = |found: f64, exact: f64| assert!((found / exact - 1.0).abs() < 1e-7, "{found} {exact}");
        near(Law::Ttpf.probability(2.0), 17.148_375_4 / 18.148_375_4);
        near(Law::Ttpf.probability(0.5), 1.0 / 9.282_119_4);
        near(Law::Ttp.probability(4.0), 8.0 / 9.0);
        near(Law::Ttp.ratio(8.0 / 9.0).unwrap(), 4.0);
        assert_eq!([Law::Ttpf, Law::Ttp].map(|law| law.probability(0.0)), [0.0; 2]);
        assert_eq!([Law::Ttpf, Law::Ttp].map(|law| law.probability(f64::INFINITY)), [1.0; 2]);
        assert!(Law::Ttpf.probability(-1.0).is_nan());
    }

    /// From the least number to the last one below 1: the odds come back to what their logarithm loses.
    #[test]
    fn every_probability_has_a_ratio() {
        for law in [Law::Ttpf, Law::Ttp] {
            for probability in [f64::MIN_POSITIVE, 1e-30, 1e-3, 0.5 - 1e-12, 0.5 + 1e-12, 0.999] {
                let back = law.probability(law.ratio(probability).unwrap());
                assert!((back / probability - 1.0).abs() < 1e-12, "{law:?} {probability:e}: {back:e}");
            }
            let last = law.ratio(1.0 - f64::EPSILON / 2.0).unwrap();
            assert!(last.is_finite() && last > 1.0, "{last}");
            for wrong in [0.0, 1.0, -0.1, f64::NAN] {
                assert!(law.ratio(wrong).is_err());
            }
        }
    }
}
