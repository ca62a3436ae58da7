//! Photon radiance of a blackbody and its differences, at full relative precision.
//!
//! B(ν,T) = 2cν²/(eˣ − 1), x = hcν/kT: photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹, both polarisations, ν in cm⁻¹.
//! With q = e⁻ˣ and p = 1 − e⁻ˣ everything needed is free of overflow and cancellation:
//!
//! * B = 2cν² q/p,   ∂B/∂T = B·x/(T p);
//! * B(T) − B(T₀) = 2cν² q₀ E/(p p₀), with E = e^δ − 1 and δ = hcν(T − T₀)/(k T T₀), so that nothing is lost
//!   as T → T₀.
//!
//! x is formed as an unevaluated sum of two doubles (hc/k to 32 digits, Dekker products by fused
//! multiply-add): a rounding error of x alone would cost x·u in B. Assumption: none beyond Planck's law.
//! Where B is below about 1e-300 of the prefactor it underflows gradually to exactly 0, and so do its
//! derivatives; ratios such as B′/B must then be formed from [`log_derivative`].
//!
//! Sources: SI constants (2019); paper S2; exponential after Cody and Waite, 'Software Manual for the
//! Elementary Functions' (1980), with a Taylor polynomial on |r| ≤ ln2/2.

use crate::units::{SECOND_RADIATION_CM_K, SECOND_RADIATION_REST_CM_K, SPEED_OF_LIGHT_M_S};

/// 2c in cm s⁻¹ times cm² per m²: turns ν² (cm⁻²) into photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹.
const PREFACTOR: f64 = 2.0 * SPEED_OF_LIGHT_M_S * 1e2 * 1e4;

const LN2_HIGH: f64 = 6.931_471_803_691_238e-1;
const LN2_LOW: f64 = 1.908_214_929_270_587_7e-10;
/// Beyond this, e⁻ˣ is below the smallest subnormal.
const LARGEST_EXPONENT: f64 = 746.0;

/// A number as the sum of two doubles, the second below half an ulp of the first.
#[derive(Debug, Clone, Copy)]
struct Double {
    high: f64,
    low: f64,
}

/// hc/(kT), in cm.
fn inverse_thermal(temperature_k: f64) -> Double {
    let high = SECOND_RADIATION_CM_K / temperature_k;
    let rest = (-high).mul_add(temperature_k, SECOND_RADIATION_CM_K) + SECOND_RADIATION_REST_CM_K;
    Double { high, low: rest / temperature_k }
}

/// e⁻ˣ and 1 − e⁻ˣ, both to full relative precision, for x = high + low ≥ 0.
#[inline(always)]
fn exp_and_complement(high: f64, low: f64) -> (f64, f64) {
    let (power, head) = reduced_exp(-high.min(LARGEST_EXPONENT), -low);
    // 2^k in two factors, so that the result may be subnormal.
    let (first, second) = powers_of_two(power);
    let q = (first + first * head) * second;
    let scale = first * second;
    let p = (1.0 - scale) - scale * head;
    (q, p)
}

/// e^y − 1 to full relative precision for |y| up to the exponent range.
#[inline(always)]
fn exp_minus_one(y: f64) -> f64 {
    let (power, head) = reduced_exp(y.clamp(-LARGEST_EXPONENT, 700.0), 0.0);
    let (first, second) = powers_of_two(power);
    let scale = first * second;
    (scale - 1.0) + scale * head
}

/// (k, e^r − 1) with y = k ln2 + r, |r| ≤ ln2/2.
#[inline(always)]
fn reduced_exp(y: f64, correction: f64) -> (f64, f64) {
    // Adding and subtracting 1.5·2⁵² rounds to the nearest integer without a branch.
    const ROUNDER: f64 = 6_755_399_441_055_744.0;
    let power = y.mul_add(std::f64::consts::LOG2_E, ROUNDER) - ROUNDER;
    let r = (-power).mul_add(LN2_LOW, (-power).mul_add(LN2_HIGH, y)) + correction;
    // e^r − 1 = r + r²(1/2! + r/3! + … + r¹²/14!): the first neglected term is below 2⁻⁶⁰ of r.
    let mut tail: f64 = 1.0 / 87_178_291_200.0;
    for coefficient in [
        1.0 / 6_227_020_800.0,
        1.0 / 479_001_600.0,
        1.0 / 39_916_800.0,
        1.0 / 3_628_800.0,
        1.0 / 362_880.0,
        1.0 / 40_320.0,
        1.0 / 5_040.0,
        1.0 / 720.0,
        1.0 / 120.0,
        1.0 / 24.0,
        1.0 / 6.0,
        0.5,
    ] {
        tail = tail.mul_add(r, coefficient);
    }
    (power, (r * r).mul_add(tail, r))
}

