//! The camera of a scenario: a preset with what the scenario overrides.

use hadar::error::{Error, Place, Result};
use hadar::grid::Grid;
use hadar::instrument::figures::{Kind, Part, TABLE};
use hadar::instrument::presets::{self, Preset};
use hadar::instrument::{Camera, EfficiencyCurve, NoiseSpec, REFERENCE_K};
use hadar_formats::file::text_of_file;
use hadar_scenario::{CameraSpec, Efficiency, Source};
use std::path::Path;

/// The preset with what the scenario overrides; without a preset everything must be said.
pub(super) fn resolved(spec: &CameraSpec, source: &Source) -> Result<Camera> {
    resolved_at(spec, &|key| source.place(&format!("camera.{key}")))
}

/// What a camera is called in a message: a known one by its name, whatever was changed of it.
pub(super) fn called(camera: &Camera, spec: &CameraSpec) -> String {
    spec.preset.clone().unwrap_or_else(|| camera.name.clone())
}

/// What is known of the camera that a spec names, one of the user's own or of the program's; nothing where it names none.
pub(super) fn known(spec: &CameraSpec) -> Result<Option<Preset>> {
    match (&spec.own, &spec.preset) {
        (Some(own), name) => {
            let stated = overridden(own, known(own)?.unwrap_or_default())?;
            Ok(Some(Preset { name: name.clone().unwrap_or_default(), ..stated }))
        }
        (None, Some(name)) => presets::find(name).map(Some),
        (None, None) => Ok(None),
    }
}

/// The same for a camera whose keys stand where `place` says.
pub(super) fn resolved_at(spec: &CameraSpec, place: &dyn Fn(&str) -> Place) -> Result<Camera> {
    let preset = known(spec).map_err(|error| error.at(place("preset")))?;
    let stated = stated_at(spec, place)?;
    let camera = |preset: &Preset| {
        preset.camera().map_err(|missing| {
            missing.error(&preset.name).at(place(missing.0.first().copied().unwrap_or("preset")))
        })
    };
    let mut camera_made = camera(&stated)?;
    camera_made.name = match (&spec.preset, preset) {
        (Some(name), Some(preset)) => match preset.camera() {
            Ok(own) => match camera_made.changed_from(&own).as_slice() {
                [] => name.clone(),
                keys => format!("{name} with {} changed", keys.join(", ")),
            },
            // What no document states is of the scenario.
            Err(_) => format!("{name} as completed"),
        },
        _ => "the camera".into(),
    };
    checked_at(camera_made, place)
}

/// All that is stated of a camera, by what it lies over and by its own keys, which stand where `place` says.
pub(super) fn stated_at(spec: &CameraSpec, place: &dyn Fn(&str) -> Place) -> Result<Preset> {
    let preset = known(spec).map_err(|error| error.at(place("preset")))?;
    check_conditions(spec, preset.as_ref(), place)?;
    overridden(spec, preset.unwrap_or_default())
}

