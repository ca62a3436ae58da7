//! Bounds against the laws themselves, summed and integrated here without anything that the bounds are made of.

use super::*;
use rand::{RngExt, SeedableRng, rngs::ChaCha8Rng};

/// Probabilities of 0, 1, 2 … counts, by their recurrence from the count at the mean in both directions.
fn masses(mean: f64, modes: Option<f64>) -> Vec<f64> {
    let ratio = |n: f64| match modes {
        None => mean / (n + 1.0),
        Some(m) => mean / (mean + m) * (n + m) / (n + 1.0),
    };
    let start = mean.floor() as usize;
    let mut all = vec![0.0; start + 1];
    all[start] = 1.0;
    for n in (0..start).rev() {
        all[n] = all[n + 1] / ratio(n as f64);
    }
    while all.len() < start + 12 || all[all.len() - 1] > 1e-17 {
        let last = all.len() - 1;
        all.push(all[last] * ratio(last as f64));
    }
    let sum: f64 = all.iter().sum();
    all.into_iter().map(|p| p / sum).collect()
}

/// ½Σ min(p, q) over all counts of all bands.
fn brute(tables: &[(Vec<f64>, Vec<f64>)], p: f64, q: f64) -> f64 {
    let Some(((a, b), rest)) = tables.split_first() else { return 0.5 * p.min(q) };
    let at = |table: &[f64], n: usize| table.get(n).copied().unwrap_or(0.0);
    (0..a.len().max(b.len())).map(|n| brute(rest, p * at(a, n), q * at(b, n))).sum()
}

/// 600 random pairs of one to three bands of 0.001 to 40 counts, bunched or not.
#[test]
fn bounds_hold_the_sum_over_all_counts() {
    let mut rng = ChaCha8Rng::seed_from_u64(40);
    let (mut widest, mut laws) = (0.0_f64, std::collections::BTreeMap::new());
    for trial in 0..600 {
        let bands = 1 + trial % 3;
        let most = [1.6, 1.3, 0.7][bands - 1];
        let counts: Vec<f64> = (0..bands).map(|_| 10_f64.powf(rng.random_range(-3.0..most))).collect();
        let contrast = rng.random_range(0.01..1.5);
        let mut other = |mean: f64| match rng.random_bool(0.05) {
            true => 0.0,
            false => (mean * f64::exp(rng.random_range(-contrast..contrast))).min(60.0),
        };
        let others: Vec<f64> = counts.iter().map(|mean| other(*mean)).collect();
        let modes: Option<Vec<f64>> =
            (trial % 4 == 3).then(|| counts.iter().map(|_| rng.random_range(0.5..50.0)).collect());
        let tables: Vec<_> = (0..bands)
            .map(|i| {
                let m = modes.as_ref().map(|modes| modes[i]);
                (masses(counts[i], m), masses(others[i], m))
            })
            .collect();
        let exact = 1.0 - brute(&tables, 1.0, 1.0);
        let found = decision_bounds(&counts, &others, &vec![0.0; bands], modes.as_deref()).unwrap();
        assert!(
            found.lower <= exact + 1e-12 && exact <= found.upper + 1e-12,
            "{counts:?} {others:?} {modes:?}: {found:?}, {exact}"
        );
        widest = widest.max(found.upper - found.lower);
        *laws.entry(format!("{:?}", found.law)).or_insert(0) += 1;
    }
    println!("widest {widest:.1e}, {laws:?}");
    assert!(widest < 1e-3 && laws["Exact"] == 600, "{widest} {laws:?}");
}

/// 0.1 to 1e4 counts in each of 1 to 50 bands, six contrasts: the law by its best route is inside, and where Φ(d) is taken for it, it is
/// no further off than it says.
#[test]
fn the_grid_of_counts() {
    let (mut off, mut width, mut numerical, mut slow) = (0.0_f64, 0.0_f64, 0.0_f64, 0);
    let mut laws = std::collections::BTreeMap::new();
    for bands in [1_usize, 2, 5, 20, 50] {
        for size in [0.1, 0.57, 2.8, 10.0, 100.0, 1e3, 1e4] {
            for (at, d) in [0.05, 0.5, 1.0, 1.7, 3.0, 5.0].into_iter().enumerate() {
                let share = |w: usize| 1.0 + 0.6 * ((w * (at + 1)) as f64 * 1.3).sin();
                let counts: Vec<f64> = (0..bands).map(|w| size * share(w)).collect();
                // Half the distance in either direction.
                let step = 2.0 * d / (bands as f64).sqrt();
                let sign = |w: usize| (w as f64 * 1.7 + 0.3).cos().signum();
                let root = |w: usize| (counts[w].sqrt() + sign(w) * 0.5 * step).max(0.02);
                let others: Vec<f64> = (0..bands).map(|w| root(w).powi(2)).collect();
                let law = RatioLaw::new(&counts, &others, &Statistics::Poisson).unwrap().error();
                let found = decision_bounds(&counts, &others, &vec![0.0; bands], None).unwrap();
                let slack = law.numerical + 1e-12;
                numerical = numerical.max(law.numerical);
                assert!(
                    found.error_lower <= law.error * (1.0 + slack)
                        && law.error * (1.0 - slack) <= found.error_upper,
                    "{bands} bands of {size}, {d}: {found:?} {law:?}"
                );
                let square: f64 =
                    counts.iter().zip(&others).map(|(a, b)| (a.sqrt() - b.sqrt()).powi(2)).sum();
                if found.law == DecisionLaw::Gaussian {
                    let normal = detection::miss_probability(square.sqrt());
                    off = off.max((normal / law.error - 1.0).abs());
                } else {
                    width = width.max(1.0 - found.error_lower / found.error_upper);
                }
                slow += usize::from(found.law == DecisionLaw::Bracket);
                *laws.entry(format!("{:?}", found.law)).or_insert(0) += 1;
            }
        }
    }
    println!(
        "Φ(d) off by {off:.1e} of the error; widest else {width:.1e}, law known to {numerical:.1e}; {laws:?}"
    );
    assert!(off < NEAR && width < 0.02 && slow == 0, "{off} {width} {laws:?}");
}

