#![allow(clippy::disallowed_methods, reason = "the arguments of a test are within the domain")]

use super::*;
use statrs::function::gamma::ln_gamma;

pub(super) const TRIALS: usize = 40_000;

/// Counts of one band, drawn `TRIALS` times.
fn sample(statistics: &Statistics, mean: f64) -> Vec<f64> {
    let draws = Draws::new(statistics, &[mean]).unwrap();
    let mut rng = generator(3, mean.to_bits());
    let mut count = [0.0];
    let draw = |_| {
        draws.draw_into(&mut rng, &mut count);
        count[0]
    };
    (0..TRIALS).map(draw).collect()
}

/// Largest distance between the counts' distribution and the exact one, times √trials; P(D > 1.95) = 1e-3
/// by Kolmogorov, and less for a discrete law.
pub(super) fn kolmogorov(
    mut counts: Vec<f64>,
    below: &dyn Fn(f64) -> f64,
    at_or_below: &dyn Fn(f64) -> f64,
) -> f64 {
    counts.sort_by(f64::total_cmp);
    let n = counts.len() as f64;
    let (mut largest, mut start): (f64, usize) = (0.0, 0);
    while start < counts.len() {
        let value = counts[start];
        let end = start + counts[start..].iter().take_while(|&&c| c == value).count();
        largest = largest.max((start as f64 / n - below(value)).abs());
        largest = largest.max((end as f64 / n - at_or_below(value)).abs());
        start = end;
    }
    largest * n.sqrt()
}

/// Σ P(k) up to each count, from the laws' logarithms.
pub(super) fn discrete(counts: Vec<f64>, ln_p: &dyn Fn(f64) -> f64) -> f64 {
    let most = counts.iter().copied().fold(0.0, f64::max) as usize + 1;
    let mut cumulated = vec![0.0; most + 1];
    let mut sum = 0.0;
    for (k, value) in cumulated.iter_mut().enumerate() {
        sum += ln_p(k as f64).exp();
        *value = sum;
    }
    let at = |k: f64| if k < 0.0 { 0.0 } else { cumulated[k as usize] };
    kolmogorov(counts, &|k| at(k - 1.0), &at)
}

/// Nine tests, each of which fails by chance with at most 1e-3; the seed is fixed, so none does.
#[test]
fn counts_follow_their_laws() {
    for mean in [0.3_f64, 4.0, 11.9, 12.1, 300.0, 2e5] {
        let ln_p = |k: f64| k * mean.ln() - mean - ln_gamma(k + 1.0);
        let distance = discrete(sample(&Statistics::Poisson, mean), &ln_p);
        assert!(distance < 1.95, "Poisson {mean}: {distance}");
    }
    for (mean, m) in [(20.0_f64, 0.7_f64), (500.0, 60.0)] {
        let ln_p = |k: f64| {
            let choose = ln_gamma(k + m) - ln_gamma(m) - ln_gamma(k + 1.0);
            choose + k * (mean / (mean + m)).ln() - m * (mean / m).ln_1p()
        };
        let statistics = Statistics::negative_binomial(vec![m]).unwrap();
        let distance = discrete(sample(&statistics, mean), &ln_p);
        assert!(distance < 1.95, "negative binomial {mean} {m}: {distance}");
    }
    let statistics = Statistics::gaussian(vec![75.0]).unwrap();
    let exact = |n: f64| hadar::identifiability::detection::probability((n - 25.0) / 10.0);
    let distance = kolmogorov(sample(&statistics, 25.0), &exact, &exact);
    assert!(distance < 1.95, "Gaussian: {distance}");
}

/// Where no exact distribution is at hand: mean and variance within 4.5 of their own deviations (by chance 7e-6
/// each).
#[test]
fn many_photons_have_the_right_mean_and_variance() {
    for mean in [1e9_f64, 1e12, 1e17] {
        let counts = sample(&Statistics::Poisson, mean);
        let n = TRIALS as f64;
        let off: f64 = counts.iter().map(|c| (c - mean) / mean.sqrt()).sum::<f64>() / n;
        let square: f64 = counts.iter().map(|c| (c - mean).powi(2) / mean).sum::<f64>() / n;
        assert!(off.abs() < 4.5 / n.sqrt() && (square - 1.0).abs() < 4.5 * (2.0 / n).sqrt(), "{mean:e}");
    }
}

