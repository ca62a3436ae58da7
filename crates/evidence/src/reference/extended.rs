//! Numbers of [`PRECISION`] bits with the usual operators.
//!
//! Sum, difference, product, quotient and square root are those of `astro-float-num`, rounded to nearest. The
//! exponential is e^x = 2^k Π e^{jᵢ/256^i} e^r with x = k ln2 + Σ jᵢ/256^i + r, 0 ≤ r < 2⁻³², the factors from tables and e^r by
//! Taylor's series, with 128 more bits; the logarithm is found by Halley's method on it. Constants
//! come from series: ln2 = Σ 2^{-k}/k, and π by Machin's formula. All are good to the last bits.
//!
//! Assumption: arguments of [`Extended::exp`] within ±10⁹.

mod decimal;

use astro_float_num::{BigFloat, RoundingMode, Sign};
use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};
use std::sync::LazyLock;

/// Bits of every number.
pub const PRECISION: usize = 512;
/// Bits more inside the exponential and the constants.
const GUARD: usize = 128;
const WORKING: usize = PRECISION + GUARD;
const NEAREST: RoundingMode = RoundingMode::ToEven;
/// Terms of the exponential's series: rⁿ/n! is below 2⁻⁶⁴⁰ at n = 19.
const TERMS: usize = 20;
/// Tables of the exponential: of how many bits of its argument each, and how many.
const BITS: u32 = 8;
const TABLES: u32 = 4;

/// A number of 512 bits, 154 digits.
///
/// ```
/// use hadar_evidence::reference::Extended;
/// let third = Extended::from(1.0) / Extended::from(3.0);
/// assert_eq!((third * Extended::from(3.0) - Extended::from(1.0)).to_f64().abs() < 1e-150, true);
/// ```
#[derive(Debug, Clone)]
pub struct Extended(BigFloat);

/// ln2 and π to [`WORKING`] bits, and 1/n! for the exponential.
struct Constants {
    ln2: BigFloat,
    pi: BigFloat,
    inverse_factorials: Vec<BigFloat>,
    /// e^{j/256^i} for j below 256, one table for every i from 1 on.
    exponentials: Vec<Vec<BigFloat>>,
}

static CONSTANTS: LazyLock<Constants> = LazyLock::new(|| {
    let one = working(1.0);
    let mut inverse_factorials = vec![one.clone()];
    for n in 1..TERMS {
        let next = inverse_factorials[n - 1].div(&working(n as f64), WORKING, NEAREST);
        inverse_factorials.push(next);
    }
    let mut ln2 = working(0.0);
    let mut power = one;
    for k in 1..=WORKING {
        power = power.div(&working(2.0), WORKING, NEAREST);
        ln2 = ln2.add(&power.div(&working(k as f64), WORKING, NEAREST), WORKING, NEAREST);
    }
    let machin = arctangent_of_inverse(5.0).mul(&working(16.0), WORKING, NEAREST).sub(
        &arctangent_of_inverse(239.0).mul(&working(4.0), WORKING, NEAREST),
        WORKING,
        NEAREST,
    );
    let exponentials = (1..=TABLES).map(|table| {
        let step = working(0.5f64.powi((BITS * table) as i32));
        let mut first = working(0.0);
        for n in (1..=WORKING).rev() {
            // Horner: 1 + s/1 (1 + s/2 (1 + s/3 …)).
            let inner = first.add(&working(1.0), WORKING, NEAREST).mul(&step, WORKING, NEAREST);
            first = inner.div(&working(n as f64), WORKING, NEAREST);
        }
        let first = first.add(&working(1.0), WORKING, NEAREST);
        let mut powers = vec![working(1.0)];
        while powers.len() < 1 << BITS {
            powers.push(powers[powers.len() - 1].mul(&first, WORKING, NEAREST));
        }
        powers
    });
    let exponentials = exponentials.collect();
    Constants { ln2, pi: machin, inverse_factorials, exponentials }
});

fn working(value: f64) -> BigFloat {
    BigFloat::from_f64(value, WORKING)
}

/// arctan(1/n) = Σ (−1)^k/((2k + 1) n^{2k + 1}).
fn arctangent_of_inverse(n: f64) -> BigFloat {
    let mut power = working(1.0).div(&working(n), WORKING, NEAREST);
    let mut sum = working(0.0);
    for k in 0..WORKING {
        let term = power.div(&working((2 * k + 1) as f64), WORKING, NEAREST);
        let sign = if k % 2 == 0 { term } else { term.neg() };
        sum = sum.add(&sign, WORKING, NEAREST);
        power = power.div(&working(n * n), WORKING, NEAREST);
    }
    sum
}

