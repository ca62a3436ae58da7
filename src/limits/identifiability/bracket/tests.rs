use super::*;
use statrs::function::gamma::ln_gamma;

/// Made with mpmath at 60 digits from the same doubles: C(¼), C(½), s* and C(s*), the last two by golden
/// section over the closed forms C = Σ(1−s)N + sN′ − N^{1−s}N′^s, ½s(1−s)Δ²/u + ½ln(u/(v^s v′^{1−s})) and
/// m ln[(1+a)^{1−s}(1+a′)^s − a^{1−s}a′^s].
struct Reference {
    means: [f64; 3],
    others: [f64; 3],
    laws: [[f64; 4]; 3],
}

#[allow(clippy::excessive_precision, reason = "all digits that were made")]
const REFERENCES: [Reference; 4] = [
    Reference {
        means: [100.0, 50.0, 3.5],
        others: [110.0, 45.0, 7.25],
        laws: [
            [0.377043739370806986, 0.522589860556684217, 0.5199185818, 0.523418515515749441],
            [0.226829916438738936, 0.326258613230277475, 0.5408835005, 0.328422751841646158],
            [0.248948851820556596, 0.349955690670111172, 0.5275826744, 0.351018239121328468],
        ],
    },
    Reference {
        means: [1000.0, 2000.0, 1500.0],
        others: [1000.0001220703125, 1999.9998779296875, 1500.0],
        laws: [
            [2.0954757182778488e-12, 2.79396763858131701e-12, 0.5000000025, 2.79396763858131709e-12],
            [1.94577369495799335e-12, 2.59436497086260869e-12, 0.5000000085, 2.59436497086260944e-12],
            [2.33528800230109516e-13, 3.11371731027439632e-13, 0.4999999958, 3.11371731027439654e-13],
        ],
    },
    Reference {
        means: [0.001, 20.0, 1000000.0],
        others: [30.0, 0.01, 1100000.0],
        laws: [
            [905.81030725229863, 1215.53691117219616, 0.5051663634, 1215.66469294423849],
            [873.985060296262309, 1193.44549415953236, 0.5121075873, 1194.14511922096341],
            [12.4385441884495951, 10.5030192334612863, 0.2809093285, 12.5084257247897626],
        ],
    },
    Reference {
        means: [1200.0, 800.0, 1500.0],
        others: [800.0, 1250.0, 1000.0],
        laws: [
            [53.3473992535030751, 70.4592314951397116, 0.4956869884, 70.46445654110581],
            [49.3621586118562144, 62.2416681190763955, 0.475285238, 62.38983432580981],
            [9.29074869326753726, 12.992070682559798, 0.5250306534, 13.02451047393653],
        ],
    },
];

fn laws() -> [Statistics; 3] {
    [
        Statistics::Poisson,
        Statistics::gaussian(vec![25.0, 400.0, 3.0]).unwrap(),
        Statistics::negative_binomial(vec![0.5, 1000.0, 30.0]).unwrap(),
    ]
}

/// A few ulp; for bunched light times 1 + a, the 200 photons in half a mode of the first band.
#[test]
fn exponents_agree_with_thirty_digits() {
    let mut worst = [0.0_f64; 3];
    for reference in &REFERENCES {
        for (kind, (statistics, exact)) in laws().iter().zip(&reference.laws).enumerate() {
            let states = KnownStates::new(&reference.means, &reference.others, statistics).unwrap();
            let found = states.bracket();
            let error = |value: f64, exact: f64| (value / exact - 1.0).abs();
            let largest = error(states.exponent(0.25), exact[0])
                .max(error(found.bhattacharyya, exact[1]))
                .max(error(found.chernoff, exact[3]));
            worst[kind] = worst[kind].max(largest);
            assert!((found.chernoff_s - exact[2]).abs() < 1e-6, "{statistics:?} {found:?}");
        }
    }
    println!("largest relative error of an exponent: {worst:?}");
    assert!(worst[0] < 1e-14 && worst[1] < 1e-14 && worst[2] < 1e-12, "{worst:?}");
}

/// ln of the probability of n counts, from the laws' textbook forms.
fn ln_mass(statistics: &Statistics, n: f64, mean: f64) -> f64 {
    match statistics {
        Statistics::NegativeBinomial { modes } => {
            let m = modes[0];
            ln_gamma(n + m) - ln_gamma(m) - ln_gamma(n + 1.0) + n * (mean / (mean + m)).ln()
                - m * (mean / m).ln_1p()
        }
        _ => n * mean.ln() - mean - ln_gamma(n + 1.0),
    }
}

#[test]
fn coefficients_agree_with_the_sum_over_all_counts() {
    for statistics in [Statistics::Poisson, Statistics::negative_binomial(vec![2.5]).unwrap()] {
        for (mean, other) in [(7.0, 9.0), (0.4, 30.0), (55.0, 21.0)] {
            let states = KnownStates::new(&[mean], &[other], &statistics).unwrap();
            for s in [0.1, 0.5, 0.83] {
                let sum: f64 = (0..3000)
                    .map(f64::from)
                    .map(|n| {
                        ((1.0 - s) * ln_mass(&statistics, n, mean) + s * ln_mass(&statistics, n, other)).exp()
                    })
                    .sum();
                assert!((states.exponent(s) + sum.ln()).abs() < 1e-11, "{statistics:?} {mean} {other} {s}");
            }
        }
    }
}

