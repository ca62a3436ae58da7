//! Thermal lighting factors of polygons: vector form factors by Lambert's formula.
//!
//! For a point p and a polygon with corners r_i (relative to p),
//!
//! Φ = (1/π) ∫ ω dΩ = (1/2π) Σ_i Θ_i (r_i × r_{i+1})/|r_i × r_{i+1}|
//!
//! where Θ_i is the angle between r_i and r_{i+1}; the factor of a surface with normal n is V = n·Φ if the polygon
//! is wholly before it. What lies behind the plane through p is cut off first. Φ does not depend on n: a bumpy
//! surface costs no more than a smooth one.
//!
//! Source: J. H. Lambert, Photometria (1760); in this form e.g. Baum, Rushmeier, Winget, SIGGRAPH 1989,
//! doi:10.1145/74333.74367.

use super::vector::{Vector, along, cross, dot, norm, scaled, subtract};

/// Corners that a quadrilateral may have after two cuts, and one to spare.
const CORNERS: usize = 8;

/// A convex polygon as seen from a point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Polygon {
    corners: [Vector; CORNERS],
    count: usize,
}

impl Polygon {
    /// A quadrilateral, seen from `point`.
    #[inline]
    pub(super) fn seen_from(point: Vector, corners: [Vector; 4]) -> Self {
        let mut polygon = Self { corners: [[0.0; 3]; CORNERS], count: 4 };
        for (to, from) in polygon.corners.iter_mut().zip(corners) {
            *to = subtract(from, point);
        }
        polygon
    }

    fn corners(&self) -> &[Vector] {
        &self.corners[..self.count]
    }

    /// Whether no corner is behind the plane through the point with this normal.
    #[inline]
    fn is_before(&self, normal: Vector) -> bool {
        self.corners().iter().all(|&corner| dot(corner, normal) >= 0.0)
    }

    /// The part before the plane through the point with this normal.
    #[inline]
    pub(super) fn cut(&self, normal: Vector) -> Self {
        if self.is_before(normal) {
            return *self;
        }
        let mut kept = Self { corners: [[0.0; 3]; CORNERS], count: 0 };
        let mut keep = |corner| {
            if let Some(place) = kept.corners.get_mut(kept.count) {
                *place = corner;
                kept.count += 1;
            }
        };
        let corners = self.corners();
        for (i, &here) in corners.iter().enumerate() {
            let next = corners[(i + 1) % corners.len()];
            let (a, b) = (dot(here, normal), dot(next, normal));
            if a >= 0.0 {
                keep(here);
            }
            if (a >= 0.0) != (b >= 0.0) {
                keep(along(here, a / (a - b), subtract(next, here)));
            }
        }
        kept
    }

    /// Φ, towards the polygon.
    #[inline]
    pub(super) fn factor(&self) -> Vector {
        let corners = self.corners();
        if corners.len() < 3 {
            return [0.0; 3];
        }
        let (mut sum, mut middle) = ([0.0; 3], [0.0; 3]);
        for (i, &here) in corners.iter().enumerate() {
            let next = corners[if i + 1 == corners.len() { 0 } else { i + 1 }];
            let across = cross(here, next);
            let sine = norm(across);
            if sine > 0.0 {
                sum = along(sum, libm::atan2(sine, dot(here, next)) / sine, across);
            }
            middle = along(middle, 1.0, here);
        }
        let sign = if dot(sum, middle) < 0.0 { -1.0 } else { 1.0 };
        scaled(sum, sign / (2.0 * std::f64::consts::PI))
    }
}

/// Φ of what is above the horizontal plane through the point, and of what is below it.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Factor {
    pub(super) above: Vector,
    pub(super) below: Vector,
}

impl Factor {
    /// Adds the part of a polygon that is before the plane with this normal.
    #[inline]
    pub(super) fn add(&mut self, polygon: &Polygon, normal: Vector) {
        let seen = polygon.cut(normal);
        let (up, down) = ([0.0, 1.0, 0.0], [0.0, -1.0, 0.0]);
        if seen.is_before(up) {
            self.above = along(self.above, 1.0, seen.factor());
        } else if seen.is_before(down) {
            self.below = along(self.below, 1.0, seen.factor());
        } else {
            self.above = along(self.above, 1.0, seen.cut(up).factor());
            self.below = along(self.below, 1.0, seen.cut(down).factor());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    const UP: Vector = [0.0, 1.0, 0.0];

    /// A horizontal rectangle at height c, with a corner above the point, sides a and b.
    fn parallel(a: f64, b: f64, c: f64) -> f64 {
        let corners = [[0.0, c, 0.0], [a, c, 0.0], [a, c, b], [0.0, c, b]];
        dot(Polygon::seen_from([0.0; 3], corners).factor(), UP)
    }

    #[test]
    fn a_parallel_rectangle_above_its_corner_has_the_textbook_factor() {
        // Howell, configuration B-3.
        for (a, b, c) in [(1.0, 1.0, 1.0), (0.3, 4.0, 0.7), (20.0, 0.1, 5.0)] {
            let (x, y) = (a / c, b / c);
            let (p, q) = (f64::hypot(1.0, x), f64::hypot(1.0, y));
            let exact = (x / p * (y / p).atan() + y / q * (x / q).atan()) / (2.0 * PI);
            assert!((parallel(a, b, c) / exact - 1.0).abs() < 1e-12, "{a} {b} {c}");
        }
        assert!((4.0 * parallel(1e7, 1e7, 1.0) - 1.0).abs() < 1e-6);
    }

    #[test]
    fn an_upright_rectangle_at_its_corner_has_the_textbook_factor() {
        // Howell, configuration B-4: wide b, high a, the point before a corner at a distance c.
        for (a, b, c) in [(1.0, 1.0, 1.0), (2.0, 0.5, 3.0), (1.7, 0.4, 0.05)] {
            let corners = [[0.0, 0.0, c], [b, 0.0, c], [b, a, c], [0.0, a, c]];
            let x = f64::hypot(a, c);
            let exact = ((b / c).atan() - c / x * (b / x).atan()) / (2.0 * PI);
            let polygon = Polygon::seen_from([0.0; 3], corners);
            assert!((dot(polygon.factor(), UP) / exact - 1.0).abs() < 1e-12);
            // The same reaching as far below the horizon: cut off there.
            let sunk = corners.map(|[x, y, z]| [x, if y == 0.0 { -a } else { y }, z]);
            let mut factor = Factor::default();
            factor.add(&Polygon::seen_from([0.0; 3], sunk), UP);
            assert!((dot(factor.above, UP) / exact - 1.0).abs() < 1e-12);
            assert_eq!(factor.below, [0.0; 3]);
            // Seen by a wall that faces it: half above, half below.
            let mut factor = Factor::default();
            factor.add(&Polygon::seen_from([0.0; 3], sunk), [0.0, 0.0, 1.0]);
            assert!((factor.above[2] / factor.below[2] - 1.0).abs() < 1e-12);
            assert!((factor.above[1] / exact - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn a_polygon_behind_or_edge_on_has_none() {
        let corners = [[0.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, -1.0, 1.0], [0.0, -1.0, 1.0]];
        assert_eq!(Polygon::seen_from([0.0; 3], corners).cut(UP).factor(), [0.0; 3]);
        let edge_on = [[1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 0.0, 1.0], [1.0, 0.0, 1.0]];
        assert!(dot(Polygon::seen_from([0.0; 3], edge_on).factor(), [1.0, 0.0, 0.0]).abs() < 1e-15);
    }
}