/// A change of any of these changes every published figure of a simulation.
#[test]
fn the_first_draws_stay_what_they_are() {
    let first = |statistics: Statistics, means: &[f64]| {
        let mut counts = vec![0.0; means.len()];
        Draws::new(&statistics, means).unwrap().draw_into(&mut generator(20, 7), &mut counts);
        counts
    };
    assert_eq!(
        first(Statistics::Poisson, &[0.5, 9.0, 40.0, 1e6, 1e12]),
        [1.0, 7.0, 37.0, 1_000_922.0, 999_998_480_959.0]
    );
    let bunched = Statistics::negative_binomial(vec![0.5, 30.0]).unwrap();
    assert_eq!(first(bunched, &[9.0, 1e4]), [10.0, 9274.0]);
    let normal = Statistics::gaussian(vec![0.0, 4.0]).unwrap();
    assert_eq!(first(normal, &[9.0, 0.0]), [10.273_173_298_150_024, 0.482_033_611_734_406_23]);
}

/// The exact distribution function of Poisson counts at large means, summed from the likeliest count outwards: that of
/// `statrs` loses ε x ln x (4e-6 at 10⁹), which does not matter here but would at 10¹².
fn poisson_table(mean: f64) -> (f64, Vec<f64>) {
    let reach = (9.0 * mean.sqrt()).ceil();
    let (mode, low) = (mean.floor(), mean.floor() - reach);
    let mut masses = vec![1.0; 2 * reach as usize + 1];
    for k in 1..=reach as usize {
        let (down, up) = (mode - k as f64 + 1.0, mode + k as f64);
        masses[reach as usize - k] = masses[reach as usize - k + 1] * down / mean;
        masses[reach as usize + k] = masses[reach as usize + k - 1] * mean / up;
    }
    let total = hadar::sum::sum(&masses);
    let mut sum = 0.0;
    masses.iter_mut().for_each(|mass| {
        sum += *mass / total;
        *mass = sum;
    });
    (low, masses)
}

/// Three tests at large means, each of which fails by chance with at most 1e-3; the seed is fixed.
#[test]
fn many_photons_follow_the_exact_distribution() {
    for mean in [2.5e4_f64, 1e6, 1e9] {
        let (low, table) = poisson_table(mean);
        let at = |k: f64| {
            let place = k - low;
            if place < 0.0 { 0.0 } else { table[(place as usize).min(table.len() - 1)] }
        };
        if mean < 1e8 {
            for k in [mean - 2.0 * mean.sqrt(), mean, mean + 1.5 * mean.sqrt()].map(f64::floor) {
                let upper = statrs::function::gamma::gamma_ur(k + 1.0, mean);
                assert!((upper / at(k) - 1.0).abs() < 1e-8, "{mean} {k} {upper} {}", at(k));
            }
        }
        let distance = kolmogorov(sample(&Statistics::Poisson, mean), &|k| at(k - 1.0), &at);
        assert!(distance < 1.95, "{mean:e}: {distance}");
    }
}

/// P(n ≤ k) of the negative binomial law is the regularised beta function; three tests, 1e-3 each.
#[test]
fn bunched_photons_follow_the_incomplete_beta_function() {
    for (mean, m) in [(1e6_f64, 3.5_f64), (1e9, 1e4), (2e5, 1e9)] {
        let below = |k: f64| {
            if k < 0.0 { 0.0 } else { statrs::function::beta::beta_reg(m, k + 1.0, m / (m + mean)) }
        };
        let statistics = Statistics::negative_binomial(vec![m]).unwrap();
        let distance = kolmogorov(sample(&statistics, mean), &|k| below(k - 1.0), &below);
        assert!(distance < 1.95, "{mean:e} {m}: {distance}");
    }
}