/// Errors from ½ to 1e-300 by direct summation; the bracket holds and keeps the exponent.
#[test]
fn brackets_hold_the_exact_error_down_to_the_smallest() {
    let (mut smallest, mut widest) = (1.0_f64, 0.0_f64);
    for statistics in [Statistics::Poisson, Statistics::negative_binomial(vec![2e4]).unwrap()] {
        for step in (0..140).step_by(4) {
            let (mean, other) = (1000.0, 1000.0 + f64::from(step * step));
            let exact: f64 = 0.5
                * (0..4000 + 2 * step * step)
                    .map(f64::from)
                    .map(|n| ln_mass(&statistics, n, mean).min(ln_mass(&statistics, n, other)).exp())
                    .sum::<f64>();
            if exact < 1e-300 {
                break;
            }
            let found = KnownStates::new(&[mean], &[other], &statistics).unwrap().bracket();
            // 1e-9: ln Γ of 2·10⁴ to 1e-15 of itself.
            let close = 1.0 + 1e-9;
            assert!(
                found.lower <= exact * close && exact <= found.upper * close,
                "{other} {exact:e} {found:?}"
            );
            smallest = smallest.min(exact);
            widest = widest.max((found.ln_upper - found.ln_lower) / (1.0 - found.ln_upper).sqrt());
        }
    }
    println!("smallest error {smallest:.1e}; widest bracket {widest:.2} √(1 − ln upper)");
    assert!(smallest < 1e-270 && widest < 4.0);
}

#[test]
fn the_poisson_bracket_is_that_of_the_distance() {
    let (means, others) = ([120.0, 80.0], [100.0, 95.0]);
    let d = means
        .iter()
        .zip(&others)
        .map(|(a, b): (&f64, &f64)| (a.sqrt() - b.sqrt()).powi(2))
        .sum::<f64>()
        .sqrt();
    let found = KnownStates::new(&means, &others, &Statistics::Poisson).unwrap().bracket();
    let by_distance = detection::error_bracket(d);
    assert!((found.bhattacharyya / (0.5 * d * d) - 1.0).abs() < 1e-13);
    assert!(found.lower >= by_distance.lower * (1.0 - 1e-13) && found.upper <= by_distance.upper);
}

/// A band that is dark in one state alone: ε = ½e^{−N′}, and both bounds are that.
#[test]
fn what_only_one_can_do_is_exact() {
    let found = KnownStates::new(&[0.0, 3.0], &[9.0, 3.0], &Statistics::Poisson).unwrap().bracket();
    assert_eq!(found.chernoff_s, 1.0);
    for bound in [found.lower, found.upper] {
        assert!((bound / (0.5 * (-9.0_f64).exp()) - 1.0).abs() < 1e-13, "{found:?}");
    }
    let same = KnownStates::new(&[4.0], &[4.0], &Statistics::Poisson).unwrap().bracket();
    assert_eq!((same.lower, same.upper), (0.5, 0.5));
    let dark = Statistics::negative_binomial(vec![2.0]).unwrap();
    let found = KnownStates::new(&[6.0], &[0.0], &dark).unwrap().bracket();
    assert!((found.upper / (0.5 * (1.0_f64 + 3.0).powi(-2)) - 1.0).abs() < 1e-13, "{found:?}");
}

/// Equal Gaussians: the exact error is Φ(−d), C = d²/2·4s(1−s).
#[test]
fn gaussians_of_one_variance_are_the_distance() {
    let statistics = Statistics::gaussian(vec![1e12]).unwrap();
    for d in [0.1, 1.0, 5.0, 20.0] {
        let found = KnownStates::new(&[0.0], &[2e6 * d], &statistics).unwrap().bracket();
        let miss = detection::miss_probability(d);
        // Variances differ by 2e-6 d, which moves the error by about d³ of that.
        let close = 1.0 + 1e-5 * d.powi(3).max(1.0);
        assert!((found.chernoff / (0.5 * d * d) - 1.0).abs() < 1e-4, "{d} {found:?}");
        assert!(found.lower <= miss * close && miss <= found.upper * close, "{d} {found:?}");
    }
}

#[test]
fn what_is_no_law_is_refused() {
    let poisson = Statistics::Poisson;
    assert!(KnownStates::new(&[1.0], &[1.0, 2.0], &poisson).is_err());
    assert!(KnownStates::new(&[-1.0], &[1.0], &poisson).is_err());
    assert!(KnownStates::new(&[f64::NAN], &[1.0], &poisson).is_err());
    assert!(KnownStates::new(&[0.0], &[1.0], &Statistics::gaussian(vec![0.0]).unwrap()).is_err());
    assert!(KnownStates::new(&[1.0], &[2.0], &Statistics::gaussian(vec![]).unwrap()).is_err());
    // Any finite means give numbers that are numbers.
    for (mean, other) in [(1e-300, 1e300), (1e300, 5e-324), (1.0, 1e308), (0.0, 1e-310)] {
        for law in [Statistics::Poisson, Statistics::negative_binomial(vec![1e3]).unwrap()] {
            if let Ok(states) = KnownStates::new(&[mean], &[other], &law) {
                let found = states.bracket();
                assert!(
                    found.upper <= 0.5 && found.lower <= found.upper && !found.ln_lower.is_nan(),
                    "{found:?}"
                );
            }
        }
    }
}
