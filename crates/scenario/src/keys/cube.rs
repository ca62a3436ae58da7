//! Tables of a heat cube that is taken apart: `[cube]`, its surroundings, library, truth, picture, categories.

use super::key::Silent::{Is, Means, Refused};
use super::key::{
    A_SHARE, KELVIN, KELVIN_APART, Key, LENGTH, MATERIALS, More, POSITIVE, POSITIVE_SHARE, Table, Value,
    WAVENUMBER, WHOLE,
};
use super::task::LIGHTING_TOTAL;
use hadar::allowed::Allowed;

pub(super) const VARIABLE: Key = Key::row(
    "variable",
    Value::Text,
    Means("the only array that could be it"),
    "\"S\"",
    "Name of the array in a file of several.",
    "which samples are read",
);
pub(super) const BAD_BANDS: Key = Key::row(
    "bad_bands",
    Value::List(&WHOLE),
    Is("[]"),
    "[0, 53]",
    "Bands that are left out, counted from 0.",
    "which samples are used",
);
pub(super) const AXES: Key = Key::row(
    "axes",
    Value::Text,
    Means("rows,columns,bands, or what the file says"),
    "\"bands,rows,columns\"",
    "Which dimension of the array is which.",
    "which samples are read",
);

const CUBE_KEYS: &[Key] = &[
    Key::row(
        "data",
        Value::File,
        Refused,
        "\"counts.npy\"",
        "Samples [row][column][band]; NPY, NPZ, ENVI, MATLAB, HDF5, NetCDF, Zarr, FITS, TIFF, or a radiometric file of FLIR (JPEG, SEQ, FFF) or Telops (HCC); or the folder of a scene of the HADAR database.",
        "S of every pixel (S44)",
    ),
    VARIABLE,
    AXES,
    Key::row(
        "counts_per_photon_radiance",
        POSITIVE,
        Means("unit or [camera] says what a sample is"),
        "2.2e-14",
        "Counts for each photon s^-1 m^-2 sr^-1 per cm^-1 of a band's mean radiance.",
        "scale of the counts, and so their shot noise",
    ),
    Key::row(
        "unit",
        Value::Text,
        Means("counts"),
        "\"W m^-2 sr^-1 per cm^-1\"",
        "Unit of samples that are spectral radiances (of watts or photons, per wavenumber, wavelength or frequency) or brightness temperatures (K, degC): a noise in the same unit must be given, for temperatures the NETD at 300 K. Where the file states another such unit its samples are converted.",
        "scale of the samples",
    ),
    Key::row(
        "noise",
        Value::Either(&[POSITIVE, Value::File]),
        Means("shot noise, and the camera's"),
        "1e-4",
        "Deviation of the electronic noise of a sample, of radiances that of all noise, in the unit of the cube; or a file with a row for each band.",
        "weights of the samples",
    ),
    BAD_BANDS,
    Key::row(
        "bad_pixels",
        Value::File,
        Means("no pixel is named"),
        "\"bad_pixels.npy\"",
        "A map of the cube's rows and columns: pixels that are not 0 in it are left out.",
        "which samples are used",
    ),
    Key::row(
        "bad",
        Value::Choice(&["leave-out", "keep"]),
        Is("\"leave-out\""),
        "\"keep\"",
        "What is done with pixels and bands that are found to be bad (dead, stuck, saturated, too bright); those that are named are left out in any case.",
        "which samples are used",
    ),
];
/// `[cube]`.
pub(crate) static CUBE: Table = Table::of("A heat cube in a file.", &[CUBE_KEYS]);

