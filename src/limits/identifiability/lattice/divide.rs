//! Deciding a box of counts by halving it until every part is decided.
//!
//! In a box the state that is the likeliest at the middle strikes out every state that is less likely than
//! it everywhere in the box. States of one surface left: the whole box is decided. One cell left: it is
//! decided at its middle. Boxes are halved along the axis that is the longest in standard deviations. The
//! first 64 boxes are spread over the threads and added up in their order, so the result does not depend on
//! the number of threads.

use super::counts::Axis;
use super::detector::MAX_BANDS;
use super::surface::{Likelihood, Surfaces};
use crate::parallel;
use crate::sum::Compensated;

/// Boxes that are spread over the threads.
const BOXES: usize = 64;

/// First cell and the one after the last, along every band; bands that are not there have one cell.
type Box3 = [[usize; 2]; MAX_BANDS];

pub(super) struct Division<'a> {
    pub(super) axes: &'a [Axis],
    pub(super) surfaces: &'a Surfaces,
}

/// Probability of each surface, and of the cells that a boundary crosses.
pub(super) struct Decided {
    pub(super) shares: Vec<f64>,
    pub(super) undecided: f64,
}

/// [`Decided`] while it is being added up.
#[derive(Clone)]
struct Tally {
    shares: Vec<Compensated>,
    undecided: Compensated,
}

impl Division<'_> {
    pub(super) fn decide(&self) -> Decided {
        let all: Vec<Likelihood> = self.surfaces.likelihoods.clone();
        let empty = Tally {
            shares: vec![Compensated::default(); self.surfaces.members.len()],
            undecided: Compensated::default(),
        };
        let boxes = self.first_boxes();
        let parts: Vec<Tally> = parallel::map(boxes.len(), |i| {
            let mut tally = empty.clone();
            self.divide(boxes[i], &all, &mut tally);
            tally
        });
        let add = |values: &mut dyn Iterator<Item = Compensated>| {
            let mut sum = Compensated::default();
            values.for_each(|value| sum.add(value.value()));
            sum.value()
        };
        let surfaces = 0..self.surfaces.members.len();
        Decided {
            shares: surfaces.map(|i| add(&mut parts.iter().map(|part| part.shares[i]))).collect(),
            undecided: add(&mut parts.iter().map(|part| part.undecided)),
        }
    }

    fn first_boxes(&self) -> Vec<Box3> {
        let whole = std::array::from_fn(|w| [0, self.axes.get(w).map_or(1, Axis::len)]);
        let mut boxes = vec![whole];
        while boxes.len() < BOXES {
            let halves: Vec<Box3> = boxes.iter().flat_map(|cells| self.halves(cells)).flatten().collect();
            if halves.len() <= boxes.len() {
                break;
            }
            boxes = halves;
        }
        boxes
    }

    /// The two halves of a box, or itself if it is a single cell.
    fn halves(&self, cells: &Box3) -> [Option<Box3>; 2] {
        let length = |w: usize| {
            let [from, to] = cells[w];
            self.axes.get(w).filter(|_| to - from > 1).map_or(0.0, |axis| axis.deviations(to - from))
        };
        let longest = (0..MAX_BANDS).fold(0, |best, w| if length(w) > length(best) { w } else { best });
        let [from, to] = cells[longest];
        if to - from < 2 {
            return [Some(*cells), None];
        }
        let middle = from.midpoint(to);
        let part = |range| {
            let mut part = *cells;
            part[longest] = range;
            Some(part)
        };
        [part([from, middle]), part([middle, to])]
    }

    fn divide(&self, cells: Box3, candidates: &[Likelihood], tally: &mut Tally) {
        crate::stop::check();
        let mass: f64 = self.axes.iter().zip(&cells).map(|(axis, &[from, to])| axis.mass(from, to)).product();
        let mut extent = [[0.0; 2]; MAX_BANDS];
        for ((axis, &[from, to]), extent) in self.axes.iter().zip(&cells).zip(&mut extent) {
            *extent = axis.extent(from, to);
        }
        let middle = extent.map(|[low, high]| 0.5 * (low + high));
        let Some(best) = likeliest(candidates, &middle) else { return };
        let left: Vec<Likelihood> =
            candidates.iter().filter(|state| !state.is_below(&best, &extent)).copied().collect();
        if left.iter().all(|state| state.surface == best.surface) {
            tally.shares[best.surface as usize].add(mass);
            return;
        }
        match self.halves(&cells) {
            [Some(first), Some(second)] => {
                self.divide(first, &left, tally);
                self.divide(second, &left, tally);
            }
            _ => self.settle(&cells, mass, &extent, &left, tally),
        }
    }

    /// Decides one cell at its middle; materials that are equally likely share it.
    fn settle(
        &self,
        cells: &Box3,
        mass: f64,
        extent: &[[f64; 2]; MAX_BANDS],
        candidates: &[Likelihood],
        tally: &mut Tally,
    ) {
        let mut x = [0.0; MAX_BANDS];
        for ((axis, &[cell, _]), x) in self.axes.iter().zip(cells).zip(&mut x) {
            *x = axis.middle(cell);
        }
        let Some(best) = likeliest(candidates, &x) else { return };
        let most = best.at(&x);
        let mut tied: Vec<u32> =
            candidates.iter().filter(|state| state.at(&x) == most).map(|state| state.surface).collect();
        tied.sort_unstable();
        tied.dedup();
        let members = |surface: u32| self.surfaces.members[surface as usize].len() as f64;
        let total: f64 = tied.iter().map(|&surface| members(surface)).sum();
        for surface in tied {
            tally.shares[surface as usize].add(mass * members(surface) / total);
        }
        if extent.iter().any(|[low, high]| low < high) {
            tally.undecided.add(mass);
        }
    }
}

/// The likeliest state at counts x; the first of several.
fn likeliest(candidates: &[Likelihood], x: &[f64; MAX_BANDS]) -> Option<Likelihood> {
    let mut best: Option<(f64, &Likelihood)> = None;
    for state in candidates {
        let value = state.at(x);
        if best.is_none_or(|(most, _)| value > most) {
            best = Some((value, state));
        }
    }
    best.map(|(_, state)| *state)
}
