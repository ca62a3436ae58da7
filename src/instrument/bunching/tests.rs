use super::*;
use statrs::function::gamma::ln_gamma;

/// ln P from ln Γ at 150 digits (mpmath), rounded to a double.
const EXACT: &[(f64, f64, f64, f64)] = &[
    (0.0, 7.5, 3.25, -3.887_814_964_254_083_3),
    (3.0, 7.5, 3.25, -2.475_780_579_694_855_5),
    (60.0, 7.5, 3.25, -17.151_479_058_255_77),
    (5e6, 1e6, 1.0, -18.815_509_057_965_44),
    (1000.0, 1000.0, 1e30, -4.372_899_506_026_297),
    (1_003_000.0, 1e6, 3e7, -12.194_985_075_965_135),
    (1_000_001_000_000.0, 1e12, 1e14, -15.234_474_099_846_109),
    (12.0, 0.001, 0.5, -76.425_504_140_999_85),
    (1.0, 1e-12, 1e-6, -27.631_022_115_929_05),
    (400.0, 2.0, 1e5, -1_724.452_866_231_925_6),
    (1e9, 1e9, 1e9, -11.627_145_042_082_851),
    (7.0, 50.0, 1e-3, -8.862_175_970_219_63),
    (250.0, 1000.0, 40.0, -28.456_278_768_402_953),
    (1e15, 1e15, 4e16, -18.200_673_036_955_2),
];

#[test]
fn the_logarithm_of_the_law_has_all_its_digits() {
    for &(count, mean, modes, exact) in EXACT {
        let found = Bunched::new(mean, modes).unwrap().ln_probability(count).unwrap();
        assert!((found / exact - 1.0).abs() < 3e-15, "{count} {mean} {modes}: {found} {exact}");
    }
}

#[test]
fn stirlings_error_is_that_of_the_gamma_function() {
    for i in 1..400 {
        let x = 0.05 * f64::from(i);
        let stirling = (x - 0.5) * x.ln() - x + 0.5 * std::f64::consts::TAU.ln();
        // ln Γ itself is good to 1e-14 of the largest of its terms.
        assert!((stirling_error(x) - (ln_gamma(x) - stirling)).abs() < 2e-13, "{x}");
    }
    // Closed forms: Γ(1) = 1, Γ(½) = √π.
    let half_log = 0.5 * std::f64::consts::TAU.ln();
    assert!((stirling_error(1.0) - (1.0 - half_log)).abs() < 1e-15);
    assert!((stirling_error(0.5) - (0.5 * std::f64::consts::PI.ln() + 0.5 - half_log)).abs() < 2e-15);
}

/// Σ P, Σ P n and Σ P (n − N)².
fn moments(law: Bunched, counts: u32) -> [f64; 3] {
    let mut sums = [Compensated::default(); 3];
    for n in (0..counts).map(f64::from) {
        let p = law.probability(n).unwrap();
        let off = n - law.mean();
        sums.iter_mut().zip([p, p * n, p * off * off]).for_each(|(sum, term)| sum.add(term));
    }
    sums.map(Compensated::value)
}

#[test]
fn the_law_adds_up_to_one_with_its_mean_and_variance() {
    for (mean, modes, counts) in
        [(7.5, 3.25, 900), (0.2, 1.0, 60), (3.0, 0.1, 5000), (40.0, 1e30, 300), (12.0, f64::INFINITY, 120)]
    {
        let law = Bunched::new(mean, modes).unwrap();
        let [one, first, second] = moments(law, counts);
        let variance = mean + mean * mean / modes;
        assert!(
            (one - 1.0).abs() < 2e-14 && (first / mean - 1.0).abs() < 1e-13,
            "{mean} {modes}: {one} {first}"
        );
        assert!((second / variance - 1.0).abs() < 1e-13, "{mean} {modes}: {second} {variance}");
        assert!((law.variance() / variance - 1.0).abs() < 1e-15);
    }
    // One mode is Bose and Einstein's law λⁿ/(1 + λ)ⁿ⁺¹ (S11).
    let one = Bunched::new(0.3, 1.0).unwrap();
    for n in 0..40 {
        let bose = 0.3f64.powi(n) / 1.3f64.powi(n + 1);
        assert!((one.probability(f64::from(n)).unwrap() / bose - 1.0).abs() < 1e-13, "{n}");
    }
}

