//! A part of the envelope with its own whitening and basis, and intervals of temperature with what is known of them.
//!
//! In a cell counts are divided by 2√c, c a variance of each band in the middle of what target and alternative can both
//! be there: ω = 1/(2√c). Spectra are then kept as their components along an orthonormal basis Q of whitened spectra of the
//! cell. For *any* weights z of the bands,
//!
//! d(θ, θ′) ≥ Σ z_w ω_w(N − N′)_w / √(Σ z_w² ĉ_w/c_w),   ĉ = ¼(1 + s)(N + v) + ¼(1 + 1/s)(N′ + v) at the upper ends of a box,
//!
//! because √(N+v) − √(N′+v) = (N − N′)/(√(N+v) + √(N′+v)), (√a + √b)² ≤ 4ĉ for any s > 0 (2√(ab) ≤ sa + b/s; best where
//! s² = b/a, which is taken from the best scene known), N and N′ grow with every temperature and lighting factor, and by
//! Cauchy and Schwarz. With z = Qu:
//!
//! | | | kept here as |
//! |---|---|---|
//! | numerator | u·Qᵀω(N − N′) = Σ_s u·Qᵀω[v f(T) + w g(T)] | Qᵀωf, Qᵀωg as cubics in T with remainders (`series`) |
//! | denominator | √(uᵀMu), M = Σ_w q_w q_wᵀ ĉ_w/c_w | shares of v and w in M at the upper end of T |
//!
//! Neither c nor Q is an approximation in a bound: a basis or weights that are not the best lose only in the second
//! order of what they miss.
//!
//! Rounding: components are sums over W bands and R basis vectors; 2√R W ulp of the largest whitened signals, and some
//! hundred more for Planck's function and the short sums, are taken off every bound.

use super::linear::{PAIRS, RANK, Vector};
use super::model::{Model, Region, SOURCES, Span};
use super::partition::{FAINT, Part};
use super::series::{TERMS, planck_series, remainder};
use crate::sum::dot;

/// Radii of the discs of Cauchy's estimate, as shares of the lowest temperature.
const RADII: [f64; 5] = [0.2, 0.4, 0.6, 0.8, 0.95];
/// The basis is complete when nothing is left of a spectrum but this share of the distance attained.
const LEFT_OVER: f64 = 1e-3;
/// What is left of a spectrum times the skew of variances is this much less of a loss: the weights of bands need not be
/// known as well as their differences.
const WEIGHT_OF_SKEW: f64 = 0.03;
/// Intervals are not halved below this share of their temperature.
const NARROWEST: f64 = 1e-9;

pub(super) type Cubic = [Vector; TERMS];

/// An interval of the temperature of a source.
#[derive(Debug, Clone)]
pub(super) struct Node {
    pub(super) t: [f64; 2],
    /// Qᵀω f and Qᵀω g as cubics, and the norms of what these leave.
    pub(super) own: Cubic,
    pub(super) other: Cubic,
    pub(super) own_rest: f64,
    pub(super) other_rest: f64,
    /// Shares of v and w in M at the upper end.
    pub(super) own_spread: Box<[f64; PAIRS]>,
    pub(super) other_spread: Box<[f64; PAIRS]>,
    /// Place of the first of two halves.
    pub(super) halves: Option<u32>,
}

/// Intervals of one source, and the norms of f and g at the reach of each disc.
#[derive(Debug)]
pub(super) struct Intervals {
    pub(super) nodes: Vec<Node>,
    lowest_k: f64,
    own_reach: [f64; RADII.len()],
    other_reach: [f64; RADII.len()],
    faint: bool,
}

#[derive(Debug)]
pub(super) struct Cell {
    pub(super) region: Region,
    /// ω, and 1/c.
    whitening: Vec<f64>,
    per_variance: Vec<f64>,
    /// The components of each band along the basis, and how many there are.
    basis: Vec<Vector>,
    pub(super) rank: usize,
    pub(super) sources: Vec<Intervals>,
    pub(super) var_spread: Box<[f64; PAIRS]>,
    pub(super) slack: f64,
}

