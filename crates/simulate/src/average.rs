//! The Bayes test between two materials whose states are drawn from priors, by Monte Carlo.
//!
//! A material and its state are drawn, counts about its spectrum, and the answer is the material of the larger likelihood
//! p(n | material) = E_θ[p(n | θ)] over the prior of its state. The share of right answers is what that test achieves; as any
//! test's it is at most ½ + ½ TV in the long run.
//!
//! The average is over a lattice of states θ_j, each of which stands for its cell: with ln p quadratic over the cell, of score s
//! and information H in units of the cell's deviation (width/√12 along each axis),
//! ln p̄_j = ln p(n | θ_j) + (t − ½t²) sᵀ(1 + H)⁻¹s − ½ ln det(1 + H),
//! t = 1 unless the most likely place (1 + H)⁻¹s is beyond `FARTHEST` deviations, and then what brings it back to there: farther
//! away nothing is quadratic. This is not exact, and makes the test no better than the best one. How much the lattice matters is told by the share of
//! decisions that every second state alone would change.
//!
//! Counts are taken about the mean n₀ of the nominal state: ln p(n | θ) = c + Σ a_w(n − n₀)_w + Σ b_w(n − n₀)²_w, b = 0 but for normal counts,
//! up to what is the same for all states.

use crate::draws::{Draws, GENERATOR, generator};
use crate::sequential::{BLOCK, Interval};
use hadar::error::{Error, Result};
use hadar::identifiability::bayes::{Lattice, Pair, PriorSpace};
use hadar::parallel;
use hadar::scene::{Jacobian, Parameter, State, Surroundings};
use hadar::spectrum::Bands;
use hadar::statistics::Statistics;
use rand::RngExt;
use rand::rngs::ChaCha8Rng;

/// States of each class that the test knows.
const STATES: usize = 1024;
/// Draws of a state that may be impossible before it is given up.
const MOST_DRAWS: usize = 100_000;
/// Terms of a likelihood this much below its largest, in logarithm, are none.
const NEGLIGIBLE: f64 = 40.0;
/// Deviations of a cell beyond which a state does not stand for it.
const FARTHEST: f64 = 2.5;
/// Least mean count that has a logarithm.
const DARK: f64 = 1e-300;

/// Two materials and the priors of their states.
#[derive(Debug, Clone, Copy)]
pub struct AverageScene<'a> {
    /// Bands.
    pub bands: &'a Bands,
    /// Surroundings.
    pub surroundings: &'a Surroundings,
    /// The materials and the nominal state.
    pub pair: Pair<'a>,
    /// Priors of the target and of the alternative.
    pub priors: &'a [PriorSpace; 2],
    /// Whether the total of the lighting is known.
    pub lighting_total_known: bool,
    /// κ, counts per unit of band signal, m² sr s.
    pub counts_per_radiance: f64,
    /// How likelihoods take counts to scatter.
    pub statistics: &'a Statistics,
}

/// How often the ratio of the two mixtures decides rightly.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct AverageDecisions {
    /// Share of correct decisions; ties are split.
    pub probability: f64,
    /// Wilson's interval of it, 95 %.
    pub interval: Interval,
    /// Share of correct decisions with the target true, and with the alternative true.
    pub probability_by_class: [f64; 2],
    /// Number of decisions that were simulated.
    pub trials: u64,
    /// States of each class that the likelihoods are averaged over.
    pub states: usize,
    /// Share of the decisions that would be others with every second state alone.
    pub changed_by_half_the_states: f64,
    /// Name of the generator of random numbers.
    pub generator: &'static str,
}

/// A state as the test knows it.
struct Node {
    constant: f64,
    linear: Vec<f64>,
    /// Empty but for normal counts.
    square: Vec<f64>,
    /// Rows L⁻¹s of the score, LLᵀ = 1 + H, and what to take from them.
    scores: Vec<(Vec<f64>, f64)>,
    /// L, row by row.
    lower: Vec<Vec<f64>>,
}

impl Node {
    /// ln p̄ of counts less those of the nominal state.
    fn log(&self, off: &[f64]) -> f64 {
        let mut log = self.constant + dot(&self.linear, off);
        if !self.square.is_empty() {
            log += self.square.iter().zip(off).map(|(b, n)| b * n * n).sum::<f64>();
        }
        let along: Vec<f64> = self.scores.iter().map(|(row, taken)| dot(row, off) - taken).collect();
        let mut place = vec![0.0; along.len()];
        for i in (0..along.len()).rev() {
            let after: f64 = (i + 1..along.len()).map(|l| self.lower[l][i] * place[l]).sum();
            place[i] = (along[i] - after) / self.lower[i][i];
        }
        let far = place.iter().map(|u| u * u).sum::<f64>().sqrt();
        let t = if far > FARTHEST { FARTHEST / far } else { 1.0 };
        log + (t - 0.5 * t * t) * along.iter().map(|w| w * w).sum::<f64>()
    }
}

