//! Tables of a street: `[scene]` and `[[object]]`.

use super::key::Silent::{Is, Means, Refused};
use super::key::{A_SHARE, KELVIN, KELVIN_FROM_ZERO, Key, LENGTH, LENGTH_FROM_ZERO, MATERIALS, Table, Value};
use hadar::allowed::Allowed;
use hadar::units::Dimension;

const ANY: Allowed = Allowed { holds: |_| true, expected: "a number" };
const ROUGHNESS: Allowed =
    Allowed { holds: |slope| (0.0..=1.0).contains(&slope), expected: "a slope from 0 to 1" };
const RENDERED: &str = "heat signal of its pixels (S1 to S6)";

const SKY_KEYS: &[Key] = &[
    Key::row(
        "spectrum",
        Value::File,
        Means("a surface at a temperature"),
        "\"sky.csv\"",
        "A table of radiances, photons s^-1 m^-2 sr^-1 per cm^-1 or the unit behind a column's name, as in `sky [W m^-2 sr^-1 um^-1]`; tape7 of MODTRAN.",
        "light of the sky in X (S2)",
    ),
    Key::row(
        "column",
        Value::Text,
        Means("must be there together with spectrum"),
        "\"sky\"",
        "The column of that table.",
        "light of the sky in X (S2)",
    ),
    Key::row(
        "material",
        Value::Material,
        Means("a blackbody"),
        "\"sky-us-standard\"",
        "What the sky is, as a material.",
        "light of the sky in X (S2)",
    ),
    Key::row(
        "temperature",
        KELVIN,
        Means("must be there, unless there is a spectrum"),
        "\"-15 degC\"",
        "Its temperature.",
        "light of the sky in X (S2)",
    ),
];
static SKY: Table = Table::of("What the sky sends.", &[SKY_KEYS]);

const SURFACE_KEYS: &[Key] = &[
    Key::row("material", Value::Material, Refused, "\"skin\"", "What the surface is made of.", RENDERED),
    Key::row("temperature", KELVIN, Refused, "\"12 degC\"", "Its mean temperature.", RENDERED),
    Key::row(
        "variation",
        KELVIN_FROM_ZERO,
        Is("\"0 K\""),
        "\"0.5 K\"",
        "Root mean square of the temperature over it.",
        "texture of its emission",
    ),
    Key::row(
        "variation_size",
        LENGTH,
        Means("the renderer's"),
        "\"20 cm\"",
        "Size of what is warmer or cooler.",
        "texture of its emission",
    ),
    Key::row(
        "roughness",
        Value::Number(ROUGHNESS),
        Is("0.0"),
        "0.1",
        "Root mean square slope of its bumps.",
        "texture of what it scatters (S5, S6)",
    ),
    Key::row(
        "roughness_size",
        LENGTH,
        Means("the renderer's"),
        "\"5 cm\"",
        "Size of its bumps.",
        "texture of what it scatters (S5, S6)",
    ),
];
/// A surface.
pub(crate) static SURFACE: Table = Table::of("A surface of one material.", &[SURFACE_KEYS]);

const MARKS: Key = Key::row(
    "marks",
    Value::Material,
    Means("none"),
    "\"marble\"",
    "Material of lane marks.",
    "texture of the ground",
);
static GROUND: Table = Table::of("The ground.", &[SURFACE_KEYS, &[MARKS]]);

