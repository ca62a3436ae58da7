//! A decomposition scenario: a heat cube, the spectra of its surroundings, a library, what is unknown, and the truth if there is one.
//!
//! It shares `[bands]` and `[camera]` with a [`super::Scenario`], and their habits: quantities are strings with their unit, every value
//! is checked when it is read, an error names file, line and key.

pub(super) mod category;
mod image;
pub(crate) mod read;
pub(super) mod write;

pub use category::{CategorySpec, SegmentationSpec};
use hadar::radiance_unit::RadianceUnit;

use super::{AtmosphereSpec, BandsSpec, CameraSpec, ClassSpec, MaterialRef, Source};
use hadar_estimate::decompose::SpatialPrior;
use hadar_formats::cube::{Axes, TemperatureUnit};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Everything a decomposition scenario says.
///
/// ```
/// use hadar_scenario::DecomposeScenario;
/// let text = r#"
///     [cube]
///     data = "counts.npy"
///     counts_per_photon_radiance = 2e-14
///     [bands]
///     start = "720 cm^-1"
///     stop = "1250 cm^-1"
///     step = "10 cm^-1"
///     [[environment]]
///     temperature = "-10 degC"
///     [library]
///     materials = ["skin", "aluminium"]
/// "#;
/// let scenario = DecomposeScenario::from_toml(text, None)?;
/// assert_eq!(scenario.unknown.temperature_k, [200.0, 400.0]);
/// let error = DecomposeScenario::from_toml(&text.replace("2e-14", "-1"), None).unwrap_err();
/// assert!(error.to_string().starts_with("line 4: cube.counts_per_photon_radiance: "));
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct DecomposeScenario {
    /// What it is about, for headings.
    pub title: Option<String>,
    /// The counts (`[cube]`).
    pub cube: HeatCube,
    /// The bands of the cube; those that its file says if silent.
    pub bands: Option<BandsSpec>,
    /// The camera, where it says what the counts are.
    pub camera: Option<CameraSpec>,
    /// The air before the camera (`[atmosphere]`); none if silent.
    pub atmosphere: Option<AirOfCube>,
    /// Spectra of the surroundings (`[[environment]]`).
    pub environment: Vec<LightSource>,
    /// Kinds of surfaces of several spectra each, by name (`[class.NAME]`).
    pub classes: BTreeMap<String, ClassSpec>,
    /// The materials that a pixel may be (`[library]`).
    pub library: LibrarySpec,
    /// What is unknown (`[unknown]`).
    pub unknown: PixelUnknown,
    /// What neighbours tell about a pixel (`[spatial]`); each is for itself if silent.
    pub spatial: Option<SpatialPrior>,
    /// How the picture is coloured (`[vision]`).
    pub vision: VisionSpec,
    /// What materials are parts of (`[[category]]`); nothing is segmented without.
    pub categories: Vec<CategorySpec>,
    /// How pixels get a category (`[segmentation]`).
    pub segmentation: SegmentationSpec,
    /// What is there, where that is known (`[truth]`).
    pub truth: Option<TruthSpec>,
    /// Where it was read from.
    pub source: Source,
}

/// A heat cube in a file (`[cube]`). Paths are absolute.
#[derive(Debug, Clone, PartialEq)]
pub struct HeatCube {
    /// Samples `[row][column][band]`.
    pub data: PathBuf,
    /// Name of the array in a file of several.
    pub variable: Option<String>,
    /// Which of its dimensions is which.
    pub axes: Option<Axes>,
    /// What a sample is.
    pub unit: CubeUnit,
    /// Deviation of the electronic noise of a sample, of radiances that of all noise, in the unit of the cube.
    pub noise: Option<CubeNoise>,
    /// Bands that are left out, counted from 0 in the order of the cube.
    pub bad_bands: Vec<usize>,
    /// A map of pixels that are left out: all that are not 0.
    pub bad_pixels: Option<PathBuf>,
    /// What is done with bands and pixels that are found to be bad.
    pub bad: Bad,
}

/// What is done with bands and pixels that are found to be bad (`cube.bad`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Bad {
    /// They are left out.
    #[default]
    LeaveOut,
    /// They are taken like all others; those that are named are left out.
    Keep,
}

/// What is said of the noise of a cube, in its unit.
#[derive(Debug, Clone, PartialEq)]
pub enum CubeNoise {
    /// One deviation for all bands.
    Uniform(f64),
    /// A table with a row for each band.
    File(PathBuf),
}

/// What the samples of a cube are.
#[derive(Debug, Clone, PartialEq)]
pub enum CubeUnit {
    /// Counts, so many for each photon s⁻¹ m⁻² sr⁻¹ per cm⁻¹ of a band's mean radiance.
    CountsPerPhotonRadiance(f64),
    /// Counts of the scenario's camera.
    Camera,
    /// Temperatures of blackbodies of the same radiance, with a noise that is stated in the same unit, of a blackbody at 300 K (NETD).
    BrightnessTemperature {
        /// The unit.
        unit: TemperatureUnit,
        /// As it is written.
        written: String,
    },
    /// Radiance, with a noise that is stated in the same unit.
    Radiance {
        /// The unit.
        unit: RadianceUnit,
        /// As it is written.
        written: String,
    },
}

