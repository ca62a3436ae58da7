//! The quadratic about the best state on an interval of the one unknown temperature, where one amplitude, at most, is free.
//!
//! With counts N₀ = Σ c A(T*) + V* q + …, p = −r/s and the weights W of `metric`, no state within reach is below
//!
//! d² + Σ p (N′ − N₀) + Σ W² (N′ − N₀)²,   N′ − N₀ = c(A(T) − A(T*)) + δ q,
//!
//! where one source of known amplitude c has the unknown temperature and one amplitude may be free, V* + δ. On an interval A is
//! low + σ rise within ± half (`sources`), so that with h = p/(2W), φ the least of the sums with it over 0 ≤ σ ≤ 1 and δ (`rectangle`),
//! and m = ‖W c half‖
//!
//! d² ≥ cost − ‖h‖² + (√(‖h‖² + φ) − m)².
//!
//! Priors of T and of δ add their squares, which are of the same kind.
//!
//! The same sums say how much light a state within reach can have at most, and with that how bright each band: better weights.

use super::super::bound::CLEAR;
use super::super::closing::Minimum;
use super::super::sources::{Spectrum, half_sag};
use super::super::vectors::{counts_into, product_into, square_of_product, square_of_quotient};
use super::super::view::View;
use crate::aligned::Aligned;
use crate::identifiability::rectangle::OverRectangle;
use crate::simd::{Chunk, LANES, dispatched, fold};
use crate::sum::dot;

/// How often the weights are made better, and the share of what is wanting that this must bring to be tried again.
const BETTER: usize = 2;
const WORTH: f64 = 0.1;

/// The quadratic about the best state, but for what hangs on the interval.
pub(super) struct About<'m> {
    minimum: &'m Minimum,
    /// A(T*), T*, c.
    own: &'m [f64],
    own_k: f64,
    pub(super) amplitude: f64,
    /// q, Σ p q with what a prior of it pulls, and where δ may be; no q where no amplitude is free.
    light: Option<&'m [f64]>,
    pull_lit: f64,
    /// Of priors: ρ and ∂ρ/∂T of the axis, ∂ρ/∂δ of the light, and Σρ² of all.
    of_axis: [f64; 2],
    per_light: f64,
    of_priors: f64,
    range: [f64; 2],
    /// N and N₀, and their rounding as a share of them.
    counts: &'m [f64],
    seen: Aligned,
    rounding: f64,
}

/// Weights, and what they make of all that does not hang on the interval.
pub(super) struct Weighed {
    weight: Aligned,
    /// W q, ‖W q‖² with what a prior of it adds.
    lit: Aligned,
    lit_lit: f64,
    /// ‖h‖², and the rounding of counts as a length.
    shift: f64,
    grain: f64,
}

impl<'m> About<'m> {
    /// The quadratic about a minimum, both in these bands; `None` where more amplitudes are free.
    pub(super) fn new(view: &'m View<'_>, minimum: &'m Minimum, s: usize) -> Option<Self> {
        let amplitude = view.held(s)?;
        let allowed = &view.allowed;
        let open: Vec<usize> = (0..allowed.ranges.len()).filter(|&k| allowed.tied(k).is_none()).collect();
        let mut lit = None;
        let (light, range) = match open[..] {
            [] => (None, [0.0; 2]),
            // With a sum that is known the one light has what that says.
            [_] if allowed.sum_known && allowed.ranges.len() == 1 => (None, [0.0; 2]),
            [k] if !allowed.sum_known => {
                let [low, high] = allowed.ranges[k];
                lit = Some(k + 1);
                let ends = [low, high.min(allowed.sum).max(low)];
                (Some(&minimum.spectra[k + 1].counts[..]), ends.map(|end| end - minimum.amplitudes[k + 1]))
            }
            _ => return None,
        };
        let pull_lit = light.map_or(0.0, |light| dot(&minimum.pull, light));
        let mut seen = Aligned::unset(minimum.other.len());
        counts_into(&minimum.other, &view.noise, &mut seen);
        let (own, counts, rounding) = (&minimum.spectra[s].counts[..], &view.counts[..], view.rounding);
        let prior = |source: Option<usize>, of_temperature: bool, units: f64| {
            let row = minimum.priors.iter();
            let mut row =
                row.filter(|row| Some(row.source) == source && row.of_temperature == of_temperature);
            row.next().map_or([0.0; 2], |row| [row.residual, row.per_unit * units])
        };
        let (of_axis, of_light) = (prior(Some(s), true, amplitude), prior(lit, false, 1.0));
        let of_priors = minimum.priors.iter().map(|row| row.residual * row.residual).sum();
        Some(Self {
            minimum,
            own,
            own_k: minimum.spectra[s].temperature_k,
            amplitude,
            light,
            pull_lit: pull_lit + 2.0 * of_light[0] * of_light[1],
            of_axis,
            per_light: of_light[1],
            of_priors,
            range,
            counts,
            seen,
            rounding,
        })
    }

    pub(super) fn weighed(&self, weight: Aligned) -> Weighed {
        let mut lit = Aligned::zeros(weight.len());
        if let Some(light) = self.light {
            product_into(light, &weight, &mut lit);
        }
        let shift = 0.25 * square_of_quotient(&self.minimum.pull, &weight) + self.of_priors;
        let length = |x: &[f64]| square_of_product(x, &weight).sqrt();
        let grain = self.rounding * (length(self.counts) + length(&self.seen));
        let lit_lit = dot(&lit, &lit) + self.per_light * self.per_light;
        Weighed { weight, lit, lit_lit, shift, grain }
    }

    /// A lower bound of d² between two temperatures; `rounding` is that of spectra as a share of them.
    pub(super) fn bound(&self, with: &Weighed, ends: [&Spectrum; 2], rounding: f64, enough: f64) -> f64 {
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
        // The prior of the axis is ρ + ∂ρ/∂T (T − T*), ρ² of which is in the cost.
        let [residual, per_k] = self.of_axis;
        let (off, turn) =
            (per_k * (cold.temperature_k - self.own_k), per_k * (hot.temperature_k - cold.temperature_k));
        let square = square + off * (off + 2.0 * residual);
        let (across, steep) = (across + turn * (residual + off), steep + turn * turn);
        let (x, y, range) = (across + 0.5 * along, lit + 0.5 * self.pull_lit, self.range);
        let quadratic = OverRectangle { xx: steep, xy: lit_along, yy: *lit_lit, x, y, range };
        let farthest = range[0].abs().max(range[1].abs());
        let sizes = shift + square.abs() + off * off + steep + farthest * farthest * lit_lit;
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
