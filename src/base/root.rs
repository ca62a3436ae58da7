//! Where an increasing function crosses zero.

use crate::error::{Error, Result};

/// Share of the value at one end below which the value at the other is zero but for rounding.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Share of x below which a step of Newton's method is the last one.
const STEP: f64 = 1e-8;

/// Where an increasing function of x crosses zero, to the last few bits of x. An end where it is zero but for rounding is the
/// crossing.
///
/// # Errors
/// An error of `f`, or ends that do not bracket the crossing.
pub fn crossing(low: f64, high: f64, mut f: impl FnMut(f64) -> Result<f64>) -> Result<f64> {
    let (at_low, at_high) = (f(low)?, f(high)?);
    crossing_between([low, at_low], [high, at_high], f)
}

/// The same where the function is known at both ends, each as x and value: what has decided that there is a crossing is not
/// computed again, and cannot come out differently.
///
/// # Errors
/// As [`crossing`].
pub fn crossing_between(low: [f64; 2], high: [f64; 2], mut f: impl FnMut(f64) -> Result<f64>) -> Result<f64> {
    // Chandrupatla's method: inverse quadratic interpolation where it is safe, else bisection
    // (Adv. Eng. Softw. 28, 145 (1997), doi:10.1016/S0965-9978(96)00051-8).
    let ([mut a, mut fa], [mut b, mut fb]) = (low, high);
    let nothing = |value: f64, other: f64| value.abs() <= ROUNDING * other.abs() && other.is_finite();
    if fa == 0.0 || fb == 0.0 {
        return Ok(if fa == 0.0 { a } else { b });
    }
    if !(fa < 0.0 && fb > 0.0) {
        if nothing(fa, fb) || nothing(fb, fa) {
            return Ok(if fa.abs() <= fb.abs() { a } else { b });
        }
        let found = format!("what is solved for is {fa} and {fb} at the ends of all that is looked at");
        return Err(Error::malformed(found, "bring the figures nearer to those of a camera and a scene"));
    }
    let (mut c, mut fc);
    let mut share = 0.5;
    for _ in 0..200 {
        let x = a + share * (b - a);
        let fx = f(x)?;
        if (fx < 0.0) == (fa < 0.0) {
            (c, fc) = (a, fa);
        } else {
            (c, fc, b, fb) = (b, fb, a, fa);
        }
        (a, fa) = (x, fx);
        let (best, f_best) = if fa.abs() < fb.abs() { (a, fa) } else { (b, fb) };
        let tolerance = 2.0 * f64::EPSILON * best.abs() + f64::MIN_POSITIVE;
        let share_least = tolerance / (b - a).abs();
        if share_least > 0.5 || f_best == 0.0 {
            return Ok(best);
        }
        let (xi, phi) = ((a - b) / (c - b), (fa - fb) / (fc - fb));
        share = if phi * phi < xi && (1.0 - phi) * (1.0 - phi) < 1.0 - xi {
            fa / (fb - fa) * (fc / (fb - fc)) + (c - a) / (b - a) * (fa / (fc - fa)) * (fb / (fc - fb))
        } else {
            0.5
        };
        share = share.clamp(share_least, 1.0 - share_least);
    }
    Ok(if fa.abs() < fb.abs() { a } else { b })
}

/// Where an increasing function crosses zero between `low` and `high`, from `start` on by Newton's method, by halves where that leads
/// out: `f` gives value and slope. An end where it does not cross.
pub fn crossing_by_newton(low: f64, high: f64, start: f64, f: impl Fn(f64) -> [f64; 2]) -> f64 {
    let ([mut low, mut high], mut x) = ([low, high], start);
    for _ in 0..200 {
        let [value, slope] = f(x);
        *(if value < 0.0 { &mut low } else { &mut high }) = x;
        let newton = x - value / slope;
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        if value == 0.0 {
            break;
        }
        // The last step squares what it is short of.
        let is_there = (next - x).abs() <= STEP * x.abs();
        x = next;
        if is_there {
            break;
        }
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn newton_finds_what_halving_does() {
        for root in [1e-9, 0.25, 0.5, 1.0 - 1e-6] {
            // Of one curvature, of two, and with poles at the ends.
            let cube = |x: f64| [(x - root).powi(3) + 1e-3 * (x - root), 3.0 * (x - root).powi(2) + 1e-3];
            let poles = |x: f64| {
                let at = |x: f64| 1.0 / (1.0 - x) - 1.0 / x;
                [at(x) - at(root), 1.0 / (1.0 - x).powi(2) + 1.0 / (x * x)]
            };
            for found in [crossing_by_newton(0.0, 1.0, 0.5, cube), crossing_by_newton(0.0, 1.0, 0.5, poles)] {
                assert!((found / root - 1.0).abs() < 1e-9, "{found} {root}");
            }
        }
        assert!(crossing_by_newton(0.0, 1.0, 0.5, |x| [x + 1.0, 1.0]) < 1e-15);
    }

    #[test]
    fn crossings_are_found_to_the_last_bits() {
        for root in [-3.7, 1e-9, 0.25, 12.0] {
            let x = crossing(-20.0, 20.0, |x| Ok((x - root).powi(3) + 1e-3 * (x - root))).unwrap();
            assert!((x - root).abs() <= 1e-15 * root.abs() + 1e-15, "{x} {root}");
        }
        assert!(crossing(0.0, 1.0, |x| Ok(x + 1.0)).is_err());
    }

    #[test]
    fn an_end_that_is_zero_but_for_rounding_is_the_crossing() {
        let last_bits = 5.551115123125783e-16;
        assert_eq!(crossing_between([-69.0, -51.18], [2.5, -last_bits], Ok).unwrap(), 2.5);
        assert_eq!(crossing_between([-3.0, last_bits], [1.0, 51.18], Ok).unwrap(), -3.0);
        // Short of zero by more than rounding is no crossing, also of a function that is small everywhere.
        assert!(crossing_between([-69.0, -51.18], [2.5, -1e-12], Ok).is_err());
        assert!(crossing_between([-69.0, -3.0 * last_bits], [2.5, -last_bits], Ok).is_err());
        assert!(crossing_between([-69.0, f64::NEG_INFINITY], [2.5, -1.0], Ok).is_err());
    }
}
