//! Probabilities near 1 in words: with as many nines as it takes not to call them certain.

use hadar::identifiability::detection;

/// Decimals of a share beyond which its distance from 1 says more than its nines.
const MOST_DECIMALS: usize = 12;

/// Reliability Φ(d) of a decision at statistical distance d: `84.1 %`, `99.9999 %`, `1 - 7.6e-24`.
#[must_use]
pub fn reliability(distance: f64) -> String {
    match decimals(distance) {
        Some(decimals) => {
            let decimals = decimals.max(3) - 2;
            format!("{:.decimals$} %", 100.0 * detection::probability(distance))
        }
        None => nearly_certain(distance),
    }
}

/// The same as a share of 1, with `least` decimals where those are enough: `0.8413`, `0.999999`.
#[must_use]
pub fn probability(distance: f64, least: usize) -> String {
    match decimals(distance) {
        Some(decimals) => {
            let decimals = decimals.max(least);
            format!("{:.decimals$}", detection::probability(distance))
        }
        None => nearly_certain(distance),
    }
}

/// Decimals at which Φ(d) is not yet rounded to 1; `None` where they would be too many.
fn decimals(distance: f64) -> Option<usize> {
    // A probability that was given as 0.999999 comes back with a rounding error.
    let wanted = (-detection::miss_probability(distance).log10() - 1e-6).ceil().max(0.0);
    (wanted <= MOST_DECIMALS as f64).then_some(wanted as usize)
}

fn nearly_certain(distance: f64) -> String {
    match detection::miss_probability(distance) {
        0.0 => "more than 1 - 1e-300".into(),
        miss => format!("1 - {miss:.1e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use detection::distance_for_probability;

    #[test]
    fn nothing_short_of_certain_is_called_100_percent() {
        for (probability, said) in [
            (0.841_344_746, "84.1 %"),
            (0.5227, "52.3 %"),
            (0.99, "99.0 %"),
            (0.9995, "99.95 %"),
            (0.999_96, "99.996 %"),
            (0.999_999, "99.9999 %"),
            (0.999_999_9, "99.99999 %"),
        ] {
            assert_eq!(reliability(distance_for_probability(probability).unwrap()), said);
        }
        assert_eq!((reliability(0.0), super::probability(1.0, 4)), ("50.0 %".into(), "0.8413".into()));
        let distance = distance_for_probability(0.999_999).unwrap();
        assert_eq!(super::probability(distance, 4), "0.999999");
        assert_eq!(reliability(10.0), "1 - 7.6e-24");
        assert_eq!(reliability(60.0), "more than 1 - 1e-300");
        for i in 0..700 {
            let d = 0.01 * f64::from(i);
            assert!(!reliability(d).starts_with("100"), "{d}");
        }
    }
}
