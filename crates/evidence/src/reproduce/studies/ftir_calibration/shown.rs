//! All that is shown of the spectrometer's calibration.

use super::choice::{EmissivityError, RadianceError};
use crate::reproduce::coverage::SpectrometerCoverage;
use hadar::error::Result;

/// Deviation of the temperature of each blackbody and of the surface, K.
pub(super) const TEMPERATURE_ERROR_K: f64 = 0.03;
/// Readings that all the time is worth.
pub(super) const READINGS: f64 = 64.0;
/// The surface: emissivity, its change, where it is wanted, and the temperature of its surroundings.
pub(super) const EMISSIVITY: f64 = 0.9;
pub(super) const SLOPE_PER_K: f64 = 1e-4;
pub(super) const WANTED_K: f64 = 310.0;
pub(super) const SURROUNDINGS_K: f64 = 295.0;

/// Blackbodies, their deviations, and what their experiments held.
pub(super) struct Held {
    pub(super) blackbodies_k: &'static [f64],
    pub(super) errors_k: &'static [f64],
    pub(super) coverage: SpectrometerCoverage,
}

/// The best settings of a number.
pub(super) struct Best {
    pub(super) within_k: [f64; 2],
    pub(super) temperatures_k: Vec<f64>,
    pub(super) error: RadianceError,
}

/// Errors over two temperatures; none where they are the same.
pub(super) struct Plane<T> {
    pub(super) axis_k: Vec<f64>,
    pub(super) errors: Vec<Option<T>>,
}

impl<T: Copy> Plane<T> {
    pub(super) fn over(axis_k: Vec<f64>, of: impl Fn(f64, f64) -> Result<T>) -> Result<Self> {
        let mut errors = Vec::new();
        for y in &axis_k {
            for x in &axis_k {
                errors.push(if x < y { Some(of(*x, *y)?) } else { None });
            }
        }
        Ok(Self { axis_k, errors })
    }

    /// The least by `size` whose lower temperature is at least `from_k`: both temperatures, and the error.
    pub(super) fn least(&self, from_k: f64, size: impl Fn(T) -> f64) -> Option<(f64, f64, T)> {
        let n = self.axis_k.len();
        let all = self.errors.iter().enumerate();
        let found = all.filter_map(|(i, error)| error.map(|e| (self.axis_k[i % n], self.axis_k[i / n], e)));
        found.filter(|one| one.0 >= from_k).min_by(|a, b| size(a.2).total_cmp(&size(b.2)))
    }
}

pub(super) struct Shown {
    pub(super) experiments: usize,
    pub(super) held: Vec<Held>,
    pub(super) pairs: Plane<RadianceError>,
    pub(super) best: Vec<Best>,
    pub(super) surface: Plane<EmissivityError>,
    /// Distance of two temperatures about the wanted one, and errors.
    pub(super) spacing: Vec<(f64, EmissivityError)>,
}
