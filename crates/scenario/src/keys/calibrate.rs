//! Tables of a calibration.

use super::cube::{AXES, BAD_BANDS, VARIABLE};
use super::key::Silent::{Is, Means, Refused};
use super::key::{
    A_SHARE, COUNT, KELVIN, KELVIN_APART, KELVIN_FROM_ZERO, Key, POSITIVE, POSITIVE_SHARE, TIME, Table,
    Value, WAVENUMBER, WHOLE,
};
use hadar::allowed::Allowed;

const FINITE: Allowed = Allowed { holds: f64::is_finite, expected: "a finite number" };

const RESPONSE_KEYS: &[Key] = &[
    Key::row(
        "filters",
        Value::File,
        Refused,
        "\"filters.csv\"",
        "Transmittances over wavenumber, a column a filter, in the order of the cubes' bands.",
        "reading of a filter: integral of filter, response and blackbody",
    ),
    Key::row(
        "start",
        WAVENUMBER,
        Is("\"595 cm^-1\""),
        "\"595 cm^-1\"",
        "First wavenumber of the response.",
        "values that are sought",
    ),
    Key::row(
        "stop",
        WAVENUMBER,
        Is("\"1340 cm^-1\""),
        "\"1340 cm^-1\"",
        "Last wavenumber of the response.",
        "values that are sought",
    ),
    Key::row(
        "values",
        Value::Count([2, 200]),
        Is("30"),
        "30",
        "How many values it has.",
        "values that are sought",
    ),
    Key::row(
        "typical",
        Value::File,
        Means("level"),
        "\"typical.csv\"",
        "The typical curve of such detectors, in any unit.",
        "mean of the prior of the response",
    ),
    Key::row(
        "scale_error",
        POSITIVE,
        Is("0.5"),
        "0.5",
        "Deviation of the response's scale beforehand, as a share.",
        "prior of the response",
    ),
    Key::row(
        "shape_error",
        POSITIVE,
        Is("0.15"),
        "0.15",
        "Deviation of the response's shape beforehand, as a share.",
        "prior of the response",
    ),
    Key::row(
        "correlation",
        WAVENUMBER,
        Is("\"100 cm^-1\""),
        "\"100 cm^-1\"",
        "Difference of wavenumbers at which the correlation of the shape has fallen to a quarter (Matern 5/2).",
        "prior of the response, s^2 (1 + x + x^2/3) exp(-x), x = 3.55 |dnu|/l",
    ),
    Key::row(
        "centre_half",
        COUNT,
        Is("10"),
        "10",
        "Rows and columns about the centre, on each side, whose mean is a reading.",
        "readings of the blackbodies",
    ),
];
/// `[response]`.
pub(crate) static RESPONSE: Table = Table::of("The response of a camera that is sought.", &[RESPONSE_KEYS]);

const fn data(example: &'static str) -> Key {
    Key::row(
        "data",
        Value::File,
        Refused,
        example,
        "Samples [row][column][band]; NPY, NPZ, ENVI, MATLAB, HDF5 or NetCDF.",
        "readings",
    )
}
const DATA: Key = data("\"cold.npy\"");
const SCENE_DATA: Key = data("\"scene.npy\"");
const BAD_BANDS_OF_ALL: Key = Key::row(
    "bad_bands",
    Value::List(&WHOLE),
    Is("[]"),
    "[0, 53]",
    "Bands that are left out of all cubes, counted from 0 in the order of this one.",
    "which samples are used",
);
const BLACKBODY_KEYS: &[Key] = &[
    Key::row(
        "temperature",
        KELVIN,
        Refused,
        "\"10 degC\"",
        "Temperature of the blackbody; two must differ.",
        "Planck's law of its light",
    ),
    Key::row(
        "uncertainty",
        KELVIN_FROM_ZERO,
        Means("it is exact, with a warning"),
        "\"0.1 K\"",
        "Standard deviation of that temperature.",
        "error of what was calibrated",
    ),
    Key::row(
        "emissivity",
        POSITIVE_SHARE,
        Means("it is black, with a warning"),
        "0.98",
        "Emissivity of the blackbody, the same in all bands.",
        "L = e B(T) + (1 - e) B(T_s)",
    ),
    Key::row(
        "emissivity_error",
        A_SHARE,
        Is("0.0"),
        "0.005",
        "Standard deviation of that emissivity.",
        "error of what was calibrated, in all bands together",
    ),
    Key::row(
        "surroundings",
        KELVIN,
        Means("it is black; must be there together with an emissivity below 1"),
        "\"22 degC\"",
        "Temperature of what the blackbody reflects.",
        "L = e B(T) + (1 - e) B(T_s)",
    ),
    Key::row(
        "surroundings_uncertainty",
        KELVIN_FROM_ZERO,
        Is("\"0 K\""),
        "\"1 K\"",
        "Standard deviation of that temperature.",
        "error of what was calibrated, in all bands together",
    ),
];
/// `[[blackbody]]`.
pub(crate) static BLACKBODY: Table = Table::of(
    "A blackbody that was read; two or more.",
    &[BLACKBODY_KEYS, &[DATA, VARIABLE, AXES, BAD_BANDS_OF_ALL]],
);

