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
//! Where x > 708, so that B is below 1e-307 of its prefactor 2cν², it is exactly 0, and so are its
//! derivatives; ratios such as B′/B must then be formed from [`log_derivative`].
//!
//! Sources: SI constants (2019); paper S2; exponential after Cody and Waite, 'Software Manual for the
//! Elementary Functions' (1980), with a Taylor polynomial on |r| ≤ ln2/2.

use crate::simd::{dispatched, largest};
use crate::units::{SECOND_RADIATION_CM_K, SECOND_RADIATION_REST_CM_K, SPEED_OF_LIGHT_M_S};

/// 2c in cm s⁻¹ times cm² per m²: turns ν² (cm⁻²) into photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹.
const PREFACTOR: f64 = 2.0 * SPEED_OF_LIGHT_M_S * 1e2 * 1e4;

const LN2_HIGH: f64 = 6.931_471_803_691_238e-1;
const LN2_LOW: f64 = 1.908_214_929_270_587_7e-10;
/// Beyond this, e⁻ˣ is below the smallest normal number and is taken as 0.
const LARGEST_EXPONENT: f64 = 708.0;

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
    let (scale, head) = reduced_exp(-high.min(LARGEST_EXPONENT), -low);
    let (q, p) = (scale.mul_add(head, scale), (-scale).mul_add(head, 1.0 - scale));
    (if high < LARGEST_EXPONENT { q } else { 0.0 }, p)
}

/// e^y − 1 to full relative precision for |y| ≤ [`LARGEST_EXPONENT`].
#[inline(always)]
fn exp_minus_one(y: f64) -> f64 {
    let (scale, head) = reduced_exp(y, 0.0);
    scale.mul_add(head, scale - 1.0)
}

