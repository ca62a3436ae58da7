//! Electronic noise of a band reading, from what data sheets state.
//!
//! * NETD: σ = NETD · dN/dT, N the photons of a blackbody at the stated temperature, f-number, pixel and
//!   optics efficiency in all of the detector's spectral range, per exposure;
//! * specific detectivity: σ_w = √(A_p Δf)/D* · t/(hcν_w), Δf = 1/(2t) (photon noise-equivalent of the NEP);
//! * counts: as given.
//!
//! The noise belongs to the detector: it does not change with the lens in front of it. Its variance grows
//! with the integration time as σ²(t) = σ²·[(1 − φ)(t/t₀) + φ(t/t₀)²], φ the flicker share at t₀.
//!
//! Source: paper Table S2 and text above it (γ = γ₀ + γ₁N).

use super::Camera;
use crate::error::{Result, check};
use crate::planck;
use crate::spectrum::Bands;
use crate::units::{PLANCK_J_S, SPEED_OF_LIGHT_M_S};

/// How the noise of a camera is stated.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case", tag = "kind", deny_unknown_fields)]
pub enum NoiseSpec {
    /// No electronic noise at all.
    None,
    /// Noise-equivalent temperature difference.
    Netd {
        /// NETD of one frame, K.
        netd_k: f64,
        /// Temperature of the blackbody at which it is stated, K.
        temperature_k: f64,
        /// f-number at which it is stated.
        f_number: f64,
        /// Optics efficiency with which its photons are counted.
        optics_efficiency: f64,
        /// Side of the pixel for which it is stated, m.
        pixel_m: f64,
    },
    /// Specific detectivity D*.
    Detectivity {
        /// D*, cm √Hz W⁻¹.
        detectivity_cm_hz05_w: f64,
    },
    /// Standard deviation of a band reading.
    Counts {
        /// σ, counts.
        sigma_counts: f64,
    },
}

impl NoiseSpec {
    /// The same kind of noise with a deviation σ `factor` times as large.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        match self {
            Self::None => Self::None,
            Self::Netd { netd_k, temperature_k, f_number, optics_efficiency, pixel_m } => {
                Self::Netd { netd_k: netd_k * factor, temperature_k, f_number, optics_efficiency, pixel_m }
            }
            Self::Detectivity { detectivity_cm_hz05_w } => {
                Self::Detectivity { detectivity_cm_hz05_w: detectivity_cm_hz05_w / factor }
            }
            Self::Counts { sigma_counts } => Self::Counts { sigma_counts: sigma_counts * factor },
        }
    }

    pub(super) fn check(&self) -> Result<()> {
        match *self {
            Self::None => {}
            Self::Netd { netd_k, temperature_k, f_number, optics_efficiency, pixel_m } => {
                check::positive("pixel of the NETD", pixel_m, "m")?;
                check::positive("netd", netd_k, "K")?;
                check::positive("netd_temperature", temperature_k, "K")?;
                check::positive("netd_f_number", f_number, "")?;
                check::positive("optics efficiency of the NETD", optics_efficiency, "")?;
            }
            Self::Detectivity { detectivity_cm_hz05_w } => {
                check::positive("detectivity", detectivity_cm_hz05_w, "cm Hz^0.5/W")?;
            }
            Self::Counts { sigma_counts } => {
                check::non_negative("noise_electrons", sigma_counts, "")?;
            }
        }
        Ok(())
    }
}

/// Growth of the noise variance when the integration time is `stretch` times the stated exposure.
#[must_use]
pub fn growth(stretch: f64, flicker_fraction: f64) -> f64 {
    stretch * ((1.0 - flicker_fraction) + flicker_fraction * stretch)
}

/// σ of each band reading at the stated exposure, counts.
pub(super) fn reading_sigma(camera: &Camera, bands: &Bands) -> Option<Vec<f64>> {
    match camera.noise {
        NoiseSpec::None => None,
        NoiseSpec::Counts { sigma_counts } => Some(vec![sigma_counts; bands.len()]),
        NoiseSpec::Netd { netd_k, temperature_k, f_number, optics_efficiency, pixel_m } => {
            let stated = Camera {
                f_number,
                optics_efficiency,
                pixel_m,
                exposure_s: camera.noise_exposure_s,
                frames: 1,
                ..camera.clone()
            };
            let sigma = netd_k * stated.counts_per_kelvin(temperature_k);
            Some(vec![sigma; bands.len()])
        }
        NoiseSpec::Detectivity { detectivity_cm_hz05_w } => {
            let t = camera.noise_exposure_s;
            let area_cm2 = (camera.pixel_m * 100.0).powi(2);
            let nep_w = (area_cm2 * 0.5 / t).sqrt() / detectivity_cm_hz05_w;
            let sigma = |center_cm1: f64| nep_w * t / (PLANCK_J_S * SPEED_OF_LIGHT_M_S * 100.0 * center_cm1);
            Some(bands.bands().iter().map(|band| sigma(band.center_cm1)).collect())
        }
    }
}

impl Camera {
    /// dN/dT of a far blackbody in all of the camera's spectral range, counts per K and exposure.
    pub(super) fn counts_per_kelvin(&self, temperature_k: f64) -> f64 {
        // A range that makes no bands is refused by `checked`; no bands here mean no counts.
        let Ok(bands) = self.own_bands() else { return 0.0 };
        let nodes = bands.nodes_cm1();
        let (mut value, mut slope) = (vec![0.0; nodes.len()], vec![0.0; nodes.len()]);
        planck::photon_radiance_and_slope_into(nodes, temperature_k, &mut value, &mut slope);
        let per_kelvin: f64 = bands.weigh(&slope).iter().sum();
        per_kelvin * self.etendue_m2_sr(None) * self.optics_efficiency * self.exposure_s
    }
}

/// One line of the noise budget of a band.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct NoiseLine {
    /// What it is.
    pub label: &'static str,
    /// Variance, counts², mean over the bands.
    pub var_counts: f64,
    /// How it grows with the integration time t.
    pub scaling: &'static str,
}

impl Camera {
    /// The noise of an average band as labelled lines, which sum to its total variance.
    #[must_use]
    pub fn noise_budget(&self, bands: &Bands, signal: &[f64], distance_m: Option<f64>) -> Vec<NoiseLine> {
        let counting = self.counting(bands, distance_m);
        let mean = |values: &mut dyn Iterator<Item = f64>| values.sum::<f64>() / bands.len() as f64;
        let shot = mean(&mut signal.iter().map(|s| s * counting.counts_per_radiance));
        let stretch = self.integration_s() / self.noise_exposure_s;
        let sigma = self.reading_sigma(bands).unwrap_or_else(|| vec![0.0; bands.len()]);
        let stated = mean(&mut sigma.iter().map(|sigma| sigma * sigma));
        vec![
            NoiseLine { label: "shot noise", var_counts: shot, scaling: "t" },
            NoiseLine {
                label: "Johnson noise",
                var_counts: stated * (1.0 - self.flicker_fraction) * stretch,
                scaling: "t",
            },
            NoiseLine {
                label: "flicker noise",
                var_counts: stated * self.flicker_fraction * stretch * stretch,
                scaling: "t^2",
            },
        ]
    }
}
