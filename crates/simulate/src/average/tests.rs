use super::*;
use crate::draws::generator;
use hadar::fisher::Nuisance::{Lighting, Temperature};
use hadar::fisher::{Counting, Unknowns};
use hadar::identifiability::bayes::BayesianBound;
use hadar::identifiability::detection;
use hadar::identifiability::nearest::StateRange;
use hadar::scene::EnvironmentObject;

/// Random scenes, priors on the temperature alone and on temperature and lighting, at equilibrium and away from it: the share
/// that the simulated Bayes test decides rightly lies in the bracket of the limits, which share no likelihood with it (normal
/// counts projected on a few directions there, Poisson counts in all bands here), within 3.3 deviations; and so it does at
/// both ends of the photons that are said to be required.
#[test]
fn the_bayes_test_keeps_the_bracket() {
    let mut rng = generator(40, 0);
    for scene in 0..6 {
        let mut uniform = |low: f64, high: f64| rng.random_range(low..high);
        let bands = Bands::uniform(750.0, 1250.0, 50.0).unwrap();
        let object = EnvironmentObject { temperature_k: uniform(270.0, 300.0), emissivity: None };
        let surroundings = Surroundings::new(bands.nodes_cm1(), vec![object.clone()]).unwrap();
        let mut material = || {
            let (mean, swing, phase) = (uniform(0.4, 0.9), uniform(0.0, 0.09), uniform(0.0, 6.0));
            let at = |nu: &f64| mean + swing * (nu / 70.0 + phase).sin();
            bands.nodes_cm1().iter().map(at).collect::<Vec<f64>>()
        };
        let materials = [material(), material()];
        let (two, equilibrium) = (scene % 2 == 1, scene % 3 == 0);
        let temperature_k = if equilibrium { object.temperature_k } else { uniform(285.0, 310.0) };
        let lighting = if two || !equilibrium { uniform(0.3, 0.95) } else { 1.0 };
        let state = surroundings.state(temperature_k, &[lighting]).unwrap();
        let sigma = [uniform(0.5, 5.0), uniform(0.02, 0.3)];
        let mut unknowns = Unknowns::new([Temperature]).unwrap().prior(Temperature, sigma[0]).unwrap();
        if two {
            unknowns = unknowns.with(Lighting).prior(Lighting, sigma[1]).unwrap();
        }
        let pair = Pair { emissivity: &materials[0], alternative: &materials[1], state: &state };
        let bound = BayesianBound::new(&bands, &surroundings, unknowns.clone());
        let total: f64 = bands.weigh(&surroundings.signal(&materials[0], &state)).iter().sum();
        let wanted = uniform(0.7, 0.9);
        let needed = bound.photons_for_average(pair, wanted, &|_, _| ()).unwrap().unwrap();
        let prior = PriorSpace::new(&unknowns, &state, &StateRange::default()).unwrap();
        let priors = [prior.clone(), prior];
        let upper = needed.upper.unwrap();
        println!(
            "scene {scene}, priors {}, wanted {wanted:.4}: {:.3e} to {upper:.3e} photons",
            1 + usize::from(two),
            needed.lower
        );
        // Below 300 photons there is the rigorous limit alone.
        assert!(upper < 1.5 * needed.lower || needed.lower < 300.0, "{needed:?}");
        for (photons, sides) in [(needed.lower, [0.0, wanted]), (upper, [wanted, 1.0])] {
            let counting = Counting { counts_per_radiance: photons / total, var_added: Vec::new() };
            let test = AverageScene {
                bands: &bands,
                surroundings: &surroundings,
                pair,
                priors: &priors,
                lighting_total_known: false,
                counts_per_radiance: counting.counts_per_radiance,
                statistics: &Statistics::Poisson,
            };
            let found = test.decide(7, 10_000, &|means| Draws::new(&Statistics::Poisson, means)).unwrap();
            let deviation = (found.probability * (1.0 - found.probability) / found.trials as f64).sqrt();
            let reach = 3.3 * deviation;
            let bracket = bound.average_probability(pair, &counting).unwrap();
            let lower = bracket.lower.unwrap_or(0.5);
            println!(
                "    {photons:.3e}: {:.4} +- {deviation:.4} in {lower:.4} to {:.4}; half the states change {:.4}",
                found.probability, bracket.upper, found.changed_by_half_the_states
            );
            assert!(
                found.probability <= bracket.upper + reach && found.probability >= lower - reach,
                "{found:?}"
            );
            assert!(
                found.probability <= sides[1] + reach && found.probability >= sides[0] - reach,
                "{found:?}"
            );
        }
    }
}

/// Where all is as good as known it is the test of two points, under each law of counts: 3.3 deviations of Φ(d).
#[test]
fn a_narrow_prior_makes_it_the_test_of_two_points() {
    let bands = Bands::uniform(750.0, 1250.0, 50.0).unwrap();
    let object = EnvironmentObject { temperature_k: 285.0, emissivity: None };
    let surroundings = Surroundings::new(bands.nodes_cm1(), vec![object]).unwrap();
    let materials: [Vec<f64>; 2] = [0.9, 0.85]
        .map(|mean| bands.nodes_cm1().iter().map(|nu| mean + 0.05 * (nu / 60.0).sin() * mean).collect());
    let state = surroundings.state(300.0, &[0.5]).unwrap();
    let unknowns = Unknowns::new([Temperature]).unwrap().prior(Temperature, 1e-7).unwrap();
    let prior = PriorSpace::new(&unknowns, &state, &StateRange::default()).unwrap();
    let priors = [prior.clone(), prior];
    let signals = materials.each_ref().map(|e| bands.weigh(&surroundings.signal(e, &state)));
    let kappa = 3e3 / signals[0].iter().sum::<f64>();
    let modes = vec![300.0; bands.len()];
    for statistics in [
        Statistics::Poisson,
        Statistics::gaussian(vec![100.0; bands.len()]).unwrap(),
        Statistics::negative_binomial(modes).unwrap(),
    ] {
        let excess =
            signals[0].iter().enumerate().map(|(w, s)| statistics.variance(w, s * kappa) - s * kappa);
        let counting = Counting { counts_per_radiance: kappa, var_added: excess.collect() };
        let means = signals.each_ref().map(|signal| signal.iter().map(|s| s * kappa).collect::<Vec<f64>>());
        let exact = detection::probability(detection::half_separation(&means[0], &means[1], &counting));
        let test = AverageScene {
            bands: &bands,
            surroundings: &surroundings,
            pair: Pair { emissivity: &materials[0], alternative: &materials[1], state: &state },
            priors: &priors,
            lighting_total_known: false,
            counts_per_radiance: kappa,
            statistics: &statistics,
        };
        let found = test.decide(3, 20_000, &|means| Draws::new(&statistics, means)).unwrap();
        println!("{statistics:?}: {:.4}, two points {exact:.4}", found.probability);
        assert!((found.probability - exact).abs() < 3.3 * (0.25 / 40_000.0_f64).sqrt() + 2e-3, "{found:?}");
        assert!(found.changed_by_half_the_states < 1e-3 && exact > 0.6 && exact < 0.95, "{found:?} {exact}");
    }
}
