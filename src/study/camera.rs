//! The camera of a scenario: a preset with what the scenario overrides.

use crate::error::{Error, Result};
use crate::instrument::{Camera, NoiseSpec, Readout, presets};
use crate::scenario::{CameraSpec, Source};

/// The preset with what the scenario overrides; without a preset everything must be said.
pub(super) fn resolved(spec: &CameraSpec, source: &Source) -> Result<Camera> {
    let place = |key: &str| source.place(&format!("camera.{key}"));
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
    let mut camera = Camera {
        name: String::new(),
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
    camera.name = match (&spec.preset, from) {
        (Some(name), Some(preset)) => match changed(&camera, preset).as_slice() {
            [] => name.clone(),
            keys => format!("{name} with {} changed", keys.join(", ")),
        },
        _ => "the camera".into(),
    };
    camera.checked().map_err(|error| error.at(place("preset")))
}

/// Keys of the figures in which a camera is not its preset, but for the rounding of a conversion of units.
fn changed(camera: &Camera, preset: &Camera) -> Vec<&'static str> {
    const ROUNDING: f64 = 1e-9;
    let same = |a: f64, b: f64| (a - b).abs() <= ROUNDING * a.abs().max(b.abs());
    let same_or_none = |a: Option<f64>, b: Option<f64>| match (a, b) {
        (Some(a), Some(b)) => same(a, b),
        (a, b) => a.is_none() && b.is_none(),
    };
    let noise = match (camera.noise, preset.noise) {
        (NoiseSpec::None, NoiseSpec::None) => None,
        (NoiseSpec::Counts { sigma_counts: 0.0 }, NoiseSpec::None) => None,
        (
            NoiseSpec::Netd { netd_k: a, temperature_k: t, f_number: f, pixel_m: p, .. },
            NoiseSpec::Netd { netd_k: b, temperature_k: at, f_number: of, pixel_m: by, .. },
        ) => (!(same(a, b) && same(t, at) && same(f, of) && same(p, by))).then_some("netd"),
        (
            NoiseSpec::Detectivity { detectivity_cm_hz05_w: a },
            NoiseSpec::Detectivity { detectivity_cm_hz05_w: b },
        ) => (!same(a, b)).then_some("detectivity"),
        (NoiseSpec::Counts { sigma_counts: a }, NoiseSpec::Counts { sigma_counts: b }) => {
            (!same(a, b)).then_some("noise_electrons")
        }
        (NoiseSpec::Netd { .. }, _) => Some("netd"),
        (NoiseSpec::Detectivity { .. }, _) => Some("detectivity"),
        (NoiseSpec::Counts { .. } | NoiseSpec::None, _) => Some("noise_electrons"),
    };
    let noiseless = matches!(camera.noise, NoiseSpec::None);
    let figures = [
        ("exposure", same(camera.exposure_s, preset.exposure_s)),
        ("pixel", same(camera.pixel_m, preset.pixel_m)),
        ("f_number", same(camera.f_number, preset.f_number)),
        ("focal_length", same(camera.focal_length_m, preset.focal_length_m)),
        ("optics_efficiency", same(camera.optics_efficiency, preset.optics_efficiency)),
        (noise.unwrap_or_default(), noise.is_none()),
        // Noise of the same figures at another exposure is another noise, where there is any.
        (
            "noise_exposure",
            noiseless || noise.is_some() || same(camera.noise_exposure_s, preset.noise_exposure_s),
        ),
        ("flicker_fraction", same(camera.flicker_fraction, preset.flicker_fraction)),
        ("full_well", same_or_none(camera.full_well, preset.full_well)),
        ("readout", camera.readout == preset.readout),
        ("frames", camera.frames == preset.frames),
        ("field_of_view", same_or_none(camera.field_of_view_rad, preset.field_of_view_rad)),
        ("pixels", camera.pixels == preset.pixels),
    ];
    figures.into_iter().filter(|(_, same)| !same).map(|(key, _)| key).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::Scenario;

    #[test]
    fn a_preset_that_was_changed_says_in_what() {
        let scenario = Scenario::from_toml(
            "[target]\nmaterial = \"skin\"\ntemperature = \"37 degC\"\n[camera]\npreset = \"flir-a325sc\"\n",
            None,
        )
        .unwrap();
        let name = |change: &dyn Fn(&mut CameraSpec)| {
            let mut spec = scenario.camera.clone().unwrap();
            change(&mut spec);
            resolved(&spec, &scenario.source).unwrap().name
        };
        let own = presets::get("flir-a325sc").unwrap();
        assert_eq!(name(&|_| ()), "flir-a325sc");
        assert_eq!(name(&|spec| spec.pixel_m = Some(own.pixel_m * (1.0 + 1e-12))), "flir-a325sc");
        let changed = name(&|spec| {
            spec.exposure_s = Some(2.0 * own.exposure_s);
            spec.netd_k = Some(0.2);
        });
        assert_eq!(changed, "flir-a325sc with exposure, netd changed");
        assert_eq!(
            name(&|spec| spec.noise_electrons = Some(7.0)),
            "flir-a325sc with noise_electrons changed"
        );
        assert_eq!(name(&|spec| spec.frames = Some(16)), "flir-a325sc with frames changed");
    }
}
