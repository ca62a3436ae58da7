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
//! What one polygon hides of another is the factor of what both cover, which is convex, or is cut away plane by plane: a convex polygon
//! without another one is at the most as many convex pieces as that has edges.
//!
//! Source: J. H. Lambert, Photometria (1760); in this form e.g. Baum, Rushmeier, Winget, SIGGRAPH 1989,
//! doi:10.1145/74333.74367.

use super::vector::{Vector, along, cross, dot, norm, scaled, subtract, unit};

/// Corners that a polygon may have: those of an outline, and one more for every cut.
pub(super) const CORNERS: usize = 16;
/// Angle between corners below which they are one, rad.
const CLOSE: f64 = 1e-10;

/// A convex polygon as seen from a point: the cone of directions to it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Polygon {
    corners: [Vector; CORNERS],
    count: usize,
}

impl Polygon {
    /// The polygon of corners relative to the point, turned so that every r_i × r_{i+1} points inwards; none if it has no area.
    pub(super) fn wound(corners: &[Vector]) -> Option<Self> {
        let mut polygon = Self { corners: [[0.0; 3]; CORNERS], count: corners.len().min(CORNERS) };
        polygon.corners.iter_mut().zip(corners).for_each(|(to, from)| *to = *from);
        if polygon.count < 3 {
            return None;
        }
        let middle = polygon.middle();
        let turned: f64 = polygon.edges().map(|(here, next)| dot(cross(here, next), middle)).sum();
        if turned < 0.0 {
            polygon.corners[..polygon.count].reverse();
        }
        (turned != 0.0).then_some(polygon)
    }

    fn corners(&self) -> &[Vector] {
        &self.corners[..self.count]
    }

    fn edges(&self) -> impl Iterator<Item = (Vector, Vector)> + '_ {
        let corners = self.corners();
        let next = corners.iter().skip(1).chain(corners.first());
        corners.iter().zip(next).map(|(here, next)| (*here, *next))
    }

    /// Normals of the planes through the point along its edges, inwards. Corners as close as [`CLOSE`] have no plane but that of
    /// their rounding.
    fn planes(&self) -> impl Iterator<Item = Vector> + '_ {
        self.edges().filter_map(|(here, next)| {
            let inwards = cross(here, next);
            let long = dot(inwards, inwards) > CLOSE * CLOSE * dot(here, here) * dot(next, next);
            long.then_some(inwards)
        })
    }

    /// A direction inside it.
    pub(super) fn middle(&self) -> Vector {
        self.corners()
            .iter()
            .fold([0.0; 3], |sum, &corner| along(sum, 1.0 / norm(corner).max(f64::MIN_POSITIVE), corner))
    }

    /// Axis, cosine and sine of a cone about all of it.
    pub(super) fn cone(&self) -> Cone {
        let axis = unit(self.middle());
        let cos = self.corners().iter().map(|&corner| dot(unit(corner), axis)).fold(1.0, f64::min);
        Cone { axis, cos, sin: (1.0 - cos * cos).max(0.0).sqrt() }
    }

    /// Keeps the part before the plane through the point with this normal; false if nothing is left.
    #[inline]
    pub(super) fn keep(&mut self, normal: Vector) -> bool {
        let mut sides = [0.0; CORNERS];
        let (mut before, mut behind) = (false, false);
        for (side, corner) in sides.iter_mut().zip(self.corners()) {
            *side = dot(*corner, normal);
            before |= *side > 0.0;
            behind |= *side < 0.0;
        }
        if !behind || !before {
            return !behind && self.count > 2;
        }
        let mut kept = [[0.0; 3]; CORNERS];
        let mut count = 0;
        let mut put = |corner| {
            if let Some(place) = kept.get_mut(count) {
                *place = corner;
                count += 1;
            }
        };
        let mut next = 0;
        for i in 0..self.count {
            next += 1;
            if next == self.count {
                next = 0;
            }
            let (here, a, b) = (self.corners[i], sides[i], sides[next]);
            if a >= 0.0 {
                put(here);
            }
            if a > 0.0 && b < 0.0 || a < 0.0 && b > 0.0 {
                put(along(here, a / (a - b), subtract(self.corners[next], here)));
            }
        }
        self.corners[..count].copy_from_slice(&kept[..count]);
        self.count = count;
        count > 2
    }

    /// The part before the plane through the point with this normal; none if there is nothing.
    pub(super) fn cut(&self, normal: Vector) -> Option<Self> {
        let mut part = *self;
        part.keep(normal).then_some(part)
    }

    /// Whether some plane through the point along an edge of the other one parts the two.
    pub(super) fn is_beside(&self, other: &Self) -> bool {
        other.planes().any(|inwards| self.corners().iter().all(|&corner| dot(corner, inwards) <= 0.0))
    }

    /// Whether a plane through the point along an edge of either parts the two.
    pub(super) fn is_parted(&self, other: &Self) -> bool {
        self.is_beside(other) || other.is_beside(self)
    }

    /// What both cover.
    pub(super) fn overlap(&self, other: &Self) -> Option<Self> {
        let mut both = *self;
        other.planes().all(|inwards| both.keep(inwards)).then_some(both)
    }

    /// Hands out what `other` leaves of it, as convex pieces.
    pub(super) fn minus(&self, other: &Self, take: &mut dyn FnMut(&Self)) {
        let mut rest = *self;
        for inwards in other.planes() {
            if rest.corners().iter().any(|&corner| dot(corner, inwards) < 0.0) {
                rest.cut(scaled(inwards, -1.0)).iter().for_each(&mut *take);
                if !rest.keep(inwards) {
                    return;
                }
            }
        }
    }

    /// Φ, towards the polygon.
    #[inline]
    pub(super) fn factor(&self) -> Vector {
        let sum = self.edges().fold([0.0; 3], |sum, (here, next)| {
            let across = cross(here, next);
            let sine = norm(across);
            if sine > 0.0 { along(sum, libm::atan2(sine, dot(here, next)) / sine, across) } else { sum }
        });
        scaled(sum, 1.0 / (2.0 * std::f64::consts::PI))
    }
}