/// 2^k as a product of two normal doubles, |k| ≤ 2000, without a branch or a table.
#[inline(always)]
fn powers_of_two(power: f64) -> (f64, f64) {
    const ROUNDER: f64 = 6_755_399_441_055_744.0;
    let half = (power * 0.5 + ROUNDER) - ROUNDER;
    (exact_power(half), exact_power(power - half))
}

#[inline(always)]
fn exact_power(power: f64) -> f64 {
    // The integer sits in the low bits of power + 1.5·2⁵²; shifting it into the exponent makes 2^power.
    const ROUNDER: f64 = 6_755_399_441_055_744.0 + 1023.0;
    f64::from_bits((power + ROUNDER).to_bits() << 52)
}

/// Photon radiance B(ν,T), photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹, at wavenumber ν (cm⁻¹) and temperature T (K).
///
/// Relative error below 2e-16·(10 + x); exactly 0 where B underflows. Both arguments must be positive.
///
/// ```
/// let radiance = hadar::planck::photon_radiance(1000.0, 300.0);
/// assert!((radiance / 4.9964e18 - 1.0).abs() < 1e-2);
/// ```
#[must_use]
pub fn photon_radiance(wavenumber_cm1: f64, temperature_k: f64) -> f64 {
    let mut out = [Radiance::default()];
    evaluate(&[wavenumber_cm1], temperature_k, |_, radiance| out[0] = radiance);
    out[0].value
}

/// ∂B/∂T in photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹ per K. Error and arguments as [`photon_radiance`].
#[must_use]
pub fn photon_radiance_slope(wavenumber_cm1: f64, temperature_k: f64) -> f64 {
    let mut out = [Radiance::default()];
    evaluate(&[wavenumber_cm1], temperature_k, |_, radiance| out[0] = radiance);
    out[0].slope
}

/// ∂ln B/∂T in K⁻¹: x/(T(1 − e⁻ˣ)), well defined also where B itself underflows.
#[must_use]
pub fn log_derivative(wavenumber_cm1: f64, temperature_k: f64) -> f64 {
    let inverse = inverse_thermal(temperature_k);
    let (x, low) = product(wavenumber_cm1, inverse);
    let (_, p) = exp_and_complement(x, low);
    x / (temperature_k * p)
}

/// B and ∂B/∂T at one wavenumber.
#[derive(Debug, Clone, Copy, Default)]
struct Radiance {
    value: f64,
    slope: f64,
}

#[inline(always)]
fn product(wavenumber_cm1: f64, inverse: Double) -> (f64, f64) {
    let high = wavenumber_cm1 * inverse.high;
    let low = wavenumber_cm1.mul_add(inverse.high, -high) + wavenumber_cm1 * inverse.low;
    (high, low)
}

#[inline(always)]
fn evaluate(wavenumbers_cm1: &[f64], temperature_k: f64, mut put: impl FnMut(usize, Radiance)) {
    let inverse = inverse_thermal(temperature_k);
    let per_kelvin = 1.0 / temperature_k;
    for (i, &wavenumber) in wavenumbers_cm1.iter().enumerate() {
        let (x, low) = product(wavenumber, inverse);
        let (q, p) = exp_and_complement(x, low);
        let value = PREFACTOR * wavenumber * wavenumber * q / p;
        put(i, Radiance { value, slope: value * (x * per_kelvin) / p });
    }
}

/// B(ν,T) of a whole spectrum into `out` (same length as `wavenumbers_cm1`).
pub fn photon_radiance_into(wavenumbers_cm1: &[f64], temperature_k: f64, out: &mut [f64]) {
    let n = wavenumbers_cm1.len().min(out.len());
    let (wavenumbers, out) = (&wavenumbers_cm1[..n], &mut out[..n]);
    pulp::Arch::new().dispatch(
        #[inline(always)]
        || evaluate(wavenumbers, temperature_k, |i, radiance| out[i] = radiance.value),
    );
}

/// B and ∂B/∂T of a whole spectrum.
pub fn photon_radiance_and_slope_into(
    wavenumbers_cm1: &[f64],
    temperature_k: f64,
    values: &mut [f64],
    slopes: &mut [f64],
) {
    let n = wavenumbers_cm1.len().min(values.len()).min(slopes.len());
    let (wavenumbers, values, slopes) = (&wavenumbers_cm1[..n], &mut values[..n], &mut slopes[..n]);
    pulp::Arch::new().dispatch(
        #[inline(always)]
        || {
            evaluate(wavenumbers, temperature_k, |i, radiance| {
                values[i] = radiance.value;
                slopes[i] = radiance.slope;
            });
        },
    );
}

