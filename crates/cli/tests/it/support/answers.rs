//! What tests of `hadar identify` share: scenarios, and reading of its JSON.

use super::folder::Folder;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};

/// Five materials and an ideal camera that tells some of them apart, in bands that are quick.
pub(crate) const FIVE: &str = r#"[target]
material = "skin"
temperature = "60 degC"
[[environment]]
temperature = "20 degC"
lighting = 0.5
[alternatives]
materials = ["aluminium", "fused-silica", "pmma", "concrete"]
[bands]
step = "5 cm^-1"
[camera]
exposure = "1 us"
pixel = "12 um"
f_number = 1.3
focal_length = "18 mm"
noise_electrons = 0
"#;

/// The whole built-in library by the camera of the paper.
pub(crate) const LIBRARY: &str = r#"[target]
material = "skin"
temperature = "37 degC"
[[environment]]
temperature = "20 degC"
lighting = 0.5
[bands]
step = "10 cm^-1"
[camera]
preset = "flir-a325sc"
"#;

pub(crate) const EVERYTHING: [&str; 9] =
    ["--matrix", "--scaling", "--bands", "3", "--filters", "3", "--exact", "--half-width", "0.05"];

pub(crate) fn example() -> String {
    hadar_testing::repository().join("examples/five_materials.toml").display().to_string()
}

pub(crate) fn identify(folder: &Folder, more: &[&str]) -> Value {
    folder.json(&[&["identify", "a.toml"], more].concat())
}

#[track_caller]
pub(crate) fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("not a number: {value}"))
}

#[track_caller]
pub(crate) fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap_or_else(|| panic!("not a list: {value}")).iter().map(number).collect()
}

#[track_caller]
pub(crate) fn texts(value: &Value) -> Vec<&str> {
    value.as_array().unwrap().iter().map(|text| text.as_str().unwrap()).collect()
}

#[track_caller]
pub(crate) fn close(what: &str, a: f64, b: f64, relative: f64) {
    assert!((a - b).abs() <= relative * a.abs().max(b.abs()), "{what}: {a:e} {b:e}");
}

pub(crate) fn keys(value: &Value) -> Vec<&str> {
    value.as_object().map(|object| object.keys().map(String::as_str).collect()).unwrap_or_default()
}

#[track_caller]
pub(crate) fn has(value: &Value, expected: &[&str]) {
    for key in expected {
        assert!(keys(value).contains(key), "`{key}` is missing among {:?}", keys(value));
    }
}

/// Pair by pair of the target: what a key says about each alternative.
pub(crate) fn by_alternative<'a>(result: &'a Value, key: &str) -> BTreeMap<&'a str, &'a Value> {
    let pairs = result["pairs"].as_array().unwrap().iter();
    pairs.map(|pair| (pair["alternative"].as_str().unwrap(), &pair[key])).collect()
}

/// Pairs of names, each in order.
pub(crate) fn pairs(value: &Value) -> BTreeSet<(String, String)> {
    let sorted = |pair: &Value| {
        let (a, b) = (pair[0].as_str().unwrap().to_owned(), pair[1].as_str().unwrap().to_owned());
        if a < b { (a, b) } else { (b, a) }
    };
    value.as_array().unwrap().iter().map(sorted).collect()
}

/// The same answer but for rounding.
#[track_caller]
pub(crate) fn same(a: &Value, b: &Value, path: &str) {
    match (a, b) {
        (Value::Object(x), Value::Object(y)) => {
            assert_eq!(x.keys().collect::<Vec<_>>(), y.keys().collect::<Vec<_>>(), "{path}");
            x.iter().for_each(|(key, value)| same(value, &y[key], &format!("{path}.{key}")));
        }
        (Value::Array(x), Value::Array(y)) => {
            assert_eq!(x.len(), y.len(), "{path}");
            x.iter().zip(y).for_each(|(x, y)| same(x, y, path));
        }
        (Value::Number(x), Value::Number(y)) => {
            let (x, y) = (x.as_f64().unwrap(), y.as_f64().unwrap());
            assert!((x - y).abs() <= 1e-9 * x.abs(), "{path}: {x:e} {y:e}");
        }
        _ => assert_eq!(a, b, "{path}"),
    }
}
