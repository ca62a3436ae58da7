//! Electronic noise of a band reading, from what data sheets state.
//!
//! * NETD: σ² = (NETD · dN/dT)² − N, N the photons of a blackbody at the stated temperature, f-number, pixel and
//!   optics efficiency in all of the detector's spectral range, per exposure. What is measured contains the shot noise of these
//!   photons, so that no NETD is below √N/(dN/dT); a quantum efficiency that is not stated is 1, at which that is least;
//! * specific detectivity: NEP = √(A_p Δf)/D*, σ_w = η_q NEP t/(hcν_w), η_q quantum efficiency;
//! * noise-equivalent power: of a bandwidth Δf, or per √Hz and then NEP = n √Δf;
//! * noise-equivalent spectral radiance L (flicks, W cm⁻² sr⁻¹ µm⁻¹): σ_w = étendue × η t × ∫ L dλ/(hcν) over the band, at the f-number,
//!   pixel and optics efficiency for which it is stated;
//! * counts: as given, or as a table over wavenumber.
//!
//! The bandwidth of a reading that integrates for t is Δf = 1/(2t) where no other is stated.
//!
//! The noise belongs to the detector: it does not change with the lens in front of it. Its variance grows
//! with the integration time as σ²(t) = σ²·[(1 − φ)(t/t₀) + φ(t/t₀)²], φ the flicker share at t₀.
//!
//! Source: paper Table S2 and text above it (γ = γ₀ + γ₁N).

mod spec;

pub use spec::{NetdConditions, NoiseSpec};

