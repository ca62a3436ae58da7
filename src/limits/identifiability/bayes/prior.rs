//! Nodes and weights that average over the Gaussian priors of a state.
//!
//! * [`product`]: Gauss–Legendre on either side of the mean of every prior, which multiplies with the priors.
//! * [`lattices`]: a rank-1 lattice of n = 2^m points in all priors together, x = {i z/n + Δ}, folded by the baker's map
//!   1 − |2x − 1|, so that it need not be periodic, and brought to the truncated Gaussians by the inverse of their
//!   distribution. [`SHIFTS`] lattices with independent random shifts Δ tell the error of their mean.
//!
//! Sources: Dick, Kuo, Sloan, Acta Numerica 22, 133 (2013), doi:10.1017/S0962492913000044; generating vector z of Cools,
//! Kuo, Nuyens, SIAM J. Sci. Comput. 28, 2162 (2006), doi:10.1137/06065074X.

use crate::error::{Error, Result};
use crate::fisher::{Nuisance, Unknowns};
use crate::identifiability::space::{set, value};
use crate::scene::{Parameter, State};
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use statrs::function::erf::{erfc, erfc_inv};
use std::f64::consts::SQRT_2;

/// Deviations from the mean beyond which a prior is nothing (2.6e-12 of it, 1.3e-10 of its variance).
const REACH: f64 = 7.0;

/// Lattices whose scatter tells the error of their mean.
pub(super) const SHIFTS: usize = 8;
/// Generating vector, good for 2¹⁰ to 2²⁰ points and fair below.
const GENERATORS: [u64; 20] = [
    1, 182_667, 469_891, 498_753, 110_745, 446_979, 250_185, 118_627, 245_333, 283_199, 408_519, 391_023,
    246_327, 126_539, 399_185, 461_527, 300_343, 69_681, 516_695, 436_179,
];

/// A parameter with a prior: its mean and deviation, and the ends of its range in deviations from the mean.
#[derive(Debug, Clone, Copy)]
struct Prior {
    parameter: Parameter,
    mean: f64,
    sigma: f64,
    sides: [f64; 2],
}

/// The priors of a state, each cut at its physical range.
fn priors(unknowns: &Unknowns, state: &State) -> Vec<Prior> {
    let of = |parameter: Parameter| {
        let sigma = unknowns.sigma_prior(parameter)?;
        let [low, high] = match parameter {
            Parameter::Temperature | Parameter::EnvironmentTemperature(_) => [0.0, f64::INFINITY],
            Parameter::Lighting(_) => [0.0, unknowns.known_lighting_total().unwrap_or(1.0)],
            Parameter::Gain | Parameter::Material => [f64::NEG_INFINITY, f64::INFINITY],
        };
        let mean = value(state, parameter);
        let sides = [((low - mean) / sigma).max(-REACH), ((high - mean) / sigma).min(REACH)];
        Some(Prior { parameter, mean, sigma, sides })
    };
    unknowns.parameters(state.lighting.len()).into_iter().filter_map(of).collect()
}

/// How many parameters have a prior.
pub(super) fn count(unknowns: &Unknowns, state: &State) -> usize {
    priors(unknowns, state).len()
}

/// Brings the last lighting factor to a known total; false for a state that physics does not allow.
fn allowed(unknowns: &Unknowns, state: &mut State) -> bool {
    if !unknowns.contains(Nuisance::Lighting) {
        return true;
    }
    match (state.lighting.as_mut_slice(), unknowns.known_lighting_total()) {
        ([others @ .., last], Some(total)) => {
            *last = total - others.iter().sum::<f64>();
            *last >= 0.0
        }
        // The nominal state may itself be above 1 by rounding.
        (all, _) => all.iter().sum::<f64>() <= 1.0 + 1e-12,
    }
}

/// The lattices of `points` states each; weights of each add up to 1, of an empty one to 0. A state alone where there are
/// no priors.
pub(super) fn lattices(unknowns: &Unknowns, state: &State, points: usize) -> Result<Vec<Vec<Node>>> {
    let priors = priors(unknowns, state);
    if priors.is_empty() {
        return Ok(vec![vec![Node { state: state.clone(), weight: 1.0 }]]);
    }
    let mut random = ChaCha8Rng::seed_from_u64(20);
    let mut lattices = Vec::with_capacity(SHIFTS);
    for _ in 0..SHIFTS {
        let shifts: Vec<f64> = priors.iter().map(|_| random.random_range(0.0..1.0)).collect();
        let mut nodes = Vec::with_capacity(points);
        for i in 0..points as u64 {
            let mut node = Node { state: state.clone(), weight: 1.0 };
            let axes = priors.iter().zip(&shifts).zip(GENERATORS.iter().cycle());
            for ((prior, shift), generator) in axes {
                let place = (i * generator % points as u64) as f64 / points as f64 + shift;
                let folded = 1.0 - (2.0 * place.fract() - 1.0).abs();
                set(
                    &mut node.state,
                    prior.parameter,
                    prior.mean + prior.sigma * quantile(folded, prior.sides),
                );
            }
            if allowed(unknowns, &mut node.state) {
                nodes.push(node);
            }
        }
        let weight = 1.0 / nodes.len().max(1) as f64;
        nodes.iter_mut().for_each(|node| node.weight = weight);
        lattices.push(nodes);
    }
    if lattices.iter().all(Vec::is_empty) { Err(outside()) } else { Ok(lattices) }
}

