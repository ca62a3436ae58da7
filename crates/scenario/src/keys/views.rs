//! Tables of two views: `[stereo]`, their cubes, and the depth that is demanded.

use super::key::Silent::{Is, Means, Refused};
use super::key::{COUNT, Key, LENGTH, POSITIVE, POSITIVE_SHARE, Table, Value};
use hadar::allowed::{ABOVE_ZERO, Allowed, FROM_ZERO};
use hadar::units::Dimension;

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
        Means("must be there together with diffraction = \"gaussian\""),
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
        "noise of a sample in addition to its shot noise (S14 to S16)",
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
