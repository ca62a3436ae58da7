//! The states of all materials as log-likelihoods that are polynomials of the counts.
//!
//! With x = n − N, N the target's mean in a band, and N′ that of a state, the log-likelihood of the state
//! less that of the target's (which is the same for all states) is a + l x + q x², summed over bands:
//!
//! * Poisson: l = ln(N′/N), q = 0, a = N l − (N′ − N);
//! * negative binomial, m modes: l = ln(N′/N) − λ, λ = ln[(N′ + m)/(N + m)], a = N l − m λ;
//! * Gaussian, variances v and v′, δ = N′ − N: q = ½(1/v − 1/v′), l = δ/v′, a = −½[δ²/v′ + ln(v′/v)].
//!
//! Materials of one and the same emissivity share one surface.

use super::super::space::{StateSpace, set, value};
use super::detector::{LatticeDetector, LatticeMesh, MAX_BANDS};
use crate::error::{Error, Result};
use crate::fisher::Nuisance;
use crate::parallel;
use crate::scene::{Jacobian, Parameter, State};
use crate::statistics::Statistics;

/// More states than this are not held.
const MAX_STATES: usize = 20_000_000;
/// What stands for a mean of zero, so that its logarithm and the inverse of its variance are numbers.
const DARK: f64 = 1e-100;

/// Log-likelihood of one state as a polynomial of the counts. Bands that are not there have zeros.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Likelihood {
    constant: f64,
    linear: [f64; MAX_BANDS],
    quadratic: [f64; MAX_BANDS],
    /// Number of its surface.
    pub(super) surface: u32,
}

impl Likelihood {
    /// At counts x.
    #[inline]
    pub(super) fn at(&self, x: &[f64; MAX_BANDS]) -> f64 {
        (0..MAX_BANDS)
            .map(|w| x[w] * (self.linear[w] + self.quadratic[w] * x[w]))
            .fold(self.constant, |a, b| a + b)
    }

    /// Whether it stays below `other` in all of the box.
    #[inline]
    pub(super) fn is_below(&self, other: &Self, extent: &[[f64; 2]; MAX_BANDS]) -> bool {
        let mut excess = self.constant - other.constant;
        for (w, &[low, high]) in extent.iter().enumerate() {
            let (l, q) = (self.linear[w] - other.linear[w], self.quadratic[w] - other.quadratic[w]);
            let mut largest = (low * (l + q * low)).max(high * (l + q * high));
            if q < 0.0 {
                let top = -0.5 * l / q;
                if top > low && top < high {
                    largest = largest.max(0.5 * l * top);
                }
            }
            excess += largest;
        }
        excess < 0.0
    }

    fn new(statistics: &Statistics, surface: u32, means: &[f64], own: &[f64], penalty: f64) -> Self {
        crate::stop::check();
        let mut found = Self { constant: -penalty, surface, ..Self::default() };
        for (w, (&mean, &own)) in means.iter().zip(own).enumerate() {
            let (mean, own) = (mean.max(DARK), own.max(DARK));
            let change = mean - own;
            let (constant, linear, quadratic) = match statistics {
                Statistics::Poisson => {
                    let log = (mean / own).ln();
                    (own * log - change, log, 0.0)
                }
                Statistics::NegativeBinomial { modes } => {
                    let m = modes[w];
                    let dark = (change / (own + m)).ln_1p();
                    let log = (mean / own).ln() - dark;
                    (own * log - m * dark, log, 0.0)
                }
                Statistics::Gaussian { .. } => {
                    let (v, v_own) = (statistics.variance(w, mean), statistics.variance(w, own));
                    let width = -0.5 * (change * change / v + (v / v_own).ln());
                    (width, change / v, 0.5 * (1.0 / v_own - 1.0 / v))
                }
            };
            found.constant += constant;
            (found.linear[w], found.quadratic[w]) = (linear, quadratic);
        }
        found
    }
}

/// The states of all surfaces, and which materials have which.
#[derive(Debug)]
pub(super) struct Surfaces {
    pub(super) likelihoods: Vec<Likelihood>,
    /// Materials of each surface.
    pub(super) members: Vec<Vec<usize>>,
}

