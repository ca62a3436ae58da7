//! Distances of the states of a prior, the probability that they make on average, and the photons at which that is met.

use super::prior::{self, Node};
use super::stack::{MAX_STACK, Pair};
use crate::error::Result;
use crate::fisher::{Counting, Unknowns};
use crate::identifiability::detection;
use crate::identifiability::local::LocalSolver;
use crate::identifiability::nearest::{NearestSolver, StateRange};
use crate::parallel;
use crate::root::crossing;
use crate::scene::Surroundings;
use crate::spectrum::Bands;
use crate::sum::Compensated;

/// Photon numbers between e^−69 and e^69 are searched, 10⁻³⁰ to 10³⁰.
pub(super) const LOG_PHOTONS: f64 = 69.0;
/// Steps of that search, and states that are looked at before progress is told.
const STEPS: usize = 60;
const TOGETHER: usize = 64;

/// Which distance of a state its detection probability is taken from. A prior counts in it as one more
/// reading, centred at that state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Distances {
    /// The paper's local distance.
    Local,
    /// The nearest distance, over this range of the alternative's state.
    Nearest(StateRange),
}

/// Which states stand for the priors.
#[derive(Debug, Clone, Copy)]
pub(super) enum States {
    /// Lattices of so many states each.
    Lattices(usize),
    /// A product rule of this order, held against one of half the order.
    Product(usize),
}

/// An average over states, and what was last found of them.
pub(super) struct Average<'b> {
    pub(super) bands: &'b Bands,
    pub(super) surroundings: &'b Surroundings,
    pub(super) unknowns: &'b Unknowns,
    pub(super) pair: Pair<'b>,
    pub(super) distances: Distances,
    pub(super) progress: &'b dyn Fn(usize, usize),
    /// ΣS of the nominal state.
    pub(super) total: f64,
    /// The states, one part after the other: lattices, or the product rule and that of half its order.
    pub(super) nodes: Vec<Node>,
    /// Where each part ends, and what share of the mean it has.
    pub(super) ends: Vec<(usize, f64)>,
    /// d of every state.
    pub(super) found: Vec<f64>,
    pub(super) looked: usize,
    /// Twice the power of N that the distances grow with, about where the photons are sought.
    pub(super) share: Option<f64>,
}

/// Where a share of wrong decisions is met.
#[derive(Debug, Clone, Copy)]
pub(super) struct Met {
    /// ln N.
    pub(super) log: f64,
    /// The shift that meets it from the photons of the last look, were the distances √N times a constant.
    pub(super) shift: f64,
}

