use super::*;
use crate::identifiability::detection::miss_probability;

fn law(means: &[f64], others: &[f64], statistics: &Statistics) -> RatioLaw {
    RatioLaw::new(means, others, statistics).unwrap()
}

fn close(found: f64, exact: f64, tolerance: f64) -> bool {
    (found / exact - 1.0).abs() <= tolerance
}

fn ln_gamma(x: f64) -> f64 {
    special::Gamma::ln_gamma(x).0
}

/// ln of the probability of n counts, from the textbook forms.
fn ln_mass(statistics: &Statistics, band: usize, n: f64, mean: f64) -> f64 {
    match statistics {
        Statistics::NegativeBinomial { modes } => {
            let m = modes[band];
            ln_gamma(n + m) - ln_gamma(m) - ln_gamma(n + 1.0) + n * (mean / (mean + m)).ln()
                - m * (mean / m).ln_1p()
        }
        _ => n * mean.ln() - mean - ln_gamma(n + 1.0),
    }
}

/// α and β by the sum over all counts of one to three bands, up to `most` of each; ties to 1e-11.
fn brute(means: &[f64], others: &[f64], statistics: &Statistics, most: usize) -> [f64; 2] {
    let table = |means: &[f64]| -> Vec<Vec<f64>> {
        let masses = |(band, &mean)| (0..=most).map(|n| ln_mass(statistics, band, n as f64, mean)).collect();
        means.iter().enumerate().map(masses).collect()
    };
    let (p, q) = (table(means), table(others));
    let mut errors = [0.0; 2];
    for place in 0..(most + 1).pow(means.len() as u32) {
        let (mut rest, mut ln_p, mut ln_q) = (place, 0.0, 0.0);
        for (p, q) in p.iter().zip(&q) {
            ln_p += p[rest % (most + 1)];
            ln_q += q[rest % (most + 1)];
            rest /= most + 1;
        }
        let ratio = ln_q - ln_p;
        let tie = ratio.abs() < 1e-11;
        let share = if tie { 0.5 } else { 1.0 };
        if ratio > 0.0 || tie {
            errors[0] += share * f64::exp(ln_p);
        }
        if ratio < 0.0 || tie {
            errors[1] += share * f64::exp(ln_q);
        }
    }
    errors
}

/// ln Γ is good to 3e-16 of itself: 1e-11 for thousands of counts.
#[test]
fn one_band_agrees_with_the_sum_over_its_counts_down_to_1e_240() {
    let bunched = Statistics::negative_binomial(vec![2e4]).unwrap();
    let mut smallest = 1.0_f64;
    for (statistics, other) in [Statistics::Poisson, bunched].iter().flat_map(|statistics| {
        [1001.0, 1003.0, 1040.0, 1400.0, 2500.0, 3200.0, 4200.0].map(|other| (statistics, other))
    }) {
        let [first, second] = brute(&[1000.0], &[other], statistics, 7000);
        let found = law(&[1000.0], &[other], statistics).error();
        assert_eq!(found.route, Route::Sum);
        assert!(close(found.error, 0.5 * (first + second), 3e-11), "{other} {found:?} {first} {second}");
        assert!(close(found.first, first, 3e-11) && close(found.second, second, 3e-11), "{other} {found:?}");
        assert!(found.numerical < 1e-10);
        smallest = smallest.min(found.error);
    }
    assert!(smallest < 1e-240, "{smallest:e}");
}

/// The threshold is half way if the variances are equal, here to 3e-13.
#[test]
fn normal_counts_of_equal_variance_err_as_the_normal_distribution_says() {
    let statistics = Statistics::gaussian(vec![1e28; 3]).unwrap();
    for shift in [1e5, 1e10, 1e13, 1e14, 8e14, 3e15] {
        let found = law(&[shift, 0.0, 5.0], &[0.0, shift, 5.0], &statistics).error();
        let d = shift * 2.0_f64.sqrt() / 1e14 / 2.0;
        assert_eq!(found.route, Route::Integral);
        assert!(close(found.error, miss_probability(d), 1e-9), "{shift} {found:?}");
        assert!(close(found.first, found.second, 1e-9) && found.numerical < 1e-12, "{found:?}");
    }
}