impl Surfaces {
    pub(super) fn new(
        detector: &LatticeDetector<'_>,
        library: &[Vec<f64>],
        state: &State,
        own: &[f64],
        counts: f64,
        mesh: LatticeMesh,
    ) -> Result<Self> {
        let mut members: Vec<Vec<usize>> = Vec::new();
        for (i, emissivity) in library.iter().enumerate() {
            match members.iter_mut().find(|same| same.first().is_some_and(|&j| library[j] == *emissivity)) {
                Some(same) => same.push(i),
                None => members.push(vec![i]),
            }
        }
        let states = meshed(detector, state, mesh, members.len())?;
        let likelihoods: Vec<Vec<Likelihood>> = parallel::map(members.len(), |surface| {
            let emissivity = members[surface].first().map_or(&[][..], |&i| &library[i]);
            let mut jacobian = Jacobian::new(detector.bands, detector.surroundings);
            let likelihood = |(state, penalty): &(State, f64)| {
                jacobian.evaluate(emissivity, emissivity, state, &[], false);
                let means: Vec<f64> = jacobian.signal().iter().map(|signal| counts * signal).collect();
                Likelihood::new(&detector.statistics, surface as u32, &means, own, *penalty)
            };
            states.iter().map(likelihood).collect()
        });
        Ok(Self { likelihoods: likelihoods.concat(), members })
    }

    /// States of all materials, those that share a surface counted each.
    pub(super) fn states(&self) -> usize {
        let each = self.likelihoods.len() / self.members.len().max(1);
        each * self.members.iter().map(Vec::len).sum::<usize>()
    }

    /// Probabilities of the materials from those of the surfaces.
    pub(super) fn spread(&self, shares: &[f64], materials: usize) -> Vec<f64> {
        let mut probabilities = vec![0.0; materials];
        for (share, same) in shares.iter().zip(&self.members) {
            for &material in same {
                probabilities[material] = share / same.len() as f64;
            }
        }
        probabilities
    }
}

/// Every state of the mesh, with the penalty ½Σ(θ′ − θ)²/σ_p² of the priors.
fn meshed(
    detector: &LatticeDetector<'_>,
    state: &State,
    mesh: LatticeMesh,
    surfaces: usize,
) -> Result<Vec<(State, f64)>> {
    let (unknowns, objects) = (&detector.unknowns, detector.surroundings.objects().len());
    let space = StateSpace::new(unknowns.clone(), detector.range, objects);
    let axes: Vec<(Parameter, Vec<f64>)> = space
        .parameters
        .iter()
        .map(|&parameter| {
            let [low, high] = match parameter {
                Parameter::Gain => mesh.gain.map(f64::ln),
                other => space.bounds(other),
            };
            let count = match parameter {
                Parameter::Temperature => mesh.temperatures,
                Parameter::Gain => mesh.gains,
                _ => mesh.lightings,
            };
            let at = |i: usize| match count {
                1 => 0.5 * (low + high),
                _ => low + (high - low) * (i as f64 / (count - 1) as f64),
            };
            (parameter, (0..count).map(at).collect())
        })
        .collect();
    let product = axes.iter().try_fold(surfaces.max(1), |product, (_, axis)| product.checked_mul(axis.len()));
    if product.is_none_or(|states| states > MAX_STATES) {
        return Err(Error::malformed(
            format!("a mesh of more than {MAX_STATES} states"),
            "mesh the unknowns more coarsely, or drop some",
        ));
    }
    let mut states = vec![(state.clone(), 0.0)];
    // The first parameter varies slowest, so that radiances are computed once per temperature.
    for (parameter, axis) in &axes {
        let sigma = unknowns.sigma_prior(*parameter).unwrap_or(f64::INFINITY);
        let moved = |(start, penalty): (State, f64)| {
            axis.iter().map(move |&to| {
                let mut next = start.clone();
                set(&mut next, *parameter, to);
                let off = (to - value(state, *parameter)) / sigma;
                (next, penalty + 0.5 * off * off)
            })
        };
        states = states.into_iter().flat_map(moved).collect();
    }
    if unknowns.contains(Nuisance::Lighting) {
        let limit = space.lighting_sum();
        let total_known = unknowns.known_lighting_total().is_some();
        states.retain_mut(|(state, _)| match state.lighting.as_mut_slice() {
            [others @ .., last] if total_known => {
                *last = limit - others.iter().sum::<f64>();
                *last >= 0.0
            }
            all => all.iter().sum::<f64>() <= limit * (1.0 + 4.0 * f64::EPSILON),
        });
    }
    if states.is_empty() {
        return Err(Error::malformed("a mesh without states", "widen the range or mesh it more finely"));
    }
    Ok(states)
}
