//! Solids: where a ray meets them, which way their surface faces, and points all over it.

use super::vector::{Vector, along, dot, norm, scaled, subtract, unit};
use std::f64::consts::PI;

/// A convex solid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Shape {
    /// A box with edges along the axes.
    Cuboid { low: Vector, high: Vector },
    /// An ellipsoid with semi-axes along the axes.
    Ellipsoid { centre: Vector, semi: Vector },
    /// All points within `radius` of a line from one end to the other.
    Capsule { ends: [Vector; 2], radius: f64 },
}

/// A point of a surface with its normal and the area it stands for.
#[derive(Debug, Clone, Copy)]
pub(super) struct Patch {
    pub(super) point: Vector,
    pub(super) normal: Vector,
    pub(super) area_m2: f64,
}

/// The first root above 0 of a t² + 2 h t + c = 0 with a > 0 and c > 0 (the ray starts outside).
#[inline]
fn first_root(a: f64, h: f64, c: f64) -> Option<f64> {
    let discriminant = h * h - a * c;
    // c/(…) rather than (…)/a: the two terms of the denominator have the same sign.
    (discriminant >= 0.0 && h < 0.0 && c > 0.0).then(|| c / (discriminant.sqrt() - h))
}

impl Shape {
    /// t > 0 at which the ray `origin` + t `direction` enters the solid from outside.
    #[inline]
    pub(super) fn hit(&self, origin: Vector, direction: Vector) -> Option<f64> {
        match *self {
            Self::Cuboid { low, high } => {
                let (mut enter, mut leave) = (f64::NEG_INFINITY, f64::INFINITY);
                for i in 0..3 {
                    if direction[i] == 0.0 {
                        if origin[i] < low[i] || origin[i] > high[i] {
                            return None;
                        }
                        continue;
                    }
                    let (a, b) = ((low[i] - origin[i]) / direction[i], (high[i] - origin[i]) / direction[i]);
                    enter = enter.max(a.min(b));
                    leave = leave.min(a.max(b));
                }
                (enter > 0.0 && enter <= leave).then_some(enter)
            }
            Self::Ellipsoid { centre, semi } => {
                let from = subtract(origin, centre);
                let o = [from[0] / semi[0], from[1] / semi[1], from[2] / semi[2]];
                let d = [direction[0] / semi[0], direction[1] / semi[1], direction[2] / semi[2]];
                first_root(dot(d, d), dot(o, d), dot(o, o) - 1.0)
            }
            Self::Capsule { ends, radius } => {
                let axis = subtract(ends[1], ends[0]);
                let (from, length2) = (subtract(origin, ends[0]), dot(axis, axis));
                let mut nearest = None::<f64>;
                // Across the axis everything is a circle.
                let d = along(direction, -dot(direction, axis) / length2, axis);
                let o = along(from, -dot(from, axis) / length2, axis);
                if let Some(t) = first_root(dot(d, d), dot(o, d), dot(o, o) - radius * radius) {
                    let s = dot(along(from, t, direction), axis) / length2;
                    if (0.0..=1.0).contains(&s) {
                        nearest = Some(t);
                    }
                }
                for end in ends {
                    let from = subtract(origin, end);
                    let ball = dot(from, from) - radius * radius;
                    if let Some(t) = first_root(dot(direction, direction), dot(from, direction), ball) {
                        nearest = Some(nearest.map_or(t, |other| other.min(t)));
                    }
                }
                nearest
            }
        }
    }

    /// The outward normal at a point of the surface.
    #[inline]
    pub(super) fn normal(&self, point: Vector) -> Vector {
        match *self {
            Self::Cuboid { low, high } => {
                let mut best = (f64::INFINITY, [0.0; 3]);
                for i in 0..3 {
                    for (face, sign) in [(low[i], -1.0), (high[i], 1.0)] {
                        let distance = (point[i] - face).abs();
                        if distance < best.0 {
                            best = (distance, [0.0; 3]);
                            best.1[i] = sign;
                        }
                    }
                }
                best.1
            }
            Self::Ellipsoid { centre, semi } => {
                let from = subtract(point, centre);
                unit(std::array::from_fn(|i| from[i] / (semi[i] * semi[i])))
            }
            Self::Capsule { ends, .. } => {
                let axis = subtract(ends[1], ends[0]);
                let s = dot(subtract(point, ends[0]), axis) / dot(axis, axis);
                unit(subtract(point, along(ends[0], s.clamp(0.0, 1.0), axis)))
            }
        }
    }

    /// Whether its normal turns along its surface.
    pub(super) fn is_round(&self) -> bool {
        !matches!(self, Self::Cuboid { .. })
    }