#[test]
fn the_information_of_the_mean_is_one_over_the_variance() {
    // Σ P (∂ ln P/∂N)², the derivative as a difference: 3e-5 squared is lost in it, and 1e-15/3e-5 to rounding.
    for (mean, modes, counts) in [(7.5, 3.25, 900), (0.5, 1.0, 100), (60.0, 1e4, 300)] {
        let law = |mean: f64| Bunched::new(mean, modes).unwrap();
        let step = 3e-5 * mean;
        let information: f64 = (0..counts)
            .map(f64::from)
            .map(|n| {
                let ln = |mean: f64| law(mean).ln_probability(n).unwrap();
                let score = (ln(mean + step) - ln(mean - step)) / (2.0 * step);
                ln(mean).exp() * score * score
            })
            .sum();
        let stated = law(mean).fisher_information();
        assert!((information / stated - 1.0).abs() < 1e-8, "{mean} {modes}: {information} {stated}");
    }
}

#[test]
fn the_likelihood_of_the_counting_law_is_this_one() {
    // That of `Statistics` lacks what depends on the count alone, so differences between means agree.
    let law = crate::statistics::Statistics::negative_binomial(vec![3.25]).unwrap();
    for count in [0.0, 1.0, 17.0, 240.0] {
        let ln = |mean: f64| Bunched::new(mean, 3.25).unwrap().ln_probability(count).unwrap();
        let expected = law.log_likelihood(0, count, 7.5) - law.log_likelihood(0, count, 21.0);
        assert!((ln(7.5) - ln(21.0) - expected).abs() < 1e-12, "{count}");
    }
    assert_eq!(law.variance(0, 7.5), Bunched::new(7.5, 3.25).unwrap().variance());
}

#[test]
fn many_modes_are_poisson() {
    for (count, mean) in [(0.0, 3.0), (5.0, 3.0), (1e6, 1.002e6)] {
        let ln = |modes: f64| Bunched::new(mean, modes).unwrap().ln_probability(count).unwrap();
        let (poisson, off) = (ln(f64::INFINITY), count - mean);
        for modes in [1e12, 1e18, 1e30, 1e300] {
            // To first order in 1/m: [(n − N)² − n]/2m.
            let first = (off * off - count) / (2.0 * modes);
            let allowed = 1e-14 * poisson.abs() + 1e-5 * first.abs();
            assert!((ln(modes) - poisson - first).abs() < allowed, "{count} {mean} {modes}");
            let stated = Bunched::new(mean, modes).unwrap().ln_over_poisson(count);
            assert!((stated / first - 1.0).abs() < 1e-5, "{count} {mean} {modes}: {stated} {first}");
        }
    }
}

#[test]
fn the_distance_from_poisson_is_exact_and_below_its_bound() {
    // mpmath at 150 digits.
    for (mean, modes, exact) in [
        (10.0, 3.0, 0.346_038_968_004_134_86),
        (1.0, 1e6, 2.759_094_199_314_297e-07),
        (50.0, 2500.0, 0.004_803_579_873_233_739),
        (0.2, 1.0, 0.024_857_261_726_707_45),
        (3.0, 1e20, 7.505_400_556_455_489e-21),
    ] {
        let law = Bunched::new(mean, modes).unwrap();
        let found = law.distance_from_poisson().unwrap();
        assert!((found / exact - 1.0).abs() < 1e-11, "{mean} {modes}: {found} {exact}");
        assert!(found <= law.largest_distance_from_poisson());
    }
    // Two Gaussians of variances 1 and 1 + x are φ(1)x apart; the next order is x and 1/N.
    let law = Bunched::new(1e6, 1e9).unwrap();
    let gaussian = (-0.5f64).exp() / std::f64::consts::TAU.sqrt() * 1e-3;
    assert!((law.distance_from_poisson().unwrap() / gaussian - 1.0).abs() < 2e-3);
    assert!(Bunched::new(1e12, 1e13).unwrap().distance_from_poisson().is_err());
    assert_eq!(Bunched::new(5.0, f64::INFINITY).unwrap().distance_from_poisson().unwrap(), 0.0);
}

