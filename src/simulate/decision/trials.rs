//! Trials of a decision, block by block.

use crate::identifiability::likelihood::{MaximumLikelihood, Terms};
use crate::scene::State;
use crate::simulate::draws::{Draws, generator};
use crate::simulate::sequential::{BLOCK, Interval, Plan};
use crate::statistics::Statistics;
use rand::rngs::ChaCha8Rng;
use rayon::prelude::*;

/// Likelihoods closer than this are a tie: fits end within 1e-9 of the largest likelihood.
const TIE: f64 = 1e-6;
/// Streams of random numbers set aside for the trials of one truth.
const STREAMS: u64 = 1 << 40;

/// A material and the states its fits start from; one without any is not fitted.
#[derive(Debug, Clone)]
pub(super) struct Candidate<'a> {
    pub(super) emissivity: &'a [f64],
    pub(super) starts: Vec<State>,
}

/// What the likelihoods of the candidates are.
#[derive(Debug, Clone)]
pub(super) enum Rule<'a> {
    /// The largest over the free states.
    Fitted { fits: Box<MaximumLikelihood<'a>>, candidates: Vec<Candidate<'a>>, known: State },
    /// Those of given means.
    Known { statistics: &'a Statistics, means: Vec<Vec<f64>>, terms: Terms },
}

/// Counts from one truth, and how they are judged.
#[derive(Debug, Clone)]
pub(super) struct Test<'a> {
    pub(super) draws: Draws,
    /// Which candidate is true.
    pub(super) truth: usize,
    pub(super) rule: Rule<'a>,
    pub(super) counts: Vec<f64>,
}

/// What came of them.
#[derive(Debug, Clone, Default)]
pub(super) struct Trials {
    pub(super) decisions: Vec<f64>,
    pub(super) trials: u64,
    pub(super) unconverged: u64,
}

impl Trials {
    /// Share of decisions for one candidate.
    pub(super) fn share(&self, candidate: usize) -> f64 {
        self.decided(candidate) / self.trials.max(1) as f64
    }

    pub(super) fn interval(&self, candidate: usize, plan: &Plan) -> Interval {
        Interval::wilson(self.decided(candidate), self.trials, plan.level())
    }

    fn decided(&self, candidate: usize) -> f64 {
        self.decisions.get(candidate).copied().unwrap_or(0.0)
    }

    fn add(&mut self, other: &Self) {
        self.decisions.resize(other.decisions.len(), 0.0);
        self.decisions.iter_mut().zip(&other.decisions).for_each(|(sum, more)| *sum += more);
        self.trials += other.trials;
        self.unconverged += other.unconverged;
    }

    /// Decides for the largest likelihood; those that tie share the decision.
    fn decide(&mut self, log_likelihoods: &[f64]) {
        self.decisions.resize(log_likelihoods.len(), 0.0);
        let largest = log_likelihoods.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let wins = |value: f64| value >= largest - TIE;
        let winners = log_likelihoods.iter().filter(|value| wins(**value)).count();
        for (decided, value) in self.decisions.iter_mut().zip(log_likelihoods) {
            *decided += if wins(*value) { 1.0 / winners as f64 } else { 0.0 };
        }
        self.trials += 1;
    }
}

impl Test<'_> {
    fn block(&mut self, seed: u64, block: u64, trials: u64) -> Trials {
        let mut rng = generator(seed, self.truth as u64 * STREAMS + block);
        let mut outcome = Trials::default();
        let mut log_likelihoods = Vec::new();
        for _ in 0..trials {
            log_likelihoods.clear();
            self.trial(&mut rng, &mut log_likelihoods, &mut outcome.unconverged);
            outcome.decide(&log_likelihoods);
        }
        outcome
    }

    fn trial(&mut self, rng: &mut ChaCha8Rng, log_likelihoods: &mut Vec<f64>, unconverged: &mut u64) {
        let counts = &mut self.counts;
        self.draws.draw_into(rng, counts);
        match &mut self.rule {
            Rule::Known { statistics, means, terms } => {
                let losses = means.iter().map(|means| terms.evaluate(statistics, 1.0, means, counts));
                log_likelihoods.extend(losses.map(|loss| -loss));
            }
            Rule::Fitted { fits, candidates, known } => {
                for candidate in candidates.iter() {
                    if candidate.starts.is_empty() {
                        log_likelihoods.push(f64::NEG_INFINITY);
                        continue;
                    }
                    let fit = fits.fit(candidate.emissivity, counts, known, &candidate.starts);
                    *unconverged += u64::from(!fit.converged);
                    log_likelihoods.push(fit.log_likelihood);
                }
            }
        }
    }
}

/// Rounds of trials of every test until the interval is narrow enough. Blocks are spread over the threads of the pool
/// and added in their order.
pub(super) fn run<const TRUTHS: usize>(
    plan: &Plan,
    tests: &[Test<'_>; TRUTHS],
    interval: impl Fn(&[Trials; TRUTHS]) -> Interval,
) -> [Trials; TRUTHS] {
    let mut sums: [Trials; TRUTHS] = std::array::from_fn(|_| Trials::default());
    let (mut done, mut half_width) = (0, f64::INFINITY);
    while let Some(total) = plan.next_total(done, half_width) {
        for (test, sum) in tests.iter().zip(&mut sums) {
            let blocks: Vec<Trials> = (done / BLOCK..total.div_ceil(BLOCK))
                .into_par_iter()
                .map_init(
                    || test.clone(),
                    |test, block| test.block(plan.seed(), block, BLOCK.min(total - block * BLOCK)),
                )
                .collect();
            blocks.iter().for_each(|block| sum.add(block));
        }
        done = total;
        half_width = interval(&sums).half_width();
    }
    sums
}
