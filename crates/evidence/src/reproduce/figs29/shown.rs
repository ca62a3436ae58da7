//! All that is shown of the response's calibration.

use super::designs::Choice;
use crate::reproduce::coverage::FilterWheelCoverage;
use hadar::calibration::determined::Determined;
use hadar_estimate::calibrate::response::Response;
use hadar_estimate::calibrate::twin::FilterWheelTwin;

/// Pixels about the centre that a reading is the mean of.
pub(super) const PIXELS: f64 = 400.0;
/// Deviation of a blackbody's temperature from what it is set to, K.
pub(super) const TEMPERATURE_ERROR_K: f64 = 0.02;

/// All that is shown.
pub(super) struct Shown {
    pub(super) twin: FilterWheelTwin,
    /// One drawn calibration.
    pub(super) found: Response,
    /// At exact temperatures, and at uncertain ones.
    pub(super) exact: Determined,
    pub(super) uncertain: Determined,
    /// (K − 1)(r − m).
    pub(super) bias: Vec<f64>,
    /// σ of a reading; number at exact and at uncertain temperatures; effective numbers.
    pub(super) over_noise: Vec<[f64; 5]>,
    pub(super) choices: Vec<Choice>,
    pub(super) coverage: FilterWheelCoverage,
    pub(super) experiments: usize,
}
