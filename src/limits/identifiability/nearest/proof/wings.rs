//! What is left on both sides of a closed interval of the one unknown temperature, in steps that grow.
//!
//! About the best state, with counts N₀ = Σ c A(T*) + V* q + …, p = −r/s and the weights W of `metric`, no state within reach is below
//!
//! d² + Σ p (N′ − N₀) + Σ W² (N′ − N₀)²,   N′ − N₀ = c(A(T) − A(T*)) + δ q,
//!
//! where one source of known amplitude c has the unknown temperature and one amplitude, at most, is free, V* + δ. On an interval A is
//! low + σ rise within ± half (`sources`), so that with h = p/(2W), φ the least of the sums with it over 0 ≤ σ ≤ 1 and δ (`rectangle`),
//! and m = ‖W c half‖
//!
//! d² ≥ cost − ‖h‖² + (√(‖h‖² + φ) − m)².
//!
//! The cost grows with the square of what T is off, and what a chord misses with the square of its width: from the closed interval
//! outwards each one may be as wide as all before it. One that does not suffice is tried narrower, then left to be halved. Where no
//! interval could be closed it begins at T* itself, and what a chord may miss of the cost there sets the width.

use super::Region;
use super::bound::{CLEAR, Mixture};
use super::closing::Minimum;
use super::prover::Prover;
use super::sources::{Spectrum, half_sag};
use super::vectors::{counts_into, largest_share, product_into, square_of_product, square_of_quotient};
use crate::identifiability::nearest::blackbodies::rounded;
use crate::identifiability::rectangle::OverRectangle;
use crate::scene::State;
use crate::simd::{Chunk, LANES, dispatched, fold};
use crate::sum::dot;

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

/// How often the weights are made better, and the share of what is wanting that this must bring to be tried again.
const BETTER: usize = 2;
const WORTH: f64 = 0.1;

/// What has come of it: no d² is below, but for what is left.
pub(super) struct Wings {
    pub(super) lower: f64,
    pub(super) left: Vec<Region>,
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
            if lower >= enough {
                lowest = lowest.min(lower);
            } else if narrower < NARROWER {
                (narrower, sufficed) = (narrower + 1, 0);
                width = FALLS * (to - from).abs();
                continue;
            } else {
                left.push([from, to]);
            }
            narrower = 0;
            sufficed += 1;
            let grows = GROWS * f64::max(lower / enough, f64::from(1 + sufficed / STEADY));
            width = grows.clamp(GROWS, GROWS_AT_MOST) * (to - from).abs();
            from = to;
        }
        (lowest, left)
    }
}

/// The quadratic about the best state, but for what hangs on the interval.
struct About<'m> {
    minimum: &'m Minimum,
    /// A(T*), c.
    own: &'m [f64],
    amplitude: f64,
    /// q, Σ p q, and where δ may be; no q where no amplitude is free.
    light: Option<&'m [f64]>,
    pull_lit: f64,
    range: [f64; 2],
    /// N and N₀, and their rounding as a share of them.
    counts: &'m [f64],
    seen: Vec<f64>,
    rounding: f64,
}

/// Weights, and what they make of all that does not hang on the interval.
struct Weighed {
    weight: Vec<f64>,
    /// W q, ‖W q‖².
    lit: Vec<f64>,
    lit_lit: f64,
    /// ‖h‖², and the rounding of counts as a length.
    shift: f64,
    grain: f64,
}

impl Prover<'_, '_> {
    /// What lies beyond the faces; `None` where more temperatures than one are unknown, or none.
    pub(super) fn wings(
        &mut self,
        minimum: &Minimum,
        faces: Option<&[[f64; 2]]>,
        warm: &State,
        enough: f64,
    ) -> Option<Wings> {
        let &[s] = &self.all.axes[..] else { return None };
        self.all.look();
        let own_k = minimum.spectra[s].temperature_k;
        let face = faces.map_or([own_k; 2], |faces| faces[0]);
        let first = NARROW * own_k / self.all.sources.middle_x(own_k).max(1.0);
        let mut wings = Wings { lower: f64::INFINITY, left: Vec::new() };
        let range = match self.quadratic(minimum, s) {
            Some(_) => self.all.sources.list[s].temperature_k,
            None => self.range(0, warm),
        };
        let sides = [(face[0], range[0].min(face[0])), (face[1], range[1].max(face[1]))];
        for (from_k, to_k) in sides {
            let width_k = if faces.is_some() { (from_k - own_k).abs() } else { first };
            let side = Side { from_k, to_k, width_k };
            let (lower, left) = match self.quadratic(minimum, s) {
                Some(about) => side.walk(enough, self.alone(&about, s, enough)),
                None => side.walk(enough, self.mixed(minimum, s, enough)),
            };
            wings.lower = wings.lower.min(lower);
            for ends in left {
                let ends = [ends[0].min(ends[1]), ends[0].max(ends[1])];
                wings.left.push(Region::of(vec![ends.map(|end| self.end(0, end))]));
            }
        }
        Some(wings)
    }

