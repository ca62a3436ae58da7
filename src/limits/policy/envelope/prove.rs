//! The worst case from below: branch and bound over the scenes and the alternative's states together.
//!
//! Boxes wait in the order of their bounds; the lowest ones are halved, a batch at a time, until none is below
//! (1 − tolerance) times the distance attained, or as many have been looked at as are allowed. What is then proved is
//! the least bound of all boxes ever left aside or waiting. The batches do not depend on the number of
//! threads. Where the lowest box promises a scene below the best one known, a descent from it is tried.

use super::attain::{self, Attained};
use super::cell::Cell;
use super::cube::Cube;
use super::joint::Residual;
use super::linear::SOURCES;
use super::model::{self, Model, Point, Region};
use super::node::Node;
use super::partition::partition;
use super::ranges::Ranges;
use crate::best_first::BestFirst;
use crate::error::Result;
use crate::parallel;
use rayon::prelude::*;

/// A descent is tried in every one of the first so many batches, and in every so many later.
const EVERY: u64 = 8;
/// Boxes halved together.
const BATCH: usize = 2048;

/// How much is done for a proof.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Effort {
    /// How far below the distance attained the proved bound may be, as a share of it.
    pub relative_tolerance: f64,
    /// Boxes of the branch and bound at most; with 0 there is no proof.
    pub boxes: u64,
}

impl Default for Effort {
    /// 1 %, and some seconds on two cores at most.
    fn default() -> Self {
        Self { relative_tolerance: 0.01, boxes: 1_000_000 }
    }
}

/// What has come of an attempt.
pub(super) struct Proof {
    pub(super) lower_bound: f64,
    pub(super) boxes: u64,
    pub(super) attained: Attained,
}

/// The queue, the oldest of equal bounds first, and the bound from which on a box is left aside.
struct Search<'m, 'a> {
    model: &'m Model<'a>,
    cells: Vec<Cell>,
    queue: BestFirst<Cube>,
    threshold: f64,
}

/// A lower bound of the distance over an envelope in which `attained` is known to be.
pub(super) fn prove(
    joint: &(Model<'_>, Region),
    ranges: &Ranges,
    effort: &Effort,
    best: &Residual,
    mut attained: Attained,
) -> Result<Proof> {
    // A little more than asked for, so that a bound rounded down does not miss it.
    let share = 1.0 - 0.999 * effort.relative_tolerance;
    let (model, whole) = joint;
    let threshold = share * attained.distance;
    let parts = partition(model, whole.clone(), attained.distance);
    let distance = attained.distance;
    let cells: Vec<Cell> = parallel::map(parts.len(), |i| Cell::new(model, &parts[i], best, distance));
    let mut search = Search { model, cells, queue: BestFirst::new(effort.boxes), threshold };
    // What cells leave out is not below the distance attained.
    search.queue.leave(distance);
    let roots = (0..search.cells.len()).filter_map(|cell| search.root(cell)).collect();
    search.take_in(roots);
    let mut round = 0;
    while search.queue.lowest().is_some() {
        // Along a stretch of distances there is nothing to attain.
        let tried = model.along.is_none() && (round < EVERY || round % EVERY == 0);
        let promising = if tried { search.lowest() } else { None };
        if let Some(start) = promising {
            let below = attained.distance * (1.0 - 1e-6);
            let (better, evaluations) = attain::attain_from(joint, ranges, start, below)?;
            attained.evaluations += evaluations;
            if let Some(better) = better {
                attained = Attained { evaluations: attained.evaluations, ..better };
                search.threshold = share * attained.distance;
            }
        }
        round += 1;
        search.advance();
    }
    let lower_bound = search.queue.bound().min(attained.distance);
    Ok(Proof { lower_bound, boxes: search.queue.looked_at(), attained })
}

impl Search<'_, '_> {
    fn root(&self, index: usize) -> Option<Cube> {
        let cell = &self.cells[index];
        let factors = model::factors(&cell.region);
        let mut cube = Cube { cell: index as u32, nodes: [0; SOURCES], factors, bound: 0.0, split: None };
        cell.clamp(self.model, &mut cube).then_some(cube)
    }

    /// Bounds new boxes, and queues those that are not beyond the threshold.
    fn take_in(&mut self, mut cubes: Vec<Cube>) {
        let (cells, model) = (&self.cells, self.model);
        cubes.par_iter_mut().with_min_len(64).for_each(|cube| cells[cube.cell as usize].bound(model, cube));
        for cube in cubes {
            let age = self.queue.look();
            if cube.bound >= self.threshold || cube.split.is_none() {
                self.queue.leave(cube.bound);
            } else {
                self.queue.push(cube.bound, age, cube);
            }
        }
    }

    /// Halves the lowest boxes.
    fn advance(&mut self) {
        let lowest = std::iter::from_fn(|| self.queue.take(|_| false)).take(BATCH);
        let batch: Vec<Cube> = lowest.map(|(_, cube)| cube).collect();
        self.halve_intervals(&batch);
        let halves = batch.iter().flat_map(|cube| self.halves(cube)).flatten().collect();
        self.take_in(halves);
    }

    /// Makes sure that the halves of all intervals to be halved are known.
    fn halve_intervals(&mut self, batch: &[Cube]) {
        let mut wanted: Vec<(u32, usize, u32)> = batch
            .iter()
            .filter_map(|cube| {
                let split = cube.split.filter(|split| split % 3 == 0)?;
                let (s, node) = (split / 3, cube.nodes[split / 3]);
                let known = self.cells[cube.cell as usize].sources[s][node as usize].halves;
                known.is_none().then_some((cube.cell, s, node))
            })
            .collect();
        wanted.sort_unstable();
        wanted.dedup();
        let (cells, model) = (&self.cells, self.model);
        let made: Vec<[Node; 2]> = parallel::map(wanted.len(), |i| {
            let (cell, s, node) = wanted[i];
            cells[cell as usize].halve(model, s, node)
        });
        for ((cell, s, node), halves) in wanted.into_iter().zip(made) {
            let nodes = &mut self.cells[cell as usize].sources[s];
            nodes[node as usize].halves = Some(nodes.len() as u32);
            nodes.extend(halves);
        }
    }

    /// The two halves of a box, without what lies beyond the distance attained and what relations exclude.
    fn halves(&self, cube: &Cube) -> [Option<Cube>; 2] {
        let Some(split) = cube.split else { return [None, None] };
        let cell = &self.cells[cube.cell as usize];
        [0, 1].map(|half: usize| {
            let mut part = cube.clone();
            if split % 3 == 0 {
                let s = split / 3;
                part.nodes[s] = cell.sources[s][cube.nodes[s] as usize].halves? + half as u32;
            } else {
                let range = &mut part.factors[split];
                range[1 - half] = 0.5 * (range[0] + range[1]);
            }
            cell.clamp(self.model, &mut part).then_some(part)
        })
    }

    /// The middle of the lowest box.
    fn lowest(&self) -> Option<Point> {
        let (_, cube) = self.queue.lowest()?;
        let cell = &self.cells[cube.cell as usize];
        let middle = |[low, high]: [f64; 2]| 0.5 * (low + high);
        let mut values = [[0.0; 3]; SOURCES];
        for (s, value) in values.iter_mut().enumerate().take(cell.sources.len()) {
            let [low, high] = cell.node_of(cube, s).t;
            let (own, other) = (cube.factors[3 * s + 1], cube.factors[3 * s + 2]);
            *value = [(low * high).sqrt(), middle(own), middle(other)];
        }
        Some(Point { values })
    }
}
