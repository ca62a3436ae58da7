//! A lower bound of the nearest distance: branch and bound over the unknown temperatures alone.
//!
//! For fixed temperatures ‖√(N + v) − √(N′ + v)‖² is jointly convex in all that enters linearly, the amplitudes of the
//! alternative's sources (`amplitudes`): −√ is convex. What is left to search are the unknown temperatures, none, one or a
//! few. A box of them is bounded by quadratics that lie below the cost wherever it could be nearer than the best state known
//! (`metric`), over amplitudes and the chord of each source's spectrum (`sources`), less what the chord misses; the least
//! value of a quadratic is bounded by its slope (`hull`). About the best state a box is closed at once by convexity
//! (`closing`); the others are halved until none could be nearer, the lowest first. A state that turns out to be nearer on
//! the way becomes the best one, and all begins again.
//!
//! Rounding: lengths are lowered by [`ROUNDING`] of what they are made of, spectra are taken to be as exact as
//! [`crate::planck`] states, and the bound given is lowered by [`MARGIN`]. Priors only add to a distance; the bound leaves
//! them out.

mod about;
mod amplitudes;
mod closing;
mod hull;
mod metric;
mod orthogonal;
mod sources;
mod vectors;
mod view;

use self::about::Closed;
use self::amplitudes::Amplitudes;
pub(super) use self::sources::Few;
use self::sources::Sources;
use self::view::{Mixture, View};
use super::refine::{NearestDistance, refine};
use super::residual::{Comparison, Target};
use crate::fisher::Nuisance;
use crate::scene::{Parameter, State};
use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::sync::Arc;

/// Rounding of a length, as a share of its terms, with that of Planck's function.
const ROUNDING: f64 = 1e-14;
/// What a bound is lowered by in the end.
const MARGIN: f64 = 1e-12;
/// Boxes looked at most, by the number of unknown temperatures.
const BOXES: [u64; 4] = [1, 2_000, 6_000, 6_000];
/// Nearer states that are followed at most.
const RESTARTS: usize = 30;
/// Descents into valleys on the way, boxes before the first one (most proofs need no more), and boxes after which another one
/// is tried from no lower than before.
const DESCENTS: usize = 40;
const FIRST_DESCENT: u64 = 40;
const SELDOM: u64 = 50;
/// Quadratics that are tried in a box.
const QUADRATICS: usize = 5;
/// Whether a state nearer than a limit was found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Nearer {
    /// One is.
    Somewhere,
    /// None is, which is proved.
    Nowhere,
    /// None was found, and it is not proved that there is none.
    Undecided,
}

/// What is to be shown.
#[derive(Debug, Clone, Copy)]
struct Goal {
    /// A state of less d² than this ends the proof.
    limit: f64,
    /// The bound of d² that is enough.
    enough: f64,
    /// Boxes looked at most.
    boxes: u64,
}

/// What is known of a search.
enum Outcome {
    /// No state is nearer than this.
    Bound(f64),
    /// A nearer state.
    Nearer(State),
}

/// Intervals of the unknown temperatures: places of their ends among the spectra known.
#[derive(Debug, Clone)]
struct Region {
    ends: Vec<[usize; 2]>,
    bound: f64,
    axis: Option<usize>,
}

impl Ord for Region {
    fn cmp(&self, other: &Self) -> Ordering {
        other.bound.total_cmp(&self.bound)
    }
}

