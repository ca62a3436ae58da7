//! Tables of the clauses of a rule: `[[clause]]` of every kind, and what each kind demands.

use super::key::Silent::{Is, Means, Refused};
use super::key::{KELVIN_APART, Key, LENGTH, MATERIALS, POSITIVE, Table, Value};
use super::rule::COVERAGE_FACTOR;
use super::scene::SCENE;
use super::stop::STOP;
use super::task;
use super::views::{DEPTH_KEYS, STEREO};

const RESOLUTION_KEYS: &[Key] = &[
    Key::row(
        "pixels",
        POSITIVE,
        Refused,
        "6",
        "Pixels across the target, of a clause of kind resolution.",
        "size f/(p z) at distance z",
    ),
    Key::row(
        "size",
        LENGTH,
        Refused,
        "\"0.5 m\"",
        "The critical dimension of the target.",
        "size f/(p z) at distance z",
    ),
];
/// `[clause.requirement]` of a resolution.
pub(crate) static RESOLUTION: Table = Table::of("So many pixels across the target.", &[RESOLUTION_KEYS]);

const TEMPERATURE_ERROR: Key = Key::row(
    "temperature_error",
    KELVIN_APART,
    Refused,
    "\"0.5 K\"",
    "How well the temperature must be known, of a clause of kind temperature-error.",
    "Cramer-Rao bound of T (S27, Extended Data Fig. 9)",
);
/// `[clause.requirement]` of a temperature.
pub(crate) static TEMPERATURE: Table =
    Table::of("A temperature that must be known.", &[&[TEMPERATURE_ERROR, COVERAGE_FACTOR]]);

const OBJECT: Key = Key::row(
    "object",
    Value::Choice(&["person", "car"]),
    Is("\"person\""),
    "\"car\"",
    "Object of the street whose distance must be known.",
    "windows on it (S35 to S43)",
);
/// `[clause.requirement]` of a depth.
pub(crate) static DEPTH: Table = Table::of("A distance that must be known.", &[&[OBJECT], DEPTH_KEYS]);

const KIND: Value = Value::Choice(&[
    "tell-apart",
    "false-alarm",
    "contrast",
    "resolution",
    "temperature-error",
    "depth-error",
]);
const CLAUSE_KEYS: &[Key] = &[
    Key::row(
        "name",
        Value::Text,
        Refused,
        "\"crossing at night\"",
        "Name of the clause.",
        "its heading in answer and certificate",
    ),
    Key::row(
        "kind",
        KIND,
        Is("\"tell-apart\""),
        "\"resolution\"",
        "What is demanded.",
        "which bound decides",
    ),
    Key::row(
        "text",
        Value::Text,
        Means("none"),
        "\"a pedestrian crosses\"",
        "Its wording.",
        "quoted in the certificate",
    ),
];
const THINGS: Key = Key::row(
    "things",
    MATERIALS,
    Means("must be there in a clause of kind false-alarm"),
    "[\"steel-rough\"]",
    "What must not be taken for the rule's target, of a clause of kind false-alarm.",
    "they are the target of this clause, and the rule's target its alternatives",
);
const BEHIND: Key = Key::row(
    "behind",
    MATERIALS,
    Means("must be there in a clause of kind contrast"),
    "[\"steel-rough\"]",
    "What the target must stand out from, of a clause of kind contrast.",
    "at any temperature of alternatives.temperature of the clause, which must be there",
);
const SCENE_OF_CLAUSE: Key = Key::row(
    "scene",
    Value::Table(&SCENE),
    Means("the built-in street"),
    "{ person_temperature = \"33 degC\" }",
    "The street, of a clause of kind depth-error.",
    "heat cube that is rendered (S1 to S6)",
);
const STEREO_OF_CLAUSE: Key = Key::row(
    "stereo",
    Value::Table(&STEREO),
    Means("must be there in a clause of kind depth-error"),
    "{ baseline = \"0.2 m\" }",
    "The pair of cameras, of a clause of kind depth-error.",
    "depth from disparity (S35, S36)",
);

