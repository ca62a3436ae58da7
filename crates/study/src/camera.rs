//! The camera of a scenario: a preset with what the scenario overrides.

use hadar::error::{Error, Place, Result};
use hadar::grid::Grid;
use hadar::instrument::figures::{self, Kind, NOISES, NoiseFigures, Part, StatedNoise, TABLE};
use hadar::instrument::presets::{self, Preset};
use hadar::instrument::{Camera, EfficiencyCurve, NoiseCamera, NoiseSpec};
use hadar::words::quantity;
use hadar_formats::file::text_of_file;
use hadar_scenario::{CameraSpec, Scenario, Source};
use std::borrow::Cow;
use std::path::Path;
use std::sync::Arc;

/// The preset with what the scenario overrides; without a preset everything must be said.
pub(super) fn resolved(spec: &CameraSpec, source: &Source) -> Result<Camera> {
    resolved_at(spec, &|key| source.place(&format!("camera.{key}")))
}

/// The same with all that is stated of it.
pub(super) fn resolved_as_stated(spec: &CameraSpec, source: &Source) -> Result<(Camera, Preset)> {
    made_at(spec, &|key| source.place(&format!("camera.{key}")))
}

/// What a camera is called in a message: a known one by its name, whatever was changed of it.
pub(super) fn called(camera: &Camera, spec: &CameraSpec) -> String {
    spec.preset.clone().unwrap_or_else(|| camera.name.clone())
}

/// Refuses a time of the decision in which the camera does not even expose once.
pub(super) fn check_time(camera: &Camera, scenario: &Scenario) -> Result<()> {
    let Some(time_s) = scenario.requirement.time_s.filter(|time_s| *time_s < camera.exposure_s) else {
        return Ok(());
    };
    let [time, exposure] = [time_s, camera.exposure_s].map(|seconds| quantity(seconds, "s"));
    let found = format!("a decision after {time}, and one exposure of {} takes {exposure}", camera.name);
    let instead = format!("write {exposure} or more, or shorten camera.exposure");
    Err(Error::malformed(found, instead).at(scenario.place("requirement.time")))
}

/// What is known of the camera that a spec names, one of the user's own or of the program's; nothing where it names none.
pub(super) fn known(spec: &CameraSpec) -> Result<Option<Cow<'static, Preset>>> {
    match (&spec.own, &spec.preset) {
        (Some(own), name) => {
            let stated = laid(own, known(own)?.unwrap_or_default().into_owned())?;
            Ok(Some(Cow::Owned(Preset { name: name.clone().unwrap_or_default(), ..stated })))
        }
        (None, Some(name)) => presets::find(name).map(|known| Some(Cow::Borrowed(known))),
        (None, None) => Ok(None),
    }
}

/// The same for a camera whose keys stand where `place` says.
pub(super) fn resolved_at(spec: &CameraSpec, place: &dyn Fn(&str) -> Place) -> Result<Camera> {
    made_at(spec, place).map(|(camera, _)| camera)
}

fn made_at(spec: &CameraSpec, place: &dyn Fn(&str) -> Place) -> Result<(Camera, Preset)> {
    let preset = known(spec).map_err(|error| error.at(place("preset")))?;
    let preset = preset.as_deref();
    let stated = stated_over(spec, preset, place);
    let stated = stated.map_err(|error| with_missing(error, spec, preset))?;
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
    Ok((checked_at(camera_made, place)?, stated))
}

/// A mistake in a camera of which figures are missing, too, with all of them: nobody is asked twice.
fn with_missing(error: Error, spec: &CameraSpec, preset: Option<&Preset>) -> Error {
    let missing =
        laid(spec, preset.cloned().unwrap_or_default()).ok().and_then(|stated| stated.camera().err());
    let Some(missing) = missing else { return error };
    match error {
        Error::At { place, source } => Error::At { place, source: Box::new(with_lines(*source, &missing)) },
        error => with_lines(error, &missing),
    }
}

