//! Emissivity and surroundings from one surface at several temperatures.
//!
//! A surface of emissivity e under surroundings of radiance X sends S = e B(T) + (1 − e) X (S53). Its readings C_i at temperatures T_i lie on
//! the line a B + b with a = R e, b = R (1 − e) X + ξ; blackbodies give the line R B + ξ. Hence (S57, S58)
//!
//! e = a/R,   X = the radiance at which the two lines meet: C̄ + R (X − B̄) = C̄_s + a (X − B̄_s),
//!
//! bars the weighted means of blackbodies and of the surface. With the least squares of [`super::blackbody`] for both lines
//!
//! de = (da − e dR)/R,   dX = [dC̄_s + (X − B̄_s) da − dC̄ − (X − B̄) dR]/(R − a):
//!
//! errors of R and ξ go into both, so that e and X are correlated through them. Errors of temperatures: da = Σ h_i a B′_i δ_i and so on, u
//! of the surface as stated, that of the blackbodies after all channels ([`super::blackbody::Bound`]).
//!
//! An emissivity that changes with temperature, e(T) = e + e′ (T − T_w), makes of two temperatures
//!
//! ê − e = e′ [(T₁ − T_w)(B₁ − X) − (T₂ − T_w)(B₂ − X)]/(B₁ − B₂):
//!
//! for T₁ → T₂ = T_w this is e′ (B − X)/B′ and not 0, however close the temperatures are. It is 0 where (B₁ + B₂)/2 = X, T_w in the
//! middle: temperatures on both sides of the surroundings' ([`bias`]).
//!
//! Units as in [`super::blackbody`]; e 1, e′ K⁻¹. Assumptions: as there; the surroundings stay the same.

use super::blackbody::{Blackbodies, Bound, Parts};
use crate::planck;

/// Emissivity and surroundings in a channel, with their errors.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Surface {
    /// Errors of the emissivity in two parts, 0 to 1.
    pub emissivity: Parts,
    /// Of the radiance of the surroundings.
    pub surroundings: Parts,
    /// Covariance of the errors of emissivity and surroundings.
    pub covariance: f64,
}

/// What stands in a channel: response R, emissivity e and radiance of the surroundings X.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Truth {
    /// R.
    pub response: f64,
    /// e, below 1.
    pub emissivity: f64,
    /// X.
    pub surroundings: f64,
}

/// Errors of e and X in a channel, the surface read at the temperatures of `readings`, whose uncertainties are those of its temperatures.
#[must_use]
pub fn errors(
    blackbodies: (&Blackbodies, &Bound),
    readings: &Blackbodies,
    channel: usize,
    truth: Truth,
) -> Surface {
    let (of, bound) = blackbodies;
    let (black, own) = (&of.channels()[channel], &readings.channels()[channel]);
    let Truth { response, emissivity, surroundings } = truth;
    let a = emissivity * response;
    // Noise: da, dR, dC̄_s, dC̄ are uncorrelated.
    let apart = response - a;
    let (off, off_own) = (surroundings - black.mean_radiance, surroundings - own.mean_radiance);
    let e_noise = (own.var_response + emissivity.powi(2) * black.var_response) / response.powi(2);
    let x_noise = (own.var_centre
        + off_own.powi(2) * own.var_response
        + black.var_centre
        + off.powi(2) * black.var_response)
        / apart.powi(2);
    let both_noise =
        (off_own * own.var_response + emissivity * off * black.var_response) / (response * apart);
    // Temperatures: what each δ moves.
    let e_own = own.moved(own.gain.iter().map(|h| emissivity * h));
    let x_own = own.moved(own.leverages(surroundings).map(|l| a * l / apart));
    let e_black = black.moved(black.gain.iter().map(|h| -emissivity * h));
    let x_black = black.moved(black.leverages(surroundings).map(|l| -response * l / apart));
    let product = |x: &[f64], y: &[f64]| -> f64 {
        let u = readings.unknowns().iter().map(|one| one.deviation);
        x.iter().zip(y).zip(u).map(|((x, y), u)| x * y * u * u).sum()
    };
    let common = |x: &[f64], y: &[f64]| bound.whitened(of, x).dot(&bound.whitened(of, y));
    Surface {
        emissivity: Parts {
            var_noise: e_noise,
            var_temperature: product(&e_own, &e_own) + common(&e_black, &e_black),
        },
        surroundings: Parts {
            var_noise: x_noise,
            var_temperature: product(&x_own, &x_own) + common(&x_black, &x_black),
        },
        covariance: both_noise + product(&e_own, &x_own) + common(&e_black, &x_black),
    }
}

