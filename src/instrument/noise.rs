//! Electronic noise of a band reading, from what data sheets state.
//!
//! * NETD: σ = NETD · dN/dT, N the photons of a blackbody at the stated temperature, f-number, pixel and
//!   optics efficiency in all of the detector's spectral range, per exposure;
//! * specific detectivity: NEP = √(A_p Δf)/D*, σ_w = η_q NEP t/(hcν_w), η_q quantum efficiency;
//! * noise-equivalent power: of a bandwidth Δf, or per √Hz and then NEP = n √Δf;
//! * noise-equivalent spectral radiance L (flicks, W cm⁻² sr⁻¹ µm⁻¹): σ_w = étendue × η t × ∫ L dλ/(hcν) over the band;
//! * counts: as given, or as a table over wavenumber.
//!
//! The bandwidth of a reading that integrates for t is Δf = 1/(2t) where no other is stated.
//!
//! The noise belongs to the detector: it does not change with the lens in front of it. Its variance grows
//! with the integration time as σ²(t) = σ²·[(1 − φ)(t/t₀) + φ(t/t₀)²], φ the flicker share at t₀.
//!
//! Source: paper Table S2 and text above it (γ = γ₀ + γ₁N).

mod spec;

pub use spec::NoiseSpec;

use super::{Camera, View};
use crate::planck;
use crate::spectrum::{Bands, interpolated};
use crate::units::{PLANCK_J_S, SPEED_OF_LIGHT_M_S};

/// 1 µflick in W m⁻² sr⁻¹ per µm.
const MICROFLICK_W_M2_SR_UM: f64 = 1e-2;

/// Growth of the noise variance when the integration time is `stretch` times the stated exposure.
#[must_use]
pub fn growth(stretch: f64, flicker_fraction: f64) -> f64 {
    stretch * ((1.0 - flicker_fraction) + flicker_fraction * stretch)
}

/// Energy of a photon, J.
fn photon_energy_j(wavenumber_cm1: f64) -> f64 {
    PLANCK_J_S * SPEED_OF_LIGHT_M_S * 100.0 * wavenumber_cm1
}

/// Photons s⁻¹ m⁻² sr⁻¹ in every band of a spectral radiance in µflick: ∫ L (10⁴/ν²)/(hcν) dν, which is L/ν³ but for constants.
fn photons_of_flick(bands: &Bands, microflick: f64) -> Vec<f64> {
    let at = |nu: f64| microflick * MICROFLICK_W_M2_SR_UM * 1e4 / (nu * nu) / photon_energy_j(nu);
    if bands.one_node_per_band() {
        // One node may stand for a wide band: the mean of ν⁻³ between its ends is (ν₁ + ν₂)/(2 ν₁²ν₂²).
        let with_width = bands.bands().iter().zip(bands.widths_cm1());
        return with_width
            .map(|(band, width)| {
                let (low, high) = (band.low_cm1 / band.center_cm1, band.high_cm1 / band.center_cm1);
                width * at(band.center_cm1) * 0.5 * (low + high) / (low * high).powi(2)
            })
            .collect();
    }
    bands.weigh(&bands.nodes_cm1().iter().map(|nu| at(*nu)).collect::<Vec<_>>())
}

impl Camera {
    /// σ of each band reading at the exposure the noise is stated for, in counts; `None` without noise.
    #[must_use]
    pub fn reading_sigma(&self, bands: &Bands) -> Option<Vec<f64>> {
        let t = self.noise_exposure_s;
        // Photons that a power on the detector amounts to in a band, as it counts them.
        let of_power = |power_w: f64| {
            let counted = |center: f64| self.counted(center) * power_w * t / photon_energy_j(center);
            bands.bands().iter().map(|band| counted(band.center_cm1)).collect()
        };
        match &self.noise {
            NoiseSpec::None => None,
            NoiseSpec::Counts { sigma_counts } => Some(vec![*sigma_counts; bands.len()]),
            NoiseSpec::Table { wavenumbers_cm1, sigma_counts } => {
                let at = |center: f64| interpolated(wavenumbers_cm1, sigma_counts, center);
                Some(bands.bands().iter().map(|band| at(band.center_cm1)).collect())
            }
            NoiseSpec::Netd { netd_k, temperature_k, f_number, optics_efficiency, pixel_m } => {
                let stated = Camera {
                    f_number: *f_number,
                    optics_efficiency: *optics_efficiency,
                    pixel_m: *pixel_m,
                    exposure_s: t,
                    frames: 1,
                    ..self.clone()
                };
                Some(vec![netd_k * stated.counts_per_kelvin(*temperature_k); bands.len()])
            }
            NoiseSpec::Detectivity { detectivity_cm_hz05_w, bandwidth_hz } => {
                let area_cm2 = (self.pixel_m * 100.0).powi(2);
                let bandwidth_hz = bandwidth_hz.unwrap_or(0.5 / t);
                Some(of_power((area_cm2 * bandwidth_hz).sqrt() / detectivity_cm_hz05_w))
            }
            NoiseSpec::Nep { nep_w_hz05, bandwidth_hz } => {
                Some(of_power(nep_w_hz05 * bandwidth_hz.unwrap_or(0.5 / t).sqrt()))
            }
            NoiseSpec::SpectralRadiance { microflick } => {
                // Light of that radiance through the camera's own optics; the weights of the bands hold the efficiency curves.
                let collected = self.etendue_m2_sr(None) * self.optics_efficiency * self.quantum_efficiency;
                Some(
                    photons_of_flick(bands, *microflick)
                        .iter()
                        .map(|photons| photons * collected * t)
                        .collect(),
                )
            }
        }
    }

    /// Johnson and flicker noise of one reading at the camera's exposure, root mean square over the bands, counts.
    #[must_use]
    pub fn electronic_noise_counts(&self, bands: &Bands) -> f64 {
        let Some(sigma) = self.reading_sigma(bands) else { return 0.0 };
        let squares: f64 = sigma.iter().map(|sigma| sigma * sigma).sum();
        (squares / bands.len() as f64
            * growth(self.exposure_s / self.noise_exposure_s, self.flicker_fraction))
        .sqrt()
    }

    /// Share of the photons on the detector that are counted at a wavenumber (cm⁻¹).
    fn counted(&self, wavenumber_cm1: f64) -> f64 {
        let curves = self.efficiency_curves.iter().filter(|curve| curve.name() == "quantum_efficiency");
        self.quantum_efficiency * curves.map(|curve| curve.at(wavenumber_cm1)).product::<f64>()
    }

    /// dN/dT of a far blackbody in all of the camera's spectral range, counts per K and exposure.
    #[must_use]
    pub fn counts_per_kelvin(&self, temperature_k: f64) -> f64 {
        // A range that makes no bands is refused by `checked`; no bands here mean no counts.
        let Ok(bands) = self.own_bands() else { return 0.0 };
        let bands = self.received(&bands);
        let nodes = bands.nodes_cm1();
        let (mut value, mut slope) = (vec![0.0; nodes.len()], vec![0.0; nodes.len()]);
        planck::photon_radiance_and_slope_into(nodes, temperature_k, &mut value, &mut slope);
        let per_kelvin: f64 = bands.weigh(&slope).iter().sum();
        let one = Self { frames: 1, readout: super::Readout::Simultaneous, ..self.clone() };
        per_kelvin * one.counts_per_radiance(&bands, &View::default())
    }
}
