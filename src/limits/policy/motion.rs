//! How far the picture of a target moves while it is taken.
//!
//! Δ = v_⊥ t L/(r θ) pixels (SII E): v_⊥ = v sin(θ/2) the largest transverse part of the speed v (m s⁻¹) that keeps the
//! target in the field of view θ (rad), t the time until all bands are exposed (s), L pixels across θ, r the distance (m).
//!
//! Assumptions: small angles; a target that crosses the edge of the view, which is the worst place for a camera that
//! looks ahead. Where the view is not known, a pixel sees its side over the focal length, and the whole speed counts as
//! transverse, which is the worst. Averaged frames are laid over each other before they are summed, so that each counts by itself.

use crate::instrument::Camera;
use std::f64::consts::PI;

/// What the blur of a moving target depends on beside speed and time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion {
    /// θ/L.
    pixel_rad: f64,
    /// sin(θ/2).
    transverse: f64,
    distance_m: f64,
}

impl Motion {
    /// Of a camera whose target is at `distance_m`; `None` where that is not known.
    #[must_use]
    pub fn of(camera: &Camera, distance_m: Option<f64>) -> Option<Self> {
        let by_lens = camera.pixel_m / camera.focal_length_m;
        let by_view = camera.view_and_pixels().map_or(by_lens, |(view_rad, pixels)| view_rad / pixels);
        Self::by(camera, by_view, distance_m)
    }

    /// The same, a pixel seeing `pixel_rad`: where the figures of a camera contradict each other, one of its
    /// [`pixel_angles_rad`](Camera::pixel_angles_rad). The number of pixels is believed, so that the view goes with the angle: the finer
    /// one blurs over more pixels, the coarser one over a wider angle.
    #[must_use]
    pub fn by(camera: &Camera, pixel_rad: f64, distance_m: Option<f64>) -> Option<Self> {
        let distance_m = distance_m?;
        let transverse =
            camera.view_and_pixels().map_or(1.0, |(_, pixels)| (0.5 * (pixel_rad * pixels).min(PI)).sin());
        Some(Self { pixel_rad, transverse, distance_m })
    }

    /// Pixels that the target moves in `time_s`, the vehicle at `speed_m_s`.
    #[must_use]
    pub fn blur_pixels(&self, speed_m_s: f64, time_s: f64) -> f64 {
        speed_m_s * self.transverse * time_s / (self.distance_m * self.pixel_rad)
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
        let camera = presets::get("flir-a325sc").unwrap();
        let motion = Motion::of(&camera, Some(30.0)).unwrap();
        assert!((motion.blur_pixels(13.4112, 12e-3) / 0.831 - 1.0).abs() < 1e-3);
        // One pixel after 12 ms/0.831.
        assert!((motion.longest_s(13.4112) / 14.44e-3 - 1.0).abs() < 1e-3);
        assert!((motion.blur_pixels(motion.fastest_m_s(5e-3), 5e-3) - 1.0).abs() < 1e-14);
    }

    /// By its lens the camera sees 320 times 2/3 mrad; the finer angle moves over more pixels, the coarser over more of the scene.
    #[test]
    fn figures_that_contradict_each_other_make_two_motions() {
        let camera = presets::get("flir-a325sc").unwrap();
        let [fine, coarse] = camera.pixel_angles_rad();
        assert!(camera.contradicts_its_view());
        assert!((fine * 1500.0 - 1.0).abs() < 1e-12);
        assert_eq!(Motion::by(&camera, coarse, Some(30.0)), Motion::of(&camera, Some(30.0)));
        let pixels = |angle: f64| Motion::by(&camera, angle, Some(30.0)).unwrap().blur_pixels(13.4112, 12e-3);
        let by_hand = 13.4112 * (0.5 * 320.0 / 1500.0_f64).sin() * 12e-3 / (30.0 / 1500.0);
        assert!((pixels(fine) / by_hand - 1.0).abs() < 1e-12 && pixels(fine) > pixels(coarse));
        assert!(pixels(fine) * fine < pixels(coarse) * coarse);
        // What both say alike is one.
        let lens = Camera { pixel_m: 18e-3 * coarse, ..camera };
        assert!(!lens.contradicts_its_view());
    }

    /// 12 µm behind 18 mm see 20 mm at 30 m: a target that crosses at 1 m/s moves half a pixel in 10 ms.
    #[test]
    fn a_view_that_is_not_known_is_taken_for_the_worst() {
        let mut camera = presets::get("flir-a325sc").unwrap();
        camera.pixels = None;
        assert_eq!(Motion::of(&camera, None), None);
        let motion = Motion::of(&camera, Some(30.0)).unwrap();
        assert!((motion.blur_pixels(1.0, 10e-3) - 0.5).abs() < 1e-12);
    }
}
