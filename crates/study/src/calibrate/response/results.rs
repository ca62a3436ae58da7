//! A calibrated camera behind a filter wheel as data: values of its response, filters left out, radiances of a scene.

use crate::Warning;
use hadar::cube::Shape;
use hadar::demand::Work;
use hadar_estimate::calibrate::vignette::Vignette;
use hadar_scenario::calibrate::ResponseScenario;
use serde::Serialize;

/// A value of the response, counts per photon s⁻¹ m⁻² sr⁻¹.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ResponseRow {
    /// Wavenumber of the value, cm⁻¹.
    pub wavenumber_cm1: f64,
    /// Response R at this wavenumber, counts per photon s⁻¹ m⁻² sr⁻¹.
    pub response: f64,
    /// Standard deviation of the response, in its unit.
    pub sigma: f64,
    /// Standard deviation of the same estimate if the response has kinks: exponential correlation, of the same length.
    pub sigma_kinked: f64,
    /// Standard deviation of the response before any reading, in its unit.
    pub sigma_beforehand: f64,
    /// The typical curve, scaled to the readings.
    pub typical: f64,
    /// The deviation by the readings alone; none where they do not tell it.
    pub sigma_readings_alone: Option<f64>,
}

/// A filter that is left out.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct LeftOutFilter {
    /// Name of the filter that is left out.
    pub filter: String,
    /// Its band of the cubes, from 0.
    pub band: usize,
    /// `named`, `missing`, `stuck` or `saturated`.
    pub why: &'static str,
}

/// Radiances of a scene behind the filters, photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹.
#[derive(Debug, Clone, Serialize)]
pub struct FilterRadiances {
    /// Numbers of rows, columns and filters of the scene.
    pub shape: Shape,
    /// Mean radiance of every sample over its filter and the response.
    #[serde(skip)]
    pub radiance: Vec<f32>,
    /// Deviation of a sample for itself at the centre, of every filter, with that of its pixel's η at the rms of the scene's contrast; noise
    /// is that over η elsewhere.
    pub sigma_noise: Vec<f64>,
    /// Deviation common to all pixels at the mean radiance, of every filter: by the response, by the centre's η, by the reference's temperature.
    pub sigma_common: Vec<f64>,
    /// The same if the response has kinks: exponential correlation, of the same length.
    pub sigma_common_kinked: Vec<f64>,
}

/// What was found.
#[derive(Debug, Clone, Serialize)]
pub struct ResponseFound {
    /// The question as it was asked, defaults filled in.
    pub scenario: ResponseScenario,
    /// Names of the filters; those left out are not among them.
    pub filters: Vec<String>,
    /// Filters that are left out of all cubes, with why.
    pub left_out: Vec<LeftOutFilter>,
    /// The response that was found, by wavenumber.
    pub response: Vec<ResponseRow>,
    /// Covariance of its values, row after row.
    #[serde(skip)]
    pub covariance: Vec<f64>,
    /// Resolving kernels, row after row.
    #[serde(skip)]
    pub kernels: Vec<f64>,
    /// Directions known to a tenth of the peak by the readings alone.
    pub determined: usize,
    /// Number of singular values of the problem above rounding.
    pub rank: usize,
    /// Effective number of values that the readings determine with smoothness.
    pub effective: f64,
    /// Deviation of every direction, peak of the typical curve 1; none where nothing tells it.
    pub sigma_directions: Vec<Option<f64>>,
    /// Offsets K_q + ξ at the centre, counts.
    pub offsets: Vec<f64>,
    /// Standard deviations of the offsets, counts.
    pub offset_sigmas: Vec<f64>,
    /// χ² of the readings over its degrees of freedom; none where the unknowns fit any readings.
    pub chi_square_reduced: Option<f64>,
    /// Those, n − tr H: the readings less what the unknowns take of them.
    pub freedom: f64,
    /// Whether the readings lie off the response beyond chance, so that errors do not hold.
    pub misfit: bool,
    /// Rows and columns of the cubes.
    pub size: [usize; 2],
    /// Relative transmittance η of every pixel; none where the cubes are all centre.
    #[serde(skip)]
    pub eta: Option<Vignette>,
    /// Least and largest relative transmittance η of the pixels.
    pub eta_range: Option<[f64; 2]>,
    /// Deviation of η in a pixel.
    pub eta_sigma: Option<f64>,
    /// The calibrated scene; none where no scene was given.
    pub scene: Option<FilterRadiances>,
    /// What was done and what was spared.
    pub stats: Work,
    /// What the reader must know.
    pub warnings: Vec<Warning>,
}
