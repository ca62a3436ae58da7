//! The camera of a scenario: a preset with what the scenario overrides.

use crate::error::{Error, Result};
use crate::instrument::{Camera, NoiseSpec, Readout, presets};
use crate::scenario::{CameraSpec, Scenario};

/// The preset with what the scenario overrides; without a preset everything must be said.
pub(super) fn resolved(spec: &CameraSpec, scenario: &Scenario) -> Result<Camera> {
    let place = |key: &str| scenario.place(&format!("camera.{key}"));
    let preset = match &spec.preset {
        Some(name) => Some(presets::get(name).map_err(|error| error.at(place("preset")))?),
        None => None,
    };
    let need = |key: &'static str, own: Option<f64>, preset: Option<f64>, example: &str| {
        own.or(preset).ok_or_else(|| {
            Error::malformed(
                format!("neither a preset nor camera.{key} is given"),
                format!("write {key} = {example}, or preset = \"flir-a325sc\""),
            )
            .at(place(key))
        })
    };
    let from = preset.as_ref();
    let exposure_s = need("exposure", spec.exposure_s, from.map(|c| c.exposure_s), "\"12 ms\"")?;
    let pixel_m = need("pixel", spec.pixel_m, from.map(|c| c.pixel_m), "\"12 um\"")?;
    let f_number = need("f_number", spec.f_number, from.map(|c| c.f_number), "1.3")?;
    let focal_length_m =
        need("focal_length", spec.focal_length_m, from.map(|c| c.focal_length_m), "\"18 mm\"")?;
    let optics_efficiency = spec.optics_efficiency.or(from.map(|c| c.optics_efficiency)).unwrap_or(1.0);
    let reference_temperature_k = from.map_or(303.15, |c| c.reference_temperature_k);
    let own_noise = if let Some(netd_k) = spec.netd_k {
        Some(NoiseSpec::Netd {
            netd_k,
            temperature_k: spec.netd_temperature_k.unwrap_or(reference_temperature_k),
            f_number: spec.netd_f_number.unwrap_or(f_number),
            optics_efficiency,
            pixel_m: spec.netd_pixel_m.unwrap_or(pixel_m),
        })
    } else if let Some(detectivity_cm_hz05_w) = spec.detectivity_cm_hz05_w {
        Some(NoiseSpec::Detectivity { detectivity_cm_hz05_w })
    } else {
        spec.noise_electrons.map(|sigma_counts| NoiseSpec::Counts { sigma_counts })
    };
    for (key, given) in [
        ("netd_temperature", spec.netd_temperature_k.is_some()),
        ("netd_f_number", spec.netd_f_number.is_some()),
        ("netd_pixel", spec.netd_pixel_m.is_some()),
    ] {
        if given && spec.netd_k.is_none() {
            let error = Error::malformed(format!("{key} without a netd"), "write netd = \"50 mK\" beside it");
            return Err(error.at(place(key)));
        }
    }
    if spec.noise_exposure_s.is_some() && own_noise.is_none() {
        let instead = "write netd, detectivity or noise_electrons beside it";
        return Err(Error::malformed("noise_exposure without a noise", instead).at(place("noise_exposure")));
    }
    let noise = match (own_noise, from) {
        (Some(noise), _) => noise,
        (None, Some(preset)) => preset.noise,
        (None, None) => {
            return Err(Error::malformed(
                "the camera's noise is not given",
                "write netd = \"50 mK\", detectivity = \"4.7e10 cm Hz^0.5/W\" or noise_electrons = 0",
            )
            .at(place("netd")));
        }
    };
    let camera = Camera {
        name: spec.preset.clone().unwrap_or_else(|| "the camera".into()),
        description: from.map_or_else(String::new, |c| c.description.clone()),
        provenance: from.map_or_else(Vec::new, |c| c.provenance.clone()),
        exposure_s,
        pixel_m,
        f_number,
        focal_length_m,
        optics_efficiency,
        noise,
        // Noise that comes with the preset is stated at the preset's exposure, other noise at its own.
        noise_exposure_s: match (from, own_noise) {
            (Some(preset), None) => preset.noise_exposure_s,
            _ => spec.noise_exposure_s.unwrap_or(exposure_s),
        },
        flicker_fraction: spec.flicker_fraction.or(from.map(|c| c.flicker_fraction)).unwrap_or(0.0),
        full_well: spec.full_well.or(from.and_then(|c| c.full_well)),
        readout: spec.readout.or(from.map(|c| c.readout)).unwrap_or(Readout::Simultaneous),
        frames: spec.frames.or(from.map(|c| c.frames)).unwrap_or(1),
        field_of_view_rad: spec.field_of_view_rad.or(from.and_then(|c| c.field_of_view_rad)),
        pixels: spec.pixels.or(from.and_then(|c| c.pixels)),
        reference_temperature_k,
        spectral_range_cm1: from.map_or([715.0, 1250.0], |c| c.spectral_range_cm1),
    };
    camera.checked().map_err(|error| error.at(place("preset")))
}
