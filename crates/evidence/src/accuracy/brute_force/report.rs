//! What a run of the brute force is asked and tells, set of unknowns by set of unknowns.

use super::scene::Set;

/// Failures of a set that are told in full.
const TOLD: usize = 8;
/// Excess of a distance that is told as large.
const LARGE: f64 = 0.01;

/// What to run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
pub struct BruteForcePlan {
    /// How many scenes of every set of unknowns.
    pub scenes_per_set: u64,
    /// Seed that determines which cases are drawn.
    pub seed: u64,
    /// One case alone, by its number.
    pub only: Option<u64>,
}

/// What one case finds.
#[derive(Debug, Clone, Default)]
pub(super) struct Judged {
    /// Whether there is no distance at all.
    pub(super) vanishing: bool,
    /// Share by which the distance is above the brute force's.
    pub(super) excess: f64,
    /// By more than the tolerance and the stated error.
    pub(super) above: bool,
    /// Whether the lower bound is above the brute force's distance.
    pub(super) lower_above: bool,
    /// Whether the lower bound is within the tolerance of the distance, or anything above 0.
    pub(super) proved: bool,
    pub(super) bounded: bool,
    pub(super) error_told: bool,
    pub(super) error_wrong: bool,
    /// Whether the brute force ended above the state of the answer.
    pub(super) missed: bool,
    pub(super) solver_s: f64,
    pub(super) brute_force_s: f64,
    pub(super) faults: Vec<String>,
}

impl Judged {
    pub(super) fn fault(what: String) -> Self {
        Self { faults: vec![what], ..Self::default() }
    }
}

/// What went wrong in one case.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Failure {
    /// Number of the case: with the seed it says all there is to say.
    pub case: u64,
    /// What is wrong in this case, in words.
    pub what: String,
}

/// How the cases of one set of unknowns went.
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize)]
pub struct SetReport {
    /// Names of the unknowns of this set.
    pub unknown: String,
    /// Number of cases of this set.
    pub cases: u64,
    /// Cases with a false statement: in these, `first_failures` say which.
    pub failures: u64,
    /// The first few of them.
    pub first_failures: Vec<Failure>,
    /// Proved lower bounds above a distance that is possible.
    pub lower_above: u64,
    /// Cases with no distance at all: the alternative can imitate the target. What follows is of the others.
    pub vanishing: u64,
    /// Distances above a possible one by more than the tolerance of the proof and their stated error, proved or not.
    pub above: u64,
    /// Those by more than 1 %.
    pub far_above: u64,
    /// Largest excess, as a share, and its case.
    pub worst_excess: f64,
    /// Number of the case with the largest excess, `worst_excess`.
    pub worst_case: u64,
    /// Cases with a lower bound within the tolerance.
    pub proved: u64,
    /// Cases without any lower bound.
    pub unproved: u64,
    /// Cases without a stated error.
    pub error_untold: u64,
    /// Stated errors that are too small.
    pub error_wrong: u64,
    /// Cases in which the brute force ended above the way down from the answer's own state: how good a witness it is.
    pub missed: u64,
    /// Number of the last case that the brute force missed.
    pub missed_case: Option<u64>,
    /// Mean time of the solver and of the brute force, s.
    pub mean_solver_s: f64,
    /// Mean time of the brute force for a case, s.
    pub mean_brute_force_s: f64,
    /// Longest time of the solver, s.
    pub longest_solver_s: f64,
}

/// A plan with how it went.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct BruteForceReport {
    /// Number of cases of every set of unknowns.
    pub scenes_per_set: u64,
    /// Seed from which the cases were drawn.
    pub seed: u64,
    /// Cases with a false statement.
    pub failures: u64,
    /// One report for every set of unknowns.
    pub sets: Vec<SetReport>,
}

impl BruteForceReport {
    pub(super) fn new(plan: &BruteForcePlan, tallies: Vec<Tally>) -> Self {
        let sets: Vec<SetReport> =
            tallies.into_iter().map(|tally| tally.0).filter(|set| set.cases > 0).collect();
        let failures = sets.iter().map(|set| set.failures).sum();
        Self { scenes_per_set: plan.scenes_per_set, seed: plan.seed, failures, sets }
    }
}

/// The sums of one set so far.
#[derive(Debug, Clone)]
pub(super) struct Tally(SetReport);

impl Tally {
    pub(super) fn new(set: Set) -> Self {
        Self(SetReport { unknown: set.name(), ..SetReport::default() })
    }

    /// Takes in one case more.
    pub(super) fn add(&mut self, case: u64, judged: Judged) {
        let set = &mut self.0;
        let mean = |mean: &mut f64, value: f64| *mean += (value - *mean) / (set.cases + 1) as f64;
        mean(&mut set.mean_solver_s, judged.solver_s);
        mean(&mut set.mean_brute_force_s, judged.brute_force_s);
        set.cases += 1;
        set.longest_solver_s = set.longest_solver_s.max(judged.solver_s);
        let counts = [
            (&mut set.lower_above, judged.lower_above),
            (&mut set.vanishing, judged.vanishing),
            (&mut set.above, judged.above),
            (&mut set.far_above, judged.above && judged.excess > LARGE),
            (&mut set.proved, judged.proved && !judged.vanishing),
            (&mut set.unproved, !judged.bounded && !judged.proved && !judged.vanishing),
            (&mut set.error_untold, !judged.error_told),
            (&mut set.error_wrong, judged.error_wrong),
            (&mut set.missed, judged.missed),
        ];
        for (count, counts) in counts {
            *count += u64::from(counts);
        }
        if judged.above && judged.excess > set.worst_excess {
            (set.worst_excess, set.worst_case) = (judged.excess, case);
        }
        if judged.missed {
            set.missed_case = Some(case);
        }
        if !judged.faults.is_empty() {
            set.failures += 1;
            if set.first_failures.len() < TOLD {
                set.first_failures.push(Failure { case, what: judged.faults.join("; ") });
            }
        }
    }
}