impl PartialOrd for Region {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Region {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Region {}

struct Prover<'a> {
    few: Option<View<'static>>,
    all: View<'a>,
    /// Ends of intervals, by axis.
    temperature_k: Vec<Vec<f64>>,
    boxes: u64,
}

/// Whether any state is nearer than `limit`; `known` is the nearest one that a search has found, if there was one.
pub(super) fn nearer_than(
    comparison: &mut Comparison<'_>,
    few: Option<&Arc<Few>>,
    target: &Target<'_>,
    limit: f64,
    known: Option<&NearestDistance>,
    boxes: u64,
) -> Nearer {
    let goal = Goal { limit: limit * limit, enough: limit * limit * (1.0 + 4.0 * MARGIN), boxes };
    match Prover::new(comparison, few, target, limit).run(comparison, target, known, goal) {
        Outcome::Nearer(_) => Nearer::Somewhere,
        Outcome::Bound(lower) if lower * (1.0 - MARGIN) >= limit => Nearer::Nowhere,
        Outcome::Bound(_) => Nearer::Undecided,
    }
}

/// The best state with a bound proved to `tolerance` of its distance, or as far as the effort goes.
pub(super) fn prove(
    comparison: &mut Comparison<'_>,
    few: Option<&Arc<Few>>,
    target: &Target<'_>,
    mut best: NearestDistance,
    tolerance: f64,
) -> NearestDistance {
    for _ in 0..RESTARTS {
        if best.distance <= 0.0 {
            break;
        }
        let cost = best.distance * best.distance;
        // A little more than asked for, so that a bound rounded down does not miss it.
        let share = 1.0 - 0.9 * tolerance;
        let prover = Prover::new(comparison, few, target, best.distance);
        let boxes = BOXES[prover.all.axes.len().min(BOXES.len() - 1)];
        let goal = Goal { limit: cost, enough: share * share * cost, boxes };
        match prover.run(comparison, target, Some(&best), goal) {
            Outcome::Bound(lower) => {
                best.lower = (lower * (1.0 - MARGIN)).clamp(0.0, best.distance);
                break;
            }
            Outcome::Nearer(state) => {
                let found = refine(comparison, target, state, None, 0.0);
                let iterations = best.iterations + found.iterations;
                if found.distance >= best.distance {
                    break;
                }
                best = NearestDistance { iterations, ..found };
            }
        }
    }
    best
}

impl<'a> Prover<'a> {
    fn new(comparison: &Comparison<'a>, few: Option<&Arc<Few>>, target: &Target<'_>, reach: f64) -> Self {
        let space = &comparison.space;
        let sources = Sources::new(comparison, target);
        let counts: Vec<f64> = comparison.target.signal().iter().map(|s| target.counts * s).collect();
        let bands = [comparison.root().to_vec(), counts, comparison.noise().to_vec()];
        let reach = reach * (1.0 + 1e-9);
        let unknown_lighting = space.unknowns.contains(Nuisance::Lighting);
        let known_total = space.unknowns.known_lighting_total();
        let mut ranges: Vec<[f64; 2]> = target
            .state
            .lighting
            .iter()
            .map(|&v| if unknown_lighting { space.range.lighting } else { [v, v] })
            .collect();
        let mut sum = if unknown_lighting { space.lighting_sum() } else { f64::INFINITY };
        let sum_known = unknown_lighting && known_total.is_some();
        if unknown_lighting && ranges.iter().map(|range| range[0]).sum::<f64>() > sum {
            // States are then scaled down to the sum, below their range.
            ranges.iter_mut().for_each(|range| range[0] = 0.0);
        }
        if sum_known {
            // The last factor is what the others leave, whatever its range.
            if let Some(last) = ranges.last_mut() {
                *last = [0.0, sum];
            }
        }
        // By the rounding of the user's own numbers.
        sum *= 1.0 + 1e-15;
        let gain_free = space.unknowns.contains(Nuisance::Gain);
        let allowed = Amplitudes { gain_free, ranges, sum, sum_known, total: 0.0, gain_cap: None };
        let few = few.map(|few| {
            let kept = bands.each_ref().map(|x| x.iter().copied().step_by(few.stride).collect());
            View::new(sources.every(few), allowed.clone(), kept, reach)
        });
        let all = View::new(sources, allowed, bands, reach);
        let temperature_k = all.axes.iter().map(|_| Vec::new()).collect();
        Self { few, all, temperature_k, boxes: 0 }
    }

