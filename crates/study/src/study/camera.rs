//! The camera of a scenario: a preset with what the scenario overrides.

use crate::scenario::{CameraSpec, Efficiency, Source};
use hadar::error::{Error, Place, Result};
use hadar::grid::{Grid, text_of_file};
use hadar::instrument::presets::{self, Preset, StatedNoise};
use hadar::instrument::{Camera, EfficiencyCurve, NoiseSpec};
use std::path::Path;

/// The preset with what the scenario overrides; without a preset everything must be said.
pub(super) fn resolved(spec: &CameraSpec, source: &Source) -> Result<Camera> {
    resolved_at(spec, &|key| source.place(&format!("camera.{key}")))
}

/// The same for a camera whose keys stand where `place` says.
pub(super) fn resolved_at(spec: &CameraSpec, place: &dyn Fn(&str) -> Place) -> Result<Camera> {
    let preset = match &spec.preset {
        Some(name) => Some(presets::find(name).map_err(|error| error.at(place("preset")))?),
        None => None,
    };
    check_conditions(spec, preset.as_ref(), place)?;
    let stated = overridden(spec, preset.clone().unwrap_or_default(), place)?;
    let camera = |preset: &Preset| {
        preset.camera().map_err(|missing| missing.error(&preset.name).at(place(missing.key)))
    };
    let mut camera_made = camera(&stated)?;
    camera_made.name = match (&spec.preset, preset) {
        (Some(name), Some(preset)) => match preset.camera() {
            Ok(own) => match changed(&camera_made, &own).as_slice() {
                [] => name.clone(),
                keys => format!("{name} with {} changed", keys.join(", ")),
            },
            // What no document states is of the scenario.
            Err(_) => format!("{name} as completed"),
        },
        _ => "the camera".into(),
    };
    camera_made.checked().map_err(|error| {
        // The figure at fault, where a scenario has a key of its name.
        let key = match &error {
            Error::OutOfRange { quantity, .. } if !quantity.contains(' ') => quantity.clone(),
            Error::Malformed { found, .. } => found.split(' ').next().unwrap_or("preset").to_owned(),
            _ => "preset".to_owned(),
        };
        error.at(place(&key))
    })
}

/// Conditions of a noise that is not stated, and a noise without the condition it cannot do without.
fn check_conditions(spec: &CameraSpec, preset: Option<&Preset>, place: &dyn Fn(&str) -> Place) -> Result<()> {
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
    if spec.noise_exposure_s.is_some() && !spec.states_noise() {
        let instead = "write netd, detectivity or noise_electrons beside it";
        return Err(Error::malformed("noise_exposure without a noise", instead).at(place("noise_exposure")));
    }
    let of_bandwidth = [("detectivity", spec.detectivity_cm_hz05_w), ("nep", spec.nep_w_hz05)];
    match of_bandwidth.iter().find(|(_, given)| given.is_some()) {
        None if spec.noise_bandwidth_hz.is_some() => {
            let instead = "write detectivity = \"4.7e10 cm Hz^0.5/W\" or nep beside it";
            let error = Error::malformed("noise_bandwidth without a detectivity or nep", instead);
            Err(error.at(place("noise_bandwidth")))
        }
        // A preset that states such a noise states its conditions too.
        Some((key, _))
            if spec.noise_bandwidth_hz.is_none()
                && spec.noise_exposure_s.is_none()
                && !preset.is_some_and(|preset| preset.bandwidth_is_stated()) =>
        {
            let instead =
                "write noise_bandwidth = \"175 kHz\", or noise_exposure = \"2.86 us\" for 1/(2 x 2.86 us)";
            Err(Error::malformed(format!("{key} without a bandwidth"), instead).at(place(key)))
        }
        _ => Ok(()),
    }
}

