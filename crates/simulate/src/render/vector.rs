//! Vectors of three components.

/// x to the right, y up, z ahead.
pub(super) type Vector = [f64; 3];

/// Up.
pub(super) const UP: Vector = [0.0, 1.0, 0.0];

#[inline]
pub(super) fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline]
pub(super) fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[inline]
pub(super) fn subtract(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// a + s b.
#[inline]
pub(super) fn along(a: Vector, s: f64, b: Vector) -> Vector {
    [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]]
}

#[inline]
pub(super) fn scaled(a: Vector, s: f64) -> Vector {
    [a[0] * s, a[1] * s, a[2] * s]
}

#[inline]
pub(super) fn norm(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

/// a/|a|, and upwards where a = 0.
#[inline]
pub(super) fn unit(a: Vector) -> Vector {
    let length = norm(a);
    if length > 0.0 { scaled(a, 1.0 / length) } else { UP }
}