/// Poisson counts plus a normal error: P(x) = Σ P(n) Φ((x − n)/σ), not the normal law of the same variance, which is
/// as far away as [`super::gaussian`] says; two tests, 1e-3 each, and one that must fail.
#[test]
fn electronic_noise_is_added_to_exact_counts() {
    let exact = |mean: f64, sigma: f64, x: f64| -> f64 {
        let p = |n: f64| (n * mean.ln() - mean - ln_gamma(n + 1.0)).exp();
        let step = |n: f64| hadar::identifiability::detection::probability((x - n) / sigma);
        (0..120).map(f64::from).map(|n| p(n) * step(n)).sum()
    };
    for (mean, sigma) in [(2.0_f64, 0.3_f64), (20.0, 3.0)] {
        let draws = Draws::new(&Statistics::Poisson, &[mean]).unwrap();
        // Variances of two calls add up.
        let part = 0.5 * sigma * sigma;
        let draws = draws.with_electronic_noise(&[part]).unwrap().with_electronic_noise(&[part]).unwrap();
        let mut rng = generator(8, 1);
        let mut reading = [0.0];
        let mut draw = |_| {
            draws.draw_into(&mut rng, &mut reading);
            reading[0]
        };
        let readings: Vec<f64> = (0..TRIALS).map(&mut draw).collect();
        let law = |x: f64| exact(mean, sigma, x);
        let distance = kolmogorov(readings.clone(), &law, &law);
        assert!(distance < 1.95, "{mean} {sigma}: {distance}");
        let spread = (mean + sigma * sigma).sqrt();
        let normal = |x: f64| hadar::identifiability::detection::probability((x - mean) / spread);
        let far = kolmogorov(readings, &normal, &normal) / (TRIALS as f64).sqrt();
        let told = gaussian::gaussian_distance(mean, sigma * sigma).unwrap().largest;
        // The sample itself is within 1.95/√trials of its law; the figure told is of leading order.
        let noise = 1.95 / (TRIALS as f64).sqrt();
        assert!((far - told).abs() < noise + 0.15 * told, "{mean}: {far} {told}");
        assert!(mean > 2.0 || far > 5.0 * noise, "{far}");
    }
    let gaussian = Draws::new(&Statistics::gaussian(vec![1.0]).unwrap(), &[3.0]).unwrap();
    assert!(gaussian.with_electronic_noise(&[1.0]).is_err());
    let draws = Draws::new(&Statistics::Poisson, &[3.0]).unwrap();
    for wrong in [vec![], vec![1.0, 1.0], vec![-1.0], vec![f64::NAN]] {
        assert!(draws.clone().with_electronic_noise(&wrong).is_err(), "{wrong:?}");
    }
}

/// 536 bands, a stream for each spectrum: the mean of Λ = Σ n a.
#[test]
fn a_sum_over_many_bands_has_its_mean() {
    use rayon::prelude::*;
    for scale in [5.0, 1e4, 1e9] {
        let means: Vec<f64> = (0..536).map(|w| scale * (1.5 + f64::from(w).sin())).collect();
        let weights: Vec<f64> = (0..536).map(|w| f64::from(w).cos() / scale.sqrt()).collect();
        let draws = Draws::new(&Statistics::Poisson, &means).unwrap();
        let spectra = 6000;
        let ratios: Vec<f64> = (0..spectra)
            .into_par_iter()
            .map_init(
                || vec![0.0; 536],
                |counts, i| {
                    draws.draw_into(&mut generator(1, i), counts);
                    hadar::sum::dot(counts, &weights)
                },
            )
            .collect();
        // Mean of Λ within 4.5 deviations.
        let mean = ratios.iter().sum::<f64>() / spectra as f64;
        let exact: f64 = means.iter().zip(&weights).map(|(n, a)| n * a).sum();
        let var: f64 = means.iter().zip(&weights).map(|(n, a)| n * a * a).sum();
        assert!((mean - exact).abs() < 4.5 * (var / spectra as f64).sqrt(), "{mean} {exact}");
    }
}

#[test]
fn impossible_means_are_refused() {
    for mean in [-1.0, f64::NAN, f64::INFINITY, 2e18] {
        assert!(Draws::new(&Statistics::Poisson, &[mean]).is_err(), "{mean}");
    }
    let statistics = Statistics::negative_binomial(vec![2.0]).unwrap();
    assert!(Draws::new(&statistics, &[1.0, 2.0]).is_err());
    let mut count = [1.0];
    Draws::new(&statistics, &[0.0]).unwrap().draw_into(&mut generator(0, 0), &mut count);
    assert_eq!(count, [0.0]);
}
