//! Tails and quantiles of the normal, χ² and Student distributions, for every `f64`.
//!
//! `statrs` panics at the closed ends of a domain (χ² = 0, an infinite argument), at NaN, and does not return for some arguments
//! that have lost their digits. Here each end has its limit and NaN gives NaN; within the domain the values are those of `statrs`.
//! `clippy.toml` forbids the originals everywhere else.
//!
//! Symbols: ν degrees of freedom, Q(a, x) the regularized upper incomplete gamma function.
//!
//! Sources: Wilson and Hilferty, Proc. Natl. Acad. Sci. 17, 684 (1931), doi:10.1073/pnas.17.12.684; Cornish and Fisher, Rev. Int. Stat.
//! Inst. 5, 307 (1938), doi:10.2307/1400905.
#![allow(clippy::disallowed_methods, reason = "the one place that holds their arguments to the domain")]

use crate::error::{Error, Result, check};
use statrs::distribution::{ChiSquared, ContinuousCDF};
use statrs::function::{beta, erf, gamma};
use std::f64::consts::SQRT_2;

/// More degrees of freedom than this have a χ² that is normal in its cube root to seven digits.
const MANY: f64 = 1e5;
/// More degrees of freedom than this have a Student's t of which three corrections to the normal one leave no error.
const NEARLY_NORMAL: f64 = 1e4;
/// Below this x in P(a, x) = xᵃ/Γ(a + 1) no digit is lost by leaving e⁻ˣ out.
const SMALL: f64 = 1e-200;
/// Above this t²/ν no digit is lost by leaving 1 beside it out.
const FAR: f64 = 1e20;

/// Inverse of the complementary error function; ∞ up to 0 and −∞ from 2 on.
#[must_use]
pub fn erfc_inv(x: f64) -> f64 {
    if x.is_nan() { x } else { erf::erfc_inv(x) }
}

/// Probability of a larger χ² with ν degrees of freedom, Q(ν/2, χ²/2): 1 up to χ² = 0, 0 at ∞, NaN unless ν is above 0 and finite.
#[must_use]
pub fn chi_square_survival(chi_square: f64, freedom: f64) -> f64 {
    if chi_square.is_nan() || !(freedom > 0.0 && freedom.is_finite()) {
        return f64::NAN;
    }
    let (a, x) = (0.5 * freedom, 0.5 * chi_square);
    if x <= 0.0 {
        1.0
    } else if x.is_infinite() || a == 0.0 {
        0.0
    } else if freedom > MANY {
        let variance = 2.0 / (9.0 * freedom);
        let z = ((chi_square / freedom).cbrt() - (1.0 - variance)) / variance.sqrt();
        0.5 * libm::erfc(z / SQRT_2)
    } else {
        gamma::checked_gamma_ur(a, x).map_or(f64::NAN, |found| found.clamp(0.0, 1.0))
    }
}

/// Quantile of χ²/ν, ν the degrees of freedom: 0 at the probability 0, ∞ at 1.
///
/// # Errors
/// Degrees of freedom that are not above 0 and finite; a probability outside [0, 1].
pub fn chi_square_quantile(probability: f64, freedom: f64) -> Result<f64> {
    check::unit_interval("probability", probability)?;
    check_freedom(freedom)?;
    if probability == 0.0 || probability == 1.0 {
        return Ok(if probability == 0.0 { 0.0 } else { f64::INFINITY });
    }
    if freedom > MANY {
        let z = erfc_inv(2.0 * (1.0 - probability)) * SQRT_2;
        let variance = 2.0 / (9.0 * freedom);
        return Ok((1.0 - variance + z * variance.sqrt()).powi(3).max(0.0));
    }
    // P(a, x) is xᵃ/Γ(a + 1) where x is small: halves of it, of which the search would take one after the other, have no digits.
    let a = 0.5 * freedom;
    let least = ((probability.ln() + gamma::ln_gamma(a + 1.0)) / a).exp();
    if least < SMALL {
        return Ok(2.0 * least / freedom);
    }
    let law = ChiSquared::new(freedom).map_err(|_| no_freedom(freedom))?;
    Ok(law.inverse_cdf(probability) / freedom)
}

