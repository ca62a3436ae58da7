//! A camera with its figures.

use super::numbers::{celsius, quantity};
use crate::instrument::{Camera, Figures, NoiseSpec};
use std::fmt::Write as _;

/// A camera with its figures and where they are from.
#[must_use]
pub fn camera(camera: &Camera, figures: &Figures) -> String {
    let mut out = format!("{}: {}\n\n", camera.name, camera.description);
    let mut line = |label: &str, text: String| {
        let _ = writeln!(out, "  {label:<34} {text}");
    };
    line("exposure", quantity(camera.exposure_s, "s"));
    line("pixel", quantity(camera.pixel_m, "m"));
    line("f-number", format!("f/{}", camera.f_number));
    line("focal length", quantity(camera.focal_length_m, "m"));
    line("optics efficiency", format!("{}", camera.optics_efficiency));
    line("noise", noise(camera));
    line("flicker share of noise variance", format!("{}", camera.flicker_fraction));
    line("readout", camera.readout.name().into());
    let [low, high] = camera.spectral_range_cm1;
    line("spectral range", format!("{low} to {high} cm^-1"));
    let _ = writeln!(out, "\nOne exposure of a blackbody at {}", celsius(figures.reference_temperature_k));
    let mut line = |label: &str, text: String| {
        let _ = writeln!(out, "  {label:<34} {text}");
    };
    line("photons", format!("{:.2e}", figures.photons));
    line("noise of a band reading", format!("{:.2e} counts", figures.noise_counts));
    line(&format!("gamma of a band, {} bands", figures.bands), format!("{:.1e}", figures.gamma_per_band));
    line("t A_p / ((1+gamma) F^2)", format!("{:.2e} m^2 s", figures.hardware_m2_s));
    out.push_str("\nProvenance\n");
    for note in &camera.provenance {
        let _ = writeln!(out, "  - {note}");
    }
    out
}

fn noise(camera: &Camera) -> String {
    match &camera.noise {
        NoiseSpec::None => "none".into(),
        NoiseSpec::Netd { netd_k, temperature_k, f_number, .. } => {
            format!("NETD {} at {}, f/{f_number}", quantity(*netd_k, "K"), celsius(*temperature_k))
        }
        NoiseSpec::Detectivity { detectivity_cm_hz05_w, bandwidth_hz } => {
            format!("D* {detectivity_cm_hz05_w:.2e} cm Hz^0.5/W{}", bandwidth(*bandwidth_hz))
        }
        NoiseSpec::Nep { nep_w_hz05, bandwidth_hz } => {
            format!("NEP {nep_w_hz05:.2e} W/Hz^0.5{}", bandwidth(*bandwidth_hz))
        }
        NoiseSpec::SpectralRadiance { microflick } => format!("{microflick} uflick"),
        NoiseSpec::Counts { sigma_counts } => format!("{sigma_counts:.2e} counts"),
        NoiseSpec::Table { wavenumbers_cm1, .. } => {
            format!("a table of {} wavenumbers", wavenumbers_cm1.len())
        }
    }
}

fn bandwidth(hz: Option<f64>) -> String {
    hz.map_or_else(|| ", bandwidth 1/(2 x exposure)".into(), |hz| format!(" in {}", quantity(hz, "Hz")))
}
