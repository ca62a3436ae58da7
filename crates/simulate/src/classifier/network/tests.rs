use super::layers::{Layers, Workspace};
use super::training::{Adam, first_weights};
use super::*;
use crate::classifier::Classifier;
use crate::draws::{Draws, generator};
use crate::sequential::Interval;
use crate::spectra::Split;
use hadar::statistics::Statistics;
use rand_distr::{Distribution, StandardNormal};

/// Two classes of Poisson counts `d` noise deviations either way from N along `direction`.
fn means(n: &[f64], direction: &[f64], d: f64) -> [Vec<f64>; 2] {
    let length = direction.iter().map(|u| u * u).sum::<f64>().sqrt();
    let at = |d: f64| n.iter().zip(direction).map(|(n, u)| n + d * u / length * n.sqrt()).collect();
    [at(-d), at(d)]
}

fn split(means: &[Vec<f64>], per_class: usize, seed: u64) -> Split {
    let draws: Vec<_> = means.iter().map(|means| Draws::new(&Statistics::Poisson, means).unwrap()).collect();
    Split::draw(&draws, per_class, seed).unwrap()
}

fn trained(split: &Split, settings: Settings) -> Network {
    let options = NetworkOptions::new(settings).unwrap();
    Network::train(&split.training, &split.validation, &options, &|_, _| ()).unwrap()
}

/// How many test spectra the network decides rightly, and how many the likelihood ratio.
fn right(network: &Network, means: &[Vec<f64>; 2], test: &LabelledSpectra) -> [f64; 2] {
    let mut judge = network.judge();
    let mut right = [0.0; 2];
    for (counts, label) in test.iter() {
        let mut scores = [0.0; 2];
        assert!(judge.score(counts, &mut scores));
        let bands = counts.iter().zip(&means[0]).zip(&means[1]);
        let ratio: f64 = bands.map(|((n, a), b)| n * (b / a).ln() - (b - a)).sum();
        for (right, decision) in right.iter_mut().zip([scores[1] > scores[0], ratio > 0.0]) {
            *right += f64::from(u8::from(decision == (label == 1)));
        }
    }
    right
}

/// Every weight and bias of every layer, with strides, more taps than bands, two blocks of channels, and a lane
/// left over. Central differences of step h are good to h² and 1e-16/h, together 1e-10 of the loss for h = 1e-5:
/// 1e-6 of the gradient, or 1e-8 of the largest one where it nearly vanishes. Weights in whose step a ReLU has its
/// kink are left out, and are few.
#[test]
fn gradients_are_those_of_central_differences() {
    const STEP: f64 = 1e-5;
    for (bands, channels, taps, stride) in
        [(1, 8, 7, 3), (2, 8, 7, 1), (3, 8, 5, 3), (29, 8, 5, 3), (40, 16, 3, 2)]
    {
        let layers = Layers::new(bands, 3, channels, taps, stride);
        let mut rng = generator(5, bands as u64);
        let mut normal = || -> f64 { StandardNormal.sample(&mut rng) };
        // Biases and the last layer are 0 at first; here nothing is.
        let mut weights = first_weights::<f64>(&layers, 1);
        weights.iter_mut().for_each(|w| *w += 0.1 * normal());
        let mut workspace = Workspace::<f64, 4>::new(&layers, true);
        let labels = [2, 0, 1];
        workspace.x[0].iter_mut().for_each(|lanes| *lanes = std::array::from_fn(|_| normal()));
        let loss = |weights: &[f64], workspace: &mut Workspace<f64, 4>| {
            workspace.forward(&layers, weights);
            let lit = workspace.x[1..].iter().flatten().flatten().map(|x| *x > 0.0).collect::<Vec<_>>();
            (-labels.iter().enumerate().map(|(i, &m)| workspace.scores[m][i]).sum::<f64>(), lit)
        };
        workspace.backward(&layers, &weights, &labels);
        let gradient = workspace.gradient.clone();
        let largest = gradient.iter().fold(0.0_f64, |a, g| a.max(g.abs()));
        let mut kinks = 0;
        for i in 0..weights.len() {
            let w = weights[i];
            weights[i] = w + STEP;
            let (above, lit_above) = loss(&weights, &mut workspace);
            weights[i] = w - STEP;
            let (below, lit_below) = loss(&weights, &mut workspace);
            weights[i] = w;
            if lit_above != lit_below {
                kinks += 1;
                continue;
            }
            let difference = (above - below) / (2.0 * STEP);
            let error = (difference - gradient[i]).abs();
            assert!(error < 1e-6 * gradient[i].abs() + 1e-8 * largest, "{bands} {i}: {error:e}");
        }
        assert!(kinks * 50 < weights.len(), "{kinks} of {}", weights.len());
    }
}

