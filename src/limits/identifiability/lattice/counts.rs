//! The counts of one band, in cells, with the probability of each under the target's law.
//!
//! Discrete laws: probabilities of neighbouring counts have a known ratio, N/(n+1) for Poisson and
//! (n+m)N/[(n+1)(N+m)] for the negative binomial, so they are built outwards from the mode until nothing is
//! left and divided by their sum: no Γ function, and every probability good to a few ulp times its distance
//! from the mode. Gaussian: differences of Φ.

use super::super::detection;
use crate::error::{Error, Result};
use crate::statistics::Statistics;

/// Share of the largest probability below which counts are not looked at.
const NOTHING: f64 = 1e-25;
/// More counts than this are not held.
const MAX_COUNTS: f64 = 2e7;

/// Cells along the counts of one band. Counts are told relative to the target's mean.
#[derive(Debug, Clone)]
pub(super) struct Axis {
    /// Lowest, middle and highest count of each cell.
    cells: Vec<[f64; 3]>,
    /// Probability of all cells before the i-th.
    before: Vec<f64>,
    /// Probability of what no cell holds.
    outside: f64,
    /// Cells per standard deviation.
    per_sigma: f64,
}

impl Axis {
    /// One axis per band, with no more than `tail` outside of all of them.
    pub(super) fn all(statistics: &Statistics, means: &[f64], cells: usize, tail: f64) -> Result<Vec<Self>> {
        let side = tail / (2.0 * means.len() as f64);
        means.iter().enumerate().map(|(band, &mean)| Self::new(statistics, band, mean, cells, side)).collect()
    }

    fn new(statistics: &Statistics, band: usize, mean: f64, cells: usize, side: f64) -> Result<Self> {
        let sigma = statistics.variance(band, mean).sqrt();
        match statistics {
            Statistics::Poisson => Self::discrete(mean, sigma, cells, side, |n| mean / (n + 1.0)),
            Statistics::NegativeBinomial { modes } => {
                let m = modes[band];
                let share = mean / (mean + m);
                Self::discrete(mean, sigma, cells, side, |n| share * ((n + m) / (n + 1.0)))
            }
            Statistics::Gaussian { .. } => Self::gaussian(sigma, cells, side),
        }
    }

    /// From the ratio P(n+1)/P(n), which falls with n.
    fn discrete(mean: f64, sigma: f64, cells: usize, side: f64, ratio: impl Fn(f64) -> f64) -> Result<Self> {
        crate::stop::check();
        let too_many = || {
            Error::out_of_range("counts of a band", mean, "", "fewer for a lattice; or Gaussian statistics")
        };
        if !(sigma * 60.0 < MAX_COUNTS && mean < 1e15) {
            return Err(too_many());
        }
        // Start anywhere near the mode; all is relative until the sum is known.
        let start = mean.floor();
        let mut below = Vec::new();
        let (mut n, mut p) = (start, 1.0);
        while n > 0.0 && p > NOTHING {
            n -= 1.0;
            p /= ratio(n);
            below.push(p);
        }
        let mut masses: Vec<f64> = below.into_iter().rev().collect();
        let first = start - masses.len() as f64;
        masses.push(1.0);
        (n, p) = (start, 1.0);
        while p > NOTHING {
            p *= ratio(n);
            n += 1.0;
            masses.push(p);
            if masses.len() as f64 > MAX_COUNTS {
                return Err(too_many());
            }
        }
        let sum = crate::sum::sum(&masses);
        masses.iter_mut().for_each(|mass| *mass /= sum);

        let (low, left) = trimmed(masses.iter(), side);
        let (high, right) = trimmed(masses[low..].iter().rev(), side);
        let kept = &masses[low..masses.len() - high];
        let group = kept.len().div_ceil(cells);
        let (mut found, mut before) = (Vec::new(), vec![0.0]);
        let mut so_far = crate::sum::Compensated::default();
        let origin = (first - mean) + low as f64;
        for (i, group_masses) in kept.chunks(group).enumerate() {
            let lowest = origin + (i * group) as f64;
            let highest = lowest + (group_masses.len() - 1) as f64;
            found.push([lowest, 0.5 * (lowest + highest), highest]);
            group_masses.iter().for_each(|&mass| so_far.add(mass));
            before.push(so_far.value());
        }
        Ok(Self { per_sigma: sigma / group as f64, cells: found, before, outside: left + right })
    }

