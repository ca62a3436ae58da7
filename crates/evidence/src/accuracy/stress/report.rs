//! What a run of the suite tells, family by family.

use super::findings::{Family, Findings, Point};
use std::collections::BTreeMap;

/// Failures that are told in full.
const TOLD: usize = 50;
/// Points of a picture that are kept.
const POINTS: usize = 4000;
/// Digits that a double holds.
const MOST_DIGITS: f64 = 16.0;

/// What went wrong in one case.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Failure {
    /// Number of the case: with the seed it says all there is to say.
    pub case: u64,
    /// What is wrong in this case, in words.
    pub what: String,
}

/// Digits of a relative error, between 0 and 16.
pub(super) fn digits(relative_error: f64) -> f64 {
    if relative_error > 0.0 { (-relative_error.log10()).clamp(0.0, MOST_DIGITS) } else { MOST_DIGITS }
}

/// How the cases of one family went.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct FamilyReport {
    /// Name of the family of cases.
    pub family: Family,
    /// Which weakness of the computation the family is meant to find.
    pub stresses: &'static str,
    /// Number of cases of this family.
    pub cases: u64,
    /// Number of comparisons with a reference computation.
    pub comparisons: u64,
    /// Cases in which anything was wrong.
    pub failures: u64,
    /// The first few of them.
    pub first_failures: Vec<Failure>,
    /// Largest true error over the bound that was given for it.
    pub worst_ratio: f64,
    /// The case it is from.
    pub worst_case: u64,
    /// Median of bound over true error, within a tenth of a decade; nothing where no answer was off at all.
    pub median_overestimation: Option<f64>,
    /// Comparisons by whole digits kept, 0 to 16 (exact, and rounded once, in the last).
    pub digits_kept: Vec<u64>,
    /// Comparisons by whole digits that the bound promises.
    pub digits_promised: Vec<u64>,
}

/// A plan with how it went.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct StressReport {
    /// Number of cases of every family.
    pub cases: u64,
    /// Seed from which the cases were generated.
    pub seed: u64,
    /// Cases in which anything was wrong.
    pub failures: u64,
    /// One report for every family of cases.
    pub families: Vec<FamilyReport>,
    /// Scenes near equilibrium, for a picture.
    pub points: Vec<Point>,
}

/// A family's sums so far; the order of adding does not matter.
#[derive(Debug, Clone, Default)]
struct Tally {
    cases: u64,
    comparisons: u64,
    failures: u64,
    first_failures: Vec<Failure>,
    /// Ratio and case.
    worst: (f64, u64),
    /// Counts of ⌊10 log₁₀(bound/error)⌋.
    overestimation: BTreeMap<i32, u64>,
    kept: [u64; 17],
    promised: [u64; 17],
}

/// Everything so far.
#[derive(Debug, Clone, Default)]
pub(super) struct Tallies {
    families: BTreeMap<Family, Tally>,
    points: Vec<Point>,
}

impl Tallies {
    /// Takes in what a case has found.
    pub(super) fn add(&mut self, case: u64, family: Family, found: Findings) {
        let tally = self.families.entry(family).or_default();
        tally.cases += 1;
        for (error, bound) in found.checks {
            tally.compare(case, error, bound);
        }
        if !found.faults.is_empty() {
            tally.failures += 1;
            tally.first_failures.push(Failure { case, what: found.faults.join("; ") });
            tally.shorten();
        }
        self.points.extend(found.points);
        self.points.truncate(POINTS);
    }

    /// Those of later cases after these.
    pub(super) fn then(mut self, later: Self) -> Self {
        for (family, tally) in later.families {
            self.families.entry(family).or_default().then(tally);
        }
        self.points.extend(later.points);
        self.points.sort_by_key(|point| point.case);
        self.points.truncate(POINTS);
        self
    }

    pub(super) fn report(self, cases: u64, seed: u64) -> StressReport {
        let families: Vec<FamilyReport> =
            self.families.into_iter().map(|(family, tally)| tally.report(family)).collect();
        let failures = families.iter().map(|family| family.failures).sum();
        StressReport { cases, seed, failures, families, points: self.points }
    }
}

impl Tally {
    fn compare(&mut self, case: u64, error: f64, bound: f64) {
        self.comparisons += 1;
        let ratio = if error == 0.0 { 0.0 } else { error / bound };
        if ratio > self.worst.0 || (ratio == self.worst.0 && case < self.worst.1) {
            self.worst = (ratio, case);
        }
        if ratio > 0.0 && ratio.is_finite() {
            *self.overestimation.entry((-10.0 * ratio.log10()).floor() as i32).or_default() += 1;
        }
        self.kept[digits(error) as usize] += 1;
        self.promised[digits(bound) as usize] += 1;
    }

    fn shorten(&mut self) {
        self.first_failures.sort_by_key(|failure| failure.case);
        self.first_failures.truncate(TOLD);
    }

    fn then(&mut self, later: Self) {
        self.cases += later.cases;
        self.comparisons += later.comparisons;
        self.failures += later.failures;
        self.first_failures.extend(later.first_failures);
        self.shorten();
        if later.worst.0 > self.worst.0 || (later.worst.0 == self.worst.0 && later.worst.1 < self.worst.1) {
            self.worst = later.worst;
        }
        for (bin, count) in later.overestimation {
            *self.overestimation.entry(bin).or_default() += count;
        }
        for (mine, later) in [(&mut self.kept, later.kept), (&mut self.promised, later.promised)] {
            mine.iter_mut().zip(later).for_each(|(mine, later)| *mine += later);
        }
    }

    fn report(self, family: Family) -> FamilyReport {
        let all: u64 = self.overestimation.values().sum();
        let mut seen = 0;
        let median = self.overestimation.iter().find(|(_, count)| {
            seen += **count;
            2 * seen >= all
        });
        FamilyReport {
            family,
            stresses: family.stresses(),
            cases: self.cases,
            comparisons: self.comparisons,
            failures: self.failures,
            first_failures: self.first_failures,
            worst_ratio: self.worst.0,
            worst_case: self.worst.1,
            median_overestimation: median.map(|(bin, _)| 10f64.powf((f64::from(*bin) + 0.5) / 10.0)),
            digits_kept: self.kept.to_vec(),
            digits_promised: self.promised.to_vec(),
        }
    }
}