const LIGHT_KEYS: &[Key] = &[
    Key::row(
        "spectrum",
        Value::File,
        Means("temperature, rows or found"),
        "\"light.csv\"",
        "A table of radiances, photons s^-1 m^-2 sr^-1 per cm^-1 or the unit behind a column's name, as in `sky [W m^-2 sr^-1 um^-1]`; tape7 of MODTRAN.",
        "S_k in X = sum of V_k S_k (S2)",
    ),
    Key::row(
        "column",
        Value::Text,
        Means("must be there together with spectrum"),
        "\"sky\"",
        "The column of that table.",
        "S_k in X = sum of V_k S_k (S2)",
    ),
    Key::row(
        "material",
        Value::Material,
        Means("a blackbody"),
        "\"sky-us-standard\"",
        "What it is made of.",
        "S_k in X = sum of V_k S_k (S2)",
    ),
    Key::row(
        "temperature",
        KELVIN,
        Means("spectrum, rows or found"),
        "\"-10 degC\"",
        "Temperature of a surface.",
        "S_k in X = sum of V_k S_k (S2)",
    ),
    Key::row(
        "rows",
        Value::Pair(&WHOLE),
        Means("spectrum, temperature or found"),
        "[0, 540]",
        "The mean of rows of the cube itself, from the first up to the second, counted from 0; together with found, rows in which that is looked for.",
        "S_k in X = sum of V_k S_k (S2)",
    ),
    Key::row(
        "found",
        Value::Choice(&["sky", "ground"]),
        Means("spectrum, temperature or rows"),
        "\"sky\"",
        "That it is found in the cube: the median of the darkest, sky-like pixels, or of warm ones that send nearly what a blackbody does. Its error is among the unknowns of the whole cube.",
        "S_k in X = sum of V_k S_k (S2)",
    ),
];
/// `[[environment]]` of a cube.
pub(crate) static LIGHT: Table =
    Table::of("Spectrum of one of the surroundings that light the pixels.", &[LIGHT_KEYS]);

const PROBABILITY: Value = Value::Number(Allowed {
    holds: |value| value > 0.0 && value < 1.0,
    expected: "a probability above 0 and below 1",
});
const LIBRARY_KEYS: &[Key] = &[
    Key::row(
        "path",
        Value::File,
        Means("the program's library"),
        "\"library.csv\"",
        "A table of emissivities, a column a material.",
        "emissivities that a pixel may have (S44)",
    ),
    Key::row(
        "materials",
        MATERIALS,
        Means("all of the table"),
        "[\"skin\", \"aluminium\"]",
        "Materials or classes by name.",
        "emissivities that a pixel may have (S44)",
    ),
    Key::row(
        "prior",
        Value::List(&POSITIVE),
        Means("equal"),
        "[1.0, 0.2]",
        "Prior probability of each of them, in any scale.",
        "posterior of the materials",
    ),
    Key::row(
        "none_of_these",
        PROBABILITY,
        Means("impossible"),
        "0.1",
        "Prior probability that a surface is none of them, with an emissivity that is smooth and otherwise unknown.",
        "posterior of the materials: one more, whose emissivity is drawn",
    ),
    Key::row(
        "mixed",
        PROBABILITY,
        Means("impossible"),
        "0.05",
        "Prior probability that a pixel holds two surfaces of them, each a tenth of it at least; of at most 64 materials.",
        "posterior of the materials: pairs, S = f S1 + (1 - f) S2",
    ),
    Key::row(
        "emissivity_error",
        Value::Either(&[A_SHARE, Value::Text]),
        Means("exact"),
        "\"1 %\"",
        "Root mean square error of the emissivities, as a share of each: 1 % is 0.009 where the emissivity is 0.9; a bare number is taken as that, an absolute error is refused.",
        "covariance of the residuals",
    ),
    Key::row(
        "emissivity_correlation",
        WAVENUMBER,
        Means("50 cm^-1"),
        "\"50 cm^-1\"",
        "Difference of wavenumbers at which the correlation of these errors has fallen to a quarter (Matern 5/2).",
        "covariance of the residuals",
    ),
];
/// `[library]`.
pub(crate) static LIBRARY: Table = Table::of("The materials that a pixel may be.", &[LIBRARY_KEYS]);

/// An unknown of the whole cube.
const fn shared(name: &'static str, value: Value, example: &'static str, meaning: &'static str) -> Key {
    Key::row(
        name,
        value,
        Means("exactly as stated"),
        example,
        meaning,
        "estimated with all pixels, in all deviations",
    )
}

