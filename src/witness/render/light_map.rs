//! Vector form factors on the ground, tabulated.
//!
//! They are computed at the points of the ground that a camera midway between the two sees at every `step`-th row and
//! column, and are linear in its image in between: a function of the place on the ground, and so the same
//! for both cameras.

use super::factor::Factor;
use super::lighting::{Factors, Room, factors};
use super::rig::{Camera, Rig};
use super::scene::{GROUND, Scene};
use super::vector::{UP, Vector, along};
use crate::error::{Error, Result};
use rayon::prelude::*;

/// Pixels between nodes.
const STEP: f64 = 2.0;
/// More nodes than this are thinned out,
const MAX_NODES: f64 = 4e5;
/// but not further than this, pixels.
const WIDEST_STEP: f64 = 64.0;

#[derive(Debug)]
pub(super) struct LightMap {
    camera: Camera,
    step: f64,
    first: [f64; 2],
    columns: usize,
    rows: usize,
    /// Surfaces beyond the ground.
    surfaces: usize,
    /// Φ above the horizon of each of them, `[row][column][surface]`.
    nodes: Vec<Vector>,
}

impl LightMap {
    /// # Errors
    /// Cameras so far apart that the ground between what they see is a map without end.
    pub(super) fn new(scene: &Scene, rig: &Rig) -> Result<Self> {
        let camera = rig.camera(0.0);
        let mut map =
            Self { camera, step: STEP, first: [0.0; 2], columns: 0, rows: 0, surfaces: 0, nodes: Vec::new() };
        map.surfaces = scene.surfaces.len().saturating_sub(GROUND + 1);
        // The nearest ground, at the lowest row, is displaced the most.
        let lowest = camera.direction(0.0, rig.rows as f64);
        if lowest[1] >= 0.0 || scene.wall.is_some() || scene.solids.is_empty() {
            return Ok(map);
        }
        let depth = rig.height_m / -lowest[1];
        let margin = 0.5 * rig.disparity_px(depth) + 4.0;
        let (across, down) = (rig.columns as f64 + 2.0 * margin, rig.rows as f64 + 8.0);
        map.step = STEP.max((across * down / MAX_NODES).sqrt());
        if map.step > WIDEST_STEP {
            let most = WIDEST_STEP * WIDEST_STEP * MAX_NODES / down;
            let expected = format!(
                "at most {:.0e} pixels: a shorter baseline, a shorter focal length or larger pixels",
                0.5 * most
            );
            let quantity = "disparity of the nearest ground";
            return Err(Error::out_of_range(quantity, rig.disparity_px(depth), "pixels", expected));
        }
        map.first = [-margin, -4.0];
        map.columns = (across / map.step).ceil() as usize + 1;
        map.rows = (down / map.step).ceil() as usize + 1;
        map.nodes = vec![[0.0; 3]; map.rows * map.columns * map.surfaces];
        let (columns, first, step) = (map.columns, map.first, map.step);
        map.nodes.par_chunks_mut(map.surfaces).enumerate().for_each_init(Room::default, |room, (i, node)| {
            let [row, column] = [i / columns, i % columns].map(|i| i as f64 * step);
            let direction = camera.direction(first[0] + column, first[1] + row);
            if direction[1] >= 0.0 {
                return;
            }
            let mut point = along(camera.origin, -camera.origin[1] / direction[1], direction);
            point[1] = 0.0;
            if point.iter().all(|x| x.is_finite()) {
                let factors = factors(scene, point, UP, None, room);
                node.iter_mut().zip(&factors[GROUND + 1..]).for_each(|(to, factor)| *to = factor.above);
            }
        });
        Ok(map)
    }

    /// Vector form factors at a point of the ground; none beyond the map.
    #[inline]
    pub(super) fn at(&self, point: Vector) -> Factors {
        let mut factors = Factors::default();
        let Some([column, row, _]) = self.camera.project(point) else { return factors };
        let (u, v) = ((column - self.first[0]) / self.step, (row - self.first[1]) / self.step);
        if !(u >= 0.0 && v >= 0.0) {
            return factors;
        }
        let (i, j) = (u as usize, v as usize);
        if i + 1 >= self.columns || j + 1 >= self.rows {
            return factors;
        }
        let (s, t) = (u - i as f64, v - j as f64);
        let (upper, lower) = (j * self.columns + i, (j + 1) * self.columns + i);
        let corners = [
            ((1.0 - s) * (1.0 - t), upper),
            (s * (1.0 - t), upper + 1),
            ((1.0 - s) * t, lower),
            (s * t, lower + 1),
        ];
        for (weight, place) in corners {
            let Some(node) = self.nodes.get(place * self.surfaces..(place + 1) * self.surfaces) else {
                continue;
            };
            for (Factor { above, .. }, phi) in factors.iter_mut().skip(GROUND + 1).zip(node) {
                *above = along(*above, weight, *phi);
            }
        }
        factors
    }
}
