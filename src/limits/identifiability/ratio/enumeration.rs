//! Class errors by the sum over all counts of few bands.
//!
//! Under the tilted law of exponent C, α = e^{−C}E[e^{−sΛ}; Λ > 0] and β = e^{−C}E[e^{(1−s)Λ}; Λ < 0], ties by
//! halves. All counts of all bands but the one with the most are gone through; of that one the sums beyond any
//! threshold stand in a table. Counts less likely than 10⁻²⁰ of the likeliest are left out.

use super::effort::Effort;
use super::integrals::Integrals;
use super::line::{Line, Mode};
use crate::order;

/// Most counts of one band.
const TABLE: usize = 4_000_000;
/// Probabilities that are left out, against the largest.
const NOTHING: f64 = 1e-20;

/// What a band adds to Λ − μ′, ascending, with the probabilities under the tilted law.
type Law = Vec<(f64, f64)>;

/// Both sums; nothing if there are too many counts or no counts at all.
pub(super) fn enumerate(line: &Line, effort: Effort) -> Option<Integrals> {
    let mut modes = merged(&line.modes)?;
    // Widest last; a cheap look before tables are made.
    order::ascending(&mut modes, width);
    let widths: Vec<f64> = modes.iter().map(width).collect();
    let (widest, others) = widths.split_last()?;
    if *widest > effort.table as f64 || others.iter().product::<f64>() > effort.combinations as f64 {
        return None;
    }
    let last = law(modes.last()?);
    let mut combined: Law = vec![(line.moments.slope, 1.0)];
    for mode in modes.split_last()?.1 {
        let more = law(mode);
        combined =
            combined.iter().flat_map(|&(x, p)| more.iter().map(move |&(y, q)| (x + y, p * q))).collect();
    }
    let (s, t) = (line.s, line.t);
    // ln Σ w e^{−sΛ} from each count up, and ln Σ w e^{tΛ} up to it.
    let above = running(last.iter().rev().map(|&(x, w)| w.ln() - s * x));
    let below = running(last.iter().map(|&(x, w)| w.ln() + t * x));
    let size = |law: &Law| law.iter().fold(0.0_f64, |size, &(x, _)| size.max(x.abs()));
    // Sums of rounded steps that should be equal.
    let tie = 1e-13 * (size(&last) + size(&combined));
    let (mut first, mut second) = (0.0, 0.0);
    for &(x, weight) in &combined {
        crate::stop::check();
        let low = last.partition_point(|&(y, _)| y + x < -tie);
        let high = low + last[low..].partition_point(|&(y, _)| y + x <= tie);
        let ln_weight = weight.ln();
        if let Some(sum) = (last.len() - high).checked_sub(1).and_then(|k| above.get(k)) {
            first += (ln_weight - s * x + sum).exp();
        }
        if let Some(sum) = low.checked_sub(1).and_then(|k| below.get(k)) {
            second += (ln_weight + t * x + sum).exp();
        }
        let ties: f64 = last[low..high].iter().map(|&(_, w)| 0.5 * weight * w).sum();
        first += ties;
        second += ties;
    }
    let steps = widths.iter().map(|width| width.sqrt()).sum::<f64>();
    let exponent = line.moments.exponent;
    // Λ at its threshold is a difference of steps and their mean, and its rounding goes into exponentials; so does that of
    // the running logarithms, which are as large.
    let reach = size(&last) + size(&combined);
    let rounding = f64::EPSILON * (10.0 + steps + exponent + 4.0 * reach) * (first + second);
    Some(Integrals { first, second, exponent, numerical: rounding, numerical_class: rounding })
}

/// Poisson bands of the same step are one; nothing if a band has no counts.
fn merged(modes: &[Mode]) -> Option<Vec<Mode>> {
    let mut sorted = modes.to_vec();
    sorted.iter().all(|mode| mode.counted().is_some()).then_some(())?;
    let step = |mode: &Mode| mode.counted().map_or(0.0, |(step, _)| step);
    order::ascending(&mut sorted, step);
    let mut merged: Vec<Mode> = Vec::new();
    for mode in sorted {
        if let (Some(Mode::Poisson { mean, step }), Mode::Poisson { mean: more, step: next }) =
            (merged.last_mut(), mode)
            && (next - *step).abs() <= 1e-14 * step.abs()
        {
            *mean += more;
        } else {
            merged.push(mode);
        }
    }
    Some(merged)
}

/// About how many counts are likely.
fn width(mode: &Mode) -> f64 {
    match *mode {
        Mode::Poisson { mean, .. } => 20.0 * mean.sqrt() + 20.0,
        Mode::Bunched { modes, occupancy: x, .. } => {
            20.0 * (modes * x * (1.0 + x)).sqrt() + 50.0 / (1.0 / x).ln_1p() + 20.0
        }
        Mode::Normal { .. } => f64::INFINITY,
    }
}

/// Probabilities of a band's counts by their ratios, outwards from the likeliest.
fn law(band: &Mode) -> Law {
    crate::stop::check();
    let (step, mean, likeliest, ratio): (f64, f64, f64, Box<dyn Fn(f64) -> f64>) = match *band {
        Mode::Poisson { mean, step } => (step, mean, mean.floor(), Box::new(move |n| mean / (n + 1.0))),
        Mode::Bunched { modes, occupancy: x, step } => {
            let share = x / (1.0 + x);
            let likeliest = ((modes - 1.0) * x).max(0.0).floor();
            (step, modes * x, likeliest, Box::new(move |n| (n + modes) / (n + 1.0) * share))
        }
        Mode::Normal { .. } => return Vec::new(),
    };
    let mut counts = Vec::new();
    let (mut n, mut p, mut below) = (likeliest, 1.0, 0.0);
    while n > 0.0 && p > NOTHING && counts.len() < TABLE {
        n -= 1.0;
        p /= ratio(n);
        counts.push((n, p));
    }
    // Sums from the smallest to the largest.
    counts.reverse();
    counts.iter().for_each(|(_, p)| below += p);
    let start = counts.len();
    (n, p) = (likeliest, 1.0);
    counts.push((n, p));
    while p > NOTHING && counts.len() < 2 * TABLE {
        p *= ratio(n);
        n += 1.0;
        counts.push((n, p));
    }
    let total = below + counts.iter().skip(start).rev().map(|(_, p)| p).sum::<f64>();
    let mut law: Law = counts.into_iter().map(|(n, p)| (step * (n - mean), p / total)).collect();
    if step < 0.0 {
        law.reverse();
    }
    law
}

/// Running logarithms of the sums of e^x.
fn running(logs: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut sum = f64::NEG_INFINITY;
    logs.map(|x| {
        let (large, small) = if x > sum { (x, sum) } else { (sum, x) };
        sum = large + (small - large).exp().ln_1p();
        sum
    })
    .collect()
}
