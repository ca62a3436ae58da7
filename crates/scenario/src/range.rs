//! A ranging scenario: a scene or a heat cube, the stereo camera, the depth that is demanded.
//!
//! It shares `[bands]` and `[camera]` with a [`super::Scenario`], and their habits: quantities are strings with their unit, every value
//! is checked when it is read, an error names file, line and key.

pub(super) mod read;
pub(super) mod write;

use super::decompose::Bad;
use super::{BandsSpec, CameraSpec, SceneSpec, Source};
pub use hadar::ranging::depth::Demand;
use hadar::ranging::derivative::Derivative;
use hadar::ranging::information::Window;
use hadar::ranging::noise::Joined;
use hadar_formats::cube::Axes;
use std::path::PathBuf;

/// Everything a ranging scenario says, defaults filled in.
///
/// ```
/// use hadar_scenario::RangeScenario;
/// let text = r#"
///     [scene]
///     person_temperature = "37 degC"
///     [camera]
///     preset = "flir-a325sc"
///     [stereo]
///     baseline = "0.2 m"
/// "#;
/// let scenario = RangeScenario::from_toml(text, None)?;
/// assert_eq!(scenario.stereo.window.rows(), 5);
/// let error = RangeScenario::from_toml(&text.replace("0.2 m", "0 m"), None).unwrap_err();
/// assert!(error.to_string().starts_with("line 7: stereo.baseline: `0 m` is out of range"));
/// # Ok::<(), hadar::Error>(())
/// ```
/// ```
/// use hadar_scenario::RangeScenario;
/// let text = "[cube]\nleft = \"left.npy\"\n[stereo]\nbaseline = \"0.2 m\"\nfocal_length = \"14 mm\"\npixel = \"12 um\"\n";
/// let scenario = RangeScenario::from_toml(text, None)?;
/// let again = RangeScenario::from_toml(&scenario.to_toml(), None)?;
/// assert_eq!((&again.subject, &again.stereo), (&scenario.subject, &scenario.stereo));
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct RangeScenario {
    /// What it is about, for headings.
    pub title: Option<String>,
    /// What is looked at.
    pub subject: Subject,
    /// The spectral bands; of a cube they are not needed.
    pub bands: Option<BandsSpec>,
    /// The camera; of a cube it is not needed.
    pub camera: Option<CameraSpec>,
    /// The pair of cameras, and how windows are looked at.
    pub stereo: Stereo,
    /// What is demanded.
    pub requirement: DepthRequirement,
    /// Where it was read from.
    pub source: Source,
}

/// What is looked at.
#[derive(Debug, Clone, PartialEq)]
pub enum Subject {
    /// A scene that is rendered (`[scene]`).
    Scene(Box<SceneSpec>),
    /// Counts that were measured or computed elsewhere (`[cube]`).
    Cube(CubeSpec),
}

/// A cube in a file (`[cube]`). Paths are absolute.
#[derive(Debug, Clone, PartialEq)]
pub struct CubeSpec {
    /// The left view.
    pub left: PathBuf,
    /// The right view; without it the right one is taken to carry as much information as the left.
    pub right: Option<PathBuf>,
    /// Name of the array in a file of several.
    pub variable: Option<String>,
    /// Which dimension of both views is which.
    pub axes: Option<Axes>,
    /// Photons that one unit of the file stands for; 1 if silent, of a file that does not say otherwise.
    pub photons_per_unit: Option<f64>,
    /// Variance of the electronic noise; the camera's if silent.
    pub noise: Option<NoiseSource>,
    /// What is done with pixels that are found to be bad.
    pub bad: Bad,
    /// Depth; windows have bounds on their disparity alone if silent.
    pub depth: Option<DepthSource>,
}

/// Where the noise variance of a cube is from.
#[derive(Debug, Clone, PartialEq)]
pub enum NoiseSource {
    /// The same for all samples, counts².
    Uniform(f64),
    /// A table by band, or a cube by sample.
    File(PathBuf),
}

/// Where the depth of a cube's pixels is from.
#[derive(Debug, Clone, PartialEq)]
pub enum DepthSource {
    /// The same for all, m.
    Uniform(f64),
    /// An image of depths in m.
    File(PathBuf),
}

/// The pair of cameras and how windows are looked at (`[stereo]`).
#[derive(Debug, Clone, PartialEq)]
pub struct Stereo {
    /// Distance of the two cameras, m.
    pub baseline_m: f64,
    /// Focal length, m; the camera's if silent.
    pub focal_length_m: Option<f64>,
    /// Distance of the pixels, m; the camera's if silent.
    pub pixel_m: Option<f64>,
    /// The window.
    pub window: Window,
    /// How the derivative along x is taken.
    pub derivative: Derivative,
    /// Electronic noise of joined samples.
    pub joined: Joined,
    /// Rows along which the bound is drawn and witnessed.
    pub lines: Vec<usize>,
    /// Diffraction.
    pub diffraction: Diffraction,
}

/// What diffraction adds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Diffraction {
    /// Nothing: the image is blurred already.
    None,
    /// The Airy pattern of the camera's aperture.
    Airy,
    /// A Gaussian of this deviation on the detector, m.
    Gaussian(f64),
}

/// The depth that is demanded (`[requirement]`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DepthRequirement {
    /// How well depth must be known.
    pub error: Demand,
    /// Share of the windows that must reach it, in (0, 1].
    pub share: f64,
}