/// One band of normal counts: the better state changes at the two roots of a quadratic.
#[test]
fn normal_counts_of_unequal_variance_have_two_thresholds() {
    for (mean, other, electronic) in [(5.0_f64, 12.0_f64, 1.0), (100.0, 101.0, 0.0), (3.0, 400.0, 2.0)] {
        let statistics = Statistics::gaussian(vec![electronic]).unwrap();
        let (v, w) = (mean + electronic, other + electronic);
        // (n − N)²/v − (n − N′)²/w + ln(v/w) = 0.
        let (a, b) = (1.0 / v - 1.0 / w, mean / v - other / w);
        let c = mean * mean / v - other * other / w + (v / w).ln();
        let root = (b * b - a * c).sqrt();
        let (low, high) = ((b - root) / a, (b + root) / a);
        let first = miss_probability((high - mean) / v.sqrt()) + miss_probability((mean - low) / v.sqrt());
        let second = miss_probability((other - high) / w.sqrt()) - miss_probability((other - low) / w.sqrt());
        let found = law(&[mean], &[other], &statistics).error();
        assert!(close(found.first, first, 1e-11), "{found:?} {first}");
        assert!(close(found.second, second, 1e-11), "{found:?} {second}");
        assert!(found.numerical < 1e-12 && found.route == Route::Integral);
    }
}

#[test]
fn few_bands_agree_with_the_sum_over_all_their_counts() {
    let bunched = Statistics::negative_binomial(vec![0.7, 3.0, 40.0]).unwrap();
    for statistics in [Statistics::Poisson, bunched] {
        for (means, others) in [
            ([0.5, 2.0, 3.5], [1.5, 1.0, 3.6]),
            ([1e-9, 3e-9, 1e-3], [1e-8, 1e-9, 2e-3]),
            ([2.0, 3.0, 1.0], [3.0, 2.0, 1.0]),
            ([0.01, 0.2, 4.0], [1.5, 0.02, 0.1]),
        ] {
            // 0.7 modes of 1.5 photons: (15/22)^110 = 5e-19 is left out.
            let [first, second] = brute(&means, &others, &statistics, 110);
            let law = law(&means, &others, &statistics);
            let found = law.error();
            assert!(close(found.error, 0.5 * (first + second), 1e-11), "{found:?} {first} {second}");
            assert!(close(found.first, first, 1e-10) && close(found.second, second, 1e-10), "{found:?}");
            // The lattice makes the error slightly smaller, and knows by about how much.
            let line = law.line(law.saddle());
            let lattice = assembled(lattice::transform(&line, WHOLE.lattice).unwrap(), Route::Lattice);
            let off = 1.0 - lattice.error / found.error;
            println!("lattice: {off:.1e}, estimated {:.1e}", lattice.numerical);
            assert!(off > -1e-13 && off < 1e-5 && off < lattice.numerical, "{off:e} {lattice:?}");
        }
    }
}

/// Two dark bands, and what never happens.
#[test]
fn dark_bands_and_equal_states() {
    let found = law(&[0.0], &[3.0], &Statistics::Poisson).error();
    assert!(close(found.error, 0.5 * (-3.0_f64).exp(), 1e-14) && found.first == 0.0, "{found:?}");
    let found = law(&[0.0, 5.0], &[3.0, 0.0], &Statistics::Poisson).error();
    // Nothing is counted: the first state with e^{−5}, the second with e^{−3}.
    assert!(close(found.error, 0.5 * (-5.0_f64).exp(), 1e-14) && found.second == 0.0, "{found:?}");
    // Beside a band that tells little: p wins without counts in the first band, whatever the other counts.
    let found = law(&[0.0, 5.0], &[50.0, 5.1], &Statistics::Poisson).error();
    assert!(close(found.error, 0.5 * (-50.0_f64).exp(), 1e-12), "{found:?}");
    let found = law(&[4.0, 7.0], &[4.0, 7.0], &Statistics::Poisson).error();
    assert_eq!([found.error, found.first, found.second], [0.5; 3]);
    let bright = law(&[0.0], &[1e18], &Statistics::Poisson).error();
    assert!(bright.error == 0.0 && close(bright.ln_error, -1e18, 1e-12));
    assert!(close(
        law(&[0.0], &[3.0], &Statistics::Poisson).certain(State::Second),
        0.950_212_931_632_136,
        1e-14
    ));
    assert_eq!(law(&[0.0], &[3.0], &Statistics::Poisson).certain(State::First), 0.0);
}