    /// Bounds of intervals by the quadratic about the best state.
    fn alone<'s>(
        &'s self,
        about: &'s About<'s>,
        s: usize,
        enough: f64,
    ) -> impl FnMut([f64; 2]) -> Option<f64> {
        let with = about.weighed(about.minimum.weight());
        let sources = &self.all.sources;
        let mut known: Option<Spectrum> = None;
        move |[from, to]| {
            let near = known.take().filter(|known| known.temperature_k == from);
            let near = near.unwrap_or_else(|| sources.spectrum(s, from));
            let bright = || largest_share(&self.all.later.brightest, &near.counts, &near.slope, 0.0);
            if to > from && bright() < about.amplitude {
                return None;
            }
            let far = sources.spectrum(s, to);
            let ends = if to < from { [&far, &near] } else { [&near, &far] };
            let lower = about.bound(&with, ends, sources.rounding(ends[0].temperature_k), enough);
            known = Some(if lower >= enough { far } else { near });
            Some(lower)
        }
    }

    /// Bounds of intervals over all amplitudes: in all bands from the best ones on, and where there was enough to spare first in bands
    /// counted together.
    fn mixed<'s>(
        &'s mut self,
        minimum: &'s Minimum,
        s: usize,
        enough: f64,
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
            let lower = self.bound_from(&ends, s, f64::from(u8::from(to < from)), &start, enough);
            if lower >= enough {
                is_ample = lower > AMPLE * enough;
                best = self.bounder.mixture(&self.all);
            }
            Some(lower)
        }
    }

    /// The quadratic about a minimum; `None` where more amplitudes are free.
    fn quadratic<'m>(&'m self, minimum: &'m Minimum, s: usize) -> Option<About<'m>> {
        let amplitude = self.all.held(s)?;
        let allowed = &self.all.allowed;
        let open: Vec<usize> =
            (0..allowed.ranges.len()).filter(|&k| allowed.ranges[k][0] < allowed.ranges[k][1]).collect();
        let (light, range) = match open[..] {
            [] => (None, [0.0; 2]),
            // With a sum that is known the one light has what that says.
            [_] if allowed.sum_known && allowed.ranges.len() == 1 => (None, [0.0; 2]),
            [k] if !allowed.sum_known => {
                let [low, high] = allowed.ranges[k];
                let ends = [low, high.min(allowed.sum).max(low)];
                (Some(&minimum.spectra[k + 1].counts[..]), ends.map(|end| end - minimum.amplitudes[k + 1]))
            }
            _ => return None,
        };
        let pull_lit = light.map_or(0.0, |light| dot(&minimum.pull, light));
        let mut seen = vec![0.0; minimum.other.len()];
        counts_into(&minimum.other, &self.all.noise, &mut seen);
        let (own, counts, rounding) =
            (&minimum.spectra[s].counts[..], &self.all.counts[..], self.all.rounding);
        Some(About { minimum, own, amplitude, light, pull_lit, range, counts, seen, rounding })
    }
}

impl About<'_> {
    fn weighed(&self, weight: Vec<f64>) -> Weighed {
        let mut lit = vec![0.0; weight.len()];
        if let Some(light) = self.light {
            product_into(light, &weight, &mut lit);
        }
        let shift = 0.25 * square_of_quotient(&self.minimum.pull, &weight);
        let length = |x: &[f64]| square_of_product(x, &weight).sqrt();
        let grain = self.rounding * (length(self.counts) + length(&self.seen));
        let lit_lit = dot(&lit, &lit);
        Weighed { weight, lit, lit_lit, shift, grain }
    }

    /// A lower bound of d² between two temperatures; `rounding` is that of spectra as a share of them.
    fn bound(&self, with: &Weighed, ends: [&Spectrum; 2], rounding: f64, enough: f64) -> f64 {
        let (mut lower, mut brightest) = self.bounded(with, ends, rounding);
        for _ in 0..BETTER {
            if lower >= enough || !brightest.is_finite() {
                break;
            }
            let Minimum { root, other, reach, .. } = self.minimum;
            let mut weight = with.weight.clone();
            narrowed_into(Narrowed {
                root,
                other,
                reach: *reach,
                amplitude: self.amplitude,
                own: self.own,
                hot: &ends[1].counts,
                light: self.light,
                brightest,
                weight: &mut weight,
            });
            let (better, still) = self.bounded(&self.weighed(weight), ends, rounding);
            let gained = better - lower;
            (lower, brightest) = (lower.max(better), still);
            if gained < WORTH * (enough - lower) {
                break;
            }
        }
        lower
    }

    /// The bound by these weights, and how much more light a state within reach can have.
    fn bounded(&self, with: &Weighed, [cold, hot]: [&Spectrum; 2], rounding: f64) -> (f64, f64) {
        let Minimum { pull, cost, reach, .. } = self.minimum;
        let Weighed { weight, lit, lit_lit, shift, grain } = with;
        let sums = sums(Interval {
            width: hot.temperature_k - cold.temperature_k,
            more: rounding,
            amplitude: self.amplitude,
            cold: [&cold.counts, &cold.slope],
            hot: [&hot.counts, &hot.slope],
            own: self.own,
            pull,
            weight,
            lit,
        });
        let [pulled, along, square, across, steep, lit, lit_along, half] = sums;
        let (x, y, range) = (across + 0.5 * along, lit + 0.5 * self.pull_lit, self.range);
        let quadratic = OverRectangle { xx: steep, xy: lit_along, yy: *lit_lit, x, y, range };
        let farthest = range[0].abs().max(range[1].abs());
        let sizes = shift + square + steep + farthest * farthest * lit_lit;
        let share = f64::EPSILON * (weight.len() / LANES + TERMS) as f64;
        let rounding = share * (cost + sizes);
        let fall = pulled + square + quadratic.least() - rounding;
        let missed = half.sqrt() * (1.0 + share) + grain;
        let left = (shift + fall).max(0.0).sqrt();
        let lower = if left > missed && left > CLEAR * grain {
            cost - rounding + fall + missed * (missed - 2.0 * left)
        } else {
            cost - shift - rounding
        };
        let within = (reach * reach - cost + shift).max(0.0).sqrt() + missed;
        let most = within * within - shift + rounding - (pulled + square);
        (lower, quadratic.highest(most))
    }
}