/// The double nearest to a number: ties to even, subnormal where it must be, ±∞ beyond the largest.
fn nearest_double(value: &BigFloat) -> f64 {
    let Some((words, _, sign, exponent, _)) = value.as_raw_parts() else {
        return if value.is_inf_pos() {
            f64::INFINITY
        } else if value.is_inf_neg() {
            f64::NEG_INFINITY
        } else {
            f64::NAN
        };
    };
    if value.is_zero() {
        return 0.0;
    }
    let sign = if sign == Sign::Neg { -1.0 } else { 1.0 };
    // value = 0.m · 2^exponent, the highest bit of m set. The 64 highest bits, and whether there is more.
    let mut rest = words.iter().rev();
    let (mut high, mut filled) = (0_u128, 0);
    while filled < 64 {
        let word = rest.next().copied().unwrap_or(0);
        high = (high << (8 * size_of_val(&word))) | u128::from(word);
        filled += 8 * size_of_val(&word);
    }
    let more = rest.any(|&word| word != 0);
    // Bits that the double has room for: 53, fewer where it is subnormal.
    let room = (exponent + 1074).min(53);
    if exponent > 1024 {
        return sign * f64::INFINITY;
    }
    if room < 0 {
        return sign * 0.0;
    }
    let cut = 64 - room;
    let kept = high.checked_shr(cut as u32).unwrap_or(0);
    let lost = high - (kept << cut);
    let half = 1_u128 << (cut - 1);
    let up = lost > half || (lost == half && (more || kept % 2 == 1));
    let whole = (kept as u64) + u64::from(up);
    // whole · 2^(exponent − room): a carry past the highest bit moves into the exponent by itself.
    let above = if room < 53 { 0 } else { (exponent + 1021) as u64 };
    sign * f64::from_bits((above << 52) + whole)
}

impl Extended {
    /// 0.
    #[must_use]
    pub fn zero() -> Self {
        Self::from(0.0)
    }

    /// 1.
    #[must_use]
    pub fn one() -> Self {
        Self::from(1.0)
    }

    /// π.
    #[must_use]
    pub fn pi() -> Self {
        Self(CONSTANTS.pi.clone()).rounded()
    }

    /// A number written with any count of digits, such as `1.25e-7`; not a number where it is none.
    #[must_use]
    pub fn parse(text: &str) -> Self {
        let (digits, exponent) = text.split_once(['e', 'E']).unwrap_or((text, "0"));
        let (negative, digits) = digits.strip_prefix('-').map_or((false, digits), |rest| (true, rest));
        let (whole, fraction) = digits.split_once('.').unwrap_or((digits, ""));
        let Ok(exponent) = exponent.parse::<i32>() else { return Self::from(f64::NAN) };
        let ten = Self::from(10.0);
        let mut value = Self::zero();
        for digit in whole.chars().chain(fraction.chars()) {
            let Some(digit) = digit.to_digit(10) else { return Self::from(f64::NAN) };
            value = &value * &ten + Self::from(f64::from(digit));
        }
        let power = exponent - fraction.len() as i32;
        let scale = (0..power.unsigned_abs()).fold(Self::one(), |scale, _| scale * &ten);
        let value = if power < 0 { value / scale } else { value * scale };
        if negative { -value } else { value }
    }

    /// The nearest double, rounded correctly also where it is subnormal; ±∞ where it is beyond the largest.
    #[must_use]
    pub fn to_f64(&self) -> f64 {
        nearest_double(&self.0)
    }

    /// Whether it is 0.
    #[must_use]
    pub fn is_zero(&self) -> bool {
        self.0.is_zero()
    }

    /// Whether it is above 0.
    #[must_use]
    pub fn is_positive(&self) -> bool {
        !self.0.is_zero() && !self.0.is_nan() && self.0.is_positive()
    }

