use super::*;
use hadar::fisher::{Counting, Nuisance};
use hadar::identifiability::nearest::NearestSolver;
use hadar::scene::EnvironmentObject;
use hadar_testing::{digits, number, reference_emissivity, reference_pairs};

/// Nearest distances of 30 digits: from the rounded state of the file Newton's method must come to the same distance.
/// Tolerance 1e-27: the file's digits, less what its ratio to the terms of the separation loses.
#[test]
fn thirty_digit_distances_are_met() {
    let Some(cases) = reference_pairs() else { return };
    let mut count = 0;
    // One case in full and each of the others would take a minute: the paper's pair and its reverse.
    for case in cases.iter().take(2) {
        let (nu, target) = reference_emissivity(&case["target"]);
        let (_, alternative) = reference_emissivity(&case["alternative"]);
        let bands = Bands::from_rows(nu.iter().map(|&nu| (nu, 1.0))).unwrap();
        let environment = case["environment"].as_array().unwrap();
        let object = EnvironmentObject { temperature_k: number(&environment[0]["T"]), emissivity: None };
        let surroundings = Surroundings::new(bands.nodes_cm1(), vec![object]).unwrap();
        let lighting = [number(&environment[0]["V"])];
        let state = surroundings.state(number(&case["target_temperature_k"]), &lighting).unwrap();
        for answer in case["distance_nearest"].as_array().unwrap() {
            let unknowns = Unknowns::new([Nuisance::Temperature, Nuisance::Lighting]).unwrap();
            let pair = Pair { emissivity: &target, alternative: &alternative, state: &state };
            let start = State {
                temperature_k: number(&answer["temperature_k"]) + 0.01,
                lighting: vec![number(&answer["lighting"][0]) - 1e-4],
                ..state.clone()
            };
            let noise = Noise::PerPhoton { photons: f64::INFINITY };
            let mut solver = NearestReference::new(&bands, &surroundings, unknowns, StateRange::default());
            let (found, at) = solver.nearest_from(pair, &[start], noise).unwrap();
            let error = found.relative_error_to(&Extended::parse(&digits(&answer["value"])));
            println!("{}: {error:.1e}", case["name"]);
            assert!(error < 1e-27, "{}: {error:e}", case["name"]);
            assert!((at.temperature_k / number(&answer["temperature_k"]) - 1.0).abs() < 1e-14);
            count += 1;
        }
    }
    assert_eq!(count, 2);
}

/// A small scene with every kind of nuisance, priors and limits that hold: from the state that the fast path finds,
/// there is no way further down than rounding.
#[test]
fn the_fast_path_stands_at_the_bottom() {
    let bands = Bands::uniform(800.0, 1200.0, 40.0).unwrap();
    let object = |temperature_k| EnvironmentObject { temperature_k, emissivity: None };
    let surroundings = Surroundings::new(bands.nodes_cm1(), vec![object(290.0), object(250.0)]).unwrap();
    let state = surroundings.state(310.0, &[0.5, 0.3]).unwrap();
    let target: Vec<f64> = (0..bands.len()).map(|i| 0.9 - 0.01 * i as f64).collect();
    let alternative: Vec<f64> = (0..bands.len()).map(|i| 0.5 + 0.03 * (i % 4) as f64).collect();
    let pair = Pair { emissivity: &target, alternative: &alternative, state: &state };
    let counting = Counting { counts_per_radiance: 1e-12, var_added: vec![1e6; bands.len()] };
    let sets = [
        Unknowns::new([Nuisance::Temperature]).unwrap(),
        Unknowns::new([Nuisance::Temperature, Nuisance::Lighting]).unwrap(),
        Unknowns::new([Nuisance::Temperature, Nuisance::Lighting])
            .unwrap()
            .lighting_total(Some(0.8))
            .unwrap(),
        Unknowns::new([Nuisance::Temperature, Nuisance::Gain]).unwrap().prior(Nuisance::Gain, 0.1).unwrap(),
    ];
    for unknowns in sets {
        let range = StateRange { temperature_k: [250.0, 330.0], ..StateRange::default() };
        let mut fast = NearestSolver::new(&bands, &surroundings, unknowns.clone(), range);
        let found = fast.with_counting(&target, &alternative, &state, &counting).unwrap();
        let mut reference = NearestReference::new(&bands, &surroundings, unknowns.clone(), range);
        let noise = Noise::Counting(&counting);
        let here = reference.separation(pair, &found.state, noise);
        let error = here.distance.relative_error_to(&Extended::from(found.distance));
        assert!(error < 1e-13, "{unknowns:?}: {error:e}");
        let own = reference.separation(pair, &state, noise);
        assert!(here.distance < own.distance && own.distance <= own.terms);
        let start = std::slice::from_ref(&found.state);
        let (least, _) = reference.nearest_from(pair, start, noise).unwrap();
        assert!(least <= here.distance, "{unknowns:?}");
        assert!(least.relative_error_to(&here.distance) < 1e-9, "{unknowns:?} {found:?}");
    }
}
