//! Surfaces and solids, and what a ray meets among them.

use super::rig::Rig;
use super::shape::Shape;
use super::surface::Surface;
use super::vector::{Vector, along};
use hadar::error::{Error, Result, check};

/// Place of the sky among the surfaces.
pub(super) const SKY: usize = 0;
/// Place of the ground among the surfaces.
pub(super) const GROUND: usize = 1;
/// Most surfaces of a scene.
pub(super) const SURFACES: usize = 12;

/// A solid that rays meet.
#[derive(Debug, Clone)]
pub(super) struct Solid {
    pub(super) shape: Shape,
    pub(super) surface: usize,
}

/// A scene: sky, ground, and what stands on it or before it.
#[derive(Debug, Clone)]
pub struct Scene {
    /// Sky, ground and the others.
    pub(super) surfaces: Vec<Surface>,
    pub(super) solids: Vec<Solid>,
    /// Distance of an endless wall across z, and its surface; the ground before it is not seen.
    pub(super) wall: Option<(f64, usize)>,
}

/// What a ray meets first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Target {
    Sky,
    Ground,
    Wall(usize),
    Solid(usize),
}

impl Scene {
    /// The surfaces, in the order of [`View::surface`](super::View::surface) and
    /// [`View::lighting`](super::View::lighting): sky, ground, then the others.
    #[must_use]
    pub fn surfaces(&self) -> &[Surface] {
        &self.surfaces
    }

    /// Checks the surfaces and that no camera is inside a solid or behind the wall.
    pub(super) fn check(&self, rig: &Rig) -> Result<()> {
        self.surfaces.iter().try_for_each(Surface::check)?;
        for camera in [rig.camera(-0.5), rig.camera(0.5)] {
            if let Some(solid) = self.solids.iter().find(|solid| solid.shape.contains(camera.origin)) {
                let name = self.surfaces.get(solid.surface).map_or("solid", |surface| &surface.name);
                let found = format!("a camera is inside the surface `{name}`");
                return Err(Error::malformed(
                    found,
                    "move the object away from x = 0, z = 0 or change its size",
                ));
            }
        }
        if let Some((distance_m, _)) = self.wall {
            check::positive("distance of the wall", distance_m, "m")?;
        }
        Ok(())
    }

    /// What the ray meets first among sky, ground or wall and the solids whose bits are set, and at which t.
    #[inline]
    pub(super) fn hit(&self, origin: Vector, direction: Vector, solids: u32) -> (f64, Target) {
        let mut nearest = (f64::INFINITY, Target::Sky);
        if let Some((distance_m, surface)) = self.wall {
            if direction[2] > 0.0 {
                nearest = ((distance_m - origin[2]) / direction[2], Target::Wall(surface));
            }
        } else if direction[1] < 0.0 {
            let t = -origin[1] / direction[1];
            // Beyond any number is the horizon.
            if t.is_finite() {
                nearest = (t, Target::Ground);
            }
        }
        let mut left = solids;
        while left != 0 {
            let index = left.trailing_zeros() as usize;
            left &= left - 1;
            let Some(solid) = self.solids.get(index) else { continue };
            if let Some(t) = solid.shape.hit(origin, direction)
                && t < nearest.0
            {
                nearest = (t, Target::Solid(index));
            }
        }
        nearest
    }

    /// Surface of a target.
    #[inline]
    pub(super) fn surface_of(&self, target: Target) -> usize {
        match target {
            Target::Sky => SKY,
            Target::Ground => GROUND,
            Target::Wall(surface) => surface,
            Target::Solid(index) => self.solids[index].surface,
        }
    }

    /// Normal of a target's surface without bumps.
    #[inline]
    pub(super) fn smooth_normal(&self, target: Target, point: Vector) -> Vector {
        match target {
            Target::Sky | Target::Ground => super::vector::UP,
            Target::Wall(_) => [0.0, 0.0, -1.0],
            Target::Solid(index) => self.solids[index].shape.normal(point),
        }
    }

    /// Whether a point just above a surface is inside another solid or below the ground.
    pub(super) fn buried(&self, point: Vector, normal: Vector) -> bool {
        let outside = along(point, 1e-6, normal);
        outside[1] < 0.0 || self.solids.iter().any(|solid| solid.shape.contains(outside))
    }
}