/// (2ᵏ, e^r − 1) with y = k ln2 + r, |r| ≤ ln2/2, for |y| ≤ [`LARGEST_EXPONENT`].
#[inline(always)]
fn reduced_exp(y: f64, correction: f64) -> (f64, f64) {
    // Adding 1.5·2⁵² rounds to the nearest integer without a branch and leaves it in the low bits,
    // from where a shift moves it into the exponent.
    const ROUNDER: f64 = 6_755_399_441_055_744.0 + 1023.0;
    let shifted = y.mul_add(std::f64::consts::LOG2_E, ROUNDER);
    let power = shifted - ROUNDER;
    let scale = f64::from_bits(shifted.to_bits() << 52);
    let r = (-power).mul_add(LN2_LOW, (-power).mul_add(LN2_HIGH, y)) + correction;
    // e^r − 1 = r + r²(1/2! + r/3! + … + r¹¹/13!): the first neglected term is below 2⁻⁵⁵ of r.
    let mut tail: f64 = 1.0 / 6_227_020_800.0;
    for coefficient in [
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
    (scale, (r * r).mul_add(tail, r))
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
    let mut out = ([0.0], [0.0]);
    photon_radiance_and_slope_into(&[wavenumber_cm1], temperature_k, &mut out.0, &mut out.1);
    out.0[0]
}

/// ∂B/∂T in photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹ per K. Error and arguments as [`photon_radiance`].
#[must_use]
pub fn photon_radiance_slope(wavenumber_cm1: f64, temperature_k: f64) -> f64 {
    let mut out = ([0.0], [0.0]);
    photon_radiance_and_slope_into(&[wavenumber_cm1], temperature_k, &mut out.0, &mut out.1);
    out.1[0]
}

/// Photons per mode 1/(eˣ − 1) at wavenumber ν (cm⁻¹) and temperature T (K): how strongly they bunch.
#[must_use]
pub fn occupancy(wavenumber_cm1: f64, temperature_k: f64) -> f64 {
    photon_radiance(wavenumber_cm1, temperature_k) / mode_density(wavenumber_cm1)
}

/// Modes 2cν² per second, m², sr and cm⁻¹, both polarisations: the photon radiance of one photon per mode.
#[must_use]
pub fn mode_density(wavenumber_cm1: f64) -> f64 {
    PREFACTOR * wavenumber_cm1 * wavenumber_cm1
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
#[derive(Debug, Clone, Copy)]
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

/// B and ∂B/∂T at one wavenumber, given hc/kT and 1/T.
#[inline(always)]
fn radiance(wavenumber_cm1: f64, inverse: Double, per_kelvin: f64) -> Radiance {
    let (x, low) = product(wavenumber_cm1, inverse);
    let (q, p) = exp_and_complement(x, low);
    let value = PREFACTOR * wavenumber_cm1 * wavenumber_cm1 * q / p;
    Radiance { value, slope: value * (x * per_kelvin) / p }
}

dispatched! {
    /// B(ν,T) of a whole spectrum into `out` (same length as `wavenumbers_cm1`).
    pub fn photon_radiance_into<'a>(wavenumbers_cm1: &'a [f64], temperature_k: f64, out: &'a mut [f64]) {
        let (inverse, per_kelvin) = (inverse_thermal(temperature_k), 1.0 / temperature_k);
        for (out, &wavenumber) in out.iter_mut().zip(wavenumbers_cm1) {
            *out = radiance(wavenumber, inverse, per_kelvin).value;
        }
    }
}

dispatched! {
    /// B and ∂B/∂T of a whole spectrum.
    pub fn photon_radiance_and_slope_into<'a>(
        wavenumbers_cm1: &'a [f64],
        temperature_k: f64,
        values: &'a mut [f64],
        slopes: &'a mut [f64],
    ) {
        let (inverse, per_kelvin) = (inverse_thermal(temperature_k), 1.0 / temperature_k);
        for ((value, slope), &wavenumber) in values.iter_mut().zip(slopes).zip(wavenumbers_cm1) {
            let at = radiance(wavenumber, inverse, per_kelvin);
            (*value, *slope) = (at.value, at.slope);
        }
    }
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
    let warmer_k = temperature_k + difference_k;
    let inverse = inverse_thermal(warmer_k);
    let delta_per_cm1 = inverse.high * (difference_k / temperature_k);
    if delta_per_cm1.abs() * largest(wavenumbers_cm1) > 30.0 {
        // e^δ may overflow, but then the two radiances have no digit in common to cancel.
        photon_radiance_into(wavenumbers_cm1, warmer_k, out);
        for (out, base) in out.iter_mut().zip(base) {
            *out -= base;
        }
        return;
    }
    near_differences(wavenumbers_cm1, inverse, delta_per_cm1, base, out);
}

/// B(T₀), B(T), ∂B/∂T at T and B(T) − B(T₀) of a whole spectrum, for T within a quarter of T₀.
///
/// Two exponentials per wavenumber instead of three: with E = e^δ − 1, 1 − e⁻ˣ = p₀ − q₀E loses at most
/// two bits where |T − T₀| ≤ T₀/4. The callers' only hot path.
#[derive(Debug)]
pub(crate) struct NearPair<'a> {
    pub(crate) base: &'a mut [f64],
    pub(crate) value: &'a mut [f64],
    pub(crate) slope: &'a mut [f64],
    pub(crate) difference: &'a mut [f64],
}

/// Whether [`near_pair_into`] may be used: B(T) as B(T₀) and the difference loses |x − x₀| in its digits where
/// T < T₀, so that this stays below 2 at the highest wavenumber.
pub(crate) fn is_near_pair(wavenumbers_cm1: &[f64], base_k: f64, temperature_k: f64) -> bool {
    let apart = (temperature_k - base_k).abs() / temperature_k;
    near(base_k, temperature_k) && SECOND_RADIATION_CM_K / base_k * apart * largest(wavenumbers_cm1) <= 2.0
}

/// Whether the difference of two radiances needs a form of its own.
fn near(base_k: f64, temperature_k: f64) -> bool {
    (temperature_k - base_k).abs() <= 0.25 * base_k
}

