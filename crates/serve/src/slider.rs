//! The range that a slider covers about a number that is written: of a share all of it, of a temperature 40 K, else a decade on
//! either side, and no value that is refused.

use hadar::units::Dimension;
use hadar_scenario::keys::{Key, Value};
use serde::Serialize;

/// A range that a slider covers, in the unit that is written.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Slider {
    number: f64,
    unit: String,
    /// `linear`, `log`, or `nines`: logarithmic towards 1.
    scale: &'static str,
    low: f64,
    high: f64,
    whole: bool,
}

/// The range about a number that is written: of a share all of it, of a temperature 40 K, else a decade on either side.
pub(crate) fn slider(key: &Key, text: &str) -> Option<Slider> {
    let (dimension, allowed, whole) = match key.value {
        Value::Quantity(dimension, allowed) => (Some(dimension), Some(allowed), false),
        Value::Number(allowed) | Value::NumberOrFile(allowed) => (None, Some(allowed), false),
        Value::Count(_) => (None, None, true),
        _ => return None,
    };
    if text.len() > LONGEST_NUMBER {
        return None;
    }
    let (number, unit) = parts(text)?;
    if dimension.is_some_and(|dimension| dimension.parse(text).is_err()) {
        return None;
    }
    let is_share = allowed.is_some_and(|allowed| {
        allowed.allows(0.5) && allowed.allows(1.0 - 1e-9) && !allowed.allows(1.0 + 1e-6)
    });
    let (scale, low, high) = match dimension {
        _ if key.name == "detection_probability" => ("nines", 0.501, 0.999_999),
        Some(Dimension::Temperature) => {
            let half = if unit.ends_with('F') { 72.0 } else { 40.0 };
            ("linear", number - half, number + half)
        }
        None if is_share => ("linear", 0.0, 1.0),
        _ if whole => ("log", 1.0, (10.0 * number).clamp(100.0, 1e6)),
        _ => ("log", number / 10.0, number * 10.0),
    };
    // No end that is refused.
    let is_allowed = |value: f64| match (dimension, allowed) {
        (Some(dimension), Some(allowed)) => {
            dimension.parse(&format!("{value} {unit}")).is_ok_and(|value| allowed.allows(value))
        }
        (None, Some(allowed)) => allowed.allows(value),
        _ => true,
    };
    let [low, high] = [low, high].map(|end| nearest_allowed(number, end, is_allowed));
    let sound = number >= low && number <= high && low.is_finite() && high.is_finite() && low < high;
    (sound && (scale != "log" || low > 0.0)).then(|| Slider {
        number,
        unit: unit.to_owned(),
        scale,
        low,
        high,
        whole,
    })
}

/// Longest text that is taken for a number with its unit, bytes.
const LONGEST_NUMBER: usize = 64;
/// Halvings between an end of a slider that is refused and a number that is not.
const HALVINGS: usize = 40;

/// The end itself where it is allowed, else the last number towards it that is.
fn nearest_allowed(number: f64, end: f64, is_allowed: impl Fn(f64) -> bool) -> f64 {
    if is_allowed(end) || !is_allowed(number) {
        return end;
    }
    let halved = |(inside, outside): (f64, f64), _| {
        let middle = 0.5 * (inside + outside);
        if is_allowed(middle) { (middle, outside) } else { (inside, middle) }
    };
    (0..HALVINGS).fold((number, end), halved).0
}

/// A number and the unit behind it, as they are written.
fn parts(text: &str) -> Option<(f64, &str)> {
    let text = text.trim();
    let is_number = |end: &usize| text.get(..*end).is_some_and(|part| part.trim().parse::<f64>().is_ok());
    let ends = text.char_indices().map(|(at, _)| at).chain([text.len()]).skip(1);
    let end = ends.filter(is_number).last()?;
    let number: f64 = text.get(..end)?.trim().parse().ok()?;
    number.is_finite().then(|| (number, text.get(end..).unwrap_or_default().trim()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::place;

    #[test]
    fn numbers_are_told_from_their_units() {
        for (text, expected) in [
            ("10 ms", Some((10.0, "ms"))),
            ("-3.5e-1 degC", Some((-0.35, "degC"))),
            ("0.6", Some((0.6, ""))),
            ("12um", Some((12.0, "um"))),
            ("1e3m", Some((1000.0, "m"))),
            ("warm", None),
            ("", None),
            ("nan K", None),
        ] {
            assert_eq!(parts(text), expected, "{text}");
        }
    }

    #[test]
    fn a_slider_ends_where_values_are_refused() {
        let slider_at = |path: &str, text: &str| {
            let mut table = place::root().unwrap();
            let mut found = None;
            for name in path.split('.') {
                let key = table.key(name).unwrap();
                found = Some(key);
                table = key.value.table().unwrap_or(table);
            }
            slider(&found.unwrap(), text)
        };
        let ends = |path: &str, text: &str| slider_at(path, text).map(|slider| (slider.low, slider.high));
        assert_eq!(ends("camera.exposure", "10 ms"), Some((1.0, 100.0)));
        assert_eq!(ends("environment.lighting", "0.6"), Some((0.0, 1.0)));
        assert_eq!(ends("target.temperature", "33 degC"), Some((-7.0, 73.0)));
        let (low, high) = ends("camera.field_of_view", "50 deg").unwrap();
        assert!(low == 5.0 && high < 180.0 && high > 179.9, "{low} {high}");
        let (low, high) = ends("camera.f_number", "1.0").unwrap();
        assert!((low - 0.5).abs() < 1e-9 && high == 10.0, "{low} {high}");
        assert!(ends("target.temperature", "10 K").unwrap().0 > 0.0);
        assert_eq!(slider_at("camera.netd", "warm"), None);
    }
}
