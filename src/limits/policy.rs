//! Bounds turned into requirements: what a camera must have for a task.
//!
//! A task demands a statistical distance d_req. Its photons come from N = Φ·(π/4)·η·t A_p/F² for a far
//! target (S7), Φ = ΣS the photon radiance, so that d = √(N/(1+γ))·d₀ ≥ d_req reads
//!
//! H = t A_p/((1 + γ)F²) ≥ H_req = d_req²/(d₀² Φ π/4)      (lossless optics)
//!
//! That inequality is a shortcut: γ spreads the electronic noise over the bands as the photons are, and
//! takes d₀ as it is without noise. Verdicts and solutions use the exact distance at the camera's noise
//! instead, re-evaluated at every trial value ([`solve`]), so a flicker floor shows as
//! 'no exposure is long enough'.
//!
//! Source: paper, Methods 'Guiding public policy'; S7, S27, S29; γ = γ₀ + γ₁N.

pub mod caps;
pub mod elasticity;
pub mod encounter;
pub mod envelope;
pub mod motion;
pub mod practice;
pub mod solve;
pub mod stand_in;
pub mod stop;
pub mod trade_off;

pub use motion::Motion;
pub use solve::{CameraTask, Cap, CapCode, Quantity, Solution, Trial};
pub use trade_off::TradeOff;

use std::f64::consts::FRAC_PI_4;

/// Photons needed for a statistical distance of `required` at a distance d₀ per √photon, shot noise only;
/// `None` where d₀ is 0 and no number of photons suffices.
///
/// ```
/// let photons = hadar::policy::photons_required(1.0, 8.85216582834686e-4).unwrap();
/// assert!((photons / 1.276e6 - 1.0).abs() < 1e-3);
/// ```
#[must_use]
pub fn photons_required(required: f64, distance_per_sqrt_photon: f64) -> Option<f64> {
    let ratio = required / distance_per_sqrt_photon;
    (distance_per_sqrt_photon > 0.0 && ratio.is_finite()).then_some(ratio * ratio)
}

/// H_req in m² s for `photons` needed from a scene of photon radiance Φ (photons s⁻¹ m⁻² sr⁻¹).
#[must_use]
pub fn hardware_required_m2_s(photons: f64, photon_radiance: f64) -> f64 {
    photons / (photon_radiance * FRAC_PI_4)
}

/// The least distance d₀ that a camera with N photons and noise ratio γ resolves: d_req √((1+γ)/N).
#[must_use]
pub fn least_distance(required: f64, photons: f64, gamma: f64) -> f64 {
    required * ((1.0 + gamma) / photons).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_inequality_of_the_paper() {
        // d₀ and Φ of the human-robot scene to 30 digits; the paper prints ≥ 5e-16.
        let photons = photons_required(1.0, 8.852_165_828_346_861e-4).unwrap();
        let hardware = hardware_required_m2_s(photons, 3.376_641_989_197_634e21);
        assert!((hardware / 4.81e-16 - 1.0).abs() < 1e-3, "{hardware}");
        assert_eq!(photons_required(1.0, 0.0), None);
        // Literal inputs of the paper for the bolometer: 0.0158 (reproduction of its 0.0078).
        let least = (hardware / 1.53e-18).sqrt() * 8.852e-4;
        assert!((least / 0.0157 - 1.0).abs() < 0.01);
    }
}
