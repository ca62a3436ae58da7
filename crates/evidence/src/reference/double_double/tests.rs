use super::*;
use crate::reference::Extended;

fn extended(value: DoubleDouble) -> Extended {
    Extended::from(value.high) + Extended::from(value.low)
}

fn close(found: DoubleDouble, exact: &Extended, bound: f64) {
    let error = extended(found).relative_error_to(exact);
    assert!(error <= bound, "{found:?}: {error:e}");
}

/// Every operation against 512 bits, at numbers that are themselves of two doubles.
#[test]
fn operations_keep_thirty_digits() {
    let mut fraction = 0.123_456_789_f64;
    let mut next = || {
        fraction = (fraction * 997.123_456_789).fract();
        fraction
    };
    for i in 0..2000 {
        let value = |next: &mut dyn FnMut() -> f64| {
            let high = (next() - 0.5) * 10f64.powi(i % 61 - 30);
            ordered_sum(high, high * f64::EPSILON * 0.4 * next())
        };
        let (a, b) = (value(&mut next), value(&mut next));
        close(a * b, &(extended(a) * extended(b)), 1e-31);
        close(a / b, &(extended(a) / extended(b)), 1e-31);
        // A sum that cancels keeps its digits as far as its terms have them.
        close(a + b, &(extended(a) + extended(b)), 1e-31);
        let nearly = ordered_sum(-a.high, a.high * f64::EPSILON * 0.3 * next());
        close(a + nearly, &(extended(a) + extended(nearly)), 1e-30);
        close(a.magnitude().root(), &extended(a).abs().sqrt(), 1e-31);
    }
}

#[test]
fn exponentials_and_logarithms_keep_their_digits() {
    for i in -400..400 {
        let x = ordered_sum(1.7 * f64::from(i), 1e-17 * f64::from(i));
        close(x.exponential(), &extended(x).exp(), 3e-29);
        let small = DoubleDouble::from(1e-6 * f64::from(i));
        if i != 0 {
            let exact = extended(small).exp() - Extended::one();
            close(small.exponential_less_one(), &exact, 1e-27);
        }
    }
    for x in [1e-200, 1e-3, 0.7, 1.5, 310.15, 1e6] {
        close(DoubleDouble::from(x).logarithm(), &Extended::from(x).ln(), 1e-29);
    }
}