fn with_lines(error: Error, missing: &presets::Missing) -> Error {
    match error {
        Error::Malformed { found, instead } => {
            let instead = format!(
                "{instead}; {} are missing as well: write what the camera has in place of the dots:",
                missing.0.join(", ")
            );
            Error::Incomplete { found, instead, lines: missing.lines() }
        }
        error => error,
    }
}

/// All that is stated of a camera, by what it lies over and by its own keys, which stand where `place` says.
pub(super) fn stated_at(spec: &CameraSpec, place: &dyn Fn(&str) -> Place) -> Result<Preset> {
    stated_over(spec, known(spec).map_err(|error| error.at(place("preset")))?.as_deref(), place)
}

fn stated_over(spec: &CameraSpec, preset: Option<&Preset>, place: &dyn Fn(&str) -> Place) -> Result<Preset> {
    check_conditions(spec, preset, place)?;
    laid(spec, preset.cloned().unwrap_or_default())
}

/// The camera of a spec with the noise of the camera as `filed` states it: what moves figures of a camera states no other noise. The
/// noise is written out with all of its conditions where it would be another one without.
#[must_use]
pub fn with_noise_kept(spec: &CameraSpec, filed: &CameraSpec) -> CameraSpec {
    let alone = CameraSpec { filed: None, ..spec.clone() };
    let moved = CameraSpec { filed: Some(Arc::new(filed.clone())), ..alone.clone() };
    match noise_alone(&moved) {
        Ok(own) => noise_written_out(alone, &own),
        Err(_) => alone,
    }
}

/// The same for a spec that knows its file, of which all this is stated.
pub(super) fn with_filed_noise(spec: &CameraSpec, stated: &Preset) -> CameraSpec {
    match spec.filed {
        Some(_) => noise_written_out(CameraSpec { filed: None, ..spec.clone() }, stated),
        None => spec.clone(),
    }
}

/// A camera with the noise of what is stated, written out where by itself it would have another one.
fn noise_written_out(alone: CameraSpec, stated: &Preset) -> CameraSpec {
    let (noise, noise_exposure_s) = stated.noise_in_full();
    let is_one = noise.table.is_some() || noise.stated().is_some_and(|noise| noise != StatedNoise::None);
    let is_other = |other: &Preset| {
        let (own, at) = other.noise_in_full();
        (&own, at, &other.noise_table) != (&noise, noise_exposure_s, &stated.noise_table)
    };
    if is_one && noise_alone(&alone).is_ok_and(|other| is_other(&other)) {
        return CameraSpec { noise, noise_exposure_s, ..alone };
    }
    alone
}

/// What is stated of a camera's noise, and nothing of what documents say beside.
fn noise_alone(spec: &CameraSpec) -> Result<Preset> {
    laid(spec, known(spec)?.as_deref().map(figures_alone).unwrap_or_default())
}

