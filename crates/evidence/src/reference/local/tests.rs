use super::*;
use hadar::fisher::Nuisance;
use hadar::scene::EnvironmentObject;
use hadar_testing::{digits, number, reference_emissivity, reference_pairs};

/// Tolerance 1e-27: the file's own 30 digits, less what is lost to the largest ratio of its distances without and
/// with nuisances (its own computation carried 40). The one answer that is not defined is left out: gain at
/// T = T₀ of a grey target.
#[test]
fn thirty_digit_distances_are_met() {
    let Some(cases) = reference_pairs() else { return };
    let mut count = 0;
    for case in &cases {
        let (nu, target) = reference_emissivity(&case["target"]);
        let (_, alternative) = reference_emissivity(&case["alternative"]);
        let bands = Bands::from_rows(nu.iter().map(|&nu| (nu, 1.0))).unwrap();
        let environment = case["environment"].as_array().unwrap();
        let objects = environment.iter().map(|object| EnvironmentObject {
            temperature_k: number(&object["T"]),
            emissivity: object.get("material").map(|name| reference_emissivity(name).1),
        });
        let surroundings = Surroundings::new(bands.nodes_cm1(), objects.collect()).unwrap();
        let lighting: Vec<f64> = environment.iter().map(|object| number(&object["V"])).collect();
        let state = surroundings.state(number(&case["target_temperature_k"]), &lighting).unwrap();
        for answer in case["distance_local"].as_array().unwrap() {
            let names: Vec<String> = answer["unknown"].as_array().unwrap().iter().map(digits).collect();
            if case["name"] == "equilibrium_T_only" && names.len() == 3 {
                continue;
            }
            let named = |nuisance: &Nuisance| names.iter().any(|name| name == nuisance.name());
            let unknowns = Unknowns::new(Nuisance::ALL.into_iter().filter(named)).unwrap();
            let pair = Pair { emissivity: &target, alternative: &alternative, state: &state };
            let noise = Noise::PerPhoton { photons: f64::INFINITY };
            let found = LocalReference::new(&bands, &surroundings, unknowns).answer(pair, noise, &[]);
            let error = found.distance.relative_error_to(&Extended::parse(&digits(&answer["value"])));
            println!("{} {names:?}: {error:.1e}", case["name"]);
            assert!(error < 1e-27, "{} {names:?}: {error:e}", case["name"]);
            let radiance = Extended::parse(&digits(&case["photon_radiance"]));
            assert!(found.photon_radiance.relative_error_to(&radiance) < 1e-28);
            count += 1;
        }
    }
    assert!(count > 10);
}

/// A column that is zero and one that is a multiple of another are told from one that nearly is.
#[test]
fn dependent_nuisances_are_told_from_nearly_dependent_ones() {
    let bands = Bands::uniform(800.0, 1200.0, 40.0).unwrap();
    let next = f64::from_bits(300.0_f64.to_bits() + 1);
    let object = |temperature_k| EnvironmentObject { temperature_k, emissivity: None };
    let objects = [300.0, 300.0, next].map(object).to_vec();
    let surroundings = Surroundings::new(bands.nodes_cm1(), objects).unwrap();
    let state = surroundings.state(320.0, &[0.2, 0.2, 0.0]).unwrap();
    let emissivity: Vec<f64> = (0..bands.len()).map(|i| 0.9 - 0.01 * i as f64).collect();
    let alternative: Vec<f64> = (0..bands.len()).map(|i| 0.8 + 0.01 * (i % 3) as f64).collect();
    let unknowns = Unknowns::new([Nuisance::Lighting, Nuisance::EnvironmentTemperature]).unwrap();
    let pair = Pair { emissivity: &emissivity, alternative: &alternative, state: &state };
    let noise = Noise::PerPhoton { photons: f64::INFINITY };
    let mut reference = LocalReference::new(&bands, &surroundings, unknowns);
    let found = reference.answer(pair, noise, &[]);
    use Parameter::{EnvironmentTemperature, Lighting};
    assert_eq!(
        found.dropped,
        [Lighting(1), EnvironmentTemperature(1), EnvironmentTemperature(2)],
        "{:?}",
        found.shares
    );
    // One ulp of 300 K is 1.9e-16 of it: what is left of the third object's column is x·1.9e-16 of it, but for its
    // mean over the bands.
    let share = found.shares[2].left;
    assert!(1e-17 < share && share < 1e-15, "{share:e}");
    // Its direction is that of ∂B/∂T: leaving out it or all others of that direction is the same.
    let one = reference.answer(pair, noise, &[Lighting(2)]);
    let other = reference.answer(pair, noise, &[EnvironmentTemperature(0), EnvironmentTemperature(1)]);
    assert!(one.distance.relative_error_to(&other.distance) < 1e-12);
    // Both together remove ∂²B/∂T² as well.
    assert!(found.distance < one.distance);
}
