//! The second derivative of the heat signal along the temperature of the surface.
//!
//! S_TT = G e B″ with B″ = (B′/T)(2TB′/B − x − 2), x = hcν/kT: from B and B′, which are known already. The other second
//! derivatives need nothing of their own: S is linear in V, and S_gj = S_j for the logarithm g of the gain.

use crate::simd::dispatched;
use crate::units::SECOND_RADIATION_CM_K;

/// What [`curvature_into`] reads and writes, at the nodes ν (cm⁻¹).
pub(super) struct Curvature<'a> {
    pub(super) nu: &'a [f64],
    pub(super) temperature_k: f64,
    pub(super) gain: f64,
    pub(super) emissivity: &'a [f64],
    /// B and ∂B/∂T.
    pub(super) value: &'a [f64],
    pub(super) slope: &'a [f64],
    pub(super) out: &'a mut [f64],
}

dispatched! {
    /// G e B″(T), from B and B′; 0 where B underflows.
    pub(super) fn curvature_into<'a>(spectra: Curvature<'a>) {
        let Curvature { nu, temperature_k, gain, emissivity, value, slope, out } = spectra;
        let per_kelvin = 1.0 / temperature_k;
        let radiance = value.iter().zip(slope);
        for (((out, nu), e), (value, slope)) in out.iter_mut().zip(nu).zip(emissivity).zip(radiance) {
            let x = SECOND_RADIATION_CM_K * nu * per_kelvin;
            let relative = if *value > 0.0 { temperature_k * slope / value } else { 0.0 };
            *out = gain * e * (slope * per_kelvin) * (2.0 * relative - x - 2.0);
        }
    }
}