/// `[noise]` beside blackbodies.
pub(crate) static SAMPLE: Table = Table::of(
    "How samples scatter.",
    &[&[Key::row(
        "sample",
        POSITIVE,
        Refused,
        "1.5",
        "Deviation of one sample, in the unit of the cubes (`hadar calibrate noise` finds it).",
        "weights of the readings",
    )]],
);

const REFERENCE_KEYS: &[Key] = &[
    Key::row(
        "reference",
        Value::File,
        Refused,
        "\"reference.npy\"",
        "Cube of a reference blackbody that is taken off.",
        "scene less reference",
    ),
    Key::row(
        "reference_temperature",
        KELVIN,
        Refused,
        "\"20 degC\"",
        "Temperature of the reference.",
        "its light is added again",
    ),
    Key::row(
        "reference_uncertainty",
        KELVIN_FROM_ZERO,
        Is("\"0 K\""),
        "\"0.1 K\"",
        "Standard deviation of that temperature.",
        "error of the radiance",
    ),
];
/// `[scene]` before filters.
pub(crate) static SCENE: Table = Table::of(
    "The cube to be calibrated, and its reference.",
    &[&[SCENE_DATA, VARIABLE, AXES, BAD_BANDS_OF_ALL], REFERENCE_KEYS],
);

const EACH: Key = Key::row(
    "response",
    Value::Choice(&["common", "each-pixel"]),
    Is("\"common\""),
    "\"each-pixel\"",
    "Whether all pixels have one response and offset, or each its own.",
    "response that the counts are divided by",
);
/// `[scene]` before a spectrometer.
pub(crate) static SPECTRAL_SCENE: Table =
    Table::of("The cube to be calibrated.", &[&[SCENE_DATA, VARIABLE, AXES, BAD_BANDS_OF_ALL, EACH]]);

const FRAMES_KEYS: &[Key] = &[
    Key::row(
        "data",
        Value::Either(&[Value::File, Value::List(&Value::File)]),
        Refused,
        "\"counts.npy\"",
        "A cube, or several frames of the same scene; of stripes one.",
        "samples",
    ),
    VARIABLE,
    AXES,
    BAD_BANDS,
];
/// `[cube]` as it was measured.
pub(crate) static FRAMES: Table = Table::of("Cubes as they were measured.", &[FRAMES_KEYS]);

const NOISE_KEYS: &[Key] = &[
    Key::row(
        "dark_level",
        Value::Number(FINITE),
        Is("0.0"),
        "0.0",
        "A sample without light.",
        "variance = noise^2 + gain (sample - dark level)",
    ),
    Key::row(
        "gain_spread",
        Value::Flag,
        Is("false"),
        "true",
        "Whether gains of pixels differ, which one frame shows as noise.",
        "a term with the square of the signal",
    ),
    Key::row(
        "exposure",
        TIME,
        Means("not known"),
        "\"2 ms\"",
        "Exposure of a frame.",
        "camera figures of the answer",
    ),
    Key::row(
        "uniform",
        Value::Flag,
        Is("false"),
        "true",
        "Whether the frames see one brightness everywhere (a blackbody, a shutter): then what stays of pixels, rows and columns is the camera's.",
        "fixed_pattern, row_noise and column_noise of the answer",
    ),
    Key::row(
        "netd",
        KELVIN_APART,
        Means("noise that pixels share is told as shares of the NETD"),
        "\"40 mK\"",
        "NETD of a frame, which the noise of a pixel from frame to frame amounts to.",
        "noise of rows, columns and frames in K",
    ),
];
/// `[noise]` that is sought.
pub(crate) static NOISE: Table = Table::of("What is known of the noise that is sought.", &[NOISE_KEYS]);

const STRIPES_KEYS: &[Key] = &[
    Key::row(
        "axis",
        Value::Choice(&["rows", "columns"]),
        Is("\"rows\""),
        "\"columns\"",
        "Along what the stripes lie.",
        "gain of each line",
    ),
    Key::row(
        "gain_deviation",
        POSITIVE,
        Is("0.1"),
        "0.1",
        "Deviation of the gains beforehand, as a share.",
        "prior of the gains",
    ),
    Key::row(
        "in_all_bands",
        Value::Flag,
        Is("false"),
        "true",
        "Whether a line has one gain in all bands.",
        "gain of each line",
    ),
];
/// `[stripes]`.
pub(crate) static STRIPES: Table = Table::of("How stripes lie.", &[STRIPES_KEYS]);