fn outside() -> Error {
    Error::malformed(
        "a prior on the lighting that lies outside its range",
        "state a nominal lighting with a sum of at most 1",
    )
}

/// Where the standard Gaussian cut at `sides` has the share `share` below.
fn quantile(share: f64, [low, high]: [f64; 2]) -> f64 {
    // From the tail that is the thinner, so that no digits are lost.
    if low + high > 0.0 {
        return -quantile(1.0 - share, [-high, -low]);
    }
    let below = |z: f64| 0.5 * erfc(-z / SQRT_2);
    let (first, last) = (below(low), below(high));
    (-SQRT_2 * erfc_inv(2.0 * (first + share * (last - first)))).clamp(low, high)
}

/// A state and its share of the prior.
#[derive(Debug, Clone)]
pub(super) struct Node {
    pub(super) state: State,
    pub(super) weight: f64,
}

/// States of the product rule with `order` nodes on either side of each mean, weights adding up to 1; `state` alone where
/// there are no priors.
pub(super) fn product(unknowns: &Unknowns, state: &State, order: usize, limit: usize) -> Result<Vec<Node>> {
    let mut nodes = vec![Node { state: state.clone(), weight: 1.0 }];
    for prior in priors(unknowns, state) {
        let rule = rule(prior, order)?;
        if nodes.len().saturating_mul(rule.len()) > limit {
            return Err(Error::malformed(
                format!("an average over a prior of more than {limit} nodes"),
                "drop a prior, or lower the order",
            ));
        }
        let moved = |node: Node| {
            rule.iter().map(move |&(to, share)| {
                let mut next = node.clone();
                set(&mut next.state, prior.parameter, to);
                next.weight *= share;
                next
            })
        };
        nodes = nodes.into_iter().flat_map(moved).collect();
    }
    nodes.retain_mut(|node| allowed(unknowns, &mut node.state));
    let sum: f64 = nodes.iter().map(|node| node.weight).sum();
    if nodes.is_empty() || sum <= 0.0 {
        return Err(outside());
    }
    nodes.iter_mut().for_each(|node| node.weight /= sum);
    Ok(nodes)
}

/// Gauss–Legendre on either side of the mean, weighted by the Gaussian and normalised.
fn rule(prior: Prior, order: usize) -> Result<Vec<(f64, f64)>> {
    let Prior { mean, sigma, sides, .. } = prior;
    let legendre = bilby::GaussLegendre::new(order.max(1))
        .map_err(|error| Error::malformed(error.to_string(), "report this as a bug"))?;
    let mut found = Vec::with_capacity(2 * order);
    for side in sides.into_iter().filter(|side| side.abs() > 0.0) {
        for (&node, &weight) in legendre.nodes().iter().zip(legendre.weights()) {
            let z = 0.5 * side * (1.0 + node);
            found.push((mean + sigma * z, weight * side.abs() * (-0.5 * z * z).exp()));
        }
    }
    let sum: f64 = found.iter().map(|(_, weight)| weight).sum();
    found.iter_mut().for_each(|(_, weight)| *weight /= sum);
    if found.is_empty() { Ok(vec![(mean, 1.0)]) } else { Ok(found) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Moments of a Gaussian and of its half: variance 1 and 1, mean 0 and √(2/π).
    #[test]
    fn moments_are_those_of_the_truncated_gaussian() {
        let prior = |mean, sigma, sides| Prior { parameter: Parameter::Temperature, mean, sigma, sides };
        let whole = rule(prior(5.0, 0.1, [-REACH, REACH]), 16).unwrap();
        let half = rule(prior(1.0, 0.02, [-REACH, 0.0]), 16).unwrap();
        let moment = |rule: &[(f64, f64)], mean: f64, sigma: f64, power: i32| -> f64 {
            rule.iter().map(|(x, w)| w * ((x - mean) / sigma).powi(power)).sum()
        };
        assert!(
            (moment(&whole, 5.0, 0.1, 1)).abs() < 1e-13 && (moment(&whole, 5.0, 0.1, 2) - 1.0).abs() < 1e-8
        );
        assert!((moment(&whole, 5.0, 0.1, 4) / 3.0 - 1.0).abs() < 1e-7);
        let mean = (2.0 / std::f64::consts::PI).sqrt();
        assert!((moment(&half, 1.0, 0.02, 1) + mean).abs() < 1e-9 && half.len() == 16);
        assert!((moment(&half, 1.0, 0.02, 2) - 1.0).abs() < 1e-8);
    }
    /// The share of a cut Gaussian below each quantile is the share asked for: by Simpson's rule, either side and in a tail.
    #[test]
    fn quantiles_are_those_of_the_cut_gaussian() {
        let between = |a: f64, b: f64| {
            let h = (b - a) / 2000.0;
            let f = |i: usize| (-0.5 * (a + h * i as f64).powi(2)).exp();
            (0..1000).map(|i| h / 3.0 * (f(2 * i) + 4.0 * f(2 * i + 1) + f(2 * i + 2))).sum::<f64>()
        };
        for sides in [[-7.0, 7.0], [-7.0, 0.0], [0.0, 7.0], [-7.0, -4.0], [3.0, 7.0], [-0.5, 2.0]] {
            for share in [1e-6, 0.1, 0.5, 0.9, 0.9999] {
                let found = between(sides[0], quantile(share, sides)) / between(sides[0], sides[1]);
                assert!((found / share - 1.0).abs() < 1e-4, "{sides:?} {share}: {found}");
            }
        }
    }
}