    /// Whether a point is inside or on the surface.
    pub(super) fn contains(&self, point: Vector) -> bool {
        match *self {
            Self::Cuboid { low, high } => (0..3).all(|i| low[i] <= point[i] && point[i] <= high[i]),
            Self::Ellipsoid { centre, semi } => {
                let from = subtract(point, centre);
                (0..3).map(|i| (from[i] / semi[i]).powi(2)).sum::<f64>() <= 1.0
            }
            Self::Capsule { ends, radius } => {
                let axis = subtract(ends[1], ends[0]);
                let s = dot(subtract(point, ends[0]), axis) / dot(axis, axis);
                norm(subtract(point, along(ends[0], s.clamp(0.0, 1.0), axis))) <= radius
            }
        }
    }

    /// Lowest and highest coordinates.
    pub(super) fn bounds(&self) -> [Vector; 2] {
        match *self {
            Self::Cuboid { low, high } => [low, high],
            Self::Ellipsoid { centre, semi } => [subtract(centre, semi), along(centre, 1.0, semi)],
            Self::Capsule { ends: [a, b], radius } => [
                std::array::from_fn(|i| a[i].min(b[i]) - radius),
                std::array::from_fn(|i| a[i].max(b[i]) + radius),
            ],
        }
    }

    /// Patches that cover the surface: `n` × `n` on every face of a box, 2n × 4n on anything round.
    pub(super) fn patches(&self, n: usize) -> Vec<Patch> {
        match *self {
            Self::Cuboid { low, high } => {
                let size = subtract(high, low);
                let mut patches = Vec::with_capacity(6 * n * n);
                for axis in 0..3 {
                    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
                    for (face, sign) in [(low[axis], -1.0), (high[axis], 1.0)] {
                        let mut normal = [0.0; 3];
                        normal[axis] = sign;
                        for i in 0..n * n {
                            let mut point = [face; 3];
                            point[u] = low[u] + size[u] * ((i / n) as f64 + 0.5) / n as f64;
                            point[v] = low[v] + size[v] * ((i % n) as f64 + 0.5) / n as f64;
                            patches.push(Patch {
                                point,
                                normal,
                                area_m2: size[u] * size[v] / (n * n) as f64,
                            });
                        }
                    }
                }
                patches
            }
            Self::Ellipsoid { centre, semi } => on_ball(n, |on_unit_sphere, solid_angle| {
                let point = std::array::from_fn(|i| centre[i] + semi[i] * on_unit_sphere[i]);
                // Nanson: dA = det(A) |A⁻¹ n₀| dA₀.
                let stretched: Vector = std::array::from_fn(|i| on_unit_sphere[i] / semi[i]);
                let area_m2 = semi.iter().product::<f64>() * norm(stretched) * solid_angle;
                Patch { point, normal: unit(stretched), area_m2 }
            }),
            Self::Capsule { ends, radius } => {
                let axis = subtract(ends[1], ends[0]);
                let length = norm(axis);
                let ahead = scaled(axis, 1.0 / length);
                let mut patches = on_ball(n, |normal, solid_angle| {
                    let end = if dot(normal, ahead) > 0.0 { ends[1] } else { ends[0] };
                    Patch {
                        point: along(end, radius, normal),
                        normal,
                        area_m2: solid_angle * radius * radius,
                    }
                });
                let across = if ahead[0].abs() < 0.9 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
                let u = unit(along(across, -dot(across, ahead), ahead));
                let v = super::vector::cross(ahead, u);
                for i in 0..2 * n * 4 * n {
                    let (sin, cos) = libm::sincos(((i % (4 * n)) as f64 + 0.5) * 2.0 * PI / (4 * n) as f64);
                    let normal = along(scaled(u, cos), sin, v);
                    let start = along(ends[0], ((i / (4 * n)) as f64 + 0.5) / (2 * n) as f64, axis);
                    let area_m2 = 2.0 * PI * radius * length / (2 * n * 4 * n) as f64;
                    patches.push(Patch { point: along(start, radius, normal), normal, area_m2 });
                }
                patches
            }
        }
    }
}

/// Patches of a unit sphere of equal solid angle, turned into those of a solid.
fn on_ball(n: usize, patch: impl Fn(Vector, f64) -> Patch) -> Vec<Patch> {
    let (bands, sectors) = (2 * n, 4 * n);
    (0..bands * sectors)
        .map(|i| {
            let y = ((i / sectors) as f64 + 0.5) * 2.0 / bands as f64 - 1.0;
            let (sin, cos) = libm::sincos(((i % sectors) as f64 + 0.5) * 2.0 * PI / sectors as f64);
            let r = (1.0 - y * y).sqrt();
            patch([r * cos, y, r * sin], 4.0 * PI / (bands * sectors) as f64)
        })
        .collect()
}

#[cfg(test)]
mod tests;
