//! What each band adds to the negative log-likelihood, and its derivatives along the signal of the band.
//!
//! With N = κS mean counts, n counts, r = n − N and v the variance, per band:
//!
//! * Poisson: n ln(n/N) − r; derivatives along N −r/N and n/N², the latter N⁻¹ on average;
//! * Gaussian: ½(r²/v + ln v), v = N + σ²; −r/v − ½r²/v² + ½/v and 1/v + 2r/v² + r²/v³ − ½/v², on average 1/v + ½/v²;
//! * negative binomial: n ln(n/N) − (n + m) ln[(n + m)/(N + m)], v = N(1 + N/m); −r/v and
//!   n/N² − (n + m)/(N + m)², on average 1/v.
//!
//! Poisson and negative binomial are thus counted from the likelihood of means equal to the counts, and their
//! logarithms are formed as ln(1 + r/N): the terms stay of order 1 near the truth however many photons there are, and
//! their rounding errors of order u√N. (Gaussian terms are so by themselves.)

use crate::aligned::Aligned;
use crate::simd::dispatched;
use crate::statistics::Statistics;
use crate::sum;
use std::f64::consts::LN_2;

/// Means and variances are not taken below this, so that nothing divides by 0.
const SMALLEST: f64 = 1e-100;

/// Loss and derivatives of every band at a candidate state.
#[derive(Debug, Clone)]
pub(crate) struct Terms {
    loss: Aligned,
    /// ∂loss/∂S.
    pub(super) pull: Aligned,
    /// ∂²loss/∂S² on average and for the counts at hand.
    pub(super) expected: Aligned,
    pub(super) observed: Aligned,
}

impl Terms {
    pub(crate) fn new(bands: usize) -> Self {
        let band = Aligned::zeros(bands);
        Self { loss: band.clone(), pull: band.clone(), expected: band.clone(), observed: band }
    }

    /// Computes them for mean counts κ·`signal`; returns the negative log-likelihood of all bands.
    pub(crate) fn evaluate(
        &mut self,
        statistics: &Statistics,
        counts_per_radiance: f64,
        signal: &[f64],
        counts: &[f64],
    ) -> f64 {
        let bands = BandTerms {
            scale: counts_per_radiance,
            signal,
            counts,
            loss: &mut self.loss,
            pull: &mut self.pull,
            expected: &mut self.expected,
            observed: &mut self.observed,
        };
        match statistics {
            Statistics::Poisson => poisson(bands),
            Statistics::Gaussian { var_added } => gaussian(bands, var_added),
            Statistics::NegativeBinomial { modes } => negative_binomial(bands, modes),
        }
        sum::sum(&self.loss)
    }
}

struct BandTerms<'a> {
    scale: f64,
    signal: &'a [f64],
    counts: &'a [f64],
    loss: &'a mut [f64],
    pull: &'a mut [f64],
    expected: &'a mut [f64],
    observed: &'a mut [f64],
}

dispatched! {
    fn poisson<'a>(bands: BandTerms<'a>) {
        let BandTerms { scale, signal, counts, loss, pull, expected, observed } = bands;
        let square = scale * scale;
        let out = loss.iter_mut().zip(pull).zip(expected.iter_mut().zip(observed));
        for (((loss, pull), (expected, observed)), (signal, n)) in out.zip(signal.iter().zip(counts)) {
            let mean = at_least(scale * signal);
            let inverse = 1.0 / mean;
            let off = n - mean;
            let relative = off * inverse;
            *loss = n.mul_add(ln_1p(relative), -off);
            *pull = -scale * relative;
            *expected = square * inverse;
            *observed = square * n * inverse * inverse;
        }
    }
}

