//! Numbers as decimal digits.

use super::Extended;
use std::cmp::Ordering;

impl Extended {
    /// Rounded to so many significant digits, from 1 to 100, half away from 0, without zeros at the end: `0.0125`, or `1.25e-7`
    /// where the point would stand far from the digits.
    ///
    /// ```
    /// use hadar_evidence::reference::Extended;
    /// assert_eq!((Extended::one() / Extended::from(3.0)).to_decimal(5), "0.33333");
    /// assert_eq!(Extended::parse("-2.99950e-12").to_decimal(4), "-3e-12");
    /// ```
    #[must_use]
    pub fn to_decimal(&self, digits: usize) -> String {
        if !self.is_finite() {
            return self.to_f64().to_string();
        }
        if self.is_zero() {
            return "0".into();
        }
        let (figures, exponent) = self.abs().figures(digits.clamp(1, 100));
        let sign = if self.is_positive() { "" } else { "-" };
        let figures = figures.trim_end_matches('0');
        let (count, digits) = (figures.len() as i32, digits as i32);
        let text = match exponent {
            e if (-4..0).contains(&e) => format!("0.{}{figures}", "0".repeat(e.unsigned_abs() as usize - 1)),
            e if e >= 0 && e + 1 >= count && e < digits => {
                format!("{figures}{}", "0".repeat((e + 1 - count) as usize))
            }
            e if e >= 0 && e < digits => {
                let (whole, rest) = figures.split_at(e as usize + 1);
                format!("{whole}.{rest}")
            }
            e if count == 1 => format!("{figures}e{e}"),
            e => {
                let (first, rest) = figures.split_at(1);
                format!("{first}.{rest}e{e}")
            }
        };
        format!("{sign}{text}")
    }

    /// The first `digits` figures of a positive number, the last one rounded, and the power of ten of the first.
    fn figures(&self, digits: usize) -> (String, i32) {
        let ten = Self::from(10.0);
        // 2^(e − 1) ≤ this < 2^e.
        let power = self.0.exponent().unwrap_or(0) - 1;
        let mut exponent = (f64::from(power) * std::f64::consts::LOG10_2).floor() as i32;
        let mut rest = self / Self::parse(&format!("1e{exponent}"));
        while rest >= ten {
            (rest, exponent) = (rest / &ten, exponent + 1);
        }
        // Half of the last figure, and what the division may have taken off an exact half.
        rest = rest + Self::parse(&format!("5e-{digits}")) + Self::parse("1e-130");
        if rest >= ten {
            (rest, exponent) = (rest / &ten, exponent + 1);
        }
        let figure = |_| {
            // The largest whole number that fits: the nearest double may be the next one.
            let mut whole = rest.to_f64().floor();
            if Self::from(whole).partial_cmp(&rest) == Some(Ordering::Greater) {
                whole -= 1.0;
            }
            rest = (&rest - Self::from(whole)) * &ten;
            char::from(b'0' + whole as u8)
        };
        ((0..digits).map(figure).collect(), exponent)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Doubles against the printing of the standard library, which is exact to any count of digits.
    #[test]
    fn doubles_are_printed_as_the_standard_library_does() {
        let mut value = 0.123_456_789_012_345_67_f64;
        for i in 0..300 {
            value = (value * 997.123_456_789).fract();
            let scaled = value * 10f64.powi(i % 40 - 35);
            for digits in [1, 3, 17, 21] {
                let found = Extended::from(scaled).to_decimal(digits);
                let exact = format!("{scaled:.*e}", digits - 1);
                let error = Extended::parse(&found).relative_error_to(&Extended::parse(&exact));
                assert!(error < 1e-100, "{found} {exact}");
            }
        }
    }

    #[test]
    fn the_point_stands_where_it_is_read_best() {
        for (text, digits, expected) in [
            ("0", 5, "0"),
            ("100", 5, "100"),
            ("-310.15", 17, "-310.15"),
            ("99999.6", 5, "1e5"),
            ("99999.6", 6, "99999.6"),
            ("123456", 5, "1.2346e5"),
            ("0.00012345", 3, "0.000123"),
            ("0.000012345", 3, "1.23e-5"),
            ("1.25", 2, "1.3"),
            ("9.9999e-62461", 2, "1e-62460"),
            ("3e21", 25, "3000000000000000000000"),
            ("5e-1", 1, "0.5"),
        ] {
            assert_eq!(Extended::parse(text).to_decimal(digits), expected, "{text}");
        }
        assert_eq!(Extended::from(f64::INFINITY).to_decimal(3), "inf");
    }

    /// What is printed in full is read again.
    #[test]
    fn a_hundred_digits_come_back() {
        let third = Extended::from(-7.25e-30) / Extended::from(3.0);
        let error = Extended::parse(&third.to_decimal(100)).relative_error_to(&third);
        assert!(error < 1e-99 && error > 0.0, "{error:e}");
    }
}