/// The preset with the scenario's figures laid over it.
fn overridden(spec: &CameraSpec, preset: Preset, place: &dyn Fn(&str) -> Place) -> Result<Preset> {
    let mut stated = preset;
    let own_noise_exposure = stated.noise_exposure_s.or(stated.exposure_s);
    let conditions = stated.bandwidth_is_stated();
    let own_bandwidth = match stated.noise {
        Some(StatedNoise::Detectivity { bandwidth_hz, .. } | StatedNoise::Nep { bandwidth_hz, .. }) => {
            bandwidth_hz
        }
        _ => None,
    };
    let bandwidth_hz = match spec.noise_exposure_s {
        Some(_) => spec.noise_bandwidth_hz,
        None => spec.noise_bandwidth_hz.or(own_bandwidth),
    };
    // Noise that comes with the preset is stated under the preset's conditions.
    if let Some(StatedNoise::Netd { f_number, optics_efficiency, pixel_m, .. }) = &mut stated.noise {
        *f_number = f_number.or(stated.f_number);
        *optics_efficiency = optics_efficiency.or(stated.optics_efficiency);
        *pixel_m = pixel_m.or(stated.pixel_m);
    }
    let lay = |over: Option<f64>, under: &mut Option<f64>| *under = over.or(*under);
    lay(spec.exposure_s, &mut stated.exposure_s);
    lay(spec.pixel_m, &mut stated.pixel_m);
    lay(spec.f_number, &mut stated.f_number);
    lay(spec.focal_length_m, &mut stated.focal_length_m);
    lay(spec.flicker_fraction, &mut stated.flicker_fraction);
    lay(spec.dark_rate_per_s, &mut stated.dark_rate_per_s);
    lay(spec.read_noise, &mut stated.read_noise_counts);
    lay(spec.full_well, &mut stated.full_well);
    lay(spec.frame_rate_hz, &mut stated.frame_rate_hz);
    lay(spec.sensor_temperature_k, &mut stated.sensor_temperature_k);
    lay(spec.filter_temperature_k, &mut stated.filter_temperature_k);
    lay(spec.field_of_view_rad, &mut stated.field_of_view_rad);
    stated.quantisation_bits = spec.quantisation_bits.or(stated.quantisation_bits);
    stated.frames = spec.frames.or(stated.frames);
    stated.pixels = spec.pixels.or(stated.pixels);
    stated.readout = spec.readout.or(stated.readout);
    stated.photon_bunching = spec.photon_bunching.unwrap_or(stated.photon_bunching);
    // Without a preset there is no document that could have stated an efficiency.
    if spec.preset.is_none() {
        stated.optics_efficiency = Some(1.0);
        stated.spectral_range_cm1 = Some([715.0, 1250.0]);
        stated.flicker_fraction = stated.flicker_fraction.or(Some(0.0));
    }
    for (key, efficiency) in
        [("optics_efficiency", &spec.optics_efficiency), ("quantum_efficiency", &spec.quantum_efficiency)]
    {
        let number = match efficiency {
            None => continue,
            Some(Efficiency::Number(number)) => *number,
            Some(Efficiency::File(path)) => {
                let rows = column(path, "efficiency", "read the efficiency")?;
                let curve = EfficiencyCurve::new(key, rows).map_err(|error| error.in_file(path))?;
                stated.efficiency_curves.push(curve);
                1.0
            }
        };
        match key {
            "optics_efficiency" => stated.optics_efficiency = Some(number),
            _ => stated.quantum_efficiency = Some(number),
        }
    }
    let noise = if let Some(netd_k) = spec.netd_k {
        Some(StatedNoise::Netd {
            netd_k,
            // Without a word on it the NETD is of the reference temperature, through the camera's own optics.
            temperature_k: spec.netd_temperature_k.or(stated.reference_temperature_k).or(Some(303.15)),
            f_number: spec.netd_f_number.or(stated.f_number),
            optics_efficiency: None,
            pixel_m: spec.netd_pixel_m,
        })
    } else if let Some(detectivity_cm_hz05_w) = spec.detectivity_cm_hz05_w {
        Some(StatedNoise::Detectivity { detectivity_cm_hz05_w, bandwidth_hz })
    } else if let Some(nep_w_hz05) = spec.nep_w_hz05 {
        Some(StatedNoise::Nep { nep_w_hz05, bandwidth_hz })
    } else if let Some(microflick) = spec.nesr_microflick {
        Some(StatedNoise::Nesr { microflick, wavelength_um: None })
    } else if let Some(path) = &spec.noise_table {
        let rows = column(path, "sigma_counts", "read the noise")?;
        let table = NoiseSpec::table(rows).map_err(|error| error.in_file(path))?;
        Some(StatedNoise::Table(table))
    } else {
        spec.noise_electrons.map(|sigma_counts| StatedNoise::Counts { sigma_counts })
    };
    if noise.is_none() && stated.noise.is_none() && spec.preset.is_none() {
        return Err(Error::malformed(
            "the camera's noise is not given",
            "write netd = \"50 mK\", detectivity = \"4.7e10 cm Hz^0.5/W\" or noise_electrons = 0",
        )
        .at(place("netd")));
    }
    // Noise that comes with the preset is stated at the preset's exposure, other noise at its own.
    stated.noise_exposure_s = match noise {
        Some(StatedNoise::Detectivity { .. } | StatedNoise::Nep { .. }) if conditions => {
            spec.noise_exposure_s.or(own_noise_exposure)
        }
        Some(_) => spec.noise_exposure_s.or(stated.exposure_s),
        None => own_noise_exposure.or(stated.exposure_s),
    };
    stated.noise = noise.or(stated.noise);
    Ok(stated)
}

