#![allow(clippy::disallowed_methods, reason = "the arguments of a test are within the domain")]

use super::*;
use crate::draws::generator;
use crate::draws::tests::{TRIALS, discrete, kolmogorov};
use statrs::function::beta::beta_reg;

/// ln of the probability of k in N.
fn ln_mass(n: f64, p: f64, k: f64) -> f64 {
    let ln_gamma = |x: f64| special::Gamma::ln_gamma(x).0;
    let choose = ln_gamma(n + 1.0) - ln_gamma(k + 1.0) - ln_gamma(n - k + 1.0);
    choose + k * p.ln() + (n - k) * (-p).ln_1p()
}

fn columns(total: u64, weights: &[f64]) -> Vec<Vec<f64>> {
    let law = Multinomial::new(total, weights).unwrap();
    let mut rng = generator(6, total);
    let mut columns = vec![Vec::with_capacity(TRIALS); weights.len()];
    let mut counts = vec![0.0; weights.len()];
    for _ in 0..TRIALS {
        law.draw_into(&mut rng, &mut counts);
        assert_eq!(counts.iter().sum::<f64>(), total as f64);
        columns.iter_mut().zip(&counts).for_each(|(column, count)| column.push(*count));
    }
    columns
}

/// Twelve tests of marginals, each of which fails by chance with 1e-3, and twelve covariances within 4.5
/// deviations; the seed is fixed.
#[test]
fn marginals_are_binomial_and_covariances_negative() {
    let weights = [0.5, 0.1, 1.0, 0.4];
    for total in [3_u64, 40, 5000] {
        let n = total as f64;
        let columns = columns(total, &weights);
        for (column, weight) in columns.iter().zip(&weights) {
            let distance =
                discrete(column.clone(), &|k| if k > n { -1e3 } else { ln_mass(n, weight / 2.0, k) });
            assert!(distance < 1.95, "{total} {weight}: {distance}");
        }
        for (i, j) in [(0, 1), (0, 3), (1, 2), (2, 3)] {
            let (p, q) = (weights[i] / 2.0, weights[j] / 2.0);
            let pairs = columns[i].iter().zip(&columns[j]);
            let products: Vec<f64> = pairs.map(|(a, b)| (a - n * p) * (b - n * q)).collect();
            let mean = products.iter().sum::<f64>() / TRIALS as f64;
            let square = products.iter().map(|x| x * x).sum::<f64>() / TRIALS as f64;
            let deviation = ((square - mean * mean) / TRIALS as f64).sqrt();
            assert!((mean + n * p * q).abs() < 4.5 * deviation, "{total} {i} {j}: {mean}");
        }
    }
}

/// At 2⁵³ photons: rare bands against the exact distribution (1e-3 each), frequent ones by their moments (4.5
/// deviations), wherever they stand.
#[test]
fn as_many_photons_as_there_are_doubles() {
    let n = MOST as f64;
    // 5 and 1e6 photons beside the rest, first and last.
    let columns = columns(MOST, &[5.0 / n, 1e6 / n, 0.5, 0.5 - 1e6 / n - 10.0 / n, 5.0 / n]);
    for rare in [0, 4] {
        let poisson = |k: f64| k * 5.0_f64.ln() - 5.0 - special::Gamma::ln_gamma(k + 1.0).0;
        let distance = discrete(columns[rare].clone(), &poisson);
        assert!(distance < 1.95, "{rare}: {distance}");
    }
    // Binomial and Poisson of 10⁶ in 2⁵³ differ by 1e-10.
    let upper = |k: f64| {
        if k < 0.0 { 0.0 } else { statrs::function::gamma::gamma_ur(k + 1.0, 1e6) }
    };
    let distance = kolmogorov(columns[1].clone(), &|k| upper(k - 1.0), &upper);
    assert!(distance < 1.95, "{distance}");
    let off: Vec<f64> = columns[2].iter().map(|count| (count - 0.5 * n) / (0.25 * n).sqrt()).collect();
    let mean = off.iter().sum::<f64>() / TRIALS as f64;
    let square = off.iter().map(|x| x * x).sum::<f64>() / TRIALS as f64;
    let trials = TRIALS as f64;
    assert!(mean.abs() < 4.5 / trials.sqrt() && (square - 1.0).abs() < 4.5 * (2.0 / trials).sqrt());
    let normal = |k: f64| hadar::identifiability::detection::probability(k);
    let distance = kolmogorov(off, &normal, &normal);
    assert!(distance < 1.95, "{distance}");
}

/// Rejection at large N against the regularised beta function; by chance 1e-3 each.
#[test]
fn many_photons_follow_the_incomplete_beta_function() {
    for (total, p) in [(1_000_000_u64, 0.3), (100_000, 0.7)] {
        let n = total as f64;
        let columns = columns(total, &[p, 1.0 - p]);
        let below = |k: f64| if k < 0.0 { 0.0 } else { beta_reg(n - k, k + 1.0, 1.0 - p) };
        let distance = kolmogorov(columns[0].clone(), &|k| below(k - 1.0), &below);
        assert!(distance < 1.95, "{total}: {distance}");
    }
}

#[test]
fn first_draws_stay_and_impossible_laws_are_refused() {
    let mut counts = [0.0; 5];
    let law = Multinomial::new(1_000_000, &[1.0, 1e-5, 0.0, 2.0, 4.0]).unwrap();
    law.draw_into(&mut generator(20, 7), &mut counts);
    assert_eq!(counts, [143_034.0, 0.0, 0.0, 285_880.0, 571_086.0]);
    for wrong in [vec![], vec![0.0, 0.0], vec![-1.0, 2.0], vec![f64::NAN], vec![f64::MAX; 3]] {
        assert!(Multinomial::new(5, &wrong).is_err(), "{wrong:?}");
    }
    assert!(Multinomial::new(MOST + 1, &[1.0]).is_err());
    // One band takes all.
    Multinomial::new(9, &[0.0, 1e-300]).unwrap().draw_into(&mut generator(1, 1), &mut counts[..2]);
    assert_eq!(counts[..2], [0.0, 9.0]);
}
