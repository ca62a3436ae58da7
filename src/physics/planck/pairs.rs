//! Radiances of two temperatures and their difference, exact to a few ulp however close the two are.
//!
//! With E = e^δ − 1 and δ = hcν(T − T₀)/(k T T₀) the second radiance follows from the first by one exponential of a
//! small number; each function says how far apart the temperatures may be.

use super::exponential::{
    Double, exp_and_complement, exp_minus_one, inverse_thermal, inverse_thermal_of, product, reduced_exp,
};
use super::{PREFACTOR, Radiance, photon_radiance_and_slope_into, radiance};
use crate::simd::{dispatched, largest};
use crate::units::SECOND_RADIATION_CM_K;

/// |δ| beyond which two radiances have no digit in common.
const ALIKE: f64 = 30.0;
/// hcν/kT up to which no radiance is 0 for want of smaller numbers.
const DARK: f64 = 700.0;

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
    let warmer = Double::sum(temperature_k, difference_k);
    let difference = Double { high: difference_k, low: 0.0 };
    differences_into(wavenumbers_cm1, (temperature_k, base), warmer, difference, out);
}

/// B(T) − B(T₀) of a whole spectrum, given T₀ and B(T₀): as [`photon_radiance_difference_into`], of the very temperatures.
pub(crate) fn photon_radiance_apart_into(
    wavenumbers_cm1: &[f64],
    base: (f64, &[f64]),
    temperature_k: f64,
    out: &mut [f64],
) {
    let difference = Double::sum(temperature_k, -base.0);
    differences_into(wavenumbers_cm1, base, Double { high: temperature_k, low: 0.0 }, difference, out);
}

/// B(T) − B(T₀), given T₀ and B(T₀), T and T − T₀.
fn differences_into(
    wavenumbers_cm1: &[f64],
    (base_k, base): (f64, &[f64]),
    temperature: Double,
    difference: Double,
    out: &mut [f64],
) {
    let inverse = inverse_thermal_of(temperature);
    let delta_per_cm1 = inverse.times(difference.over(base_k));
    let highest = largest(wavenumbers_cm1);
    if delta_per_cm1.high.abs() * highest <= ALIKE {
        near_differences(wavenumbers_cm1, inverse, delta_per_cm1, base, out);
        if SECOND_RADIATION_CM_K * highest > DARK * base_k {
            let spectra = out.iter_mut().zip(base).zip(wavenumbers_cm1);
            for ((out, _), &wavenumber) in spectra.filter(|((_, base), _)| **base == 0.0) {
                *out = from_dark(wavenumber, inverse, delta_per_cm1);
            }
        }
        return;
    }
    // e^δ may overflow at the highest wavenumbers, where the two radiances have no digit in common to cancel; at the
    // lowest they may have all.
    for ((out, base), &wavenumber) in out.iter_mut().zip(base).zip(wavenumbers_cm1) {
        *out = if *base == 0.0 {
            from_dark(wavenumber, inverse, delta_per_cm1)
        } else if (wavenumber * delta_per_cm1.high).abs() <= ALIKE {
            base * growth(wavenumber, inverse, delta_per_cm1)
        } else {
            let Radiance { value, .. } = radiance(wavenumber, inverse, 0.0);
            value - base
        };
    }
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
    let x = SECOND_RADIATION_CM_K / base_k * largest(wavenumbers_cm1);
    near(base_k, temperature_k) && x * apart <= 2.0 && x <= DARK
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
            let e = exp_minus_one(wavenumber * delta_per_cm1, 0.0);
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
    if !near(base_k, temperature_k) {
        // So far apart that no more than two or three bits cancel.
        photon_radiance_and_slope_into(wavenumbers_cm1, temperature_k, out.value, out.slope);
        subtract(base, out.value, out.difference);
        return;
    }
    let delta_per_cm1 =
        inverse_thermal(base_k).times(Double::sum(temperature_k, -base_k).over(temperature_k));
    let highest = largest(wavenumbers_cm1);
    if delta_per_cm1.high.abs() * highest <= ALIKE && SECOND_RADIATION_CM_K * highest <= DARK * base_k {
        near_beside(wavenumbers_cm1, delta_per_cm1, base, temperature_k, out);
        return;
    }
    // The highest wavenumbers have no digit in common, or B(T₀) is dark; the lowest may have all.
    let inverse = inverse_thermal(temperature_k);
    let Beside { value, slope, difference } = out;
    for (i, (&wavenumber, &base)) in wavenumbers_cm1.iter().zip(base).enumerate() {
        if base > 0.0 && (wavenumber * delta_per_cm1.high).abs() <= ALIKE {
            let one = i..i + 1;
            let out = Beside {
                value: &mut value[one.clone()],
                slope: &mut slope[one.clone()],
                difference: &mut difference[one],
            };
            near_beside(&[wavenumber], delta_per_cm1, &[base], temperature_k, out);
            continue;
        }
        let at = radiance(wavenumber, inverse, 1.0 / temperature_k);
        (value[i], slope[i]) = (at.value, at.slope);
        difference[i] =
            if base > 0.0 { base - at.value } else { -of_dark(at.value, wavenumber, delta_per_cm1) };
    }
}

