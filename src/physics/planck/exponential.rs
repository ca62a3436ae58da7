//! e⁻ˣ and 1 − e⁻ˣ of x = hcν/kT without loss: x as a sum of two doubles, the exponential by reduction to
//! |r| ≤ ln2/2 and a Taylor polynomial.
//!
//! Source: exponential after Cody and Waite, 'Software Manual for the Elementary Functions' (1980).

use crate::units::{SECOND_RADIATION_CM_K, SECOND_RADIATION_REST_CM_K};

const LN2_HIGH: f64 = 6.931_471_803_691_238e-1;
const LN2_LOW: f64 = 1.908_214_929_270_587_7e-10;
/// Beyond this, e⁻ˣ is below the smallest normal number and is taken as 0.
const LARGEST_EXPONENT: f64 = 708.0;

/// A number as the sum of two doubles, the second below half an ulp of the first.
#[derive(Debug, Clone, Copy)]
pub(super) struct Double {
    pub(super) high: f64,
    pub(super) low: f64,
}

impl Double {
    /// a + b without rounding (Knuth's TwoSum).
    pub(super) fn sum(a: f64, b: f64) -> Self {
        let high = a + b;
        let part = high - a;
        Self { high, low: (a - (high - part)) + (b - part) }
    }

    /// This over a double, and this times another, to twice the digits.
    pub(super) fn over(self, divisor: f64) -> Self {
        let high = self.high / divisor;
        Self { high, low: ((-high).mul_add(divisor, self.high) + self.low) / divisor }
    }

    pub(super) fn times(self, other: Self) -> Self {
        let high = self.high * other.high;
        let rest = self.high.mul_add(other.high, -high);
        Self { high, low: self.high.mul_add(other.low, self.low.mul_add(other.high, rest)) }
    }
}

/// hc/(kT), in cm.
pub(super) fn inverse_thermal(temperature_k: f64) -> Double {
    Double { high: SECOND_RADIATION_CM_K, low: SECOND_RADIATION_REST_CM_K }.over(temperature_k)
}

/// hc/(kT) of a temperature that is the sum of two doubles.
pub(super) fn inverse_thermal_of(temperature: Double) -> Double {
    let Double { high, low } = inverse_thermal(temperature.high);
    Double { high, low: low - high * (temperature.low / temperature.high) }
}

/// e⁻ˣ and 1 − e⁻ˣ, both to full relative precision, for x = high + low ≥ 0.
#[inline(always)]
pub(super) fn exp_and_complement(high: f64, low: f64) -> (f64, f64) {
    let (scale, head) = reduced_exp(-high.min(LARGEST_EXPONENT), -low);
    let (q, p) = (scale.mul_add(head, scale), (-scale).mul_add(head, 1.0 - scale));
    (if high < LARGEST_EXPONENT { q } else { 0.0 }, p)
}

/// e^y − 1 to full relative precision for y = high + low, |y| ≤ [`LARGEST_EXPONENT`].
#[inline(always)]
pub(super) fn exp_minus_one(high: f64, low: f64) -> f64 {
    let (scale, head) = reduced_exp(high, low);
    scale.mul_add(head, scale - 1.0)
}

/// (2ᵏ, e^r − 1) with y = k ln2 + r, |r| ≤ ln2/2, for |y| ≤ [`LARGEST_EXPONENT`].
#[inline(always)]
pub(super) fn reduced_exp(y: f64, correction: f64) -> (f64, f64) {
    // Adding 1.5·2⁵² rounds to the nearest integer without a branch and leaves it in the low bits,
    // from where a shift moves it into the exponent.
    const ROUNDER: f64 = 6_755_399_441_055_744.0 + 1023.0;
    let shifted = y.mul_add(std::f64::consts::LOG2_E, ROUNDER);
    let power = shifted - ROUNDER;
    let scale = f64::from_bits(shifted.to_bits() << 52);
    let r = (-power).mul_add(LN2_LOW, (-power).mul_add(LN2_HIGH, y)) + correction;
    // e^r − 1 = r + r²(1/2! + r/3! + … + r¹¹/13!): the first neglected term is below 2⁻⁵⁵ of r.
    let mut tail: f64 = 1.0 / 6_227_020_800.0;
    for coefficient in [
        1.0 / 479_001_600.0,
        1.0 / 39_916_800.0,
        1.0 / 3_628_800.0,
        1.0 / 362_880.0,
        1.0 / 40_320.0,
        1.0 / 5_040.0,
        1.0 / 720.0,
        1.0 / 120.0,
        1.0 / 24.0,
        1.0 / 6.0,
        0.5,
    ] {
        tail = tail.mul_add(r, coefficient);
    }
    (scale, (r * r).mul_add(tail, r))
}

#[inline(always)]
pub(super) fn product(wavenumber_cm1: f64, inverse: Double) -> (f64, f64) {
    let high = wavenumber_cm1 * inverse.high;
    let low = wavenumber_cm1.mul_add(inverse.high, -high) + wavenumber_cm1 * inverse.low;
    (high, low)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_exponential_agrees_with_the_standard_library() {
        // std's exp and exp_m1 are good to 1 ulp; ours adds about as much.
        for i in 0..20_000 {
            let x = 0.000_37 * f64::from(i) * f64::from(i % 97 + 1);
            let (q, p) = exp_and_complement(x, 0.0);
            if x < 700.0 {
                assert!((q / (-x).exp() - 1.0).abs() < 5e-16, "{x}");
            }
            if x > 0.0 {
                assert!((p / -(-x).exp_m1() - 1.0).abs() < 5e-16, "{x}");
                let y = x.min(600.0);
                assert!((exp_minus_one(y, 0.0) / y.exp_m1() - 1.0).abs() < 5e-16, "{y}");
                assert!((exp_minus_one(-y, 0.0) / (-y).exp_m1() - 1.0).abs() < 5e-16, "{y}");
            }
        }
    }
}