    fn gaussian(sigma: f64, cells: usize, side: f64) -> Result<Self> {
        crate::stop::check();
        let reach = detection::distance_for_probability(1.0 - side)?;
        let edge = |i: usize| reach * (2.0 * i as f64 / cells as f64 - 1.0);
        let outside = detection::miss_probability(reach);
        Ok(Self {
            cells: (0..cells)
                .map(|i| [edge(i), 0.5 * (edge(i) + edge(i + 1)), edge(i + 1)].map(|x| sigma * x))
                .collect(),
            before: (0..=cells).map(|i| detection::probability(edge(i)) - outside).collect(),
            outside: 2.0 * outside,
            per_sigma: cells as f64 / (2.0 * reach),
        })
    }

    pub(super) fn len(&self) -> usize {
        self.cells.len()
    }

    /// Probability of the cells from `from` to before `to`.
    pub(super) fn mass(&self, from: usize, to: usize) -> f64 {
        self.before[to] - self.before[from]
    }

    /// Lowest and highest count of the cells from `from` to before `to`.
    pub(super) fn extent(&self, from: usize, to: usize) -> [f64; 2] {
        [self.cells[from][0], self.cells[to - 1][2]]
    }

    /// Where cell `i` is decided.
    pub(super) fn middle(&self, i: usize) -> f64 {
        self.cells[i][1]
    }

    /// Width of `cells` cells in standard deviations.
    pub(super) fn deviations(&self, cells: usize) -> f64 {
        cells as f64 / self.per_sigma
    }
}

/// How many of the first masses together are no more than `side`, and what they are.
fn trimmed<'a>(masses: impl Iterator<Item = &'a f64>, side: f64) -> (usize, f64) {
    let (mut count, mut cut) = (0, 0.0);
    for mass in masses {
        if cut + mass > side {
            break;
        }
        cut += mass;
        count += 1;
    }
    (count, cut)
}

/// Probability of the counts that no axis holds.
pub(super) fn tail(axes: &[Axis]) -> f64 {
    -axes.iter().map(|axis| (-axis.outside).ln_1p()).sum::<f64>().exp_m1()
}

#[cfg(test)]
mod tests {
    use super::*;
    use statrs::function::gamma::ln_gamma;

    /// Mass by mass against the textbook form; ln Γ loses 1e-15 of n ln n.
    #[test]
    fn masses_are_those_of_the_law() {
        for mean in [0.3, 7.5, 2000.0] {
            let axis = &Axis::all(&Statistics::Poisson, &[mean], 10_000, 1e-9).unwrap()[0];
            for i in 0..axis.len() {
                let n = (mean + axis.middle(i)).round();
                let exact = (n * mean.ln() - mean - ln_gamma(n + 1.0)).exp();
                assert!((axis.mass(i, i + 1) - exact).abs() < 1e-11 * exact + 4e-16, "{mean} {n}");
            }
            let whole = axis.mass(0, axis.len());
            assert!(axis.outside <= 1e-9 && (whole + axis.outside - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn groups_hold_what_their_counts_hold() {
        let fine = &Axis::all(&Statistics::Poisson, &[500.0], 10_000, 1e-6).unwrap()[0];
        let coarse = &Axis::all(&Statistics::Poisson, &[500.0], 30, 1e-6).unwrap()[0];
        let group = fine.len().div_ceil(30);
        for i in 0..coarse.len() {
            let to = ((i + 1) * group).min(fine.len());
            assert!((coarse.mass(i, i + 1) - fine.mass(i * group, to)).abs() < 1e-14);
            assert_eq!(coarse.extent(i, i + 1), fine.extent(i * group, to));
        }
    }

    #[test]
    fn continuous_counts_are_all_there() {
        let statistics = Statistics::gaussian(vec![100.0]).unwrap();
        let axis = &Axis::all(&statistics, &[800.0], 64, 1e-6).unwrap()[0];
        assert!((axis.mass(0, 64) + axis.outside - 1.0).abs() < 1e-15);
        assert!(
            (axis.outside / 1e-6 - 1.0).abs() < 1e-6 && (axis.extent(0, 64)[1] / 30.0 - 4.8916).abs() < 1e-3
        );
    }
}
