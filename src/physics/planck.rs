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

mod exponential;
mod pairs;
mod tabulated;

pub use pairs::photon_radiance_difference_into;
pub(crate) use pairs::{
    Beside, NearPair, beside_into, is_near_pair, near_pair_into, photon_radiance_apart_into,
};
pub use tabulated::Tabulated;

use self::exponential::{Double, exp_and_complement, inverse_thermal, product};
use crate::simd::dispatched;
use crate::units::{SECOND_RADIATION_CM_K, SPEED_OF_LIGHT_M_S};

/// 2c in cm s⁻¹ times cm² per m²: turns ν² (cm⁻²) into photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹.
const PREFACTOR: f64 = 2.0 * SPEED_OF_LIGHT_M_S * 1e2 * 1e4;

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

/// Temperature (K) of the blackbody that sends the photon radiance `radiance` at wavenumber ν (cm⁻¹); 0 for none.
///
/// ```
/// use hadar::planck::{brightness_temperature, photon_radiance};
/// assert!((brightness_temperature(900.0, photon_radiance(900.0, 310.0)) / 310.0 - 1.0).abs() < 1e-14);
/// ```
#[must_use]
pub fn brightness_temperature(wavenumber_cm1: f64, radiance: f64) -> f64 {
    SECOND_RADIATION_CM_K * wavenumber_cm1 / libm::log1p(mode_density(wavenumber_cm1) / radiance)
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

#[cfg(test)]
mod tests {
    use super::*;

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
}
