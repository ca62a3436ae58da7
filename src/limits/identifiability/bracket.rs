//! Rigorous bounds on the error of telling two known states apart.
//!
//! Two equally likely product laws p and q over the counts of W bands. The best test errs with
//! probability ε = ½Σ min(p, q). With C(s) = −ln Σ p^{1−s}q^s (sums over bands; `tilted`):
//!
//! * above: min(p, q) ≤ p^{1−s}q^s, so ε ≤ ½e^{−C(s)} for any s in [0, 1]; s = ½ is Bhattacharyya's
//!   ρ = e^{−C(½)}, the best s* Chernoff's;
//! * below: ½(1 − √(1−ρ²)) ≤ ε (Kailath), whose exponent is twice too large when ε is small;
//! * below, with the right exponent: let Q_s be the tilted law p^{1−s}q^s e^{C} and Λ = ln(q/p), of mean μ′
//!   and variance μ″ under Q_s. Then p = Q_s e^{−C−sΛ} and q = Q_s e^{−C+(1−s)Λ}, and Chebyshev leaves at
//!   least 1 − 1/k² of Q_s within |Λ − μ′| ≤ k√μ″. For any s and any k > 1 this gives the bound below. At
//!   s* μ′ = 0, and with h = max(s, 1−s)√μ″ the bound is largest where k³ − k = 2/h. It is the argument of
//!   Shannon, Gallager and Berlekamp (their theorem 5) with k free instead of √2.
//!
//! ε ≥ ½(1 − 1/k²) exp(−C − max[s(μ′ + k√μ″), (1−s)(k√μ″ − μ′)])
//!
//! [`detection::error_bracket`] is the same Bhattacharyya bracket as a function of a distance: for Poisson
//! C(½) = ½Σ(√N − √N′)² = d²/2 exactly, d the distance of [`super::nearest`] at that state; for the
//! other laws d = √(2C(½)) defines what it is asked for here.
//!
//! Rigorous up to rounding, relative 1e-15·(10 + C)(1 + a), a the largest occupancy per mode of bunched
//! light. States are known: nothing is fitted, so these are bounds for the nearest states, not of a
//! likelihood-ratio test of best fits.
//!
//! Sources: Chernoff, Ann. Math. Stat. 23, 493 (1952), doi:10.1214/aoms/1177729330; Kailath, IEEE Trans.
//! Commun. 15, 52 (1967), doi:10.1109/TCOM.1967.1089532; Shannon, Gallager, Berlekamp, Inf. Control 10, 65
//! (1967).

pub(super) mod tilted;

use self::tilted::{Moments, Tilted};
use super::detection;
use crate::error::{Error, Result};
use crate::root::crossing_by_newton;
use crate::statistics::Statistics;
use crate::sum::Compensated;
use std::f64::consts::LN_2;

/// Bounds on the error of the best test between two known, equally likely states.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct KnownStatesBracket {
    /// −ln ρ of the Bhattacharyya coefficient ρ.
    pub bhattacharyya: f64,
    /// Chernoff information C(s*), the largest value of C(s).
    pub chernoff: f64,
    /// Where C is largest, in [0, 1].
    pub chernoff_s: f64,
    /// No test errs less often.
    pub lower: f64,
    /// The likelihood-ratio test errs no more often.
    pub upper: f64,
    /// Natural logarithms of the two, where they would underflow.
    pub ln_lower: f64,
    /// Natural logarithm of the upper bound, where that would underflow.
    pub ln_upper: f64,
}

/// Two known states: the laws of their counts, band by band.
///
/// ```
/// use hadar::identifiability::bracket::KnownStates;
/// use hadar::statistics::Statistics;
/// let states = KnownStates::new(&[100.0, 50.0], &[144.0, 50.0], &Statistics::Poisson)?;
/// let bracket = states.bracket();
/// assert!((bracket.bhattacharyya - 2.0).abs() < 1e-14);
/// assert!(bracket.lower < bracket.upper && bracket.upper < 0.5 * (-2.0_f64).exp());
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct KnownStates {
    bands: Vec<Tilted>,
}