dispatched! {
    fn gaussian<'a>(bands: BandTerms<'a>, var_added: &'a [f64]) {
        let BandTerms { scale, signal, counts, loss, pull, expected, observed } = bands;
        let square = scale * scale;
        let out = loss.iter_mut().zip(pull).zip(expected.iter_mut().zip(observed));
        let given = signal.iter().zip(counts).zip(var_added);
        for (((loss, pull), (expected, observed)), ((signal, n), var)) in out.zip(given) {
            let mean = scale * signal;
            let variance = at_least(mean + var);
            let inverse = 1.0 / variance;
            let off = n - mean;
            let relative = off * inverse;
            *loss = 0.5 * off.mul_add(relative, ln(variance));
            *pull = -scale * (relative + 0.5 * (relative * relative - inverse));
            *expected = square * inverse * 0.5f64.mul_add(inverse, 1.0);
            let bend = 2.0 * relative + relative * relative - 0.5 * inverse;
            *observed = square * inverse * (1.0 + bend);
        }
    }
}

dispatched! {
    fn negative_binomial<'a>(bands: BandTerms<'a>, modes: &'a [f64]) {
        let BandTerms { scale, signal, counts, loss, pull, expected, observed } = bands;
        let square = scale * scale;
        let out = loss.iter_mut().zip(pull).zip(expected.iter_mut().zip(observed));
        let given = signal.iter().zip(counts).zip(modes);
        for (((loss, pull), (expected, observed)), ((signal, n), m)) in out.zip(given) {
            let mean = at_least(scale * signal);
            let (inverse, with_modes) = (1.0 / mean, 1.0 / (mean + m));
            let off = n - mean;
            let precision = m * inverse * with_modes;
            *loss = n * ln_1p(off * inverse) - (n + m) * ln_1p(off * with_modes);
            *pull = -scale * (off * precision);
            *expected = square * precision;
            *observed = square * (n * inverse * inverse - (n + m) * with_modes * with_modes);
        }
    }
}

#[inline(always)]
fn at_least(value: f64) -> f64 {
    if value > SMALLEST { value } else { SMALLEST }
}

const ONE_BITS: u64 = 0x3ff0_0000_0000_0000;
/// √½, rounded down.
const ROOT_HALF_BITS: u64 = 0x3fe6_a09e_667f_3bcc;
const MANTISSA: u64 = 0x000f_ffff_ffff_ffff;
/// 2⁵², whose low bits hold an integer.
const INTEGER_BITS: u64 = 0x4330_0000_0000_0000;
/// 2⁵² and the bias of the exponent.
const INTEGER: f64 = 4_503_599_627_370_496.0 + 1023.0;

/// (k, f) of x = 2ᵏf with √½ ≤ f < √2, for a normal x > 0; finite nonsense for others.
#[inline(always)]
fn split(x: f64) -> (f64, f64) {
    let bits = x.to_bits().wrapping_add(ONE_BITS - ROOT_HALF_BITS);
    let power = f64::from_bits((bits >> 52) | INTEGER_BITS) - INTEGER;
    (power, f64::from_bits((bits & MANTISSA) + ROOT_HALF_BITS))
}

/// ln(1 + t) for √½ − 1 ≤ t < √2 − 1, as t − s(t − R) with s = t/(2 + t) and R = Σ 2s²ⁱ/(2i + 1).
#[inline(always)]
fn ln_near_one(t: f64) -> f64 {
    let s = t / (2.0 + t);
    let z = s * s;
    // |z| < 0.0295: the first neglected term is below 2⁻⁵⁴ of R.
    let mut tail: f64 = 2.0 / 21.0;
    for divisor in [19.0, 17.0, 15.0, 13.0, 11.0, 9.0, 7.0, 5.0, 3.0] {
        tail = tail.mul_add(z, 2.0 / divisor);
    }
    (-s).mul_add((-z).mul_add(tail, t), t)
}

/// ln(1 + x) to a few ulp for x > −1; finite at x = −1.
#[inline(always)]
fn ln_1p(x: f64) -> f64 {
    let (power, f) = split(1.0 + x);
    // Near 0 the sum 1 + x has lost digits that x has.
    let t = if power == 0.0 { x } else { f - 1.0 };
    power.mul_add(LN_2, ln_near_one(t))
}

