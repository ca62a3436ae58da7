//! Trained classifiers against the optimum of known classes, and against what theory says they lose.

use super::*;
use crate::draws::Draws;
use crate::spectra::Split;
use hadar::identifiability::detection;
use hadar::statistics::Statistics;

/// Two Poisson classes in `bands` bands, half their separation being `distance` deviations; the difference changes
/// its sign from band to band.
fn two(bands: usize, distance: f64) -> Vec<Vec<f64>> {
    let mean = |w: usize| 1e6 * (1.0 + 0.3 * (w as f64).sin());
    let sign = |w: usize| if w.is_multiple_of(2) { 1.0 } else { -1.0 };
    let off = |w: usize| sign(w) * distance * (mean(w) / bands as f64).sqrt();
    vec![(0..bands).map(|w| mean(w) - off(w)).collect(), (0..bands).map(|w| mean(w) + off(w)).collect()]
}

fn draws(means: &[Vec<f64>]) -> Vec<Draws> {
    means.iter().map(|means| Draws::new(&Statistics::Poisson, means).unwrap()).collect()
}

fn split(means: &[Vec<f64>], per_class: usize) -> Split {
    Split::draw(&draws(means), per_class, 11).unwrap()
}

fn optimum(means: &[Vec<f64>], spectra: &LabelledSpectra) -> f64 {
    let rule = LikelihoodRatio::new(&Statistics::Poisson, means).unwrap();
    Confusion::of(&rule, spectra).unwrap().accuracy()
}

/// Six distances in 3 bands, 40 000 test spectra: Φ(d) lies outside of an interval of 99.9 % once in 170 times by
/// chance, and not with this seed. Trained ones lose next to nothing: 20 000 spectra tell 3 means.
#[test]
fn the_limit_is_reached_in_few_bands() {
    for distance in [0.1, 0.3, 1.0, 1.5, 2.0, 3.0] {
        let means = two(3, distance);
        let split = split(&means, 40_000);
        let rule = LikelihoodRatio::new(&Statistics::Poisson, &means).unwrap();
        let confusion = Confusion::of(&rule, &split.test).unwrap();
        let interval = confusion.interval(0.999);
        let limit = detection::probability(distance);
        assert!(interval.low < limit && limit < interval.high, "{distance}: {interval:?} {limit}");
        let discriminant = Discriminant::train(&split.training, &split.validation, &SHRINKAGES).unwrap();
        let logistic = Logistic::train(&split.training, &split.validation).unwrap();
        for trained in [&discriminant as &dyn Classifier, &logistic] {
            let right = Confusion::of(trained, &split.test).unwrap().accuracy();
            let short = confusion.accuracy() - right;
            // Paired with the optimum on the same spectra, both lose at most a few in a thousand.
            assert!((-0.002..0.005).contains(&short), "{} at {distance}: {short}", trained.name());
        }
    }
}

/// 100 bands from 400 spectra: Φ(d √(1 − p/n)/√(1 + p/(n d²))) for Fisher's discriminant, without the root in the numerator
/// where correlations are neglected. Twelve training sets scatter by 0.015 each; the mean is allowed 3 deviations of its own.
#[test]
fn many_bands_cost_what_theory_says() {
    let (bands, sets) = (100_usize, 12);
    for distance in [0.7_f64, 1.5] {
        let means = two(bands, distance);
        let draws = draws(&means);
        let test = LabelledSpectra::draw(&draws, 0..5000, 12).unwrap();
        let ratio = bands as f64 / 400.0;
        let learnt = distance / (1.0 + ratio / (distance * distance)).sqrt();
        for (shrinkage, expected) in [(0.0, learnt * (1.0 - ratio).sqrt()), (1.0, learnt)] {
            let rights: Vec<f64> = (0..sets)
                .map(|seed| {
                    let training = LabelledSpectra::draw(&draws, 0..200, 100 + seed).unwrap();
                    let trained = Discriminant::train(&training, &training, &[shrinkage]).unwrap();
                    Confusion::of(&trained, &test).unwrap().accuracy()
                })
                .collect();
            let mean = rights.iter().sum::<f64>() / sets as f64;
            let expected = detection::probability(expected);
            println!("d = {distance}, shrinkage {shrinkage}: {mean:.4}, theory {expected:.4}, {rights:.3?}");
            assert!((mean - expected).abs() < 0.013, "{distance} {shrinkage}: {mean} {expected}");
            assert!(rights.iter().all(|&right| right < optimum(&means, &test)));
        }
    }
}

