//! Cameras as the reports show them: what is stated, what is missing, and what follows.

mod sheet;

pub use crate::words::cameras::{comparison, list, text};
pub use sheet::{Sheet, SideBySide, Worked};

use crate::json::value;
use crate::words::cameras::{alone, caveats, comparison_sentence, in_scene};
use hadar::error::Result;
use hadar::instrument::comparison::SCENE_K;
use serde_json::{Map, Value};

/// All of two cameras side by side as JSON; ratios are of B over A.
///
/// # Errors
/// What cannot be written as JSON.
pub fn comparison_json(both: &SideBySide) -> Result<Value> {
    let mut ratios = Map::new();
    for row in alone(both).iter().chain(&in_scene(both)) {
        ratios.insert(row.key.into(), value(&row.ratio())?);
    }
    let compared = both.comparison.as_ref();
    ratios.insert("photons_in_same_time".into(), value(&compared.map(|of| of.photons_in_same_time))?);
    ratios.insert("distance_in_same_time".into(), value(&compared.map(|of| of.distance_in_same_time))?);
    let (mut a, mut b) = (both.a.json()?, both.b.json()?);
    a.insert("in_scene".into(), value(&compared.map(|of| &of.a))?);
    b.insert("in_scene".into(), value(&compared.map(|of| &of.b))?);
    Ok(serde_json::json!({
        "sentence": comparison_sentence(both),
        "scene_temperature_k": SCENE_K,
        "lens_of_both": both.lens.map(|[f_number, focal_length_m]| serde_json::json!({ "f_number": f_number, "focal_length_m": focal_length_m })),
        "common_range_cm1": compared.map(|of| of.range_cm1),
        "a": a,
        "b": b,
        "ratios": ratios,
        "caveats": value(&caveats(both))?,
    }))
}