    /// Whether it is a number and neither infinite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        !self.0.is_nan() && !self.0.is_inf()
    }

    /// Magnitude.
    #[must_use]
    pub fn abs(&self) -> Self {
        Self(self.0.abs())
    }

    /// Square.
    #[must_use]
    pub fn square(&self) -> Self {
        self * self
    }

    /// Square root; not a number below 0.
    #[must_use]
    pub fn sqrt(&self) -> Self {
        Self(self.0.sqrt(PRECISION, NEAREST))
    }

    /// This times 2^power.
    #[must_use]
    pub fn times_power_of_two(&self, power: i32) -> Self {
        let mut scaled = self.0.clone();
        if let Some(exponent) = scaled.exponent().filter(|_| !scaled.is_zero()) {
            scaled.set_exponent(exponent + power);
        }
        Self(scaled)
    }

    /// e to the power of this.
    #[must_use]
    pub fn exp(&self) -> Self {
        if self.0.is_zero() {
            return Self::one();
        }
        let constants = &*CONSTANTS;
        let power = (self.to_f64() * std::f64::consts::LOG2_E).floor();
        let whole = constants.ln2.mul(&working(power), WORKING, NEAREST);
        let rest = self.0.sub(&whole, WORKING, NEAREST);
        let scale = f64::from(BITS * TABLES).exp2();
        // At a whole multiple of ln2 the rest may be rounding below 0.
        let digits = (nearest_double(&rest) * scale).floor().clamp(0.0, scale - 1.0);
        let rest = rest.sub(&working(digits / scale), WORKING, NEAREST);
        let mut value = working(0.0);
        for coefficient in constants.inverse_factorials.iter().rev() {
            value = value.mul(&rest, WORKING, NEAREST).add(coefficient, WORKING, NEAREST);
        }
        for (table, powers) in (1..).zip(&constants.exponentials) {
            let digit = (digits as usize >> (BITS * (TABLES - table))) % (1 << BITS);
            value = value.mul(&powers[digit], WORKING, NEAREST);
        }
        Self(value).times_power_of_two(power as i32).rounded()
    }

    /// Natural logarithm; not a number at 0 and below.
    #[must_use]
    pub fn ln(&self) -> Self {
        if !self.is_positive() {
            return Self::from(f64::NAN);
        }
        let power = self.0.exponent().unwrap_or(0);
        let fraction = self.times_power_of_two(-power);
        // y ← y + 2(x − e^y)/(x + e^y): three times as many digits every time.
        let mut y = Self::from(fraction.to_f64().ln());
        for _ in 0..4 {
            let at = y.exp();
            let change = (&fraction - &at) / (&fraction + &at);
            y = y + change.times_power_of_two(1);
        }
        y + Self(CONSTANTS.ln2.clone()) * Self::from(f64::from(power))
    }

    /// ln(1 + this), also of what is far below the last bit of 1.
    #[must_use]
    pub fn ln_1p(&self) -> Self {
        if self.abs() > Self::from(1e-20) {
            return (Self::one() + self).ln();
        }
        // Σ (−1)ⁿ⁺¹ yⁿ/n: the ninth term is below 10⁻¹⁶⁰ of the first.
        (1..9).rev().fold(Self::zero(), |sum, n| {
            let n = f64::from(n);
            let inverse = Self::one() / Self::from(n);
            (if n % 2.0 == 0.0 { -inverse } else { inverse } + sum) * self
        })
    }

    /// The larger of two.
    #[must_use]
    pub fn max(self, other: Self) -> Self {
        if self < other { other } else { self }
    }

    /// |this/exact − 1| as a double: 0 where both are equal, ∞ where only `exact` is 0.
    #[must_use]
    pub fn relative_error_to(&self, exact: &Self) -> f64 {
        let difference = (self - exact).abs();
        if difference.is_zero() {
            return 0.0;
        }
        if exact.is_zero() { f64::INFINITY } else { (difference / exact.abs()).to_f64() }
    }

    fn rounded(self) -> Self {
        let mut value = self.0;
        // A precision that is possible never fails.
        let _ = value.set_precision(PRECISION, NEAREST);
        Self(value)
    }
}

impl From<f64> for Extended {
    /// All bits of the double.
    fn from(value: f64) -> Self {
        if value.is_subnormal() {
            // These come out at half their value.
            let scaled = Self(BigFloat::from_f64(value * 1024.0_f64.powi(6), PRECISION));
            return scaled.times_power_of_two(-60);
        }
        Self(BigFloat::from_f64(value, PRECISION))
    }
}

impl std::iter::Sum for Extended {
    fn sum<I: Iterator<Item = Self>>(terms: I) -> Self {
        terms.fold(Self::zero(), |sum, term| sum + term)
    }
}

impl PartialEq for Extended {
    fn eq(&self, other: &Self) -> bool {
        self.partial_cmp(other) == Some(Ordering::Equal)
    }
}

impl PartialOrd for Extended {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        self.0.cmp(&other.0).map(|order| order.cmp(&0))
    }
}

impl Neg for Extended {
    type Output = Self;
    fn neg(self) -> Self {
        Self(self.0.neg())
    }
}

impl Neg for &Extended {
    type Output = Extended;
    fn neg(self) -> Extended {
        Extended(self.0.clone().neg())
    }
}

macro_rules! operator {
    ($trait:ident, $method:ident) => {
        impl $trait<&Extended> for &Extended {
            type Output = Extended;
            fn $method(self, other: &Extended) -> Extended {
                Extended(self.0.$method(&other.0, PRECISION, NEAREST))
            }
        }
        impl $trait<Extended> for Extended {
            type Output = Extended;
            fn $method(self, other: Extended) -> Extended {
                (&self).$method(&other)
            }
        }
        impl $trait<&Extended> for Extended {
            type Output = Extended;
            fn $method(self, other: &Extended) -> Extended {
                (&self).$method(other)
            }
        }
        impl $trait<Extended> for &Extended {
            type Output = Extended;
            fn $method(self, other: Extended) -> Extended {
                self.$method(&other)
            }
        }
    };
}

operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);
operator!(Div, div);

#[cfg(test)]
mod tests {
    use super::*;
    use astro_float_num::Consts;

    fn close(found: &Extended, exact: &Extended, digits: i32) {
        let error = found.relative_error_to(exact);
        assert!(error <= 10f64.powi(-digits), "{error:e}");
    }

    #[test]
    fn doubles_come_and_go_unchanged() {
        for value in [
            0.0,
            1.0,
            -0.1,
            f64::MAX,
            f64::MIN_POSITIVE,
            5e-324,
            -1.5e-310,
            0.999_999_999_999_999_9,
            f64::from_bits((1 << 52) - 1),
        ] {
            assert_eq!(Extended::from(value).to_f64(), value);
        }
        assert_eq!(Extended::from(f64::INFINITY).to_f64(), f64::INFINITY);
        assert!(Extended::from(f64::NAN).to_f64().is_nan());
    }

    /// Products of two doubles in 106 bits against the same product in double precision, which IEEE 754 rounds
    /// correctly, through all of the subnormal range and past both ends.
    #[test]
    fn rounding_to_doubles_is_that_of_the_processor() {
        let mut a = 0.123_456_789_012_345_67_f64;
        for i in 0..20_000 {
            a = (a * 997.123_456_789).fract();
            let b = f64::from_bits(((i * 7919) % 2046 + 1) << 52) * (1.0 + (a * 31.7).fract());
            let scale = if i % 2 == 0 { a } else { a * 1e-300 };
            let product = Extended::from(scale) * Extended::from(b);
            assert_eq!(product.to_f64().to_bits(), (scale * b).to_bits(), "{scale:e} {b:e}");
        }
        let tiny = Extended::from(5e-324);
        assert_eq!((&tiny / Extended::from(2.0)).to_f64(), 0.0);
        assert_eq!((&tiny * Extended::from(1.5)).to_f64(), 1e-323);
        assert_eq!((&tiny * Extended::from(0.500_001)).to_f64(), 5e-324);
        assert_eq!((Extended::from(f64::MAX) * Extended::from(1.000_000_1)).to_f64(), f64::INFINITY);
        assert_eq!((&tiny * &tiny).to_f64(), 0.0);
    }

    /// Against the exponential and logarithm of the library that the numbers come from: another algorithm.
    #[test]
    fn exponential_and_logarithm_agree_with_another_algorithm() {
        let mut constants = Consts::new().unwrap();
        for x in [1e-300, -1e-20, 0.1, 0.346, -0.35, 1.0, -3.7, 20.0, 143_877.687_750_393_38, -1e6] {
            let x = Extended::from(x) / Extended::from(3.0) * Extended::from(3.0);
            close(&x.exp(), &Extended(x.0.exp(PRECISION, NEAREST, &mut constants)), 150);
            let back = (x.exp().ln() - &x).abs().to_f64();
            assert!(back <= 1e-150 * (1.0 + x.to_f64().abs()), "{back:e}");
        }
        for x in [1e-300, 0.1, 0.999, 1.001, 2.0, 7e200] {
            let x = Extended::from(x);
            close(&x.ln(), &Extended(x.0.ln(PRECISION, NEAREST, &mut constants)), 150);
        }
        for y in [1e-5, -1e-19, 3e-21] {
            // What ln(1 + y) loses is what 1 + y has lost of y.
            let y = Extended::from(y);
            close(&y.ln_1p(), &(Extended::one() + &y).ln(), 130);
        }
        assert_eq!(Extended::from(1e-300).ln_1p().to_f64(), 1e-300);
        assert_eq!(Extended::zero().exp(), Extended::one());
        assert!(Extended::from(-1.0).ln().to_f64().is_nan());
    }

    /// mpmath 1.3 at 60 digits: e, π, ln 2 and e^(1/3).
    #[test]
    fn named_constants() {
        let third = Extended::one() / Extended::from(3.0);
        for (found, exact) in [
            (Extended::one().exp(), "2.71828182845904523536028747135266249775724709369995957496697"),
            (Extended::pi(), "3.14159265358979323846264338327950288419716939937510582097494"),
            (Extended::from(2.0).ln(), "0.693147180559945309417232121458176568075500134360255254120680"),
            (third.exp(), "1.39561242508608952862812531960258683759790651519940698261752"),
        ] {
            close(&found, &Extended::parse(exact), 58);
        }
    }

    #[test]
    fn digits_are_read_as_written() {
        assert_eq!(Extended::parse("-1.25e3").to_f64(), -1250.0);
        assert_eq!(Extended::parse("5e-324").to_f64(), 5e-324);
        assert_eq!(Extended::parse("0.1").to_f64(), 0.1);
        assert!(Extended::parse("one").to_f64().is_nan());
    }
}
