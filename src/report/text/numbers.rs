//! Numbers and names as text: as short as they can be without losing what matters.

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
    for (factor, prefix) in [(1.0, ""), (1e3, "m"), (1e6, "u"), (1e9, "n")] {
        if value * factor >= 1.0 {
            return format!("{} {prefix}{unit}", significant(value * factor, 3));
        }
    }
    format!("{} {unit}", significant(value, 3))
}

/// A number in powers of ten with `decimals` decimals; a plain 0.
pub(super) fn exponential(value: f64, decimals: usize) -> String {
    if value == 0.0 { "0".into() } else { format!("{value:.decimals$e}") }
}

pub(super) fn photons(count: Option<f64>) -> String {
    count.map_or_else(|| "no number suffices".into(), |count| format!("{count:.2e}"))
}

pub(super) fn celsius(kelvin: f64) -> String {
    format!("{:.2} degC", kelvin - 273.15)
}

/// Numbers with `decimals` decimals behind a label; nothing where there are none.
pub(super) fn numbers(label: &str, values: &[f64], decimals: usize) -> String {
    let values: Vec<String> = values.iter().map(|value| format!("{value:.decimals$}")).collect();
    if values.is_empty() { String::new() } else { format!("{label}{}", values.join(" ")) }
}

/// Names listed in one line at most; all of them are in the tables.
const LISTED: usize = 12;

/// A list of names, cut short where it is long.
pub(super) fn listed(names: &[String]) -> String {
    match names.len().checked_sub(LISTED) {
        Some(more) if more > 0 => format!("{} and {more} more", names[..LISTED].join(", ")),
        _ => names.join(", "),
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
}
