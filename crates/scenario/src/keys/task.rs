//! Tables of a task: what is there, what it must be told apart from, what is unknown, what is demanded.

use super::key::Silent::{Is, Means, Refused};
use super::key::{
    A_SHARE, KELVIN, Key, LENGTH, MATERIALS, More, POSITIVE, SPEED, TIME, Table, Value, WAVENUMBER,
};
use hadar::allowed::{ABOVE_ZERO, Allowed, FROM_ZERO};
use hadar::units::Dimension;

const EXTRAPOLATE: Key = Key::row(
    "extrapolate",
    Value::Choice(&["hold", "linear"]),
    Means("a spectrum that does not cover the bands is refused"),
    "\"hold\"",
    "How the spectrum is continued beyond its data: by its last value, or along its last slope.",
    "emissivity of the bands",
);

const TARGET_KEYS: &[Key] = &[
    Key::row(
        "material",
        Value::Material,
        Refused,
        "\"skin\"",
        "What the target is made of.",
        "its emissivity in S = eps B(T) + (1 - eps) X (S1)",
    ),
    Key::row(
        "temperature",
        KELVIN,
        Refused,
        "\"37 degC\"",
        "Temperature of the target's surface.",
        "T of its own emission eps B(T) (S1)",
    ),
    Key::row(
        "distance",
        LENGTH,
        Means(
            "no air on the path, no motion blur, no footprint of a pixel; of signal = \"air\" it must be there",
        ),
        "\"30 m\"",
        "Distance of the target from the camera.",
        "path through the air; footprint of a pixel and motion blur (SII E)",
    ),
    Key::row(
        "size",
        LENGTH,
        Means("the target fills its pixel"),
        "\"0.5 m\"",
        "Side of the target as the camera sees it.",
        "share of the pixel that it fills; ranges of sizing practice",
    ),
    Key::row(
        "pixels",
        Value::Either(&[Value::Count([1, 100_000_000]), Value::Pair(&Value::Count([1, 100_000]))]),
        Means("those of size at its distance"),
        "400",
        "Pixels that the target fills, a number or rows and columns, in the place of size; the verdict is then of the object.",
        "counts of all of them are added up; noise that rows, columns and frames share",
    ),
    EXTRAPOLATE,
];
/// `[target]`.
pub(crate) static TARGET: Table = Table::of("What is there.", &[TARGET_KEYS]);

const BACKGROUND_KEYS: &[Key] = &[
    Key::row(
        "temperature",
        KELVIN,
        Refused,
        "\"15 degC\"",
        "Temperature of what is behind the target.",
        "its emission in the rest of the pixel",
    ),
    Key::row(
        "material",
        Value::Material,
        Means("a blackbody"),
        "\"brick-red\"",
        "What it is made of.",
        "its emissivity (S1)",
    ),
    EXTRAPOLATE,
];
/// `[background]`.
pub(crate) static BACKGROUND: Table = Table::of(
    "What is behind a target that does not fill its pixel; lit as the target is.",
    &[BACKGROUND_KEYS],
);

const ENVIRONMENT_KEYS: &[Key] = &[
    Key::row(
        "temperature",
        KELVIN,
        Refused,
        "\"20 degC\"",
        "Temperature of this object of the surroundings.",
        "its light in X = sum of V_k S_k (S2)",
    ),
    Key::row(
        "lighting",
        A_SHARE,
        Means(
            "must be there; but of the last object, where unknown.lighting_total is given, what the others leave",
        ),
        "0.5",
        "Thermal lighting factor V: share of the hemisphere above the target that the object fills; they add up to at most 1.",
        "V_k in X = sum of V_k S_k (S2, S5)",
    ),
    Key::row(
        "material",
        Value::Material,
        Means("a blackbody"),
        "\"sky-us-standard\"",
        "What the object is made of; a sky is a material too.",
        "its emissivity in S_k (S2)",
    ),
    EXTRAPOLATE,
];
/// `[[environment]]`.
pub(crate) static ENVIRONMENT: Table = Table::of(
    "One object of the surroundings that light the target; as many as there are.",
    &[ENVIRONMENT_KEYS],
);