/// On w²/2 at w = 1 with η = 0.1 (gradient w), by hand: the first step is η/(1 + ε); then m = 0.18, v = 0.00180900...
/// m̂ = (0.9·0.1 + 0.1·0.9)/0.19, v̂ = (0.999·0.001 + 0.001·0.81)/0.001999.
#[test]
fn adam_takes_the_steps_worked_out_by_hand() {
    let (mut adam, mut w) = (Adam::<f64>::new(1), [1.0]);
    let mut step = |w: &mut [f64; 1], decay| {
        let gradient = *w;
        adam.step(w, &gradient, 0.1, decay);
    };
    step(&mut w, 0.0);
    assert!((w[0] - 0.9).abs() < 2e-9, "{w:?}");
    step(&mut w, 0.0);
    let by_hand = 0.9 - 0.1 * (0.18 / 0.19) / (0.001809_f64 / 0.001999).sqrt();
    assert!((w[0] - by_hand).abs() < 3e-9, "{w:?} {by_hand}");
    // Decay beside it: w (1 − η λ) − the step without.
    let (mut plain, mut decayed) = (Adam::<f64>::new(1), Adam::<f64>::new(1));
    let (mut a, mut b) = ([2.0], [2.0]);
    plain.step(&mut a, &[0.3], 0.1, 0.0);
    decayed.step(&mut b, &[0.3], 0.1, 0.5);
    assert!((a[0] - b[0] - 2.0 * 0.1 * 0.5).abs() < 1e-15);
}

/// Optimum Φ(1) = 0.8413 in 3 bands. The likelihood ratio's accuracy on the test spectra lies in Wilson's 99.9 %
/// interval about it (false alarms 1e-3, none at this seed), and so does the network's about the ratio's, which decides
/// most of these spectra alike and so leaves the interval far less often.
#[test]
fn three_bands_are_learnt_to_the_optimum() {
    let means = means(&[4e5, 5e5, 3e5], &[1.0, -1.5, 0.8], 1.0);
    let split = split(&means, 5000, 3);
    let network = trained(&split, Settings::default());
    let [learnt, best] = right(&network, &means, &split.test);
    let trials = split.test.len() as u64;
    let interval = |right| Interval::wilson(right, trials, 0.999);
    let (about, share) = (interval(best), learnt / trials as f64);
    assert!(about.low < 0.8413 && 0.8413 < about.high, "{about:?}");
    assert!(about.low < share && share < about.high, "{about:?} {share}");
    // ln 2 says nothing; the optimum, E ln(1 + exp(−2 − 2Z)), is 0.3609 nats, by quadrature.
    let loss = network.outcome().validation_loss;
    assert!((0.33..0.40).contains(&loss), "{loss}");
}

/// At d = 0.2 a training that stops before it has learnt anything decides at 0.5; Φ(0.2) = 0.579. The mean of 4 seeds
/// is at most 0.01 below the likelihood ratio's (0.001 ± 0.0015 over many seeds, five deviations away).
#[test]
fn weak_differences_are_learnt_too() {
    let means = means(&[4e5, 5e5, 3e5], &[-1.0, 0.2, 1.0], 0.2);
    let short = |seed| {
        let split = split(&means, 5000, 20 + seed);
        let network = trained(&split, Settings { seed, ..Settings::default() });
        let [learnt, best] = right(&network, &means, &split.test);
        (best - learnt) / split.test.len() as f64 / 4.0
    };
    let mean: f64 = (0..4).map(short).sum();
    assert!(mean < 0.01, "{mean}");
}

/// Five classes far apart, one band without any scatter and counts far from 0 and 1.
#[test]
fn classes_far_apart_are_all_told_apart() {
    let class =
        |c: usize| (0..20).map(|i| if i == 3 { 0.0 } else { 1e9 + 1e6 * ((i + c) % 5) as f64 }).collect();
    let means: Vec<Vec<f64>> = (0..5).map(class).collect();
    let split = split(&means, 400, 1);
    let network = trained(&split, Settings::default());
    let mut judge = network.judge();
    for (counts, label) in split.test.iter() {
        let mut scores = [0.0; 5];
        assert!(judge.score(counts, &mut scores));
        assert!((scores.iter().map(|s| s.exp()).sum::<f64>() - 1.0).abs() < 1e-5);
        assert!((0..5).all(|other| other == label || scores[other] < scores[label]));
    }
    assert_eq!((network.classes(), network.bands(), network.name()), (5, 20, "network"));
}

