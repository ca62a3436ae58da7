//! A price as a class: between two sums of one currency, as a public page states it or as the user gives it.
//!
//! Prices of the same part differ by factors of two between sellers and years; what is compared is the class.

use crate::error::{Error, Result};

/// Between two sums of a currency.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Price {
    /// At least so much, and at most.
    pub range: [f64; 2],
    /// Three capital letters, as in USD.
    pub currency: String,
}

impl Price {
    /// Reads `"under 300 USD"`, `"1 000 to 3 000 USD"` or `"3 558 USD"`.
    ///
    /// ```
    /// use hadar::instrument::Price;
    /// assert_eq!(Price::parse("1 000 to 3 000 USD")?.range, [1000.0, 3000.0]);
    /// assert_eq!(Price::parse("under 300 EUR")?.to_string(), "under 300 EUR");
    /// assert!(Price::parse("300").is_err());
    /// # Ok::<(), hadar::Error>(())
    /// ```
    ///
    /// # Errors
    /// Text that says it in another way, sums that are not above 0, the larger sum first.
    pub fn parse(text: &str) -> Result<Self> {
        let refuse = || {
            let instead = "write \"1 000 to 3 000 USD\", \"under 300 USD\" or \"3 558 USD\"";
            Error::malformed(format!("`{}` is no price", text.trim().escape_debug()), instead)
        };
        let (sums, currency) = text.trim().rsplit_once(' ').ok_or_else(refuse)?;
        if currency.len() != 3 || !currency.chars().all(|letter| letter.is_ascii_uppercase()) {
            return Err(refuse());
        }
        let sum = |text: &str| {
            let digits: String = text.chars().filter(|char| *char != ' ').collect();
            let value =
                digits.parse::<f64>().ok().filter(|_| digits.starts_with(|c: char| c.is_ascii_digit()));
            value.filter(|value| value.is_finite() && *value > 0.0).ok_or_else(refuse)
        };
        let range = match (sums.strip_prefix("under "), sums.split_once(" to ")) {
            (Some(most), _) => [0.0, sum(most)?],
            (None, Some((least, most))) => [sum(least)?, sum(most)?],
            (None, None) => [sum(sums)?; 2],
        };
        if range[0] > range[1] {
            return Err(refuse());
        }
        Ok(Self { range, currency: currency.into() })
    }

    /// The price of two parts together; none of two currencies.
    #[must_use]
    pub fn and(&self, other: &Self) -> Option<Self> {
        let range = [0, 1].map(|end| self.range[end] + other.range[end]);
        (self.currency == other.currency).then(|| Self { range, currency: self.currency.clone() })
    }

    /// The price of so many of it.
    #[must_use]
    pub fn times(&self, count: usize) -> Self {
        Self { range: self.range.map(|end| end * count as f64), currency: self.currency.clone() }
    }
}

impl std::fmt::Display for Price {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let sum = |value: f64| match value.fract() == 0.0 && value < 1e15 {
            true => crate::words::whole(value as u64),
            false => value.to_string(),
        };
        let [least, most] = self.range;
        match (least > 0.0, least < most) {
            (false, _) => write!(out, "under {} {}", sum(most), self.currency),
            (true, true) => write!(out, "{} to {} {}", sum(least), sum(most), self.currency),
            (true, false) => write!(out, "{} {}", sum(most), self.currency),
        }
    }
}

impl TryFrom<String> for Price {
    type Error = Error;

    fn try_from(text: String) -> Result<Self> {
        Self::parse(&text)
    }
}

impl From<Price> for String {
    fn from(price: Price) -> Self {
        price.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_price_is_read_as_it_is_written() {
        for text in ["under 300 USD", "300 to 1 000 USD", "3 558 EUR", "0.5 USD"] {
            assert_eq!(Price::parse(text).unwrap().to_string(), text);
        }
        for text in [
            "",
            "300",
            "300 usd",
            "300 to 100 USD",
            "-3 USD",
            "inf USD",
            "under USD",
            "a to b USD",
            "0 USD",
            "nan USD",
        ] {
            assert!(Price::parse(text).is_err(), "{text}");
        }
        let [one, other] = ["300 to 1 000 USD", "20 USD"].map(|text| Price::parse(text).unwrap());
        assert_eq!(one.and(&other.times(2)).unwrap().to_string(), "340 to 1 040 USD");
        assert_eq!(one.and(&Price::parse("1 EUR").unwrap()), None);
    }
}
