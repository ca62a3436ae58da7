//! Where a condition begins to be met.

/// The first number on the way from one end, where the condition is not met, to the other, where it is, that meets it; by
/// halving down to neighbouring doubles.
pub(super) fn crossing([mut outside, mut inside]: [f64; 2], mut met: impl FnMut(f64) -> bool) -> f64 {
    loop {
        let (small, large) = (outside.min(inside), outside.max(inside));
        // In the logarithm where the ends are far apart.
        let middle = if small > 0.0 && large > 4.0 * small {
            (small * large).sqrt()
        } else {
            small + 0.5 * (large - small)
        };
        if middle <= small || middle >= large {
            return inside;
        }
        if met(middle) {
            inside = middle;
        } else {
            outside = middle;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_crossing_is_found_to_the_last_bit_from_either_side() {
        let root = crossing([0.0, 10.0], |x| x * x >= 2.0);
        assert!((root - 2.0_f64.sqrt()).abs() <= f64::EPSILON * 2.0, "{root}");
        assert_eq!(crossing([1e12, 1e-9], |x| x <= 0.125), 0.125);
        assert_eq!(crossing([0.0, 1e9], |x| x.floor() >= 17.0), 17.0);
    }
}
