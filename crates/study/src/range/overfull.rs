//! A pixel that holds more photons than its well.

use crate::Warning;
use hadar::instrument::Camera;

/// The brightest band of the brightest pixel of a picture, beyond the full well of its camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Overfull {
    /// Photons of one reading.
    pub(crate) counts: f64,
    /// Photons that the well holds.
    pub(crate) full_well: f64,
}

impl Overfull {
    /// That of a reading of so many photons; `None` where they fit, or where the camera's well is not stated.
    pub(crate) fn of(counts: f64, camera: &Camera) -> Option<Self> {
        camera.full_well.filter(|full_well| counts > *full_well).map(|full_well| Self { counts, full_well })
    }

    pub(crate) fn remark(self) -> Warning {
        Warning::PixelFull { counts: self.counts, full_well: self.full_well }
    }
}
