//! The quantities that can be solved for, and a camera in its place with one of them changed.

use crate::instrument::Camera;

crate::base::named::named! {
    /// A quantity that can be solved for.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub enum Quantity {
        /// Exposure of a frame, s.
        Exposure = "exposure_s",
        /// Side of the pixel, m.
        Pixel = "pixel_m",
        /// f-number.
        FNumber = "f_number",
        /// Electronic noise of a band reading in one frame, counts at the camera's exposure.
        Noise = "noise_counts",
        /// Number of averaged frames.
        Frames = "frames",
        /// Largest distance of the target, m.
        Distance = "distance_m",
        /// Largest speed at which the exposure that the task takes still moves the target by less than a pixel, m s⁻¹.
        Speed = "speed_m_s",
    }
    /// Key in the JSON, with its unit.
    key
}

impl Quantity {
    /// Those that the camera alone has.
    pub const OF_CAMERA: [Self; 5] = [Self::Exposure, Self::Pixel, Self::FNumber, Self::Noise, Self::Frames];

    /// Name in a sentence.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Exposure => "exposure",
            Self::Pixel => "pixel",
            Self::FNumber => "f-number",
            Self::Noise => "noise per reading",
            Self::Frames => "frames",
            Self::Distance => "distance",
            Self::Speed => "speed",
        }
    }

    /// Whether the value that just meets a task is the least that does, not the largest.
    #[must_use]
    pub const fn is_least(self) -> bool {
        matches!(self, Self::Exposure | Self::Pixel | Self::Frames)
    }
}

impl serde::Serialize for Quantity {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.key())
    }
}

/// A camera and how far its target is.
#[derive(Debug, Clone, PartialEq)]
pub struct Trial {
    /// The camera.
    pub camera: Camera,
    /// Distance of the target, m; infinitely far where `None`.
    pub distance_m: Option<f64>,
}
