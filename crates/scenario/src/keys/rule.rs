//! Tables that only a rule has: what it says of itself, its cameras, sources and tests.

use super::key::Silent::{Is, Means, Refused};
use super::key::{COUNT, Key, LENGTH, More, POSITIVE, SPEED, TIME, Table, Value};
use super::task::LIT_KEYS;
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
        "\"A camera must distinguish a person from a robot.\"",
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

pub(super) const COVERAGE_FACTOR: Key = Key::row(
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
const SHARE: Key = Key::row(
    "share",
    Value::Number(Allowed { holds: |value| value > 0.0 && value <= 1.0, expected: "above 0, at most 1" }),
    Means("not counted"),
    "0.3",
    "What part of a market the camera is.",
    "which part of the market meets the rule",
);
/// `[[camera]]` of a rule.
pub(crate) static CAMERA: Table = Table {
    meaning: "A camera that is held against the rule; a figure may be a table of a value and its standard uncertainty.",
    keys: &[&[CAMERA_NAME, SHARE]],
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
    Key::row(
        "kind",
        Value::Choice(&["uncooled", "cooled"]),
        Means("not known"),
        "\"uncooled\"",
        "Whether its array is cooled.",
        "`hadar find` of one kind",
    ),
    Key::row(
        "price",
        Value::Text,
        Means("not known"),
        "\"1 000 to 3 000 USD\"",
        "What one piece costs, as a range or a sum of one currency.",
        "order of what `hadar find` finds",
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
        Means("must be there together with value"),
        "\"5 mK\"",
        "Its standard uncertainty, 0 or above, in the unit of the figure.",
        "budget of the margin: u times how the margin changes with the figure (GUM)",
    ),
    Key::row(
        "law",
        Value::Choice(&["gaussian", "rectangular"]),
        Is("\"gaussian\""),
        "\"rectangular\"",
        "How its error is distributed: rectangular errors, as of a tolerance, go to sqrt(3) u and no farther.",
        "draws and ends of the figure",
    ),
    Key::row(
        "same",
        Value::Text,
        Means("independent of all other figures"),
        "\"lens\"",
        "Figures of one camera with the same name here have one common error, in units of the deviation of each.",
        "contributions that are added before they are squared; draws",
    ),
    Key::row(
        "at_most",
        Value::Figure,
        Means("no limit"),
        "\"50 mK\"",
        "Instead of value: a noise that is no larger than this, as a sheet promises it. A camera that fails by the margin is undecided.",
        "the margin at the limit",
    ),
];
/// A figure with its uncertainty.
pub(crate) static UNCERTAIN: Table =
    Table::of("A figure of a camera with its standard uncertainty, or a limit of it.", &[UNCERTAIN_KEYS]);

const SOURCE_KEYS: &[Key] = &[Key::row(
    "keys",
    Value::List(&Value::Text),
    Refused,
    "[\"stop.latency\"]",
    "Figures of this file, or tables with all of theirs, that it stands behind.",
    "a rule that names any source must name one for each figure",
)];
const GROUND_KEYS: &[Key] = &[
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
        "Why the author of the rule chose the figure, which no document states.",
        "`hadar rule --sources`",
    ),
];
/// `[[source]]`.
pub(crate) static SOURCE: Table = Table::of(
    "Where figures of the rule are from: a document, or a choice with its reason.",
    &[SOURCE_KEYS, GROUND_KEYS],
);

const REFORM_KEYS: &[Key] = &[
    Key::row(
        "name",
        Value::Text,
        Refused,
        "\"H.R. 7353\"",
        "What the reform is called.",
        "heading of its column",
    ),
    Key::row("status", Value::Text, Means("none"), "\"bill\"", "What became of it.", "quoted in the answer"),
    Key::row(
        "from",
        Value::Date,
        Means("no day is known"),
        "\"2031-02-04\"",
        "The day from which it would hold, not before the law.",
        "quoted in the answer",
    ),
    Key::row(
        "set",
        Value::List(&Value::Text),
        Refused,
        "[\"requirement.detection_probability = 0.95\"]",
        "What would stand in the place of values of the law.",
        "`hadar rule --reforms`",
    ),
];
/// `[[reform]]`.
pub(crate) static REFORM: Table = Table::of(
    "Other values of the law that somebody proposes or has enacted, with a document or a choice behind them.",
    &[REFORM_KEYS, GROUND_KEYS],
);

const GRID_KEYS: &[Key] = &[
    Key::row("name", Value::Text, Refused, "\"night\"", "What the light is called.", "rows of the table"),
    Key::row(
        "speed_step",
        SPEED,
        Refused,
        "\"10 km/h\"",
        "From one speed of a [stop] to the next, from its lowest on; its highest is a cell in any case.",
        "columns of the table",
    ),
];
/// `[[grid]]`.
pub(crate) static GRID: Table = Table::of(
    "A light in which every clause with a [stop] is judged speed by speed, for the table that a maker hands in.",
    &[GRID_KEYS, LIT_KEYS],
);

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
        "Expected margin: value reached over value required, for an error the inverse.",
        "`hadar rule --test`",
    ),
    Key::row(
        "decision_distance",
        LENGTH,
        Means("any"),
        "\"20 m\"",
        "Expected greatest distance at which the decision is due.",
        "`hadar rule --test`",
    ),
    Key::row(
        "decision_time",
        TIME,
        Means("any"),
        "\"2 s\"",
        "Expected least time until then.",
        "`hadar rule --test`",
    ),
    Key::row(
        "bearing",
        Value::Quantity(Dimension::Angle, ABOVE_ZERO),
        Means("any"),
        "\"27 deg\"",
        "Expected largest angle from the axis that a crossing target has until then.",
        "`hadar rule --test`",
    ),
    Key::row(
        "frames",
        COUNT,
        Means("any"),
        "60",
        "Expected number of frames of all bands that fit into it.",
        "`hadar rule --test`",
    ),
    Key::row(
        "tolerance",
        Value::Number(AT_MOST_WHOLE),
        Is("0.01"),
        "0.01",
        "Relative tolerance of these numbers.",
        "`hadar rule --test`",
    ),
];
/// `[[test]]`.
pub(crate) static TEST: Table = Table::of("What is expected of a camera of the rule.", &[TEST_KEYS]);