/// Rows (wavenumber in cm⁻¹, value) of a file with that column.
fn column(path: &Path, name: &str, action: &str) -> Result<Vec<(f64, f64)>> {
    let text = text_of_file(path, action)?;
    let read = || {
        let grid = Grid::parse(&text)?;
        let axis = grid.wavenumbers_cm1()?;
        let Some(index) = grid.header.iter().position(|header| header == name) else {
            let found = format!("there is no column `{name}`");
            let instead = format!("begin the file with wavenumber_cm1,{name}");
            return Err(Error::malformed(found, instead).on_line(grid.header_line));
        };
        let value = |cells: &Vec<f64>| cells.get(index).copied().unwrap_or(f64::NAN);
        Ok(axis.into_iter().zip(grid.rows.iter().map(|(_, cells)| value(cells))).collect())
    };
    read().map_err(|error| error.in_file(path))
}

/// Keys of the figures in which a camera is not its preset, but for the rounding of a conversion of units.
fn changed(camera: &Camera, preset: &Camera) -> Vec<&'static str> {
    const ROUNDING: f64 = 1e-9;
    let same = |a: f64, b: f64| (a - b).abs() <= ROUNDING * a.abs().max(b.abs());
    let same_or_none = |a: Option<f64>, b: Option<f64>| match (a, b) {
        (Some(a), Some(b)) => same(a, b),
        (a, b) => a.is_none() && b.is_none(),
    };
    let noise = match (&camera.noise, &preset.noise) {
        (NoiseSpec::None, NoiseSpec::None) => None,
        (NoiseSpec::Counts { sigma_counts: 0.0 }, NoiseSpec::None) => None,
        (
            NoiseSpec::Netd { netd_k: a, temperature_k: t, f_number: f, pixel_m: p, .. },
            NoiseSpec::Netd { netd_k: b, temperature_k: at, f_number: of, pixel_m: by, .. },
        ) => (!(same(*a, *b) && same(*t, *at) && same(*f, *of) && same(*p, *by))).then_some("netd"),
        (NoiseSpec::Counts { sigma_counts: a }, NoiseSpec::Counts { sigma_counts: b }) => {
            (!same(*a, *b)).then_some("noise_electrons")
        }
        (NoiseSpec::SpectralRadiance { microflick: a }, NoiseSpec::SpectralRadiance { microflick: b }) => {
            (!same(*a, *b)).then_some("nesr")
        }
        (
            NoiseSpec::Detectivity { detectivity_cm_hz05_w: a, bandwidth_hz: of },
            NoiseSpec::Detectivity { detectivity_cm_hz05_w: b, bandwidth_hz: by },
        ) => (!(same(*a, *b) && same_or_none(*of, *by))).then_some("detectivity"),
        (
            NoiseSpec::Nep { nep_w_hz05: a, bandwidth_hz: of },
            NoiseSpec::Nep { nep_w_hz05: b, bandwidth_hz: by },
        ) => (!(same(*a, *b) && same_or_none(*of, *by))).then_some("nep"),
        (own, _) => Some(own.key()),
    };
    let noiseless = matches!(camera.noise, NoiseSpec::None);
    let figures = [
        ("exposure", same(camera.exposure_s, preset.exposure_s)),
        ("pixel", same(camera.pixel_m, preset.pixel_m)),
        ("f_number", same(camera.f_number, preset.f_number)),
        ("focal_length", same(camera.focal_length_m, preset.focal_length_m)),
        (
            "optics_efficiency",
            same(camera.optics_efficiency, preset.optics_efficiency)
                && camera.efficiency_curves == preset.efficiency_curves,
        ),
        ("quantum_efficiency", same(camera.quantum_efficiency, preset.quantum_efficiency)),
        (noise.unwrap_or_default(), noise.is_none()),
        // Noise of the same figures at another exposure is another noise, where there is any.
        (
            "noise_exposure",
            noiseless || noise.is_some() || same(camera.noise_exposure_s, preset.noise_exposure_s),
        ),
        ("flicker_fraction", same(camera.flicker_fraction, preset.flicker_fraction)),
        ("dark_rate", same(camera.dark_rate_per_s, preset.dark_rate_per_s)),
        ("read_noise", same(camera.read_noise_counts, preset.read_noise_counts)),
        ("quantisation_bits", camera.quantisation_bits == preset.quantisation_bits),
        ("photon_bunching", camera.photon_bunching == preset.photon_bunching),
        ("frame_rate", same_or_none(camera.frame_rate_hz, preset.frame_rate_hz)),
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
