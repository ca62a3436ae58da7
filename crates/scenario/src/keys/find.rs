//! Keys of `[find]`: what may be chosen where a camera is sought.

use super::key::Silent::{Is, Means, Refused};
use super::key::{Key, LENGTH, POSITIVE, TIME, Table, Value};
use super::task::{FILTER_INDEX, FILTER_PLACE};

const PRICE: Key = Key::row(
    "price",
    Value::Text,
    Means("not known: sorted last, and said"),
    "\"300 to 1 000 USD\"",
    "What one piece costs, as a range or a sum of one currency; all prices of a question in the same.",
    "order of the cameras that are found",
);

const LENS_KEYS: &[Key] = &[
    Key::row(
        "name",
        Value::Text,
        Means("by its figures"),
        "\"wide\"",
        "What it is called.",
        "names of what is found",
    ),
    Key::row("f_number", POSITIVE, Refused, "1.0", "Focal length over aperture.", "etendue of a pixel (S7)"),
    Key::row(
        "focal_length",
        LENGTH,
        Refused,
        "\"14 mm\"",
        "Focal length of the lens.",
        "pixels on an object, etendue (S7)",
    ),
    PRICE,
];
static LENS: Table = Table::of("A lens.", &[LENS_KEYS]);

const FILTERS_KEYS: &[Key] = &[
    Key::row(
        "from",
        Value::Either(&[Value::Choice(&["catalogue", "any"]), Value::File]),
        Is("\"catalogue\""),
        "\"my_filters.csv\"",
        "Where the filters come from: the shapes of the program, a file with a column for each, or \"any\": ideal ones with free edges.",
        "bands that S is integrated over (S8, S9)",
    ),
    Key::row(
        "at_most",
        Value::Count([1, 8]),
        Is("3"),
        "5",
        "How many there may be before one camera.",
        "choices that are searched",
    ),
    Key::row(
        "step",
        Value::Spectral,
        Means("\"0.5 um\" of from = \"any\""),
        "\"0.25 um\"",
        "Free edges are multiples of this wavelength.",
        "choices that are searched",
    ),
    FILTER_PLACE,
    FILTER_INDEX,
    Key { meaning: "What each filter costs.", ..PRICE },
];
static FILTERS: Table = Table::of("Filters of which some are chosen.", &[FILTERS_KEYS]);

const FIND_KEYS: &[Key] = &[
    Key::row(
        "cameras",
        Value::List(&Value::Text),
        Is("[\"*\"]"),
        "[\"flir-boson*\", \"ours\"]",
        "Cameras to choose from, of the program and of --cameras; * stands for any letters.",
        "what is searched",
    ),
    Key::row(
        "kind",
        Value::Choice(&["uncooled", "cooled"]),
        Means("both"),
        "\"uncooled\"",
        "Cooled or uncooled cameras alone.",
        "what is searched",
    ),
    Key::row(
        "lenses",
        Value::Tables(&LENS),
        Means("those that a document names for each camera (cameras/lenses.toml)"),
        "[{ f_number = 1.0, focal_length = \"14 mm\" }]",
        "Lenses, each tried on every camera that has none of its own.",
        "what is searched",
    ),
    Key::row(
        "filters",
        Value::Table(&FILTERS),
        Means("up to 3 of the catalogue"),
        "{ from = \"catalogue\", at_most = 5 }",
        "Filters of which some are chosen, for cameras of one band.",
        "what is searched",
    ),
    Key::row(
        "frames",
        Value::List(&Value::Count([1, 1_000_000])),
        Is("[1, 4, 16, 64]"),
        "[1, 16, 64]",
        "Numbers of frames that are tried.",
        "frames of the camera",
    ),
    Key::row(
        "time",
        TIME,
        Means("that of requirement.time; else the decision may wait"),
        "\"0.5 s\"",
        "Time within which all bands of all frames must be read.",
        "requirement.time of every camera",
    ),
    Key::row(
        "least",
        Value::List(&Value::Choice(&["price", "time", "filters", "aperture"])),
        Is("[\"price\", \"time\", \"filters\"]"),
        "[\"time\", \"price\"]",
        "What is to be small, the most important first; Pareto-optimal choices are listed.",
        "order of the cameras that are found",
    ),
];
/// `[find]`.
pub(crate) static FIND: Table =
    Table::of("What may be chosen where a camera is sought; all else of [camera] is fixed.", &[FIND_KEYS]);
