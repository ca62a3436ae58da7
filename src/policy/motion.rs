//! How far the picture of a target moves while it is taken.
//!
//! Δ = v_⊥ t L/(r θ) pixels (SII E): v_⊥ = v sin(θ/2) the largest transverse part of the speed v (m s⁻¹) that keeps the
//! target in the field of view θ (rad), t the time until all bands are exposed (s), L pixels across θ, r the distance (m).
//!
//! Assumptions: small angles; a target that crosses the edge of the view, which is the worst place for a camera that
//! looks ahead. Averaged frames are laid over each other before they are summed, so that each counts by itself.

use super::motion_blur_pixels;
use crate::instrument::Camera;

/// What the blur of a moving target depends on beside speed and time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion {
    pixels: u32,
    field_of_view_rad: f64,
    distance_m: f64,
}

impl Motion {
    /// Of a camera whose target is at `distance_m`; `None` where something is not known ([`Motion::missing`]).
    #[must_use]
    pub fn of(camera: &Camera, distance_m: Option<f64>) -> Option<Self> {
        let (pixels, field_of_view_rad) = (camera.pixels?, camera.field_of_view_rad?);
        Some(Self { pixels, field_of_view_rad, distance_m: distance_m? })
    }

    /// Keys of a scenario that would have to be there.
    #[must_use]
    pub fn missing(camera: &Camera, distance_m: Option<f64>) -> Vec<&'static str> {
        let keys = [
            ("camera.pixels", camera.pixels.is_none()),
            ("camera.field_of_view", camera.field_of_view_rad.is_none()),
            ("target.distance", distance_m.is_none()),
        ];
        keys.into_iter().filter(|(_, missing)| *missing).map(|(key, _)| key).collect()
    }

    /// Pixels that the target moves in `time_s`, the vehicle at `speed_m_s`.
    #[must_use]
    pub fn blur_pixels(&self, speed_m_s: f64, time_s: f64) -> f64 {
        let transverse = speed_m_s * (0.5 * self.field_of_view_rad).sin();
        motion_blur_pixels(transverse, time_s, self.pixels, self.distance_m, self.field_of_view_rad)
    }

    /// Speed at which the target moves by one pixel in `time_s`, m s⁻¹.
    #[must_use]
    pub fn fastest_m_s(&self, time_s: f64) -> f64 {
        self.blur_pixels(1.0, time_s).recip()
    }

    /// Time in which the target moves by one pixel, the vehicle at `speed_m_s`, s.
    #[must_use]
    pub fn longest_s(&self, speed_m_s: f64) -> f64 {
        self.blur_pixels(speed_m_s, 1.0).recip()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::instrument::presets;

    /// The paper's case by its own numbers: 320 pixels across 50 degrees, 30 mph at 30 m, 12 ms: 0.83 pixels.
    #[test]
    fn thirty_miles_per_hour_at_thirty_metres() {
        let motion = Motion { pixels: 320, field_of_view_rad: 50f64.to_radians(), distance_m: 30.0 };
        assert!((motion.blur_pixels(13.4112, 12e-3) / 0.831 - 1.0).abs() < 1e-3);
        // One pixel after 12 ms/0.831.
        assert!((motion.longest_s(13.4112) / 14.44e-3 - 1.0).abs() < 1e-3);
        assert!((motion.blur_pixels(motion.fastest_m_s(5e-3), 5e-3) - 1.0).abs() < 1e-14);
    }

    #[test]
    fn what_is_missing_is_named() {
        let mut camera = presets::get("flir-a325sc").unwrap();
        camera.pixels = None;
        assert_eq!(Motion::of(&camera, None), None);
        assert_eq!(Motion::missing(&camera, None), ["camera.pixels", "target.distance"]);
    }
}
