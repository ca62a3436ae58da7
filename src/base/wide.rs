//! Numbers of many digits and any size, for the few places where sixteen do not do.
//!
//! ±m·2^e with a fraction m in [½, 1) of 64·L bits and an exponent of its own, so that nothing overflows or underflows.
//! Sums and products are cut off after the last bit; quotients come from Newton's iteration. Each is good to a few units
//! of [`Wide::UNIT`], relative to the larger of the operands.
//!
//! eˣ − 1 = 2^k(1 + E) − 1 with x = k ln2 + r, E = e^r − 1: Taylor's series at r/2^m, doubled m times by E → E(2 + E), which
//! keeps the relative precision. Assumption: |k| < 2³¹ in it.
//!
//! Kept beside the arbitrary precision of the references (`astro-float-num`): that allocates each number and brings a dependency, and at 256
//! bits a sum takes 73 ns there and 13 ns here, a product 86 and 16 ns, an exponential 26 and 1.7 µs (at 128 bits 106 and 10 ns, 105 and
//! 8 ns, 22 and 0.8 µs). Only quotients of 512 bits are faster there (0.48 µs against 0.67).
//!
//! Source: Brent and Zimmermann, 'Modern Computer Arithmetic' (2010), sections 1.3, 3.4 and 4.2.

use std::cmp::Ordering;
use std::ops::{Add, Mul, Neg, Sub};

/// Most limbs of a number.
const MOST: usize = 8;
/// ln2·2⁵¹², the least limb first.
const LN2: [u64; MOST] = [
    0x2757_3b29_1169_b825,
    0xed2e_ae35_c138_2144,
    0x5595_52fb_4afa_1b10,
    0xe7b8_7620_6deb_ac98,
    0x8a0d_175b_8baa_fa2b,
    0x40f3_4326_7298_b62d,
    0xc9e3_b398_03f2_f6af,
    0xb172_17f7_d1cf_79ab,
];
/// Terms of the series of E: |r|¹⁵/16! is below 2⁻⁵¹² at |r| < 2⁻³⁷ and below 2⁻¹²⁸ at |r| < 2⁻¹³.
const TERMS: u64 = 16;

/// A number of 64·L bits, L no more than 8.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Wide<const L: usize> {
    negative: bool,
    exponent: i64,
    /// The fraction, the least limb first; its highest bit is 1, or all are 0.
    limbs: [u64; L],
}

impl<const L: usize> Wide<L> {
    pub(crate) const ZERO: Self = Self { negative: false, exponent: 0, limbs: [0; L] };
    /// Twice the relative error of a cut after the last bit.
    pub(crate) const UNIT: f64 = {
        let (mut unit, mut limbs) = (2.0, 0);
        while limbs < L {
            unit /= 18_446_744_073_709_551_616.0;
            limbs += 1;
        }
        unit
    };

    pub(crate) fn is_zero(&self) -> bool {
        self.limbs[L - 1] == 0
    }

    pub(crate) fn is_positive(&self) -> bool {
        !self.negative && !self.is_zero()
    }

    /// e of 2^e, the least power of two above the magnitude; 0 for 0.
    pub(crate) fn exponent(&self) -> i64 {
        if self.is_zero() { 0 } else { self.exponent }
    }

    /// This times 2^power.
    pub(crate) fn shifted(mut self, power: i64) -> Self {
        self.exponent += power;
        self
    }

    pub(crate) fn abs(self) -> Self {
        Self { negative: false, ..self }
    }

    /// The nearest double, or nearly; 0 or infinite beyond their range.
    pub(crate) fn to_f64(self) -> f64 {
        let power = (self.exponent - 64).clamp(-2200, 2200) as i32;
        let magnitude = crate::units::times_power_of_two(self.limbs[L - 1] as f64, power);
        if self.negative { -magnitude } else { magnitude }
    }

    /// The square root of what is not negative, to the digits of a double.
    pub(crate) fn sqrt(self) -> Self {
        if !self.is_positive() {
            return Self::ZERO;
        }
        let half = self.exponent.div_euclid(2);
        Self::from(self.shifted(-2 * half).to_f64().sqrt()).shifted(half)
    }

    /// 1/self; 0 of 0.
    pub(crate) fn inverse(self) -> Self {
        if self.is_zero() {
            return self;
        }
        let fraction = Self { exponent: 0, negative: false, ..self };
        let (one, mut inverse) = (Self::from(1.0), Self::from(1.0 / fraction.to_f64()));
        // 50 good bits of the double, doubled each time.
        let mut bits = 50;
        while bits < 64 * L {
            inverse = inverse + inverse * (one - fraction * inverse);
            bits *= 2;
        }
        Self { negative: self.negative, ..inverse.shifted(-self.exponent) }
    }