/// ln x to a few ulp of max(1, |ln x|) for a normal x > 0.
#[inline(always)]
fn ln(x: f64) -> f64 {
    let (power, f) = split(x);
    power.mul_add(LN_2, ln_near_one(f - 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn logarithms_agree_with_those_of_the_standard_library() {
        for i in -4000..4000 {
            let x = 10_f64.powf(f64::from(i) / 50.0);
            assert!((ln(x) - x.ln()).abs() <= 4e-16 * x.ln().abs().max(1.0), "{x:e}");
            for x in [x, -x] {
                if x > -1.0 {
                    let exact = x.ln_1p();
                    assert!(
                        (ln_1p(x) - exact).abs() <= 5e-16 * exact.abs(),
                        "{x:e} {:e} {exact:e}",
                        ln_1p(x)
                    );
                }
            }
        }
        assert!(ln_1p(-1.0).is_finite());
    }

    /// The likelihoods of [`Statistics`], up to what depends on the counts alone.
    #[test]
    fn differences_of_loss_are_those_of_the_likelihoods() {
        let laws = [
            Statistics::Poisson,
            Statistics::gaussian(vec![3.0]).unwrap(),
            Statistics::negative_binomial(vec![2.5]).unwrap(),
        ];
        let mut terms = Terms::new(1);
        for law in &laws {
            for count in [0.0, 1.0, 7.0, 40.0] {
                let mut loss = |mean: f64| terms.evaluate(law, 0.5, &[2.0 * mean], &[count]);
                let difference = loss(6.0) - loss(11.0);
                let exact = law.log_likelihood(0, count, 11.0) - law.log_likelihood(0, count, 6.0);
                assert!((difference - exact).abs() < 1e-13 * exact.abs().max(1.0), "{law:?} {count}");
            }
        }
    }

    /// Against the exact value in a form that does not cancel: at n = N + √N, n ln(n/N) − r = ½ − 1/(6√N) + …
    #[test]
    fn losses_of_many_photons_keep_their_digits() {
        for exponent in [6, 9, 12, 15] {
            let mean = 10_f64.powi(exponent);
            let root = mean.sqrt();
            let loss = Terms::new(1).evaluate(&Statistics::Poisson, 1.0, &[mean], &[mean + root]);
            let series = 0.5 - 1.0 / (6.0 * root) + 1.0 / (12.0 * mean);
            assert!((loss - series).abs() < 1e-15 * root + 1.0 / (19.0 * mean * root), "{mean:e} {loss}");
        }
    }

    /// Derivatives against central differences, and their averages against the counts' moments.
    #[test]
    fn derivatives_agree_with_differences() {
        let laws = [
            Statistics::Poisson,
            Statistics::gaussian(vec![3.0]).unwrap(),
            Statistics::negative_binomial(vec![2.5]).unwrap(),
        ];
        for law in &laws {
            for count in [0.0, 5.0, 40.0] {
                let at = |signal: f64| {
                    let mut terms = Terms::new(1);
                    let loss = terms.evaluate(law, 0.5, &[signal], &[count]);
                    (loss, terms.pull[0], terms.observed[0])
                };
                let (h, s) = (1e-5, 21.0);
                let (below, above) = (at(s - h), at(s + h));
                let slope = (above.0 - below.0) / (2.0 * h);
                let bend = (above.1 - below.1) / (2.0 * h);
                assert!((at(s).1 - slope).abs() < 1e-8, "{law:?} {count}");
                assert!((at(s).2 - bend).abs() < 1e-9, "{law:?} {count}");
            }
            // Both second derivatives are linear or quadratic in the count: two counts at N ± √v average
            // them exactly.
            let (mean, root) = (10.5, law.variance(0, 10.5).sqrt());
            let mut terms = Terms::new(1);
            let mut average = 0.0;
            for count in [mean - root, mean + root] {
                terms.evaluate(law, 0.5, &[2.0 * mean], &[count]);
                average += 0.5 * terms.observed[0];
            }
            assert!((average / terms.expected[0] - 1.0).abs() < 1e-13, "{law:?}");
        }
    }
}