/// A camera whose figures make one; a mistake is told where its key stands.
pub(super) fn checked_at(camera: Camera, place: &dyn Fn(&str) -> Place) -> Result<Camera> {
    camera.checked().map_err(|error| {
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
    for row in TABLE.iter().filter(|row| row.part == Part::Condition(&["netd"])) {
        if row.is_given(spec) && spec.noise.netd_k.is_none() {
            let found = format!("{} without a netd", row.key);
            return Err(Error::malformed(found, "write netd = \"50 mK\" beside it").at(place(row.key)));
        }
    }
    if spec.noise_exposure_s.is_some() && !spec.states_noise() {
        let instead = "write netd, detectivity or noise_electrons beside it";
        return Err(Error::malformed("noise_exposure without a noise", instead).at(place("noise_exposure")));
    }
    let of_bandwidth = [("detectivity", spec.noise.detectivity_cm_hz05_w), ("nep", spec.noise.nep_w_hz05)];
    match of_bandwidth.iter().find(|(_, given)| given.is_some()) {
        None if spec.noise.bandwidth_hz.is_some() => {
            let instead = "write detectivity = \"4.7e10 cm Hz^0.5/W\" or nep beside it";
            let error = Error::malformed("noise_bandwidth without a detectivity or nep", instead);
            Err(error.at(place("noise_bandwidth")))
        }
        // A preset that states such a noise states its conditions too.
        Some((key, _))
            if spec.noise.bandwidth_hz.is_none()
                && spec.noise_exposure_s.is_none()
                && !preset.is_some_and(|preset| preset.figures.noise.is_of_bandwidth()) =>
        {
            let instead =
                "write noise_bandwidth = \"175 kHz\", or noise_exposure = \"2.86 us\" for 1/(2 x 2.86 us)";
            Err(Error::malformed(format!("{key} without a bandwidth"), instead).at(place(key)))
        }
        _ => Ok(()),
    }
}

/// Noise that comes with a preset is stated under the preset's conditions.
fn under_own_conditions(figures: &mut CameraSpec) {
    if figures.noise.netd_k.is_some() {
        let noise = &mut figures.noise;
        noise.netd_f_number = noise.netd_f_number.or(figures.f_number);
        noise.netd_optics_efficiency =
            noise.netd_optics_efficiency.or(figures.optics_efficiency.as_ref().and_then(Efficiency::number));
        noise.netd_pixel_m = noise.netd_pixel_m.or(figures.pixel_m);
    }
}

/// The same camera with its preset's noise as one of its own, under the preset's conditions, so that it can be changed alone.
pub(super) fn with_own_noise(spec: &CameraSpec) -> CameraSpec {
    let preset = known(spec).ok().flatten();
    match preset {
        Some(Preset { mut figures, .. }) if !spec.states_noise() => {
            under_own_conditions(&mut figures);
            let noise_exposure_s = figures.noise_exposure_s.or(figures.exposure_s);
            CameraSpec { noise: figures.noise, noise_exposure_s, ..spec.clone() }
        }
        _ => spec.clone(),
    }
}

/// The preset with the scenario's figures laid over it.
fn overridden(spec: &CameraSpec, preset: Preset) -> Result<Preset> {
    let mut stated = preset;
    let figures = &mut stated.figures;
    let own_noise_exposure = figures.noise_exposure_s.or(figures.exposure_s);
    let conditions = figures.noise.is_of_bandwidth();
    let own_bandwidth = figures.noise.bandwidth_hz;
    under_own_conditions(figures);
    for row in TABLE.iter().filter(|row| row.part == Part::Own) {
        row.lay(spec, figures);
        if let (Kind::Efficiency(..), Some(path)) = (row.kind, row.file(spec)) {
            let rows = column(path, "efficiency", "read the efficiency")?;
            let curve = EfficiencyCurve::new(row.key, rows).map_err(|error| error.in_file(path))?;
            stated.efficiency_curves.push(curve);
        }
    }
    if !spec.states_noise() {
        // Noise that comes with the preset is stated at the preset's exposure.
        figures.noise_exposure_s = own_noise_exposure.or(figures.exposure_s);
        return Ok(stated);
    }
    let mut noise = spec.noise.clone();
    if noise.netd_k.is_some() {
        // Without a word on it the NETD is of the reference temperature, through the camera's own optics.
        let reference_k = figures.reference_temperature_k.unwrap_or(REFERENCE_K);
        noise.netd_temperature_k.get_or_insert(reference_k);
        noise.netd_f_number = noise.netd_f_number.or(figures.f_number);
    }
    // Noise of the scenario's own is stated at the camera's exposure, one of the preset's kind at the preset's.
    let exposure_s =
        if noise.is_of_bandwidth() && conditions { own_noise_exposure } else { figures.exposure_s };
    if noise.is_of_bandwidth() && spec.noise_exposure_s.is_none() {
        noise.bandwidth_hz = noise.bandwidth_hz.or(own_bandwidth);
    }
    if let Some(path) = &noise.table {
        let rows = column(path, "sigma_counts", "read the noise")?;
        stated.noise_table = Some(NoiseSpec::table(rows).map_err(|error| error.in_file(path))?);
    }
    figures.noise_exposure_s = spec.noise_exposure_s.or(exposure_s);
    figures.noise = noise;
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

#[cfg(test)]
mod tests {
    use super::*;
    use hadar::instrument::Readout;
    use hadar::instrument::figures::{self, Row};
    use hadar_scenario::Scenario;

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
            spec.noise.netd_k = Some(0.2);
        });
        assert_eq!(changed, "flir-a325sc with exposure, netd changed");
        assert_eq!(
            name(&|spec| spec.noise.electrons = Some(7.0)),
            "flir-a325sc with noise_electrons changed"
        );
        assert_eq!(name(&|spec| spec.frames = Some(16)), "flir-a325sc with frames changed");
    }

    /// A camera like the FLIR of the paper with one figure changed, and what that figure cannot be stated without.
    fn with_changed(row: &Row, table: &Path) -> CameraSpec {
        let own = CameraSpec::of(&presets::get("flir-a325sc").unwrap());
        let mut spec = CameraSpec { preset: Some("flir-a325sc".into()), ..CameraSpec::default() };
        match row.key {
            "noise_bandwidth" => spec.noise.detectivity_cm_hz05_w = Some(1e10),
            "detectivity" | "nep" => spec.noise_exposure_s = own.noise_exposure_s,
            "quantisation_bits" => spec.full_well = Some(1e7),
            "filter_temperature" => spec.sensor_temperature_k = Some(300.0),
            _ if matches!(row.part, Part::Condition(_)) => spec.noise.netd_k = own.noise.netd_k,
            _ => {}
        }
        match row.kind {
            Kind::Quantity(..) | Kind::Number(..) | Kind::Efficiency(..) => {
                let value = row.number(&own).filter(|value| *value > 0.0).map_or(1.0, |value| 0.9 * value);
                row.put_number(&mut spec, value);
            }
            Kind::Count(slot) => {
                *(slot.at)(&mut spec) = (slot.of)(&own).map_or(Some(2), |count| Some(count + 1))
            }
            Kind::Flag(slot) => *(slot.at)(&mut spec) = (slot.of)(&own).map(|flag| !flag),
            Kind::Readout(slot) => *(slot.at)(&mut spec) = Some(Readout::Sequential),
            Kind::Span(slot) => *(slot.at)(&mut spec) = Some([700.0, 1300.0]),
            Kind::File(slot) => *(slot.at)(&mut spec) = Some(table.to_owned()),
            Kind::Name(_) => {}
        }
        spec
    }

    #[test]
    fn every_figure_that_is_changed_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let table = folder.path().join("table.csv");
        std::fs::write(&table, "wavenumber_cm1,sigma_counts,efficiency\n700,1e5,0.5\n1300,2e5,0.8\n")
            .unwrap();
        let name = |spec: &CameraSpec| resolved(spec, &Source::default()).unwrap().name;
        for row in TABLE.iter().filter(|row| row.key != "preset") {
            let name = name(&with_changed(row, &table));
            let keys = name.strip_prefix("flir-a325sc with ").and_then(|rest| rest.strip_suffix(" changed"));
            let expected = match row.part {
                // A noise under other conditions is another noise.
                Part::Condition(noises) if row.key != "noise_exposure" => noises[0],
                _ => row.key,
            };
            let named = keys.is_some_and(|keys| keys.split(", ").any(|key| key == expected));
            assert!(named, "{}: {name}", row.key);
        }
        for key in ["optics_efficiency", "quantum_efficiency"] {
            let mut spec = CameraSpec { preset: Some("flir-a325sc".into()), ..CameraSpec::default() };
            if let Some(Kind::Efficiency(_, slot)) = figures::row(key).map(|row| row.kind) {
                *(slot.at)(&mut spec) = Some(Efficiency::File(table.clone()));
            }
            assert_eq!(name(&spec), format!("flir-a325sc with {key} changed"));
        }
    }

    /// Every example of the table can be read, and is written as it was.
    #[test]
    fn the_examples_of_the_table_are_read_and_written() {
        for row in TABLE {
            let text = format!(
                "[target]\nmaterial = \"skin\"\ntemperature = \"37 degC\"\n[camera]\n{} = {}\n",
                row.key, row.example
            );
            let scenario = Scenario::from_toml(&text, None).unwrap_or_else(|error| panic!("{error}"));
            assert!(scenario.camera.as_ref().is_some_and(|spec| row.is_given(spec)), "{}", row.key);
            assert_eq!(Scenario::from_toml(&scenario.to_toml(), None).unwrap(), scenario, "{}", row.key);
        }
    }
}
