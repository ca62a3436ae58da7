//! The integral over a response by a finer sum than the response has values.
//!
//! A reading is the integral C = g ∫ r(ν) T_q(ν) B(ν) dν + K_q. The sum over W values, g Δν Σ_j r_j T_qj B_j, differs from it by what r does
//! between the values. A curve drawn from the prior ([`super::determined::CurvePrior`]: Matérn 5/2, length ℓ) moves there by about
//! shape × (Δν/ℓ)², far beyond the noise of good readings, and that error is common to all blackbodies.
//!
//! Each value's width is therefore cut into an odd number of parts, P, no wider than ℓ/[`PER_LENGTH`]. The prior is set up at the centres
//! of all W P parts, the sum runs over them, and value j is the part at its centre, ν_j. The posterior of the value then holds what
//! is unknown between the values. The error of the sum falls at least as P⁻². It is in no deviation: where so many parts cannot be worked
//! with, there is no answer.
//!
//! Units: cm⁻¹ for ν, Δν, ℓ. Assumption: filters are given as their means over each part.
//!
//! Source: O'Hagan, J. Stat. Plan. Inference 29, 245 (1991), doi:10.1016/0378-3758(91)90002-V (integrals of Gaussian processes).

use crate::error::{Error, Result, check};
use crate::words::significant;

/// Fewest parts over the length at which the correlation has fallen to a quarter.
pub const PER_LENGTH: f64 = 20.0;
/// Most parts of all values: the prior takes the cube of them in time.
const MOST: usize = 600;

/// The parts of evenly spaced values.
#[derive(Debug, Clone, PartialEq)]
pub struct Finer {
    parts: usize,
    centres_cm1: Vec<f64>,
}

impl Finer {
    /// For values at these wavenumbers, of curves with this correlation (cm⁻¹).
    ///
    /// # Errors
    /// Fewer than two values, a length that is not positive or takes more than about 600 parts.
    pub fn of(values_cm1: &[f64], correlation_cm1: f64) -> Result<Self> {
        check::positive("correlation of the response", correlation_cm1, "cm^-1")?;
        let step = step(values_cm1)?;
        let odd = |parts: usize| if parts.is_multiple_of(2) { parts + 1 } else { parts };
        let most = odd((MOST / values_cm1.len()).max(1));
        let wanted = (step * PER_LENGTH / correlation_cm1).ceil().max(1.0);
        if wanted > most as f64 {
            let least = significant(up_to_digits(step * PER_LENGTH / most as f64), 3);
            let values = values_cm1.len();
            let expected = format!(
                "{least} or more for {values} values {} cm^-1 apart: what a curve does between them is summed over at most {} parts, \
                 and the error of a coarser sum would be in no deviation",
                significant(step, 4),
                most * values
            );
            return Err(Error::out_of_range(
                "correlation of the response",
                correlation_cm1,
                "cm^-1",
                expected,
            ));
        }
        Self::cut(values_cm1, odd(wanted as usize))
    }

    /// Each value's width cut into an odd number of parts.
    ///
    /// # Errors
    /// Fewer than two values, an even number of parts.
    pub fn cut(values_cm1: &[f64], parts: usize) -> Result<Self> {
        let step = step(values_cm1)?;
        if parts.is_multiple_of(2) {
            let found = format!("{parts} parts of each value");
            return Err(Error::malformed(found, "give an odd number, so that one part is at the value"));
        }
        let (first, middle) = (values_cm1[0], (parts / 2) as f64);
        let at = |i: usize| first + step * ((i as f64 - middle) / parts as f64);
        Ok(Self { parts, centres_cm1: (0..values_cm1.len() * parts).map(at).collect() })
    }

    /// P.
    #[must_use]
    pub fn parts(&self) -> usize {
        self.parts
    }

    /// Centres of all parts, cm⁻¹.
    #[must_use]
    pub fn centres_cm1(&self) -> &[f64] {
        &self.centres_cm1
    }

    /// Width of a part, cm⁻¹.
    #[must_use]
    pub fn step_cm1(&self) -> f64 {
        (self.centres_cm1[self.centres_cm1.len() - 1] - self.centres_cm1[0])
            / (self.centres_cm1.len() - 1) as f64
    }

    /// Which part is at a value.
    #[must_use]
    pub fn place(&self, value: usize) -> usize {
        value * self.parts + self.parts / 2
    }

    /// Of numbers for all parts, those at the values.
    #[must_use]
    pub fn at_values(&self, of_parts: &[f64]) -> Vec<f64> {
        of_parts.iter().skip(self.parts / 2).step_by(self.parts).copied().collect()
    }

    /// Means over the parts of each value.
    #[must_use]
    pub fn means(&self, of_parts: &[f64]) -> Vec<f64> {
        of_parts.chunks(self.parts).map(|own| own.iter().sum::<f64>() / own.len() as f64).collect()
    }
}

/// The next number of three digits from here up.
fn up_to_digits(value: f64) -> f64 {
    let unit = 10_f64.powf(value.log10().floor() - 2.0);
    (value / unit).ceil() * unit
}

fn step(values_cm1: &[f64]) -> Result<f64> {
    let (Some(first), Some(last), true) = (values_cm1.first(), values_cm1.last(), values_cm1.len() > 1)
    else {
        let found = format!("{} response values", values_cm1.len());
        return Err(Error::malformed(found, "give two values or more"));
    };
    check::positive("step of the response values", (last - first) / (values_cm1.len() - 1) as f64, "cm^-1")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_at_the_middle_of_their_parts() {
        let values = [600.0, 630.0, 660.0, 690.0];
        let finer = Finer::of(&values, 100.0).unwrap();
        assert_eq!((finer.parts(), finer.centres_cm1().len()), (7, 28));
        for (found, value) in finer.at_values(finer.centres_cm1()).iter().zip(values) {
            assert!((found - value).abs() < 1e-9);
        }
        for (j, (found, value)) in finer.means(finer.centres_cm1()).iter().zip(values).enumerate() {
            assert!((found - value).abs() < 1e-9);
            assert!((finer.centres_cm1()[finer.place(j)] - value).abs() < 1e-9);
        }
        assert!((finer.step_cm1() - 30.0 / 7.0).abs() < 1e-12);
    }

    #[test]
    fn parts_are_no_more_than_can_be_worked_with() {
        let values: Vec<f64> = (0..200).map(|j| 600.0 + 4.0 * f64::from(j)).collect();
        assert_eq!(Finer::of(&values, 100.0).unwrap().parts(), 1);
        assert_eq!(Finer::of(&values, 26.7).unwrap().parts(), 3);
        // 4 cm⁻¹ × 20 / 3 parts.
        let refused = Finer::of(&values, 26.6).unwrap_err().to_string();
        assert!(
            refused.contains("26.6 cm^-1") && refused.contains("26.7 or more for 200 values"),
            "{refused}"
        );
        assert!(refused.contains("at most 600 parts"), "{refused}");
        assert!(Finer::of(&values, 1e-9).is_err() && Finer::of(&values[..2], 1e-300).is_err());
        assert_eq!(Finer::of(&values[..2], 0.266).unwrap().parts(), 301);
        assert!(Finer::cut(&values, 4).is_err() && Finer::of(&values[..1], 10.0).is_err());
        assert!(Finer::of(&values, f64::NAN).is_err());
    }
}