dispatched! {
    pub(crate) fn near_pair_into<'a>(
        wavenumbers_cm1: &'a [f64],
        base_k: f64,
        temperature_k: f64,
        out: NearPair<'a>,
    ) {
        let inverse = inverse_thermal(base_k);
        let delta_per_cm1 = inverse.high * ((temperature_k - base_k) / temperature_k);
        let x_ratio = base_k / (temperature_k * temperature_k);
        let bands = out.base.iter_mut().zip(out.value).zip(out.slope).zip(out.difference).zip(wavenumbers_cm1);
        for ((((base, value), slope), difference), &wavenumber) in bands {
            let (x, low) = product(wavenumber, inverse);
            let (q, p) = exp_and_complement(x, low);
            let e = exp_minus_one(wavenumber * delta_per_cm1);
            let inverse_p = 1.0 / (-q).mul_add(e, p);
            *base = PREFACTOR * wavenumber * wavenumber * q / p;
            *difference = *base * (e * inverse_p);
            *value = *base + *difference;
            *slope = *value * (x * x_ratio) * inverse_p;
        }
    }
}

/// What [`beside_into`] writes: B(T), ∂B/∂T at T, and B(T₀) − B(T).
#[derive(Debug)]
pub(crate) struct Beside<'a> {
    pub(crate) value: &'a mut [f64],
    pub(crate) slope: &'a mut [f64],
    pub(crate) difference: &'a mut [f64],
}

/// B(T), ∂B/∂T and B(T₀) − B(T) of a whole spectrum by one exponential per wavenumber, given T₀ and B(T₀); all exact to
/// a few ulp however close the two temperatures are.
pub(crate) fn beside_into(
    wavenumbers_cm1: &[f64],
    (base_k, base): (f64, &[f64]),
    temperature_k: f64,
    out: Beside<'_>,
) {
    let delta_per_cm1 = inverse_thermal(base_k).high * ((temperature_k - base_k) / temperature_k);
    if near(base_k, temperature_k) && delta_per_cm1.abs() * largest(wavenumbers_cm1) <= 30.0 {
        near_beside(wavenumbers_cm1, delta_per_cm1, base, temperature_k, out);
    } else {
        // So far apart that no more than two or three bits cancel.
        photon_radiance_and_slope_into(wavenumbers_cm1, temperature_k, out.value, out.slope);
        subtract(base, out.value, out.difference);
    }
}

dispatched! {
    /// With M = 2cν² and n₀ = B(T₀)/M photons per mode, 1/(1 − e⁻ˣ) = (1 + n₀)/(1 − n₀E) = (M + B₀)/(M − B₀E),
    /// and B = B₀(E + 1)M/(M − B₀E).
    fn near_beside<'a>(
        wavenumbers_cm1: &'a [f64],
        delta_per_cm1: f64,
        base: &'a [f64],
        temperature_k: f64,
        out: Beside<'a>,
    ) {
        let x_ratio = SECOND_RADIATION_CM_K / (temperature_k * temperature_k);
        let spectra = out.value.iter_mut().zip(out.slope).zip(out.difference);
        for (((value, slope), difference), (&wavenumber, base)) in spectra.zip(wavenumbers_cm1.iter().zip(base)) {
            let (scale, head) = reduced_exp(wavenumber * delta_per_cm1, 0.0);
            // E, and E + 1 with all its digits where E is nearly −1.
            let (e, grown) = (scale.mul_add(head, scale - 1.0), scale.mul_add(head, scale));
            let modes = PREFACTOR * wavenumber * wavenumber;
            let share = 1.0 / (-base).mul_add(e, modes);
            let inverse_p = (modes + base) * share;
            let warmer = base * (e * inverse_p);
            *value = base * grown * (modes * share);
            *slope = *value * (wavenumber * x_ratio) * inverse_p;
            *difference = -warmer;
        }
    }
}

