//! Tables that only a rule has.

use super::key::Silent::{Is, Means, Refused};
use super::key::{
    COUNT, KELVIN, KELVIN_APART, Key, LENGTH, LENGTH_FROM_ZERO, MATERIALS, More, POSITIVE, SPEED, TIME,
    Table, Value,
};
use super::scene::{DEPTH_KEYS, SCENE, STEREO};
use super::task;
use hadar::allowed::{ABOVE_ZERO, Allowed, FROM_ZERO};
use hadar::units::Dimension;

const ABOUT_KEYS: &[Key] = &[
    Key::row(
        "name",
        Value::Text,
        Means("none"),
        "\"Robots that see people at night\"",
        "Name of the rule.",
        "heading of the certificate",
    ),
    Key::row(
        "text",
        Value::Text,
        Means("none"),
        "\"A camera must tell a person from a robot.\"",
        "Its wording.",
        "quoted in the certificate",
    ),
    Key::row(
        "authority",
        Value::Text,
        Means("none"),
        "\"City of Lafayette\"",
        "Who sets it.",
        "quoted in the certificate",
    ),
    Key::row("version", Value::Text, Means("none"), "\"1\"", "Its version.", "quoted in the certificate"),
    Key::row(
        "status",
        Value::Text,
        Means("none"),
        "\"in force\"",
        "Whether it is law, a draft, postponed.",
        "quoted in the certificate",
    ),
    Key::row(
        "from",
        Value::Date,
        Means("since ever"),
        "\"2029-09-01\"",
        "The first day on which it holds.",
        "`hadar rule --on DAY`",
    ),
    Key::row(
        "until",
        Value::Date,
        Means("for ever"),
        "\"2029-09-01\"",
        "The last day on which it holds.",
        "`hadar rule --on DAY`",
    ),
];
/// `[rule]`.
pub(crate) static ABOUT: Table = Table::of("What a rule says of itself.", &[ABOUT_KEYS]);

const COVERAGE_FACTOR: Key = Key::row(
    "coverage_factor",
    POSITIVE,
    Is("2.0"),
    "2",
    "Standard deviations that must lie within: 2 is 95 % of a Gaussian.",
    "guard band about a margin; temperature error times it",
);
/// `[uncertainty]`.
pub(crate) static UNCERTAINTY: Table =
    Table::of("How sure a verdict must be where figures of a camera are uncertain.", &[&[COVERAGE_FACTOR]]);

const CAMERA_NAME: Key = Key::row(
    "name",
    Value::Text,
    Means("that of its preset, or its place in the file"),
    "\"ours\"",
    "What the camera is called in the answer.",
    "heading of its row",
);
/// `[[camera]]` of a rule.
pub(crate) static CAMERA: Table = Table {
    meaning: "A camera that is held against the rule; a figure may be a table of a value and its standard uncertainty.",
    keys: &[&[CAMERA_NAME]],
    more: More::UncertainFigures,
};

const OWN_CAMERA_KEYS: &[Key] = &[
    Key::row(
        "name",
        Value::Text,
        Refused,
        "\"ours\"",
        "Name of the camera, by which a preset calls it.",
        "`preset` of a [camera], `cameras` of a rule",
    ),
    Key::row(
        "description",
        Value::Text,
        Means("none"),
        "\"Thermal camera of the test vehicle\"",
        "What the camera is.",
        "`hadar cameras list` and `show`",
    ),
    Key::row(
        "document",
        Value::Text,
        Means("none"),
        "\"data sheet of 2024\"",
        "The document that its figures were read in.",
        "`hadar cameras show`",
    ),
    Key::row(
        "provenance",
        Value::List(&Value::Text),
        Means("none"),
        "[\"data sheet of 2024\"]",
        "Where its figures are from.",
        "`hadar cameras show`",
    ),
];
/// `[[camera]]` of a file of cameras.
pub(crate) static OWN_CAMERA: Table = Table {
    meaning: "A camera of one's own; what is left out is asked for where nothing can stand for it.",
    keys: &[OWN_CAMERA_KEYS],
    more: More::Figures,
};

const UNCERTAIN_KEYS: &[Key] = &[
    Key::row(
        "value",
        Value::Figure,
        Means("that of the preset"),
        "\"50 mK\"",
        "The figure itself.",
        "as without an uncertainty",
    ),
    Key::row(
        "u",
        Value::Figure,
        Refused,
        "\"5 mK\"",
        "Its standard uncertainty, 0 or above, in the unit of the figure.",
        "budget of the margin: u times how the margin changes with the figure (GUM)",
    ),
];
/// A figure with its uncertainty.
pub(crate) static UNCERTAIN: Table =
    Table::of("A figure of a camera and its standard uncertainty.", &[UNCERTAIN_KEYS]);