const ALTERNATIVES_KEYS: &[Key] = &[
    Key::row(
        "materials",
        MATERIALS,
        Means("every other material of the library, skies apart"),
        "[\"aluminium\"]",
        "What the target must be distinguished from.",
        "emissivity of the other hypothesis (S18)",
    ),
    Key::row(
        "temperature",
        Value::Pair(&KELVIN),
        Means("any"),
        "[\"0 degC\", \"120 degC\"]",
        "Temperatures that the alternative may have.",
        "bounds of the search for its nearest state",
    ),
    Key::row(
        "lighting",
        Value::Pair(&A_SHARE),
        Means("any that adds up to at most 1"),
        "[0.0, 1.0]",
        "Range of each lighting factor at the alternative.",
        "bounds of the search for its nearest state",
    ),
    EXTRAPOLATE,
    Key::row(
        "skip_uncovered",
        Value::Flag,
        Is("false"),
        "true",
        "Whether materials that do not cover the bands are left out, with a warning, instead of refused.",
        "which alternatives are computed",
    ),
];
/// `[alternatives]`.
pub(crate) static ALTERNATIVES: Table =
    Table::of("What the target must be distinguished from.", &[ALTERNATIVES_KEYS]);

const CLASS_KEYS: &[Key] = &[
    Key::row(
        "materials",
        MATERIALS,
        Refused,
        "[\"my_skin.csv\", \"skins/\"]",
        "Its members: names, patterns of names (`*paint*`), files, folders, patterns of files.",
        "spectra that are each compared with each of the other class",
    ),
    Key::row(
        "weights",
        Value::List(&Value::Number(FROM_ZERO)),
        Means("all alike"),
        "[2.0, 1.0]",
        "How often each member occurs, in any scale.",
        "means over pairs of members",
    ),
    Key::row(
        "mixtures",
        Value::Flag,
        Is("false"),
        "true",
        "Whether the class is also whatever its members make mixed.",
        "nearest point of the hull of its emissivities",
    ),
    Key::row(
        "covariance",
        Value::Choice(&["sample"]),
        Means("no scatter about the members"),
        "\"sample\"",
        "That emissivities scatter about their mean as the members do.",
        "covariance of the emissivity in the distance",
    ),
    Key::row(
        "emissivity_error",
        Value::Either(&[A_SHARE, Value::Text]),
        Means("no scatter about the members"),
        "\"0.01 absolute\"",
        "Root mean square by which emissivities scatter about each member, absolute; a bare number is taken as that, a share is refused.",
        "covariance of the emissivity in the distance",
    ),
    Key::row(
        "correlation",
        WAVENUMBER,
        Means("must be there together with emissivity_error"),
        "\"50 cm^-1\"",
        "Difference of wavenumbers over which that scatter loses its correlation.",
        "covariance of the emissivity, s^2 exp(-|dnu|/l)",
    ),
];
/// `[class.NAME]`.
pub(crate) static CLASS: Table = Table::of(
    "A kind of surface of several spectra, which may stand wherever a material may.",
    &[CLASS_KEYS],
);

const NUISANCE: Value = Value::Choice(&["temperature", "lighting", "gain", "environment-temperature"]);
const PRIOR: Allowed =
    Allowed { expected: "above 0 (what is known exactly is left out of unknown.nuisances)", ..ABOVE_ZERO };
pub(super) const PRIOR_KELVIN: Value = Value::Quantity(Dimension::TemperatureDifference, PRIOR);

pub(super) const PRIOR_KEYS: &[Key] = &[
    Key::row(
        "temperature",
        PRIOR_KELVIN,
        Means("nothing is known of it"),
        "\"2 K\"",
        "How well the target's temperature is known beforehand, a standard deviation.",
        "prior information added to the Fisher matrix (S27)",
    ),
    Key::row(
        "lighting",
        Value::Number(PRIOR),
        Means("nothing is known of them"),
        "0.1",
        "How well each lighting factor is known beforehand, a standard deviation.",
        "prior information added to the Fisher matrix (S27)",
    ),
    Key::row(
        "gain",
        Value::Number(PRIOR),
        Means("nothing is known of it"),
        "0.02",
        "How well the gain of the camera is known beforehand, as a share of it, a standard deviation.",
        "prior information added to the Fisher matrix (S29)",
    ),
    Key::row(
        "environment-temperature",
        PRIOR_KELVIN,
        Means("nothing is known of them"),
        "\"5 K\"",
        "How well the temperatures of the surroundings are known beforehand, a standard deviation.",
        "prior information added to the Fisher matrix (S27)",
    ),
];
/// `[unknown.priors]`.
pub(crate) static PRIORS: Table =
    Table::of("What is known beforehand of what is unknown: standard deviations.", &[PRIOR_KEYS]);