/// 536 bands with hardly a photon: error ½ − ½ P_p-excess of one photon, ½ − ¼Σ|N − N′|, to first order in N.
#[test]
fn hardly_a_photon_leaves_a_coin() {
    let means: Vec<f64> = (0..536).map(|w| 1e-9 * (1.0 + 0.5 * f64::from(w).sin())).collect();
    let others: Vec<f64> = (0..536).map(|w| 1e-9 * (1.0 + 0.5 * f64::from(w).cos())).collect();
    let found = law(&means, &others, &Statistics::Poisson).error();
    // Without a photon the state of fewer photons is right; one photon decides for the brighter band.
    let (p, q): (f64, f64) = (means.iter().sum(), others.iter().sum());
    let one: f64 = means.iter().zip(&others).map(|(a, b)| a.min(*b)).sum();
    let exact = 0.5 * ((-p).exp().min((-q).exp()) + one);
    // Two photons: 5e-7² / 2.
    assert!((found.error - exact).abs() < 2e-13 && found.route == Route::Lattice, "{found:?} {exact}");
    assert!(0.5 - found.error > 1e-8);
}

/// Half the distance 2(√N′ − √N) as a number of deviations; next order is 1/N.
#[test]
fn many_photons_are_normal() {
    for (scale, tolerance) in [(1e8_f64, 1e-5), (1e12, 1e-9), (1e18, 1e-12)] {
        let means: Vec<f64> = (0..536).map(|w| scale * (1.0 + 0.5 * f64::from(w).sin())).collect();
        let shift = |w: usize| 0.1 * scale.sqrt() * f64::cos(w as f64 * 1.7);
        let others: Vec<f64> = means.iter().enumerate().map(|(w, mean)| mean + shift(w)).collect();
        let found = law(&means, &others, &Statistics::Poisson).error();
        let square: f64 = means
            .iter()
            .enumerate()
            // √(N + δ) − √N without the difference of roots.
            .map(|(w, mean)| (2.0 * (others[w] - mean) / ((others[w]).sqrt() + mean.sqrt())).powi(2))
            .sum();
        let exact = miss_probability(0.5 * square.sqrt());
        println!("{scale:e}: {:e}, estimated {:e}", found.error / exact - 1.0, found.numerical);
        assert!(close(found.error, exact, tolerance) && found.route == Route::Integral, "{found:?} {exact}");
    }
}

