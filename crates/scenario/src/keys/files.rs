//! Kinds of files: which tables each has, and which commands read it.

use super::key::Silent::{Means, Refused};
use super::key::{Key, TITLE, Table, Value};
use super::{air, calibrate, clause, cube, find, rule, scene, stop, task, views};

/// A kind of file.
#[derive(Debug)]
pub struct FileKind {
    /// What it is called.
    pub name: &'static str,
    /// Commands that read it.
    pub commands: &'static [&'static str],
    /// Its tables.
    pub root: &'static Table,
}

const NOT_THERE: super::Silent = Means("what it means that each of its keys is");

/// A table of a file.
const fn table(name: &'static str, table: &'static Table) -> Key {
    Key::row(name, Value::Table(table), NOT_THERE, "a table", table.meaning, "see its keys")
}

/// Tables in double brackets.
const fn tables(name: &'static str, table: &'static Table) -> Key {
    Key::row(
        name,
        Value::Tables(table),
        NOT_THERE,
        "tables in double brackets",
        table.meaning,
        "see its keys",
    )
}

/// The same with other words for its silence.
const fn silent(words: &'static str, key: Key) -> Key {
    Key { silent: Means(words), ..key }
}

/// The same that must be there.
const fn needed(key: Key) -> Key {
    Key { silent: Refused, ..key }
}

const CLASSES: Key = Key::row(
    "class",
    Value::Named(&task::CLASS),
    Means("the classes of the library alone"),
    "a table [class.NAME]",
    task::CLASS.meaning,
    "see its keys",
);
const BANDS: Key = silent("the band of a camera that has one, else the grid", table("bands", &task::BANDS));
const CAMERA: Key = silent("no camera", table("camera", &task::CAMERA));
const ENVIRONMENT: Key =
    silent("no surroundings: nothing but its own light is seen", tables("environment", &task::ENVIRONMENT));
const TASK: &[Key] = &[
    TITLE,
    CLASSES,
    needed(table("target", &task::TARGET)),
    silent("must be there behind a target smaller than its pixel", table("background", &task::BACKGROUND)),
    ENVIRONMENT,
    table("alternatives", &task::ALTERNATIVES),
    silent("no air on the path", table("atmosphere", &task::ATMOSPHERE)),
    BANDS,
    table("unknown", &task::UNKNOWN),
    table("requirement", &task::REQUIREMENT),
    silent("the scene as it is", table("envelope", &task::ENVELOPE)),
    table("sensitivity", &task::SENSITIVITY),
    silent(
        "every camera of the program, its lenses, the filters of the catalogue",
        table("find", &find::FIND),
    ),
    silent("no categories", tables("category", &cube::CATEGORY_OF_TASK)),
];
/// A task.
pub(crate) static SCENARIO: Table =
    Table::of("A target, what it must be distinguished from, a camera.", &[TASK, &[CAMERA]]);

const PRESETS: Key = Key::row(
    "cameras",
    Value::List(&Value::Text),
    Means("those of [[camera]]"),
    "[\"flir-a325sc\", \"ideal-pnrd\"]",
    "Known cameras that are judged by the rule, as they are; above the first [table].",
    "rows of the answer",
);
/// A rule.
pub(crate) static RULE: Table = Table::of(
    "A requirement over ranges of scenes, and cameras that are judged by it.",
    &[
        TASK,
        &[
            table("rule", &rule::ABOUT),
            PRESETS,
            silent("those of cameras", tables("camera", &rule::CAMERA)),
            silent("distances are as they are written", table("stop", &stop::STOP)),
            silent("the rule is one demand", tables("clause", &clause::CLAUSE)),
            silent("no figure has a source", tables("source", &rule::SOURCE)),
            silent("no reform is looked at", tables("reform", &rule::REFORM)),
            silent("no table is made", tables("grid", &rule::GRID)),
            silent("nothing is tested", tables("test", &rule::TEST)),
            table("uncertainty", &rule::UNCERTAINTY),
            table("stand_in", &stop::STAND_IN),
        ],
    ],
);

const STREET: &[Key] = &[
    TITLE,
    silent("the built-in car and person", tables("object", &scene::OBJECT)),
    BANDS,
    table("requirement", &views::DEPTH),
    silent("none", tables("category", &cube::CATEGORY_OF_SCENE)),
];
/// Two views of a street or in a cube.
pub(crate) static RANGE: Table = Table::of(
    "Two views of a scene that is rendered, or of heat cubes.",
    &[
        STREET,
        &[
            silent("a [cube] must be there", table("scene", &scene::SCENE)),
            silent("a [scene] must be there", table("cube", &views::VIEWS)),
            CAMERA,
            needed(table("stereo", &views::STEREO)),
        ],
    ],
);
/// A scene to be rendered.
pub(crate) static RENDER: Table = Table::of(
    "A scene that is rendered.",
    &[
        STREET,
        &[
            needed(table("scene", &scene::SCENE)),
            needed(CAMERA),
            silent("one view", table("stereo", &views::STEREO)),
        ],
    ],
);