/// A table of a task or a rule that stands in a clause in the place of the rule's own.
macro_rules! own {
    ($name:literal, $value:expr, $meaning:literal) => {
        own!($name, $value, $meaning, "a table")
    };
    ($name:literal, $value:expr, $meaning:literal, $example:literal) => {
        Key::row(
            $name,
            $value,
            Means("that of the rule"),
            $example,
            $meaning,
            "in the place of the rule's own",
        )
    };
}
const OWN_KEYS: &[Key] = &[
    own!("target", Value::Table(&task::TARGET), "What is there, in this clause."),
    own!("background", Value::Table(&task::BACKGROUND), "What is behind it, in this clause."),
    own!("environment", Value::Tables(&task::ENVIRONMENT), "The surroundings, in this clause."),
    own!(
        "alternatives",
        Value::Table(&task::ALTERNATIVES),
        "What it must be distinguished from, in this clause."
    ),
    own!("atmosphere", Value::Table(&task::ATMOSPHERE), "The air, in this clause."),
    own!("bands", Value::Table(&task::BANDS), "The bands, in this clause."),
    own!("unknown", Value::Table(&task::UNKNOWN), "What is unknown, in this clause."),
    own!("envelope", Value::Table(&task::ENVELOPE), "Ranges of scenes, in this clause."),
    own!("stop", Value::Table(&STOP), "How the vehicle stops, in this clause."),
];
const REQUIREMENT_OF_TASK: &[Key] = &[own!(
    "requirement",
    Value::Table(&task::REQUIREMENT),
    "Required probability of a correct decision, in this clause."
)];
const DEMANDS: &[Value] = &[
    Value::Table(&task::REQUIREMENT),
    Value::Table(&RESOLUTION),
    Value::Table(&TEMPERATURE),
    Value::Table(&DEPTH),
];
const REQUIREMENT_OF_ANY: &[Key] = &[Key {
    silent: Means("that of the rule; of kinds that distinguish nothing it must be there"),
    ..own!("requirement", Value::Either(DEMANDS), "What is demanded, in terms of the clause's kind.")
}];
const WHAT: &str = "One demand, with the tables in which its scenes differ from the rule's.";
/// `[[clause]]`, whatever its kind.
pub(crate) static CLAUSE: Table = Table::of(
    WHAT,
    &[CLAUSE_KEYS, &[THINGS, BEHIND, SCENE_OF_CLAUSE, STEREO_OF_CLAUSE], REQUIREMENT_OF_ANY, OWN_KEYS],
);
/// The same of a kind without keys of its own, which demands reliability.
pub(crate) static CLAUSE_TELL_APART: Table = Table::of(WHAT, &[CLAUSE_KEYS, REQUIREMENT_OF_TASK, OWN_KEYS]);
/// Of false alarms.
pub(crate) static CLAUSE_FALSE_ALARM: Table =
    Table::of(WHAT, &[CLAUSE_KEYS, &[THINGS], REQUIREMENT_OF_TASK, OWN_KEYS]);
/// Of something that is there.
pub(crate) static CLAUSE_CONTRAST: Table =
    Table::of(WHAT, &[CLAUSE_KEYS, &[BEHIND], REQUIREMENT_OF_TASK, OWN_KEYS]);
/// Of pixels on a target.
pub(crate) static CLAUSE_RESOLUTION: Table = Table::of(
    WHAT,
    &[
        CLAUSE_KEYS,
        &[own!(
            "requirement",
            Value::Table(&RESOLUTION),
            "So many pixels across the target.",
            "{ pixels = 6, size = \"0.5 m\" }"
        )],
        OWN_KEYS,
    ],
);
/// Of a temperature.
pub(crate) static CLAUSE_TEMPERATURE: Table = Table::of(
    WHAT,
    &[
        CLAUSE_KEYS,
        &[own!(
            "requirement",
            Value::Table(&TEMPERATURE),
            "A temperature that must be known.",
            "{ temperature_error = \"0.5 K\" }"
        )],
        OWN_KEYS,
    ],
);
/// Of a distance.
pub(crate) static CLAUSE_DEPTH: Table = Table::of(
    WHAT,
    &[
        CLAUSE_KEYS,
        &[
            SCENE_OF_CLAUSE,
            STEREO_OF_CLAUSE,
            own!(
                "requirement",
                Value::Table(&DEPTH),
                "A distance that must be known.",
                "{ depth_error = \"1 m\" }"
            ),
        ],
        OWN_KEYS,
    ],
);
