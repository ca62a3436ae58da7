//! Tables that only ranging by air has.

use super::key::Silent::{Is, Means, Refused};
use super::key::{COUNT, Key, LENGTH, POSITIVE, POSITIVE_SHARE, Table, Value, WAVENUMBER};
use super::task::{LIGHTING_TOTAL, PRIOR_KELVIN, PRIOR_KEYS};

const DISTANCES_KEYS: &[Key] = &[
    Key::row(
        "list",
        Value::List(&LENGTH),
        Means("from, to and points"),
        "[\"15 m\", \"150 m\"]",
        "Distances at which the bound is drawn.",
        "curve of the answer",
    ),
    Key::row(
        "from",
        LENGTH,
        Means("a tenth of target.distance"),
        "\"15 m\"",
        "The first of them.",
        "curve of the answer",
    ),
    Key::row(
        "to",
        LENGTH,
        Means("three times target.distance"),
        "\"150 m\"",
        "The last of them.",
        "curve of the answer",
    ),
    Key::row("points", COUNT, Is("25"), "25", "How many, evenly in their logarithm.", "curve of the answer"),
];
/// `[distances]`.
pub(crate) static DISTANCES: Table = Table::of("Distances at which the bound is drawn.", &[DISTANCES_KEYS]);

const AIR_PRIOR_KEYS: &[Key] = &[Key::row(
    "air-temperature",
    PRIOR_KELVIN,
    Means("nothing is known of it"),
    "\"2 K\"",
    "How well the temperature of the air is known beforehand, a standard deviation.",
    "prior information added to the Fisher matrix",
)];
static AIR_PRIORS: Table = Table::of(
    "What is known beforehand of what is unknown: standard deviations.",
    &[PRIOR_KEYS, AIR_PRIOR_KEYS],
);
const AIR_NUISANCE: Value = Value::Choice(&[
    "temperature",
    "lighting",
    "gain",
    "environment-temperature",
    "air-temperature",
    "emissivity",
]);
const AIR_UNKNOWN_KEYS: &[Key] = &[
    Key::row(
        "nuisances",
        Value::List(&AIR_NUISANCE),
        Is("[\"temperature\", \"lighting\"]"),
        "[\"temperature\", \"lighting\"]",
        "What of the scene is not known in addition to the distance.",
        "columns of the Fisher matrix that the distance is distinguished from",
    ),
    Key::row(
        "priors",
        Value::Table(&AIR_PRIORS),
        Means("nothing is known beforehand"),
        "{ temperature = \"2 K\" }",
        "What is known beforehand of what is unknown: standard deviations.",
        "prior information added to the Fisher matrix",
    ),
    LIGHTING_TOTAL,
    Key::row(
        "emissivity_error",
        Value::Either(&[POSITIVE_SHARE, Value::Text]),
        Means("0.01, where the emissivity is unknown"),
        "\"0.01 absolute\"",
        "Root mean square error of the emissivity, absolute (a bare number is taken as that), where that is among the unknowns.",
        "covariance of the emissivity",
    ),
    Key::row(
        "emissivity_correlation",
        WAVENUMBER,
        Means("100 cm^-1, where the emissivity is unknown"),
        "\"100 cm^-1\"",
        "Difference of wavenumbers at which the correlation of that error has fallen to a quarter (Matern 5/2).",
        "covariance of the emissivity",
    ),
];
/// `[unknown]` of ranging by air.
pub(crate) static AIR_UNKNOWN: Table =
    Table::of("What of the scene is not known in addition to the distance.", &[AIR_UNKNOWN_KEYS]);

const AIR_STEREO_KEYS: &[Key] = &[
    Key::row(
        "baseline",
        LENGTH,
        Refused,
        "\"0.2 m\"",
        "Distance of the second camera from the first.",
        "depth from disparity (S36), for comparison",
    ),
    Key::row(
        "window",
        Value::Pair(&COUNT),
        Is("[5, 5]"),
        "[5, 5]",
        "Rows and columns of the window that is matched.",
        "information of disparity (S37)",
    ),
    Key::row(
        "texture",
        POSITIVE_SHARE,
        Refused,
        "0.01",
        "Root mean square change of the target's own light from pixel to pixel, as a share of it.",
        "information of disparity (S37)",
    ),
];
/// `[stereo]` of ranging by air.
pub(crate) static AIR_STEREO: Table =
    Table::of("A second camera next to the first, for comparison.", &[AIR_STEREO_KEYS]);

const AIR_REQUIREMENT_KEYS: &[Key] = &[
    Key::row(
        "distance_error",
        LENGTH,
        Means("that of relative_distance_error"),
        "\"5 m\"",
        "How well the distance must be known, a standard deviation.",
        "Cramer-Rao bound of the distance",
    ),
    Key::row(
        "relative_distance_error",
        POSITIVE,
        Means("that of distance_error"),
        "0.05",
        "How well the distance must be known, as a share of it.",
        "Cramer-Rao bound of the distance",
    ),
];
/// `[requirement]` of ranging by air.
pub(crate) static AIR_REQUIREMENT: Table =
    Table::of("How well the distance must be known.", &[AIR_REQUIREMENT_KEYS]);
