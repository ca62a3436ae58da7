//! Tables that several commands write.

use super::table::{Table, joined, number, optional, yes_no};
use crate::words::Say;
use hadar_study::companion::Condition;
use hadar_study::{Companion, Condition as RestsOn, PairResult, SafetyOfTarget, Warning};

/// All pairs as a table.
#[must_use]
pub fn pairs(pairs: &[PairResult]) -> Table {
    Table::of(
        pairs,
        &[
            ("target", &|pair| pair.target.clone()),
            ("alternative", &|pair| pair.alternative.clone()),
            ("distance_nearest_per_sqrt_photon", &|pair| number(pair.distance_nearest)),
            ("distance_local_per_sqrt_photon", &|pair| number(pair.distance_local)),
            ("distance_local_unknown_gain_per_sqrt_photon", &|pair| number(pair.distance_local_unknown_gain)),
            ("distance_no_nuisance_per_sqrt_photon", &|pair| number(pair.distance_no_nuisance)),
            ("distance_return_per_sqrt_photon", &|pair| number(pair.distance_return)),
            ("nearest_temperature_k", &|pair| number(pair.nearest_state.temperature_k)),
            ("nearest_lighting", &|pair| joined(&pair.nearest_state.lighting)),
            ("photons_required_nearest", &|pair| optional(pair.photons_required_by.nearest)),
            ("photons_required_local", &|pair| optional(pair.photons_required_by.local)),
            ("photons_required_local_unknown_gain", &|pair| {
                optional(pair.photons_required_by.local_unknown_gain)
            }),
            ("statistical_distance_camera", &|pair| optional(pair.statistical_distance)),
            ("detection_probability_camera", &|pair| optional(pair.detection_probability)),
            ("miss_probability_camera", &|pair| optional(pair.miss_probability)),
            ("information_bits_camera", &|pair| optional(pair.information_bits)),
            ("condition_number", &|pair| optional(pair.condition_number)),
            ("distance_nearest_lower_per_sqrt_photon", &|pair| number(pair.distance_nearest_lower)),
            ("distance_return_lower_per_sqrt_photon", &|pair| number(pair.distance_return_lower)),
            ("statistical_distance_camera_lower", &|pair| {
                optional(pair.statistical_distance_bounds.map(|[lower, _]| lower))
            }),
            ("photons_required_proved", &|pair| optional(pair.photons_required)),
            ("relative_error_nearest", &|pair| number(pair.relative_error_nearest)),
            ("relative_error_return", &|pair| number(pair.relative_error_return)),
            ("relative_error_local", &|pair| number(pair.relative_error)),
            ("relative_error_local_unknown_gain", &|pair| number(pair.relative_error_unknown_gain)),
        ],
    )
}

/// Categories that matter for safety where a target is, a row a material of them.
#[must_use]
pub fn safety(all: &[SafetyOfTarget]) -> Table {
    let mut table = Table::new([
        "category",
        "target",
        "target_is_of_it",
        "category_excluded",
        "material",
        "compared",
        "excluded",
        "probability_left_at_least",
        "conditions",
    ]);
    for found in all {
        let conditions = found.conditions.iter().map(RestsOn::code).collect::<Vec<_>>().join(" ");
        for one in &found.materials {
            table.push(vec![
                found.category.clone(),
                found.target.clone(),
                yes_no(found.is_target),
                yes_no(found.excluded),
                one.material.clone(),
                yes_no(one.compared),
                yes_no(one.excluded),
                optional(one.probability_left_at_least),
                if one.excluded { conditions.clone() } else { String::new() },
            ]);
        }
    }
    table
}

/// Warnings with their codes.
#[must_use]
pub fn warnings(warnings: &[Warning]) -> Table {
    Table::of(
        warnings,
        &[("code", &|warning| warning.code().name().into()), ("message", &|warning| warning.say())],
    )
}

/// What verdicts rest on, each with the camera that it is of; nothing where there is one alone.
pub(crate) fn conditions<'a>(all: impl IntoIterator<Item = (&'a str, &'a RestsOn)>) -> Table {
    let mut table = Table::new(["camera", "code", "kind", "favourable", "figure", "sentence"]);
    for (camera, one) in all {
        let (kind, favourable) = (one.kind().name().to_owned(), one.favourable().to_string());
        table.push(vec![camera.to_owned(), one.code(), kind, favourable, one.figure(), one.say()]);
    }
    table
}

/// The tables of any number of cameras as one: a row a value.
pub(crate) fn companions<'a>(companions: impl IntoIterator<Item = &'a Companion>) -> Table {
    let header = ["camera", "kind", "code", "task", "quantity", "value", "conditions", "caveat", "unknown"];
    let mut table = Table::new(header);
    for companion in companions {
        for row in &companion.rows {
            let conditions = row.conditions.iter().map(|(name, condition)| match condition {
                Condition::Number(value) => format!("{name}={}", number(*value)),
                Condition::Text(text) => format!("{name}={text}"),
            });
            let conditions = conditions.collect::<Vec<_>>().join("; ");
            for (quantity, value) in row.named() {
                table.push(vec![
                    companion.camera.clone().unwrap_or_default(),
                    row.measure.kind().code().into(),
                    row.measure.code().into(),
                    row.task.map_or("", |task| task.name()).into(),
                    quantity.into(),
                    optional(value),
                    conditions.clone(),
                    row.measure.caveat().code().into(),
                    row.unknown().map_or_else(String::new, |unknown| unknown.say()),
                ]);
            }
        }
    }
    table
}