impl Cell {
    /// Prepares a part of the envelope, with a distance for what is negligible.
    pub(super) fn new(model: &Model<'_>, part: &Part, attained: f64) -> Self {
        let (region, variance) = (part.region.clone(), &part.variance);
        let usable = |c: &f64| *c > 0.0;
        let per_variance: Vec<f64> = variance.iter().map(|c| if usable(c) { 1.0 / c } else { 0.0 }).collect();
        let whitening: Vec<f64> = per_variance.iter().map(|inverse| 0.5 * inverse.sqrt()).collect();
        let mut cell = Self {
            region,
            whitening,
            per_variance,
            basis: vec![[0.0; RANK]; variance.len()],
            rank: 0,
            sources: Vec::new(),
            var_spread: Box::new([0.0; PAIRS]),
            slack: 0.0,
        };
        let samples = cell.samples(model, &part.skew);
        cell.set_basis(&orthonormal(samples, LEFT_OVER * attained));
        let shares = model.shares[0].iter().zip(&model.shares[1]);
        let var: Vec<f64> = model.var.iter().zip(shares).map(|(v, (a, b))| v * (a + b)).collect();
        cell.var_spread = cell.spread(&var);
        let mut size = 0.0;
        for s in 0..cell.region.len().min(SOURCES) {
            let (intervals, largest) = cell.unhalved(model, s, FAINT * attained);
            size += largest;
            cell.sources.push(intervals);
            let t = cell.region[s].t;
            let root = cell.node(model, s, t, cell.spreads(model, s, t[1]));
            cell.sources[s].nodes.push(root);
        }
        let ulps = 2.0 * (RANK as f64).sqrt() * variance.len() as f64 + 400.0;
        cell.slack = ulps * f64::EPSILON * size;
        cell
    }

    /// A source without intervals yet, and the norm of the most that it can give.
    fn unhalved(&self, model: &Model<'_>, s: usize, faint: f64) -> (Intervals, f64) {
        let Span { t, own, other } = self.region[s];
        let (own_top, other_top) = self.norms(model, s, t[1]);
        let largest = own[1] * own_top + other[1] * other_top;
        let reach = RADII.map(|share| self.norms(model, s, t[1] + share * t[0]));
        let intervals = Intervals {
            nodes: Vec::new(),
            lowest_k: t[0],
            own_reach: reach.map(|norms| norms.0),
            other_reach: reach.map(|norms| norms.1),
            faint: largest <= faint,
        };
        (intervals, largest)
    }

    /// Norms of the whitened magnitudes of f and g at a temperature.
    fn norms(&self, model: &Model<'_>, s: usize, temperature_k: f64) -> (f64, f64) {
        let radiance = model.radiance(temperature_k);
        let norm = |strength: &[f64]| {
            let magnitude: Vec<f64> = strength.iter().map(|x| x.abs()).collect();
            let counts = self.whitened(model.counts(&magnitude, &radiance));
            dot(&counts, &counts).sqrt()
        };
        (norm(&model.sources[s].own), norm(&model.sources[s].other))
    }

    fn whitened(&self, mut counts: Vec<f64>) -> Vec<f64> {
        counts.iter_mut().zip(&self.whitening).for_each(|(count, w)| *count *= w);
        counts
    }

    /// What the basis has to span: whitened spectra at Chebyshev points of every temperature, and what they become if the
    /// variances change.
    fn samples(&self, model: &Model<'_>, skew: &[f64]) -> Vec<Vec<f64>> {
        let mut samples = Vec::new();
        for (source, span) in model.sources.iter().zip(&self.region) {
            for point in 0..5 {
                let place = (f64::from(2 * point + 1) * std::f64::consts::PI / 10.0).cos();
                let t = 0.5 * (span.t[0] + span.t[1]) + 0.5 * (span.t[1] - span.t[0]) * place;
                let radiance = model.radiance(t);
                for (strength, factor) in [(&source.own, span.own[1]), (&source.other, span.other[1])] {
                    let mut counts = self.whitened(model.counts(strength, &radiance));
                    counts.iter_mut().for_each(|count| *count *= factor);
                    samples.push(
                        counts.iter().zip(skew).map(|(count, skew)| WEIGHT_OF_SKEW * count * skew).collect(),
                    );
                    samples.push(counts);
                }
            }
        }
        samples
    }

    /// Takes orthonormal vectors, at most [`RANK`], as the basis.
    fn set_basis(&mut self, vectors: &[Vec<f64>]) {
        self.rank = vectors.len();
        for (r, vector) in vectors.iter().enumerate() {
            for (row, x) in self.basis.iter_mut().zip(vector) {
                row[r] = *x;
            }
        }
    }

    /// Qᵀω of counts.
    fn components(&self, counts: &[f64]) -> Vector {
        let mut out = [0.0; RANK];
        for ((row, count), w) in self.basis.iter().zip(counts).zip(&self.whitening) {
            let value = count * w;
            for (out, q) in out.iter_mut().zip(row) {
                *out += q * value;
            }
        }
        out
    }

