//! What is found, and how much was asked for.

use hadar_study::air_ranging::{AirPoint, AirRanging, AirWitness};

/// Spectra at each distance.
pub(super) const TRIALS: usize = 200;
/// Bands that are chosen.
pub(super) const BANDS: usize = 4;

/// All that is found.
pub(super) struct Found {
    pub(super) main: AirRanging,
    /// Least error over the contrast, K.
    pub(super) contrasts: Vec<(f64, AirPoint)>,
    /// Least error over the deviation of the emissivity.
    pub(super) errors: Vec<(f64, AirPoint)>,
    /// Air and stereo over long distances, a curve for each texture.
    pub(super) stereo: Vec<(f64, AirRanging)>,
    /// Estimates of 100 m over the noise of a band, µflick.
    pub(super) noises: Vec<(f64, AirWitness)>,
    pub(super) seed: u64,
}