/// A last batch that is not full; one thread, two, and the way that a caller gets.
#[test]
fn bits_do_not_depend_on_the_number_of_threads() {
    let direction: Vec<f64> = (0..200).map(|i| (i as f64 / 9.0).sin()).collect();
    let split = split(&means(&[1e4; 200], &direction, 2.0), 420, 2);
    let settings = Settings { epochs: 3, ..Settings::default() };
    let network = trained(&split, settings);
    assert!(training::parallel(&network.layers));
    for threads in [1, 2] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let Network { layers, standard, .. } = &network;
        for parallel in [false, true] {
            let parts = [&split.training, &split.validation];
            let (weights, outcome) = pool
                .install(|| training::train::<f32>(layers, parts, standard, &settings, parallel, &|_, _| ()));
            let bits = |weights: &[f32]| weights.iter().map(|w| w.to_bits()).collect::<Vec<_>>();
            assert_eq!(bits(&weights), bits(&network.weights), "{threads} {parallel}");
            assert_eq!(outcome, network.outcome);
        }
    }
    assert!(network.outcome.best_epoch > 0);
}

#[test]
fn a_network_comes_back_from_a_file_with_the_same_scores() {
    let means = means(&[4e5, 5e5, 3e5], &[1.0, -1.0, 1.0], 1.0);
    let split = split(&means, 200, 1);
    let network = trained(&split, Settings::default());
    let text = serde_json::to_string(&network).unwrap();
    let back: Network = serde_json::from_str(&text).unwrap();
    for (counts, _) in split.test.iter() {
        let (mut a, mut b) = ([0.0; 2], [0.0; 2]);
        network.judge().score(counts, &mut a);
        back.judge().score(counts, &mut b);
        assert_eq!(a.map(f64::to_bits), b.map(f64::to_bits));
    }
    let changed = |change: &dyn Fn(&mut serde_json::Value)| {
        let mut value = serde_json::to_value(&network).unwrap();
        change(&mut value);
        serde_json::from_value::<Network>(value).map_err(|error| error.to_string())
    };
    assert!(changed(&|_| ()).is_ok());
    assert!(changed(&|v| v["weights"][7] = 1e300.into()).unwrap_err().contains("a finite number"));
    assert!(changed(&|v| v["weights"][7] = serde_json::Value::Null).is_err());
    assert!(changed(&|v| v["bands"] = 4.into()).unwrap_err().contains("are needed"));
    assert!(changed(&|v| v["bands"] = u64::MAX.into()).is_err());
    assert!(changed(&|v| v["classes"] = 1.into()).unwrap_err().contains("number of classes"));
    assert!(changed(&|v| v["options"]["taps"] = 4.into()).unwrap_err().contains("taps"));
    assert!(changed(&|v| v["standard"]["scales"] = vec![1.0; 2].into()).unwrap_err().contains("scales"));
}

#[test]
fn what_cannot_be_learnt_from_is_refused() {
    let options = NetworkOptions::default();
    let train = |a: &LabelledSpectra, b: &LabelledSpectra| Network::train(a, b, &options, &|_, _| ());
    let spectra = |bands, classes, n: usize| {
        let counts = (0..bands * n).map(|i| i as f64).collect();
        LabelledSpectra::new(bands, classes, counts, (0..n).map(|i| i % classes).collect()).unwrap()
    };
    let good = spectra(3, 2, 8);
    assert!(train(&good, &good).is_ok());
    assert!(train(&spectra(3, 2, 0), &good).is_err() && train(&good, &spectra(3, 2, 0)).is_err());
    assert!(train(&spectra(3, 1, 8), &spectra(3, 1, 8)).is_err());
    assert!(train(&good, &spectra(4, 2, 8)).is_err() && train(&good, &spectra(3, 3, 9)).is_err());
    let huge = LabelledSpectra::new(1, 2, vec![-1e308, 1e308], vec![0, 1]).unwrap();
    assert!(train(&huge, &huge).is_err());

    let network = train(&good, &good).unwrap();
    let mut scores = [0.0; 2];
    assert!(!network.judge().score(&[1.0; 4], &mut scores) && scores[0].is_nan());
    assert!(!network.judge().score(&[f64::NAN; 3], &mut scores));

    let refused = |change: &dyn Fn(&mut Settings)| {
        let mut settings = Settings::default();
        change(&mut settings);
        NetworkOptions::new(settings).is_err()
    };
    assert!(refused(&|s| s.channels = 4) && refused(&|s| s.channels = 0) && refused(&|s| s.batch = 8));
    assert!(
        refused(&|s| s.taps = 4)
            && refused(&|s| s.stride = 0)
            && refused(&|s| s.epochs = 0)
            && refused(&|s| s.patience = 0)
    );
    assert!(refused(&|s| s.learning_rate = f64::NAN) && refused(&|s| s.weight_decay = -1.0));
}