const ANY: Allowed = Allowed { holds: |_| true, expected: "a finite number" };
const STOP_KEYS: &[Key] = &[
    Key::row(
        "speed",
        Value::Either(&[SPEED, Value::Pair(&SPEED)]),
        Refused,
        "\"60 km/h\" or [\"10 km/h\", \"60 km/h\"]",
        "Speed of the vehicle, or a range of speeds.",
        "stopping distance v t + v^2/(2 a); motion blur",
    ),
    Key::row(
        "latency",
        Value::Quantity(Dimension::Time, FROM_ZERO),
        Refused,
        "\"0.5 s\"",
        "Time from the decision until the brakes act.",
        "stopping distance v t + v^2/(2 a)",
    ),
    Key::row(
        "deceleration",
        Value::Quantity(Dimension::Acceleration, ABOVE_ZERO),
        Refused,
        "\"5 m/s^2\"",
        "How hard the vehicle brakes.",
        "stopping distance v t + v^2/(2 a)",
    ),
    Key::row(
        "margin",
        LENGTH_FROM_ZERO,
        Is("\"0 m\""),
        "\"1 m\"",
        "How far before the target the vehicle must stand.",
        "added to the stopping distance",
    ),
    Key::row(
        "start",
        Value::Either(&[TIME, LENGTH]),
        Means("the target is in view all the time"),
        "\"4 s\"",
        "Where the target comes into view: a time before contact, or a distance.",
        "time that is left for looking",
    ),
    Key::row(
        "target_speed",
        Value::Quantity(Dimension::Speed, ANY),
        Is("\"0 m/s\""),
        "\"5 km/h\"",
        "Speed of the target along the way, away from the vehicle.",
        "closing speed",
    ),
    Key::row(
        "closing_speed",
        SPEED,
        Means("speed less target_speed"),
        "\"50 km/h\"",
        "Speed at which vehicle and target come together.",
        "closing speed",
    ),
];
/// `[stop]`.
pub(crate) static STOP: Table =
    Table::of("How the vehicle comes to a stop, from which the distances of the rule follow.", &[STOP_KEYS]);

const BELOW_ONE: Value =
    Value::Number(Allowed { holds: |value| (0.0..1.0).contains(&value), expected: "from 0 to below 1" });
const STAND_IN_KEYS: &[Key] = &[
    Key::row(
        "clause",
        Value::Text,
        Means("the only one that tells people apart"),
        "\"crossing\"",
        "The clause whose limit is turned round.",
        "scenes in which no camera may tell the stand-in",
    ),
    Key::row(
        "materials",
        MATERIALS,
        Means("those of the target"),
        "[\"skin\"]",
        "What it may be made of.",
        "emissivity of the stand-in",
    ),
    Key::row(
        "temperature",
        KELVIN,
        Means("that of the target"),
        "\"33 degC\"",
        "Its temperature.",
        "about which the tolerance lies",
    ),
    Key::row(
        "emissivity",
        Value::List(&BELOW_ONE),
        Is("[0.0, 0.005, 0.01, 0.02, 0.03, 0.05]"),
        "[0.0, 0.01, 0.02]",
        "Tolerances of its emissivity, for each of which the tolerance of its temperature is found.",
        "the distance stays below the demand for all errors within",
    ),
];
/// `[stand_in]`.
pub(crate) static STAND_IN: Table =
    Table::of("What is to pass for a person where cameras are tested.", &[STAND_IN_KEYS]);

const SOURCE_KEYS: &[Key] = &[
    Key::row(
        "keys",
        Value::List(&Value::Text),
        Refused,
        "[\"stop.latency\"]",
        "Figures of this file, or tables with all of theirs, that it stands behind.",
        "a rule that names any source must name one for each figure",
    ),
    Key::row(
        "document",
        Value::Text,
        Means("must be there, unless there is a choice"),
        "\"49 CFR 571.127\"",
        "What says so.",
        "`hadar rule --sources`",
    ),
    Key::row(
        "clause",
        Value::Text,
        Means("must be there, unless there is a choice"),
        "\"S8.2\"",
        "Where in it.",
        "`hadar rule --sources`",
    ),
    Key::row(
        "quote",
        Value::Text,
        Means("must be there, unless there is a choice"),
        "\"its own words\"",
        "In its own words.",
        "`hadar rule --sources`",
    ),
    Key::row(
        "date",
        Value::Date,
        Means("must be there, unless there is a choice"),
        "\"2024-05-09\"",
        "Its date.",
        "`hadar rule --sources`",
    ),
    Key::row(
        "mark",
        Value::Choice(&["seen", "excerpt", "copy", "recalled", "computed"]),
        Means("must be there, unless there is a choice"),
        "\"seen\"",
        "How the document was read.",
        "`hadar rule --sources`",
    ),
    Key::row(
        "choice",
        Value::Text,
        Means("a document says so"),
        "\"why\"",
        "That nobody says so but the author of the rule, and why.",
        "`hadar rule --sources`",
    ),
];
/// `[[source]]`.
pub(crate) static SOURCE: Table =
    Table::of("Where figures of the rule are from: a document, or a choice with its reason.", &[SOURCE_KEYS]);

