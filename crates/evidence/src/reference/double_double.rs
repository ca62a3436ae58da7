//! Numbers of two doubles, some 31 digits, and what they have in common with one.
//!
//! x = high + low, |low| ≤ ½ ulp(high). Sums by Knuth's and products by Dekker's transformations, which give the rounding
//! error of a double operation exactly; a quotient is three quotients of doubles, a root one step of Newton's method.
//! Relative error of each operation a few 2⁻¹⁰⁴, where nothing underflows: magnitudes between 1e-250 and 1e250.
//! The exponential is e^x = 2^k (1 + q)^{512}, q = e^{r/512} − 1 from its series, x = k ln2 + r, |r| ≤ ½ ln2.
//!
//! [`Real`] lets one algorithm run fast in doubles and then to the end in these: between the 16 digits of the former and
//! the 154 of [`super::Extended`], a thousand times faster than the latter.
//!
//! Source: Hida, Li, Bailey, Proc. 15th IEEE Symp. Comput. Arith. 155 (2001), doi:10.1109/ARITH.2001.930115.

use std::cmp::Ordering;
use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};
use std::sync::LazyLock;

/// A number that algorithms here are written in.
pub trait Real:
    Copy
    + Debug
    + PartialOrd
    + From<f64>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// Relative rounding of one operation.
    const ROUNDING: f64;
    /// The nearest double.
    fn to_f64(self) -> f64;
    /// Square root; 0 of what is not above 0.
    fn root(self) -> Self;
    /// e to the power of this; 0 far below.
    fn exponential(self) -> Self;
    /// e to the power of this, less 1.
    fn exponential_less_one(self) -> Self;
    /// Natural logarithm of a number above 0.
    fn logarithm(self) -> Self;
    /// The larger of two.
    fn larger(self, other: Self) -> Self {
        if self < other { other } else { self }
    }
    /// The smaller of two.
    fn smaller(self, other: Self) -> Self {
        if other < self { other } else { self }
    }
    /// Magnitude.
    fn magnitude(self) -> Self {
        if self < Self::from(0.0) { -self } else { self }
    }
}

impl Real for f64 {
    const ROUNDING: f64 = 0.5 * f64::EPSILON;
    fn to_f64(self) -> f64 {
        self
    }
    fn root(self) -> Self {
        if self > 0.0 { self.sqrt() } else { 0.0 }
    }
    fn exponential(self) -> Self {
        self.exp()
    }
    fn exponential_less_one(self) -> Self {
        self.exp_m1()
    }
    fn logarithm(self) -> Self {
        self.ln()
    }
}

/// A number of two doubles.
///
/// ```
/// use hadar_evidence::reference::double_double::{DoubleDouble, Real};
/// let third = DoubleDouble::from(1.0) / DoubleDouble::from(3.0);
/// assert!((third * DoubleDouble::from(3.0) - DoubleDouble::from(1.0)).to_f64().abs() < 1e-31);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DoubleDouble {
    high: f64,
    low: f64,
}

/// a + b and its rounding error, |a| ≥ |b|.
fn ordered_sum(a: f64, b: f64) -> DoubleDouble {
    let high = a + b;
    DoubleDouble { high, low: b - (high - a) }
}

/// a + b and its rounding error.
fn sum(a: f64, b: f64) -> DoubleDouble {
    let high = a + b;
    let part = high - a;
    DoubleDouble { high, low: (a - (high - part)) + (b - part) }
}

/// Upper and lower half of the bits.
fn split(a: f64) -> [f64; 2] {
    let shifted = 134_217_729.0 * a;
    let high = shifted - (shifted - a);
    [high, a - high]
}

/// a·b and its rounding error.
fn product(a: f64, b: f64) -> DoubleDouble {
    let high = a * b;
    let ([a_high, a_low], [b_high, b_low]) = (split(a), split(b));
    let low = ((a_high * b_high - high) + a_high * b_low + a_low * b_high) + a_low * b_low;
    DoubleDouble { high, low }
}

impl From<f64> for DoubleDouble {
    fn from(value: f64) -> Self {
        Self { high: value, low: 0.0 }
    }
}

impl Add for DoubleDouble {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let (high, low) = (sum(self.high, other.high), sum(self.low, other.low));
        let high = ordered_sum(high.high, high.low + low.high);
        ordered_sum(high.high, high.low + low.low)
    }
}

