//! Class errors with so few counts that the characteristic function does not fall.
//!
//! Counts are independent rare events: of a Poisson band N of step L = ln(N′/N); of a negative binomial band
//! clusters of k with m r^k/k, r = N/(N + m), and step k ln(r′/r). An event of means N and N′ whose step lies between
//! two points ηk, η(k+1) of a lattice is split into two of these steps, so that N and N′ are both kept. The finer
//! events tell more, never less, so the error found is too small, by a relative O(η² times the events), or O(η) where
//! Λ = 0 is likely. The law of the sum on the lattice is one discrete Fourier transform, exact but for what wraps
//! around (below e⁻³⁷). How far off it can be is known: a test that rounds the steps of Λ to a lattice (of 2η) is a test,
//! so that it errs no less often than the best one; its errors are two more transforms.
//!
//! Splitting and the transform: as for privacy losses, Doroshenko et al., Proc. Priv. Enhancing Technol. 2022(4), 552.

use super::integrals::Integrals;
use super::line::{Line, Mode};
use std::f64::consts::PI;

/// Clusters that are gone through for one band.
const CLUSTERS: usize = 4000;

/// Events of one kind under the tilted law: mean number and step, that of so many counts.
#[derive(Debug, Clone, Copy)]
struct Events {
    mean: f64,
    step: f64,
    counts: f64,
}

/// A lattice of `points` for Λ: of step `range`/points, from `low` on, `origin` without any event.
#[derive(Debug, Clone, Copy)]
struct Grid {
    origin: f64,
    low: f64,
    range: f64,
    points: usize,
}

/// Both sums, the finer lattice of `points`, a power of two; nothing for a law without counts, or with too many.
pub(super) fn transform(line: &Line, points: usize) -> Option<Integrals> {
    crate::stop::check();
    let events = events(line)?;
    let steps = events.iter().map(|event| event.step.abs());
    let largest = steps.fold(0.0, f64::max);
    let mean: f64 = events.iter().map(|event| event.mean * event.step).sum();
    // Events shift Λ from where it is without any.
    let origin = line.moments.slope - mean;
    let low = mean - line.reach(-1.0, 37.0);
    let high = mean + line.reach(1.0, 37.0);
    let range = high.max(0.0) - low.min(0.0) + 4.0 * largest;
    if !(range.is_finite() && origin.is_finite() && largest > 0.0) {
        return None;
    }
    let grid = Grid { origin, low: low - 2.0 * largest, range, points };
    let fine = split(line, &events, grid);
    let rounded = rounded(line, &events, Grid { points: points / 2, ..grid });
    let beyond = (rounded[0] + rounded[1] - (fine[0] + fine[1])).max(0.0);
    // In first order of η where Λ has ties: as far again.
    let change = |a: f64, b: f64| 2.0 * (a - b).abs();
    // Of 10⁵ terms, none of them known better than 1e-18.
    let rounding = 1e-13 + 1e-15 * line.moments.exponent;
    Some(Integrals {
        first: fine[0],
        second: fine[1],
        exponent: line.moments.exponent,
        numerical: beyond + rounding,
        numerical_class: change(fine[0], rounded[0]).max(change(fine[1], rounded[1])) + rounding,
    })
}

fn events(line: &Line) -> Option<Vec<Events>> {
    let mut events = Vec::new();
    for mode in &line.modes {
        match *mode {
            Mode::Poisson { mean, step } => events.push(Events { mean, step, counts: 1.0 }),
            Mode::Bunched { modes, occupancy, step } => {
                let ln_ratio = -(1.0 / occupancy).ln_1p();
                if -40.0 / ln_ratio > CLUSTERS as f64 {
                    return None;
                }
                let many = (-40.0 / ln_ratio) as usize + 2;
                events.extend((1..=many).map(|k| k as f64).map(|k| Events {
                    mean: modes * (k * ln_ratio).exp() / k,
                    step: k * step,
                    counts: k,
                }));
            }
            Mode::Normal { .. } => return None,
        }
    }
    Some(events)
}

/// E[e^{−sΛ}; Λ > 0] and E[e^{(1−s)Λ}; Λ < 0] of the split events, relative to the law that is not split.
fn split(line: &Line, events: &[Events], grid: Grid) -> [f64; 2] {
    let (s, t, eta) = (line.s, line.t, grid.step());
    let (mut means, mut gained) = (vec![(0.0, 0.0); grid.points], 0.0);
    for event in events {
        crate::stop::check();
        let below = (event.step / eta).floor();
        // Parts of the events under the tilted law with N = a + b, N′ = ae^{ηk} + be^{η(k+1)}: the share
        // (e^{L−ηk} − 1)/(e^η − 1) of N takes the upper step.
        let rest = event.step - below * eta;
        let upper = rest.exp_m1() / eta.exp_m1();
        let (a, b) = ((1.0 - upper) * (-s * rest).exp(), upper * (s * (eta - rest)).exp());
        means[grid.place(below)].0 += event.mean * a;
        means[grid.place(below + 1.0)].0 += event.mean * b;
        gained += event.mean * ((1.0 - upper) * (-s * rest).exp_m1() + upper * (s * (eta - rest)).exp_m1());
    }
    let (mut first, mut second) = (0.0, 0.0);
    // The exponent of the split events is smaller by `gained`.
    for (p, ratio) in grid.law(means, gained) {
        if ratio.abs() < 1e-13 * grid.range {
            first += 0.5 * p;
            second += 0.5 * p;
        } else if ratio > 0.0 {
            first += p * (-s * ratio).exp();
        } else {
            second += p * (t * ratio).exp();
        }
    }
    [first, second]
}