    fn run(
        mut self,
        comparison: &mut Comparison<'_>,
        target: &Target<'_>,
        best: Option<&NearestDistance>,
        goal: Goal,
    ) -> Outcome {
        let Goal { limit, enough, boxes } = goal;
        let (mut aside, faces) = match best.map(|best| self.close_about(comparison, target, best, goal)) {
            Some(Closed::Nearer(state)) => return Outcome::Nearer(state),
            Some(Closed::Box(lower, faces)) => (lower, Some(faces)),
            Some(Closed::Nothing) | None => (f64::INFINITY, None),
        };
        let mut queue = BinaryHeap::new();
        if self.all.axes.is_empty() {
            if faces.is_none() {
                queue.push(Region { ends: Vec::new(), bound: 0.0, axis: None });
            }
        } else {
            let warmest = best.map_or(target.state, |best| &best.state);
            queue.extend(self.around(faces.as_deref(), warmest));
        }
        let (mut descents, mut descended) = (0, f64::INFINITY);
        while let Some(region) = queue.pop() {
            if region.bound >= enough || self.boxes >= boxes {
                queue.push(region);
                break;
            }
            let parts = match region.axis {
                Some(axis) => self.halves(&region, axis),
                None => vec![region.clone()],
            };
            if parts.is_empty() {
                aside = aside.min(region.bound);
                continue;
            }
            for mut part in parts {
                self.boxes += 1;
                let (bound, axis, in_all) = self.bound(&part.ends, None, enough);
                part.bound = bound.max(part.bound);
                if part.bound < enough && in_all {
                    let (state, cost) = self.candidate(comparison, target, &self.all.mixture());
                    if cost < limit * (1.0 - 1e-12) {
                        return Outcome::Nearer(state);
                    }
                    if self.boxes >= FIRST_DESCENT && cost < descended && descents < DESCENTS {
                        // Downhill from here another valley may be found; each time from lower than before, or seldom.
                        descents += 1;
                        descended = cost;
                        let found = refine(comparison, target, state, None, 0.0);
                        if found.distance * found.distance < limit * (1.0 - 1e-12) {
                            return Outcome::Nearer(found.state);
                        }
                    } else if self.boxes.is_multiple_of(SELDOM) {
                        descended = f64::INFINITY;
                    }
                }
                part.axis = Some(axis);
                queue.push(part);
            }
        }
        let waiting = queue.peek().map_or(f64::INFINITY, |region| region.bound);
        Outcome::Bound(aside.min(waiting).min(limit.max(enough)).max(0.0).sqrt())
    }

    /// The state of a mixture, if its cost is below the limit.
    fn nearer(
        &self,
        comparison: &mut Comparison<'_>,
        target: &Target<'_>,
        limit: f64,
        mixture: &Mixture,
    ) -> Option<State> {
        let (state, cost) = self.candidate(comparison, target, mixture);
        (cost < limit * (1.0 - 1e-12)).then_some(state)
    }

    /// The state of a mixture, and its cost.
    fn candidate(
        &self,
        comparison: &mut Comparison<'_>,
        target: &Target<'_>,
        mixture: &Mixture,
    ) -> (State, f64) {
        let mut state = target.state.clone();
        let space = &comparison.space;
        let surface = mixture.amplitudes[0];
        for parameter in &space.parameters {
            match *parameter {
                Parameter::Temperature => state.temperature_k = mixture.temperature_k[0],
                Parameter::Lighting(k) => {
                    state.lighting[k] = if surface > 0.0 { mixture.amplitudes[k + 1] / surface } else { 0.0 };
                }
                Parameter::Gain => state.gain = surface.max(f64::MIN_POSITIVE),
                Parameter::EnvironmentTemperature(k) => state.environment_k[k] = mixture.temperature_k[k + 1],
                Parameter::Material => {}
            }
        }
        let state = space.within_range(&state);
        let cost = comparison.cost(target, &state);
        (state, cost)
    }

    /// The place of an end of an interval.
    fn end(&mut self, axis: usize, temperature_k: f64) -> usize {
        let known = self.temperature_k[axis].iter().position(|t| *t == temperature_k);
        known.unwrap_or_else(|| {
            self.temperature_k[axis].push(temperature_k);
            self.temperature_k[axis].len() - 1
        })
    }

