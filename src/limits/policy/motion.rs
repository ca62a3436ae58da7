//! How far the picture of a target moves while it is taken.
//!
//! Δ = v_⊥ t/(r α) pixels (SII E): v_⊥ = v sin(θ/2) the largest transverse part of the speed v (m s⁻¹) that keeps the
//! target in the field of view θ (rad), t the time until all bands are exposed (s), α the angle of a pixel (rad), r the distance (m).
//!
//! Of pixel side p, focal length f, view θ and pixels L across it one is redundant, p/f = θ/L. Where they contradict each other, one of
//! them is wrong, and nobody knows which: each is left out in turn, and the largest blur of these readings counts,
//!
//! | left out | α | θ |
//! |---|---|---|
//! | L | p/f | θ |
//! | θ | p/f | L p/f |
//! | p or f | θ/L | θ |
//!
//! Assumptions: small angles; a target that crosses the edge of the view, which is the worst place for a camera that
//! looks ahead. Where view or pixels are not known, α = p/f and the whole speed counts as transverse, which is the worst.
//! Averaged frames are laid over each other before they are summed, so that each counts by itself.

use crate::instrument::Camera;
use std::f64::consts::FRAC_PI_2;

/// What the blur of a moving target depends on beside speed and time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion {
    /// sin(θ/2)/α, the largest of all readings of the camera's figures.
    per_angle: f64,
    /// sin(θ/2), the largest of all readings.
    transverse: f64,
    distance_m: f64,
}

impl Motion {
    /// Of a camera whose target is at `distance_m`; `None` where that is not known.
    #[must_use]
    pub fn of(camera: &Camera, distance_m: Option<f64>) -> Option<Self> {
        distance_m.map(|distance_m| Self::within(camera, distance_m, FRAC_PI_2))
    }

    /// The same of a target that is no farther beside the axis than `bearing_rad`.
    pub(super) fn within(camera: &Camera, distance_m: f64, bearing_rad: f64) -> Self {
        let by_lens = camera.pixel_m / camera.focal_length_m;
        let Some((view_rad, pixels)) = camera.view_and_pixels() else {
            let transverse = bearing_rad.sin();
            return Self { per_angle: transverse / by_lens, transverse, distance_m };
        };
        let transverse = |view_rad: f64| (0.5 * view_rad).min(bearing_rad).sin();
        let readings = [(by_lens, view_rad), (by_lens, pixels * by_lens), (view_rad / pixels, view_rad)];
        let most = |of: &dyn Fn(f64, f64) -> f64| {
            readings.iter().map(|(pixel_rad, view_rad)| of(*pixel_rad, *view_rad)).fold(0.0, f64::max)
        };
        Self {
            per_angle: most(&|pixel_rad, view_rad| transverse(view_rad) / pixel_rad),
            transverse: most(&|_, view_rad| transverse(view_rad)),
            distance_m,
        }
    }

    /// Pixels that the target moves in `time_s`, the vehicle at `speed_m_s`.
    #[must_use]
    pub fn blur_pixels(&self, speed_m_s: f64, time_s: f64) -> f64 {
        speed_m_s * self.per_angle * time_s / self.distance_m
    }