/// ê − e(T_w) of two temperatures in a channel at a wavenumber (cm⁻¹), for an emissivity that changes by `slope_per_k`.
#[must_use]
pub fn bias(
    wavenumber_cm1: f64,
    temperatures_k: [f64; 2],
    wanted_k: f64,
    slope_per_k: f64,
    surroundings: f64,
) -> f64 {
    let [first, second] = temperatures_k;
    let base = planck::photon_radiance(wavenumber_cm1, second);
    let mut apart = [0.0];
    planck::photon_radiance_difference_into(&[wavenumber_cm1], second, first - second, &[base], &mut apart);
    // (T₁ − T_w)(B₁ − B₂) + (T₁ − T₂)(B₂ − X), without a difference of products.
    slope_per_k * ((first - wanted_k) + (first - second) * (base - surroundings) / apart[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against derivatives by differences of the formulas as the paper has them.
    #[test]
    fn errors_are_those_of_the_papers_formulas() {
        let nu = 950.0;
        let (black_k, own_k) = ([285.0, 345.0], [300.0, 320.0]);
        let (r, xi, e) = (2e-18, 0.7, 0.85);
        let x = planck::photon_radiance(nu, 265.0);
        let b = |t: f64| planck::photon_radiance(nu, t);
        let make = |t: [f64; 2], u: [f64; 2], sigma: [f64; 2]| {
            Blackbodies::new(&[nu], t.to_vec(), u.to_vec(), &[vec![sigma[0]], vec![sigma[1]]]).unwrap()
        };
        let of = make(black_k, [0.03, 0.06], [2e-3, 3e-3]);
        let own = make(own_k, [0.05, 0.02], [4e-3, 1e-3]);
        let bound = of.bound(&[r]).unwrap();
        let found = errors((&of, &bound), &own, 0, Truth { response: r, emissivity: e, surroundings: x });
        // S55 to S58, of readings and of what the temperatures are taken for.
        let formula = |off: [f64; 8]| -> [f64; 2] {
            let c = |t: f64, e: f64| r * (e * b(t) + (1.0 - e) * x) + xi;
            let [c1, c2] = [c(black_k[0] + off[4], 1.0) + off[0], c(black_k[1] + off[5], 1.0) + off[1]];
            let [s1, s2] = [c(own_k[0] + off[6], e) + off[2], c(own_k[1] + off[7], e) + off[3]];
            let response = (c1 - c2) / (b(black_k[0]) - b(black_k[1]));
            let offset = c1 - response * b(black_k[0]);
            let [s1, s2] = [(s1 - offset) / response, (s2 - offset) / response];
            let e = (s1 - s2) / (b(own_k[0]) - b(own_k[1]));
            [e, (s2 - e * b(own_k[1])) / (1.0 - e)]
        };
        let deviations = [2e-3, 3e-3, 4e-3, 1e-3, 0.03, 0.06, 0.05, 0.02];
        let mut expected = [0.0; 5];
        for (i, deviation) in deviations.iter().enumerate() {
            let mut off = [0.0; 8];
            let step = deviation * 1e-3;
            off[i] = step;
            let up = formula(off);
            off[i] = -step;
            let down = formula(off);
            let [de, dx] = [0, 1].map(|j| (up[j] - down[j]) / 2e-3);
            let part = if i < 4 { 0 } else { 1 };
            expected[part] += de * de;
            expected[2 + part] += dx * dx;
            expected[4] += de * dx;
        }
        let ours = [
            found.emissivity.var_noise,
            found.emissivity.var_temperature,
            found.surroundings.var_noise,
            found.surroundings.var_temperature,
            found.covariance,
        ];
        for (ours, expected) in ours.iter().zip(expected) {
            assert!((ours / expected - 1.0).abs() < 1e-5, "{ours} {expected}");
        }
    }

    /// By the formula of two temperatures, and what it becomes where these meet.
    #[test]
    fn close_temperatures_do_not_take_the_bias_away() {
        let (nu, slope, e) = (950.0, 1e-4, 0.9);
        let x = planck::photon_radiance(nu, 270.0);
        let b = |t: f64| planck::photon_radiance(nu, t);
        let sent = |t: f64, wanted: f64| {
            let e = e + slope * (t - wanted);
            e * b(t) + (1.0 - e) * x
        };
        let [t1, t2, wanted] = [330.0, 300.0, 310.0];
        let direct = (sent(t1, wanted) - sent(t2, wanted)) / (b(t1) - b(t2)) - e;
        assert!((bias(nu, [t1, t2], wanted, slope, x) / direct - 1.0).abs() < 1e-9);
        let close = bias(nu, [300.0005, 299.9995], 300.0, slope, x);
        let limit = slope * (b(300.0) - x) / planck::photon_radiance_slope(nu, 300.0);
        assert!((close / limit - 1.0).abs() < 1e-6, "{close} {limit}");
        assert!(limit > 1e-3);
    }
}