pub(super) const LIGHTING_TOTAL: Key = Key::row(
    "lighting_total",
    A_SHARE,
    Means("at most 1, and not known"),
    "1.0",
    "The known sum of all lighting factors, which makes one of them no unknown of its own.",
    "constraint on V (S48)",
);
const UNKNOWN_KEYS: &[Key] = &[
    Key::row(
        "nuisances",
        Value::List(&NUISANCE),
        Is("[\"temperature\", \"lighting\"]"),
        "[\"temperature\", \"lighting\"]",
        "What of the scene is not known and has to be read from the same photons.",
        "columns of the Fisher matrix that the material is distinguished from (S27, S29)",
    ),
    Key::row(
        "priors",
        Value::Table(&PRIORS),
        Means("nothing is known beforehand"),
        "{ temperature = \"2 K\" }",
        "What is known beforehand of what is unknown: standard deviations.",
        "prior information added to the Fisher matrix",
    ),
    LIGHTING_TOTAL,
];
/// `[unknown]`.
pub(crate) static UNKNOWN: Table = Table::of("What is not known of the scene beforehand.", &[UNKNOWN_KEYS]);

const PROBABILITY: Allowed = Allowed {
    holds: |value| value > 0.5 && value < 1.0,
    expected: "above 0.5 (tossing a coin) and below 1 (never wrong)",
};
const BELOW_HALF: Allowed =
    Allowed { holds: |value| value > 0.0 && value < 0.5, expected: "above 0 and below 0.5" };
const REQUIREMENT_KEYS: &[Key] = &[
    Key::row(
        "detection_probability",
        Value::Number(PROBABILITY),
        Means("that of distance"),
        "0.8413",
        "Required probability of a correct decision P, above 0.5.",
        "P = Phi(d) (Theorem 1, equation 2)",
    ),
    Key::row(
        "false_alarm_probability",
        Value::Number(BELOW_HALF),
        Means("as rare as misses"),
        "0.001",
        "Largest probability with which an alternative may be taken for the target, together with a detection_probability.",
        "2 d = Phi^-1(detection) + Phi^-1(1 - false alarm)",
    ),
    Key::row(
        "distance",
        POSITIVE,
        Is("1.0"),
        "1.0",
        "Statistical distance d that the camera must reach; 1 is right in 84.13 % of the decisions.",
        "P = Phi(d) (Theorem 1); d grows as the root of the photons",
    ),
    Key::row(
        "by",
        Value::Choice(&["nearest", "local", "local-unknown-gain"]),
        Is("\"nearest\""),
        "\"local\"",
        "The distance that decides: to the nearest state of the alternative, or one of its tangents at the target.",
        "search over T and V; S27; S29",
    ),
    Key::row(
        "of",
        Value::Choice(&["pixel", "object"]),
        Means("the object where target.pixels is stated, else a pixel"),
        "\"object\"",
        "What decides: one pixel, or all pixels that the target fills, with the noise that they share.",
        "counts of all pixels of the target are added up",
    ),
    Key::row(
        "speed",
        SPEED,
        Means("nothing moves"),
        "\"10 m/s\"",
        "Speed of the vehicle that carries the camera.",
        "motion blur in pixels (SII E, Fig. 3d)",
    ),
    Key::row(
        "time",
        TIME,
        Means("as long as it takes, on which a 'yes' then depends"),
        "\"0.5 s\"",
        "Time within which all bands of all frames must be read.",
        "frames x bands x exposure, at the frame rate",
    ),
];
/// `[requirement]` of a task.
pub(crate) static REQUIREMENT: Table =
    Table::of("Required probability of a correct decision, and speed.", &[REQUIREMENT_KEYS]);