use super::camera::OWN_STEP_CM1;
use super::{Camera, View};
use crate::planck;
use crate::spectrum::{Bands, OPAQUE, interpolated};
use crate::units::{PLANCK_J_S, SPEED_OF_LIGHT_M_S};
use std::cell::Cell;

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
            NoiseSpec::Netd { netd_k, .. } => {
                let sigma = self.of_netd().map_or(0.0, |of| of.electronic_sigma(*netd_k));
                Some(vec![sigma; bands.len()])
            }
            NoiseSpec::Detectivity { detectivity_cm_hz05_w, bandwidth_hz } => {
                let area_cm2 = (self.pixel_m * 100.0).powi(2);
                let bandwidth_hz = bandwidth_hz.unwrap_or(0.5 / t);
                Some(of_power((area_cm2 * bandwidth_hz).sqrt() / detectivity_cm_hz05_w))
            }
            NoiseSpec::Nep { nep_w_hz05, bandwidth_hz } => {
                Some(of_power(nep_w_hz05 * bandwidth_hz.unwrap_or(0.5 / t).sqrt()))
            }
            NoiseSpec::SpectralRadiance { microflick, f_number, optics_efficiency, pixel_m } => {
                // Light of that radiance through those optics; the weights of the bands hold the efficiency curves.
                let stated = Self { f_number: *f_number, pixel_m: *pixel_m, ..self.clone() };
                let collected = stated.etendue_m2_sr(None) * optics_efficiency * self.quantum_efficiency;
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

    /// The same kind of noise with a deviation σ `factor` times as large. Of a NETD σ is stated itself: it contains shot noise, which no
    /// factor changes.
    #[must_use]
    pub fn noise_scaled(&self, factor: f64) -> NoiseSpec {
        let mut noise = self.noise.clone();
        match &mut noise {
            NoiseSpec::None => {}
            NoiseSpec::Netd { netd_k, .. } => {
                let sigma = self.of_netd().map_or(0.0, |of| of.electronic_sigma(*netd_k));
                return NoiseSpec::Counts { sigma_counts: factor * sigma };
            }
            NoiseSpec::Detectivity { detectivity_cm_hz05_w, .. } => *detectivity_cm_hz05_w /= factor,
            NoiseSpec::Nep { nep_w_hz05, .. } => *nep_w_hz05 *= factor,
            NoiseSpec::SpectralRadiance { microflick, .. } => *microflick *= factor,
            NoiseSpec::Counts { sigma_counts } => *sigma_counts *= factor,
            NoiseSpec::Table { sigma_counts, .. } => {
                sigma_counts.iter_mut().for_each(|sigma| *sigma *= factor);
            }
        }
        noise
    }

    /// The least NETD that there can be under the conditions of the stated one, K: that of shot noise alone. `None` where the noise is
    /// not stated as NETD.
    #[must_use]
    pub fn least_netd_k(&self) -> Option<f64> {
        self.of_netd().map(|of| of.shot_noise / of.per_kelvin)
    }

    /// The reading of which the NETD is stated.
    fn of_netd(&self) -> Option<OfNetd> {
        let NoiseSpec::Netd { temperature_k, f_number, optics_efficiency, pixel_m, .. } = self.noise else {
            return None;
        };
        let exposure_s = self.noise_exposure_s;
        let stated = Self { f_number, optics_efficiency, pixel_m, exposure_s, ..self.clone() };
        let [photons, per_kelvin] = stated.counts_and_slope(temperature_k);
        Some(OfNetd { shot_noise: photons.sqrt(), per_kelvin })
    }

    /// Share of the photons on the detector that are counted at a wavenumber (cm⁻¹).
    fn counted(&self, wavenumber_cm1: f64) -> f64 {
        let curves = self.efficiency_curves.iter().filter(|curve| curve.name() == "quantum_efficiency");
        self.quantum_efficiency * curves.map(|curve| curve.at(wavenumber_cm1)).product::<f64>()
    }

    /// dN/dT of a far blackbody in all of the camera's spectral range, counts per K and exposure.
    #[must_use]
    pub fn counts_per_kelvin(&self, temperature_k: f64) -> f64 {
        let [_, per_kelvin] = self.counts_and_slope(temperature_k);
        per_kelvin
    }

    /// N and dN/dT of that blackbody, counts of an exposure and counts per K.
    fn counts_and_slope(&self, temperature_k: f64) -> [f64; 2] {
        let one = Self { frames: 1, ..self.clone() };
        let counted = OWN_STEP_CM1 * one.collected(&View::default());
        self.blackbody_seen(temperature_k).map(|radiance| counted * radiance)
    }

    /// Sums of B and ∂B/∂T over [`Camera::own_bands`] with the efficiencies in them. Every reading of a camera with a NETD asks for them:
    /// without curves they are those of a range and a temperature, the last ones of which are kept.
    fn blackbody_seen(&self, temperature_k: f64) -> [f64; 2] {
        thread_local! { static LAST: Cell<Option<([f64; 3], [f64; 2])>> = const { Cell::new(None) } }
        let [low, high] = self.spectral_range_cm1;
        let (asked, keeps) = ([low, high, temperature_k], self.efficiency_curves.is_empty());
        if let Some((_, sums)) = LAST.get().filter(|(known, _)| keeps && *known == asked) {
            return sums;
        }
        // A range that makes no bands is refused by `checked`; no bands here mean no counts.
        let Ok(nodes) = Bands::uniform_centers(low, high, OWN_STEP_CM1) else { return [0.0; 2] };
        let (mut value, mut slope) = (vec![0.0; nodes.len()], vec![0.0; nodes.len()]);
        planck::photon_radiance_and_slope_into(&nodes, temperature_k, &mut value, &mut slope);
        let sums = [value, slope].map(|radiance| -> f64 {
            let bands = nodes.iter().zip(&radiance);
            bands.map(|(nu, radiance)| radiance * self.efficiency_at(*nu).max(OPAQUE)).sum()
        });
        if keeps {
            LAST.set(Some((asked, sums)));
        }
        sums
    }
}

/// The reading of which a NETD is stated.
struct OfNetd {
    /// √N, counts.
    shot_noise: f64,
    /// dN/dT, counts per K.
    per_kelvin: f64,
}

impl OfNetd {
    /// σ = √((NETD · dN/dT)² − N), as a product so that no digits are lost where the two are nearly equal; 0 below the shot noise, which
    /// `checked` refuses.
    fn electronic_sigma(&self, netd_k: f64) -> f64 {
        let all = netd_k * self.per_kelvin;
        ((all - self.shot_noise).max(0.0) * (all + self.shot_noise)).sqrt()
    }
}

#[cfg(all(test, feature = "library"))]
mod tests {
    use super::*;
    use crate::instrument::{EfficiencyCurve, presets};