    /// This over a small number.
    fn over(mut self, divisor: u64) -> Self {
        let mut rest = 0_u128;
        for limb in self.limbs.iter_mut().rev() {
            let part = (rest << 64) | u128::from(*limb);
            *limb = (part / u128::from(divisor)) as u64;
            rest = part % u128::from(divisor);
        }
        self.normalised()
    }

    /// eˣ − 1.
    pub(crate) fn exp_minus_one(self) -> Self {
        let turns = (self.to_f64() / std::f64::consts::LN_2).round();
        let ln2 = Self { negative: false, exponent: 0, limbs: std::array::from_fn(|i| LN2[MOST - L + i]) };
        let (one, two) = (Self::from(1.0), Self::from(2.0));
        let halvings = 4 * L + 4;
        let r = (self - ln2 * Self::from(turns)).shifted(-(halvings as i64));
        let mut series = one;
        for n in (2..=TERMS).rev() {
            series = one + (r * series).over(n);
        }
        let mut e = r * series;
        for _ in 0..halvings {
            e = e * (two + e);
        }
        if turns == 0.0 { e } else { (one + e).shifted(turns as i64) - one }
    }

    /// Brings the highest bit to its place.
    fn normalised(mut self) -> Self {
        let Some(top) = (0..L).rev().find(|&i| self.limbs[i] != 0) else { return Self::ZERO };
        let (limbs, bits) = (L - 1 - top, self.limbs[top].leading_zeros());
        if limbs > 0 || bits > 0 {
            let at = |i: usize| i.checked_sub(limbs).map_or(0, |i| self.limbs[i]);
            self.limbs = std::array::from_fn(|i| {
                let below = i.checked_sub(1).map_or(0, at);
                if bits == 0 { at(i) } else { at(i) << bits | below >> (64 - bits) }
            });
            self.exponent -= 64 * limbs as i64 + i64::from(bits);
        }
        self
    }

    /// The limbs, as many bits lower.
    fn lowered(&self, bits: u64) -> [u64; L] {
        let (limbs, bits) = ((bits / 64) as usize, bits % 64);
        let at = |i: usize| if i < L { self.limbs[i] } else { 0 };
        std::array::from_fn(|i| {
            let (low, high) = (at(i + limbs), at(i + limbs + 1));
            if bits == 0 { low } else { low >> bits | high << (64 - bits) }
        })
    }

    /// |self| against |other|.
    fn compare_magnitudes(&self, other: &Self) -> Ordering {
        match (self.is_zero(), other.is_zero()) {
            (true, true) => Ordering::Equal,
            (true, false) => Ordering::Less,
            (false, true) => Ordering::Greater,
            (false, false) => {
                let key = |x: &Self| (x.exponent, x.limbs);
                let ((e, a), (f, b)) = (key(self), key(other));
                e.cmp(&f).then_with(|| a.iter().rev().cmp(b.iter().rev()))
            }
        }
    }
}

impl<const L: usize> From<f64> for Wide<L> {
    /// Without rounding; not for what is no number.
    fn from(value: f64) -> Self {
        let bits = value.to_bits();
        let (power, fraction) = ((bits >> 52 & 0x7ff) as i64, bits & ((1 << 52) - 1));
        // Numbers below the normal ones have no leading bit of their own.
        let (integer, power) = if power == 0 { (fraction, 1) } else { (fraction | 1 << 52, power) };
        let mut limbs = [0; L];
        limbs[L - 1] = integer;
        Self { negative: value < 0.0, exponent: power - 1075 + 64, limbs }.normalised()
    }
}

impl<const L: usize> Neg for Wide<L> {
    type Output = Self;
    fn neg(self) -> Self {
        Self { negative: !self.negative, ..self }
    }
}

impl<const L: usize> Add for Wide<L> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let (large, small) =
            if self.compare_magnitudes(&other) == Ordering::Less { (other, self) } else { (self, other) };
        let apart = large.exponent - small.exponent;
        if small.is_zero() || apart >= 64 * L as i64 {
            return large;
        }
        let addend = small.lowered(apart as u64);
        let mut sum = large;
        let mut carry = false;
        if large.negative == small.negative {
            for (limb, addend) in sum.limbs.iter_mut().zip(addend) {
                let (once, first) = limb.overflowing_add(addend);
                let (twice, second) = once.overflowing_add(u64::from(carry));
                (*limb, carry) = (twice, first || second);
            }
            if carry {
                sum.limbs = sum.lowered(1);
                sum.limbs[L - 1] |= 1 << 63;
                sum.exponent += 1;
            }
            return sum;
        }
        for (limb, addend) in sum.limbs.iter_mut().zip(addend) {
            let (once, first) = limb.overflowing_sub(addend);
            let (twice, second) = once.overflowing_sub(u64::from(carry));
            (*limb, carry) = (twice, first || second);
        }
        sum.normalised()
    }
}

