//! Tables of a street and of the cameras before it: `[scene]`, `[[object]]`, `[stereo]`, and ranging by air.

use super::key::Silent::{Is, Means, Refused};
use super::key::{
    A_SHARE, COUNT, KELVIN, KELVIN_FROM_ZERO, Key, LENGTH, LENGTH_FROM_ZERO, MATERIALS, POSITIVE,
    POSITIVE_SHARE, Table, Value, WAVENUMBER,
};
use super::task::{LIGHTING_TOTAL, PRIOR_KELVIN, PRIOR_KEYS};
use hadar::allowed::{ABOVE_ZERO, Allowed, FROM_ZERO};
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
        "A table of photon radiances, photons s^-1 m^-2 sr^-1 per cm^-1.",
        "light of the sky in X (S2)",
    ),
    Key::row(
        "column",
        Value::Text,
        Means("must be there beside spectrum"),
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
        "library.csv beside the rendered cube",
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
    Table::of("A scene that is rendered; what is silent is that of the built-in street.", &[SCENE_KEYS]);

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

const BASELINE: Allowed = Allowed {
    expected: "above 0: cameras at one place see no depth (cameras that turn towards each other are not treated)",
    ..ABOVE_ZERO
};
const STEREO_KEYS: &[Key] = &[
    Key::row(
        "baseline",
        Value::Quantity(Dimension::Length, BASELINE),
        Refused,
        "\"0.2 m\"",
        "Distance of the two cameras.",
        "disparity f b/z, depth error z^2/(f b) (S35, S36)",
    ),
    Key::row(
        "focal_length",
        LENGTH,
        Means("the camera's, where it must stand if there is one"),
        "\"1.4 cm\"",
        "Focal length, of a cube without a camera.",
        "disparity f b/z (S35)",
    ),
    Key::row(
        "pixel",
        LENGTH,
        Means("the camera's, where it must stand if there is one"),
        "\"12 um\"",
        "Distance of the pixels, of a cube without a camera.",
        "disparity f b/(p z) (S35)",
    ),
    Key::row(
        "window",
        Value::Pair(&COUNT),
        Is("[5, 5]"),
        "[5, 5]",
        "Rows and columns of the window that is matched.",
        "sum of the information over the window (S37 to S40)",
    ),
    Key::row(
        "derivative",
        Value::Choice(&["central", "simoncelli", "cubic-spline", "fourier"]),
        Means("cubic-spline of a rendered scene, central of a cube"),
        "\"cubic-spline\"",
        "How the derivative along the row is taken.",
        "dS/dx in the information of a window (S37)",
    ),
    Key::row(
        "joined",
        Value::Choice(&["sum-of-readings", "one-reading"]),
        Is("\"sum-of-readings\""),
        "\"one-reading\"",
        "Electronic noise of samples that are joined over bands or pixels.",
        "the four cells of Tables S4 and S5",
    ),
    Key::row(
        "lines",
        Value::List(&COUNT),
        Is("[]"),
        "[300]",
        "Rows along which the bound is drawn and witnessed.",
        "lines of the answer",
    ),
    Key::row(
        "diffraction",
        Value::Choice(&["none", "airy", "gaussian"]),
        Means("airy of a rendered scene, none of a cube"),
        "\"airy\"",
        "What the lens blurs.",
        "S41 to S43",
    ),
    Key::row(
        "psf_sigma",
        LENGTH,
        Means("must be there beside diffraction = \"gaussian\""),
        "\"5 um\"",
        "Deviation of a Gaussian blur on the detector.",
        "S41 to S43",
    ),
];
/// `[stereo]` of two views.
pub(crate) static STEREO: Table =
    Table::of("The pair of cameras, and how windows are looked at.", &[STEREO_KEYS]);

pub(super) const DEPTH_KEYS: &[Key] = &[
    Key::row(
        "depth_error",
        LENGTH,
        Means("that of relative_depth_error"),
        "\"1 m\"",
        "How well depth must be known, a standard deviation.",
        "bound of depth (S36)",
    ),
    Key::row(
        "relative_depth_error",
        POSITIVE,
        Is("0.05"),
        "0.05",
        "How well depth must be known, as a share of it.",
        "bound of depth (S36)",
    ),
    Key::row(
        "share",
        POSITIVE_SHARE,
        Is("0.5"),
        "0.5",
        "Share of the windows that must reach it.",
        "windows counted",
    ),
];
/// `[requirement]` of a depth.
pub(crate) static DEPTH: Table = Table::of("The depth that is demanded.", &[DEPTH_KEYS]);

const VIEWS_KEYS: &[Key] = &[
    Key::row(
        "left",
        Value::File,
        Refused,
        "\"left.npy\"",
        "Counts of the left view, [row][column][band]; NPY, NPZ, ENVI, MATLAB, HDF5 or NetCDF; or the folder of a scene of the HADAR database.",
        "S in the information of a window (S37)",
    ),
    Key::row(
        "right",
        Value::File,
        Means("as much information as the left one"),
        "\"right.npy\"",
        "Counts of the right view.",
        "S in the information of a window (S37)",
    ),
    super::cube::VARIABLE,
    super::cube::AXES,
    Key::row(
        "photons_per_unit",
        POSITIVE,
        Means("1; samples that are no counts by their file are refused"),
        "1.0",
        "Photons that one unit of the file stands for.",
        "shot noise of a sample",
    ),
    Key::row(
        "noise_variance",
        Value::Either(&[Value::Number(FROM_ZERO), Value::File]),
        Means("that of the camera"),
        "50.0",
        "Variance of the electronic noise: a number in counts^2, a table by band, or a cube by sample.",
        "noise of a sample beside its shot noise (S14 to S16)",
    ),
    Key::row(
        "bad",
        Value::Choice(&["leave-out", "keep"]),
        Is("\"leave-out\""),
        "\"keep\"",
        "What is done with pixels that are found to be bad (dead, stuck, or far beyond all around them): they are missing, or taken like all others.",
        "which samples are used",
    ),
    Key::row(
        "depth",
        Value::Either(&[LENGTH, Value::File]),
        Means("bounds are on disparity alone"),
        "\"12 m\"",
        "Depth, the same for all or an image of it in m.",
        "depth error z^2/(f b) times that of disparity (S36)",
    ),
];
/// `[cube]` of two views.
pub(crate) static VIEWS: Table =
    Table::of("Counts of two views that were measured or computed elsewhere.", &[VIEWS_KEYS]);

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
        "What of the scene is not known beside the distance.",
        "columns of the Fisher matrix that the distance is told apart from",
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
        "Difference of wavenumbers over which that error loses its correlation.",
        "covariance of the emissivity",
    ),
];
/// `[unknown]` of ranging by air.
pub(crate) static AIR_UNKNOWN: Table =
    Table::of("What is not known of the scene beside the distance.", &[AIR_UNKNOWN_KEYS]);

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
    Table::of("A second camera beside the first, for comparison.", &[AIR_STEREO_KEYS]);

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