/// Ranges of what lights a scene.
pub(super) const LIT_KEYS: &[Key] = &[
    Key::row(
        "lighting",
        Value::Either(&[Value::Pair(&A_SHARE), Value::List(&Value::Pair(&A_SHARE))]),
        Means("environment.lighting"),
        "[0.1, 0.9]",
        "Range of the lighting factors: one for each [[environment]], or a list with one for each.",
        "sides of the box of scenes whose worst is found and proved",
    ),
    Key::row(
        "surroundings",
        Value::Either(&[Value::Pair(&KELVIN), Value::List(&Value::Pair(&KELVIN))]),
        Means("environment.temperature"),
        "[\"-10 degC\", \"30 degC\"]",
        "Temperatures of the surroundings: one range for each [[environment]], or a list with one for each.",
        "sides of the box of scenes whose worst is found and proved",
    ),
];
const TEMPERATURE_KEYS: &[Key] = &[Key::row(
    "temperature",
    Value::Pair(&KELVIN),
    Means("target.temperature"),
    "[\"30 degC\", \"40 degC\"]",
    "Temperatures of the target in which the requirement must hold.",
    "one side of the box of scenes whose worst is found and proved",
)];
const ENVELOPE_KEYS: &[Key] = &[
    Key::row(
        "distance",
        Value::Pair(&LENGTH),
        Means("target.distance"),
        "[\"5 m\", \"30 m\"]",
        "Distances of the target in which the requirement must hold.",
        "path through the air and footprint of a pixel",
    ),
    Key::row(
        "materials",
        MATERIALS,
        Means("target.material"),
        "[\"skin\", \"fabric\"]",
        "What the target may be made of, each in turn.",
        "the worst of them decides",
    ),
];
/// `[envelope]`.
pub(crate) static ENVELOPE: Table = Table::of(
    "Ranges of scenes in all of which the requirement must hold; hadar rule alone searches them.",
    &[TEMPERATURE_KEYS, LIT_KEYS, ENVELOPE_KEYS],
);

const SENSITIVITY_KEYS: &[Key] = &[
    Key::row(
        "emissivity_error",
        Value::Either(&[A_SHARE, Value::Text]),
        Is("0.005"),
        "\"0.005 absolute\"",
        "Root mean square error of the emissivities, absolute: 0.005 of 1; a bare number is taken as that, a share is refused.",
        "draws of spectra whose distances are compared",
    ),
    Key::row(
        "correlation",
        WAVENUMBER,
        Is("\"10 cm^-1\""),
        "\"10 cm^-1\"",
        "Difference of wavenumbers over which these errors lose their correlation.",
        "covariance s^2 exp(-|dnu|/l)",
    ),
];
/// `[sensitivity]`.
pub(crate) static SENSITIVITY: Table = Table::of("How wrong the emissivities may be.", &[SENSITIVITY_KEYS]);

const ATMOSPHERE_KEYS: &[Key] = &[
    Key::row(
        "model",
        Value::Text,
        Means("a table"),
        "\"us-standard\"",
        "A built-in model atmosphere.",
        "transmittance tau of the path: tau S + (1 - tau) B(T_air)",
    ),
    Key::row(
        "table",
        Value::File,
        Means("a model"),
        "\"my_path.csv\"",
        "Transmittances by wavenumber and length of the path.",
        "transmittance tau of the path: tau S + (1 - tau) B(T_air)",
    ),
    Key::row(
        "temperature",
        KELVIN,
        Means("that of the model; with a table it must be there"),
        "\"15 degC\"",
        "Temperature of the air.",
        "its emission (1 - tau) B(T_air)",
    ),
];
/// `[atmosphere]`.
pub(crate) static ATMOSPHERE: Table = Table::of("The air between target and camera.", &[ATMOSPHERE_KEYS]);

const DISTANCE_OF_CUBE: &[Key] = &[Key::row(
    "distance",
    LENGTH,
    Refused,
    "\"30 m\"",
    "Length of the path from what is seen to the camera, the same for all pixels.",
    "transmittance of the path",
)];
/// `[atmosphere]` of a cube.
pub(crate) static ATMOSPHERE_OF_CUBE: Table =
    Table::of("The air between what a cube shows and its camera.", &[ATMOSPHERE_KEYS, DISTANCE_OF_CUBE]);

