//! A part of the scenes with its own whitening and basis.
//!
//! In a cell counts are divided by 2√c, c a variance of each band in the middle of what the target can have there:
//! ω = 1/(2√c). Spectra are then kept as their components along an orthonormal basis Q of whitened spectra of the
//! cell. With r = √(N+v) − √(N′+v) and *any* weights y of the bands there are two bounds from below:
//!
//! 1. N − N′ = 2r√(N+v) − r², so that Σ y(N − N′) ≤ 2d‖y√(N+v)‖ + d² max|y|, of which the target alone says all:
//!
//!    d ≥ n/(A + √(A² + hn)),   n = Σ y(N − N′) ≥ 0,   A = ‖y√(N+v)‖,   h = max|y|.
//!
//!    It loses about dh/2A, next to nothing where counts are many ([`Weighing::Target`]).
//! 2. N − N′ = r(√(N+v) + √(N′+v)), (√a + √b)² ≤ 4ĉ, ĉ = ¼(1 + s)a + ¼(1 + 1/s)b, for any s > 0 (2√(ab) ≤ sa + b/s; best
//!    where s² = b/a, which is taken from the best scene known), so that d ≥ n/(2√(Σ y²ĉ)) ([`Weighing::Both`]).
//!
//! N and N′ grow with every temperature and factor: variances are those at the upper ends of a box. With y = ωQu:
//!
//! | | | kept here as |
//! |---|---|---|
//! | n | u·Qᵀω(N − N′) = Σ_s u·Qᵀω[v f(T) + w g(T)] | Qᵀωf, Qᵀωg (`node`) |
//! | 2A | √(uᵀMu), M = Σ_b q_b q_bᵀ (N+v)_b/c_b, or ĉ in place of N + v | shares of v and w in M |
//! | h | ≤ max ω_b‖q_b‖ for ‖u‖ = 1 | |
//!
//! Neither c nor Q is an approximation in a bound: a basis or weights that are not the best lose only in the second
//! order of what they miss. That they are good where it counts is seen to by the best point known, whose r is in Q.
//!
//! Rounding: components are sums over W bands and R basis vectors; 2√R W ulp of the largest whitened signals, and some
//! thousand more for Planck's function and the short sums, are taken off every bound.

use super::joint::Residual;
use super::linear::{PAIRS, RANK, Vector};
use super::model::{Model, Region};
use super::node::{Node, Spread};
use super::partition::{FAINT, Part, WIDEST};
use crate::sum::dot;

/// The basis is complete when nothing is left of a spectrum but this share of the distance attained.
const LEFT_OVER: f64 = 1e-3;
/// What is left of a spectrum times the skew of variances is this much less of a loss: the weights of bands need not be
/// known as well as their differences.
const WEIGHT_OF_SKEW: f64 = 0.03;
/// Steps between the temperatures of the alternative that the basis is chosen for, as a ratio.
const STEP: f64 = 1.35;
/// Rounding of Planck's function far in its Wien tail and of short sums, ulp.
const PLANCK_ULPS: f64 = 2000.0;
/// What weighing by the target alone may lose of a distance.
const LOSS: f64 = 5e-4;

/// Whose counts the variances of a cell are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Weighing {
    /// The target's alone, with what h is at most.
    Target { highest: f64 },
    /// Those of target and alternative.
    Both,
}

#[derive(Debug)]
pub(super) struct Cell {
    pub(super) region: Region,
    /// ω, and 1/c.
    whitening: Vec<f64>,
    per_variance: Vec<f64>,
    /// The most counts of the alternative with which it may be nearer than the distance attained.
    pub(super) brightest: Vec<f64>,
    /// The components of each band along the basis, and how many there are.
    basis: Vec<Vector>,
    pub(super) rank: usize,
    pub(super) weighing: Weighing,
    /// The intervals of every source, whole ranges first.
    pub(super) sources: Vec<Vec<Node>>,
    pub(super) var_spread: Box<[f64; PAIRS]>,
    /// What is negligible, and the least distance known.
    pub(super) faint: f64,
    pub(super) attained: f64,
    /// Rounding of a component as a share of its size.
    pub(super) rounding: f64,
}

impl Cell {
    /// Prepares a part of an envelope of which `best` is the nearest point known, at the distance `attained`, priors and all.
    pub(super) fn new(model: &Model<'_>, part: &Part, best: &Residual, attained: f64) -> Self {
        crate::stop::check();
        let (region, variance) = (part.region.clone(), &part.variance);
        let usable = |c: &f64| *c > 0.0;
        let per_variance: Vec<f64> = variance.iter().map(|c| if usable(c) { 1.0 / c } else { 0.0 }).collect();
        let whitening: Vec<f64> = per_variance.iter().map(|inverse| 0.5 * inverse.sqrt()).collect();
        // (√(N + v) + D)² − v without the difference, of which much noise would leave nothing.
        let brightest = part.most.iter().zip(&part.seen);
        let brightest = brightest.map(|(var, n)| n + attained * (2.0 * var.sqrt() + attained));
        let ulps = 2.0 * (RANK as f64).sqrt() * variance.len() as f64 + PLANCK_ULPS;
        let mut cell = Self {
            region,
            whitening,
            per_variance,
            brightest: brightest.collect(),
            basis: vec![[0.0; RANK]; variance.len()],
            rank: 0,
            weighing: Weighing::Both,
            sources: Vec::new(),
            var_spread: Box::new([0.0; PAIRS]),
            faint: FAINT * attained,
            attained,
            rounding: ulps * f64::EPSILON,
        };
        let samples = cell.samples(model, &part.skew);
        cell.set_basis(&orthonormal(cell.directions(model, best), samples, LEFT_OVER * attained));
        let rows = cell.basis.iter().zip(&cell.whitening);
        let highest = rows.map(|(row, w)| w * dot(row, row).sqrt()).fold(0.0, f64::max) * (1.0 + 1e-12);
        // A is ½ about where variances are those of the cell.
        if attained * highest <= LOSS {
            cell.weighing = Weighing::Target { highest };
        }
        let [own, other] = cell.shares(model);
        let var: Vec<f64> = (0..model.var.len()).map(|b| model.var[b] * (own(b) + other(b))).collect();
        cell.var_spread = cell.spread(&var);
        for s in 0..cell.region.len() {
            let root = cell.root(model, s);
            cell.sources.push(vec![root]);
        }
        cell
    }

