//! Numbers in words: as short as they can be without losing what matters; names and titles in one form.

use std::borrow::Cow;

/// Powers of ten within which a number is written plainly: from 0.001 to 99999.
const PLAIN: std::ops::Range<i32> = -3..5;

/// What is said in the place of digits of what has none.
const fn no_number(value: f64) -> Option<&'static str> {
    match value {
        f64::INFINITY => Some("infinite"),
        f64::NEG_INFINITY => Some("minus infinite"),
        value if value.is_nan() => Some("none"),
        _ => None,
    }
}

/// A number with so many decimals.
#[must_use]
pub fn fixed(value: f64, decimals: usize) -> String {
    no_number(value).map_or_else(|| format!("{value:.decimals$}"), str::to_owned)
}

/// A number with `digits` significant digits, plain where that is short, else in powers of ten: the one style of all
/// numbers in a text.
#[must_use]
pub fn significant(value: f64, digits: usize) -> String {
    if let Some(word) = no_number(value) {
        return word.into();
    }
    if value == 0.0 {
        return "0".into();
    }
    let last = digits.saturating_sub(1);
    // The power of ten after rounding: 0.0009999 may be 0.00100.
    let in_powers = format!("{value:.last$e}");
    let exponent = in_powers.split_once('e').and_then(|(_, power)| power.parse().ok()).unwrap_or(i32::MAX);
    if PLAIN.contains(&exponent) {
        let decimals = usize::try_from(last as i32 - exponent).unwrap_or(0);
        // As it was rounded: 44032 of three digits is 44000.
        let rounded: f64 = in_powers.parse().unwrap_or(value);
        format!("{rounded:.decimals$}")
    } else {
        in_powers
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
        f64::INFINITY => return "infinite".into(),
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
        no_number(percent).map_or_else(|| format!("{percent:.0} %"), str::to_owned)
    }
}

/// A name in kebab-case: `tilePavement` → `tile-pavement`, `Fused silica` → `fused-silica`. Qualified
/// names keep their `@`.
#[must_use]
pub fn kebab_case(name: &str) -> String {
    let mut kebab = String::with_capacity(name.len() + 2);
    let mut previous = ' ';
    for character in name.chars() {
        let boundary = !(character.is_alphanumeric() || character == '@');
        let hump = character.is_uppercase() && previous.is_lowercase();
        if (boundary || hump) && !kebab.is_empty() && !kebab.ends_with(['-', '@']) {
            kebab.push('-');
        }
        if !boundary {
            if character == '@' && kebab.ends_with('-') {
                kebab.pop();
            }
            kebab.extend(character.to_lowercase());
        }
        previous = character;
    }
    kebab.truncate(kebab.trim_end_matches('-').len());
    kebab
}

/// Text without line breaks and other control characters, nor more than one blank at a place.
#[must_use]
pub fn one_line(text: &str) -> String {
    let words = text.split(|char: char| char.is_whitespace() || char.is_control());
    words.filter(|word| !word.is_empty()).collect::<Vec<_>>().join(" ")
}

/// Whether a letter is not seen, or changes the order in which others are: what is read is then not what is there.
#[must_use]
pub fn is_hidden(letter: char) -> bool {
    let unseen = matches!(letter,
        '\u{AD}' | '\u{34F}' | '\u{61C}' | '\u{115F}' | '\u{1160}' | '\u{17B4}' | '\u{17B5}' | '\u{180B}'..='\u{180F}'
        | '\u{200B}'..='\u{200F}' | '\u{2028}'..='\u{202E}' | '\u{2060}'..='\u{206F}' | '\u{3164}' | '\u{FE00}'..='\u{FE0F}'
        | '\u{FEFF}' | '\u{FFA0}' | '\u{FFF0}'..='\u{FFFB}' | '\u{E0000}'..='\u{E0FFF}');
    unseen || (letter.is_control() && !matches!(letter, '\n' | '\t'))
}

/// Whether a text has such a letter.
#[must_use]
pub fn has_hidden(text: &str) -> bool {
    // Most texts are of plain letters, of which none is hidden.
    !text.bytes().all(|byte| matches!(byte, b' '..=b'~' | b'\n')) && text.contains(is_hidden)
}

/// A text as it may be shown: letters that are not seen, or that change the order of others, as `\u{202e}`. Lines stay lines.
///
/// ```
/// use hadar::words::visible;
/// assert_eq!(visible("skin, 37 degC"), "skin, 37 degC");
/// assert_eq!(visible("gold\u{202e}toboR"), "gold\\u{202e}toboR");
/// ```
#[must_use]
pub fn visible(text: &str) -> Cow<'_, str> {
    if !has_hidden(text) {
        return Cow::Borrowed(text);
    }
    let shown = |letter: char| match is_hidden(letter) {
        true => letter.escape_unicode().to_string(),
        false => letter.to_string(),
    };
    Cow::Owned(text.chars().map(shown).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_keep_their_digits() {
        assert_eq!(significant(0.056_23, 3), "0.0562");
        assert_eq!(significant(66_321.0, 3), "66300");
        assert_eq!(significant(663_212.0, 3), "6.63e5");
        assert_eq!(
            [0.629, 0.0569, 0.001, 0.000_999].map(|x| significant(x, 3)),
            ["0.629", "0.0569", "0.00100", "9.99e-4"]
        );
        assert_eq!([99_999.9, 0.000_999_96, 9.999].map(|x| significant(x, 3)), ["1.00e5", "0.00100", "10.0"]);
        assert_eq!(
            [0.0, -0.0, f64::INFINITY, -f64::INFINITY].map(|x| significant(x, 3)),
            ["0", "0", "infinite", "minus infinite"]
        );
        assert_eq!(significant(6.632e8, 3), "6.63e8");
        assert_eq!(quantity(12e-6, "m"), "12.0 um");
        assert_eq!(quantity(0.012, "s"), "12.0 ms");
        assert_eq!(quantity(0.0, "s"), "0 s");
    }

    /// What has no digits is said in words, whatever it is written as.
    #[test]
    fn no_number_is_said_as_the_computer_says_it() {
        let mut seed = 1_u64;
        let bits = std::iter::repeat_with(|| {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            f64::from_bits(seed ^ (seed >> 29))
        });
        let ends = [f64::INFINITY, f64::NEG_INFINITY, f64::NAN, f64::MAX, f64::MIN, 5e-324, -0.0, 0.0];
        for value in ends.into_iter().chain(bits.take(20_000)) {
            let said =
                [significant(value, 3), fixed(value, 2), quantity(value, "m"), length(value), share(value)];
            for text in &said {
                let word = text.split([' ', '-', '>', '<']).any(|word| ["inf", "NaN", "nan"].contains(&word));
                assert!(!word && !text.is_empty(), "{value}: {text}");
                // A share of 1e307 is more than a number can say.
                let has_digits = text.contains(|letter: char| letter.is_ascii_digit());
                assert!(
                    value.is_finite() && value.abs() > 1e300 || value.is_finite() == has_digits,
                    "{value}: {text}"
                );
            }
        }
    }

    #[test]
    fn what_is_not_seen_is_shown() {
        for letter in ('\0'..='\u{2FFF}').chain(['\u{FEFF}', '\u{E0041}']) {
            let text = format!("a{letter}b");
            let shown = visible(&text);
            assert!(!shown.contains(is_hidden));
            // What is seen stays as it is.
            assert_eq!(is_hidden(letter), shown != text, "{letter:?}");
        }
        assert_eq!(visible("one\n\ttwo ä Ω 人"), "one\n\ttwo ä Ω 人");
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
