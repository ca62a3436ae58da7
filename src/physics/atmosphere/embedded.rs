//! The tables of `spectra/atmosphere/`, compiled into the library so that it needs no files at run time.

/// A table: its name, the temperature of its air (K) and its text.
pub(super) struct Embedded {
    pub(super) name: &'static str,
    pub(super) temperature_k: f64,
    pub(super) text: &'static str,
}

/// Their names, in the order of [`TABLES`].
pub(super) const NAMES: &[&str] = &[
    "us-standard",
    "tropical",
    "midlatitude-summer",
    "midlatitude-winter",
    "subarctic-summer",
    "subarctic-winter",
];

macro_rules! tables {
    ($(($name:literal, $temperature_k:literal)),* $(,)?) => {
        &[$(Embedded {
            name: $name,
            temperature_k: $temperature_k,
            text: include_str!(concat!("../../../spectra/atmosphere/", $name, ".csv")),
        }),*]
    };
}

/// All of them.
pub(super) const TABLES: &[Embedded] = tables![
    ("us-standard", 288.2),
    ("tropical", 299.7),
    ("midlatitude-summer", 294.2),
    ("midlatitude-winter", 272.2),
    ("subarctic-summer", 287.2),
    ("subarctic-winter", 257.2),
];