const UNKNOWN_KEYS: &[Key] = &[
    Key::row(
        "temperature",
        Value::Pair(&KELVIN),
        Is("[\"200 K\", \"400 K\"]"),
        "[\"250 K\", \"340 K\"]",
        "Temperatures that a pixel may have.",
        "range of the fit (S44)",
    ),
    LIGHTING_TOTAL,
    Key::row(
        "gain",
        Value::Either(&[Value::Flag, POSITIVE]),
        Is("false"),
        "0.02",
        "Whether the scale of the counts is unknown: true, another one for each pixel; a number, one for the whole cube, with this deviation.",
        "one more unknown of the fit; one that is estimated with all pixels",
    ),
    shared(
        "wavelength_shift",
        WAVENUMBER,
        "\"2 cm^-1\"",
        "Deviation of the wavenumbers of all bands together.",
    ),
    shared(
        "sky_scale",
        POSITIVE,
        "0.05",
        "Deviation of the strength of the sky, as a share: of vision.sky, else of the darkest light.",
    ),
    shared(
        "sky_shape",
        POSITIVE,
        "0.02",
        "Deviation of the sky's spectrum, smooth, rms over the bands, as a share.",
    ),
    shared(
        "sky_path",
        POSITIVE,
        "0.5",
        "Deviation of the length of the path through the air that the sky's light comes by, as a share: 0.5 where it is told as it is seen at some height.",
    ),
    shared(
        "light_temperature",
        KELVIN_APART,
        "\"1 K\"",
        "Deviation of the temperature of each of the surroundings that is a surface.",
    ),
    shared(
        "missing_light",
        POSITIVE,
        "0.1",
        "Deviation of the lighting factor of a light besides those that are told, as warm as the warmest of them.",
    ),
    shared("air", LENGTH, "\"10 m\"", "Deviation of the length of the path through the air of [atmosphere]."),
    shared("noise_scale", POSITIVE, "0.2", "Deviation of the factor by which all noise is larger than told."),
];
/// `[unknown]` of a cube.
pub(crate) static UNKNOWN: Table =
    Table::of("What is unknown of every pixel, besides its material and lighting.", &[UNKNOWN_KEYS]);

const WEIGHT: Allowed =
    Allowed { holds: |value| value > 0.0 && value <= 10.0, expected: "above 0, at most 10" };
const SPATIAL_KEYS: &[Key] = &[
    Key::row(
        "prior",
        Value::Choice(&["potts", "tex-sgd"]),
        Refused,
        "\"potts\"",
        "The prior: neighbours are of one material, or the paper's.",
        "posterior of the map of materials",
    ),
    Key::row(
        "weight",
        Value::Number(WEIGHT),
        Means("1.0 of potts, 0.1 of tex-sgd"),
        "1.0",
        "Its weight: log-odds of a neighbour of the same material, or the paper's p.",
        "posterior of the map of materials",
    ),
    Key::row(
        "temperature_step",
        KELVIN_APART,
        Means("temperatures of neighbours say nothing"),
        "\"2 K\"",
        "Difference of temperatures at which neighbours need not be of one material, of potts.",
        "posterior of the map of materials",
    ),
];
/// `[spatial]`.
pub(crate) static SPATIAL: Table =
    Table::of("What neighbours tell about a pixel; default: each pixel independently.", &[SPATIAL_KEYS]);

const HUE: Allowed =
    Allowed { holds: |value| (0.0..360.0).contains(&value), expected: "from 0, below 360 degrees" };
