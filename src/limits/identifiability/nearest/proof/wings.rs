//! What is left on both sides of a closed interval of the one unknown temperature, in steps that grow.
//!
//! The cost grows with the square of what T is off, and what a chord misses with the square of its width: from the closed interval
//! outwards each one may be as wide as all before it. One that does not suffice is tried narrower, then left to be halved. Where no
//! interval could be closed it begins at T* itself, and what a chord may miss of the cost there sets the width. An interval is bounded by
//! [`quadratic`] where one amplitude is free at most, else over all amplitudes (`bound`) from the best ones of the interval before.

mod quadratic;

use self::quadratic::{About, Weighed};
use super::bound::Mixture;
use super::closing::Minimum;
use super::prover::{Goal, Prover, merged_into};
use super::region::Region;
use super::sources::Spectrum;
use super::vectors::largest_share;
use super::view::View;
use crate::identifiability::nearest::blackbodies::rounded;
use crate::identifiability::nearest::residual::{Comparison, Target};
use crate::scene::State;

/// Width of the first interval where none is closed about the best state, as a share of T/x, x = hcν/kT in the middle of the bands.
const NARROW: f64 = 1e-3;
/// By what the width grows from one interval to the next, times how much more than enough was found, and at most; and by what it falls
/// where one does not suffice.
const GROWS: f64 = 2.0;
const GROWS_AT_MOST: f64 = 30.0;
const FALLS: f64 = 0.3;
/// After so many that sufficed each one grows by as much again.
const STEADY: i32 = 3;
/// How much more than enough is ample.
const AMPLE: f64 = 1.5;
/// How often one is tried narrower.
const NARROWER: usize = 3;
/// Intervals looked at most on a side.
const MOST: usize = 40;
/// Share of the temperature at its hot end from which on a cold interval goes down to the end of the range.
const COLD: f64 = 0.4;

/// What has come of it: no d² is below, but for what is left; or a nearer state.
pub(super) struct Wings {
    pub(super) lower: f64,
    pub(super) left: Vec<Region>,
    pub(super) nearer: Option<State>,
}

/// One side: where it begins and ends, and the width of the first interval.
struct Side {
    from_k: f64,
    to_k: f64,
    width_k: f64,
}

impl Side {
    /// Goes outwards; `bound` is told the ends, the nearer one first, and says nothing where all beyond the nearer one is out of reach.
    /// Returned are the least bound of those that suffice, and what is left.
    fn walk(self, enough: f64, mut bound: impl FnMut([f64; 2]) -> Option<f64>) -> (f64, Vec<[f64; 2]>) {
        let Self { from_k: mut from, to_k: limit, width_k: mut width } = self;
        let (mut lowest, mut left) = (f64::INFINITY, Vec::new());
        let (mut narrower, mut looked_at, mut sufficed) = (0, 0, 0);
        let mut widest = from;
        while from != limit {
            if looked_at == MOST {
                left.push([from, limit]);
                break;
            }
            looked_at += 1;
            let to = match limit < from {
                true if from - width <= COLD * from => limit,
                true => rounded(from - width, from).max(limit),
                false => rounded(from + width, from).min(limit),
            };
            let Some(lower) = bound([from, to]) else { break };
            if narrower == 0 {
                widest = to;
            }
            if lower < enough || lower.is_nan() {
                (narrower, sufficed) = (narrower + 1, 0);
                width = FALLS * (to - from).abs();
                if narrower > NARROWER {
                    left.push([from, widest]);
                    (narrower, width) = (0, GROWS * (widest - from).abs());
                    from = widest;
                }
                continue;
            }
            lowest = lowest.min(lower);
            narrower = 0;
            sufficed += 1;
            let grows = GROWS * f64::max(lower / enough, f64::from(1 + sufficed / STEADY));
            width = grows.clamp(GROWS, GROWS_AT_MOST) * (to - from).abs();
            from = to;
        }
        (lowest, left)
    }
}

/// Bounds of intervals by the quadratic about the best state, in these bands.
struct Alone<'s> {
    view: &'s View<'s>,
    about: About<'s>,
    with: Weighed,
    source: usize,
    /// The spectrum at the farther end of the interval before, or where that did not suffice at its nearer one.
    known: Option<Spectrum>,
}

impl<'s> Alone<'s> {
    fn new(view: &'s View<'s>, minimum: &'s Minimum, source: usize) -> Option<Self> {
        let about = About::new(view, minimum, source)?;
        let with = about.weighed(minimum.weight.clone());
        Some(Self { view, about, with, source, known: None })
    }