#[test]
fn a_blackbody_bunches_by_its_occupancy_whatever_the_camera() {
    // 1/(e^x − 1) at 300 K, from hc/k = 1.438 776 877 cm K.
    for (wavenumber, occupancy) in [(715.0, 0.0335), (1000.0, 0.0083), (1250.0, 0.0025)] {
        let radiance = planck::photon_radiance(wavenumber, 300.0);
        for (etendue, time, efficiency) in [(1e-10, 1e-3, 1.0), (5e-7, 2.0, 0.5)] {
            let m = modes(wavenumber, 1.0, etendue, time);
            let mean = radiance * etendue * time * efficiency;
            let factor = Bunched::new(mean, m).unwrap().factor();
            assert!((factor - 1.0 - efficiency * occupancy).abs() < 6e-5, "{wavenumber} {factor}");
            let per_mode = counts_per_mode(wavenumber, radiance, efficiency);
            assert!((per_mode / (mean / m) - 1.0).abs() < 1e-14);
        }
    }
}

/// Each photon kept with probability η: Σ_k P(k) C(k, n) ηⁿ(1 − η)^(k − n) is the law of mean ηN in as many modes.
#[test]
fn losses_keep_the_modes() {
    let (mean, modes, kept) = (6.0, 2.5, 0.3f64);
    let (all, rest) = (Bunched::new(mean, modes).unwrap(), Bunched::new(kept * mean, modes).unwrap());
    for n in 0..12 {
        let thinned: f64 = (n..400)
            .map(|k| {
                let (n, k) = (f64::from(n), f64::from(k));
                let ln_choose = ln_gamma(k + 1.0) - ln_gamma(n + 1.0) - ln_gamma(k - n + 1.0);
                let binomial = (ln_choose + n * kept.ln() + (k - n) * (-kept).ln_1p()).exp();
                binomial * all.probability(k).unwrap()
            })
            .sum();
        assert!((thinned / rest.probability(f64::from(n)).unwrap() - 1.0).abs() < 1e-11, "{n}");
    }
}

#[test]
fn unlike_modes_count_for_fewer() {
    let parts = [(10.0, 100.0), (40.0, 200.0), (0.0, 50.0)];
    let effective = effective_modes(&parts).unwrap();
    let variance: f64 = parts.iter().map(|(mean, modes)| mean + mean * mean / modes).sum();
    assert!((Bunched::new(50.0, effective).unwrap().variance() / variance - 1.0).abs() < 1e-14);
    assert!(effective < 350.0);
    // Filled alike, all count: N/m is the same for both.
    assert!((effective_modes(&[(10.0, 100.0), (20.0, 200.0)]).unwrap() - 300.0).abs() < 1e-10);
    assert_eq!(effective_modes(&[]), None);
}

#[test]
fn impossible_counts_are_refused() {
    for (mean, modes) in [(0.0, 1.0), (-1.0, 1.0), (1.0, 0.0), (1.0, f64::NAN), (f64::INFINITY, 1.0)] {
        assert!(Bunched::new(mean, modes).is_err(), "{mean} {modes}");
    }
    let law = Bunched::new(1.0, 1.0).unwrap();
    assert!(law.ln_probability(-1.0).is_err() && law.ln_probability(0.5).is_err());
    assert!(law.ln_probability(f64::INFINITY).is_err() && Bunched::new(1e300, 1e-300).is_err());
    assert_eq!(law.ln_probability(1.0).unwrap(), law.probability(1.0).unwrap().ln());
}