impl<const L: usize> Sub for Wide<L> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl<const L: usize> Mul for Wide<L> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        if self.is_zero() || other.is_zero() {
            return Self::ZERO;
        }
        let mut product = [0_u64; 2 * MOST];
        for (i, &a) in self.limbs.iter().enumerate() {
            let mut carry = 0_u128;
            for (j, &b) in other.limbs.iter().enumerate() {
                carry += u128::from(a) * u128::from(b) + u128::from(product[i + j]);
                product[i + j] = carry as u64;
                carry >>= 64;
            }
            product[i + L] = carry as u64;
        }
        let mut exponent = self.exponent + other.exponent;
        // Two fractions of at least ½ make one of at least ¼.
        let low = product[2 * L - 1] >> 63 == 0;
        if low {
            exponent -= 1;
        }
        let limbs = std::array::from_fn(|i| {
            let (own, below) = (product[L + i], product[L + i - 1]);
            if low { own << 1 | below >> 63 } else { own }
        });
        Self { negative: self.negative != other.negative, exponent, limbs }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wide<const L: usize>(value: f64) -> Wide<L> {
        Wide::from(value)
    }

    /// What is left of two numbers, in units of the last place of the first.
    fn units_apart<const L: usize>(a: Wide<L>, b: Wide<L>) -> f64 {
        ((a - b) * a.inverse()).to_f64().abs() / Wide::<L>::UNIT
    }

    fn identities<const L: usize>() {
        for (a, b) in [(3.0, 7.0), (1e300, 1e-300), (-0.1, 0.3), (1.0 + f64::EPSILON, -1.0), (5e-324, 2.5)] {
            let (x, y) = (wide::<L>(a), wide::<L>(b));
            assert_eq!((x.to_f64(), y.to_f64()), (a, b));
            assert!(units_apart((x + y) * (x - y), x * x - y * y) < 4.0, "{a} {b}");
            assert!(units_apart(x * y * y.inverse(), x) < 8.0, "{a} {b}");
            assert_eq!(x + -x, Wide::ZERO);
            assert!(a < 0.0 || units_apart(x.sqrt() * x.sqrt(), x) * Wide::<L>::UNIT < 1e-15);
        }
        // Exact: (1 + 2⁻⁵²) − 1, and 2⁻¹⁰⁰ beside 1.
        assert_eq!((wide::<L>(1.0 + f64::EPSILON) - wide(1.0)).to_f64(), f64::EPSILON);
        let tiny = wide::<L>(1.0).shifted(-100);
        assert_eq!((wide::<L>(1.0) + tiny - wide(1.0)), tiny);
        assert_eq!(wide::<L>(1.0).shifted(5000).to_f64(), f64::INFINITY);
        assert_eq!(wide::<L>(1.0).shifted(-5000).to_f64(), 0.0);
    }

    #[test]
    fn sums_products_and_quotients_are_those_of_algebra() {
        identities::<2>();
        identities::<8>();
    }

    /// (e^x − 1) + 1 squared is e^{2x}; against the double; e^{−x} its inverse; small x by two terms of the series.
    fn exponentials<const L: usize>() {
        let one = wide::<L>(1.0);
        for x in [1e-30, 3e-9, 0.1, 0.35, 1.0, 2.5, 17.25, 700.0, 1.4e5] {
            let e = wide::<L>(x).exp_minus_one();
            let twice = wide::<L>(2.0 * x).exp_minus_one();
            assert!(units_apart(twice, e * (e + wide(2.0))) < (1.0 + x) * 4e3, "{x}");
            if x < 700.0 {
                assert!((e.to_f64() / x.exp_m1() - 1.0).abs() < 1e-15, "{x}");
                let negative = wide::<L>(-x).exp_minus_one();
                assert!(units_apart((one + e) * (one + negative), one) < x.exp() * 1e4);
            }
        }
        let x = wide::<L>(1e-30);
        let two_terms = x + x * x * wide(0.5);
        let third = 1e-60 / 6.0 / Wide::<L>::UNIT;
        assert!(units_apart(x.exp_minus_one(), two_terms) < 1e3 + 2.0 * third);
    }

    #[test]
    fn exponentials_keep_their_digits() {
        exponentials::<2>();
        exponentials::<8>();
    }
}
