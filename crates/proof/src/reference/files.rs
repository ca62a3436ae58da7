//! The files of 30-digit answers, as tests read them.

use std::path::Path;

/// Wavenumbers and emissivities of a material.
pub(super) fn table(root: &Path, name: &str) -> (Vec<f64>, Vec<f64>) {
    let text = std::fs::read_to_string(root.join(format!("emissivity/{name}.csv"))).unwrap();
    let row = |line: &str| {
        let (nu, e) = line.split_once(',').unwrap();
        (nu.parse::<f64>().unwrap(), e.parse::<f64>().unwrap())
    };
    text.lines().skip(1).map(row).unzip()
}

/// The digits of a number, which may stand there as text.
pub(super) fn text(value: &serde_json::Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}
