//! Trials of a decision, block by block.

use crate::classifier::{Classifier, Judge, share};
use crate::draws::{Draws, STREAMS, generator};
use crate::sequential::{BLOCK, Interval, Plan};
use hadar::parallel;

/// Counts from one truth, and how they are judged.
pub(super) struct Test<'a> {
    pub(super) draws: Draws,
    /// Which candidate is true.
    pub(super) truth: usize,
    pub(super) rule: Box<dyn Classifier + 'a>,
    /// Candidates that are not fitted.
    pub(super) out_of_reach: Vec<usize>,
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
        share(log_likelihoods, &mut self.decisions);
        self.trials += 1;
    }
}

impl Test<'_> {
    fn block(&self, judge: &mut dyn Judge, seed: u64, block: u64, trials: u64) -> Trials {
        let mut rng = generator(seed, self.truth as u64 * STREAMS + block);
        let mut outcome = Trials::default();
        let (mut counts, mut scores) = (vec![0.0; self.draws.bands()], vec![0.0; self.rule.classes()]);
        for _ in 0..trials {
            hadar::stop::check();
            self.draws.draw_into(&mut rng, &mut counts);
            outcome.unconverged += u64::from(!judge.score(&counts, &mut scores));
            outcome.decide(&scores);
        }
        outcome
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
            let first = done / BLOCK;
            let blocks: Vec<Trials> = parallel::map_with(
                total.div_ceil(BLOCK).saturating_sub(first) as usize,
                || test.rule.judge(),
                |judge, i| {
                    let block = first + i as u64;
                    test.block(judge.as_mut(), plan.seed(), block, BLOCK.min(total - block * BLOCK))
                },
            );
            blocks.iter().for_each(|block| sum.add(block));
        }
        done = total;
        half_width = interval(&sums).half_width();
    }
    sums
}
