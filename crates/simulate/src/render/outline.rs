//! A solid as it is seen from a point: the convex polygon of its outline.
//!
//! All of a convex solid lies before the plane through the point that is square to the way to its nearest point. There its corners, or
//! those of its rims, are drawn in perspective, and their convex hull is the outline. A rim, where sight lines touch a ball, is a circle: with
//! q the way from the middle to the point in units of the radius, its middle is q/|q|² and its radius (1 − 1/|q|²)^½; an ellipsoid is a
//! ball in units of its semi-axes. Eight corners stand for it, drawn out along one axis to the circle's area.

use super::factor::{CORNERS, Polygon};
use super::shape::Shape;
use super::vector::{UP, Vector, along, cross, dot, norm, scaled, subtract, unit};

/// Corners of a rim.
const RIM: usize = 8;
/// π over the area of the regular octagon in the unit circle.
const STRETCH: f64 = std::f64::consts::PI / (2.0 * std::f64::consts::SQRT_2);

impl Shape {
    /// Its outline seen from `point`; none from inside, or from its surface.
    pub(super) fn outline(&self, point: Vector) -> Option<Polygon> {
        match *self {
            Self::Cuboid { low, high } => {
                let nearest = std::array::from_fn(|i| point[i].clamp(low[i], high[i]));
                let corner = |corner: usize| -> Vector {
                    std::array::from_fn(|i| if corner >> i & 1 == 1 { high[i] } else { low[i] } - point[i])
                };
                hull(subtract(nearest, point), &std::array::from_fn::<_, 8, _>(corner))
            }
            Self::Ellipsoid { centre, semi } => {
                let from: Vector = std::array::from_fn(|i| (point[i] - centre[i]) / semi[i]);
                // Fixed to the world, so that the outline moves smoothly with the point.
                let rim = rim(from, UP)?.map(|at| std::array::from_fn(|i| (at[i] - from[i]) * semi[i]));
                Polygon::wound(&rim)
            }
            Self::Capsule { ends, radius } => {
                let axis = subtract(ends[1], ends[0]);
                let s = dot(subtract(point, ends[0]), axis) / dot(axis, axis);
                let towards = subtract(along(ends[0], s.clamp(0.0, 1.0), axis), point);
                let distance = norm(towards);
                if distance <= radius {
                    return None;
                }
                let mut corners = [[0.0; 3]; 2 * RIM];
                for (corners, end) in corners.chunks_exact_mut(RIM).zip(ends) {
                    let from = scaled(subtract(point, end), 1.0 / radius);
                    for (to, at) in corners.iter_mut().zip(rim(from, axis)?) {
                        *to = scaled(subtract(at, from), radius);
                    }
                }
                hull(towards, &corners)
            }
        }
    }

    /// Its middle.
    pub(super) fn middle(&self) -> Vector {
        let [low, high] = self.bounds();
        scaled(along(low, 1.0, high), 0.5)
    }
}

/// Points around the rim of the unit ball at the origin seen from `from`, the first of them towards `axis`.
fn rim(from: Vector, axis: Vector) -> Option<[Vector; RIM]> {
    let square = dot(from, from);
    if square <= 1.0 {
        return None;
    }
    let away = scaled(from, 1.0 / square.sqrt());
    let across = |axis: Vector| along(axis, -dot(axis, away), away);
    let mut ahead = across(axis);
    // Along the axis any direction does.
    if dot(ahead, ahead) < 1e-12 * dot(axis, axis) {
        ahead = across([away[1], away[2], -away[0]]);
    }
    let (ahead, radius) = (unit(ahead), (1.0 - 1.0 / square).sqrt());
    let side = cross(away, ahead);
    const HALF: f64 = std::f64::consts::FRAC_1_SQRT_2;
    let circle = [
        (1.0, 0.0),
        (HALF, HALF),
        (0.0, 1.0),
        (-HALF, HALF),
        (-1.0, 0.0),
        (-HALF, -HALF),
        (0.0, -1.0),
        (HALF, -HALF),
    ];
    let middle = scaled(from, 1.0 / square);
    Some(circle.map(|(cos, sin)| along(along(middle, radius * cos * STRETCH, ahead), radius * sin, side)))
}

/// The outline of corners that are all before the plane across `towards`.
fn hull(towards: Vector, corners: &[Vector]) -> Option<Polygon> {
    let depth2 = dot(towards, towards);
    if depth2 == 0.0 {
        return None;
    }
    let ahead = scaled(towards, 1.0 / depth2.sqrt());
    let right = unit(cross(if ahead[1].abs() < 0.9 { UP } else { [1.0, 0.0, 0.0] }, ahead));
    let up = cross(ahead, right);
    let mut drawn = [([0.0; 2], [0.0; 3]); 2 * RIM];
    let mut count = 0;
    for &corner in corners {
        let depth = dot(corner, ahead);
        if depth > 0.0
            && let Some(place) = drawn.get_mut(count)
        {
            *place = ([dot(corner, right) / depth, dot(corner, up) / depth], corner);
            count += 1;
        }
    }
    let drawn = drawn.get_mut(..count)?;
    drawn.sort_unstable_by(|(a, _), (b, _)| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    // Andrew's chains: the lower one from left to right, then the upper one back.
    let turn =
        |o: [f64; 2], a: [f64; 2], b: [f64; 2]| (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
    let mut chain = [([0.0; 2], [0.0; 3]); CORNERS];
    let mut length = 0;
    for (start, backwards) in [(0, false), (1, true)] {
        let least = if backwards { length + 1 } else { 2 };
        for i in start..count {
            let next = drawn[if backwards { count - 1 - i } else { i }];
            while length >= least && turn(chain[length - 2].0, chain[length - 1].0, next.0) <= 0.0 {
                length -= 1;
            }
            if length < CORNERS {
                chain[length] = next;
                length += 1;
            }
        }
    }
    // The last is the first again.
    let outline = chain.get(..length.saturating_sub(1))?;
    let mut corners = [[0.0; 3]; CORNERS];
    corners.iter_mut().zip(outline).for_each(|(to, (_, corner))| *to = *corner);
    Polygon::wound(corners.get(..outline.len())?)
}
