//! What is said from both sides is in order, on every number of every answer.

use crate::solved::{Task, library, task};
use hadar_scenario::Scenario;
use hadar_study::{Asked, Study, Watch};
use hadar_testing::seeded;
use proptest::prelude::*;
use serde_json::Value;

/// Roundings of one number taken two ways.
const ROUNDING: f64 = 1e-12;

/// Numbers of a value, place by place; `None` where there is none.
fn numbers(value: &Value) -> Vec<Option<f64>> {
    match value {
        Value::Array(all) => all.iter().flat_map(numbers).collect(),
        one => vec![one.as_f64()],
    }
}

/// Every place where what should be less is more.
fn disorder(value: &Value, place: &str, seen: &mut usize, found: &mut Vec<String>) {
    let fields = match value {
        Value::Object(fields) => fields,
        Value::Array(all) => {
            all.iter().enumerate().for_each(|(i, one)| disorder(one, &format!("{place}[{i}]"), seen, found));
            return;
        }
        _ => return,
    };
    let mut ordered = |what: String, low: &Value, high: &Value| {
        for (low, high) in numbers(low).into_iter().zip(numbers(high)) {
            if let (Some(low), Some(high)) = (low, high) {
                *seen += 1;
                if low > high + ROUNDING * low.abs().max(high.abs()) {
                    found.push(format!("{place}.{what}: {low} above {high}"));
                }
            }
        }
    };
    for (key, one) in fields {
        let stem = |end: &str| key.strip_suffix(end).filter(|stem| !stem.is_empty());
        let of = |name: &str| fields.get(name);
        if let Some(own) = stem("_lower").and_then(of) {
            ordered(key.clone(), one, own);
        }
        if let Some(stem) = stem("_lower")
            && let Some(upper) = fields.get(&format!("{stem}_upper"))
        {
            ordered(key.clone(), one, upper);
        }
        if let Some(own) = stem("_upper").and_then(of) {
            ordered(key.clone(), own, one);
        }
        let of_both = ["bounds", "interval", "bracket"].iter().any(|part| key.contains(part));
        if let (true, Value::Array(ends)) = (of_both, one)
            && let [low, high] = &ends[..]
        {
            ordered(key.clone(), low, high);
            // The figure that the ends are of: `photons` of `photons_bounds`.
            for own in [key.replace("_bounds", ""), key.replace("_interval", "")] {
                if own != *key
                    && let Some(own) = of(&own)
                {
                    ordered(format!("{key}, lower"), low, own);
                    ordered(format!("{key}, upper"), own, high);
                }
            }
        }
    }
    for [low, high] in [
        ["lower", "upper"],
        ["low", "high"],
        ["lower", "statistical_distance_nearest"],
        ["lower_bound", "statistical_distance"],
        ["distance_5", "distance_95"],
    ] {
        if let (Some(low_value), Some(high_value)) = (fields.get(low), fields.get(high)) {
            ordered(low.to_owned(), low_value, high_value);
        }
    }
    // What suffices is no easier than what is necessary.
    if let (Some(value), Some(necessary)) = (fields.get("value"), fields.get("necessary")) {
        let greatest = ["f_number", "noise_counts", "distance_m", "speed_m_s"];
        match greatest.iter().any(|key| place.ends_with(key)) {
            true => ordered("value, necessary".into(), value, necessary),
            false => ordered("necessary, value".into(), necessary, value),
        }
    }
    fields.iter().for_each(|(key, one)| disorder(one, &format!("{place}.{key}"), seen, found));
}

fn check(what: &impl serde::Serialize, text: &str) -> Result<usize, TestCaseError> {
    let json = serde_json::to_value(what).expect("an answer is JSON");
    let (mut seen, mut found) = (0, Vec::new());
    disorder(&json, "", &mut seen, &mut found);
    prop_assert!(found.is_empty(), "{}\n{text}", found.join("\n"));
    Ok(seen)
}

fn ordered(task: &Task, required: f64) -> Result<(), TestCaseError> {
    let text = task.scenario(required, None, None);
    let scenario = Scenario::from_toml(&text, None).unwrap_or_else(|error| panic!("{error}\n{text}"));
    let study = Study::new(&scenario, library()).unwrap_or_else(|error| panic!("{error}\n{text}"));
    let sizing = study.size_with_curves().unwrap_or_else(|error| panic!("{error}\n{text}"));
    let asked = Asked {
        matrix: true,
        apart: true,
        skipping: hadar::demand::Skipping::On,
        scaling: false,
        bands: None,
        exact: None,
        average: false,
    };
    let answers = study.answer(&asked, &Watch::NONE).unwrap_or_else(|error| panic!("{error}\n{text}"));
    let seen = check(&sizing, &text)? + check(&answers, &text)?;
    prop_assert!(seen > 20, "{seen} pairs of numbers");
    Ok(())
}

proptest! {
    #![proptest_config(seeded(41, 12))]
    #[test]
    fn lower_is_not_above_upper(task in task(), required in -2.0..2.0f64) {
        ordered(&task, 10f64.powf(required))?;
    }

    /// The same where the exposure leaves a few photons.
    #[test]
    fn nor_where_counts_are_few(task in task(), required in -2.0..0.7f64, photons in 0.0..5.0f64) {
        let mut few = task;
        few.exposure_s *= 10f64.powf(photons - 9.0);
        (few.noise, few.full_well) = (0.0, None);
        ordered(&few, 10f64.powf(required))?;
    }
}