impl Average<'_> {
    /// Takes other states.
    pub(super) fn take(&mut self, states: States) -> Result<()> {
        let (unknowns, state) = (self.unknowns, self.pair.state);
        let (parts, rule) = match states {
            States::Lattices(points) => (prior::lattices(unknowns, state, points)?, false),
            States::Product(order) => {
                let product = |order| prior::product(unknowns, state, order, MAX_STACK);
                (vec![product(order)?, product(order / 2)?], true)
            }
        };
        let filled = parts.iter().filter(|part| !part.is_empty()).count();
        self.nodes.clear();
        self.ends.clear();
        for (i, part) in parts.into_iter().enumerate().filter(|part| !part.1.is_empty()) {
            self.nodes.extend(part);
            let share = if rule { f64::from(u8::from(i == 0)) } else { 1.0 / filled as f64 };
            self.ends.push((self.nodes.len(), share));
        }
        Ok(())
    }

    /// Finds the distance of every state when the nominal one sends `photons`.
    pub(super) fn look(&mut self, photons: f64) -> Result<()> {
        let Self { bands, surroundings, unknowns, .. } = *self;
        let (own, other) = (self.pair.emissivity, self.pair.alternative);
        let counting = Counting { counts_per_radiance: photons / self.total, var_added: Vec::new() };
        self.found.clear();
        for nodes in self.nodes.chunks(TOGETHER) {
            let nodes_found: Result<Vec<f64>> = match self.distances {
                Distances::Local => parallel::try_map_with(
                    nodes.len(),
                    || LocalSolver::new(bands, surroundings, unknowns.clone()),
                    |solver, i| Ok(solver.with_counting(own, other, &nodes[i].state, &counting)?.distance),
                ),
                Distances::Nearest(range) => parallel::try_map_with(
                    nodes.len(),
                    || NearestSolver::new(bands, surroundings, unknowns.clone(), range),
                    |solver, i| Ok(solver.with_counting(own, other, &nodes[i].state, &counting)?.distance),
                ),
            };
            self.found.extend(nodes_found?);
            let left = self.nodes.len() - self.found.len();
            self.looked += nodes.len();
            (self.progress)(self.looked, self.looked + left);
        }
        Ok(())
    }

    /// Share of wrong decisions of each part, with e^shift times the photons.
    fn misses(&self, shift: f64) -> impl Iterator<Item = f64> {
        let factor = (0.5 * shift).exp();
        let starts = std::iter::once(0).chain(self.ends.iter().map(|end| end.0));
        starts.zip(&self.ends).map(move |(start, (end, _))| {
            // In the order of the nodes, so that the number of threads changes no bit.
            let mut sum = Compensated::default();
            for (node, distance) in self.nodes[start..*end].iter().zip(&self.found[start..*end]) {
                sum.add(node.weight * detection::miss_probability(factor * distance));
            }
            sum.value()
        })
    }

    /// Share of wrong decisions on average, with e^shift times the photons of the last look.
    pub(super) fn miss(&self, shift: f64) -> f64 {
        self.misses(shift).zip(&self.ends).map(|(miss, (_, share))| share * miss).sum()
    }

    /// Three deviations of it by the scatter of the parts and what may stand between the states, or for a product rule the
    /// change from half the order.
    pub(super) fn error(&self, shift: f64) -> f64 {
        if self.nodes.len() < 2 {
            return 0.0;
        }
        let (mean, parts) = (self.miss(shift), self.ends.len() as f64);
        let squares: f64 = self.misses(shift).map(|miss| (miss - mean).powi(2)).sum();
        match self.ends.as_slice() {
            [_] => 1.0,
            [_, (_, 0.0)] => squares.sqrt(),
            _ => 3.0 * (squares / (parts * (parts - 1.0))).sqrt() + 0.25 / self.nodes.len() as f64,
        }
    }

    /// Where `miss` is met, searched from `start` on: to `left` of it, or where it is known how much less than √N the distances
    /// grow, by a step from where it is off by no more than `near`. `None` where no number of photons suffices.
    pub(super) fn solve(&mut self, start: f64, miss: f64, [left, near]: [f64; 2]) -> Result<Option<Met>> {
        let (mut low, mut high) = (-LOG_PHOTONS, LOG_PHOTONS);
        let mut before: Option<(f64, f64)> = None;
        let mut log = start.clamp(low, high);
        for step in 1.. {
            self.look(log.exp())?;
            // As if the distances were √N times a constant.
            let [least, most] = [-LOG_PHOTONS - log, LOG_PHOTONS - log];
            let shift = if self.miss(most) > miss {
                most
            } else if self.miss(least) < miss {
                least
            } else {
                crossing(least, most, |shift| Ok(miss - self.miss(shift)))?
            };
            if shift > 0.0 {
                low = log
            } else {
                high = log
            }
            let off = (self.miss(0.0) - miss).abs();
            if log >= LOG_PHOTONS && self.miss(0.0) > miss {
                return Ok(None);
            }
            // The shifts of this step and the last vanish on a straight line; they fall no faster than by what is taken.
            if let Some((log_before, before)) = before {
                self.share = Some(((before - shift) / (log - log_before)).clamp(0.05, 1.0));
            }
            let known = self.share.is_some() && off <= near;
            let next = log + shift / self.share.unwrap_or(1.0);
            if off <= left || known || high - low <= 1e-12 || step >= STEPS || log <= -LOG_PHOTONS {
                return Ok(Some(Met { log: next.clamp(-LOG_PHOTONS, LOG_PHOTONS), shift }));
            }
            before = Some((log, shift));
            let inside = next > low && next < high;
            log = if inside { next } else { (log + shift).clamp(low, high) };
        }
        Ok(None)
    }
}