const SCENE_KEYS: &[Key] = &[
    Key::row(
        "ground_temperature",
        KELVIN,
        Means("that of the built-in street"),
        "\"15 degC\"",
        "Temperature of the ground.",
        RENDERED,
    ),
    Key::row(
        "sky_temperature",
        KELVIN,
        Means("that of the built-in street"),
        "\"-15 degC\"",
        "Temperature of the sky, a blackbody.",
        RENDERED,
    ),
    Key::row(
        "car_temperature",
        KELVIN,
        Means("that of the built-in street"),
        "\"30 degC\"",
        "Temperature of the built-in car.",
        RENDERED,
    ),
    Key::row(
        "person_temperature",
        KELVIN,
        Means("that of the built-in street"),
        "\"33 degC\"",
        "Temperature of the built-in person.",
        RENDERED,
    ),
    Key::row(
        "ground_emissivity",
        Value::Pair(&A_SHARE),
        Means("that of the built-in street"),
        "[0.8, 1.0]",
        "Emissivities between which the ground's texture varies.",
        RENDERED,
    ),
    Key::row(
        "car",
        Value::Material,
        Means("that of the built-in street"),
        "\"pmma\"",
        "Material of the built-in car.",
        RENDERED,
    ),
    Key::row(
        "person",
        Value::Material,
        Means("that of the built-in street"),
        "\"skin\"",
        "Material of the built-in person.",
        RENDERED,
    ),
    Key::row(
        "car_distance",
        LENGTH,
        Means("that of the built-in street"),
        "\"20 m\"",
        "Distance of the built-in car.",
        "disparity f b/z (S35)",
    ),
    Key::row(
        "person_distance",
        LENGTH,
        Means("that of the built-in street"),
        "\"10 m\"",
        "Distance of the built-in person.",
        "disparity f b/z (S35)",
    ),
    Key::row(
        "sky",
        Value::Table(&SKY),
        Means("a blackbody at sky_temperature"),
        "{ material = \"sky-us-standard\", temperature = \"288 K\" }",
        "What the sky sends.",
        "light of the sky in X (S2)",
    ),
    Key::row(
        "ground",
        Value::Table(&GROUND),
        Means("that of the built-in street"),
        "{ material = \"asphalt\", temperature = \"12 degC\" }",
        "What the ground is made of.",
        RENDERED,
    ),
    Key::row(
        "library",
        MATERIALS,
        Means("those of the scene alone"),
        "[\"brick-red\"]",
        "Materials besides those of the scene that a decomposition chooses from.",
        "library.csv next to the rendered cube",
    ),
    Key::row(
        "camera_height",
        LENGTH,
        Means("that of the built-in street"),
        "\"1.5 m\"",
        "Height of the cameras above the ground.",
        "where the rays of the pixels go",
    ),
    Key::row(
        "camera_pitch",
        Value::Quantity(Dimension::Angle, ANY),
        Means("that of the built-in street"),
        "\"9 deg\"",
        "Angle by which the cameras look down.",
        "where the rays of the pixels go",
    ),
    Key::row(
        "bounces",
        Value::Count([1, 64]),
        Means("the renderer's"),
        "8",
        "Times that light is scattered before it reaches the camera.",
        "multiple scattering (S3, S4)",
    ),
    Key::row(
        "size",
        Value::Pair(&Value::Count([1, 16_384])),
        Means("the renderer's"),
        "[480, 640]",
        "Rows and columns of the image.",
        "pixels that are rendered",
    ),
];
/// `[scene]`.
pub(crate) static SCENE: Table =
    Table::of("A scene that is rendered; defaults are those of the built-in street.", &[SCENE_KEYS]);

const OBJECT_KEYS: &[Key] = &[
    Key::row(
        "name",
        Value::Text,
        Means("that of its shape"),
        "\"guard\"",
        "Its name.",
        "names of surfaces and categories",
    ),
    Key::row(
        "shape",
        Value::Choice(&["person", "robot", "car", "block", "post", "ball"]),
        Refused,
        "\"person\"",
        "Its form.",
        "what the rays of the pixels hit",
    ),
    Key::row(
        "at",
        Value::Pair(&Value::Quantity(Dimension::Length, ANY)),
        Refused,
        "[\"-0.9 m\", \"8 m\"]",
        "Where it stands: to the right of the middle, and ahead, the latter above 0.",
        "what the rays of the pixels hit",
    ),
    Key::row(
        "height",
        LENGTH,
        Means("a usual one; of a post it must be there"),
        "\"3 m\"",
        "Height of a person, robot or post.",
        "what the rays of the pixels hit",
    ),
    Key::row(
        "size",
        Value::Triple(&LENGTH),
        Means("a usual one of a car; of a block and a ball it must be there"),
        "[\"4.2 m\", \"1.8 m\", \"1.45 m\"]",
        "Length, width and height of a car, block or ball.",
        "what the rays of the pixels hit",
    ),
    Key::row(
        "radius",
        LENGTH,
        Means("of a post it must be there"),
        "\"10 cm\"",
        "Radius of a post.",
        "what the rays of the pixels hit",
    ),
    Key::row(
        "above",
        LENGTH_FROM_ZERO,
        Is("\"0 m\""),
        "\"1 m\"",
        "Height of a ball above the ground.",
        "what the rays of the pixels hit",
    ),
    Key::row(
        "tyres",
        Value::Table(&SURFACE),
        Means("of its own surface"),
        "{ material = \"rubber-tyre\", temperature = \"30 degC\" }",
        "Surface of a car's tyres.",
        RENDERED,
    ),
];
/// `[[object]]`.
pub(crate) static OBJECT: Table = Table::of(
    "Something that stands in the scene, in the place of the built-in car and person.",
    &[OBJECT_KEYS, SURFACE_KEYS],
);
