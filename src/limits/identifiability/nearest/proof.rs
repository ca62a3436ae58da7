//! A lower bound of the nearest distance: branch and bound over the unknown temperatures alone.
//!
//! For fixed temperatures ‖√(N + v) − √(N′ + v)‖² is jointly convex in all that enters linearly, the amplitudes of the
//! alternative's sources (`amplitudes`): −√ is convex. What is left to search are the unknown temperatures, none, one or a
//! few. A box of them is bounded over amplitudes and the chord of each source's spectrum (`sources`), less what the chord misses: by a
//! quadratic that lies below the cost wherever it could be nearer than the best state known (`metric`), and by tangents of the cost itself
//! (`tangent`); the least value of a quadratic is bounded by its slope (`hull`). About the best state a box is closed at once by convexity
//! (`closing`). Beside it one unknown temperature is walked through outwards (`wings`); what that leaves, and boxes of several, are halved
//! until none could be nearer, the lowest first. A state that turns out to be nearer on
//! the way becomes the best one, and all begins again.
//!
//! Rounding: lengths are lowered by a stated share of what they are made of, spectra are taken to be as exact as
//! [`crate::planck`] states, and the bound given is lowered by [`MARGIN`]. Priors that are linear in all this are rows of it
//! (`priors`).

mod about;
mod amplitudes;
mod bound;
mod closing;
mod groups;
mod hull;
mod metric;
mod orthogonal;
mod priors;
mod prover;
mod region;
mod sources;
mod tangent;
mod vectors;
mod view;
mod wings;

use self::about::Closed;
pub(super) use self::groups::by_place;
pub(super) use self::prover::Memory;
use self::prover::{Goal, Looked, Prover};
use self::region::Region;
pub(in crate::limits::identifiability) use self::sources::{Chord, chord};
use self::wings::Wings;
use super::refine::{NearestDistance, refine};
use super::residual::{Comparison, Target};
use crate::best_first::BestFirst;
use crate::scene::State;

/// What a bound is lowered by in the end.
const MARGIN: f64 = 1e-12;
/// Boxes looked at most, by the number of unknown temperatures.
const BOXES: [u64; 4] = [1, 2_000, 6_000, 6_000];
/// The same where the bound leaves a prior out: what is wanting then no box brings.
const BOXES_WITHOUT_PRIORS: u64 = 30;
/// Nearer states that are followed at most.
const RESTARTS: usize = 30;
/// Descents into valleys on the way, boxes before the first one (most proofs need no more), and boxes after which another one
/// is tried from no lower than before.
const DESCENTS: usize = 40;
const FIRST_DESCENT: u64 = 40;
const SELDOM: u64 = 50;

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

/// What is known of a search.
enum Outcome {
    /// No state is nearer than this.
    Bound(f64),
    /// A nearer state.
    Nearer(State),
}

/// Whether any state is nearer than `limit`: none is where that can be proved of `reach`, a little more. `known` is the nearest
/// one that a search has found, if there was one.
pub(super) fn nearer_than(
    comparison: &mut Comparison<'_>,
    (merging, memory): (Option<usize>, &mut Memory),
    target: &Target<'_>,
    [limit, reach]: [f64; 2],
    known: Option<&NearestDistance>,
    boxes: u64,
) -> Nearer {
    // The rounding of a distance is in the reach.
    let goal =
        Goal { limit: limit * limit, enough: reach * reach * (1.0 + 4.0 * MARGIN), rounding: 0.0, boxes };
    match Prover::new(comparison, merging, memory, target, reach).run(comparison, target, known, goal) {
        Outcome::Nearer(_) => Nearer::Somewhere,
        Outcome::Bound(lower) if lower * (1.0 - MARGIN) >= reach => Nearer::Nowhere,
        Outcome::Bound(_) => Nearer::Undecided,
    }
}

/// The best state with a bound proved to `tolerance` of its distance, or as far as the effort goes.
pub(super) fn prove(
    comparison: &mut Comparison<'_>,
    (merging, memory): (Option<usize>, &mut Memory),
    target: &Target<'_>,
    mut best: NearestDistance,
    tolerance: f64,
) -> NearestDistance {
    let (mut restarts, mut ends_at_nearer) = (0, true);
    while best.distance > 0.0 {
        let cost = best.distance * best.distance;
        // A little more than asked for, so that a bound rounded down does not miss it.
        let (rounding, _) = comparison.rounding_at(target, &best.state, best.distance);
        let share = 1.0 - 0.9 * (tolerance - rounding).max(0.1 * tolerance);
        let prover = Prover::new(comparison, merging, memory, target, best.distance);
        let boxes = BOXES[prover.all.axes.len().min(BOXES.len() - 1)];
        let limit = if ends_at_nearer { cost } else { 0.0 };
        let goal = Goal { limit, enough: share * share * cost, rounding, boxes };
        match prover.run(comparison, target, Some(&best), goal) {
            Outcome::Bound(lower) => {
                best.lower = (lower * (1.0 - MARGIN)).max(0.0).min(best.distance);
                break;
            }
            Outcome::Nearer(state) => {
                restarts += 1;
                let found = refine(comparison, target, state, None, 0.0);
                let iterations = best.iterations + found.iterations;
                let is_nearer = found.distance < best.distance;
                // Where nothing comes of it, or too many follow each other, what can be said of the best one is better than nothing.
                ends_at_nearer = is_nearer && restarts < RESTARTS;
                if is_nearer {
                    best = NearestDistance { iterations, ..found };
                }
            }
        }
    }
    best
}