/// A cone of directions.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cone {
    axis: Vector,
    cos: f64,
    sin: f64,
}

impl Cone {
    /// Whether two cones may have a direction in common.
    pub(super) fn meets(&self, other: &Self) -> bool {
        let wide = self.cos <= 0.0 || other.cos <= 0.0;
        wide || dot(self.axis, other.axis) >= self.cos * other.cos - self.sin * other.sin
    }
}

/// Φ of what is above the horizontal plane through the point, and of what is below it.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Factor {
    pub(super) above: Vector,
    pub(super) below: Vector,
}

impl Factor {
    /// Adds `sign` times a polygon that is before the surface.
    #[inline]
    pub(super) fn add(&mut self, seen: &Polygon, sign: f64) {
        if seen.corners().iter().all(|corner| corner[1] >= 0.0) {
            self.above = along(self.above, sign, seen.factor());
            return;
        }
        for (to, side) in [(&mut self.above, 1.0), (&mut self.below, -1.0)] {
            if let Some(part) = seen.cut([0.0, side, 0.0]) {
                *to = along(*to, sign, part.factor());
            }
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
        dot(Polygon::wound(&corners).unwrap().factor(), UP)
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
            let polygon = Polygon::wound(&corners).unwrap();
            assert!((dot(polygon.factor(), UP) / exact - 1.0).abs() < 1e-12);
            // The same reaching as far below the horizon: cut off there.
            let sunk = corners.map(|[x, y, z]| [x, if y == 0.0 { -a } else { y }, z]);
            let mut factor = Factor::default();
            factor.add(&Polygon::wound(&sunk).unwrap().cut(UP).unwrap(), 1.0);
            assert!((dot(factor.above, UP) / exact - 1.0).abs() < 1e-12);
            assert_eq!(factor.below, [0.0; 3]);
            // Seen by a wall that faces it: half above, half below.
            let mut factor = Factor::default();
            factor.add(&Polygon::wound(&sunk).unwrap(), 1.0);
            assert!((factor.above[2] / factor.below[2] - 1.0).abs() < 1e-12);
            assert!((factor.above[1] / exact - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn corners_that_are_one_but_for_rounding_cut_nothing_off() {
        let square = |half: f64, height: f64| {
            [[-half, height, -half], [half, height, -half], [half, height, half], [-half, height, half]]
        };
        let (wide, [a, b, c, d]) = (Polygon::wound(&square(2.0, 4.0)).unwrap(), square(0.5, 2.0));
        let both = wide.overlap(&Polygon::wound(&[a, b, c, d]).unwrap()).unwrap().factor();
        // One step back along the edge: its plane is that of the edge, turned round.
        for back in [0.0, f64::EPSILON] {
            let twice = Polygon::wound(&[a, b, [b[0] - back, b[1], b[2]], c, d]).unwrap();
            let found = wide.overlap(&twice).unwrap().factor();
            assert!((found[1] / both[1] - 1.0).abs() < 1e-12, "{found:?} {both:?}");
            let mut left = 0.0;
            wide.minus(&twice, &mut |piece| left += piece.factor()[1]);
            assert!(((wide.factor()[1] - left) / both[1] - 1.0).abs() < 1e-12, "{left}");
        }
    }

    #[test]
    fn a_polygon_behind_or_edge_on_has_none() {
        let corners = [[0.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, -1.0, 1.0], [0.0, -1.0, 1.0]];
        assert!(Polygon::wound(&corners).unwrap().cut(UP).is_none());
        let edge_on = [[1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 0.0, 1.0], [1.0, 0.0, 1.0]];
        assert!(Polygon::wound(&edge_on).is_none());
    }
}