impl Neg for DoubleDouble {
    type Output = Self;
    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl Sub for DoubleDouble {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for DoubleDouble {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let whole = product(self.high, other.high);
        ordered_sum(whole.high, whole.low + (self.high * other.low + self.low * other.high))
    }
}

impl Div for DoubleDouble {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let first = self.high / other.high;
        let rest = self - other * Self::from(first);
        let second = rest.high / other.high;
        let third = (rest - other * Self::from(second)).high / other.high;
        let high = ordered_sum(first, second);
        high + Self::from(third)
    }
}

impl PartialOrd for DoubleDouble {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        match self.high.partial_cmp(&other.high)? {
            Ordering::Equal => self.low.partial_cmp(&other.low),
            order => Some(order),
        }
    }
}

impl std::iter::Sum for DoubleDouble {
    fn sum<I: Iterator<Item = Self>>(terms: I) -> Self {
        terms.fold(Self::from(0.0), |sum, term| sum + term)
    }
}

/// Terms of the exponential's series: (½ ln2/512)ⁿ/n! is below 2⁻¹¹⁰ of the first at n = 10.
const TERMS: usize = 11;
/// Squarings of the exponential.
const SQUARINGS: usize = 9;

struct Constants {
    ln2: DoubleDouble,
    inverse_factorials: [DoubleDouble; TERMS],
}

static CONSTANTS: LazyLock<Constants> = LazyLock::new(|| {
    let one = DoubleDouble::from(1.0);
    let mut inverse_factorials = [one; TERMS];
    for n in 1..TERMS {
        inverse_factorials[n] = inverse_factorials[n - 1] / DoubleDouble::from(n as f64);
    }
    // ln2 = Σ 2⁻ᵏ/k.
    let ln2 = (1..120).rev().map(|k| DoubleDouble::from(0.5_f64.powi(k)) / DoubleDouble::from(f64::from(k)));
    Constants { ln2: ln2.sum(), inverse_factorials }
});

impl DoubleDouble {
    /// The double nearest to this; exact where it is one.
    #[must_use]
    pub fn high(self) -> f64 {
        self.high
    }

    /// What the nearest double leaves.
    #[must_use]
    pub fn low(self) -> f64 {
        self.low
    }

    fn times_power_of_two(self, power: i32) -> Self {
        // In two steps, so that neither factor leaves the range.
        let half = power / 2;
        let scale = |value: f64| value * 2.0_f64.powi(half) * 2.0_f64.powi(power - half);
        Self { high: scale(self.high), low: scale(self.low) }
    }
}

impl Real for DoubleDouble {
    const ROUNDING: f64 = 1e-31;
    fn to_f64(self) -> f64 {
        self.high
    }
    fn root(self) -> Self {
        if self.high <= 0.0 {
            return Self::from(0.0);
        }
        let root = self.high.sqrt();
        let rest = self - product(root, root);
        ordered_sum(root, rest.high / (2.0 * root))
    }
    fn exponential(self) -> Self {
        if self.high < -700.0 {
            return Self::from(0.0);
        }
        let constants = &*CONSTANTS;
        let power = (self.high * std::f64::consts::LOG2_E).round();
        let rest = (self - constants.ln2 * Self::from(power)).times_power_of_two(-(SQUARINGS as i32));
        let mut less_one = Self::from(0.0);
        for coefficient in constants.inverse_factorials[1..].iter().rev() {
            less_one = (less_one + *coefficient) * rest;
        }
        for _ in 0..SQUARINGS {
            less_one = less_one * less_one + less_one + less_one;
        }
        (less_one + Self::from(1.0)).times_power_of_two(power as i32)
    }
    fn exponential_less_one(self) -> Self {
        if self.high.abs() > 1e-3 {
            return self.exponential() - Self::from(1.0);
        }
        let terms = CONSTANTS.inverse_factorials[1..].iter().rev();
        terms.fold(Self::from(0.0), |value, coefficient| (value + *coefficient) * self)
    }
    fn logarithm(self) -> Self {
        // One step of Newton's method doubles the digits.
        let y = Self::from(self.high.ln());
        y + self * (-y).exponential() - Self::from(1.0)
    }
}

#[cfg(test)]
mod tests;