const TOLERANCE: Allowed =
    Allowed { holds: |value| (1e-14..=0.1).contains(&value), expected: "between 1e-14 and 0.1" };
const FILTER_NAMES: Key = Key::row(
    "names",
    Value::List(&Value::Text),
    Means("all filters of the list"),
    "[\"choice-8.5-1\", \"choice-11-2\"]",
    "Those of the filters that are used.",
    "bands that S is integrated over",
);
/// Where filters stand.
pub(super) const FILTER_PLACE: Key = Key::row(
    "place",
    Value::Choice(&["lens", "sensor"]),
    Means("filters pass at every angle what they pass at right angles, which a yes then rests on"),
    "\"sensor\"",
    "Where the filters stand: before the lens, or before the sensor in the cone of light of the lens.",
    "transmission averaged over the angles of the cone",
);
/// Their effective index.
pub(super) const FILTER_INDEX: Key = Key::row(
    "index",
    Value::Number(INDEX),
    Means("asked for where filters stand before the sensor"),
    "2.0",
    "Effective index of the filters: at the angle a they pass wavelengths shorter by sqrt(1 - sin^2(a)/n^2); makers state 1.7 to 2.5 for the infrared.",
    "transmission averaged over the angles of the cone",
);
const INDEX: Allowed = Allowed { holds: |value| (1.0..=10.0).contains(&value), expected: "between 1 and 10" };
const BANDS_KEYS: &[Key] = &[
    Key::row(
        "start",
        Value::Spectral,
        Is("\"715 cm^-1\""),
        "\"715 cm^-1\"",
        "Centre of the first band of an even grid; start, stop and step all as wavenumbers or all as wavelengths.",
        "bands over which S is counted",
    ),
    Key::row(
        "stop",
        Value::Spectral,
        Is("\"1250 cm^-1\""),
        "\"1250 cm^-1\"",
        "End of the grid, itself a centre where it is a whole number of steps away.",
        "bands over which S is counted",
    ),
    Key::row(
        "step",
        Value::Spectral,
        Is("\"1 cm^-1\""),
        "\"5 cm^-1\"",
        "Distance of the centres, and the width of a band.",
        "bands over which S is counted",
    ),
    Key::row(
        "filters",
        Value::File,
        Means("no filters"),
        "\"filters.csv\"",
        "Transmission of filters over wavenumber, a column for each; \"catalogue\" for the shapes of the program.",
        "bands that S is integrated over (S8, S9)",
    ),
    FILTER_NAMES,
    FILTER_PLACE,
    FILTER_INDEX,
    Key::row(
        "rows",
        Value::File,
        Means("no rows"),
        "\"bands.csv\"",
        "A row for each band: its centre, and its width if it has one.",
        "bands over which S is counted",
    ),
    Key::row(
        "ranges",
        Value::List(&Value::Pair(&Value::Spectral)),
        Means("no ranges"),
        "[[\"715 cm^-1\", \"800 cm^-1\"]]",
        "Bands from edge to edge.",
        "bands that S is integrated over",
    ),
    Key::row(
        "integrate",
        Value::Flag,
        Means(
            "bands in which a spectrum has rows nearer to each other than the band is wide are integrated, the others sampled at their centres",
        ),
        "true",
        "Whether the spectrum is integrated over each band of a grid or of rows, or its value at the centre counts. Ranges and filters are always integrated.",
        "integral of S over a band, by adaptive Gauss-Legendre rules",
    ),
    Key::row(
        "tolerance",
        Value::Number(TOLERANCE),
        Is("1e-9"),
        "1e-9",
        "Largest relative error of that integral.",
        "integral of S over a band",
    ),
];
/// `[bands]`.
pub(crate) static BANDS: Table = Table::of(
    "The spectral bands: a grid, ranges, rows or filters; default: the band of a camera that has one, else 715 to 1250 cm^-1 in steps of 1.",
    &[BANDS_KEYS],
);

/// `[camera]`.
pub(crate) static CAMERA: Table = Table {
    meaning: "The camera: a preset, its own figures, or a preset with some overridden.",
    keys: &[],
    more: More::Figures,
};
