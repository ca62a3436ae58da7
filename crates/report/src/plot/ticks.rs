//! Where an axis carries marks, and what is printed at them.
//!
//! Linear axes: steps of 1, 2 or 5 times a power of ten, a common power of ten taken out when the numbers
//! are long. Logarithmic axes: decades, 0.001 … 1000 in full and others as 10ⁿ, with unlabelled marks
//! between; over a few decades the 1–2–5 multiples, over less than one as many as make three labels, and below that the marks of a
//! linear axis.

use super::axis::{Ruler, Scale};

/// Marks along an axis; positions are fractions of its length.
#[derive(Debug, Clone, Default)]
pub(super) struct Ticks {
    /// Labelled marks.
    pub(super) major: Vec<(f64, String)>,
    /// Marks without label.
    pub(super) minor: Vec<f64>,
    /// Power of ten that all labels are to be multiplied with, e.g. `×10¹⁸`.
    pub(super) multiplier: Option<String>,
}

impl Ticks {
    /// About `wanted` labelled marks for the range of `ruler`.
    pub(super) fn new(ruler: &Ruler, wanted: usize) -> Self {
        let wanted = wanted.clamp(2, 40);
        match ruler.scale {
            Scale::Linear => linear(wanted, ruler.bounds(), |value| ruler.place(value)),
            Scale::Log => log(ruler, wanted),
        }
    }
}

fn linear(wanted: usize, (low, high): (f64, f64), place: impl Fn(f64) -> f64) -> Ticks {
    let raw = (high - low) / wanted as f64;
    let decade = raw.log10().floor();
    let unit = 10f64.powf(decade);
    let mantissa = [1.0, 2.0, 5.0].into_iter().find(|m| m * unit >= raw * 0.999).unwrap_or(10.0);
    let step = mantissa * unit;
    // A tick that rounding has pushed just outside the range still belongs to it.
    let (from, to) = ((low / step - 1e-6).ceil() as i64, (high / step + 1e-6).floor() as i64);

    let largest = low.abs().max(high.abs());
    let exponent = if (1e-3..1e5).contains(&largest) { 0.0 } else { largest.log10().floor() };
    let step_exponent = if mantissa == 10.0 { decade + 1.0 } else { decade };
    let decimals = (exponent - step_exponent).clamp(0.0, 15.0) as usize;
    let major = (from..=to.min(from.saturating_add(200)))
        .map(|i| (place(i as f64 * step), signed(i as f64 * step / 10f64.powf(exponent), decimals)))
        .collect();
    let multiplier = (exponent != 0.0).then(|| format!("×{}", power(exponent as i32)));
    Ticks { major, minor: Vec::new(), multiplier }
}

/// Multiples of a power of ten that carry labels, from few to many.
const LABELLED: [&[i32]; 4] = [&[1], &[1, 2, 5], &[1, 2, 3, 5, 7], &[1, 2, 3, 4, 5, 6, 7, 8, 9]];
/// Decades up to which more than powers of ten are labelled where there is room.
const FEW_DECADES: f64 = 3.0;
/// One or two numbers do not make a scale.
const LEAST: usize = 3;

fn log(ruler: &Ruler, wanted: usize) -> Ticks {
    let (low, high) = ruler.bounds();
    let (from, to) = ((low - 1e-9).ceil() as i32, (high + 1e-9).floor() as i32);
    let decades = usize::try_from(to - from + 1).unwrap_or(0);
    if decades > wanted {
        let stride = decades.div_ceil(wanted) as i32;
        let is_major = |n: &i32| n.rem_euclid(stride) == 0;
        let major = (from..=to).filter(is_major).map(|n| (ruler.place(n.into()), number(1, n))).collect();
        let minor = (from..=to).filter(|n| !is_major(n)).map(|n| ruler.place(n.into())).collect();
        return Ticks { major, minor, multiplier: None };
    }
    let all: Vec<_> = multiples(low, high, 1..=9).collect();
    let count = |set: &[i32]| all.iter().filter(|(_, m, _)| set.contains(m)).count();
    let roomy = |set: &[i32]| high - low < FEW_DECADES && count(set) <= wanted;
    let [_, thirds, ..] = LABELLED;
    let first = usize::from(roomy(thirds));
    let Some(set) = LABELLED.iter().skip(first).find(|set| count(set) >= LEAST) else {
        return linear(wanted, (10f64.powf(low), 10f64.powf(high)), |value| ruler.place(value.log10()));
    };
    let (major, minor): (Vec<_>, Vec<_>) = all.iter().partition(|(_, m, _)| set.contains(m));
    Ticks {
        major: major.into_iter().map(|(t, m, n)| (ruler.place(t), number(m, n))).collect(),
        minor: minor.into_iter().map(|(t, ..)| ruler.place(t)).collect(),
        multiplier: None,
    }
}

