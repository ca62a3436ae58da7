//! Cuts the envelope and the alternative's range into parts small enough for a whitening and a cubic each.
//!
//! All counts grow with every temperature and lighting factor, so that the lower and the upper end of a part enclose
//! them, and
//!
//! d² ≥ Σ over bands of max(0, √(N_low+v) − √(N′_high+v), √(N′_low+v) − √(N_high+v))².
//!
//! A part for which this reaches the threshold is done with: an alternative far too hot, and most that are far too cold.
//! Others are halved until every temperature T ± ΔT has ΔT/T ≤ 0.08 ([`WIDEST`]) and the variances keep their
//! proportions: where target and alternative agree, N + v lies between the higher of their lower ends and the lower of
//! their upper ends, and ln of the ratio of these two may differ from band to band by 1.6 ([`SKEWED`]).

use super::model::{Model, Region, Source, Span};
use rayon::prelude::*;

/// A source that is weaker than this share of the distance attained is not resolved in temperature.
pub(super) const FAINT: f64 = 3e-4;
/// Largest half width of a temperature, as a share of its middle.
const WIDEST: f64 = 0.08;
/// How far the variances of bands may change differently: ln of the ratio of ratios. Bounds do without; only the
/// basis is chosen for one variance.
const SKEWED: f64 = 1.6;
/// Parts beyond which proportions no longer matter.
const MANY: usize = 600;
/// Rounding of a count, relative.
const ROUNDING: f64 = 1e-14;

/// A part that is left, with a variance of each band that is typical where target and alternative agree.
pub(super) struct Part {
    pub(super) region: Region,
    pub(super) variance: Vec<f64>,
    /// By what share of itself that of each band may differ, beyond what all bands have in common.
    pub(super) skew: Vec<f64>,
    /// Proved of the part as a whole.
    pub(super) bound: f64,
}

/// What is to be done with a part.
enum Verdict {
    Beyond(f64),
    Halve([Region; 2]),
    Keep(Part),
}

/// The parts in which distances below `threshold` are not excluded, and the least bound of those in which they are.
pub(super) fn partition(model: &Model<'_>, whole: Region, threshold: f64, attained: f64) -> (Vec<Part>, f64) {
    let (mut kept, mut least) = (Vec::new(), f64::INFINITY);
    let mut frontier = vec![whole];
    while !frontier.is_empty() {
        let many = kept.len() + frontier.len() > MANY;
        let verdicts: Vec<Verdict> =
            frontier.into_par_iter().map(|region| assess(model, region, threshold, attained, many)).collect();
        frontier = Vec::new();
        for verdict in verdicts {
            match verdict {
                Verdict::Beyond(bound) => least = least.min(bound),
                Verdict::Halve(halves) => frontier.extend(halves),
                Verdict::Keep(part) => kept.push(part),
            }
        }
    }
    (kept, least)
}

/// Counts of target and alternative at the lower and upper ends of a part.
struct Ends {
    target: [Vec<f64>; 2],
    alternative: [Vec<f64>; 2],
    /// What each source adds to their mean from the lower to the upper end of its temperature, v and w.
    changes: Vec<[Vec<f64>; 3]>,
    /// Magnitude of N − N′ at the upper end, source by source.
    magnitudes: Vec<Vec<f64>>,
}

impl Ends {
    fn add(&mut self, model: &Model<'_>, source: &Source, span: &Span) {
        let bands = model.var.len();
        let radiance = span.t.map(|t| model.radiance(t));
        let seen = |strength: &[f64]| [0, 1].map(|end: usize| model.counts(strength, &radiance[end]));
        let (target, alternative, alone) =
            (seen(&source.target), seen(&source.alternative), seen(&source.alone));
        for end in [0, 1] {
            let (v, w) = (span.own[end], span.other[end]);
            for band in 0..bands {
                self.target[end][band] += v * target[end][band];
                self.alternative[end][band] += v * alternative[end][band] + w * alone[end][band];
            }
        }
        let mut changes = [vec![0.0; bands], vec![0.0; bands], vec![0.0; bands]];
        let middle = |range: [f64; 2]| 0.5 * (range[0] + range[1]);
        for band in 0..bands {
            let both = |end: usize| 0.5 * (target[end][band] + alternative[end][band]);
            let lone = |end: usize| 0.5 * alone[end][band];
            let [v, w] = [span.own, span.other].map(middle);
            changes[0][band] = v * (both(1) - both(0)) + w * (lone(1) - lone(0));
            changes[1][band] = (span.own[1] - span.own[0]) * middle([both(0), both(1)]);
            changes[2][band] = (span.other[1] - span.other[0]) * middle([lone(0), lone(1)]);
        }
        self.changes.push(changes);
        let magnitude = |strength: &[f64], factor: f64| {
            let strength: Vec<f64> = strength.iter().map(|x| factor * x.abs()).collect();
            model.counts(&strength, &radiance[1])
        };
        let (own, other) = (magnitude(&source.own, span.own[1]), magnitude(&source.other, span.other[1]));
        self.magnitudes.push(own.iter().zip(&other).map(|(a, b)| a + b).collect());
    }
}

