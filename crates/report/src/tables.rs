//! Tables that several commands write.

use super::table::{Table, number, optional};
use crate::words::Say;
use hadar_study::companion::Condition;
use hadar_study::{Companion, PairResult, Warning};

/// All pairs as a table.
#[must_use]
pub fn pairs(pairs: &[PairResult]) -> Table {
    let mut table = Table::new([
        "target",
        "alternative",
        "distance_nearest_per_sqrt_photon",
        "distance_local_per_sqrt_photon",
        "distance_local_unknown_gain_per_sqrt_photon",
        "distance_no_nuisance_per_sqrt_photon",
        "distance_return_per_sqrt_photon",
        "nearest_temperature_k",
        "nearest_lighting",
        "photons_required_nearest",
        "photons_required_local",
        "photons_required_local_unknown_gain",
        "statistical_distance_camera",
        "detection_probability_camera",
        "miss_probability_camera",
        "information_bits_camera",
        "condition_number",
        "distance_nearest_lower_per_sqrt_photon",
        "relative_error_nearest",
        "relative_error_return",
        "relative_error_local",
        "relative_error_local_unknown_gain",
    ]);
    for pair in pairs {
        let lighting: Vec<String> = pair.nearest_state.lighting.iter().map(|&v| number(v)).collect();
        table.push(vec![
            pair.target.clone(),
            pair.alternative.clone(),
            number(pair.distance_nearest),
            number(pair.distance_local),
            number(pair.distance_local_unknown_gain),
            number(pair.distance_no_nuisance),
            number(pair.distance_return),
            number(pair.nearest_state.temperature_k),
            lighting.join(" "),
            optional(pair.photons_required_by.nearest),
            optional(pair.photons_required_by.local),
            optional(pair.photons_required_by.local_unknown_gain),
            optional(pair.statistical_distance),
            optional(pair.detection_probability),
            optional(pair.miss_probability),
            optional(pair.information_bits),
            optional(pair.condition_number),
            number(pair.distance_nearest_lower),
            number(pair.relative_error_nearest),
            number(pair.relative_error_return),
            number(pair.relative_error),
            number(pair.relative_error_unknown_gain),
        ]);
    }
    table
}

/// Warnings with their codes.
#[must_use]
pub fn warnings(warnings: &[Warning]) -> Table {
    let mut table = Table::new(["code", "message"]);
    for warning in warnings {
        table.push(vec![warning.code().name().into(), warning.say()]);
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