/// Integral and sum are two ways to the same number; the integral knows how far off it may be.
#[test]
fn integral_sum_and_lattice_agree() {
    let cases: [(&[f64], &[f64], f64); 4] = [
        (&[2e4], &[2.02e4], 3e-5),
        (&[300.0, 200.0], &[320.0, 190.0], 3e-3),
        (&[3000.0, 20.0, 40.0], &[3100.0, 25.0, 36.0], 3e-4),
        (&[1e6, 3e6], &[1.001e6, 2.999e6], 3e-6),
    ];
    for (means, others, most) in cases {
        let law = law(means, others, &Statistics::Poisson);
        let line = law.line(law.saddle());
        let sum = assembled(enumeration::enumerate(&line, WHOLE).unwrap(), Route::Sum);
        let integral = assembled(inversion::integrate(&line, WHOLE).unwrap(), Route::Integral);
        let off = (integral.error / sum.error - 1.0).abs();
        println!("integral: {off:.1e}, estimated {:.1e}", integral.numerical);
        assert!(off <= integral.numerical && integral.numerical < most, "{integral:?} {sum:?}");
        assert!((integral.first - sum.first).abs() <= integral.numerical_class * sum.error);
        assert!((integral.second - sum.second).abs() <= integral.numerical_class * sum.error);
    }
    // Four bands whose steps are multiples of one another: more revivals than of any four steps.
    let means = [400.0, 500.0, 600.0, 700.0_f64];
    let others: Vec<f64> = means.iter().zip(1..).map(|(mean, k)| mean * 1.02_f64.powi(k)).collect();
    let states = law(&means, &others, &Statistics::Poisson);
    let line = states.line(states.saddle());
    let integral = assembled(inversion::integrate(&line, WHOLE).unwrap(), Route::Integral);
    // One lattice of step ln 1.02 holds all of them.
    let lattice = assembled(lattice::transform(&line, WHOLE.lattice).unwrap(), Route::Lattice);
    let off = (integral.error / lattice.error - 1.0).abs();
    println!("multiples: {off:.1e}, estimated {:.1e} {:.1e}", integral.numerical, lattice.numerical);
    assert!(off <= integral.numerical + lattice.numerical && integral.numerical > 1e-7);
    // Many bands of few photons.
    for total in [60.0, 200.0] {
        let share = |w: f64| total / 60.0 * (1.0 + 0.6 * (w * 1.3).sin());
        let means: Vec<f64> = (0..60).map(|w| share(f64::from(w))).collect();
        let others: Vec<f64> = (0..60).map(|w| share(f64::from(w) + 0.3)).collect();
        let law = law(&means, &others, &Statistics::Poisson);
        let line = law.line(law.saddle());
        let integral = assembled(inversion::integrate(&line, WHOLE).unwrap(), Route::Integral);
        let lattice = assembled(lattice::transform(&line, WHOLE.lattice).unwrap(), Route::Lattice);
        let off = integral.error / lattice.error - 1.0;
        println!("{total}: lattice off by {off:.1e}, {:.1e} {:.1e}", integral.numerical, lattice.numerical);
        assert!(off.abs() <= lattice.numerical + integral.numerical && lattice.numerical < 1e-4, "{off:e}");
    }
}

/// Distribution function: quantiles are its inverse, its value at 0 is the error of a class, its mean and variance
/// are those of Λ.
#[test]
fn the_distribution_is_that_of_the_errors() {
    let cases = [
        (Statistics::Poisson, 50.0),
        (Statistics::gaussian(vec![30.0; 40]).unwrap(), 1e3),
        (Statistics::negative_binomial(vec![20.0; 40]).unwrap(), 50.0),
        (Statistics::Poisson, 1e15),
    ];
    for (statistics, scale) in &cases {
        let means: Vec<f64> = (0..40).map(|w| scale * (1.0 + 0.5 * f64::from(w).sin())).collect();
        let shift = |w: usize| 0.3 * scale.sqrt() * f64::cos(w as f64 * 1.7);
        let others: Vec<f64> = means.iter().enumerate().map(|(w, mean)| mean + shift(w)).collect();
        let law = law(&means, &others, statistics);
        let error = law.error();
        for (state, below) in [(State::First, 1.0 - error.first), (State::Second, error.second)] {
            let found = law.distribution(state).unwrap();
            assert!((found.cumulative(0.0) - below).abs() < 1e-10, "{statistics:?} {state:?}");
            let points = 20_000;
            let (mut mean, mut square) = (0.0, 0.0);
            for k in 0..points {
                let u = (f64::from(k) + 0.5) / f64::from(points);
                let x = found.quantile(u);
                assert!((found.cumulative(x) - u).abs() < 1e-12, "{u}");
                mean += x / f64::from(points);
                square += x * x / f64::from(points);
            }
            let s = if state == State::First { 0.0 } else { 1.0 };
            let moments = law.states.at(s);
            let spread = moments.variance.sqrt();
            assert!((mean - moments.slope).abs() < 1e-4 * spread, "{mean} {moments:?}");
            // The midpoint rule leaves a few ten thousandths of the variance in the tails.
            assert!(close(square - mean * mean, moments.variance, 2e-3), "{square} {moments:?}");
            assert!(found.cumulative(f64::NAN) == 0.0 && found.quantile(f64::NAN).is_finite());
        }
    }
    // Few photons are steps.
    let few = law(&[0.5; 40], &[0.7; 40], &Statistics::Poisson);
    assert!(few.distribution(State::First).is_none());
}

mod everywhere;
