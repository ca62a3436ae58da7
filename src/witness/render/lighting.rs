//! Thermal lighting factors of a surface point.
//!
//! Without solids a point with normal n sees the sky with (1 + n_y)/2 and the ground with (1 − n_y)/2. A solid k
//! takes from the sky what it covers above the horizontal plane through the point, and from the ground what it
//! covers below:
//!
//! V_sky = (1 + n_y)/2 − Σ_k n·Φ_k,above   V_ground = (1 − n_y)/2 − Σ_k n·Φ_k,below   V_k = n·Φ_k,above + n·Φ_k,below
//!
//! so that ΣV = 1 whatever the shapes. Where bumps turn n, the solid is still cut off at the horizon of the smooth
//! surface. Solids that hide each other count twice; should they then cover more than there is, their shares are
//! scaled down.

use super::factor::{Factor, Polygon};
use super::scene::{Form, GROUND, SKY, SURFACES, Scene};
use super::vector::{Vector, dot};

/// Factors of each surface.
pub(super) type Shares = [f64; SURFACES];
/// Vector form factors of each surface.
pub(super) type Factors = [Factor; SURFACES];

/// A face of a box: axis, whether it is the high one, and its corners.
fn face(low: Vector, high: Vector, axis: usize, upper: bool) -> [Vector; 4] {
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut corners = [low; 4];
    for (corner, (a, b)) in
        corners.iter_mut().zip([(false, false), (true, false), (true, true), (false, true)])
    {
        corner[axis] = if upper { high[axis] } else { low[axis] };
        corner[u] = if a { high[u] } else { low[u] };
        corner[v] = if b { high[v] } else { low[v] };
    }
    corners
}

impl Form {
    /// Adds what a point with the smooth normal `normal` sees of it.
    fn add(&self, point: Vector, normal: Vector, factor: &mut Factor) {
        match *self {
            Self::Cuboid { low, high } => {
                for axis in 0..3 {
                    // Only the faces that the point is before are seen.
                    if point[axis] < low[axis] {
                        factor.add(&Polygon::seen_from(point, face(low, high, axis, false)), normal);
                    } else if point[axis] > high[axis] {
                        factor.add(&Polygon::seen_from(point, face(low, high, axis, true)), normal);
                    }
                }
            }
            Self::Screen { foot, half_width_m, height_m } => {
                let (x, z) = (foot[0] - point[0], foot[2] - point[2]);
                let distance = x.hypot(z);
                if distance == 0.0 {
                    return;
                }
                let side = [half_width_m * z / distance, 0.0, -half_width_m * x / distance];
                let corner = |s: f64, y: f64| [foot[0] + s * side[0], foot[1] + y, foot[2] + s * side[2]];
                let corners =
                    [corner(-1.0, 0.0), corner(1.0, 0.0), corner(1.0, height_m), corner(-1.0, height_m)];
                factor.add(&Polygon::seen_from(point, corners), normal);
            }
        }
    }
}

/// Vector form factors at a point that belongs to light `own`, if any.
pub(super) fn factors(scene: &Scene, point: Vector, smooth: Vector, own: Option<usize>) -> Factors {
    let mut factors = Factors::default();
    for (index, light) in scene.lights.iter().enumerate() {
        if Some(index) != own
            && let Some(factor) = factors.get_mut(light.surface)
        {
            light.form.add(point, smooth, factor);
        }
    }
    factors
}

/// Thermal lighting factors of a surface with `normal`; they add up to 1.
#[inline]
pub(super) fn shares(factors: &Factors, normal: Vector) -> Shares {
    let [sky, ground] = [0.5 * (1.0 + normal[1]), 0.5 * (1.0 - normal[1])];
    let (mut above, mut below) = (Shares::default(), Shares::default());
    let (mut sum_above, mut sum_below) = (0.0, 0.0);
    for k in GROUND + 1..SURFACES {
        above[k] = dot(normal, factors[k].above).max(0.0);
        below[k] = dot(normal, factors[k].below).max(0.0);
        sum_above += above[k];
        sum_below += below[k];
    }
    let kept = |sum: f64, all: f64| if sum > all { all / sum } else { 1.0 };
    let (up, down) = (kept(sum_above, sky), kept(sum_below, ground));
    let mut shares = Shares::default();
    for k in GROUND + 1..SURFACES {
        shares[k] = above[k] * up + below[k] * down;
    }
    shares[SKY] = (sky - sum_above * up).max(0.0);
    shares[GROUND] = (ground - sum_below * down).max(0.0);
    shares
}

/// Factors of every surface averaged over each: `[of][seen]`. The ground is endless and sees the sky alone; the sky
/// is not lit at all.
pub(super) fn mean_shares(scene: &Scene, patches_per_side: usize) -> Vec<Shares> {
    let mut sums = vec![Shares::default(); scene.surfaces.len()];
    let mut areas = vec![0.0; scene.surfaces.len()];
    let mut add = |surface: usize, area: f64, shares: Shares| {
        if let (Some(sum), Some(total)) = (sums.get_mut(surface), areas.get_mut(surface)) {
            *total += area;
            sum.iter_mut().zip(shares).for_each(|(sum, share)| *sum += area * share);
        }
    };
    for solid in &scene.solids {
        for patch in solid.shape.patches(patches_per_side) {
            if !scene.buried(patch.point, patch.normal) {
                let factors = factors(scene, patch.point, patch.normal, Some(solid.light));
                add(solid.surface, patch.area_m2, shares(&factors, patch.normal));
            }
        }
    }
    add(GROUND, 1.0, shares(&Factors::default(), super::vector::UP));
    if let Some((_, surface)) = scene.wall {
        add(surface, 1.0, shares(&Factors::default(), [0.0, 0.0, -1.0]));
    }
    for (sum, area) in sums.iter_mut().zip(areas) {
        if area > 0.0 {
            sum.iter_mut().for_each(|share| *share /= area);
        }
    }
    sums
}

#[cfg(test)]
mod tests;