/// log₁₀, mantissa and exponent of every m·10ⁿ in the range.
fn multiples(
    low: f64,
    high: f64,
    mantissas: std::ops::RangeInclusive<i32>,
) -> impl Iterator<Item = (f64, i32, i32)> {
    (low.floor() as i32..=high.ceil() as i32)
        .flat_map(move |n| mantissas.clone().map(move |m| (f64::from(n) + f64::from(m).log10(), m, n)))
        .filter(move |(t, ..)| (low - 1e-9..=high + 1e-9).contains(t))
}

/// `value` with a true minus sign and no negative zero.
fn signed(value: f64, decimals: usize) -> String {
    let text = format!("{:.decimals$}", value.abs());
    if value < 0.0 && text.bytes().any(|b| (b'1'..=b'9').contains(&b)) { format!("−{text}") } else { text }
}

/// m·10ⁿ as a person writes it.
fn number(mantissa: i32, exponent: i32) -> String {
    match exponent {
        0..=3 => format!("{}", mantissa * 10i32.pow(exponent.unsigned_abs())),
        -3..0 => {
            let decimals = exponent.unsigned_abs() as usize;
            format!("{:.decimals$}", f64::from(mantissa) * 10f64.powi(exponent))
        }
        _ if mantissa == 1 => power(exponent),
        _ => format!("{mantissa}×{}", power(exponent)),
    }
}

/// 10ⁿ with superscript digits.
pub(super) fn power(exponent: i32) -> String {
    format!("10{}", superscript(&exponent.to_string()))
}

/// Digits and signs raised.
pub(super) fn superscript(digits: &str) -> String {
    const RAISED: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let raised = |c: char| match c {
        '-' | '−' => '⁻',
        c => c.to_digit(10).and_then(|digit| RAISED.get(digit as usize)).copied().unwrap_or(c),
    };
    digits.chars().map(raised).collect()
}

/// A single number as a label, three significant digits, e.g. of a contour line.
pub(super) fn label(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let exponent = value.abs().log10().floor();
    if (-3.0..4.0).contains(&exponent) {
        let text = signed(value, (2.0 - exponent).max(0.0) as usize);
        return if text.contains('.') {
            text.trim_end_matches('0').trim_end_matches('.').to_owned()
        } else {
            text
        };
    }
    let mantissa = format!("{:.2}", value / 10f64.powf(exponent));
    let mantissa = mantissa.trim_end_matches('0').trim_end_matches('.').replace('-', "−");
    match mantissa.as_str() {
        "1" => power(exponent as i32),
        "10" => power(exponent as i32 + 1),
        other => format!("{other}×{}", power(exponent as i32)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(scale: Scale, low: f64, high: f64, wanted: usize) -> (Vec<String>, Option<String>) {
        let ticks = Ticks::new(&Ruler::fit(scale, Some((low, high)), std::iter::empty(), 0.0), wanted);
        (ticks.major.into_iter().map(|(_, text)| text).collect(), ticks.multiplier)
    }

    #[test]
    fn labels_are_those_a_person_would_write() {
        assert_eq!(labels(Scale::Linear, 0.0, 1.0, 5).0, ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(labels(Scale::Linear, -0.1, 0.1, 4).0, ["−0.10", "−0.05", "0.00", "0.05", "0.10"]);
        let (radiance, factor) = labels(Scale::Linear, 4e18, 6e18, 4);
        assert_eq!(radiance, ["4.0", "4.5", "5.0", "5.5", "6.0"]);
        assert_eq!(factor.as_deref(), Some("×10¹⁸"));
        assert_eq!(labels(Scale::Log, 0.1, 1e4, 9).0, ["0.1", "1", "10", "100", "1000", "10⁴"]);
        assert_eq!(labels(Scale::Log, 1e-9, 1e9, 7).0.len(), 7);
        assert_eq!(labels(Scale::Log, 1.5e5, 8e5, 5).0, ["2×10⁵", "3×10⁵", "5×10⁵", "7×10⁵"]);
        assert_eq!(labels(Scale::Log, 0.02, 1.0, 9).0, ["0.02", "0.05", "0.1", "0.2", "0.5", "1"]);
        assert_eq!(labels(Scale::Log, 8.3e-4, 1.02e-3, 4).0, ["0.00085", "0.00090", "0.00095", "0.00100"]);
        assert_eq!(labels(Scale::Log, 3.1, 3.3, 4).0, ["3.10", "3.15", "3.20", "3.25", "3.30"]);
    }

    #[test]
    fn single_numbers_keep_three_digits() {
        for (value, text) in
            [(0.75, "0.75"), (-2.5e-6, "−2.5×10⁻⁶"), (1e9, "10⁹"), (1234.0, "1234"), (9.999e8, "10⁹")]
        {
            assert_eq!(label(value), text);
        }
    }
}