const PLACE: Allowed = Allowed {
    holds: |value| value >= 0.0 && value.fract() == 0.0 && value <= 1e6,
    expected: "a whole number from 0",
};
static HUES: Table = Table {
    meaning: "Hues of materials by name, degrees.",
    keys: &[],
    more: More::Names(&Value::Number(HUE)),
};
const VISION_KEYS: &[Key] = &[
    Key::row(
        "hues",
        Value::Table(&HUES),
        Means("the program's"),
        "{ skin = 210 }",
        "Hues of materials by name, degrees.",
        "colour of the picture",
    ),
    Key::row(
        "temperature",
        Value::Pair(&KELVIN),
        Means("those of the picture"),
        "[\"0 degC\", \"40 degC\"]",
        "Temperatures of the palest and the fullest colour.",
        "colour of the picture",
    ),
    Key::row(
        "sky",
        Value::Number(PLACE),
        Means("no texture is distilled"),
        "0",
        "Which of the [[environment]] is the sky, counted from 0; its texture is distilled then.",
        "texture of the sky's light alone (S45)",
    ),
    Key::row(
        "brightness",
        Value::Choice(&["texture", "distilled"]),
        Is("\"texture\""),
        "\"distilled\"",
        "What is bright in the picture: all light that a surface sees, or that of the sky.",
        "brightness of the picture",
    ),
];
/// `[vision]`.
pub(crate) static VISION: Table =
    Table::of("How the picture of material, temperature and texture is coloured.", &[VISION_KEYS]);

const CATEGORY_KEYS: &[Key] = &[
    Key::row("name", Value::Text, Refused, "\"car\"", "Its name.", "names of the objects that are found"),
    Key::row(
        "materials",
        Value::List(&Value::Text),
        Refused,
        "[\"pmma\"]",
        "Materials or classes of the library that it is made of.",
        "segmentation by materials (SIII E, Algorithm 4)",
    ),
    Key::row(
        "enclosed",
        Value::List(&Value::Text),
        Means("none"),
        "[\"soda-lime-glass\"]",
        "Those of them that have other parts of it around them.",
        "segmentation by materials (SIII E, Algorithm 4)",
    ),
    Key::row(
        "safety",
        Value::Flag,
        Is("false"),
        "true",
        "Whether it matters for safety: where it cannot be excluded is said, and neighbours give a pixel that may be of it no other category.",
        "pixels and objects in which it cannot be excluded",
    ),
];
const LABELS: Key = Key::row(
    "labels",
    Value::List(&WHOLE),
    Means("its own place among the categories"),
    "[4, 5]",
    "Numbers that stand for it in the map of the truth.",
    "comparison with the truth",
);
const SURFACES: Key = Key::row(
    "surfaces",
    Value::List(&Value::Text),
    Means("none"),
    "[\"car\", \"tyres of car\"]",
    "Surfaces of a scene to be rendered that it is.",
    "map of the truth next to the rendered cube",
);
/// `[[category]]` of a task or a rule: what `safety` says of it.
pub(crate) static CATEGORY_OF_TASK: Table = Table::of(
    "A kind of thing, and what it is made of: with safety = true, identify, size, simulate and rule say where it cannot be excluded.",
    &[CATEGORY_KEYS],
);
/// `[[category]]` of a cube.
pub(crate) static CATEGORY: Table =
    Table::of("A kind of thing, and what it is made of.", &[CATEGORY_KEYS, &[LABELS]]);
/// `[[category]]` of a scene to be rendered.
pub(crate) static CATEGORY_OF_SCENE: Table =
    Table::of("A kind of thing, and what it is made of.", &[CATEGORY_KEYS, &[SURFACES]]);

const PIXELS: Allowed = Allowed {
    holds: |value| value >= 1.0 && value.fract() == 0.0 && value <= 1e9,
    expected: "a whole number from 1",
};
const SEGMENTATION_KEYS: &[Key] = &[
    Key::row(
        "rule",
        Value::Choice(&["regions", "raster"]),
        Is("\"regions\""),
        "\"raster\"",
        "How pixels of a material of several categories are given to one.",
        "segmentation by materials (SIII E, Algorithm 4)",
    ),
    Key::row(
        "smoothing",
        Value::Flag,
        Is("true"),
        "false",
        "Whether the likeliest category of each pixel is the commonest of 5 x 5 in the end; no finding rests on it.",
        "segmentation by materials (SIII E, Algorithm 4)",
    ),
    Key::row(
        "smallest_object",
        Value::Number(PIXELS),
        Is("25"),
        "25",
        "Pixels from which on an object is listed without a decided pixel too; one with a decided pixel is listed whatever its size.",
        "objects of the answer",
    ),
];
/// `[segmentation]`.
pub(crate) static SEGMENTATION: Table = Table::of("How pixels get a category.", &[SEGMENTATION_KEYS]);