    /// How far the target moves across the line of sight in `time_s`, m.
    #[must_use]
    pub fn blur_m(&self, speed_m_s: f64, time_s: f64) -> f64 {
        speed_m_s * self.transverse * time_s
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
    use proptest::prelude::*;

    /// The paper's case by its own numbers: 320 pixels across 50 degrees, 30 mph at 30 m, 12 ms: 0.83 pixels.
    #[test]
    fn thirty_miles_per_hour_at_thirty_metres() {
        let mut camera = presets::get("flir-a325sc").unwrap();
        // Its pixel and focal length see 0.667 mrad; the paper's blur is that of the view alone.
        camera.focal_length_m = camera.pixel_m * 320.0 / 50f64.to_radians();
        let motion = Motion::of(&camera, Some(30.0)).unwrap();
        assert!((motion.blur_pixels(13.4112, 12e-3) / 0.831 - 1.0).abs() < 1e-3);
        // One pixel after 12 ms/0.831.
        assert!((motion.longest_s(13.4112) / 14.44e-3 - 1.0).abs() < 1e-3);
        assert!((motion.blur_pixels(motion.fastest_m_s(5e-3), 5e-3) - 1.0).abs() < 1e-14);
    }

    /// By its lens the camera of the paper sees 2/3 mrad a pixel, by its view 2.7 mrad: the finer pixel in the stated view is the worst.
    #[test]
    fn figures_that_contradict_each_other_are_judged_by_the_worst_reading() {
        let camera = presets::get("flir-a325sc").unwrap();
        assert!(camera.contradicts_its_view());
        let motion = Motion::of(&camera, Some(30.0)).unwrap();
        let way_m = 13.4112 * 25f64.to_radians().sin() * 12e-3;
        assert!((motion.blur_pixels(13.4112, 12e-3) / (way_m / (30.0 / 1500.0)) - 1.0).abs() < 1e-12);
        assert!((motion.blur_m(13.4112, 12e-3) / way_m - 1.0).abs() < 1e-12);
        // Eight pixels across 12.5 degrees behind a lens of 35 mm: 1/2917 rad, not 12.5/8 degrees, and not eight of the finer pixels wide.
        let few = Camera {
            focal_length_m: 35e-3,
            field_of_view_rad: Some(12.5f64.to_radians()),
            pixels: Some(8),
            ..camera
        };
        let by_hand = 10.0 * 6.25f64.to_radians().sin() * 10e-3 / (30.0 * 12.0 / 35e3);
        let found = Motion::of(&few, Some(30.0)).unwrap().blur_pixels(10.0, 10e-3);
        assert!((found / by_hand - 1.0).abs() < 1e-12, "{found} {by_hand}");
    }

    proptest! {
        /// Blur of three figures that agree with each other, by hand; whatever the fourth is, the blur is no less.
        #[test]
        fn a_figure_that_is_added_never_makes_the_blur_less(
            log_angle in -9.0..-4.0f64, view_rad in 0.01..3.1f64, pixels in 1u32..3000, distance_m in 0.1..1e4f64,
        ) {
            let by_lens: f64 = log_angle.exp();
            let count = f64::from(pixels);
            let camera = Camera {
                pixel_m: 12e-6,
                focal_length_m: 12e-6 / by_lens,
                field_of_view_rad: Some(view_rad),
                pixels: Some(pixels),
                ..presets::get("ideal-pnrd").unwrap()
            };
            let motion = Motion::of(&camera, Some(distance_m)).unwrap();
            let blur = motion.blur_pixels(2.0, 0.01);
            let of = |pixel_rad: f64, view_rad: f64| 2.0 * (0.5 * view_rad.min(std::f64::consts::PI)).sin() * 0.01 / (distance_m * pixel_rad);
            let consistent = [of(by_lens, view_rad), of(by_lens, count * by_lens), of(view_rad / count, view_rad)];
            for least in consistent {
                prop_assert!(blur >= least * (1.0 - 1e-12), "{blur} {consistent:?}");
            }
            // It is that of one of them: no worse than any camera that there could be.
            prop_assert!(consistent.iter().any(|of| (blur / of - 1.0).abs() < 1e-12), "{blur} {consistent:?}");
            prop_assert!(motion.blur_m(2.0, 0.01) >= blur * distance_m * by_lens.min(view_rad / count) * (1.0 - 1e-12));
            // Without the view or the pixels nothing but the lens says what a pixel sees, and all of the speed counts.
            for unknown in [Camera { pixels: None, ..camera.clone() }, Camera { field_of_view_rad: None, ..camera.clone() }] {
                let whole = Motion::of(&unknown, Some(distance_m)).unwrap().blur_pixels(2.0, 0.01);
                prop_assert!((whole / (2.0 * 0.01 / (distance_m * by_lens)) - 1.0).abs() < 1e-12);
            }
        }
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