/// What is stated of a camera without what its documents say beside.
fn figures_alone(preset: &Preset) -> Preset {
    Preset {
        figures: preset.figures.clone(),
        is_noise_own: preset.is_noise_own,
        noise_at: preset.noise_at,
        efficiency_curves: preset.efficiency_curves.clone(),
        noise_table: preset.noise_table.clone(),
        ..Preset::default()
    }
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

/// Conditions of a noise that is not stated, a noise without the condition it cannot do without, and one with half of its conditions.
fn check_conditions(spec: &CameraSpec, preset: Option<&Preset>, place: &dyn Fn(&str) -> Place) -> Result<()> {
    let refuse =
        |key: &str, found: String, instead: &str| Err(Error::malformed(found, instead).at(place(key)));
    let is_of_kind = preset.is_some_and(|preset| preset.figures.noise.is_of_kind(&spec.noise));
    let conditions = || TABLE.iter().filter(|row| row.is_given(spec) && row.part.is_condition_of("netd"));
    for row in conditions() {
        if !NOISES.iter().any(|key| row.part.is_condition_of(key) && is_stated(spec, key)) {
            let found = format!("{} without a netd", row.key);
            return refuse(row.key, found, "write netd = \"50 mK\" beside it");
        }
    }
    if spec.noise_exposure_s.is_some() && !spec.states_noise() {
        let instead = "write netd, detectivity or noise_electrons beside it";
        return refuse("noise_exposure", "noise_exposure without a noise".into(), instead);
    }
    // A value of the preset's noise is one under the preset's conditions.
    let noise = &spec.noise;
    let (kelvin, f_number) = (("netd_temperature", "\"30 degC\""), ("netd_f_number", "1.0"));
    let needed = match () {
        () if is_of_kind => &[][..],
        () if noise.netd_k.is_some() => &[kelvin, f_number],
        () if noise.nesr_microflick.is_some() => &[f_number],
        () => &[],
    };
    let of_exposure = spec.noise_exposure_s.filter(|_| noise.netd_k.is_some()).map(|_| "noise_exposure");
    if let Some(key) = conditions().next().map(|row| row.key).or(of_exposure)
        && let Some((missing, example)) = needed.iter().find(|(key, _)| !is_stated(spec, key))
    {
        let found =
            format!("{key} beside a noise without its {missing}, which is half of what it is stated for");
        return refuse(key, found, &format!("write {missing} = {example} beside it, or no condition at all"));
    }
    let of_bandwidth = [("detectivity", spec.noise.detectivity_cm_hz05_w), ("nep", spec.noise.nep_w_hz05)];
    match of_bandwidth.iter().find(|(_, given)| given.is_some()) {
        None if spec.noise.bandwidth_hz.is_some() => {
            let instead = "write detectivity = \"4.7e10 cm Hz^0.5/W\" or nep beside it";
            refuse("noise_bandwidth", "noise_bandwidth without a detectivity or nep".into(), instead)
        }
        // A preset that states such a noise states its conditions too.
        Some((key, _))
            if spec.noise.bandwidth_hz.is_none() && spec.noise_exposure_s.is_none() && !is_of_kind =>
        {
            let instead =
                "write noise_bandwidth = \"175 kHz\", or noise_exposure = \"2.86 us\" for 1/(2 x 2.86 us)";
            refuse(key, format!("{key} without a bandwidth"), instead)
        }
        _ => Ok(()),
    }
}

/// What is stated of a camera over a known one. Where figures were moved over a file, the camera of the file is the one whose noise it is.
fn laid(spec: &CameraSpec, preset: Preset) -> Result<Preset> {
    let of_file = |filed: &CameraSpec| overridden(filed, figures_alone(&preset), None);
    let file = spec.filed.as_deref().map(of_file).transpose()?;
    overridden(spec, preset, file.as_ref())
}

/// Whether a key is stated.
fn is_stated(spec: &CameraSpec, key: &str) -> bool {
    figures::row(key).is_some_and(|row| row.is_given(spec))
}

/// The preset with the scenario's figures laid over it.
///
/// A noise is one figure with its conditions. It keeps them, stated or those of the camera that states it, whatever lies over that
/// camera; the same kind of noise without conditions is another value of it; any other is a noise of its own.
fn overridden(spec: &CameraSpec, preset: Preset, file: Option<&Preset>) -> Result<Preset> {
    let beneath = file.unwrap_or(&preset);
    let own_noise = beneath.figures.noise.clone();
    let own_exposure_s = beneath.figures.noise_exposure_s;
    let (own_at, is_noise_own) = (beneath.noise_camera(), beneath.is_noise_own);
    let mut stated = preset;
    let figures = &mut stated.figures;
    for row in TABLE.iter().filter(|row| row.part == Part::Own) {
        row.lay(spec, figures);
        if let (Kind::Efficiency(..), Some(path)) = (row.kind, row.file(spec)) {
            let rows = column(path, "efficiency", "read the efficiency")?;
            let curve = EfficiencyCurve::new(row.key, rows).map_err(|error| error.in_file(path))?;
            stated.efficiency_curves.push(curve);
        }
    }
    let is_of_kind = spec.noise.is_of_kind(&own_noise);
    (figures.noise, figures.noise_exposure_s) = (own_noise.clone(), own_exposure_s);
    (stated.noise_at, stated.is_noise_own) = (Some(own_at), is_noise_own);
    if !spec.states_noise() {
        return Ok(stated);
    }
    let own_in_full = stated.noise_in_full();
    let noise = spec.noise.clone();
    if let Some(path) = &noise.table {
        let rows = column(path, "sigma_counts", "read the noise")?;
        stated.noise_table = Some(NoiseSpec::table(rows).map_err(|error| error.in_file(path))?);
    } else {
        stated.noise_table = None;
    }
    let figures = &mut stated.figures;
    if is_of_kind {
        let own_bandwidth = own_noise.bandwidth_hz.filter(|_| spec.noise_exposure_s.is_none());
        figures.noise = noise.under(&NoiseFigures { bandwidth_hz: own_bandwidth, ..own_noise });
        figures.noise_exposure_s = spec.noise_exposure_s.or(own_exposure_s);
    } else {
        (figures.noise, figures.noise_exposure_s) = (noise, spec.noise_exposure_s);
        stated.noise_at = file.map(|file| NoiseCamera::of(&file.figures));
    }
    // Written out with all of its conditions it is still the document's.
    stated.is_noise_own |= !is_of_kind || stated.noise_in_full() != own_in_full;
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
    use hadar::instrument::figures::Row;
    use hadar::spectrum::Bands;
    use hadar_scenario::{Efficiency, Scenario};

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

    /// Noise in counts, and the exposure of which it is.
    fn noise_of(camera: &Camera) -> (Vec<f64>, f64) {
        let bands = Bands::from_rows([(800.0, 20.0), (1000.0, 50.0), (1200.0, 30.0)]).unwrap();
        (camera.reading_sigma(&bands).unwrap(), camera.noise_exposure_s)
    }

    /// One rule: over the file (`--set`, `--vary`, an uncertainty), written out (the page, a report) and in the camera itself (the solver).
    #[test]
    fn a_noise_is_the_same_whatever_figure_is_moved() {
        let own = CameraSpec {
            exposure_s: Some(10e-3),
            pixel_m: Some(12e-6),
            f_number: Some(1.2),
            focal_length_m: Some(14e-3),
            optics_efficiency: Some(Efficiency::Number(0.9)),
            ..CameraSpec::default()
        };
        let of = |state: &dyn Fn(&mut CameraSpec)| {
            let mut spec = own.clone();
            state(&mut spec);
            spec
        };
        // A preset that states its NETD for no lens, one that does for f/1, and noises of one's own.
        let cameras = [
            of(&|spec| spec.preset = Some("flir-tau-2-640".into())),
            of(&|spec| spec.preset = Some("flir-boson-640-14mm".into())),
            of(&|spec| spec.noise.netd_k = Some(30e-3)),
            of(&|spec| spec.noise.nesr_microflick = Some(2.0)),
            of(&|spec| (spec.noise.nep_w_hz05, spec.noise.bandwidth_hz) = (Some(1e-12), Some(50.0))),
            of(&|spec| (spec.noise.nep_w_hz05, spec.noise_exposure_s) = (Some(1e-12), Some(2e-3))),
            of(&|spec| spec.noise.electrons = Some(5e4)),
        ];
        let resolved = |spec: &CameraSpec| resolved(spec, &Source::default()).unwrap();
        let figures = ["exposure", "f_number", "pixel", "optics_efficiency"];
        for spec in &cameras {
            let camera = resolved(spec);
            for row in figures.into_iter().filter_map(figures::row) {
                let mut moved = spec.clone();
                row.put_number(&mut moved, 0.7 * row.number(spec).unwrap());
                let kept = with_noise_kept(&moved, spec);
                let over = CameraSpec { filed: Some(Arc::new(spec.clone())), ..moved.clone() };
                let mut solved = CameraSpec::of(&camera);
                row.put_number(&mut solved, 0.7 * row.number(spec).unwrap());
                for (what, found) in [("over", resolved(&over)), ("kept", resolved(&kept))] {
                    assert_eq!(noise_of(&found), noise_of(&camera), "{what} {} {spec:?}", row.key);
                    assert_eq!(row.number(&CameraSpec::of(&found)), row.number(&solved));
                }
                let trial = Camera {
                    exposure_s: solved.exposure_s.unwrap(),
                    f_number: solved.f_number.unwrap(),
                    pixel_m: solved.pixel_m.unwrap(),
                    optics_efficiency: row
                        .number(&solved)
                        .filter(|_| row.key == "optics_efficiency")
                        .unwrap_or(0.9),
                    ..camera.clone()
                };
                assert_eq!(noise_of(&trial), noise_of(&camera), "solver {} {spec:?}", row.key);
            }
        }
    }

    /// The name of a camera answers for what its document states, not for a noise that lies over it; the same noise written out is its own.
    #[test]
    fn a_name_takes_no_condition_from_a_noise_of_ones_own() {
        let silent = |camera: &Camera| -> Vec<_> {
            camera.assumed.iter().filter(|of| of.favourable).map(|of| of.figure).collect()
        };
        let noises: [&dyn Fn(&mut CameraSpec); 4] = [
            &|spec| spec.noise.netd_k = Some(0.033),
            &|spec| {
                let noise = &mut spec.noise;
                (noise.netd_k, noise.netd_temperature_k, noise.netd_f_number) =
                    (Some(0.033), Some(300.0), Some(1.0));
            },
            &|spec| spec.noise.nesr_microflick = Some(2.0),
            &|spec| spec.noise.electrons = Some(5e4),
        ];
        for preset in presets::all().unwrap() {
            let mut named = CameraSpec {
                exposure_s: Some(5e-3),
                focal_length_m: Some(20e-3),
                f_number: Some(1.3),
                pixel_m: Some(15e-6),
                full_well: Some(1e7),
                optics_efficiency: Some(Efficiency::Number(0.9)),
                preset: Some(preset.name.clone()),
                ..CameraSpec::default()
            };
            if preset.figures.noise == NoiseFigures::default() {
                named.noise.electrons = Some(5e4);
            }
            let documented = resolved(&named, &Source::default()).unwrap();
            let (noise, noise_exposure_s) = stated_at(&named, &|_| Place::default()).unwrap().noise_in_full();
            let in_full = CameraSpec { noise, noise_exposure_s, ..named.clone() };
            let is_noisy = in_full.states_noise();
            let kept = resolved(if is_noisy { &in_full } else { &named }, &Source::default()).unwrap();
            let is_added = |figure: &&str| !silent(&documented).contains(figure);
            assert_eq!(silent(&kept).iter().filter(|one| is_added(one)).count(), 0, "{}", preset.name);
            for noise in noises {
                let mut own =
                    CameraSpec { noise: NoiseFigures::default(), noise_exposure_s: None, ..named.clone() };
                noise(&mut own);
                let found = silent(&resolved(&own, &Source::default()).unwrap());
                let alone = CameraSpec { preset: None, ..own.clone() };
                let alone = silent(&resolved(&alone, &Source::default()).unwrap());
                // Whether there are pauses or bands at once is of the camera, whichever noise it has.
                let of_noise = |figure: &&&str| {
                    !["frame_rate", "readout", "spectral_range", "spectral_bands"].contains(figure)
                };
                for figure in alone.iter().filter(of_noise).filter(|figure| !found.contains(figure)) {
                    let stated = stated_at(&own, &|_| Place::default()).unwrap().figures;
                    let is_stated = figures::row(figure).is_some_and(|row| row.is_given(&stated));
                    assert!(is_stated, "{} {figure}: {found:?}", preset.name);
                }
            }
        }
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