    /// 47.8 mK of the paper's bolometer: σ_all = 1.769e6 counts of the 2.530e9 photons of a blackbody of 30 degC in front of the
    /// optics, whose shot noise is 5.030e4 counts. It takes 1/(2 · 1237) of σ, some 0.04 %.
    #[test]
    fn a_measured_netd_contains_the_shot_noise_of_its_photons() {
        let camera = presets::get("flir-a325sc").unwrap();
        let bands = camera.own_bands().unwrap();
        let before = Camera { optics_efficiency: 1.0, ..camera.clone() };
        let all = 47.8e-3 * before.counts_per_kelvin(303.15);
        let photons = Camera { reference_temperature_k: 303.15, ..before }.figures().unwrap().photons;
        let sigma = camera.reading_sigma(&bands).unwrap()[0];
        assert!((sigma.powi(2) / (all.powi(2) - photons) - 1.0).abs() < 1e-12);
        assert!(((1.0 - sigma / all) * 2.0 * all.powi(2) / photons - 1.0).abs() < 1e-3);
        assert!((3e-4..5e-4).contains(&(1.0 - sigma / all)), "{}", 1.0 - sigma / all);
        // With the shot noise of its photons it is the NETD that was stated.
        let total = camera.equivalents().unwrap();
        let own =
            Camera { noise: NoiseSpec::Counts { sigma_counts: sigma }, optics_efficiency: 1.0, ..camera };
        assert!(
            (own.equivalents().unwrap().netd_with_shot_noise_k / 47.8e-3 - 1.0).abs() < 1e-12,
            "{total:?}"
        );
    }

    /// Against the bands written out, with an efficiency curve and without, whoever asked before.
    #[test]
    fn a_blackbody_is_counted_over_the_cameras_own_bands() {
        let open = presets::get("flir-a325sc").unwrap();
        let curve = EfficiencyCurve::new("optics", vec![(700.0, 0.2), (1000.0, 0.9), (1300.0, 0.4)]).unwrap();
        let behind = Camera { efficiency_curves: vec![curve], ..open.clone() };
        let narrow = Camera { spectral_range_cm1: [800.0, 900.0], ..open.clone() };
        for _ in 0..2 {
            for camera in [&open, &behind, &narrow] {
                for temperature_k in [250.0, 303.15] {
                    let bands = camera.received(&camera.own_bands().unwrap());
                    let slope = |nu: &f64| planck::photon_radiance_slope(*nu, temperature_k);
                    let slopes: Vec<f64> = bands.nodes_cm1().iter().map(slope).collect();
                    let one = Camera { frames: 1, ..camera.clone() };
                    let counted = one.counts_per_radiance(&bands, &View::default());
                    let expected = counted * bands.weigh(&slopes).iter().sum::<f64>();
                    let found = camera.counts_per_kelvin(temperature_k);
                    assert!((found / expected - 1.0).abs() < 1e-13, "{found} {expected}");
                }
            }
        }
    }

    #[test]
    fn a_netd_below_the_shot_noise_is_no_camera() {
        let mut camera = presets::get("flir-a325sc").unwrap();
        let least_k = camera.least_netd_k().unwrap();
        // √N/(dN/dT) by hand: 5.030e4/(1.769e6/47.8 mK).
        assert!((least_k / (5.030e4 / 1.769e6 * 47.8e-3) - 1.0).abs() < 2e-3, "{least_k}");
        let stated = |camera: &mut Camera, share: f64| {
            if let NoiseSpec::Netd { netd_k, .. } = &mut camera.noise {
                *netd_k = share * least_k;
            }
            camera.clone().checked()
        };
        let sigma = |camera: &Camera| camera.reading_sigma(&camera.own_bands().unwrap()).unwrap()[0];
        // NETD = (1 + ε) least: σ = √(2ε + ε²) of the shot noise.
        for share in [1e-9, 1e-4, 0.5] {
            let found = sigma(&stated(&mut camera, 1.0 + share).unwrap());
            let photons = (least_k
                * Camera { optics_efficiency: 1.0, ..camera.clone() }.counts_per_kelvin(303.15))
            .powi(2);
            let expected = (photons * (2.0 * share + share * share)).sqrt();
            assert!((found / expected - 1.0).abs() < 1e-6, "{share}: {found} {expected}");
        }
        let refused = stated(&mut camera, 1.0 - 1e-6).unwrap_err().to_string();
        assert!(refused.contains("netd") && refused.contains("at least 1.36"), "{refused}");
    }
}
