//! Numbers in words: as short as they can be without losing what matters.

/// A number with `digits` significant digits, plain where that is short, else in powers of ten.
#[must_use]
pub fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let exponent = value.abs().log10().floor() as i32;
    let last = digits.saturating_sub(1);
    if (-4..6).contains(&exponent) {
        let decimals = usize::try_from(last as i32 - exponent).unwrap_or(0);
        format!("{value:.decimals$}")
    } else {
        format!("{value:.last$e}")
    }
}

/// A length, time or such with a unit that keeps the number short.
#[must_use]
pub fn quantity(value: f64, unit: &str) -> String {
    for (factor, prefix) in [(1.0, ""), (1e3, "m"), (1e6, "u"), (1e9, "n"), (1e12, "p")] {
        if value * factor >= 1.0 {
            return format!("{} {prefix}{unit}", significant(value * factor, 3));
        }
    }
    format!("{} {unit}", significant(value, 3))
}

/// A length from millimetres to metres, in two digits.
#[must_use]
pub fn length(metres: f64) -> String {
    let (factor, unit) = match metres {
        _ if metres.is_nan() => return "-".into(),
        _ if metres.is_infinite() => return "infinite".into(),
        _ if metres >= 1.0 => (1.0, "m"),
        _ if metres >= 0.01 => (1e2, "cm"),
        _ if metres >= 1e-3 => (1e3, "mm"),
        _ => (1e6, "um"),
    };
    format!("{} {unit}", significant(metres * factor, 2))
}

/// A whole number, its digits in groups of three.
#[must_use]
pub fn whole(count: u64) -> String {
    let digits = count.to_string();
    let groups: Vec<&str> =
        digits.as_bytes().rchunks(3).rev().filter_map(|g| std::str::from_utf8(g).ok()).collect();
    groups.join(" ")
}

/// A share in percent, never 0 or 100 % short of it.
#[must_use]
pub fn share(share: f64) -> String {
    let percent = 100.0 * share;
    if share > 0.0 && percent < 0.5 {
        "< 1 %".into()
    } else if share < 1.0 && percent > 99.5 {
        "> 99 %".into()
    } else {
        format!("{percent:.0} %")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_keep_their_digits() {
        assert_eq!(significant(0.056_23, 3), "0.0562");
        assert_eq!(significant(663_212.0, 3), "663212");
        assert_eq!(significant(6.632e8, 3), "6.63e8");
        assert_eq!(quantity(12e-6, "m"), "12.0 um");
        assert_eq!(quantity(0.012, "s"), "12.0 ms");
        assert_eq!(quantity(0.0, "s"), "0 s");
    }

    #[test]
    fn whole_numbers_are_grouped() {
        assert_eq!([0, 999, 1000, 1_234_567].map(whole), ["0", "999", "1 000", "1 234 567"]);
    }

    #[test]
    fn lengths_and_shares_are_not_rounded_to_what_they_are_not() {
        assert_eq!([12.34, 0.0512, 0.0042, 3e-5].map(length), ["12 m", "5.1 cm", "4.2 mm", "30 um"]);
        assert_eq!([0.0, 0.001, 0.5, 0.9999, 1.0].map(share), ["0 %", "< 1 %", "50 %", "> 99 %", "100 %"]);
    }
}
