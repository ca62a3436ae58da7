//! Nodes and weights that average over the Gaussian priors of a state.
//!
//! * [`PriorSpace`]: the unit cube, one axis for each prior, brought to the truncated Gaussians by the inverse of their
//!   distribution.
//! * [`PriorSpace::product`]: Gauss–Legendre on either side of the mean of every prior, which multiplies with the priors.
//! * [`Lattice`]: a rank-1 lattice of n = 2^m points in all priors together, x = {i z/n + Δ}, folded by the baker's map
//!   1 − |2x − 1|, so that it need not be periodic. Lattices with independent random shifts Δ tell the error of their mean,
//!   and every one of their points is distributed as the prior.
//!
//! Sources: Dick, Kuo, Sloan, Acta Numerica 22, 133 (2013), doi:10.1017/S0962492913000044; generating vector z of Cools,
//! Kuo, Nuyens, SIAM J. Sci. Comput. 28, 2162 (2006), doi:10.1137/06065074X.

use crate::error::{Error, Result};
use crate::fisher::{Nuisance, Unknowns};
use crate::identifiability::nearest::StateRange;
use crate::identifiability::space::{set, value};
use crate::scene::{Parameter, State};
use crate::statistics::erfc_inv;
use libm::erfc;
use rand::RngExt;
use rand::rngs::ChaCha8Rng;
use std::f64::consts::SQRT_2;

/// Deviations from the mean beyond which a prior is nothing (2.6e-12 of it, 1.3e-10 of its variance).
const REACH: f64 = 7.0;

/// Share of an outermost cell that is left out where its width is told: a Gaussian goes on as far as it is looked at.
const OUTERMOST: f64 = 1.0 / 64.0;

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

/// The priors of a material's state: Gaussians about a nominal state, cut at a range and renormalised.
#[derive(Debug, Clone)]
pub struct PriorSpace {
    unknowns: Unknowns,
    nominal: State,
    lighting_sum: f64,
    priors: Vec<Prior>,
}

impl PriorSpace {
    /// The priors of `unknowns` about `nominal`, cut at `range`.
    ///
    /// # Errors
    /// A range that lies seven deviations or more from the mean.
    pub fn new(unknowns: &Unknowns, nominal: &State, range: &StateRange) -> Result<Self> {
        let mut priors = Vec::new();
        for parameter in unknowns.parameters(nominal.lighting.len()) {
            let Some(sigma) = unknowns.sigma_prior(parameter) else { continue };
            let total = unknowns.known_lighting_total().unwrap_or(f64::INFINITY);
            let [low, high] = match parameter {
                Parameter::Temperature => range.temperature_k,
                Parameter::EnvironmentTemperature(_) => [0.0, f64::INFINITY],
                Parameter::Lighting(_) => [range.lighting[0], range.lighting[1].min(total)],
                Parameter::Gain | Parameter::Material => [f64::NEG_INFINITY, f64::INFINITY],
            };
            let mean = value(nominal, parameter);
            // A nominal lighting may itself be above 1 by rounding.
            let sides = [(low - mean) / sigma, ((high - mean) / sigma)];
            if sides[0] >= REACH || sides[1] <= -REACH {
                return Err(outside());
            }
            let sides = [sides[0].max(-REACH), sides[1].min(REACH)];
            priors.push(Prior { parameter, mean, sigma, sides });
        }
        let (unknowns, nominal) = (unknowns.clone(), nominal.clone());
        Ok(Self { unknowns, nominal, lighting_sum: range.lighting_sum, priors })
    }

    /// How many parameters have a prior.
    #[must_use]
    pub fn axes(&self) -> usize {
        self.priors.len()
    }

    /// The parameters that have a prior.
    pub fn parameters(&self) -> impl Iterator<Item = Parameter> {
        self.priors.iter().map(|prior| prior.parameter)
    }

    /// The state below which each prior has the share `shares` of itself; `None` where all together are impossible
    /// (ΣV above its most). Shares that are uniform in [0, 1) make states that are distributed as the priors.
    #[must_use]
    pub fn state(&self, shares: &[f64]) -> Option<State> {
        crate::stop::check();
        let mut state = self.nominal.clone();
        for (prior, &share) in self.priors.iter().zip(shares) {
            set(&mut state, prior.parameter, prior.mean + prior.sigma * quantile(share, prior.sides));
        }
        self.allowed(&mut state).then_some(state)
    }

