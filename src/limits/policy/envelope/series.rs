//! Planck's function as a polynomial of the temperature, with a bound on what the polynomial leaves.
//!
//! B ∝ q/(1 − q), q = e⁻ˣ, x = c₂ν/T. With T = T_c(1 + τ) and n = 1/(eˣ − 1) at T_c,
//!
//! q/q_c = 1 + p₁τ + p₂τ² + p₃τ³ + …,  p₁ = x,  p₂ = x²/2 − x,  p₃ = x³/6 − x² + x,
//! B/B_c = 1 + (1+n){p₁τ + (p₂ + n p₁²)τ² + (p₃ + 2n p₁p₂ + n²p₁³)τ³} + …
//!
//! Remainder: B is analytic in the disc |z − T_c| ≤ R < T_c of the complex plane, and Re(1/z) ≥ 1/(T_c + R) there, so
//! that |B(z)| ≤ 2cν²/(e^{Re x} − 1) ≤ B(T_c + R). By Cauchy's estimate the terms from τ⁴ on are, for |T − T_c| ≤ h < R, at
//! most B(T_c + R)(h/R)⁴/(1 − h/R).

use crate::planck;
use crate::simd::dispatched;
use crate::units::SECOND_RADIATION_CM_K;

/// Coefficients of a cubic in t, |t| ≤ 1.
pub(super) const TERMS: usize = 4;

/// B and the coefficients of t, t², t³ at the nodes `nu_cm1`, T = `centre_k` + t·`half_k`.
pub(super) fn planck_series(nu_cm1: &[f64], centre_k: f64, half_k: f64) -> [Vec<f64>; TERMS] {
    let mut terms = [(); TERMS].map(|()| vec![0.0; nu_cm1.len()]);
    planck::photon_radiance_into(nu_cm1, centre_k, &mut terms[0]);
    terms_into(nu_cm1, centre_k, half_k / centre_k, terms.each_mut().map(|term| &mut term[..]));
    terms
}

dispatched! {
    /// The coefficients of t, t², t³ from B, which stands in the first place: n is B over the density of modes.
    fn terms_into<'a>(nu_cm1: &'a [f64], centre_k: f64, share: f64, terms: [&'a mut [f64]; TERMS]) {
        let per_mode = planck::mode_density(1.0);
        let [value, first, second, third] = terms;
        let out = value.iter().zip(first).zip(second.iter_mut().zip(third));
        for (nu, ((value, first), (second, third))) in nu_cm1.iter().zip(out) {
            let x = SECOND_RADIATION_CM_K * nu / centre_k;
            let n = value / (per_mode * nu * nu);
            let (p1, p2, p3) = (x, x * (0.5 * x - 1.0), x * (x * (x / 6.0 - 1.0) + 1.0));
            let scale = value * (1.0 + n);
            *first = scale * p1 * share;
            *second = scale * (p2 + n * p1 * p1) * share * share;
            *third = scale * (p3 + 2.0 * n * p1 * p2 + n * n * p1 * p1 * p1) * share * share * share;
        }
    }
}

/// (h/R)⁴/(1 − h/R): what the remainder is of the value at T_c + R; infinite unless h < R.
pub(super) fn remainder(half_k: f64, reach_k: f64) -> f64 {
    let ratio = half_k / reach_k;
    if ratio < 1.0 { ratio.powi(4) / (1.0 - ratio) } else { f64::INFINITY }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cubic_and_its_remainder_enclose_the_radiance() {
        for nu in [10.0, 300.0, 715.0, 1250.0, 5000.0] {
            for (centre, half) in [(300.0, 20.0), (300.0, 1.0), (60.0, 4.0), (2000.0, 100.0)] {
                let [a, b, c, d] = planck_series(&[nu], centre, half).map(|term| term[0]);
                let mut worst = 0.0f64;
                for step in -10..=10 {
                    let t = 0.1 * f64::from(step);
                    let exact = planck::photon_radiance(nu, centre + t * half);
                    worst = worst.max((exact - (a + t * (b + t * (c + t * d)))).abs());
                }
                let bound = [0.2, 0.5, 0.9]
                    .map(|share| {
                        planck::photon_radiance(nu, centre * (1.0 + share)) * remainder(half, share * centre)
                    })
                    .into_iter()
                    .fold(f64::INFINITY, f64::min);
                assert!(worst <= bound + 1e-14 * a, "{nu} {centre} {half}: {worst} {bound}");
                // The bound is of the right order of smallness: a wrong coefficient would leave far more than it.
                if nu / centre < 5.0 {
                    assert!(bound < 0.01 * a, "{nu} {centre} {half}: {bound} {a}");
                }
            }
        }
    }
}
