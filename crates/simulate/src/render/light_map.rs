//! Vector form factors on the ground, tabulated.
//!
//! They are computed at points of the ground that a camera midway between the two sees, every second row and column (of large pictures
//! fewer) where they bend, every eighth elsewhere, and are linear in its image in between: a function of the place on the ground, and so
//! the same for both cameras.

use super::factor::Factor;
use super::lighting::{Factors, Room, factors};
use super::rig::{Camera, Rig};
use super::scene::{GROUND, Scene};
use super::vector::{UP, Vector, along};
use hadar::error::{Error, Result};
use hadar::parallel;
use rayon::prelude::*;

/// Nodes from one corner of a cell to the next.
const CELL: usize = 4;
/// What lies between corners may be off by so much of all light before it is computed.
const ALIKE: f64 = 1e-5;
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
        map.fill(scene);
        Ok(map)
    }

    /// Computes the nodes: every fourth one; then the middle of each cell between four of these, and all of the cell where that is not
    /// what the four say of it.
    fn fill(&mut self, scene: &Scene) {
        let [rows, columns] = [self.rows, self.columns];
        let is_corner = |row: usize, column: usize| {
            let on = |i: usize, last: usize| i.is_multiple_of(CELL) || i + 1 == last;
            on(row, rows) && on(column, columns)
        };
        let (map, surfaces) = (&*self, self.surfaces);
        let mut nodes = vec![[0.0; 3]; rows * columns * surfaces];
        nodes.par_chunks_mut(surfaces).enumerate().for_each_init(Room::default, |room, (i, node)| {
            hadar::stop::check();
            if is_corner(i / columns, i % columns) {
                map.exact(scene, i / columns, i % columns, room, node);
            }
        });
        let coarse = nodes.clone();
        let [down, across] = [rows, columns].map(|n| (n - 1).div_ceil(CELL));
        let rough: Vec<bool> = parallel::map_with(down * across, Room::default, |room, cell| {
            let [row, column] = [cell / across * CELL + CELL / 2, cell % across * CELL + CELL / 2];
            let [row, column] = [row.min(rows - 1), column.min(columns - 1)];
            let (mut exact, mut guess) = (vec![[0.0; 3]; surfaces], vec![[0.0; 3]; surfaces]);
            map.exact(scene, row, column, room, &mut exact);
            map.between(&coarse, row, column, &mut guess);
            exact.iter().flatten().zip(guess.iter().flatten()).any(|(a, b)| (a - b).abs() > ALIKE)
        });
        let in_rough = |row: usize, column: usize| {
            // A node on an edge is of two cells.
            let cells = |i: usize, last: usize| [i.saturating_sub(1) / CELL, (i / CELL).min(last - 1)];
            cells(row, down).iter().any(|y| cells(column, across).iter().any(|x| rough[y * across + x]))
        };
        nodes.par_chunks_mut(surfaces).enumerate().for_each_init(Room::default, |room, (i, node)| {
            hadar::stop::check();
            let (row, column) = (i / columns, i % columns);
            if is_corner(row, column) {
                return;
            }
            if in_rough(row, column) {
                map.exact(scene, row, column, room, node);
            } else {
                map.between(&coarse, row, column, node);
            }
        });
        self.nodes = nodes;
    }

    /// What a node of the ground sees.
    fn exact(&self, scene: &Scene, row: usize, column: usize, room: &mut Room, node: &mut [Vector]) {
        hadar::stop::check();
        let [row, column] = [row, column].map(|i| i as f64 * self.step);
        let direction = self.camera.direction(self.first[0] + column, self.first[1] + row);
        if direction[1] >= 0.0 {
            return;
        }
        let mut point = along(self.camera.origin, -self.camera.origin[1] / direction[1], direction);
        point[1] = 0.0;
        if point.iter().all(|x| x.is_finite()) {
            let factors = factors(scene, point, UP, None, room);
            node.iter_mut().zip(&factors[GROUND + 1..]).for_each(|(to, factor)| *to = factor.above);
        }
    }

    /// The same from the corners of its cell.
    fn between(&self, corners: &[Vector], row: usize, column: usize, node: &mut [Vector]) {
        let ends = |i: usize, count: usize| {
            let low = i / CELL * CELL;
            let high = (low + CELL).min(count - 1);
            (low, high, if high > low { (i - low) as f64 / (high - low) as f64 } else { 0.0 })
        };
        let ((up, low, t), (left, right, s)) = (ends(row, self.rows), ends(column, self.columns));
        let four = [
            ((1.0 - s) * (1.0 - t), up, left),
            (s * (1.0 - t), up, right),
            ((1.0 - s) * t, low, left),
            (s * t, low, right),
        ];
        for (k, to) in node.iter_mut().enumerate() {
            *to = four.iter().fold([0.0; 3], |sum, (weight, row, column)| {
                let at = (row * self.columns + column) * self.surfaces + k;
                corners.get(at).map_or(sum, |phi| along(sum, *weight, *phi))
            });
        }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::StreetSpec;

    #[test]
    fn between_its_nodes_the_map_is_what_the_ground_sees() {
        let scene = Scene::street(&StreetSpec::default()).unwrap();
        let rig = Rig::default();
        let map = LightMap::new(&scene, &rig).unwrap();
        let mut room = Room::default();
        let mut errors = Vec::new();
        for i in 0..4000 {
            let at = |step: f64, low: f64, high: f64| low + (high - low) * (f64::from(i) * step).fract();
            let direction = map.camera.direction(at(0.618_034, 0.0, 640.0), at(0.414_214, 150.0, 479.0));
            let mut point = along(map.camera.origin, -map.camera.origin[1] / direction[1], direction);
            point[1] = 0.0;
            let exact = factors(&scene, point, UP, None, &mut room);
            let found = map.at(point);
            let off = exact.iter().zip(&found).map(|(a, b)| (a.above[1] - b.above[1]).abs());
            errors.push(off.fold(0.0, f64::max));
        }
        errors.sort_by(f64::total_cmp);
        // Where things stand on the ground light ends between two nodes, and straight lines are off by more.
        let [half, most, nearly_all] = [errors[2000], errors[3600], errors[3920]];
        assert!(half < 1e-5 && most < 3e-4 && nearly_all < 6e-3, "{half} {most} {nearly_all}");
    }
}
