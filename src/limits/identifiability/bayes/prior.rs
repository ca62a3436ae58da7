//! Nodes and weights that average over the Gaussian priors of a state.

use crate::error::{Error, Result};
use crate::fisher::{Nuisance, Unknowns};
use crate::identifiability::space::{set, value};
use crate::scene::{Parameter, State};

/// Deviations from the mean beyond which a prior is nothing (2.6e-12 of it, 1.3e-10 of its variance).
const REACH: f64 = 7.0;

/// A state and its share of the prior.
#[derive(Debug, Clone)]
pub(super) struct Node {
    pub(super) state: State,
    pub(super) weight: f64,
}

/// States that stand for the priors about `state`, weights adding up to 1; `state` alone where there are no
/// priors.
pub(super) fn nodes(unknowns: &Unknowns, state: &State, order: usize, limit: usize) -> Result<Vec<Node>> {
    let mut nodes = vec![Node { state: state.clone(), weight: 1.0 }];
    for parameter in unknowns.parameters(state.lighting.len()) {
        let Some(sigma) = unknowns.sigma_prior(parameter) else { continue };
        let [low, high] = match parameter {
            Parameter::Temperature | Parameter::EnvironmentTemperature(_) => [0.0, f64::INFINITY],
            Parameter::Lighting(_) => [0.0, unknowns.known_lighting_total().unwrap_or(1.0)],
            Parameter::Gain | Parameter::Material => [f64::NEG_INFINITY, f64::INFINITY],
        };
        let rule = rule(value(state, parameter), sigma, [low, high], order)?;
        if nodes.len().saturating_mul(rule.len()) > limit {
            return Err(Error::malformed(
                format!("an average over a prior of more than {limit} nodes"),
                "drop a prior, or lower the order",
            ));
        }
        let moved = |node: Node| {
            rule.iter().map(move |&(to, share)| {
                let mut next = node.clone();
                set(&mut next.state, parameter, to);
                next.weight *= share;
                next
            })
        };
        nodes = nodes.into_iter().flat_map(moved).collect();
    }
    if unknowns.contains(Nuisance::Lighting) {
        let total_known = unknowns.known_lighting_total();
        nodes.retain_mut(|node| match (node.state.lighting.as_mut_slice(), total_known) {
            ([others @ .., last], Some(total)) => {
                *last = total - others.iter().sum::<f64>();
                *last >= 0.0
            }
            // The nominal state may itself be above 1 by rounding.
            (all, _) => all.iter().sum::<f64>() <= 1.0 + 1e-12,
        });
        let sum: f64 = nodes.iter().map(|node| node.weight).sum();
        if nodes.is_empty() || sum <= 0.0 {
            return Err(Error::malformed(
                "a prior on the lighting that lies outside its range",
                "state a nominal lighting with a sum of at most 1",
            ));
        }
        nodes.iter_mut().for_each(|node| node.weight /= sum);
    }
    Ok(nodes)
}

/// Gauss–Legendre on either side of the mean, weighted by the Gaussian and normalised.
fn rule(mean: f64, sigma: f64, [low, high]: [f64; 2], order: usize) -> Result<Vec<(f64, f64)>> {
    let legendre = bilby::GaussLegendre::new(order.max(1))
        .map_err(|error| Error::malformed(error.to_string(), "report this as a bug"))?;
    let sides = [((low - mean) / sigma).max(-REACH), ((high - mean) / sigma).min(REACH)];
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
        let whole = rule(5.0, 0.1, [0.0, f64::INFINITY], 16).unwrap();
        let half = rule(1.0, 0.02, [0.0, 1.0], 16).unwrap();
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
}