dispatched! {
    fn subtract<'a>(a: &'a [f64], b: &'a [f64], out: &'a mut [f64]) {
        for ((out, a), b) in out.iter_mut().zip(a).zip(b) {
            *out = a - b;
        }
    }
}

dispatched! {
    fn near_differences<'a>(
        wavenumbers_cm1: &'a [f64],
        inverse: Double,
        delta_per_cm1: f64,
        base: &'a [f64],
        out: &'a mut [f64],
    ) {
        for ((out, base), &wavenumber) in out.iter_mut().zip(base).zip(wavenumbers_cm1) {
            let (x, low) = product(wavenumber, inverse);
            let (_, p) = exp_and_complement(x, low);
            *out = base * exp_minus_one(wavenumber * delta_per_cm1) / p;
        }
    }
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

    #[test]
    fn beside_agrees_with_the_radiances_themselves() {
        let nu: Vec<f64> = (0..2000).map(|i| 5.0 + 5.0 * f64::from(i)).collect();
        for (base_k, t) in
            [(333.15, 333.15), (333.15, 333.150_001), (300.0, 250.0), (300.0, 374.0), (4.0, 4.9)]
                .into_iter()
                .chain([(300.0, 40.0), (300.0, 1e5), (0.2, 0.24), (300.0, 375.1)])
        {
            let zeros = || vec![0.0; nu.len()];
            let (mut base, mut value, mut slope, mut difference) = (zeros(), zeros(), zeros(), zeros());
            photon_radiance_into(&nu, base_k, &mut base);
            let out = Beside { value: &mut value, slope: &mut slope, difference: &mut difference };
            beside_into(&nu, (base_k, &base), t, out);
            let mut colder = zeros();
            photon_radiance_difference_into(&nu, t, base_k - t, &value, &mut colder);
            for (i, &nu) in nu.iter().enumerate() {
                // As much as x shifts by a rounding error of the temperatures; nothing where B underflows.
                let tolerance = 1e-15 * (3.0 + SECOND_RADIATION_CM_K * nu / t.min(base_k));
                let close = |a: f64, b: f64| (a - b).abs() <= tolerance * b.abs() + 1e-280;
                assert!(close(value[i], photon_radiance(nu, t)), "{base_k} {t} {nu}");
                assert!(close(slope[i], photon_radiance_slope(nu, t)), "{base_k} {t} {nu}");
                assert!(
                    close(difference[i], colder[i]),
                    "{base_k} {t} {nu}: {} {}",
                    difference[i],
                    colder[i]
                );
            }
        }
    }

    /// Where one exponential serves two temperatures, both radiances are those of their own: also for a
    /// target much colder than its surroundings at high wavenumbers, where B(T) is a small part of B(T₀).
    #[test]
    fn a_near_pair_keeps_the_digits_of_the_colder_radiance() {
        let nu: Vec<f64> = (1..=60).map(|i| 100.0 * f64::from(i)).collect();
        let mut used = 0;
        for (base_k, t) in [(300.0, 250.0), (300.0, 280.0), (300.0, 299.0), (293.15, 310.15), (400.0, 301.0)]
        {
            for nu in nu.chunks(3) {
                if !is_near_pair(nu, base_k, t) {
                    continue;
                }
                used += 1;
                let zeros = || vec![0.0; nu.len()];
                let (mut base, mut value, mut slope, mut difference) = (zeros(), zeros(), zeros(), zeros());
                let out = NearPair {
                    base: &mut base,
                    value: &mut value,
                    slope: &mut slope,
                    difference: &mut difference,
                };
                near_pair_into(nu, base_k, t, out);
                for (i, &nu) in nu.iter().enumerate() {
                    let exact = photon_radiance(nu, t);
                    let tolerance = 2e-16 * (10.0 + SECOND_RADIATION_CM_K * nu / t);
                    assert!((value[i] / exact - 1.0).abs() <= tolerance, "{base_k} {t} {nu}");
                }
            }
        }
        assert!(used > 50);
    }
}
