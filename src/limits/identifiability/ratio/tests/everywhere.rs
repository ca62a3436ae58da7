use super::*;
use rand::{RngExt, SeedableRng, rngs::ChaCha8Rng};

/// 300 random pairs of all three laws, from 10⁻⁶ to 10¹⁸ photons: a number, inside the rigorous bracket.
#[test]
fn every_error_lies_inside_the_rigorous_bracket() {
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    let mut routes = std::collections::BTreeMap::new();
    for trial in 0..300 {
        let bands = [1, 2, 3, 10, 60][trial / 3 % 5];
        let size = 10_f64.powf(rng.random_range(-6.0..16.0));
        let contrast = 10_f64.powf(rng.random_range(-3.0..1.5)) / (size * bands as f64).sqrt().max(6.0);
        let mut draw = |low: f64, high: f64| rng.random_range(low..high);
        let means: Vec<f64> = (0..bands).map(|_| size * draw(0.2, 1.0)).collect();
        let others: Vec<f64> = means.iter().map(|mean| mean * (contrast * draw(-1.0, 1.0)).exp()).collect();
        let statistics = match trial % 3 {
            0 => Statistics::Poisson,
            1 => Statistics::gaussian(vec![size.sqrt() + 1.0; bands]).unwrap(),
            _ => Statistics::negative_binomial((0..bands).map(|_| size * draw(0.05, 9.0)).collect()).unwrap(),
        };
        let law = law(&means, &others, &statistics);
        let (found, bracket) = (law.error(), law.states.bracket());
        // Rounding of the exponent.
        let slack = found.numerical + 1e-13 * (10.0 - bracket.ln_lower);
        assert!(
            found.ln_error >= bracket.ln_lower - slack && found.ln_error <= bracket.ln_upper + slack,
            "{found:?} {bracket:?}"
        );
        assert!(close(0.5 * (found.first + found.second), found.error, 1e-12) || found.error < 1e-300);
        assert!(
            found.numerical >= 0.0 && found.numerical_class.is_finite(),
            "{found:?} {means:?} {others:?}"
        );
        if found.route == Route::Bracket || found.numerical > 1e-6 {
            println!("{bands} bands of {size:.1e} {contrast:.1e} {}: {found:?}", statistics.name());
        }
        *routes.entry(format!("{:?}", found.route)).or_insert(0) += 1;
    }
    println!("{routes:?}");
    assert!(routes.get("Bracket").is_none_or(|count| *count < 10), "{routes:?}");
}

/// Whatever is given: an error of the input, or numbers.
#[test]
fn no_input_gives_what_is_no_number() {
    let values = [0.0, 1e-300, 1e-12, 0.3, 1.0, 7.0, 1e6, 1e6 + 1.0, 1e18, 1.1e18, 1e300];
    for a in values {
        for b in values {
            for statistics in [
                Statistics::Poisson,
                Statistics::gaussian(vec![0.0, 1e-3]).unwrap(),
                Statistics::gaussian(vec![1e12, 3.0]).unwrap(),
                Statistics::negative_binomial(vec![1e-3, 2.0]).unwrap(),
                Statistics::negative_binomial(vec![1e15, 30.0]).unwrap(),
            ] {
                let Ok(law) = RatioLaw::new(&[a, 2.0], &[b, 2.5], &statistics) else { continue };
                let found = law.error();
                let TestError { error, ln_error, first, second, numerical, numerical_class, .. } = found;
                assert!((0.0..=0.5).contains(&error), "{a:e} {b:e} {statistics:?} {found:?}");
                assert!((0.0..=1.0).contains(&first) && (0.0..=1.0).contains(&second), "{found:?}");
                assert!(ln_error.is_finite() && ln_error <= -LN_2, "{a:e} {b:e} {statistics:?} {found:?}");
                assert!(numerical >= 0.0 && numerical.is_finite(), "{a:e} {b:e} {statistics:?} {found:?}");
                assert!(numerical_class >= 0.0 && numerical_class.is_finite(), "{found:?}");
                for state in [State::First, State::Second] {
                    assert!((0.0..=1.0).contains(&law.certain(state)));
                    if let Some(table) = law.distribution(state) {
                        let quantiles = [0.0, 1e-9, 0.5, 1.0].map(|u| table.quantile(u));
                        assert!(
                            quantiles.is_sorted() && quantiles.iter().all(|x| x.is_finite()),
                            "{quantiles:?}"
                        );
                    }
                }
            }
        }
    }
    assert!(RatioLaw::new(&[1.0], &[1.0, 2.0], &Statistics::Poisson).is_err());
    assert!(RatioLaw::new(&[f64::NAN], &[1.0], &Statistics::Poisson).is_err());
    let nothing = RatioLaw::new(&[], &[], &Statistics::Poisson).unwrap().error();
    assert_eq!(nothing.error, 0.5);
}
