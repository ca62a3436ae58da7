//! Cuts the scenes of an envelope into parts small enough for a whitening each.
//!
//! Parts are halved until every temperature T ± ΔT of the scene has ΔT/T ≤ 0.08 ([`WIDEST`]) and the variances of the
//! target keep their proportions: ln of the ratio of the highest to the lowest N + v may differ from band to band by 1.6
//! ([`SKEWED`]). What the alternative may be is the same in every part.

use super::model::{Model, Region, Source, Span};
use crate::parallel;

/// Largest half width of a temperature of the scene, as a share of its middle.
pub(super) const WIDEST: f64 = 0.08;
/// A source that is weaker than this share of the distance attained is not resolved in temperature.
pub(super) const FAINT: f64 = 3e-4;
/// How far the variances of bands may change differently: ln of the ratio of ratios. Bounds do without; only the
/// basis is chosen for one variance.
const SKEWED: f64 = 1.6;
/// Parts beyond which proportions no longer matter.
const MANY: usize = 600;

/// A part of the scenes, with every state of the alternative.
pub(super) struct Part {
    pub(super) region: Region,
    /// Variance of each band in the middle of what the target can have, and the most that it can.
    pub(super) variance: Vec<f64>,
    pub(super) most: Vec<f64>,
    /// The most counts of the target alone.
    pub(super) seen: Vec<f64>,
    /// By what share of itself that of each band may differ, beyond what all bands have in common.
    pub(super) skew: Vec<f64>,
}

/// What is to be done with a part.
enum Verdict {
    Halve([Region; 2]),
    Keep(Part),
}

/// The parts of an envelope in which `attained` is the least distance known.
pub(super) fn partition(model: &Model<'_>, whole: Region, attained: f64) -> Vec<Part> {
    let mut kept = Vec::new();
    let mut frontier = vec![whole];
    while !frontier.is_empty() {
        let many = kept.len() + frontier.len() > MANY;
        let verdicts: Vec<Verdict> =
            parallel::map(frontier.len(), |i| assess(model, frontier[i].clone(), attained, many));
        frontier = Vec::new();
        for verdict in verdicts {
            match verdict {
                Verdict::Halve(halves) => frontier.extend(halves),
                Verdict::Keep(part) => kept.push(part),
            }
        }
    }
    kept
}

/// Counts of the target at the lower and upper ends of a part.
struct Ends {
    target: [Vec<f64>; 2],
    /// What each source adds to their mean from the lower to the upper end of its temperature, and of v.
    changes: Vec<[Vec<f64>; 2]>,
    /// Magnitude of what a source of the scene can give at the upper end.
    magnitudes: Vec<Vec<f64>>,
}

impl Ends {
    fn of(model: &Model<'_>, region: &Region) -> Self {
        let zeros = || vec![0.0; model.var.len()];
        let mut ends = Self { target: [zeros(), zeros()], changes: Vec::new(), magnitudes: Vec::new() };
        for (source, span) in model.sources.iter().zip(region) {
            ends.add(model, source, span);
        }
        ends
    }

    fn add(&mut self, model: &Model<'_>, source: &Source, span: &Span) {
        let bands = model.var.len();
        if source.role.is_free() {
            self.changes.push([vec![0.0; bands], vec![0.0; bands]]);
            self.magnitudes.push(vec![0.0; bands]);
            return;
        }
        let radiance = span.t.map(|t| model.radiance(t));
        let target = [0, 1].map(|end: usize| model.counts(&source.target, &radiance[end]));
        for (end, counts) in target.iter().enumerate() {
            for (sum, n) in self.target[end].iter_mut().zip(counts) {
                *sum += span.own[end] * n;
            }
        }
        let mut changes = [vec![0.0; bands], vec![0.0; bands]];
        for band in 0..bands {
            let [low, high] = [target[0][band], target[1][band]];
            changes[0][band] = 0.5 * (span.own[0] + span.own[1]) * (high - low);
            changes[1][band] = (span.own[1] - span.own[0]) * 0.5 * (low + high);
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

/// What is to be done with a part: halving what is too wide, or keeping it.
fn assess(model: &Model<'_>, region: Region, attained: f64, many: bool) -> Verdict {
    let ends = Ends::of(model, &region);
    let [low, high] = [0, 1].map(|end: usize| -> Vec<f64> {
        ends.target[end].iter().zip(&model.var).map(|(n, v)| n + v).collect()
    });
    let variance: Vec<f64> = low.iter().zip(&high).map(|(low, high)| 0.5 * (low + high)).collect();
    if let Some(s) = widest_temperature(model, &region, &ends, &variance, attained) {
        return Verdict::Halve(halved(&region, s, 0));
    }
    let known = || low.iter().zip(&high).filter(|(low, _)| **low > 0.0);
    let ratios = known().map(|(low, high)| (high / low).ln());
    let [least, most] =
        ratios.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], ratio| [a.min(ratio), b.max(ratio)]);
    if most - least > SKEWED
        && !many
        && let Some((s, which)) = most_skewing(&ends, &variance)
    {
        return Verdict::Halve(halved(&region, s, which));
    }
    let common = if least <= most { 0.5 * (least + most) } else { 0.0 };
    let skew = low.iter().zip(&high).map(|(low, high)| {
        let ratio = if *low > 0.0 { (high / low).ln() } else { 0.0 };
        0.5 * (ratio - common)
    });
    let skew = skew.collect();
    let [_, seen] = ends.target;
    Verdict::Keep(Part { region, variance, seen, most: high, skew })
}

/// The source of the scene whose temperature is too wide for a cubic, the widest, among those that can be seen at all.
fn widest_temperature(
    model: &Model<'_>,
    region: &Region,
    ends: &Ends,
    variance: &[f64],
    attained: f64,
) -> Option<usize> {
    let mut widest = (WIDEST, None);
    for (s, (span, source)) in region.iter().zip(&model.sources).enumerate() {
        let [low, high] = span.t;
        let width = (high - low) / (high + low);
        if width > widest.0 && !source.role.is_free() {
            let counts = ends.magnitudes[s].iter().zip(variance);
            let square: f64 = counts.map(|(n, c)| if *c > 0.0 { 0.25 * n * n / c } else { 0.0 }).sum();
            if square.sqrt() > FAINT * attained {
                widest = (width, Some(s));
            }
        }
    }
    widest.1
}

/// The source, and which of its temperature and v (0, 1), that changes the proportions of the variances most.
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

/// Halves of a part: at the geometric mean of a temperature, at the middle of v.
fn halved(region: &Region, s: usize, which: usize) -> [Region; 2] {
    let mut halves = [region.clone(), region.clone()];
    for (half, region) in halves.iter_mut().enumerate() {
        let span = &mut region[s];
        let range = if which == 0 { &mut span.t } else { &mut span.own };
        let middle = if which == 0 { (range[0] * range[1]).sqrt() } else { 0.5 * (range[0] + range[1]) };
        range[1 - half] = middle;
    }
    halves
}