/// B(T₀ + ΔT) − B(T₀) of a whole spectrum, given B(T₀) as `base`; exact to a few ulp however small ΔT is.
///
/// B(T₀ + ΔT) − B(T₀) = B(T₀)·E/(1 − e⁻ˣ), with x at T₀ + ΔT and E = e^δ − 1, δ = hcν ΔT/(k T T₀).
pub fn photon_radiance_difference_into(
    wavenumbers_cm1: &[f64],
    temperature_k: f64,
    difference_k: f64,
    base: &[f64],
    out: &mut [f64],
) {
    let n = wavenumbers_cm1.len().min(base.len()).min(out.len());
    let (wavenumbers, base, out) = (&wavenumbers_cm1[..n], &base[..n], &mut out[..n]);
    let warmer_k = temperature_k + difference_k;
    let inverse = inverse_thermal(warmer_k);
    let delta_per_cm1 = inverse.high * (difference_k / temperature_k);
    let direct = delta_per_cm1.abs() * wavenumbers.iter().copied().fold(0.0, f64::max) > 30.0;
    pulp::Arch::new().dispatch(
        #[inline(always)]
        || {
            if direct {
                // e^δ may overflow, but then the two radiances have no digit in common to cancel.
                evaluate(wavenumbers, warmer_k, |i, radiance| out[i] = radiance.value - base[i]);
                return;
            }
            for i in 0..n {
                let (x, low) = product(wavenumbers[i], inverse);
                let (_, p) = exp_and_complement(x, low);
                out[i] = base[i] * exp_minus_one(wavenumbers[i] * delta_per_cm1) / p;
            }
        },
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_exponential_agrees_with_the_standard_library() {
        // std's exp and exp_m1 are good to 1 ulp; ours adds about as much.
        for i in 0..20_000 {
            let x = 0.000_37 * f64::from(i) * f64::from(i % 97 + 1);
            let (q, p) = exp_and_complement(x, 0.0);
            if x < 700.0 {
                assert!((q / (-x).exp() - 1.0).abs() < 5e-16, "{x}");
            }
            if x > 0.0 {
                assert!((p / -(-x).exp_m1() - 1.0).abs() < 5e-16, "{x}");
                let y = x.min(600.0);
                assert!((exp_minus_one(y) / y.exp_m1() - 1.0).abs() < 5e-16, "{y}");
                assert!((exp_minus_one(-y) / (-y).exp_m1() - 1.0).abs() < 5e-16, "{y}");
            }
        }
    }

    #[test]
    fn limits_of_rayleigh_jeans_and_of_underflow() {
        // hν ≪ kT: B → 2cν k T/(h c) = PREFACTOR ν T/c₂, next order −x/2.
        let (nu, t) = (1e-6, 300.0);
        let x = SECOND_RADIATION_CM_K * nu / t;
        let classical = PREFACTOR * nu * t / SECOND_RADIATION_CM_K * (1.0 - x / 2.0);
        assert!((photon_radiance(nu, t) / classical - 1.0).abs() < 1e-15);
        assert_eq!(photon_radiance(1e5, 1.0), 0.0);
        assert_eq!(photon_radiance_slope(1e5, 1.0), 0.0);
        assert!((log_derivative(1e5, 1.0) / (1e5 * SECOND_RADIATION_CM_K) - 1.0).abs() < 1e-15);
    }

    #[test]
    fn photon_exitance_of_the_whole_spectrum() {
        // π ∫B dν = 4π ζ(3) c (kT/hc)³... = 1.520 460 e15 T³ photons s⁻¹ m⁻² (Planck's law integrated).
        let t = 300.0;
        let step = 0.5;
        let sum: f64 = (1..20_000).map(|i| photon_radiance(step * f64::from(i), t) * step).sum();
        let zeta3 = 1.202_056_903_159_594_2;
        let exact = PREFACTOR * 2.0 * zeta3 * (t / SECOND_RADIATION_CM_K).powi(3);
        assert!((sum / exact - 1.0).abs() < 1e-6, "{sum} {exact}");
    }

    #[test]
    fn differences_keep_their_digits_at_equilibrium() {
        let nu: Vec<f64> = (0..536).map(|i| 715.0 + f64::from(i)).collect();
        let (t0, mut base, mut slope) = (293.15, vec![0.0; 536], vec![0.0; 536]);
        photon_radiance_and_slope_into(&nu, t0, &mut base, &mut slope);
        let mut difference = vec![0.0; 536];
        for exponent in -40..=-20 {
            let dt = 2f64.powi(exponent);
            photon_radiance_difference_into(&nu, t0, dt, &base, &mut difference);
            for (difference, slope) in difference.iter().zip(&slope) {
                // The next term of the Taylor series is below ΔT·x/(2T) ≈ 0.03 ΔT of the first.
                assert!((difference / (slope * dt) - 1.0).abs() < 1e-15 + 0.03 * dt);
            }
        }
        for dt in [-250.0, -100.0, 1.0, 500.0, 1e5] {
            photon_radiance_difference_into(&nu, t0, dt, &base, &mut difference);
            for (i, difference) in difference.iter().enumerate() {
                let direct = photon_radiance(nu[i], t0 + dt) - base[i];
                assert!((difference / direct - 1.0).abs() < 2e-13, "{dt} {i}");
            }
        }
    }
}
