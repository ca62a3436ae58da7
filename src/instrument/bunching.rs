//! Photon bunching: how much more the counts of thermal light scatter than those of independent photons.
//!
//! * variance of N counts in m modes: N(1 + N/m) (S12), so that bunching adds N × N/m; m → ∞ is Poisson (S13);
//! * N/m = η × photons per mode, η efficiency of optics and detector: a photon radiance (s⁻¹ m⁻² sr⁻¹ per cm⁻¹) over the
//!   density 2cν² of the modes, both polarisations. Photons lost at random leave m as it is and take their share off N
//!   alone, so that losses make light more Poissonian.
//!
//! The noise of a blackbody's light is thus raised by 1 + η·occupancy: 1.034 at 715 cm⁻¹ and 300 K, 1.0025 at
//! 1250 cm⁻¹. The λ of S7 is no such occupancy: it is the photons of a pixel in a coherence time, in all the E ν²
//! modes of its étendue E together, and 1 + λ is many times too large.
//!
//! Assumptions: light of many independent emitters, flat over a band; m ≥ 1, a coherence area and a coherence time at
//! least; no dead time.
//!
//! Sources: paper S11–S13; Mandel and Wolf, 'Optical Coherence and Quantum Optics' (1995), section 14.9.

use super::{Camera, View};
use crate::planck;
use crate::spectrum::Bands;

/// Variance that bunching adds to so many counts, counted photons per mode given, counts².
///
/// ```
/// // 50 counts in 1000 modes: a variance of 52.5.
/// assert_eq!(hadar::instrument::bunching::added_variance(50.0, 50.0 / 1000.0), 2.5);
/// ```
#[must_use]
pub fn added_variance(counts: f64, counts_per_mode: f64) -> f64 {
    counts * counts_per_mode
}

impl Camera {
    /// Photons that are counted per mode, mean over each band, of all that a pixel sees; `open` are the bands as nothing on
    /// the path or in the camera dims them.
    #[must_use]
    pub fn counts_per_mode(&self, open: &Bands, view: &View) -> Vec<f64> {
        let modes: Vec<f64> = open.nodes_cm1().iter().map(|&nu| planck::mode_density(nu)).collect();
        let efficiency = self.optics_efficiency * self.quantum_efficiency;
        let all = |w: usize| view.fill * view.signal[w] + view.other_light(w);
        open.weigh(&modes).iter().enumerate().map(|(w, modes)| efficiency * all(w) / modes).collect()
    }

    /// The same of a far blackbody of a temperature in K, in bands so narrow that their middles stand for them.
    #[must_use]
    pub fn counts_per_mode_of_blackbody(&self, bands: &Bands, temperature_k: f64) -> Vec<f64> {
        let counted = |center: f64| {
            let curves: f64 = self.efficiency_curves.iter().map(|curve| curve.at(center)).product();
            planck::occupancy(center, temperature_k)
                * self.optics_efficiency
                * self.quantum_efficiency
                * curves
        };
        bands.bands().iter().map(|band| counted(band.center_cm1)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::instrument::presets;

    /// The occupancies of the header, 1/(exp(hcν/kT) − 1), halved by a detector that counts every second photon.
    #[test]
    fn losses_make_light_more_poissonian() {
        let mut camera = presets::get("ideal-pnrd").unwrap();
        let bands = Bands::from_rows([(715.0, 1.0), (1250.0, 1.0)]).unwrap();
        for (efficiency, factors) in [(1.0, [1.034, 1.0025]), (0.5, [1.017, 1.00125])] {
            camera.quantum_efficiency = efficiency;
            let found = camera.counts_per_mode_of_blackbody(&bands, 300.0);
            // The digits of the header.
            assert!(
                found.iter().zip(factors).all(|(found, factor)| (1.0 + found - factor).abs() < 5e-4),
                "{found:?}"
            );
        }
    }
}