/// Where the spectrum of one of the surroundings is from.
#[derive(Debug, Clone, PartialEq)]
pub enum LightSource {
    /// A column of a table of radiances, photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹ where its header has no unit.
    Spectrum {
        /// The table.
        path: PathBuf,
        /// Its column.
        column: String,
    },
    /// A surface at a temperature, a blackbody without a material.
    Surface {
        /// Its material.
        material: Option<MaterialRef>,
        /// Its temperature, K.
        temperature_k: f64,
    },
    /// The mean of rows of the cube itself, from the first up to the second.
    Rows([usize; 2]),
    /// Pixels of the cube that are like it.
    Found {
        /// What they are like.
        like: LightLike,
        /// Rows in which they are looked for, from the first up to the second; all if silent.
        rows: Option<[usize; 2]>,
    },
}

/// What pixels are like whose spectrum is taken for one of the surroundings (`environment.found`).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LightLike {
    /// The sky: the darkest ones.
    Sky,
    /// The ground: warm ones that send nearly what a blackbody does.
    Ground,
}

/// The materials that a pixel may be (`[library]`).
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LibrarySpec {
    /// A table of one column a material.
    pub path: Option<PathBuf>,
    /// Materials by name, of the table or of the program's library; all if silent.
    pub materials: Option<Vec<MaterialRef>>,
    /// Prior probability of each of them, in any scale; equal if silent.
    pub prior: Option<Vec<f64>>,
    /// Prior probability that a surface is none of them; taken for impossible if silent.
    pub none_of_these: Option<f64>,
    /// Prior probability that a pixel holds two surfaces of them; taken for impossible if silent.
    pub mixed: Option<f64>,
    /// Root mean square error of the emissivities.
    pub emissivity_error: Option<f64>,
    /// Length over which these errors are correlated, cm⁻¹.
    pub emissivity_correlation_cm1: Option<f64>,
}

/// The air between what a cube shows and its camera (`[atmosphere]`), the same for all pixels.
#[derive(Debug, Clone, PartialEq)]
pub struct AirOfCube {
    /// Which air.
    pub air: AtmosphereSpec,
    /// Length of the path, m.
    pub distance_m: f64,
}

/// What has one value for the whole cube and is known up to a standard deviation (`[unknown]`); exact where silent.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SharedUnknown {
    /// Of the scale of the counts, as a share.
    pub gain: Option<f64>,
    /// Of the wavenumbers of all bands, cm⁻¹.
    pub wavelength_shift_cm1: Option<f64>,
    /// Of the strength of the sky, as a share.
    pub sky_scale: Option<f64>,
    /// Of its spectrum, rms over the bands, as a share.
    pub sky_shape: Option<f64>,
    /// Of the length of the path through the air that the sky's light comes by, as a share.
    pub sky_path: Option<f64>,
    /// Of the temperature of each of the surroundings that is a surface, K.
    pub light_temperature_k: Option<f64>,
    /// Of the lighting factor of a light besides those that are told.
    pub missing_light: Option<f64>,
    /// Of the length of the path through the air, m.
    pub air_m: Option<f64>,
    /// Of the factor of all noise.
    pub noise_scale: Option<f64>,
}

/// What is unknown of every pixel, besides its material and lighting (`[unknown]`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PixelUnknown {
    /// Temperatures that a pixel may have, K, the lower first.
    pub temperature_k: [f64; 2],
    /// The known sum of the lighting factors; at most 1 if silent.
    pub lighting_total: Option<f64>,
    /// Whether the scale of the counts is unknown, another one for each pixel.
    pub gain: bool,
    /// What the whole cube shares.
    pub shared: SharedUnknown,
}

/// How the picture of material, temperature and texture is coloured (`[vision]`).
#[derive(Debug, Clone, PartialEq, Default)]
pub struct VisionSpec {
    /// Hues of materials by name, degrees.
    pub hues_deg: BTreeMap<String, f64>,
    /// Temperatures of the palest and the fullest colour, K.
    pub temperature_k: Option<[f64; 2]>,
    /// Which of the surroundings is the sky, counted from 0; its texture is distilled then.
    pub sky: Option<usize>,
    /// What is bright.
    pub brightness: Brightness,
}

/// What is bright in the picture (`vision.brightness`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Brightness {
    /// All light that a surface sees.
    #[default]
    Texture,
    /// That of the sky.
    Distilled,
}

/// Maps of what is there (`[truth]`).
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TruthSpec {
    /// Place in the library of each pixel's material.
    pub material: Option<PathBuf>,
    /// What its numbers stand for, as the HADAR database has it: the place, from 1, in this list of places in the library, from 1.
    pub material_list: Option<PathBuf>,
    /// Temperature, K or degC.
    pub temperature: Option<PathBuf>,
    /// Whether it is in degC.
    pub celsius: bool,
    /// Lighting factors `[row][column][surroundings]`, or a map for each of the first surroundings.
    pub lighting: Vec<PathBuf>,
    /// A number for each pixel's category.
    pub category: Option<PathBuf>,
}