    /// Shares of N + v and N′ + v in the variance of a band.
    fn shares<'m>(&self, model: &'m Model<'_>) -> [Box<dyn Fn(usize) -> f64 + 'm>; 2] {
        match self.weighing {
            Weighing::Target { .. } => [Box::new(|_| 1.0), Box::new(|_| 0.0)],
            Weighing::Both => [Box::new(|b| model.shares[0][b]), Box::new(|b| model.shares[1][b])],
        }
    }

    pub(super) fn whitened(&self, mut counts: Vec<f64>) -> Vec<f64> {
        counts.iter_mut().zip(&self.whitening).for_each(|(count, w)| *count *= w);
        counts
    }

    /// The weights of bands that are best at the best point known.
    fn directions(&self, model: &Model<'_>, best: &Residual) -> Vec<Vec<f64>> {
        let safe = |x: f64| if x > 0.0 { 1.0 / x.sqrt() } else { 0.0 };
        let bands = best.rows.iter().enumerate().map(|(b, r)| {
            let [own, other] = [&best.target, &best.alternative].map(|counts| counts[b] + model.var[b]);
            let mean = 0.25 * (own.max(0.0).sqrt() + other.max(0.0).sqrt()).powi(2);
            r * safe(mean) * safe(self.per_variance[b])
        });
        vec![bands.collect()]
    }

    /// What the basis has to span: whitened spectra at Chebyshev points of every temperature of the scene, at
    /// steps of those of the alternative, and what they become if the variances change.
    fn samples(&self, model: &Model<'_>, skew: &[f64]) -> Vec<Vec<f64>> {
        crate::stop::check();
        let mut samples = Vec::new();
        for (s, (source, span)) in model.sources.iter().zip(&self.region).enumerate() {
            let [low, high] = span.t;
            let temperatures: Vec<f64> = if source.role.is_free() && high > low * (1.0 + 2.0 * WIDEST) {
                let steps = ((high / low).ln() / STEP.ln()).ceil();
                (0..=steps as u32).map(|step| low * (high / low).powf(f64::from(step) / steps)).collect()
            } else {
                let place = |point: u32| (f64::from(2 * point + 1) * std::f64::consts::PI / 10.0).cos();
                (0..5).map(|point| 0.5 * (low + high) + 0.5 * (high - low) * place(point)).collect()
            };
            for t in temperatures {
                let (radiance, most) = (model.radiance(t), self.most(model, s, t));
                for (strength, range, most) in
                    [(&source.own, span.own, most[0]), (&source.other, span.other, most[1])]
                {
                    let factor = range[1].min(most);
                    if factor < range[0] || factor <= 0.0 {
                        continue;
                    }
                    if model.along.is_some() {
                        let mut far = self.whitened(model.counts_of_far(strength, &radiance));
                        far.iter_mut().for_each(|count| *count *= factor);
                        samples.push(far);
                    }
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
    pub(super) fn components(&self, counts: &[f64]) -> Vector {
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

    /// Shares of v and w of a source in M.
    pub(super) fn spreads(&self, model: &Model<'_>, s: usize, temperature_k: f64) -> [Spread; 2] {
        let (source, radiance) = (&model.sources[s], model.radiance(temperature_k));
        let [own, other] = self.shares(model);
        let sum = |strengths: [&[f64]; 2]| -> Spread {
            let mut var = vec![0.0; model.var.len()];
            let mut any = false;
            for (strength, share) in strengths.into_iter().zip([&own, &other]) {
                if strength.iter().any(|x| *x > 0.0) {
                    let counts = model.counts(strength, &radiance);
                    var.iter_mut().zip(counts).enumerate().for_each(|(b, (var, n))| *var += n * share(b));
                    any = true;
                }
            }
            any.then(|| self.spread(&var))
        };
        match self.weighing {
            Weighing::Target { .. } => [sum([&source.target, &[]]), None],
            Weighing::Both => [sum([&source.target, &source.alternative]), sum([&[], &source.alone])],
        }
    }
}

/// An orthonormal basis of samples but for what is negligible, those to be had first, then the largest remainder
/// (Gram and Schmidt, twice).
fn orthonormal(first: Vec<Vec<f64>>, mut samples: Vec<Vec<f64>>, negligible: f64) -> Vec<Vec<f64>> {
    let mut basis: Vec<Vec<f64>> = Vec::new();
    let mut first = first.into_iter();
    while basis.len() < RANK {
        let mut next = match first.next() {
            Some(first) => first,
            None => {
                let norms: Vec<f64> = samples.iter().map(|sample| dot(sample, sample)).collect();
                let Some(largest) = (0..norms.len()).max_by(|&a, &b| norms[a].total_cmp(&norms[b])) else {
                    break;
                };
                if norms[largest].sqrt() <= negligible {
                    break;
                }
                samples.swap_remove(largest)
            }
        };
        basis.iter().for_each(|known| remove(&mut next, known));
        let norm = dot(&next, &next).sqrt();
        if !(norm > 0.0 && norm.is_finite()) {
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