/// The gradient that logistic regression descends is that of its loss: at the end of a long training on separable
/// weights, Newton's method (written here) finds no lower loss on two bands.
#[test]
fn logistic_regression_is_the_maximum_of_likelihood() {
    let means = two(2, 0.8);
    let split = split(&means, 8000);
    // Validated on the training part itself, it descends to the minimum.
    let trained = Logistic::train(&split.training, &split.training).unwrap();
    let mut theta = [0.0_f64; 3];
    let features = |counts: &[f64]| {
        let x = |w: usize| (counts[w] - means[0][w]) / means[0][w].sqrt();
        [x(0), x(1), 1.0]
    };
    let mut loss = 0.0;
    for _ in 0..30 {
        let (mut gradient, mut hessian) = (nalgebra::Vector3::zeros(), nalgebra::Matrix3::zeros());
        loss = 0.0;
        for (counts, label) in split.training.iter() {
            let x = nalgebra::Vector3::from(features(counts));
            let score = x.dot(&nalgebra::Vector3::from(theta));
            let p = 1.0 / (1.0 + (-score).exp());
            loss += if label == 1 { -p.ln() } else { -(1.0 - p).ln() };
            gradient += x * (p - label as f64);
            hessian += x * x.transpose() * p * (1.0 - p);
        }
        let step = hessian.cholesky().unwrap().solve(&gradient);
        (0..3).for_each(|i| theta[i] -= step[i]);
    }
    let expected = loss / split.training.len() as f64;
    let excess = trained.validation_loss() - expected;
    // The loss is strongly convex on two bands that scatter: accelerated steps come as near as that.
    assert!((-1e-12..1e-6).contains(&excess), "{excess:e} above {expected}");
}

/// Three classes, a band that never scatters, and one without counts.
#[test]
fn several_classes_and_dead_bands() {
    let means = vec![vec![400.0, 0.0, 900.0], vec![500.0, 0.0, 900.0], vec![400.0, 0.0, 1050.0]];
    let split = split(&means, 8000);
    let best = optimum(&means, &split.test);
    let discriminant = Discriminant::train(&split.training, &split.validation, &SHRINKAGES).unwrap();
    let logistic = Logistic::train(&split.training, &split.validation).unwrap();
    for trained in [&discriminant as &dyn Classifier, &logistic] {
        let confusion = Confusion::of(trained, &split.test).unwrap();
        assert!(confusion.accuracy() > best - 0.01, "{}: {}", trained.name(), confusion.accuracy());
        assert_eq!(confusion.spectra(), [4000.0; 3]);
    }
}

/// Spectra that are drawn, judged and forgotten are those that are drawn and kept.
#[test]
fn kept_or_forgotten_spectra_are_the_same() {
    let means = two(4, 0.6);
    let (draws, rule) = (draws(&means), LikelihoodRatio::new(&Statistics::Poisson, &means).unwrap());
    let kept = Confusion::of(&rule, &LabelledSpectra::draw(&draws, 100..900, 3).unwrap()).unwrap();
    assert_eq!(Confusion::of_draws(&[&rule, &rule], &draws, 100..900, 3).unwrap(), [kept.clone(), kept]);
}

#[test]
fn threads_do_not_matter() {
    let means = two(5, 0.5);
    let split = split(&means, 2000);
    let judged = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let trained = Logistic::train(&split.training, &split.validation).unwrap();
            (Confusion::of(&trained, &split.test).unwrap(), trained)
        })
    };
    assert_eq!(judged(1), judged(3));
}

#[test]
fn parts_that_do_not_fit_are_refused() {
    let (three, five) = (split(&two(3, 1.0), 100), split(&two(5, 1.0), 100));
    assert!(Logistic::train(&three.training, &five.validation).is_err());
    assert!(Discriminant::train(&three.training, &five.validation, &[1.0]).is_err());
    // Fewer spectra than bands tell no covariance.
    let few = split(&two(60, 1.0), 80);
    assert!(Discriminant::train(&few.training, &few.validation, &[0.0]).is_err());
    assert!(Discriminant::train(&few.training, &few.validation, &[f64::NAN]).is_err());
    let one = LabelledSpectra::new(1, 2, vec![1.0, 2.0], vec![0, 0]).unwrap();
    assert!(Logistic::train(&one, &one).is_err() && Discriminant::train(&one, &one, &[1.0]).is_err());
    let trained = Logistic::train(&three.training, &three.validation).unwrap();
    assert!(Confusion::of(&trained, &five.test).is_err());
}

/// What comes back from a file gives the same scores; what was damaged is refused.
#[test]
fn trained_rules_survive_a_file() {
    let split = split(&two(3, 1.0), 400);
    let trained = Discriminant::train(&split.training, &split.validation, &SHRINKAGES).unwrap();
    let text = serde_json::to_string(&trained).unwrap();
    assert_eq!(serde_json::from_str::<Discriminant>(&text).unwrap(), trained);
    let logistic = Logistic::train(&split.training, &split.validation).unwrap();
    let text = serde_json::to_string(&logistic).unwrap();
    assert_eq!(serde_json::from_str::<Logistic>(&text).unwrap(), logistic);
    let short = text.replacen("\"constants\":[", "\"constants\":[1.0,", 1);
    assert!(serde_json::from_str::<Logistic>(&short).is_err());
}
