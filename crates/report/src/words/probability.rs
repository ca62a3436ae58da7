//! Probabilities in words: near 1 with as many nines as it takes not to call them certain. Other numbers in words are in
//! [`hadar::words`].

use hadar::identifiability::detection;

/// Decimals of a demanded share beyond which more nines say nothing.
const MOST_DECIMALS: usize = 12;
/// The same of one that is reached.
const MOST_REACHED: usize = 6;

/// Reliability Φ(d) of a decision at statistical distance d: `84.1 %`, `99.9999 %`, `more than 99.9999 %`.
#[must_use]
pub fn reliability(distance: f64) -> String {
    in_percent(distance, MOST_REACHED)
}

/// A reliability that somebody demands, with all the nines that were asked for.
#[must_use]
pub fn demanded(distance: f64) -> String {
    in_percent(distance, MOST_DECIMALS)
}

/// Φ(d) as a share of 1, with `least` decimals where those are enough: `0.8413`, `0.999999`.
#[must_use]
pub fn probability(distance: f64, least: usize) -> String {
    as_share(distance, least, MOST_REACHED)
}

/// The same of one that somebody demands.
#[must_use]
pub fn demanded_probability(distance: f64, least: usize) -> String {
    as_share(distance, least, MOST_DECIMALS)
}

/// A share that was found, in percent: short of 1 never 100, but with as many nines as it takes.
#[must_use]
pub fn percent(share: f64) -> String {
    let missing = 1.0 - share;
    let decimals = if missing > 0.0 && missing < 5e-4 { (-missing.log10() - 1e-9).ceil() - 2.0 } else { 1.0 };
    format!("{:.*} %", decimals.clamp(1.0, MOST_DECIMALS as f64) as usize, 100.0 * share)
}

fn in_percent(distance: f64, most: usize) -> String {
    match decimals(distance) {
        wanted if wanted <= most => {
            format!("{:.*} %", wanted.max(3) - 2, 100.0 * detection::probability(distance))
        }
        _ => "more than 99.9999 %".into(),
    }
}

fn as_share(distance: f64, least: usize, most: usize) -> String {
    match decimals(distance) {
        wanted if wanted <= most => format!("{:.*}", wanted.max(least), detection::probability(distance)),
        _ => "more than 0.999999".into(),
    }
}

/// Decimals at which Φ(d) is not yet rounded to 1.
fn decimals(distance: f64) -> usize {
    // A probability that was given as 0.999999 comes back with a rounding error.
    (-detection::miss_probability(distance).log10() - 1e-6).ceil().max(0.0) as usize
}

#[cfg(test)]
mod tests {
    use super::*;
    use detection::distance_for_probability;

    #[test]
    fn short_of_certain_is_never_100_percent() {
        for (share, text) in
            [(0.8413, "84.1 %"), (1.0, "100.0 %"), (0.99951, "99.95 %"), (0.999_99, "99.999 %")]
        {
            assert_eq!(percent(share), text);
        }
        assert_ne!(percent(1.0 - 3e-9), percent(1.0));
    }

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
            let distance = distance_for_probability(probability).unwrap();
            assert_eq!(demanded(distance), said);
            let reached = if probability > 0.999_999 { "more than 99.9999 %" } else { said };
            assert_eq!(reliability(distance), reached);
        }
        assert_eq!((reliability(0.0), super::probability(1.0, 4)), ("50.0 %".into(), "0.8413".into()));
        let distance = distance_for_probability(0.999_999).unwrap();
        assert_eq!(super::probability(distance, 4), "0.999999");
        assert_eq!((reliability(10.0), reliability(60.0)), ("more than 99.9999 %".into(), reliability(7.0)));
        assert_eq!(
            (demanded(10.0), super::probability(6.0, 4)),
            (reliability(10.0), "more than 0.999999".into())
        );
        for i in 0..700 {
            let d = 0.01 * f64::from(i);
            assert!(!reliability(d).starts_with("100"), "{d}");
        }
    }
}