/// Roundings of a sum besides those of its terms one by one.
const TERMS: usize = 16;

/// What [`narrowed_into`] reads and writes.
struct Narrowed<'a> {
    root: &'a [f64],
    other: &'a [f64],
    reach: f64,
    amplitude: f64,
    own: &'a [f64],
    hot: &'a [f64],
    light: Option<&'a [f64]>,
    brightest: f64,
    weight: &'a mut [f64],
}

dispatched! {
    /// Weights of states that are nowhere brighter than the hot end with so much more light.
    fn narrowed_into<'a>(narrowed: Narrowed<'a>) -> () {
        let Narrowed { root, other, reach, amplitude, own, hot, light, brightest, weight } = narrowed;
        let light = light.unwrap_or(own);
        let bands = root.iter().zip(other).zip(own.iter().zip(hot)).zip(light);
        for (weight, (((y, s), (own, hot)), light)) in weight.iter_mut().zip(bands) {
            let square = brightest.mul_add(*light, amplitude.mul_add(hot - own, s * s)).max(0.0).sqrt();
            let bright = square.min(y + reach);
            let better = (y / s).sqrt() / (s + bright);
            *weight = if *weight > 0.0 { better } else { 0.0 };
        }
    }
}

struct Interval<'a> {
    width: f64,
    more: f64,
    amplitude: f64,
    cold: [&'a [f64]; 2],
    hot: [&'a [f64]; 2],
    own: &'a [f64],
    pull: &'a [f64],
    weight: &'a [f64],
    lit: &'a [f64],
}

dispatched! {
    /// With x = c(low − A(T*)), d = c rise: Σ p x, Σ p d, ‖Wx‖², Σ W²xd, ‖Wd‖², Σ W²xq, Σ W²dq, ‖W c half‖².
    fn sums<'a>(interval: Interval<'a>) -> [f64; 8] {
        let Interval { width, more, amplitude, cold, hot, own, pull, weight, lit } = interval;
        let per_unit = 1.0 / width;
        let chunks = |x: &'a [f64]| -> &'a [Chunk] { x.as_chunks().0 };
        let weight = chunks(weight);
        let [[cold, cold_slope], [hot, hot_slope]] = [cold, hot].map(|end| end.map(|x| &chunks(x)[..weight.len()]));
        let [own, pull, lit] = [own, pull, lit].map(|x| &chunks(x)[..weight.len()]);
        let mut sums = [[0.0; LANES]; 8];
        for c in 0..weight.len() {
            let (a, b, slope_a, slope_b) = (cold[c], hot[c], cold_slope[c], hot_slope[c]);
            let (w, p, wq, at) = (weight[c], pull[c], lit[c], own[c]);
            for k in 0..LANES {
                let missed = half_sag([width, per_unit], [a[k], slope_a[k]], [b[k], slope_b[k]]);
                let (x, d) = (amplitude * (a[k] - at[k] - missed), amplitude * (b[k] - a[k]));
                let (wx, wd) = (w[k] * x, w[k] * d);
                let wh = w[k] * amplitude * more.mul_add(b[k], missed);
                sums[0][k] = p[k].mul_add(x, sums[0][k]);
                sums[1][k] = p[k].mul_add(d, sums[1][k]);
                sums[2][k] = wx.mul_add(wx, sums[2][k]);
                sums[3][k] = wx.mul_add(wd, sums[3][k]);
                sums[4][k] = wd.mul_add(wd, sums[4][k]);
                sums[5][k] = wx.mul_add(wq[k], sums[5][k]);
                sums[6][k] = wd.mul_add(wq[k], sums[6][k]);
                sums[7][k] = wh.mul_add(wh, sums[7][k]);
            }
        }
        sums.map(|sum| fold(&sum))
    }
}

#[cfg(test)]
mod tests;