const TRUTH_KEYS: &[Key] = &[
    Key::row(
        "scene",
        Value::File,
        Means("the maps are named one by one"),
        "\"Scene1\"",
        "Folder of the scene of the HADAR database that the cube is of, with its maps in GroundTruth.",
        "comparison with the truth",
    ),
    Key::row(
        "material",
        Value::File,
        Means("not known"),
        "\"material.npy\"",
        "Place in the library of each pixel's material.",
        "comparison with the truth",
    ),
    Key::row(
        "material_list",
        Value::File,
        Means("numbers are places in the library, from 0"),
        "\"materials.txt\"",
        "What its numbers stand for, as in the HADAR database: the place, from 1, in this list of places in the library, from 1.",
        "comparison with the truth",
    ),
    Key::row(
        "temperature",
        Value::File,
        Means("not known"),
        "\"temperature.npy\"",
        "Temperature of each pixel.",
        "comparison with the truth",
    ),
    Key::row(
        "temperature_unit",
        Value::Choice(&["K", "degC"]),
        Is("\"K\""),
        "\"degC\"",
        "Unit of these temperatures.",
        "comparison with the truth",
    ),
    Key::row(
        "lighting",
        Value::Either(&[Value::File, Value::List(&Value::File)]),
        Means("not known"),
        "[\"v1.npy\"]",
        "Lighting factors [row][column][surroundings], or a map for each of the first surroundings.",
        "comparison with the truth",
    ),
];
const TRUTH_CATEGORY: Key = Key::row(
    "category",
    Value::File,
    Means("not known"),
    "\"category.npy\"",
    "A number for each pixel's category.",
    "comparison with the truth",
);
/// `[truth]` of a decomposition.
pub(crate) static TRUTH: Table =
    Table::of("What is there, where that is known.", &[TRUTH_KEYS, &[TRUTH_CATEGORY]]);
/// `[truth]` of a library out of a cube.
pub(crate) static TRUTH_OF_LIBRARY: Table = Table::of("What is there, where that is known.", &[TRUTH_KEYS]);

const CLUSTERS_KEYS: &[Key] = &[
    Key::row(
        "count",
        Value::Either(&[Value::Count([1, 200]), Value::Pair(&Value::Count([1, 200]))]),
        Refused,
        "6",
        "How many groups of pixels of one material there are, or the fewest and the most.",
        "grouping by relative emissivities (SV C)",
    ),
    Key::row(
        "max_emissivity",
        POSITIVE_SHARE,
        Is("0.99"),
        "0.99",
        "The largest emissivity of a pixel, by which pixels are first compared (NEM).",
        "first temperature of a pixel",
    ),
];
/// `[clusters]`.
pub(crate) static CLUSTERS: Table = Table::of("How pixels are grouped.", &[CLUSTERS_KEYS]);

const EMISSIVITY_KEYS: &[Key] = &[
    Key::row("mean", A_SHARE, Is("0.9"), "0.9", "Mean emissivity.", "prior of the emissivities"),
    Key::row(
        "magnitude_error",
        POSITIVE_SHARE,
        Is("0.3"),
        "0.3",
        "Deviation of an emissivity's mean over the bands.",
        "prior of the emissivities",
    ),
    Key::row(
        "shape_error",
        POSITIVE_SHARE,
        Is("0.1"),
        "0.1",
        "Deviation of an emissivity about its mean over the bands.",
        "prior of the emissivities",
    ),
    Key::row(
        "correlation",
        WAVENUMBER,
        Is("\"50 cm^-1\""),
        "\"50 cm^-1\"",
        "Difference of wavenumbers at which the correlation of the shape has fallen to a quarter (Matern 5/2).",
        "prior of the emissivities, s^2 (1 + x + x^2/3) exp(-x), x = 3.55 |dnu|/l",
    ),
];
/// `[emissivity]`.
pub(crate) static EMISSIVITY: Table =
    Table::of("What is known of emissivities beforehand.", &[EMISSIVITY_KEYS]);
