//! Two parallel cameras.
//!
//! A camera looks ahead, tilted down by `pitch_rad`. A point at depth z along the optical axis, X to the right and Y
//! towards the top of the image, is seen at column (columns − 1)/2 + F X/z and row (rows − 1)/2 − F Y/z, where
//! F = f/pixel is the focal length in pixels and whole numbers are pixel centres. Disparity: d = x_L − x_R = b F/z.

use super::vector::{Vector, along, dot, subtract};
use hadar::cube::Shape;
use hadar::error::{Error, Result, check};

/// A stereo camera above the ground; the left camera is at x = −b/2, the right one at +b/2.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Rig {
    /// Distance b between the cameras, m.
    pub baseline_m: f64,
    /// Focal length f of both cameras, m.
    pub focal_length_m: f64,
    /// Side of a square pixel, m.
    pub pixel_m: f64,
    /// Number of pixels in the direction y.
    pub rows: usize,
    /// Number of pixels in the direction x.
    pub columns: usize,
    /// Height above the ground, m.
    pub height_m: f64,
    /// Angle by which both look down, rad.
    pub pitch_rad: f64,
}

impl Default for Rig {
    /// The paper's Fig. 4: b = 0.2 m, f = 1.4 cm, 640 × 480 pixels. Not told there, chosen here: 12 µm pixels (31°
    /// across), 1.5 m above the ground and 9° down, so that it sees the ground from 4 m to the horizon.
    fn default() -> Self {
        Self {
            baseline_m: 0.2,
            focal_length_m: 0.014,
            pixel_m: 12e-6,
            rows: 480,
            columns: 640,
            height_m: 1.5,
            pitch_rad: 9_f64.to_radians(),
        }
    }
}

impl Rig {
    /// Checks every figure.
    ///
    /// # Errors
    /// A length that is not positive, no pixels, a pitch of a right angle or more.
    ///
    /// ```
    /// use hadar_simulate::render::Rig;
    /// assert!((Rig::default().disparity_px(10.0) - 0.2 * 0.014 / (10.0 * 12e-6)).abs() < 1e-12);
    /// assert!(Rig { baseline_m: 0.0, ..Rig::default() }.checked().is_err());
    /// # Ok::<(), hadar::Error>(())
    /// ```
    pub fn checked(self) -> Result<Self> {
        check::positive("baseline", self.baseline_m, "m")?;
        check::positive("focal length", self.focal_length_m, "m")?;
        check::positive("pixel", self.pixel_m, "m")?;
        check::positive("height of the cameras", self.height_m, "m")?;
        check::finite("pitch", self.pitch_rad, "rad")?;
        if self.pitch_rad.abs() >= 1.5 {
            return Err(Error::out_of_range("pitch", self.pitch_rad, "rad", "between -1.5 and 1.5 rad"));
        }
        check::positive("focal length in pixels", self.focal_px(), "pixel")?;
        Shape::new(self.rows, self.columns, 1)?;
        Ok(self)
    }

    /// Focal length in pixels.
    #[must_use]
    pub fn focal_px(&self) -> f64 {
        self.focal_length_m / self.pixel_m
    }

    /// Disparity of a point at depth `depth_m`, pixels; 0 infinitely far away.
    #[must_use]
    pub fn disparity_px(&self, depth_m: f64) -> f64 {
        self.baseline_m * self.focal_px() / depth_m
    }

    /// Cycles per metre, on a plane across the optical axis at `depth_m`, of what has `cycles_per_px` in the image.
    #[must_use]
    pub fn cycles_per_m(&self, depth_m: f64, cycles_per_px: f64) -> f64 {
        cycles_per_px * self.focal_px() / depth_m
    }

    /// The camera at x = `side` × b.
    pub(super) fn camera(&self, side: f64) -> Camera {
        let (sin, cos) = libm::sincos(self.pitch_rad);
        Camera {
            origin: [side * self.baseline_m, self.height_m, 0.0],
            up: [0.0, cos, sin],
            forward: [0.0, -sin, cos],
            focal_px: self.focal_px(),
            centre: [0.5 * (self.columns as f64 - 1.0), 0.5 * (self.rows as f64 - 1.0)],
        }
    }
}

/// One camera; its right is x.
#[derive(Debug, Clone, Copy)]
pub(super) struct Camera {
    pub(super) origin: Vector,
    pub(super) up: Vector,
    pub(super) forward: Vector,
    pub(super) focal_px: f64,
    centre: [f64; 2],
}

impl Camera {
    /// Direction of the ray through (column, row), as long as its depth is 1: a point of it at t has depth t.
    #[inline]
    pub(super) fn direction(&self, column: f64, row: f64) -> Vector {
        let ahead = along(self.forward, (self.centre[1] - row) / self.focal_px, self.up);
        [(column - self.centre[0]) / self.focal_px, ahead[1], ahead[2]]
    }

    /// Column, row and depth of a point; `None` if it is not before the camera.
    #[inline]
    pub(super) fn project(&self, point: Vector) -> Option<[f64; 3]> {
        let from = subtract(point, self.origin);
        let depth = dot(from, self.forward);
        (depth > 0.0).then(|| {
            let per = self.focal_px / depth;
            [self.centre[0] + from[0] * per, self.centre[1] - dot(from, self.up) * per, depth]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_on_a_ray_is_projected_back_and_has_the_disparity_of_its_depth() {
        let rig = Rig::default();
        let (left, right) = (rig.camera(-0.5), rig.camera(0.5));
        for (column, row, depth) in [(0.0, 0.0, 3.0), (319.5, 239.5, 8.0), (600.25, 470.75, 41.0)] {
            let point = along(left.origin, depth, left.direction(column, row));
            let [x, y, z] = left.project(point).unwrap();
            assert!((x - column).abs() < 1e-9 && (y - row).abs() < 1e-9 && (z - depth).abs() < 1e-12);
            let [x_right, y_right, z_right] = right.project(point).unwrap();
            assert!((x - x_right - 0.2 * 0.014 / (depth * 12e-6)).abs() < 1e-9);
            assert!((y_right - row).abs() < 1e-9 && (z_right - depth).abs() < 1e-12);
        }
        assert!(left.project([0.0, 1.5, -1.0]).is_none());
        // Looking down, the lowest rows see the nearest ground: below the axis by atan(239.5/F).
        let lowest = left.direction(319.5, 479.0);
        let angle = (-lowest[1] / lowest[2]).atan();
        assert!((angle - rig.pitch_rad - (239.5 / rig.focal_px()).atan()).abs() < 1e-12);
    }

    #[test]
    fn impossible_rigs_are_errors() {
        let rig = Rig::default();
        for bad in [
            Rig { baseline_m: 0.0, ..rig.clone() },
            Rig { focal_length_m: f64::NAN, ..rig.clone() },
            Rig { pixel_m: -1.0, ..rig.clone() },
            Rig { rows: 0, ..rig.clone() },
            Rig { height_m: 0.0, ..rig.clone() },
            Rig { pitch_rad: 1.6, ..rig.clone() },
        ] {
            assert!(bad.clone().checked().is_err(), "{bad:?}");
        }
        assert!(rig.checked().is_ok());
    }
}
