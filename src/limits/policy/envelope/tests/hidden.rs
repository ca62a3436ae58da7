//! A proof ends at the distance attained, which hides a bound that is too high. Told that more was attained than can be, it must
//! find that out: whatever is attained, no bound is above the least distance there is.

use super::*;
use crate::policy::envelope::prove::prove;

/// What is proved of an envelope by a proof that is told `times` the distance attained.
fn proved_by(setting: &Setting, ranges: &Ranges, times: f64) -> (f64, f64, u64) {
    let scene = setting.scene();
    let mut joint = Model::new(&scene, ranges);
    let attained = attain::attain(&scene, ranges, SCENES, Some(&joint)).unwrap();
    let best = joint::residual(&joint.0, &joint.0.point(&attained.state, &attained.nearest));
    joint.0.lean([&best.target, &best.alternative]);
    let there = attained.distance;
    let told = Attained { distance: times * there, ..attained };
    let proof = prove(&joint, ranges, &Effort::default(), &best, told).unwrap();
    (proof.lower_bound, there, proof.boxes)
}

fn three_bands(unknown: impl IntoIterator<Item = Nuisance>) -> Setting {
    let bands = Bands::from_rows(vec![(800.0, 200.0), (1000.0, 200.0), (1200.0, 200.0)]).unwrap();
    Setting {
        surroundings: Surroundings::new(bands.nodes_cm1(), Vec::new()).unwrap(),
        emissivity: vec![0.9, 0.5, 0.8],
        alternative: vec![0.6, 0.7, 0.5],
        counting: Counting { counts_per_radiance: 1.0, var_added: vec![] },
        unknowns: Unknowns::new(unknown).unwrap(),
        range: StateRange::default(),
        bands,
    }
}

/// Noise of any height above the counts.
#[test]
fn noise_far_above_the_counts_excludes_nothing() {
    let ranges = Ranges::new([300.0, 310.0], vec![], vec![]).unwrap();
    for unknown in
        [vec![Nuisance::Temperature], vec![Nuisance::Gain], vec![Nuisance::Temperature, Nuisance::Gain]]
    {
        for exponent in [0, 8, 14, 16, 18, 22, 28] {
            let mut setting = three_bands(unknown.clone());
            let state = setting.surroundings.state(305.0, &[]).unwrap();
            let signal = setting.bands.weigh(&setting.surroundings.signal(&setting.emissivity, &state));
            setting.counting = Counting::shot(1e6, &signal);
            setting.counting.var_added = vec![1e6 * 10f64.powi(exponent); 3];
            for times in [1.3, 10.0] {
                let (lower, there, boxes) = proved_by(&setting, &ranges, times);
                assert!(
                    lower <= there * (1.0 + 1e-6),
                    "{unknown:?} 1e{exponent}: {lower:e} {there:e} {boxes}"
                );
                assert!(boxes > 0, "{unknown:?} 1e{exponent}: {lower:e} {there:e}");
            }
        }
    }
}

/// What nearly equal materials send and scatter differently keeps its digits, also where 1 − e is rounded.
#[test]
fn differences_of_nearly_equal_materials_keep_their_digits() {
    let mut setting = three_bands([]);
    let object = EnvironmentObject { temperature_k: 270.0, emissivity: Some(vec![0.9, 0.7, 0.3]) };
    setting.surroundings = Surroundings::new(setting.bands.nodes_cm1(), vec![object]).unwrap();
    setting.emissivity = vec![0.11, 0.23, 0.37];
    setting.alternative = setting.emissivity.iter().map(|e| e * (1.0 + 1e-13)).collect();
    let ranges = Ranges::new([300.0; 2], vec![[0.5; 2]], vec![[270.0; 2]]).unwrap();
    let (model, _) = Model::new(&setting.scene(), &ranges);
    // The difference of two numbers so near is exact.
    let apart: Vec<f64> = setting.emissivity.iter().zip(&setting.alternative).map(|(a, b)| a - b).collect();
    let scattered: Vec<f64> = apart.iter().zip([0.9, 0.7, 0.3]).map(|(apart, own)| -apart * own).collect();
    assert_eq!([&model.sources[0].own, &model.sources[1].own], [&apart, &scattered]);
}