/// Density of Poisson counts plus normal noise.
fn density(masses: &[f64], sigma: f64, y: f64) -> f64 {
    let reach = 10.0 * sigma;
    let (low, high) = ((y - reach).floor().max(0.0) as usize, (y + reach).ceil().max(0.0) as usize);
    let normal = |n: usize| (-0.5 * ((y - n as f64) / sigma).powi(2)).exp() / (sigma * (2.0 * PI).sqrt());
    (low..=high.min(masses.len() - 1)).map(|n| masses[n] * normal(n)).sum()
}

/// Cells of a reading: probabilities of each under both laws, by Simpson's rule.
fn cells(mean: f64, other: f64, sigma: f64, step: f64) -> (Vec<f64>, Vec<f64>) {
    let (p, q) = (masses(mean, None), masses(other, None));
    let reach = 9.0 * (mean.max(other) + sigma * sigma).sqrt() + 9.0 * sigma + 9.0;
    let (low, high) = (mean.min(other) - reach, mean.max(other) + reach);
    let number = ((high - low) / step) as usize;
    let mass = |masses: &[f64], i: usize| {
        let at = |x: f64| density(masses, sigma, low + step * (i as f64 + x));
        step / 6.0 * (at(0.0) + 4.0 * at(0.5) + at(1.0))
    };
    ((0..number).map(|i| mass(&p, i)).collect(), (0..number).map(|i| mass(&q, i)).collect())
}

/// One band of 0.3 to 3000 counts read with noise of 0.1 to 60 counts: the law by quadrature is inside. Where it is taken for normal the
/// bounds themselves are within 1 % of the error.
#[test]
fn bounds_hold_counts_that_are_read_with_noise() {
    let mut laws = std::collections::BTreeMap::new();
    for mean in [0.3, 3.0, 30.0, 300.0, 3000.0_f64] {
        for sigma in [0.1, 0.5, 1.0, 3.0, 10.0, 60.0, 250.0] {
            for d in [0.2, 1.0, 2.5] {
                let var = sigma * sigma;
                let other = mean + 2.0 * d * (mean + var).sqrt() + d * d;
                let spread = (mean + var).sqrt();
                let (p, q) = cells(mean, other, sigma, (0.03 * sigma).max(0.001 * spread));
                let exact = brute(&[(p, q)], 1.0, 1.0);
                let found = decision_bounds(&[mean], &[other], &[var], None).unwrap();
                // Cells tell no more than the readings; of 0.03 deviations hardly less.
                let slack = 2e-3;
                assert!(
                    found.error_lower <= exact * (1.0 + 1e-9) && exact * (1.0 - slack) <= found.error_upper,
                    "{mean} {other} ± {sigma}: {found:?}, {exact}"
                );
                *laws.entry(format!("{:?}", found.law)).or_insert(0) += 1;
            }
        }
    }
    println!("{laws:?}");
    assert!(laws["Gaussian"] > 0 && laws["Bracket"] > 0);
}

#[test]
fn any_input_gives_bounds_or_a_message() {
    let values = [0.0, 1e-300, 1e-9, 0.3, 40.0, 1e6, 1e6 + 1.0, 1e15, 1e300];
    for a in values {
        for b in values {
            for var in [0.0, 1e-12, 0.3, 1e4, 1e200] {
                for modes in [None, Some([0.5, 1e9])] {
                    let modes = modes.as_ref().map(|modes| modes.as_slice());
                    let Ok(found) = decision_bounds(&[a, 3.0], &[b, 3.3], &[var, 0.0], modes) else {
                        continue;
                    };
                    let DecisionBounds { lower, upper, error_lower, error_upper, .. } = found;
                    assert!(0.5 <= lower && lower <= upper && upper <= 1.0, "{a:e} {b:e} {var:e} {found:?}");
                    assert!(
                        0.0 <= error_lower && error_lower <= error_upper && error_upper <= 0.5,
                        "{found:?}"
                    );
                }
            }
        }
    }
    assert!(decision_bounds(&[1.0], &[2.0], &[], None).is_err());
    assert!(decision_bounds(&[1.0], &[2.0, 3.0], &[0.0], None).is_err());
    assert!(decision_bounds(&[1.0], &[f64::NAN], &[0.0], None).is_err());
    assert!(decision_bounds(&[1.0], &[2.0], &[-1.0], None).is_err());
    assert!(decision_bounds(&[1.0], &[2.0], &[0.0], Some(&[0.0])).is_err());
    let nothing = decision_bounds(&[], &[], &[], None).unwrap();
    assert!(nothing.lower == 0.5 && nothing.upper - 0.5 < 1e-12);
}
