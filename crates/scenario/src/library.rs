//! What a library is to be made from: a heat cube, the spectra of its surroundings, how many groups, what is known of emissivities.
//!
//! `[cube]`, `[bands]`, `[camera]`, `[[environment]]`, `[unknown]` and `[truth]` are those of a [`super::DecomposeScenario`]; in the
//! place of `[library]` stands `[clusters]`, with `[emissivity]` beside it.

mod read;
mod write;

use super::decompose::{AirOfCube, HeatCube, LightSource, PixelUnknown, TruthSpec};
use super::{BandsSpec, CameraSpec, Source};
use hadar::fisher::emissivity::Smoothness;

/// Everything that the file says.
///
/// ```
/// use hadar_scenario::LibraryScenario;
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
///     [clusters]
///     count = [2, 8]
/// "#;
/// let scenario = LibraryScenario::from_toml(text, None)?;
/// assert_eq!(scenario.clusters.count, [2, 8]);
/// let error = LibraryScenario::from_toml(&text.replace("[2, 8]", "0"), None).unwrap_err();
/// assert!(error.to_string().starts_with("line 12: clusters.count: "));
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct LibraryScenario {
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
    /// How pixels are grouped (`[clusters]`).
    pub clusters: ClustersSpec,
    /// What is known of the emissivities beforehand (`[emissivity]`).
    pub emissivity: Smoothness,
    /// What is unknown of every pixel (`[unknown]`).
    pub unknown: PixelUnknown,
    /// What is there, where that is known (`[truth]`); indices of materials are those of a library of its own.
    pub truth: Option<TruthSpec>,
    /// Where it was read from.
    pub source: Source,
}

/// How pixels are grouped (`[clusters]`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClustersSpec {
    /// The fewest and the most groups; the count is known where they are the same.
    pub count: [usize; 2],
    /// The largest emissivity of NEM, by which pixels are first compared.
    pub max_emissivity: f64,
}

/// What is known where nothing is said: any magnitude, and shapes as those of most solids in the long-wave infrared.
pub const EMISSIVITY: Smoothness =
    Smoothness { mean: 0.9, magnitude: 0.3, shape: 0.1, correlation_cm1: 50.0 };