    /// Deviations of the parameters over the cell of one of `points` states, that at `shares`, in their units: the cell's width
    /// over √12, which ends within the prior.
    pub fn cell_deviations<'s>(&'s self, shares: &'s [f64], points: usize) -> impl Iterator<Item = f64> + 's {
        let step = (points as f64).powf(-1.0 / self.axes().max(1) as f64);
        self.priors.iter().zip(shares).map(move |(prior, &at)| {
            let low = (at - 0.5 * step).min(1.0 - step).max(0.0);
            let end =
                |share: f64| quantile(share.clamp(OUTERMOST * step, 1.0 - OUTERMOST * step), prior.sides);
            prior.sigma * (end(low + step) - end(low)) / 12.0_f64.sqrt()
        })
    }

    /// Brings the last lighting factor to a known total; false for a state that is impossible.
    fn allowed(&self, state: &mut State) -> bool {
        if !self.unknowns.contains(Nuisance::Lighting) {
            return true;
        }
        match (state.lighting.as_mut_slice(), self.unknowns.known_lighting_total()) {
            ([others @ .., last], Some(total)) => {
                *last = total - others.iter().sum::<f64>();
                *last >= 0.0
            }
            // The nominal state may itself be above 1 by rounding.
            (all, _) => all.iter().sum::<f64>() <= self.lighting_sum + 1e-12,
        }
    }

    /// The states of some lattices, with weights of each that add up to 1; the nominal state alone where there are no priors.
    pub(super) fn lattices(
        &self,
        count: usize,
        points: usize,
        rng: &mut ChaCha8Rng,
    ) -> Result<Vec<Vec<Node>>> {
        if self.priors.is_empty() {
            return Ok(vec![vec![Node { state: self.nominal.clone(), weight: 1.0 }]]);
        }
        let of = |_| {
            let lattice = Lattice::new(points, self.axes(), rng);
            let states: Vec<State> = (0..points).filter_map(|i| self.state(&lattice.folded(i))).collect();
            let weight = 1.0 / states.len().max(1) as f64;
            states.into_iter().map(|state| Node { state, weight }).collect()
        };
        let lattices: Vec<Vec<Node>> = (0..count).map(of).collect();
        if lattices.iter().all(Vec::is_empty) { Err(outside()) } else { Ok(lattices) }
    }

    /// States of the product rule with `order` nodes on either side of each mean, weights adding up to 1; the nominal state
    /// alone where there are no priors.
    pub(super) fn product(&self, order: usize, limit: usize) -> Result<Vec<Node>> {
        let mut nodes = vec![Node { state: self.nominal.clone(), weight: 1.0 }];
        for &prior in &self.priors {
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
        nodes.retain_mut(|node| self.allowed(&mut node.state));
        let sum: f64 = nodes.iter().map(|node| node.weight).sum();
        if nodes.is_empty() || sum <= 0.0 {
            return Err(outside());
        }
        nodes.iter_mut().for_each(|node| node.weight /= sum);
        Ok(nodes)
    }
}

/// A rank-1 lattice with a random shift.
#[derive(Debug, Clone)]
pub struct Lattice {
    points: usize,
    shifts: Vec<f64>,
}

impl Lattice {
    /// `points` points in a cube of so many axes.
    pub fn new(points: usize, axes: usize, rng: &mut ChaCha8Rng) -> Self {
        Self { points, shifts: (0..axes).map(|_| rng.random_range(0.0..1.0)).collect() }
    }

    /// How many points there are.
    #[must_use]
    pub fn points(&self) -> usize {
        self.points
    }

    /// Point `i`, whose axes begin with number `first` of the generating vector.
    pub(super) fn point(&self, i: usize, first: usize) -> impl Iterator<Item = f64> {
        let generators = GENERATORS.iter().cycle().skip(first);
        self.shifts.iter().zip(generators).map(move |(shift, generator)| {
            ((i as u64 * generator % self.points as u64) as f64 / self.points as f64 + shift).fract()
        })
    }

    /// Point `i` by the baker's map.
    #[must_use]
    pub fn folded(&self, i: usize) -> Vec<f64> {
        self.point(i, 0).map(|place| 1.0 - (2.0 * place - 1.0).abs()).collect()
    }
}

fn outside() -> Error {
    Error::malformed(
        "a prior that lies outside the range of the state",
        "state a nominal lighting with a sum of at most 1, or widen the range of `alternatives`",
    )
}

/// Where the standard Gaussian cut at `sides` has the share `share` below.
pub(super) fn quantile(share: f64, [low, high]: [f64; 2]) -> f64 {
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

/// Gauss–Legendre on either side of the mean, weighted by the Gaussian and normalised.
fn rule(prior: Prior, order: usize) -> Result<Vec<(f64, f64)>> {
    crate::stop::check();
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