impl KnownStates {
    /// States with mean counts `means` and `others` in the bands.
    ///
    /// # Errors
    /// Lengths that differ, a mean that is negative or not finite, a Gaussian law without variance.
    pub fn new(means: &[f64], others: &[f64], statistics: &Statistics) -> Result<Self> {
        if means.len() != others.len() {
            return Err(Error::Length {
                what: "bands of the other state".into(),
                found: others.len(),
                expected: means.len(),
            });
        }
        statistics.check_bands(means.len())?;
        let bands = means
            .iter()
            .zip(others)
            .enumerate()
            .map(|(band, (&mean, &other))| Tilted::new(statistics, band, mean, other))
            .collect::<Result<_>>()?;
        Ok(Self { bands })
    }

    /// C(s) = −ln Σ p^{1−s}q^s for s in [0, 1]; ½e^{−C(s)} bounds the error from above.
    #[must_use]
    pub fn exponent(&self, s: f64) -> f64 {
        self.at(s.clamp(0.0, 1.0)).exponent
    }

    /// The bands between the two states.
    pub(super) fn bands(&self) -> &[Tilted] {
        &self.bands
    }

    /// C, μ′ and μ″ of all bands.
    pub(super) fn at(&self, s: f64) -> Moments {
        crate::stop::check();
        let [exponent, slope, variance] = self.summed(|band| {
            let Moments { exponent, slope, variance } = band.at(s);
            [exponent, slope, variance]
        });
        Moments { exponent, slope, variance }
    }

    /// C, μ′ and μ″ at s = ½, and L = Σ E|X|³/(Σ E X²)^{3/2} of the events X whose Poisson sum ln(q/p) is there.
    pub(super) fn halfway(&self) -> (Moments, f64) {
        let [exponent, slope, variance, third] = self.summed(|band| {
            let Moments { exponent, slope, variance } = band.at(0.5);
            [exponent, slope, variance, variance * band.graininess(0.5)]
        });
        (Moments { exponent, slope, variance }, third / (variance * variance.sqrt()))
    }

    fn summed<const N: usize>(&self, of: impl Fn(&Tilted) -> [f64; N]) -> [f64; N] {
        let mut sums = [Compensated::default(); N];
        for band in &self.bands {
            sums.iter_mut().zip(of(band)).for_each(|(sum, term)| sum.add(term));
        }
        sums.map(Compensated::value)
    }

    /// All bounds on the error of the best test.
    #[must_use]
    pub fn bracket(&self) -> KnownStatesBracket {
        let half = self.at(0.5);
        let (mut chernoff_s, mut best) = (0.5, half);
        let s = self.steepest();
        let found = self.at(s);
        if found.exponent > half.exponent {
            (chernoff_s, best) = (s, found);
        }
        let kailath = detection::error_bracket((2.0 * half.exponent).sqrt()).lower.ln();
        let ln_upper = -LN_2 - best.exponent;
        // Two bounds that meet may cross by rounding.
        let ln_lower = kailath.max(ln_lower_bound(chernoff_s, best)).min(ln_upper);
        KnownStatesBracket {
            bhattacharyya: half.exponent,
            chernoff: best.exponent,
            chernoff_s,
            lower: ln_lower.exp(),
            upper: ln_upper.exp(),
            ln_lower,
            ln_upper,
        }
    }

    /// Where μ′ crosses zero; μ is convex.
    fn steepest(&self) -> f64 {
        if self.at(0.0).slope >= 0.0 {
            return 0.0;
        }
        if self.at(1.0).slope <= 0.0 {
            return 1.0;
        }
        // Any s gives a valid bound; ½ is a good one.
        crossing_by_newton(0.0, 1.0, 0.5, |s| {
            let Moments { slope, variance, .. } = self.at(s);
            [slope, variance]
        })
    }
}

/// Logarithm of the lower bound with the right exponent.
fn ln_lower_bound(s: f64, at: Moments) -> f64 {
    let spread = at.variance.sqrt();
    let h = s.max(1.0 - s) * spread;
    if h == 0.0 {
        return -LN_2 - at.exponent - (s * at.slope).max(-(1.0 - s) * at.slope);
    }
    // From above Newton's method descends to the root of k³ − k − 2/h without passing it.
    let mut k = 1.0 + (2.0 / h).cbrt();
    for _ in 0..50 {
        let next = k - (k * k * k - k - 2.0 / h) / (3.0 * k * k - 1.0);
        if next.is_nan() || next >= k {
            break;
        }
        k = next;
    }
    let reach = k * spread;
    let loss = (s * (at.slope + reach)).max((1.0 - s) * (reach - at.slope));
    (-1.0 / (k * k)).ln_1p() - LN_2 - at.exponent - loss
}

#[cfg(test)]
mod tests;
