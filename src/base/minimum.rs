//! Where a function of one variable is least, by the golden section.
//!
//! A bracket [a, b] is narrowed to [a, b − g(b − a)] or [a + g(b − a), b], whichever has the lesser of the two values at these
//! inner places; with g = (√5 − 1)/2 one of them is an inner place of the new bracket, so that each narrowing costs one
//! value and leaves g = 0.618 of the length. Assumption: one minimum within the bracket; of a function with several,
//! one of them is found.
//!
//! Source: Kiefer, Proc. Am. Math. Soc. 4, 502 (1953), doi:10.2307/2032161. Written out and not taken from `argmin` (0.11):
//! there a search of 26 steps takes 12 µs instead of 0.7, errors come back as `anyhow`'s, and eight packages with it.

/// The bracket of a minimum of `f` after `steps` narrowings, for which `f` is evaluated `steps` + 1 times. Of two equal
/// values the upper one is followed.
///
/// # Errors
/// The first error of `f`.
///
/// ```
/// use hadar::minimum::golden_section;
/// let Ok([low, high]) = golden_section::<std::convert::Infallible>([0.0, 3.0], 30, |x| Ok((x - 1.0).powi(2)));
/// assert!(low <= 1.0 && 1.0 <= high && high - low < 1e-5);
/// ```
pub fn golden_section<E>(
    [mut low, mut high]: [f64; 2],
    steps: usize,
    mut f: impl FnMut(f64) -> Result<f64, E>,
) -> Result<[f64; 2], E> {
    if steps == 0 {
        return Ok([low, high]);
    }
    let golden = 0.5 * (5f64.sqrt() - 1.0);
    let lower = |low: f64, high: f64| high - golden * (high - low);
    let upper = |low: f64, high: f64| low + golden * (high - low);
    let (mut left, mut right) = (lower(low, high), upper(low, high));
    let (mut at_left, mut at_right) = (f(left)?, f(right)?);
    for step in 1..=steps {
        let last = step == steps;
        if at_left < at_right {
            (high, right, at_right) = (right, left, at_left);
            if !last {
                left = lower(low, high);
                at_left = f(left)?;
            }
        } else {
            (low, left, at_left) = (left, right, at_right);
            if !last {
                right = upper(low, high);
                at_right = f(right)?;
            }
        }
    }
    Ok([low, high])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_minimum_stays_in_its_bracket_and_an_error_comes_back() {
        for minimum in [0.0, 0.2, 0.77, 1.0] {
            let mut evaluations = 0;
            let found = golden_section([0.0, 1.0], 20, |x| {
                evaluations += 1;
                Ok::<_, ()>((x - minimum).abs())
            });
            let [low, high] = found.unwrap();
            assert!(low <= minimum && minimum <= high, "{minimum}: {low} {high}");
            assert!(((high - low) / 0.618_034_f64.powi(20) - 1.0).abs() < 1e-4);
            assert_eq!(evaluations, 21);
        }
        assert_eq!(golden_section([0.0, 1.0], 3, |_| Err("no")), Err("no"));
        assert_eq!(golden_section([0.0, 1.0], 0, |_| Err("no")), Ok([0.0, 1.0]));
    }
}