    /// A lower bound of d² in a box, the axis along which it is best halved, and whether it was found in all bands: few of them
    /// are looked at first.
    fn bound(
        &mut self,
        ends: &[[usize; 2]],
        narrower: Option<&Amplitudes>,
        enough: f64,
    ) -> (f64, usize, bool) {
        let known = &self.temperature_k;
        let know = |view: &mut View<'_>| {
            for (axis, ends) in ends.iter().enumerate() {
                ends.iter().for_each(|&end| view.know(axis, end, known[axis][end]));
            }
        };
        let mut least = 0.0;
        if let Some(few) = &mut self.few {
            know(few);
            let found = few.bound(ends, narrower, enough, None, 1);
            let share = self.all.root.len() as f64 / few.root.len() as f64;
            // Where they are far from it all bands would hardly do either.
            if found.lower >= enough || (found.coarse && share * found.lower < enough) {
                return (found.lower, found.axis, false);
            }
            least = found.lower;
        }
        know(&mut self.all);
        let start = self.few.as_ref().map(|few| few.point());
        let found = self.all.bound(ends, narrower, enough, start, QUADRATICS);
        (found.lower.max(least), found.axis, true)
    }

    /// The whole range but for the closed box, in boxes that share faces with it.
    fn around(&mut self, faces: Option<&[[f64; 2]]>, warm: &State) -> Vec<Region> {
        let ranges: Vec<[f64; 2]> = (0..self.all.axes.len()).map(|axis| self.range(axis, warm)).collect();
        let mut rest: Vec<[usize; 2]> = Vec::new();
        for (axis, range) in ranges.iter().enumerate() {
            let ends = [self.end(axis, range[0]), self.end(axis, range[1])];
            rest.push(ends);
        }
        let region = |ends: Vec<[usize; 2]>| Region { ends, bound: 0.0, axis: None };
        let Some(faces) = faces else { return vec![region(rest)] };
        let mut regions = Vec::new();
        for (axis, (face, range)) in faces.iter().zip(&ranges).enumerate() {
            let mut inner = rest[axis];
            for side in 0..2 {
                if (side == 0 && face[0] <= range[0]) || (side == 1 && face[1] >= range[1]) {
                    continue;
                }
                let cut = self.end(axis, face[side]);
                let mut outer = rest.clone();
                outer[axis][1 - side] = cut;
                inner[side] = cut;
                regions.push(region(outer));
            }
            rest[axis] = inner;
        }
        regions
    }

    /// The range of an unknown temperature, cut off where a known amplitude is too bright in some band.
    fn range(&mut self, axis: usize, warm: &State) -> [f64; 2] {
        let s = self.all.axes[axis];
        let [low, high] = self.all.sources.list[s].temperature_k;
        let low = low.max(self.all.coldest_k(axis)).min(high);
        let Some(amplitude) = self.all.held(s) else { return [low, high] };
        let mut t = 1.2 * temperature_of(warm, s).max(low);
        while t < high {
            let end = self.end(axis, t);
            // What is too bright in few bands is so in all of them.
            let too_bright = match &mut self.few {
                Some(few) => few.too_bright(axis, end, t, amplitude),
                None => self.all.too_bright(axis, end, t, amplitude),
            };
            if too_bright {
                return [low, t];
            }
            t *= 1.3;
        }
        [low, high]
    }

    fn halves(&mut self, region: &Region, axis: usize) -> Vec<Region> {
        let ends = region.ends[axis];
        let [a, b] = ends.map(|end| self.temperature_k[axis][end]);
        let middle = if b > 1.2 * a { (a * b).sqrt() } else { 0.5 * (a + b) };
        if !(middle > a && middle < b) || b - a <= 1e-13 * b {
            return Vec::new();
        }
        let middle = self.end(axis, middle);
        [[ends[0], middle], [middle, ends[1]]]
            .map(|ends| {
                let mut half = Region { axis: None, ..region.clone() };
                half.ends[axis] = ends;
                half
            })
            .into()
    }
}

fn temperature_of(state: &State, s: usize) -> f64 {
    s.checked_sub(1).map_or(state.temperature_k, |k| state.environment_k[k])
}

#[cfg(test)]
mod tests;