/// Quantile of Student's t with ν degrees of freedom: −∞ at the probability 0, ∞ at 1; normal at ν = ∞.
///
/// # Errors
/// Degrees of freedom below 1; a probability outside [0, 1].
pub fn student_quantile(probability: f64, freedom: f64) -> Result<f64> {
    check::unit_interval("probability", probability)?;
    if freedom.is_nan() || freedom < 1.0 {
        return Err(no_freedom(freedom));
    }
    let tail = probability.min(1.0 - probability);
    let t = if tail == 0.0 {
        f64::INFINITY
    } else if freedom > NEARLY_NORMAL {
        // Cornish and Fisher.
        let z = SQRT_2 * erfc_inv(2.0 * tail);
        let s = z * z;
        let terms = [(s + 1.0) / 4.0, ((5.0 * s + 16.0) * s + 3.0) / 96.0];
        let third = (((3.0 * s + 19.0) * s + 17.0) * s - 15.0) / 384.0;
        z * (1.0 + (terms[0] + (terms[1] + third / freedom) / freedom) / freedom)
    } else {
        // The bits of positive numbers are in their order: 63 halvings leave the two neighbours of the crossing.
        let (mut low, mut high) = (0, f64::INFINITY.to_bits());
        while high - low > 1 {
            let middle = low + (high - low) / 2;
            *(if student_tail(f64::from_bits(middle), freedom) > tail { &mut low } else { &mut high }) =
                middle;
        }
        f64::from_bits(high)
    };
    Ok(if probability < 0.5 { -t } else { t })
}

/// Probability of a larger t than this one, which is positive.
fn student_tail(t: f64, freedom: f64) -> f64 {
    let (a, square) = (0.5 * freedom, (t / freedom) * t);
    let share = |a: f64, b: f64, x: f64| beta::checked_beta_reg(a, b, x).unwrap_or(f64::NAN);
    if t < 1.0 {
        // `statrs` takes an x that is nearly 1 for 1.
        0.5 - 0.5 * share(0.5, a, square / (1.0 + square))
    } else if square < FAR {
        0.5 * share(a, 0.5, 1.0 / (1.0 + square))
    } else {
        // Iₓ(a, ½) is xᵃ/(a B(a, ½)) where x = ν/t² is small, and may be no number where that is one.
        let logarithm = gamma::ln_gamma(a + 0.5) - gamma::ln_gamma(a + 1.0) - gamma::ln_gamma(0.5);
        0.5 * (a * (freedom.ln() - 2.0 * t.ln()) + logarithm).exp()
    }
}

fn check_freedom(freedom: f64) -> Result<()> {
    if freedom > 0.0 && freedom.is_finite() { Ok(()) } else { Err(no_freedom(freedom)) }
}