fn ends(model: &Model<'_>, region: &Region) -> Ends {
    let zeros = || vec![0.0; model.var.len()];
    let mut ends = Ends {
        target: [zeros(), zeros()],
        alternative: [zeros(), zeros()],
        changes: Vec::new(),
        magnitudes: Vec::new(),
    };
    for (source, span) in model.sources.iter().zip(region) {
        ends.add(model, source, span);
    }
    ends
}

/// What is to be done with a part: nothing more, halving what is too wide, or keeping it.
fn assess(model: &Model<'_>, region: Region, threshold: f64, attained: f64, many: bool) -> Verdict {
    let ends = ends(model, &region);
    let Likeness { bound, variance, ratios, mut skew } = Likeness::of(model, &ends);
    if bound >= threshold {
        return Verdict::Beyond(bound);
    }
    if let Some(s) = widest_temperature(&region, &ends, &variance, attained) {
        return Verdict::Halve(halved(&region, s, 0));
    }
    if ratios[1] - ratios[0] > SKEWED
        && !many
        && let Some((s, which)) = most_skewing(&ends, &variance)
    {
        return Verdict::Halve(halved(&region, s, which));
    }
    let common = 0.5 * (ratios[0] + ratios[1]);
    skew.iter_mut().for_each(|ratio| *ratio = 0.5 * (*ratio - common));
    Verdict::Keep(Part { region, variance, skew, bound })
}

/// How near target and alternative can come in a part, and what variances they then have.
struct Likeness {
    /// A lower bound of the distance.
    bound: f64,
    /// Variance of each band in the middle of what both can have.
    variance: Vec<f64>,
    /// ln of the highest over the lowest variance that both can have, band by band; the least and the largest of them.
    skew: Vec<f64>,
    ratios: [f64; 2],
}

impl Likeness {
    fn of(model: &Model<'_>, ends: &Ends) -> Self {
        let mut square = 0.0;
        let mut variance = vec![0.0; model.var.len()];
        let mut skew = vec![0.0; model.var.len()];
        let mut ratios = [f64::INFINITY, f64::NEG_INFINITY];
        for (band, (variance, v)) in variance.iter_mut().zip(&model.var).enumerate() {
            let [low, high] = [0, 1].map(|end: usize| ends.target[end][band] + v);
            let [other_low, other_high] = [0, 1].map(|end: usize| ends.alternative[end][band] + v);
            let gap = |above: f64, below: f64| above.sqrt() * (1.0 - ROUNDING) - below.sqrt();
            let apart = gap(low, other_high).max(gap(other_low, high)).max(0.0);
            square += apart * apart;
            let common = [low.max(other_low), high.min(other_high)];
            *variance = 0.5 * (common[0] + common[1]);
            if *variance > 0.0 && common[0] > 0.0 {
                let ratio = (common[1] / common[0]).ln();
                skew[band] = ratio;
                ratios = [ratios[0].min(ratio), ratios[1].max(ratio)];
            }
        }
        Self { bound: square.sqrt() * (1.0 - 1e-12), variance, skew, ratios }
    }
}

/// The source whose temperature is too wide for a cubic, the widest, among those that can be seen at all.
fn widest_temperature(region: &Region, ends: &Ends, variance: &[f64], attained: f64) -> Option<usize> {
    let mut widest = (WIDEST, None);
    for (s, span) in region.iter().enumerate() {
        let [low, high] = span.t;
        let width = (high - low) / (high + low);
        if width > widest.0 {
            let counts = ends.magnitudes[s].iter().zip(variance);
            let square: f64 = counts.map(|(n, c)| if *c > 0.0 { 0.25 * n * n / c } else { 0.0 }).sum();
            if square.sqrt() > FAINT * attained {
                widest = (width, Some(s));
            }
        }
    }
    widest.1
}

/// The source, and which of its temperature, v and w (0, 1, 2), that changes the proportions of the variances most.
fn most_skewing(ends: &Ends, variance: &[f64]) -> Option<(usize, usize)> {
    let mut most = (0.0, None);
    for (s, changes) in ends.changes.iter().enumerate() {
        for (which, change) in changes.iter().enumerate() {
            let mut range = [f64::INFINITY, f64::NEG_INFINITY];
            for (change, c) in change.iter().zip(variance).filter(|(_, c)| **c > 0.0) {
                range = [range[0].min(change / c), range[1].max(change / c)];
            }
            if range[1] - range[0] > most.0 {
                most = (range[1] - range[0], Some((s, which)));
            }
        }
    }
    most.1
}

/// Halves of a part: at the geometric mean of a temperature, at the middle of v or w.
fn halved(region: &Region, s: usize, which: usize) -> [Region; 2] {
    let mut halves = [region.clone(), region.clone()];
    for (half, region) in halves.iter_mut().enumerate() {
        let span = &mut region[s];
        let range = [&mut span.t, &mut span.own, &mut span.other].into_iter().nth(which);
        if let Some(range) = range {
            let middle = if which == 0 { (range[0] * range[1]).sqrt() } else { 0.5 * (range[0] + range[1]) };
            range[1 - half] = middle;
        }
    }
    halves
}
