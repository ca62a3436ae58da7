//! What the tests of several packages share: the repository's files and those beside it, and properties whose failures
//! come back, and how colours look to the colour-blind.

pub mod vision;

#[cfg(feature = "proptest")]
use proptest::test_runner::{Config, RngSeed};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// The root of the repository.
///
/// # Panics
/// If this package has been moved.
#[must_use]
pub fn repository() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).expect("a member in crates/")
}

/// A file or folder in `shared`, beside the repository; `None`, with a printed line, where it is not there.
#[must_use]
pub fn shared(name: &str) -> Option<PathBuf> {
    let path = repository().with_file_name("shared").join(name);
    if path.exists() {
        return Some(path);
    }
    println!("skipped: no {}", path.display());
    None
}

/// The cells of a table of 30-digit references, without its head.
///
/// # Panics
/// If the file is there and cannot be read.
#[must_use]
pub fn reference_rows(name: &str) -> Option<Vec<Vec<String>>> {
    let text = std::fs::read_to_string(shared(&format!("reference/{name}"))?).expect("a readable reference");
    let cells = |line: &str| line.split(',').map(str::to_owned).collect();
    Some(text.lines().skip(1).map(cells).collect())
}

/// Pairs of materials whose distances are known to 30 digits.
///
/// # Panics
/// If the file is there and is not JSON with a list of cases.
#[must_use]
pub fn reference_pairs() -> Option<Vec<Value>> {
    let text = std::fs::read_to_string(shared("reference/pairs.json")?).expect("a readable reference");
    let file: Value = serde_json::from_str(&text).expect("JSON");
    Some(file["cases"].as_array().expect("a list of cases").clone())
}

/// Wavenumbers and emissivities of a material of those pairs.
///
/// # Panics
/// Unless the table is there and holds two numbers a row.
#[must_use]
pub fn reference_emissivity(name: &Value) -> (Vec<f64>, Vec<f64>) {
    let file = format!("emissivity/{}.csv", digits(name));
    let number = |cell: &String| cell.parse::<f64>().expect("a number");
    let rows = reference_rows(&file).expect("a table of a reference");
    rows.iter().map(|row| (number(&row[0]), number(&row[1]))).unzip()
}

/// The digits of a number, which may stand there as text.
#[must_use]
pub fn digits(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

/// The number nearest to those digits.
///
/// # Panics
/// If it is none.
#[must_use]
pub fn number(value: &Value) -> f64 {
    digits(value).parse().expect("a number")
}

/// So many cases of a property, the same in every run.
#[cfg(feature = "proptest")]
#[must_use]
pub fn seeded(seed: u64, cases: u32) -> Config {
    Config { cases, rng_seed: RngSeed::Fixed(seed), failure_persistence: None, ..Config::default() }
}
