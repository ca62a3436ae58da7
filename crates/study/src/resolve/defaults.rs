//! What a scenario leaves silent: unknowns and ranges, and the echo that says everything.

use super::super::camera::with_filed_noise;
use hadar::error::{Error, Result};
use hadar::fisher::{Nuisance, Unknowns};
use hadar::identifiability::nearest::StateRange;
use hadar::instrument::figures::{self, Part, TABLE};
use hadar::instrument::presets::Preset;
use hadar::instrument::{Camera, CameraSpec};
use hadar_scenario::{MaterialRef, Scenario};

pub(super) fn unknowns(scenario: &Scenario) -> Result<Unknowns> {
    let unknown = &scenario.unknown;
    let mut unknowns =
        Unknowns::new(unknown.nuisances.iter().copied())?.lighting_total(unknown.lighting_total)?;
    for (nuisance, sigma) in &unknown.priors {
        unknowns = unknowns.prior(*nuisance, *sigma)?;
    }
    Ok(unknowns)
}

pub(super) fn state_range(scenario: &Scenario) -> StateRange {
    let default = StateRange::default();
    StateRange {
        temperature_k: scenario.alternatives.temperature_range_k.unwrap_or(default.temperature_k),
        lighting: scenario.alternatives.lighting_range.unwrap_or(default.lighting),
        lighting_sum: default.lighting_sum,
    }
}

/// The least lighting of all objects together must fit into what they may sum to, and what alternatives share with the target since it is
/// known must be within what is said of them.
pub(super) fn check_range(scenario: &Scenario, range: &StateRange) -> Result<()> {
    let is_known = |nuisance| !scenario.unknown.nuisances.contains(&nuisance);
    let outside = |[low, high]: [f64; 2], value: f64| !(low..=high).contains(&value);
    let shared = |key: &str, found: String, name: &str| {
        let instead = format!("add \"{name}\" to unknown.nuisances, or leave {key} out");
        Err(Error::malformed(found, instead).at(scenario.place(key)))
    };
    let own_k = scenario.target.temperature_k;
    let stated = scenario.alternatives.temperature_range_k;
    if is_known(Nuisance::Temperature) && stated.is_some_and(|range_k| outside(range_k, own_k)) {
        let found =
            format!("the target's {own_k} K, which alternatives have too since it is known, is not within");
        return shared("alternatives.temperature", found, "temperature");
    }
    let lit = scenario.environment.iter().map(|object| object.lighting);
    let stated = scenario.alternatives.lighting_range.filter(|_| is_known(Nuisance::Lighting));
    if let Some(lighting) = stated.and_then(|range| lit.clone().find(|lighting| outside(range, *lighting))) {
        let found = format!(
            "the target's lighting {lighting}, which alternatives have too since it is known, is not within"
        );
        return shared("alternatives.lighting", found, "lighting");
    }
    let least = range.lighting[0] * scenario.environment.len() as f64;
    let most = scenario.unknown.lighting_total.unwrap_or(range.lighting_sum);
    if least <= most {
        return Ok(());
    }
    let found = format!("a lighting of at least {} for each object makes {least} in all", range.lighting[0]);
    let error = Error::malformed(found, format!("lower it, so that all together stay at or below {most}"));
    Err(error.at(scenario.place("alternatives.lighting")))
}

/// Fills in what the scenario left silent and others knew, so that its echo says everything.
pub(super) fn fill(
    scenario: &mut Scenario,
    alternatives: &[String],
    camera: Option<(&Camera, &Preset)>,
    range: &StateRange,
) {
    if scenario.alternatives.materials.is_none() {
        scenario.alternatives.materials =
            Some(alternatives.iter().map(|name| MaterialRef::Name(name.clone())).collect());
    }
    scenario.alternatives.temperature_range_k = Some(range.temperature_k);
    scenario.alternatives.lighting_range = Some(range.lighting);
    if let (Some(spec), Some((camera, stated))) = (scenario.camera.as_mut(), camera) {
        *spec = with_filed_noise(spec, stated);
        // A preset's noise stays the preset's, stated under the preset's own conditions. Noise of the
        // scenario's own is written with its conditions, so that it stays what it is when the rest is changed.
        let used = CameraSpec::of(camera);
        // What nobody stated is not stated by the program either: asked again, the echo rests on it as this answer does.
        let is_open = |key: &str| camera.assumed.iter().any(|one| one.figure == key);
        let noise_is_open =
            TABLE.iter().any(|row| matches!(row.part, Part::Condition(_)) && is_open(row.key));
        for row in TABLE {
            let is_filled = match row.part {
                Part::Own => !is_open(row.key),
                Part::Noise => false,
                Part::Condition(noises) => {
                    // Nor is half of what a noise is stated for.
                    !noise_is_open
                        && noises
                            .iter()
                            .any(|key| figures::row(key).is_some_and(|noise| noise.is_given(spec)))
                }
            };
            if is_filled && !row.is_given(spec) {
                row.lay(&used, spec);
            }
        }
    }
}