dispatched! {
    /// With M = 2cν² and n₀ = B(T₀)/M photons per mode, 1/(1 − e⁻ˣ) = (1 + n₀)/(1 − n₀E) = (M + B₀)/(M − B₀E),
    /// and B = B₀(E + 1)M/(M − B₀E).
    fn near_beside<'a>(
        wavenumbers_cm1: &'a [f64],
        delta_per_cm1: Double,
        base: &'a [f64],
        temperature_k: f64,
        out: Beside<'a>,
    ) {
        let x_ratio = SECOND_RADIATION_CM_K / (temperature_k * temperature_k);
        let spectra = out.value.iter_mut().zip(out.slope).zip(out.difference);
        for (((value, slope), difference), (&wavenumber, base)) in spectra.zip(wavenumbers_cm1.iter().zip(base)) {
            let (y, low) = product(wavenumber, delta_per_cm1);
            let (scale, head) = reduced_exp(y, low);
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
        delta_per_cm1: Double,
        base: &'a [f64],
        out: &'a mut [f64],
    ) {
        for ((out, base), &wavenumber) in out.iter_mut().zip(base).zip(wavenumbers_cm1) {
            *out = base * growth(wavenumber, inverse, delta_per_cm1);
        }
    }
}

/// [`of_dark`], of a radiance that is not known yet.
fn from_dark(wavenumber_cm1: f64, inverse: Double, delta_per_cm1: Double) -> f64 {
    of_dark(radiance(wavenumber_cm1, inverse, 0.0).value, wavenumber_cm1, delta_per_cm1)
}

/// B(T) − B(T₀) where B(T₀) is dark, which B(T) need not be: B(T)(1 − e⁻ᵟ), as far in the Wien tail as both are.
fn of_dark(value: f64, wavenumber_cm1: f64, delta_per_cm1: Double) -> f64 {
    if value > 0.0 { -value * (-wavenumber_cm1 * delta_per_cm1.high).exp_m1() } else { 0.0 }
}

/// E/(1 − e⁻ˣ).
#[inline(always)]
fn growth(wavenumber_cm1: f64, inverse: Double, delta_per_cm1: Double) -> f64 {
    let (x, low) = product(wavenumber_cm1, inverse);
    let (_, p) = exp_and_complement(x, low);
    let (y, low) = product(wavenumber_cm1, delta_per_cm1);
    exp_minus_one(y, low) / p
}

#[cfg(test)]
mod tests {
    use super::super::{photon_radiance, photon_radiance_into, photon_radiance_slope};
    use super::*;

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

    /// The colder radiance may be below all numbers where the warmer is not: 2cν²e⁻ˣ of the one, and the difference by the
    /// logarithms of both.
    #[test]
    fn what_is_warmer_than_dark_is_not_dark() {
        let (nu, t0) = ([1000.0, 1999.0], 4.02);
        for t in [4.08, 4.1, 4.5, 4.9] {
            let (mut base, mut apart) = ([0.0; 2], [[0.0; 2]; 3]);
            photon_radiance_into(&nu, t0, &mut base);
            assert!(base[0] > 0.0 && base[1] == 0.0, "{base:?}");
            let [direct, value, difference] = &mut apart;
            photon_radiance_apart_into(&nu, (t0, &base), t, direct);
            let mut slope = [0.0; 2];
            beside_into(&nu, (t0, &base), t, Beside { value, slope: &mut slope, difference });
            assert!(!is_near_pair(&nu, t0, t));
            for (i, &nu) in nu.iter().enumerate() {
                let x = |t: f64| SECOND_RADIATION_CM_K * nu / t;
                let warm = (PREFACTOR * nu * nu).ln() - x(t);
                let delta = x(t0) - x(t);
                let expected = (warm + (-(-delta).exp_m1()).ln()).exp();
                // ln of 1e-300 has an ulp of 1e-13, and a temperature's last digit shifts x by as much.
                let close = |a: f64, b: f64| (a - b).abs() <= 1e-11 * b;
                assert!(expected > 1e-308, "{nu} {t}");
                assert!(close(apart[0][i], expected), "{nu} {t}: {:e} {expected:e}", apart[0][i]);
                assert!(close(apart[1][i], warm.exp()), "{nu} {t}: {:e}", apart[1][i]);
                assert!(close(-apart[2][i], expected), "{nu} {t}: {:e} {expected:e}", apart[2][i]);
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