/// Errors of the test by the sum T of the steps rounded to the lattice, its threshold where the rounding moves their mean to,
/// relative to the same law: T has the law of its steps under p, tilted by e^{sT}, and under q, by e^{−(1−s)T}.
fn rounded(line: &Line, events: &[Events], grid: Grid) -> [f64; 2] {
    let eta = grid.step();
    let off = |event: &Events| {
        let steps = (event.step / event.counts / eta).round() * event.counts;
        (steps, steps * eta - event.step)
    };
    let threshold = events.iter().map(|event| event.mean * off(event).1).sum::<f64>();
    [(1.0, line.s), (-1.0, line.t)].map(|(sign, tilt)| {
        let (mut means, mut gained) = (vec![(0.0, 0.0); grid.points], 0.0);
        for event in events {
            let (steps, off) = off(event);
            means[grid.place(steps)].0 += event.mean * (sign * tilt * off).exp();
            gained += event.mean * (sign * tilt * off).exp_m1();
        }
        let wrong = |(p, ratio): (f64, f64)| {
            let beyond = sign * (ratio - threshold);
            let share = if beyond > 0.0 { 1.0 } else { 0.0 };
            let share = if beyond.abs() < 1e-13 * grid.range { 0.5 } else { share };
            share * p * (-sign * tilt * ratio).exp()
        };
        grid.law(means, gained).map(wrong).sum()
    })
}

impl Grid {
    fn step(&self) -> f64 {
        self.range / self.points as f64
    }

    fn place(&self, k: f64) -> usize {
        (k as i64).rem_euclid(self.points as i64) as usize
    }

    /// Probabilities, times e^`gained`, with the values of the sum of events of so many `means` of each step.
    fn law(self, mut means: Vec<(f64, f64)>, gained: f64) -> impl Iterator<Item = (f64, f64)> {
        means[0] = (0.0, 0.0);
        let total: f64 = means.iter().map(|mean| mean.0).sum();
        fourier(&mut means, -1.0);
        for value in &mut means {
            let modulus = (value.0 - total).exp();
            let (sine, cosine) = value.1.sin_cos();
            *value = (modulus * cosine, modulus * sine);
        }
        fourier(&mut means, 1.0);
        let scale = gained.exp() / self.points as f64;
        let start = (self.low / self.step()).floor();
        (0..self.points).map(move |k| {
            let steps = start + k as f64;
            ((means[self.place(steps)].0 * scale).max(0.0), self.origin + steps * self.step())
        })
    }
}

/// Σ x_j e^{±2πijk/n} in place (Cooley and Tukey), n a power of two.
fn fourier(x: &mut [(f64, f64)], sign: f64) {
    crate::stop::check();
    let n = x.len();
    if n < 2 {
        return;
    }
    let bits = n.trailing_zeros();
    for i in 0..n {
        let j = i.reverse_bits() >> (usize::BITS - bits);
        if i < j {
            x.swap(i, j);
        }
    }
    let root = |k: usize| (sign * 2.0 * PI * k as f64 / n as f64).sin_cos();
    let roots: Vec<(f64, f64)> = (0..n / 2).map(root).collect();
    let mut half = 1;
    while half < n {
        crate::stop::check();
        let stride = n / (2 * half);
        for block in x.chunks_mut(2 * half) {
            let (low, high) = block.split_at_mut(half);
            for (k, (a, b)) in low.iter_mut().zip(high).enumerate() {
                let (sine, cosine) = roots[k * stride];
                let turned = (b.0 * cosine - b.1 * sine, b.0 * sine + b.1 * cosine);
                *b = (a.0 - turned.0, a.1 - turned.1);
                *a = (a.0 + turned.0, a.1 + turned.1);
            }
        }
        half *= 2;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_transform_is_the_sum() {
        let x: Vec<(f64, f64)> = (0..16).map(|j| (f64::from(j).sin(), f64::from(j * j).cos())).collect();
        let mut found = x.clone();
        fourier(&mut found, -1.0);
        for (k, value) in found.iter().enumerate() {
            let mut sum = (0.0, 0.0);
            for (j, x) in x.iter().enumerate() {
                let (sine, cosine) = (-2.0 * PI * (j * k) as f64 / 16.0).sin_cos();
                sum.0 += x.0 * cosine - x.1 * sine;
                sum.1 += x.0 * sine + x.1 * cosine;
            }
            assert!((sum.0 - value.0).abs() < 1e-13 && (sum.1 - value.1).abs() < 1e-13, "{k}");
        }
    }
}