impl Prover<'_, '_> {
    fn run(
        mut self,
        comparison: &mut Comparison<'_>,
        target: &Target<'_>,
        best: Option<&NearestDistance>,
        goal: Goal,
    ) -> Outcome {
        let Goal { limit, enough, rounding, boxes } = goal;
        // Where the bound leaves a prior out the best state is no minimum of what it is of: nothing closes about that.
        let is_whole = self.all.priors.are_rows();
        let boxes = if is_whole { boxes } else { boxes.min(BOXES_WITHOUT_PRIORS) };
        let mut queue = BestFirst::new(boxes);
        let minimum = best.filter(|_| is_whole).map(|best| self.minimum(comparison, target, &best.state));
        if minimum.as_ref().is_some_and(|minimum| self.all.allowed.at_limit(&minimum.amplitudes)) {
            self.all.at_limit();
        }
        let closed = minimum.as_ref().map(|minimum| self.close_about(comparison, target, minimum, goal));
        let faces = match closed {
            Some(Closed::Nearer(state)) => return Outcome::Nearer(state),
            // Its bound is that distance, and errs as that does; what bounds the others counts its own rounding.
            Some(Closed::Box(lower, faces)) => {
                let surely = (1.0 - rounding).max(0.0);
                Some((surely * surely * lower, faces))
            }
            Some(Closed::Nothing) | None => None,
        };
        let (lower, faces) = faces.unzip();
        match lower {
            // There is one box; where closing it did not suffice tangents may.
            _ if self.all.axes.is_empty() => queue.push(lower.unwrap_or(0.0), 0, Region::of(Vec::new())),
            Some(lower) => queue.leave(lower),
            None => {}
        }
        if self.all.axes.is_empty() {
            // Nothing is left beside it.
        } else if let Some(Wings { lower, left, nearer }) =
            minimum.as_ref().zip(best).and_then(|(minimum, best)| {
                self.wings((&mut *comparison, target), (minimum, &best.state), faces.as_deref(), goal)
            })
        {
            if let Some(state) = nearer {
                return Outcome::Nearer(state);
            }
            queue.leave(lower);
            left.into_iter().for_each(|region| queue.push(0.0, 0, region));
        } else {
            let warmest = best.map_or(target.state, |best| &best.state);
            self.around(faces.as_deref(), warmest).into_iter().for_each(|region| queue.push(0.0, 0, region));
        }
        let (mut descents, mut descended) = (0, f64::INFINITY);
        while let Some((lowest, region)) = queue.take(|bound| bound >= enough) {
            let parts = match region.axis {
                Some(axis) => self.halves(&region, axis),
                None => vec![region.clone()],
            };
            if parts.is_empty() {
                queue.leave(lowest);
                continue;
            }
            for mut part in parts {
                let looked_at = queue.look();
                let Looked { lower, axis, in_all } = self.bound(&part.ends, None, enough);
                let bound = lower.max(lowest);
                if bound < enough && in_all {
                    let (state, cost) = self.candidate(comparison, target, &self.bounder.mixture(&self.all));
                    if cost < limit * (1.0 - 1e-12) {
                        return Outcome::Nearer(state);
                    }
                    if looked_at >= FIRST_DESCENT && cost < descended && descents < DESCENTS {
                        // Downhill from here another valley may be found; each time from lower than before, or seldom.
                        descents += 1;
                        descended = cost;
                        let found = refine(comparison, target, state, None, 0.0);
                        if found.distance * found.distance < limit * (1.0 - 1e-12) {
                            return Outcome::Nearer(found.state);
                        }
                    } else if looked_at.is_multiple_of(SELDOM) {
                        descended = f64::INFINITY;
                    }
                }
                if self.all.axes.is_empty() {
                    // There is nothing to halve.
                    queue.leave(bound);
                    continue;
                }
                part.axis = Some(axis);
                queue.push(bound, 0, part);
            }
        }
        Outcome::Bound(queue.bound().min(limit.max(enough)).max(0.0).sqrt())
    }

    /// The whole range but for the closed box, in boxes that share faces with it.
    fn around(&mut self, faces: Option<&[[f64; 2]]>, warm: &State) -> Vec<Region> {
        let ranges: Vec<[f64; 2]> = (0..self.all.axes.len()).map(|axis| self.range(axis, warm)).collect();
        let mut rest: Vec<[usize; 2]> = Vec::new();
        for (axis, range) in ranges.iter().enumerate() {
            let ends = [self.end(axis, range[0]), self.end(axis, range[1])];
            rest.push(ends);
        }
        let Some(faces) = faces else { return vec![Region::of(rest)] };
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
                regions.push(Region::of(outer));
            }
            rest[axis] = inner;
        }
        regions
    }

    fn halves(&mut self, region: &Region, axis: usize) -> Vec<Region> {
        let ends = region.ends[axis];
        let [a, b] = ends.map(|end| self.temperature_k[axis][end]);
        let middle = self.all.middle(axis, [a, b]);
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

#[cfg(test)]
mod tests;