fn no_freedom(freedom: f64) -> Error {
    Error::out_of_range("degrees of freedom", freedom, "", "above 0: more estimates")
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use statrs::distribution::StudentsT;

    /// Any bits at all: NaN, infinities and subnormal numbers among them.
    fn bits() -> impl Strategy<Value = f64> {
        prop_oneof![
            any::<u64>().prop_map(f64::from_bits),
            -2.0..2.0,
            0.0..1e6,
            Just(0.0),
            Just(1.0),
            Just(2.0)
        ]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(4096))]

        #[test]
        fn every_number_has_a_value(x in bits(), freedom in bits()) {
            prop_assert_eq!(erfc_inv(x).is_nan(), x.is_nan());
            let usable = freedom > 0.0 && freedom.is_finite();
            let survival = chi_square_survival(x, freedom);
            prop_assert_eq!(survival.is_nan(), x.is_nan() || !usable);
            prop_assert!(survival.is_nan() || (0.0..=1.0).contains(&survival), "{}", survival);
            let probability = (0.0..=1.0).contains(&x);
            let quantile = chi_square_quantile(x, freedom).ok();
            prop_assert_eq!(quantile.is_some_and(|quantile| quantile >= 0.0), probability && usable);
            prop_assert_eq!(quantile.is_some(), probability && usable);
            let student = student_quantile(x, freedom).ok().map(|t| if x < 0.5 { -t } else { t });
            prop_assert_eq!(student.is_some_and(|t| t >= 0.0), probability && freedom >= 1.0);
            prop_assert_eq!(student.is_some(), probability && freedom >= 1.0);
        }

        #[test]
        fn within_the_domain_the_values_are_those_of_statrs(share in 1e-6..1.0 - 1e-6, freedom in 1.0..1e4, x in 1e-3..2e4) {
            let near = |found: f64, exact: f64, share: f64| (found - exact).abs() <= share * exact.abs() + 1e-12;
            prop_assert_eq!(erfc_inv(2.0 * share), erf::erfc_inv(2.0 * share));
            prop_assert_eq!(chi_square_survival(x, freedom), gamma::gamma_ur(0.5 * freedom, 0.5 * x));
            let law = ChiSquared::new(freedom).unwrap();
            prop_assert_eq!(chi_square_quantile(share, freedom).unwrap() * freedom, law.inverse_cdf(share) / freedom * freedom);
            let law = StudentsT::new(0.0, 1.0, freedom).unwrap();
            // Nearer to the middle its probabilities are those of the middle.
            let found = law.cdf(student_quantile(share, freedom).unwrap());
            prop_assert!(near(found, share, 1e-9) || (share - 0.5).abs() < 0.05, "{} {}", found, share);
        }
    }

    /// The quantile of a tail is where the tail is, also far outside.
    #[test]
    fn tails_and_quantiles_are_inverse_to_the_last_probability() {
        for exponent in [-300, -100, -30, -12, -6, -3] {
            let tail = 10f64.powi(exponent);
            for freedom in [1.0, 2.0, 7.5, 100.0, 9e3, 1.1e4, 1e9] {
                let t = student_quantile(tail, freedom).unwrap();
                let found = student_tail(-t, freedom.min(1e4));
                assert!(
                    (found / tail - 1.0).abs() < 1e-9 || freedom > NEARLY_NORMAL,
                    "{tail} {freedom} {found}"
                );
                assert!(student_quantile(1.0, freedom).unwrap() == f64::INFINITY);
            }
            // Two degrees of freedom have Q = exp(-χ²/2).
            assert!((chi_square_survival(-2.0 * tail.ln(), 2.0) / tail - 1.0).abs() < 1e-11, "{tail}");
        }
        for freedom in [0.001, 1e-300, 5e-324, 1.0, 2e5, 1e300] {
            assert_eq!(chi_square_survival(0.0, freedom), 1.0);
            assert_eq!(chi_square_survival(f64::INFINITY, freedom), 0.0);
            assert_eq!(chi_square_quantile(0.0, freedom).unwrap(), 0.0);
            assert_eq!(chi_square_quantile(1.0, freedom).unwrap(), f64::INFINITY);
            assert!(chi_square_quantile(1e-10, freedom).unwrap() <= 1.0);
        }
    }

    /// Where a formula takes over from another, nothing leaps.
    #[test]
    fn formulas_agree_where_they_meet() {
        for share in [1e-9, 1e-3, 0.3, 0.5, 0.9, 0.999_999] {
            let [below, above] =
                [1.0 - 1e-9, 1.0 + 1e-9].map(|by| student_quantile(share, NEARLY_NORMAL * by).unwrap());
            assert!((below - above).abs() <= 1e-10 * above.abs() + 1e-12, "{share}: {below} {above}");
            let chi = MANY * chi_square_quantile(share, MANY).unwrap();
            let [below, above] = [1.0 - 1e-9, 1.0 + 1e-9].map(|by| chi_square_survival(chi, MANY * by));
            assert!((below - above).abs() < 2e-4 * above, "{share}: {below} {above}");
        }
    }
}