const AT_MOST_WHOLE: Allowed =
    Allowed { holds: |value| value > 0.0 && value < 1.0, expected: "above 0 and below 1" };
const TEST_KEYS: &[Key] = &[
    Key::row(
        "camera",
        Value::Text,
        Refused,
        "\"flir-a325sc\"",
        "A camera of the rule, by its name.",
        "`hadar rule --test`",
    ),
    Key::row(
        "clause",
        Value::Text,
        Means("all clauses together"),
        "\"crossing\"",
        "A clause of the rule, by its name.",
        "`hadar rule --test`",
    ),
    Key::row(
        "verdict",
        Value::Choice(&["meets", "fails", "undecided"]),
        Means("any"),
        "\"meets\"",
        "The verdict that is expected.",
        "`hadar rule --test`",
    ),
    Key::row(
        "margin",
        Value::Number(FROM_ZERO),
        Means("any"),
        "1.23",
        "What is there over what is demanded, as it is expected.",
        "`hadar rule --test`",
    ),
    Key::row(
        "decision_distance",
        LENGTH,
        Means("any"),
        "\"20 m\"",
        "Greatest distance at which the decision must stand, as it is expected.",
        "`hadar rule --test`",
    ),
    Key::row(
        "decision_time",
        TIME,
        Means("any"),
        "\"2 s\"",
        "Least time until then, as it is expected.",
        "`hadar rule --test`",
    ),
    Key::row(
        "frames",
        COUNT,
        Means("any"),
        "60",
        "Frames of all bands that fit into it, as is expected.",
        "`hadar rule --test`",
    ),
    Key::row(
        "tolerance",
        Value::Number(AT_MOST_WHOLE),
        Is("0.01"),
        "0.01",
        "Share of itself by which a number may miss.",
        "`hadar rule --test`",
    ),
];
/// `[[test]]`.
pub(crate) static TEST: Table = Table::of("What is expected of a camera of the rule.", &[TEST_KEYS]);

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
    "Of what of the street the distance must be known.",
    "windows on it (S35 to S43)",
);
/// `[clause.requirement]` of a depth.
pub(crate) static DEPTH: Table = Table::of("A distance that must be known.", &[&[OBJECT], DEPTH_KEYS]);

const KIND: Value =
    Value::Choice(&["tell-apart", "false-alarm", "resolution", "temperature-error", "depth-error"]);
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
        "What it must be told apart from, in this clause."
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
    "How reliable the decision must be, in this clause."
)];
const DEMANDS: &[Value] = &[
    Value::Table(&task::REQUIREMENT),
    Value::Table(&RESOLUTION),
    Value::Table(&TEMPERATURE),
    Value::Table(&DEPTH),
];
const REQUIREMENT_OF_ANY: &[Key] = &[Key {
    silent: Means("that of the rule; of kinds that tell nothing apart it must be there"),
    ..own!("requirement", Value::Either(DEMANDS), "What is demanded, in terms of the clause's kind.")
}];
const WHAT: &str = "One demand, with the tables in which its scenes differ from the rule's.";
/// `[[clause]]`, whatever its kind.
pub(crate) static CLAUSE: Table = Table::of(
    WHAT,
    &[CLAUSE_KEYS, &[THINGS, SCENE_OF_CLAUSE, STEREO_OF_CLAUSE], REQUIREMENT_OF_ANY, OWN_KEYS],
);
/// The same of a kind without keys of its own, which demands reliability.
pub(crate) static CLAUSE_TELL_APART: Table = Table::of(WHAT, &[CLAUSE_KEYS, REQUIREMENT_OF_TASK, OWN_KEYS]);
/// Of false alarms.
pub(crate) static CLAUSE_FALSE_ALARM: Table =
    Table::of(WHAT, &[CLAUSE_KEYS, &[THINGS], REQUIREMENT_OF_TASK, OWN_KEYS]);
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
