use super::*;
use hadar::identifiability::ratio::Route;

/// Two spectra of `bands` bands, about `scale` photons each, `contrast` standard deviations of a band apart.
fn pair(bands: u32, scale: f64, contrast: f64) -> [Vec<f64>; 2] {
    let wave = |w: u32| 1.0 + 0.5 * f64::from(w).sin();
    let means: Vec<f64> = (0..bands).map(|w| scale * wave(w)).collect();
    let shift = |w: u32| contrast * scale.sqrt() * (1.7 * f64::from(w)).cos();
    let others = (0..bands).map(|w| (scale * wave(w) + shift(w)).max(0.1 * scale)).collect();
    [means, others]
}

fn laws(bands: usize) -> [Statistics; 3] {
    [
        Statistics::Poisson,
        Statistics::gaussian(vec![50.0; bands]).unwrap(),
        Statistics::negative_binomial(vec![8.0; bands]).unwrap(),
    ]
}

/// Share of trials in which spectra drawn band by band are judged wrongly, by the likelihoods themselves.
fn drawn(means: &[f64], others: &[f64], statistics: &Statistics, truth: State, trials: u32) -> f64 {
    let of_truth = if truth == State::First { means } else { others };
    let draws = Draws::new(statistics, of_truth).unwrap();
    let mut rng = generator(11, 1 << 50);
    let mut counts = vec![0.0; means.len()];
    let mut wrong = 0.0;
    for _ in 0..trials {
        draws.draw_into(&mut rng, &mut counts);
        let ratio: f64 = (0..means.len())
            .map(|w| {
                let ln = |mean: f64| statistics.log_likelihood(w, counts[w], mean);
                ln(others[w]) - ln(means[w])
            })
            .sum();
        let says_second = if ratio.abs() < 1e-10 { 0.5 } else { f64::from(u8::from(ratio > 0.0)) };
        wrong += if truth == State::First { says_second } else { 1.0 - says_second };
    }
    wrong / f64::from(trials)
}

/// The calculated errors against Monte Carlo: 16 comparisons within 4.5 deviations, by chance one fails with 1e-4.
#[test]
fn calculated_errors_are_those_of_drawn_spectra() {
    let trials = 40_000;
    let mut worst = 0.0_f64;
    for (bands, scale, contrast) in [(20, 30.0, 0.4), (60, 0.05, 2.0), (3, 4.0, 0.8)] {
        let [means, others] = pair(bands, scale, contrast);
        for statistics in laws(bands as usize) {
            let found = RatioLaw::new(&means, &others, &statistics).unwrap().error();
            assert_ne!(found.route, Route::Bracket);
            for (state, exact) in [(State::First, found.first), (State::Second, found.second)] {
                let share = drawn(&means, &others, &statistics, state, trials);
                let deviation = (exact * (1.0 - exact) / f64::from(trials)).sqrt();
                let off = (share - exact) / deviation;
                worst = worst.max(off.abs());
                assert!(off.abs() < 4.5, "{bands} {scale} {statistics:?} {state:?}: {share} {exact}");
            }
        }
    }
    println!("farthest: {worst:.2} deviations");
}

/// Values by all three ways have the law's errors and moments. 18 comparisons each within 4.5 deviations.
#[test]
fn values_have_the_law_of_the_spectra() {
    let trials = 100_000;
    for (bands, scale, contrast) in [(60, 300.0, 0.2), (60, 0.02, 3.0), (3, 40.0, 0.8)] {
        let [means, others] = pair(bands, scale, contrast);
        for statistics in laws(bands as usize) {
            let found = RatioLaw::new(&means, &others, &statistics).unwrap().error();
            for (state, exact) in [(State::First, found.first), (State::Second, found.second)] {
                let draws = RatioDraws::new(&means, &others, &statistics, state).unwrap();
                let values = draws.values(5, 0, trials);
                let second = |ratio: &f64| {
                    if ratio.abs() < 1e-10 { 0.5 } else { f64::from(u8::from(*ratio > 0.0)) }
                };
                let share = values.iter().map(second).sum::<f64>() / trials as f64;
                let share = if state == State::First { share } else { 1.0 - share };
                let deviation = (exact * (1.0 - exact) / trials as f64).sqrt();
                assert!((share - exact).abs() < 4.5 * deviation, "{statistics:?} {state:?} {share} {exact}");
                // E[q/p] = 1 under p: any error of Λ shows. Its spread is that of the values themselves.
                let sign = if state == State::First { 1.0 } else { -1.0 };
                let ratios: Vec<f64> = values.iter().map(|ratio| (0.5 * sign * ratio).exp()).collect();
                let mean = ratios.iter().sum::<f64>() / trials as f64;
                let square = ratios.iter().map(|r| r * r).sum::<f64>() / trials as f64;
                let bracket =
                    hadar::identifiability::bracket::KnownStates::new(&means, &others, &statistics).unwrap();
                let rho = (-bracket.exponent(0.5)).exp();
                let deviation = ((square - mean * mean) / trials as f64).sqrt();
                assert!((mean - rho).abs() < 4.5 * deviation, "{statistics:?} {state:?} {mean} {rho}");
            }
        }
    }
}

#[test]
fn bands_dark_in_one_state_decide_at_once() {
    let mut means = pair(60, 300.0, 0.2)[0].clone();
    let mut others = pair(60, 300.0, 0.2)[1].clone();
    (means[7], others[7], means[9], others[9]) = (0.0, 0.7, 0.4, 0.0);
    let draws = RatioDraws::new(&means, &others, &Statistics::Poisson, State::First).unwrap();
    let values = draws.values(1, 0, 20_000);
    let certain = values.iter().filter(|ratio| **ratio == f64::NEG_INFINITY).count() as f64 / 20_000.0;
    // 1 − e^{−0.4} = 0.3297; 4.5 deviations.
    assert!((certain - 0.3297).abs() < 4.5 * (0.3297 * 0.6703 / 2e4_f64).sqrt(), "{certain}");
    assert!(values.iter().all(|ratio| *ratio < f64::INFINITY));
    let none = RatioDraws::new(&[0.0], &[3.0], &Statistics::Poisson, State::First).unwrap();
    assert_eq!(none.values(1, 0, 3), [-3.0; 3]);
}

/// 536 bands: the share of errors among the values drawn is the probability that is computed.
#[test]
fn values_of_many_bands_err_as_often_as_computed() {
    const VALUES: usize = 300_000;
    let [means, others] = pair(536, 1e4, 0.1);
    let draws = RatioDraws::new(&means, &others, &Statistics::Poisson, State::First).unwrap();
    let values = draws.values(3, 0, VALUES);
    let found = RatioLaw::new(&means, &others, &Statistics::Poisson).unwrap().error();
    let wrong = values.iter().filter(|ratio| **ratio > 0.0).count() as f64 / VALUES as f64;
    let deviation = (found.first * (1.0 - found.first) / VALUES as f64).sqrt();
    assert!((wrong - found.first).abs() < 4.5 * deviation, "{wrong} {found:?}");
}
