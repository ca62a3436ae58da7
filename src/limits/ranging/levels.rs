//! What an image of grey levels tells, beside the counts that it was made of.
//!
//! A pixel of Gaussian noise σ about the mean N is shown as level k where its count is between two edges, b_k ≤ n < b_{k+1}. Whatever
//! rising map f made the level, it is these edges that matter: those of the level's ends under f⁻¹. With a_k = (b_k − N)/σ the level
//! has the probability p_k = Φ(a_{k+1}) − Φ(a_k), and of the information 1/σ² of the count itself there is the share
//!
//! s = Σ_k [φ(a_k) − φ(a_{k+1})]²/p_k ≤ 1
//!
//! left. A map without levels leaves all of it: it steepens the image and its noise alike. Fine steps Δ leave 1/(1 + Δ²/12σ²), two
//! levels with their edge at the mean 2/π.
//!
//! Assumptions: f is known and does not follow the noise of the pixel itself (an equalisation's curve is that of many pixels).
//!
//! Source: elementary; the inequality is the data processing inequality of Fisher information.

use libm::{erfc, exp};
use std::f64::consts::{FRAC_1_SQRT_2, TAU};

/// Edges farther from the mean than this, in σ, are not looked at: what is beyond is less than 1e-15.
const FAR: f64 = 8.0;

/// The share of the information about `mean` that is left once a count of deviation `sigma` is shown in levels between `edges`, which
/// rise. NaN for a mean or edge that is no number, and without noise.
///
/// ```
/// use hadar::ranging::levels::share_left;
/// assert!((share_left(5.0, 2.0, &[5.0]) - std::f64::consts::FRAC_2_PI).abs() < 1e-14);
/// assert_eq!(share_left(5.0, 2.0, &[]), 0.0);
/// ```
#[must_use]
pub fn share_left(mean: f64, sigma: f64, edges: &[f64]) -> f64 {
    if !(mean.is_finite() && sigma > 0.0) || edges.iter().any(|edge| edge.is_nan()) {
        return f64::NAN;
    }
    let (first, last) = (mean - FAR * sigma, mean + FAR * sigma);
    let near = edges.partition_point(|edge| *edge < first)..edges.partition_point(|edge| *edge <= last);
    let Some(near) = edges.get(near) else { return 0.0 };
    let mut left = 0.0;
    let mut before = f64::NEG_INFINITY;
    for edge in near.iter().copied().chain([f64::INFINITY]) {
        let after = (edge - mean) / sigma;
        let p = between(before, after);
        let difference = density(before) - density(after);
        if p > 0.0 {
            left += difference * difference / p;
        }
        before = after;
    }
    left.min(1.0)
}

/// φ.
fn density(a: f64) -> f64 {
    if a.is_finite() { exp(-0.5 * a * a) / TAU.sqrt() } else { 0.0 }
}

/// Φ(b) − Φ(a), of the tail where both are small.
fn between(a: f64, b: f64) -> f64 {
    let above = |a: f64| 0.5 * erfc(a * FRAC_1_SQRT_2);
    if a > 0.0 { above(a) - above(b) } else { above(-b) - above(-a) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn steps(from: f64, step: f64, count: usize) -> Vec<f64> {
        (0..count).map(|k| (k as f64).mul_add(step, from)).collect()
    }

    /// Sheppard: steps of Δ add the variance Δ²/12, wherever the mean lies, up to terms that fall off as exp(−2π²σ²/Δ²).
    #[test]
    fn fine_steps_add_a_twelfth_of_their_square() {
        for (step, places) in [(0.25, 7), (0.5, 7), (1.0, 7)] {
            for place in 0..places {
                let mean = 100.0 + step * f64::from(place) / 7.0;
                let found = share_left(mean, 1.0, &steps(90.0, step, 81));
                assert!(
                    (found * (1.0 + step * step / 12.0) - 1.0).abs() < 4e-3 * step.powi(4),
                    "{step} {place}"
                );
            }
        }
    }

    /// Two levels: φ(a)²/[Φ(a)Φ(−a)], by another way of writing Φ.
    #[test]
    fn two_levels_have_a_closed_form() {
        for a in [-3.0, -1.0, 0.0, 0.5, 2.0] {
            let phi = (-0.5 * f64::powi(a, 2)).exp() / TAU.sqrt();
            let above = 0.5 * (1.0 - libm::erf(a * FRAC_1_SQRT_2));
            let expected = phi * phi / (above * (1.0 - above));
            let found = share_left(7.0, 0.5, &[7.0 + 0.5 * a]);
            assert!((found / expected - 1.0).abs() < 1e-12, "{a}: {found} {expected}");
        }
    }

    /// Fewer edges never tell more, and all shares lie between 0 and 1, also far from all edges.
    #[test]
    fn joining_levels_loses() {
        let mut state = 7_u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        for _ in 0..400 {
            let mut edges: Vec<f64> = (0..12).map(|_| 20.0 * next() - 10.0).collect();
            edges.sort_by(f64::total_cmp);
            let (mean, sigma) = (30.0 * next() - 15.0, 0.05 + 3.0 * next());
            let all = share_left(mean, sigma, &edges);
            edges.remove(5);
            let fewer = share_left(mean, sigma, &edges);
            assert!((0.0..=1.0).contains(&all) && fewer <= all + 1e-12, "{fewer} {all}");
        }
        assert_eq!(share_left(0.0, 1.0, &[20.0]), 0.0);
        assert!(share_left(0.0, 0.0, &[0.0]).is_nan() && share_left(0.0, 1.0, &[f64::NAN]).is_nan());
    }
}
