//! Thermal lighting factors of a surface point.
//!
//! Without solids a point with normal n sees the sky with (1 + n_y)/2 and the ground with (1 − n_y)/2. A solid k
//! takes from the sky what it covers above the horizontal plane through the point, and from the ground what it
//! covers below:
//!
//! V_sky = (1 + n_y)/2 − Σ_k n·Φ_k,above   V_ground = (1 − n_y)/2 − Σ_k n·Φ_k,below   V_k = n·Φ_k,above + n·Φ_k,below
//!
//! so that ΣV = 1 whatever the shapes. Where bumps turn n, the solid is still cut off at the horizon of the smooth
//! surface; should solids then cover more than there is, their shares are scaled down. Of two solids in one direction the nearer one is
//! seen: what it hides is cut out of the outline of the other (convex solids that do not reach into each other have one order).

use super::factor::{Cone, Factor, Polygon};
use super::scene::{GROUND, SKY, SURFACES, Scene};
use super::vector::{Vector, dot, subtract};
use hadar::parallel;

/// Factors of each surface.
pub(super) type Shares = [f64; SURFACES];
/// Vector form factors of each surface.
pub(super) type Factors = [Factor; SURFACES];

/// Solids before a polygon of which what they cover together is counted in and out, 2^n polygons; of more the polygon is cut first.
const FEW: u32 = 3;

/// Vector form factors at a point with the smooth normal `smooth` that belongs to the solid `own`, if any.
pub(super) fn factors(
    scene: &Scene,
    point: Vector,
    smooth: Vector,
    own: Option<usize>,
    room: &mut Room,
) -> Factors {
    let seen = &mut room.seen;
    seen.clear();
    for (index, solid) in scene.solids.iter().enumerate() {
        let bounds = solid.shape.bounds();
        if Some(index) != own
            && reaches_before(bounds, point, smooth)
            && let Some(mut outline) = solid.shape.outline(point)
            && outline.keep(smooth)
        {
            seen.push(Seen { index, bounds, cone: outline.cone(), outline, hidden_by: 0 });
        }
    }
    for i in 1..seen.len() {
        let (before, rest) = seen.split_at_mut(i);
        let Some(here) = rest.first_mut() else { break };
        for (j, there) in before.iter_mut().enumerate() {
            let nearer = match may_hide(here.bounds, there.bounds, point) {
                [false, false] => continue,
                _ if !here.cone.meets(&there.cone) => continue,
                _ if here.outline.is_parted(&there.outline) => continue,
                [nearer, farther] if nearer != farther => nearer,
                _ => {
                    let Some(both) = here.outline.overlap(&there.outline) else { continue };
                    scene.is_nearer(here.index, there.index, point, both.middle())
                }
            };
            if nearer {
                there.hidden_by |= 1 << i;
            } else {
                here.hidden_by |= 1 << j;
            }
        }
    }
    let mut factors = Factors::default();
    for solid in seen.iter() {
        if let Some(factor) = scene.solids.get(solid.index).and_then(|own| factors.get_mut(own.surface)) {
            add_seen(seen, &solid.outline, solid.hidden_by, 1.0, factor);
        }
    }
    factors
}

/// Adds `sign` times what the solids `before` (bits by their place in `seen`) leave of a polygon.
fn add_seen(seen: &[Seen], polygon: &Polygon, before: u32, sign: f64, factor: &mut Factor) {
    let Some(first) = seen.get(before.trailing_zeros() as usize) else {
        factor.add(polygon, sign);
        return;
    };
    let others = before & (before - 1);
    let before_part = |part: &Polygon| {
        let hides = |(i, other): &(usize, &Seen)| others >> i & 1 == 1 && !part.is_beside(&other.outline);
        seen.iter().enumerate().filter(hides).fold(0, |bits, (i, _)| bits | 1_u32 << i)
    };
    if before.count_ones() > FEW {
        let mut add = |piece: &Polygon| add_seen(seen, piece, before_part(piece), sign, factor);
        polygon.minus(&first.outline, &mut add);
        return;
    }
    add_seen(seen, polygon, others, sign, factor);
    if let Some(both) = polygon.overlap(&first.outline) {
        add_seen(seen, &both, before_part(&both), -sign, factor);
    }
}

/// Lowest and highest coordinates.
type Bounds = [Vector; 2];

/// Whether some of a box is before the plane through a point with this normal.
#[inline]
fn reaches_before([low, high]: Bounds, point: Vector, normal: Vector) -> bool {
    let furthest: Vector = std::array::from_fn(|i| if normal[i] > 0.0 { high[i] } else { low[i] });
    dot(subtract(furthest, point), normal) > 0.0
}

/// Whether what is in the one box may hide what is in the other, and the other way round: what is beyond a plane between them hides
/// nothing on the point's side of it.
#[inline]
fn may_hide(one: Bounds, other: Bounds, point: Vector) -> [bool; 2] {
    let mut may = [true; 2];
    for (i, at) in point.into_iter().enumerate() {
        for (k, (near, far)) in [(one, other), (other, one)].into_iter().enumerate() {
            if near[1][i] <= far[0][i] {
                may[k] &= at < near[1][i];
                may[1 - k] &= at > far[0][i];
            }
        }
    }
    may
}

/// A solid as it is seen from the point in work.
#[derive(Debug)]
struct Seen {
    index: usize,
    bounds: Bounds,
    outline: Polygon,
    cone: Cone,
    /// The solids before it, as bits by their place among those that are seen.
    hidden_by: u32,
}

/// Memory that is used again from point to point.
#[derive(Debug, Default)]
pub(super) struct Room {
    seen: Vec<Seen>,
}

impl Scene {
    /// Whether the first of two solids is before the other one in a direction in which both are seen.
    fn is_nearer(&self, first: usize, second: usize, point: Vector, direction: Vector) -> bool {
        let distance = |index: usize| {
            self.solids.get(index).map_or(f64::INFINITY, |solid| {
                // At the rim an outline of few corners reaches a little beyond the solid.
                let beside =
                    || dot(subtract(solid.shape.middle(), point), direction) / dot(direction, direction);
                solid.shape.hit(point, direction).unwrap_or_else(beside)
            })
        };
        distance(first) < distance(second)
    }
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
    for (index, solid) in scene.solids.iter().enumerate() {
        let patches = solid.shape.patches(patches_per_side);
        let shared: Vec<Option<(f64, Shares)>> =
            parallel::map_with(patches.len(), Room::default, |room, i| {
                let patch = &patches[i];
                let seen = || {
                    let factors = factors(scene, patch.point, patch.normal, Some(index), room);
                    (patch.area_m2, shares(&factors, patch.normal))
                };
                (!scene.buried(patch.point, patch.normal)).then(seen)
            });
        shared.into_iter().flatten().for_each(|(area, shares)| add(solid.surface, area, shares));
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