    /// Σ q qᵀ of the bands times `var`/c, the lines of its upper half.
    fn spread(&self, var: &[f64]) -> Box<[f64; PAIRS]> {
        let mut square = [[0.0; RANK]; RANK];
        for ((row, var), inverse) in self.basis.iter().zip(var).zip(&self.per_variance) {
            let share = var * inverse;
            for (i, line) in square.iter_mut().enumerate().take(self.rank) {
                let factor = share * row[i];
                for (out, q) in line.iter_mut().zip(row) {
                    *out += factor * q;
                }
            }
        }
        let mut packed = Box::new([0.0; PAIRS]);
        let places = (0..RANK).flat_map(|i| (i..RANK).map(move |j| (i, j)));
        for (out, (i, j)) in packed.iter_mut().zip(places) {
            *out = square[i][j];
        }
        packed
    }

    fn spreads(&self, model: &Model<'_>, s: usize, temperature_k: f64) -> [Box<[f64; PAIRS]>; 2] {
        let (source, radiance) = (&model.sources[s], model.radiance(temperature_k));
        let [target, alternative, alone] = [&source.target, &source.alternative, &source.alone]
            .map(|strength| model.counts(strength, &radiance));
        let [share, other_share] = &model.shares;
        let sum = |a: &[f64], b: &[f64]| -> Vec<f64> {
            let terms = a.iter().zip(share).zip(b.iter().zip(other_share));
            terms.map(|((a, share), (b, other))| a * share + b * other).collect()
        };
        let nothing = vec![0.0; alone.len()];
        [self.spread(&sum(&target, &alternative)), self.spread(&sum(&nothing, &alone))]
    }

    fn node(&self, model: &Model<'_>, s: usize, t: [f64; 2], top: [Box<[f64; PAIRS]>; 2]) -> Node {
        let [own_spread, other_spread] = top;
        let intervals = &self.sources[s];
        let (centre, half) = (0.5 * (t[0] + t[1]), 0.5 * (t[1] - t[0]));
        let mut node = Node {
            t,
            own: [[0.0; RANK]; TERMS],
            other: [[0.0; RANK]; TERMS],
            own_rest: 0.0,
            other_rest: 0.0,
            own_spread,
            other_spread,
            halves: None,
        };
        if intervals.faint {
            (node.own_rest, node.other_rest) = self.norms(model, s, t[1]);
            return node;
        }
        let source = &model.sources[s];
        let series = planck_series(model.scene.bands.nodes_cm1(), centre, half);
        for (term, radiance) in series.iter().enumerate() {
            node.own[term] = self.components(&model.counts(&source.own, radiance));
            if source.object {
                node.other[term] = self.components(&model.counts(&source.other, radiance));
            }
        }
        let least = |norms: &[f64; RADII.len()]| {
            let radii = RADII.iter().zip(norms);
            radii
                .map(|(share, norm)| norm * remainder(half, share * intervals.lowest_k))
                .fold(f64::INFINITY, f64::min)
        };
        (node.own_rest, node.other_rest) = (least(&intervals.own_reach), least(&intervals.other_reach));
        node
    }

    /// Whether an interval can be halved further.
    pub(super) fn divisible(&self, s: usize, node: u32) -> bool {
        let intervals = &self.sources[s];
        let [low, high] = intervals.nodes[node as usize].t;
        !intervals.faint && high - low > NARROWEST * high
    }

    /// The two halves of an interval.
    pub(super) fn halve(&self, model: &Model<'_>, s: usize, node: u32) -> [Node; 2] {
        let whole = &self.sources[s].nodes[node as usize];
        let [low, high] = whole.t;
        let middle = 0.5 * (low + high);
        let top = [whole.own_spread.clone(), whole.other_spread.clone()];
        [
            self.node(model, s, [low, middle], self.spreads(model, s, middle)),
            self.node(model, s, [middle, high], top),
        ]
    }
}

/// An orthonormal basis of samples but for what is negligible, the largest remainder first (Gram and Schmidt, twice).
fn orthonormal(mut samples: Vec<Vec<f64>>, negligible: f64) -> Vec<Vec<f64>> {
    let mut basis: Vec<Vec<f64>> = Vec::new();
    while basis.len() < RANK {
        let norms: Vec<f64> = samples.iter().map(|sample| dot(sample, sample)).collect();
        let Some(largest) = (0..norms.len()).max_by(|&a, &b| norms[a].total_cmp(&norms[b])) else {
            break;
        };
        let mut next = samples.swap_remove(largest);
        if norms[largest].sqrt() <= negligible {
            break;
        }
        basis.iter().for_each(|known| remove(&mut next, known));
        let norm = dot(&next, &next).sqrt();
        if norm <= 0.0 {
            continue;
        }
        next.iter_mut().for_each(|x| *x /= norm);
        samples.iter_mut().for_each(|sample| remove(sample, &next));
        basis.push(next);
    }
    basis
}

/// Takes from a vector what it has along a unit vector.
fn remove(from: &mut [f64], unit: &[f64]) {
    let along = dot(from, unit);
    from.iter_mut().zip(unit).for_each(|(x, u)| *x -= along * u);
}