    /// The bound of one, its nearer end first; none where all from there on is out of reach.
    fn bound(&mut self, [from, to]: [f64; 2], enough: f64) -> Option<f64> {
        let sources = &self.view.sources;
        let near = self.known.take().filter(|known| known.temperature_k == from);
        let near = near.unwrap_or_else(|| sources.spectrum(self.source, from));
        let bright = || largest_share(self.view.brightest(), &near.counts, &near.slope, 0.0);
        if to > from && bright() < self.about.amplitude {
            return None;
        }
        let far = sources.spectrum(self.source, to);
        let ends = if to < from { [&far, &near] } else { [&near, &far] };
        let lower = self.about.bound(&self.with, ends, sources.rounding(ends[0].temperature_k), enough);
        self.known = Some(if lower >= enough { far } else { near });
        Some(lower)
    }
}

impl Prover<'_, '_> {
    /// What lies beyond the faces; `None` where more temperatures than one are unknown, or none.
    pub(super) fn wings(
        &mut self,
        (comparison, target): (&mut Comparison<'_>, &Target<'_>),
        (minimum, warm): (&Minimum, &State),
        faces: Option<&[[f64; 2]]>,
        goal: Goal,
    ) -> Option<Wings> {
        let &[s] = &self.all.axes[..] else { return None };
        let own_k = minimum.spectra[s].temperature_k;
        let face = faces.map_or([own_k; 2], |faces| faces[0]);
        let first = NARROW * own_k / self.all.sources.middle_x(own_k).max(1.0);
        let enough = goal.enough;
        let mut wings = Wings { lower: f64::INFINITY, left: Vec::new(), nearer: None };
        let sides = |[low, high]: [f64; 2]| {
            let to = [low.min(face[0]), high.max(face[1])];
            [0, 1].map(|side| {
                let width_k = if faces.is_some() { (face[side] - own_k).abs() } else { first };
                Side { from_k: face[side], to_k: to[side], width_k }
            })
        };
        let mut walked = Vec::new();
        let merged = merged_into(&mut self.merged, &self.all, self.merging).zip(self.merging);
        let merged = merged.and_then(|(view, count)| Some((minimum.counted_together(view, count)?, &*view)));
        let mut in_few = merged.as_ref().and_then(|(minimum, view)| Alone::new(view, minimum, s));
        let mut in_all = if in_few.is_none() { Alone::new(&self.all, minimum, s) } else { None };
        if in_few.is_some() || in_all.is_some() {
            for side in sides(self.all.sources.list[s].temperature_k) {
                walked.push(side.walk(enough, |ends| {
                    if let Some(in_few) = &mut in_few {
                        let lower = in_few.bound(ends, enough)?;
                        if lower >= enough {
                            return Some(lower);
                        }
                    }
                    in_all = in_all.take().or_else(|| Alone::new(&self.all, minimum, s));
                    in_all.as_mut().map_or(Some(0.0), |in_all| in_all.bound(ends, enough))
                }));
            }
        } else {
            for side in sides(self.range(0, warm)) {
                let is_nearer = |prover: &Self, mixture: &Mixture| {
                    wings.nearer = prover.nearer(comparison, target, goal.limit, mixture);
                    wings.nearer.is_some()
                };
                walked.push(side.walk(enough, self.mixed(minimum, s, enough, is_nearer)));
                if wings.nearer.is_some() {
                    return Some(wings);
                }
            }
        }
        for (lower, left) in walked {
            wings.lower = wings.lower.min(lower);
            for [a, b] in left {
                wings.left.push(Region::of(vec![[a.min(b), a.max(b)].map(|end| self.end(0, end))]));
            }
        }
        Some(wings)
    }

    /// Bounds of intervals over all amplitudes: in all bands from the best ones on, and where there was enough to spare first in bands
    /// counted together. It ends where one shows a nearer state.
    fn mixed<'s>(
        &'s mut self,
        minimum: &'s Minimum,
        s: usize,
        enough: f64,
        mut is_nearer: impl FnMut(&Self, &Mixture) -> bool,
    ) -> impl FnMut([f64; 2]) -> Option<f64> {
        let mut is_ample = false;
        let mut best = Mixture {
            amplitudes: minimum.amplitudes.clone(),
            temperature_k: minimum.spectra.iter().map(|spectrum| spectrum.temperature_k).collect(),
        };
        move |[from, to]| {
            let ends = [[from.min(to), from.max(to)].map(|end| self.end(0, end))];
            if is_ample {
                let lower = self.bound(&ends, None, enough).lower;
                is_ample = lower > AMPLE * enough;
                return Some(lower);
            }
            // As bright as before at the nearer end.
            let mut start = best.amplitudes.clone();
            start[s] *= self.all.sources.brightness(best.temperature_k[s], from);
            self.all.allowed.bring_within(&mut start);
            let lower = self.bound_from(&ends, s, f64::from(u8::from(to < from)), &start, enough);
            let there = self.bounder.mixture(&self.all);
            if lower >= enough {
                is_ample = lower > AMPLE * enough;
                best = there;
            } else if is_nearer(self, &there) {
                return None;
            }
            Some(lower)
        }
    }
}

#[cfg(test)]
mod tests;