impl AverageScene<'_> {
    /// Draws `per_class` spectra of each material, by `draws` about their mean counts, and decides.
    ///
    /// # Errors
    /// Counts that cannot be drawn; a range that leaves nothing of a prior.
    pub fn decide(
        &self,
        seed: u64,
        per_class: u64,
        draws: &(dyn Fn(&[f64]) -> Result<Draws> + Sync),
    ) -> Result<AverageDecisions> {
        let middle = self.means(&mut self.jacobian(), 0, self.pair.state);
        let mut rng = generator(seed, u64::MAX);
        let nodes = [self.nodes(0, &middle, &mut rng)?, self.nodes(1, &middle, &mut rng)?];
        let trials = 2 * per_class;
        let blocks = parallel::try_map_with(
            trials.div_ceil(BLOCK) as usize,
            || self.jacobian(),
            |jacobian, block| {
                let block = block as u64;
                let mut rng = generator(seed, block);
                let mut counted = [0.0; 3];
                let mut off = vec![0.0; middle.len()];
                for trial in block * BLOCK..trials.min((block + 1) * BLOCK) {
                    let class = (trial % 2) as usize;
                    let means = self.drawn(jacobian, class, &mut rng)?;
                    draws(&means)?.draw_into(&mut rng, &mut off);
                    off.iter_mut().zip(&middle).for_each(|(n, middle)| *n -= middle);
                    let [own, other] = nodes.each_ref().map(|nodes| log_means(nodes, &off));
                    let right = |which: usize| match own[which].total_cmp(&other[which]) {
                        std::cmp::Ordering::Equal => 0.5,
                        order => f64::from(u8::from((order == std::cmp::Ordering::Greater) == (class == 0))),
                    };
                    counted[class] += right(0);
                    counted[2] += (right(0) - right(1)).abs();
                }
                Ok::<_, Error>(counted)
            },
        )?;
        let mut sums = [0.0; 3];
        blocks.iter().flat_map(|block| block.iter().enumerate()).for_each(|(i, more)| sums[i] += more);
        let [own, other, changed] = sums;
        Ok(AverageDecisions {
            probability: (own + other) / trials.max(1) as f64,
            interval: Interval::wilson(own + other, trials, 0.95),
            probability_by_class: [own, other].map(|right| right / per_class.max(1) as f64),
            trials,
            states: nodes[0].len().min(nodes[1].len()),
            changed_by_half_the_states: changed / trials.max(1) as f64,
            generator: GENERATOR,
        })
    }

    fn jacobian(&self) -> Jacobian<'_> {
        Jacobian::new(self.bands, self.surroundings)
    }

    fn evaluate(&self, jacobian: &mut Jacobian<'_>, class: usize, state: &State, of: &[Parameter]) {
        hadar::stop::check();
        let Pair { emissivity, alternative, .. } = self.pair;
        let (own, other) = if class == 0 { (emissivity, alternative) } else { (alternative, emissivity) };
        jacobian.evaluate(own, other, state, of, self.lighting_total_known);
    }

    fn means(&self, jacobian: &mut Jacobian<'_>, class: usize, state: &State) -> Vec<f64> {
        self.evaluate(jacobian, class, state, &[]);
        jacobian.signal().iter().map(|signal| (signal * self.counts_per_radiance).max(0.0)).collect()
    }

    /// Mean counts of a state out of the prior.
    fn drawn(&self, jacobian: &mut Jacobian<'_>, class: usize, rng: &mut ChaCha8Rng) -> Result<Vec<f64>> {
        let prior = &self.priors[class];
        for _ in 0..MOST_DRAWS {
            let shares: Vec<f64> = (0..prior.axes()).map(|_| rng.random_range(0.0..1.0)).collect();
            if let Some(state) = prior.state(&shares) {
                return Ok(self.means(jacobian, class, &state));
            }
        }
        Err(Error::malformed(
            "a prior on the lighting whose sum is nearly always above 1",
            "state a smaller nominal lighting or a narrower prior",
        ))
    }

    fn nodes(&self, class: usize, middle: &[f64], rng: &mut ChaCha8Rng) -> Result<Vec<Node>> {
        let prior = &self.priors[class];
        let parameters: Vec<Parameter> = prior.parameters().collect();
        let lattice = Lattice::new(STATES, prior.axes(), rng);
        let mut jacobian = self.jacobian();
        let mut nodes = Vec::with_capacity(STATES);
        for i in 0..STATES {
            let shares = lattice.folded(i);
            let Some(state) = prior.state(&shares) else { continue };
            self.evaluate(&mut jacobian, class, &state, &parameters);
            let widths: Vec<f64> = prior.cell_deviations(&shares, STATES).collect();
            nodes.push(self.node(&jacobian, &widths, middle));
        }
        if nodes.is_empty() {
            return Err(Error::malformed("a prior that allows no state", "widen it or its range"));
        }
        Ok(nodes)
    }

    fn node(&self, jacobian: &Jacobian<'_>, widths: &[f64], middle: &[f64]) -> Node {
        hadar::stop::check();
        let kappa = self.counts_per_radiance;
        let means: Vec<f64> = jacobian.signal().iter().map(|signal| (signal * kappa).max(DARK)).collect();
        let mut node = Node {
            constant: 0.0,
            linear: Vec::new(),
            square: Vec::new(),
            scores: Vec::new(),
            lower: Vec::new(),
        };
        for (band, (&mean, &middle)) in means.iter().zip(middle).enumerate() {
            let ratio = (mean / middle.max(DARK)).ln();
            match self.statistics {
                Statistics::Poisson => {
                    node.linear.push(ratio);
                    node.constant += middle * ratio - (mean - middle);
                }
                Statistics::NegativeBinomial { modes } => {
                    let m = modes[band];
                    let more = ((mean + m) / (middle + m)).ln();
                    node.linear.push(ratio - more);
                    node.constant += middle * (ratio - more) - m * more;
                }
                Statistics::Gaussian { .. } => {
                    let (variance, off) = (self.statistics.variance(band, mean), mean - middle);
                    node.linear.push(off / variance);
                    node.square.push(-0.5 / variance);
                    node.constant -= 0.5 * (off * off / variance + variance.ln());
                }
            }
        }
        let slopes = |axis: usize| {
            let columns = jacobian.column(axis).iter().map(|column| kappa * widths[axis] * column);
            columns.collect::<Vec<f64>>()
        };
        let slopes: Vec<Vec<f64>> = (0..widths.len()).map(slopes).collect();
        let weighed = |slope: &Vec<f64>| {
            let by = |(band, s): (usize, &f64)| s / self.statistics.variance(band, means[band]);
            slope.iter().enumerate().map(by).collect::<Vec<f64>>()
        };
        let scores: Vec<Vec<f64>> = slopes.iter().map(weighed).collect();
        for (i, score) in scores.iter().enumerate() {
            let mut row = score.clone();
            let mut factors = Vec::with_capacity(i + 1);
            for (j, slope) in slopes.iter().enumerate().take(i + 1) {
                let mut sum = f64::from(u8::from(i == j)) + dot(score, slope);
                sum -= (0..j)
                    .map(|l| factors[l] * if i == j { factors[l] } else { node.lower[j][l] })
                    .sum::<f64>();
                factors.push(if i == j { sum.max(1.0).sqrt() } else { sum / node.lower[j][j] });
            }
            for (factor, (earlier, _)) in factors.iter().zip(&node.scores) {
                row.iter_mut().zip(earlier).for_each(|(row, earlier)| *row -= factor * earlier);
            }
            let diagonal = factors[i];
            row.iter_mut().for_each(|row| *row /= diagonal);
            node.constant -= diagonal.ln();
            let taken =
                row.iter().zip(means.iter().zip(middle)).map(|(r, (mean, middle))| r * (mean - middle));
            let taken = taken.sum();
            node.scores.push((row, taken));
            node.lower.push(factors);
        }
        node
    }
}

/// Logarithms of the mean likelihood over all states, and over every second one.
fn log_means(nodes: &[Node], off: &[f64]) -> [f64; 2] {
    let logs: Vec<f64> = nodes.iter().map(|node| node.log(off)).collect();
    let of = |step: usize| {
        let some = || logs.iter().step_by(step);
        let most = some().fold(f64::NEG_INFINITY, |a, b| a.max(*b));
        let sum: f64 = some().filter(|log| **log > most - NEGLIGIBLE).map(|log| (log - most).exp()).sum();
        most + sum.ln() - (some().count() as f64).ln()
    };
    [of(1), of(2)]
}

/// In four sums, which run side by side.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    let (fours, rest) = (a.chunks_exact(4).zip(b.chunks_exact(4)), a.len() / 4 * 4);
    for (a, b) in fours {
        (0..4).for_each(|i| sums[i] += a[i] * b[i]);
    }
    sums.iter().sum::<f64>() + a[rest..].iter().zip(&b[rest..]).map(|(a, b)| a * b).sum::<f64>()
}

#[cfg(test)]
mod tests;