const SIGNAL: Key = Key::row(
    "signal",
    Value::Choice(&["air"]),
    Refused,
    "\"air\"",
    "That the distance is read from the air between; above the first [table].",
    "which ranging is asked for",
);
/// Ranging by air.
pub(crate) static AIR_RANGING: Table = Table::of(
    "A target whose distance is read from the air between.",
    &[&[
        TITLE,
        SIGNAL,
        needed(table("target", &task::TARGET)),
        ENVIRONMENT,
        needed(table("atmosphere", &task::ATMOSPHERE)),
        BANDS,
        table("unknown", &air::AIR_UNKNOWN),
        needed(CAMERA),
        table("distances", &air::DISTANCES),
        silent("no comparison", table("stereo", &air::AIR_STEREO)),
        silent("nothing is demanded", table("requirement", &air::AIR_REQUIREMENT)),
    ]],
);

/// A heat cube to be taken apart.
pub(crate) static DECOMPOSE: Table = Table::of(
    "A heat cube, its surroundings and the materials that a pixel may be.",
    &[&[
        TITLE,
        CLASSES,
        needed(table("cube", &cube::CUBE)),
        BANDS,
        CAMERA,
        silent("no air on the path", table("atmosphere", &task::ATMOSPHERE_OF_CUBE)),
        tables("environment", &cube::LIGHT),
        needed(table("library", &cube::LIBRARY)),
        table("unknown", &cube::UNKNOWN),
        silent("each pixel is for itself", table("spatial", &cube::SPATIAL)),
        table("vision", &cube::VISION),
        silent("no categories", tables("category", &cube::CATEGORY)),
        table("segmentation", &cube::SEGMENTATION),
        silent("nothing is compared", table("truth", &cube::TRUTH)),
    ]],
);
/// A heat cube to make a library of.
pub(crate) static LIBRARY: Table = Table::of(
    "A heat cube, its surroundings and how its pixels are grouped.",
    &[&[
        TITLE,
        needed(table("cube", &cube::CUBE)),
        BANDS,
        CAMERA,
        silent("no air on the path", table("atmosphere", &task::ATMOSPHERE_OF_CUBE)),
        tables("environment", &cube::LIGHT),
        needed(table("clusters", &cube::CLUSTERS)),
        table("emissivity", &cube::EMISSIVITY),
        table("unknown", &cube::UNKNOWN),
        silent("nothing is compared", table("truth", &cube::TRUTH_OF_LIBRARY)),
    ]],
);

const BLACKBODIES: &[Key] =
    &[TITLE, needed(tables("blackbody", &calibrate::BLACKBODY)), needed(table("noise", &calibrate::SAMPLE))];
/// A camera behind filters before blackbodies.
pub(crate) static RESPONSE: Table = Table::of(
    "A camera behind filters to be calibrated by blackbodies.",
    &[
        BLACKBODIES,
        &[
            needed(table("response", &calibrate::RESPONSE)),
            silent("no cube is calibrated", table("scene", &calibrate::SCENE)),
        ],
    ],
);
/// A spectrometer before blackbodies.
pub(crate) static BLACKBODY: Table = Table::of(
    "A spectrometer to be calibrated by blackbodies.",
    &[
        BLACKBODIES,
        &[needed(BANDS), silent("no cube is calibrated", table("scene", &calibrate::SPECTRAL_SCENE))],
    ],
);
/// Frames whose noise is sought.
pub(crate) static NOISE: Table = Table::of(
    "Frames whose noise is sought.",
    &[&[TITLE, needed(table("cube", &calibrate::FRAMES)), table("noise", &calibrate::NOISE)]],
);
/// A cube whose stripes are sought.
pub(crate) static STRIPES: Table = Table::of(
    "A cube whose stripes are sought.",
    &[&[TITLE, needed(table("cube", &calibrate::FRAMES)), table("stripes", &calibrate::STRIPES)]],
);

const OWN_CAMERAS: Key = Key { example: "[[camera]]", ..tables("camera", &rule::OWN_CAMERA) };
/// Cameras of one's own.
pub(crate) static CAMERAS: Table =
    Table::of("User-defined cameras, for --cameras.", &[&[needed(OWN_CAMERAS)]]);

/// All kinds of files.
pub static FILES: &[FileKind] = &[
    FileKind { name: "task", commands: &["size", "identify", "simulate", "find"], root: &SCENARIO },
    FileKind { name: "rule", commands: &["rule"], root: &RULE },
    FileKind { name: "stereo", commands: &["range"], root: &RANGE },
    FileKind { name: "scene", commands: &["render"], root: &RENDER },
    FileKind { name: "air", commands: &["range"], root: &AIR_RANGING },
    FileKind { name: "cube", commands: &["decompose"], root: &DECOMPOSE },
    FileKind { name: "library", commands: &["library"], root: &LIBRARY },
    FileKind { name: "response", commands: &["calibrate response"], root: &RESPONSE },
    FileKind { name: "blackbodies", commands: &["calibrate blackbody"], root: &BLACKBODY },
    FileKind { name: "noise", commands: &["calibrate noise"], root: &NOISE },
    FileKind { name: "stripes", commands: &["calibrate stripes"], root: &STRIPES },
    FileKind { name: "cameras", commands: &["cameras"], root: &CAMERAS },
];
